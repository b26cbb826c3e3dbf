//! What a run was made from, part by part, so that a checkpoint can be gone on from where only what lies ahead has changed.
//!
//! | part | when it may change |
//! | --- | --- |
//! | `title`, `solver`, `limits`, `output`, `probe`, `units` | always |
//! | `step N`, its conditions and its duration | until it has begun |
//! | `step N increments` | always |
//! | a group | it may be added or left out |
//! | all others: mesh, materials, bodies, tools, contacts, ties, equations | never |

use super::checkpoint::InputHash;
use asperity_core::Error;
use asperity_core::solve::Problem;
use asperity_core::system::{Caution, State};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// A part of the input: what messages call it, and its fingerprint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Part {
    /// Its key in the deck: `material.steel`, `step 2`.
    pub key: String,
    /// The hash of what stands there.
    pub print: InputHash,
}

/// An accepted state with what a deck that is no longer the same is compared with.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// The parts of the input.
    pub parts: Vec<Part>,
    /// The names of the terms, in their order.
    pub terms: Vec<String>,
    /// The state.
    pub state: State,
}

/// What a checkpoint says of where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// Hash of the whole input.
    pub input: InputHash,
    /// Its parts.
    pub parts: Vec<Part>,
    /// The names of the terms, in their order.
    pub terms: Vec<String>,
}

impl Default for Origin {
    fn default() -> Self {
        Self { input: InputHash::of(&[]), parts: Vec::new(), terms: Vec::new() }
    }
}

/// The parts that may be other than they were, whenever they like.
const FREE: [&str; 6] = ["title", "solver", "limits", "output", "probe", "units"];

/// The keys of parts that differ.
fn differences(old: &[Part], new: &[Part]) -> BTreeSet<String> {
    let of = |parts: &[Part]| parts.iter().map(|part| (part.key.clone(), part.print)).collect::<BTreeMap<_, _>>();
    let (old, new) = (of(old), of(new));
    let both = old.keys().chain(new.keys());
    let group = |key: &str| key.starts_with("group ") && !(old.contains_key(key) && new.contains_key(key));
    both.filter(|key| old.get(*key) != new.get(*key) && !group(key)).cloned().collect()
}

/// Number of the step, from zero, of which a part is, and whether it is of its increments only.
fn step_of(key: &str) -> Option<(usize, bool)> {
    let rest = key.strip_prefix("step ")?;
    let (number, increments) = rest.strip_suffix(" increments").map_or((rest, false), |number| (number, true));
    Some((number.parse::<usize>().ok()?.checked_sub(1)?, increments))
}

impl Kept {
    /// The state as one of a problem whose input may have changed in what lies ahead, and the parts that have.
    ///
    /// # Errors
    /// In words, which parts of what lies behind differ; or that the state is of another model.
    pub fn go_on(self, problem: &Problem, parts: &[Part]) -> Result<(State, Vec<String>), String> {
        let changed = differences(&self.parts, parts);
        // What the first increment of a step that failed has handed over is of that step.
        let begun = self.state.step_increment > 0 || (self.state.entered && self.state.step > 0);
        let behind = self.state.step + usize::from(begun);
        let may_change = |key: &&String| match step_of(key) {
            Some((step, increments)) => increments || step >= behind,
            None => FREE.contains(&key.as_str()),
        };
        let lost: Vec<String> = changed.iter().filter(|key| !may_change(key)).map(|key| format!("`{key}`")).collect();
        if !lost.is_empty() {
            return Err(format!(
                "this checkpoint belongs to another deck or mesh: what lies behind it must be what it was, and {} {}; \
                 `step {}` and later steps may change, and of all steps the increments, `solver`, `limits`, `output`, \
                 `probe`, `units`, `title`; if it was run with --set, give the same --set again",
                lost.join(", "),
                if lost.len() == 1 { "is not" } else { "are not" },
                behind + 1,
            ));
        }
        let state = self.fitted(problem, begun, &changed);
        problem.fits(&state)?;
        Ok((state, changed.into_iter().collect()))
    }

    /// The state with terms in the problem's order, and with the size of increments that the problem wants next.
    fn fitted(self, problem: &Problem, begun: bool, changed: &BTreeSet<String>) -> State {
        let Self { terms, mut state, .. } = self;
        let names: Vec<&str> = problem.terms.iter().map(|term| term.name()).collect();
        if names != terms && terms.len() == state.histories.len() && terms.len() == state.energies.len() {
            let (old, own) = (numbered(terms.iter().map(String::as_str)), problem.initial_state());
            let places: Vec<_> =
                numbered(names.into_iter()).iter().map(|key| old.iter().position(|o| o == key)).collect();
            let (histories, energies) = (std::mem::take(&mut state.histories), std::mem::take(&mut state.energies));
            for ((place, history), energy) in places.into_iter().zip(own.histories).zip(own.energies) {
                state.histories.push(place.map_or(history, |at| histories[at].clone()));
                state.energies.push(place.map_or(energy, |at| energies[at]));
            }
        }
        let increments = format!("step {} increments", state.step + 1);
        if let Some(step) = problem.steps.get(state.step).filter(|_| !begun || changed.contains(&increments)) {
            state.next_dt = step.increments.first * step.duration;
            state.caution = Caution::default();
        }
        if changed.contains("solver") {
            state.preconditioner = None;
        }
        state
    }
}

/// Names with how often each came before.
fn numbered<'n>(names: impl Iterator<Item = &'n str>) -> Vec<(&'n str, usize)> {
    let mut met = BTreeMap::new();
    let number = |name: &'n str| {
        let count = met.entry(name).or_insert(0);
        *count += 1;
        (name, *count)
    };
    names.map(number).collect()
}

/// The names of the terms of a problem.
pub fn terms_of(problem: &Problem) -> Vec<String> {
    problem.terms.iter().map(|term| term.name().to_owned()).collect()
}

/// The state in a checkpoint, and the parts of the input that have changed since.
///
/// # Errors
/// [`Error::File`] when it cannot be read, or what lies behind it has changed.
pub fn resumed(path: &std::path::Path, problem: &Problem, parts: &[Part]) -> Result<(State, Vec<String>), Error> {
    let (_, kept) = super::checkpoint::read::<Kept>(path)?;
    kept.go_on(problem, parts).map_err(|reason| Error::file(path, reason))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(of: &[(&str, &str)]) -> Vec<Part> {
        let part = |(key, text): &(&str, &str)| Part { key: (*key).into(), print: InputHash::of(&[text.as_bytes()]) };
        of.iter().map(part).collect()
    }

    #[test]
    fn parts_that_differ_are_found_but_for_groups_that_come_or_go() {
        let old = parts(&[("material.m", "1"), ("group a", "1"), ("group b", "1"), ("step 1", "1")]);
        let new = parts(&[("material.m", "2"), ("group b", "2"), ("group c", "1"), ("step 1", "1"), ("step 2", "1")]);
        let found: Vec<String> = differences(&old, &new).into_iter().collect();
        assert_eq!(found, ["group b", "material.m", "step 2"]);
    }

    #[test]
    fn parts_of_steps() {
        assert_eq!(step_of("step 3"), Some((2, false)));
        assert_eq!(step_of("step 3 increments"), Some((2, true)));
        assert_eq!([step_of("step 0"), step_of("material.step 1")], [None, None]);
    }

    #[test]
    fn names_that_come_twice_are_told_apart() {
        assert_eq!(numbered(["a", "b", "a"].into_iter()), [("a", 1), ("b", 1), ("a", 2)]);
    }
}
