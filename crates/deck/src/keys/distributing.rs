//! Points whose loads a group carries.

use crate::form::{Form, list, number, refers, table, word, words};
use crate::reader::Name;
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};

table! {
    /// A reference point whose force and moment nodes carry by weights, without being held to each other. Steps load it by
    /// `load`, as a tool; it goes with the nodes in the mean.
    pub struct DistributingKeys {
        /// The nodes, as a group.
        group: Name = refers(Names::Group).required(),
        /// Where force and moment act.
        reference: Option<Spot<Vec<f64>>> =
            list(number(unit::LENGTH, Range::ANY), 2..=3).spot().computed("the weighted mean of the places of its nodes"),
        /// What the weights of the nodes are.
        weights: Weights = word().or("\"equal\""),
    }
}

words! {
    /// Weights of nodes.
    pub enum Weights {
        /// One each.
        Equal = "equal",
        /// The area around each, of a group of sides.
        Area = "area",
    }
}
