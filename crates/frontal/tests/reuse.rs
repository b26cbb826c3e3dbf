//! Solving with the factor of another matrix.

#[path = "../benches/models/mod.rs"]
mod models;

use frontal::{Krylov, LowRankChange, Options, Outcome, Pattern, Policy, Reuse, Solver, Symbolic, Work};

/// A body with stiff springs on some nodes of its top, as where a rigid body touches it.
fn with_patch(model: &models::Model, first_node: usize) -> Vec<f64> {
    let (starts, columns) = (model.pattern.starts(), model.pattern.columns());
    let mut values = model.values.clone();
    let n = model.pattern.len();
    for unknown in (n - 3 * first_node - 60)..(n - 3 * first_node) {
        let at = columns[starts[unknown]..starts[unknown + 1]].binary_search(&unknown).expect("a diagonal");
        values[starts[unknown] + at] += 40.0;
    }
    values
}

/// The tolerance holds in the equilibrated scale, whose norms are within this factor of the plain ones for these models.
const SCALES: f64 = 10.0;

fn residual(model: &models::Model, values: &[f64], x: &[f64], b: &[f64]) -> f64 {
    let (starts, columns) = (model.pattern.starts(), model.pattern.columns());
    let row = |i: usize| b[i] - (starts[i]..starts[i + 1]).map(|at| values[at] * x[columns[at]]).sum::<f64>();
    let norm = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
    norm(&(0..b.len()).map(row).collect::<Vec<_>>()) / norm(b)
}

#[test]
fn an_old_factor_solves_a_matrix_that_changed_in_a_patch() {
    let model = models::hex8([9, 9, 9]);
    let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
    let mut factor = symbolic.new_factor();
    symbolic.factorise(&with_patch(&model, 0), &mut factor).expect("a regular matrix");
    let values = with_patch(&model, 1);
    let b = (0..model.pattern.len()).map(|k| (k as f64).cos()).collect::<Vec<_>>();
    let mut x = b.clone();
    let convergence = factor.solve_with(&values, &mut x, &Krylov::default()).expect("good input");
    assert!(convergence.converged && convergence.iterations < 15, "{convergence:?}");
    assert!(residual(&model, &values, &x, &b) < SCALES * 1e-10);

    let krylov = Krylov { restart: 8, iterations: 300, ..Krylov::default() };
    let mut x = b.clone();
    let restarted = factor.solve_with(&values, &mut x, &krylov).expect("good input");
    assert!(restarted.converged && restarted.iterations >= convergence.iterations, "{restarted:?}");
    assert!(residual(&model, &values, &x, &b) < SCALES * 1e-10);
}

#[test]
fn a_sequence_begins_with_a_fresh_factor() {
    let model = models::hex8([12, 12, 12]);
    let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
    let b = vec![1.0; model.pattern.len()];
    let run = |policy: Policy| {
        let mut solver = Solver::new(symbolic.clone(), policy);
        let mut direct = Vec::new();
        for node in [0, 1, 2, 3] {
            if node == 2 {
                solver.begin();
            }
            let (values, mut x) = (with_patch(&model, node), b.clone());
            let outcome = solver.solve(&values, &mut x, 1e-9).expect("a regular matrix");
            assert!(residual(&model, &values, &x, &b) < SCALES * 1e-9);
            direct.push(matches!(outcome, Outcome::Direct { .. }));
        }
        direct
    };
    // A body as small as this one would not do with half a factorisation's cost.
    let policy = |reuse| Policy { reuse, share: 2.0, ..Policy::default() };
    assert_eq!(run(policy(Reuse::WithinSequence)), [true, false, true, false]);
    assert_eq!(run(policy(Reuse::Never)), [true; 4]);
    assert_eq!(run(policy(Reuse::AcrossSequences)), [true, false, false, false]);
}

#[test]
fn a_factor_of_one_pattern_serves_another() {
    let model = models::hex8([6, 6, 6]);
    let n = model.pattern.len();
    // The first unknown and the last couple too.
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for row in 0..n {
        let range = model.pattern.starts()[row]..model.pattern.starts()[row + 1];
        let mut entries: Vec<_> = range.map(|at| (model.pattern.columns()[at], model.values[at])).collect();
        match row {
            0 => entries.push((n - 1, 0.5)),
            row if row == n - 1 => entries.insert(0, (0, 0.5)),
            _ => {}
        }
        columns.extend(entries.iter().map(|entry| entry.0));
        values.extend(entries.iter().map(|entry| entry.1));
        starts.push(columns.len());
    }
    let other = Pattern::new(starts, columns).expect("a good pattern");
    let analyse = |pattern: &Pattern| Symbolic::analyse(pattern, &Options::default()).expect("a good pattern");
    let mut solver = Solver::new(analyse(&model.pattern), Policy { share: f64::INFINITY, ..Policy::default() });
    solver.factorise(&model.values).expect("a regular matrix");
    let row: Vec<_> = solver.factor().row(5).collect();
    let range = model.pattern.starts()[5]..model.pattern.starts()[6];
    let expected = model.pattern.columns()[range.clone()].iter().copied().zip(model.values[range].iter().copied());
    assert!(row.into_iter().eq(expected), "a row as it was given");

    assert!(solver.follow(models::hex8([5, 6, 6]).pattern).is_err(), "other unknowns");
    solver.follow(other.clone()).expect("the same unknowns");
    let mut x = vec![1.0; n];
    solver.iterate(&values, &mut x, 1e-10).expect("good input").expect("an old factor would do");
    assert!(solver.factorise(&values).is_err(), "another pattern than the one analysed");

    solver.replace(analyse(&other));
    let (mut again, mut fresh) = (vec![1.0; n], vec![1.0; n]);
    solver.solve(&values, &mut again, 1e-10).expect("a regular matrix");
    let mut anew = Solver::new(analyse(&other), Policy::default());
    anew.solve(&values, &mut fresh, 1e-10).expect("a regular matrix");
    assert_eq!(again, fresh, "old memory leaves no trace");
    let largest = fresh.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(x.iter().zip(&fresh).all(|(x, fresh)| (x - fresh).abs() < 1e-7 * largest));
}

#[test]
fn small_matrices_are_always_factorised() {
    let model = models::quad4([8, 30]);
    let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
    assert_eq!(Policy::default().affordable_iterations(Work::from(&symbolic.prediction())), 0);
}

#[test]
fn directions_of_earlier_solutions_save_iterations() {
    let model = models::hex8([10, 10, 10]);
    let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
    let mut solver = Solver::new(symbolic.clone(), Policy { share: 10.0, ..Policy::default() });
    let vector = |seed: f64| (0..model.pattern.len()).map(|k| (seed + k as f64).cos()).collect::<Vec<_>>();
    solver.solve(&with_patch(&model, 0), &mut vector(0.0), 1e-9).expect("a regular matrix");
    solver.solve(&with_patch(&model, 6), &mut vector(1.0), 1e-9).expect("a regular matrix");
    let (values, b) = (with_patch(&model, 7), vector(2.0));
    let mut x = b.clone();
    let mut other = Solver::new(symbolic.clone(), Policy { share: 10.0, ..Policy::default() });
    other.factorise(&with_patch(&model, 0)).expect("a regular matrix");
    // More than may be made, if it does not end.
    let alone = other.iterate(&values, &mut x, 1e-9).expect("good input").map_or(usize::MAX, |done| done.iterations);
    let mut x = b.clone();
    let Ok(Outcome::Iterative(recycling)) = solver.solve(&values, &mut x, 1e-9) else {
        panic!("an old factor would do")
    };
    assert!(recycling.iterations + 2 < alone, "{} against {alone}", recycling.iterations);
    assert!(recycling.relative_residual < 1e-9 && residual(&model, &values, &x, &b) < SCALES * 1e-9);
}

/// What springs that many times as stiff as the body change between two places, with the entries of the inverse it takes.
fn leap(solver: &Solver, patches: [&[f64]; 2]) -> LowRankChange {
    let pattern = solver.symbolic().pattern().clone();
    let (starts, columns) = (pattern.starts(), pattern.columns());
    let rows = (0..pattern.len()).filter_map(|row| {
        let range = starts[row]..starts[row + 1];
        let changes = range.map(|at| (columns[at], patches[1][at] - patches[0][at]));
        let changes: Vec<_> = changes.filter(|(_, change)| *change != 0.0).collect();
        (!changes.is_empty()).then_some((row, changes))
    });
    let (at, rows): (Vec<usize>, Vec<_>) = rows.unzip();
    let loads: Vec<_> = at.iter().map(|&unknown| vec![(unknown, 1.0)]).collect();
    let mut inverse = vec![0.0; at.len() * at.len()];
    solver.influence(&loads, &at, &mut inverse).expect("a factor");
    let entry = |i: usize, j: usize| inverse[j * at.len() + at.iter().position(|&u| u == i).expect("a changed row")];
    let along = |i: usize, j: usize| rows[i].iter().map(|&(unknown, value)| value * entry(unknown, j)).sum::<f64>();
    let all = (0..at.len()).flat_map(|i| (0..at.len()).map(move |j| (i, j)));
    let capacitance = all.map(|(i, j)| f64::from(u8::from(i == j)) + along(i, j)).collect();
    LowRankChange::new(loads, rows, capacitance).expect("a regular matrix")
}

#[test]
fn a_factor_put_right_for_a_leap_solves_at_once() {
    let model = models::hex8([10, 10, 10]);
    let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
    let mut solver = Solver::new(symbolic, Policy { share: 10.0, ..Policy::default() });
    let [then, now] = [0, 6].map(|node| with_patch(&model, node));
    solver.factorise(&then).expect("a regular matrix");
    let b = (0..model.pattern.len()).map(|k| (k as f64).cos()).collect::<Vec<_>>();
    let mut solve = |change: Option<LowRankChange>| {
        solver.change(change);
        let mut x = b.clone();
        let done = solver.iterate(&now, &mut x, 1e-9).expect("good input").expect("an old factor would do");
        assert!(residual(&model, &now, &x, &b) < SCALES * 1e-9);
        (done.iterations, leap(&solver, [&then, &now]))
    };
    let (alone, change) = solve(None);
    assert!(alone > 6, "{alone} iterations");
    // In single precision the factor leaves less than the tolerance when it is applied twice.
    assert!(change.rank() > 30 && solve(Some(change)).0 <= 2);
}

#[test]
fn another_right_hand_side_of_the_same_matrix_takes_fewer_iterations() {
    let model = models::hex8([10, 10, 10]);
    let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
    let mut solver = Solver::new(symbolic, Policy { share: 10.0, ..Policy::default() });
    solver.factorise(&with_patch(&model, 0)).expect("a regular matrix");
    let values = with_patch(&model, 2);
    let vector = |seed: f64| (0..model.pattern.len()).map(|k| (seed + k as f64).cos()).collect::<Vec<_>>();
    let (b, mut x) = (vector(1.0), vector(1.0));
    let alone = solver.iterate(&values, &mut x, 1e-6).expect("good input").expect("an old factor would do");
    solver.iterate(&values, &mut vector(0.0), 1e-6).expect("good input").expect("an old factor would do");
    let mut x = b.clone();
    let again = solver.iterate_again(&values, &mut x, 1e-6).expect("good input").expect("an old factor would do");
    assert!(2 * again.iterations < alone.iterations, "{again:?} against {alone:?}");
    assert!(residual(&model, &values, &x, &b) < SCALES * 1e-6);
}

/// Iterations to solve with the matrix that was factorised.
fn own_iterations(pattern: &Pattern, values: &[f64], tolerance: f64) -> usize {
    let symbolic = Symbolic::analyse(pattern, &Options::default()).expect("a good pattern");
    let mut solver = Solver::new(symbolic, Policy { share: f64::INFINITY, ..Policy::default() });
    solver.factorise(values).expect("a regular matrix");
    let mut x = vec![1.0; pattern.len()];
    solver.iterate(values, &mut x, tolerance).expect("good input").expect("its own factor would do").iterations
}

#[test]
fn a_factor_is_rounded_unless_that_would_spoil_it() {
    let block = models::hex8([6, 6, 6]);
    assert_eq!(own_iterations(&block.pattern, &block.values, 1e-9), 2, "once more for what rounding leaves");
    // A chain on springs so soft that they are lost in single precision.
    let (links, spring) = (4000_usize, 1e-8);
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for row in 0..links {
        let neighbours = [row.wrapping_sub(1), row + 1].into_iter().filter(|&other| other < links);
        let mut entries: Vec<(usize, f64)> = neighbours.map(|other| (other, -1.0)).collect();
        entries.push((row, entries.len() as f64 + spring));
        entries.sort_by_key(|entry| entry.0);
        columns.extend(entries.iter().map(|entry| entry.0));
        values.extend(entries.iter().map(|entry| entry.1));
        starts.push(columns.len());
    }
    let chain = Pattern::new(starts, columns).expect("a good pattern");
    assert_eq!(own_iterations(&chain, &values, 1e-6), 1, "as it was found");
}

/// Columns of the inverse are found as they are asked for, and all at once where a solver goes on from elsewhere.
#[test]
fn loads_of_one_call_do_not_show_in_each_other() {
    let model = models::hex8([12, 12, 12]);
    let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
    let n = model.pattern.len();
    let at: Vec<usize> = (0..n).step_by(37).collect();
    let loads: Vec<_> = (0..70).map(|k| vec![((k * 53) % n, 1.0)]).collect();
    for share in [0.0, 10.0] {
        let mut solver = Solver::new(symbolic.clone(), Policy { share, ..Policy::default() });
        // In single precision where the factor is to serve for other matrices.
        solver.solve(&model.values, &mut vec![1.0; n], 1e-9).expect("a regular matrix");
        let mut together = vec![0.0; loads.len() * at.len()];
        solver.influence(&loads, &at, &mut together).expect("a factor");
        for count in [1, 2, 3, 5, 8, 13, 64] {
            for (loads, together) in loads.chunks(count).zip(together.chunks(count * at.len())) {
                let mut alone = vec![0.0; together.len()];
                solver.influence(loads, &at, &mut alone).expect("a factor");
                assert!(alone.iter().zip(together).all(|(a, b)| a == b), "{count} at a time");
            }
        }
    }
}

#[test]
fn a_solver_goes_on_where_another_left_off() {
    let model = models::hex8([10, 10, 10]);
    let n = model.pattern.len();
    let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
    let policy = Policy { share: 10.0, reuse: Reuse::AcrossSequences, ..Policy::default() };
    let sequence = |solver: &mut Solver, nodes: std::ops::Range<usize>| -> Vec<Vec<f64>> {
        solver.begin();
        let solve = |node| {
            let mut x = vec![1.0; n];
            let outcome = solver.solve(&with_patch(&model, node), &mut x, 1e-9).expect("a regular matrix");
            x.push(f64::from(u8::from(matches!(outcome, Outcome::Direct { .. }))));
            x
        };
        nodes.map(solve).collect()
    };
    let mut first = Solver::new(symbolic.clone(), policy);
    sequence(&mut first, 0..2);
    assert_eq!(first.counts().factorisations, 1);
    let mut second = Solver::new(symbolic.clone(), policy);
    second.factorise(&with_patch(&model, 0)).expect("a regular matrix");
    second.resume(first.service().expect("it may serve on"));
    for nodes in [2..4, 5..6, 7..20, 20..22] {
        assert_eq!(sequence(&mut first, nodes.clone()), sequence(&mut second, nodes.clone()), "{nodes:?}");
        assert_eq!(first.service(), second.service());
    }
    // It has not served for ever.
    assert!(first.counts().factorisations > 1);
}
