//! Displacements and the forces that hold nodes or act on them.

use super::Source;
use crate::output::{Frame, Quantity, QuantityPlace, Unit, Width};
use asperity_core::Error;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let nodal = |values: &[f64]| -> Vec<f64> {
        (0..source.parts.mesh.points.len()).flat_map(|node| source.nodal(values, node)).collect()
    };
    let vector = |name: &str, unit, values| Quantity::new(name, unit, QuantityPlace::Node, Width::Vector, values);
    frame.push(vector("displacement", Unit::Length, nodal(&source.state.u)))?;
    frame.push(vector("reaction", Unit::Force, nodal(&source.borne())))?;
    frame.push(vector("load", Unit::Force, nodal(&source.state.load)))
}
