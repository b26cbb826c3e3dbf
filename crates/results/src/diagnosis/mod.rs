//! What a run that failed, or whose results are doubtful, most likely suffers from: data in, findings out. [`Facts`] are what
//! is known of the model before it runs, a [`RunCourse`] is what was seen of the run; each of the rules looks at both and may
//! find a cause, with its evidence and with what to try. The findings are ranked by how strongly they are supported.
//!
//! [`oddities`] are the same for a model alone: numbers that hardly belong together, as of mixed units.

mod course;
mod facts;
mod plausible;
mod rules;
mod settings;
#[cfg(test)]
mod tests;

pub use course::{Doubted, End, Fault, RunCourse};
pub use facts::{BodyFacts, ContactFacts, Facts, Load, StepFacts, ToolFacts};
pub use plausible::{Oddity, oddities};
pub use settings::{Setting, settings};

use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A likely cause.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// Its name for scripts: `free-body`.
    pub cause: String,
    /// What it is, in plain words.
    pub what: String,
    /// What speaks for it.
    pub evidence: Vec<String>,
    /// What to try, the likeliest first.
    pub advice: Vec<String>,
    /// How strongly it is supported, from zero to one.
    pub weight: f64,
}

/// Findings that are kept.
const MOST: usize = 4;
/// A finding of less than this part of the weight of the first is left out.
const FAINT: f64 = 0.4;

/// The likely causes, the likeliest first; none for a run that ended well, and always one for a run that did not.
pub fn diagnose(facts: &Facts, course: &RunCourse) -> Vec<Finding> {
    if course.ended == End::Well && course.doubts.is_empty() {
        return Vec::new();
    }
    let mut found: Vec<Finding> = rules::ALL.iter().filter_map(|rule| rule(facts, course)).collect();
    found.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    let mut named = BTreeSet::new();
    found.retain(|finding| named.insert(finding.cause.clone()));
    let least = FAINT * found.first().map_or(0.0, |first| first.weight);
    found.retain(|finding| finding.weight >= least);
    found.truncate(MOST);
    if found.is_empty() {
        found.push(rules::unknown(course));
    }
    found
}
