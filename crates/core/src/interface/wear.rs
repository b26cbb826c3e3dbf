//! Archard's wear of a surface that recedes while it slips: `h = k p s` (J. Appl. Phys. 24, 1953).
//!
//! Over an increment that slips by `s` the law sees what the wear at its end leaves of the penetration, `u = v + k p(v) s`. Taken at
//! its beginning a surface that wears by more than it penetrates would lose touch, node by node, and the pressure go to and fro.

use super::{Interface, Linearised, Past, Status};
use crate::Failure;
use crate::declare::Variable;
use crate::integrate::Update;
use std::sync::Arc;

/// A law of a surface that recedes by its wear.
pub struct Wearing {
    /// The law.
    pub law: Arc<dyn Interface>,
    /// Depth for a unit of pressure times sliding.
    pub coefficient: f64,
}

/// Iterations for the penetration that wear leaves,
const ITERATIONS: usize = 60;
/// and the part of the whole that may be missing.
const SETTLED: f64 = 1e-13;

impl Interface for Wearing {
    fn variables(&self) -> &'static [Variable] {
        self.law.variables()
    }
    fn initial(&self, vars: &mut [f64]) {
        self.law.initial(vars);
    }
    fn release(&self, old: &[f64], new: &mut [f64]) {
        self.law.release(old, new);
    }
    fn touch(&self, past: &Past) -> f64 {
        self.law.touch(past)
    }
    fn keeps(&self, past: &Past) -> f64 {
        self.law.keeps(past)
    }
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64 {
        self.law.opens(past, slip)
    }
    fn respond(&self, [penetration, s, t]: [f64; 3], past: &Past, vars: &mut [f64]) -> Result<Linearised, Failure> {
        let (touch, mut left) = (self.touch(past), penetration);
        for _ in 0..ITERATIONS {
            let mut answer = self.law.respond([left, s, t], past, vars)?;
            let (pressure, slopes) = (answer.pressure(), answer.slopes);
            // What slips is the slip less the elastic change of the shear.
            let rest = [0, 1].map(|i| [s, t][i] - (answer.shear()[i] - past.shear[i]) / past.tangential_penalty);
            let slipped = if answer.status == Status::Slip { rest[0].hypot(rest[1]) } else { 0.0 };
            let along = rest.map(|rest| if slipped > 0.0 { rest / slipped } else { 0.0 });
            let lengthening = |k: usize| {
                let sheared = along[0] * slopes[1][k] + along[1] * slopes[2][k];
                [0.0, along[0], along[1]][k] - sheared / past.tangential_penalty
            };
            let rates = [0, 1, 2].map(|k| self.coefficient * (slopes[0][k] * slipped + pressure * lengthening(k)));
            let (excess, slope) = (left + self.coefficient * pressure * slipped - penetration, 1.0 + rates[0]);
            if excess.abs() <= SETTLED * (penetration - touch).abs() {
                for row in &mut answer.slopes {
                    row[0] /= slope;
                    (1..3).for_each(|k| row[k] -= row[0] * rates[k]);
                }
                answer.closure += self.coefficient * pressure * answer.slipped;
                return Ok(answer);
            }
            left = (left - excess / slope).max(0.5 * (left + touch));
        }
        Err(Failure::new("no penetration goes with the wear of the increment"))
    }
    fn stored(&self, pressure: f64, penalty: f64) -> f64 {
        self.law.stored(pressure, penalty)
    }
    fn is_compliant(&self) -> bool {
        self.law.is_compliant()
    }
    fn recession(&self) -> f64 {
        self.coefficient
    }
    fn radius(&self) -> f64 {
        self.law.radius()
    }
    fn sliding_stress(&self, pressure: f64) -> Option<f64> {
        self.law.sliding_stress(pressure)
    }
    fn with_update(&self, update: Update) -> Result<Box<dyn Interface>, String> {
        let law = Arc::from(self.law.with_update(update)?);
        Ok(Box::new(Self { law, coefficient: self.coefficient }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::Law;
    use crate::interface::laws::Coulomb;

    /// `p = K u / (1 + K k s)` with `s` the slip less what is elastic, and derivatives against central differences, for wear far beyond the
    /// penetration, sliding on, turned, across and stuck.
    #[test]
    fn wear_of_an_increment_counts_in_it() {
        let law = Wearing { law: Arc::new(Law(Coulomb::new(0.3))), coefficient: 0.1 };
        let past = Past {
            penalty: 1e3,
            tangential_penalty: 1e3,
            penetration: 0.01,
            pressure: 10.0,
            shear: [3.0, 0.0],
            vars: &[],
            dt: 1.0,
        };
        for motion in [[0.02, 0.5, 0.0], [0.02, -0.5, 0.0], [0.01, 0.3, 0.2], [0.02, 1e-4, 0.0]] {
            let answer = law.respond(motion, &past, &mut []).unwrap();
            let (pressure, slipped) = (answer.pressure(), answer.slipped);
            assert!((pressure * (1.0 / 1e3 + 0.1 * slipped) / motion[0] - 1.0).abs() < 2e-3, "{motion:?} {pressure}");
            assert!((answer.closure - 0.1 * pressure * slipped).abs() < 1e-15);
            for k in 0..3 {
                let at = |step: f64| {
                    let mut motion = motion;
                    motion[k] += step;
                    law.respond(motion, &past, &mut []).unwrap().stress
                };
                let (up, down) = (at(1e-7), at(-1e-7));
                for i in 0..3 {
                    let (slope, told) = ((up[i] - down[i]) / 2e-7, answer.slopes[i][k]);
                    assert!((slope - told).abs() < 1e-4 * slope.abs().max(10.0), "{motion:?} {i} {k}: {slope} {told}");
                }
            }
        }
    }
}
