//! Some entries of the inverse: what loads on a few unknowns do at a few others.

use crate::error::FrontalError;
use crate::factor::Factor;
use crate::pattern::check_length;
use crate::solve::Halves;
use crate::together::Together;
use crate::vector::Number;

/// Loads substituted together, a multiple of so many with zeros: products of matrices treat a vector alone in another way,
/// and their digits would show how many there were.
const TOGETHER: usize = 64;
const EVEN: usize = 8;

impl Factor {
    /// Solves `A x = b` for many sparse `b`, each given by unknowns and values that are added, and writes the `x` at the
    /// unknowns `at`, load after load. Not refined: the accuracy is that of the factor, perturbed pivots included. Only
    /// fronts between loads, unknowns wanted and the root of the tree are visited.
    ///
    /// # Errors
    /// [`FrontalError::NotFactorised`]; [`FrontalError::WrongLength`] unless `x` holds one number for each load and unknown wanted.
    ///
    /// # Panics
    /// If there is no such unknown.
    pub fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<(), FrontalError> {
        self.check_ready()?;
        self.halves().influence(loads, at, x)
    }
}

impl<T: Number> Halves<'_, T> {
    /// [`Factor::influence`] by factors in this precision.
    pub(crate) fn influence(
        &self,
        loads: &[Vec<(usize, f64)>],
        at: &[usize],
        x: &mut [f64],
    ) -> Result<(), FrontalError> {
        check_length("x", loads.len() * at.len(), x.len())?;
        if x.is_empty() {
            return Ok(());
        }
        let Factor { symbolic, scaling, .. } = self.factor;
        let position = &symbolic.tree.position;
        let to: Vec<u32> = at.iter().map(|&unknown| position[unknown]).collect();
        let mut vectors = Together::with_room_for(self.factor, TOGETHER.min(loads.len().next_multiple_of(EVEN)));
        for (loads, x) in loads.chunks(TOGETHER).zip(x.chunks_mut(TOGETHER * at.len())) {
            vectors.clear(self.factor, loads.len().next_multiple_of(EVEN));
            let from = self.scatter(loads, &mut vectors);
            self.substitute_between(&from, &to, &mut vectors);
            for (place, (&unknown, &position)) in at.iter().zip(&to).enumerate() {
                let scale = scaling.columns[unknown];
                for (x, value) in x.chunks_exact_mut(at.len()).zip(vectors.row(position)) {
                    x[place] = scale * (*value).into();
                }
            }
        }
        Ok(())
    }

    /// Adds the scaled loads to vectors in elimination order and returns the positions that are loaded.
    fn scatter(&self, loads: &[Vec<(usize, f64)>], vectors: &mut Together<T>) -> Vec<u32> {
        let mut loaded = Vec::new();
        for (k, load) in loads.iter().enumerate() {
            for &(unknown, value) in load {
                let position = self.factor.symbolic.tree.position[unknown];
                vectors.row(position)[k] += T::round(value * self.factor.scaling.rows[unknown]);
                loaded.push(position);
            }
        }
        loaded
    }
}
