//! When an iteration is good enough: unbalanced forces against a yardstick of the forces in play.
//!
//! The yardstick of a force is the largest sum of absolute stencil forces on any displacement, that of a moment the
//! same over the rotations of tools. Below it stands the rounding of the stiffest unknown over the size of the model,
//! so that a body that carries nothing converges too. All are ratios: a change of units changes nothing.

use crate::system::{Constraints, Dofs, Evaluation};

/// The unknown with the largest unbalanced force, in its own yardstick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Worst {
    /// The unknown.
    pub dof: usize,
    /// Its unbalanced force.
    pub force: f64,
}

/// Unbalanced forces against their yardsticks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Norms {
    /// Largest ratio of an unbalanced force or moment to its yardstick.
    pub ratio: f64,
    /// The largest ratio there may be: the tolerance, or rounding where that is larger.
    pub allowed: f64,
    /// The ratio that the rounding of positions leaves at the stiffest unknown.
    pub rounding: f64,
    /// Where the largest ratio is.
    pub worst: Worst,
    /// The yardsticks of force and moment.
    pub reference: [f64; 2],
    /// Force and moment in play, without what the tolerance adds to the yardsticks; zero where there is no more than what
    /// rounding makes.
    pub in_play: [f64; 2],
}

/// What the yardsticks are made of besides the evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Yardstick {
    /// Largest forces and moments of the past.
    pub past: [f64; 2],
    /// Largest diagonal entry of the matrix.
    pub stiffness: f64,
    /// Size of the model, a length.
    pub size: f64,
    /// Relative tolerance.
    pub tolerance: f64,
}

/// Part of the past yardstick that still counts: after unloading, equilibrium is asked to a tolerance of this.
const MEMORY: f64 = 1e-3;
/// Forces below this multiple of what rounding leaves at the stiffest unknown are no forces.
const NOTHING: f64 = 100.0;
/// By what factor an iteration makes unbalanced forces smaller that are not yet rounding.
const FALLING: f64 = 10.0;

impl Norms {
    /// Measures an evaluation whose unbalanced forces on the free unknowns are `residual`.
    pub fn measure(
        evaluation: &Evaluation,
        residual: &[f64],
        (dofs, constraints): (&Dofs, &Constraints),
        yardstick: &Yardstick,
    ) -> Self {
        let mut largest = [0.0_f64; 2];
        for (dof, &magnitude) in evaluation.magnitude.iter().enumerate() {
            let kind = usize::from(dofs.is_rotation(dof));
            largest[kind] = largest[kind].max(magnitude);
        }
        let rounding = 16.0 * f64::EPSILON * yardstick.stiffness * yardstick.size;
        let floor = [rounding, rounding * yardstick.size].map(|f| f / yardstick.tolerance);
        let scale = [0, 1].map(|k| largest[k].max(MEMORY * yardstick.past[k]).max(floor[k]));
        let nothing = [rounding, rounding * yardstick.size].map(|rounding| NOTHING * rounding);
        let in_play = [0, 1].map(|k| if largest[k] > nothing[k] { largest[k] } else { 0.0 });
        let mut norms = Self { rounding: rounding / scale[0], reference: scale, in_play, ..Self::default() };
        norms.allowed = yardstick.tolerance;
        for (&dof, &force) in constraints.free().iter().zip(residual) {
            let scale = scale[usize::from(dofs.is_rotation(dof))];
            let ratio = if force == 0.0 { 0.0 } else { force.abs() / scale };
            if ratio > norms.ratio || ratio.is_nan() {
                (norms.ratio, norms.worst) = (ratio, Worst { dof, force });
            }
        }
        norms
    }

    /// Whether it is good enough.
    pub fn converged(&self) -> bool {
        self.ratio <= self.allowed
    }

    /// The same after an iteration that began with the ratio `before`, zero if there was none: unbalanced forces below
    /// what rounding may leave are not rounding yet as long as iterations make them much smaller.
    pub fn converged_from(&self, before: f64) -> bool {
        let falling = self.ratio > 0.0 && before > FALLING * self.ratio;
        self.converged() && !(falling && self.rounding >= self.allowed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_still_falls_is_not_rounding() {
        let norms = |ratio, rounding| Norms { ratio, rounding, allowed: 1e-13, ..Norms::default() };
        assert!(!norms(0.9e-13, 1e-13).converged_from(1e-8), "rounding's bound, but on the way down");
        assert!(norms(0.9e-13, 1e-13).converged_from(5e-13) && norms(0.9e-13, 1e-13).converged_from(0.0));
        assert!(norms(0.9e-13, 0.5e-13).converged_from(1e-8), "the tolerance itself is met");
        assert!(norms(0.0, 1e-13).converged_from(1e-8) && !norms(2e-13, 1e-13).converged_from(2e-13));
    }
}
