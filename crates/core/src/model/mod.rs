//! The model: what is to be solved, put together from parts and immutable from then on.

mod audited;
mod bearing;
mod behind;
mod builder;
#[allow(clippy::module_inception)] // the room and the type it is about share the field's word
mod model;

pub use behind::{ELASTIC_SLIP, FieldSides, backings, boundary_behind, tool_target};
pub use builder::{ContactBuilder, ModelBuilder, StepBuilder};
pub use model::{Model, ModelParts, RigidGroup};
