//! Rate laws in a frame whose spin follows from the whole deformation: that of Green and Naghdi, or the logarithmic one.
//!
//! What the frame has to remember of the deformation is a symmetric tensor, a history variable of its own behind those of
//! the law: the left stretch `V` of [Green and Naghdi](super::green_naghdi), the logarithmic strain `ln V` of the
//! [logarithmic rate](super::logarithmic).

use super::law::{Advance, Creep, Differentiate};
use super::rate::{INSIDE_OUT, stress_of};
use super::small::NO_RATE;
use super::{
    Directions, Flow, Gradient, Lapse, Material, Rate, RateLaw, Variable, VariableKind, Vars, green_naghdi, logarithmic,
};
use crate::integrate::Update;
use crate::tensor::{Scalar, Tensor2};
use crate::{Failure, FailureKind};

/// The spin of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spin {
    /// Of the polar rotation (Green and Naghdi).
    Polar,
    /// With which the rate of the logarithmic strain is the rate of deformation (Xiao, Bruhns and Meyers).
    Logarithmic,
}

/// A [`RateLaw`] as a [`Material`] in a frame with one of the spins.
#[derive(Debug, Clone)]
pub struct Turned<L> {
    law: L,
    spin: Spin,
    variables: Vec<Variable>,
}

/// What a frame makes of an increment: strain, rotation, and the tensor that it remembers.
pub(super) struct Turn<T> {
    pub de: Tensor2<T>,
    pub q: Tensor2<T>,
    pub memory: Tensor2,
}

impl<L: RateLaw> Turned<L> {
    /// The law in this frame.
    pub fn new(law: L, spin: Spin) -> Self {
        let name = match spin {
            Spin::Polar => "left_stretch",
            Spin::Logarithmic => "frame_strain",
        };
        let memory = Variable { name, kind: VariableKind::Symmetric };
        Self { law, spin, variables: L::VARIABLES.iter().copied().chain([memory]).collect() }
    }

    /// Where the tensor of the frame begins in the state.
    fn memory_at(&self) -> usize {
        self.state_len() - 6
    }
}

impl<L: RateLaw> Advance for Turned<L> {
    fn advance<T: Scalar>(
        &self,
        f: &Tensor2<T>,
        lapse: Lapse,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<Tensor2<T>, Failure> {
        if f.det().re() <= 0.0 {
            return Err(Failure::new(INSIDE_OUT).of(FailureKind::Inverted));
        }
        let at = self.memory_at();
        let memory = Tensor2::from_voigt(std::array::from_fn(|i| old[at + i]));
        let Turn { de, q, memory } = match self.spin {
            Spin::Polar => green_naghdi::turn(f, &memory)?,
            Spin::Logarithmic => logarithmic::turn(f, &memory)?,
        };
        let stress = q * stress_of(old).lift() * q.transpose();
        let vars = L::Vars::<T>::read(&old[6..at]).rotate(&q);
        let (stress, vars) = self.law.update(de, stress, &vars, lapse)?;
        new[..6].copy_from_slice(&stress.re().to_voigt());
        vars.write(&mut new[6..at]);
        new[at..at + 6].copy_from_slice(&memory.to_voigt());
        Ok(stress)
    }
}

impl<L: RateLaw> Material for Turned<L> {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn initialise(&self, state: &mut [f64]) {
        state.fill(0.0);
        let at = self.memory_at();
        self.law.initial(&mut state[..at]);
        if self.spin == Spin::Polar {
            state[at..at + 3].fill(1.0);
        }
    }

    fn bears(&self, state: &[f64]) -> Result<(), String> {
        Rate(self.law.clone()).bears(&state[..self.memory_at()])
    }

    fn with_update(&self, update: Update) -> Result<Box<dyn Material>, String> {
        self.law.serves(update)?;
        self.law.updated(update).with_spin(self.spin)
    }

    fn creep(&self, state: &[f64]) -> Option<Creep> {
        self.law.creep(&stress_of(state), &L::Vars::read(&state[6..self.memory_at()]))
    }

    fn own_update(&self) -> Option<Update> {
        self.law.own_update()
    }

    fn with_spin(&self, spin: Spin) -> Result<Box<dyn Material>, String> {
        Ok(Box::new(Self::new(self.law.clone(), spin)))
    }

    fn axes_at(&self) -> Option<usize> {
        L::AXES
    }

    fn mean_moduli(&self) -> Option<[f64; 2]> {
        self.law.mean_moduli()
    }

    fn flow(&self) -> Flow {
        self.law.flow()
    }

    fn own_spin(&self) -> Option<Spin> {
        self.law.own_spin()
    }

    fn with_small_strain(&self) -> Result<Box<dyn Material>, String> {
        Err(NO_RATE.into())
    }

    fn update(&self, f: &Tensor2, lapse: Lapse, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        self.advance(f, lapse, old, new).map(|_| ())
    }

    fn differentiate(
        &self,
        f: &Tensor2,
        lapse: Lapse,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        self.advance_along(f, lapse, old, (new, gradient), directions)
    }

    fn stored_energy(&self, state: &[f64]) -> f64 {
        self.law.stored_energy(&stress_of(state), &L::Vars::read(&state[6..self.memory_at()]))
    }

    fn dissipation(&self, old: &[f64], new: &[f64]) -> f64 {
        let vars = |state: &[f64]| L::Vars::<f64>::read(&state[6..self.memory_at()]);
        self.law.dissipation((&stress_of(old), &vars(old)), (&stress_of(new), &vars(new)))
    }
}
