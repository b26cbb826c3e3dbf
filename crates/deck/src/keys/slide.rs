//! The deck of one point of an interface: laws as any contact has, and the path along which they are driven.

use super::point::PointCurve;
use super::update::UpdateKeys;
use crate::diagnose::Diagnostic;
use crate::form::{ChosenLaw, Form, defines, law, list, map, number, table, table_of, text, whole};
use crate::reader::{Name, Reader};
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};
use asperity_core::interface::{self, Interface};
use asperity_results::point::{Normal, Slide};

table! {
    /// Laws of interfaces and the path along which they are driven.
    pub struct InterfaceDeck {
        /// Version of the deck's language.
        version: usize = whole(1..=1).required(),
        /// What pictures call it.
        title: String = text("a title").or("\"\""),
        /// Interfaces: a name, then a law and its numbers. Each is driven along the same path.
        interface: Vec<(Name, ChosenLaw<Box<dyn Interface>>)> =
            map(defines(Names::Interface), law(interface::laws::ALL)).required(),
        /// Pressure for one unit of penetration.
        penalty: f64 = number(unit::PENALTY, Range::POSITIVE).required(),
        /// Shear stress for one unit of elastic slip.
        tangential_penalty: Option<f64> =
            number(unit::PENALTY, Range::POSITIVE).unless_given("equal to the penalty"),
        /// How the laws are integrated over an increment.
        update: Option<UpdateKeys> = table_of().unless_given("one step"),
        /// The path, in order.
        step: Vec<InterfaceStep> = list(table_of(), 1..=usize::MAX).required(),
        /// What is drawn.
        curve: Vec<PointCurve> = list(table_of(), 0..=usize::MAX).or("[]"),
    }
}

table! {
    /// A part of the path. Where neither penetration nor pressure nor stiffness is named the pressure stays.
    pub struct InterfaceStep check conflicts {
        /// What messages call it.
        name: Option<String> = text("the name of a step").computed("step and its number"),
        /// How long it lasts.
        duration: f64 = number(unit::TIME, Range::POSITIVE).or("1.0"),
        /// Number of equal increments.
        increments: usize = whole(1..=1_000_000).or("100"),
        /// Penetration at the end of the step, negative for a gap.
        penetration: Option<Spot<f64>> = number(unit::LENGTH, Range::ANY).spot().unless_given("not prescribed"),
        /// Pressure at the end of the step.
        pressure: Option<Spot<f64>> = number(unit::STRESS, Range::ANY).spot().unless_given("not prescribed"),
        /// Stiffness of a spring that holds the interface from behind, so that dilation raises the pressure.
        normal_stiffness: Option<Spot<f64>> =
            number(unit::PENALTY, Range::POSITIVE).spot().unless_given("no spring"),
        /// Slip at the end of the step since the beginning of the path, along the two tangents.
        slip: Option<Vec<f64>> = list(number(unit::LENGTH, Range::ANY), 2..=2).unless_given("no more slip"),
    }
}

/// One thing at the most is prescribed across the interface.
fn conflicts(step: &InterfaceStep, reader: &mut Reader) {
    let given =
        [("penetration", step.penetration), ("pressure", step.pressure), ("normal_stiffness", step.normal_stiffness)];
    let given: Vec<_> = given.into_iter().filter_map(|(key, spot)| Some((key, spot?))).collect();
    if let [(first, _), (second, spot), ..] = given.as_slice() {
        let what = format!("`{}` says both `{first}` and `{second}`", reader.path());
        reader.report(Diagnostic::error(what).at(spot.place).help("keep one of the two"));
    }
}

impl InterfaceStep {
    /// What the keys say of the step of a number, from one, after the slip and the pressure of those before it.
    pub fn slide(&self, number: usize, slip: &mut [f64; 2]) -> Slide {
        if let Some([s, t]) = self.slip.as_deref() {
            *slip = [*s, *t];
        }
        let normal = match (self.penetration, self.pressure, self.normal_stiffness) {
            (Some(penetration), ..) => Normal::Penetration(penetration.value),
            (_, Some(pressure), _) => Normal::Pressure(pressure.value),
            (.., Some(stiffness)) => Normal::Stiffness(stiffness.value),
            _ => Normal::Stiffness(0.0),
        };
        let name = self.name.clone().unwrap_or_else(|| format!("step {number}"));
        Slide { name, duration: self.duration, increments: self.increments, normal, slip: *slip }
    }
}
