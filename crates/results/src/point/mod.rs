//! One material point driven along a path of strains and stresses: how a law is calibrated, and how its closed forms are
//! checked.
//!
//! The deformation is the triangular `F = [[l1, g12, g13], [0, l2, g23], [0, 0, l3]]`, which is any deformation up to a
//! rotation. Its strains are `ln l_i` and the shears `g_ij`; stresses are Cauchy's. Each of the six components follows
//! a prescribed strain or a prescribed stress; what is prescribed as stress is found by Newton's method with the exact
//! derivative of the law. A point of an interface is driven by its slip, and by penetration or pressure. This room knows
//! laws only: no mesh, no body.

mod course;
mod curves;
mod locus;
mod newton;
mod probe;
mod slider;
mod table;
mod tangent;

pub use course::{COMPONENTS, PathControl, Stage};
pub use curves::Curve;
pub use locus::yield_surface;
pub use probe::MaterialPointDriver;
pub use slider::{InterfaceDriver, Normal, Slide, columns as slider_columns, drive};
pub use table::{Record, columns, draw, write};
pub use tangent::PointTangentCheck;
