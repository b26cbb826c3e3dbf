//! How far pressures jump from point to point: cells that cannot keep their volume and deform lock, and their pressures alternate.

use super::Source;
use crate::output::{Frame, QuantityPlace, Reading};
use asperity_core::Error;
use asperity_core::system::Term;

/// Part of the pressure itself, and of the modulus, that the iterations and rounding leave of it: no less counts as von Mises' stress where a solid is
/// pressed from all sides, or expands freely.
const NOISE: [f64; 2] = [1e-3, 1e-8];

/// For each body the root mean square distance of the pressure at its points from the mean of the nodal means of their cell, over
/// that of von Mises' stress, both by volume. A smooth field changes little over a cell.
pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let nodal = frame.at(QuantityPlace::Node).find(|quantity| quantity.name == "cauchy_stress_averaged");
    let Some(nodal) = nodal.map(|quantity| quantity.values.clone()) else { return Ok(()) };
    for (term, body) in &source.parts.bodies {
        let (mut apart, mut scale, modulus) = (0.0, 0.0, body.material().moduli()[0]);
        for record in body.records(&source.state.u, source.history(*term)?) {
            let nodes = source.parts.mesh.cell(record.cell).nodes;
            let mean = nodes.iter().map(|&node| pressure(&nodal[6 * node..])).sum::<f64>() / nodes.len() as f64;
            apart += record.volume * (pressure(record.state) - mean).powi(2);
            let noise = (NOISE[0] * pressure(record.state)).powi(2) + (NOISE[1] * modulus).powi(2);
            scale += record.volume * (shape(record.state) + noise);
        }
        let reading = Reading::new("pressure_oscillation", format!("body '{}'", body.name()), apart.sqrt());
        frame.certify(reading.over(scale.sqrt()));
    }
    Ok(())
}

fn pressure(stress: &[f64]) -> f64 {
    -(stress[0] + stress[1] + stress[2]) / 3.0
}

/// Square of von Mises' stress.
fn shape(stress: &[f64]) -> f64 {
    let [xx, yy, zz, xy, yz, xz] = std::array::from_fn(|i| stress[i]);
    0.5 * ((xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2)) + 3.0 * (xy * xy + yz * yz + xz * xz)
}
