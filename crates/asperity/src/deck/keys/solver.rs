//! How the equations are solved.

use crate::deck::form::{Form, flag, number, table, whole, word, words};
use crate::declare::{Range, unit};

table! {
    /// How the equations are solved.
    pub struct Solver {
        /// When the matrix of Newton's method is renewed.
        newton: Newton = word().or("\"full\""),
        /// Where the derivatives come from.
        tangent: Tangent = word().or("\"exact\""),
        /// Largest unbalanced force over the reference force of a converged increment.
        tolerance: f64 = number(unit::NONE, Range::above_to(0.0, 0.1)).or("1e-8"),
        /// Most iterations of an attempt; then the increment is cut.
        iterations: usize = whole(2..=1000).or("16"),
        /// Whether a correction that does not lower the residual is shortened.
        line_search: bool = flag().or("true"),
        /// Whether the matrix is kept from increment to increment. A run is then no longer bit for bit the same after
        /// a restart.
        reuse: bool = flag().or("false"),
    }
}

words! {
    /// When the matrix of Newton's method is renewed.
    pub enum Newton {
        /// At every iteration.
        Full = "full",
        /// At the first iteration of an attempt.
        Modified = "modified",
    }
}

words! {
    /// Where the derivatives come from.
    pub enum Tangent {
        /// Exact, by dual numbers.
        Exact = "exact",
        /// Differences of perturbed forces, as an independent check.
        Perturbation = "perturbation",
    }
}
