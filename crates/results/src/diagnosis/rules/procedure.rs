//! What the deck says of the solution and that stands in its way.

use super::super::Finding;
use super::super::course::RunCourse;
use super::super::facts::Facts;
use super::finding;
use asperity_core::FailureKind;

/// A tolerance that rounding does not allow.
const TIGHT: f64 = 1e-10;

pub(super) fn tolerance(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let loose = course.doubt(&["equilibrium_error"]);
    if let Some(doubt) = loose.filter(|_| facts.tolerance > 1e-4) {
        return Some(
            finding("tolerance", 0.88, "the tolerance of the iterations is too loose")
                .shown(format!("`solver.tolerance` is {:.0e}; {}: {:.1e}", facts.tolerance, doubt.words, doubt.value))
                .try_to(&["leave `solver.tolerance` out: 1e-6"]),
        );
    }
    let near = course.faults.iter().find(|fault| fault.kind == FailureKind::Iterations && fault.residual < 1e-7);
    let near = near.filter(|_| course.kind() == Some(FailureKind::Iterations) && facts.tolerance < TIGHT)?;
    Some(
        finding("tolerance", 0.9, "the tolerance of the iterations is tighter than rounding allows")
            .shown(format!(
                "`solver.tolerance` is {:.0e}, and the iterations come to {:.1e}",
                facts.tolerance, near.residual
            ))
            .try_to(&["leave `solver.tolerance` out: 1e-6"]),
    )
}

pub(super) fn few_iterations(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let stopped = course.share(&[FailureKind::Iterations, FailureKind::Cycle]) > 0.5 && course.kind().is_some();
    (stopped && facts.iterations < 8).then(|| {
        finding("few-iterations", 0.9, "the iterations are given up before they can converge")
            .shown(format!("`solver.iterations` allows {}", facts.iterations))
            .try_to(&["leave `solver.iterations` out: 25"])
    })
}

pub(super) fn switched_off(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let kinds = [FailureKind::Iterations, FailureKind::Cycle, FailureKind::NotFinite];
    (!facts.switched_off.is_empty() && course.kind().is_some_and(|kind| kinds.contains(&kind))).then(|| {
        finding("procedure", 0.65, "parts of the procedure that help here are switched off")
            .shown(facts.switched_off.join(", "))
            .try_to(&["leave these keys out"])
    })
}

pub(super) fn smallest(facts: &Facts, course: &RunCourse) -> Option<Finding> {
    let step = facts.steps.get(course.step)?;
    let few = course.faults.len() <= 3 && !course.faults.is_empty();
    let cuts = matches!(course.kind(), Some(kind) if ![FailureKind::Free, FailureKind::Pushed, FailureKind::Hourglass, FailureKind::TooMany].contains(&kind));
    (cuts && few && step.smallest > 0.002).then(|| {
        finding("smallest-increment", 0.75, "increments may not become small enough")
            .shown(format!(
                "`increments.smallest` is {}, and the run gave up after {} attempts at one increment",
                step.smallest,
                course.faults.len()
            ))
            .try_to(&["leave `increments.smallest` out: 1e-6", "or begin with a smaller `increments.first`"])
    })
}

pub(super) fn too_many(_: &Facts, course: &RunCourse) -> Option<Finding> {
    (course.kind() == Some(FailureKind::TooMany)).then(|| {
        finding("increments-used-up", 0.9, "the step has used up the increments that it may take")
            .shown(&course.reason)
            .shown(format!("{} attempts were cut before", course.cuts))
            .try_to(&[
                "raise `increments.most`; `asperity restart` goes on from the last accepted increment",
                "if many were cut: what cuts them is the cause, see `increments.csv`",
            ])
    })
}
