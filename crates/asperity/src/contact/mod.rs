//! Contact with friction: the element of Charlier & Habraken (1990) between a deformable surface and a target.
//!
//! Every integration point of the surface carries a triad, casts a ray along its inward normal, takes penetration and
//! slip from the place it hits, asks the interface law for pressure and shear, and loads its own nodes and the target.
//! Bodies, laws and tools are known here; other terms of equilibrium are strangers.

mod adjust;
mod augment;
mod averaged;
mod before;
mod capture;
mod faces;
pub mod field;
mod geometry;
mod guard;
mod kink;
mod known;
mod layout;
mod nonlocal;
mod open;
mod options;
mod overlap;
mod pair;
mod partner;
mod passage;
mod penalty;
mod placed;
mod point;
mod record;
mod rigid;
mod sampled;
mod search;
mod seed;
pub mod space;
mod split;
mod spread;
mod surface;
mod target;
mod thin;
mod uzawa;
mod variational;

pub use adjust::Move;
pub use augment::Augmentation;
pub use faces::Faces;
pub use guard::Guard;
pub use options::{ContactOptions, Loads, Normals, second_name};
pub use overlap::{Overlap, Wear};
pub use pair::Contact;
pub use partner::Role;
pub use penalty::{Backing, TWO_PASSES, default_penalty};
pub use record::{PointRecord, PointStatus};
pub use rigid::Rigid;
pub use sampled::Sample;
pub use surface::{Edge, Surface};
pub use target::{Hit, Target};
pub use thin::{Plate, plates};
pub use variational::ContactForm;
