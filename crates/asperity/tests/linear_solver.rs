//! Linear solvers keep the contract that the library has with them: its own, and the least that there can be, which says nothing
//! but how it factorises and solves. What saves factorisations is there for both.

#[path = "support/contract.rs"]
mod contract;
mod support;

use asperity::solve::{
    Factored, Factors, Frontal, LinearError, LinearSolver, Run, RunOptions, Silent, SolverCounts, Unknowns,
};
use asperity::system::Csr;
use frontal::{Full, Work};

#[test]
fn frontal_keeps_the_contract() {
    for factors in [Factors::Auto, Factors::Fresh, Factors::Kept] {
        contract::hold(&mut Frontal::new(factors), true);
    }
}

/// A dense matrix.
#[derive(Default)]
struct Dense {
    pattern: Option<Csr>,
    factor: Option<Full>,
    work: Option<Work>,
}

impl LinearSolver for Dense {
    fn set_pattern(&mut self, pattern: &Csr, _: Unknowns) -> Result<(), LinearError> {
        self.pattern = Some(pattern.clone());
        self.factor = None;
        Ok(())
    }
    fn factorise(&mut self, values: &[f64]) -> Result<Factored, LinearError> {
        self.factor = None;
        let pattern = self.pattern.as_ref().ok_or(LinearError::Other("nothing is analysed".into()))?;
        if values.iter().any(|value| !value.is_finite()) {
            return Err(LinearError::NotFinite("the stiffness is not finite".into()));
        }
        let n = pattern.rows();
        let mut entries = vec![0.0; n * n];
        for row in 0..n {
            let places = pattern.starts[row]..pattern.starts[row + 1];
            places.for_each(|at| entries[row * n + pattern.columns[at]] = values[at]);
        }
        let none = || LinearError::Inaccurate("no pivot is left".into());
        self.factor = Some(Full::factorise(n, entries).ok_or_else(none)?);
        Ok(Factored { signs: None, work: self.work })
    }
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        self.factor.as_ref().ok_or(LinearError::Other("nothing is factorised".into()))?.solve(rhs);
        Ok(())
    }
}

#[test]
fn the_least_of_engines_keeps_it_too() {
    // It tells no motions without stiffness, as one that iterates.
    contract::hold(&mut Dense::default(), false);
    contract::hold(&mut Dense { work: Some(Work { factorisation: 1e3, solution: 1.0 }), ..Dense::default() }, false);
}

/// A ball that is dragged over a block: displacements, and what its linear systems took.
fn drag(engine: Box<dyn LinearSolver>) -> (Vec<f64>, SolverCounts) {
    let deck = include_str!("../../../cases/dragged-ball/slab.toml");
    let more = ["mesh.part.slab.box.cells=[10, 5, 2]", "step.drag.increments.count=4", "solver.factors=kept"];
    let model = support::model(deck, &more);
    let mut run = Run::new(&model.problem, model.problem.initial_state(), engine);
    run.run(&RunOptions::default(), &mut Silent).unwrap();
    let counts = run.solver_counts();
    (run.state.u, counts)
}

/// Largest difference over the largest displacement.
fn apart(u: &[f64], v: &[f64]) -> f64 {
    let largest = u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
    u.iter().zip(v).fold(0.0_f64, |m, (u, v)| m.max((u - v).abs())) / largest
}

/// An old factor preconditions, put right for what changes near contact, whoever made it; one that says nothing of its cost is made
/// for every matrix.
#[test]
fn factors_are_saved_whatever_the_engine() {
    let (u, own) = drag(Box::new(Frontal::new(Factors::Kept)));
    let work = Some(Work { factorisation: 1e3, solution: 1.0 });
    let (v, other) = drag(Box::new(Dense { work, ..Dense::default() }));
    let (w, every) = drag(Box::new(Dense::default()));
    assert!(apart(&w, &u) < 1e-5 && apart(&w, &v) < 1e-5, "{:.1e} {:.1e}", apart(&w, &u), apart(&w, &v));
    assert_eq!(every.iterative, 0, "{every:?}");
    let few = |counts: SolverCounts| 2 * counts.factorisations < every.factorisations && counts.iterative > 0;
    assert!(few(own) && few(other), "{own:?} {other:?} {every:?}");
}
