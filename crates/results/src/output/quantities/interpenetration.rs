//! What the audit found: how deep something lies in something, beyond what is explained, and how deep single nodes do.

use super::Source;
use crate::output::{Frame, Quantity, Reading, Unit};
use asperity_core::Error;
use asperity_core::tensor::Vec3;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let state = source.state;
    for (figure, found) in [("node_depth", &state.deepest_node), ("interpenetration", &state.interpenetration)] {
        frame.certify(match &found.pair {
            [own, _] if own.is_empty() => Reading::new(figure, "", 0.0),
            [own, other] => Reading::new(figure, format!("{own} in {other}"), found.relative).at(Vec3(found.place)),
        });
    }
    frame.push(Quantity::scalar("audit.node_depth", Unit::One, state.deepest_node.relative))?;
    frame.push(Quantity::scalar("audit.interpenetration", Unit::One, state.interpenetration.relative))
}
