//! Equilibrium of the whole: what holds the supports and tools, what acts, and what is left over. The sum of all forces
//! on supports, tools and from loads is the sum of the unbalanced forces of the free nodes, up to its sign.

use super::Source;
use crate::Error;
use crate::mesh::Space;
use crate::output::{Frame, Quantity, Unit};

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let dofs = source.parts.dofs;
    let reactions: Vec<f64> = (0..dofs.count()).map(|dof| source.reaction(dof)).collect();
    let unbalanced = unbalanced(source, &reactions);
    // Radial forces of a full circumference have no sum.
    let axes = if source.parts.space == Space::Axisymmetric { 1..2 } else { 0..dofs.per_node() };
    let along = |axis: usize| {
        let nodes = (0..dofs.nodes()).map(move |node| dofs.node(node) + axis);
        nodes.chain((0..dofs.tools()).map(move |tool| dofs.tool(tool) + axis))
    };
    // Where nothing is loaded yet, the yardstick of the iterations stands for the forces.
    let (mut left, mut largest) = (0.0f64, source.state.reference[0]);
    for axis in axes {
        left = left.max(along(axis).map(|dof| unbalanced[dof]).sum::<f64>().abs());
        let forces = |dof: usize| reactions[dof].abs().max(source.state.load[dof].abs());
        largest = largest.max(along(axis).map(forces).sum());
    }
    let error = if largest > 0.0 { left / largest } else { 0.0 };
    frame.push(Quantity::scalar("equilibrium.leap", Unit::One, source.state.leap))?;
    frame.push(Quantity::scalar("equilibrium.error", Unit::One, error))
}

/// What is left over on the free unknowns, on those that follow others included; zero elsewhere.
fn unbalanced(source: &Source, reactions: &[f64]) -> Vec<f64> {
    let mut full = vec![0.0; reactions.len()];
    if let Some(constraints) = source.parts.constraints.get(source.step) {
        let mut reduced = vec![0.0; constraints.free_count()];
        constraints.gather(reactions, &mut reduced);
        constraints.free().iter().zip(reduced).for_each(|(&dof, force)| full[dof] = force);
    }
    full
}
