//! How far fluids have entered: the area that each wets, and the part of its surface that this is.

use super::Source;
use crate::output::{Frame, Quantity, Unit};
use asperity_core::Error;
use asperity_core::system::Term;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    for &(term, fluid) in &source.parts.fluids {
        let [wet, all] = fluid.wetted(source.state, source.history(term)?);
        frame.push(Quantity::scalar(format!("{}.wetted_area", fluid.name()), Unit::Area, wet))?;
        frame.push(Quantity::scalar(format!("{}.wetted_part", fluid.name()), Unit::One, wet / all))?;
    }
    Ok(())
}
