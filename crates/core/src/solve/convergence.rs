//! When an iteration is good enough: unbalanced forces against a yardstick of the forces in play.
//!
//! The yardstick of a force is the largest sum of absolute stencil forces on any displacement, that of a moment the
//! same over the rotations of tools. Below it stands what the rounding of positions leaves of each equation, its largest
//! coefficient times the size of the model (Oettli & Prager, Numer. Math. 6, 1964), so that a body that carries nothing
//! converges too; one of all equations together would let a stiff corner hide the forces of a soft contact. What is left on
//! a part that hangs together is asked for as a whole too, against half of the force that goes through it: many small forces of
//! one sign are no equilibrium, and a reaction misses the loads by their sum. One iteration more mends that. All are ratios: a
//! change of units changes nothing.

use super::constants::convergence::{FALLING, MEMORY, NOTHING};
use crate::system::{Constraints, Dofs, Evaluation, Row, Whole};

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
    /// Largest ratio of the sum of unbalanced forces on a whole, along an axis, to its yardstick.
    pub whole: f64,
    /// The largest ratio there may be: the tolerance, or rounding where that is larger.
    pub allowed: f64,
    /// The ratio that the rounding of positions leaves where the largest is.
    pub rounding: f64,
    /// Where the largest ratio is.
    pub worst: Worst,
    /// Largest displacement that the unbalanced force of an equation makes against its own stiffness alone.
    pub local: f64,
    /// The yardsticks of force and moment.
    pub reference: [f64; 2],
    /// Force and moment in play, without what the tolerance adds to the yardsticks; zero where there is no more than what
    /// rounding makes.
    pub in_play: [f64; 2],
}

/// What the yardsticks are made of besides the evaluation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResidualScale<'a> {
    /// Largest forces and moments of the past.
    pub past: [f64; 2],
    /// Largest coefficient of a displacement in each equation; empty before there is a matrix.
    pub coefficients: &'a [f64],
    /// Size of the model, a length.
    pub size: f64,
    /// Relative tolerance.
    pub tolerance: f64,
}

impl Norms {
    /// Measures an evaluation whose unbalanced forces on the free unknowns are `residual`.
    pub fn measure(
        evaluation: &Evaluation,
        residual: &[f64],
        (dofs, constraints, wholes): (&Dofs, &Constraints, &[Whole]),
        yardstick: &ResidualScale,
    ) -> Self {
        let mut largest = [0.0_f64; 2];
        for (dof, &magnitude) in evaluation.magnitude.iter().enumerate() {
            let kind = usize::from(dofs.is_rotation(dof));
            largest[kind] = largest[kind].max(magnitude);
        }
        let coefficient = |row: usize| yardstick.coefficients.get(row).copied().unwrap_or(0.0);
        let rounding = |row: usize| 16.0 * f64::EPSILON * coefficient(row) * yardstick.size;
        let scale = [0, 1].map(|k| largest[k].max(MEMORY * yardstick.past[k]));
        let mut norms = Self { allowed: yardstick.tolerance, ..Self::default() };
        for (row, (&dof, &force)) in constraints.free().iter().zip(residual).enumerate() {
            let (kind, rounding) = (usize::from(dofs.is_rotation(dof)), rounding(row));
            let scale = scale[kind].max(rounding / yardstick.tolerance);
            norms.reference[kind] = norms.reference[kind].max(scale);
            if evaluation.magnitude[dof] > NOTHING * rounding {
                norms.in_play[kind] = largest[kind];
            }
            if kind == 0 && force.abs() > rounding && coefficient(row) > 0.0 {
                norms.local = norms.local.max(force.abs() / coefficient(row));
            }
            let ratio = if force == 0.0 { 0.0 } else { force.abs() / scale };
            if ratio > norms.ratio || ratio.is_nan() {
                (norms.ratio, norms.worst, norms.rounding) = (ratio, Worst { dof, force }, rounding / scale);
            }
        }
        for whole in wholes {
            let (mut sums, mut roundings, mut largest) = ([0.0_f64; 3], [0.0_f64; 3], MEMORY * scale[0]);
            let (mut forces, axes) = ([0.0_f64; 3], dofs.per_node());
            for (axis, dof) in whole.nodes().flat_map(|node| (dofs.node(node)..).take(axes).enumerate()) {
                largest = largest.max(evaluation.magnitude[dof]);
                forces[axis] += evaluation.magnitude[dof];
                if let Row::Free(row) = constraints.row(dof) {
                    sums[axis] += residual[*row];
                    roundings[axis] += rounding(*row);
                }
            }
            // The nodes of a layer bear the force through it from both sides: half of its mean over about so many layers.
            let layers = (whole.nodes().count() as f64).powf((axes as f64).recip());
            for ((sum, rounding), force) in sums.iter().zip(roundings).zip(forces).filter(|((sum, _), _)| **sum != 0.0)
            {
                let through = largest.max(force / (4.0 * layers));
                norms.whole = norms.whole.max(sum.abs() / through.max(rounding / yardstick.tolerance));
            }
        }
        norms
    }

    /// Whether each force is good enough.
    pub fn converged(&self) -> bool {
        self.ratio <= self.allowed
    }

    /// Whether it is good enough after an iteration that began with the ratio `before`, zero if there was none. Where each force
    /// was small enough then, what is left on a whole is what jumps of the forces leave. Unbalanced forces below what rounding may
    /// leave are not rounding yet as long as iterations make them much smaller.
    pub fn converged_from(&self, before: f64) -> bool {
        let falling = self.ratio > 0.0 && before > FALLING * self.ratio;
        let balanced = self.whole <= self.allowed || (0.0 < before && before <= self.allowed);
        self.converged() && balanced && !(falling && self.rounding >= self.allowed)
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

    #[test]
    fn a_whole_out_of_balance_takes_one_iteration_more() {
        let norms = Norms { ratio: 5e-7, whole: 5e-6, allowed: 1e-6, ..Norms::default() };
        assert!(!norms.converged_from(0.0) && !norms.converged_from(1e-3) && norms.converged_from(9e-7));
        assert!(Norms { whole: 9e-7, ..norms }.converged_from(1e-3));
    }
}
