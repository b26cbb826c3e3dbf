//! Every law of a solid, found by walking the registry: no law is named where all are meant. The laws are sampled from
//! the decks of `cases/point`, of which each law must have one.
//!
//! Ten times the states for the tangents and fifty times for the search of what is no number:
//! `cargo test --release -p asperity --test laws -- --ignored --nocapture`.

mod closed_forms;
mod conformance;
mod plasticity;
mod refusals;
mod rubber;
mod samples;
mod schemes;
mod single_steps;
mod soils;
