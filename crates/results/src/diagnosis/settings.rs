//! Settings with which a run that failed may go on from its last accepted increment: how it is solved may change there, what
//! is solved may not.

use super::{Facts, RunCourse};
use asperity_core::FailureKind;
use serde::{Deserialize, Serialize};

/// A change of the deck's settings.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Setting {
    /// What it does.
    pub what: String,
    /// What is set over the deck: `KEY=VALUE`.
    pub set: String,
}

/// First and largest increment become this part of what failed,
const SMALLER: f64 = 0.25;
/// the smallest this part of what it was, but no less than what rounding allows.
const SMALLEST: [f64; 2] = [1e-3, 1e-12];
/// Iterations up to which more may help.
const MANY: usize = 100;

/// The settings that may help, the likeliest first; none for a run that ended well.
pub fn settings(facts: &Facts, course: &RunCourse) -> Vec<Setting> {
    let (Some(kind), Some(step)) = (course.kind(), facts.steps.get(course.step)) else { return Vec::new() };
    let (number, mut found) = (course.step + 1, Vec::new());
    let mut add = |what: &str, set: String| found.push(Setting { what: what.into(), set });
    match kind {
        FailureKind::TooMany => add("more increments", format!("step.{number}.increments.most={}", 4 * step.most)),
        FailureKind::Free => add("what nothing holds stays where it is", "solver.if_free=\"hold\"".into()),
        _ => {
            let tried = course.faults.first().map_or(step.first, |fault| fault.size.min(step.first));
            let size = (SMALLER * tried).max(10.0 * SMALLEST[1]);
            let smallest = (SMALLEST[0] * step.smallest).max(SMALLEST[1]).min(size);
            let sizes = format!("first = {size:e}, largest = {size:e}, smallest = {smallest:e}, most = {}", step.most);
            add("smaller increments", format!("step.{number}.increments={{ {sizes} }}"));
        }
    }
    if kind == FailureKind::Iterations && facts.iterations < MANY {
        add("more iterations", format!("solver.iterations={}", 2 * facts.iterations));
    }
    for off in &facts.switched_off {
        add("what was switched off", off.trim_matches('`').replace(" = false", "=true"));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::{End, Fault, StepFacts};
    use super::*;

    fn told(kind: FailureKind) -> Vec<String> {
        let step = StepFacts { first: 0.1, largest: 0.2, smallest: 1e-3, most: 50, ..StepFacts::default() };
        let off = vec!["`solver.line_search = false`"];
        let facts =
            Facts { steps: vec![StepFacts::default(), step], iterations: 25, switched_off: off, ..Facts::default() };
        let faults = vec![Fault { size: 0.04, ..Fault::default() }];
        let course = RunCourse { ended: End::Failed(kind), step: 1, faults, ..RunCourse::default() };
        settings(&facts, &course).into_iter().map(|setting| setting.set).collect()
    }

    #[test]
    fn each_kind_of_failure_has_its_settings() {
        let increments = "step.2.increments={ first = 1e-2, largest = 1e-2, smallest = 1e-6, most = 50 }";
        assert_eq!(told(FailureKind::Iterations), [increments, "solver.iterations=50", "solver.line_search=true"]);
        assert_eq!(told(FailureKind::TooMany)[0], "step.2.increments.most=200");
        assert_eq!(told(FailureKind::Free)[0], "solver.if_free=\"hold\"");
        assert!(settings(&Facts::default(), &RunCourse::default()).is_empty());
    }
}
