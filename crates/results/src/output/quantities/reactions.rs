//! Reactions of the groups that something holds or moves, and how far these have moved, and others that are watched.

use super::Source;
use crate::output::{Frame, Quantity, QuantityPlace, Unit, Width};
use asperity_core::Error;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let reactions = source.borne();
    let vector = |name: String, unit, values: [f64; 3]| {
        Quantity::new(name, unit, QuantityPlace::Global, Width::Vector, values.to_vec())
    };
    let sum = |nodes: &[usize], of: &dyn Fn(usize) -> [f64; 3]| {
        nodes.iter().fold([0.0; 3], |sum, &node| std::array::from_fn(|a| sum[a] + of(node)[a]))
    };
    let moved = |(group, nodes): &(String, Vec<usize>)| {
        let mean = sum(nodes, &|node| source.displacement(node)).map(|total| total / nodes.len() as f64);
        vector(format!("displacement.{group}"), Unit::Length, mean)
    };
    for held @ (group, nodes) in &source.parts.supports {
        frame.push(moved(held))?;
        let force = sum(nodes, &|node| source.nodal(&reactions, node));
        frame.push(vector(format!("reaction.{group}"), Unit::Force, force))?;
    }
    source.parts.watched.iter().try_for_each(|group| frame.push(moved(group)))?;
    Ok(())
}
