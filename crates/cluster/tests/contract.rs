//! The linear solver by PETSc keeps to the contract of every linear solver: alone, or as `mpirun -n 2 .../contract-HASH`.

#[path = "../../asperity/tests/support/contract.rs"]
mod contract;

use cluster::{Petsc, start};

const ITERATIVE: &str = "-ksp_type fgmres -pc_type asm -ksp_rtol 1e-10";

fn main() {
    let ranks = start().unwrap_or_else(|why| panic!("{why}"));
    // The options of PETSc are those of the whole process: what comes last holds.
    contract::hold(&mut Petsc::with(None), true);
    contract::hold(&mut Petsc::with(Some(ITERATIVE.into())), false);
    if ranks.rank() == 0 {
        println!("the contract holds on {} ranks, directly and by iterations", ranks.size());
    }
    ranks.part(0, None);
}
