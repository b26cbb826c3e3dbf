//! `increments.csv`, a row an attempt, and `iterations.csv`, a row an iteration: what the solver did, with the user's
//! names. Both hold results only, no times of the clock, so that two runs may be compared.

use super::table::{Field, Table};
use asperity_core::Error;
use asperity_core::solve::{AttemptRecord, IterationRecord, Problem};
use std::path::Path;

const INCREMENTS: &[&str] = &[
    "step",
    "increment",
    "attempt",
    "time",
    "step_time",
    "dt",
    "iterations",
    "augmentations",
    "residual",
    "changes",
    "open",
    "stick",
    "slip",
    "order",
    "residual_order",
    "accepted",
    "reason",
];
const ITERATIONS: &[&str] = &[
    "step",
    "increment",
    "attempt",
    "iteration",
    "augmentation",
    "residual",
    "tolerance",
    "rounding",
    "correction",
    "line_search",
    "factorised",
    "open",
    "stick",
    "slip",
    "changes",
    "changed",
    "worst",
    "worst_force",
];

/// The two tables.
#[derive(Debug)]
pub struct RunLog {
    increments: Table,
    iterations: Table,
}

impl RunLog {
    /// Begins both tables.
    ///
    /// # Errors
    /// [`Error::File`] when they cannot be written.
    pub fn create(directory: &Path) -> Result<Self, Error> {
        let increments = Table::create(&directory.join("increments.csv"), INCREMENTS)?;
        Ok(Self { increments, iterations: Table::create(&directory.join("iterations.csv"), ITERATIONS)? })
    }
    /// Continues both after a restart from an increment; later rows are dropped.
    ///
    /// # Errors
    /// [`Error::File`] when the old tables cannot be read or rewritten.
    pub fn resume(directory: &Path, increment: usize) -> Result<Self, Error> {
        if !directory.join("increments.csv").exists() || !directory.join("iterations.csv").exists() {
            return Self::create(directory);
        }
        let table = |name: &str| {
            Table::resume(&directory.join(name), |columns, row| {
                let at = columns.position("increment").and_then(|i| row[i].parse::<usize>().ok());
                at.is_some_and(|at| at <= increment)
            })
        };
        Ok(Self { increments: table("increments.csv")?, iterations: table("iterations.csv")? })
    }
    /// Adds an iteration, as it happens.
    ///
    /// # Errors
    /// [`Error::File`] when the row cannot be written.
    pub fn iteration(
        &mut self,
        problem: &Problem,
        record: &AttemptRecord,
        iteration: &IterationRecord,
    ) -> Result<(), Error> {
        self.iterations.push(&iteration_row(problem, record, iteration))
    }
    /// Adds an attempt, whose iterations are told.
    ///
    /// # Errors
    /// [`Error::File`] when the row cannot be written.
    pub fn attempt(&mut self, problem: &Problem, record: &AttemptRecord) -> Result<(), Error> {
        self.increments.push(&attempt_row(problem, record))
    }
}

/// Step, increment and attempt, counted from one.
fn leading(record: &AttemptRecord) -> [Field; 3] {
    [(record.step + 1).into(), record.increment.into(), record.attempt.into()]
}

fn attempt_row(problem: &Problem, record: &AttemptRecord) -> Vec<Field> {
    let last = record.iterations.last();
    let changes: usize = record.iterations.iter().map(|i| i.changes).sum();
    let times = [record.time.into(), record.step_time.into(), record.dt.into()];
    let solutions = [record.solutions(), record.augmentations()].map(Field::from);
    let solution = solutions.into_iter().chain([last.map(|i| i.residual).into(), changes.into()]);
    let end = [
        record.order().into(),
        record.residual_order().into(),
        usize::from(record.failure.is_none()).into(),
        record.failure.as_deref().into(),
    ];
    let branches = last.map_or([0; 3], |last| problem.points_by_status(last)).map(Field::from);
    leading(record).into_iter().chain(times).chain(solution).chain(branches).chain(end).collect()
}

fn iteration_row(problem: &Problem, record: &AttemptRecord, iteration: &IterationRecord) -> Vec<Field> {
    let changed = iteration.changed.and_then(|(term, stencil)| Some(problem.terms.get(term)?.name_of(stencil)));
    let numbers = [
        iteration.iteration.into(),
        iteration.augmentation.into(),
        iteration.residual.into(),
        iteration.tolerance.into(),
        iteration.rounding.into(),
        iteration.correction.into(),
        iteration.step.into(),
        usize::from(iteration.factorised).into(),
    ];
    let end = [
        iteration.changes.into(),
        changed.as_deref().into(),
        problem.name_of(iteration.worst.dof).as_str().into(),
        iteration.worst.force.into(),
    ];
    let branches = problem.points_by_status(iteration).map(Field::from);
    leading(record).into_iter().chain(numbers).chain(branches).chain(end).collect()
}
