//! The laws as their example decks set them, and random paths.

use asperity::Failure;
use asperity::deck::{LoadedInterface, read_interface};
use asperity::interface::{Interface, Linearised, Motion, Past};
use asperity::point::Record;
use std::path::{Path, PathBuf};

/// Decks of a point of an interface.
pub fn decks() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/interface");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    // Beside them stands what `verify` expects.
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml") && !path.ends_with("expect.toml"));
    paths.sort();
    paths
}

pub fn load(path: &Path, sets: &[&str]) -> LoadedInterface {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    let text = std::fs::read_to_string(path).unwrap();
    read_interface(&text, "deck.toml", &sets).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// Runs a deck of `cases/interface`.
pub fn run(deck: &str, sets: &[&str]) -> Vec<Record> {
    let path = decks().into_iter().find(|path| path.file_stem().is_some_and(|stem| stem == deck));
    load(&path.unwrap_or_else(|| panic!("no deck {deck}")), sets).run().unwrap()
}

/// A law as a deck sets it, with what is usual on that deck's path.
pub struct Sample {
    /// Name of the registered law and of the deck that sets it.
    pub name: String,
    pub law: &'static str,
    pub interface: Box<dyn Interface>,
    pub penalties: [f64; 2],
    /// The largest pressure, the slip and the time of the whole path.
    pub pressure: f64,
    pub slip: f64,
    pub time: f64,
}

pub fn samples() -> Vec<Sample> {
    let of = |path: &PathBuf| {
        let loaded = load(path, &[]);
        let records = loaded.run().unwrap();
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        let most = |record: &Record, name: &str| record.column(name).unwrap().into_iter().fold(0.0, f64::max);
        let penalty = loaded.deck.penalty;
        let sample =
            |((name, law), record): (&(asperity::deck::Name, asperity::deck::form::ChosenLaw<_>), &Record)| Sample {
                name: format!("{} of {stem}.{name}", law.entry.name),
                law: law.entry.name,
                interface: law.build().unwrap(),
                penalties: [penalty, loaded.deck.tangential_penalty.unwrap_or(0.7 * penalty)],
                pressure: most(record, "pressure"),
                slip: most(record, "slip"),
                time: most(record, "time"),
            };
        loaded.deck.interface.iter().zip(&records).map(sample).collect::<Vec<_>>()
    };
    decks().iter().flat_map(of).collect()
}

/// Random numbers (splitmix64), the same on every machine.
pub struct Random(pub u64);

impl Random {
    /// Between 0 and 1.
    pub fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
    /// `10^a` to `10^b`.
    pub fn decades(&mut self, a: f64, b: f64) -> f64 {
        10_f64.powf(a + (b - a) * self.number())
    }
}

/// A state at the end of an increment.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    pub penetration: f64,
    pub pressure: f64,
    pub shear: [f64; 2],
    pub vars: Vec<f64>,
}

impl State {
    pub fn initial(law: &dyn Interface) -> Self {
        let mut vars = vec![0.0; law.variables().iter().map(|variable| variable.len()).sum()];
        law.initial(&mut vars);
        Self { penetration: 0.0, pressure: 0.0, shear: [0.0; 2], vars }
    }

    pub fn past(&self, sample: &Sample, dt: f64) -> Past<'_> {
        let past = Past {
            penalty: sample.penalties[0],
            tangential_penalty: sample.penalties[1],
            penetration: self.penetration,
            pressure: self.pressure,
            shear: self.shear,
            vars: &self.vars,
            dt,
        };
        Past { penetration: self.penetration.max(sample.interface.touch(&past)), ..past }
    }

    /// The state after a motion, and the response.
    pub fn moved(&self, sample: &Sample, motion: &Motion<f64>, dt: f64) -> Result<(Self, Linearised), Failure> {
        let mut vars = self.vars.clone();
        let response = sample.interface.respond(numbers(motion), &self.past(sample, dt), &mut vars)?;
        let (pressure, shear) = (response.pressure(), response.shear());
        Ok((Self { penetration: motion.penetration, pressure, shear, vars }, response))
    }
}

/// What a law is asked.
pub fn numbers(motion: &Motion<f64>) -> [f64; 3] {
    [motion.penetration, motion.slip[0], motion.slip[1]]
}

/// A random increment from a state: pressed by up to one and a half of the usual pressure, slipped by anything from the
/// elastic slip to the whole way.
pub fn increment(sample: &Sample, state: &State, random: &mut Random) -> (Motion<f64>, f64) {
    let dt = sample.time * random.decades(-3.0, -1.5);
    let touch = sample.interface.touch(&state.past(sample, dt));
    let penetration = touch + (0.02 + 1.5 * random.number()) * sample.pressure / sample.penalties[0];
    let least = (1e-2 * sample.pressure / sample.penalties[1]).log10();
    let most = (0.1 * sample.slip).max(sample.pressure / sample.penalties[1]).log10();
    let (size, angle) = (random.decades(least, most), std::f64::consts::TAU * random.number());
    (Motion { penetration, slip: [size * angle.cos(), size * angle.sin()] }, dt)
}

/// A state reached by a few random increments from the initial one; what fails on the way is left out.
pub fn reached(sample: &Sample, random: &mut Random) -> State {
    let mut state = State::initial(sample.interface.as_ref());
    for _ in 0..4 {
        let (motion, dt) = increment(sample, &state, random);
        if let Ok((next, _)) = state.moved(sample, &motion, dt) {
            state = next;
        }
    }
    state
}
