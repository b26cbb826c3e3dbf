//! The return to the ellipse. With the dimensionless multiplier `g` it is `tau = tau_trial / (1 + k g)`,
//! `p = h + (p_trial - h) / (1 + M^2 g)`, `k = K_t / K_p`, and `S(g) = sqrt(|tau|^2 + M^2 (p - h)^2) = M r`. Newton's method
//! on `1 / S - 1 / (M r)` climbs to the root from below (the secular equation). An ellipse that hardens has its growth
//! for a second unknown.

use super::CamClayInterface;
use crate::Failure;
use crate::integrate::{System, solve};
use crate::tensor::Scalar;

const WHAT: &str = "Cam-clay of the interface";

fn failed() -> Failure {
    Failure::new(format!("{WHAT}: the return does not converge"))
}

/// Shape of a return.
#[derive(Debug, Clone, Copy)]
pub struct Shape<'a> {
    /// The law.
    pub law: &'a CamClayInterface,
    /// Tangential penalty over the normal one.
    pub ratio: f64,
    /// Normal penalty.
    pub penalty: f64,
    /// Tensile strength that is left.
    pub tension: f64,
}

/// Where a return ends for a multiplier and a preconsolidation.
pub struct End<S> {
    /// Shear there.
    pub shear: S,
    /// Pressure there.
    pub pressure: S,
    /// `S(g)`,
    pub size: S,
    /// and `M r`.
    pub wanted: S,
}

impl Shape<'_> {
    /// The end for a multiplier, a preconsolidation and the sizes of the trial stress.
    pub fn end<S: Scalar>(&self, g: S, last: S, [shear, pressure]: [S; 2]) -> End<S> {
        let slope = self.law.slope;
        let (centre, axis) = ((last - self.tension) * 0.5, (last + self.tension) * 0.5);
        let shear = shear / (g * self.ratio + 1.0);
        let away = (pressure - centre) / (g * (slope * slope) + 1.0);
        let size = (shear * shear + away * away * (slope * slope)).sqrt();
        End { shear, pressure: centre + away, size, wanted: axis * slope }
    }

    /// Whether stresses of these sizes lie beyond the cone at the tip.
    pub fn is_steep(&self, [shear, pressure]: [f64; 2]) -> bool {
        shear > self.law.steepest()[0] * (pressure + self.tension)
    }

    /// Shear and pressure on that cone, where a trial returns to it and not to the ellipse after the closure `before`.
    pub fn steep<T: Scalar>(&self, [shear, pressure]: [T; 2], before: T) -> Option<[T; 2]> {
        if !self.is_steep([shear.re(), pressure.re()]) {
            return None;
        }
        let [slope, dilatancy] = self.law.steepest();
        let apart = (shear - (pressure + self.tension) * slope) / (slope * dilatancy + self.ratio);
        let (shear, end) = (shear - apart * self.ratio, pressure + apart * dilatancy);
        let last = self.preconsolidation(self.grown(before + (pressure - end) / self.penalty)).re();
        let here = self.end(0.0, last, [shear.re(), end.re()]);
        (here.size <= here.wanted).then_some([shear, end])
    }

    /// Logarithm of the preconsolidation over the first one, after the closure `w` since the beginning.
    pub fn grown<S: Scalar>(&self, w: S) -> S {
        let grown = if self.law.hardening > 0.0 { w / self.law.hardening } else { S::zero() };
        grown.max(S::from(self.law.least.ln()))
    }

    /// The preconsolidation that has grown so.
    pub fn preconsolidation<S: Scalar>(&self, grown: S) -> S {
        grown.exp() * self.law.preconsolidation
    }

    /// The multiplier for a fixed ellipse, and the number of iterations.
    fn secular(&self, last: f64, [shear, pressure]: [f64; 2]) -> Option<(f64, usize)> {
        let squared = self.law.slope * self.law.slope;
        let (k, m) = (self.ratio, squared);
        let (mut g, mut before) = (0.0, f64::INFINITY);
        for iteration in 0..60 {
            let end = self.end(g, last, [shear, pressure]);
            let miss = end.size / end.wanted - 1.0;
            if miss <= 1e-14 || miss >= before {
                return Some((g, iteration));
            }
            before = miss;
            let away = end.pressure - (last - self.tension) * 0.5;
            let slope = (k * end.shear * end.shear / (1.0 + k * g) + m * m * away * away / (1.0 + m * g)) / end.size;
            g += miss * end.size / slope;
            if !g.is_finite() {
                return None;
            }
        }
        None
    }

    /// The growth that belongs to a multiplier: the root of a rising function.
    fn consistent(&self, g: f64, trial: [f64; 2], before: f64) -> f64 {
        let miss = |grown: f64| {
            let end = self.end(g, self.preconsolidation(grown), trial);
            grown - self.grown(before + (trial[1] - end.pressure) / self.penalty)
        };
        let (mut low, mut high, mut step) = (self.grown(f64::NEG_INFINITY), self.grown(before), 1.0);
        while miss(high) < 0.0 && step < 1e3 {
            (low, high, step) = (high, high + step, 2.0 * step);
        }
        halved(low, high, |grown| miss(grown) < 0.0)
    }

    /// Multiplier and growth of an ellipse that hardens.
    fn bracketed(&self, trial: [f64; 2], before: f64) -> [f64; 2] {
        let outside = |g: f64| {
            let end = self.end(g, self.preconsolidation(self.consistent(g, trial, before)), trial);
            end.size > end.wanted
        };
        let (mut low, mut high) = (0.0, 1e-3);
        while outside(high) && high < 1e30 {
            (low, high) = (high, 4.0 * high);
        }
        let g = halved(low, high, outside);
        [g, self.consistent(g, trial, before)]
    }

    /// Shear and pressure on the surface, from the sizes of the trial stress and the closure `before`.
    ///
    /// # Errors
    /// A [`Failure`] where no iteration converges.
    pub fn returned<T: Scalar>(&self, trial: [T; 2], before: T) -> Result<[T; 2], Failure> {
        let end = if self.law.hardening > 0.0 { self.hardened(trial, before)? } else { self.fixed(trial)? };
        Ok([end.shear, end.pressure])
    }

    fn fixed<T: Scalar>(&self, trial: [T; 2]) -> Result<End<T>, Failure> {
        let last = self.law.preconsolidation;
        let (g, _) = self.secular(last, trial.map(T::re)).ok_or_else(failed)?;
        let [g] = solve::<_, _, 1, 3>(self, [g], &[trial[0], trial[1], T::from(last)], WHAT)?;
        Ok(self.end(g, T::from(last), trial))
    }

    fn hardened<T: Scalar>(&self, trial: [T; 2], before: T) -> Result<End<T>, Failure> {
        let (data, plain, grown) = ([trial[0], trial[1], before], trial.map(T::re), self.grown(before.re()));
        let growing = Growing { shape: self, scale: 1.0 + plain[1].abs() / (self.penalty * self.law.hardening) };
        let (first, _) = self.secular(self.preconsolidation(grown), plain).ok_or_else(failed)?;
        let from = |start| solve::<_, _, 2, 3>(&growing, start, &data, WHAT).ok().filter(|[g, _]| g.re() > 0.0);
        let found = from([first, grown]).or_else(|| from(self.bracketed(plain, before.re())));
        let [g, grown] = found.ok_or_else(failed)?;
        Ok(self.end(g, self.preconsolidation(grown), trial))
    }
}

/// Where a condition that holds at `low` ceases to.
fn halved(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        *(if holds(middle) { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// In the multiplier; data are the sizes of the trial stress and the preconsolidation.
impl System<1, 3> for Shape<'_> {
    fn residual<S: Scalar>(&self, &[g]: &[S; 1], &[shear, pressure, last]: &[S; 3]) -> [S; 1] {
        let end = self.end(g, last, [shear, pressure]);
        [end.size / end.wanted - 1.0]
    }
}

/// The return to an ellipse that hardens, and a growth that is large in it.
struct Growing<'a> {
    shape: &'a Shape<'a>,
    scale: f64,
}

/// In the multiplier and the growth; data are the sizes of the trial stress and the old closure.
impl System<2, 3> for Growing<'_> {
    fn residual<S: Scalar>(&self, &[g, grown]: &[S; 2], &[shear, pressure, before]: &[S; 3]) -> [S; 2] {
        let shape = self.shape;
        let end = shape.end(g, shape.preconsolidation(grown), [shear, pressure]);
        let closure = before + (pressure - end.pressure) / shape.penalty;
        [end.size / end.wanted - 1.0, (grown - shape.grown(closure)) / self.scale]
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;

    /// Returns of trial stresses up to 10^6 times the ellipse, ratios of penalties over six decades.
    fn returns(count: usize) -> (usize, f64) {
        let (mut random, mut most, mut sum, mut outside) = (Random(1), 0, 0, 0);
        while outside < count {
            let law = CamClayInterface::perfect(random.decades(0.7), 1.0, random.next());
            let shape = Shape { law: &law, ratio: random.decades(3.0), penalty: 1.0, tension: law.tension };
            let trial = [random.decades(6.0), random.decades(6.0) * (2.0 * random.next() - 1.0)];
            let here = shape.end(0.0, 1.0, trial);
            if here.size <= here.wanted {
                continue;
            }
            outside += 1;
            let (g, iterations) = shape.secular(1.0, trial).unwrap();
            let end = shape.end(g, 1.0, trial);
            assert!((end.size / end.wanted - 1.0).abs() < 1e-12, "{trial:?} {law:?}");
            (most, sum) = (most.max(iterations), sum + iterations);
        }
        (most, sum as f64 / count as f64)
    }

    /// `cargo test --release -p asperity-core --lib two_hundred_thousand -- --nocapture` prints the numbers.
    #[test]
    fn two_hundred_thousand_returns_take_few_iterations() {
        let (most, mean) = returns(200_000);
        eprintln!("{most} iterations at most, {mean:.2} in the mean");
        assert!(most <= 12 && mean < 4.0, "{most} at most, {mean} in the mean");
    }
}
