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
//! A model without a deck is put together by name with [`model::Model::builder`], as in `examples/hertz.rs`. `press.rs`, `branch.rs` and
//! `law.rs` go on from here; a program of your own reads what a run writes, or listens to it as a
//! [`solve::Observer`].
//!
//! Four crates are joined here, each with the packages that it needs and no more: `asperity-core` with all that is solved (the rooms
//! [`tensor`] to [`model`]), `asperity-results` ([`output`], [`diagnosis`], [`point`]), `asperity-deck` ([`deck`]). Its users may
//! depend on one of them alone.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[doc(inline)]
pub use asperity_core::{
    Error, Failure, FailureKind, amplitude, audit, contact, declare, error, files, integrate, interface, load, machine,
    material, mesh, model, solid, solve, system, tensor, tool,
};
#[doc(inline)]
pub use asperity_deck as deck;
#[doc(inline)]
pub use asperity_results::{diagnosis, output, point};
