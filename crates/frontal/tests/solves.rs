//! The three phases on matrices with known answers.

mod support;

use frontal::{FrontalError, Options, Ordering, Pattern, Symbolic};
use support::{Matrix, Random, grid, matrix, solve};

fn assert_solves(matrix: &Matrix, options: &Options) {
    let b = Random(7).vector(matrix.len());
    let x = solve(matrix, options, &b).expect("a regular matrix");
    assert!(matrix.backward_error(&x, &b) < 1e-12, "backward error {}", matrix.backward_error(&x, &b));
}

#[test]
fn grids_are_solved() {
    for (cells, k) in [([8, 20, 0], 2), ([5, 6, 7], 3), ([0, 0, 0], 1), ([30, 0, 0], 1)] {
        assert_solves(&grid(cells, k, 1), &Options::default());
    }
}

#[test]
fn a_random_order_and_late_unknowns_change_nothing_but_the_cost() {
    let matrix = grid([7, 5, 2], 3, 3);
    let mut order = (0..matrix.len()).collect::<Vec<_>>();
    let mut random = Random(5);
    for k in (1..order.len()).rev() {
        order.swap(k, random.below(k + 1));
    }
    let mut options = Options::default();
    options.last = vec![17, 4, 100];
    assert_solves(&matrix, &options);
    let symbolic = Symbolic::analyse(&matrix.pattern, &options).expect("a good pattern");
    let last = symbolic.order().skip(matrix.len() - 9).collect::<Vec<_>>();
    assert_eq!(last, [15, 16, 17, 3, 4, 5, 99, 100, 101]);
    options.ordering = Ordering::Given(order);
    assert_solves(&matrix, &options);
}

#[test]
fn minimum_degree_is_there_if_it_was_built() {
    let matrix = grid([9, 9, 3], 2, 4);
    let mut options = Options::default();
    options.ordering = Ordering::MinimumDegree;
    if cfg!(feature = "feral") {
        assert_solves(&matrix, &options);
    } else {
        let analysis = Symbolic::analyse(&matrix.pattern, &options).map(|_| ());
        assert_eq!(analysis, Err(FrontalError::OrderingNotBuilt));
    }
}

#[test]
fn the_transposed_system_and_many_right_hand_sides() {
    let matrix = grid([6, 9, 1], 2, 11);
    let n = matrix.len();
    let symbolic = Symbolic::analyse(&matrix.pattern, &Options::default()).expect("a good pattern");
    let mut factor = symbolic.new_factor();
    symbolic.factorise(&matrix.values, &mut factor).expect("a regular matrix");
    let b = Random(3).vector(3 * n);
    let (mut x, mut y) = (b.clone(), b.clone());
    factor.solve(&mut x).expect("a regular matrix");
    factor.solve_transposed(&mut y).expect("a regular matrix");
    for k in 0..3 {
        let range = k * n..(k + 1) * n;
        assert!(matrix.backward_error(&x[range.clone()], &b[range.clone()]) < 1e-13);
        let back = matrix.transposed_times(&y[range.clone()]);
        assert!(back.iter().zip(&b[range]).all(|(back, b)| (back - b).abs() < 1e-12));
    }
}

#[test]
fn some_entries_of_the_inverse_are_found_without_the_others() {
    let matrix = grid([9, 11, 5], 3, 5);
    let n = matrix.len();
    let symbolic = Symbolic::analyse(&matrix.pattern, &Options::default()).expect("a good pattern");
    let mut factor = symbolic.new_factor();
    let at = [n - 1, 0, n / 2, 17];
    let loads: Vec<_> = (0..37).map(|k| vec![((k * 29) % n, 1.0 + k as f64), (k, -0.5), (k, 0.25)]).collect();
    let mut x = vec![0.0; loads.len() * at.len()];
    assert_eq!(factor.influence(&loads, &at, &mut x), Err(FrontalError::NotFactorised));
    symbolic.factorise(&matrix.values, &mut factor).expect("a regular matrix");
    factor.influence(&loads, &at, &mut x).expect("a factor");
    for (load, x) in loads.iter().zip(x.chunks_exact(at.len())) {
        let mut solved = vec![0.0; n];
        load.iter().for_each(|&(unknown, value)| solved[unknown] += value);
        factor.solve(&mut solved).expect("a regular matrix");
        let largest = solved.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(x.iter().zip(at).all(|(x, unknown)| (x - solved[unknown]).abs() < 1e-12 * largest));
    }
    assert!(matches!(factor.influence(&loads, &at[..3], &mut x), Err(FrontalError::WrongLength { .. })));
    factor.influence(&[], &at, &mut []).expect("nothing to do");
}

#[test]
fn symmetric_matrices_take_half_the_work() {
    for (cells, k) in [([12, 30, 0], 2), ([6, 7, 8], 3), ([2, 1, 0], 1)] {
        let mut matrix = grid(cells, k, 9);
        let random = |i: usize, j: usize| Random((i * 1000 + j) as u64).next() + if i == j { 30.0 } else { 0.0 };
        matrix.values = matrix.entries().map(|(i, j, _)| random(i.min(j), i.max(j))).collect();
        let mut options = Options::default();
        options.symmetric = true;
        assert_solves(&matrix, &options);
        let cost = |options: &Options| Symbolic::analyse(&matrix.pattern, options).expect("a pattern").prediction();
        assert_eq!(cost(&options).flops, 0.5 * cost(&Options::default()).flops);
    }
}

#[test]
fn values_may_be_badly_scaled() {
    let mut matrix = grid([6, 6, 3], 3, 2);
    let scales = (0..matrix.len()).map(|k| 10f64.powi((k * 7 % 13) as i32 * 2 - 12)).collect::<Vec<_>>();
    let scaled = matrix.entries().map(|(i, j, a)| a * scales[i] * scales[matrix.len() - 1 - j]).collect();
    matrix.values = scaled;
    assert_solves(&matrix, &Options::default());
}

#[test]
fn an_empty_matrix_has_an_empty_solution() {
    let empty = Matrix { pattern: Pattern::new(vec![0], vec![]).expect("nothing"), values: vec![] };
    assert_eq!(solve(&empty, &Options::default(), &[]), Ok(vec![]));
}

#[test]
fn a_disconnected_matrix_is_solved() {
    let matrix = matrix(6, &[(0, 3), (1, 4)], |i, j| if i == j { 3.0 } else { (i + 2 * j) as f64 * 0.1 });
    assert_solves(&matrix, &Options::default());
}

#[test]
fn a_free_chain_is_singular_along_its_translation() {
    let n = 50;
    let pairs = (1..n).map(|k| (k - 1, k)).collect::<Vec<_>>();
    let ends = |i: usize| i == 0 || i == n - 1;
    let chain = matrix(n, &pairs, |i, j| match i == j {
        true if ends(i) => 1.0,
        true => 2.0,
        false => -1.0,
    });
    match solve(&chain, &Options::default(), &vec![1.0; n]) {
        Err(FrontalError::Singular(singular)) => {
            assert_eq!(singular.unknowns.len(), 1);
            assert!(singular.null_vectors[0].entries.iter().all(|x| (x - 1.0).abs() < 1e-9));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn two_free_chains_have_two_null_vectors() {
    let pairs = (1..40).filter(|k| k % 20 != 0).map(|k| (k - 1, k)).collect::<Vec<_>>();
    let stiffness = |k: usize| if k < 20 { 1.0 } else { 1e5 };
    let chains = matrix(40, &pairs, |i, j| match i == j {
        true if i % 20 == 0 || i % 20 == 19 => stiffness(i),
        true => 2.0 * stiffness(i),
        false => -stiffness(i),
    });
    match solve(&chains, &Options::default(), &[1.0; 40]) {
        Err(FrontalError::Singular(singular)) => {
            assert_eq!(singular.null_vectors.len(), 2);
            for vector in &singular.null_vectors {
                let constant = |half: &[f64]| half.iter().all(|x| (x - half[0]).abs() < 1e-9);
                assert!(vector.entries.chunks(20).all(constant), "{:?}", vector.entries);
            }
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_zero_pivot_of_a_regular_matrix_is_no_obstacle() {
    let saddle = matrix(3, &[(0, 2), (1, 2)], |i, j| if i == j { [1.0, 2.0, 0.0][i] } else { 1.0 });
    let mut options = Options::default();
    options.ordering = Ordering::Given(vec![2, 0, 1]);
    options.amalgamation.always = 0;
    assert_solves(&saddle, &options);
}

#[test]
fn condition_and_growth_of_a_known_matrix() {
    let diagonal = matrix(5, &[], |i, _| if i == 3 { 1e-6 } else { 1.0 });
    let mut options = Options::default();
    options.equilibrate = false;
    let symbolic = Symbolic::analyse(&diagonal.pattern, &options).expect("a good pattern");
    let mut factor = symbolic.new_factor();
    symbolic.factorise(&diagonal.values, &mut factor).expect("a regular matrix");
    let condition = factor.condition().expect("values");
    assert!((condition / 1e6 - 1.0).abs() < 1e-12, "{condition}");
    assert_eq!(factor.growth(), Ok(1.0));
}

#[test]
fn bad_input_is_refused() {
    let matrix = grid([2, 2, 0], 1, 1);
    let symbolic = Symbolic::analyse(&matrix.pattern, &Options::default()).expect("a good pattern");
    let mut factor = symbolic.new_factor();
    assert_eq!(factor.solve(&mut [0.0; 9]), Err(FrontalError::NotFactorised));
    let mut values = matrix.values.clone();
    values[4] = f64::NAN;
    assert_eq!(symbolic.factorise(&values, &mut factor), Err(FrontalError::NotFinite { row: 1, column: 0 }));
    assert!(matches!(symbolic.factorise(&values[1..], &mut factor), Err(FrontalError::WrongLength { .. })));
    symbolic.factorise(&matrix.values, &mut factor).expect("a regular matrix");
    assert!(matches!(factor.solve(&mut [0.0; 10]), Err(FrontalError::WrongLength { .. })));
    assert!(matches!(factor.solve(&mut [f64::INFINITY; 9]), Err(FrontalError::NotFinite { .. })));
    let other = Symbolic::analyse(&matrix.pattern, &Options::default()).expect("a good pattern");
    assert_eq!(other.factorise(&matrix.values, &mut factor), Err(FrontalError::ForeignFactor));
    let mut options = Options::default();
    options.memory_limit = Some(100);
    assert!(matches!(Symbolic::analyse(&matrix.pattern, &options), Err(FrontalError::MemoryLimit { limit: 100, .. })));
    options = Options::default();
    options.last = vec![3, 3];
    assert!(matches!(Symbolic::analyse(&matrix.pattern, &options), Err(FrontalError::InvalidOrder { unknown: 3 })));
}
