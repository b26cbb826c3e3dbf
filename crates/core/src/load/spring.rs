//! Springs from nodes to the ground: `F_i = k_i u_i`, unstressed in the undeformed place.

use crate::Failure;
use crate::amplitude::Timeline;
use crate::system::{Attempt, Branch, Dofs, History, Instant, Local, State, Stencil, Stencils, Term};

/// A spring along each axis at each of some nodes.
#[derive(Debug)]
pub struct Springs {
    name: String,
    dofs: Dofs,
    nodes: Vec<usize>,
    stiffness: Vec<Timeline>,
}

impl Springs {
    /// Springs with the given stiffness along each axis (force per length) at each node; axes that are not given
    /// have none. A stiffness that changes stretches no spring anew: the force is always that of the whole displacement.
    pub fn new(name: &str, dofs: Dofs, nodes: Vec<usize>, stiffness: Vec<Timeline>) -> Self {
        Self { name: name.into(), dofs, nodes, stiffness }
    }
}

impl Term for Springs {
    fn name(&self) -> &str {
        &self.name
    }
    /// At each node the stiffness that the springs have.
    fn initial(&self) -> History {
        History::new(self.nodes.iter().map(|_| self.stiffness.len()))
    }
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let stiffness = self.stiffness.iter().map(|k| k.value(at.step, at.step_time)).collect();
        Ok(Box::new(OpenSprings { springs: self, stiffness, accepted, history }))
    }
    fn name_of(&self, stencil: usize) -> String {
        format!("node {} on springs '{}'", self.nodes[stencil], self.name)
    }
}

/// Springs at one instant.
struct OpenSprings<'a> {
    springs: &'a Springs,
    stiffness: Vec<f64>,
    accepted: &'a State,
    history: &'a History,
}

impl Attempt for OpenSprings<'_> {
    fn scratch(&self, _: usize) -> Vec<f64> {
        vec![0.0; self.stiffness.len()]
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        let dofs = &self.springs.dofs;
        self.springs.nodes.iter().for_each(|&node| out.push(dofs.node(node)..dofs.node(node) + dofs.per_node(), 0));
        Ok(())
    }
    fn evaluate(&self, index: usize, _: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let n = local.u.len();
        let before = &self.accepted.u[self.springs.dofs.displacements(self.springs.nodes[index])];
        for ((&k, &had), (u, before)) in
            self.stiffness.iter().zip(self.history.slot(index)).zip(local.u.iter().zip(before))
        {
            // Who makes a stretched spring stiffer or softer does work on it, which that of its forces at both ends of the increment has not.
            local.energies.supplied += 0.5 * (k - had) * before * u;
        }
        new.copy_from_slice(&self.stiffness);
        for (i, (&k, &u)) in self.stiffness.iter().zip(&local.u).enumerate() {
            local.force[i] = k * u;
            local.energies.stored += 0.5 * k * u * u;
            if local.wants_tangent {
                local.tangent[i * n + i] = k;
            }
        }
        Ok(0)
    }
}
