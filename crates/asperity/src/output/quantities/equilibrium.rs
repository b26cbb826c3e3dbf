//! Equilibrium of the whole: what holds the supports and tools, what acts, and what is left over. The sum of all forces
//! on supports, tools and from loads is the sum of the unbalanced forces of the free nodes, up to its sign.

use super::Source;
use crate::Error;
use crate::mesh::Space;
use crate::output::{Frame, Quantity, Unit};

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let dofs = source.parts.dofs;
    let held = source.parts.held.get(source.step).map_or(&[][..], Vec::as_slice);
    let mut free = vec![true; dofs.count()];
    held.iter().for_each(|&dof| free[dof] = false);
    // Radial forces of a full circumference have no sum.
    let axes = if source.parts.space == Space::Axisymmetric { 1..2 } else { 0..dofs.per_node() };
    let along = |axis: usize| {
        let nodes = (0..dofs.nodes()).map(move |node| dofs.node(node) + axis);
        nodes.chain((0..dofs.tools()).map(move |tool| dofs.tool(tool) + axis))
    };
    let (mut left, mut largest) = (0.0f64, 0.0f64);
    for axis in axes {
        let unbalanced: f64 = along(axis).filter(|&dof| free[dof]).map(|dof| source.reaction(dof)).sum();
        left = left.max(unbalanced.abs());
        let forces = |dof: usize| source.reaction(dof).abs().max(source.state.load[dof].abs());
        largest = largest.max(along(axis).map(forces).sum());
    }
    let error = if largest > 0.0 { left / largest } else { 0.0 };
    frame.push(Quantity::scalar("equilibrium.error", Unit::One, error))
}
