//! The path to a solution: how early iterations of an attempt are helped to find the set of closed points.
//!
//! A penalty is a spring that is there or is not. Newton's iterations converge at once when they know which are, and
//! find out one by one when they do not. So the first solutions keep the pattern in which the target was touched at
//! the accepted state (`Held`); where there is none, or it does not serve, softer penalties lead to one (`Led`). What
//! is accepted is found without help (`Free`). Nothing here knows what the terms enforce.

use crate::system::Aid;

/// Solutions with the expected pattern,
const HELD: usize = 2;
/// fewer where the unbalanced forces fall below this part of the forces in play.
const SETTLED: f64 = 1e-3;
/// Part of the penalties that leads,
const LEAD: f64 = 0.01;
/// and the residual below which the full ones take over,
const LED: f64 = 0.15;
/// once fewer points than this part of all change their status in an iteration,
const QUIET: f64 = 0.1;
/// or after so many iterations.
const PATIENCE: usize = 8;
/// A part of a step below which the line search says that the set of closed points is far from the solution's,
const SHORT: f64 = 0.2;
/// and how often an attempt heeds that.
const LEADS: usize = 2;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Stage {
    Held,
    Led,
    Free,
}

/// Where on its path an attempt is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Path {
    stage: Stage,
    leads: usize,
}

/// What an iteration has come to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Progress {
    /// Its number.
    pub iteration: usize,
    /// Largest unbalanced force over the forces in play.
    pub residual: f64,
    /// Part of the last step that the line search took.
    pub taken: f64,
    /// Part of all points whose status has changed over it.
    pub changed: f64,
    /// Whether the residual would be accepted.
    pub converged: bool,
}

impl Path {
    /// The path of an attempt: `helped` where a term can be and the user does not forbid it, `moved` where the state
    /// that it starts from has been reached by a motion that goes on.
    pub fn begin(helped: bool, moved: bool) -> Self {
        match (helped, moved) {
            (false, _) => Self { stage: Stage::Free, leads: LEADS },
            (true, false) => Self { stage: Stage::Led, leads: 1 },
            (true, true) => Self { stage: Stage::Held, leads: 0 },
        }
    }

    /// The help for the evaluations to come.
    pub fn aid(&self) -> Aid {
        match self.stage {
            Stage::Held => Aid { expects: true, ..Aid::NONE },
            Stage::Led => Aid { stiffness: LEAD, ..Aid::NONE },
            Stage::Free => Aid::NONE,
        }
    }

    /// Whether terms decide for themselves, with full penalties.
    pub fn is_free(&self) -> bool {
        self.stage == Stage::Free
    }

    /// Goes on to the next stage if it is time to, and returns the help with which the present state is to be
    /// evaluated anew for the next direction.
    pub fn advance(&mut self, at: &Progress) -> Option<Aid> {
        let from = self.stage;
        match from {
            Stage::Held if at.iteration > 0 && (at.residual < SETTLED || at.iteration >= HELD) => {
                self.stage = Stage::Free;
            }
            Stage::Led if at.residual < LED && (at.changed < QUIET || at.iteration >= PATIENCE) => {
                self.stage = Stage::Free;
            }
            Stage::Free if at.iteration > 0 && !at.converged && at.taken < SHORT && self.leads < LEADS => {
                (self.stage, self.leads) = (Stage::Led, self.leads + 1);
            }
            _ => return None,
        }
        // Full penalties times the penetrations of soft ones are forces that nothing has borne yet: in the matrix
        // they count as the soft ones do.
        Some(if from == Stage::Led { Aid { turning: LEAD, ..Aid::NONE } } else { self.aid() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(iteration: usize, residual: f64, taken: f64) -> Progress {
        Progress { iteration, residual, taken, changed: 0.0, converged: residual < 1e-6 }
    }

    #[test]
    fn first_attempts_are_led_and_then_free() {
        let mut path = Path::begin(true, false);
        assert_eq!(path.aid().stiffness, LEAD);
        assert_eq!(path.advance(&at(1, 0.5, 1.0)), None);
        assert_eq!(path.advance(&at(2, 0.1, 1.0)), Some(Aid { turning: LEAD, ..Aid::NONE }));
        assert!(path.is_free() && path.aid() == Aid::NONE);
    }

    #[test]
    fn later_ones_hold_the_pattern_and_are_led_where_it_does_not_serve() {
        let mut path = Path::begin(true, true);
        assert!(path.aid().expects);
        assert_eq!(path.advance(&at(0, 0.0, 0.0)), None);
        assert_eq!(path.advance(&at(1, 0.5, 1.0)), None);
        assert_eq!(path.advance(&at(2, 0.5, 1.0)), Some(Aid::NONE));
        assert_eq!(path.advance(&at(3, 0.5, 0.01)).map(|aid| aid.stiffness), Some(LEAD));
        assert!(path.advance(&at(4, 0.1, 1.0)).is_some());
        // Twice is enough.
        assert!(path.advance(&at(5, 0.5, 0.01)).is_some() && path.advance(&at(6, 0.1, 1.0)).is_some());
        assert_eq!(path.advance(&at(7, 0.5, 0.01)), None);
    }

    #[test]
    fn a_solution_is_not_led_away_from() {
        let mut path = Path::begin(true, true);
        assert_eq!(path.advance(&at(1, 1e-9, 1.0)), Some(Aid::NONE));
        assert_eq!(path.advance(&at(2, 1e-9, 0.01)), None);
        let mut alone = Path::begin(false, true);
        assert!(alone.is_free() && alone.advance(&at(3, 0.5, 0.01)).is_none());
    }
}
