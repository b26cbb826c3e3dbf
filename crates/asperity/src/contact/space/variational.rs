//! The variational form of contact with a tool in space: forces that are the gradient of a potential, as in the plane
//! ([`ContactForm::Variational`]), with two slips in place of one: `F = A_0 (p du/dq + tau_S ds/dq + tau_T dt/dq)`.

use super::geometry::Geometry;
use super::open::{D, OpenContact};
use super::pair::Contact;
use super::point::{Closed, Triad};
use super::surface::SurfacePoint;
use crate::Failure;
use crate::contact::ContactForm;
use crate::contact::point::acting;
use crate::contact::record::entry;
use crate::contact::seed::Seed;
use crate::contact::variational::{STEP, add_forces, add_slopes, bend_forces};
use crate::system::{Local, Stencil};
use crate::tensor::{Scalar, Vec3};
use crate::tool::Ray;

/// Rates of penetration and the two slips along the unknowns of a stencil.
pub type Rates = [Vec<f64>; 3];

impl Contact {
    /// Area over which the stresses of a point act whose tangents are these.
    pub(super) fn acting_area(&self, index: usize, point: &SurfacePoint, tangents: [Vec3; 2]) -> f64 {
        match self.parts.options.form {
            ContactForm::Traction => point.weight * Triad::new(tangents).area,
            ContactForm::Variational | ContactForm::Field => self.undeformed_area(index),
        }
    }

    /// Area that a point stands for before any motion.
    pub(super) fn undeformed_area(&self, index: usize) -> f64 {
        let (point, still) = (&self.parts.surface.points[index], vec![0.0; self.parts.dofs.count()]);
        point.weight * Triad::new(self.locate(point, &still).1).area
    }

    /// Direction in which a unit of pressure acts at a point in an accepted state.
    pub(super) fn thrust(&self, values: &[f64], u: &[f64], ray: Ray) -> Vec3 {
        if self.parts.options.form == ContactForm::Traction || values[entry::SEGMENT] < 0.0 {
            return ray.direction;
        }
        let (segment, near) = (values[entry::SEGMENT] as usize, [values[entry::S], values[entry::S2]]);
        let mut dofs = Vec::new();
        self.parts.target.unknowns(segment, &mut dofs);
        let own: Vec<f64> = dofs.iter().map(|&dof| u[dof]).collect();
        let normal = self.parts.target.meet(segment, &own, &ray, near).map_or(ray.direction, |hit| hit.normal);
        normal * normal.dot(ray.direction).recip()
    }
}

impl OpenContact<'_> {
    /// Penetration and slips of a point, with their rates along its unknowns `u`.
    pub(super) fn rates(&self, g: &Geometry, u: &[f64]) -> ([f64; 3], Rates) {
        let place = Self::variable(g);
        let (triad, normal) = (Triad::new(place.tangents), g.hit.normal.lift::<D>());
        let slip = |e: Vec3<D>| place.touched.map_or(D::zero(), |touched| e.dot(touched - place.a));
        let [s, t] = triad.along.map(slip);
        let y = [normal.dot(place.b - place.a) / normal.dot(triad.inward), s, t];
        let (columns, mut rates) = (self.columns(g, u), [0; 3].map(|_| vec![0.0; u.len()]));
        for (rates, y) in rates.iter_mut().zip(&y) {
            for (rate, column) in rates.iter_mut().zip(&columns) {
                *rate = y.du.iter().zip(column).map(|(s, c)| s * c).sum();
            }
        }
        (y.map(Scalar::re), rates)
    }

    /// Adds the forces of a closed point and their derivatives.
    ///
    /// # Errors
    /// As [`geometry`](Self::geometry), beside the point.
    pub(super) fn add_variational<T: Seed<15>>(
        &self,
        (index, stencil): (usize, &Stencil),
        g: &Geometry,
        closed: &Closed<T>,
        local: &mut Local,
    ) -> Result<(), Failure> {
        let area = self.contact.undeformed_area(index);
        let (_, rates) = self.rates(g, &local.u);
        let stresses = closed.stress;
        add_forces(&rates, &stresses, area, local);
        if !local.wants_tangent {
            return Ok(());
        }
        add_slopes((&rates, &self.columns(g, &local.u)), &stresses, area, local);
        // The last unknowns of a tool are its rotation.
        let rotation = g.layout.hit.end - 3..g.layout.hit.end;
        let step = |j| if rotation.contains(&j) { STEP } else { STEP * self.contact.face_length(index) };
        let loads = acting(stresses, local.acting).map(|stress| area * stress.re());
        bend_forces(loads, step, local, |u| {
            Ok(self.geometry(index, (stencil, true), u)?.map(|beside| self.rates(&beside, u).1))
        })
    }
}
