//! The decks of `cases/point` against closed forms.

use super::samples::{decks, load};
use asperity::point::Record;

/// Runs a deck of `cases/point`.
pub fn run(deck: &str, sets: &[&str]) -> Vec<Record> {
    let path = decks().into_iter().find(|path| path.file_stem().is_some_and(|stem| stem == deck));
    load(&path.unwrap_or_else(|| panic!("no deck {deck}")), sets).run().unwrap()
}

/// A column of a material where another column first has (or crosses) a value, by straight lines.
pub fn at(records: &[Record], material: &str, (x, value): (&str, f64), column: &str) -> f64 {
    let record = records.iter().find(|record| record.name == material).unwrap();
    let (x, y) = (record.column(x).unwrap(), record.column(column).unwrap());
    let near = |i: &usize| (x[*i] - value).abs() <= 1e-9 * value.abs();
    if let Some(i) = (0..x.len()).find(near) {
        return y[i];
    }
    let crossing = |i: &usize| (x[*i] - value) * (x[i + 1] - value) <= 0.0;
    let i = (0..x.len() - 1).find(crossing).expect("the value is reached");
    y[i] + (y[i + 1] - y[i]) * (value - x[i]) / (x[i + 1] - x[i])
}

pub fn last(records: &[Record], material: &str, column: &str) -> f64 {
    let record = records.iter().find(|record| record.name == material).unwrap();
    *record.column(column).unwrap().last().unwrap()
}

#[track_caller]
pub fn near(found: f64, wanted: f64, ratio: f64) {
    assert!((found / wanted - 1.0).abs() < ratio, "{found} instead of {wanted}: off by {:.1e}", found / wanted - 1.0);
}

#[test]
fn every_deck_can_be_run() {
    for path in decks() {
        let records = load(&path, &[]).run().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let finite = records.iter().flat_map(|r| r.rows.iter().flatten()).all(|x| x.is_finite());
        assert!(finite, "{}", path.display());
    }
}

/// Jaumann's rate gives `s12 = G sin g`, `s11 = -s22 = G (1 - cos g)`; the error is of second order in the increment.
#[test]
fn elastic_simple_shear() {
    let [coarse, fine] = [100, 200].map(|n| run("elastic", &[&format!("step.1.increments={n}")]));
    for g in [1.0_f64, 2.0, 3.0] {
        for (column, exact) in [("stress_xy", g.sin()), ("stress_xx", 1.0 - g.cos()), ("stress_yy", g.cos() - 1.0)] {
            let [a, b] = [&coarse, &fine].map(|records| at(records, "elastic", ("strain_xy", g), column) - exact);
            assert!(a.abs() < 3e-4, "{column} at {g} is off by {a}");
            assert!((b - 0.25 * a).abs() < 0.02 * a.abs() + 1e-9, "{column} at {g}: {a}, then {b}");
        }
    }
}

/// With `tan b = g/2` the polar rotation is `b`, and the rate of Green and Naghdi gives (Dienes 1979)
/// `s12 = 2 G cos 2b (2 b - 2 tan 2b ln cos b - tan b)`, `s11 = -s22 = 4 G (cos 2b ln cos b + b sin 2b - sin^2 b)`.
/// The stress never turns back, as Jaumann's does from a shear of pi/2.
#[test]
fn elastic_simple_shear_in_the_polar_frame() {
    let run = |n| run("elastic", &[&format!("step.1.increments={n}"), "rate=\"green-naghdi\""]);
    let [coarse, fine] = [100, 200].map(run);
    for g in [1.0_f64, 2.0, 3.0] {
        let b = (0.5 * g).atan();
        let (sin, cos) = (2.0 * b).sin_cos();
        let along = 4.0 * (cos * b.cos().ln() + b * sin - b.sin().powi(2));
        let shear = 2.0 * (cos * (2.0 * b - b.tan()) - 2.0 * sin * b.cos().ln());
        for (column, exact) in [("stress_xy", shear), ("stress_xx", along), ("stress_yy", -along)] {
            let [a, b] = [&coarse, &fine].map(|records| at(records, "elastic", ("strain_xy", g), column) - exact);
            assert!(a.abs() < 3e-4, "{column} at {g} is off by {a}");
            assert!((b - 0.25 * a).abs() < 0.02 * a.abs() + 1e-9, "{column} at {g}: {a}, then {b}");
        }
    }
    let shear = |g| at(&fine, "elastic", ("strain_xy", g), "stress_xy");
    assert!(shear(3.0) > shear(2.0) && shear(2.0) > shear(1.0));
}

/// The logarithmic rate makes a linear law one of the logarithmic strain, in increments of any length: with
/// `sinh e = g/2` it gives `s12 = 2 G e / cosh e`, `s11 = -s22 = 2 G e tanh e`.
#[test]
fn elastic_simple_shear_by_the_logarithmic_rate() {
    for increments in [1, 7, 100] {
        let records = run("elastic", &[&format!("step.1.increments={increments}"), "rate=\"logarithmic\""]);
        let e = (0.5 * last(&records, "elastic", "strain_xy")).asinh();
        let (shear, along) = (2.0 * e / e.cosh(), 2.0 * e * e.tanh());
        for (column, exact) in [("stress_xy", shear), ("stress_xx", along), ("stress_yy", -along)] {
            assert!((last(&records, "elastic", column) - exact).abs() < 1e-12, "{increments}: {column}");
        }
    }
}

/// A back stress in simple shear, with hardly any elasticity: by the default rate it is that of the logarithmic strain,
/// `C 2/3 e / cosh e`, and never swings; in Jaumann's frame it turns over.
#[test]
fn a_back_stress_does_not_swing() {
    let steel = "material.steel.von_mises={ young = 210e3, poisson = 0.3, yield_stress = 1.0, kinematic = 200.0 }";
    let path = "step.1.strain={ xx = 0.0, yy = 0.0, zz = 0.0, xy = 8.0 }";
    let sheared = |more: &[&str]| run("von_mises", &[&[steel, path, "step.1.increments=800"], more].concat());
    let records = sheared(&[]);
    for g in [0.5, 1.57, 3.0, 4.0, 8.0_f64] {
        let e = (0.5 * g).asinh();
        let back = at(&records, "steel", ("strain_xy", g), "back_stress_xy");
        near(back, 2.0 / 3.0 * 200.0 * e / e.cosh(), 0.01);
    }
    let jaumann = sheared(&["rate=\"jaumann\""]);
    assert!(at(&jaumann, "steel", ("strain_xy", 4.0), "back_stress_xy") < 0.0);
}

/// Perfectly plastic under Jaumann's rate: `s11` tends to `k^2/G` and `s12` to `sqrt(k^2 - s11^2)`, extrapolated to
/// increments of no length.
#[test]
fn plastic_simple_shear() {
    let steel = "material.steel.von_mises={ young = 210e3, poisson = 0.3, yield_stress = 400.0 }";
    let path = "step.1.strain={ xx = 0.0, yy = 0.0, zz = 0.0, xy = 0.1 }";
    let [coarse, fine] = [2000, 4000].map(|n| run("von_mises", &[steel, path, &format!("step.1.increments={n}")]));
    for (column, exact) in [("stress_xx", 0.6603), ("stress_xy", 230.9392)] {
        let [a, b] = [&coarse, &fine].map(|records| last(records, "steel", column));
        assert!((2.0 * b - a - exact).abs() < 1e-4, "{column}: {} instead of {exact}", 2.0 * b - a);
    }
}

#[test]
fn rubber_in_tension() {
    let l = 1.0_f64.exp();
    let records = run("neo_hookean", &["material.neo_hookean.neo_hookean.bulk=1e7", "material.ogden.ogden.bulk=1e7"]);
    for material in ["neo_hookean", "ogden"] {
        near(last(&records, material, "stress_xx"), l * l - 1.0 / l, 2e-6);
    }
    let (records, l) = (run("ogden", &["material.rubber.ogden.bulk=1e7"]), 1.8_f64.exp());
    let terms = [[0.63, 1.3], [0.0012, 5.0], [-0.01, -2.0]];
    let exact: f64 = terms.iter().map(|[mu, alpha]| mu * (l.powf(*alpha) - l.powf(-0.5 * alpha))).sum();
    near(last(&records, "rubber", "stress_xx"), exact, 2e-6);
}

/// Slopes of the energies of `rubbers.toml` and `rubber_shear.toml` along both invariants, by their formulas.
fn slopes(material: &str, first: f64) -> [f64; 2] {
    let x = first - 3.0;
    match material {
        "mooney" => [0.3, 0.2],
        "yeoh" => [0.5 - 0.02 * x + 6e-4 * x * x, 0.0],
        _ => {
            let y = first / 9.0;
            let series =
                0.5 + y / 10.0 + 11.0 / 350.0 * y * y + 19.0 / 1750.0 * y.powi(3) + 519.0 / 134_750.0 * y.powi(4);
            [0.5 * series, 0.0]
        }
    }
}

#[test]
fn rubbers_in_tension_and_shear() {
    let (drawn, sheared) = (run("rubbers", &[]), run("rubber_shear", &[]));
    for material in ["mooney", "yeoh", "chains"] {
        let l = 1.0_f64.exp();
        let [along, across] = slopes(material, l * l + 2.0 / l);
        near(last(&drawn, material, "stress_xx"), 2.0 * (l * l - 1.0 / l) * (along + across / l), 1e-4);
        let g: f64 = 1.5;
        let [along, across] = slopes(material, 3.0 + g * g);
        let [xx, yy, zz, xy] = ["xx", "yy", "zz", "xy"].map(|c| last(&sheared, material, &format!("stress_{c}")));
        near(xy, 2.0 * (along + across) * g, 1e-12);
        near(xx - yy, g * xy, 1e-12);
        assert!((zz - yy - 2.0 * across * g * g).abs() < 1e-12, "{material}: {zz} {yy}");
    }
}

#[test]
fn billet_steel() {
    let records = run("von_mises", &[]);
    for (strain, stress) in [(0.01, 701.947), (0.1, 728.907), (0.5, 848.727), (1.0, 998.502)] {
        near(at(&records, "steel", ("strain_xx", strain), "stress_xx"), stress, 5e-6);
    }
    let records = run("von_mises_confined", &[]);
    // The strain yields at 0.00455, s = 1225; beyond, the modulus is 166799.83.
    near(last(&records, "steel", "stress_xx"), -3802.06, 2e-6);
    near(last(&records, "steel", "equivalent_plastic_strain"), 0.0102866, 5e-6);
    near(last(&records, "steel", "von_mises"), 703.086, 1e-6);
    near(at(&records, "steel", ("strain_xx", -0.0044), "stress_xx"), -0.0044 * 1225.0 / 0.00455, 1e-5);
}

#[test]
fn flow_curves() {
    let records = run("von_mises_swift", &[]);
    let p = last(&records, "steel", "equivalent_plastic_strain");
    near(last(&records, "steel", "stress_xx"), 500.0 * (0.01 + p).powf(0.2), 1e-10);
    let records = run("von_mises_table", &[]);
    let p = last(&records, "steel", "equivalent_plastic_strain");
    near(last(&records, "steel", "stress_xx"), 350.0 + 125.0 * (p - 0.1), 1e-10);
}

/// The first quarter cycle of Armstrong and Frederick's law: X = C/gamma (1 - exp(-gamma p)).
#[test]
fn back_stress_saturates() {
    let finely = ["step.1.increments=2000", "step.2.increments=20", "step.3.increments=20"];
    let records = run("von_mises_cyclic", &finely);
    let p = at(&records, "steel", ("strain_xx", 0.02), "equivalent_plastic_strain");
    near(at(&records, "steel", ("strain_xx", 0.02), "stress_xx"), 200.0 + 200.0 * (1.0 - (-100.0 * p).exp()), 1e-3);
    let p = at(&records, "voce", ("strain_xx", 0.02), "equivalent_plastic_strain");
    near(at(&records, "voce", ("strain_xx", 0.02), "stress_xx"), 200.0 + 200.0 * (1.0 - (-50.0 * p).exp()), 1e-9);
}

#[test]
fn perzyna_and_norton() {
    near(last(&run("perzyna", &[]), "steel", "stress_xx"), 770.0, 1e-8);
    let records = run("norton_hoff", &[]);
    for (time, stress) in [(1.0, 181.404), (10.0, 105.333), (100.0, 59.4374), (1000.0, 33.4357)] {
        near(at(&records, "bar", ("time", time), "stress_xx"), stress, 1e-3);
    }
}

/// `q` at a lateral pressure of 100: the outer cone (Mohr-Coulomb), the inner one, and the plane-strain one without
/// dilatancy and with associated flow.
#[test]
fn cones() {
    let records = run("drucker_prager", &["material.plane.drucker_prager_plane_strain.dilatancy=0"]);
    near(last(&records, "outer", "von_mises"), 234.641, 1e-5);
    near(last(&records, "inner", "von_mises"), 140.785, 1e-5);
    // With psi = 0: eta = sin phi, xi = cos phi, eta_b = 0, so q/sqrt(3) = c cos phi + (100 + q/3) sin phi.
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let q = (10.0 * cos + 100.0 * sin) / (1.0 / 3.0_f64.sqrt() - sin / 3.0);
    near(last(&records, "plane", "von_mises"), q, 1e-9);
    let records = run("drucker_prager", &["material.plane.drucker_prager_plane_strain.dilatancy=30"]);
    near(last(&records, "plane", "von_mises"), 135.081, 1e-5);
}

#[test]
fn mohr_and_coulomb_in_compression() {
    let records = run("mohr_coulomb", &[]);
    near(last(&records, "soil", "von_mises"), 234.641, 1e-5);
    near(last(&records, "clay", "von_mises"), 80.0, 1e-12);
}

/// Normally consolidated, undrained: p and the plastic shear strain at ratios `eta = q/p`, then the critical state.
#[test]
fn cam_clay_undrained() {
    let records = run("cam_clay_undrained", &["step.1.increments=20000"]);
    let record = &records[0];
    let [p, q, shear] = ["mean_stress", "von_mises", "plastic_shear_strain"].map(|name| record.column(name).unwrap());
    let eta = |i: usize| -q[i] / p[i];
    for (wanted, pressure, strain) in
        [(0.3, 95.266, None), (0.6, 83.651, None), (0.9, 69.975, Some(0.0087854)), (1.1, 61.389, Some(0.0220213))]
    {
        let i = (0..p.len() - 1).find(|&i| eta(i + 1) >= wanted).unwrap();
        let part = (wanted - eta(i)) / (eta(i + 1) - eta(i));
        near(p[i] + part * (p[i + 1] - p[i]), -pressure, 2e-5);
        if let Some(strain) = strain {
            near(shear[i] + part * (shear[i + 1] - shear[i]), strain, 2e-3);
        }
    }
    near(last(&records, "clay", "mean_stress"), -57.435, 1e-5);
    near(last(&records, "clay", "von_mises"), 68.922, 1e-5);
}

#[test]
fn cam_clay_drained_and_confined() {
    let records = run("cam_clay_drained", &["step.1.increments=4000"]);
    near(last(&records, "normal", "mean_stress"), -166.667, 1e-4);
    near(last(&records, "normal", "von_mises"), 200.0, 2e-4);
    let peak = records[1].column("von_mises").unwrap().into_iter().fold(0.0, f64::max);
    near(peak, 238.746, 1e-3);
    let records = run("cam_clay_oedometer", &[]);
    near(last(&records, "clay", "stress_xx") / last(&records, "clay", "stress_yy"), 0.6476, 1e-4);
}

/// Hydrostatic tension: the surface p/s = 2/3 acosh((1 + q3 f^2)/(2 q1 f)) with f = 1 - (1 - f0) exp(-ev).
/// The same with matrices that harden, each on its own curve.
#[test]
fn porous_metals_that_harden_follow_the_curve_of_their_matrix() {
    let records = run("gurson_curves", &[]);
    let swift: &dyn Fn(f64) -> f64 = &|em| 500.0 * (0.01 + em).powf(0.2);
    let table: &dyn Fn(f64) -> f64 = &|em| if em < 0.1 { 300.0 + 500.0 * em } else { 350.0 + 250.0 * (em - 0.1) };
    for (name, curve) in [("power", swift), ("measured", table)] {
        let [f, em, ev] =
            ["porosity", "matrix_plastic_strain", "plastic_volume_strain"].map(|c| last(&records, name, c));
        near(f, 1.0 - 0.995 * (-ev).exp(), 1e-4);
        assert!(em > 0.2, "{em}");
        near(last(&records, name, "mean_stress"), curve(em) / 1.5 * ((1.0 + 2.25 * f * f) / (3.0 * f)).acosh(), 1e-9);
    }
}

#[test]
fn gurson_in_hydrostatic_tension() {
    let records = run("gurson", &["step.1.increments=4000"]);
    let peak = records[0].column("mean_stress").unwrap().into_iter().fold(0.0, f64::max);
    assert!(peak < 978.571, "{peak} beyond first yield");
    near(peak, 978.570, 5e-3);
    for (volume, p) in [(0.014344, 760.180), (0.052882, 504.422), (0.102172, 380.051)] {
        near(at(&records, "porous", ("volume_strain", volume), "mean_stress"), p, 5e-4);
    }
    near(at(&records, "porous", ("volume_strain", 0.201463), "mean_stress"), 255.995, 5e-4);
}

/// The undrained strength of overconsolidated clay, `q = M p0 (R/2)^(1 - kappa/lambda)` at the critical state.
#[test]
fn cam_clay_undrained_overconsolidated() {
    for (ratio, q) in [(1.0, 68.922), (2.0, 120.0), (4.0, 208.932)] {
        let consolidated = format!("material.clay.modified_cam_clay.preconsolidation={:?}", 100.0 * ratio);
        let path = "step.1.strain={ xx = 0.2, yy = -0.4, zz = 0.2 }";
        near(last(&run("cam_clay_undrained", &[&consolidated, path]), "clay", "von_mises"), q, 1e-3);
    }
}

/// Jaeger's curve: the strength by the angle of the joints' normal from the axis; beyond that of the friction the joints
/// slip, near both ends the rock itself fails.
#[test]
fn fractured_rock_in_compression() {
    let strength = |normal: f64, lateral: f64| {
        let (sin, cos) = normal.to_radians().sin_cos();
        let joint = format!("material.rock.ubiquitous_joint.normal_x={sin:?}");
        let other = format!("material.rock.ubiquitous_joint.normal_y={cos:?}");
        let stress = format!("initial_stress={{ xx = {l:?}, yy = {l:?}, zz = {l:?} }}", l = -lateral);
        // Stiff, and compressed so little that the joints hardly turn.
        let stiff = ["material.rock.ubiquitous_joint.young=1e8", "step.1.strain={ yy = -1e-6 }"];
        last(&run("ubiquitous_joint", &[&joint, &other, &stress, stiff[0], stiff[1]]), "rock", "von_mises")
    };
    let intact = 8.5780;
    let curve = [(0.0, intact), (30.0, intact), (40.0, 6.5104), (45.0, 4.7321), (50.0, 3.9392), (60.0, 3.4641)];
    for (normal, exact) in curve.into_iter().chain([(75.0, 4.7321), (80.0, 6.5104)]) {
        let found = strength(normal, 0.0);
        assert!((found / exact - 1.0).abs() < 2e-5, "{normal} degrees: {found} instead of {exact}");
    }
    near(strength(60.0, 5.0) + 5.0, 18.4641, 2e-5);
    near(strength(0.0, 5.0) + 5.0, 31.5726, 2e-5);
}
