//! Creep, relaxation and ratchetting with nothing said of increments or sub-steps, against closed forms and a fine run.

mod support;

use asperity::model::Model;
use asperity::solve::RunOptions;
use support::{Keep, columns, model, run};

/// A round bar of radius 5, a material that it is made of, and steps after the first, in which its feet come to stand.
fn bar(material: &str, first: &str, others: &str) -> String {
    format!(
        "version = 1
        space = \"axisymmetric\"
        mesh.part.t.rectangle = {{ from = [0.0, 0.0], to = [5.0, 10.0], cells = [2, 2], cell = \"quad4\" }}
        material.m.{material}
        body.t = {{ material = \"m\", strain = \"small\" }}
        [[step]]
        displacement.\"t.left\" = {{ x = 0.0 }}
        displacement.\"t.bottom\" = {{ y = 0.0 }}
        {first}
        {others}"
    )
}

/// Times and axial stresses of a bar.
fn stresses(model: &Model) -> Vec<[f64; 2]> {
    let keep = run(model);
    let force = columns(model, &keep)["reaction.t.bottom.y"].clone();
    keep.states.iter().zip(force).map(|(state, force)| [state.time, -force / (25.0 * std::f64::consts::PI)]).collect()
}

/// Height by which the top of a bar of 10 has risen, as a strain.
fn strain(state: &asperity::system::State) -> f64 {
    state.u.iter().skip(1).step_by(2).fold(0.0_f64, |most, u| if u.abs() > most.abs() { *u } else { most }) / 10.0
}

const NORTON: &str = "norton_hoff = { young = 200e3, poisson = 0.3, consistency = 100.0, sensitivity = 0.2 }";
const HELD: &str = "duration = 1e-6
        displacement.\"t.top\" = { y = 0.01 }";

/// `s^-4 = s_0^-4 + 4 E t/(sqrt 3 (sqrt 3 K)^5)`.
fn relaxed(t: f64) -> f64 {
    let root = 3.0_f64.sqrt();
    (200.0_f64.powi(-4) + 4.0 * 200e3 / root * t / (root * 100.0).powi(5)).powf(-0.25)
}

#[test]
fn a_bolt_of_norton_and_hoff_relaxes_as_its_closed_form() {
    let model = model(&bar(NORTON, HELD, "[[step]]\nduration = 1000.0"), &[]);
    let found = stresses(&model);
    let worst = found.iter().filter(|[t, _]| *t > 0.1).map(|[t, s]| (s / relaxed(*t) - 1.0).abs()).fold(0.0, f64::max);
    eprintln!("{worst} in {} increments", found.len());
    assert!(worst < 0.01, "{worst}: {found:?}");
    assert!(found.len() < 80, "{} increments", found.len());
}

/// A count is kept, and what it costs is known.
#[test]
fn given_increments_are_kept_and_noted() {
    let model = model(&bar(NORTON, HELD, "[[step]]\nduration = 1000.0\nincrements.count = 10"), &[]);
    let mut keep = Keep::default();
    let mut run = model.run(model.problem.initial_state());
    run.run(&RunOptions::default(), &mut keep).unwrap();
    assert_eq!(keep.states.iter().filter(|state| state.time > 2e-6).count(), 10);
    let (most, body, time) = run.uneven.clone().unwrap();
    assert!(most > 0.1 && body == "t" && (time - 100.0).abs() < 1e-3, "{most} {body} {time}");
}

/// Overstress `y` over the yield stress: `y^-4 = y_0^-4 + 4 E gamma t/s_y`.
#[test]
fn an_overstress_of_perzyna_relaxes_as_its_closed_form() {
    let material = "perzyna = { young = 200e3, poisson = 0.3, yield_stress = 200.0, fluidity = 1e-3, power = 5.0 }";
    let first = "duration = 0.001\ndisplacement.\"t.top\" = { y = 0.02 }";
    let found = stresses(&model(&bar(material, first, "[[step]]\nduration = 1000.0"), &[]));
    let exact = |t: f64| 200.0 * (1.0 + (1.0 + 4.0 * t).powf(-0.25));
    let worst = found.iter().filter(|[t, _]| *t > 0.1).map(|[t, s]| (s / exact(*t) - 1.0).abs()).fold(0.0, f64::max);
    eprintln!("{worst} in {} increments", found.len());
    assert!(worst < 0.01, "{worst}: {found:?}");
}

/// The creep of a load that grows evenly to 50 in a second is a sixth of that which a second at 50 makes.
#[test]
fn creep_under_a_load_is_the_integral_of_its_rate() {
    let steps = "[[step]]\nduration = 10.0";
    let keep = run(&model(&bar(NORTON, "traction.\"t.top\" = { y = 50.0 }", steps), &[]));
    let rate = (50.0 / (100.0 * 3.0_f64.powf(0.6))).powi(5);
    let at = |time: f64| {
        let state = keep.states.iter().find(|state| (state.time - time).abs() < 1e-9).unwrap();
        (strain(state) - 50.0 / 200e3) / rate
    };
    eprintln!("{} {}", 6.0 * at(1.0) - 1.0, (at(11.0) - at(1.0)) / 10.0 - 1.0);
    assert!((6.0 * at(1.0) - 1.0).abs() < 0.03, "{}", at(1.0));
    assert!(((at(11.0) - at(1.0)) / 10.0 - 1.0).abs() < 1e-3, "{}", at(11.0) - at(1.0));
}

/// A bar under a dead load, whose stress grows as it thins: `-m ln(1 - r t/m)` (theory.md, Norton and Hoff), here at a strain of .23 against 2000 increments.
#[test]
fn a_bar_that_thins_creeps_faster() {
    let deck = "version = 1
        space = \"axisymmetric\"
        mesh.part.t.rectangle = { from = [0.0, 0.0], to = [1.0, 2.0], cells = [1, 1], cell = \"quad8\" }
        material.m.norton_hoff = { young = 1e5, poisson = 0.3, consistency = 100.0, sensitivity = 0.25 }
        body.t.material = \"m\"
        [[step]]
        duration = 1e-6
        symmetry = [\"t.left\", \"t.bottom\"]
        traction.\"t.top\" = { y = 60.0 }
        [[step]]
        duration = 18.0422";
    let keep = run(&model(deck, &[]));
    let top = keep.states.last().unwrap().u.iter().fold(0.0, |most: f64, u| most.max(*u));
    let strain = (top / 2.0).ln_1p();
    eprintln!("{strain} in {} increments", keep.states.len());
    assert!((strain / 0.2304 - 1.0).abs() < 0.02, "{strain}");
    assert!(keep.states.len() < 100, "{} increments", keep.states.len());
}

/// The strain of a cycle, `ln(((C/g)^2 - (s_min + k)^2)/((C/g)^2 - (s_max - k)^2))/g` (Lemaitre and Chaboche 1990).
#[test]
fn a_bar_ratchets_as_its_closed_form() {
    let material =
        "chaboche = { young = 200e3, poisson = 0.3, yield_stress = 150.0, kinematic_1 = 50e3, recovery_1 = 200.0 }";
    let to = |stress: f64| format!("traction.\"t.top\" = {{ y = {stress:?} }}\n");
    let cycle = format!("[[step]]\n{}[[step]]\n{}", to(-290.0), to(350.0));
    let keep = run(&model(&bar(material, &to(350.0), &cycle.repeat(3)), &[]));
    let at = |time: f64| strain(keep.states.iter().find(|state| (state.time - time).abs() < 1e-9).unwrap());
    let exact = ((250.0_f64.powi(2) - 140.0_f64.powi(2)) / (250.0_f64.powi(2) - 200.0_f64.powi(2))).ln() / 200.0;
    for end in [3.0, 5.0, 7.0] {
        let cycle = at(end) - at(end - 2.0);
        assert!((cycle / exact - 1.0).abs() < 0.01, "{cycle} instead of {exact}");
    }
}

/// A flange of lead under a washer that has been tightened: its force against that of 221 increments with a tolerance of 1e-4.
#[test]
fn a_flange_creeps_from_under_its_bolt() {
    let deck = "version = 1
        space = \"axisymmetric\"
        mesh.part.flange.rectangle = { from = [5.0, 0.0], to = [12.0, 30.0], cells = [5, 20], cell = \"quad4\" }
        material.lead.norton_hoff = { young = 16e3, poisson = 0.4, consistency = 20.0, sensitivity = 0.2 }
        body.flange.material = \"lead\"
        tool.washer.profile = [{ line = [[0.0, 30.0], [20.0, 30.0]] }]
        contact.c = { surface = \"flange.top\", target = \"washer\", law.coulomb.friction = 0.2 }
        [[step]]
        displacement.\"flange.bottom\" = { y = 0.0 }
        motion.washer = { y = -0.02 }
        duration = 0.001
        [[step]]
        duration = 3600.0";
    let model = model(deck, &[]);
    let keep = run(&model);
    let force = &columns(&model, &keep)["contact.c.force.y"];
    // Along straight lines between the logarithms.
    let at = |time: f64| {
        let after = keep.states.iter().position(|state| state.time >= time).unwrap();
        let [t, f] = [after - 1, after].map(|i| (keep.states[i].time.ln(), (-force[i]).ln()));
        (t.1 + (f.1 - t.1) * (time.ln() - t.0) / (f.0 - t.0)).exp()
    };
    for (time, fine) in [(50.0, 866.8), (180.0, 629.5), (1000.0, 410.0), (3600.0, 297.5)] {
        eprintln!("{time} {} in {} increments", at(time) / fine - 1.0, keep.states.len());
        assert!((at(time) / fine - 1.0).abs() < 0.01, "{} at {time} instead of {fine}", at(time));
    }
}
