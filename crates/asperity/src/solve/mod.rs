//! The procedure: increments, attempts, Newton's iterations. It sees the discrete system and the linear solver only;
//! it knows neither mechanics nor contact.

mod bend;
mod convergence;
mod demand;
mod free;
mod hand_over;
mod influences;
mod jump;
mod linear;
mod mixed;
mod newton;
mod observer;
mod path;
mod piecewise;
mod preconditioner;
mod predict;
mod problem;
mod progress;
mod relax;
mod rigid;
mod run;
mod schedule;
mod stability;
mod step;
mod stop;
mod trail;

pub use convergence::{Norms, Worst};
pub use demand::Demand;
pub use linear::{Factors, Frontal, LinearError, LinearSolver};
pub use newton::{IfFree, NewtonOptions, Variant};
pub use observer::{AttemptRecord, IterationRecord, Observer, Silent};
pub use problem::Problem;
pub use run::{Run, RunOptions, Stop};
pub use schedule::{ArcLength, Course, Increments, Prescribed, SMALLEST, Step, Until};
pub use stability::{Stability, Turn};
