//! Contacts.

use crate::deck::form::{Form, Law, law, number, refers, table, whole};
use crate::deck::reader::Name;
use crate::deck::schema::Names;
use crate::deck::source::Spot;
use crate::declare::{Range, unit};
use crate::interface::{self, Interface};

table! {
    /// A surface and what it may touch.
    pub struct Contact {
        /// The group of sides that carries the contact points.
        surface: Name = refers(Names::Sides).required(),
        /// The rigid tool that it may touch.
        target: Name = refers(Names::Tool).required(),
        /// The law of the interface. Without friction: law.coulomb = { friction = 0.0 }.
        law: Law<Box<dyn Interface>> = law(interface::laws::ALL).required(),
        /// Integration points along an edge.
        gauss: Option<Spot<usize>> =
            whole(1..=3).spot().computed("the degree of the edge: 1 on edges of first degree, 2 on edges of second degree"),
        /// Pressure for one unit of penetration.
        penalty: Option<f64> = number(unit::PENALTY, Range::POSITIVE)
            .computed("50 times the confined modulus over the depth of the cells behind the surface"),
        /// Friction stress for one unit of elastic slip.
        tangential_penalty: Option<f64> =
            number(unit::PENALTY, Range::POSITIVE).computed("equal to the penalty"),
    }
}
