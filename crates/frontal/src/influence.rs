//! Some entries of the inverse: what loads on a few unknowns do at a few others.

use crate::error::Error;
use crate::factor::Factor;
use crate::pattern::check_length;
use crate::together::Together;

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
        let position = &self.symbolic.tree.position;
        let to: Vec<u32> = at.iter().map(|&unknown| position[unknown]).collect();
        let mut vectors = Together::with_room_for(self, TOGETHER.min(loads.len()));
        for (loads, x) in loads.chunks(TOGETHER).zip(x.chunks_mut(TOGETHER * at.len())) {
            vectors.clear(self, loads.len());
            let from = self.scatter(loads, &mut vectors);
            self.substitute_between(&from, &to, &mut vectors);
            for (place, (&unknown, &position)) in at.iter().zip(&to).enumerate() {
                let scale = self.scaling.columns[unknown];
                for (x, value) in x.chunks_exact_mut(at.len()).zip(vectors.row(position)) {
                    x[place] = *value * scale;
                }
            }
        }
        Ok(())
    }

    /// Adds the scaled loads to vectors in elimination order and returns the positions that are loaded.
    fn scatter(&self, loads: &[Vec<(usize, f64)>], vectors: &mut Together) -> Vec<u32> {
        let mut loaded = Vec::new();
        for (k, load) in loads.iter().enumerate() {
            for &(unknown, value) in load {
                let position = self.symbolic.tree.position[unknown];
                vectors.row(position)[k] += value * self.scaling.rows[unknown];
                loaded.push(position);
            }
        }
        loaded
    }
}
