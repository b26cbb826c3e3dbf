//! Contact without friction: `p = K_p u`, no shear.

use super::{law, nothing_to_integrate};
use crate::Failure;
use crate::declare::{Entry, Variable};
use crate::integrate::Update;
use crate::interface::{Interface, InterfaceLaw, Motion, Past, Response, Status};
use crate::tensor::Scalar;

pub(super) const ENTRY: Entry<Box<dyn Interface>> = Entry {
    name: "frictionless",
    meaning: "pressure without friction",
    parameters: &[],
    pairs: None,
    build: |_| Ok(law(Frictionless)),
};

/// The law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Frictionless;

impl InterfaceLaw for Frictionless {
    const VARIABLES: &'static [Variable] = &[];

    fn respond<T: Scalar>(&self, motion: &Motion<T>, past: &Past<T>, _: &mut [T]) -> Result<Response<T>, Failure> {
        let slipped = motion.slip[0].re().hypot(motion.slip[1].re());
        Ok(Response {
            pressure: motion.penetration * past.penalty,
            shear: [T::zero(); 2],
            status: Status::Slip,
            slipped,
            closure: 0.0,
            dissipated: 0.0,
            violation: 0.0,
        })
    }

    fn updated(&self, _: Update) -> Result<Box<dyn Interface>, String> {
        nothing_to_integrate("the stress follows from the motion alone")
    }
}
