//! A ball slides with friction over a block in space: every matrix factorised, one an attempt, and as few as possible, in
//! one run.
//! `cargo run --release -p asperity --example sliding -- 21` (cells along an edge), or with a deck and what is set over
//! it: `... --example sliding -- cases/dragged-ball/slab.toml "mesh.part.slab.box.cells=[48,18,12]"`.

#[path = "../tests/support/ball.rs"]
mod ball;
#[path = "../../frontal/benches/measure/mod.rs"]
mod measure;

use asperity::model::Model;
use asperity::solve::{Factors, Frontal, LinearError, LinearSolver, Run, Unknowns};
use asperity::system::Csr;
use ball::Attempts;
use frontal::{Change, Service};
use measure::timed;
use std::path::Path;
use std::sync::{Arc, Mutex};

/// Processor time of analyses, factorisations, direct and iterative solutions, entries of the inverse.
type Times = Arc<Mutex<[f64; 5]>>;

/// The solver with a clock beside it.
struct Clocked {
    solver: Frontal,
    times: Times,
}

impl Clocked {
    fn add<T>(&mut self, phase: usize, work: impl FnOnce(&mut Frontal) -> T) -> T {
        let (result, time) = timed(|| work(&mut self.solver));
        self.times.lock().expect("no panic")[phase] += time.processor;
        result
    }
}

impl Clocked {
    fn counted(
        &mut self,
        tolerance: f64,
        work: impl FnOnce(&mut Frontal) -> Result<bool, LinearError>,
    ) -> Result<bool, LinearError> {
        let before = self.solver.counts().iterations;
        let solved = self.add(3, work)?;
        let iterations = self.solver.counts().iterations - before;
        if std::env::var_os("VERBOSE").is_some() {
            println!("    {iterations} inner iterations to {tolerance:.0e}: {solved}");
        }
        Ok(solved)
    }
}

impl LinearSolver for Clocked {
    fn analyse(&mut self, pattern: &Csr, unknowns: Unknowns) -> Result<(), LinearError> {
        self.add(0, |solver| solver.analyse(pattern, unknowns))
    }
    fn follow(&mut self, pattern: &Csr) -> bool {
        self.add(0, |solver| solver.follow(pattern))
    }
    fn row(&self, row: usize) -> Vec<(usize, f64)> {
        self.solver.row(row)
    }
    fn factorise(&mut self, values: &[f64]) -> Result<(), LinearError> {
        self.add(1, |solver| solver.factorise(values))
    }
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        self.add(2, |solver| solver.solve(rhs))
    }
    fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<(), LinearError> {
        let (result, time) = timed(|| self.solver.influence(loads, at, x));
        self.times.lock().expect("no panic")[4] += time.processor;
        if std::env::var_os("VERBOSE").is_some() {
            println!("    {} loads, {} unknowns, {:.3} s", loads.len(), at.len(), time.processor);
        }
        result
    }
    fn begin(&mut self) {
        self.solver.begin();
    }
    fn refuse(&mut self) {
        self.solver.refuse();
    }
    fn iterates(&self) -> bool {
        self.solver.iterates()
    }
    fn service(&self) -> Option<Service> {
        self.solver.service()
    }
    fn resume(&mut self, service: Service) {
        self.solver.resume(service);
    }
    fn change(&mut self, change: Option<Change>) {
        if let (Some(change), true) = (&change, std::env::var_os("VERBOSE").is_some()) {
            println!("    change of rank {}", change.rank());
        }
        self.solver.change(change);
    }
    fn iterate(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<bool, LinearError> {
        self.counted(tolerance, |solver| solver.iterate(values, rhs, tolerance))
    }
    fn iterate_again(&mut self, values: &[f64], rhs: &mut [f64], tolerance: f64) -> Result<bool, LinearError> {
        self.counted(tolerance, |solver| solver.iterate_again(values, rhs, tolerance))
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

/// Runs, prints what it took, and returns the whole processor time and that of the linear solver.
fn slide(model: &Model, factors: Factors) -> [f64; 2] {
    let (times, mut attempts) = (Times::default(), Attempts::default());
    let solver = Clocked { solver: Frontal::new(factors), times: times.clone() };
    let mut run = Run::new(&model.problem, model.problem.initial_state(), Box::new(solver));
    let (stop, time) = timed(|| run.run(&Default::default(), &mut attempts));
    stop.expect("a solution");
    let (iterations, factorised) = attempts.iterations();
    let times = *times.lock().expect("no panic");
    println!("{factors:?}: {} unknowns, {} attempts", model.problem.dofs.count(), attempts.0.len());
    if std::env::var_os("VERBOSE").is_some() {
        attempts.print();
    }
    println!("  {iterations} iterations, {factorised} factorisations, {} analyses", run.memory.analyses);
    println!(
        "  analyses {:.2} s, factorisations {:.2} s, solutions {:.2} s, by FGMRES {:.2} s, of the inverse {:.2} s; run {:.2} s",
        times[0], times[1], times[2], times[3], times[4], time.processor
    );
    [time.processor, times.iter().sum()]
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let model = model(&arguments);
    let all = [Factors::Fresh, Factors::Attempt, Factors::Auto];
    // On a thread of the pool, as the program runs: from outside, every parallel loop would hand over to it and wait.
    let [fresh, attempt, auto] = rayon::scope(|_| all.map(|factors| slide(&model, factors)));
    for (name, times) in [("attempt", attempt), ("auto", auto)] {
        println!("{name} / fresh: run {:.2}, linear solver {:.2}", times[0] / fresh[0], times[1] / fresh[1]);
    }
}
