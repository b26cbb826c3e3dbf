//! What there is to know of a run of Asperity: [`output`] quantities, tables, pictures and files; [`diagnosis`] what a run most likely
//! suffers from; [`point`] one driven point of a material or an interface.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod diagnosis;
pub mod output;
pub mod point;
