//! Asperity: implicit finite elements for contact with friction under large displacements and strains.
//!
//! A deck is read, a model built of it, and the model run increment by increment; what there is to know of a state is a frame.
//!
//! ```
//! use asperity::deck::{build, read};
//! use asperity::output::{Parts, Source, global_columns};
//! use asperity::solve::Silent;
//!
//! let deck = r#"
//! version = 1
//! space = "plane-strain"
//! mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [4, 2], cell = "quad8" }
//! material.steel.elastic = { young = 210e3, poisson = 0.0 }
//! body.block.material = "steel"
//! tool.plate.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]
//! contact.sole = { surface = "block.bottom", target = "plate", law.coulomb = { friction = 0.2 } }
//!
//! [[step]]
//! increments = { count = 2 }
//! displacement."block.top" = { x = 0.0, y = -0.01 }
//! "#;
//! // All that is wrong is told at once, each with its line.
//! let deck = read(deck, "block.toml", ".".as_ref(), &[]).map_err(|found| found.render(false))?;
//! let model = build(deck).map_err(|found| found.render(false))?.model;
//!
//! let (parts, mut run) = (Parts::of(&model), model.run(model.problem.initial_state()));
//! let mut force = 0.0;
//! while let Some(attempt) = run.advance(&mut Silent)? {
//!     let frame = Source { parts: &parts, state: &run.state, step: attempt.step }.gather()?;
//!     let totals = global_columns(&frame, parts.is_plane());
//!     force = totals.iter().find(|(name, _)| name == "contact.sole.force.y").unwrap().1;
//! }
//! // Logarithmic strain of a column that is shortened by 0.005 of itself, over its width of 4; the penalty gives way by a hundredth.
//! assert!((force / (210e3 * 4.0 * (2.0_f64 / 1.99).ln()) - 1.0).abs() < 0.02, "{force}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `examples/press.rs`, `branch.rs` and `law.rs` go on from here; a program of your own reads what a run writes, or listens to it as a
//! [`solve::Observer`].
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
