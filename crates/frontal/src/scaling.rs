//! Equilibration: rows and columns scaled to largest values near one.

use crate::pattern::Pattern;

/// Sweeps over the matrix; each halves the distance, on a logarithmic scale, to largest values of one.
const SWEEPS: usize = 3;

/// Factors of rows and columns, powers of two so that scaling rounds nothing.
#[derive(Debug, Clone)]
pub struct Scaling {
    pub(crate) rows: Vec<f64>,
    pub(crate) columns: Vec<f64>,
    /// Largest values by row and column, reused from one factorisation to the next.
    row_norms: Vec<f64>,
    column_norms: Vec<f64>,
}

impl Scaling {
    /// That which brings the largest values of the rows and columns of a matrix close to one. Where this process has only some of the
    /// rows, the others empty, `largest` replaces each of some numbers by the largest of all processes.
    ///
    /// # Errors
    /// Those of `largest`.
    pub fn of<E>(
        pattern: &Pattern,
        values: &[f64],
        largest: impl FnMut(&mut [f64]) -> Result<(), E>,
    ) -> Result<Self, E> {
        let mut scaling = Self::identity(pattern.len());
        scaling.sweep(pattern, values, largest)?;
        Ok(scaling)
    }

    pub(crate) fn identity(n: usize) -> Self {
        Scaling { rows: vec![1.0; n], columns: vec![1.0; n], row_norms: vec![0.0; n], column_norms: vec![0.0; n] }
    }

    /// Ruiz's iteration in the largest-value norm (CERFACS report TR/PA/01/35, 2001).
    pub(crate) fn equilibrate(&mut self, pattern: &Pattern, values: &[f64]) {
        let Ok(()) = self.sweep(pattern, values, |_| Ok::<_, std::convert::Infallible>(()));
    }

    fn sweep<E>(
        &mut self,
        pattern: &Pattern,
        values: &[f64],
        mut largest: impl FnMut(&mut [f64]) -> Result<(), E>,
    ) -> Result<(), E> {
        self.rows.fill(1.0);
        self.columns.fill(1.0);
        for _ in 0..SWEEPS {
            self.measure(pattern, values);
            largest(&mut self.row_norms)?;
            largest(&mut self.column_norms)?;
            let moved = update(&mut self.rows, &self.row_norms) | update(&mut self.columns, &self.column_norms);
            // What one sweep leaves as it is, the next one would too.
            if !moved {
                break;
            }
        }
        Ok(())
    }

    /// Writes the scaled values and returns the largest of them.
    pub(crate) fn apply(&self, pattern: &Pattern, values: &[f64], scaled: &mut [f64]) -> f64 {
        let mut largest = 0.0;
        for (range, scale) in pattern.starts().windows(2).map(|w| w[0]..w[1]).zip(&self.rows) {
            let entries = values[range.clone()].iter().zip(&pattern.columns()[range.clone()]);
            for (scaled, (value, &column)) in scaled[range].iter_mut().zip(entries) {
                *scaled = scale * value * self.columns[column];
                largest = larger(largest, scaled.abs());
            }
        }
        largest
    }

    fn measure(&mut self, pattern: &Pattern, values: &[f64]) {
        self.column_norms.fill(0.0);
        let norms = &mut self.column_norms[..self.columns.len()];
        let rows = pattern.starts().windows(2).map(|w| w[0]..w[1]).zip(&self.rows);
        for ((range, scale), row_norm) in rows.zip(&mut self.row_norms) {
            *row_norm = 0.0;
            for (value, &column) in values[range.clone()].iter().zip(&pattern.columns()[range]) {
                let size = (scale * value * self.columns[column]).abs();
                *row_norm = larger(*row_norm, size);
                norms[column] = larger(norms[column], size);
            }
        }
    }
}

/// The larger of two numbers, of which neither is not a number: one instruction, which `f64::max` is not.
#[inline]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Divides by the square root of the norms, to the nearest power of two, and says whether any factor changed; an empty row
/// or column stays as it is.
fn update(factors: &mut [f64], norms: &[f64]) -> bool {
    let mut moved = false;
    for (factor, &norm) in factors.iter_mut().zip(norms) {
        if norm > 0.0 && norm.is_finite() {
            let part = inverse_root(norm);
            *factor *= part;
            moved |= part != 1.0;
        }
    }
    moved
}

/// The power of two nearest, on a logarithmic scale, to the inverse square root of a positive number: with
/// `2^e <= x < 2^(e + 1)` the whole number nearest to `-log2(x) / 2` is `-ceil(e / 2)`. A subnormal number counts as the
/// largest of them.
fn inverse_root(x: f64) -> f64 {
    const BIAS: i64 = 1023;
    let exponent = (x.to_bits() >> 52) as i64 - BIAS;
    let half = (exponent + 1) >> 1;
    f64::from_bits(((BIAS - half) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::inverse_root;

    #[test]
    fn inverse_roots_are_the_nearest_powers_of_two() {
        let mut x = 1.7e-300;
        while x < 1e300 {
            assert_eq!(inverse_root(x), (-0.5 * x.log2()).round().exp2(), "{x:e}");
            x *= 1.37;
        }
        assert_eq!([0.5, 1.0, 1.9, 4.0].map(inverse_root), [1.0, 1.0, 1.0, 0.5]);
        assert!(inverse_root(5e-324).is_finite());
    }
}
