//! How an increment is made of implicit steps.
//!
//! With `B(y, h)` one backward-Euler step of the law over the fraction `h` of the increment:
//!
//! - backward Euler, `y1 = B(y0, h)`: order 1;
//! - midpoint with parameter `theta`: `y1 = B(y0 + (B(y0, theta h) - y0) / theta, 0)`, the generalised midpoint rule of
//!   Ortiz and Popov (1985) with the final return to the admissible states: order 2 at `theta = 1/2`;
//! - two-step: `y1 = B(y0 + (B(y0, g h) - y0) (1 - g) / g, g h)` with `g = 1 - 1/sqrt 2` (Alexander 1977; for
//!   plasticity Ellsiepen and Hartmann 2001): order 2, and the end of each sub-step fulfils the law.

use crate::Failure;

/// How one sub-step is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// One implicit step: order 1.
    BackwardEuler,
    /// The generalised midpoint rule with its parameter: order 2 at 1/2, backward Euler at 1.
    Midpoint(f64),
    /// Two implicit stages: order 2.
    TwoStep,
}

/// How an increment is integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update {
    /// How one sub-step is taken.
    pub scheme: Scheme,
    /// Number of equal sub-steps; the fewest where an error is to be kept.
    pub substeps: usize,
    /// Relative error of the state that each sub-step must keep; sub-steps are halved until they do, or until their
    /// local iteration converges. None: the sub-steps are as many as said.
    pub tolerance: Option<f64>,
}

impl Default for Update {
    fn default() -> Self {
        Self { scheme: Scheme::BackwardEuler, substeps: 1, tolerance: None }
    }
}

/// A state that schemes combine.
pub trait Blend: Copy {
    /// `self + (other - self) weight`.
    fn blend(&self, other: &Self, weight: f64) -> Self;
    /// The largest difference of two states, each part relative to its own size.
    fn distance(&self, other: &Self) -> f64;
}

/// Most times that a sub-step is halved.
const HALVINGS: i32 = 12;

impl Update {
    /// The state at the end of an increment that begins with `start`; `step(state, h)` takes one implicit step over
    /// the fraction `h` of the increment, and with `h = 0` returns to the admissible states.
    ///
    /// # Errors
    /// The failure of a step; with a tolerance, that of a sub-step that was halved too often.
    pub fn advance<S: Blend>(&self, start: S, step: impl Fn(&S, f64) -> Result<S, Failure>) -> Result<S, Failure> {
        let h = 1.0 / self.substeps as f64;
        match self.tolerance {
            None => (0..self.substeps).try_fold(start, |state, _| self.scheme.step(&state, h, &step)),
            Some(tolerance) => (0..self.substeps).try_fold(start, |s, _| self.controlled(s, h, tolerance, &step)),
        }
    }

    /// One sub-step, in as many parts as its error asks for. Sizes are halved and doubled only, so that the parts are
    /// the same for neighbouring strains and the derivative is that of the result.
    fn controlled<S: Blend>(
        &self,
        start: S,
        whole: f64,
        tolerance: f64,
        step: &impl Fn(&S, f64) -> Result<S, Failure>,
    ) -> Result<S, Failure> {
        let (mut state, mut done, mut size) = (start, 0_u32, 1_u32 << HALVINGS);
        let end = size;
        while done < end {
            let h = whole * f64::from(size) / f64::from(end);
            let tried = self.scheme.compared(&state, h, step);
            match tried {
                Ok((next, error)) if error <= tolerance => {
                    (state, done) = (next, done + size);
                    let room = done % (2 * size) == 0 && done + 2 * size <= end;
                    size = if error < 0.1 * tolerance && room { 2 * size } else { size.min(end - done) };
                }
                _ if size > 1 => size /= 2,
                Ok(_) => return Err(Failure::new("the law's sub-steps do not keep their error")),
                Err(failure) => return Err(failure),
            }
        }
        Ok(state)
    }
}

impl Scheme {
    fn step<S: Blend>(&self, from: &S, h: f64, step: &impl Fn(&S, f64) -> Result<S, Failure>) -> Result<S, Failure> {
        match *self {
            Self::BackwardEuler => step(from, h),
            Self::Midpoint(theta) => step(&from.blend(&step(from, theta * h)?, 1.0 / theta), 0.0),
            Self::TwoStep => {
                let g = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
                step(&from.blend(&step(from, g * h)?, (1.0 - g) / g), g * h)
            }
        }
    }

    /// Two half sub-steps, and how far a whole one is from them.
    fn compared<S: Blend>(
        &self,
        from: &S,
        h: f64,
        step: &impl Fn(&S, f64) -> Result<S, Failure>,
    ) -> Result<(S, f64), Failure> {
        let whole = self.step(from, h, step)?;
        let halves = self.step(&self.step(from, 0.5 * h, step)?, 0.5 * h, step)?;
        let error = whole.distance(&halves);
        if error.is_finite() { Ok((halves, error)) } else { Err(Failure::new("a sub-step of the law is not finite")) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Blend for f64 {
        fn blend(&self, other: &Self, weight: f64) -> Self {
            self + (other - self) * weight
        }
        fn distance(&self, other: &Self) -> f64 {
            (self - other).abs() / self.abs().max(other.abs())
        }
    }

    /// `y' = -y^2` from 1: `1 / (1 + t)`, here over t = 2.
    fn decay(update: Update) -> f64 {
        let euler = |y: &f64, h: f64| Ok(if h == 0.0 { *y } else { ((1.0 + 8.0 * h * y).sqrt() - 1.0) / (4.0 * h) });
        update.advance(1.0, euler).unwrap()
    }

    #[test]
    fn orders_are_those_of_the_schemes() {
        for (scheme, order) in [(Scheme::BackwardEuler, 1.0), (Scheme::Midpoint(0.5), 2.0), (Scheme::TwoStep, 2.0)] {
            let error = |substeps| (decay(Update { scheme, substeps, tolerance: None }) - 1.0 / 3.0).abs();
            let measured = (error(64) / error(128)).log2();
            assert!((measured - order).abs() < 0.05, "{scheme:?}: {measured}");
        }
    }

    #[test]
    fn a_tolerance_is_kept() {
        for tolerance in [1e-3, 1e-5] {
            let y = decay(Update { scheme: Scheme::TwoStep, substeps: 1, tolerance: Some(tolerance) });
            assert!((y * 3.0 - 1.0).abs() < 10.0 * tolerance, "{tolerance}: {y}");
        }
    }

    #[test]
    fn a_step_that_fails_is_halved_and_then_told() {
        let picky = |y: &f64, h: f64| if h > 0.1 { Err(Failure::new("too far")) } else { Ok(y + h) };
        let update = Update { tolerance: Some(1e-3), ..Update::default() };
        assert!((update.advance(0.0, picky).unwrap() - 1.0).abs() < 1e-14);
        let never = |_: &f64, _: f64| Err(Failure::new("never"));
        assert_eq!(update.advance(0.0, never).unwrap_err().reason, "never");
    }
}
