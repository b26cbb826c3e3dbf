//! What acts on a model from outside: pressures, tractions, nodal forces, body forces, and springs to the ground.
//!
//! Each is a term of equilibrium whose values follow a [`Timeline`]. Loads whose forces do
//! not depend on the displacements (all but the follower pressure) are one term, [`DeadLoad`], built from the integral
//! `integral of N_L dA` or `dV` over the undeformed mesh; [`FollowerPressure`] acts along the present normal over the
//! present area, with its exact tangent. Forces are those of the full circumference when axisymmetric, and include the
//! nominal thickness in the plane cases. This room knows neither bodies nor contact.

mod body_force;
mod dead;
mod distributed;
mod face;
mod follower;
mod force;
mod penetrating;
mod pressure;
mod spring;
#[cfg(test)]
mod tests;
mod torque;
mod traction;

pub use body_force::body_force;
pub use dead::DeadLoad;
pub use distributed::DistributedLoad;
pub use face::areas;
pub use follower::FollowerPressure;
pub use force::{force_on_nodes, force_on_tool};
pub use penetrating::{Bearing, PenetratingPressure};
pub use pressure::dead_pressure;
pub use spring::Springs;
pub use torque::TorqueOnTool;
pub use traction::traction;

use crate::amplitude::Timeline;
use crate::mesh::{Mesh, Space};
use crate::system::{Dofs, Instant, State};
use crate::tensor::{Scalar, Vec3};
use std::sync::Arc;

/// The value of a load at an instant.
fn now(value: &Timeline, accepted: &State, at: Instant) -> f64 {
    value.on_path(&accepted.load_factors, at.step, (at.step_time, at.factor))
}

/// What a load acts in.
#[derive(Debug, Clone)]
pub struct Site {
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// Numbering of the unknowns.
    pub dofs: Dofs,
    /// What the coordinates mean.
    pub space: Space,
    /// Nominal thickness in the plane cases, a length; not used otherwise.
    pub thickness: f64,
}

impl Site {
    /// What an area in the plane is multiplied by at `x`: the thickness, the circumference, or one.
    fn depth<T: Scalar>(&self, x: Vec3<T>) -> T {
        match self.space {
            Space::PlaneStrain | Space::PlaneStress => T::from(self.thickness),
            Space::Axisymmetric => x[0] * std::f64::consts::TAU,
            Space::Solid => T::one(),
        }
    }
    /// Unknowns of nodes, node by node.
    fn unknowns(&self, nodes: impl IntoIterator<Item = usize>) -> Vec<usize> {
        nodes.into_iter().flat_map(|node| self.dofs.node(node)..self.dofs.node(node) + self.dofs.per_node()).collect()
    }
}
