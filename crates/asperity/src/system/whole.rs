//! Parts of the mesh that hang together, carried on as rigid wholes.
//!
//! The motion of the last increment, node by node, is the better first guess where a body deforms steadily. Where it slides
//! past something, its nodes follow each other: what one did last its neighbour does next, and a body bent as it was bent
//! last is strained. Carried on as a whole it is not.

use super::{Dofs, State};
use crate::mesh::Space;
use crate::tensor::{Tensor2, Vec3};
use crate::tool::space::SpacePose;

/// Nodes that hang together by cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Whole {
    /// The nodes, and where they are in the undeformed mesh.
    nodes: Vec<(usize, Vec3)>,
    space: Space,
}

impl Whole {
    /// The wholes of cells, each given by its nodes.
    pub fn all<'a>(cells: impl Iterator<Item = &'a [usize]>, points: &[Vec3], space: Space) -> Vec<Self> {
        let mut leader: Vec<Option<usize>> = vec![None; points.len()];
        for cell in cells {
            let leaders: Vec<usize> = cell.iter().map(|&node| lead(&leader, node)).collect();
            let first = leaders.iter().copied().fold(usize::MAX, usize::min);
            leaders.iter().chain(cell).for_each(|&node| leader[node] = Some(first));
        }
        let mut wholes: Vec<(usize, Self)> = Vec::new();
        for (node, &x) in points.iter().enumerate().filter(|(node, _)| leader[*node].is_some()) {
            let first = lead(&leader, node);
            match wholes.binary_search_by_key(&first, |(first, _)| *first) {
                Ok(place) => wholes[place].1.nodes.push((node, x)),
                Err(place) => wholes.insert(place, (first, Self { nodes: vec![(node, x)], space })),
            }
        }
        wholes.into_iter().map(|(_, whole)| whole).collect()
    }

    /// The nodes.
    pub fn nodes(&self) -> impl Iterator<Item = usize> + '_ {
        self.nodes.iter().map(|(node, _)| *node)
    }

    /// The nodes, and where they are in the undeformed mesh.
    pub fn places(&self) -> &[(usize, Vec3)] {
        &self.nodes
    }

    /// Writes to `u` the accepted state with the motion of the last increment, times `part`, carried on.
    pub fn carry(&self, dofs: &Dofs, state: &State, part: f64, u: &mut [f64]) {
        let (now, arms) = self.placed(dofs, |dof| state.u[dof]);
        let (before, earlier) = self.placed(dofs, |dof| state.u[dof] - state.last_change[dof]);
        let (mut shift, mut turn) = (now - before, rotation(&earlier, &arms));
        if self.space == Space::Axisymmetric {
            (shift, turn) = (Vec3::new(0.0, shift[1], 0.0), Vec3::zero());
        }
        let along = carried(shift, turn, part);
        for (&(node, x), &arm) in self.nodes.iter().zip(&arms) {
            let to = now + along + rotated(arm, turn * part);
            (0..dofs.per_node()).for_each(|axis| u[dofs.node(node) + axis] = to[axis] - x[axis]);
        }
    }

    /// Its rigid motions in the undeformed mesh as motions of all unknowns: translations, then rotations about the mean of
    /// its nodes, of largest entry one.
    pub fn rigid_motions(&self, dofs: &Dofs) -> Vec<Vec<f64>> {
        let (_, arms) = self.placed(dofs, |_| 0.0);
        let axis = |axis: usize| Vec3(std::array::from_fn(|i| if i == axis { 1.0 } else { 0.0 }));
        let (shifts, turns) = match self.space {
            Space::Solid => (vec![0, 1, 2], vec![0, 1, 2]),
            Space::Axisymmetric => (vec![1], vec![]),
            Space::PlaneStrain | Space::PlaneStress => (vec![0, 1], vec![2]),
        };
        let size = arms.iter().map(|arm| arm.norm()).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let shift = shifts.into_iter().map(|a| self.motion(dofs, |_| axis(a)));
        let turn = turns.into_iter().map(|a| self.motion(dofs, |k| axis(a).cross(arms[k]) * size.recip()));
        shift.chain(turn).collect()
    }

    /// The motion of all unknowns that moves node number `k` of this whole by `of(k)`.
    fn motion(&self, dofs: &Dofs, of: impl Fn(usize) -> Vec3) -> Vec<f64> {
        let mut motion = vec![0.0; dofs.count()];
        for (k, (node, _)) in self.nodes.iter().enumerate() {
            (0..dofs.per_node()).for_each(|axis| motion[dofs.node(*node) + axis] = of(k)[axis]);
        }
        motion
    }

    /// The mean of the nodes' positions, and their arms from there.
    fn placed(&self, dofs: &Dofs, u: impl Fn(usize) -> f64) -> (Vec3, Vec<Vec3>) {
        let at = |&(node, mut x): &(usize, Vec3)| {
            (0..dofs.per_node()).for_each(|axis| x[axis] += u(dofs.node(node) + axis));
            x
        };
        let places: Vec<Vec3> = self.nodes.iter().map(at).collect();
        let mean = places.iter().fold(Vec3::zero(), |sum, &x| sum + x) * (places.len() as f64).recip();
        (mean, places.into_iter().map(|x| x - mean).collect())
    }
}

/// The node that leads those which hang together with this one.
fn lead(leader: &[Option<usize>], mut node: usize) -> usize {
    while let Some(next) = leader[node].filter(|next| *next != node) {
        node = next;
    }
    node
}

/// The rotation vector that takes one set of arms to another, by least squares over the arms halfway: exact where one is the
/// other turned, since the chord over the arm halfway is twice the tangent of half the angle.
fn rotation(before: &[Vec3], now: &[Vec3]) -> Vec3 {
    let (mut inertia, mut moment) = (Tensor2::zero(), Vec3::zero());
    for (&a, &b) in before.iter().zip(now) {
        let arm = (a + b) * 0.5;
        inertia = inertia + Tensor2::identity() * arm.dot(arm) - Tensor2::from_fn(|i, j| arm[i] * arm[j]);
        moment += arm.cross(b - a);
    }
    let tangent = inertia.inverse() * moment * 0.5;
    if !tangent.norm().is_finite() {
        return Vec3::zero();
    }
    let size = tangent.norm();
    if size == 0.0 { tangent } else { tangent * (2.0 * size.atan() / size) }
}

/// How far a point goes in `part` of the time in which it went by `shift`, when its motion turns on: the chord of the arc that
/// follows the one which it has gone.
fn carried(shift: Vec3, turn: Vec3, part: f64) -> Vec3 {
    let angle = turn.norm();
    if angle == 0.0 {
        return shift * part;
    }
    let axis = turn * angle.recip();
    let along = axis * axis.dot(shift);
    let chord = (0.5 * part * angle).sin() / (0.5 * angle).sin();
    along * part + rotated(shift - along, turn * (0.5 * (part + 1.0))) * chord
}

/// `v` turned by a rotation vector.
fn rotated(v: Vec3, rotation: Vec3) -> Vec3 {
    SpacePose { rotation, ..SpacePose::default() }.rotate(v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_whole_goes_on_as_a_rigid_body() {
        let points: Vec<Vec3> = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [9.0, 9.0], [5.0, 0.0], [6.0, 0.0], [5.0, 3.0]]
            .map(|[x, y]| Vec3::new(x, y, 0.0))
            .to_vec();
        let wholes = Whole::all([[6, 5, 4].as_slice(), &[2, 1, 0]].into_iter(), &points, Space::PlaneStrain);
        assert_eq!(
            wholes.iter().map(|w| w.nodes.iter().map(|n| n.0).collect()).collect::<Vec<Vec<_>>>(),
            [vec![0, 1, 2], vec![4, 5, 6]]
        );
        let (dofs, turn) = (Dofs::new(2, 7, 0), Vec3::new(0.0, 0.0, 0.7));
        // The first is turned about the origin, the second shifted and stretched.
        let mut state = State { u: vec![0.0; dofs.count()], ..State::default() };
        for (node, &x) in points[..3].iter().enumerate() {
            let moved = rotated(x, turn) - x;
            (0..2).for_each(|axis| state.u[2 * node + axis] = moved[axis]);
        }
        (4..7).for_each(|node| state.u[2 * node] = 0.5);
        state.last_change = state.u.clone();
        state.u[8] -= 0.1;
        state.u[10] += 0.1;
        let mut u = vec![7.0; dofs.count()];
        wholes.iter().for_each(|whole| whole.carry(&dofs, &state, 2.0, &mut u));
        for (node, &x) in points[..3].iter().enumerate() {
            let to = rotated(x, turn * 3.0) - x;
            (0..2).for_each(|axis| assert!((u[2 * node + axis] - to[axis]).abs() < 1e-14));
        }
        assert_eq!(u[6..8], [7.0, 7.0]);
        assert!((u[10] - u[8] - 0.2).abs() < 1e-14, "the stretch stays as it was");
    }
}
