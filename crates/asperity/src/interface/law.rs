//! What a contact point asks of a law.

use crate::Failure;
use crate::declare::Variable;
use crate::tensor::{Dual, Scalar};

/// How a contact point is moved over an increment, in its local triad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion<T> {
    /// Penetration at the end of the increment, a length; positive, since an open point asks no law. Only a point that
    /// is expected to close in an early iteration asks with a gap, and means the same smooth function.
    pub penetration: T,
    /// Slip of the increment along the two tangents, a length; in the plane the second is zero.
    pub slip: [T; 2],
}

/// What does not vary within an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Past<'a> {
    /// Normal penalty, a stress per length.
    pub penalty: f64,
    /// Tangential penalty, a stress per length.
    pub tangential_penalty: f64,
    /// Pressure at the beginning of the increment; zero at a point that was open.
    pub pressure: f64,
    /// Shear stress at the beginning of the increment.
    pub shear: [f64; 2],
    /// The law's own variables at the beginning of the increment.
    pub vars: &'a [f64],
    /// Length of the increment.
    pub dt: f64,
}

/// Whether a point in contact sticks or slips; open points have no response.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// Inside the yield surface.
    Stick = 1,
    /// On it.
    Slip = 2,
}

/// The answer of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response<T> {
    /// Pressure, positive in compression.
    pub pressure: T,
    /// Shear stress along the two tangents.
    pub shear: [T; 2],
    /// Stick or slip.
    pub status: Status,
    /// Length of irreversible slip in the increment.
    pub slipped: f64,
    /// Energy dissipated per area in the increment.
    pub dissipated: f64,
    /// By how much the stress exceeds the yield surface, as a ratio to it; zero up to rounding.
    pub violation: f64,
}

/// A law of an interface, written once over any scalar.
pub trait InterfaceLaw: Send + Sync {
    /// Its history variables besides the shear stress.
    const VARIABLES: &'static [Variable];
    /// The response to a motion; writes the new variables.
    ///
    /// # Errors
    /// A [`Failure`] when a local iteration does not converge.
    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past, vars: &mut [f64]) -> Result<Response<T>, Failure>;
}

/// A law as the object that contacts hold: one method for each number of directions in use.
pub trait Interface: Send + Sync {
    /// History variables besides the shear stress.
    fn variables(&self) -> &'static [Variable];
    /// Plain numbers.
    ///
    /// # Errors
    /// As [`InterfaceLaw::respond`].
    fn respond(&self, motion: &Motion<f64>, past: &Past, vars: &mut [f64]) -> Result<Response<f64>, Failure>;
    /// With the derivatives of a contact point in the plane.
    ///
    /// # Errors
    /// As [`InterfaceLaw::respond`].
    fn respond_plane(
        &self,
        motion: &Motion<Dual<8>>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Dual<8>>, Failure>;
    /// With the derivatives of a contact point in space.
    ///
    /// # Errors
    /// As [`InterfaceLaw::respond`].
    fn respond_space(
        &self,
        motion: &Motion<Dual<15>>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Dual<15>>, Failure>;
}

/// An [`InterfaceLaw`] as an [`Interface`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<L>(pub L);

impl<L: InterfaceLaw> Interface for Law<L> {
    fn variables(&self) -> &'static [Variable] {
        L::VARIABLES
    }
    fn respond(&self, motion: &Motion<f64>, past: &Past, vars: &mut [f64]) -> Result<Response<f64>, Failure> {
        self.0.respond(motion, past, vars)
    }
    fn respond_plane(
        &self,
        motion: &Motion<Dual<8>>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Dual<8>>, Failure> {
        self.0.respond(motion, past, vars)
    }
    fn respond_space(
        &self,
        motion: &Motion<Dual<15>>,
        past: &Past,
        vars: &mut [f64],
    ) -> Result<Response<Dual<15>>, Failure> {
        self.0.respond(motion, past, vars)
    }
}
