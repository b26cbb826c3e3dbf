//! Newton's method with the factor of an attempt's first iteration against a factor for every iteration.

#[path = "support/ball.rs"]
mod ball;

use asperity::solve::Factors;
use ball::{Attempts, model};

/// Displacements and attempts of a run on so many threads.
fn slide(factors: Factors, threads: usize) -> (Vec<f64>, Attempts) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let model = model(8, factors);
        let mut attempts = Attempts::default();
        let mut run = model.run(model.problem.initial_state());
        run.run(&Default::default(), &mut attempts).unwrap();
        (run.state.u, attempts)
    })
}

#[test]
fn one_factor_an_attempt_takes_the_same_iterations_to_the_same_place() {
    let (u, fresh) = slide(Factors::Fresh, 1);
    let (v, attempt) = slide(Factors::Attempt, 1);
    let ((all, factorised), (iterations, few)) = (fresh.iterations(), attempt.iterations());
    assert_eq!(all, factorised);
    assert!(2 * few < iterations && few >= attempt.0.len(), "{few} of {iterations} factorised");
    assert!(iterations.abs_diff(all) * 10 <= all, "{iterations} iterations against {all}");
    let largest = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    let difference = u.iter().zip(&v).fold(0.0_f64, |m, (u, v)| m.max((u - v).abs()));
    assert!(difference < 1e-5 * largest, "{difference:.1e} of {largest:.1e}");
}

#[test]
fn the_number_of_threads_does_not_show() {
    let one = slide(Factors::Attempt, 1).0;
    for threads in [2, 4] {
        let other = slide(Factors::Attempt, threads).0;
        assert!(one.iter().zip(&other).all(|(a, b)| a.to_bits() == b.to_bits()), "{threads} threads");
    }
}

#[test]
fn a_repeated_attempt_does_not_show() {
    let mut rehearsed = model(6, Factors::Attempt);
    rehearsed.problem.newton.rehearse = true;
    let plain = model(6, Factors::Attempt);
    let [u, v] = [&plain, &rehearsed].map(|model| {
        let mut run = model.run(model.problem.initial_state());
        run.run(&Default::default(), &mut Attempts::default()).unwrap();
        run.state.u
    });
    assert!(u.iter().zip(&v).all(|(a, b)| a.to_bits() == b.to_bits()));
}
