//! Thermal strain: a prescribed temperature stretches a body alike in all directions, by `1 + alpha T` against its size
//! at the reference temperature. The law sees the rest of the deformation, `f (1 + alpha T_n)/(1 + alpha T_n+1)`.

use crate::Failure;
use crate::amplitude::Timeline;
use crate::system::Instant;

/// The temperature of a body and what it does to its size.
#[derive(Debug, Clone, PartialEq)]
pub struct Heat {
    /// Linear expansion for a unit of temperature.
    pub expansion: f64,
    /// Temperature above that at which the undeformed body is free of stress.
    pub temperature: Timeline,
}

impl Heat {
    /// Thermal stretch at an instant.
    ///
    /// # Errors
    /// A [`Failure`] where nothing of the body would be left.
    pub fn stretch(&self, at: Instant) -> Result<f64, Failure> {
        let stretch = 1.0 + self.expansion * self.temperature.value(at.step, at.step_time);
        if stretch > 0.0 { Ok(stretch) } else { Err(Failure::new("the cold leaves nothing of the body")) }
    }
}
