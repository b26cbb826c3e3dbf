//! Hyperelastic laws: the Cauchy stress follows from the left Cauchy-Green tensor `b = F F^T`, which is the only
//! history and is carried by `b = f b_n f^T`; nothing is integrated, and closed cycles give all energy back.

use super::rate::INSIDE_OUT;
use super::{Directions, Gradient, Material, Variable, VariableKind};
use crate::Failure;
use crate::integrate::Update;
use crate::tensor::{Dual, Scalar, Tensor2};

/// An isotropic law between `b` and the Cauchy stress.
pub trait HyperLaw: Clone + Send + Sync + 'static {
    /// Cauchy stress at `b`.
    ///
    /// # Errors
    /// A [`Failure`] when `b` is inadmissible.
    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure>;
    /// Stored energy per undeformed volume.
    fn energy(&self, b: &Tensor2) -> f64;
}

/// A [`HyperLaw`] as a [`Material`].
#[derive(Debug, Clone, PartialEq)]
pub struct Hyper<L>(pub L);

static VARIABLES: &[Variable] = &[Variable { name: "left_cauchy_green", kind: VariableKind::Symmetric }];

fn left_cauchy_green(state: &[f64]) -> Tensor2 {
    Tensor2::from_voigt(std::array::from_fn(|i| state[6 + i]))
}

/// `f b_n` and `b = f b_n f^T`.
fn carried(f: &Tensor2, old: &[f64]) -> Result<(Tensor2, Tensor2), Failure> {
    if f.det() <= 0.0 {
        return Err(Failure::new(INSIDE_OUT));
    }
    let half = *f * left_cauchy_green(old);
    Ok((half, (half * f.transpose()).sym()))
}

fn write<T: Scalar>(stress: &[T; 6], b: &Tensor2, new: &mut [f64]) {
    new[..6].copy_from_slice(&stress.map(Scalar::re));
    new[6..12].copy_from_slice(&b.to_voigt());
}

impl<L: HyperLaw> Material for Hyper<L> {
    fn variables(&self) -> &[Variable] {
        VARIABLES
    }

    fn initialise(&self, state: &mut [f64]) {
        state.fill(0.0);
        state[6..9].fill(1.0);
    }

    fn bears(&self, _: &[f64]) -> Result<(), String> {
        Err("the stress of a hyperelastic law follows from the deformation alone".into())
    }

    fn with_update(&self, _: Update) -> Result<Box<dyn Material>, String> {
        Err("the stress of a hyperelastic law follows from the deformation alone: there is nothing to sub-step".into())
    }

    fn with_green_naghdi(&self) -> Result<Box<dyn Material>, String> {
        Err("the stress of a hyperelastic law follows from the deformation alone: no objective rate enters it".into())
    }

    fn update(&self, f: &Tensor2, _dt: f64, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        let (_, b) = carried(f, old)?;
        write(&self.0.stress(&b)?.to_voigt(), &b, new);
        Ok(())
    }

    /// By the slopes along the six components of `b`, and `db_ij = df_ik (f b_n)_jk + (f b_n)_ik df_jk`.
    fn differentiate(
        &self,
        f: &Tensor2,
        _dt: f64,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        let (half, b) = carried(f, old)?;
        let components = b.to_voigt();
        let variable = Tensor2::from_voigt(std::array::from_fn(|i| Dual::<6>::variable(components[i], i)));
        let stress = self.0.stress(&variable)?.to_voigt();
        write(&stress, &b, new);
        for (row, stress) in gradient.iter_mut().zip(&stress) {
            // An entry off the diagonal stands in `b` twice.
            let slopes = Tensor2::from_voigt(std::array::from_fn(|i| stress.du[i] * if i < 3 { 2.0 } else { 1.0 }));
            let along = slopes * half;
            row.iter_mut().zip(directions.components()).for_each(|(slope, &place)| *slope = along[place]);
        }
        Ok(())
    }

    fn is_conservative(&self) -> bool {
        true
    }

    fn stored_energy(&self, state: &[f64]) -> f64 {
        let b = left_cauchy_green(state);
        self.0.energy(&b) / b.det().sqrt()
    }
}
