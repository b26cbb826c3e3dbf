//! Drucker and Prager's plasticity, non-associated: `f = sqrt(J2) + eta p - xi c` (tension positive), flow along
//! `sqrt(J2) + eta_b p`, return to the cone or, where its deviator would turn over, to the apex `p = xi c/eta`.
//!
//! The cone touches Mohr and Coulomb's at the outer or inner edges, or gives the same limit load in plane strain. In
//! plane strain `eta_b` is the associated value of the dilatancy `psi` and `eta = 3 sin phi/d`, `xi = 3 cos phi/d`,
//! `d = sin phi eta_b + 3 sqrt(1 - eta_b^2/3)`, so that the match holds for non-associated flow too.
//!
//! Where the strength changes with the plastic shear strain, `eta`, `eta_b` and `xi c` do (see [`Changing`]), and one equation
//! is solved for the strain at the end of the step.

use super::elastic::{Elastic, POISSON, YOUNG};
use super::hardening::join;
use super::rate;
use super::softening::{self, Changing};
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::integrate::{System, Update, root};
use crate::material::{Flow, Lapse, Material, RateLaw, Variable};
use crate::tensor::{Scalar, Tensor2};

pub(super) const COHESION: Parameter =
    Parameter { key: "cohesion", meaning: "cohesion", unit: unit::STRESS, range: Range::NOT_NEGATIVE, default: None };

pub(super) const FRICTION: Parameter = Parameter {
    key: "friction",
    meaning: "angle of internal friction",
    unit: unit::DEGREES,
    range: Range { least: Some((0.0, true)), most: Some((89.0, true)) },
    default: None,
};

pub(super) const DILATANCY: Parameter = Parameter {
    key: "dilatancy",
    meaning: "angle of dilatancy; the angle of friction for associated flow",
    unit: unit::DEGREES,
    range: Range { least: Some((0.0, true)), most: Some((89.0, true)) },
    default: Some(0.0),
};

static PARAMETERS: &[Parameter] = &[YOUNG, POISSON, COHESION, FRICTION, DILATANCY];

pub(super) const OUTER: Entry<Box<dyn Material>> = Entry {
    name: "drucker_prager",
    meaning: "Drucker-Prager plasticity, the cone through Mohr-Coulomb's outer edges (triaxial compression)",
    parameters: PARAMETERS,
    pairs: None,
    build: |v| build(v, Cone::Outer),
};

pub(super) const INNER: Entry<Box<dyn Material>> = Entry {
    name: "drucker_prager_inner",
    meaning: "Drucker-Prager plasticity, the cone through Mohr-Coulomb's inner edges (triaxial extension)",
    parameters: PARAMETERS,
    pairs: None,
    build: |v| build(v, Cone::Inner),
};

pub(super) const PLANE_STRAIN: Entry<Box<dyn Material>> = Entry {
    name: "drucker_prager_plane_strain",
    meaning: "Drucker-Prager plasticity, the cone with Mohr-Coulomb's limit load in plane strain",
    parameters: PARAMETERS,
    pairs: None,
    build: |v| build(v, Cone::PlaneStrain),
};

pub(super) const HARDENING: Entry<Box<dyn Material>> = Entry {
    name: "drucker_prager_hardening",
    meaning: "Drucker-Prager plasticity by the outer edges whose strength rises or falls with the plastic shear strain",
    parameters: &join::<9>(&[&[YOUNG, POISSON], &softening::PARAMETERS]),
    pairs: None,
    build: |v| {
        let strength =
            Changing::declared(&v[2..], |cohesion, angles| DruckerPrager::numbers(cohesion, angles, Cone::Outer))?;
        Ok(rate(DruckerPrager { elastic: Elastic::new(v[0], v[1]), strength }))
    },
};

fn build(v: &[f64], cone: Cone) -> Result<Box<dyn Material>, String> {
    check_angles(v[3], v[4])?;
    let angles = [v[3].to_radians(), v[4].to_radians()];
    Ok(rate(DruckerPrager::new(Elastic::new(v[0], v[1]), v[2], angles, cone)))
}

/// A dilatancy beyond the friction would give out energy.
pub(super) fn check_angles(friction: f64, dilatancy: f64) -> Result<(), String> {
    if dilatancy > friction {
        return Err(format!(
            "`dilatancy`, {dilatancy}, must not exceed `friction`, {friction}: the solid would give out energy"
        ));
    }
    Ok(())
}

/// Which of Mohr and Coulomb's states the cone shares.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cone {
    /// Triaxial compression.
    Outer,
    /// Triaxial extension.
    Inner,
    /// Plastic flow in plane strain.
    PlaneStrain,
}

impl Cone {
    /// `eta` and `xi` for friction and dilatancy in radians, then `eta_b`.
    pub(super) fn match_angles(self, friction: f64, dilatancy: f64) -> [f64; 3] {
        let edge = |angle: f64, sign: f64| 3.0_f64.sqrt() * (3.0 - sign * angle.sin()) / 6.0;
        let sign = if self == Self::Outer { 1.0 } else { -1.0 };
        if self != Self::PlaneStrain {
            let d = edge(friction, sign);
            return [friction.sin() / d, friction.cos() / d, dilatancy.sin() / edge(dilatancy, sign)];
        }
        let tan = dilatancy.tan();
        let eta_b = 3.0 * tan / (9.0 + 12.0 * tan * tan).sqrt();
        let d = friction.sin() * eta_b + 3.0 * (1.0 - eta_b * eta_b / 3.0).sqrt();
        [3.0 * friction.sin() / d, 3.0 * friction.cos() / d, eta_b]
    }
}

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DruckerPrager {
    elastic: Elastic,
    /// `eta`, `eta_b` and `xi c`.
    strength: Changing<3>,
}

/// The equation of a step in the plastic shear strain; data are `sqrt(J2)` and `p` of the trial stress and the strain at the
/// beginning.
struct Hardened<'a> {
    law: &'a DruckerPrager,
    scale: f64,
}

impl System<1, 3> for Hardened<'_> {
    fn residual<S: Scalar>(&self, &[strain]: &[S; 1], &[root, p, first]: &[S; 3]) -> [S; 1] {
        let [more, _] = self.law.flow_to(self.law.strength.at(strain), root, p).plastic;
        [(strain - first - more) / self.scale]
    }
}

/// A return: what is left of `sqrt(J2)` as a ratio, the mean stress, and the plastic shear and volume strain.
struct Returned<T> {
    scale: T,
    p: T,
    plastic: [T; 2],
}

impl DruckerPrager {
    /// From elasticity, cohesion, and the angles of friction and dilatancy in radians.
    pub fn new(elastic: Elastic, cohesion: f64, angles: [f64; 2], cone: Cone) -> Self {
        Self { elastic, strength: Changing::constant(Self::numbers(cohesion, angles, cone)) }
    }

    fn numbers(cohesion: f64, [friction, dilatancy]: [f64; 2], cone: Cone) -> [f64; 3] {
        let [eta, xi, eta_b] = cone.match_angles(friction, dilatancy);
        [eta, eta_b, xi * cohesion]
    }

    /// `eta`, `eta_b` and `xi c` after a plastic shear strain.
    fn numbers_at<T: Scalar>(&self, strain: T) -> [T; 3] {
        if self.strength.changes() { self.strength.at(strain) } else { self.strength.first().map(T::from) }
    }

    /// Return to the cone or its apex of a stress beyond.
    fn flow_to<T: Scalar>(&self, [eta, eta_b, strength]: [T; 3], root: T, p: T) -> Returned<T> {
        let (g, k) = (self.elastic.shear, self.elastic.bulk());
        let flow = (root + p * eta - strength) / (eta * eta_b * k + g);
        if flow.re() * g <= root.re() {
            let scale = if root.re() > 0.0 { T::one() - flow * g / root } else { T::one() };
            return Returned { scale, p: p - flow * eta_b * k, plastic: [flow, flow * eta_b] };
        }
        let apex = strength / eta;
        Returned { scale: T::zero(), p: apex, plastic: [root / g, (p - apex) / k] }
    }

    fn beyond<T: Scalar>([eta, _, strength]: [T; 3], root: T, p: T) -> T {
        root + p * eta - strength
    }
}

impl RateLaw for DruckerPrager {
    type Vars<T: Scalar> = [T; 2];
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "plastic_shear_strain", kind: VariableKind::Scalar },
        Variable { name: "plastic_volume_strain", kind: VariableKind::Scalar },
    ];

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        &[shear, volume]: &[T; 2],
        _lapse: Lapse,
    ) -> Result<(Tensor2<T>, [T; 2]), Failure> {
        let trial = stress + self.elastic.stress(&de);
        let (p, s) = (trial.trace() * (1.0 / 3.0), trial.deviator());
        let size = (s.contract(s) * 0.5).sqrt();
        let mut numbers = self.numbers_at(shear);
        let beyond = Self::beyond(numbers, size, p).re();
        if beyond <= 0.0 {
            return Ok((trial, [shear, volume]));
        }
        if self.strength.changes() {
            // Neither the cone nor the apex takes more shear than there is.
            let ends = softening::bracket(shear.re(), size.re() / self.elastic.shear);
            let equation = Hardened { law: self, scale: beyond / self.elastic.shear };
            numbers = self.strength.at(root(&equation, ends, &[size, p, shear], "Drucker-Prager")?);
        }
        let Returned { scale, p, plastic: [more, wider] } = self.flow_to(numbers, size, p);
        Ok((s * scale + Tensor2::identity() * p, [shear + more, volume + wider]))
    }

    fn elastic_step(&self, de: &Tensor2, stress: &Tensor2, &[shear, _]: &[f64; 2], _: Lapse) -> Option<[f64; 2]> {
        let trial = *stress + self.elastic.stress(de);
        let (p, s) = (trial.trace() * (1.0 / 3.0), trial.deviator());
        let f = Self::beyond(self.numbers_at(shear), (s.contract(s) * 0.5).sqrt(), p);
        (f <= 0.0).then_some([self.elastic.lambda, self.elastic.shear])
    }

    fn flow(&self) -> Flow {
        // No dilatancy goes beyond the friction.
        if self.strength.first()[0] == 0.0 { Flow::Isochoric } else { Flow::Dilatant }
    }

    fn own_update(&self) -> Option<Update> {
        self.strength.changes().then_some(Update::ADAPTIVE)
    }

    fn stored_energy(&self, stress: &Tensor2, _: &[f64; 2]) -> f64 {
        self.elastic.energy(stress)
    }

    fn dissipation(&self, old: (&Tensor2, &[f64; 2]), new: (&Tensor2, &[f64; 2])) -> f64 {
        let (p, s) = (new.0.trace() / 3.0, new.0.deviator());
        (0.5 * s.contract(s)).sqrt() * (new.1[0] - old.1[0]) + p * (new.1[1] - old.1[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three returns of a cone whose flow and yield surface have nothing to do with each other: friction 30 degrees by
    /// the associated cone, dilatancy 10, `G = 1000`, `K = 2000`, cohesion 10.
    #[test]
    fn returns_with_the_associated_cone() {
        let [eta, xi, _] = Cone::PlaneStrain.match_angles(30f64.to_radians(), 30f64.to_radians());
        let eta_b = Cone::PlaneStrain.match_angles(30f64.to_radians(), 10f64.to_radians())[2];
        let elastic = Elastic::new(9.0 * 2e6 / 7e3, 2.0 / 7.0);
        let soil = DruckerPrager { elastic, strength: Changing::constant([eta, eta_b, 10.0 * xi]) };
        for ([p, root], wanted) in [
            ([-20.0, 60.0], [-32.46866, 23.91794]),
            ([5.0, 40.0], [-5.10058, 10.77074]),
            ([60.0, 5.0], [17.3205081, 0.0]),
        ] {
            let trial = Tensor2::from_voigt([p + root, p - root, p, 0.0, 0.0, 0.0]);
            let (stress, vars) = soil.update(Tensor2::zero(), trial, &[0.0; 2], 0.0.into()).unwrap();
            let s = stress.deviator();
            for (found, wanted) in [stress.trace() / 3.0, (0.5 * s.contract(s)).sqrt()].into_iter().zip(wanted) {
                assert!((found - wanted).abs() < 6e-6, "{found} instead of {wanted}");
            }
            assert!(p < 50.0 || (vars[1] - 0.0213397).abs() < 5e-8, "{}", vars[1]);
        }
    }
}
