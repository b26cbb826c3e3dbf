//! Increments that jump: snap-through and snap-back under loads or motions that are prescribed.
//!
//! Along a path whose forces rise or fall steadily, what terms take up lies between the work of the forces at the beginning of an
//! increment and at its end, `f0 . du` and `f1 . du`. Where they take up less than both, the forces have fallen below both on the
//! way: no equilibrium led there, and the difference is set free, as the energy of motion that a slow procedure does not see.

use super::constants::snaps::{DRIVEN, FREE};
use crate::system::State;

/// An increment that jumped.
#[derive(Debug, Clone, PartialEq)]
pub struct Snap {
    /// Time at its end.
    pub time: f64,
    /// Energy that was set free, at the least.
    pub energy: f64,
    /// The unknown that moved most, in words.
    pub largest: String,
}

/// Energy that an increment set free from the forces `before` it, where terms took up so much and heat supplied so much; zero where it
/// did not jump. The state is that after it.
pub(super) fn set_free(state: &State, before: &[f64], [taken, supplied]: [f64; 2]) -> f64 {
    let (mut works, mut size) = ([0.0; 2], supplied.abs());
    for ((change, f0), f1) in state.last_change.iter().zip(before).zip(&state.internal) {
        works[0] += f0 * change;
        works[1] += f1 * change;
        size += (f0 * change).abs().max((f1 * change).abs());
    }
    let free = works[0].min(works[1]) - taken;
    if free > FREE * size && size - supplied.abs() > DRIVEN * free { free } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_falls_below_both_ends_is_free() {
        let heated = |[f0, f1]: [f64; 2], moved: f64, taken: f64, supplied: f64| {
            let state = State { last_change: vec![moved], internal: vec![f1], ..State::default() };
            set_free(&state, &[f0], [taken, supplied])
        };
        let free = |forces: [f64; 2], moved: f64, taken: f64| heated(forces, moved, taken, 0.0);
        assert_eq!(free([0.0, 1.0], 2.0, 0.3), 0.0, "hardens");
        assert_eq!(free([1.0, 0.2], 2.0, 0.9), 0.0, "softens");
        assert_eq!(free([1.0, 0.5], -2.0, -1.4), 0.0, "unloads");
        assert_eq!(free([1.0, 1.01], 2.0, 1.2), 0.8, "snaps through");
        assert_eq!(free([1.0, 0.0], 0.25, -0.5), 0.5, "snaps back");
        assert_eq!(free([1.0, 0.1], 0.0, -0.5), 0.0, "nothing is driven");
        assert_eq!(heated([0.0, -0.1], 0.5, -0.2, 50.0), 0.0, "what heat supplies is known to the increment");
        assert_eq!(heated([1.0, 1.01], 2.0, 1.2, 1.0), 0.8, "snaps through while it is heated");
    }
}
