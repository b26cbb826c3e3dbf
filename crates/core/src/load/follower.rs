//! Pressure that turns and grows with its surface: `F_L = -p integral of N_L (g1 x g2) d xi`, in the present positions.
//!
//! The tangent is the exact derivative of the density `q(x, g1, g2)` by dual numbers at the integration point, chained
//! with the shape functions. It is unsymmetric unless the surface is closed or its rim held.

use super::face::{Face, FacePoint, area};
use super::{Site, now};
use crate::amplitude::Timeline;
use crate::mesh::Side;
use crate::system::{Attempt, Branch, History, Instant, Local, Role, State, Stencil, Stencils, Term};
use crate::tensor::{Dual, Vec3};
use crate::{Error, Failure};
use std::array::from_fn;

/// A pressure (a stress, positive into the body) along the present normal over the present area.
#[derive(Debug)]
pub struct FollowerPressure {
    name: String,
    site: Site,
    value: Timeline,
    faces: Vec<Face>,
}

impl FollowerPressure {
    /// A pressure on sides.
    ///
    /// # Errors
    /// An input error if a side cannot carry a load.
    pub fn new(name: &str, site: Site, sides: &[Side], value: Timeline) -> Result<Self, Error> {
        let faces = sides.iter().map(|&side| Face::new(name, &site.mesh, side)).collect::<Result<_, _>>()?;
        Ok(Self { name: name.into(), site, value, faces })
    }
}

impl Term for FollowerPressure {
    fn name(&self) -> &str {
        &self.name
    }
    fn role(&self) -> Role {
        Role::Load
    }
    fn initial(&self) -> History {
        History::new(self.faces.iter().map(|_| 0))
    }
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        _: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        Ok(Box::new(OpenPressure { load: self, value: now(&self.value, accepted, at) }))
    }
    fn name_of(&self, stencil: usize) -> String {
        self.faces[stencil].under(&self.name)
    }
}

/// A pressure at one instant.
struct OpenPressure<'a> {
    load: &'a FollowerPressure,
    value: f64,
}

impl Attempt for OpenPressure<'_> {
    fn scratch(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let unknowns = |face: &Face| self.load.site.unknowns(face.nodes.iter().copied());
        self.load.faces.iter().for_each(|face| out.push(unknowns(face), 0));
        Ok(())
    }
    fn evaluate(&self, index: usize, _: &Stencil, _: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        OpenFace { site: &self.load.site, face: &self.load.faces[index], pressure: self.value }.press(local);
        Ok(0)
    }
}

/// A face under a pressure.
pub(super) struct OpenFace<'a> {
    pub(super) site: &'a Site,
    pub(super) face: &'a Face,
    pub(super) pressure: f64,
}

impl OpenFace<'_> {
    /// Adds the forces of the pressure, and their derivatives where they are wanted.
    pub(super) fn press(&self, local: &mut Local) {
        let (site, face) = (self.site, self.face);
        for point in &face.points {
            let [x, g1, g2] = point.place(present(face, site, &local.u), site.space);
            let scale = -self.pressure * point.weight;
            if local.wants_tangent {
                let vary = |v: Vec3, first: usize| Vec3(from_fn(|i| Dual::<9>::variable(v[i], first + i)));
                let q = area(site, [vary(x, 0), vary(g1, 3), vary(g2, 6)]) * Dual::from(scale);
                add_forces(point, q.re(), site, &mut local.force);
                add_tangent(point, q, site, &mut local.tangent);
            } else {
                add_forces(point, area(site, [x, g1, g2]) * scale, site, &mut local.force);
            }
        }
    }
}

/// Present positions of the nodes of a face with displacements `u`.
pub(super) fn present<'a>(face: &'a Face, site: &'a Site, u: &'a [f64]) -> impl Iterator<Item = Vec3> + 'a {
    let displacements = u.chunks_exact(site.space.dimension());
    face.undeformed(&site.mesh).zip(displacements).map(|(mut x, u)| {
        u.iter().enumerate().for_each(|(axis, u)| x[axis] += u);
        x
    })
}

/// `F_Li += N_L q_i`.
fn add_forces(point: &FacePoint, q: Vec3, site: &Site, force: &mut [f64]) {
    for (force, n) in force.chunks_exact_mut(site.space.dimension()).zip(&point.n) {
        force.iter_mut().zip(q.0).for_each(|(force, q)| *force += n * q);
    }
}

/// `K_Li,Mj += N_L (dq_i/dx_j N_M + dq_i/dg1_j dN_M/dxi1 + dq_i/dg2_j dN_M/dxi2)`.
fn add_tangent(point: &FacePoint, q: Vec3<Dual<9>>, site: &Site, tangent: &mut [f64]) {
    let dim = site.space.dimension();
    let nodes = tangent.len().isqrt() / dim;
    for (row, values) in tangent.chunks_exact_mut(dim * nodes).enumerate() {
        let (n, slope) = (point.n[row / dim], &q[row % dim].du);
        for (m, columns) in values.chunks_exact_mut(dim).enumerate() {
            let [d1, d2] = point.dn[m];
            for (j, value) in columns.iter_mut().enumerate() {
                *value += n * (slope[j] * point.n[m] + slope[3 + j] * d1 + slope[6 + j] * d2);
            }
        }
    }
}
