//! The variational form of contact with a tool, here in the plane: forces that are the gradient of a potential.
//!
//! The paper's force `p e_R` along the normal of the strained surface is not conservative. Here pressure and shear do
//! their work on the rates of penetration and slip themselves, over the undeformed area: `F = A_0 (p du/dq + tau ds/dq)`.
//! Without friction this is the gradient of `A_0 p^2 / 2 K`, the pressure acts along `n_B / (n_B.e_R)` with a couple that
//! turns the normal, and the tangent is symmetric. Both forms agree to first order in penetration and in the angle
//! between the two normals. The second derivatives of penetration and slip, which hold the curvature of the target, are
//! central differences of their rates; they are multiplied by the stresses, not by the penalty, so that their error is
//! far below rounding of the rest.

use super::geometry::{Geometry, MAX_DOFS};
use super::open::{D, OpenContact, seed};
use super::pair::Contact;
use super::point::{Closed, acting, triad};
use super::record::entry;
use super::seed::Seed;
use super::surface::SurfacePoint;
use crate::Failure;
use crate::system::{Local, Stencil};
use crate::tensor::{Scalar, Vec3};
use crate::tool::Ray;

/// How the stresses of a point become forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactForm {
    /// Along the triad of the strained surface, over the present area.
    Traction,
    /// As the gradient of a potential over the undeformed area.
    Variational,
    /// As a field of nodal values: see [`field`](super::field).
    Field,
}

/// Step of the differences, as a part of the length of an edge or a face, or in radians.
pub const STEP: f64 = 1e-5;

/// Rates of penetration and slip along the unknowns of a stencil.
pub type Rates = [[f64; MAX_DOFS]; 2];

impl Contact {
    /// Area that a point stands for before any motion.
    pub(super) fn undeformed_area(&self, index: usize) -> f64 {
        let point = &self.surface.points[index];
        let x: Vec<Vec3> = self.surface.nodes(point).iter().map(|&node| self.mesh.points[node]).collect();
        let (a, tangent) = point.place(&x);
        self.area(point, a, tangent)
    }

    /// Area over which the stresses of a point act.
    pub(super) fn acting_area(&self, index: usize, point: &SurfacePoint, (a, tangent): (Vec3, Vec3)) -> f64 {
        match self.options.form {
            ContactForm::Traction => self.area(point, a, tangent),
            ContactForm::Variational | ContactForm::Field => self.undeformed_area(index),
        }
    }

    /// Direction in which a unit of pressure acts at a point in an accepted state.
    pub(super) fn thrust(&self, values: &[f64], u: &[f64], ray: Ray) -> Vec3 {
        if self.options.form == ContactForm::Traction || values[entry::SEGMENT] < 0.0 {
            return ray.direction;
        }
        let (segment, near) = (values[entry::SEGMENT] as usize, [values[entry::S], values[entry::S2]]);
        let mut dofs = Vec::new();
        self.target.unknowns(segment, &mut dofs);
        let own: Vec<f64> = dofs.iter().map(|&dof| u[dof]).collect();
        let normal = self.target.meet(segment, &own, &ray, near).map_or(ray.direction, |hit| hit.normal);
        normal * normal.dot(ray.direction).recip()
    }
}

impl OpenContact<'_> {
    /// Penetration and slip of a point, with their rates along its unknowns `u`.
    pub(super) fn rates(&self, g: &Geometry, u: &[f64]) -> ([f64; 2], Rates) {
        let (along, inward, _) = triad(seed::<D>(g.place.tangent, 2));
        let (a, b, normal) = (seed::<D>(g.place.a, 0), seed::<D>(g.place.b, 4), g.hit.normal.lift::<D>());
        let penetration = normal.dot(b - a) / normal.dot(inward);
        let slip = g.place.touched.map_or(D::zero(), |touched| along.dot(seed::<D>(touched, 6) - a));
        let columns = self.columns(g, u);
        let rates = [penetration, slip].map(|y| {
            let rate = |column: &[f64; 8]| y.du.iter().zip(column).map(|(s, c)| s * c).sum();
            columns.each_ref().map(rate)
        });
        ([penetration.re(), slip.re()], rates)
    }

    /// Adds the forces of a closed point and their derivatives.
    ///
    /// # Errors
    /// As [`geometry`](Self::geometry), beside the point.
    pub(super) fn add_variational<T: Seed<8>>(
        &self,
        (index, stencil): (usize, &Stencil),
        g: &Geometry,
        closed: &Closed<T>,
        local: &mut Local,
    ) -> Result<(), Failure> {
        let area = self.contact.undeformed_area(index);
        let (_, rates) = self.rates(g, &local.u);
        let stresses = [closed.stress[0], closed.stress[1]];
        add_forces(&rates, &stresses, area, local);
        if !local.wants_tangent {
            return Ok(());
        }
        add_slopes((&rates, &self.columns(g, &local.u)), &stresses, area, local);
        let [p, s, _] = acting([stresses[0], stresses[1], T::zero()], local.acting);
        // The last unknown of a tool is its rotation.
        let step = |j| if j + 1 == g.layout.hit.end { STEP } else { STEP * self.contact.edge_length(index) };
        bend_forces([p, s].map(|stress| area * stress.re()), step, local, |u| {
            Ok(self.geometry(index, stencil, u)?.map(|beside| self.rates(&beside, u).1))
        })
    }
}

/// Adds the forces of stresses over an area that do their work on these rates.
pub fn add_forces<T: Scalar>(rates: &[impl AsRef<[f64]>], stresses: &[T], area: f64, local: &mut Local) {
    for (rates, stress) in rates.iter().zip(stresses) {
        local.force.iter_mut().zip(rates.as_ref()).for_each(|(force, rate)| *force += area * stress.re() * rate);
    }
}

/// Adds what the stresses' own derivatives give the tangent: `columns` are those of the directions along the unknowns.
pub fn add_slopes<T: Seed<N>, const N: usize>(
    (rates, columns): (&[impl AsRef<[f64]>], &[[f64; N]]),
    stresses: &[T],
    area: f64,
    local: &mut Local,
) {
    let n = local.force.len();
    for (rates, stress) in rates.iter().zip(stresses) {
        let (rates, slopes) = (rates.as_ref(), stress.slopes());
        for (j, column) in columns[..n].iter().enumerate() {
            let slope: f64 = slopes.iter().zip(column).map(|(s, c)| s * c).sum();
            (0..n).for_each(|i| local.tangent[i * n + j] += area * rates[i] * slope);
        }
    }
}

/// Adds what the second derivatives of penetration and slips give the tangent: central differences of their rates, by the
/// step of each unknown.
///
/// # Errors
/// As those of the rates.
pub fn bend_forces<R: AsRef<[f64]>, const N: usize>(
    loads: [f64; N],
    step: impl Fn(usize) -> f64,
    local: &mut Local,
    rates_at: impl Fn(&[f64]) -> Result<Option<[R; N]>, Failure>,
) -> Result<(), Failure> {
    let (n, mut u) = (local.force.len(), local.u.clone());
    for j in 0..n {
        for sign in [1.0, -1.0] {
            u[j] = local.u[j] + sign * step(j);
            let Some(beside) = rates_at(&u)? else { continue };
            for (rates, load) in beside.iter().zip(loads) {
                let part = sign * load / (2.0 * step(j));
                (0..n).for_each(|i| local.tangent[i * n + j] += part * rates.as_ref()[i]);
            }
        }
        u[j] = local.u[j];
    }
    Ok(())
}
