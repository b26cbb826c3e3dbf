//! Contact with friction between a deformable surface and a target.
//!
//! Contact stress is a [`field`] of nodal values, or lives at Gauss points as in the element of Charlier & Habraken (1990): [`PaperContact`].
//! What both share is here: the two sides, options, the history of a point and its record, what a law answers, overlap and wear, penalties.
//! Bodies, laws and tools are known here; other terms of equilibrium are strangers.

mod augment;
mod energy;
pub mod field;
mod increment;
mod kink;
mod options;
mod overlap;
mod paper;
mod penalty;
mod record;
mod sides;
mod thin;

pub use augment::Augmentation;
pub use options::{ContactOptions, LoadedSides, Move, RaisedPenalty, second_name};
pub use overlap::Overlap;
pub use paper::{GaussPoint, PaperContact, Sample};
pub use penalty::{Backing, DefaultPenalty, TWO_PASSES, default_penalty};
pub use record::{ContactRecord, PointStatus};
pub use sides::{Borne, ContactParts, ContactSides};
pub use thin::{Plate, plates};
