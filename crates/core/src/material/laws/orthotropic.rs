//! Linear elasticity along axes of the solid, `sigma = C : e` in components along the axes 1, 2 and 3: orthotropic by nine engineering
//! constants, `e11 = s11/E1 - nu12 s22/E1 - nu13 s33/E1`, `2 e12 = s12/G12` and so on with `nu21/E2 = nu12/E1` (Lekhnitskii 1963), or by
//! the 21 coefficients of `C`. The axes turn with the solid, by the polar rotation unless another rate is said.

use super::axes::{FIRST, THIRD, axes, basis, local};
use super::elastic::POISSON;
use super::hardening::join;
use super::rate;
use crate::Failure;
use crate::declare::{Entry, Parameter, Range, VariableKind, unit};
use crate::material::{Lapse, Material, RateLaw, ScalarsAndVectors, Spin, Variable};
use crate::tensor::{Scalar, Tensor2, Vec3};

const fn modulus(key: &'static str, meaning: &'static str) -> Parameter {
    Parameter { key, meaning, unit: unit::STRESS, range: Range::POSITIVE, default: None }
}

const fn ratio(key: &'static str, meaning: &'static str) -> Parameter {
    Parameter { key, meaning, range: Range::ANY, ..POISSON }
}

const fn coefficient(key: &'static str, meaning: &'static str) -> Parameter {
    Parameter { key, meaning, unit: unit::STRESS, range: Range::ANY, default: Some(0.0) }
}

pub(super) const ORTHOTROPIC: Entry<Box<dyn Material>> = Entry {
    name: "orthotropic",
    meaning: "linear elasticity along three axes of the solid, by nine engineering constants",
    parameters: &join::<15>(&[
        &[
            modulus("young_1", "Young's modulus along the first axis"),
            modulus("young_2", "Young's modulus along the second axis"),
            modulus("young_3", "Young's modulus along the third axis"),
            ratio("poisson_12", "contraction along 2 over elongation along 1 in tension along 1"),
            ratio("poisson_13", "contraction along 3 over elongation along 1 in tension along 1"),
            ratio("poisson_23", "contraction along 3 over elongation along 2 in tension along 2"),
            modulus("shear_12", "shear modulus in the plane of 1 and 2"),
            modulus("shear_13", "shear modulus in the plane of 1 and 3"),
            modulus("shear_23", "shear modulus in the plane of 2 and 3"),
        ],
        &FIRST,
        &THIRD,
    ]),
    pairs: None,
    build: |v| {
        let inverse = [v[0], v[1], v[2]].map(f64::recip);
        let off = [v[3] * inverse[0], v[4] * inverse[0], v[5] * inverse[1]].map(|x| -x);
        let mut compliance = Matrix::default();
        for (i, row) in [[inverse[0], off[0], off[1]], [off[0], inverse[1], off[2]], [off[1], off[2], inverse[2]]]
            .iter()
            .enumerate()
        {
            compliance[i][..3].copy_from_slice(row);
        }
        // Components 12, 23, 13, whose strain counts half.
        for (place, shear) in [v[6], v[8], v[7]].into_iter().enumerate() {
            compliance[3 + place][3 + place] = 0.5 / shear;
        }
        let stiffness = inverted(&compliance).ok_or(
            "Poisson's ratios are too large for these moduli: the energy of some strain would be negative; \
             poisson_ij belongs to tension along i, and |poisson_ij| < sqrt(young_i / young_j)",
        )?;
        build(stiffness, compliance, &v[9..])
    },
};

pub(super) const ANISOTROPIC: Entry<Box<dyn Material>> = Entry {
    name: "anisotropic",
    meaning: "linear elasticity along three axes of the solid, by the 21 coefficients of its stiffness",
    parameters: &join::<27>(&[
        &[
            coefficient("c1111", "stress 11 for a strain 11"),
            coefficient("c1122", "stress 11 for a strain 22"),
            coefficient("c2222", "stress 22 for a strain 22"),
            coefficient("c1133", "stress 11 for a strain 33"),
            coefficient("c2233", "stress 22 for a strain 33"),
            coefficient("c3333", "stress 33 for a strain 33"),
            coefficient("c1112", "stress 11 for a shear angle 12"),
            coefficient("c2212", "stress 22 for a shear angle 12"),
            coefficient("c3312", "stress 33 for a shear angle 12"),
            coefficient("c1212", "stress 12 for a shear angle 12"),
            coefficient("c1113", "stress 11 for a shear angle 13"),
            coefficient("c2213", "stress 22 for a shear angle 13"),
            coefficient("c3313", "stress 33 for a shear angle 13"),
            coefficient("c1213", "stress 12 for a shear angle 13"),
            coefficient("c1313", "stress 13 for a shear angle 13"),
            coefficient("c1123", "stress 11 for a shear angle 23"),
            coefficient("c2223", "stress 22 for a shear angle 23"),
            coefficient("c3323", "stress 33 for a shear angle 23"),
            coefficient("c1223", "stress 12 for a shear angle 23"),
            coefficient("c1323", "stress 13 for a shear angle 23"),
            coefficient("c2323", "stress 23 for a shear angle 23"),
        ],
        &FIRST,
        &THIRD,
    ]),
    pairs: None,
    build: |v| {
        // The order of the coefficients goes through 11 22 33 12 13 23, that of components through 11 22 33 12 23 13.
        const PLACES: [usize; 6] = [0, 1, 2, 3, 5, 4];
        let (mut stiffness, mut values) = (Matrix::default(), v.iter());
        for (j, &column) in PLACES.iter().enumerate() {
            for &row in &PLACES[..=j] {
                let value = values.next().copied().unwrap_or(0.0);
                // A shear angle is twice the strain.
                stiffness[row][column] = value * if column < 3 { 1.0 } else { 2.0 };
                stiffness[column][row] = value * if row < 3 { 1.0 } else { 2.0 };
            }
        }
        let compliance = inverted(&stiffness)
            .ok_or("the coefficients are no stiffness: the energy of some strain would not be positive")?;
        build(stiffness, compliance, &v[21..])
    },
};

/// From components of a strain to those of a stress or back, in the order 11 22 33 12 23 13; shears count once.
type Matrix = [[f64; 6]; 6];

/// How often a component stands in a tensor.
const COUNT: [f64; 6] = [1.0, 1.0, 1.0, 2.0, 2.0, 2.0];

/// The inverse of a matrix whose quadratic form is positive; none of another.
fn inverted(matrix: &Matrix) -> Option<Matrix> {
    let (mut left, mut right) = (*matrix, Matrix::default());
    (0..6).for_each(|i| right[i][i] = 1.0);
    // Without exchange of rows the pivots are positive just if the form is.
    for i in 0..6 {
        let pivot = left[i][i];
        if pivot.is_nan() || pivot <= 1e-12 * matrix[i][i].abs() {
            return None;
        }
        let (row, own) = (left[i].map(|x| x / pivot), right[i].map(|x| x / pivot));
        (left[i], right[i]) = (row, own);
        for j in (0..6).filter(|&j| j != i) {
            let factor = left[j][i];
            for k in 0..6 {
                left[j][k] -= factor * row[k];
                right[j][k] -= factor * own[k];
            }
        }
    }
    Some(right)
}

fn build(stiffness: Matrix, compliance: Matrix, along: &[f64]) -> Result<Box<dyn Material>, String> {
    let axes = basis(along, ["first", "third"])?;
    Ok(rate(Orthotropic { stiffness, compliance, axes }))
}

/// The law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orthotropic {
    stiffness: Matrix,
    compliance: Matrix,
    /// First and third axis at the beginning, unit vectors.
    axes: [Vec3; 2],
}

/// Components that a matrix makes of others.
fn product<T: Scalar>(matrix: &Matrix, of: &[T; 6]) -> [T; 6] {
    std::array::from_fn(|i| (0..6).fold(T::from(0.0), |sum, j| sum + of[j] * matrix[i][j]))
}

type State<T> = ScalarsAndVectors<T, 0, 2>;

impl RateLaw for Orthotropic {
    type Vars<T: Scalar> = State<T>;
    const VARIABLES: &'static [Variable] = &[
        Variable { name: "first_axis", kind: VariableKind::Vector },
        Variable { name: "third_axis", kind: VariableKind::Vector },
    ];
    const AXES: Option<usize> = Some(6);

    fn initial(&self, state: &mut [f64]) {
        state[6..9].copy_from_slice(&self.axes[0].0);
        state[9..12].copy_from_slice(&self.axes[1].0);
    }

    fn update<T: Scalar>(
        &self,
        de: Tensor2<T>,
        stress: Tensor2<T>,
        vars: &State<T>,
        _lapse: Lapse,
    ) -> Result<(Tensor2<T>, State<T>), Failure> {
        let axes = axes(&vars.vectors);
        let grown = Tensor2::from_voigt(product(&self.stiffness, &local(&de, &axes)));
        Ok((stress + (axes * grown * axes.transpose()).sym(), *vars))
    }

    fn own_spin(&self) -> Option<Spin> {
        Some(Spin::Polar)
    }

    /// Means over all directions (Voigt).
    fn mean_moduli(&self) -> Option<[f64; 2]> {
        let c = &self.stiffness;
        let sides = c[0][0] + c[1][1] + c[2][2];
        let pairs = c[0][1] + c[0][2] + c[1][2];
        let shears = 0.5 * (c[3][3] + c[4][4] + c[5][5]);
        let (bulk, shear) = ((sides + 2.0 * pairs) / 9.0, (sides - pairs + 3.0 * shears) / 15.0);
        Some([bulk + 4.0 / 3.0 * shear, shear])
    }

    fn stored_energy(&self, stress: &Tensor2, vars: &State<f64>) -> f64 {
        let stress = local(stress, &axes(&vars.vectors));
        let strain = product(&self.compliance, &stress);
        0.5 * (0..6).map(|i| COUNT[i] * stress[i] * strain[i]).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stress(law: &dyn Material, strain: &Tensor2) -> Tensor2 {
        let small = law.with_small_strain().unwrap();
        let mut old = vec![0.0; small.state_len()];
        small.initialise(&mut old);
        let mut new = old.clone();
        small.update(&(Tensor2::identity() + *strain), 1.0.into(), &old, &mut new).unwrap();
        Tensor2::from_voigt(std::array::from_fn(|i| new[i]))
    }

    fn strain() -> Tensor2 {
        let rows = [[1.0, 0.3, -0.2], [0.3, -0.4, 0.7], [-0.2, 0.7, 0.2]];
        Tensor2::from_fn(|i, j| 1e-3 * rows[i][j])
    }

    /// Equal constants are those of an isotropic solid, whatever the axes.
    #[test]
    fn equal_constants_are_isotropic() {
        let (e, nu) = (1000.0, 0.3);
        let g = 0.5 * e / (1.0 + nu);
        let law = (ORTHOTROPIC.build)(&[e, e, e, nu, nu, nu, g, g, g, 1.0, 2.0, 0.5, 0.0, -1.0, 3.0]).unwrap();
        let plain = super::super::Elastic::new(e, nu).stress(&strain());
        let off = stress(law.as_ref(), &strain()) - plain;
        assert!(off.contract(off).sqrt() < 1e-12, "{off:?}");
        let [confined, shear] = law.moduli();
        assert!((confined - e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))).abs() < 1e-9 && (shear - g).abs() < 1e-9);
    }

    /// The nine constants and the coefficients that follow from them are one law; the energy is half of stress times strain.
    #[test]
    fn constants_and_coefficients_agree() {
        let along = [0.6, 0.8, 0.0, 0.1, 0.0, 1.0];
        let nine = [1400.0, 100.0, 80.0, 0.25, 0.3, 0.4, 50.0, 45.0, 30.0];
        let law = (ORTHOTROPIC.build)(&[&nine[..], &along].concat()).unwrap();
        // The inverse of the compliance by its cofactors.
        let (s11, s22, s33) = (1.0 / 1400.0, 1.0 / 100.0, 1.0 / 80.0);
        let (s12, s13, s23) = (-0.25 / 1400.0, -0.3 / 1400.0, -0.4 / 100.0);
        let det = s11 * (s22 * s33 - s23 * s23) - s12 * (s12 * s33 - s23 * s13) + s13 * (s12 * s23 - s22 * s13);
        let mut c = [0.0; 21];
        c[0] = (s22 * s33 - s23 * s23) / det;
        c[1] = (s13 * s23 - s12 * s33) / det;
        c[2] = (s11 * s33 - s13 * s13) / det;
        c[3] = (s12 * s23 - s13 * s22) / det;
        c[4] = (s12 * s13 - s11 * s23) / det;
        c[5] = (s11 * s22 - s12 * s12) / det;
        (c[9], c[14], c[20]) = (50.0, 45.0, 30.0);
        let other = (ANISOTROPIC.build)(&[&c[..], &along].concat()).unwrap();
        let (one, two) = (stress(law.as_ref(), &strain()), stress(other.as_ref(), &strain()));
        let off = one - two;
        assert!(off.contract(off).sqrt() < 1e-12 * one.contract(one).sqrt());
        let mut state = vec![0.0; law.state_len()];
        law.initialise(&mut state);
        state[..6].copy_from_slice(&one.to_voigt());
        assert!((law.stored_energy(&state) - 0.5 * one.contract(strain())).abs() < 1e-12 * law.stored_energy(&state));
    }

    #[test]
    fn what_is_no_solid_is_refused() {
        let along = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let nine = [1400.0, 100.0, 80.0, 3.0, 0.3, 0.3, 50.0, 45.0, 30.0];
        assert!((ORTHOTROPIC.build)(&[&nine[..], &along].concat()).is_ok());
        let nine = [100.0, 1400.0, 80.0, 0.3, 0.3, 0.3, 50.0, 45.0, 30.0];
        assert!((ORTHOTROPIC.build)(&[&nine[..], &along].concat()).err().unwrap().contains("too large"));
        assert!((ANISOTROPIC.build)(&[&[0.0; 21][..], &along].concat()).is_err());
    }
}
