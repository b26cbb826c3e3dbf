//! Every law of an interface, found by walking the registry: no law is named where all are meant. The laws are sampled
//! from the decks of `cases/interface`, of which each law must have one.

mod closed_forms;
mod conformance;
mod increments;
mod refusals;
mod samples;
mod schemes;
