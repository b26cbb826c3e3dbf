//! Condition and growth, on demand.

use crate::error::FrontalError;
use crate::factor::Factor;
use crate::krylov::multiply;
use crate::solve::Workspace;

/// Steps of the estimator; two are nearly always enough.
const STEPS: usize = 5;

impl Factor {
    /// Lower bound, nearly always within a factor of three, of the condition number of the equilibrated matrix in the
    /// 1-norm (Hager, SIAM J. Sci. Stat. Comput. 5, 1984; Higham, ACM TOMS 14, 1988). It costs a few solutions.
    ///
    /// # Errors
    /// [`FrontalError::NotFactorised`].
    pub fn condition(&self) -> Result<f64, FrontalError> {
        self.check_ready()?;
        let (pattern, n) = (&self.symbolic.pattern, self.symbolic.pattern.len());
        let mut column_sums = vec![0.0; n];
        for row in 0..n {
            pattern.entries(row).for_each(|(at, column)| column_sums[column] += self.values[at].abs());
        }
        let norm = column_sums.into_iter().fold(0.0, f64::max);
        Ok(norm * self.inverse_norm(n))
    }

    /// Ascends `|A^-1 x|_1` over the corners of the 1-norm's unit ball.
    fn inverse_norm(&self, n: usize) -> f64 {
        let mut work = Workspace::new(self);
        let mut x = vec![1.0 / n.max(1) as f64; n];
        let mut corner = usize::MAX;
        let mut best = 0.0;
        for _ in 0..STEPS {
            self.substitute(&mut x, &mut work);
            let size = x.iter().map(|x| x.abs()).sum::<f64>();
            if size <= best || size.is_nan() {
                break;
            }
            best = size;
            x.iter_mut().for_each(|x| *x = 1f64.copysign(*x));
            self.substitute_transposed(&mut x, &mut work);
            let next = (0..n).max_by(|&i, &j| x[i].abs().total_cmp(&x[j].abs())).unwrap_or(0);
            if next == corner {
                break;
            }
            corner = next;
            x.fill(0.0);
            x[corner] = 1.0;
        }
        best
    }

    /// Largest entry of U over the largest entry of the equilibrated matrix: how much accuracy the elimination may
    /// have lost. Without trouble it is of the order of one.
    ///
    /// # Errors
    /// [`FrontalError::NotFactorised`].
    pub fn growth(&self) -> Result<f64, FrontalError> {
        self.check_ready()?;
        let largest = |values: &[f64]| values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
        let mut most = 0.0_f64;
        let halves = self.halves();
        for front in &self.symbolic.tree.fronts {
            let panels = halves.panels(front);
            most = most.max(largest(panels.right));
            for k in 0..front.pivots {
                let size = match front.symmetric {
                    true => panels.column_below(k)[0].abs() * largest(&panels.column_below(k)[1..]).max(1.0),
                    false => largest(&panels.left[front.size() * k..][..=k]),
                };
                most = most.max(size);
            }
        }
        Ok(most / largest(&self.values).max(f64::MIN_POSITIVE))
    }

    /// The equilibrated matrix times `x`.
    pub(crate) fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        multiply(&self.symbolic.pattern, &self.values, x, &mut y);
        y
    }

    /// `|A| |x|` for the equilibrated matrix.
    pub(crate) fn sizes(&self, x: &[f64]) -> Vec<f64> {
        let row = |row: usize| {
            let entries = self.symbolic.pattern.entries(row);
            entries.map(|(at, column)| (self.values[at] * x[column]).abs()).sum()
        };
        (0..x.len()).map(row).collect()
    }
}
