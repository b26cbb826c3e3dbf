//! The stresses with which the tangents of stencils that bend turn and move.
//!
//! A penalty makes a large stress of a small error in position, and with it the tangent holds what turning and moving it
//! would do: a step then leads astray, the farther the stiffer the penalty. In a mixed method the stress is an unknown of
//! its own which follows the linear step, and that one turns and moves. The step is the same but for it, and at the
//! solution both stresses are, so that the order stays (Magisano, Leonetti & Garcea, Comput. Methods Appl. Mech. Engrg.
//! 313, 2017).

use crate::Failure;
use crate::system::{Assembly, Coordinates, Kinks, Workspace};

/// Stresses of all stencils that bend, and where a step leads them.
#[derive(Debug, Default)]
pub(in crate::solve) struct MipStress {
    acting: Vec<Vec<Coordinates>>,
    aims: Vec<Aim>,
}

/// The stress of a stencil over a step.
#[derive(Debug)]
struct Aim {
    term: usize,
    stencil: usize,
    from: Coordinates,
    to: Coordinates,
}

impl MipStress {
    /// Begins an attempt with the stresses of the accepted state.
    pub fn begin(&mut self, assembly: &Assembly, workspace: &Workspace) {
        let terms = assembly.terms.iter().zip(&assembly.attempts).enumerate();
        let before = terms.map(|(number, (term, attempt))| match term.bends() {
            true => (0..workspace.stencils(number)).map(|stencil| attempt.before(stencil)).collect(),
            false => Vec::new(),
        });
        self.acting = before.collect();
        self.aims.clear();
    }

    /// Takes up where a step of all unknowns leads.
    ///
    /// # Errors
    /// When a law cannot answer.
    pub fn aim(&mut self, assembly: &Assembly, kinks: &Kinks, du: &[f64]) -> Result<(), Failure> {
        self.aims.clear();
        for kink in kinks.list() {
            let (term, stencil, change) = (kink.term, kink.stencil, kinks.along(kink, du));
            let y = std::array::from_fn(|c| kink.y[c] + change[c]);
            let to = assembly.attempts[term].answer(stencil, &y)?.stress;
            self.aims.push(Aim { term, stencil, from: self.acting[term][stencil], to });
        }
        Ok(())
    }

    /// Goes a part of the step.
    pub fn follow(&mut self, part: f64) {
        for Aim { term, stencil, from, to } in &self.aims {
            self.acting[*term][*stencil] = std::array::from_fn(|c| from[c] + part * (to[c] - from[c]));
        }
    }

    /// The stresses, term by term.
    pub fn acting(&self) -> &[Vec<Coordinates>] {
        &self.acting
    }
}
