//! Plane stress: the stretch through the thickness is a local unknown of each point.
//!
//! It is found from `sigma_33 = 0` in plain numbers; its derivative follows from the implicit function theorem with
//! the exact gradient at the solution. The current thickness, as a ratio to the nominal one, is the last history value.

use super::point::{PointLaw, PointStress};
use crate::Failure;
use crate::material::{Directions, Gradient};
use crate::tensor::Tensor2;

const LIMIT: usize = 30;
/// Place of the normal among the components that vary.
const NORMAL: usize = 4;

/// Solves for f33 starting from `f`; returns the deformation with the stretch in it.
fn solve(law: &PointLaw, f: &Tensor2, old: &[f64], new: &mut [f64]) -> Result<Tensor2, Failure> {
    let (mut f, mut c) = (*f, Gradient::default());
    for _ in 0..LIMIT {
        let (seen, out) = (law.seen(&f), (&mut *new, &mut c));
        law.material.differentiate(&seen, law.lapse, old, out, Directions::PlaneAndNormal)?;
        let change = -new[2] / (c[2][4] * law.free);
        f[(2, 2)] += change.clamp(-0.5 * f[(2, 2)], f[(2, 2)]);
        if change.abs() <= 4.0 * f64::EPSILON {
            return Ok(f);
        }
    }
    Err(Failure::new("the stretch through the thickness was not found"))
}

/// Writes the thickness; the state of the law is already in `new`.
fn finish(law: &PointLaw, f: &Tensor2, old: &[f64], new: &mut [f64]) {
    let place = law.material.state_len();
    new[place] = law.strain.stretched(old[place], f[(2, 2)]);
}

/// New state, and in `s` `P` and `det f`.
pub fn stress<const D: usize>(
    law: &PointLaw,
    f: &Tensor2,
    old: &[f64],
    new: &mut [f64],
    s: &mut PointStress<D>,
) -> Result<(), Failure> {
    let f = solve(law, f, old, new)?;
    law.stress::<2, D>(&f, old, new, s)?;
    s.p[NORMAL] = 0.0;
    finish(law, &f, old, new);
    Ok(())
}

/// New state, and in `s` `P` and its derivatives with the thickness following.
pub fn stress_with_tangent<const D: usize>(
    law: &PointLaw,
    f: &Tensor2,
    old: &[f64],
    new: &mut [f64],
    s: &mut PointStress<D>,
) -> Result<(), Failure> {
    let f = solve(law, f, old, new)?;
    law.stress_with_tangent::<2, D>(&f, old, new, s)?;
    // P_33 is det(f) / f33 times sigma_33 = 0, so its row of the tangent is the condition's own derivative.
    let condition = s.tangent[NORMAL];
    for row in &mut s.tangent {
        let along_stretch = row[NORMAL];
        for (value, condition_d) in row.iter_mut().zip(condition) {
            *value -= along_stretch * condition_d / condition[NORMAL];
        }
    }
    s.p[NORMAL] = 0.0;
    finish(law, &f, old, new);
    Ok(())
}
