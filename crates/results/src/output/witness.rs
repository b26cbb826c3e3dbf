//! What a run shows of itself for a diagnosis: why attempts failed, and whether motion runs away.

use super::certificate::Certificate;
use crate::diagnosis::{Doubted, End, Fault, RunCourse};
use crate::output::Limits;
use asperity_core::FailureKind;
use asperity_core::solve::{AttemptRecord, Problem};
use asperity_core::system::State;

/// Increments of a step over which motion at its beginning and at its end is measured.
const SEVERAL: usize = 2;

/// Watches a run.
#[derive(Debug, Default)]
pub struct Witness {
    faults: Vec<Fault>,
    cuts: usize,
    /// Motion per time of the accepted increments of the step.
    speeds: Vec<f64>,
    step: usize,
    /// Contact points that stick or slip in the last accepted increment.
    touching: usize,
    /// Those of them that stick.
    sticking: usize,
}

impl Witness {
    /// Takes note of an attempt.
    pub fn attempt(&mut self, problem: &Problem, record: &AttemptRecord) {
        let Some(reason) = &record.failure else { return self.faults.clear() };
        let last = record.iterations.last();
        let duration = problem.steps.get(record.step).map_or(1.0, |step| step.duration);
        self.cuts += 1;
        self.faults.push(Fault {
            kind: record.kind,
            reason: reason.clone(),
            size: record.dt / duration,
            residual: last.map_or(f64::NAN, |last| last.residual),
            allowed: last.map_or(f64::NAN, |last| last.tolerance),
            changes: last.map_or(0, |last| last.changes),
        });
    }

    /// Takes note of an accepted increment.
    pub fn accepted(&mut self, problem: &Problem, state: &State, record: &AttemptRecord) {
        if record.step != self.step {
            (self.step, self.speeds) = (record.step, Vec::new());
        }
        (self.touching, self.sticking) = record.iterations.last().map_or((0, 0), |last| {
            let [_, stick, slip] = problem.points_by_status(last);
            (stick + slip, stick)
        });
        let nodes = problem.dofs.nodes() * problem.dofs.per_node();
        let moved = state.last_change[..nodes].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        self.speeds.push(moved / record.dt.max(f64::MIN_POSITIVE));
    }

    fn acceleration(&self) -> f64 {
        let mean = |speeds: &[f64]| speeds.iter().sum::<f64>() / speeds.len().max(1) as f64;
        let count = self.speeds.len();
        if count < 2 * SEVERAL {
            return 1.0;
        }
        let (first, last) = (mean(&self.speeds[..SEVERAL]), mean(&self.speeds[count - SEVERAL..]));
        if first > 0.0 { last / first } else { 1.0 }
    }

    /// What was seen of a run that ended at `state`, of the kind of failure if it failed, with its reason.
    pub fn course(&self, (problem, state): (&Problem, &State), ended: Option<(FailureKind, String)>) -> RunCourse {
        let (ended, reason) = ended.map_or((End::Well, String::new()), |(kind, reason)| (End::Failed(kind), reason));
        let step = state.step.min(problem.steps.len().saturating_sub(1));
        let duration = problem.steps.get(step).map_or(1.0, |step| step.duration);
        RunCourse {
            ended,
            reason,
            step,
            part: match problem.steps.get(step).is_some_and(|step| step.arc_length.is_some()) {
                _ if state.step > step => 1.0,
                true => state.factor,
                false => state.step_time / duration,
            },
            increments: state.increment,
            cuts: self.cuts,
            faults: self.faults.clone(),
            acceleration: self.acceleration(),
            jumps: state.jumps,
            touching: self.touching,
            sticking: self.sticking,
            ..RunCourse::default()
        }
    }
}

/// Adds what the certificate says.
pub fn certified(course: RunCourse, certificate: &Certificate, limits: &Limits) -> RunCourse {
    let doubted = |doubt: super::certificate::Doubt| Doubted {
        figure: doubt.figure.name.into(),
        words: doubt.figure.words.trim().into(),
        value: doubt.worst.value,
        limit: doubt.worst.limit.unwrap_or(f64::NAN),
        step: doubt.worst.step,
        place: doubt.worst.place(),
        remedy: doubt.figure.limit.map_or("", |limit| limit.remedy).into(),
    };
    let name = |of: &str| of.trim_start_matches("contact '").trim_end_matches('\'').to_owned();
    RunCourse {
        doubts: certificate.doubts(limits).into_iter().map(doubted).collect(),
        closed: certificate.each("closed_points").map(|(of, most)| (name(of), most > 0.0)).collect(),
        leap: certificate.figure("leap").unwrap_or(0.0),
        ..course
    }
}
