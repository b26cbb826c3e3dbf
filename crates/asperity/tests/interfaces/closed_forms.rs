//! The decks of `cases/interface` against closed forms.

use super::samples::{decks, load, run};
use asperity::deck::read_interface;
use asperity::point::Record;

fn of<'a>(records: &'a [Record], name: &str) -> &'a Record {
    records.iter().find(|record| record.name == name).unwrap()
}

fn column(records: &[Record], name: &str, column: &str) -> Vec<f64> {
    of(records, name).column(column).unwrap()
}

fn last(records: &[Record], name: &str, of: &str) -> f64 {
    *column(records, name, of).last().unwrap()
}

/// A column where another column first has a value.
fn at(records: &[Record], name: &str, (x, value): (&str, f64), y: &str) -> f64 {
    let (x, y) = (column(records, name, x), column(records, name, y));
    let i = x.iter().position(|x| (x - value).abs() <= 1e-9 * value.abs().max(1e-12)).expect("the value is reached");
    y[i]
}

#[track_caller]
fn near(found: f64, wanted: f64, ratio: f64) {
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

#[test]
fn dry_friction_smooth_and_glued() {
    let records = run("coulomb", &[]);
    let (shear, dissipated) = (column(&records, "dry", "shear_s"), column(&records, "dry", "dissipated_energy"));
    near(shear[101], 30.0, 1e-12);
    near(shear[201], -30.0, 1e-12);
    // Slip 0.01 less 0.003 of elastic slip at 30, then 0.02 less 0.006.
    near(dissipated[101], 30.0 * 0.007, 1e-9);
    near(dissipated[201], 30.0 * 0.021, 1e-9);
    near(last(&records, "dry", "shear"), 30.0, 1e-12);
    assert!(column(&records, "smooth", "shear").iter().all(|&tau| tau == 0.0));
    near(column(&records, "glued", "shear_s")[101], 100.0, 1e-12);
}

/// Bonded at a tension of 4.9, where the shear strength is ten times what is left of the tensile one, 5; broken at 6; then without
/// cohesion.
#[test]
fn a_bond_breaks_once() {
    let records = run("cohesive", &[]);
    let (p, tau) = (column(&records, "joint", "pressure"), column(&records, "joint", "shear"));
    near(p[100], 10.0, 1e-12);
    near(tau[100], 0.6 * 10.0 + 4.0, 1e-9);
    near(p[200], -4.9, 1e-9);
    near(tau[200], 10.0 * (5.0 - 4.9), 1e-9);
    assert_eq!((p[300], tau[300]), (0.0, 0.0));
    near(last(&records, "joint", "shear"), 6.0, 1e-9);
    assert_eq!(last(&records, "joint", "bond_broken"), 1.0);
}

/// Behind a wall of stiffness k: `p = p_0 + k_e psi_0 s_c (1 - exp(-s / s_c))` and `tau = phi p + c` with
/// `1/k_e = 1/k + 1/K_p`, in any number of increments; the dilation tends to `psi_0 s_c`.
#[test]
fn constant_normal_stiffness() {
    for increments in [20, 200] {
        let records = run("dilatant", &[&format!("step.2.increments={increments}")]);
        let stiffness = 1.0 / (1.0 / 2e4 + 1.0 / 1e6);
        let [p, tau, s] = ["pressure", "shear", "slip_path"].map(|name| column(&records, "joint", name));
        for i in 2..p.len() {
            let exact = 100.0 + stiffness * 0.3 * 2e-3 * (1.0 - (-s[i] / 2e-3).exp());
            near(p[i], exact, 1e-10);
            near(tau[i], 0.6 * exact + 10.0, 1e-10);
        }
        near(last(&records, "joint", "dilation"), 0.3 * 2e-3, 1e-4);
    }
}

#[test]
fn interfaces_like_cam_clay_reach_their_critical_state() {
    let records = run("cam_clay", &[]);
    for name in ["perfect", "printed"] {
        near(last(&records, name, "pressure"), 50.0, 1e-6);
        near(last(&records, name, "shear"), 40.0, 1e-6);
        near(last(&records, name, "closure"), 0.02 - 0.05, 1e-6);
    }
    // With tension the centre is at (p_c - p_t) / 2, and the top M (p_c + p_t) / 2 above it.
    near(last(&records, "bonded", "pressure"), 45.0, 1e-6);
    near(last(&records, "bonded", "shear"), 44.0, 1e-6);
    // Hardened: p = p_c / 2, p_c = 100 exp(w / chi), p = K_p (u - w).
    let (p, w) = (last(&records, "hardening", "pressure"), last(&records, "hardening", "closure"));
    near(p, 50.0 * (w / 0.02).exp(), 1e-5);
    near(p, 1e3 * (0.02 - w), 1e-9);
    near(last(&records, "hardening", "shear"), 0.8 * p, 1e-5);
}

#[test]
fn shear_limited_friction() {
    let records = run("shear_limited", &["step.2.increments=490"]);
    for (name, values) in [("orowan", [60.0, 100.0]), ("smooth", [53.7050, 90.5148]), ("shaw", [51.4496, 83.2050])] {
        for (pressure, value) in [200.0, 500.0].into_iter().zip(values) {
            near(at(&records, name, ("pressure", pressure), "shear"), value, 2e-6);
        }
    }
    near(last(&records, "factor", "shear"), 60.0, 1e-12);
}

/// `mu = mu_1 + (mu_0 - mu_1) exp(-s / s_c)`; the same over the work of friction.
#[test]
fn friction_that_depends_on_slip_and_work() {
    let records = run("decay", &[]);
    for (name, [first, end]) in [("rest", [0.5, 0.3]), ("softening", [0.5, 0.3]), ("hardening", [0.1, 0.3])] {
        let (s, tau) = (column(&records, name, "slip_path"), column(&records, name, "shear"));
        for i in [20, 60, 201] {
            near(tau[i], 100.0 * (end + (first - end) * (-s[i] / 0.01).exp()), 1e-9);
        }
    }
    let (work, tau) = (column(&records, "worn", "friction_work"), column(&records, "worn", "shear"));
    for i in [20, 60, 201] {
        near(tau[i], 100.0 * (0.3 - 0.2 * (-work[i] / 0.3).exp()), 1e-9);
    }
    // Turned back, the one that heals begins at its static value again, the other does not.
    let peak = |name: &str| column(&records, name, "shear")[202..].iter().fold(0.0, |m: f64, &x| m.max(x));
    assert!(peak("rest") > 49.0 && peak("softening") < 30.5, "{} {}", peak("rest"), peak("softening"));
}

#[test]
fn friction_that_depends_on_velocity() {
    let records = run("velocity", &[]);
    for (time, velocity) in [(2.0, 0.05_f64), (3.0, 0.1), (4.0, 0.4)] {
        let fade = (-velocity / 0.1).exp();
        near(at(&records, "brake", ("time", time), "shear"), 20.0 + 10.0 * fade, 1e-9);
        near(at(&records, "oil", ("time", time), "shear"), 20.0 - 10.0 * fade, 1e-9);
    }
}

/// Below the criterion the slip is not unique, and this is said.
#[test]
fn stick_slip_is_named() {
    let path = decks().into_iter().find(|path| path.ends_with("decay.toml")).unwrap();
    let text = load(&path, &["penalty=1.5e3"]).run().unwrap_err().to_string();
    assert!(text.contains("stick-slip, the slip is not unique") && text.contains("tangential penalty"), "{text}");
}

/// Steady 0.6, direct effect 0.01 ln 10 to 0.6230259, steady 0.5884871; at a slip of D_c 0.610404 (ageing) and
/// 0.601193 (slip).
#[test]
fn velocity_step_of_a_gouge() {
    let records = run("rate_and_state", &["step.3.increments=1000"]);
    let slip_law = |d: f64| 0.5884871 + 0.0345388 * (-d).exp();
    let ageing = |d: f64| 0.6 + 0.0230259 + 0.015 * (0.1 + 0.9 * (-d).exp()).ln();
    let curves: [(&str, &dyn Fn(f64) -> f64); 2] = [("ageing", &ageing), ("slip", &slip_law)];
    for (name, exact) in curves {
        near(at(&records, name, ("time", 101.0), "shear"), 6e6, 1e-6);
        for slip in [0.5, 1.0, 2.0, 5.0_f64] {
            let mu = at(&records, name, ("slip", 1e-4 + slip * 1e-5), "shear") / 1e7;
            near(mu, exact(slip), 1e-5);
        }
        near(last(&records, name, "shear"), 5.884871e6, 2e-5);
    }
    near(at(&records, "ageing", ("slip", 1.1e-4), "shear"), 6.10404e6, 1e-5);
    near(at(&records, "slip", ("slip", 1.1e-4), "shear"), 6.01193e6, 1e-5);
}

/// From rest `tanh(s / e)`; back elastic to no stress, then along the same curve.
#[test]
fn regularised_friction_follows_the_slip() {
    for increments in [10, 100, 1000] {
        let more = [2, 3].map(|step| format!("step.{step}.increments={increments}"));
        let records = run("oden_pires", &[&more[0], &more[1]]);
        for (name, length) in [("smooth", 1e-4_f64), ("coarse", 1e-3)] {
            let shear = column(&records, name, "shear_s");
            near(shear[1 + increments], 30.0 * (0.01 / length).tanh(), 1e-9);
            near(*shear.last().unwrap(), -30.0 * (0.01 / length - (0.01 / length).tanh()).tanh(), 1e-9);
        }
    }
}

/// A bond under a prescribed pressure: up to its tension it is found at any part of it, beyond it out of reach.
#[test]
fn a_bond_is_drawn_up_to_its_tension() {
    for (tension, steps) in [(0.3, 100), (1.5, 1), (4.9, 1), (4.9, 7), (4.999, 100)] {
        let text = format!(
            "version = 1\ninterface.joint.cohesive = {{ friction = 0.6, cohesion = 4.0, tension = 5.0 }}\npenalty = 1e4\n\
             [[step]]\npressure = -{tension}\nincrements = {steps}\n[[step]]\npressure = 10.0\nincrements = {steps}\n"
        );
        let records =
            read_interface(&text, "deck.toml", &[]).unwrap().run().unwrap_or_else(|e| panic!("{tension}: {e}"));
        near(column(&records, "joint", "pressure")[steps], -tension, 1e-9);
        near(last(&records, "joint", "pressure"), 10.0, 1e-9);
        assert_eq!(last(&records, "joint", "bond_broken"), 0.0);
    }
    let beyond = "version = 1\ninterface.joint.cohesive = { friction = 0.6, cohesion = 4.0, tension = 5.0 }\npenalty = 1e4\n\
                  [[step]]\npressure = -5.1\nincrements = 51\n";
    let (records, stopped) = read_interface(beyond, "deck.toml", &[]).unwrap().follow();
    assert!(stopped.unwrap().to_string().contains("out of reach"));
    // What was reached is there.
    near(last(&records, "joint", "pressure"), -5.0, 1e-9);
    assert_eq!(records[0].rows.len(), 51);
}
