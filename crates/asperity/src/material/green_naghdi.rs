//! Rate laws in the frame of Green and Naghdi (1965), whose spin is that of the polar rotation of the whole deformation.
//!
//! With the left stretch `V` of the polar decomposition `F = V R`, an increment `f` gives `f V_n = V Q`: `Q` is the
//! rotation of the increment, `V` the new stretch, and neither needs `R` itself. `V` is a history tensor of its own
//! behind the variables of the law. The strain of the increment is that about the midpoint configuration, as in
//! [`rate`](super::rate), turned to the end by half of the rotation. In simple shear the two frames part from strains
//! of about one half: Jaumann's goes on turning, this one tends to a quarter turn.

use super::frame::{about_midpoint, half};
use super::law::{self, Differentiate};
use super::rate::{INSIDE_OUT, stress_of};
use super::small::NO_RATE;
use super::{Directions, Gradient, Material, Rate, RateLaw, Variable, VariableKind, Vars};
use crate::integrate::Update;
use crate::tensor::{Scalar, Tensor2};
use crate::{Failure, Kind};

/// A [`RateLaw`] as a [`Material`] in the frame of Green and Naghdi.
#[derive(Debug, Clone)]
pub struct GreenNaghdi<L> {
    law: L,
    variables: Vec<Variable>,
}

/// Most iterations of the polar decomposition, which converges with order 2 from any deformation.
const LIMIT: usize = 60;

/// The rotation `Q` of `a = V Q`, by Newton's iteration `x <- (x + x^-T)/2` (Higham 1986) with its derivatives.
fn rotation<T: Scalar>(a: &Tensor2<T>) -> Option<Tensor2<T>> {
    let step = |x: &Tensor2<T>| (*x + x.inverse().transpose()) * T::from(0.5);
    let mut x = *a;
    for _ in 0..LIMIT {
        let next = step(&x);
        let change = (next - x).re();
        x = next;
        // The change of a step is squared by the next, and so is the error of the derivatives.
        if change.contract(change) <= 1e-20 {
            return Some(step(&step(&x)));
        }
    }
    None
}

impl<L: RateLaw> GreenNaghdi<L> {
    /// The law in this frame.
    pub fn new(law: L) -> Self {
        let stretch = Variable { name: "left_stretch", kind: VariableKind::Symmetric };
        Self { law, variables: L::VARIABLES.iter().copied().chain([stretch]).collect() }
    }

    /// Where the stretch begins in the state.
    fn stretch_at(&self) -> usize {
        self.state_len() - 6
    }

    fn advance<T: Scalar>(&self, f: &Tensor2<T>, dt: f64, old: &[f64], new: &mut [f64]) -> Result<Tensor2<T>, Failure> {
        if f.det().re() <= 0.0 {
            return Err(Failure::new(INSIDE_OUT).of(Kind::Inverted));
        }
        let at = self.stretch_at();
        let a = *f * Tensor2::from_voigt(std::array::from_fn(|i| old[at + i])).lift();
        let q = rotation(&a).ok_or_else(|| Failure::new("the polar decomposition does not converge"))?;
        let turn = half(&q);
        let de = (turn * about_midpoint(f).sym() * turn.transpose()).sym();
        let stress = q * stress_of(old).lift() * q.transpose();
        let vars = L::Vars::<T>::read(&old[6..at]).rotate(&q);
        let (stress, vars) = self.law.update(de, stress, &vars, dt)?;
        new[..6].copy_from_slice(&stress.re().to_voigt());
        vars.write(&mut new[6..at]);
        new[at..at + 6].copy_from_slice(&(a * q.transpose()).sym().re().to_voigt());
        Ok(stress)
    }
}

impl<L: RateLaw> Differentiate for GreenNaghdi<L> {
    fn advance_dual<const N: usize>(
        &self,
        f: &Tensor2,
        dt: f64,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        let stress = self.advance(&law::seeded::<N>(f, directions.components()), dt, old, new)?;
        law::write_slopes(&stress.to_voigt(), gradient);
        Ok(())
    }
}

impl<L: RateLaw> Material for GreenNaghdi<L> {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn initialise(&self, state: &mut [f64]) {
        state.fill(0.0);
        let at = self.stretch_at();
        self.law.initial(&mut state[..at]);
        state[at..at + 3].fill(1.0);
    }

    fn bears(&self, state: &[f64]) -> Result<(), String> {
        Rate(self.law.clone()).bears(&state[..self.stretch_at()])
    }

    fn with_update(&self, update: Update) -> Result<Box<dyn Material>, String> {
        self.law.updated(update).with_green_naghdi()
    }

    fn with_green_naghdi(&self) -> Result<Box<dyn Material>, String> {
        Ok(Box::new(self.clone()))
    }

    fn with_small_strain(&self) -> Result<Box<dyn Material>, String> {
        Err(NO_RATE.into())
    }

    fn update(&self, f: &Tensor2, dt: f64, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        self.advance(f, dt, old, new).map(|_| ())
    }

    fn differentiate(
        &self,
        f: &Tensor2,
        dt: f64,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        self.advance_along(f, dt, old, (new, gradient), directions)
    }

    fn stored_energy(&self, state: &[f64]) -> f64 {
        self.law.stored_energy(&stress_of(state), &L::Vars::read(&state[6..self.stretch_at()]))
    }

    fn dissipation(&self, old: &[f64], new: &[f64]) -> f64 {
        let vars = |state: &[f64]| L::Vars::<f64>::read(&state[6..self.stretch_at()]);
        self.law.dissipation((&stress_of(old), &vars(old)), (&stress_of(new), &vars(new)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Dual;

    #[test]
    fn a_rotation_is_found_with_its_derivative() {
        let f = Tensor2([[0.3, -0.9, 0.1], [1.2, 0.4, -0.2], [0.05, 0.1, 0.8]]);
        let turn = |h: f64| {
            let mut moved = f;
            moved[(0, 1)] += h;
            rotation(&moved).unwrap()
        };
        let (q, h): (Tensor2<Dual<1>>, _) = (rotation(&law::seeded(&f, &[(0, 1)])).unwrap(), 1e-5);
        let (up, down) = (turn(h), turn(-h));
        let product = q.re() * q.re().transpose() - Tensor2::identity();
        assert!(product.contract(product) < 1e-28 && q.re().det() > 0.0);
        let stretch = f * q.re().transpose();
        let skew = stretch.skew();
        assert!(skew.contract(skew) < 1e-28);
        for &place in Directions::Space.components() {
            assert!((q[place].du[0] - (up[place] - down[place]) / (2.0 * h)).abs() < 1e-9, "{place:?}");
        }
    }
}
