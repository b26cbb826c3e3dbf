//! Nodes that follow a reference node as a rigid body, by any rotation.
//!
//! A node at the arm `A` from its reference point has the displacement `t + (R(w) - I) A`, of a group of bodies in small strain `t + w x A`:
//! those would feel the arc as a stretch. Its unknowns are not among those that
//! are solved for: every term is asked with this in the place of them, and its forces `f` and tangent `K` become those of the
//! reference node, `C^t f` and `C^t K C + d(C^t)/dq f` with `C = du/dq`. The first is the sum of the forces and their moment
//! about the reference point, and the second of its tangents is what they turn with. Nothing is penalised, and the rest of the
//! system sees a term like any other.

mod led;
mod map;

use super::{Dofs, Term};
use crate::tensor::{Dual, Vec3};
use crate::tool::Pose;
use led::Led;
use map::{Map, Source};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Rigid groups of nodes, each led by the unknowns of one tool.
#[derive(Debug, Default)]
pub struct Following {
    per_node: usize,
    /// First unknown of a node, with that of its leader and its arm.
    nodes: BTreeMap<usize, Arm>,
}

/// What a node is held by.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Arm {
    /// First unknown of the leader.
    leader: usize,
    /// From the reference point to the node, before any motion.
    arm: Vec3,
    /// Whether it turns by small rotations.
    small: bool,
}

/// Nodes that follow as one body.
#[derive(Debug, Clone, PartialEq)]
pub struct FollowingGroup {
    /// Number of the tool whose unknowns lead it.
    pub tool: usize,
    /// The nodes with their arms.
    pub nodes: Vec<(usize, Vec3)>,
    /// Whether it turns by small rotations.
    pub small: bool,
}

impl Following {
    /// The followers of these groups.
    pub fn new(dofs: &Dofs, groups: &[FollowingGroup]) -> Self {
        let arms = groups.iter().flat_map(|&FollowingGroup { tool, ref nodes, small }| {
            let leader = dofs.tool(tool);
            nodes.iter().map(move |&(node, arm)| (dofs.node(node), Arm { leader, arm, small }))
        });
        Self { per_node: dofs.per_node(), nodes: arms.collect() }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// Writes the displacements of all nodes that follow.
    pub fn place(&self, u: &mut [f64]) {
        for (&first, arm) in &self.nodes {
            let moved = self.moved(arm, &u[arm.leader..arm.leader + self.unknowns()]);
            (0..self.per_node).for_each(|axis| u[first + axis] = moved[axis]);
        }
    }

    /// A term that is asked so.
    pub fn wrap(following: &Arc<Self>, term: Arc<dyn Term>) -> Arc<dyn Term> {
        Arc::new(Led::new(following.clone(), term))
    }

    /// Unknowns of a leader.
    fn unknowns(&self) -> usize {
        if self.per_node == 2 { 3 } else { 6 }
    }

    /// The components of the rotation vector that are unknowns.
    fn turns(&self) -> std::ops::Range<usize> {
        if self.per_node == 2 { 2..3 } else { 0..3 }
    }

    /// The rotation vector of a leader's unknowns.
    fn rotation(&self, q: &[f64]) -> Vec3 {
        if self.per_node == 2 { Vec3::new(0.0, 0.0, q[2]) } else { Vec3([q[3], q[4], q[5]]) }
    }

    fn moved(&self, &Arm { arm, small, .. }: &Arm, q: &[f64]) -> Vec3 {
        let rotation = self.rotation(q);
        let shift = Vec3(std::array::from_fn(|axis| if axis < self.per_node { q[axis] } else { 0.0 }));
        shift + if small { rotation.cross(arm) } else { Pose::turned(rotation).rotate(arm) - arm }
    }

    /// The arm turned, and the moment of a force there on the unknowns of the rotation, with derivatives along these.
    fn turned(&self, &Arm { arm, small, .. }: &Arm, q: &[f64], force: Vec3) -> [Vec3<Dual<3>>; 2] {
        let w = self.rotation(q);
        let w = Vec3(std::array::from_fn(|i| Dual::variable(w[i], i)));
        if small {
            return [arm.lift() + w.cross(arm.lift()), arm.cross(force).lift()];
        }
        let pose = Pose::turned(w);
        let turned = pose.rotate(arm);
        [turned, pose.conjugate(turned.cross(force.lift()))]
    }

    /// The node of an unknown and which of its axes that is, if it follows.
    fn find(&self, dof: usize) -> Option<(Arm, usize)> {
        let (&first, arm) = self.nodes.range(..=dof).next_back()?;
        (dof < first + self.per_node).then_some((*arm, dof - first))
    }

    /// What the unknowns of a stencil become: the unknowns in their place, and how these lead them.
    fn map(&self, dofs: &[usize]) -> (Vec<usize>, Map) {
        let (mut outer, mut map) = (Vec::with_capacity(dofs.len()), Map::default());
        let found: Vec<_> = dofs.iter().map(|&dof| self.find(dof)).collect();
        outer.extend(dofs.iter().zip(&found).filter(|(_, found)| found.is_none()).map(|(&dof, _)| dof));
        let (mut own, mut leaders) = (0, Vec::new());
        for found in found {
            let Some((arm, axis)) = found else {
                map.sources.push(Source::Own(own));
                own += 1;
                continue;
            };
            let slot = match leaders.iter().find(|(leader, _)| *leader == arm.leader) {
                Some((_, slot)) => *slot,
                None => {
                    leaders.push((arm.leader, outer.len()));
                    outer.extend(arm.leader..arm.leader + self.unknowns());
                    outer.len() - self.unknowns()
                }
            };
            let node = map.nodes.iter().position(|node| *node == (slot, arm)).unwrap_or_else(|| {
                map.nodes.push((slot, arm));
                map.nodes.len() - 1
            });
            map.sources.push(Source::Led(node, axis));
        }
        (outer, map)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Failure;
    use crate::system::{Attempt, Branch, History, Instant, Local, State, Stencil, Stencils, check_tangent};

    /// Springs of different stiffness, and a force that grows with the square, on four unknowns.
    struct Bed {
        nodes: Vec<usize>,
    }

    struct Open<'a>(&'a Bed);

    impl Term for Bed {
        fn name(&self) -> &str {
            "bed"
        }
        fn initial(&self) -> History {
            History::new([0])
        }
        fn attempt<'a>(&'a self, _: &'a State, _: &'a History, _: Instant) -> Result<Box<dyn Attempt + 'a>, Failure> {
            Ok(Box::new(Open(self)))
        }
        fn name_of(&self, _: usize) -> String {
            String::new()
        }
    }

    impl Attempt for Open<'_> {
        fn scratch(&self, _: usize) -> Vec<f64> {
            Vec::new()
        }
        fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
            out.push(self.0.nodes.iter().copied(), 0);
            Ok(())
        }
        fn evaluate(&self, _: usize, _: &Stencil, _: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
            let n = local.u.len();
            for i in 0..n {
                for j in 0..n {
                    let k = if i == j { 3.0 + i as f64 } else { 0.3 };
                    local.force[i] += k * local.u[j];
                    if local.wants_tangent {
                        local.tangent[i * n + j] += k;
                    }
                }
                local.force[i] += 0.5 * local.u[i] * local.u[i];
                if local.wants_tangent {
                    local.tangent[i * n + i] += local.u[i];
                }
            }
            Ok(0)
        }
    }

    fn check(dofs: &Dofs, arms: [Vec3; 2], unknowns: &[usize], small: bool) {
        let nodes = arms.iter().enumerate().map(|(node, &arm)| (node, arm)).collect();
        let following = Arc::new(Following::new(dofs, &[FollowingGroup { tool: 0, nodes, small }]));
        let term = Following::wrap(&following, Arc::new(Bed { nodes: unknowns.to_vec() }));
        let (state, history) = (State::default(), term.initial());
        let attempt = term.attempt(&state, &history, Instant::default()).unwrap();
        let u: Vec<f64> = (0..dofs.count()).map(|k| 0.9 - 0.31 * k as f64).collect();
        let mut stencils = Stencils::default();
        attempt.stencils(&u, &mut stencils).unwrap();
        let here: Vec<f64> = stencils.dofs.iter().map(|&dof| u[dof]).collect();
        assert_eq!(stencils.dofs.len(), dofs.per_node() + dofs.per_tool());
        let scale = vec![1.0; here.len()];
        let check = check_tangent(attempt.as_ref(), 0, &stencils.list[0], &here, &scale).unwrap();
        assert!(check.error < 1e-8, "{}", check.error);
    }

    #[test]
    fn tangents_are_exact_at_any_rotation() {
        let plane = Dofs::new(2, 3, 1);
        let space = Dofs::new(3, 3, 1);
        for small in [false, true] {
            check(&plane, [Vec3::new(1.0, 0.5, 0.0), Vec3::new(-0.3, 2.0, 0.0)], &[2, 0, 1, 4, 3, 5], small);
            check(&space, [Vec3::new(1.0, 0.5, -0.7), Vec3::new(-0.3, 2.0, 0.4)], &[0, 1, 2, 3, 4, 5, 6, 7, 8], small);
        }
    }

    #[test]
    fn a_quarter_turn_moves_nodes_with_it() {
        let following = Following::new(
            &Dofs::new(2, 2, 1),
            &[FollowingGroup { tool: 0, nodes: vec![(1, Vec3::new(2.0, 0.0, 0.0))], small: false }],
        );
        let mut u = vec![0.0, 0.0, 7.0, 7.0, 0.5, 0.0, std::f64::consts::FRAC_PI_2];
        following.place(&mut u);
        assert!((u[2] + 1.5).abs() < 1e-15 && (u[3] - 2.0).abs() < 1e-15, "{u:?}");
        assert_eq!(u[..2], [0.0, 0.0]);
    }
}
