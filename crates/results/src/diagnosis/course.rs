//! What was seen of a run.

use asperity_core::FailureKind;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum End {
    /// All steps were completed.
    #[default]
    Well,
    /// An increment did not converge, of what.
    Failed(FailureKind),
}

/// A run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RunCourse {
    /// How it ended.
    pub ended: End,
    /// Why, in words.
    pub reason: String,
    /// The step that it ended in, counted from zero, and the part of it that was reached.
    pub step: usize,
    /// That part.
    pub part: f64,
    /// Accepted increments.
    pub increments: usize,
    /// Attempts that were cut.
    pub cuts: usize,
    /// Why the attempts at the increment failed that ended the run, the first first.
    pub faults: Vec<Fault>,
    /// Contact points that were closed in the last accepted increment.
    pub touching: usize,
    /// Those of them that did not slip.
    pub sticking: usize,
    /// What was held still first since nothing held it any more, in words, and from when on.
    pub adrift: Option<(String, f64)>,
    /// For each contact whether it ever closed.
    pub closed: Vec<(String, bool)>,
    /// Motion per time of the last accepted increments over that of the first ones of their step.
    pub acceleration: f64,
    /// Figures of the certificate beyond their limits.
    pub doubts: Vec<Doubted>,
    /// How far an increment leapt, over the size of the model.
    pub leap: f64,
    /// Energy set free over all relaxations.
    pub jumps: usize,
}

/// Why an attempt failed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Fault {
    /// What of.
    pub kind: FailureKind,
    /// In words.
    pub reason: String,
    /// Size of the increment over its step.
    pub size: f64,
    /// Unbalanced forces over those in play at the end, and what was allowed.
    pub residual: f64,
    /// What was allowed.
    pub allowed: f64,
    /// Contact points that still changed their state.
    pub changes: usize,
}

/// A figure of the certificate beyond its limit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Doubted {
    /// Its name.
    pub figure: String,
    /// What the screen calls it.
    pub words: String,
    /// Its worst value and limit.
    pub value: f64,
    /// The limit.
    pub limit: f64,
    /// The step in which it was worst, from one.
    pub step: usize,
    /// Of what, where and when.
    pub place: String,
    /// What helps.
    pub remedy: String,
}

impl RunCourse {
    /// The kind of failure that ended the run.
    pub fn kind(&self) -> Option<FailureKind> {
        if let End::Failed(kind) = self.ended { Some(kind) } else { None }
    }
    /// Part of the failed attempts that are of a kind.
    pub fn share(&self, kinds: &[FailureKind]) -> f64 {
        let count = self.faults.iter().filter(|fault| kinds.contains(&fault.kind)).count();
        count as f64 / self.faults.len().max(1) as f64
    }
    /// The first fault of a kind.
    pub fn fault(&self, kinds: &[FailureKind]) -> Option<&Fault> {
        self.faults.iter().find(|fault| kinds.contains(&fault.kind))
    }
    /// Whether none of the contacts was ever seen to be closed; where no increment was accepted none was.
    pub fn never_closed(&self) -> bool {
        (self.increments == 0 || !self.closed.is_empty()) && self.closed.iter().all(|(_, closed)| !closed)
    }
    /// Whether a contact ever closed.
    pub fn closed(&self, name: &str) -> bool {
        self.closed.iter().any(|(other, closed)| other == name && *closed)
    }
    /// The doubt of a figure.
    pub fn doubt(&self, figures: &[&str]) -> Option<&Doubted> {
        self.doubts.iter().find(|doubt| figures.contains(&doubt.figure.as_str()))
    }
}
