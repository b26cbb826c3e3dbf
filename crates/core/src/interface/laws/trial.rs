//! What most laws share: the stress of an elastic trial and its radial return to `|tau| = tau_y`.
//!
//! The trial is `p = K_p (u - w)` with the closure `w` that stays, and `tau_n + K_t d`; slip flows along the trial, so
//! that `|tau| = |tau_trial| - K_t dl`.

use crate::interface::{Motion, Past, Response, Status};
use crate::tensor::Scalar;

/// Shear over pressure up to which a law bears what does not follow from the pressure. Without it the shear stress would jump
/// to nothing as a contact opens, and between the two no state is in equilibrium.
pub(super) const STEEPEST: f64 = 10.0;

/// The trial shear stress.
pub(super) struct Trial<T> {
    pub shear: [T; 2],
    /// Its magnitude.
    pub size: T,
    stiffness: f64,
}

impl<T: Scalar> Trial<T> {
    pub fn new(motion: &Motion<T>, past: &Past<T>) -> Self {
        let stiffness = past.tangential_penalty;
        let shear: [T; 2] = std::array::from_fn(|i| past.shear[i] + motion.slip[i] * stiffness);
        let size = (shear[0] * shear[0] + shear[1] * shear[1]).sqrt();
        Self { shear, size, stiffness }
    }

    /// The trial is the answer.
    pub fn stick(&self, pressure: T) -> Response<T> {
        let (status, shear) = (Status::Stick, self.shear);
        Response { pressure, shear, status, slipped: 0.0, closure: 0.0, dissipated: 0.0, violation: 0.0 }
    }

    /// The stress of the size `limit` along the trial.
    pub fn slide(&self, pressure: T, limit: T) -> Response<T> {
        let shear = if self.size.re() > 0.0 { self.shear.map(|t| t / self.size * limit) } else { self.shear };
        let (slipped, limit) = ((self.size.re() - limit.re()) / self.stiffness, limit.re());
        let excess = shear[0].re().hypot(shear[1].re()) - limit;
        let violation = if limit > 0.0 { excess.max(0.0) / limit } else { 0.0 };
        let status = Status::Slip;
        Response { pressure, shear, status, slipped, closure: 0.0, dissipated: limit * slipped, violation }
    }

    /// Stick up to the limit, slip on it. A trial may come with a negative limit.
    pub fn within(&self, pressure: T, limit: T) -> Response<T> {
        if self.size.re() <= limit.re() { self.stick(pressure) } else { self.slide(pressure, limit.max(T::zero())) }
    }
}
