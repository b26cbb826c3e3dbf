//! Mohr and Coulomb's plasticity, non-associated, in principal stresses (tension positive, `a >= b >= c`):
//! `f_ac = (a - c) + (a + c) sin phi - 2 c0 cos phi`, flow by the same with the dilatancy.
//!
//! A stress beyond the surface returns to the main plane; where that would change the order of the principal stresses,
//! to the edge of two planes; where it does even then, to the apex `c0 cot phi` (de Souza Neto et al. 2008). Each
//! return is linear for a given strength. Where that changes with the plastic shear strain (see [`Changing`]), one equation
//! is solved for the strain at the end of the step, in which the return stands as it is.

use super::drucker_prager::{COHESION, DILATANCY, FRICTION, check_angles};
use super::elastic::{Elastic, POISSON, YOUNG};
use super::hardening::join;
use super::rate;
use super::softening::{self, Changing};
use crate::Failure;
use crate::declare::{Entry, VariableKind};
use crate::integrate::{System, Update, root};
use crate::material::{Flow, Lapse, Material, RateLaw, Variable};
use crate::tensor::{Dual, Isotropic, Scalar, Tensor2, Vec3, principal};
use std::ops::{Mul, Sub};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "mohr_coulomb",
    meaning: "Mohr-Coulomb plasticity",
    parameters: &[YOUNG, POISSON, COHESION, FRICTION, DILATANCY],
    pairs: None,
    build: |v| {
        check_angles(v[3], v[4])?;
        let angles = [v[3].to_radians(), v[4].to_radians()];
        Ok(rate(MohrCoulomb::new(Elastic::new(v[0], v[1]), v[2], angles)))
    },
};

pub(super) const HARDENING: Entry<Box<dyn Material>> = Entry {
    name: "mohr_coulomb_hardening",
    meaning: "Mohr-Coulomb plasticity whose strength rises or falls with the plastic shear strain",
    parameters: &join::<9>(&[&[YOUNG, POISSON], &softening::PARAMETERS]),
    pairs: None,
    build: |v| {
        let strength = Changing::declared(&v[2..], MohrCoulomb::numbers)?;
        Ok(rate(MohrCoulomb { elastic: Elastic::new(v[0], v[1]), strength }))
    },
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MohrCoulomb {
    elastic: Elastic,
    /// Sines of friction and dilatancy, and cohesion.
    strength: Changing<3>,
}

/// A pair of principal stresses, the larger first.
type Plane = (usize, usize);

/// The surface of one strength, whose numbers may carry derivatives.
#[derive(Debug, Clone, Copy)]
struct Surface<P> {
    elastic: Elastic,
    sin_friction: P,
    sin_dilatancy: P,
    /// `2 c cos phi`.
    strength: P,
    /// Mean stress of the apex; none without friction.
    apex: Option<P>,
}

impl<P: Scalar> Surface<P> {
    fn new(elastic: Elastic, [sin_friction, sin_dilatancy, cohesion]: [P; 3]) -> Self {
        let cos = (P::one() - sin_friction * sin_friction).sqrt();
        let apex = (sin_friction.re() > 0.0).then(|| cohesion * cos / sin_friction);
        Self { elastic, sin_friction, sin_dilatancy, strength: cohesion * cos * 2.0, apex }
    }

    fn yields<S: Over<P>>(&self, s: &[S; 3], (i, j): Plane) -> S {
        s[i] - s[j] + (s[i] + s[j]) * self.sin_friction - self.strength
    }

    /// Elastic stress of unit flow on a plane.
    fn flow_stress(&self, (i, j): Plane) -> [P; 3] {
        let mut flow = [self.sin_dilatancy * (2.0 * self.elastic.lambda); 3];
        flow[i] += (self.sin_dilatancy + 1.0) * (2.0 * self.elastic.shear);
        flow[j] += (self.sin_dilatancy - 1.0) * (2.0 * self.elastic.shear);
        flow
    }

    /// Rate at which a flow lowers what yields.
    fn slope(&self, flow: &[P; 3], (i, j): Plane) -> P {
        flow[i] - flow[j] + (flow[i] + flow[j]) * self.sin_friction
    }

    /// Return to one plane.
    fn onto_plane<S: Over<P>>(&self, s: &[S; 3], plane: Plane) -> [S; 3] {
        let flow = self.flow_stress(plane);
        let amount = self.yields(s, plane) * self.slope(&flow, plane).recip();
        std::array::from_fn(|k| s[k] - amount * flow[k])
    }

    /// Return to the edge of two planes.
    fn onto_edge<S: Over<P>>(&self, s: &[S; 3], planes: [Plane; 2]) -> [S; 3] {
        let flows = planes.map(|plane| self.flow_stress(plane));
        let slope = |k: usize, l: usize| self.slope(&flows[l], planes[k]);
        let [f, g] = planes.map(|plane| self.yields(s, plane));
        let (a, b, c, d) = (slope(0, 0), slope(0, 1), slope(1, 0), slope(1, 1));
        let scale = (a * d - b * c).recip();
        let (x, y) = ((f * d - g * b) * scale, (g * a - f * c) * scale);
        std::array::from_fn(|k| s[k] - x * flows[0][k] - y * flows[1][k])
    }

    /// Principal stresses returned to the surface.
    fn returned<S: Over<P>>(&self, s: [S; 3]) -> [S; 3] {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| s[j].re().total_cmp(&s[i].re()));
        let [a, b, c] = order;
        if self.yields(&s, (a, c)).re() <= 0.0 {
            return s;
        }
        let plane = self.onto_plane(&s, (a, c));
        if plane[a].re() >= plane[b].re() && plane[b].re() >= plane[c].re() {
            return plane;
        }
        // Which edge: the side of the plane through the axis and the flow of the main plane on which the stress lies.
        let sin = self.sin_dilatancy.re();
        let lower = (1.0 - sin) * s[a].re() - 2.0 * s[b].re() + (1.0 + sin) * s[c].re() > 0.0;
        let other = if lower { (a, b) } else { (b, c) };
        let edge = self.onto_edge(&s, [(a, c), other]);
        match self.apex {
            Some(apex) if edge[a].re() < edge[c].re() => [<S as From<P>>::from(apex); 3],
            _ => edge,
        }
    }
}

/// A scalar that takes the numbers of a surface: plain ones, or its own kind.
trait Over<P>: Scalar + From<P> + Mul<P, Output = Self> + Sub<P, Output = Self> {}
impl<P, S: Scalar + From<P> + Mul<P, Output = S> + Sub<P, Output = S>> Over<P> for S {}

impl Isotropic for Surface<f64> {
    fn principal<S: Scalar>(&self, s: [S; 3]) -> Result<[S; 3], Failure> {
        Ok(self.returned(s))
    }
}

/// The equation of a step in the plastic shear strain, where the strength depends on it; data are the principal stresses
/// of the trial stress and the strain at the beginning.
struct Hardened<'a> {
    law: &'a MohrCoulomb,
    scale: f64,
}

impl System<1, 4> for Hardened<'_> {
    fn residual<S: Scalar>(&self, &[strain]: &[S; 1], &[a, b, c, first]: &[S; 4]) -> [S; 1] {
        let MohrCoulomb { elastic, strength } = self.law;
        let trial = [a, b, c];
        let back = Surface::new(*elastic, strength.at(strain)).returned(trial);
        let lost: [S; 3] = std::array::from_fn(|i| trial[i] - back[i]);
        let mean = (lost[0] + lost[1] + lost[2]) * (1.0 / 3.0);
        let square = lost.into_iter().fold(S::zero(), |sum, x| sum + (x - mean) * (x - mean));
        [(strain - first - (square * 0.5).sqrt() / elastic.shear) / self.scale]
    }
}

impl MohrCoulomb {
    /// From elasticity, cohesion, and the angles of friction and dilatancy in radians.
    pub fn new(elastic: Elastic, cohesion: f64, angles: [f64; 2]) -> Self {
        Self { elastic, strength: Changing::constant(Self::numbers(cohesion, angles)) }
    }

    fn numbers(cohesion: f64, [friction, dilatancy]: [f64; 2]) -> [f64; 3] {
        [friction.sin(), dilatancy.sin(), cohesion]
    }

    /// The admissible stress for a trial one after the plastic shear strain `before`, with the plastic shear and volume strain
    /// of the return.
    pub(super) fn returned<T: Scalar>(&self, trial: &Tensor2<T>, before: T) -> Result<(Tensor2<T>, [T; 2]), Failure> {
        let stress = if self.strength.changes() {
            self.hardened(trial, before)?
        } else {
            Surface::new(self.elastic, self.strength.first()).of(trial)?
        };
        let lost = *trial - stress;
        let shear = lost.deviator() * T::from(0.5 / self.elastic.shear);
        let volume = lost.trace() * (1.0 / (3.0 * self.elastic.bulk()));
        Ok((stress, [(shear.contract(shear) * 2.0).sqrt(), volume]))
    }

    fn hardened<T: Scalar>(&self, trial: &Tensor2<T>, before: T) -> Result<Tensor2<T>, Failure> {
        let (values, axes) = principal(&trial.re());
        let first = Surface::new(self.elastic, self.strength.at(before.re()));
        let mut order = values;
        order.sort_by(|x, y| y.total_cmp(x));
        let beyond = first.yields(&order, (0, 2));
        if beyond <= 0.0 {
            return Ok(*trial);
        }
        let axis = |a: usize| Vec3([axes[(0, a)], axes[(1, a)], axes[(2, a)]]);
        let along = |a: usize| axis(a).lift().dot(*trial * axis(a).lift());
        let deviator = trial.re().deviator();
        let most = (0.5 * deviator.contract(deviator)).sqrt() / self.elastic.shear;
        let equation = Hardened { law: self, scale: beyond / self.elastic.shear };
        let data = [along(0), along(1), along(2), before];
        let strain = root(&equation, softening::bracket(before.re(), 2.0 * most), &data, "Mohr-Coulomb")?;
        let stress = Surface::new(self.elastic, self.strength.at(strain.re())).of(trial)?;
        // What the strength adds to the derivatives.
        let numbers = self.strength.at(Dual::<1>::variable(strain.re(), 0));
        let slopes = Surface::new(self.elastic, numbers).returned(values.map(Dual::from));
        let change = strain - strain.re();
        Ok((0..3).fold(stress, |sum, a| {
            let n = axis(a);
            sum + Tensor2::from_fn(|i, j| change * (slopes[a].du[0] * n[i] * n[j]))
        }))
    }
}

impl RateLaw for MohrCoulomb {
    type Vars<T: Scalar> = [T; 3];
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "plastic_shear_strain", kind: VariableKind::Scalar },
        Variable { name: "plastic_volume_strain", kind: VariableKind::Scalar },
        Variable { name: "plastic_work", kind: VariableKind::Scalar },
    ];

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        &[shear, volume, work]: &[T; 3],
        _lapse: Lapse,
    ) -> Result<(Tensor2<T>, [T; 3]), Failure> {
        let trial = stress + self.elastic.stress(&de);
        let (stress, [more_shear, more_volume]) = self.returned(&trial, shear)?;
        let done = self.plastic_work(&trial, &stress);
        Ok((stress, [shear + more_shear, volume + more_volume, work + done]))
    }

    fn flow(&self) -> Flow {
        // No dilatancy goes beyond the friction.
        if self.strength.first()[0] == 0.0 { Flow::Isochoric } else { Flow::Dilatant }
    }

    fn own_update(&self) -> Option<Update> {
        self.strength.changes().then_some(Update::ADAPTIVE)
    }

    fn stored_energy(&self, stress: &Tensor2, _: &[f64; 3]) -> f64 {
        self.elastic.energy(stress)
    }

    fn dissipation(&self, old: (&Tensor2, &[f64; 3]), new: (&Tensor2, &[f64; 3])) -> f64 {
        new.1[2] - old.1[2]
    }
}

impl MohrCoulomb {
    /// Work of a stress on the plastic strain that took the trial stress to it.
    pub(super) fn plastic_work<T: Scalar>(&self, trial: &Tensor2<T>, stress: &Tensor2<T>) -> T {
        let lost = *trial - *stress;
        let shape = stress.deviator().contract(lost.deviator()) * (0.5 / self.elastic.shear);
        shape + stress.trace() * lost.trace() * (1.0 / (9.0 * self.elastic.bulk()))
    }
}
