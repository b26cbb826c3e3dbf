//! Drucker and Prager's cone closed by a cap: `f = sqrt(J2) + eta p - xi c` as [without](super::drucker_prager), outer edges, and
//! `g = q^2/a^2 + P^2 - Pb^2` under pressure, `P = -p > 0`, with associated flow. The cap moves with its own compaction,
//! `Pb = Pb_0 exp(e_c/x)` (as that of Schanz, Vermeer and Bonnier 1999, with a logarithm in the place of a power), never back.
//!
//! Backward Euler: the cone takes `G y` from `t = sqrt(J2)` and adds `K eta_b y` to `P`; the cap divides `t` by `1 + 6 G l/a^2` and `P` by
//! `1 + 2 K l`, and compacts by `2 l P`. Its pressure follows by the exponential, and by backward Euler in the schemes of second order,
//! which are made of that (see [`PressureCourse`](super::PressureCourse)). A stress beyond returns to the cone or its apex, to the cap, or to the edge of both, the first of
//! them that the other surface bears.

use super::cam_clay::PressureCourse;
use super::drucker_prager::{COHESION, Cone, DILATANCY, FRICTION, check_angles};
use super::elastic::{Elastic, POISSON, YOUNG};
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{System, Update, root, solve};
use crate::material::integrated::Integrated;
use crate::material::{Flow, Lapse, Material, Rate, RateLaw, Variable};
use crate::tensor::{Scalar, Tensor2};

const fn positive(key: &'static str, meaning: &'static str, unit: &'static str, default: Option<f64>) -> Parameter {
    Parameter { key, meaning, unit, range: Range::POSITIVE, default }
}

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "drucker_prager_cap",
    meaning: "Drucker-Prager plasticity by the outer edges with a cap that compaction moves",
    parameters: &[
        YOUNG,
        POISSON,
        COHESION,
        FRICTION,
        DILATANCY,
        positive(
            "cap_pressure",
            "pressure at which the cap yields at the beginning, equal in all directions",
            unit::STRESS,
            None,
        ),
        positive(
            "cap_ratio",
            "half axis of the cap along the equivalent stress over that along the pressure",
            unit::NONE,
            Some(1.0),
        ),
        positive("compressibility", "plastic compaction for a growth of the pressure by a factor e", unit::NONE, None),
    ],
    pairs: None,
    build: |v| {
        check_angles(v[3], v[4])?;
        let [eta, xi, eta_b] = Cone::Outer.match_angles(v[3].to_radians(), v[4].to_radians());
        let cone = [eta, eta_b, xi * v[2]];
        let (elastic, course) = (Elastic::new(v[0], v[1]), PressureCourse::Exact);
        Ok(rate(Capped { elastic, cone, first: v[5], ratio: v[6], compressibility: v[7], course }))
    },
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capped {
    elastic: Elastic,
    /// `eta`, `eta_b` and `xi c`.
    cone: [f64; 3],
    /// Pressure of the cap at the beginning.
    first: f64,
    ratio: f64,
    compressibility: f64,
    /// How a step carries the pressure of the cap.
    course: PressureCourse,
}

/// Part of the stress by which a surface may be passed.
const NEAR: f64 = 1e-12;

/// Where a return ends: `t`, `P`, the pressure of the cap at the beginning over that at the end, and the strains of cone and cap, `y` and `l`.
#[derive(Clone, Copy)]
struct End<S> {
    t: S,
    p: S,
    left: S,
    y: S,
    l: S,
}

impl Capped {
    fn end<S: Scalar>(&self, [t, p, _]: [S; 3], y: S, l: S) -> End<S> {
        let (g, k) = (self.elastic.shear, self.elastic.bulk());
        let t = (t - y * g) / (l * (6.0 * g / (self.ratio * self.ratio)) + 1.0);
        let p = (p + y * (k * self.cone[1])) / (l * (2.0 * k) + 1.0);
        End { t, p, left: self.course.left(l * p * (2.0 / self.compressibility)), y, l }
    }

    fn beyond_cone<S: Scalar>(&self, t: S, p: S) -> S {
        t - p * self.cone[0] - self.cone[2]
    }

    fn beyond_cap<S: Scalar>(&self, t: S, p: S, cap: S) -> S {
        t * t * (3.0 / (self.ratio * self.ratio)) + p * p - cap * cap
    }

    /// How far an end is beyond its cap, which was `cap` at the beginning: a ratio, that falls on where backward Euler has no cap.
    fn at_the_end<S: Scalar>(&self, end: &End<S>, cap: S) -> S {
        let left = if end.left.re() < 0.0 { -(end.left * end.left) } else { end.left * end.left };
        self.beyond_cap(end.t, end.p, S::zero()) * left / (cap * cap) - 1.0
    }

    /// Return to the cone, or to its apex.
    fn onto_cone<S: Scalar>(&self, start: [S; 3]) -> (End<S>, S) {
        let ([t, p, _], [eta, eta_b, strength]) = (start, self.cone);
        let (g, k) = (self.elastic.shear, self.elastic.bulk());
        let y = self.beyond_cone(t, p) * (1.0 / (g + k * eta * eta_b));
        if y.re() * g <= t.re() {
            return (self.end(start, y, S::zero()), y * eta_b);
        }
        let apex = S::from(-strength / eta);
        (End { t: S::zero(), p: apex, left: S::one(), y: t / g, l: S::zero() }, (apex - p) / k)
    }
}

/// The strain of the cap alone, as a ratio; data are `t`, `P` and the pressure of the cap.
struct CapAlone<'a>(&'a Capped, f64);

impl System<1, 3> for CapAlone<'_> {
    fn residual<S: Scalar>(&self, &[l]: &[S; 1], data: &[S; 3]) -> [S; 1] {
        let end = self.0.end(*data, S::zero(), l * self.1);
        [self.0.at_the_end(&end, data[2])]
    }
}

/// Strains of cone and cap at their edge, as ratios.
struct Edge<'a>(&'a Capped, [f64; 2]);

impl System<2, 3> for Edge<'_> {
    fn residual<S: Scalar>(&self, &[y, l]: &[S; 2], data: &[S; 3]) -> [S; 2] {
        let end = self.0.end(*data, y * self.1[0], l * self.1[1]);
        [self.0.beyond_cone(end.t, end.p) / data[2], self.0.at_the_end(&end, data[2])]
    }
}

impl Capped {
    /// The end of a return from `t`, `P` and the pressure of the cap, and the plastic change of volume.
    fn returned<S: Scalar>(&self, start: [S; 3]) -> Result<Option<(End<S>, S)>, Failure> {
        let [t, p, cap] = start.map(S::re);
        let passes_cone = self.beyond_cone(t, p) > 0.0;
        let passes_cap = p > 0.0 && self.beyond_cap(t, p, cap) > 0.0;
        if !passes_cone && !passes_cap {
            return Ok(None);
        }
        let size = t.max(p.abs()).max(cap);
        if passes_cone {
            let (end, volume) = self.onto_cone(start);
            if end.p.re() <= 0.0 || self.beyond_cap(end.t.re(), end.p.re(), cap) <= NEAR * size * size {
                return Ok(Some((end, volume)));
            }
        }
        let unit = [cap / self.elastic.shear, 1.0 / self.elastic.bulk()];
        if passes_cap {
            let (equation, plain, mut high) = (CapAlone(self, unit[1]), start.map(S::re), 1.0);
            while equation.residual(&[high], &plain)[0] > 0.0 && high < 1e12 {
                high *= 8.0;
            }
            let end = self.end(start, S::zero(), root(&equation, [0.0, high], &start, "the cap")? * unit[1]);
            if self.beyond_cone(end.t, end.p).re() <= NEAR * size {
                return Ok(Some((end, -(end.l * end.p * 2.0))));
            }
        }
        let [y, l] = solve(&Edge(self, unit), [0.0, 0.0], &start, "cone and cap")?;
        let end = self.end(start, y * unit[0], l * unit[1]);
        if y.re() < -NEAR || l.re() < -NEAR || end.t.re() < 0.0 {
            return Err(Failure::new("cone and cap: the local iteration finds another branch"));
        }
        Ok(Some((end, end.y * self.cone[1] - end.l * end.p * 2.0)))
    }
}

impl RateLaw for Capped {
    type Vars<T: Scalar> = [T; 3];
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "cap_pressure", kind: VariableKind::Scalar },
        Variable { name: "plastic_volume_strain", kind: VariableKind::Scalar },
        Variable { name: "plastic_shear_strain", kind: VariableKind::Scalar },
    ];

    fn initial(&self, state: &mut [f64]) {
        state[6] = self.first;
    }

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        &[cap, volume, shear]: &[T; 3],
        _lapse: Lapse,
    ) -> Result<(Tensor2<T>, [T; 3]), Failure> {
        let trial = stress + self.elastic.stress(&de);
        let (p, s) = (trial.trace() * (-1.0 / 3.0), trial.deviator());
        let t = (s.contract(s) * 0.5).sqrt();
        let Some((end, more)) = self.returned([t, p, cap])? else { return Ok((trial, [cap, volume, shear])) };
        // Without a deviator it is the cap that takes a part of it, or the apex that takes all.
        let scale = match t.re() > 0.0 {
            true => end.t / t,
            false if end.p.re() <= 0.0 => T::zero(),
            false => (end.l * (6.0 * self.elastic.shear / (self.ratio * self.ratio)) + 1.0).recip(),
        };
        let stress = s * scale - Tensor2::identity() * end.p;
        let sheared = (t - end.t) * (1.0 / self.elastic.shear);
        Ok((stress, [cap / end.left, volume + more, shear + sheared]))
    }

    fn updated(&self, update: Update) -> Box<dyn Material> {
        Box::new(Rate(Integrated { law: Self { course: PressureCourse::of(update.scheme), ..*self }, update }))
    }

    fn flow(&self) -> Flow {
        Flow::Dilatant
    }

    fn stored_energy(&self, stress: &Tensor2, _: &[f64; 3]) -> f64 {
        self.elastic.energy(stress)
    }

    fn dissipation(&self, old: (&Tensor2, &[f64; 3]), new: (&Tensor2, &[f64; 3])) -> f64 {
        let (p, s) = (new.0.trace() / 3.0, new.0.deviator());
        (0.5 * s.contract(s)).sqrt() * (new.1[2] - old.1[2]) + p * (new.1[1] - old.1[1])
    }
}
