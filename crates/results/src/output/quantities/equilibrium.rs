//! Equilibrium of the whole: what holds the supports and tools, what acts, and what is left over. The sum of all forces
//! on supports, tools and from loads is the sum of the unbalanced forces of the free nodes, up to its sign, where the two
//! sides of every contact bear the same force.

use super::Source;
use crate::output::{Frame, Quantity, Reading, Unit};
use asperity_core::Error;
use asperity_core::mesh::Space;
use std::ops::Range;

/// Part of the forces in play below which those from outside are taken for rounding.
const ROUNDING: f64 = 1e-3;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let (state, dofs) = (source.state, source.parts.dofs);
    let reactions: Vec<f64> = (0..dofs.count()).map(|dof| source.reaction(dof)).collect();
    let unbalanced = unbalanced(source, &reactions);
    let forces: Vec<f64> = reactions.iter().zip(&state.load).map(|(r, load)| r.abs().max(load.abs())).collect();
    let largest = |of: &[f64]| axes(source).map(|axis| sum(source, of, axis).abs()).fold(0.0, f64::max);
    let (left, in_play) = (largest(&unbalanced), largest(&forces).max(state.in_play[0]));
    // Where no force is in play, what rounding leaves is out of no balance.
    let loaded = state.in_play[0] > rounding(source);
    let part = |left: f64| if loaded { left / in_play } else { 0.0 };
    let scale = if loaded { in_play } else { 0.0 };
    frame.certify(Reading::new("leap", "", state.leap));
    // What rolls or slides on what it touches has motions that are hardly stiff, and their sign is that of rounding.
    if let Some(signs) = state.signs.filter(|_| !source.parts.follows && source.parts.contacts.is_empty()) {
        frame.certify(Reading::new("unstable", "", signs.negative as f64));
    }
    frame.certify(Reading::new("equilibrium_error", "", left).over(scale));
    // Springs pull on the ground, which is no support.
    if source.parts.springs.is_empty() {
        // What bodies do to each other may be many times what they are held and loaded by, but rounding goes with it.
        let outer = largest(&forces).max(ROUNDING * scale);
        let apart = if loaded { largest(&state.internal) } else { 0.0 };
        frame.certify(Reading::new("reaction_balance", "", apart).over(outer));
    }
    if source.parts.follows {
        frame.push(Quantity::scalar("load_factor", Unit::One, state.factor))?;
    }
    frame.push(Quantity::scalar("equilibrium.leap", Unit::One, state.leap))?;
    frame.push(Quantity::scalar("equilibrium.error", Unit::One, part(left)))
}

/// A force below which nothing is loaded: that of the stiffest body over the model's size, at a strain of some hundred roundings.
fn rounding(source: &Source) -> f64 {
    let (size, dimension) = (source.parts.mesh.size(), source.parts.space.dimension() as i32);
    let stiffness = source.parts.bodies.iter().map(|(_, body)| body.material().moduli()[0]).fold(0.0, f64::max);
    100.0 * f64::EPSILON * stiffness * size.powi(dimension - 1)
}

/// The axes along which forces have a sum: radial forces of a full circumference have none.
fn axes(source: &Source) -> Range<usize> {
    if source.parts.space == Space::Axisymmetric { 1..2 } else { 0..source.parts.dofs.per_node() }
}

/// Sum of forces along an axis over all nodes and tools.
fn sum(source: &Source, forces: &[f64], axis: usize) -> f64 {
    let dofs = source.parts.dofs;
    let nodes = (0..dofs.nodes()).map(|node| dofs.node(node) + axis);
    nodes.chain((0..dofs.tools()).map(|tool| dofs.tool(tool) + axis)).map(|dof| forces[dof]).sum()
}

/// What is left over on the free unknowns, on those that follow others included; zero elsewhere.
fn unbalanced(source: &Source, reactions: &[f64]) -> Vec<f64> {
    let mut full = vec![0.0; reactions.len()];
    if let Some(constraints) = source.parts.constraints.get(source.step) {
        let mut reduced = vec![0.0; constraints.free_count()];
        constraints.gather(reactions, &mut reduced);
        let free = constraints.free().iter().zip(reduced);
        free.filter(|(dof, _)| !source.state.stopped.contains(dof)).for_each(|(&dof, force)| full[dof] = force);
    }
    full
}
