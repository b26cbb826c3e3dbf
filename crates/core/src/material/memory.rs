//! Rubber that remembers: finite linear viscoelasticity (Simo 1987; Simo and Hughes 1998, ch. 10) and Mullins' softening (Ogden
//! and Roxburgh 1999), of the shape alone, of any hyperelastic law that keeps volume and shape apart.
//!
//! With the deviator `s` of the Kirchhoff stress of the law, which is that of an instantaneous deformation, and the energy `W`
//! of the shape:
//!
//! - softening: `s* = (1 - erf((W_m - W)/(m + beta W_m))/r) s` below the largest energy `W_m` so far;
//! - relaxation: `tau = p J I + (1 - sum_i g_i) s* + sum_i g_i dev(h_i)`, where `h_i` is carried by the isochoric part `c` of
//!   the deformation of an increment, `h = e^-x c h_n c^T + (1 - e^-x)/x (s* - c s*_n c^T)`, `x = dt/tau_i`: exact for a
//!   deformation whose stress grows evenly over the increment (Taylor, Pister and Goudreau 1970).
//!
//! Softened rubber gives back `integral of (1 - erf(...)/r) dW` from zero to `W`, and its dissipation follows from `W_m` alone.
//! The springs of relaxation are taken to store `g W h:h/(s:s)`, `g h:h/(4 G)` at small strains with the shear modulus `G` of the
//! undeformed solid, and what their dampers take is integrated alike: exact for a deformation that comes at once and for one that is held.

use super::hyper::{HyperLaw, left_cauchy_green};
use super::law::{Advance, Differentiate};
use super::rate::INSIDE_OUT;
use super::{Directions, Gradient, Hyper, Lapse, Material, Spin, Variable, VariableKind};
use crate::integrate::Update;
use crate::tensor::{Scalar, Tensor2};
use crate::{Failure, FailureKind};
use libm::erf;

/// Most terms of a Prony series.
pub const TERMS: usize = 8;

/// What rubber remembers of its past.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Memory {
    /// Share `g` of the instantaneous stress and relaxation time of each term, at most [`TERMS`].
    pub prony: Vec<[f64; 2]>,
    /// Softening.
    pub mullins: Option<Mullins>,
}

/// The numbers of Mullins' softening.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mullins {
    /// `r`, above one: the most that is lost is `1/r`.
    pub r: f64,
    /// `m`, an energy per volume.
    pub m: f64,
    /// `beta`.
    pub beta: f64,
}

impl Mullins {
    fn width(&self, most: f64) -> f64 {
        self.m + self.beta * most
    }

    /// Ratio of the softened to the unsoftened stress at the energy `w`.
    fn left<T: Scalar>(&self, w: T, most: f64) -> T {
        if w.re() >= most {
            return T::one();
        }
        let x = (T::from(most) - w) / self.width(most);
        let slope = std::f64::consts::FRAC_2_SQRT_PI * (-x.re() * x.re()).exp();
        T::one() - x.chain(erf(x.re()), slope) / self.r
    }

    /// What unloading from `w` to nothing gives back.
    fn returned(&self, w: f64, most: f64) -> f64 {
        let width = self.width(most);
        w - width / self.r * (antiderivative(most / width) - antiderivative((most - w) / width))
    }

    /// What loading up to `most` has taken.
    fn taken(&self, most: f64) -> f64 {
        most - self.returned(most, most)
    }
}

/// `x erf(x) + exp(-x^2)/sqrt(pi)`, whose slope is the error function.
fn antiderivative(x: f64) -> f64 {
    x * erf(x) + 0.5 * std::f64::consts::FRAC_2_SQRT_PI * (-x * x).exp()
}

static LEFT: Variable = Variable { name: "left_cauchy_green", kind: VariableKind::Symmetric };
static LARGEST: Variable = Variable { name: "largest_energy", kind: VariableKind::Scalar };
static DAMPED: Variable = Variable { name: "viscous_dissipation", kind: VariableKind::Scalar };
static OVERSTRESS: [&str; TERMS] = [
    "overstress_1",
    "overstress_2",
    "overstress_3",
    "overstress_4",
    "overstress_5",
    "overstress_6",
    "overstress_7",
    "overstress_8",
];

/// A [`HyperLaw`] with a memory as a [`Material`]. Its state is the stress, `b`, the largest energy, the energy that dampers
/// took, and the overstresses `h_i`.
#[derive(Debug, Clone)]
pub struct Remembering<L> {
    law: L,
    memory: Memory,
    shear: f64,
    variables: Vec<Variable>,
}

/// Where the largest energy stands in a state, and the energy that dampers took, and where the overstresses begin.
const MOST: usize = 12;
const TAKEN: usize = 13;
const BACK: usize = 14;
/// Stress over the shear modulus below which the strain is small.
const SMALL: f64 = 1e-5;

impl<L: HyperLaw> Remembering<L> {
    /// The law with this memory.
    ///
    /// # Errors
    /// In words, where the memory is none.
    pub fn new(law: L, memory: Memory) -> Result<Self, String> {
        if !L::APART {
            return Err("the law does not keep volume and shape apart: it takes neither `prony` nor `mullins`".into());
        }
        let shares: f64 = memory.prony.iter().map(|[share, _]| share).sum();
        if memory.prony.len() > TERMS {
            return Err(format!("`prony` has {} terms, and at most {TERMS} are kept", memory.prony.len()));
        }
        if memory.prony.iter().any(|[share, time]| *share <= 0.0 || *time <= 0.0) || shares >= 1.0 {
            return Err(format!(
                "shares and times of `prony` must be positive and the shares less than 1 in all, not {shares}"
            ));
        }
        let back = OVERSTRESS.iter().take(memory.prony.len());
        let back = back.map(|&name| Variable { name, kind: VariableKind::Symmetric });
        let variables = [LEFT, LARGEST, DAMPED].into_iter().chain(back).collect();
        let shear = Hyper(law.clone()).moduli()[1];
        Ok(Self { law, memory, shear, variables })
    }

    /// Part of the stress that never relaxes.
    fn lasting(&self) -> f64 {
        1.0 - self.memory.prony.iter().map(|[share, _]| share).sum::<f64>()
    }

    /// The energy of the shape.
    fn energy(&self, b: &Tensor2) -> f64 {
        self.law.energy(&(*b * b.det().powf(-1.0 / 3.0)))
    }

    /// Softened deviator of the Kirchhoff stress of an accepted state.
    fn softened(&self, state: &[f64]) -> Result<Tensor2, Failure> {
        let b = left_cauchy_green(state);
        let shape = self.law.stress(&b)?.deviator() * b.det().sqrt();
        let left = self.memory.mullins.map_or(1.0, |mullins| mullins.left(self.energy(&b), state[MOST]));
        Ok(shape * left)
    }

    /// Energy that a spring stores over the square of its stress.
    fn compliance(&self, state: &[f64]) -> f64 {
        let b = left_cauchy_green(state);
        let shape = self.law.stress(&b).map_or(Tensor2::zero(), |stress| stress.deviator() * b.det().sqrt());
        let square = shape.contract(shape);
        if square > (SMALL * self.shear).powi(2) { self.energy(&b) / square } else { 0.25 / self.shear }
    }

    fn overstress(state: &[f64], i: usize) -> Tensor2 {
        Tensor2::from_voigt(std::array::from_fn(|k| state[BACK + 6 * i + k]))
    }
}

impl<L: HyperLaw> Advance for Remembering<L> {
    fn advance<T: Scalar>(
        &self,
        f: &Tensor2<T>,
        lapse: Lapse,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<Tensor2<T>, Failure> {
        let det = f.det();
        if det.re() <= 0.0 {
            return Err(Failure::new(INSIDE_OUT).of(FailureKind::Inverted));
        }
        let b = (*f * left_cauchy_green(old).lift() * f.transpose()).sym();
        let j = b.det().sqrt();
        let stress = self.law.stress(&b)?;
        let mut shape = stress.deviator() * j;
        new[MOST] = old[MOST];
        if let Some(mullins) = &self.memory.mullins {
            let at = self.energy(&b.re());
            if !at.is_finite() {
                return Err(Failure::new("the energy of the deformation is beyond numbers"));
            }
            // The rate of the energy is `s : df f^-1`.
            let change = (*f - f.re().lift()) * f.re().inverse().lift();
            let w = shape.re().lift::<T>().contract(change) + at;
            shape = shape * mullins.left(w, old[MOST]);
            new[MOST] = old[MOST].max(at);
        }
        let mut total = shape * T::from(self.lasting());
        let c = *f * det.powf(-1.0 / 3.0);
        let carry = |t: Tensor2| (c * t.lift() * c.transpose()).sym();
        let before = if self.memory.prony.is_empty() { Tensor2::zero() } else { carry(self.softened(old)?) };
        let mut damping = 0.0;
        for (i, [share, time]) in self.memory.prony.iter().enumerate() {
            let x = lapse.dt / time;
            let grown = if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 };
            let (start, step) = (carry(Self::overstress(old, i)), shape - before);
            let h = start * T::from((-x).exp()) + step * T::from(grown);
            total = total + h.deviator() * T::from(*share);
            new[BACK + 6 * i..BACK + 6 * i + 6].copy_from_slice(&h.re().to_voigt());
            damping += share * damped(&start.re().deviator(), &step.re().deviator(), x);
        }
        let stress = total * j.recip() + Tensor2::identity() * (stress.trace() * (1.0 / 3.0));
        new[..6].copy_from_slice(&stress.re().to_voigt());
        new[6..12].copy_from_slice(&b.re().to_voigt());
        new[TAKEN] = old[TAKEN] + 2.0 * self.compliance(new) * damping;
        Ok(stress)
    }
}

/// `integral of h:h dt` over the relaxation time, where `h` relaxes from `start` while `step` comes evenly: with the steady
/// state `a = step/x` it is `a + (start - a) e^-t`, `t` from 0 to `x`.
fn damped(start: &Tensor2, step: &Tensor2, x: f64) -> f64 {
    if x < 1e-3 {
        let end = *start * (1.0 - x) + *step;
        return x / 3.0 * (start.contract(*start) + start.contract(end) + end.contract(end));
    }
    let steady = *step * x.recip();
    let falling = *start - steady;
    let (once, twice) = (-(-x).exp_m1(), -0.5 * (-2.0 * x).exp_m1());
    let square =
        steady.contract(steady) * x + 2.0 * steady.contract(falling) * once + falling.contract(falling) * twice;
    square.max(0.0)
}

impl<L: HyperLaw> Material for Remembering<L> {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn initialise(&self, state: &mut [f64]) {
        state.fill(0.0);
        state[6..9].fill(1.0);
    }

    fn bears(&self, state: &[f64]) -> Result<(), String> {
        Hyper(self.law.clone()).bears(state)
    }

    fn with_update(&self, update: Update) -> Result<Box<dyn Material>, String> {
        Hyper(self.law.clone()).with_update(update)
    }

    fn with_spin(&self, spin: Spin) -> Result<Box<dyn Material>, String> {
        Hyper(self.law.clone()).with_spin(spin)
    }

    fn with_small_strain(&self) -> Result<Box<dyn Material>, String> {
        Hyper(self.law.clone()).with_small_strain()
    }

    fn update(&self, f: &Tensor2, lapse: Lapse, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        self.advance(f, lapse, old, new).map(|_| ())
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

    fn has_potential(&self) -> bool {
        true
    }

    /// Those before anything relaxes, whatever the unit of time.
    fn moduli(&self) -> [f64; 2] {
        Hyper(self.law.clone()).moduli()
    }

    fn stored_energy(&self, state: &[f64]) -> f64 {
        let b = left_cauchy_green(state);
        let shape = self.energy(&b);
        let softened =
            self.memory.mullins.map_or(shape, |mullins| mullins.returned(shape.min(state[MOST]), state[MOST]));
        let springs = |(i, [share, _]): (usize, &[f64; 2])| {
            let h = Self::overstress(state, i).deviator();
            share * h.contract(h) * self.compliance(state)
        };
        let springs: f64 = self.memory.prony.iter().enumerate().map(springs).sum();
        (self.law.energy(&b) - shape + self.lasting() * softened + springs) / b.det().sqrt()
    }

    fn dissipation(&self, old: &[f64], new: &[f64]) -> f64 {
        let softened = self.memory.mullins.map_or(0.0, |mullins| mullins.taken(new[MOST]) - mullins.taken(old[MOST]));
        (new[TAKEN] - old[TAKEN] + self.lasting() * softened) / left_cauchy_green(new).det().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_function_is_that_of_tables() {
        for (x, value) in
            [(0.0, 0.0), (0.1, 0.112_462_916_018_285), (1.0, 0.842_700_792_949_715), (3.0, 0.999_977_909_503_001)]
        {
            assert!((erf(x) - value).abs() < 1e-14, "{x}: {}", erf(x));
        }
        let slope = (antiderivative(1.3 + 1e-5) - antiderivative(1.3 - 1e-5)) / 2e-5;
        assert!((slope - erf(1.3)).abs() < 1e-9);
    }
}
