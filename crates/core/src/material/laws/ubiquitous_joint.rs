//! Fractured rock: Mohr and Coulomb's matrix cut everywhere by joints of one direction (ubiquitous joints, Jaeger 1960).
//!
//! On the plane of the joint with normal `n`, `t = sigma n`, `s_n = n.t`, `tau = |t - s_n n|` (tension positive):
//! `f = tau + s_n tan phi_j - c_j` with flow by the angle of dilatancy, and `s_n <= s_t`. The normal turns with the
//! frame. Returns to the matrix and to the joint alternate, each exact, until neither moves the stress: two passes mostly.

use super::axes::component;
use super::drucker_prager::{COHESION, DILATANCY, FRICTION, check_angles};
use super::elastic::{Elastic, POISSON, YOUNG};
use super::mohr_coulomb::MohrCoulomb;
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, VariableKind};
use crate::integrate::Update;
use crate::material::{Flow, Lapse, Material, RateLaw, ScalarsAndVectors, Variable};
use crate::tensor::{Scalar, Tensor2, Vec3};

pub(super) const ENTRY: Entry<Box<dyn Material>> = Entry {
    name: "ubiquitous_joint",
    meaning: "fractured rock: Mohr-Coulomb with joints of one direction, which turn with it",
    parameters: &[
        YOUNG,
        POISSON,
        COHESION,
        FRICTION,
        DILATANCY,
        Parameter { key: "joint_cohesion", meaning: "cohesion of the joints", ..COHESION },
        Parameter { key: "joint_friction", meaning: "angle of friction of the joints", ..FRICTION },
        Parameter { key: "joint_dilatancy", meaning: "angle of dilatancy of the joints", ..DILATANCY },
        Parameter {
            key: "joint_tension",
            meaning: "tensile strength across the joints",
            default: Some(0.0),
            ..COHESION
        },
        component("normal_x", "normal of the joints along x, of any length", None),
        component("normal_y", "normal along y", None),
        component("normal_z", "normal along z", Some(0.0)),
    ],
    pairs: None,
    build: |v| {
        let normal = Vec3::new(v[9], v[10], v[11]);
        if normal.norm() == 0.0 {
            return Err("`normal_x`, `normal_y` and `normal_z` are zero: the joints have no direction".into());
        }
        check_angles(v[3], v[4])?;
        check_angles(v[6], v[7])
            .map_err(|_| format!("`joint_dilatancy`, {}, must not exceed `joint_friction`", v[7]))?;
        let elastic = Elastic::new(v[0], v[1]);
        let joint = Joint {
            elastic,
            cohesion: v[5],
            friction: v[6].to_radians().tan(),
            dilatancy: v[7].to_radians().tan(),
            tension: v[8],
        };
        if joint.tension * joint.friction > joint.cohesion {
            return Err(format!("`joint_tension`, {}, lies beyond the tip of the friction cone", v[8]));
        }
        let matrix = MohrCoulomb::new(elastic, v[2], [v[3].to_radians(), v[4].to_radians()]);
        Ok(rate(UbiquitousJoint { matrix, joint, normal: normal.unit() }))
    },
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UbiquitousJoint {
    matrix: MohrCoulomb,
    joint: Joint,
    /// Unit normal of the joints at the beginning.
    normal: Vec3,
}

/// The joints, with tangents of their angles.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Joint {
    elastic: Elastic,
    cohesion: f64,
    friction: f64,
    dilatancy: f64,
    tension: f64,
}

/// What a joint does in a return: its slip, its opening, and the work on both.
type Motion<T> = [T; 3];

impl Joint {
    /// Shear stress where the tensile strength is reached.
    fn corner(&self) -> f64 {
        self.cohesion - self.tension * self.friction
    }

    /// Slip and opening that bring the plane's normal stress and shear stress back.
    fn motion<T: Scalar>(&self, normal: T, shear: T) -> Option<[T; 2]> {
        let (g, m) = (self.elastic.shear, self.elastic.lambda + 2.0 * self.elastic.shear);
        let beyond = normal.re() > self.tension;
        if beyond && shear.re() <= self.corner() {
            return Some([T::from(0.0), (normal - self.tension) / m]);
        }
        let f = shear + normal * self.friction - self.cohesion;
        if !beyond && f.re() <= 0.0 {
            return None;
        }
        let slip = f * (1.0 / (g + self.friction * self.dilatancy * m));
        if (normal - slip * (self.dilatancy * m)).re() <= self.tension {
            return Some([slip, slip * self.dilatancy]);
        }
        Some([(shear - self.corner()) / g, (normal - self.tension) / m])
    }

    /// The stress that the joints of unit normal `n` bear; nothing if they bear it as it is.
    fn returned<T: Scalar>(&self, stress: &Tensor2<T>, n: Vec3<T>) -> Option<(Tensor2<T>, Motion<T>)> {
        let (g, lambda) = (self.elastic.shear, self.elastic.lambda);
        let traction = *stress * n;
        let normal = n.dot(traction);
        let along = traction - n * normal;
        // The root of zero has no slope; without shear there is no slip either.
        let shear = if along.dot(along).re() > 0.0 { along.norm() } else { T::from(0.0) };
        let [slip, opening] = self.motion(normal, shear)?;
        let s = if slip.re() > 0.0 { along * shear.recip() } else { Vec3::zero() };
        let lost = Tensor2::from_fn(|i, j| {
            let across = opening * (n[i] * n[j] * (2.0 * g)) + slip * ((n[i] * s[j] + s[i] * n[j]) * g);
            if i == j { across + opening * lambda } else { across }
        });
        let (shear, normal) = (shear - slip * g, normal - opening * (lambda + 2.0 * g));
        Some((*stress - lost, [slip, opening, shear * slip + normal * opening]))
    }
}

/// Most passes over matrix and joint, and the part of the stress that the last may still move.
const PASSES: usize = 100;
const STILL: f64 = 1e-13;

type State<T> = ScalarsAndVectors<T, 5, 1>;

impl RateLaw for UbiquitousJoint {
    type Vars<T: Scalar> = State<T>;
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "plastic_shear_strain", kind: VariableKind::Scalar },
        Variable { name: "plastic_volume_strain", kind: VariableKind::Scalar },
        Variable { name: "joint_slip", kind: VariableKind::Scalar },
        Variable { name: "joint_opening", kind: VariableKind::Scalar },
        Variable { name: "plastic_work", kind: VariableKind::Scalar },
        Variable { name: "joint_normal", kind: VariableKind::Vector },
    ];

    fn initial(&self, state: &mut [f64]) {
        state[11..14].copy_from_slice(&self.normal.0);
    }

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        vars: &State<T>,
        _lapse: Lapse,
    ) -> Result<(Tensor2<T>, State<T>), Failure> {
        let (mut stress, mut vars) = (stress + self.joint.elastic.stress(&de), *vars);
        let size = stress.re().contract(stress.re()).sqrt();
        for _ in 0..PASSES {
            let trial = stress;
            let (borne, [shear, volume]) = self.matrix.returned(&trial, vars.scalars[0])?;
            vars.scalars[0] += shear;
            vars.scalars[1] += volume;
            vars.scalars[4] += self.matrix.plastic_work(&trial, &borne);
            let Some((joined, motion)) = self.joint.returned(&borne, vars.vectors[0]) else { return Ok((borne, vars)) };
            (0..3).for_each(|i| vars.scalars[2 + i] += motion[i]);
            stress = joined;
            let beyond = joined.re() - self.matrix.returned(&joined.re(), vars.scalars[0].re())?.0;
            if beyond.contract(beyond).sqrt() <= STILL * size {
                return Ok((stress, vars));
            }
        }
        Err(Failure::new("ubiquitous joint: matrix and joint do not agree on a stress"))
    }

    fn own_update(&self) -> Option<Update> {
        Some(Update::ADAPTIVE)
    }

    fn flow(&self) -> Flow {
        Flow::Dilatant
    }

    fn stored_energy(&self, stress: &Tensor2, _: &State<f64>) -> f64 {
        self.joint.elastic.energy(stress)
    }

    fn dissipation(&self, old: (&Tensor2, &State<f64>), new: (&Tensor2, &State<f64>)) -> f64 {
        new.1.scalars[4] - old.1.scalars[4]
    }
}
