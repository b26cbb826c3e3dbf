//! Bodies: sums of cells whose stress follows from a law.
//!
//! Updated Lagrangian: with `f` the deformation of the increment and `sigma` the Cauchy stress at its end, the nodal
//! forces are `F_L = integral of P grad_n N_L dv_n`, `P = det(f) sigma f^-T`, with gradients and volume taken at the
//! beginning of the increment. The tangent is the exact derivative of that same expression. With small [`Strain`] all of
//! it is taken over the undeformed body.
//! F-bar and incompatible modes change the deformation that the points of a cell see.

mod attempt;
mod axes;
mod body;
mod formulation;
mod free;
mod gradient;
mod heat;
mod hourglass;
mod incompatible;
mod initial_stress;
mod lanes;
mod measure;
mod operator;
mod patches;
mod piola;
mod plane_stress;
mod point;
mod record;
mod slenderness;
mod strain;
mod volume;

pub use axes::CylinderAxes;
pub use body::Body;
pub use formulation::{BodyOptions, Choice, Formulation, Integration, NEARLY};
pub use heat::{Heat, Temperature};
pub use initial_stress::InitialStress;
pub use record::PointRecord;
pub use slenderness::{layers, too_stiff};
pub use strain::Strain;
