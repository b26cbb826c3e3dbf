//! What the audit found: how deep something lies in something, beyond what is explained.

use super::Source;
use crate::output::{Frame, Quantity, Reading, Unit};
use asperity_core::Error;
use asperity_core::tensor::Vec3;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let found = &source.state.interpenetration;
    let reading = match &found.pair {
        [own, _] if own.is_empty() => Reading::new("interpenetration", "", 0.0),
        [own, other] => {
            Reading::new("interpenetration", format!("{own} in {other}"), found.relative).at(Vec3(found.place))
        }
    };
    frame.certify(reading);
    frame.push(Quantity::scalar("audit.interpenetration", Unit::One, found.relative))
}
