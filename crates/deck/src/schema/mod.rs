//! What a deck may say, as data: each key with its kind, unit, range, default and words, declared once in the tables
//! of [`keys`](super::keys). The reader, its checks, the JSON Schema of editors and the manual follow from it.

mod json;
mod manual;

pub use json::{interface_json_schema, json_schema, point_json_schema};
pub use manual::{interface_manual, manual, path_behind, path_of, point_manual};

use super::form::KeyTable;
use super::keys::{Deck, InterfaceDeck, PointDeck};
use asperity_core::declare::Range;

/// A key of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Key {
    /// The key.
    pub name: &'static str,
    /// What it means.
    pub doc: &'static str,
    /// What may stand behind it.
    pub schema: Schema,
    /// What happens when it is not said.
    pub presence: Presence,
}

/// What happens when a key is not said.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Presence {
    /// That is an error.
    Required,
    /// The value is this, written as a deck would.
    Default(String),
    /// What these words say.
    Optional(&'static str),
}

/// What may stand behind a key.
#[derive(Debug, Clone, PartialEq)]
pub enum Schema {
    /// A number.
    Number {
        /// Its unit, in the words of [`declare::unit`](asperity_core::declare::unit).
        unit: &'static str,
        /// What it may be.
        range: Range,
    },
    /// A whole number.
    Whole {
        /// The least.
        least: u64,
        /// The largest.
        most: u64,
    },
    /// `true` or `false`.
    Flag,
    /// Free text; what it is.
    Text(&'static str),
    /// One of a few words, each with its meaning.
    Word(Vec<(&'static str, &'static str)>),
    /// The name of something.
    Name(Names),
    /// A list.
    List {
        /// What its items are.
        item: Box<Schema>,
        /// Fewest items.
        least: usize,
        /// Most items.
        most: usize,
    },
    /// A table whose keys are names.
    Map {
        /// What the names name.
        names: Names,
        /// Whether a key gives the name to a new thing or refers to one that exists.
        defines: bool,
        /// What stands behind each name.
        item: Box<Schema>,
    },
    /// A table of keys.
    Table(Vec<Key>),
    /// A table with exactly one of these keys.
    OneOf(Vec<Key>),
}

/// What a name names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Names {
    /// A material.
    Material,
    /// An interface.
    Interface,
    /// A rigid tool.
    Tool,
    /// A contact.
    Contact,
    /// A probe.
    Probe,
    /// A part of a generated mesh.
    Part,
    /// A step.
    Step,
    /// A group of any kind.
    Group,
    /// A group with cells.
    Cells,
    /// A group with sides.
    Sides,
    /// What a surface may touch: a tool, or a group with sides.
    Target,
    /// A condition of an earlier step: `pressure.bore`.
    Condition,
    /// What may be held: a tool, or a group of nodes.
    Movable,
    /// What may be removed: a contact, or a tool.
    Removable,
    /// A point whose loads a group carries.
    Distributing,
    /// What may be loaded: a tool, or such a point.
    Loadable,
}

impl Names {
    /// What messages call it.
    pub fn noun(self) -> &'static str {
        match self {
            Self::Material => "material",
            Self::Interface => "interface",
            Self::Tool => "tool",
            Self::Contact => "contact",
            Self::Probe => "probe",
            Self::Part => "part of the mesh",
            Self::Step => "step",
            Self::Group => "group",
            Self::Cells => "group of cells",
            Self::Sides => "group of sides",
            Self::Target => "tool or group of sides",
            Self::Condition => "condition of an earlier step",
            Self::Movable => "tool or group",
            Self::Removable => "contact, tool or body",
            Self::Distributing => "point of loads",
            Self::Loadable => "tool or point of loads",
        }
    }
}

/// The whole deck's schema.
pub fn root() -> Schema {
    Schema::Table(Deck::keys())
}

/// The schema of a deck for one material point.
pub fn point_root() -> Schema {
    Schema::Table(PointDeck::keys())
}

/// The schema of a deck for one point of an interface.
pub fn interface_root() -> Schema {
    Schema::Table(InterfaceDeck::keys())
}
