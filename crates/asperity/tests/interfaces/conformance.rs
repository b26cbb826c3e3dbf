//! What every law must keep: exact tangents, isotropy, dissipation, stress inside its surface, finite numbers, a way
//! back from a gap; and that every law is described, has an example and is tested.

use super::samples::*;
use asperity::deck::schema::{interface_json_schema, interface_manual, json_schema, manual};
use asperity::declare::{Entry, Parameter};
use asperity::interface::Motion;
use asperity::interface::laws::ALL;
use serde_json::Value;

/// States of a law at which it is looked at; `cargo test --release -p asperity --test interfaces -- --ignored` takes
/// ten thousand.
const STATES: usize = 500;

/// Whether a JSON schema knows a table of this name with these keys.
fn knows(schema: &Value, name: &str, keys: &[Parameter]) -> bool {
    let properties = |schema: &Value| schema.get("properties").and_then(Value::as_object).cloned();
    let here = properties(schema).and_then(|all| properties(all.get(name)?));
    here.is_some_and(|table| keys.iter().all(|parameter| table.contains_key(parameter.key)))
        || schema.as_object().is_some_and(|all| all.values().any(|inner| knows(inner, name, keys)))
        || schema.as_array().is_some_and(|all| all.iter().any(|inner| knows(inner, name, keys)))
}

#[test]
fn every_law_has_an_example_and_stands_in_the_schema_and_the_manual() {
    let samples = samples();
    let (manual, point) = (manual(), interface_manual());
    for Entry { name, parameters, .. } in ALL {
        for schema in [json_schema(), interface_json_schema()] {
            assert!(knows(&schema, name, parameters), "a schema lacks `{name}`");
        }
        assert!(samples.iter().any(|sample| sample.law == *name), "no deck of cases/interface names `{name}`");
        for (page, head) in [(&manual, "contact.CONTACT.law"), (&point, "interface.INTERFACE")] {
            let section = page.split_once(&format!("## `{head}.{name}`")).map(|(_, rest)| rest);
            let section = section.unwrap_or_else(|| panic!("the manual lacks `{name}`"));
            let section = section.split("\n## ").next().unwrap();
            for p in *parameters {
                assert!(section.contains(&format!("| `{}` |", p.key)), "`{name}` lacks `{}`", p.key);
            }
        }
        let book = include_str!("../../../../book/src/interface.md");
        assert!(book.contains(&format!("`{name}`")), "the guide lacks `{name}`");
    }
}

/// What a point does, and near the apex of its surface what is left of its pressure.
const OPEN: usize = 0;
const STICK: usize = 1;
const SLIP: usize = 2;
const APEX: usize = 3;

struct At<'a> {
    sample: &'a Sample,
    state: State,
    motion: Motion<f64>,
    dt: f64,
}

impl At<'_> {
    /// Whether a point is open after a motion, as a contact finds it.
    fn is_open(&self, motion: &Motion<f64>) -> bool {
        motion.penetration <= self.sample.interface.opens(&self.state.past(self.sample, self.dt), motion.slip)
    }

    /// The stress at the motion moved along a direction, and what the point does.
    fn along(&self, direction: usize, h: f64) -> Option<([f64; 3], usize)> {
        let mut motion = self.motion;
        match direction {
            0 => motion.penetration += h,
            i => motion.slip[i - 1] += h,
        }
        if self.is_open(&motion) {
            return Some(([0.0; 3], OPEN));
        }
        let (_, response) = self.state.moved(self.sample, &motion, self.dt).ok()?;
        Some((response.stress, response.status as usize))
    }

    fn tangent(&self) -> Option<[[f64; 3]; 3]> {
        if self.is_open(&self.motion) {
            return Some([[0.0; 3]; 3]);
        }
        let (past, mut vars) = (self.state.past(self.sample, self.dt), self.state.vars.clone());
        Some(self.sample.interface.respond(numbers(&self.motion), &past, &mut vars).ok()?.slopes)
    }

    /// The increment turned into one of a kind: little slip, any, a gap, or so much slip so close to the gap that hardly any
    /// of the pressure is left.
    fn turned(mut self, kind: usize, random: &mut Random) -> Self {
        let reach = self.sample.pressure / self.sample.penalties[1];
        let depth = self.sample.pressure / self.sample.penalties[0];
        let size = self.motion.slip[0].hypot(self.motion.slip[1]);
        let scaled = |slip: [f64; 2], to: f64| slip.map(|s| s * to / size);
        match kind {
            STICK => self.motion.slip = scaled(self.motion.slip, reach * random.decades(-4.0, -2.0)),
            APEX => self.motion.slip = scaled(self.motion.slip, reach * random.decades(-0.5, 0.5)),
            _ => {}
        }
        let opens = self.sample.interface.opens(&self.state.past(self.sample, self.dt), self.motion.slip);
        match kind {
            OPEN => self.motion.penetration = opens - depth * random.decades(-3.0, 0.0),
            APEX => self.motion.penetration = opens + depth * random.decades(-3.0, -1.5),
            _ => {}
        }
        self
    }

    /// The largest error of a column of the tangent against central differences of fourth order, over a few sizes of
    /// the difference and relative to the column; nothing at a corner of the law.
    fn compare(&self, direction: usize, tangent: &[[f64; 3]; 3]) -> Option<f64> {
        let unit = self.sample.pressure / self.sample.penalties[usize::from(direction > 0)];
        let scale = (0..3).fold(0.0_f64, |m, i| m.max(tangent[i][direction].abs()));
        let scale = scale.max(1e-6 * self.sample.penalties[usize::from(direction > 0)]);
        let mut best = f64::INFINITY;
        for h in [3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6].map(|h| h * unit) {
            let at = |k: f64| self.along(direction, k * h);
            let (Some(a), Some(b), Some(c), Some(d)) = (at(-2.0), at(-1.0), at(1.0), at(2.0)) else { continue };
            if [b.1, c.1, d.1].iter().any(|&status| status != a.1) {
                continue;
            }
            let error = |i: usize| (8.0 * (c.0[i] - b.0[i]) - (d.0[i] - a.0[i])) / (12.0 * h) - tangent[i][direction];
            best = best.min((0..3).fold(0.0, |m: f64, i| m.max(error(i).abs())) / scale);
        }
        (best.is_finite() && (best < 1e-7 || !self.is_corner(direction, unit, scale))).then_some(best)
    }

    /// Whether the derivatives of the two sides differ.
    fn is_corner(&self, direction: usize, unit: f64, scale: f64) -> bool {
        let h = 1e-5 * unit;
        let at = |k: f64| self.along(direction, k * h).map(|(stress, _)| stress);
        let (Some(a), Some(b), Some(o), Some(c), Some(d)) = (at(-2.0), at(-1.0), at(0.0), at(1.0), at(2.0)) else {
            return true;
        };
        let sides = |i: usize| (4.0 * (c[i] + b[i]) - d[i] - a[i] - 6.0 * o[i]) / (2.0 * h);
        (0..3).any(|i| sides(i).abs() > 1e-3 * scale)
    }
}

/// Whether a law can do what a kind of increment asks for.
fn can(law: &str, kind: usize) -> bool {
    match kind {
        // Velocity is never zero where friction depends on its logarithm; regularised friction is one smooth curve.
        STICK => !law.starts_with("rate_and_state") && !["oden_pires", "frictionless"].contains(&law),
        // Only on the way to its opening.
        SLIP => law != "sticking",
        _ => true,
    }
}

fn tangents(states: usize) {
    for sample in samples() {
        let (mut random, mut worst, mut compared, mut met) = (Random(1), 0.0_f64, 0, [0; 4]);
        for kind in [OPEN, STICK, SLIP, APEX] {
            for _ in 0..states / 4 {
                let state = reached(&sample, &mut random);
                let (motion, dt) = increment(&sample, &state, &mut random);
                let at = At { sample: &sample, state, motion, dt }.turned(kind, &mut random);
                let Some(tangent) = at.tangent() else { continue };
                let (_, does) = at.along(0, 0.0).unwrap();
                let errors: Vec<f64> = (0..3).filter_map(|direction| at.compare(direction, &tangent)).collect();
                let wanted = if kind == APEX { SLIP } else { kind };
                met[kind] += usize::from(does == wanted && !errors.is_empty());
                compared += errors.len();
                for error in errors {
                    worst = worst.max(error);
                    assert!(error < 1e-7, "{}: {error:.1e} at {:?} {:?} {dt}", sample.name, at.state, at.motion);
                }
            }
        }
        eprintln!("{}: open, stick, slip, apex {met:?}, worst of {compared} columns {worst:.1e}", sample.name);
        assert!(10 * compared > 25 * states, "{}: only {compared} columns", sample.name);
        for (kind, met) in met.into_iter().enumerate().filter(|&(kind, _)| can(sample.law, kind)) {
            assert!(met > states / 16, "{}: {met} of kind {kind}", sample.name);
        }
    }
}

#[test]
fn tangents_are_those_of_differences() {
    tangents(STATES);
}

#[test]
#[ignore = "long"]
fn tangents_are_those_of_differences_at_ten_thousand_states() {
    tangents(10_000);
}

/// Along random paths no increment gives out energy, and none leaves its surface.
#[test]
fn no_increment_gives_out_energy_or_leaves_its_surface() {
    for sample in samples() {
        let (mut random, mut done) = (Random(2), 0);
        for _ in 0..STATES {
            let mut state = State::initial(sample.interface.as_ref());
            for _ in 0..8 {
                let (motion, dt) = increment(&sample, &state, &mut random);
                let Ok((next, response)) = state.moved(&sample, &motion, dt) else { continue };
                let scale = sample.pressure * sample.pressure / sample.penalties[1];
                assert!(response.dissipated >= -1e-12 * scale, "{}: {response:?}", sample.name);
                assert!(response.slipped >= -1e-12 * sample.slip, "{}: {response:?}", sample.name);
                assert!(response.violation < 1e-9, "{}: {response:?}", sample.name);
                state = next;
                done += 1;
            }
        }
        assert!(done > 4 * STATES, "{}: only {done} increments", sample.name);
    }
}

/// The two tangents have no direction of their own: turned slip and stress give turned stress.
#[test]
fn laws_are_isotropic() {
    for sample in samples() {
        let mut random = Random(3);
        for _ in 0..STATES {
            let state = reached(&sample, &mut random);
            let (motion, dt) = increment(&sample, &state, &mut random);
            let (sin, cos) = (std::f64::consts::TAU * random.number()).sin_cos();
            let turn = |v: [f64; 2]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
            let Ok((_, plain)) = state.moved(&sample, &motion, dt) else { continue };
            let turned = State { shear: turn(state.shear), ..state };
            let (_, other) = turned.moved(&sample, &Motion { slip: turn(motion.slip), ..motion }, dt).unwrap();
            let wanted = turn(plain.shear());
            let scale = sample.pressure.max(1e-4 * sample.penalties[1] * motion.slip[0].hypot(motion.slip[1]));
            let miss = (other.shear()[0] - wanted[0]).hypot(other.shear()[1] - wanted[1]);
            assert!(miss + (other.pressure() - plain.pressure()).abs() < 1e-9 * scale, "{}: {miss}", sample.name);
        }
    }
}

/// A point that opens keeps what its law says, and comes back without a jump of its pressure.
#[test]
fn a_gap_closes_again_where_the_law_says() {
    for sample in samples() {
        let mut random = Random(4);
        for _ in 0..STATES {
            let mut state = reached(&sample, &mut random);
            let mut left = vec![f64::NAN; state.vars.len()];
            sample.interface.release(&state.vars, &mut left);
            assert!(left.iter().all(|x| x.is_finite()), "{}", sample.name);
            (state.vars, state.shear, state.pressure) = (left, [0.0; 2], 0.0);
            let touch = sample.interface.touch(&state.past(&sample, 1.0));
            state.penetration = touch;
            let small = 1e-9 * sample.pressure / sample.penalties[0];
            let motion = Motion { penetration: touch + small, slip: [0.0; 2] };
            let (_, response) = state.moved(&sample, &motion, 1e-3 * sample.time).unwrap();
            let pressure = response.pressure() / sample.pressure;
            assert!((0.0..2e-9).contains(&pressure), "{}: {pressure}", sample.name);
        }
    }
}

/// Any numbers: a result is finite, or there is none. A gap is one of them.
#[test]
fn no_state_gives_what_is_no_number() {
    for sample in samples() {
        let (mut random, mut good) = (Random(5), 0);
        for _ in 0..10 * STATES {
            let state = reached(&sample, &mut random);
            let (mut motion, dt) = increment(&sample, &state, &mut random);
            motion.penetration *= random.decades(-3.0, 3.0) * if random.number() < 0.3 { -1.0 } else { 1.0 };
            motion.slip = motion.slip.map(|s| s * random.decades(-6.0, 4.0));
            if random.number() < 0.1 {
                motion.slip = [0.0; 2];
            }
            let at = At { sample: &sample, state, motion, dt: dt * random.decades(-4.0, 4.0) };
            let Some(tangent) = at.tangent() else { continue };
            let (stress, _) = at.along(0, 0.0).unwrap();
            good += 1;
            let finite = stress.iter().chain(tangent.iter().flatten()).all(|x| x.is_finite());
            assert!(finite, "{}: {stress:?} {tangent:?} after {:?} by {:?}", sample.name, at.state, at.motion);
        }
        assert!(good > STATES, "{}: only {good} results", sample.name);
    }
}
