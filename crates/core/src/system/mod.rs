//! The discrete system: unknowns, constraints, state, and the sum of terms.
//!
//! Equilibrium is `sum of internal terms - sum of loads = 0`. A [`Term`] is a list of small stencils (an element, a
//! contact point, a loaded face), each a pure function of the accepted state, the trial unknowns and the instant.
//! This room knows neither mechanics nor contact: it sums, scatters and eliminates constrained unknowns. What the procedure
//! and the linear solver hand on from increment to increment stands in the state as data.

mod assembly;
mod band;
mod check;
mod chunk;
mod constraint;
mod dofs;
mod following;
mod idle;
mod kernel;
mod kink;
mod packed;
mod parcel;
mod pattern;
mod places;
mod preconditioner;
mod shares;
mod sink;
mod state;
mod structure;
mod term;
mod whole;

pub use assembly::{Assembly, Evaluation, Tangent, Trial, Workspace};
pub use check::{TangentCheck, check_tangent};
pub use constraint::{Constraints, Row, Tied};
pub use dofs::{Dofs, Unknown};
pub use following::{Following, FollowingGroup};
pub use idle::Idle;
pub use kernel::kernel;
pub use kink::{Answer, COORDINATES, Coordinates, Kink, Kinks};
pub use packed::PackedPattern;
pub use pattern::{Couplings, Csr, Reduced};
pub use preconditioner::{Factorised, Near, Preconditioner};
pub use shares::{Communicator, Shares, apart, said};
pub use state::{Caution, Energies, History, Interpenetration, Signs, Softest, State};
pub use term::{Attempt, Branch, Instant, Local, Origin, Role, Stencil, Stencils, Term, Unevenness};
pub use whole::Whole;
