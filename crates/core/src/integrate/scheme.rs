//! How an increment is made of implicit steps.
//!
//! With `B(y, h)` one backward-Euler step of the law over the fraction `h` of the increment:
//!
//! - backward Euler, `y1 = B(y0, h)`: order 1;
//! - midpoint with parameter `theta`: `y1 = B(y0 + (B(y0, theta h) - y0) / theta, 0)`, the generalised midpoint rule of
//!   Ortiz and Popov (1985) with the final return to the admissible states: order 2 at `theta = 1/2`;
//! - two-step: `y1 = B(y0 + (B(y0, g h) - y0) (1 - g) / g, g h)` with `g = 1 - 1/sqrt 2` (Alexander 1977; for
//!   plasticity Ellsiepen and Hartmann 2001): order 2, and the end of each sub-step fulfils the law;
//! - adaptive: two-step, halved again and again until each part is as near its halves as is said (local error per step, as for
//!   stiff equations: Hairer and Wanner 1996, IV.8). Between half of that error and all of it the halves and what is finer are blended, so
//!   that the end follows the strain without jumps, and its derivative with it.

use crate::Failure;
use crate::tensor::Scalar;

/// How one sub-step is taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scheme {
    /// One implicit step: order 1.
    BackwardEuler,
    /// The generalised midpoint rule with its parameter: order 2 at 1/2, backward Euler at 1.
    Midpoint(f64),
    /// Two implicit stages: order 2.
    TwoStep,
    /// Two-step over parts that are halved until each differs from its halves by this part of the state at most.
    Adaptive(f64),
}

/// How an increment is integrated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Update {
    /// How one sub-step is taken.
    pub scheme: Scheme,
    /// Number of equal sub-steps; the fewest where an error is to be kept.
    pub substeps: usize,
    /// Error of the state at the end of the increment, over its largest size on the way: sub-steps are halved until their
    /// errors together keep it, or until their local iteration converges. None: the sub-steps are as many as said.
    pub tolerance: Option<f64>,
}

impl Default for Update {
    fn default() -> Self {
        Self { scheme: Scheme::BackwardEuler, substeps: 1, tolerance: None }
    }
}

/// A state that schemes combine.
pub trait Blend: Copy {
    /// What it is made of.
    type Number: Scalar;
    /// `self + (other - self) weight`.
    fn blend(&self, other: &Self, weight: Self::Number) -> Self;
    /// The size of the difference of two states.
    fn distance(&self, other: &Self) -> Self::Number;
    /// The size of a state.
    fn size(&self) -> Self::Number;
}

/// Most times that a sub-step is halved.
const HALVINGS: u32 = 12;
/// Halvings before the first sub-step: one as long as the increment may agree with its halves by chance, as where all of
/// them have turned as far as they can.
const FIRST: u32 = 2;
/// Part of the tolerance that sub-steps share by their lengths; what is left over is for those at kinks.
const SHARED: f64 = 0.5;
/// Most times that the adaptive scheme halves: what of a creep by the twentieth power has relaxed nine tenths of its stress over an
/// increment has relaxed half of it in `10^-19` of that.
const DEEPEST: u32 = 64;
/// Most parts of an increment that the adaptive scheme looks at.
const PARTS: u32 = 4096;
/// Halvings after which a sub-step is taken to be at a kink, where halving gains no more than its length.
const AT_A_KINK: u32 = 6;

impl Update {
    /// What a law takes by itself whose one step is wrong by more than a few hundredths of the stress in increments as long as equilibrium
    /// allows.
    pub const ADAPTIVE: Self = Self { scheme: Scheme::Adaptive(1e-3), substeps: 1, tolerance: None };

    /// The same for a law that often has no answer, as where voids open, and would be asked for it in all of the halves in vain.
    pub const TWO_STEP: Self = Self { scheme: Scheme::TwoStep, substeps: 1, tolerance: None };

    /// The state at the end of an increment that begins with `start`; `step(state, h, end)` takes one implicit step over
    /// the fraction `h` of the increment to its fraction `end`, and with `h = 0` returns to the admissible states.
    ///
    /// # Errors
    /// The failure of a step; with a tolerance, that of a sub-step that was halved too often.
    pub fn advance<S: Blend>(&self, start: S, step: impl Fn(&S, f64, f64) -> Result<S, Failure>) -> Result<S, Failure> {
        let h = 1.0 / self.substeps as f64;
        match self.tolerance {
            None => (0..self.substeps)
                .try_fold(start, |state, number| self.scheme.step(&state, [number as f64 * h, h], &step)),
            Some(tolerance) => self.controlled(start, tolerance, &step),
        }
    }

    /// The increment in as many parts as its error asks for. Sizes are halved and doubled only, so that the parts are
    /// the same for neighbouring strains and the derivative is that of the result.
    fn controlled<S: Blend>(
        &self,
        start: S,
        tolerance: f64,
        step: &impl Fn(&S, f64, f64) -> Result<S, Failure>,
    ) -> Result<S, Failure> {
        const MOST: u64 = 1 << HALVINGS;
        let end = self.substeps as u64 * MOST;
        let (mut state, mut done, mut part) = (start, 0, MOST >> FIRST);
        let (mut largest, mut reserve) = (start.size().re(), (1.0 - SHARED) * tolerance);
        while done < end {
            let h = part as f64 / end as f64;
            let tried = self.scheme.compared(&state, [done as f64 / end as f64, h], step);
            if let Ok((next, off)) = &tried {
                let size = largest.max(next.size().re());
                let (error, share) = (if *off > 0.0 { off / size } else { 0.0 }, SHARED * tolerance * h);
                let at_a_kink = part << AT_A_KINK <= MOST && error <= 0.5 * reserve;
                if error <= share || at_a_kink {
                    reserve -= (error - share).max(0.0);
                    (state, done, largest) = (*next, done + part, size);
                    let twice = 2 * part;
                    let room = twice <= MOST && done.is_multiple_of(twice) && done + twice <= end;
                    part = if error < 0.1 * share && room { twice } else { part };
                    continue;
                }
            }
            match tried {
                _ if part > 1 => part /= 2,
                Ok(_) => return Err(Failure::new(NOT_KEPT)),
                Err(failure) => return Err(failure),
            }
        }
        Ok(state)
    }
}

const NOT_KEPT: &str = "the law's sub-steps do not keep their error";

impl Scheme {
    /// One sub-step over `h` from the fraction `begun` of the increment.
    fn step<S: Blend>(
        &self,
        from: &S,
        [begun, h]: [f64; 2],
        step: &impl Fn(&S, f64, f64) -> Result<S, Failure>,
    ) -> Result<S, Failure> {
        match *self {
            Self::BackwardEuler => step(from, h, begun + h),
            Self::Midpoint(theta) => {
                step(&from.blend(&step(from, theta * h, begun + theta * h)?, (1.0 / theta).into()), 0.0, begun + h)
            }
            Self::TwoStep => {
                let g = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
                step(&from.blend(&step(from, g * h, begun + g * h)?, ((1.0 - g) / g).into()), g * h, begun + h)
            }
            Self::Adaptive(tolerance) => {
                let whole = Self::TwoStep.step(from, [begun, h], step);
                halved(from, whole, [begun, h], (tolerance, DEEPEST, &mut PARTS.clone()), step)
            }
        }
    }

    /// Two half sub-steps, and how far a whole one is from them.
    fn compared<S: Blend>(
        &self,
        from: &S,
        [begun, h]: [f64; 2],
        step: &impl Fn(&S, f64, f64) -> Result<S, Failure>,
    ) -> Result<(S, f64), Failure> {
        let whole = self.step(from, [begun, h], step)?;
        let halves = self.step(&self.step(from, [begun, 0.5 * h], step)?, [begun + 0.5 * h, 0.5 * h], step)?;
        let error = whole.distance(&halves).re();
        if error.is_finite() { Ok((halves, error)) } else { Err(Failure::new("a sub-step of the law is not finite")) }
    }
}

/// A part `h` of an increment from its fraction `begun` on, whose end by one sub-step is `whole`, by halves that keep the error.
fn halved<S: Blend>(
    from: &S,
    whole: Result<S, Failure>,
    [begun, h]: [f64; 2],
    (tolerance, deep, parts): (f64, u32, &mut u32),
    step: &impl Fn(&S, f64, f64) -> Result<S, Failure>,
) -> Result<S, Failure> {
    let two = |from: &S, begun: f64| Scheme::TwoStep.step(from, [begun, 0.5 * h], step);
    let first = two(from, begun);
    let coarse = whole.and_then(|whole| {
        let end = two(first.as_ref().map_err(Clone::clone)?, begun + 0.5 * h)?;
        let (off, sizes) = (whole.distance(&end), [from.size(), end.size()]);
        let size = if sizes[0].re() > sizes[1].re() { sizes[0] } else { sizes[1] };
        Ok((end, if off.re() == 0.0 { off } else { off / size * (1.0 / tolerance) }))
    });
    if let Ok((end, error)) = &coarse
        && error.re() <= 0.5
    {
        return Ok(*end);
    }
    if deep == 0 || *parts == 0 {
        return Err(coarse.err().unwrap_or_else(|| Failure::new(NOT_KEPT)));
    }
    *parts -= 1;
    let middle = halved(from, first, [begun, 0.5 * h], (tolerance, deep - 1, parts), step)?;
    let whole = two(&middle, begun + 0.5 * h);
    let fine = halved(&middle, whole, [begun + 0.5 * h, 0.5 * h], (tolerance, deep - 1, parts), step)?;
    Ok(match coarse {
        Ok((end, error)) if error.re() < 1.0 => end.blend(&fine, error * 2.0 - S::Number::one()),
        _ => fine,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    impl Blend for f64 {
        type Number = f64;
        fn blend(&self, other: &Self, weight: f64) -> Self {
            self + (other - self) * weight
        }
        fn distance(&self, other: &Self) -> f64 {
            (self - other).abs()
        }
        fn size(&self) -> f64 {
            self.abs()
        }
    }

    /// `y' = -y^2` from 1: `1 / (1 + t)`, here over t = 2.
    fn decay(update: Update) -> f64 {
        let euler =
            |y: &f64, h: f64, _: f64| Ok(if h == 0.0 { *y } else { ((1.0 + 8.0 * h * y).sqrt() - 1.0) / (4.0 * h) });
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
        for scheme in [Scheme::BackwardEuler, Scheme::Midpoint(0.5), Scheme::TwoStep] {
            for (tolerance, substeps) in [(1e-2_f64, 1), (1e-3, 3), (1e-5, 1)] {
                // Steps of first order are too many below this.
                let tolerance = if scheme == Scheme::BackwardEuler { tolerance.max(1e-3) } else { tolerance };
                let off = (decay(Update { scheme, substeps, tolerance: Some(tolerance) }) - 1.0 / 3.0).abs();
                assert!(off < tolerance && off > 1e-3 * tolerance, "{scheme:?} {tolerance}: {off}");
            }
        }
    }

    /// Over a time in which the state falls to a millionth, and without jumps.
    #[test]
    fn the_adaptive_scheme_follows_a_transient() {
        let end = |y: f64| {
            let euler = |y: &f64, h: f64, _: f64| Ok(2.0 * y / (1.0 + (1.0 + 4e12 * h * y).sqrt()));
            Update { scheme: Scheme::Adaptive(1e-3), ..Update::default() }.advance(y, euler).unwrap()
        };
        let errors: Vec<f64> =
            (0..2000).map(|i| 1.0 + 1e-3 * f64::from(i)).map(|y| end(y) * (1e12 + 1.0 / y) - 1.0).collect();
        assert!(errors.iter().all(|e| e.abs() < 1e-3), "{errors:?}");
        assert!(errors.windows(2).all(|two| (two[1] - two[0]).abs() < 1e-6), "{errors:?}");
    }

    #[test]
    fn a_step_that_fails_is_halved_and_then_told() {
        let picky = |y: &f64, h: f64, _: f64| if h > 0.1 { Err(Failure::new("too far")) } else { Ok(y + h) };
        let update = Update { tolerance: Some(1e-3), ..Update::default() };
        assert!((update.advance(0.0, picky).unwrap() - 1.0).abs() < 1e-14);
        let never = |_: &f64, _: f64, _: f64| Err(Failure::new("never"));
        assert_eq!(update.advance(0.0, never).unwrap_err().reason, "never");
    }
}
