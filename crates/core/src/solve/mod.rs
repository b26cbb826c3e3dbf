//! The procedure. It sees the discrete system and the linear solver only; it knows neither mechanics nor contact.
//!
//! # What it is
//!
//! Equilibrium of an increment is `r(u) = 0`, where `r` is smooth but for the contact points: these close, open, stick or slip. It is
//! solved by Newton's method for B-differentiable functions (Pang, Math. Oper. Res. 15, 1990): the step solves
//! `K du + H (t(y0 + G du) - t0 - C0 G du) = -r`, with `K` the tangent in the present contact state, `y` the penetrations and slips of
//! the points, `t` their stresses, `C0` the slopes of `t` at `y0`. Eliminating `du` leaves a small problem over the few stresses that
//! the linear step misses, whose matrix is the Schur complement `I + (C - C0) G K^-1 H` of the contact stresses; `G K^-1 H` is the
//! compliance of contact. Tangents turn and move with the stress to which the step leads (mixed integration points: Magisano, Leonetti
//! & Garcea, CMAME 313, 2017). The linear systems are solved by an inexact Newton-Krylov method (Eisenstat & Walker, SIAM J. Sci.
//! Comput. 17, 1996) that an older factor preconditions, with recycled directions (Parks et al. 2006) and a correction of low rank near
//! contact (Hager, SIAM Review 31, 1989). Increments adapt to what converges. Where none does, the unbalanced forces are followed at
//! fixed load through a viscous medium to the equilibrium beyond (pseudo-transient continuation: Kelley & Keyes, SIAM J. Numer. Anal.
//! 35, 1998); steps of arc length pass limit points without a jump.
//!
//! # Where it is
//!
//! | | |
//! |---|---|
//! | `run` | steps, increments, attempts; what is accepted |
//! | `newton` | one attempt, and the one loop that all iterations go through |
//! | `predict`, `step`, `semismooth` | first guess; linear step and line search; what contact makes of it |
//! | `linear` | the linear system: engines behind one trait, and all that saves factorisations above it |
//! | `path`, `relax` | arc length; pseudo-transient continuation |
//! | `convergence`, `cycle`, `progress` | when forces balance; states that repeat; iterations that wander |
//! | `free`, `rigid`, `stop` | what nothing holds: in an iterate, before the run, under a load |
//! | `stability`, `snap` | eigenvalues that pass zero; increments that jump |
//! | `hand_over`, `schedule`, `problem`, `observer` | from step to step; sizes; what is solved; who is told |
//! | `constants` | every number that tunes it, with its reason and what half and twice of it do |

mod constants;
mod convergence;
mod cycle;
mod free;
mod hand_over;
mod linear;
mod newton;
mod observer;
mod path;
mod predict;
mod problem;
mod progress;
mod relax;
mod rigid;
mod run;
mod schedule;
mod semismooth;
mod snap;
mod stability;
mod step;
mod stop;

pub use convergence::{Norms, Worst};
pub use linear::{
    Demand, Factored, Factors, Frontal, LinearError, LinearSolver, OfRanks, SolverCounts, Unknowns, dense, engine,
};
pub use newton::{IfFree, NewtonOptions, Spent, Variant};
pub use observer::{AttemptRecord, IterationRecord, Observer, Silent};
pub use problem::Problem;
pub use run::{Run, RunOptions, Stop};
pub use schedule::{ArcLength, Course, Increments, Prescribed, SMALLEST, Step, Until};
pub use snap::Snap;
pub use stability::{Stability, Turn};
