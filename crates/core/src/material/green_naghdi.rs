//! The frame of Green and Naghdi (1965), whose spin is that of the polar rotation of the whole deformation.
//!
//! With the left stretch `V` of the polar decomposition `F = V R`, an increment `f` gives `f V_n = V Q`: `Q` is the
//! rotation of the increment, `V` the new stretch, and neither needs `R` itself. The strain of the increment is that about
//! the midpoint configuration, as in [`rate`](super::rate), turned to the end by half of the rotation. In simple shear the
//! two frames part from strains of about one half: Jaumann's goes on turning, this one tends to a quarter turn.

use super::frame::{about_midpoint, half};
use super::turned::Turn;
use crate::Failure;
use crate::tensor::{Scalar, Tensor2};

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

/// The increment `f` from the left stretch `old`.
pub(super) fn turn<T: Scalar>(f: &Tensor2<T>, old: &Tensor2) -> Result<Turn<T>, Failure> {
    let a = *f * old.lift();
    let q = rotation(&a).ok_or_else(|| Failure::new("the polar decomposition does not converge"))?;
    let turn = half(&q);
    let de = (turn * about_midpoint(f).sym() * turn.transpose()).sym();
    Ok(Turn { de, q, memory: (a * q.transpose()).sym().re() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Directions, law};
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
