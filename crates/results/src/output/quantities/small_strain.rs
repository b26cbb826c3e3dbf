//! How far bodies in small strain leave the range in which that is a theory.

use super::Source;
use crate::output::{Frame, Quantity, Reading, Unit};
use asperity_core::Error;
use asperity_core::system::Term;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    for (_, body) in &source.parts.bodies {
        if let Some(gradient) = body.largest_gradient(&source.state.u) {
            frame.certify(Reading::new("small_strain", format!("body '{}'", body.name()), gradient));
            frame.push(Quantity::scalar(format!("small_strain.{}", body.name()), Unit::One, gradient))?;
        }
    }
    Ok(())
}
