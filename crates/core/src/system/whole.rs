//! Parts of the mesh that hang together by cells.

use super::Dofs;
use crate::mesh::Space;
use crate::tensor::{Tensor2, Vec3};
use crate::tool::Pose;

/// Nodes that hang together by cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Whole {
    /// The nodes, and where they are in the undeformed mesh.
    nodes: Vec<(usize, Vec3)>,
    space: Space,
}

/// Angle by which an increment must turn a whole for the next to turn on; and the step with which the search for it ends, within so many.
const TURNS: f64 = 0.05;
const SETTLED: f64 = 1e-12;
const TURNING: usize = 30;

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

    /// The sum of the squares of a motion over its nodes, and of what is left of them without its mean, by which the whole goes as one.
    pub fn squares(&self, dofs: &Dofs, motion: &[f64]) -> [f64; 2] {
        let first = if self.space == Space::Axisymmetric { 1 } else { 0 };
        let count = self.nodes.len() as f64;
        let squares = (0..dofs.per_node()).map(|axis| {
            let along = || self.nodes.iter().map(|(node, _)| motion[dofs.node(*node) + axis]);
            let all = along().map(|x| x * x).sum::<f64>();
            let mean = if axis < first { 0.0 } else { along().sum::<f64>() / count };
            [all, all - count * mean * mean]
        });
        squares.fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]])
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

    /// Where a motion `change` that led to `u` leads where a part `ratio` of it is carried on: where it turned the whole by more than a little
    /// that turns on, about the mean of its nodes, with what deformed it, in place of the straight motion in `ahead`, which would stretch it by
    /// half the square of the angle.
    pub fn turn_on(&self, dofs: &Dofs, [u, change]: [&[f64]; 2], ratio: f64, ahead: &mut [f64]) {
        let (mean, now) = self.placed(dofs, |dof| u[dof]);
        let (mean_before, before) = self.placed(dofs, |dof| u[dof] - change[dof]);
        let Some(turn) = self.best_turn(&before, &now).filter(|turn| turn.norm() > TURNS) else { return };
        let [whole, part] = [1.0, ratio].map(|part| Pose::<f64>::turned(turn * part));
        let mean = mean + (mean - mean_before) * ratio;
        for ((&(node, x), now), before) in self.nodes.iter().zip(now).zip(before) {
            let deformed = now - whole.rotate(before);
            let place = mean + part.rotate(now + deformed * ratio) - x;
            (0..dofs.per_node()).for_each(|axis| ahead[dofs.node(node) + axis] = place[axis]);
        }
    }

    /// The rotation that brings arms nearest to others by least squares (Gauss and Newton), as a vector; none that there is not.
    fn best_turn(&self, from: &[Vec3], to: &[Vec3]) -> Option<Vec3> {
        let mut turn = Vec3::zero();
        for _ in 0..TURNING {
            let pose = Pose::<f64>::turned(turn);
            let (mut moment, mut inertia) = (Vec3::zero(), Tensor2::zero());
            for (from, to) in from.iter().zip(to) {
                let arm = pose.rotate(*from);
                moment += arm.cross(*to);
                let square = arm.dot(arm);
                inertia = inertia + Tensor2::from_fn(|i, j| if i == j { square } else { 0.0 } - arm[i] * arm[j]);
            }
            let step = match self.space {
                Space::Axisymmetric => return None,
                Space::Solid => inertia.inverse() * moment,
                Space::PlaneStrain | Space::PlaneStress => Vec3::axis(2) * (moment[2] / inertia[(2, 2)]),
            };
            turn += step;
            if !step.is_finite() {
                return None;
            }
            if step.norm() < SETTLED {
                return Some(turn);
            }
        }
        None
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wholes_hang_together_and_move_rigidly() {
        let points: Vec<Vec3> = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [9.0, 9.0], [5.0, 0.0], [6.0, 0.0], [5.0, 3.0]]
            .map(|[x, y]| Vec3::new(x, y, 0.0))
            .to_vec();
        let wholes = Whole::all([[6, 5, 4].as_slice(), &[2, 1, 0]].into_iter(), &points, Space::PlaneStrain);
        assert_eq!(
            wholes.iter().map(|w| w.nodes.iter().map(|n| n.0).collect()).collect::<Vec<Vec<_>>>(),
            [vec![0, 1, 2], vec![4, 5, 6]]
        );
        let dofs = Dofs::new(2, 7, 0);
        let [along, _, about] = &wholes[0].rigid_motions(&dofs)[..] else { panic!("three in the plane") };
        assert!(along[..6] == [1.0, 0.0, 1.0, 0.0, 1.0, 0.0] && along[6..].iter().all(|x| *x == 0.0));
        let apart = |a: usize, b: usize| [about[2 * b] - about[2 * a], about[2 * b + 1] - about[2 * a + 1]];
        // About one axis: across the way from one node to the other.
        let (first, second) = (apart(0, 1), apart(0, 2));
        assert!(first[0].abs() < 1e-14 && second[1].abs() < 1e-14 && (first[1] + 2.0 * second[0]).abs() < 1e-14);
    }
}
