//! Forces on nodes, and forces and a torque on a tool.

use super::dead::{DeadLoad, On, Part};
use crate::amplitude::Timeline;
use crate::system::Dofs;

/// A force on each of some nodes, given by its components along the axes; of the full circumference when axisymmetric.
pub fn force_on_nodes(name: &str, dofs: &Dofs, nodes: &[usize], components: Vec<Timeline>) -> DeadLoad {
    let part = |&node: &usize| whole(On::Node(node), dofs.node(node), dofs.per_node());
    DeadLoad::new(name, components, nodes.iter().map(part).collect())
}

/// Force and torque on the reference point of a tool, one value for each of its unknowns: forces along the axes, then
/// torques, positive counter-clockwise.
pub fn force_on_tool(name: &str, dofs: &Dofs, tool: usize, values: Vec<Timeline>) -> DeadLoad {
    DeadLoad::new(name, values, vec![whole(On::Tool, dofs.tool(tool), dofs.per_tool())])
}

/// Consecutive unknowns, each of which takes the whole of its own value.
fn whole(on: On, first: usize, count: usize) -> Part {
    Part { on, dofs: (first..first + count).collect(), shares: (0..count).map(|i| (i, 1.0)).collect() }
}
