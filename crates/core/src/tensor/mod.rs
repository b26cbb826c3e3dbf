//! Numbers that carry their derivatives, and the vectors and tensors of mechanics over them.
//!
//! Every law and every contact point is written once, generic over [`Scalar`]; evaluated with `f64` it gives the
//! value, with [`Dual`] the value and its exact derivative along `N` directions.

mod bounds;
mod dual;
mod inverse;
mod principal;
mod quadrature;
mod roots;
mod scalar;
mod sets;
mod tensor2;
mod vec3;

pub use bounds::BoundingBox;
pub use dual::Dual;
pub use inverse::{inverse, invert};
pub use principal::{Isotropic, principal};
pub use quadrature::{integral, legendre};
pub use roots::{quadratic, root, roots};
pub use scalar::Scalar;
pub use sets::DisjointSets;
pub use tensor2::Tensor2;
pub use vec3::Vec3;
