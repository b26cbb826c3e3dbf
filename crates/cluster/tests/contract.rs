//! The linear solver by PETSc keeps to the contract of every linear solver: alone, or as `mpirun -n 2 .../contract-HASH`.

#[path = "../../asperity/tests/support/contract.rs"]
mod contract;

use asperity::solve::{Factored, LinearError, LinearSolver, Unknowns};
use asperity::system::{Communicator, Csr, Shares};
use cluster::{Petsc, Ranks, others, start};
use std::ops::Range;

const ITERATIVE: &str = "-ksp_type fgmres -pc_type asm -ksp_rtol 1e-10";

/// The solver of a rank that is given all of a matrix, and hands on its own rows.
struct Share {
    petsc: Petsc,
    entries: Range<usize>,
}

impl Share {
    fn with(options: Option<&str>) -> Self {
        Self { petsc: Petsc::with(options.map(Into::into)), entries: 0..0 }
    }
}

impl LinearSolver for Share {
    fn set_pattern(&mut self, pattern: &Csr, unknowns: Unknowns) -> Result<(), LinearError> {
        let own = Shares::new(others(), unknowns.dofs, unknowns.free).own();
        let (pattern, entries) = pattern.rows_only(own);
        self.entries = entries;
        self.petsc.set_pattern(&pattern, unknowns)
    }
    fn factorise(&mut self, values: &[f64]) -> Result<Factored, LinearError> {
        self.petsc.factorise(&values[self.entries.clone()])
    }
    fn solve(&mut self, rhs: &mut [f64]) -> Result<(), LinearError> {
        self.petsc.solve(rhs)
    }
    fn substitute(&mut self, x: &mut [f64]) -> Result<(), LinearError> {
        self.petsc.substitute(x)
    }
    fn compliance(&mut self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<bool, LinearError> {
        self.petsc.compliance(loads, at, x)
    }
}

/// Where ranks come to different things they hear of what failed on some of them, and of nothing else after.
fn a_failure_is_told_with_its_rank(ranks: &Ranks) {
    ranks.failed("all");
    assert_eq!(Communicator::agree(ranks, &[1.0]), Ok(()));
    if ranks.rank() == 1 {
        ranks.failed("the law of sand fails");
        assert!(!ranks.any(false));
    }
    for _ in 0..2 {
        let apart = Communicator::agree(ranks, &[2.0]).expect_err("a rank was elsewhere");
        let told = format!(": the law of sand fails (rank 1 of {})", ranks.size());
        assert!(apart.ends_with(&told), "{apart}");
    }
}

fn main() {
    let ranks = start().unwrap_or_else(|why| panic!("{why}"));
    // The options of PETSc are those of the whole process: what comes last holds.
    contract::hold(&mut Share::with(None), true);
    contract::hold(&mut Share::with(Some(ITERATIVE)), false);
    if ranks.rank() == 0 {
        println!("the contract holds on {} ranks, directly and by iterations", ranks.size());
    }
    if ranks.size() > 1 {
        a_failure_is_told_with_its_rank(ranks);
    }
    ranks.part(0, None);
}
