//! A soil whose pore water cannot leave: the stress is that of its skeleton less the excess pore pressure `u`, which the change
//! of volume makes, `u = -K_w/n ln(V/V_0)` with the bulk modulus `K_w` of the water and the porosity `n`; in small strain
//! `u = -K_w/n tr(e)`. The skeleton follows its own law, which sees the effective stress (Terzaghi 1923). The stress of the
//! beginning is effective: the pressure that the water had then is none of the excess.

use super::{Directions, Flow, Gradient, Lapse, Material, Placement, Spin, Variable, VariableKind};
use crate::Failure;
use crate::integrate::Update;
use crate::tensor::Tensor2;
use std::sync::Arc;

/// A law of a soil with pore water that stays.
pub struct Undrained {
    soil: Arc<dyn Material>,
    /// Bulk modulus of the water over the porosity.
    bulk: f64,
    /// Whether strain is small.
    small: bool,
    variables: Vec<Variable>,
}

/// Most values of the state of a skeleton, which is copied at each point.
const MOST: usize = 64;

impl Undrained {
    /// A soil in finite strain, and the bulk modulus of the water over the porosity.
    ///
    /// # Errors
    /// In words, where the law is none of a soil.
    pub fn new(soil: Arc<dyn Material>, bulk: f64) -> Result<Self, String> {
        if soil.has_potential() {
            return Err(
                "the stress of a hyperelastic law follows from the deformation alone: it has no pore water".into()
            );
        }
        Self::of(soil, bulk, false)
    }

    fn of(soil: Arc<dyn Material>, bulk: f64, small: bool) -> Result<Self, String> {
        if soil.state_len() > MOST {
            return Err(format!("the law keeps {} values, and pore water goes with {MOST} at most", soil.state_len()));
        }
        let pressure = Variable { name: "excess_pore_pressure", kind: VariableKind::Scalar };
        let variables = soil.variables().iter().copied().chain([pressure]).collect();
        Ok(Self { soil, bulk, small, variables })
    }

    /// The same water in another form of the law.
    fn with(&self, soil: Box<dyn Material>, small: bool) -> Result<Box<dyn Material>, String> {
        Ok(Box::new(Self::of(Arc::from(soil), self.bulk, small)?))
    }

    /// Where the pressure of the water is in a state; what the cell keeps of its own may follow.
    fn place(&self) -> usize {
        self.soil.state_len()
    }

    /// What a function makes of the state of the skeleton.
    fn effective<R>(&self, state: &[f64], of: impl FnOnce(&[f64]) -> R) -> R {
        let (total, pressure) = (&state[..self.place()], state[self.place()]);
        let mut skeleton = [0.0; MOST];
        let skeleton = &mut skeleton[..total.len()];
        skeleton.copy_from_slice(total);
        skeleton[..3].iter_mut().for_each(|normal| *normal += pressure);
        of(skeleton)
    }

    /// Change of the logarithm of the volume.
    fn dilation(&self, f: &Tensor2) -> f64 {
        if self.small { f.trace() - 3.0 } else { f.det().ln() }
    }

    /// The state with the water in it.
    fn fill(&self, f: &Tensor2, old: &[f64], new: &mut [f64]) {
        let last = self.place();
        new[last] = old[last] - self.bulk * self.dilation(f);
        let pressure = new[last];
        new[..3].iter_mut().for_each(|normal| *normal -= pressure);
    }
}

impl Material for Undrained {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn initialise(&self, state: &mut [f64]) {
        let last = self.place();
        self.soil.initialise(&mut state[..last]);
        state[last] = 0.0;
    }

    fn initialise_at(&self, state: &mut [f64], at: &Placement) {
        let last = self.place();
        self.soil.initialise_at(&mut state[..last], at);
        state[last] = 0.0;
    }

    fn bears(&self, state: &[f64]) -> Result<(), String> {
        self.effective(state, |skeleton| self.soil.bears(skeleton))
    }

    fn own_update(&self) -> Option<Update> {
        self.soil.own_update()
    }

    fn with_update(&self, update: Update) -> Result<Box<dyn Material>, String> {
        self.with(self.soil.with_update(update)?, self.small)
    }

    fn with_spin(&self, spin: Spin) -> Result<Box<dyn Material>, String> {
        self.with(self.soil.with_spin(spin)?, self.small)
    }

    fn with_small_strain(&self) -> Result<Box<dyn Material>, String> {
        self.with(self.soil.with_small_strain()?, true)
    }

    fn axes_at(&self) -> Option<usize> {
        self.soil.axes_at()
    }

    /// The water lets the volume change hardly at all.
    fn flow(&self) -> Flow {
        if self.soil.flow() == Flow::None { Flow::None } else { Flow::Isochoric }
    }

    fn own_spin(&self) -> Option<Spin> {
        self.soil.own_spin()
    }

    fn advice(&self) -> Option<&'static str> {
        self.soil.advice()
    }

    fn update(&self, f: &Tensor2, lapse: Lapse, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        let last = self.place();
        self.effective(old, |old| self.soil.update(f, lapse, old, &mut new[..last]))?;
        self.fill(f, old, new);
        Ok(())
    }

    /// With `d ln det(f) = f^-T : df`.
    fn differentiate(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        let last = self.place();
        let out = (&mut new[..last], &mut *gradient);
        self.effective(old, |old| self.soil.differentiate(f, lapse, old, out, directions))?;
        self.fill(f, old, new);
        let along = if self.small { Tensor2::identity() } else { f.inverse().transpose() };
        for (d, &place) in directions.components().iter().enumerate() {
            gradient[..3].iter_mut().for_each(|row| row[d] += self.bulk * along[place]);
        }
        Ok(())
    }

    fn stored_energy(&self, state: &[f64]) -> f64 {
        let pressure = state[self.place()];
        self.effective(state, |skeleton| self.soil.stored_energy(skeleton)) + 0.5 * pressure * pressure / self.bulk
    }

    fn dissipation(&self, old: &[f64], new: &[f64]) -> f64 {
        self.effective(old, |old| self.effective(new, |new| self.soil.dissipation(old, new)))
    }
}
