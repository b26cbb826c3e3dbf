//! Friction on a cone `|tau| <= y` over an increment in which the limit `y` runs linearly and the elastic trial
//! `tau' = K_t slip'` is constant; flow along `tau`, without dilatancy.
//!
//! *Exact*: the elastic path is a chord of a convex cone, so a point sticks up to one crossing and slips from there to
//! the end. With `w` the angle from `tau` to the slip while it slips,
//! `tan(w_b / 2) = tan(w_a / 2) exp(-K_t |slip| ln(y_b / y_a) / (y_b - y_a))`, and `|tau| = y`.
//! *Backward Euler*: radial return, order 1. *Midpoint*: the sub-incremented scheme of Charlier & Habraken (1990): after
//! the crossing each sub-increment is carried along the cone in two steps, the second with the normal that the first,
//! over the part `theta` of it, leads to; order 2 at `theta = 1/2`. Where the two steps would carry the stress beyond the
//! direction of the slip, which the solution never crosses, it ends along the slip. In the plane all of them coincide.

use crate::tensor::Scalar;

/// How the cone is integrated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ConeScheme {
    /// The closed form.
    #[default]
    Exact,
    /// Radial returns in this many equal sub-increments.
    BackwardEuler(usize),
    /// The two-step midpoint rule in this many equal sub-increments after the crossing, and its parameter.
    Midpoint(usize, f64),
}

/// What an increment imposes.
pub(super) struct Path<T> {
    /// Shear at the beginning.
    pub start: [T; 2],
    /// Limit at the beginning and at the end.
    pub limit: (T, T),
    /// Elastic change of the shear if nothing slips.
    pub step: [T; 2],
}

/// Where it leads.
pub(super) struct End<T> {
    /// Shear at the end.
    pub shear: [T; 2],
    /// Irreversible slip times the tangential penalty; none when the point sticks to the end.
    pub slip: Option<f64>,
    /// Dissipated energy times the tangential penalty.
    pub work: f64,
}

/// By how much, as a ratio, a stress on the cone may exceed it by rounding.
const OUTSIDE: f64 = 1e-9;

fn dot<T: Scalar>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

/// Positive where `b` lies to the left of `a`.
fn cross<T: Scalar>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[1] - a[1] * b[0]
}

/// `a + f b`.
fn plus<T: Scalar>(a: [T; 2], b: [T; 2], f: T) -> [T; 2] {
    [a[0] + b[0] * f, a[1] + b[1] * f]
}

fn norm<T: Scalar>(a: [T; 2]) -> T {
    dot(a, a).sqrt()
}

impl<T: Scalar> Path<T> {
    /// The end of the increment.
    pub fn end(&self, scheme: ConeScheme) -> End<T> {
        let trial = plus(self.start, self.step, T::one());
        if norm(trial).re() <= self.limit.1.re().max(0.0) {
            return End { shear: trial, slip: None, work: 0.0 };
        }
        // Multipliers of augmentation may begin outside of the cone: there is no path from there but straight back.
        if norm(self.start).re() > self.limit.0.re() * (1.0 + OUTSIDE) {
            return self.euler(1);
        }
        // Without a limit there is nothing to slide along.
        match scheme {
            ConeScheme::Exact if self.limit.1.re() > 0.0 => self.sliding().exact(),
            ConeScheme::Midpoint(n, theta) if self.limit.1.re() > 0.0 => self.sliding().midpoint(n, theta),
            ConeScheme::Exact | ConeScheme::Midpoint(..) => self.euler(1),
            ConeScheme::BackwardEuler(n) => self.euler(n),
        }
    }

    fn euler(&self, n: usize) -> End<T> {
        let part = 1.0 / n as f64;
        let (mut shear, mut slip, mut work) = (self.start, 0.0, 0.0);
        for i in 1..=n {
            let y = (self.limit.1 - self.limit.0) * (i as f64 * part) + self.limit.0;
            let trial = plus(shear, self.step, T::from(part));
            let size = norm(trial);
            if size.re() > y.re().max(0.0) {
                shear = trial.map(|t| t / size * y);
                slip += size.re() - y.re();
                work += y.re() * (size.re() - y.re());
            } else {
                shear = trial;
            }
        }
        End { shear, slip: Some(slip), work }
    }

    /// What is left of the increment after the crossing, the root of `|tau + a step|^2 = y(a)^2` at which the left side
    /// outgrows the right.
    fn sliding(&self) -> Sliding<T> {
        let (start, before) = (self.start, self.limit.0);
        let rise = self.limit.1 - before;
        let a = dot(self.step, self.step) - rise * rise;
        let b = dot(start, self.step) - before * rise;
        let c = (dot(start, start) - before * before).min(T::zero());
        let root = (b * b - a * c).max(T::zero()).sqrt();
        let crossing = if b.re() > 0.0 { -c / (b + root) } else { (root - b) / a };
        let crossing = crossing.max(T::zero()).min(T::one());
        let shear = plus(start, self.step, crossing);
        let left = T::one() - crossing;
        Sliding { shear, from: before + rise * crossing, to: self.limit.1, step: self.step.map(|d| d * left) }
    }
}

/// The part of an increment in which a point slips.
struct Sliding<T> {
    shear: [T; 2],
    from: T,
    to: T,
    step: [T; 2],
}

impl<T: Scalar> Sliding<T> {
    fn exact(&self) -> End<T> {
        let length = norm(self.step);
        if length.re() == 0.0 || self.from.re() == 0.0 {
            let m = if length.re() == 0.0 { self.shear } else { self.step };
            let size = norm(m);
            return self.closed(m.map(|m| m / size * self.to), |_| f64::from(u8::from(length.re() > 0.0)));
        }
        let along = self.step.map(|d| d / length);
        let size = norm(self.shear);
        let (cos, sin) = (dot(self.shear, along) / size, (along[0] * self.shear[1] - along[1] * self.shear[0]) / size);
        if sin.re() == 0.0 && cos.re() > 0.0 {
            // Slip along the stress, as always in the plane, turns nothing but what derivatives see.
            let rise = (self.to - self.from).re() / self.from.re();
            let sin = sin * (-length.re() / self.from.re() * log_ratio(rise)).exp();
            let shear = [along[0] - along[1] * sin, along[1] + along[0] * sin].map(|m| m * self.to);
            return self.closed(shear, |_| 1.0);
        }
        // tan(w / 2) as a fraction that is well defined at every angle.
        let half = if cos.re() >= 0.0 { (sin, cos + 1.0) } else { (T::one() - cos, sin) };
        let turned = |part: T| {
            let rise = (self.to - self.from) * part;
            let fade = (-length * part / self.from * log_ratio(rise / self.from)).exp();
            let (n, d) = (half.0 * fade, half.1);
            let sum = n * n + d * d;
            ((d * d - n * n) / sum, n * d * 2.0 / sum)
        };
        let (cos, sin) = turned(T::one());
        let shear = [along[0] * cos - along[1] * sin, along[1] * cos + along[0] * sin].map(|m| m * self.to);
        self.closed(shear, |part| turned(T::from(part)).0.re())
    }

    /// With slip and work: `K_t lambda' = |step| cos w - y'`, by Gauss's rule of five points over the part that slips.
    fn closed(&self, shear: [T; 2], cos: impl Fn(f64) -> f64) -> End<T> {
        const X: [f64; 5] =
            [0.046_910_077_030_668, 0.230_765_344_947_158, 0.5, 0.769_234_655_052_842, 0.953_089_922_969_332];
        const W: [f64; 5] = [
            0.118_463_442_528_095,
            0.239_314_335_249_683,
            0.284_444_444_444_444,
            0.239_314_335_249_683,
            0.118_463_442_528_095,
        ];
        let (length, from, rise) = (norm(self.step).re(), self.from.re(), self.to.re() - self.from.re());
        let (mut slip, mut work) = (0.0, 0.0);
        for (x, w) in X.into_iter().zip(W) {
            let rate = (length * cos(x) - rise).max(0.0);
            slip += w * rate;
            work += w * rate * (from + rise * x);
        }
        End { shear, slip: Some(slip), work }
    }

    fn midpoint(&self, n: usize, theta: f64) -> End<T> {
        if self.from.re() == 0.0 {
            return self.exact();
        }
        let part = 1.0 / n as f64;
        let (mut shear, mut slip, mut work) = (self.shear, 0.0, 0.0);
        // With the component of the step along the cone only.
        let carried = |shear: [T; 2], normal: [T; 2], part: f64| {
            let size = norm(normal);
            let m = normal.map(|m| m / size);
            let out = dot(m, self.step);
            (plus(shear, plus(self.step, m, -out), T::from(part)), out)
        };
        let limit = |i: f64| self.from + (self.to - self.from) * (i * part);
        for i in 1..=n {
            let (i, first) = (i as f64, limit(i as f64 - 1.0));
            let (y, before) = (limit(i), first.re());
            let (half, _) = carried(shear, shear, theta * part);
            // On the way the stress has the size of the limit there: with that of the beginning a limit that moves would
            // leave the order at one.
            let on_the_way = limit(i - 1.0 + theta) / first;
            let (end, out) = carried(shear.map(|t| t * on_the_way), half, part);
            // Slip turns the stress towards itself and never beyond: a part that is long beside the elastic slip ends there.
            let beyond = cross(self.step, shear).re() * cross(self.step, end).re() < 0.0;
            let end = if beyond { self.step } else { end };
            let size = norm(end);
            shear = end.map(|t| t / size * y);
            let slipped = (out.re() * part - (y.re() - before)).max(0.0);
            slip += slipped;
            work += slipped * 0.5 * (before + y.re());
        }
        End { shear, slip: Some(slip), work }
    }
}

/// `ln(1 + x) / x`, smooth at zero.
fn log_ratio<T: Scalar>(x: T) -> T {
    let r = x.re();
    if r.abs() < 1e-3 {
        let value = 1.0 - r * (1.0 / 2.0 - r * (1.0 / 3.0 - r * (1.0 / 4.0 - r * (1.0 / 5.0 - r / 6.0))));
        let slope = -1.0 / 2.0 + r * (2.0 / 3.0 - r * (3.0 / 4.0 - r * (4.0 / 5.0 - r * 5.0 / 6.0)));
        return x.chain(value, slope);
    }
    let value = r.ln_1p() / r;
    x.chain(value, ((1.0 + r).recip() - value) / r)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Dual;

    /// Starts at the limit at a right angle to the slip; the angle left at the end, in degrees.
    fn angle(reach: f64, scheme: ConeScheme) -> f64 {
        let path = Path { start: [0.0, 2.0], limit: (2.0, 2.0), step: [2.0 * reach, 0.0] };
        let shear = path.end(scheme).shear;
        assert!((f64::hypot(shear[0], shear[1]) - 2.0).abs() < 1e-14);
        shear[1].atan2(shear[0]).to_degrees()
    }

    /// The table of the three integrators: exact angle, then the errors with 1, 2, 4 and 8 sub-increments.
    #[test]
    fn the_table_of_integrators() {
        type Row = (f64, f64, [f64; 4], [f64; 4]);
        const TABLE: [Row; 3] = [
            (0.5, 62.4762, [0.959, 0.607, 0.340, 0.180], [-0.549, -0.121, -0.0280, -0.0067]),
            (1.0, 40.3951, [4.605, 2.963, 1.714, 0.927], [-3.525, -0.482, -0.0868, -0.0177]),
            (2.0, 15.4146, [11.15, 7.09, 4.17, 2.28], [-15.4, 1.32, 0.344, 0.0865]),
        ];
        for (reach, exact, euler, midpoint) in TABLE {
            let closed = angle(reach, ConeScheme::Exact);
            assert!((closed - exact).abs() < 1e-4, "{reach}: {closed}");
            for (k, n) in [1, 2, 4, 8].into_iter().enumerate() {
                let near = |error: f64, table: f64| (error - table).abs() < 6e-3 * table.abs().max(0.01);
                let error = angle(reach, ConeScheme::BackwardEuler(n)) - closed;
                assert!(near(error, euler[k]), "backward Euler {reach} {n}: {error}");
                let error = angle(reach, ConeScheme::Midpoint(n, 0.5)) - closed;
                assert!(near(error, midpoint[k]), "midpoint {reach} {n}: {error}");
            }
        }
    }

    #[test]
    fn orders_are_one_and_two_and_one_beside_the_middle() {
        let order = |scheme: &dyn Fn(usize) -> ConeScheme| {
            let error = |n| (angle(1.0, scheme(n)) - angle(1.0, ConeScheme::Exact)).abs();
            (error(64) / error(128)).log2()
        };
        assert!((order(&ConeScheme::BackwardEuler) - 1.0).abs() < 0.02);
        assert!((order(&|n| ConeScheme::Midpoint(n, 0.5)) - 2.0).abs() < 0.1);
        assert!((order(&|n| ConeScheme::Midpoint(n, 0.75)) - 1.0).abs() < 0.05);
    }

    /// Paths that stick first, unload first, turn by nearly half a turn, with limits that rise and fall.
    fn paths() -> Vec<Path<f64>> {
        let mut paths = Vec::new();
        for i in 0..240 {
            let x = |k: u32| f64::from((i * 7919 + k * 104_729) % 1009) / 504.5 - 1.0;
            let start = [x(1), x(2)];
            let size = f64::hypot(start[0], start[1]);
            let before = size * if i % 3 == 0 { 1.0 } else { 1.0 + 0.5 * x(3).abs() };
            paths.push(Path { start, limit: (before, before * (1.0 + 0.6 * x(4))), step: [3.0 * x(5), 3.0 * x(6)] });
        }
        paths.push(Path { start: [-1.0, 1e-9], limit: (1.0, 0.5), step: [0.2, 0.0] });
        paths.push(Path { start: [0.5, 0.0], limit: (1.0, 0.2), step: [0.0, 0.0] });
        paths
    }

    #[test]
    fn the_closed_form_is_the_limit_of_many_sub_increments() {
        let mut slipped = 0;
        for path in paths() {
            let exact = path.end(ConeScheme::Exact);
            let Some(slip) = exact.slip else { continue };
            slipped += 1;
            let many = |n| path.end(ConeScheme::BackwardEuler(n));
            let (coarse, fine) = (many(4000), many(8000));
            let size = path.limit.0.max(path.limit.1);
            for i in 0..2 {
                let limit = 2.0 * fine.shear[i] - coarse.shear[i];
                assert!((exact.shear[i] - limit).abs() < 2e-6 * size, "{:?} {:?}", path.start, path.step);
            }
            let limit = 2.0 * fine.slip.unwrap() - coarse.slip.unwrap();
            assert!((slip - limit).abs() < 3e-3 * size, "{slip} {limit}");
            assert!(exact.work >= 0.0 && (exact.work - (2.0 * fine.work - coarse.work)).abs() < 3e-3 * size * size);
        }
        assert!(slipped > 100, "{slipped}");
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let h = 1e-6;
        for (path, scheme) in paths().iter().flat_map(|path| {
            [ConeScheme::Exact, ConeScheme::BackwardEuler(3), ConeScheme::Midpoint(2, 0.5)].map(|s| (path, s))
        }) {
            let at =
                |x: [f64; 3]| Path { start: path.start, limit: (path.limit.0, x[0]), step: [x[1], x[2]] }.end(scheme);
            let here = [path.limit.1, path.step[0], path.step[1]];
            let v = |i: usize| Dual::<3>::variable(here[i], i);
            let dual =
                Path { start: path.start.map(Dual::from), limit: (Dual::from(path.limit.0), v(0)), step: [v(1), v(2)] }
                    .end(scheme);
            for k in 0..3 {
                let shifted = |sign: f64| at(std::array::from_fn(|i| here[i] + if i == k { sign * h } else { 0.0 }));
                let (up, down) = (shifted(1.0), shifted(-1.0));
                if up.slip.is_some() != down.slip.is_some() || path.limit.1 < 0.05 || here[1] == 0.0 {
                    continue;
                }
                for i in 0..2 {
                    let slope = (up.shear[i] - down.shear[i]) / (2.0 * h);
                    let error = (dual.shear[i].du[k] - slope).abs();
                    assert!(error < 1e-5 * slope.abs().max(1.0), "{scheme:?} {:?} {here:?} {error}", path.start);
                }
            }
        }
    }
}
