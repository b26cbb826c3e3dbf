//! A law whose increments are integrated by sub-steps and a scheme of [`integrate`](crate::integrate).
//!
//! Penetration and slip are cut into equal parts of constant rate; stress and variables carry their derivatives from
//! one sub-step to the next, so the tangent is that of the whole.

use super::law::MOST_VARIABLES;
use super::{Interface, InterfaceLaw, Motion, Past, Response, Status};
use crate::Failure;
use crate::declare::Variable;
use crate::integrate::{Blend, Update};
use crate::tensor::Scalar;

/// A law with the way in which its increments are integrated.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Integrated<L> {
    pub law: L,
    pub update: Update,
}

/// Stress, variables and what was lost, as one state.
#[derive(Debug, Clone, Copy)]
struct Point<T> {
    penetration: T,
    vars: [T; MOST_VARIABLES],
    response: Response<T>,
}

impl<T: Scalar> Point<T> {
    fn stress(&self) -> [T; 3] {
        [self.response.pressure, self.response.shear[0], self.response.shear[1]]
    }
}

fn norm<T: Scalar>(stress: [T; 3]) -> T {
    stress.iter().fold(T::zero(), |sum, x| sum + *x * *x).sqrt()
}

impl<T: Scalar> Blend for Point<T> {
    type Number = T;
    fn blend(&self, other: &Self, weight: T) -> Self {
        let mix = |a: T, b: T| a + (b - a) * weight;
        let plain = |a: f64, b: f64| a + (b - a) * weight.re();
        let (a, b) = (&self.response, &other.response);
        let response = Response {
            pressure: mix(a.pressure, b.pressure),
            shear: std::array::from_fn(|i| mix(a.shear[i], b.shear[i])),
            status: b.status,
            slipped: plain(a.slipped, b.slipped),
            closure: plain(a.closure, b.closure),
            dissipated: plain(a.dissipated, b.dissipated),
            violation: b.violation,
        };
        let vars = std::array::from_fn(|i| mix(self.vars[i], other.vars[i]));
        Self { penetration: mix(self.penetration, other.penetration), vars, response }
    }

    fn distance(&self, other: &Self) -> T {
        let (a, b) = (self.stress(), other.stress());
        norm(std::array::from_fn(|i| a[i] - b[i]))
    }
    fn size(&self) -> T {
        norm(self.stress())
    }
}

impl<L: InterfaceLaw> InterfaceLaw for Integrated<L> {
    const VARIABLES: &'static [Variable] = L::VARIABLES;

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
    fn radius(&self) -> f64 {
        self.law.radius()
    }
    fn sliding_stress(&self, pressure: f64) -> Option<f64> {
        self.law.sliding_stress(pressure)
    }
    /// Integrated once, not twice.
    fn updated(&self, update: Update) -> Result<Box<dyn Interface>, String> {
        self.law.updated(update)
    }

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let n = vars.len();
        let way = motion.penetration - past.penetration;
        let step = |from: &Point<T>, part: f64, _: f64| {
            let penetration = from.penetration + way * part;
            let (pressure, shear) = (from.response.pressure, from.response.shear);
            // Only the extrapolation of the midpoint rule can lead beyond the slip.
            let shear = if part == 0.0 { before_slip(past.shear, shear, motion.slip) } else { shear };
            let here = Past { penetration: from.penetration, pressure, shear, vars: &from.vars[..n], ..*past };
            let motion = Motion { penetration, slip: motion.slip.map(|s| s * part) };
            let mut vars = from.vars;
            let here = Past { dt: part * past.dt, ..here };
            let mut response = self.law.respond(&motion, &here, &mut vars[..n])?;
            if part == 0.0 {
                // Nothing has moved: whether the point slips was found before.
                response.status = from.response.status;
            }
            response.slipped += from.response.slipped;
            response.closure += from.response.closure;
            response.dissipated += from.response.dissipated;
            Ok(Point { penetration, vars, response })
        };
        let end = self.update.advance(start(past), step)?;
        vars.copy_from_slice(&end.vars[..n]);
        Ok(end.response)
    }
}

/// A shear stress that began as `start`, without what has carried it across the direction of the slip: slip turns a stress
/// towards itself and never beyond.
fn before_slip<T: Scalar>(start: [T; 2], shear: [T; 2], slip: [T; 2]) -> [T; 2] {
    let left = |a: [T; 2]| slip[0].re() * a[1].re() - slip[1].re() * a[0].re();
    if left(start) * left(shear) >= 0.0 {
        return shear;
    }
    let along = (shear[0] * slip[0] + shear[1] * slip[1]) / (slip[0] * slip[0] + slip[1] * slip[1]);
    slip.map(|slip| slip * along)
}

fn start<T: Scalar>(past: &Past<T>) -> Point<T> {
    let response = Response {
        pressure: past.pressure,
        shear: past.shear,
        status: Status::Stick,
        slipped: 0.0,
        closure: 0.0,
        dissipated: 0.0,
        violation: 0.0,
    };
    let vars = std::array::from_fn(|i| past.vars.get(i).copied().unwrap_or_else(T::zero));
    Point { penetration: past.penetration, vars, response }
}
