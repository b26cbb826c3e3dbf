//! Laws of interfaces: to a surface what a material is to a body.
//!
//! A law maps the penetration and the slip increment of a contact point to pressure and shear in its local triad,
//! which turns with the surface, so that nothing has to be made objective here. Penalties play the role of elastic
//! stiffness. Laws know no surface, no target and no search.
//!
//! To add a law: its file in `laws/`, its `mod` line and its line in [`laws::ALL`].

mod integrated;
mod law;
pub mod laws;

pub use law::{Interface, InterfaceLaw, Law, MOST_VARIABLES, Motion, Past, Response, Status};
