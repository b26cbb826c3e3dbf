//! Equilibration: rows and columns scaled to largest values near one.

use crate::pattern::Pattern;

/// Sweeps over the matrix; each halves the distance, on a logarithmic scale, to largest values of one.
const SWEEPS: usize = 3;

/// Factors of rows and columns, powers of two so that scaling rounds nothing.
#[derive(Debug, Clone)]
pub(crate) struct Scaling {
    pub rows: Vec<f64>,
    pub columns: Vec<f64>,
    /// Largest values by row and column, reused from one factorisation to the next.
    row_norms: Vec<f64>,
    column_norms: Vec<f64>,
}

impl Scaling {
    pub fn identity(n: usize) -> Self {
        Scaling { rows: vec![1.0; n], columns: vec![1.0; n], row_norms: vec![0.0; n], column_norms: vec![0.0; n] }
    }

    /// Ruiz's iteration in the largest-value norm (CERFACS report TR/PA/01/35, 2001).
    pub fn equilibrate(&mut self, pattern: &Pattern, values: &[f64]) {
        self.rows.fill(1.0);
        self.columns.fill(1.0);
        for _ in 0..SWEEPS {
            self.measure(pattern, values);
            update(&mut self.rows, &self.row_norms);
            update(&mut self.columns, &self.column_norms);
        }
    }

    /// Writes the scaled values and returns the largest of them.
    pub fn apply(&self, pattern: &Pattern, values: &[f64], scaled: &mut [f64]) -> f64 {
        let mut largest = 0.0_f64;
        for row in 0..pattern.len() {
            for (at, column) in pattern.entries(row) {
                scaled[at] = self.rows[row] * values[at] * self.columns[column];
                largest = largest.max(scaled[at].abs());
            }
        }
        largest
    }

    fn measure(&mut self, pattern: &Pattern, values: &[f64]) {
        self.row_norms.fill(0.0);
        self.column_norms.fill(0.0);
        for row in 0..pattern.len() {
            let mut row_norm = 0.0_f64;
            for (at, column) in pattern.entries(row) {
                let size = (self.rows[row] * values[at] * self.columns[column]).abs();
                row_norm = row_norm.max(size);
                self.column_norms[column] = self.column_norms[column].max(size);
            }
            self.row_norms[row] = row_norm;
        }
    }
}

/// Divides by the square root of the norms, to the nearest power of two; an empty row or column stays as it is.
fn update(factors: &mut [f64], norms: &[f64]) {
    for (factor, &norm) in factors.iter_mut().zip(norms) {
        if norm > 0.0 && norm.is_finite() {
            *factor *= (-0.5 * norm.log2()).round().exp2();
        }
    }
}
