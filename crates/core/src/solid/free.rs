//! Words for motions of a body that meet no stiffness. What a solver finds are vectors that span them, in any mixture: the
//! rigid motions among them are told from those that deform cells, and translations from rotations.

use crate::mesh::Space;
use crate::system::{Dofs, kernel};
use crate::tensor::{Tensor2, Vec3};

/// A motion of the body below this part of the largest anywhere is that of another, with which this one goes a little.
const ALONG: f64 = 0.05;
/// What is left of a motion beside a rigid one, over its size, where it is rigid.
const RIGID: f64 = 1e-4;
/// A part of a translation that counts.
const PART: f64 = 0.05;

/// Motions of a body that meet no stiffness.
#[derive(Debug, Default)]
pub(super) struct Free {
    /// Independent rigid ones: translation, and rotation times the size of the body; rotations first.
    rigid: Vec<[f64; 6]>,
    /// Whether there are others.
    deforms: bool,
}

impl Free {
    /// Those of the body with these nodes that the given motions of all unknowns span.
    pub fn of(motions: &[Vec<f64>], (dofs, points): (&Dofs, &[Vec3]), nodes: &[usize], space: Space) -> Self {
        let body = Rigid::of(points, nodes, space);
        let parts: Vec<_> = motions.iter().filter_map(|motion| body.part(dofs, nodes, motion)).collect();
        let (rigid, others) = kernel(parts, RIGID);
        Self { rigid: reduced(rigid.iter().map(|r| std::array::from_fn(|i| r[i])).collect()), deforms: others > 0 }
    }

    /// Words for them: "is free along x and y".
    pub fn words(&self, space: Space) -> Vec<String> {
        let turns = self.rigid.iter().filter(|r| turn(r) != [0.0; 3]);
        let shifts = self.rigid.iter().filter(|r| turn(r) == [0.0; 3]);
        let along: Vec<String> = shifts.map(|r| axes(&r[..3], " + ")).collect();
        let along = (!along.is_empty()).then(|| format!("is free along {}", along.join(" and ")));
        let about: Vec<String> = turns.map(|r| axes(&turn(r), " + ")).collect();
        let about = (!about.is_empty()).then(|| match space {
            Space::Solid => format!("is free to turn about {}", about.join(" and ")),
            _ => "is free to turn".into(),
        });
        let deforms = "deforms without resistance, as what flows all through does, and cells with reduced integration may (hourglass)";
        along.into_iter().chain(about).chain(self.deforms.then(|| deforms.into())).collect()
    }
}

fn turn(rigid: &[f64; 6]) -> [f64; 3] {
    [rigid[3], rigid[4], rigid[5]]
}

/// The axes that a direction has parts along.
fn axes(direction: &[f64], between: &str) -> String {
    let largest = direction.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let names = direction.iter().zip(["x", "y", "z"]).filter(|(x, _)| x.abs() > PART * largest).map(|(_, name)| name);
    names.collect::<Vec<_>>().join(between)
}

/// Independent vectors of the same span by Gauss and Jordan's elimination, rotations first: what has no rotation left is a
/// translation.
fn reduced(mut rows: Vec<[f64; 6]>) -> Vec<[f64; 6]> {
    let largest = rows.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
    let mut done = 0;
    for column in [3, 4, 5, 0, 1, 2] {
        let size = |row: &[f64; 6]| row[column].abs();
        let Some(pivot) = (done..rows.len()).max_by(|&a, &b| size(&rows[a]).total_cmp(&size(&rows[b]))) else { break };
        if size(&rows[pivot]) <= RIGID * largest {
            rows[done..].iter_mut().for_each(|row| row[column] = 0.0);
            continue;
        }
        rows.swap(done, pivot);
        let by = rows[done].map(|x| x / rows[done][column]);
        rows[done] = by;
        for row in rows.iter_mut().enumerate().filter(|(i, _)| *i != done).map(|(_, row)| row) {
            let part = row[column];
            row.iter_mut().zip(by).for_each(|(x, by)| *x -= part * by);
        }
        done += 1;
    }
    rows.truncate(done);
    rows
}

/// What a rigid motion of some nodes is measured by.
struct Rigid {
    arms: Vec<Vec3>,
    /// Takes moments to rotations.
    compliance: Tensor2<f64>,
    size: f64,
    space: Space,
}

impl Rigid {
    fn of(points: &[Vec3], nodes: &[usize], space: Space) -> Self {
        let count = nodes.len().max(1) as f64;
        let mean = nodes.iter().fold(Vec3::zero(), |sum, &n| sum + points[n]) * count.recip();
        let arms: Vec<Vec3> = nodes.iter().map(|&n| points[n] - mean).collect();
        let mut inertia = Tensor2::zero();
        for &arm in &arms {
            inertia = inertia + Tensor2::identity() * arm.dot(arm) - Tensor2::from_fn(|i, j| arm[i] * arm[j]);
        }
        let size = (arms.iter().map(|arm| arm.dot(*arm)).sum::<f64>() / count).sqrt();
        Self { arms, compliance: inertia.inverse(), size, space }
    }

    /// What of a motion is left beside the nearest rigid one, and that, both over the largest motion anywhere; none where
    /// the body hardly moves.
    fn part(&self, dofs: &Dofs, nodes: &[usize], motion: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let largest = motion.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let at = |&n: &usize| {
            let axis = |axis: usize| if axis < dofs.per_node() { motion[dofs.node(n) + axis] / largest } else { 0.0 };
            Vec3::new(axis(0), axis(1), axis(2))
        };
        let moved: Vec<Vec3> = nodes.iter().map(at).collect();
        let count = (nodes.len().max(1) as f64).sqrt();
        if moved.iter().map(|v| v.dot(*v)).sum::<f64>().sqrt() < ALONG * count {
            return None;
        }
        let (shift, turn) = self.nearest(&moved);
        let left = moved.iter().zip(&self.arms).flat_map(|(&v, &arm)| (v - shift - turn.cross(arm)).0);
        let rigid = shift.0.into_iter().chain((turn * self.size).0).collect();
        Some((left.map(|x| x / count).collect(), rigid))
    }

    fn nearest(&self, moved: &[Vec3]) -> (Vec3, Vec3) {
        let mut shift = moved.iter().fold(Vec3::zero(), |sum, &v| sum + v) * (moved.len().max(1) as f64).recip();
        let moment = moved.iter().zip(&self.arms).fold(Vec3::zero(), |sum, (&v, arm)| sum + arm.cross(v));
        let turn = self.compliance * moment;
        if self.space == Space::Axisymmetric {
            shift[0] = 0.0;
        }
        // Neither is a line of nodes known to turn about itself, nor a body of revolution to turn at all.
        let turns = turn.is_finite() && self.space != Space::Axisymmetric;
        (shift, if turns { turn } else { Vec3::zero() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> (Dofs, Vec<Vec3>) {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
        (Dofs::new(2, 4, 0), points)
    }

    fn words(motions: &[[f64; 8]]) -> Vec<String> {
        let (dofs, points) = square();
        let motions: Vec<Vec<f64>> = motions.iter().map(|motion| motion.to_vec()).collect();
        Free::of(&motions, (&dofs, &points), &[0, 1, 2, 3], Space::PlaneStrain).words(Space::PlaneStrain)
    }

    const X: [f64; 8] = [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0];
    const Y: [f64; 8] = [0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0];
    /// About the first node.
    const TURN: [f64; 8] = [0.0, 0.0, 0.0, 1.0, -1.0, 0.0, -1.0, 1.0];
    /// Of one cell with a single integration point, along x.
    const HOURGLASS: [f64; 8] = [1.0, 0.0, -1.0, 0.0, -1.0, 0.0, 1.0, 0.0];

    fn mixed(a: [f64; 8], b: [f64; 8], part: f64) -> [f64; 8] {
        std::array::from_fn(|i| a[i] + part * b[i])
    }

    #[test]
    fn each_motion_is_named_for_what_it_is() {
        assert_eq!(words(&[X]), ["is free along x"]);
        assert_eq!(words(&[TURN]), ["is free to turn"]);
        assert_eq!(words(&[mixed(X, Y, 1.0)]), ["is free along x + y"]);
        let [hourglass] = &words(&[HOURGLASS])[..] else { panic!("one motion") };
        assert!(hourglass.contains("deforms without resistance"));
    }

    /// The vectors of a null space come in any mixture.
    #[test]
    fn mixtures_are_taken_apart() {
        assert_eq!(words(&[mixed(X, Y, 0.4), mixed(Y, X, -0.7)]), ["is free along x and y"]);
        let all = words(&[mixed(X, TURN, 0.3), mixed(TURN, HOURGLASS, 0.5), mixed(HOURGLASS, X, 2.0)]);
        assert!(all[0] == "is free along x" && all[1] == "is free to turn" && all[2].contains("hourglass"), "{all:?}");
    }
}
