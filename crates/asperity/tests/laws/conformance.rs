//! What every law must keep: exact tangents, objectivity, dissipation, finite numbers; and that every law is described,
//! has an example and is tested.

use super::samples::*;
use asperity::deck::schema::{manual, point_manual};
use asperity::declare::Entry;
use asperity::material::laws::ALL;
use asperity::material::{Directions, Gradient, Material};
use asperity::tensor::Tensor2;
use std::collections::BTreeSet;

const STATES: usize = 1000;
/// The smallest difference of a component of the deformation.
const FINEST: f64 = 3e-8;

#[test]
fn every_law_has_an_example_and_stands_in_the_manual() {
    let samples = samples();
    let (manual, point) = (manual(), point_manual());
    for Entry { name, parameters, pairs, .. } in ALL {
        assert!(samples.iter().any(|sample| sample.law == *name), "no deck of cases/point names `{name}`");
        let keys = parameters.iter().map(|p| p.key).chain(pairs.iter().map(|p| p.key));
        for page in [&manual, &point] {
            let section = page.split_once(&format!("## `material.MATERIAL.{name}`")).map(|(_, rest)| rest);
            let section = section.unwrap_or_else(|| panic!("the manual lacks `{name}`"));
            let section = section.split("\n## ").next().unwrap();
            keys.clone().for_each(|key| assert!(section.contains(&format!("| `{key}` |")), "`{name}` lacks `{key}`"));
        }
    }
}

fn norm(gradient: &Gradient) -> f64 {
    gradient.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Stress at `f` moved by `h` along a component, or nothing where the law fails.
fn moved(material: &dyn Material, state: &[f64], f: &Tensor2, place: (usize, usize), h: f64) -> Option<[f64; 6]> {
    let mut f = *f;
    f[place] += h;
    let mut new = state.to_vec();
    material.update(&f, 0.1.into(), state, &mut new).ok()?;
    Some(std::array::from_fn(|i| new[i]))
}

/// What differences say of one column of a tangent.
enum Column {
    /// The least error against central differences of second and fourth order, over a few sizes of the difference.
    Error(f64),
    /// The two sides differ: a corner of the law lies within the differences.
    Kink,
}

fn compare(material: &dyn Material, state: &[f64], f: &Tensor2, d: usize, gradient: &Gradient) -> Option<Column> {
    let place = Directions::Space.components()[d];
    let scale = norm(gradient).max(1e-3 * material.moduli()[0]);
    let mut best = f64::INFINITY;
    for h in [2e-5, 4e-6, 1e-4, 8e-7, 1.6e-7, FINEST] {
        let at = |k: f64| moved(material, state, f, place, k * h);
        let [a, b, c, e] = [at(-2.0)?, at(-1.0)?, at(1.0)?, at(2.0)?];
        let fourth = |i: usize| (8.0 * (c[i] - b[i]) - (e[i] - a[i])) / (12.0 * h);
        // A corner of the law between the inner and the outer points is none of the inner ones' business.
        let second = |i: usize| (c[i] - b[i]) / (2.0 * h);
        let error = |of: &dyn Fn(usize) -> f64| (0..6).fold(0.0, |m: f64, i| m.max((of(i) - gradient[i][d]).abs()));
        best = best.min(error(&fourth)).min(error(&second));
        if best < 1e-8 * scale {
            return Some(Column::Error(best / scale));
        }
    }
    if best <= 1e-7 * scale {
        return Some(Column::Error(best / scale));
    }
    let h = FINEST;
    let at = |k: f64| moved(material, state, f, place, k * h);
    let [a, b, o, c, e] = [at(-2.0)?, at(-1.0)?, at(0.0)?, at(1.0)?, at(2.0)?];
    let sides = |i: usize| (4.0 * (c[i] + b[i]) - e[i] - a[i] - 6.0 * o[i]) / (2.0 * h);
    // On a smooth branch the sides differ by the rounding of the stress only.
    let kink = (0..6).any(|i| sides(i).abs() > best.min(1e-4 * scale));
    Some(if kink { Column::Kink } else { Column::Error(best / scale) })
}

/// Ten thousand states of each law; of the frames beside its first, and of small strain, a tenth of them.
#[test]
fn tangents_are_those_of_differences() {
    let mut known = BTreeSet::new();
    for sample in samples() {
        let first = known.insert(sample.law);
        compare_tangents(1, if first { 10 * STATES } else { STATES }, &sample);
    }
    small_samples().iter().for_each(|sample| compare_tangents(2, STATES, sample));
}

#[test]
#[ignore = "minutes"]
fn tangents_are_those_of_differences_at_many_states() {
    samples().iter().chain(&small_samples()).for_each(|sample| compare_tangents(11, 10 * STATES, sample));
}

fn compare_tangents(seed: u64, states: usize, sample: &Sample) {
    let material = sample.material.as_ref();
    let (mut random, mut worst, mut kinks, mut compared) = (Random::new(seed), 0.0_f64, 0, 0);
    for _ in 0..states {
        let state = reached(material, &mut random);
        let f = random.deformation([-5.0, -1.5]);
        let mut new = state.clone();
        let Ok(c) = material.update_with_gradient(&f, 0.1.into(), &state, &mut new, Directions::Space) else {
            continue;
        };
        for d in 0..9 {
            match compare(material, &state, &f, d, &c) {
                Some(Column::Error(error)) => {
                    compared += 1;
                    worst = worst.max(error);
                    assert!(error < 1e-7, "{}: {error} along {d} at {state:?}, {f:?}", sample.name);
                }
                Some(Column::Kink) => kinks += 1,
                None => {}
            }
        }
    }
    eprintln!("{}: worst of {compared} columns {worst:.1e}, {kinks} at corners", sample.name);
    assert!(compared > 8 * states, "{}: only {compared} columns", sample.name);
    assert!(kinks * 50 < compared, "{}: {kinks} corners", sample.name);
}

fn largest(stress: &Tensor2) -> f64 {
    stress.to_voigt().iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

#[test]
fn turned_solids_have_turned_stresses() {
    for sample in samples() {
        let material = sample.material.as_ref();
        let mut random = Random::new(2);
        for _ in 0..STATES {
            let state = reached(material, &mut random);
            let (q, f) = (random.rotation(), random.deformation([-5.0, -1.5]));
            let (mut plain, mut other) = (state.clone(), state.clone());
            if material.update(&f, 0.1.into(), &state, &mut plain).is_err() {
                continue;
            }
            let before = turned(material, &state, &q);
            material.update(&(q * f * q.transpose()), 0.1.into(), &before, &mut other).unwrap();
            let wanted = turned(material, &plain, &q);
            let difference = largest(&(stress(&wanted) - stress(&other)));
            // What the elastic increment brings in and the return takes out again is rounded at its own size.
            let scale = largest(&stress(&state)) + 1e-2 * material.moduli()[0];
            assert!(difference < 1e-12 * scale, "{}: {difference} of {scale}", sample.name);
        }
    }
}

#[test]
fn rigid_rotations_turn_the_stress_and_nothing_else() {
    for sample in samples() {
        let material = sample.material.as_ref();
        let mut random = Random::new(3);
        for _ in 0..STATES {
            let (state, q) = (reached(material, &mut random), random.rotation());
            let mut new = state.clone();
            // Without time, so that nothing creeps.
            material.update(&q, 0.0.into(), &state, &mut new).unwrap();
            let difference = largest(&(stress(&turned(material, &state, &q)) - stress(&new)));
            let scale = largest(&stress(&state)).max(1e-2 * material.moduli()[0]);
            assert!(difference < 1e-12 * scale, "{}: {difference} of {scale}", sample.name);
        }
    }
}

#[test]
fn no_increment_gives_out_energy() {
    for sample in samples() {
        let material = sample.material.as_ref();
        let mut random = Random::new(4);
        for _ in 0..STATES {
            let mut state = initial(material);
            for _ in 0..8 {
                let mut new = state.clone();
                if material.update(&random.deformation([-4.5, -1.5]), 0.1.into(), &state, &mut new).is_err() {
                    continue;
                }
                let lost = material.dissipation(&state, &new);
                let scale = material.stored_energy(&new).abs().max(lost.abs());
                assert!(lost >= -1e-12 * scale, "{}: {lost} of {scale}", sample.name);
                assert!(material.stored_energy(&new).is_finite(), "{}", sample.name);
                state = new;
            }
        }
    }
}

#[test]
fn no_state_gives_what_is_no_number() {
    search_what_is_no_number(5, 20 * STATES);
}

#[test]
#[ignore = "minutes"]
fn no_state_of_a_million_gives_what_is_no_number() {
    search_what_is_no_number(15, 1000 * STATES);
}

/// Any numbers: a result is finite, or there is none.
fn search_what_is_no_number(seed: u64, states: usize) {
    for sample in samples() {
        let material = sample.material.as_ref();
        let (mut random, mut good) = (Random::new(seed), 0);
        for _ in 0..states {
            let mut state = reached(material, &mut random);
            let factor = 10_f64.powf(4.0 * random.number());
            state[..6].iter_mut().for_each(|s| *s *= factor);
            let f = random.deformation([-9.0, 0.3]);
            let dt = 10_f64.powf(6.0 * random.number());
            let mut new = state.clone();
            let Ok(c) = material.update_with_gradient(&f, dt.into(), &state, &mut new, Directions::Space) else {
                continue;
            };
            good += 1;
            let finite = new.iter().chain(c.iter().flatten()).all(|x| x.is_finite());
            assert!(finite, "{}: {new:?} after {state:?} by {f:?} in {dt}", sample.name);
        }
        eprintln!("{}: {good} results of {states}, all finite", sample.name);
        assert!(10 * good > states, "{}: only {good} results", sample.name);
    }
}

#[test]
fn the_plain_update_is_the_one_with_the_tangent() {
    for sample in samples().into_iter().chain(small_samples()) {
        let material = sample.material.as_ref();
        let mut random = Random::new(6);
        for _ in 0..STATES / 10 {
            let state = reached(material, &mut random);
            let f = random.deformation([-5.0, -1.5]);
            let (mut plain, mut dual) = (state.clone(), state.clone());
            let with = material.update_with_gradient(&f, 0.1.into(), &state, &mut dual, Directions::Space);
            assert_eq!(with.is_ok(), material.update(&f, 0.1.into(), &state, &mut plain).is_ok(), "{}", sample.name);
            if with.is_ok() {
                let scale = plain.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-13 * scale;
                assert!(plain.iter().zip(&dual).all(near), "{}", sample.name);
            }
        }
    }
}

/// What `asperity point --tangent` says of the paths of all decks.
#[test]
fn tangents_along_the_paths_of_all_decks() {
    for path in decks() {
        let sets: Vec<String> = (1..=4).map(|i| format!("step.{i}.increments=20")).collect();
        let steps = load(&path, &[]).stages.len().min(4);
        let loaded = load(&path, &sets[..steps].iter().map(String::as_str).collect::<Vec<_>>());
        for (name, check) in loaded.tangents() {
            assert!(check.columns > 0 && check.worst < 2e-6, "{name} of {}: {check:?}", path.display());
        }
    }
}
