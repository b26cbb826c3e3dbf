//! Newton's method with the factor of an earlier increment against a factor for every iteration.

#[path = "support/ball.rs"]
mod ball;

use asperity::model::Model;
use asperity::solve::{Factors, Frontal, LinearSolver, RunOptions, Unknowns};
use asperity::system::{Csr, Dofs, Factorised, Near, State};
use ball::{Attempts, distance, model};
use std::sync::Arc;

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
fn a_factor_serves_increments_to_come() {
    let (u, fresh) = slide(Factors::Fresh, 1);
    let (v, kept) = slide(Factors::Kept, 1);
    let ((all, factorised), (iterations, few)) = (fresh.iterations(), kept.iterations());
    assert_eq!(all, factorised);
    assert!(4 * few < all && few < kept.0.len(), "{few} of {iterations} factorised");
    assert!(iterations.abs_diff(all) * 10 <= all, "{iterations} iterations against {all}");
    assert!(distance(&u, &v) < 1e-5, "{:.1e}", distance(&u, &v));
}

#[test]
fn the_number_of_threads_does_not_show() {
    let one = slide(Factors::Kept, 1).0;
    for threads in [2, 4] {
        assert!(same(&one, &slide(Factors::Kept, threads).0), "{threads} threads");
    }
}

#[test]
fn a_repeated_attempt_does_not_show() {
    let mut rehearsed = model(6, Factors::Kept);
    rehearsed.problem.newton.rehearse = true;
    let [u, v] = [&model(6, Factors::Kept), &rehearsed].map(|model| go_on(model, model.problem.initial_state(), None));
    assert!(bytes(&u) == bytes(&v));
}

/// With the matrix that the state holds a new solver makes the same factor.
#[test]
fn a_restart_does_not_show() {
    let model = model(6, Factors::Kept);
    let whole = go_on(&model, model.problem.initial_state(), None);
    let mut held = 0;
    for increment in 1..whole.increment {
        let begun = go_on(&model, model.problem.initial_state(), Some(increment));
        held += usize::from(begun.preconditioner.is_some());
        let read: State = postcard::from_bytes(&bytes(&begun)).unwrap();
        model.problem.fits(&read).unwrap();
        assert!(bytes(&go_on(&model, read, None)) == bytes(&whole), "from increment {increment}");
    }
    assert!(held > 2, "{held} states hold a matrix");
}

type Spoil<'a> = &'a dyn Fn(&mut Factorised, &mut Near);

/// What a checkpoint may hold that no run wrote.
#[test]
fn a_matrix_that_cannot_be_is_refused_and_one_without_a_factor_left_out() {
    let model = model(6, Factors::Kept);
    let state = go_on(&model, model.problem.initial_state(), Some(3));
    let spoilt = |spoil: Spoil| {
        let mut state = state.clone();
        let held = state.preconditioner.as_mut().expect("a factor that serves on");
        spoil(Arc::make_mut(&mut held.matrix), &mut held.near);
        state
    };
    let impossible: [Spoil; 9] = [
        &|matrix, _| matrix.pattern.0[1] = u32::MAX,
        &|matrix, _| matrix.pattern.0[2] = u32::MAX,
        &|matrix, _| matrix.pattern.0[0] = 7,
        &|matrix, _| matrix.pattern.0.clear(),
        &|matrix, _| Arc::make_mut(&mut matrix.values).truncate(5),
        &|matrix, _| *matrix.free.last_mut().expect("unknowns") = usize::MAX,
        &|_, near| near.at.push(usize::MAX),
        &|_, near| near.closed = vec![usize::MAX],
        &|_, near| near.columns = vec![usize::MAX],
    ];
    for (number, spoil) in impossible.into_iter().enumerate() {
        assert!(model.problem.fits(&spoilt(spoil)).is_err(), "number {number}");
    }
    let useless: [Spoil; 3] = [
        &|matrix, _| Arc::make_mut(&mut matrix.values)[3] = f64::NAN,
        &|matrix, _| Arc::make_mut(&mut matrix.values).fill(0.0),
        &|_, near| *near = Near { columns: vec![0], ..Near::default() },
    ];
    let sound = go_on(&model, state.clone(), Some(1)).u;
    for (number, spoil) in useless.into_iter().enumerate() {
        let state = spoilt(spoil);
        model.problem.fits(&state).unwrap();
        let u = go_on(&model, state, Some(1)).u;
        assert!(distance(&sound, &u) < 1e-5, "number {number}: {:.1e}", distance(&sound, &u));
    }
}

/// The state after so many increments, or all.
fn go_on(model: &Model, state: State, increments: Option<usize>) -> State {
    let mut run = model.run(state);
    run.run(&RunOptions { increments }, &mut Attempts::default()).unwrap();
    run.state
}

fn bytes(state: &State) -> Vec<u8> {
    postcard::to_stdvec(state).unwrap()
}

fn same(u: &[f64], v: &[f64]) -> bool {
    u.iter().zip(v).all(|(a, b)| a.to_bits() == b.to_bits())
}

/// A chain of springs, with a skew part between the first two of its unknowns, and with a stiffness at its first.
fn chain(skew: f64, first: f64) -> (Csr, Vec<f64>) {
    let n = 40_usize;
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for row in 0..n {
        for column in row.saturating_sub(1)..(row + 2).min(n) {
            columns.push(column);
            values.push(match (row, column) {
                (0, 0) => first,
                (0, 1) => -1.0 + skew,
                _ if row == column => 2.0,
                _ => -1.0,
            });
        }
        starts.push(columns.len());
    }
    (Csr::new(Arc::new(starts), Arc::new(columns)), values)
}

/// Each matrix by itself: what came before does not show in a bit.
#[test]
fn values_decide_how_a_matrix_is_factorised() {
    let (pattern, _) = chain(0.0, 2.0);
    let mut solver = Frontal::new(Factors::Fresh);
    let (dofs, free) = (Dofs::new(2, pattern.rows(), 0), (0..pattern.rows()).map(|k| 2 * k).collect::<Vec<_>>());
    solver.set_pattern(&pattern, Unknowns { dofs: &dofs, free: &free }).unwrap();
    let mut solved: Vec<(f64, Vec<u64>)> = Vec::new();
    // Symmetric, by rounding, not, and again; one negative eigenvalue.
    let all = [0.0, 1e-15, 0.1, 0.0].map(|skew| (skew, 2.0, skew < 0.1, 0));
    for (skew, first, symmetric, negative) in all.into_iter().chain([(0.0, -1.0, true, 1)]) {
        let (_, values) = chain(skew, first);
        let signs = solver.factorise(&values).unwrap().signs.unwrap();
        assert_eq!((signs.symmetric, signs.negative), (symmetric, negative), "{skew} {first}");
        let mut x: Vec<f64> = (0..pattern.rows()).map(|k| (k as f64).sin()).collect();
        let b = x.clone();
        solver.solve(&mut x).unwrap();
        for (row, b) in b.iter().enumerate() {
            let range = pattern.starts[row]..pattern.starts[row + 1];
            let product: f64 = range.map(|at| values[at] * x[pattern.columns[at]]).sum();
            assert!((product - b).abs() < 1e-11, "{skew} {first}, row {row}");
        }
        let bits: Vec<u64> = x.iter().map(|x| x.to_bits()).collect();
        let before = solved.iter().find(|(same, _)| *same == skew && first == 2.0);
        assert!(before.is_none_or(|(_, before)| *before == bits), "{skew} {first}");
        solved.push((skew, bits));
    }
}
