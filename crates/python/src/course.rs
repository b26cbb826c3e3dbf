//! A run and the model it reads, held together.

use asperity::Error;
use asperity::deck::Made;
use asperity::output::{Begun, Ended, Job, Simulation};
use asperity::system::State;
use self_cell::self_cell;
use std::sync::Arc;

type Going<'m> = Box<Simulation<'m>>;

self_cell!(
    /// A run with its model.
    pub struct Course {
        owner: Arc<Made>,
        #[covariant]
        dependent: Going,
    }
);

/// Why there is nothing to run.
pub enum Nothing {
    /// The run has come to its end.
    Ended(Box<Ended>),
    /// It cannot begin.
    Error(Error),
}

impl Course {
    /// A run whose results are written.
    pub fn recorded(made: Arc<Made>, job: &Job) -> Result<Self, Nothing> {
        Self::try_new(made, |made| match Simulation::begin(&made.model, job) {
            Ok(Begun::Going(simulation)) => Ok(simulation),
            Ok(Begun::Ended(ended)) => Err(Nothing::Ended(ended)),
            Err(error) => Err(Nothing::Error(error)),
        })
    }
    /// A run of which nothing is written.
    pub fn in_memory(made: Arc<Made>, state: State, notes: &[String]) -> Result<Self, Nothing> {
        Self::try_new(made, |made| {
            let simulation = Simulation::in_memory(&made.model, state, &made.deck.limits.limits, notes);
            simulation.map(Box::new).map_err(Nothing::Error)
        })
    }
}
