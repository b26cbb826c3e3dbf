//! How a law is integrated over an increment.

use crate::diagnose::Diagnostic;
use crate::form::{Form, number, table, whole, word, words};
use crate::reader::Reader;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};
use asperity_core::integrate::{Scheme, Update};
use asperity_core::material::{Material, Spin};

table! {
    /// Sub-steps and scheme of a law.
    pub struct UpdateKeys check parameter {
        /// How one sub-step is taken.
        scheme: Option<SchemeWord> = word().unless_given("backward-euler; two-step where a tolerance is given"),
        /// Parameter of the midpoint rule: order 2 at 0.5, backward Euler at 1.
        theta: Option<Spot<f64>> =
            number(unit::NONE, Range::from_to(0.5, 1.0)).spot().unless_given("0.5 for the midpoint scheme"),
        /// Number of equal sub-steps of an increment; the fewest where a tolerance is given.
        substeps: usize = whole(1..=10_000).or("1"),
        /// Relative error of the stress at the end of an increment; sub-steps are halved until theirs together keep it.
        tolerance: Option<f64> =
            number(unit::NONE, Range::from_to(1e-9, 0.1)).unless_given("as many sub-steps as said"),
    }
}

words! {
    /// How one sub-step is taken.
    pub enum SchemeWord {
        /// one implicit step, order 1
        BackwardEuler = "backward-euler",
        /// the generalised midpoint rule and a return to the admissible states
        Midpoint = "midpoint",
        /// two implicit stages, order 2
        TwoStep = "two-step",
    }
}

words! {
    /// The objective rate of the stress, in whose frame a law is integrated.
    pub enum ObjectiveRate {
        /// Jaumann's, with the spin of the solid (Hughes and Winget)
        Jaumann = "jaumann",
        /// that of Green and Naghdi, with the spin of the polar rotation
        GreenNaghdi = "green-naghdi",
        /// the one in which the rate of the logarithmic strain is the rate of deformation (Xiao, Bruhns and Meyers)
        Logarithmic = "logarithmic",
    }
}

fn parameter(keys: &UpdateKeys, reader: &mut Reader) {
    if let Some(theta) = keys.theta.filter(|_| keys.scheme != Some(SchemeWord::Midpoint)) {
        let what = format!("`{}.theta` is the parameter of the midpoint scheme", reader.path());
        reader.report(Diagnostic::error(what).at(theta.place).help("say scheme = \"midpoint\", or remove it"));
    }
}

impl UpdateKeys {
    /// What the keys say.
    pub fn update(&self) -> Update {
        let scheme = match self.scheme {
            Some(SchemeWord::BackwardEuler) => Scheme::BackwardEuler,
            Some(SchemeWord::Midpoint) => Scheme::Midpoint(self.theta.map_or(0.5, |theta| theta.value)),
            Some(SchemeWord::TwoStep) => Scheme::TwoStep,
            None if self.tolerance.is_some() => Scheme::TwoStep,
            None => Scheme::BackwardEuler,
        };
        Update { scheme, substeps: self.substeps, tolerance: self.tolerance }
    }
}

/// How a law is integrated where nothing is said.
pub const OWN_UPDATE: &str = "one backward-Euler step; two-step sub-steps, each within a thousandth of its halves, for `norton_hoff`, \
`perzyna`, `mohr_coulomb_hardening`, `drucker_prager_hardening`, `modified_cam_clay`, `ubiquitous_joint` and a back stress \
with recovery; one two-step for the laws of Gurson";

/// The rate where none is said.
pub const DEFAULT_RATE: &str =
    "Jaumann's; the logarithmic one for a law with a back stress, Green and Naghdi's for Hill's";

/// A law as a body or a point wants it integrated, turned with the rate that is said; nothing where that is the law as it
/// is.
///
/// # Errors
/// In words, where the stress of a law follows from the deformation alone.
pub fn integrated(
    law: &dyn Material,
    rate: Option<ObjectiveRate>,
    update: Option<&UpdateKeys>,
) -> Result<Option<Box<dyn Material>>, String> {
    let said = update.map(UpdateKeys::update).or(law.own_update());
    let updated = said.map(|update| law.with_update(update)).transpose()?;
    let spin = match rate {
        Some(ObjectiveRate::Jaumann) => None,
        Some(ObjectiveRate::GreenNaghdi) => Some(Spin::Polar),
        Some(ObjectiveRate::Logarithmic) => Some(Spin::Logarithmic),
        None => law.own_spin(),
    };
    let Some(spin) = spin else { return Ok(updated) };
    updated.as_deref().unwrap_or(law).with_spin(spin).map(Some)
}
