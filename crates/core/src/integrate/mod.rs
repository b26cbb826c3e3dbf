//! Integration of laws over an increment, for any law: sub-steps and schemes, and the local equations of a step.
//!
//! A law knows how to take one implicit step. [`Update`] says how an increment is made of such steps (scheme, their
//! number, or an error they must keep) and [`solve`], [`root`] find the unknowns of one step in plain numbers and
//! carry derivatives by one last step, which is the implicit function theorem. This room knows no law and no stress:
//! a state is anything that can be [blended](Blend).

mod local;
mod scheme;

pub use local::{System, root, solve};
pub use scheme::{Blend, Scheme, Update};
