//! A full matrix of moderate size, factorised by the kernels of the fronts.

use crate::dense::{Panel, Pivot, PivotRule};
use crate::panels::{Panels, backward_transposed, forward_transposed};
use pulp::Arch;

/// A full matrix `A`, factorised with partial pivoting. What is stored is `P A^T = L U`: the rows of `A` are the columns
/// of the kernels.
///
/// ```
/// let matrix = frontal::Full::factorise(2, vec![0.0, 2.0, 3.0, 1.0]).expect("a regular matrix");
/// let mut x = [4.0, 5.0];
/// matrix.solve(&mut x);
/// assert_eq!(x, [1.0, 2.0]);
/// assert!(frontal::Full::factorise(2, vec![1.0, 2.0, 2.0, 4.0]).is_none());
/// ```
#[derive(Debug, Clone)]
pub struct Full {
    factors: Vec<f64>,
    pivots: Vec<Pivot>,
}

impl Full {
    /// Factorises the `n` x `n` matrix given by rows. `None` if it is singular in the arithmetic, or not finite.
    ///
    /// # Panics
    /// Unless there are `n` rows of `n` entries.
    pub fn factorise(n: usize, mut rows: Vec<f64>) -> Option<Self> {
        assert_eq!(rows.len(), n * n, "a matrix of {n} rows");
        let mut pivots = vec![Pivot::default(); n];
        let rule = PivotRule { smallest: 0.0, replacement: 1.0 };
        let mut panel = Panel { left: &mut rows, m: n, p: n, rule, symmetric: false, parallel: false };
        panel.factorise(0..n, &mut pivots);
        let regular = pivots.iter().all(|pivot| !pivot.perturbed) && rows.iter().all(|x| x.is_finite());
        regular.then_some(Full { factors: rows, pivots })
    }

    /// `x <- A^-1 x`.
    ///
    /// # Panics
    /// Unless `x` holds one number for each row.
    pub fn solve(&self, x: &mut [f64]) {
        let n = self.pivots.len();
        assert_eq!(x.len(), n, "a vector for {n} rows");
        let panels = Panels { left: &self.factors, right: &[], pivots: &self.pivots, m: n, p: n, symmetric: false };
        Arch::new().dispatch(
            #[inline(always)]
            || {
                forward_transposed(&panels, x);
                backward_transposed(&panels, x);
            },
        );
    }
}
