//! A ball slides with friction over a block in space: every matrix factorised, and as few as possible, in one run.
//! `cargo run --release -p asperity --example sliding -- 21` (cells along an edge), or with a deck and what is set over
//! it: `... --example sliding -- cases/dragged-ball/slab.toml "mesh.part.slab.box.cells=[48,18,12]"`.

#[path = "../tests/support/ball.rs"]
mod ball;
#[path = "../../frontal/benches/measure/mod.rs"]
mod measure;

use asperity::model::Model;
use asperity::solve::{Factored, Factors, Frontal, LinearError, LinearSolver, Run, Unknowns};
use asperity::system::Csr;
use ball::Attempts;
use frontal::LowRankChange;
use measure::timed;
use std::path::Path;
use std::sync::{Arc, Mutex};

/// Processor time of analyses, factorisations, solutions, preconditioning and compliance.
type Times = Arc<Mutex<[f64; 5]>>;

/// The engine with a clock beside it.
struct Clocked {
    engine: Frontal,
    times: Times,
}

impl Clocked {
    fn add<T>(&mut self, phase: usize, work: impl FnOnce(&mut Frontal) -> T) -> T {
        let (result, time) = timed(|| work(&mut self.engine));
        self.times.lock().expect("no panic")[phase] += time.processor;
        result
    }
}

impl LinearSolver for Clocked {
    fn set_pattern(&mut self, pattern: &Csr, unknowns: Unknowns) -> Result<(), LinearError> {
        self.add(0, |engine| engine.set_pattern(pattern, unknowns))
    }
    fn factorise(&mut self, values: &[f64]) -> Result<Factored, LinearError> {
        self.add(1, |engine| engine.factorise(values))
    }
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        self.add(2, |engine| engine.solve(rhs))
    }
    fn substitute(&mut self, x: &mut [f64]) -> Result<(), LinearError> {
        self.add(2, |engine| engine.substitute(x))
    }
    fn precondition(&mut self, change: Option<&LowRankChange>, x: &mut [f64]) -> Result<(), LinearError> {
        self.add(3, |engine| engine.precondition(change, x))
    }
    fn compliance(&mut self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<bool, LinearError> {
        self.add(4, |engine| engine.compliance(loads, at, x))
    }
}

/// The model that the arguments ask for.
fn model(arguments: &[String]) -> Model {
    let first = arguments.first().map_or("21", String::as_str);
    if let Ok(cells) = first.parse() {
        return ball::model(cells, Factors::Auto);
    }
    let made = asperity::deck::load(Path::new(first), &arguments[1..]).and_then(asperity::deck::build);
    made.map_err(|found| found.render(false)).unwrap_or_else(|text| panic!("{text}")).model
}

/// Runs, prints what it took, and returns the whole processor time and that of the linear systems.
fn slide(model: &mut Model, factors: Factors) -> [f64; 2] {
    model.problem.newton.factors = factors;
    let (times, mut attempts) = (Times::default(), Attempts::default());
    let engine = Clocked { engine: Frontal::new(factors), times: times.clone() };
    let mut run = Run::new(&model.problem, model.problem.initial_state(), Box::new(engine));
    let (stop, time) = timed(|| run.run(&Default::default(), &mut attempts));
    stop.expect("a solution");
    let ((iterations, factorised), counts) = (attempts.iterations(), run.solver_counts());
    println!("{factors:?}: {} unknowns, {} attempts", model.problem.dofs.count(), attempts.0.len());
    if std::env::var_os("VERBOSE").is_some() {
        attempts.print();
    }
    println!(
        "  {iterations} iterations, {factorised} factorisations, {} analyses, {} inner iterations for {} solutions",
        counts.analyses, counts.iterations, counts.iterative
    );
    let times = *times.lock().expect("no panic");
    println!(
        "  analyses {:.2} s, factorisations {:.2} s, solutions {:.2} s, preconditioning {:.2} s, compliance {:.2} s; run {:.2} s",
        times[0], times[1], times[2], times[3], times[4], time.processor
    );
    // With the products and small matrices of the iterations.
    let of_systems = counts.factorising + counts.solving + counts.complying;
    [time.processor, of_systems.as_secs_f64()]
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut model = model(&arguments);
    // On a thread of the pool, as the program runs: from outside, every parallel loop would hand over to it and wait.
    let [fresh, auto] = rayon::scope(|_| [Factors::Fresh, Factors::Auto].map(|factors| slide(&mut model, factors)));
    println!("auto / fresh: run {:.2}, linear systems {:.2}", auto[0] / fresh[0], auto[1] / fresh[1]);
}
