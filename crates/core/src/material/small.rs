//! Rate laws in small strain: the strain of an increment is the symmetric part of its displacement gradient, taken over
//! the undeformed body, and nothing turns. What an elastic law makes of it is linear in the displacements.

use super::frame::{Still, Turning};
use super::law::Differentiate;
use super::rate::stress_of;
use super::{Creep, Directions, Flow, Gradient, Lapse, Material, Rate, RateLaw, Spin, Variable};
use crate::Failure;
use crate::integrate::Update;
use crate::tensor::Tensor2;

/// A [`RateLaw`] as a [`Material`] in small strain: its deformation is `I` and the displacement gradient of the increment.
#[derive(Debug, Clone)]
pub struct SmallStrain<L>(Rate<L>);

impl<L: RateLaw> SmallStrain<L> {
    /// The law in small strain.
    pub fn new(law: L) -> Self {
        Self(Rate(law))
    }
}

impl<L: RateLaw> Differentiate for SmallStrain<L> {
    fn advance_dual<const N: usize>(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        out: (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        self.0.advance_in::<N>(&Still::new(f, &stress_of(old)), lapse, old, out, directions.components())
    }
}

impl<L: RateLaw> Material for SmallStrain<L> {
    fn variables(&self) -> &[Variable] {
        self.0.variables()
    }

    fn initialise(&self, state: &mut [f64]) {
        self.0.initialise(state);
    }

    fn bears(&self, state: &[f64]) -> Result<(), String> {
        self.0.bears(state)
    }

    fn creep(&self, state: &[f64]) -> Option<Creep> {
        self.0.creep(state)
    }

    fn with_update(&self, update: Update) -> Result<Box<dyn Material>, String> {
        self.0.with_update(update)?.with_small_strain()
    }

    fn with_spin(&self, _: Spin) -> Result<Box<dyn Material>, String> {
        Err(NO_RATE.into())
    }

    fn with_small_strain(&self) -> Result<Box<dyn Material>, String> {
        Ok(Box::new(self.clone()))
    }

    fn update(&self, f: &Tensor2, lapse: Lapse, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        self.0.update_in(&Still::new(f, &stress_of(old)).values(), lapse, old, new)
    }

    fn differentiate(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        out: (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        self.advance_along(f, lapse, old, out, directions)
    }

    fn axes_at(&self) -> Option<usize> {
        self.0.axes_at()
    }

    fn mean_moduli(&self) -> Option<[f64; 2]> {
        self.0.mean_moduli()
    }

    fn flow(&self) -> Flow {
        self.0.flow()
    }

    fn stored_energy(&self, state: &[f64]) -> f64 {
        self.0.stored_energy(state)
    }

    fn dissipation(&self, old: &[f64], new: &[f64]) -> f64 {
        self.0.dissipation(old, new)
    }
}

/// Why small strain takes no objective rate.
pub(super) const NO_RATE: &str =
    "nothing turns in small strain: there is no objective rate to choose; leave `rate` out";
