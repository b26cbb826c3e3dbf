//! Hertz's point contact: an elastic sphere pressed on a rigid plane. `a^3 = 3 P R / (4 E*)`,
//! `p0 = 3 P / (2 pi a^2)`, `p(r) = p0 sqrt(1 - r^2/a^2)`.

use crate::Case;
use crate::hertz::Study;
use std::f64::consts::PI;

/// The case.
pub const CASE: Case = Case { name: "hertz-sphere", measure: |bench| STUDY.measure(bench) };

const RADIUS: f64 = 10.0;
const MODULUS: f64 = 210e3 / (1.0 - 0.3 * 0.3);
const STUDY: Study = Study { deck: "sphere.toml", refined, share: 1.0, force: 1000.0, theory };

fn theory(force: f64) -> (f64, f64) {
    let a = (0.75 * force * RADIUS / MODULUS).cbrt();
    (a, 1.5 * force / (PI * a * a))
}

fn refined(n: usize) -> Vec<String> {
    let part = "mesh.part.sphere.annulus";
    let radius = format!("[{{ to = 9.6, cells = {}, ratio = 0.02 }}, {{ to = 10.0, cells = {} }}]", 10 * n, 9 * n);
    let angle = format!("[{{ to = -87.4, cells = {} }}, {{ to = 0.0, cells = {}, smooth = true }}]", 9 * n, 12 * n);
    vec![format!("{part}.along_radius={radius}"), format!("{part}.along_angle={angle}")]
}
