//! The core of Asperity: elements, laws, contact and the solution of what they make together, without files of input or results.
//!
//! [`model::Model`] is what is to be solved: built in code, or by the crate `asperity-deck` of what a user writes. The crate `asperity`
//! joins all and has the examples.
//!
//! The rooms, by layer; a room may use rooms of lower layers only (`tests/layers.rs` of the crate `asperity` holds the rule):
//!
//! 1. [`tensor`] dual numbers, vectors, tensors; [`declare`] parameters declared once, nearest names;
//!    [`amplitude`] values in time; [`machine`] memory there is; [`integrate`] sub-steps and local equations of laws;
//!    [`files`] reading what a user names.
//! 2. [`mesh`] nodes, cells, groups, files; [`material`] laws of solids; [`interface`] laws of contact; [`tool`] rigid tools and what a
//!    ray meets on them.
//! 3. [`system`] unknowns, state, terms, assembly.
//! 4. [`solid`] bodies; [`contact`] contact with friction; [`load`] loads and springs;
//!    [`audit`] whether anything lies in or went through anything.
//! 5. [`solve`] increments, Newton's method.
//! 6. [`model`] what is to be solved.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod amplitude;
pub mod audit;
pub mod contact;
pub mod declare;
pub mod error;
pub mod files;
pub mod integrate;
pub mod interface;
pub mod load;
pub mod machine;
pub mod material;
pub mod mesh;
pub mod model;
pub mod solid;
pub mod solve;
pub mod system;
pub mod tensor;
pub mod tool;

pub use error::{Error, Failure, FailureKind};
