//! Orders of the schemes, measured for every law of the registry on a path whose direction turns from the stress.

use super::samples::{Sample, State, numbers, samples};
use asperity::integrate::{Scheme, Update};
use asperity::interface::Motion;

/// Shear and pressure after slip along one tangent and then a turn, in one increment in which the
/// pressure falls a little, so that the point slips from its beginning: a crossing would hide the order.
fn end(sample: &Sample, update: Update) -> [f64; 3] {
    let reach = sample.pressure / sample.penalties[1];
    let press = 0.8 * sample.pressure / sample.penalties[0];
    let first = Motion { penetration: press, slip: [2.0 * reach, 0.0] };
    let (state, _) = State::initial(sample.interface.as_ref()).moved(sample, &first, 1e-2 * sample.time).unwrap();
    let law = sample.interface.with_update(update).unwrap();
    let turn = Motion { penetration: 0.95 * press, slip: [0.2 * reach, 0.6 * reach] };
    let mut vars = state.vars.clone();
    law.respond(numbers(&turn), &state.past(sample, 1e-2 * sample.time), &mut vars).unwrap().stress
}

/// What the guide says of the schemes of a law.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Claim {
    /// Two-step and midpoint are of second order where the law is smooth.
    Second,
    /// Two-step is; there is no midpoint rule.
    TwoStep,
    /// Its increments are closed forms, and there is nothing to choose.
    Closed,
}

/// Every law of the registry has a line here, or the test fails.
fn claim(law: &str) -> Claim {
    match law {
        "frictionless" | "sticking" | "oden_pires" => Claim::Closed,
        "velocity_dependent" | "rate_and_state" | "rate_and_state_slip" => Claim::TwoStep,
        "coulomb" | "cohesive" | "dilatant" | "cam_clay" | "cam_clay_phi_a" | "orowan" | "orowan_smooth" | "shaw"
        | "shear_factor" | "static_kinetic" | "slip_dependent" | "work_dependent" => Claim::Second,
        other => panic!("say in this test and in the guide what the schemes of `{other}` are worth"),
    }
}

/// What a scheme of a law is worth.
pub struct Order {
    /// Name of the sample.
    pub name: String,
    pub law: &'static str,
    pub scheme: Scheme,
    /// The mean order over several halvings; none where the error is that of rounding.
    pub found: Option<f64>,
    /// What the guide claims, in so many halvings.
    pub least: f64,
}

fn serves(sample: &Sample, scheme: Scheme) -> bool {
    sample.interface.with_update(Update { scheme, ..Update::default() }).is_ok()
}

/// Orders of the schemes of every law of the registry.
pub fn orders() -> Vec<Order> {
    let mut orders = Vec::new();
    for sample in samples().iter().filter(|sample| claim(sample.law) != Claim::Closed) {
        let by = |scheme: Scheme, substeps: usize| end(sample, Update { scheme, substeps, tolerance: None });
        // A velocity that jumps at the beginning of the turn has to be resolved before an order is seen.
        let (few, many) = if claim(sample.law) == Claim::TwoStep { (128, 2048) } else { (32, 1024) };
        let exact = by(Scheme::TwoStep, 16 * many);
        let schemes = [(Scheme::BackwardEuler, 0.9), (Scheme::TwoStep, 1.9), (Scheme::Midpoint(0.5), 1.9)];
        for (scheme, least) in schemes.into_iter().filter(|(scheme, _)| serves(sample, *scheme)) {
            let error = |substeps| distance(by(scheme, substeps), exact) / sample.pressure;
            let (first, last) = (error(few), error(many));
            let found = (first >= 1e-11).then(|| (first / last).log2() / (many as f64 / few as f64).log2());
            orders.push(Order { name: sample.name.clone(), law: sample.law, scheme, found, least });
        }
    }
    orders
}

/// Errors fall with the order of the scheme, for every law of the registry.
#[test]
fn errors_fall_with_the_order_of_the_scheme() {
    for Order { name, law, scheme, found, least } in orders() {
        assert!(found.is_none_or(|order| order > least), "{law}, {name}: {scheme:?} has the order {found:?}");
    }
}

#[test]
fn schemes_that_a_law_cannot_serve_are_refused() {
    for sample in samples() {
        let claim = claim(sample.law);
        assert_eq!(serves(&sample, Scheme::TwoStep), claim != Claim::Closed, "{}", sample.name);
        assert_eq!(serves(&sample, Scheme::Midpoint(0.5)), claim == Claim::Second, "{}", sample.name);
    }
}

/// The error at the end of the increment is at most the tolerance, and not that of needlessly many sub-steps.
#[test]
fn errors_are_within_the_tolerance() {
    for sample in samples() {
        if claim(sample.law) == Claim::Closed {
            continue;
        }
        let exact = end(&sample, Update { scheme: Scheme::TwoStep, substeps: 16_384, tolerance: None });
        for (scheme, tolerances) in [
            (Scheme::BackwardEuler, &[1e-1, 1e-2][..]),
            (Scheme::TwoStep, &[1e-2, 1e-3, 1e-4, 1e-5]),
            (Scheme::Midpoint(0.5), &[1e-2, 1e-3, 1e-4, 1e-5]),
        ] {
            for &tolerance in tolerances {
                let update = Update { scheme, substeps: 1, tolerance: Some(tolerance) };
                if sample.interface.with_update(update).is_err() {
                    continue;
                }
                let error = distance(end(&sample, update), exact) / distance(exact, [0.0; 3]);
                eprintln!("| {} | {scheme:?} | {tolerance:.0e} | {error:.1e} |", sample.name);
                assert!(error <= tolerance, "{}: {scheme:?} leaves {error:.1e} of {tolerance:.0e}", sample.name);
            }
        }
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// A slider that is loaded three times as fast as it crept, over a slip in which its state is renewed.
#[test]
fn the_state_of_a_gouge_is_carried_with_second_order() {
    use asperity::interface::Past;
    use asperity::interface::laws::{Evolution, RateState, StateCourse};
    let (distance_c, pressure, velocity) = (1e-5, 1e7, 1e-6);
    for evolution in [Evolution::Ageing, Evolution::Slip] {
        let law = RateState {
            friction: 0.6,
            direct: 0.01,
            evolution: 0.015,
            distance: distance_c,
            velocity,
            state: 1.0,
            damping: 0.0,
            law: evolution,
            course: StateCourse::Exact,
        };
        let stiffness = 20.0 * 0.015 * pressure / distance_c;
        let end = |scheme: Scheme, substeps: usize| {
            let update = Update { scheme, substeps, tolerance: None };
            let law = asperity::interface::InterfaceLaw::updated(&law, update).unwrap();
            let vars = [0.0, velocity];
            let past = Past {
                penalty: pressure,
                tangential_penalty: stiffness,
                penetration: 1.0,
                pressure,
                shear: [0.6 * pressure, 0.0],
                vars: &vars,
                dt: 0.5 * distance_c / velocity,
            };
            let motion = asperity::interface::Motion { penetration: 1.0, slip: [1.5 * distance_c, 0.0] };
            let mut new = vars;
            let response = law.respond(numbers(&motion), &past, &mut new).unwrap();
            [response.shear()[0] / pressure, new[0], new[1] / velocity]
        };
        let exact = end(Scheme::TwoStep, 65_536);
        for (scheme, least) in [(Scheme::BackwardEuler, 0.9), (Scheme::TwoStep, 1.9)] {
            let error = |substeps| distance(end(scheme, substeps), exact);
            let order = (error(128) / error(2048)).log2() / 4.0;
            eprintln!("| rate and state, {evolution:?} | {scheme:?} | {order:.2} | {:.1e} |", error(2048));
            assert!(order > least, "{evolution:?}: {scheme:?} has the order {order}");
        }
    }
}

/// The tangent of sub-steps is that of the whole.
#[test]
fn tangents_of_sub_steps_are_those_of_differences() {
    let update = Update { scheme: Scheme::TwoStep, substeps: 3, tolerance: None };
    for sample in samples().iter().filter(|sample| claim(sample.law) != Claim::Closed) {
        let reach = sample.pressure / sample.penalties[1];
        let press = 0.8 * sample.pressure / sample.penalties[0];
        let first = Motion { penetration: press, slip: [2.0 * reach, 0.0] };
        let dt = 1e-2 * sample.time;
        let (state, _) = State::initial(sample.interface.as_ref()).moved(sample, &first, dt).unwrap();
        let law = sample.interface.with_update(update).unwrap();
        let at = |x: [f64; 3]| law.respond(x, &state.past(sample, dt), &mut state.vars.clone()).unwrap();
        let here = [1.1 * press, 0.2 * reach, 0.6 * reach];
        let rows = at(here).slopes;
        for direction in 0..3 {
            let h = 1e-3 * if direction == 0 { press } else { reach };
            let by = |k: f64| at(std::array::from_fn(|i| here[i] + if i == direction { k * h } else { 0.0 })).stress;
            let [a, b, c, d] = [by(-2.0), by(-1.0), by(1.0), by(2.0)];
            let scale = rows.iter().fold(1e-6 * sample.penalties[0], |m: f64, row| m.max(row[direction].abs()));
            for i in 0..3 {
                let slope = (8.0 * (c[i] - b[i]) - (d[i] - a[i])) / (12.0 * h);
                let error = (rows[i][direction] - slope).abs() / scale;
                assert!(error < 1e-6, "{}: {error:.1e} in {i} along {direction}", sample.name);
            }
        }
    }
}
