//! The solution is a function of the deck alone: the number of threads, outputs, a restart, an attempt that failed
//! before do not change a bit of it. States are compared as the bytes of a checkpoint.

mod support;

use asperity::output::checkpoint::{self, Head, InputHash, Stamp};
use asperity::output::{CHECKPOINT, Job, Kept, Limits, ResultOptions, Start, simulate};
use asperity::solve::{Factored, Factors, Frontal, LinearError, LinearSolver, Run, RunOptions, Silent, Unknowns};
use asperity::system::{Csr, State};
use frontal::LowRankChange;
use proptest::prelude::*;
use support::{all_bytes, bytes, go_on, model, run, with_threads};

const DECK: &str = include_str!("../../../cases/tube/tube.toml");
const COARSE: [&str; 3] = [
    "mesh.part.tube.rectangle.cells=[2, 40]",
    "step.push.increments.count=24",
    "step.push.displacement.'tube.top'.y=-36.0",
];
const QUAD4: [&str; 3] =
    ["mesh.part.tube.rectangle.cell=quad4", "body.tube.formulation=f-bar", "body.tube.integration=full"];

fn coarse(more: &[&'static str]) -> Vec<&'static str> {
    [&COARSE, more].concat()
}

#[test]
fn the_number_of_threads_changes_nothing() {
    for cell in [&[][..], &QUAD4] {
        let model = model(DECK, &coarse(cell));
        let [one, two, three] = [1, 2, 3].map(|threads| with_threads(threads, || all_bytes(&run(&model))));
        assert_eq!(one.len(), 24);
        assert!(one == two && one == three);
    }
}

/// Contact in space: its rays are cast side by side.
#[test]
fn the_number_of_threads_changes_nothing_in_space() {
    let deck = include_str!("../../../cases/dragged-ball/slab.toml");
    for factors in ["solver.factors=fresh", "solver.factors=kept"] {
        let mut model = model(deck, &["mesh.part.slab.box.cells=[12, 6, 2]", "step.drag.increments.count=4", factors]);
        let [one, two, three] = [1, 2, 3].map(|threads| with_threads(threads, || all_bytes(&run(&model))));
        assert_eq!(one.len(), 8);
        assert!(one == two && one == three, "{factors}");
        model.problem.newton.rehearse = true;
        let rehearsed = run(&model);
        assert!(one == all_bytes(&rehearsed), "{factors}: nor does an attempt that is made twice");
        model.problem.newton.rehearse = false;
        let held: Vec<_> = rehearsed.states.iter().filter_map(|state| state.preconditioner.as_ref()).collect();
        assert_eq!(held.iter().any(|held| !held.near.columns.is_empty()), factors.ends_with("kept"));
        for k in 1..8 {
            let begun = go_on(&model, model.problem.initial_state(), Some(k));
            let rest = go_on(&model, through_a_file(begun.states.last().unwrap()), None);
            assert!(one[k..] == all_bytes(&rest)[..], "{factors}: a restart at {k} changes nothing either");
        }
    }
}

#[test]
fn outputs_change_nothing() {
    let model = model(DECK, &coarse(&[]));
    let without = run(&model);
    let directory = tempfile::tempdir().unwrap();
    let options = ResultOptions { every: 1, checkpoint_every: 1, ..ResultOptions::default() };
    let input = InputHash::of(&[DECK.as_bytes()]);
    let job = Job {
        directory: directory.path(),
        options,
        input,
        parts: &[],
        asked: None,
        start: Start::Beginning,
        limits: &Limits::default(),
        notes: &[],
        facts: &Default::default(),
    };
    simulate(&model, &job, &mut Silent).unwrap().1.unwrap();
    let (_, last) = checkpoint::read::<Kept>(&directory.path().join(CHECKPOINT)).unwrap();
    assert_eq!(bytes(&last.state), bytes(without.states.last().unwrap()));
}

/// Each attempt made twice, the first thrown away when it has converged.
#[test]
fn an_attempt_leaves_nothing_behind() {
    for way in ["solver.factors=fresh", "solver.factors=kept"] {
        let mut model = model(DECK, &coarse(&[way]));
        let once = all_bytes(&run(&model));
        model.problem.newton.rehearse = true;
        assert!(once == all_bytes(&run(&model)), "{way}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_restart_changes_nothing(k in 1_usize..24) {
        let model = model(DECK, &coarse(&QUAD4));
        let whole = all_bytes(&run(&model));
        let begun = go_on(&model, model.problem.initial_state(), Some(k));
        let restarted = through_a_file(begun.states.last().unwrap());
        let rest = go_on(&model, restarted, None);
        prop_assert!(whole[k..] == all_bytes(&rest)[..]);
    }

    /// An attempt whose linear solver gives up in the middle is cut in half; what follows is what would have been,
    /// had the half been tried at once.
    #[test]
    fn a_failed_attempt_changes_nothing(k in 5_usize..23, matrix in 2_usize..4) {
        let model = model(DECK, &coarse(&[]));
        let begun = go_on(&model, model.problem.initial_state(), Some(k));
        let mut start = begun.states.last().unwrap().clone();
        let faulty = |at| Faulty { at, ..Faulty::default() };
        let failed = faulty_increment(&model.problem, start.clone(), faulty(matrix));
        // An increment that needs fewer solutions does not meet the fault.
        prop_assume!(failed.attempts == start.attempts + 2);
        start.next_dt *= 0.5;
        let direct = faulty_increment(&model.problem, start, faulty(usize::MAX));
        let counted = as_if_direct(failed, &direct);
        prop_assert!(bytes(&counted) == bytes(&direct));
    }
}

/// A state that came about by an attempt that failed, without its count and without what it taught about the size of increments.
fn as_if_direct(failed: State, direct: &State) -> State {
    let &State { attempts, iterations, next_dt, caution, .. } = direct;
    State { attempts, iterations, next_dt, caution, ..failed }
}

fn through_a_file(state: &State) -> State {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.checkpoint");
    let input = InputHash::of(&[b"tube"]);
    let stamp = Stamp { step: state.step as u64, increment: state.increment as u64, time: state.time };
    checkpoint::save(&path, &Head { input, stamp }, state).unwrap();
    checkpoint::read(&path).unwrap().1
}

/// In space, where the attempt begins with the factor that the accepted state holds and may make another.
#[test]
fn a_failed_attempt_leaves_the_factor_of_the_state() {
    let deck = include_str!("../../../cases/dragged-ball/slab.toml");
    let more = ["mesh.part.slab.box.cells=[12, 6, 2]", "step.drag.increments.count=4", "solver.factors=kept"];
    let model = model(deck, &more);
    let (mut held, mut failed) = (0, 0);
    for k in 1..8 {
        let start = go_on(&model, model.problem.initial_state(), Some(k)).states.last().unwrap().clone();
        held += usize::from(start.preconditioner.is_some());
        let faulty = |at| Faulty { solver: Frontal::new(Factors::Kept), at, poisoned: true, ..Faulty::default() };
        let half = State { next_dt: 0.5 * start.next_dt, ..start.clone() };
        let direct = faulty_increment(&model.problem, half, faulty(usize::MAX));
        for at in 1..6 {
            let state = faulty_increment(&model.problem, start.clone(), faulty(at));
            if state.attempts == direct.attempts + 1 {
                failed += 1;
                let counted = as_if_direct(state, &direct);
                assert!(bytes(&counted) == bytes(&direct), "from {k}, call {at}");
            }
        }
    }
    assert!(held > 2 && failed > 10, "{held} factors, {failed} failed attempts");
}

/// Far from equilibrium a stiffness may overflow: the increment is cut, the run goes on.
#[test]
fn a_stiffness_that_is_not_finite_cuts_the_increment() {
    let model = model(DECK, &coarse(&[]));
    let faulty = Faulty { at: 2, poisoned: true, ..Faulty::default() };
    let state = faulty_increment(&model.problem, model.problem.initial_state(), faulty);
    assert_eq!((state.attempts, state.increment), (2, 1));
}

/// The state after one increment with a solver that gives up once.
fn faulty_increment(problem: &asperity::solve::Problem, start: State, faulty: Faulty) -> State {
    let mut run = Run::new(problem, start, Box::new(faulty));
    run.run(&RunOptions { increments: Some(1) }, &mut Silent).unwrap();
    run.state
}

/// A solver whose `at`-th call that factorises or preconditions is poisoned, or which calls that matrix and the next, which is that one
/// regularised, singular.
#[derive(Default)]
struct Faulty {
    solver: Frontal,
    at: usize,
    poisoned: bool,
    /// Calls so far.
    calls: usize,
    unknowns: usize,
}

impl LinearSolver for Faulty {
    fn set_pattern(&mut self, pattern: &Csr, unknowns: Unknowns) -> Result<(), LinearError> {
        self.unknowns = unknowns.free.len();
        self.solver.set_pattern(pattern, unknowns)
    }
    fn factorise(&mut self, values: &[f64]) -> Result<Factored, LinearError> {
        self.calls += 1;
        match self.calls.checked_sub(self.at) {
            Some(0) if self.poisoned => self.solver.factorise(&vec![f64::NAN; values.len()]),
            Some(0 | 1) if !self.poisoned => Err(LinearError::Singular(vec![vec![1.0; self.unknowns]])),
            _ => self.solver.factorise(values),
        }
    }
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        self.solver.solve(rhs)
    }
    fn substitute(&mut self, x: &mut [f64]) -> Result<(), LinearError> {
        self.solver.substitute(x)
    }
    fn precondition(&mut self, change: Option<&LowRankChange>, x: &mut [f64]) -> Result<(), LinearError> {
        self.calls += usize::from(self.poisoned);
        if self.poisoned && self.calls == self.at {
            return Err(LinearError::NotFinite("poisoned".into()));
        }
        self.solver.precondition(change, x)
    }
    fn compliance(&mut self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<bool, LinearError> {
        self.solver.compliance(loads, at, x)
    }
}
