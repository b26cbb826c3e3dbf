//! Friction by a pressure that is a mean over the neighbourhood of a point (Oden and Pires, J. Appl. Mech. 50, 1983), with
//! a tool: `S = sum_j w_j A_j p_j / sum_j w_j A_j`, `w = exp(1 / ((r / rho)^2 - 1))` within the radius `rho`
//! on the undeformed surface.
//!
//! The pressures `p_j = K_p <u_j>` are those at the trial displacements, never those of the last iterate: a point casts
//! the rays of its neighbours too, their nodes are unknowns of its stencil behind its own, and the derivatives of the
//! mean along them are in the tangent. Its own pressure and the place of its forces stay local.

use super::attempt::PaperAttempt;
use super::point::Triad;
use super::segment::{dofs_of, placed};
use super::stencil::PointGeometry;
use crate::Failure;
use crate::contact::field::configuration::TargetInPlace;
use crate::interface::{Interface, Linearised, Past};
use crate::system::Local;
use crate::tool::{ProfileRay, Rejected};
use std::ops::Range;

/// A mean pressure and its derivatives along all unknowns of a stencil.
pub struct MeanPressure {
    /// The mean.
    pub pressure: f64,
    /// Its derivatives.
    pub slopes: Vec<f64>,
}

impl PaperAttempt<'_> {
    /// The mean pressure around a point for values `u` of its unknowns; none where friction is local.
    pub(super) fn mean_pressure(&self, index: usize, g: &PointGeometry, u: &[f64]) -> Option<MeanPressure> {
        let parts = self.contact.neighbours.of(index)?;
        let mut mean = MeanPressure { pressure: 0.0, slopes: vec![0.0; u.len()] };
        for &(point, part) in parts {
            self.add_pressure((point, part), (self.nodes_of(index, point, g), g), u, &mut mean);
        }
        Some(mean)
    }

    /// Where the unknowns of a neighbour's nodes stand in the stencil of a point.
    fn nodes_of(&self, index: usize, neighbour: usize, g: &PointGeometry) -> Range<usize> {
        let (parts, mut start) = (&self.contact.parts, g.count);
        let face = self.contact.points[neighbour].face;
        if face == self.contact.points[index].face {
            return 0..g.own;
        }
        for &other in self.contact.neighbours.others(index) {
            let end = start + dofs_of(&parts.surface.faces[other].nodes, &parts.dofs).count();
            if other == face {
                return start..end;
            }
            start = end;
        }
        start..start
    }

    /// Adds what one neighbour gives to the mean.
    fn add_pressure(
        &self,
        (index, part): (usize, f64),
        (own, g): (Range<usize>, &PointGeometry),
        u: &[f64],
        mean: &mut MeanPressure,
    ) {
        let (contact, parts) = (self.contact, &self.contact.parts);
        let (point, face) = (&self.contact.points[index], self.contact.face(index));
        let (placed, axes) = (placed(&face.nodes, &parts.mesh, &u[own.clone()]), parts.dofs.per_node());
        let plane = contact.surface().plane;
        let tangents = point.shape.tangents(placed.nodes(), plane);
        let inward = Triad::new(tangents, plane).inward;
        let ray = ProfileRay { origin: point.shape.value(placed.nodes()), direction: inward };
        let cast = contact.cast(index, ray, (self.depths[index], self.reach));
        let Some(tool) = g.segment.tool() else { return };
        let Some(hit) = TargetInPlace::Tool(tool).see(&cast, &mut Rejected::default()) else { return };
        let seen = hit.u + self.closure(index) - contact.least;
        if seen <= 0.0 {
            return;
        }
        let (stiffness, cosine) = (part * parts.options.penalty, hit.normal.dot(inward));
        mean.pressure += stiffness * seen;
        let area = tangents[1].cross(tangents[0]);
        for (k, column) in own.enumerate() {
            let turned = area.turned(-point.shape.area_rates(k / axes, tangents)[k % axes]);
            let moved = hit.normal[k % axes] * point.shape.n[k / axes];
            mean.slopes[column] -= stiffness * (moved + hit.normal.dot(turned) * hit.u) / cosine;
        }
        for (rate, column) in g.segment.rates(hit.s, ray.point(hit.u)).iter().zip(g.met.clone()) {
            mean.slopes[column] += stiffness * hit.normal.dot(*rate) / cosine;
        }
    }

    /// Adds to the tangent what the mean pressure does to the friction of a point, by the derivatives of its shear
    /// stresses along the mean.
    pub(super) fn add_neighbours(
        &self,
        (g, [s, t]): (&PointGeometry, [f64; 2]),
        mean: &MeanPressure,
        local: &mut Local,
    ) {
        let n = local.force.len();
        let force = (g.triad.along[0] * s + g.triad.along[1] * t) * self.present_area(g);
        for (i, row) in self.rows::<f64>(g, (g.place.b, g.place.b), force).iter().enumerate() {
            for (entry, change) in local.tangent[i * n..(i + 1) * n].iter_mut().zip(&mean.slopes) {
                *entry += row * change;
            }
        }
    }
}

/// The answer of a law, its friction that of the mean pressure `by` where there is one, and the derivatives of the two
/// shear stresses along that mean.
///
/// # Errors
/// As the law.
pub fn ask(
    (law, by): (&dyn Interface, Option<f64>),
    motion: [f64; 3],
    past: &Past,
    vars: &mut [f64],
) -> Result<(Linearised, [f64; 2]), Failure> {
    let local = law.respond(motion, past, vars)?;
    let Some(mean) = by else { return Ok((local, [0.0; 2])) };
    let mean = law.respond([mean / past.penalty, motion[1], motion[2]], past, vars)?;
    let ([_, s, t], [_, by_s, by_t]) = (mean.stress, mean.slopes);
    // The mean does not follow the penetration of the point alone.
    let fixed = |slopes: [f64; 3]| [0.0, slopes[1], slopes[2]];
    let (stress, slopes) = ([local.pressure(), s, t], [local.slopes[0], fixed(by_s), fixed(by_t)]);
    let response = Linearised { stress, slopes, closure: local.closure, ..mean };
    Ok((response, [by_s[0], by_t[0]].map(|slope| slope / past.penalty)))
}
