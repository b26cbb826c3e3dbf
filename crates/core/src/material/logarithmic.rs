//! The frame of the logarithmic rate (Xiao, Bruhns and Meyers 1997), the only one in which the rate of the logarithmic
//! strain `h = ln V` is the rate of deformation `D`.
//!
//! Its spin is `W + N` with, in the axes of `h` and with `y = 2 (h_i - h_j)`, `N_ij = (2/y - coth(y/2)) D_ij`. That is
//! `psi(y^2) [2 h, D]_ij`, so that the axial vector of `N` is that of the commutator times the isotropic function of `2 h`
//! whose value along an axis is `psi` of the other two: smooth where principal values meet. The rotation `Q` of an
//! increment takes the spin of the midpoint, and its strain is `h - Q h_n Q^T`, exactly: an elastic law gives
//! `lambda tr(h) I + 2 G h` in increments of any length.

use super::frame::{about_midpoint, cayley};
use super::turned::Turn;
use crate::Failure;
use crate::tensor::{Isotropic, Scalar, Tensor2, Vec3};

struct Logarithm;

impl Isotropic for Logarithm {
    fn principal<S: Scalar>(&self, values: [S; 3]) -> Result<[S; 3], Failure> {
        if values.iter().all(|x| x.re() > 0.0 && x.re().is_finite()) {
            return Ok(values.map(S::ln));
        }
        Err(Failure::new("the stretches are beyond numbers"))
    }
}

struct Exponential;

impl Isotropic for Exponential {
    fn principal<S: Scalar>(&self, values: [S; 3]) -> Result<[S; 3], Failure> {
        Ok(values.map(S::exp))
    }
}

/// `psi` of the differences of the other two principal values.
struct Lead;

impl Isotropic for Lead {
    fn principal<S: Scalar>(&self, [a, b, c]: [S; 3]) -> Result<[S; 3], Failure> {
        Ok([psi(b - c), psi(c - a), psi(a - b)])
    }
}

/// `(2/y - coth(y/2))/y`, smooth through zero.
fn psi<S: Scalar>(y: S) -> S {
    if y.re().abs() < 0.25 {
        // The series of the hyperbolic cotangent; six terms leave less than rounding.
        const TERMS: [f64; 6] =
            [-1.0 / 6.0, 1.0 / 360.0, -1.0 / 15_120.0, 1.0 / 604_800.0, -1.0 / 23_950_080.0, 691.0 / 653_837_184_000.0];
        let square = y * y;
        return TERMS.iter().rev().fold(S::zero(), |sum, &term| sum * square + term);
    }
    (y.recip() * 2.0 - (y * 0.5).tanh().recip()) / y
}

/// The increment `f` from the logarithmic strain `old`.
pub(super) fn turn<T: Scalar>(f: &Tensor2<T>, old: &Tensor2) -> Result<Turn<T>, Failure> {
    let before: Tensor2<T> = Exponential.of(&(*old * 2.0))?.lift();
    let (g, identity) = (about_midpoint(f), Tensor2::<T>::identity());
    // Half of the way, with the same gradient about its own midpoint.
    let quarter = g * T::from(0.25);
    let half = (identity - quarter).inverse() * (identity + quarter);
    let twice = Logarithm.of(&(half * before * half.transpose()).sym())?;
    let d = g.sym();
    let commutator = twice * d - d * twice;
    let [x, y, z] = (Lead.of(&twice)? * Vec3([commutator[(2, 1)], commutator[(0, 2)], commutator[(1, 0)]])).0;
    let n = Tensor2([[T::zero(), -z, y], [z, T::zero(), -x], [-y, x, T::zero()]]);
    let q = cayley(&((g.skew() + n) * T::from(0.5)));
    let after = Logarithm.of(&(*f * before * f.transpose()).sym())? * T::from(0.5);
    let de = (after - q * old.lift() * q.transpose()).sym();
    Ok(Turn { de, q, memory: after.re() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::frame;

    /// The rate of the logarithmic strain is the rate of deformation: the strain of an increment is that about its midpoint,
    /// turned to the end, but for the third order of its length.
    #[test]
    fn the_rate_of_the_logarithmic_strain_is_the_rate_of_deformation() {
        let rate = Tensor2([[0.3, 0.9, -0.4], [-0.5, -0.2, 0.7], [0.6, 0.1, 0.25]]);
        for h in [[0.6, -0.3, 0.1, 0.4, -0.2, 0.3], [0.5, 0.5, -0.2, 0.0, 0.0, 0.0], [1.9, -1.0, -0.4, 0.0, 0.8, 0.0]] {
            let old = Tensor2::from_voigt(h);
            let miss = |dt: f64| {
                let f = Tensor2::identity() + rate * dt;
                let turn = turn(&f, &old).unwrap();
                let half = frame::half(&turn.q);
                let off = turn.de - half * about_midpoint(&f).sym() * half.transpose();
                off.contract(off).sqrt()
            };
            let order = (miss(1e-2) / miss(2.5e-3)).log2() / 2.0;
            assert!((order - 3.0).abs() < 0.1, "{h:?}: {order}, {}", miss(1e-2));
        }
    }

    #[test]
    fn the_lead_is_smooth_where_its_formula_changes() {
        let direct = |y: f64| (2.0 / y - 1.0 / (0.5 * y).tanh()) / y;
        for y in [0.249_999, -0.249_999, 0.250_001] {
            assert!((psi(y) - direct(y)).abs() < 1e-13, "{y}");
        }
        assert_eq!(psi(0.0), -1.0 / 6.0);
        assert!((psi(0.1) - direct(0.1)).abs() < 1e-12);
    }
}
