//! Soils whose water cannot leave, against closed forms.

use super::closed_forms::{at, last, near, run};

/// With water so stiff that the volume stays, sand without dilatancy keeps its effective mean stress: the strength is
/// `q = (6 p sin phi + 6 c cos phi)/(3 - sin phi)` at the pressure of the beginning, and the excess pressure a third of it.
/// Clay follows its undrained path to `M p0 2^(kappa/lambda - 1)`.
#[test]
fn soils_whose_water_stays() {
    let records = run("undrained", &["pore_stiffness=1e9"]);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    let q = (6.0 * 100.0 * sin + 6.0 * cos) / (3.0 - sin);
    near(last(&records, "sand", "von_mises"), q, 1e-5);
    near(last(&records, "sand", "excess_pore_pressure"), q / 3.0, 1e-4);
    // Total stress across stays, so that the effective mean stress is that of the total one and the water's.
    near(last(&records, "sand", "mean_stress") + last(&records, "sand", "excess_pore_pressure"), -100.0, 1e-4);
    near(last(&records, "clay", "von_mises"), 1.2 * 100.0 * 2.0_f64.powf(0.2 - 1.0), 2e-3);
    let dilated = at(&records, "cone", ("strain_yy", -0.1), "excess_pore_pressure");
    assert!(dilated < 0.5 * q / 3.0, "dilatancy draws the water: {dilated}");
}

/// Compressed alike in all directions the water bears its share, `B = K_w/n / (K + K_w/n)` (Skempton 1954).
#[test]
fn water_bears_its_share() {
    let sets = ["step.1.stress={ xx = -110.0, yy = -110.0, zz = -110.0 }", "step.1.strain={}"];
    let records = run("undrained", &sets);
    let bulk = 2e4 / (3.0 * 0.4);
    near(last(&records, "sand", "excess_pore_pressure"), 10.0 * 5e5 / (5e5 + bulk), 1e-3);
}

/// Drained triaxial compression at the lateral pressure 100: with the strength at the plastic shear strain of each increment
/// `q = 2 (100 sin phi + c cos phi)/(1 - sin phi)`, of the cone `q (1/sqrt 3 - eta/3) = 100 eta + xi c`.
#[test]
fn strength_changes_with_plastic_shear() {
    let records = run("soil_hardening", &[]);
    let column = |name: &str, what: &str| -> Vec<f64> {
        records.iter().find(|record| record.name == name).unwrap().column(what).unwrap()
    };
    let changed = |from: f64, to: f64, strain: f64, over: f64| to + (from - to) * (-strain / over).exp();
    let sin = |angle: f64| angle.to_radians().sin();
    for (name, [c, friction], [c_end, friction_end], over) in
        [("dense", [10.0, 40.0], [1.0, 30.0], 0.05), ("loose", [20.0, 15.0], [10.0, 32.0], 0.02)]
    {
        let (strain, q) = (column(name, "plastic_shear_strain"), column(name, "von_mises"));
        assert!(strain.last().unwrap() > &0.1);
        for (strain, q) in strain.iter().zip(&q).filter(|(strain, _)| **strain > 0.0) {
            let (s, c) = (changed(sin(friction), sin(friction_end), *strain, over), changed(c, c_end, *strain, over));
            near(*q, 2.0 * (100.0 * s + c * (1.0 - s * s).sqrt()) / (1.0 - s), 1e-7);
        }
    }
    let cone = |c: f64, angle: f64| {
        let d = 3.0_f64.sqrt() * (3.0 - sin(angle)) / 6.0;
        [sin(angle) / d, c * angle.to_radians().cos() / d]
    };
    let ([eta, strength], [eta_end, strength_end]) = (cone(10.0, 40.0), cone(1.0, 30.0));
    for (strain, q) in column("cone", "plastic_shear_strain").iter().zip(column("cone", "von_mises")) {
        if *strain > 0.0 {
            let eta = changed(eta, eta_end, *strain, 0.05);
            let strength = changed(strength, strength_end, *strain, 0.05);
            near(q, (100.0 * eta + strength) / (1.0 / 3.0_f64.sqrt() - eta / 3.0), 1e-7);
        }
    }
    // The peak of what softens, and the volume that grows as it does.
    let peak = column("dense", "von_mises").into_iter().fold(0.0, f64::max);
    assert!(peak > 1.2 * last(&records, "dense", "von_mises"), "{peak}");
    assert!(last(&records, "dense", "volume_strain") > 0.0);
}

/// Sheared without change of volume, within yield `q = 3 G e`, and at the critical state `M p0 (R/2)^(1 - kappa/lambda)`, `R = 1.2`.
#[test]
fn clay_of_constant_shear_modulus() {
    let records = run("cam_clay_constant_shear", &[]);
    near(at(&records, "clay", ("strain_yy", -0.002), "von_mises"), 3.0 * 5e3 * 0.002, 1e-4);
    near(last(&records, "clay", "von_mises"), 1.2 * 100.0 * 0.6_f64.powf(0.8), 1e-3);
}

/// Pressed alike in all directions the volume changes by `P/K + x ln(P/Pb)`, and sheared the sand fails on its cone, with a cap
/// beyond it.
#[test]
fn a_cap_moves_with_compaction() {
    let records = run("drucker_prager_cap", &[]);
    let bulk = 2e4 / (3.0 * 0.4);
    let exact = -(200.0 / bulk + 0.01 * 2.0_f64.ln());
    near(at(&records, "sand", ("time", 1.0), "volume_strain"), exact, 1e-3);
    near(at(&records, "sand", ("time", 1.0), "cap_pressure"), 200.0, 1e-9);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    near(last(&records, "sand", "von_mises"), 2.0 * (200.0 * sin + cos) / (1.0 - sin), 1e-6);
    let [p, q] = [-last(&records, "sand", "mean_stress"), last(&records, "sand", "von_mises")];
    assert!(last(&records, "sand", "cap_pressure") >= (p * p + q * q).sqrt() * (1.0 - 1e-9));
}

#[test]
fn uniaxial_strength_of_mohr_and_coulomb_is_found_at_the_edge() {
    let text = "version = 1\n\
        material.m.mohr_coulomb = { young = 2e4, poisson = 0.3, cohesion = 10.0, friction = 40.0, dilatancy = 15.0 }\n\
        [[step]]\nincrements = 50\nstrain.yy = ";
    let (s, c) = 40.0_f64.to_radians().sin_cos();
    for (strain, strength) in [(0.01, 20.0 * c / (1.0 + s)), (-0.05, -20.0 * c / (1.0 - s))] {
        let deck = asperity::deck::read_point(&format!("{text}{strain}"), "deck.toml", std::path::Path::new(""), &[]);
        let records = deck.unwrap_or_else(|e| panic!("{}", e.render(false))).run().unwrap();
        let of = |name: &str| {
            let column = records[0].columns.iter().position(|column| column == name).unwrap();
            records[0].rows.last().unwrap()[column]
        };
        assert!((of("stress_yy") / strength - 1.0).abs() < 1e-9, "{}", of("stress_yy"));
        assert!((of("strain_xx") - of("strain_zz")).abs() < 1e-12);
    }
}
