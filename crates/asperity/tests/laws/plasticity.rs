//! Hardening by rate, three back stresses and orthotropy against closed forms.

use super::closed_forms::{at, last, near, run};

/// `(A + B p^n)(1 + C ln rate)(1 - T^m)` with the rate of each increment, over a jump by a factor of a hundred.
#[test]
fn the_flow_stress_jumps_with_the_rate() {
    let records = run("johnson_cook", &[]);
    for (name, reference, warmth) in [("steel", 1.0, 0.9), ("warm", 1.0, 1.0 - 0.4_f64.powf(1.2)), ("slow", 1e3, 1.0)] {
        let record = records.iter().find(|record| record.name == name).unwrap();
        let [time, p, stress] =
            ["time", "equivalent_plastic_strain", "stress_xx"].map(|column| record.column(column).unwrap());
        for i in 2..time.len() {
            let rate = (p[i] - p[i - 1]) / (time[i] - time[i - 1]) / reference;
            let exact = (350.0 + 275.0 * p[i].powf(0.36)) * (1.0 + 0.05 * rate.max(1.0).ln()) * warmth;
            near(stress[i], exact, 1e-9);
        }
        // From the rate 2 to 200, but for hardening and the elastic part of the rate.
        let over_slow = |strain: f64| {
            let p = at(&records, name, ("strain_xx", strain), "equivalent_plastic_strain");
            at(&records, name, ("strain_xx", strain), "stress_xx") / (350.0 + 275.0 * p.powf(0.36))
        };
        let jump = (1.0 + 0.05 * (200.0 / reference).max(1.0).ln()) / (1.0 + 0.05 * (2.0 / reference).max(1.0).ln());
        near(over_slow(0.11) / over_slow(0.1), jump, 1e-3);
    }
}

/// The same while the temperature rises to 0.6 of that of melting; the matrix of porous metal flows on Gurson's surface.
#[test]
fn the_flow_stress_follows_the_temperature() {
    // In one step, whose rate is that of the increment.
    let records = run("johnson_cook_heated", &["update.substeps=1"]);
    for (record, strain) in
        records.iter().zip(["equivalent_plastic_strain", "equivalent_plastic_strain", "matrix_plastic_strain"])
    {
        let column = |name: &str| record.column(name).unwrap();
        let [time, p, stress, mean] = ["time", strain, "stress_xx", "mean_stress"].map(column);
        let porosity = if record.name == "porous" { column("porosity") } else { vec![0.0; time.len()] };
        for i in 2..time.len() {
            let (rate, t) = ((p[i] - p[i - 1]) / (time[i] - time[i - 1]), 0.6 * (time[i] / 0.05 - 1.0).max(0.0));
            let flow = (350.0 + 275.0 * p[i].powf(0.36)) * (1.0 + 0.05 * rate.max(1.0).ln()) * (1.0 - t.powf(1.2));
            let (q, f) = (stress[i] / flow, porosity[i]);
            let surface = q * q + 3.0 * f * (1.5 * mean[i] / flow).cosh() - 1.0 - 2.25 * f * f;
            assert!(surface.abs() < 1e-8, "{}: {surface:e} at {i}", record.name);
        }
    }
}

/// Beyond its last point a measured curve goes on with the slope that is said.
#[test]
fn a_curve_goes_on_beyond_its_end() {
    let steel = "material.steel.von_mises_table={ young = 200e3, poisson = 0.3, end_slope = 70.0, curve = [[0.0, 200.0], [0.1, 350.0]] }";
    let records = run("von_mises_table", &[steel]);
    let p = last(&records, "steel", "equivalent_plastic_strain");
    assert!(p > 0.15, "{p}");
    near(last(&records, "steel", "stress_xx"), 350.0 + 70.0 * (p - 0.1), 1e-10);
}

/// Back stresses along a branch of uniaxial flow, `X_i(p) = s C_i/g_i + (X_i - s C_i/g_i) exp(-g_i p)` with the sign `s` of
/// flow: the plastic strain after which they sum up to `target`, by halving, and what they are then.
fn branch(backs: &[[f64; 2]], x: &mut [f64], sign: f64, target: f64) -> f64 {
    let after = |p: f64, k: usize, x: &[f64]| {
        let [c, g] = backs[k];
        sign * c / g + (x[k] - sign * c / g) * (-g * p).exp()
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..100 {
        let p = 0.5 * (low + high);
        let sum: f64 = (0..x.len()).map(|k| after(p, k, x)).sum();
        *(if sign * (sum - target) < 0.0 { &mut low } else { &mut high }) = p;
    }
    let next: Vec<f64> = (0..x.len()).map(|k| after(low, k, x)).collect();
    x.copy_from_slice(&next);
    low
}

/// The strain of each half cycle between two stresses; by one back stress the step of a cycle is
/// `1/g ln(((C/g)^2 - X1^2)/((C/g)^2 - X2^2))` from the first on (Lemaitre and Chaboche 1990).
#[test]
fn back_stresses_ratchet() {
    let records = run("chaboche", &[]);
    let laws: [(&str, f64, &[[f64; 2]]); 2] =
        [("one", 200.0, &[[20e3, 100.0]]), ("three", 150.0, &[[60e3, 800.0], [15e3, 120.0], [1e3, 1.0]])];
    for (name, first, backs) in laws {
        let (mut x, mut strain) = (vec![0.0; backs.len()], 0.0);
        for half in 0..10 {
            let (sign, stress) = if half % 2 == 0 { (1.0, 350.0) } else { (-1.0, -290.0) };
            strain += sign * branch(backs, &mut x, sign, stress - sign * first);
            let found = at(&records, name, ("time", f64::from(half + 1)), "strain_xx");
            near(found, strain + stress / 200e3, 1e-3);
        }
    }
    let end = |time| at(&records, "one", ("time", time), "strain_xx");
    let step = 0.01 * ((200.0_f64.powi(2) - 90.0_f64.powi(2)) / (200.0_f64.powi(2) - 150.0_f64.powi(2))).ln();
    [3.0, 5.0, 7.0, 9.0].into_iter().for_each(|time| near(end(time) - end(time - 2.0), step, 1e-3));
}

/// The loop at which cycles between two strains settle: `X = C/g tanh(g dep/2)` with the range of plastic strain.
#[test]
fn loops_settle() {
    let steps: Vec<String> = (1..=10)
        .flat_map(|i| {
            let strain = if i % 2 == 1 { 0.006 } else { -0.006 };
            [format!("step.{i}.strain={{ xx = {strain} }}"), format!("step.{i}.stress={{}}")]
        })
        .collect();
    let records = run("chaboche", &steps.iter().map(String::as_str).collect::<Vec<_>>());
    let stress = last(&records, "one", "stress_xx").abs();
    let range = 2.0 * (0.006 - stress / 200e3);
    near(stress - 200.0, 200.0 * (50.0 * range).tanh(), 1e-3);
}

/// Strips at angles to the rolling direction: the flow stress and the ratio of the strains of width and thickness.
#[test]
fn strips_of_a_rolled_sheet() {
    let [f, g, h, n] = [0.3, 0.4, 0.6, 1.1];
    for angle in [0.0_f64, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0] {
        let (sin, cos) = angle.to_radians().sin_cos();
        let set = |key: &str, value: f64| format!("material.angle.hill_coefficients.{key}={value:?}");
        // So stiff and drawn so little that the axes do not turn.
        let sets = [
            set("rolling_x", cos),
            set("rolling_y", -sin),
            set("young", 1e12),
            set("hardening", 0.0),
            "step.1.strain={ xx = 1e-4 }".into(),
        ];
        let records = run("hill", &sets.each_ref().map(String::as_str));
        let [s2, c2] = [sin * sin, cos * cos];
        let square = f * s2 * s2 + g * c2 * c2 + h * (c2 - s2).powi(2) + 2.0 * n * s2 * c2;
        near(last(&records, "angle", "stress_xx"), 200.0 / square.sqrt(), 1e-3);
        let r = (h + (2.0 * n - f - g - 4.0 * h) * s2 * c2) / (f * s2 + g * c2);
        near(last(&records, "angle", "strain_yy") / last(&records, "angle", "strain_zz"), r, 1e-3);
    }
}

/// By ratios the strain of width over that of thickness is as said, and the flow stress along the rolling direction on the
/// curve.
#[test]
fn ratios_of_a_rolled_sheet() {
    for (x, y, r) in [(1.0, 0.0, 1.8), (1.0, 1.0, 1.2), (1.0, -1.0, 1.2), (0.0, 1.0, 2.1)] {
        let set = |key: &str, value: f64| format!("material.sheet.hill.{key}={value:?}");
        let sets =
            [set("rolling_x", x), set("rolling_y", y), set("young", 1e12), "step.1.strain={ xx = 1e-4 }".to_string()];
        let records = run("hill", &sets.each_ref().map(String::as_str));
        near(last(&records, "sheet", "strain_yy") / last(&records, "sheet", "strain_zz"), r, 1e-3);
    }
    let records = run("hill", &[]);
    let p = last(&records, "power", "equivalent_plastic_strain");
    near(last(&records, "power", "stress_xx"), 500.0 * (0.01 + p).powf(0.2), 1e-9);
}
