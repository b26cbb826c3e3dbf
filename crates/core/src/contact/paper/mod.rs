//! The element of Charlier and Habraken (1990): contact stress at the Gauss points of a surface.
//!
//! Every Gauss point carries a triad, casts a ray along its inward normal, takes penetration and slip from the place it hits,
//! asks the interface law for pressure and shear, and loads its own nodes and the target. The way of a point, each step of which knows those before
//! it alone: `surface` says where it stands, `point` is the pure function from positions to forces, `segment` a piece of a target, `contact` the two
//! sides, `search` what a point may touch, `attempt` what holds during one, `stencil` the unknowns with the chain rule,
//! `mean` friction by a mean pressure, `evaluate` forces, energies and history, `term` the whole. `report` is what outputs ask. The plane is
//! space with the second tangent `e_z`.

mod attempt;
mod contact;
mod evaluate;
mod mean;
mod neighbours;
mod point;
mod report;
mod search;
mod seed;
mod segment;
mod stencil;
mod surface;
mod term;

pub use contact::PaperContact;
pub use report::Sample;
pub use surface::GaussPoint;
