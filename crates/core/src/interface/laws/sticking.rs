//! Contact that does not slip while it is closed: `p = K_p u`, `tau = tau_n + K_t d`, and `|tau| <= 10 p` so that the shear
//! stress is gone as the contact opens.

use super::trial::{STEEPEST, Trial};
use super::{law, nothing_to_integrate};
use crate::Failure;
use crate::declare::{Entry, Variable};
use crate::integrate::Update;
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response};
use crate::tensor::Scalar;

pub(super) const ENTRY: Entry<Box<dyn Interface>> = Entry {
    name: "sticking",
    meaning: "no slip while closed, up to a shear of ten times the pressure",
    parameters: &[],
    pairs: None,
    build: |_| Ok(law(Sticking)),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sticking;

impl InterfaceLaw for Sticking {
    const VARIABLES: &'static [Variable] = &[];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, _: &mut [T]) -> Result<Response<T>, Failure> {
        let pressure = motion.penetration * past.penalty;
        Ok(Trial::new(motion, past).within(pressure, pressure * STEEPEST))
    }

    fn updated(&self, _: Update) -> Result<Box<dyn Interface>, String> {
        nothing_to_integrate("the stress follows from the motion alone")
    }
}
