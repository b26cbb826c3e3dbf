//! A force and a moment at a reference point that nodes carry by weights, without being held to each other (a distributing
//! coupling).
//!
//! With weights `w_i` of sum one, `xm = sum w_i x_i` and `r_i = x_i - xm` in the present positions, the nodes carry
//! `f_i = w_i (F + q x r_i)`. Their sum is `F`, and their moment is that of the point where
//! `(sum w_i (r_i . r_i I - r_i r_i^t)) q = M + (xr - xm) x F`: the forces of least `sum f_i . f_i / w_i`. The reference point goes
//! with the nodes in the mean, `xr = xm + R (Xr - Xm)`, with the rotation `R` that brings the undeformed arms nearest to the present
//! ones by least squares, the orthogonal factor of `K = sum w_i r_i R_i^t`. Force and moment keep their directions. In the plane all
//! is about one axis. The tangent is exact: `q` depends on the motion through `K` and `S = sum w_i r_i r_i^t` only.

use super::{Site, now};
use crate::amplitude::Timeline;
use crate::system::{Attempt, Branch, History, Instant, Local, Role, State, Stencil, Stencils, Term};
use crate::tensor::{Dual, Scalar, Tensor2, Vec3};
use crate::{Error, Failure};
use std::array::from_fn;

/// `K` by rows, then `S`: xx, yy, zz, xy, xz, yz.
type Sums<T> = [T; 15];
type D = Dual<15>;
/// The pairs of axes of the last six.
const PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
/// Iterations for an orthogonal factor, which converge quadratically.
const ROUNDS: usize = 60;
/// Extent across a line, as a part of that along it, below which nodes lie on it.
const LINE: f64 = 1e-6;

/// The load.
#[derive(Debug)]
pub struct DistributedLoad {
    name: String,
    site: Site,
    nodes: Vec<usize>,
    /// Weights, of sum one.
    weights: Vec<f64>,
    /// Undeformed arms of the nodes and of the reference point from the weighted mean of the nodes.
    arms: Vec<Vec3>,
    offset: Vec3,
    /// Force along the axes, then moment about them; in the plane about the one across it.
    components: Vec<Timeline>,
}

impl DistributedLoad {
    /// A load on nodes with weights.
    ///
    /// # Errors
    /// An input error where the weights have no positive sum, or the nodes lie so that they can bear no moment.
    pub fn new(
        name: &str,
        site: Site,
        carriers: &[(usize, f64)],
        reference: Vec3,
        components: Vec<Timeline>,
    ) -> Result<Self, Error> {
        let sum: f64 = carriers.iter().map(|(_, weight)| weight).sum();
        if sum.is_nan() || sum <= 0.0 {
            return Err(Error::input(format!("'{name}': the weights of the nodes have no positive sum")));
        }
        let weights: Vec<f64> = carriers.iter().map(|(_, weight)| weight / sum).collect();
        let nodes: Vec<usize> = carriers.iter().map(|(node, _)| *node).collect();
        let point = |i: usize| site.mesh.points[nodes[i]];
        let mean = (0..nodes.len()).fold(Vec3::zero(), |mean, i| mean + point(i) * weights[i]);
        let arms: Vec<Vec3> = (0..nodes.len()).map(|i| point(i) - mean).collect();
        let load = Self { name: name.into(), offset: reference - mean, site, nodes, weights, arms, components };
        if !load.spans() {
            let (need, where_) = match load.plane() {
                true => ("two nodes apart from each other", "at one place"),
                false => ("three nodes that lie on no line", "on one line"),
            };
            return Err(Error::input(format!("'{name}': the nodes lie {where_}, and a moment needs {need}")));
        }
        Ok(load)
    }

    fn plane(&self) -> bool {
        self.site.space.dimension() == 2
    }

    /// Whether the nodes lie apart enough to bear any moment.
    fn spans(&self) -> bool {
        let longest =
            self.arms.iter().fold(Vec3::zero(), |most, arm| if arm.norm() > most.norm() { *arm } else { most });
        let across = self.arms.iter().map(|arm| arm.cross(longest).norm()).fold(0.0, f64::max);
        longest.norm() > 0.0 && (self.plane() || across > LINE * longest.dot(longest))
    }

    /// Arms of the nodes in the present configuration.
    fn present(&self, u: &[f64]) -> Vec<Vec3> {
        let moved = u.chunks_exact(self.site.space.dimension());
        let moved: Vec<Vec3> = moved.map(|u| Vec3(from_fn(|i| u.get(i).copied().unwrap_or(0.0)))).collect();
        let mean = moved.iter().zip(&self.weights).fold(Vec3::zero(), |mean, (u, &w)| mean + *u * w);
        self.arms.iter().zip(moved).map(|(arm, u)| *arm + u - mean).collect()
    }

    fn sums(&self, arms: &[Vec3]) -> Sums<f64> {
        let mut sums = [0.0; 15];
        for ((now, before), w) in arms.iter().zip(&self.arms).zip(&self.weights) {
            for k in 0..9 {
                sums[k] += w * now[k / 3] * before[k % 3];
            }
            for (k, (a, b)) in PAIRS.into_iter().enumerate() {
                sums[9 + k] += w * now[a] * now[b];
            }
        }
        sums
    }

    /// The vector `q` for a force and a moment at the reference point.
    fn turn<T: Scalar>(&self, sums: Sums<T>, force: Vec3, moment: Vec3) -> Vec3<T> {
        let offset: Vec3<T> = self.offset.lift();
        if self.plane() {
            let (along, across) = (sums[0] + sums[4], sums[3] - sums[1]);
            let size = (along * along + across * across).sqrt();
            let (c, s) = (along / size, across / size);
            let arm = Vec3([c * offset[0] - s * offset[1], s * offset[0] + c * offset[1], T::zero()]);
            let about = arm.cross(force.lift())[2] + moment[2];
            return Vec3([T::zero(), T::zero(), about / (sums[9] + sums[10])]);
        }
        let rotation = orthogonal(Tensor2::from_fn(|i, j| sums[3 * i + j]));
        let about: Vec3<T> = (rotation * offset).cross(force.lift()) + moment.lift();
        let [xx, yy, zz, xy, xz, yz] = from_fn(|k| sums[9 + k]);
        Tensor2([[yy + zz, -xy, -xz], [-xy, xx + zz, -yz], [-xz, -yz, xx + yy]]).inverse() * about
    }
}

/// The rotation that is the orthogonal factor of a matrix of rank two or three, by Newton's iteration
/// `X <- (X + X^-t) / 2` (Higham, SIAM J. Sci. Stat. Comput. 7, 1986). Its cofactors, which have the same factor, give a matrix of
/// rank two the third direction.
fn orthogonal<T: Scalar>(k: Tensor2<T>) -> Tensor2<T> {
    let unit = k * k.contract(k).sqrt().recip();
    let better = |x: Tensor2<T>| (x + x.inverse().transpose()) * T::from(0.5);
    let mut x = unit + unit.cofactors();
    for _ in 0..ROUNDS {
        let next = better(x);
        let change = (next.re() - x.re()).0.as_flattened().iter().fold(0.0, |most: f64, d| most.max(d.abs()));
        x = next;
        // Derivatives lag behind values by one round.
        if change < 1e-9 {
            return better(x);
        }
    }
    x
}

impl Term for DistributedLoad {
    fn name(&self) -> &str {
        &self.name
    }
    fn role(&self) -> Role {
        Role::Load
    }
    fn initial(&self) -> History {
        History::new([0])
    }
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        _: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let value = |i: usize| self.components.get(i).map_or(0.0, |value| now(value, accepted, at));
        let (force, moment) = match self.plane() {
            true => (Vec3([value(0), value(1), 0.0]), Vec3([0.0, 0.0, value(2)])),
            false => (Vec3(from_fn(value)), Vec3(from_fn(|i| value(3 + i)))),
        };
        Ok(Box::new(Open { load: self, force, moment }))
    }
    fn name_of(&self, _: usize) -> String {
        format!("the nodes under '{}'", self.name)
    }
}

/// The load at one instant.
struct Open<'a> {
    load: &'a DistributedLoad,
    force: Vec3,
    moment: Vec3,
}

impl Attempt for Open<'_> {
    fn scratch(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        out.push(self.load.site.unknowns(self.load.nodes.iter().copied()), 0);
        Ok(())
    }
    fn evaluate(&self, _: usize, _: &Stencil, _: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let (load, dim) = (self.load, self.load.site.space.dimension());
        let arms = load.present(&local.u);
        let sums = load.sums(&arms);
        let varied: Sums<D> = from_fn(|k| D::variable(sums[k], k));
        let turn = match local.wants_tangent {
            true => load.turn(varied, self.force, self.moment),
            false => load.turn(sums, self.force, self.moment).lift(),
        };
        let q = turn.re();
        if !q.is_finite() {
            return Err(Failure::new(format!("the nodes under '{}' have come to lie on one line", load.name)));
        }
        for (i, arm) in arms.iter().enumerate() {
            let force = (self.force + q.cross(*arm)) * load.weights[i];
            (0..dim).for_each(|axis| local.force[dim * i + axis] += force[axis]);
        }
        if local.wants_tangent {
            let unknowns = dim * arms.len();
            for (j, w) in load.weights.iter().enumerate() {
                for c in 0..dim {
                    let dq = Vec3(from_fn(|i| load.slope(&turn[i].du, (j, c), (&arms, *w))));
                    for (i, arm) in arms.iter().enumerate() {
                        let moved = Vec3::axis(c) * (f64::from(u8::from(i == j)) - w);
                        let df = (dq.cross(*arm) + q.cross(moved)) * load.weights[i];
                        (0..dim).for_each(|axis| local.tangent[(dim * i + axis) * unknowns + dim * j + c] += df[axis]);
                    }
                }
            }
        }
        Ok(0)
    }
}

impl DistributedLoad {
    /// Derivative along one unknown of what has the slopes `du` over the sums.
    fn slope(&self, du: &[f64; 15], (j, c): (usize, usize), (arms, w): (&[Vec3], f64)) -> f64 {
        let of_k: f64 = (0..3).map(|b| du[3 * c + b] * self.arms[j][b]).sum();
        let of_s = PAIRS.iter().enumerate().map(|(k, &(a, b))| {
            let along = |one: usize, other: usize| if one == c { arms[j][other] } else { 0.0 };
            du[9 + k] * (along(a, b) + along(b, a))
        });
        w * (of_k + of_s.sum::<f64>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::amplitude::{Amplitude, Change};
    use crate::mesh::generate::Spacing;
    use crate::mesh::{Mesh, Space, generate};
    use crate::system::{Dofs, check_tangent};
    use std::sync::Arc;

    fn site(space: Space) -> Site {
        let along = |to: f64, cells: usize| Spacing::graded(0.0, to, cells, 1.0);
        let kind = |name: &str| crate::mesh::cells::ALL.iter().find(|cell| cell.name == name).copied().unwrap();
        let mesh: Mesh = match space {
            Space::Solid => {
                generate::Block { x: along(2.0, 2), y: along(1.0, 1), z: along(1.0, 1), cell: kind("hex8") }.mesh("b")
            }
            _ => generate::Rectangle { x: along(2.0, 2), y: along(1.0, 1), cell: kind("quad4") }.mesh("b"),
        }
        .unwrap();
        let dofs = Dofs::new(space.dimension(), mesh.points.len(), 0);
        Site { mesh: Arc::new(mesh), dofs, space, thickness: 1.0 }
    }

    fn constants(values: &[f64]) -> Vec<Timeline> {
        values.iter().map(|&value| Timeline::new([(1.0, Change::To(value, Amplitude::at_once()))])).collect()
    }

    /// Turned far and stretched: the forces are the force and the moment at the reference point that goes with the nodes,
    /// and the tangent is that of differences. A group in a plane and one in space.
    fn check(space: Space, nodes: &[usize], turn: impl Fn(Vec3) -> Vec3) {
        let site = site(space);
        let (dim, points) = (space.dimension(), site.mesh.points.clone());
        let weights: Vec<(usize, f64)> =
            nodes.iter().enumerate().map(|(i, &node)| (node, 1.0 + 0.3 * i as f64)).collect();
        let values: Vec<f64> = if dim == 2 { vec![3.0, -2.0, 1.5] } else { vec![3.0, -2.0, 1.0, 0.5, -1.5, 2.5] };
        let reference = Vec3([2.5, 0.7, if dim == 2 { 0.0 } else { -0.4 }]);
        let load = DistributedLoad::new("d", site, &weights, reference, constants(&values)).unwrap();
        let (state, history) = (State::default(), load.initial());
        let at = Instant { step_time: 1.0, time: 1.0, dt: 1.0, ..Instant::default() };
        let attempt = load.attempt(&state, &history, at).unwrap();
        let motion = |node: usize| turn(points[node]) - points[node];
        let u: Vec<f64> =
            nodes.iter().flat_map(|&node| (0..dim).map(move |a| (node, a))).map(|(n, a)| motion(n)[a]).collect();
        let mut local = Local { u: u.clone(), ..Local::default() };
        local.reset(u.len());
        attempt.evaluate(0, &Stencil::default(), &mut [], &mut local).unwrap();
        let force = local.force;
        let each = |i: usize| Vec3(from_fn(|a| if a < dim { force[dim * i + a] } else { 0.0 }));
        let (mut sum, mut moment) = (Vec3::zero(), Vec3::zero());
        for (i, &node) in nodes.iter().enumerate() {
            sum += each(i);
            moment += (turn(points[node]) - turn(reference)).cross(each(i));
        }
        let (f, m) = match dim {
            2 => (Vec3([3.0, -2.0, 0.0]), Vec3([0.0, 0.0, 1.5])),
            _ => (Vec3([3.0, -2.0, 1.0]), Vec3([0.5, -1.5, 2.5])),
        };
        assert!((sum - f).norm() < 1e-12 && (moment - m).norm() < 1e-11, "{sum:?} {moment:?}");
        let mut stencils = Stencils::default();
        attempt.stencils(&vec![0.0; dim * points.len()], &mut stencils).unwrap();
        let checked = check_tangent(attempt.as_ref(), 0, &stencils.list[0], &u, &vec![1.0; u.len()]).unwrap();
        assert!(checked.error < 1e-9, "{}", checked.error);
    }

    #[test]
    fn forces_and_moments_are_exact_at_any_rotation() {
        let (c, s) = (2.2_f64.cos(), 2.2_f64.sin());
        let about_z = |x: Vec3| Vec3([c * x[0] - s * x[1] + 1.0, s * x[0] + c * x[1] - 3.0, x[2]]);
        let tilted = |x: Vec3| {
            let y = about_z(x);
            Vec3([y[0], c * y[1] - s * y[2], s * y[1] + c * y[2]])
        };
        check(Space::PlaneStrain, &[2, 5], about_z);
        check(Space::PlaneStrain, &[0, 1, 2, 4], about_z);
        check(Space::Solid, &[2, 5, 8, 11], tilted);
        check(Space::Solid, &[0, 1, 2, 5, 8, 10], tilted);
    }

    #[test]
    fn nodes_on_a_line_bear_no_moment_in_space() {
        let told = DistributedLoad::new("d", site(Space::Solid), &[(0, 1.0), (1, 1.0), (2, 1.0)], Vec3::zero(), vec![]);
        assert!(told.unwrap_err().to_string().contains("on one line"));
    }
}
