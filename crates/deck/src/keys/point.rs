//! The deck of one material point: materials as in any deck, and the path along which they are driven.

use super::memory::{self, MullinsKeys};
use super::umat::{SolidLaw, solid_law};
use super::update::{DEFAULT_RATE, OWN_UPDATE, ObjectiveRate, UpdateKeys};
use crate::diagnose::Diagnostic;
use crate::form::{Form, defines, list, map, number, table, table_of, text, whole, word};
use crate::reader::{Name, Reader};
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};
use asperity_core::material::Material;
use asperity_results::point::{PathControl, Stage};
use std::sync::Arc;

table! {
    /// Laws and the path along which they are driven.
    pub struct PointDeck {
        /// Version of the deck's language.
        version: usize = whole(1..=1).required(),
        /// What pictures call it.
        title: String = text("a title").or("\"\""),
        /// Materials: a name, then a law and its numbers. Each is driven along the same path.
        material: Vec<(Name, SolidLaw)> = map(defines(Names::Material), solid_law()).required(),
        /// How the laws are integrated over an increment.
        update: Option<UpdateKeys> = table_of().unless_given(OWN_UPDATE),
        /// The objective rate of the stress, in whose frame the laws are integrated.
        rate: Option<ObjectiveRate> = word().unless_given(DEFAULT_RATE),
        /// Relaxation of the shape of rubber: pairs of a share of the instantaneous stress and a relaxation time (Prony series).
        prony: Vec<Vec<f64>> = memory::prony().or("[]"),
        /// Softening of rubber by the largest deformation so far.
        mullins: Option<MullinsKeys> = table_of().unless_given("none"),
        /// Bulk modulus of the pore water over the porosity, of a soil that is not drained.
        pore_stiffness: Option<f64> = number(unit::STRESS, Range::POSITIVE).unless_given("drained"),
        /// Stress at the beginning.
        initial_stress: Option<Stresses> = table_of().unless_given("that of the law"),
        /// The path, in order.
        step: Vec<PointStep> = list(table_of(), 1..=usize::MAX).required(),
        /// What is drawn.
        curve: Vec<PointCurve> = list(table_of(), 0..=usize::MAX).or("[]"),
    }
}

table! {
    /// A part of the path. A component that is named neither as strain nor as stress keeps its stress.
    pub struct PointStep check conflicts {
        /// What messages call it.
        name: Option<String> = text("the name of a step").computed("step and its number"),
        /// How long it lasts.
        duration: f64 = number(unit::TIME, Range::POSITIVE).or("1.0"),
        /// Number of equal increments.
        increments: usize = whole(1..=1_000_000).or("100"),
        /// Strains that are prescribed, reached at the end of the step: logarithms of stretches, and shears.
        strain: Strains = table_of().or("{}"),
        /// Stresses that are prescribed, reached at the end of the step.
        stress: Stresses = table_of().or("{}"),
        /// Temperature above that of the room, reached at the end of the step; it stretches nothing.
        temperature: Option<f64> = number(unit::TEMPERATURE, Range::ANY).unless_given("what it was, at first 0"),
    }
}

table! {
    /// Strains. The deformation gradient is triangular: stretches on the diagonal, shears above it.
    pub struct Strains {
        /// Logarithm of the stretch along x.
        xx: Option<f64> = number(unit::NONE, Range::between(-20.0, 20.0)).unless_given("not prescribed"),
        /// Logarithm of the stretch along y.
        yy: Option<f64> = number(unit::NONE, Range::between(-20.0, 20.0)).unless_given("not prescribed"),
        /// Logarithm of the stretch along z.
        zz: Option<f64> = number(unit::NONE, Range::between(-20.0, 20.0)).unless_given("not prescribed"),
        /// Shear: motion along x for one unit of y.
        xy: Option<f64> = number(unit::NONE, Range::ANY).unless_given("not prescribed"),
        /// Shear: motion along y for one unit of z.
        yz: Option<f64> = number(unit::NONE, Range::ANY).unless_given("not prescribed"),
        /// Shear: motion along x for one unit of z.
        xz: Option<f64> = number(unit::NONE, Range::ANY).unless_given("not prescribed"),
    }
}

table! {
    /// Cauchy stresses, tension positive.
    pub struct Stresses {
        /// Along x.
        xx: Option<f64> = number(unit::STRESS, Range::ANY).unless_given("not prescribed"),
        /// Along y.
        yy: Option<f64> = number(unit::STRESS, Range::ANY).unless_given("not prescribed"),
        /// Along z.
        zz: Option<f64> = number(unit::STRESS, Range::ANY).unless_given("not prescribed"),
        /// Shear of x and y.
        xy: Option<f64> = number(unit::STRESS, Range::ANY).unless_given("not prescribed"),
        /// Shear of y and z.
        yz: Option<f64> = number(unit::STRESS, Range::ANY).unless_given("not prescribed"),
        /// Shear of x and z.
        xz: Option<f64> = number(unit::STRESS, Range::ANY).unless_given("not prescribed"),
    }
}

table! {
    /// A picture: columns over a column.
    pub struct PointCurve {
        /// The column of the abscissa.
        x: Spot<String> = text("the name of a column").spot().required(),
        /// The columns of the ordinate.
        y: Vec<Spot<String>> = list(text("the name of a column").spot(), 1..=12).required(),
    }
}

impl Strains {
    /// In the order XX YY ZZ XY YZ XZ.
    fn all(&self) -> [Option<f64>; 6] {
        [self.xx, self.yy, self.zz, self.xy, self.yz, self.xz]
    }
}

impl Stresses {
    /// In the order XX YY ZZ XY YZ XZ.
    pub fn all(&self) -> [Option<f64>; 6] {
        [self.xx, self.yy, self.zz, self.xy, self.yz, self.xz]
    }
}

/// A component follows its strain or its stress, not both.
fn conflicts(step: &PointStep, reader: &mut Reader) {
    for (i, component) in asperity_results::point::COMPONENTS.iter().enumerate() {
        if step.strain.all()[i].is_some() && step.stress.all()[i].is_some() {
            let what = format!("`{}` prescribes both strain and stress of `{component}`", reader.path());
            reader.report(Diagnostic::error(what).at(step.stress.place).help("keep one of the two"));
        }
    }
}

impl PointStep {
    /// What the keys say of the step of a number, from one.
    pub fn stage(&self, number: usize) -> Stage {
        let (strain, stress) = (self.strain.all(), self.stress.all());
        let control = |i: usize| match (strain[i], stress[i]) {
            (Some(strain), _) => PathControl::Strain(strain),
            (_, Some(stress)) => PathControl::Stress(stress),
            _ => PathControl::Kept,
        };
        Stage {
            name: self.name.clone().unwrap_or_else(|| format!("step {number}")),
            duration: self.duration,
            increments: self.increments,
            controls: std::array::from_fn(control),
            temperature: self.temperature,
        }
    }
}

impl PointDeck {
    /// A law with the memory and the pore water of the deck, before it is integrated.
    ///
    /// # Errors
    /// In words, where it takes no memory.
    pub fn completed(&self, law: Arc<dyn Material>) -> Result<Arc<dyn Material>, String> {
        memory::completed(law, &self.prony, self.mullins.as_ref(), self.pore_stiffness)
    }
}
