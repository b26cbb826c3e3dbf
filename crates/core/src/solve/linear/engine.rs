//! Linear solvers from outside the library: what provides one has every run use it.

use super::{Frontal, LinearSolver};
use crate::solve::Problem;
use crate::system::Communicator;
use std::sync::OnceLock;

/// What makes the linear solver of a run.
pub type Maker = fn(&Problem) -> Box<dyn LinearSolver>;

/// The other ranks of a run, where there are any.
pub type Others = fn() -> Option<&'static dyn Communicator>;

static MAKER: OnceLock<(Maker, Others)> = OnceLock::new();

/// Has the runs to come solve their linear systems otherwise, and evaluate with other ranks; what comes first stays.
pub fn provide(maker: Maker, others: Others) {
    MAKER.get_or_init(|| (maker, others));
}

/// The other ranks of a run, where there are any.
pub fn others() -> Option<&'static dyn Communicator> {
    MAKER.get().and_then(|(_, others)| others())
}

/// Whether there is a maker.
pub fn provided() -> bool {
    MAKER.get().is_some()
}

/// The linear solver of a run: [`Frontal`] where nothing else is provided.
pub fn make(problem: &Problem) -> Box<dyn LinearSolver> {
    let own = || Box::new(Frontal::new(problem.newton.factors).within(problem.newton.memory)) as Box<dyn LinearSolver>;
    MAKER.get().map_or_else(own, |(maker, _)| maker(problem))
}
