//! Steps that follow a path of equilibria by its length.

use super::step::StepKeys;
use crate::diagnose::Diagnostic;
use crate::form::{Form, number, refers, table, words};
use crate::reader::{Name, Reader};
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::amplitude::Amplitude;
use asperity_core::declare::{Range, unit};

words! {
    /// What the increments of a step are parts of.
    pub enum ControlWord {
        /// Of its time, with which loads and prescribed motion go.
        Time = "time",
        /// Of the length of the path of equilibria; loads and prescribed motion go with a load factor, which is an unknown.
        ArcLength = "arc-length",
    }
}

table! {
    /// A displacement at which a step ends that follows a path: the mean of a group along one axis.
    pub struct UntilKeys check one_axis {
        /// The group.
        group: Name = refers(Names::Group).required(),
        /// Along x (r).
        x: Option<f64> = number(unit::LENGTH, Range::ANY).unless_given("see y, z"),
        /// Along y (z when axisymmetric).
        y: Option<f64> = number(unit::LENGTH, Range::ANY).unless_given("see x, z"),
        /// Along z.
        z: Option<Spot<f64>> = number(unit::LENGTH, Range::ANY).spot().unless_given("see x, y"),
    }
}

impl UntilKeys {
    /// The axis and the displacement along it.
    pub fn along(&self) -> Option<(usize, f64)> {
        let values = [self.x, self.y, self.z.map(|z| z.value)];
        values.into_iter().enumerate().find_map(|(axis, value)| Some((axis, value?)))
    }
}

fn one_axis(until: &UntilKeys, reader: &mut Reader) {
    let said = [until.x.is_some(), until.y.is_some(), until.z.is_some()].into_iter().filter(|said| *said).count();
    if said != 1 {
        let what = format!("`{}` must say one of `x`, `y`, `z`", reader.path());
        let help = "the displacement at which the step is to end, as `{ group = \"crown\", y = -2.0 }`";
        reader.report(Diagnostic::error(what).at(until.place).help(help));
    }
}

/// Loads that may be released in a step that follows a path.
const LOADS: [&str; 6] = ["force.", "pressure.", "traction.", "body_force.", "load.", "gravity."];

/// What a step that follows a path needs, and what it cannot do at the same time.
pub(super) fn follows(step: &StepKeys, reader: &mut Reader) {
    let path = reader.path();
    let mut refuse = |what: String, place, help: &str| reader.report(Diagnostic::error(what).at(place).help(help));
    if step.control.value == ControlWord::Time {
        if let Some(until) = &step.until {
            let what = format!("`{path}.until` has no use in a step that goes with time");
            refuse(what, until.place, "say `control = \"arc-length\"`, or leave `until` out");
        }
        return;
    }
    let place = step.control.place;
    for (kind, name, _) in step.courses().filter(|(_, _, amplitude)| **amplitude != Amplitude::ramp()) {
        let what = format!("`{kind}.{name}` has an amplitude in a step that follows a path");
        refuse(what, name.place, "loads and motions go with the load factor there: leave `amplitude` out");
    }
    let others = [
        step.temperature.first().map(|(name, _)| ("temperature", name)),
        step.spring.first().map(|(name, _)| ("spring", name)),
        step.friction.first().map(|(name, _)| ("friction", name)),
        step.remove.first().map(|name| ("remove", name)),
        step.add.first().map(|name| ("add", name)),
        step.release.iter().find(|name| !LOADS.iter().any(|kind| name.text.starts_with(kind))).map(|n| ("release", n)),
    ];
    for (kind, name) in others.into_iter().flatten() {
        let what = format!("a step that follows a path says `{kind}` of `{name}`");
        refuse(
            what,
            name.place,
            "such a step has loads and prescribed motion only, and no time of its own: say it in a step before or after",
        );
    }
    let loads = step.gravity.is_some()
        || step.is_loaded()
        || step.release.iter().any(|name| LOADS.iter().any(|kind| name.text.starts_with(kind)));
    if !loads {
        let what = format!("`{path}` follows a path by arc length, and no load changes in it");
        refuse(what, place, "say the load whose factor is followed, or leave `control` out where motion is prescribed");
    }
}

impl StepKeys {
    /// Loads and motions of the step with their amplitudes.
    fn courses(&self) -> impl Iterator<Item = (&'static str, &Name, &Amplitude)> {
        let courses = [
            courses("displacement", &self.displacement, |keys| &keys.amplitude),
            courses("force", &self.force, |keys| &keys.amplitude),
            courses("pressure", &self.pressure, |keys| &keys.amplitude),
            courses("traction", &self.traction, |keys| &keys.amplitude),
            courses("body_force", &self.body_force, |keys| &keys.amplitude),
            courses("motion", &self.motion, |keys| &keys.amplitude),
            courses("load", &self.load, |keys| &keys.amplitude),
        ];
        courses.into_iter().flatten()
    }

    /// Its amplitudes that are no straight lines, each once.
    pub fn amplitudes(&self) -> Vec<Amplitude> {
        let others = [
            courses("temperature", &self.temperature, |keys| &keys.amplitude),
            courses("friction", &self.friction, |keys| &keys.amplitude),
        ];
        let all = self.courses().chain(others.into_iter().flatten()).map(|(_, _, amplitude)| amplitude);
        let mut found: Vec<Amplitude> = Vec::new();
        for amplitude in all.chain(self.gravity.as_ref().map(|gravity| &gravity.amplitude)) {
            if amplitude.bend([0.0, 1.0]).is_some() && !found.contains(amplitude) {
                found.push(amplitude.clone());
            }
        }
        found
    }
}

fn courses<'s, T>(
    kind: &'static str,
    said: &'s [(Name, T)],
    of: fn(&T) -> &Amplitude,
) -> Vec<(&'static str, &'s Name, &'s Amplitude)> {
    said.iter().map(|(name, keys)| (kind, name, of(keys))).collect()
}
