//! Rigid groups of nodes.

use crate::form::{Form, list, number, refers, table};
use crate::reader::Name;
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};

table! {
    /// Nodes of bodies that follow a reference point as a rigid body, by any rotation. Steps lead and load the point as they do
    /// a tool's, by `motion` and `load`; what neither says stays where it is.
    pub struct RigidKeys {
        /// The nodes, as a group.
        group: Name = refers(Names::Group).required(),
        /// The point that its motion moves and about which it turns; where its force and torque act.
        reference: Option<Spot<Vec<f64>>> =
            list(number(unit::LENGTH, Range::ANY), 2..=3).spot().computed("the mean of the places of its nodes"),
    }
}
