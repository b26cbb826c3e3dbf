//! The number of threads must not show in a single bit.

#[path = "../benches/models/mod.rs"]
mod models;

use frontal::{Krylov, Options, Symbolic};

/// Bits of the solutions of the system, of its transpose and of one with other values.
fn solution_bits(model: &models::Model, options: &Options, threads: usize) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    pool.install(|| {
        let symbolic = Symbolic::analyse(&model.pattern, options).expect("a good pattern");
        let mut factor = symbolic.new_factor();
        let n = model.pattern.len();
        let mut x = (0..n).map(|k| (k as f64).sin()).collect::<Vec<_>>();
        let mut y = x.clone();
        symbolic.factorise(&model.values, &mut factor).expect("a regular matrix");
        factor.solve(&mut x).expect("a regular matrix");
        factor.solve_transposed(&mut y).expect("a regular matrix");
        let other = model.values.iter().map(|value| value + 0.1 * value.abs()).collect::<Vec<_>>();
        let mut z = x.clone();
        factor.solve_with(&other, &mut z, &Krylov::default()).expect("good input");
        x.iter().chain(&y).chain(&z).map(|x| x.to_bits()).collect()
    })
}

fn assert_same_bits(model: &models::Model, options: &Options) {
    let one = solution_bits(model, options, 1);
    assert!(one == solution_bits(model, options, 2), "{} with two threads", model.name);
    assert!(one == solution_bits(model, options, 4), "{} with four threads", model.name);
}

#[test]
fn one_two_and_four_threads_give_the_same_bits() {
    for model in [models::hex8([11, 11, 11]), models::bordered([7, 7, 7], 6), models::quad8([40, 40])] {
        assert_same_bits(&model, &Options::default());
    }
}

#[test]
fn so_they_do_for_symmetric_matrices() {
    let mut model = models::hex8([11, 11, 11]);
    model.symmetrise();
    let mut options = Options::default();
    options.symmetric = true;
    assert_same_bits(&model, &options);
}
