//! Friction whose limit depends on the slip of the increment itself: the slip `dl` solves
//! `|tau_trial| - K_t dl - tau_y(p, tau, dl) = 0` with `tau = |tau_trial| - K_t dl`.
//!
//! The solution is unique as long as the limit falls more slowly with slip than `K_t`. Where it does not, the motion
//! is true stick-slip, which needs inertia to be followed: this is a [`Failure`] that says so.

use super::trial::Trial;
use crate::Failure;
use crate::integrate::{Scheme, System, Update, root};
use crate::interface::{Motion, Past, Response, Status};
use crate::tensor::Scalar;

/// Refuses the midpoint rule for friction that depends on the velocity.
///
/// # Errors
/// In words.
pub(super) fn no_midpoint(update: Update) -> Result<(), String> {
    match update.scheme {
        Scheme::Midpoint(_) => Err(
            "the midpoint rule ends with a return in which no time passes, and friction that depends on the velocity has none \
             then: use scheme = \"two-step\", of second order too"
                .into(),
        ),
        _ => Ok(()),
    }
}

/// What the limit may depend on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sliding<T> {
    pub pressure: T,
    /// Shear stress at the end of the increment.
    pub shear: T,
    /// Irreversible slip of the increment.
    pub slip: T,
    /// What the law remembers from before.
    pub memory: T,
    pub dt: f64,
}

/// A limit that depends on slip.
pub(super) trait Limit: Sync {
    /// What messages call the law.
    const NAME: &'static str;
    /// The largest shear stress.
    fn limit<T: Scalar>(&self, at: &Sliding<T>) -> T;
    /// The most that the limit falls for one unit of slip, at a pressure, from a trial shear stress.
    fn fall(&self, pressure: f64, trial: f64, dt: f64) -> f64;
}

struct Slip<'a, L> {
    law: &'a L,
    stiffness: f64,
    dt: f64,
    scale: f64,
}

impl<L: Limit> System<1, 3> for Slip<'_, L> {
    fn residual<S: Scalar>(&self, &[slip]: &[S; 1], &[trial, pressure, memory]: &[S; 3]) -> [S; 1] {
        let shear = trial - slip * self.stiffness;
        let limit = self.law.limit(&Sliding { pressure, shear, slip, memory, dt: self.dt });
        [(shear - limit) / self.scale]
    }
}

/// The response, and the irreversible slip with its derivatives.
pub(super) fn respond<L: Limit, T: Scalar>(
    law: &L,
    motion: &Motion<T>,
    past: &Past<T>,
    memory: T,
) -> Result<(Response<T>, T), Failure> {
    let (trial, pressure) = (Trial::new(motion, past), motion.penetration * past.penalty);
    if pressure.re() <= 0.0 {
        return Ok((trial.slide(pressure, T::zero()), T::zero()));
    }
    let (size, stiffness, dt) = (trial.size, past.tangential_penalty, past.dt);
    let still = Sliding { pressure, shear: size, slip: T::zero(), memory, dt };
    if size.re() <= law.limit(&still).re() {
        return Ok((trial.stick(pressure), T::zero()));
    }
    refuse_stick_slip(law, [pressure.re(), size.re()], past)?;
    let equation = Slip { law, stiffness, dt, scale: size.re() };
    let slip = root(&equation, [0.0, size.re() / stiffness], &[size, pressure, memory], L::NAME)?;
    let limit = law.limit(&Sliding { shear: size - slip * stiffness, slip, ..still });
    let response = trial.slide(pressure, limit);
    debug_assert_eq!(response.status, Status::Slip);
    Ok((response, slip))
}

fn refuse_stick_slip<L: Limit, T: Scalar>(law: &L, [pressure, trial]: [f64; 2], past: &Past<T>) -> Result<(), Failure> {
    let (fall, stiffness) = (law.fall(pressure, trial, past.dt), past.tangential_penalty);
    if fall < stiffness {
        return Ok(());
    }
    let unique =
        format!("the friction stress falls by {fall:.3e} for one unit of slip, which is not below the tangential");
    Err(Failure::new(format!("{}: stick-slip, the slip is not unique: {unique} penalty {stiffness:.3e}", L::NAME)))
}
