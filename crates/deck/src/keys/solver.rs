//! How the equations are solved.

use crate::form::{Form, Words, flag, number, table, text, whole, word, words};
use crate::source::Spot;
use asperity_core::declare::{Range, unit};
use asperity_core::solve::{Factors, IfFree, NewtonOptions, Variant};
use std::sync::Arc;

table! {
    /// How the equations are solved.
    pub struct SolverKeys {
        /// Which matrix Newton's method uses.
        newton: Variant = word().or("\"full\""),
        /// What is factorised when every iteration has a new matrix.
        factors: Factors = word().or("\"auto\""),
        /// Where the derivatives come from.
        tangent: TangentWord = word().or("\"exact\""),
        /// Largest unbalanced force over the reference force of a converged increment.
        tolerance: f64 = number(unit::NONE, Range::above_to(0.0, 0.1)).or("1e-6"),
        /// Most iterations of an attempt; then the increment is cut.
        iterations: usize = whole(2..=1000).or("25"),
        /// Whether each step of Newton's method finds out at once which points close, open, stick or slip over it,
        /// instead of taking one after the other from iteration to iteration.
        piecewise: bool = flag().or("true"),
        /// Whether a correction that does not lower the residual is shortened.
        line_search: bool = flag().or("true"),
        /// Whether an increment that cutting does not help, as where a contact lets go or slip jumps to another band, is relaxed
        /// at fixed load to the equilibrium beyond; without contact only where no load acts, whose limit is told.
        relax: bool = flag().or("true"),
        /// What becomes of what nothing holds any more, as of a body that has lost its contact.
        if_free: IfFree = word().or("\"auto\""),
        /// Options of PETSc, which solves the linear systems of a program that was built with it (feature `cluster`), as of its
        /// command line: `"-ksp_type fgmres -pc_type hypre"`.
        petsc: Option<Spot<String>> = text("options of PETSc").spot().computed("in a program built with PETSc every matrix factorised by MUMPS, else its own solver"),
        /// Gigabytes (10^9 bytes) of memory that the process may take; a run that needs more ends before it takes them and says
        /// what would fit.
        memory: Option<f64> = number("GB", Range::from_to(0.01, 1e6))
            .computed("what the machine has, or less where a control group or `ulimit -v` allows less"),
    }
}

impl Words for Variant {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Full, "full", "a new matrix at every iteration"),
            (Self::Modified, "modified", "that of the attempt's first iteration"),
        ]
    }
}

impl Words for IfFree {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        let hold = "it stays where it is until something touches it; a load on it finds no equilibrium";
        let auto = "`hold` for what has lost its hold, or lies in the first increment within a third of a cell of what it may touch, `stop` for what else nothing holds there";
        vec![(Self::Auto, "auto", auto), (Self::Stop, "stop", "the run ends and names it"), (Self::Hold, "hold", hold)]
    }
}

impl Words for Factors {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Auto, "auto", "as `kept` where that is predicted to be cheaper, as in space; else as `fresh`"),
            (Self::Fresh, "fresh", "every matrix"),
            (Self::Kept, "kept", "as few matrices as possible, with which those of later increments are solved too"),
        ]
    }
}

impl SolverKeys {
    /// The options of the iterations.
    pub fn newton_options(&self) -> NewtonOptions {
        NewtonOptions {
            variant: self.newton,
            factors: self.factors,
            perturbation: self.tangent == TangentWord::Perturbation,
            tolerance: self.tolerance,
            iterations: self.iterations,
            piecewise: self.piecewise,
            line_search: self.line_search,
            relax: self.relax,
            if_free: self.if_free,
            memory: self.memory.map(|gigabytes| (gigabytes * 1e9) as u64),
            engine: self.petsc.as_ref().map(|options| Arc::from(options.value.as_str())),
            rehearse: false,
        }
    }
}

words! {
    /// Where the derivatives come from.
    pub enum TangentWord {
        /// Exact, by dual numbers.
        Exact = "exact",
        /// Differences of perturbed forces, as an independent check.
        Perturbation = "perturbation",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::form::KeyTable;
    use crate::reader::Reader;
    use crate::tree::Node;

    /// The defaults of a deck and of the library are one.
    #[test]
    fn the_defaults_are_those_of_the_procedure() {
        let solver = SolverKeys::read(&Node::empty(Default::default()), &mut Reader::default()).unwrap();
        assert_eq!(solver.newton_options(), NewtonOptions::default());
    }
}
