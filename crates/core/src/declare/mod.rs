//! Things that a user may name, each declared once: key, meaning, unit, range, default.
//!
//! A law, a shape or a cell says what numbers it takes as a list of [`Parameter`]s and stands in a registry as an
//! [`Entry`]. The reader of decks, its checks and messages, the schema and the manual follow from these lists; no
//! key, range or default is written a second time. This room knows neither decks nor mechanics.

mod nearest;
mod parameter;
mod range;
mod registry;
mod variable;

pub use nearest::nearest;
pub use parameter::{Parameter, unit};
pub use range::{Range, short};
pub use registry::{Entry, Pairs, find};
pub use variable::{Variable, VariableKind};
