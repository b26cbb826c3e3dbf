//! Contacts.

use super::UpdateKeys;
use crate::diagnose::Diagnostic;
use crate::form::{ChosenLaw, Form, flag, law, list, number, refers, table, table_of, whole, word, words};
use crate::reader::{Name, Reader};
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::contact::{Augmentation, Overlap};
use asperity_core::declare::{Range, unit};
use asperity_core::interface::{self, Interface};

table! {
    /// A surface and what it may touch.
    pub struct Contact check stiffness {
        /// The group of sides that carries the contact points.
        surface: Name = refers(Names::Sides).required(),
        /// What it may touch: a rigid tool, or a group of sides of this or another body.
        target: Name = refers(Names::Target).required(),
        /// The law of the interface. Without friction: law.coulomb = { friction = 0.0 }.
        law: ChosenLaw<Box<dyn Interface>> = law(interface::laws::ALL).required(),
        /// How the law is integrated over an increment.
        update: Option<UpdateKeys> = table_of().unless_given("in closed form where the law has one, else in one step"),
        /// Integration points along an edge; along each side of a quadrilateral face, and 1, 3, 6, or their square from 4 on, on a
        /// triangle.
        gauss: Option<Spot<usize>> =
            whole(1..=10).spot().computed("the degree of the edge: 1 on edges of first degree, 2 on edges of second degree; in axial symmetry 2 \
             also on edges of first degree within about ten of their lengths from the axis, over which the radius changes"),
        /// Pressure for one unit of penetration.
        penalty: Option<f64> = number(unit::PENALTY, Range::POSITIVE)
            .computed("50 times the modulus over the depth of the cells behind the faces, or what bending of a thin body makes of it, the \
             least of both sides, 10 times with two passes; the modulus is the confined one, at most four shear moduli, \
             of a thin body that flows the secant one at a strain of 0.2 %"),
        /// Rows of penetration and pressure in place of a penalty, from [0.0, 0.0] on: straight between them and beyond the last.
        closure: Option<Spot<Vec<Vec<f64>>>> =
            list(list(number(unit::NONE, Range::NOT_NEGATIVE), 2..=2), 2..=usize::MAX).spot().unless_given("the penalty"),
        /// Friction stress for one unit of elastic slip.
        tangential_penalty: Option<f64> =
            number(unit::PENALTY, Range::POSITIVE)
            .computed("that of the elastic slip, at most the penalty; equal to the penalty where there is none"),
        /// Elastic slip of a node of a field that is about to slide under its pressure before the increment, over the length of its
        /// edges: the tangential penalty follows from it.
        elastic_slip: Option<Spot<f64>> = number(unit::NONE, Range::above_to(0.0, 1.0)).spot().computed(
            "0.005 in a field, with friction by the pressure and without augmentation; else none"),
        /// Which sides of two bodies carry contact points.
        passes: Option<Spot<Passes>> = word().spot().computed(
            "two between sides of second degree, one where a side is of first degree; a tool carries none"),
        /// Whether the tangent holds the coupling of the two bodies. Without it the paper's iterations are reproduced.
        coupling: Option<Spot<bool>> = flag().spot().computed("true"),
        /// Where contact stress lives, and how it becomes forces.
        form: Option<Spot<ContactForm>> = word().spot().computed("field, or paper where \
             `gauss`, `passes`, `coupling` or a law over a mean of the pressure are said"),
        /// Which of two bodies carries the field of contact stress.
        roles: Roles = word().or("\"auto\""),
        /// What becomes of points that lie inside the target before the first increment.
        overlap: Spot<OverlapWord> = word().spot().or("\"ramp\""),
        /// Wear of the surface: reported as a depth, and felt as a gap if it recedes.
        wear: Option<WearKeys> = table_of().unless_given("the surface does not wear"),
        /// Multipliers of a field that take out what the penalties leave of penetration and elastic slip: `augmentation = {}`.
        augmentation: Option<Spot<AugmentationKeys>> = table_of().spot().unless_given("penetration and elastic slip stay"),
    }
}

table! {
    /// How the surface wears: Archard's depth, a coefficient times pressure times sliding.
    pub struct WearKeys {
        /// Depth for a unit of pressure times sliding.
        coefficient: f64 = number("1/stress", Range::POSITIVE).required(),
        /// Whether the surface recedes by what it has worn.
        recedes: bool = flag().or("false"),
    }
}

words! {
    /// What becomes of points that lie inside the target before the first increment.
    pub enum OverlapWord {
        /// it is removed little by little over the first step
        Ramp = "ramp",
        /// it presses from the first increment on
        Keep = "keep",
        /// the nodes of the surface are moved out of the target, without strain; what is left between them is removed as by "ramp"
        Adjust = "adjust",
        /// the deck is refused
        Refuse = "refuse",
        /// the surfaces are meant to fit, as a shaft in its bore: what stands between their facets counts as nothing
        Fit = "fit",
    }
}

impl OverlapWord {
    /// What becomes of it, when the first step lasts so long.
    pub fn overlap(self, step: f64) -> Overlap {
        match self {
            Self::Keep => Overlap::Keep,
            Self::Ramp | Self::Adjust | Self::Refuse => Overlap::Ramp(step),
            Self::Fit => Overlap::Fit,
        }
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

/// A table stands in place of the penalty, and multipliers would take out what it leaves.
fn stiffness(contact: &Contact, reader: &mut Reader) {
    let Some(closure) = &contact.closure else { return };
    let other = contact.penalty.map(|_| "penalty").or(contact.augmentation.as_ref().map(|_| "augmentation"));
    if let Some(other) = other {
        let what = format!("`{}` has `closure` and `{other}`", reader.path());
        reader.report(Diagnostic::error(what).at(closure.place).help("keep one of the two"));
    }
}

impl Contact {
    /// Depth of wear for a unit of pressure times sliding, of a surface that recedes by it.
    pub fn recession(&self) -> Option<f64> {
        self.wear.as_ref().filter(|wear| wear.recedes).map(|wear| wear.coefficient)
    }
}

impl AugmentationKeys {
    /// What the keys say.
    pub fn augmentation(&self) -> Augmentation {
        Augmentation { penetration: self.penetration, slip: self.slip, loops: self.loops }
    }
}

words! {
    /// Which of two bodies carries the field of contact stress.
    pub enum Roles {
        /// a flat side beside one in chords of first degree, of two in chords the coarser, of flat ones the smaller up to faces three times as large, else the finer one; the surface where they are alike, and where it wears
        Auto = "auto",
        /// the surface
        Given = "given",
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

words! {
    /// Where contact stress lives.
    pub enum ContactForm {
        /// as a field of nodal values, along the normals of what is touched
        Field = "field",
        /// at the integration points, along the normal of the strained surface, over its present area
        Paper = "paper",
    }
}
