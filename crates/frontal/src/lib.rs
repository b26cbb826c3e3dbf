//! Sparse LU for matrices with symmetric pattern and unsymmetric values, by the multifrontal method.
//!
//! Friction, follower forces and non-associated plasticity give finite element matrices whose pattern is symmetric
//! while their values are not. For these the fill-reducing ordering of the undirected graph is the right one, and the
//! work can be done in dense *fronts* (Duff & Reid, ACM TOMS 9, 1983; Liu, SIAM Review 34, 1992).
//!
//! Three phases, with nothing about mechanics in them:
//!
//! 1. [`Symbolic::analyse`] orders a [`Pattern`], once per pattern, and predicts flops and memory exactly;
//! 2. [`Symbolic::factorise`] puts values into a [`Factor`] and re-uses all of its memory;
//! 3. [`Factor::solve`] solves for one or many right-hand sides, [`Factor::solve_transposed`] for the adjoint.
//!
//! ```
//! use frontal::{Options, Pattern, Symbolic};
//!
//! // A 3 x 3 matrix by rows: [4 1 0; 2 5 1; 0 3 6].
//! let pattern = Pattern::new(vec![0, 2, 5, 7], vec![0, 1, 0, 1, 2, 1, 2])?;
//! let symbolic = Symbolic::analyse(&pattern, &Options::default())?;
//! let mut factor = symbolic.new_factor();
//! symbolic.factorise(&[4.0, 1.0, 2.0, 5.0, 1.0, 3.0, 6.0], &mut factor)?;
//!
//! let mut x = [5.0, 8.0, 9.0];
//! factor.solve(&mut x)?;
//! assert!(x.iter().all(|x| (x - 1.0).abs() < 1e-14));
//! # Ok::<(), frontal::FrontalError>(())
//! ```
#![deny(unsafe_code)]
#![warn(missing_docs)]

mod allocator;
mod assembly_tree;
mod change;
mod dense;
mod diagnose;
mod direct;
mod error;
mod estimate;
mod etree;
mod extend_add;
mod factor;
#[cfg(feature = "feral")]
mod feral;
mod full;
mod graph;
mod huge;
mod influence;
mod krylov;
pub mod market;
#[cfg(feature = "metis")]
mod metis;
mod numeric;
mod options;
mod ordering;
mod panels;
mod pattern;
mod plan;
mod recycle;
mod refine;
mod reuse;
mod rounded;
mod scaling;
mod solve;
mod speed;
mod stripes;
mod supernode;
mod symbolic;
mod symmetric;
mod together;
mod vector;

pub use allocator::give_back_large_arrays;
pub use change::{LowRankChange, Sparse};
pub use diagnose::{NullVector, Singular};
pub use direct::Direct;
pub use error::FrontalError;
pub use factor::{Factor, PivotSigns, Report};
pub use full::{Full, subtract_product};
pub use huge::ask as ask_for_huge_pages;
pub use krylov::{Convergence, Krylov};
pub use options::{Amalgamation, Options, Ordering};
pub use pattern::Pattern;
pub use refine::Accuracy;
pub use reuse::{Counts, Outcome, Policy, Recycler, Reuse, Service, Solver, Work};
pub use scaling::Scaling;
pub use speed::speed;
pub use symbolic::{NodeGraph, Prediction, Symbolic};
