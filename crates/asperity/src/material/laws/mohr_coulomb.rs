//! Mohr and Coulomb's plasticity, non-associated, in principal stresses (tension positive, `a >= b >= c`):
//! `f_ac = (a - c) + (a + c) sin phi - 2 c0 cos phi`, flow by the same with the dilatancy.
//!
//! A stress beyond the surface returns to the main plane; where that would change the order of the principal stresses,
//! to the edge of two planes; where it does even then, to the apex `c0 cot phi` (de Souza Neto et al. 2008). Each
//! return is linear, since cohesion and angles are constant.

use super::drucker_prager::{COHESION, DILATANCY, FRICTION, check_angles};
use super::elastic::{Elastic, POISSON, YOUNG};
use super::rate;
use crate::Failure;
use crate::declare::{Entry, VariableKind};
use crate::material::{Flow, Material, RateLaw, Variable};
use crate::tensor::{Isotropic, Scalar, Tensor2};

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

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MohrCoulomb {
    elastic: Elastic,
    sin_friction: f64,
    sin_dilatancy: f64,
    /// `2 c cos phi`.
    strength: f64,
    /// Mean stress of the apex; none without friction.
    apex: Option<f64>,
}

/// A pair of principal stresses, the larger first.
type Plane = (usize, usize);

impl MohrCoulomb {
    /// From elasticity, cohesion, and the angles of friction and dilatancy in radians.
    pub fn new(elastic: Elastic, cohesion: f64, [friction, dilatancy]: [f64; 2]) -> Self {
        Self {
            elastic,
            sin_friction: friction.sin(),
            sin_dilatancy: dilatancy.sin(),
            strength: 2.0 * cohesion * friction.cos(),
            apex: (friction > 0.0).then(|| cohesion / friction.tan()),
        }
    }

    fn yields<S: Scalar>(&self, s: &[S; 3], (i, j): Plane) -> S {
        s[i] - s[j] + (s[i] + s[j]) * self.sin_friction - self.strength
    }

    /// Elastic stress of unit flow on a plane.
    fn flow_stress(&self, (i, j): Plane) -> [f64; 3] {
        let mut flow = [self.elastic.lambda * 2.0 * self.sin_dilatancy; 3];
        flow[i] += 2.0 * self.elastic.shear * (1.0 + self.sin_dilatancy);
        flow[j] -= 2.0 * self.elastic.shear * (1.0 - self.sin_dilatancy);
        flow
    }

    /// Return to one plane.
    fn onto_plane<S: Scalar>(&self, s: &[S; 3], plane: Plane) -> [S; 3] {
        let flow = self.flow_stress(plane);
        let amount = self.yields(s, plane) / (self.yields(&flow, plane) + self.strength);
        std::array::from_fn(|k| s[k] - amount * flow[k])
    }

    /// Return to the edge of two planes.
    fn onto_edge<S: Scalar>(&self, s: &[S; 3], planes: [Plane; 2]) -> [S; 3] {
        let flows = planes.map(|plane| self.flow_stress(plane));
        let slope = |k: usize, l: usize| self.yields(&flows[l], planes[k]) + self.strength;
        let [f, g] = planes.map(|plane| self.yields(s, plane));
        let (a, b, c, d) = (slope(0, 0), slope(0, 1), slope(1, 0), slope(1, 1));
        let det = a * d - b * c;
        let (x, y) = ((f * d - g * b) / det, (g * a - f * c) / det);
        std::array::from_fn(|k| s[k] - x * flows[0][k] - y * flows[1][k])
    }
}

/// Principal stresses returned to the surface.
impl Isotropic for MohrCoulomb {
    fn principal<S: Scalar>(&self, s: [S; 3]) -> Result<[S; 3], Failure> {
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| s[j].re().total_cmp(&s[i].re()));
        let [a, b, c] = order;
        if self.yields(&s, (a, c)).re() <= 0.0 {
            return Ok(s);
        }
        let plane = self.onto_plane(&s, (a, c));
        if plane[a].re() >= plane[b].re() && plane[b].re() >= plane[c].re() {
            return Ok(plane);
        }
        // Which edge: the side of the plane through the axis and the flow of the main plane on which the stress lies.
        let (up, down) = (1.0 + self.sin_dilatancy, 1.0 - self.sin_dilatancy);
        let lower = down * s[a].re() - 2.0 * s[b].re() + up * s[c].re() > 0.0;
        let other = if lower { (a, b) } else { (b, c) };
        let edge = self.onto_edge(&s, [(a, c), other]);
        match self.apex {
            Some(apex) if edge[a].re() < edge[c].re() => Ok([S::from(apex); 3]),
            _ => Ok(edge),
        }
    }
}

impl MohrCoulomb {
    /// The admissible stress for a trial one, with the plastic shear and volume strain of the return.
    pub(super) fn returned<T: Scalar>(&self, trial: &Tensor2<T>) -> Result<(Tensor2<T>, [T; 2]), Failure> {
        let stress = self.of(trial)?;
        let lost = *trial - stress;
        let shear = lost.deviator() * T::from(0.5 / self.elastic.shear);
        let volume = lost.trace() * (1.0 / (3.0 * self.elastic.bulk()));
        Ok((stress, [(shear.contract(shear) * 2.0).sqrt(), volume]))
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
        _dt: f64,
    ) -> Result<(Tensor2<T>, [T; 3]), Failure> {
        let trial = stress + self.elastic.stress(&de);
        let (stress, [more_shear, more_volume]) = self.returned(&trial)?;
        let done = self.plastic_work(&trial, &stress);
        Ok((stress, [shear + more_shear, volume + more_volume, work + done]))
    }

    fn flow(&self) -> Flow {
        // No dilatancy goes beyond the friction.
        if self.sin_friction == 0.0 { Flow::Isochoric } else { Flow::Dilatant }
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
