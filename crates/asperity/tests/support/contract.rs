//! What every linear solver of a run must do, whatever is behind it: [`hold`] panics where one does not.

use asperity::solve::{LinearError, LinearSolver, Unknowns};
use asperity::system::{Csr, Dofs};
use frontal::LowRankChange;
use std::sync::Arc;

/// What a preconditioner may miss of a solution.
const FEW_DIGITS: f64 = 1e-3;

/// An unknown, and the changes of its row with their columns.
type ChangedRow = (usize, Vec<(usize, f64)>);

/// A grid of `n` by `n` nodes with two unknowns each, some of them held: springs to the neighbours, and friction that makes the
/// values unsymmetric. Without `ground` nothing holds a node that has no neighbour.
struct Grid {
    dofs: Dofs,
    free: Vec<usize>,
    pattern: Csr,
    values: Vec<f64>,
}

impl Grid {
    fn new(n: usize, held: &[usize], skew: f64, ground: f64) -> Self {
        let dofs = Dofs::new(2, n * n, 0);
        let free: Vec<usize> = (0..2 * n * n).filter(|dof| !held.contains(dof)).collect();
        let near = |a: usize, b: usize| (a % n).abs_diff(b % n) + (a / n).abs_diff(b / n) <= 1;
        let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for &row in &free {
            for (number, &column) in free.iter().enumerate().filter(|(_, column)| near(row / 2, **column / 2)) {
                let (node, other, same) = (row / 2, column / 2, row % 2 == column % 2);
                let neighbours = (0..n * n).filter(|&b| b != node && near(node, b)).count() as f64;
                columns.push(number);
                values.push(match (node == other, same) {
                    (true, true) => ground + neighbours * (1.0 + 0.5 * (row % 2) as f64),
                    (true, false) => skew * if row < column { 0.5 } else { -0.2 },
                    (false, true) => -1.0 - 0.5 * (row % 2) as f64,
                    (false, false) => skew * 0.1 * if node < other { 1.0 } else { -1.0 },
                });
            }
            starts.push(columns.len());
        }
        Self { dofs, free, pattern: Csr::new(Arc::new(starts), Arc::new(columns)), values }
    }

    fn tell(&self, solver: &mut dyn LinearSolver) {
        let unknowns = Unknowns { dofs: &self.dofs, free: &self.free };
        solver.set_pattern(&self.pattern, unknowns).expect("a pattern");
    }

    /// Rows that are changed, and the values of the matrix with them.
    fn stiffened(&self, unknowns: &[usize]) -> (Vec<ChangedRow>, Vec<f64>) {
        let mut values = self.values.clone();
        let rows = unknowns.iter().map(|&row| {
            let entries = self.pattern.starts[row]..self.pattern.starts[row + 1];
            let changed = |at: usize| {
                let more = 3.0 * self.values[at].abs() + if self.pattern.diagonal(row) == Some(at) { 5.0 } else { 0.0 };
                values[at] += more;
                (self.pattern.columns[at], more)
            };
            (row, entries.map(changed).collect())
        });
        let rows: Vec<_> = rows.collect();
        (rows, values)
    }

    fn product(&self, values: &[f64], x: &[f64]) -> Vec<f64> {
        let row = |row: usize| self.pattern.starts[row]..self.pattern.starts[row + 1];
        let sum = |row: std::ops::Range<usize>| row.map(|at| values[at] * x[self.pattern.columns[at]]).sum();
        (0..self.free.len()).map(|number| sum(row(number))).collect()
    }
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest(b)
}

/// Sees to it that a solver keeps to what [`LinearSolver`] says; an iterative one to this part of the right-hand side.
pub fn hold(solver: &mut dyn LinearSolver, direct: bool) {
    let tolerance = if direct { 1e-12 } else { 1e-6 };
    let grid = Grid::new(9, &[0, 1, 7, 40], 1.0, 0.3);
    assert!(solver.solve(&mut []).is_err() && solver.factorise(&[]).is_err(), "nothing was analysed");
    grid.tell(solver);
    let expected: Vec<f64> = (0..grid.free.len()).map(|k| ((k * k) as f64).sin()).collect();

    // Solutions, of one pattern and many values.
    for factor in [1.0, -3e6] {
        let values: Vec<f64> = grid.values.iter().map(|value| factor * value).collect();
        solver.factorise(&values).expect("a matrix with an inverse");
        let mut x = grid.product(&values, &expected);
        solver.solve(&mut x).expect("a solution");
        assert!(apart(&x, &expected) < tolerance, "{:.1e}", apart(&x, &expected));
    }
    let mut nothing = vec![0.0; grid.free.len()];
    solver.solve(&mut nothing).expect("nothing");
    assert_eq!(largest(&nothing), 0.0);

    // A factor says what it took, always the same, or never.
    let factored = solver.factorise(&grid.values).expect("a matrix with an inverse");
    assert_eq!(factored.work, solver.factorise(&grid.values).expect("a matrix with an inverse").work);
    assert!(factored.work.is_none_or(|work| work.factorisation > 0.0 && work.solution > 0.0));

    // Substitution, to the digits of the factor; preconditioning, to a few, for the matrix as it was and with some rows changed.
    let rhs = grid.product(&grid.values, &expected);
    let mut x = rhs.clone();
    solver.substitute(&mut x).expect("a substitution");
    assert!(apart(&x, &expected) < 1e3 * tolerance, "{:.1e}", apart(&x, &expected));
    let mut x = rhs.clone();
    solver.precondition(None, &mut x).expect("a substitution");
    assert!(apart(&x, &expected) < FEW_DIGITS, "{:.1e}", apart(&x, &expected));
    let (rows, changed) = grid.stiffened(&[4, 5, 60]);
    let mut capacitance = vec![0.0; rows.len() * rows.len()];
    for (j, (unknown, _)) in rows.iter().enumerate() {
        let mut column = vec![0.0; grid.free.len()];
        column[*unknown] = 1.0;
        solver.solve(&mut column).expect("a solution");
        for (i, (_, row)) in rows.iter().enumerate() {
            let along: f64 = row.iter().map(|&(unknown, value)| value * column[unknown]).sum();
            capacitance[i * rows.len() + j] = along + f64::from(u8::from(i == j));
        }
    }
    let forces = rows.iter().map(|(unknown, _)| vec![(*unknown, 1.0)]).collect();
    let change =
        LowRankChange::new(forces, rows.into_iter().map(|(_, row)| row).collect(), capacitance).expect("a change");
    let mut x = grid.product(&changed, &expected);
    solver.precondition(Some(&change), &mut x).expect("a substitution");
    assert!(apart(&x, &expected) < FEW_DIGITS, "{:.1e}", apart(&x, &expected));

    // Compliance, where an engine has a way of its own: loads that add up, more of them than are solved for together, at some
    // unknowns.
    let loads: Vec<Vec<(usize, f64)>> = (0..70).map(|k| vec![(k, 1.0), (2 * k, 0.5), (k, 1.0)]).collect();
    let at: Vec<usize> = (0..grid.free.len()).filter(|k| k % 3 != 1).collect();
    let mut motions = vec![0.0; loads.len() * at.len()];
    if solver.compliance(&loads, &at, &mut motions).expect("motions") {
        for (load, motion) in loads.iter().zip(motions.chunks(at.len())) {
            let mut x = vec![0.0; grid.free.len()];
            load.iter().for_each(|&(unknown, force)| x[unknown] += force);
            solver.solve(&mut x).expect("a solution");
            let there: Vec<f64> = at.iter().map(|&unknown| x[unknown]).collect();
            assert!(apart(motion, &there) < FEW_DIGITS, "{:.1e}", apart(motion, &there));
        }
        solver.compliance(&[], &at, &mut []).expect("no motions");
        solver.compliance(&loads[..1], &[], &mut []).expect("no unknowns");
    }

    // What is not finite is told, and does no harm.
    let mut broken = grid.values.clone();
    broken[17] = f64::NAN;
    assert!(matches!(solver.factorise(&broken), Err(LinearError::NotFinite(_))));
    solver.factorise(&grid.values).expect("a matrix with an inverse");

    // Another pattern.
    let grid = Grid::new(6, &[3], 0.0, 0.1);
    grid.tell(solver);
    solver.factorise(&grid.values).expect("a matrix with an inverse");
    let expected: Vec<f64> = (0..grid.free.len()).map(|k| (k as f64).cos()).collect();
    let mut x = grid.product(&grid.values, &expected);
    solver.solve(&mut x).expect("a solution");
    assert!(apart(&x, &expected) < tolerance);
    if !direct {
        return;
    }

    // Without ground the grid is free along both axes, and the motions say so: by rounding, and with an exact zero.
    let free = Grid::new(6, &[], 0.0, 0.0);
    free.tell(solver);
    for lone in [false, true] {
        let mut values = free.values.clone();
        if lone {
            let row = free.pattern.starts[8]..free.pattern.starts[9];
            row.for_each(|at| values[at] = 0.0);
        }
        let motions = match solver.factorise(&values) {
            Err(LinearError::Singular(motions)) => motions,
            other => panic!("that is singular: {other:?}"),
        };
        assert_eq!(motions.len(), 2);
        for motion in motions {
            let left = largest(&free.product(&values, &motion)) / largest(&motion);
            assert!(left < 1e-11, "{left:.1e}");
        }
    }
    // What holds little holds.
    let held: Vec<f64> = Grid::new(6, &[], 0.0, 1e-6).values;
    solver.factorise(&held).expect("a matrix with an inverse");
}
