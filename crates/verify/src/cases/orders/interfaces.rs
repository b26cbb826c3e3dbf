//! Those of interfaces.

#[path = "../../../../asperity/tests/interfaces/samples.rs"]
mod samples;
#[path = "../../../../asperity/tests/interfaces/schemes.rs"]
pub mod schemes;
