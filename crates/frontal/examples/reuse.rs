//! A rigid ball slides over an elastic block with friction: Newton's method with a fresh factor at every iteration
//! against the policy that reuses the factor of an increment's first iteration.
//! `cargo run --release -p frontal --example reuse -- 21` (cells along an edge).

#[path = "../benches/measure/mod.rs"]
mod measure;
#[path = "../benches/models/mod.rs"]
mod models;

use frontal::{Options, Outcome, Policy, Reuse, Solver, Symbolic};
use measure::timed;

const RADIUS: f64 = 12.0;
const DEPTH: f64 = 0.4;
const PENALTY: f64 = 4.0;
const FRICTION: f64 = 0.3;
const INCREMENTS: usize = 8;

fn main() {
    let cells = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(21);
    let block = Block::new(cells);
    println!("{} unknowns, {INCREMENTS} increments", block.model.pattern.len());
    let (symbolic, analysis) = timed(|| Symbolic::analyse(&block.model.pattern, &Options::default()));
    let symbolic = symbolic.expect("a good pattern");
    println!("analysis: {:.2} s", analysis.processor);
    let always = Policy { reuse: Reuse::Never, ..Policy::default() };
    let mut totals = [0.0; 2];
    for (total, (name, policy)) in totals.iter_mut().zip([("every iteration", always), ("reuse", Policy::default())]) {
        let mut solver = Solver::new(symbolic.clone(), policy);
        let (newton, time) = timed(|| block.slide(&mut solver));
        *total = time.processor;
        println!("{name}: {:.2} s, {newton} Newton iterations, {:?}", time.processor, solver.counts());
    }
    println!("reuse / every iteration = {:.2}", totals[1] / totals[0]);
}

struct Block {
    model: models::Model,
    /// Nodes of the top, and their places.
    top: Vec<(usize, [f64; 3])>,
}

impl Block {
    fn new(cells: usize) -> Self {
        let side = cells + 1;
        let place = |node: usize| [(node % side) as f64, (node / side) as f64, cells as f64];
        let top = (0..side * side).map(|k| (k + side * side * cells, place(k))).collect();
        Block { model: models::hex8([cells; 3]), top }
    }

    /// Newton iterations of all increments.
    fn slide(&self, solver: &mut Solver) -> usize {
        let mut u = vec![0.0; self.model.pattern.len()];
        let middle = (self.top.len() as f64).sqrt() / 2.0;
        let mut count = 0;
        for increment in 0..INCREMENTS {
            let x = middle - 3.0 + 0.4 * increment as f64;
            let depth = DEPTH * (0.25 * (increment + 1) as f64).min(1.0);
            let ball = [x, middle, self.top[0].1[2] + RADIUS - depth];
            solver.begin();
            count += self.increment(solver, &mut u, ball);
        }
        count
    }

    fn increment(&self, solver: &mut Solver, u: &mut [f64], ball: [f64; 3]) -> usize {
        let (mut first, mut previous) = (0.0, 0.0);
        for iteration in 0..30 {
            let (mut residual, values) = self.equilibrium(u, ball);
            let size = residual.iter().map(|r| r * r).sum::<f64>().sqrt();
            if iteration == 0 {
                (first, previous) = (size, size);
            }
            if iteration > 0 && size <= 1e-9 * first {
                return iteration;
            }
            // Eisenstat & Walker's second choice, bounded so that Newton's order shows.
            let tolerance = if iteration == 0 { 1e-4 } else { (size / previous).powi(2).clamp(1e-8, 1e-4) };
            previous = size;
            let outcome = solver.solve(&values, &mut residual, tolerance).expect("a regular matrix");
            if std::env::var_os("VERBOSE").is_some() {
                let iterations = match outcome {
                    Outcome::Iterative(convergence) => convergence.iterations,
                    _ => 0,
                };
                println!("  residual {size:.2e}, tolerance {tolerance:.1e}, {iterations} inner iterations");
            }
            u.iter_mut().zip(&residual).for_each(|(u, du)| *u += du);
        }
        panic!("no equilibrium");
    }

    /// Out-of-balance forces and their derivative, with the sign that makes the derivative a stiffness.
    fn equilibrium(&self, u: &[f64], ball: [f64; 3]) -> (Vec<f64>, Vec<f64>) {
        let (starts, columns) = (self.model.pattern.starts(), self.model.pattern.columns());
        let mut values = self.model.values.clone();
        let row = |i: usize| -(starts[i]..starts[i + 1]).map(|at| values[at] * u[columns[at]]).sum::<f64>();
        let mut residual = (0..u.len()).map(row).collect::<Vec<_>>();
        for &(node, place) in &self.top {
            let (force, stiffness) = touch([0, 1, 2].map(|i| place[i] + u[3 * node + i] - ball[i]));
            for (i, j) in (0..9).map(|k| (k / 3, k % 3)) {
                let row = starts[3 * node + i]..starts[3 * node + i + 1];
                let at = columns[row.clone()].binary_search(&(3 * node + j)).expect("a node couples to itself");
                values[row.start + at] += stiffness[i][j];
            }
            (0..3).for_each(|i| residual[3 * node + i] += force[i]);
        }
        (residual, values)
    }
}

/// Force of the ball on a node at `r` from its centre, sliding along the first axis, and minus its derivative.
fn touch(r: [f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let distance = r.iter().map(|r| r * r).sum::<f64>().sqrt();
    let penetration = RADIUS - distance;
    if penetration <= 0.0 {
        return ([0.0; 3], [[0.0; 3]; 3]);
    }
    let n = r.map(|r| r / distance);
    let pressure = PENALTY * penetration;
    let drag = [FRICTION, 0.0, 0.0];
    let force = [0, 1, 2].map(|i| pressure * (n[i] + drag[i]));
    let entry = |i: usize, j: usize| {
        let turn = (if i == j { 1.0 } else { 0.0 } - n[i] * n[j]) / distance;
        PENALTY * n[j] * (n[i] + drag[i]) - pressure * turn
    };
    (force, [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))))
}
