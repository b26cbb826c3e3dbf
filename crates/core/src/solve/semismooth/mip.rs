//! The stresses with which the tangents of stencils that bend turn and move.
//!
//! A penalty makes a large stress of a small error in position, and with it the tangent holds what turning and moving it
//! would do: a step then leads astray, the farther the stiffer the penalty. In a mixed method the stress is an unknown of
//! its own which follows the linear step, and that one turns and moves. The step is the same but for it, and at the
//! solution both stresses are, so that the order stays (Magisano, Leonetti & Garcea, Comput. Methods Appl. Mech. Engrg.
//! 313, 2017). The bulk modulus of a body is such a penalty too: a first guess misses the volume by the square of its strain. Where
//! cells share their change of volume its mean stress is that of the accepted state at the first guess and follows the step after it.

use crate::Failure;
use crate::system::{Assembly, Coordinates, Kinks, Origin, Workspace};

/// Stresses of all stencils that bend, and where a step leads them.
#[derive(Debug, Default)]
pub(in crate::solve) struct MipStress {
    acting: Vec<Vec<Coordinates>>,
    aims: Vec<Aim>,
    /// The unknowns where the step began; empty before the first.
    from: Vec<f64>,
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
        self.guess();
    }

    /// Begins anew with a first guess.
    pub fn guess(&mut self) {
        self.aims.clear();
        self.from.clear();
    }

    /// Takes up where a step `du` of all unknowns from `u` leads.
    ///
    /// # Errors
    /// When a law cannot answer.
    pub fn aim(&mut self, assembly: &Assembly, kinks: &Kinks, (u, du): (&[f64], &[f64])) -> Result<(), Failure> {
        self.aims.clear();
        self.from.clear();
        self.from.extend_from_slice(u);
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

    /// Where the step began, and the unknowns there.
    pub fn origin(&self) -> (Origin, &[f64]) {
        (if self.from.is_empty() { Origin::Accepted } else { Origin::Step }, &self.from)
    }
}
