//! Symmetric values: L D L^T beside L U, the signs of its pivots, and what it refuses.

#[path = "../benches/models/mod.rs"]
mod models;
mod support;

use frontal::{Factor, FrontalError, Options, Pattern, PivotSigns, Symbolic};
use std::f64::consts::PI;
use support::{Matrix, matrix};

fn symmetric() -> Options {
    let mut options = Options::default();
    options.symmetric = true;
    options
}

fn factorised(pattern: &Pattern, values: &[f64], options: &Options) -> Result<Factor, FrontalError> {
    let symbolic = Symbolic::analyse(pattern, options)?;
    let mut factor = symbolic.new_factor();
    symbolic.factorise(values, &mut factor)?;
    Ok(factor)
}

/// Fronts of one stripe and of many, with and without a border.
#[test]
fn both_factors_solve_alike() {
    for cells in [[3, 2, 2], [11, 11, 11], [15, 14, 13]] {
        let mut model = models::hex8(cells);
        model.symmetrise();
        let n = model.pattern.len();
        let analysis = Symbolic::analyse(&model.pattern, &Options::default()).unwrap();
        let of = |symmetric: bool| {
            let analysis = analysis.for_values(symmetric).unwrap();
            let mut factor = analysis.new_factor();
            analysis.factorise(&model.values, &mut factor).unwrap();
            factor
        };
        let (lu, ldl) = (of(false), of(true));
        let near = |x: &[f64], y: &[f64], part: f64| {
            let largest = x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            assert!(x.iter().zip(y).all(|(x, y)| (x - y).abs() <= part * largest), "{cells:?}");
        };
        let mut x: Vec<f64> = (0..n).map(|k| (k as f64).sin()).collect();
        let (mut y, mut z) = (x.clone(), x.clone());
        let refined = [lu.solve(&mut x).unwrap(), ldl.solve(&mut y).unwrap(), ldl.solve_transposed(&mut z).unwrap()];
        assert!(refined.iter().all(|accuracy| accuracy.backward_error < 1e-14 && accuracy.refinements <= 1));
        near(&x, &y, 1e-10);
        near(&x, &z, 1e-10);
        let loads: Vec<_> = (0..19).map(|k| vec![((k * 29) % n, 1.0 + k as f64), (k, -0.5)]).collect();
        let at = [n - 1, 0, n / 2, 17];
        let [mut x, mut y] = [(); 2].map(|()| vec![0.0; loads.len() * at.len()]);
        lu.influence(&loads, &at, &mut x).unwrap();
        ldl.influence(&loads, &at, &mut y).unwrap();
        near(&x, &y, 1e-10);
        let signs = |symmetric, negative| Some(PivotSigns { symmetric, negative });
        assert_eq!((lu.signs(), ldl.signs()), (signs(false, 0), signs(true, 0)));
        assert!(ldl.growth().unwrap() <= 1.0 + 1e-12 && lu.growth().unwrap() < 10.0);
    }
}

/// The discrete Laplacian on a rectangle less a multiple of the unit matrix has negative eigenvalues that are known.
#[test]
fn negative_pivots_are_negative_eigenvalues() {
    let (width, height) = (23, 31);
    let (n, at) = (width * height, |i: usize, j: usize| i + width * j);
    let right = (1..width).flat_map(|i| (0..height).map(move |j| (at(i - 1, j), at(i, j))));
    let up = (0..width).flat_map(|i| (1..height).map(move |j| (at(i, j - 1), at(i, j))));
    let pairs: Vec<_> = right.chain(up).collect();
    let wave = |k: usize, n: usize| 2.0 - 2.0 * (PI * (k + 1) as f64 / (n + 1) as f64).cos();
    for shift in [0.01, 0.1, 0.5, 1.3, 3.77] {
        let Matrix { pattern, values } = matrix(n, &pairs, |i, j| if i == j { 4.0 - shift } else { -1.0 });
        let [factor, lu] = [symmetric(), Options::default()].map(|o| factorised(&pattern, &values, &o).unwrap());
        let lower = (0..n).filter(|k| wave(k % width, width) + wave(k / width, height) < shift).count();
        assert_eq!(factor.signs(), Some(PivotSigns { symmetric: true, negative: lower }), "{shift}");
        assert_eq!(lu.signs(), Some(PivotSigns { symmetric: false, negative: lower % 2 }), "{shift}");
    }
}

#[test]
fn pivots_from_the_diagonal_that_will_not_do_are_refused() {
    // Multipliers: nothing on their diagonal.
    let saddle = matrix(4, &[(0, 2), (1, 3), (2, 3)], |i, j| if i == j { 0.0 } else { (i + j) as f64 });
    let refused = factorised(&saddle.pattern, &saddle.values, &symmetric());
    assert_eq!(refused.map(|_| ()), Err(FrontalError::Unstable));
    let factor = factorised(&saddle.pattern, &saddle.values, &Options::default()).unwrap();
    let mut x = [1.0, 2.0, 3.0, 4.0];
    factor.solve(&mut x).unwrap();
    assert!(saddle.backward_error(&x, &[1.0, 2.0, 3.0, 4.0]) < 1e-14);
}

#[test]
fn symmetry_is_seen_in_the_values() {
    let mut matrix = matrix(3, &[(0, 1), (1, 2)], |i, j| if i == j { 1e6 } else { -1.0 });
    assert!(matrix.pattern.is_symmetric(&matrix.values, 1e-12));
    matrix.values[1] += 1e-7;
    assert!(matrix.pattern.is_symmetric(&matrix.values, 1e-12));
    matrix.values[1] += 1e-5;
    assert!(!matrix.pattern.is_symmetric(&matrix.values, 1e-12));
    matrix.values[1] = f64::NAN;
    assert!(!matrix.pattern.is_symmetric(&matrix.values, 1e-12));
}

/// A dense matrix of one front, with rounding in place of its zeros.
#[test]
fn a_matrix_of_one_front_with_small_entries_is_solved() {
    let e = 1e-14;
    let rows: [[f64; 6]; 6] = [
        [500.0, 0.0, 0.0, 0.0, -500.0, 0.4 * e],
        [-0.7 * e, 500.0, 0.7 * e, 500.0, -0.7 * e, 2.8 * e],
        [-0.7 * e, -1.4 * e, 1000.0, -9.9 * e, -1.4 * e, 0.0],
        [-0.4 * e, 500.0, 0.0, 625.0, 3.6 * e, 0.0],
        [-500.0, 0.0, 0.0, 0.7 * e, 625.0, 0.0],
        [-5.3 * e, -1.4 * e, -0.4 * e, -3.0 * e, -0.4 * e, 83.0],
    ];
    let (starts, columns) = ((0..=6).map(|k| 6 * k).collect(), (0..36).map(|k| k % 6).collect());
    let pattern = Pattern::new(starts, columns).unwrap();
    let factor = factorised(&pattern, &rows.concat(), &symmetric()).unwrap();
    let mut x = vec![0.0, 0.0, 20.0, 0.0, 0.0, 0.0];
    factor.solve(&mut x).unwrap();
    assert!((x[2] - 0.02).abs() < 1e-15, "{x:?}");
}
