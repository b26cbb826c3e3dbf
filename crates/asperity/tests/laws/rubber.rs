//! Rubber that relaxes and softens, and coupled hyperelastic laws, against closed forms.

use super::closed_forms::{at, last, near, run};
use asperity::point::Record;

/// Sheared at once and held: each term of the series has decayed by its exponential.
#[test]
fn rubber_relaxes() {
    let records = run("rubber_relaxation", &[]);
    let at_once = at(&records, "neo", ("time", 1e-9), "stress_xy");
    near(at_once, 1.5, 1e-8);
    for name in ["neo", "ogden"] {
        let first = at(&records, name, ("time", 1e-9), "stress_xy");
        for time in [0.1_f64, 0.5, 1.0, 3.0, 10.0] {
            let left = 0.5 + 0.3 * (-time / 0.5).exp() + 0.2 * (-time / 5.0).exp();
            near(at(&records, name, ("time", 1e-9 + time), "stress_xy"), first * left, 1e-7);
        }
    }
}

/// A shear that grows evenly, of a neo-Hookean solid and one term: in the undeformed axes the stress `G F^-1 dev(F F^T) F^-T` has
/// the shear `G (g + g^3/3)` and the part `-G g^2/3` across the planes; each relaxes by itself, and both are carried back. The error
/// is of second order in the increment.
#[test]
fn rubber_relaxes_while_it_is_sheared() {
    let relaxed = |power: i32, time: f64, tau: f64| {
        // The integral of exp(-(t - s)/tau) d(s^power).
        let steps = 20_000;
        let h = time / f64::from(steps);
        let at = |s: f64| f64::from(power) * s.powi(power - 1) * (-(time - s) / tau).exp();
        (0..steps).map(|i| at((f64::from(i) + 0.5) * h) * h).sum::<f64>()
    };
    let set = ["prony=[[0.4, 0.7]]", "step.1.duration=1.0", "step.1.strain.xy=1.2"];
    let found = |n: usize| {
        let records = run("rubber_relaxation", &[&set[..], &[&format!("step.1.increments={n}")]].concat());
        at(&records, "neo", ("time", 1.0), "stress_xy")
    };
    let g: f64 = 1.2;
    let mut terms = [0.0; 5];
    (1..5).for_each(|n| terms[n] = g.powi(n as i32) * relaxed(n as i32, 1.0, 0.7));
    // H_12 and H_22 of the history, then dev(F H F^T)_12 = H_12 + g H_22.
    let exact = 0.6 * g + 0.4 * (terms[1] + terms[3] / 3.0 + g * (-terms[2] / 3.0));
    let [coarse, fine] = [found(50) - exact, found(100) - exact];
    assert!(fine.abs() < 1e-4 * exact && (coarse / fine - 4.0).abs() < 0.3, "{coarse} {fine} of {exact}");
}

fn column(records: &[Record], name: &str, what: &str) -> Vec<f64> {
    records.iter().find(|record| record.name == name).unwrap().column(what).unwrap()
}

/// The error function by Simpson's rule.
fn erf(x: f64) -> f64 {
    let n = 2000;
    let h = x / f64::from(n);
    let at =
        |i: i32| (-(f64::from(i) * h).powi(2)).exp() * if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    2.0 / std::f64::consts::PI.sqrt() * h / 3.0 * (0..=n).map(at).sum::<f64>()
}

/// Loops in shear: loading beyond the largest energy is that of the law, below it the stress is less by
/// `1 - erf((W_m - W)/(m + beta W_m))/r`, and the area of the loops is what is dissipated.
#[test]
fn rubber_softens() {
    let records = run("rubber_softening", &[]);
    let [shear, stress] = ["strain_xy", "stress_xy"].map(|what| column(&records, "neo", what));
    let mut most: f64 = 0.0;
    for (g, found) in shear.iter().zip(&stress).skip(1) {
        let w = 0.5 * g * g;
        most = most.max(w);
        let left = 1.0 - erf((most - w) / (0.2 + 0.15 * most)) / 1.6;
        assert!((found - g * left).abs() < 1e-10, "{g}: {found} instead of {}", g * left);
    }
    let area = |fine: &[Record]| {
        let [shear, stress] = ["strain_xy", "stress_xy"].map(|what| column(fine, "neo", what));
        (1..shear.len()).map(|i| 0.5 * (stress[i] + stress[i - 1]) * (shear[i] - shear[i - 1])).sum::<f64>()
    };
    let steps: Vec<String> = (1..5).map(|i| format!("step.{i}.increments=2000")).collect();
    let fine = run("rubber_softening", &steps.iter().map(String::as_str).collect::<Vec<_>>());
    near(last(&fine, "neo", "dissipated_energy"), area(&fine), 1e-5);
}

/// Confined: `(G (l^2 - 1) + lambda ln l)/l` and `(lambda/2 + G) l (l^2 - 1)`.
#[test]
fn coupled_laws_confined() {
    let records = run("coupled_hyperelastic", &[]);
    for strain in [-0.2_f64, 0.5] {
        let l = strain.exp();
        let simo = ((l * l - 1.0) + 4.0 / 3.0 * l.ln()) / l;
        near(at(&records, "simo", ("strain_xx", strain), "stress_xx"), simo, 1e-12);
        near(at(&records, "kirchhoff", ("strain_xx", strain), "stress_xx"), 1.5 * l * (l * l - 1.0), 1e-12);
    }
}
