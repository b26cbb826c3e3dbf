//! Numbers that make no interface are refused by name, with their line and what they may be.

use asperity::deck::read_interface;

/// What is said against a law.
fn refused(law: &str) -> String {
    let text = format!("version = 1\npenalty = 1.0\ninterface.i.{law}\n[[step]]\npressure = 1.0\n");
    match read_interface(&text, "deck.toml", &[]) {
        Ok(_) => panic!("accepted: {law}"),
        Err(diagnostics) => diagnostics.render(false),
    }
}

#[test]
fn impossible_numbers_are_refused_by_name_line_and_range() {
    let fault = "friction = 0.6, evolution = 0.01, distance = 1.0, velocity = 1.0";
    for (law, said) in [
        (
            "coulomb = { friction = -0.1 }".to_string(),
            "`interface.i.coulomb.friction` must be zero or positive, not -0.1",
        ),
        ("coulomb = { friction = nan }".into(), "must be zero or positive, not NaN"),
        ("dilatant = { friction = 0.3, dilatancy = 0.4, dilation_slip = 1.0 }".into(), "at most the friction, 0.3"),
        ("dilatant = { friction = 0.3, dilatancy = 0.2 }".into(), "does not say `dilation_slip`"),
        ("dilatant = { friction = 0.3, dilatancy = 0.2, dilation_slip = 0.0 }".into(), "must be positive, not 0"),
        ("cohesive = { friction = 0.5, cohesion = 1.0, tension = 2.1 }".into(), "at most cohesion over friction, 2"),
        ("cam_clay = { critical_slope = 0.0, preconsolidation = 1.0 }".into(), "must be positive, not 0"),
        ("cam_clay_phi_a = { phi = 1.0, a = -1.0 }".into(), "must be positive, not -1"),
        (
            "orowan = { friction = 0.3, shear_strength = 1.0, factor = 1.5 }".into(),
            "must be above 0 and at most 1, not 1.5",
        ),
        (
            "static_kinetic = { static = 0.2, kinetic = 0.3, slip = 1.0 }".into(),
            "`kinetic` must be at most `static`, 0.2",
        ),
        (format!("rate_and_state = {{ {fault}, direct = 0.0 }}"), "rate_and_state.direct` must be positive, not 0"),
        (format!("rate_and_state_slip = {{ {fault}, direct = -0.1 }}"), "must be positive, not -0.1"),
        ("oden_pires = { friction = 0.3, length = 0.0 }".into(), "must be positive, not 0"),
        ("oden_pires = { friction = 0.3, length = 1.0, radius = 0.5 }".into(), "a single point has no neighbours"),
        (
            "velocity_dependent = { static = 0.3, kinetic = 0.2, velocity = inf }".into(),
            "is infinite, or too large for a number; it must be positive",
        ),
    ] {
        let message = refused(&law);
        assert!(message.contains(said), "{law} is refused with\n{message}");
        assert!(message.contains("deck.toml:3:"), "{law} is refused with\n{message}");
    }
}

#[test]
fn a_step_says_one_thing_across_the_interface() {
    let text =
        "version = 1\npenalty = 1.0\ninterface.i.frictionless = {}\n[[step]]\npressure = 1.0\npenetration = 0.1\n";
    let message = read_interface(text, "deck.toml", &[]).err().unwrap().render(false);
    assert!(message.contains("says both `penetration` and `pressure`"), "{message}");
}
