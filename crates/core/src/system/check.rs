//! Perturbation: the paper's way to the tangent, and the independent check of the exact one.

use super::{Attempt, Branch, Local, Stencil};
use crate::Failure;

/// Angle by which a rotation is perturbed, in radians.
const ANGLE: f64 = 1e-6;

/// Appends the tangent of a stencil by central differences to `out`. Where a perturbed state cannot be evaluated, the
/// column stays zero; the evaluation that follows reports why.
pub(super) fn perturb(
    attempt: &dyn Attempt,
    index: usize,
    stencil: &Stencil,
    (step, is_rotation): (f64, &dyn Fn(usize) -> bool),
    local: &mut Local,
    out: &mut Vec<f64>,
) {
    let (n, begin) = (stencil.len, out.len());
    out.resize(begin + n * n, 0.0);
    let mut history = attempt.scratch(index);
    for column in 0..n {
        let h = if is_rotation(column) { ANGLE } else { step };
        let here = local.u[column];
        let mut sides = [(here + h, 1.0), (here - h, -1.0)].into_iter();
        let _ = sides.try_for_each(|(value, sign)| {
            local.u[column] = value;
            local.reset(n);
            attempt.evaluate(index, stencil, &mut history, local)?;
            for row in 0..n {
                out[begin + row * n + column] += sign * local.force[row] / (2.0 * h);
            }
            Ok::<(), Failure>(())
        });
        local.u[column] = here;
    }
}

/// Comparison of one stencil's exact tangent with Richardson-extrapolated central differences.
#[derive(Debug, Clone, PartialEq)]
pub struct TangentCheck {
    /// Branch at the state itself.
    pub branch: Branch,
    /// Whether all perturbed states lie on the same branch; if not, the error means nothing.
    pub smooth: bool,
    /// Largest difference of an entry over the largest entry, in scaled variables.
    pub error: f64,
}

/// Checks the exact tangent of a stencil at `u` (values of its unknowns). `scales` are the typical sizes of the
/// unknowns (a length, or one radian): unknowns are divided by them and forces multiplied, so that entries compare.
///
/// # Errors
/// A [`Failure`] when the state or a perturbed one cannot be evaluated.
pub fn check_tangent(
    attempt: &dyn Attempt,
    index: usize,
    stencil: &Stencil,
    u: &[f64],
    scales: &[f64],
) -> Result<TangentCheck, Failure> {
    let n = stencil.len;
    let mut history = attempt.scratch(index);
    let mut local = Local { wants_tangent: true, u: u.to_vec(), ..Local::default() };
    local.reset(n);
    let branch = attempt.evaluate(index, stencil, &mut history, &mut local)?;
    let exact = std::mem::take(&mut local.tangent);
    local.wants_tangent = false;
    let (mut error, mut largest, mut smooth) = (0.0_f64, f64::MIN_POSITIVE, true);
    for column in 0..n {
        let mut slope = |h: f64| -> Result<Vec<f64>, Failure> {
            let mut forces = [Vec::new(), Vec::new()];
            for (side, forces) in [h, -h].into_iter().zip(&mut forces) {
                local.u[column] = u[column] + side * scales[column];
                local.reset(n);
                smooth &= attempt.evaluate(index, stencil, &mut history, &mut local)? == branch;
                forces.clone_from(&local.force);
            }
            local.u[column] = u[column];
            Ok(forces[0].iter().zip(&forces[1]).map(|(a, b)| (a - b) / (2.0 * h)).collect())
        };
        let (coarse, fine) = (slope(2e-4)?, slope(1e-4)?);
        for row in 0..n {
            let difference = scales[row] * (4.0 * fine[row] - coarse[row]) / 3.0;
            let entry = scales[row] * exact[row * n + column] * scales[column];
            largest = largest.max(entry.abs());
            error = error.max((entry - difference).abs());
        }
    }
    Ok(TangentCheck { branch, smooth, error: error / largest })
}
