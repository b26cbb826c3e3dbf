//! Periodic pairs of sides.

use crate::form::{Form, refers, table};
use crate::reader::Name;
use crate::schema::Names;

table! {
    /// Two opposite sides of a periodic cell, with nodes in the same places: the difference of the displacements of opposite nodes is
    /// the same for all, that of one pair which steps may lead.
    pub struct Periodic {
        /// One side.
        surface: Name = refers(Names::Group).required(),
        /// The other.
        target: Name = refers(Names::Group).required(),
        /// A node of the first side, as a group: it and the node opposite are the pair that all others follow.
        lead: Name = refers(Names::Group).required(),
    }
}
