//! Friction that steps change: a law whose coefficient runs in time.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys;
use crate::reader::Name;
use asperity_core::amplitude::{Change, Timeline};
use asperity_core::integrate::Update;
use asperity_core::interface::{Closing, Closure, Interface, Rule, Wearing};
use std::sync::Arc;

/// The key of laws that steps may change.
const KEY: &str = "friction";

/// A law, its increments integrated as said, under the table of pressure over penetration and with the wear that recedes that are said.
pub(super) fn integrated(
    law: Box<dyn Interface>,
    update: Option<Update>,
    (closure, wear): (Option<&Arc<Closure>>, Option<f64>),
) -> Result<Arc<dyn Interface>, String> {
    let mut law: Arc<dyn Interface> = match update {
        Some(update) => Arc::from(law.with_update(update)?),
        None => Arc::from(law),
    };
    if let Some(closure) = closure {
        law = Arc::new(Closing::new(law, closure.clone())?);
    }
    Ok(match wear {
        Some(coefficient) => Arc::new(Wearing { law, coefficient }),
        None => law,
    })
}

impl Builder<'_> {
    /// The law of a contact whose `first` is that of the deck, with the coefficients that steps say.
    pub(super) fn running(
        &mut self,
        name: &Name,
        keys: &keys::Contact,
        (first, closure): (Arc<dyn Interface>, Option<Arc<Closure>>),
    ) -> Option<Rule> {
        let steps = &self.deck.step;
        let said = |step: &'_ keys::StepKeys| step.friction.iter().find(|(other, _)| other.text == name.text).cloned();
        let Some((place, _)) = steps.iter().find_map(said).map(|(name, keys)| (name.place, keys)) else {
            return Some(first.into());
        };
        let law = keys.law.clone();
        let Some(at) = law.entry.parameters.iter().position(|parameter| parameter.key == KEY) else {
            let what =
                format!("the law `{}` of the contact `{name}` has no `{KEY}` that a step could change", law.entry.name);
            let help = format!("a law with `{KEY}` can be changed, as `coulomb` with {KEY} = 0.0 to begin with");
            self.found.push(Diagnostic::error(what).at(place).help(help));
            return None;
        };
        let change = |step: &keys::StepKeys| match said(step) {
            Some((_, keys)) => Change::To(keys.value, keys.amplitude),
            None => Change::Keep,
        };
        let course = Timeline::from(law.values[at], steps.iter().map(|step| (step.duration, change(step))));
        let (entry, values, update) = (law.entry, law.values, keys.update.as_ref().map(|update| update.update()));
        let wear = keys.recession();
        Some(Rule::running(first, move |step, step_time| {
            let mut values = values.clone();
            values[at] = course.value(step, step_time);
            let allowed = entry.parameters[at].range.contains(values[at]);
            let built =
                if allowed { (entry.build)(&values) } else { Err(format!("friction cannot be {}", values[at])) };
            built.and_then(|law| integrated(law, update, (closure.as_ref(), wear)))
        }))
    }
}
