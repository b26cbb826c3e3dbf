//! Asperity: implicit finite elements for contact with friction under large displacements and strains.
//!
//! The rooms, by layer; a room may use rooms of lower layers only (`tests/layers.rs` holds the rule):
//!
//! 1. [`tensor`] dual numbers, vectors, tensors; [`declare`] parameters declared once, nearest names;
//!    [`amplitude`] values in time; [`machine`] memory there is; [`integrate`] sub-steps and local equations of laws;
//!    [`files`] reading what a user names.
//! 2. [`mesh`] nodes, cells, groups, files; [`material`] laws; [`tool`] rigid tools and what a ray meets on them.
//! 3. [`system`] unknowns, state, terms, assembly.
//! 4. [`solid`] bodies; [`contact`] contact with friction; [`load`] loads and springs;
//!    [`audit`] whether anything lies in or went through anything.
//! 5. [`solve`] increments, Newton's method.
//! 6. The program: [`model`] what is to be solved; [`output`] files, tables, pictures; [`point`] one driven
//!    material point; [`deck`] what a user writes.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod amplitude;
pub mod audit;
pub mod contact;
pub mod deck;
pub mod declare;
pub mod diagnosis;
pub mod error;
pub mod files;
pub mod integrate;
pub mod interface;
pub mod load;
pub mod machine;
pub mod material;
pub mod mesh;
pub mod model;
pub mod output;
pub mod point;
pub mod solid;
pub mod solve;
pub mod system;
pub mod tensor;
pub mod tool;

pub use error::{Error, Failure, Kind};
