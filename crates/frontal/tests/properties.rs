//! Random structurally symmetric matrices against dense LU with partial pivoting.

mod support;

use frontal::{FrontalError, Options, Ordering, Pattern, Symbolic, market};
use proptest::prelude::*;
use support::{Matrix, Random, matrix, solve};

/// Kinds of values; each has its own trouble.
#[derive(Debug, Clone, Copy)]
enum Kind {
    /// The diagonal is no larger than the rest.
    General,
    /// The last third of the unknowns have no diagonal entry, like Lagrange multipliers.
    Saddle,
    /// Rows and columns scaled by powers of ten.
    BadlyScaled,
}

fn kinds() -> impl Strategy<Value = Kind> {
    prop_oneof![Just(Kind::General), Just(Kind::Saddle), Just(Kind::BadlyScaled)]
}

fn random_matrix(n: usize, density: usize, kind: Kind, seed: u64) -> Matrix {
    let mut random = Random(seed);
    let pairs = (0..n * density).map(|_| (random.below(n), random.below(n))).collect::<Vec<_>>();
    let scale = |k: usize| 10f64.powi((k % 9) as i32 * 3 - 12);
    matrix(n, &pairs, |i, j| match kind {
        Kind::General => random.next(),
        Kind::Saddle if i == j && 3 * i >= 2 * n => 0.0,
        Kind::Saddle => random.next() + if i == j { 3.0 } else { 0.0 },
        Kind::BadlyScaled => random.next() * scale(i) * scale(j + 4),
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Either the solution is good, or the error names unknowns; a matrix that dense LU finds regular is solved.
    #[test]
    fn never_a_silent_answer(
        n in 1..60usize, density in 0..5usize, kind in kinds(), seed: u64, blocks in 1..4usize, always in 0..20usize,
    ) {
        let mut matrix = random_matrix(n, density, kind, seed);
        matrix.pattern = matrix.pattern.with_nodes((0..n).map(|k| k / blocks).collect()).expect("a node each");
        let mut options = Options::default();
        options.amalgamation.always = always;
        let b = Random(seed ^ 1).vector(n);
        let (_, smallest_pivot) = matrix.dense_solve(&b);
        let symbolic = Symbolic::analyse(&matrix.pattern, &options).expect("a good pattern");
        let report = symbolic.factorise(&matrix.values, &mut symbolic.new_factor());
        let unperturbed = report.is_ok_and(|report| report.perturbed.is_empty());
        let bound = if unperturbed { 1e-12 } else { 1e-10 };
        match solve(&matrix, &options, &b) {
            Ok(x) => prop_assert!(matrix.backward_error(&x, &b) < bound),
            Err(FrontalError::Singular(singular)) => {
                prop_assert!(!singular.unknowns.is_empty() && !singular.null_vectors.is_empty());
                prop_assert!(smallest_pivot < 1e-9 || matches!(kind, Kind::BadlyScaled), "{smallest_pivot}");
            }
            Err(FrontalError::Inaccurate { unknowns, .. }) => {
                prop_assert!(!unknowns.is_empty());
                prop_assert!(smallest_pivot < 1e-6 || matches!(kind, Kind::BadlyScaled), "{smallest_pivot}");
            }
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    /// Diagonally dominant matrices lose nothing, in any order.
    #[test]
    fn dominant_matrices_are_solved_to_the_last_digits(n in 1..80usize, density in 0..6usize, seed: u64) {
        let mut matrix = random_matrix(n, density, Kind::General, seed);
        let starts = matrix.pattern.starts().to_vec();
        for i in 0..n {
            let at = starts[i] + matrix.pattern.columns()[starts[i]..starts[i + 1]].partition_point(|&j| j < i);
            matrix.values[at] = (starts[i + 1] - starts[i]) as f64;
        }
        let mut options = Options::default();
        let mut random = Random(seed);
        let mut order = (0..n).collect::<Vec<_>>();
        (1..n).for_each(|k| order.swap(k, random.below(k + 1)));
        options.ordering = Ordering::Given(order);
        options.refinements = 0;
        let b = random.vector(n);
        let x = solve(&matrix, &options, &b).expect("a regular matrix");
        prop_assert!(matrix.backward_error(&x, &b) < 1e-13);
        let (reference, _) = matrix.dense_solve(&b);
        prop_assert!(x.iter().zip(&reference).all(|(x, y)| (x - y).abs() < 1e-11));
    }

    /// A pattern is either refused or analysed, and covers itself.
    #[test]
    fn any_pattern_is_refused_or_analysed(
        starts in prop::collection::vec(0..12usize, 0..8), columns in prop::collection::vec(0..8usize, 0..12),
    ) {
        if let Ok(pattern) = Pattern::new(starts, columns) {
            let symbolic = Symbolic::analyse(&pattern, &Options::default()).expect("a good pattern");
            prop_assert!(symbolic.covers(&pattern));
        }
    }

    /// Matrix Market text comes back to the last bit.
    #[test]
    fn a_matrix_survives_its_file(n in 1..30usize, density in 0..4usize, kind in kinds(), seed: u64) {
        let matrix = random_matrix(n, density, kind, seed);
        let mut text = Vec::new();
        market::write(&mut text, &matrix.pattern, &matrix.values).expect("memory");
        let (pattern, values) = market::read(&text[..]).expect("our own file");
        prop_assert_eq!(pattern, matrix.pattern);
        prop_assert_eq!(values, matrix.values);
    }
}

#[test]
fn market_files_with_mistakes_are_refused() {
    let read = |text: &str| market::read(text.as_bytes()).map(|(pattern, _)| pattern.nonzeros()).ok();
    assert_eq!(read("%%MatrixMarket matrix coordinate real symmetric\n% so\n2 2 2\n1 1 4\n2 1 1.5\n"), Some(3));
    assert_eq!(read("%%MatrixMarket matrix coordinate real general\n2 2 1\n2 1 1.5\n"), Some(2));
    assert_eq!(read("%%MatrixMarket matrix array real general\n1 1\n4\n"), None);
    assert_eq!(read("%%MatrixMarket matrix coordinate real general\n2 3 1\n2 1 1.5\n"), None);
    assert_eq!(read("%%MatrixMarket matrix coordinate real general\n2 2 2\n2 1 1.5\n"), None);
    assert_eq!(read("%%MatrixMarket matrix coordinate real general\n2 2 1\n3 1 1.5\n"), None);
    assert_eq!(read("%%MatrixMarket matrix coordinate real general\n2 2 1\n0 1 1.5\n"), None);
    assert_eq!(read("%%MatrixMarket matrix coordinate real general\n2 2 1\n1 1 x\n"), None);
    assert_eq!(read(""), None);
}
