//! Contacts.

use super::UpdateKeys;
use crate::contact::{Augmentation, Guard};
use crate::deck::form::{Form, Law, Words, flag, law, number, refers, table, table_of, whole, word, words};
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
        /// What it may touch: a rigid tool, or a group of sides of this or another body.
        target: Name = refers(Names::Target).required(),
        /// The law of the interface. Without friction: law.coulomb = { friction = 0.0 }.
        law: Law<Box<dyn Interface>> = law(interface::laws::ALL).required(),
        /// How the law is integrated over an increment.
        update: Option<UpdateKeys> = table_of().unless_given("in closed form where the law has one, else in one step"),
        /// Integration points along an edge; along each side of a quadrilateral face, and 1, 3 or 6 on a triangle.
        gauss: Option<Spot<usize>> =
            whole(1..=3).spot().computed("the degree of the edge: 1 on edges of first degree, 2 on edges of second degree"),
        /// Equal parts of an edge that carry these points each: more than one where contact is narrower than an edge.
        parts: Option<Spot<usize>> = whole(1..=64).spot().computed("1"),
        /// Pressure for one unit of penetration.
        penalty: Option<f64> = number(unit::PENALTY, Range::POSITIVE)
            .computed("50 times the confined modulus over the depth of the cells behind the faces, the least of both sides; 10 times with two passes"),
        /// Friction stress for one unit of elastic slip.
        tangential_penalty: Option<f64> =
            number(unit::PENALTY, Range::POSITIVE).computed("equal to the penalty"),
        /// Which sides of two bodies carry contact points.
        passes: Option<Spot<Passes>> = word().spot().computed(
            "two between bodies, but one where edges of first degree bend; a tool carries none"),
        /// Whether the tangent holds the coupling of the two bodies. Without it the paper's iterations are reproduced.
        coupling: Option<Spot<bool>> = flag().spot().computed("true"),
        /// What is done when, with two passes, the facets of curved faces bear more than half of the pressure.
        guard: Option<Spot<Guard>> = word().spot().computed("refuse"),
        /// Multipliers that take out what the penalties leave of penetration and elastic slip: `augmentation = {}`.
        augmentation: Option<Spot<AugmentationKeys>> = table_of().spot().unless_given("penetration and elastic slip stay"),
    }
}

table! {
    /// How far penetration and elastic slip are taken out. Both are weighted means around the nodes of the surface.
    pub struct AugmentationKeys {
        /// Largest penetration at a node, over the length of the shortest edge there, or the root of the area of the least face.
        penetration: f64 = number(unit::NONE, Range::above_to(0.0, 1.0)).or("1e-6"),
        /// Largest slip of an increment at a node where nothing slides, over the same length.
        slip: f64 = number(unit::NONE, Range::above_to(0.0, 1.0)).or("1e-6"),
        /// Most augmentations; an increment that needs more is cut.
        loops: usize = whole(1..=1000).or("10"),
    }
}

impl AugmentationKeys {
    /// What the keys say.
    pub fn augmentation(&self) -> Augmentation {
        Augmentation { penetration: self.penetration, slip: self.slip, loops: self.loops }
    }
}

words! {
    /// Which sides of two bodies carry contact points.
    pub enum Passes {
        /// As the faces suit.
        Auto = "auto",
        /// The surface; its forces act on both bodies.
        One = "one",
        /// Both, each for its own forces.
        Two = "two",
    }
}

impl Words for Guard {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        vec![(Self::Refuse, "refuse", "the run ends with its step"), (Self::Warn, "warn", "the summary notes it")]
    }
}
