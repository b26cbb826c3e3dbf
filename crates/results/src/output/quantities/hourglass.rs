//! What cells of first degree with reduced integration move without resistance.

use super::Source;
use crate::output::{Frame, Quantity, Reading, Unit};
use asperity_core::Error;
use asperity_core::system::Term;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    for (_, body) in &source.parts.bodies {
        if let Some(part) = body.hourglass(&source.state.u) {
            frame.certify(Reading::new("hourglass", format!("body '{}'", body.name()), part));
            frame.push(Quantity::scalar(format!("hourglass.{}", body.name()), Unit::One, part))?;
        }
    }
    Ok(())
}
