//! Some entries of the inverse: what loads on a few unknowns do at a few others.

use crate::error::Error;
use crate::factor::Factor;
use crate::pattern::check_length;
use crate::solve::Workspace;

/// Loads substituted together.
const TOGETHER: usize = 32;

impl Factor {
    /// Solves `A x = b` for many sparse `b`, each given by unknowns and values that are added, and writes the `x` at the
    /// unknowns `at`, load after load. Not refined: the accuracy is that of the factor, perturbed pivots included. Only
    /// fronts between loads, unknowns wanted and the root of the tree are visited.
    ///
    /// # Errors
    /// [`Error::NotFactorised`]; [`Error::WrongLength`] unless `x` holds one number for each load and unknown wanted.
    ///
    /// # Panics
    /// If there is no such unknown.
    pub fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<(), Error> {
        self.check_ready()?;
        check_length("x", loads.len() * at.len(), x.len())?;
        if x.is_empty() {
            return Ok(());
        }
        let to: Vec<u32> = at.iter().map(|&unknown| self.symbolic.tree.position[unknown]).collect();
        let mut work = Workspace::with_room_for(self, TOGETHER.min(loads.len()));
        for (loads, x) in loads.chunks(TOGETHER).zip(x.chunks_mut(TOGETHER * at.len())) {
            let from = self.scatter(loads, work.vectors());
            self.substitute_between(&from, &to, &mut work);
            let vectors = work.vectors().chunks_exact(self.symbolic.pattern.len());
            for (x, vector) in x.chunks_exact_mut(at.len()).zip(vectors) {
                for ((x, &unknown), &position) in x.iter_mut().zip(at).zip(&to) {
                    *x = vector[position as usize] * self.scaling.columns[unknown];
                }
            }
        }
        Ok(())
    }

    /// Sets the vectors to the scaled loads in elimination order and returns the positions that are loaded.
    fn scatter(&self, loads: &[Vec<(usize, f64)>], vectors: &mut [f64]) -> Vec<u32> {
        vectors.fill(0.0);
        let mut loaded = Vec::new();
        for (load, vector) in loads.iter().zip(vectors.chunks_exact_mut(self.symbolic.pattern.len())) {
            for &(unknown, value) in load {
                let position = self.symbolic.tree.position[unknown];
                vector[position as usize] += value * self.scaling.rows[unknown];
                loaded.push(position);
            }
        }
        loaded
    }
}
