//! Where everything is at one contact point in space, and the chain rule from its fifteen directions to the unknowns of
//! its stencil: those of its own nodes, then the six of the tool.

use super::open::OpenContact;
use super::point::{Closed, Place, Triad};
use super::surface::MAX_NODES;
use crate::Failure;
use crate::contact::record::entry;
use crate::contact::seed::Seed;
use crate::system::{Local, Stencil};
use crate::tensor::{Dual, Vec3};
use crate::tool::Ray;
use crate::tool::space::{Hit, Pose};

/// Directions in which a contact point is differentiated: five vectors.
pub const DIRECTIONS: usize = 15;
/// Unknowns of a tool.
pub const TOOL: usize = 6;
/// Most unknowns of a stencil.
const MAX_DOFS: usize = 3 * MAX_NODES + TOOL;

/// Where everything is at one point, in plain numbers.
pub struct Geometry {
    /// Positions.
    pub place: Place<f64>,
    /// Where the target is hit.
    pub hit: Hit,
    /// Where the tool stands.
    pub pose: Pose,
}

/// A force on the unknowns of a stencil: on its own nodes, then on those of the tool.
pub struct Rows<'a, T> {
    shapes: &'a [f64],
    force: Vec3<T>,
    moment: Vec3<T>,
    turning: Vec3<T>,
}

impl<T: Seed<DIRECTIONS>> Rows<'_, T> {
    /// On unknown number `k`.
    pub(super) fn of(&self, k: usize) -> T {
        match k.checked_sub(3 * self.shapes.len()) {
            None => -self.force[k % 3] * self.shapes[k / 3],
            Some(axis) if axis < 3 => self.force[axis],
            Some(axis) => self.turning[axis - 3],
        }
    }
}

impl OpenContact<'_> {
    /// Where everything is for values `u` of a stencil's unknowns; None where it hits nothing.
    pub(super) fn geometry(&self, index: usize, stencil: &Stencil, u: &[f64]) -> Result<Option<Geometry>, Failure> {
        let Some(facet) = (stencil.choice as usize).checked_sub(1) else { return Ok(None) };
        let (contact, parts) = (self.contact, &self.contact.parts);
        let point = &parts.surface.points[index];
        let (nodes, mut x) = (parts.surface.nodes(point), [Vec3::zero(); MAX_NODES]);
        for ((x, u), &node) in x.iter_mut().zip(u.chunks_exact(3)).zip(nodes) {
            *x = parts.mesh.points[node] + Vec3::new(u[0], u[1], u[2]);
        }
        let (a, tangents) = point.place(&x[..nodes.len()]);
        let inward = Triad::new(tangents).inward;
        let motion = &u[3 * nodes.len()..];
        let pose = Pose::new(std::array::from_fn(|i| motion[i]));
        let lost = || Failure::new(format!("{}: its ray runs along the target", contact.describe(index)));
        let ray = Ray { origin: a, direction: inward };
        let hit = contact.tool().cast_facet(&pose, facet, &ray, stencil.near).ok_or_else(lost)?;
        let touched = self.touched(index).map(|(facet, s)| contact.tool().point(&pose, facet, s));
        Ok(Some(Geometry { place: Place { a, tangents, b: a + inward * hit.u, touched }, hit, pose }))
    }

    /// The facet touched at the last accepted state, and where.
    fn touched(&self, index: usize) -> Option<(usize, [f64; 2])> {
        let old = self.history.slot(index);
        (old[entry::SEGMENT] >= 0.0).then(|| (old[entry::SEGMENT] as usize, [old[entry::S], old[entry::S2]]))
    }

    /// What a force at `at` does to the unknowns of a stencil.
    pub(super) fn rows<T: Seed<DIRECTIONS>>(
        &self,
        index: usize,
        g: &Geometry,
        at: Vec3<T>,
        force: Vec3<T>,
    ) -> Rows<'_, T> {
        let (contact, point) = (self.contact, &self.contact.parts.surface.points[index]);
        let reference = contact.tool().reference() + g.pose.translation;
        let moment = (at - reference.lift()).cross(force);
        let own = contact.parts.surface.nodes(point).len();
        Rows { shapes: &point.n[..own], force, moment, turning: conjugate(&g.pose, moment) }
    }

    /// Adds the forces of a closed point and their derivatives by the chain rule: `-N_L f` on its own nodes, and on the
    /// tool the force and what does the work of its moment about the reference point.
    pub(super) fn add<T: Seed<DIRECTIONS>>(&self, index: usize, g: &Geometry, closed: &Closed<T>, local: &mut Local) {
        let n = local.force.len();
        let (own, rows) = (n - TOOL, self.rows(index, g, closed.hit, closed.force));
        for i in 0..n {
            local.force[i] += rows.of(i).re();
        }
        if local.wants_tangent {
            let columns = self.columns(index, g, own);
            for i in 0..n {
                let slopes = rows.of(i).slopes();
                for (entry, column) in local.tangent[i * n..].iter_mut().zip(&columns[..n]) {
                    *entry += slopes.iter().zip(column).map(|(s, c)| s * c).sum::<f64>();
                }
            }
            stiffen(&g.pose, (closed.force.re(), rows.moment.re()), &mut local.tangent[own * n + own..], n);
        }
    }

    /// Derivatives of the fifteen directions along each unknown of the stencil.
    pub(super) fn columns(&self, index: usize, g: &Geometry, own: usize) -> [[f64; DIRECTIONS]; MAX_DOFS] {
        let (contact, mut columns) = (self.contact, [[0.0; DIRECTIONS]; MAX_DOFS]);
        let point = &contact.parts.surface.points[index];
        for (k, column) in columns[..own].iter_mut().enumerate() {
            column[k % 3] = point.n[k / 3];
            column[3 + k % 3] = point.dn[k / 3][0];
            column[6 + k % 3] = point.dn[k / 3][1];
        }
        let reference = contact.tool().reference();
        let at_hit = g.pose.rates(reference, g.place.b);
        let at_touched = g.place.touched.map_or([Vec3::zero(); TOOL], |x| g.pose.rates(reference, x));
        for (k, column) in columns[own..own + TOOL].iter_mut().enumerate() {
            column[9..12].copy_from_slice(&at_hit[k].0);
            column[12..15].copy_from_slice(&at_touched[k].0);
        }
        columns
    }
}

/// The forces on the unknowns of a rotation that do the work of a moment.
fn conjugate<T: Seed<DIRECTIONS>>(pose: &Pose, moment: Vec3<T>) -> Vec3<T> {
    let rotation = Pose { translation: Vec3::zero(), rotation: pose.rotation.lift() };
    rotation.conjugate(moment)
}

/// What the motion of the tool adds to the derivatives besides those of the place and the force: the arm shortens as
/// the reference point moves, and a turning tool has other axes. `block` begins at the tool's own rows and columns.
fn stiffen(pose: &Pose, (force, moment): (Vec3, Vec3), block: &mut [f64], n: usize) {
    let turned = Pose {
        translation: Vec3::zero(),
        rotation: Vec3(std::array::from_fn(|i| Dual::<3>::variable(pose.rotation[i], i))),
    };
    let turning = turned.conjugate(moment.lift());
    for j in 0..3 {
        let axis = Vec3(std::array::from_fn(|k| f64::from(u8::from(k == j))));
        let shorter = pose.conjugate(-axis.cross(force));
        for i in 0..3 {
            block[(3 + i) * n + j] += shorter[i];
            block[(3 + i) * n + 3 + j] += turning[i].du[j];
        }
    }
}
