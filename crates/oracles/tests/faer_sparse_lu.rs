//! The same solutions as faer's sparse LU.

#[path = "../../frontal/benches/models/mod.rs"]
mod models;

use frontal::{Options, Symbolic};

/// Numbers between -1 and 1 (xorshift).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn below(&mut self, n: usize) -> usize {
        ((self.next() + 1.0) * 0.5 * n as f64) as usize % n
    }
}

/// A random structurally symmetric matrix with a diagonal that keeps it regular, and unsymmetric values.
fn random_model(seed: u64) -> models::Model {
    let mut random = Random(seed * 0x9e37_79b9_7f4a_7c15 + 1);
    let n = 1 + random.below(120);
    let mut rows = (0..n).map(|i| vec![i]).collect::<Vec<_>>();
    for _ in 0..random.below(4 * n + 1) {
        let (i, j) = (random.below(n), random.below(n));
        rows[i].push(j);
        rows[j].push(i);
    }
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (i, row) in rows.iter_mut().enumerate() {
        row.sort_unstable();
        row.dedup();
        values.extend(row.iter().map(|&j| random.next() + if i == j { row.len() as f64 } else { 0.0 }));
        columns.extend_from_slice(row);
        starts.push(columns.len());
    }
    let pattern = frontal::Pattern::new(starts, columns).expect("symmetric");
    models::Model { name: format!("random {seed}"), pattern, values }
}

#[test]
fn solutions_agree_with_faer() {
    let bodies = [models::hex8([6, 7, 8]), models::quad8([20, 20]), models::bordered([5, 5, 5], 6)];
    for model in bodies.into_iter().chain((0..200).map(random_model)) {
        let n = model.pattern.len();
        let b = (0..n).map(|k| (k as f64).sin()).collect::<Vec<_>>();
        let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
        let mut factor = symbolic.new_factor();
        symbolic.factorise(&model.values, &mut factor).expect("a regular matrix");
        let mut x = b.clone();
        factor.solve(&mut x).expect("a regular matrix");

        let matrix = oracles::matrix(&model.pattern, &model.values);
        let mut y = b;
        oracles::solve(&oracles::factorise(&oracles::analyse(&matrix), &matrix).expect("a regular matrix"), &mut y);
        let size = y.iter().fold(0.0, |size: f64, y| size.max(y.abs()));
        let difference = x.iter().zip(&y).fold(0.0, |worst: f64, (x, y)| worst.max((x - y).abs()));
        assert!(difference <= 1e-9 * size, "{}: {difference} of {size}", model.name);
    }
}
