//! Hyperelastic laws: the Cauchy stress follows from the left Cauchy-Green tensor `b = F F^T`, which is the only
//! history and is carried by `b = f b_n f^T`; nothing is integrated, and closed cycles give all energy back.

use super::memory::{Memory, Remembering};
use super::rate::INSIDE_OUT;
use super::{Directions, Gradient, Lapse, Material, Spin, Variable, VariableKind};
use crate::integrate::Update;
use crate::tensor::{Dual, Scalar, Tensor2, Vec3};
use crate::{Failure, FailureKind};

/// An isotropic law between `b` and the Cauchy stress.
pub trait HyperLaw: Clone + Send + Sync + 'static {
    /// Whether the energy is a sum of one of the volume and one of the shape, `b` over the 2/3 power of the volume ratio.
    const APART: bool = true;

    /// Cauchy stress at `b`.
    ///
    /// # Errors
    /// A [`Failure`] when `b` is inadmissible.
    fn stress<T: Scalar>(&self, b: &Tensor2<T>) -> Result<Tensor2<T>, Failure>;
    /// The same, and its [`Slopes`]: by dual numbers where a law does not write them out.
    ///
    /// # Errors
    /// As [`stress`](Self::stress).
    fn stress_with_slopes(&self, b: &Tensor2, slopes: &mut Slopes) -> Result<Tensor2, Failure> {
        by_duals(self, b, slopes)
    }
    /// Stored energy per undeformed volume.
    fn energy(&self, b: &Tensor2) -> f64;
}

/// Derivatives of the six stress components along the six of `b`, in the order XX YY ZZ XY YZ XZ; one off the diagonal
/// stands in `b` twice.
pub type Slopes = [[f64; 6]; 6];

/// Stress of a law and its slopes by dual numbers.
pub(super) fn by_duals<L: HyperLaw>(law: &L, b: &Tensor2, slopes: &mut Slopes) -> Result<Tensor2, Failure> {
    let components = b.to_voigt();
    let variable = Tensor2::from_voigt(std::array::from_fn(|i| Dual::<6>::variable(components[i], i)));
    let stress = law.stress(&variable)?;
    slopes.iter_mut().zip(stress.to_voigt()).for_each(|(slopes, stress)| *slopes = stress.du);
    Ok(stress.re())
}

/// A [`HyperLaw`] as a [`Material`].
#[derive(Debug, Clone, PartialEq)]
pub struct Hyper<L>(pub L);

static VARIABLES: &[Variable] = &[Variable { name: "left_cauchy_green", kind: VariableKind::Symmetric }];

pub(super) fn left_cauchy_green(state: &[f64]) -> Tensor2 {
    Tensor2::from_voigt(std::array::from_fn(|i| state[6 + i]))
}

/// `f b_n` and `b = f b_n f^T`.
fn carried(f: &Tensor2, old: &[f64]) -> Result<(Tensor2, Tensor2), Failure> {
    if f.det() <= 0.0 {
        return Err(Failure::new(INSIDE_OUT).of(FailureKind::Inverted));
    }
    let half = *f * left_cauchy_green(old);
    let b = |i: usize, j: usize| Vec3(half.0[i]).dot(Vec3(f.0[j]));
    Ok((half, Tensor2::from_voigt([b(0, 0), b(1, 1), b(2, 2), b(0, 1), b(1, 2), b(0, 2)])))
}

fn write(stress: &Tensor2, b: &Tensor2, new: &mut [f64]) {
    new[..6].copy_from_slice(&stress.to_voigt());
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

    fn with_spin(&self, _: Spin) -> Result<Box<dyn Material>, String> {
        Err("the stress of a hyperelastic law follows from the deformation alone: no objective rate enters it".into())
    }

    fn with_small_strain(&self) -> Result<Box<dyn Material>, String> {
        Err("the stress of a hyperelastic law follows from the whole deformation and has no small strain: use the law \
             `elastic`, or strain = \"finite\""
            .into())
    }

    fn with_memory(&self, memory: &Memory) -> Result<Box<dyn Material>, String> {
        Ok(Box::new(Remembering::new(self.0.clone(), memory.clone())?))
    }

    fn update(&self, f: &Tensor2, _lapse: Lapse, old: &[f64], new: &mut [f64]) -> Result<(), Failure> {
        let (_, b) = carried(f, old)?;
        write(&self.0.stress(&b)?, &b, new);
        Ok(())
    }

    /// By the slopes along the six components of `b`, and `db_ij = df_ik (f b_n)_jk + (f b_n)_ik df_jk`.
    fn differentiate(
        &self,
        f: &Tensor2,
        _lapse: Lapse,
        old: &[f64],
        (new, gradient): (&mut [f64], &mut Gradient),
        directions: Directions,
    ) -> Result<(), Failure> {
        let (half, b) = carried(f, old)?;
        let mut slopes = Slopes::default();
        write(&self.0.stress_with_slopes(&b, &mut slopes)?, &b, new);
        for (row, slopes) in gradient.iter_mut().zip(&slopes) {
            // An entry off the diagonal stands in `b` twice.
            let [xx, yy, zz, xy, yz, xz] = *slopes;
            let along = Tensor2::from_voigt([2.0 * xx, 2.0 * yy, 2.0 * zz, xy, yz, xz]) * half;
            match directions {
                Directions::Space => row.copy_from_slice(along.0.as_flattened()),
                _ => row.iter_mut().zip(directions.components()).for_each(|(slope, &place)| *slope = along[place]),
            }
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
