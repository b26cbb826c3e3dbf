//! A rate law whose increments are integrated by sub-steps and a scheme of [`integrate`](crate::integrate).
//!
//! The strain of the objective frame is cut into equal parts of constant rate; stress and variables carry their
//! derivatives from one sub-step to the next, so the tangent is that of the whole.

use super::{Creep, Flow, Lapse, Material, RateLaw, Spin, Variable, Vars};
use crate::Failure;
use crate::integrate::{Blend, Scheme, Update};
use crate::tensor::{Scalar, Tensor2};
use std::marker::PhantomData;

/// A law with the way in which its increments are integrated.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Integrated<L> {
    pub law: L,
    pub update: Update,
}

/// Most values of the variables of a law.
const MOST: usize = 64;

/// Stress and variables as one state.
#[derive(Clone, Copy)]
struct Point<T, V> {
    stress: Tensor2<T>,
    vars: V,
    scalar: PhantomData<T>,
}

impl<T: Scalar, V: Vars<T>> Blend for Point<T, V> {
    type Number = T;
    fn blend(&self, other: &Self, weight: T) -> Self {
        let stress = self.stress + (other.stress - self.stress) * weight;
        Self { stress, vars: self.vars.blend(&other.vars, weight), scalar: PhantomData }
    }
    fn distance(&self, other: &Self) -> T {
        let difference = self.stress - other.stress;
        difference.contract(difference).sqrt()
    }
    fn size(&self) -> T {
        self.stress.contract(self.stress).sqrt()
    }
}

impl<L: RateLaw> RateLaw for Integrated<L> {
    type Vars<T: Scalar> = L::Vars<T>;
    const VARIABLES: &'static [Variable] = L::VARIABLES;
    const AXES: Option<usize> = L::AXES;

    fn initial(&self, state: &mut [f64]) {
        self.law.initial(state);
    }

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        vars: &Self::Vars<T>,
        lapse: Lapse,
    ) -> Result<(Tensor2<T>, Self::Vars<T>), Failure> {
        if matches!(self.update.scheme, Scheme::Adaptive(_)) {
            let mut values = [0.0; MOST];
            vars.write(&mut values);
            if self.elastic_step(&de.re(), &stress.re(), &L::Vars::read(&values), lapse).is_some() {
                return self.law.update(de, stress, vars, lapse);
            }
        }
        let step = |from: &Point<T, L::Vars<T>>, part: f64, end: f64| {
            let (stress, vars) = self.law.update(de * T::from(part), from.stress, &from.vars, lapse.part(part, end))?;
            Ok(Point { stress, vars, scalar: PhantomData })
        };
        let end = self.update.advance(Point { stress, vars: *vars, scalar: PhantomData }, step)?;
        Ok((end.stress, end.vars))
    }

    /// A stress that begins and ends within a convex surface stays there.
    fn elastic_step(&self, de: &Tensor2, stress: &Tensor2, vars: &L::Vars<f64>, lapse: Lapse) -> Option<[f64; 2]> {
        let Scheme::Adaptive(_) = self.update.scheme else { return None };
        self.law.elastic_step(&Tensor2::zero(), stress, vars, lapse.part(0.0, 0.0))?;
        self.law.elastic_step(de, stress, vars, lapse)
    }

    fn stored_energy(&self, stress: &Tensor2, vars: &Self::Vars<f64>) -> f64 {
        self.law.stored_energy(stress, vars)
    }
    fn dissipation(&self, old: (&Tensor2, &Self::Vars<f64>), new: (&Tensor2, &Self::Vars<f64>)) -> f64 {
        self.law.dissipation(old, new)
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
    fn creep(&self, stress: &Tensor2, vars: &L::Vars<f64>) -> Option<Creep> {
        self.law.creep(stress, vars)
    }
    fn own_update(&self) -> Option<Update> {
        self.law.own_update()
    }
    fn serves(&self, update: Update) -> Result<(), String> {
        self.law.serves(update)
    }
    /// Integrated once, not twice.
    fn updated(&self, update: Update) -> Box<dyn Material> {
        self.law.updated(update)
    }
}
