//! A periodic cell of a laminate: its moduli are those of the layers in series and side by side.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "laminate", measure };

/// The strain, and moduli of the layers in series and side by side.
const STRAIN: f64 = 1e-3;
const SERIES: f64 = 1.0 / (0.3 / 10.0 + 0.7 / 1000.0);
const PARALLEL: f64 = 0.3 * 10.0 + 0.7 * 1000.0;

fn measure(bench: &Bench) -> Result<Measured, Error> {
    // Without lateral strain and with a Poisson's ratio of zero the shear modulus of each layer is half of its modulus.
    let led = [
        ("across", "bottom_right", "x", SERIES),
        ("along", "top_left", "y", PARALLEL),
        ("shear", "bottom_right", "y", 0.5 * SERIES),
    ];
    let mut measured = Measured::new();
    for (key, corner, axis, modulus) in led {
        let run = bench.solve("cell.toml", &[format!("step.1.displacement.\"cell.{corner}\".{axis}={STRAIN:?}")])?;
        let stored: f64 = run.state.energies.iter().map(|energies| energies.stored).sum();
        measured.push((key.into(), 2.0 * stored / (STRAIN * STRAIN) / modulus - 1.0));
    }
    Ok(measured)
}
