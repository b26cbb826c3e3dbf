//! Regularised friction after Oden and Pires (1983): from rest `tau = mu p tanh(s / e)` with the slip `s`, smooth, without
//! a stick branch. With a `radius` the contact puts the mean of the pressure around the point in the place of `p`; the law
//! itself knows one point only.
//!
//! The shear stress over its limit, `t = tau / (mu p)`, is the state, so that friction is the same in any number of
//! increments: loading, `t . d > 0`, follows `e t' = d - t (t . d)` over the slip `d`, unloading `e t' = d`, which is elastic.
//! Along a straight slip, with the component `a` of `t` along it, `b` across it and `T = tanh(s / e)`, loading ends at
//! `a = (a_0 + T) / (1 + a_0 T)`, `b = b_0 / cosh(s / e) / (1 + a_0 T)`; the increment is integrated by that. What loading
//! dissipates is `mu p a |t|^2` for a unit of slip. A point that only unloads sticks, any other slips.
//!
//! Below `e` a point gives way elastically; `e` is to friction what the tangential penalty is to other laws.

use super::coulomb::FRICTION;
use super::{law, nothing_to_integrate};
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, Variable, VariableKind, unit};
use crate::integrate::Update;
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response, Status};
use crate::tensor::Scalar;

const LENGTH: Parameter = Parameter {
    key: "length",
    meaning: "slip from rest at which friction is three quarters of the whole",
    unit: unit::LENGTH,
    range: Range::POSITIVE,
    default: None,
};

const RADIUS: Parameter = Parameter {
    key: "radius",
    meaning: "distance on the surface over which friction takes the mean of the pressure, with a tool in the plane; zero for that of the point",
    unit: unit::LENGTH,
    range: Range::NOT_NEGATIVE,
    default: Some(0.0),
};

pub(super) const ENTRY: Entry<Box<dyn Interface>> = Entry {
    name: "oden_pires",
    meaning: "regularised friction after Oden and Pires: smooth in the slip, elastic where it turns back",
    parameters: &[FRICTION, LENGTH, RADIUS],
    pairs: None,
    build: |v| Ok(law(OdenPires { friction: v[0], length: v[1], radius: v[2] })),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OdenPires {
    /// Coefficient of friction.
    pub friction: f64,
    /// Slip from rest at which friction is `tanh 1` of the whole.
    pub length: f64,
    /// Distance over which the pressure is a mean.
    pub radius: f64,
}

/// Place of the limit `mu p` to which the shear stress of the past belongs: with a radius, that of a mean pressure.
const LIMIT: usize = 0;

/// A shear stress over its limit along and across a slip.
#[derive(Clone, Copy)]
struct Ratio<T> {
    along: T,
    across: T,
}

impl<T: Scalar> Ratio<T> {
    fn square(&self) -> f64 {
        self.along.re().powi(2) + self.across.re().powi(2)
    }

    /// Elastic up to where loading begins; also what is left of the slip `x`, a ratio to the length.
    fn unloaded(self, x: T) -> (Self, T) {
        let back = (-self.along).max(T::zero()).min(x);
        (Self { along: self.along + back, ..self }, x - back)
    }

    /// After loading by `x`.
    fn loaded(self, x: T) -> Self {
        let (tanh, fade) = (x.tanh(), (-x).exp());
        let sech = fade * 2.0 / (fade * fade + 1.0);
        let scale = (self.along * tanh + 1.0).recip();
        Self { along: (self.along + tanh) * scale, across: self.across * sech * scale }
    }

    /// What loading by `x` to `end` dissipates: the work less what is stored.
    fn dissipated(self, x: f64, end: &Self) -> f64 {
        let (a, fade) = (self.along.re(), (-2.0 * x).exp());
        let work = x + (0.5 * (1.0 + a + (1.0 - a) * fade)).ln();
        (work - 0.5 * (end.square() - self.square())).max(0.0)
    }
}

impl OdenPires {
    /// The old shear stress over its limit; one beyond it, as multipliers may be, lies on it.
    fn ratio<T: Scalar>(past: &Past<T>) -> [T; 2] {
        let limit = past.vars[LIMIT];
        if limit.re() <= 0.0 {
            return [T::zero(); 2];
        }
        let ratio = past.shear.map(|tau| tau / limit);
        let size = (ratio[0] * ratio[0] + ratio[1] * ratio[1]).sqrt();
        if size.re() > 1.0 { ratio.map(|t| t / size) } else { ratio }
    }
}

impl InterfaceLaw for OdenPires {
    const VARIABLES: &'static [Variable] = &[Variable { name: "friction_limit", kind: VariableKind::Scalar }];

    fn radius(&self) -> f64 {
        self.radius
    }

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, vars: &mut [T]) -> Result<Response<T>, Failure> {
        let pressure = motion.penetration * past.penalty;
        let limit = pressure.max(T::zero()) * self.friction;
        let [s, t] = Self::ratio(past);
        let size = (motion.slip[0] * motion.slip[0] + motion.slip[1] * motion.slip[1]).sqrt();
        vars[LIMIT] = limit;
        if size.re() <= SMALL * self.length {
            let ratio: [T; 2] = std::array::from_fn(|i| [s, t][i] + motion.slip[i] / self.length);
            return Ok(response([pressure, limit], ratio, Status::Stick, [0.0; 2]));
        }
        let [m, n] = motion.slip.map(|slip| slip / size);
        let start = Ratio { along: s * m + t * n, across: t * m - s * n };
        let (turned, left) = start.unloaded(size / self.length);
        let end = turned.loaded(left);
        let lost = turned.dissipated(left.re(), &end) * self.length * limit.re();
        let elastic = self.length * (end.along.re() - start.along.re()).hypot(end.across.re() - start.across.re());
        let ratio = [end.along * m - end.across * n, end.along * n + end.across * m];
        // What only unloads is elastic; at no slip the two part.
        let status = if left.re() > 0.0 { Status::Slip } else { Status::Stick };
        Ok(response([pressure, limit], ratio, status, [(size.re() - elastic).max(0.0), lost]))
    }

    /// The increment is a closed form.
    fn updated(&self, _: Update) -> Result<Box<dyn Interface>, String> {
        nothing_to_integrate("regularised friction is integrated in closed form, exactly along a straight slip")
    }
}

/// Slip, as a ratio to the length, below which it has no direction: what is left out is its square.
const SMALL: f64 = 1e-12;

fn response<T: Scalar>(
    [pressure, limit]: [T; 2],
    ratio: [T; 2],
    status: Status,
    [slipped, dissipated]: [f64; 2],
) -> Response<T> {
    let shear = ratio.map(|t| t * limit);
    Response { pressure, shear, status, slipped, closure: 0.0, dissipated, violation: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: OdenPires = OdenPires { friction: 0.2, length: 1e-3, radius: 0.0 };

    /// Shear after slips in equal increments each, under a pressure of 100; and what was dissipated.
    fn slid(slips: &[[f64; 2]], increments: usize) -> ([f64; 2], f64) {
        let (mut shear, mut vars, mut lost) = ([0.0; 2], [0.0], 0.0);
        for slip in slips {
            for _ in 0..increments {
                let old = vars;
                let past = Past {
                    penalty: 1e3,
                    tangential_penalty: 1e3,
                    penetration: 0.1,
                    pressure: 100.0,
                    shear,
                    vars: &old,
                    dt: 1.0,
                };
                let motion = Motion { penetration: 0.1, slip: slip.map(|s| s / increments as f64) };
                let response = LAW.respond(&motion, &past, &mut vars).unwrap();
                (shear, lost) = (response.shear, lost + response.dissipated);
            }
        }
        (shear, lost)
    }

    #[test]
    fn friction_follows_the_slip_from_rest_in_any_number_of_increments() {
        for slip in [1e-9, 1e-4, 1e-3, 1e-2] {
            for increments in [1, 10, 1000] {
                let (shear, _) = slid(&[[0.6 * slip, -0.8 * slip]], increments);
                let size = 20.0 * f64::tanh(slip / 1e-3);
                assert!((shear[0] - 0.6 * size).abs() < 1e-11 * size && (shear[1] + 0.8 * size).abs() < 1e-11 * size);
            }
        }
    }

    /// Back and around a corner: the same in any number of increments; at rest the stress stays.
    #[test]
    fn a_way_that_turns_is_integrated_exactly() {
        let way = [[3e-3, 0.0], [-1.5e-3, 0.0], [4e-4, 9e-4], [0.0, 0.0]];
        let (one, lost) = slid(&way, 1);
        for increments in [3, 100] {
            let (shear, loss) = slid(&way, increments);
            assert!((shear[0] - one[0]).abs() + (shear[1] - one[1]).abs() < 1e-12 * 20.0);
            assert!((loss / lost - 1.0).abs() < 1e-10, "{loss} {lost}");
        }
        // On a line: elastic to no stress, then along the hyperbolic tangent.
        let (back, _) = slid(&way[..2], 7);
        assert!((back[0] + 20.0 * f64::tanh(1.5 - f64::tanh(3.0))).abs() < 1e-12);
    }
}
