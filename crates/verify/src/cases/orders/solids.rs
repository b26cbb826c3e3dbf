//! Those of solids.

#[path = "../../../../asperity/tests/laws/samples.rs"]
mod samples;
#[path = "../../../../asperity/tests/laws/schemes.rs"]
pub mod schemes;
