//! Linear solvers from outside the library: what provides one has every run use it.

use super::{Frontal, LinearSolver};
use crate::solve::Problem;
use std::sync::OnceLock;

/// What makes the linear solver of a run.
pub type Maker = fn(&Problem) -> Box<dyn LinearSolver>;

static MAKER: OnceLock<Maker> = OnceLock::new();

/// Has the runs to come solve their linear systems otherwise; the first maker stays.
pub fn provide(maker: Maker) {
    MAKER.get_or_init(|| maker);
}

/// Whether there is a maker.
pub fn provided() -> bool {
    MAKER.get().is_some()
}

/// The linear solver of a run: [`Frontal`] where nothing else is provided.
pub fn make(problem: &Problem) -> Box<dyn LinearSolver> {
    let own = || Box::new(Frontal::new(problem.newton.factors).within(problem.newton.memory)) as Box<dyn LinearSolver>;
    MAKER.get().map_or_else(own, |maker| maker(problem))
}
