//! Orders of the schemes, measured for every smooth law on a path whose direction turns from the stress.

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
    let law = sample.interface.with_update(update);
    let turn = Motion { penetration: 0.95 * press, slip: [0.2 * reach, 0.6 * reach] };
    let mut vars = state.vars.clone();
    law.respond(numbers(&turn), &state.past(sample, 1e-2 * sample.time), &mut vars).unwrap().stress
}

/// Errors fall with the order of the scheme: the mean order over six halvings.
#[test]
fn errors_fall_with_the_order_of_the_scheme() {
    let smooth = ["cohesive", "dilatant", "cam_clay", "cam_clay_phi_a", "orowan_smooth", "shaw", "slip_dependent"];
    let mut met = 0;
    for sample in samples().iter().filter(|sample| smooth.contains(&sample.law)) {
        let by = |scheme: Scheme, substeps: usize| end(sample, Update { scheme, substeps, tolerance: None });
        let exact = by(Scheme::TwoStep, 8192);
        for (scheme, order) in [(Scheme::BackwardEuler, 1.0), (Scheme::TwoStep, 2.0), (Scheme::Midpoint(0.5), 2.0)] {
            let error = |substeps| {
                let stress = by(scheme, substeps);
                (0..3).map(|i| (stress[i] - exact[i]).powi(2)).sum::<f64>().sqrt() / sample.pressure
            };
            let measured = (error(8) / error(512)).log2() / 6.0;
            eprintln!("{}: {scheme:?} order {measured:.2}, error {:.1e}", sample.name, error(512));
            assert!(measured > order - 0.15, "{}: {scheme:?} has the order {measured}", sample.name);
            met += 1;
        }
    }
    assert!(met >= 3 * smooth.len());
}

/// The tangent of sub-steps is that of the whole.
#[test]
fn tangents_of_sub_steps_are_those_of_differences() {
    let update = Update { scheme: Scheme::TwoStep, substeps: 3, tolerance: None };
    for sample in samples().iter().filter(|sample| sample.law != "oden_pires") {
        let reach = sample.pressure / sample.penalties[1];
        let press = 0.8 * sample.pressure / sample.penalties[0];
        let first = Motion { penetration: press, slip: [2.0 * reach, 0.0] };
        let dt = 1e-2 * sample.time;
        let (state, _) = State::initial(sample.interface.as_ref()).moved(sample, &first, dt).unwrap();
        let law = sample.interface.with_update(update);
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
