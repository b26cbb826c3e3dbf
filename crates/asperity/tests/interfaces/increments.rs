//! What must not depend on the length of increments, whatever the scheme.

use asperity::declare::find;
use asperity::integrate::{Scheme, Update};
use asperity::interface::laws::ALL;
use asperity::interface::{Interface, Motion, Past};

const PENALTIES: [f64; 2] = [1e4, 1e4];
const PRESSURE: f64 = 100.0;

fn law(name: &str, numbers: &[f64]) -> Box<dyn Interface> {
    (find(ALL, name).unwrap().build)(numbers).unwrap()
}

fn by(name: &str, numbers: &[f64], scheme: Scheme) -> Box<dyn Interface> {
    law(name, numbers).with_update(Update { scheme, substeps: 1, tolerance: None }).unwrap()
}

/// The shear stress at the end of a way under constant pressure, each part of it in `increments` over the time `time`.
fn slid(law: &dyn Interface, way: &[[f64; 2]], increments: usize, time: f64) -> [f64; 2] {
    let penetration = PRESSURE / PENALTIES[0];
    let (mut shear, mut pressure) = ([0.0; 2], 0.0);
    let mut vars = vec![0.0; law.variables().iter().map(|variable| variable.len()).sum()];
    law.initial(&mut vars);
    let still = (&[0.0; 2], 1);
    for (slip, count) in std::iter::once(still).chain(way.iter().map(|slip| (slip, increments))) {
        for _ in 0..count {
            let old = vars.clone();
            let past = Past {
                penalty: PENALTIES[0],
                tangential_penalty: PENALTIES[1],
                penetration: pressure / PENALTIES[0],
                pressure,
                shear,
                vars: &old,
                dt: time / count as f64,
            };
            let motion = Motion { penetration, slip: slip.map(|s| s / count as f64) };
            let response = law.respond(super::samples::numbers(&motion), &past, &mut vars).unwrap();
            (shear, pressure) = (response.shear(), response.pressure());
        }
    }
    shear
}

const STATIC_KINETIC: [f64; 3] = [0.5, 0.3, 0.01];

/// Friction after the irreversible slip `s` from rest.
fn after(s: f64) -> f64 {
    PRESSURE * (0.3 + 0.2 * (-s / 0.01).exp())
}

#[test]
fn the_midpoint_rule_forgets_rest() {
    let law = by("static_kinetic", &STATIC_KINETIC, Scheme::Midpoint(0.5));
    for increments in [20, 200, 2000] {
        let [shear, _] = slid(law.as_ref(), &[[0.1, 0.0]], increments, 1.0);
        let exact = after(0.1 - shear / PENALTIES[1]);
        assert!((shear / exact - 1.0).abs() < 1e-3, "{increments}: {shear} instead of {exact}");
    }
}

/// Turned back, the elastic path leads inside the limit: friction begins at its static value again.
#[test]
fn reversal_is_rest_in_increments_of_any_length() {
    for scheme in [Scheme::BackwardEuler, Scheme::TwoStep, Scheme::Midpoint(0.5)] {
        let law = by("static_kinetic", &STATIC_KINETIC, scheme);
        for increments in [1, 2, 7, 1000] {
            let [before, _] = slid(law.as_ref(), &[[0.1, 0.0]], increments, 1.0);
            let [shear, _] = slid(law.as_ref(), &[[0.1, 0.0], [-0.02, 0.0]], increments, 1.0);
            let exact = -after(0.02 - (before - shear) / PENALTIES[1]);
            // In an increment that turns back and slips again the others are of first order.
            let near = if scheme == Scheme::BackwardEuler || increments >= 7 { 1e-6 } else { 0.12 };
            assert!((shear / exact - 1.0).abs() < near, "{scheme:?} {increments}: {shear} instead of {exact}");
        }
    }
}

/// After a quarter turn, in increments many times as long as the elastic slip, which turn the stress at once.
#[test]
fn the_midpoint_rule_turns_the_stress_with_the_slip() {
    let laws: [(&str, &[f64]); 5] = [
        ("coulomb", &[0.3]),
        ("cohesive", &[0.2, 10.0, 0.0]),
        ("orowan", &[0.3, 100.0, 1.0]),
        ("shear_factor", &[60.0, 0.5]),
        ("slip_dependent", &[0.3, 0.3, 1.0]),
    ];
    for (name, numbers) in laws {
        let law = by(name, numbers, Scheme::Midpoint(0.5));
        for increments in [1, 2, 5, 20, 1000] {
            let shear = slid(law.as_ref(), &[[0.06, 0.0], [0.0, 0.06]], increments, 1.0);
            let miss = shear[0].hypot(shear[1] - 30.0);
            assert!(miss < 1e-3 * 30.0, "{name} {increments}: {shear:?}");
        }
    }
}

#[test]
fn regularised_friction_keeps_its_shear() {
    let law = law("oden_pires", &[0.3, 1e-4, 0.0]);
    for increments in [1, 10, 100, 1000] {
        let [shear, _] = slid(law.as_ref(), &[[0.01, 0.0], [0.0, 0.0]], increments, 1.0);
        assert!((shear - 30.0).abs() < 1e-9, "{increments}: {shear}");
    }
}

/// Friction that falls with the velocity: ever shorter increments are followed, to the friction of the velocity.
#[test]
fn falling_friction_is_followed_in_short_increments() {
    let numbers = [0.3, 0.2, 0.1, 0.0];
    for scheme in [Scheme::BackwardEuler, Scheme::TwoStep] {
        let law = by("velocity_dependent", &numbers, scheme);
        for increments in [10, 1000, 100_000] {
            let [shear, _] = slid(law.as_ref(), &[[0.4, 0.0]], increments, 1.0);
            let exact = PRESSURE * (0.2 + 0.1 * (-4.0_f64).exp());
            assert!((shear / exact - 1.0).abs() < 1e-6, "{scheme:?} {increments}: {shear} instead of {exact}");
        }
    }
}

#[test]
fn what_a_law_cannot_serve_is_refused() {
    let midpoint = Update { scheme: Scheme::Midpoint(0.5), substeps: 1, tolerance: None };
    let gouge = [0.6, 0.01, 0.015, 1e-5, 1e-6, 1.0, 0.0];
    let laws: [(&str, &[f64]); 3] =
        [("velocity_dependent", &[0.3, 0.2, 0.1, 0.0]), ("rate_and_state", &gouge), ("rate_and_state_slip", &gouge)];
    for (name, numbers) in laws {
        let why = law(name, numbers).with_update(midpoint).err().unwrap();
        assert!(why.contains("two-step"), "{name}: {why}");
    }
    for name in ["frictionless", "sticking"] {
        assert!(law(name, &[]).with_update(midpoint).err().unwrap().contains("nothing to sub-step"), "{name}");
    }
    let why = law("oden_pires", &[0.3, 1e-4, 0.0]).with_update(midpoint).err().unwrap();
    assert!(why.contains("nothing to sub-step"), "{why}");
}
