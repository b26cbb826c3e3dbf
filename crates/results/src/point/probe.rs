//! The driven point.

use super::course::{COMPONENTS, PathControl, Stage};
use super::newton::Increment;
use super::tangent::PointTangentCheck;
use asperity_core::material::{Lapse, Material};
use asperity_core::tensor::Tensor2;
use asperity_core::{Error, Failure};

/// Most times that an increment is halved.
const HALVINGS: u32 = 14;

/// A material point: its law, its strains and the state of its law.
pub struct MaterialPointDriver<'a> {
    /// The law.
    pub material: &'a dyn Material,
    /// Strains: logarithms of the stretches, then shears.
    pub strain: [f64; 6],
    /// State of the law: the Cauchy stress, then its variables.
    pub state: Vec<f64>,
    /// Time.
    pub time: f64,
    /// Temperature above that of the room.
    pub temperature: f64,
    /// Energy dissipated so far per undeformed volume.
    pub dissipated: f64,
    /// Compares the tangents of all increments with differences, where it is asked to.
    pub check: Option<PointTangentCheck>,
    /// Strain rates of the last increment, for the first guess of the next.
    rate: [f64; 6],
    modulus: f64,
}

/// `[[exp e_xx, e_xy, e_xz], [0, exp e_yy, e_yz], [0, 0, exp e_zz]]`.
pub(super) fn deformation(e: &[f64; 6]) -> Tensor2 {
    Tensor2([[e[0].exp(), e[3], e[5]], [0.0, e[1].exp(), e[4]], [0.0, 0.0, e[2].exp()]])
}

impl<'a> MaterialPointDriver<'a> {
    /// The undeformed point, with a given stress where that of the law is not wanted.
    pub fn new(material: &'a dyn Material, stress: Option<[f64; 6]>) -> Self {
        let mut state = vec![0.0; material.state_len()];
        material.initialise(&mut state);
        if let Some(stress) = stress {
            state[..6].copy_from_slice(&stress);
        }
        let [modulus, _] = material.moduli();
        Self {
            material,
            strain: [0.0; 6],
            state,
            time: 0.0,
            temperature: 0.0,
            dissipated: 0.0,
            check: None,
            rate: [0.0; 6],
            modulus,
        }
    }

    /// Goes along a stage and calls `seen` at the end of each of its increments. An increment that the law or the
    /// iteration refuses is halved.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the stage, the time and the reason where the path cannot be followed.
    pub fn follow(&mut self, stage: &Stage, mut seen: impl FnMut(&Self)) -> Result<(), Error> {
        let ends = Ends::of(stage, self);
        let steps = stage.increments as f64;
        for i in 0..stage.increments {
            self.advance(&ends, [i as f64 / steps, (i + 1) as f64 / steps], 0).map_err(|failure| {
                let lost = "the path cannot be followed beyond the time";
                Error::NotConverged(format!("{}: {lost} {}: {failure}", stage.name, self.time))
            })?;
            self.time = ends.time + stage.duration * (i + 1) as f64 / steps;
            seen(self);
        }
        Ok(())
    }

    /// Goes from one fraction of a stage to another.
    fn advance(&mut self, ends: &Ends, [from, to]: [f64; 2], depth: u32) -> Result<(), Failure> {
        match self.attempt(ends, [from, to]) {
            Err(_) if depth < HALVINGS => {
                let middle = 0.5 * (from + to);
                self.advance(ends, [from, middle], depth + 1)?;
                self.advance(ends, [middle, to], depth + 1)
            }
            done => done,
        }
    }

    fn attempt(&mut self, ends: &Ends, [from, to]: [f64; 2]) -> Result<(), Failure> {
        let dt = ends.duration * (to - from);
        let [cold, hot] = ends.temperature;
        let lapse = Lapse { dt, temperature: Some([self.temperature, cold + (hot - cold) * to]) };
        let increment = Increment {
            material: self.material,
            old: &self.state,
            strain: self.strain,
            stress: ends.stress.map(|two| two.map(|[start, end]| start + (end - start) * to)),
            lapse,
            modulus: self.modulus,
        };
        let guess = |rate: &[f64; 6]| -> [f64; 6] {
            std::array::from_fn(|i| ends.strain[i].map_or(self.strain[i] + rate[i] * dt, |[a, b]| a + (b - a) * to))
        };
        let solved = increment.solve(guess(&self.rate)).or_else(|_| increment.solve(guess(&[0.0; 6])));
        let (strain, new) = solved?;
        if let Some(check) = &mut self.check {
            let f = deformation(&strain) * deformation(&self.strain).inverse();
            check.compare(self.material, (&self.state, &f, lapse), ends.time + ends.duration * to);
        }
        let volume = strain[0] + strain[1] + strain[2];
        self.dissipated += self.material.dissipation(&self.state, &new) * volume.exp();
        self.rate = std::array::from_fn(|i| (strain[i] - self.strain[i]) / dt);
        (self.strain, self.state) = (strain, new);
        self.time = ends.time + ends.duration * to;
        self.temperature = cold + (hot - cold) * to;
        Ok(())
    }

    /// Mean stress, tension positive.
    pub fn mean_stress(&self) -> f64 {
        (self.state[0] + self.state[1] + self.state[2]) / 3.0
    }

    /// Equivalent stress of von Mises.
    pub fn von_mises(&self) -> f64 {
        let s = Tensor2::from_voigt(std::array::from_fn(|i| self.state[i])).deviator();
        (1.5 * s.contract(s)).sqrt()
    }
}

/// A stage as the point meets it: for each component the values at both ends.
struct Ends {
    time: f64,
    duration: f64,
    strain: [Option<[f64; 2]>; 6],
    stress: [Option<[f64; 2]>; 6],
    temperature: [f64; 2],
}

impl Ends {
    fn of(stage: &Stage, probe: &MaterialPointDriver) -> Self {
        let strain = |i: usize| match stage.controls[i] {
            PathControl::Strain(end) => Some([probe.strain[i], end]),
            _ => None,
        };
        let stress = |i: usize| stage.controls[i].stress(probe.state[i]).map(|end| [probe.state[i], end]);
        Self {
            time: probe.time,
            duration: stage.duration,
            strain: std::array::from_fn(strain),
            stress: std::array::from_fn(stress),
            temperature: [probe.temperature, stage.temperature.unwrap_or(probe.temperature)],
        }
    }
}

/// Names of the strains or stresses: `strain_xx`.
pub(super) fn named(what: &str) -> impl Iterator<Item = String> {
    COMPONENTS.map(|component| format!("{what}_{component}")).into_iter()
}
