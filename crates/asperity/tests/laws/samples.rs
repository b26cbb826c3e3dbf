//! The laws as their example decks set them, and random paths.

use asperity::deck::keys::SolidLaw;
use asperity::deck::{LoadedPoint, Name, load_point};
use asperity::material::{Material, Spin, VariableKind};
use asperity::tensor::Tensor2;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Decks of the material point.
pub fn decks() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/point");
    let mut paths: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    paths
}

pub fn load(path: &Path, sets: &[&str]) -> LoadedPoint {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    load_point(path, &sets).unwrap_or_else(|error| panic!("{}", error.render(false)))
}

/// A law as a deck sets it, by plain backward Euler, in the frames of Jaumann, of Green and Naghdi and of the logarithmic rate.
pub struct Sample {
    /// Name of the registered law and of the deck that sets it.
    pub name: String,
    pub law: &'static str,
    pub material: Arc<dyn Material>,
}

pub fn samples() -> Vec<Sample> {
    let of = |path: &PathBuf| {
        let deck = load(path, &[]).deck;
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        let sample = |(name, law): &(Name, SolidLaw)| {
            let (material, _) = law.build(&name.text, Path::new(""), false).unwrap();
            let (name, material) = (format!("{} of {stem}", law.name()), deck.completed(material).unwrap());
            let spun = |spin: Spin| {
                let material = material.with_spin(spin).ok()?;
                Some(Sample { name: format!("{name}, {spin:?}"), law: law.name(), material: material.into() })
            };
            let spun = [Spin::Polar, Spin::Logarithmic].into_iter().filter_map(spun).collect::<Vec<_>>();
            [Sample { name, law: law.name(), material }].into_iter().chain(spun)
        };
        deck.material.iter().flat_map(sample).collect::<Vec<_>>()
    };
    decks().iter().flat_map(of).collect()
}

/// The same laws in small strain, those that have one.
pub fn small_samples() -> Vec<Sample> {
    let small = |Sample { name, law, material }| {
        let material = material.with_small_strain().ok()?;
        Some(Sample { name: format!("{name}, small strain"), law, material: material.into() })
    };
    samples().into_iter().filter_map(small).collect()
}

/// Random numbers (xorshift), the same on every machine.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(0x9E37_79B9_7F4A_7C15 ^ seed.wrapping_mul(0xD134_2543_DE82_EF95))
    }
    /// Between -1 and 1.
    pub fn number(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
    pub fn tensor(&mut self) -> Tensor2 {
        Tensor2::from_fn(|_, _| self.number())
    }
    /// A deformation whose size is anything from `10^least` to `10^most`.
    pub fn deformation(&mut self, [least, most]: [f64; 2]) -> Tensor2 {
        let size = 10_f64.powf(least + 0.5 * (self.number() + 1.0) * (most - least));
        Tensor2::identity() + self.tensor() * size
    }
    pub fn rotation(&mut self) -> Tensor2 {
        let half = self.tensor().skew();
        (Tensor2::identity() - half).inverse() * (Tensor2::identity() + half)
    }
}

pub fn initial(material: &dyn Material) -> Vec<f64> {
    let mut state = vec![0.0; material.state_len()];
    material.initialise(&mut state);
    state
}

/// A state reached by a few random deformations from the initial one; what fails on the way is left out.
pub fn reached(material: &dyn Material, random: &mut Random) -> Vec<f64> {
    let mut state = initial(material);
    for _ in 0..4 {
        let mut new = state.clone();
        if material.update(&random.deformation([-4.5, -2.0]), 0.1.into(), &state, &mut new).is_ok() {
            state = new;
        }
    }
    state
}

pub fn stress(state: &[f64]) -> Tensor2 {
    Tensor2::from_voigt(std::array::from_fn(|i| state[i]))
}

/// The state turned by a rotation: stress, tensors and vectors, not scalars.
pub fn turned(material: &dyn Material, state: &[f64], q: &Tensor2) -> Vec<f64> {
    let turn = |values: &[f64]| (*q * stress(values) * q.transpose()).to_voigt();
    let mut out = turn(state).to_vec();
    let mut at = 6;
    for variable in material.variables() {
        let values = &state[at..at + variable.len()];
        match variable.kind {
            VariableKind::Scalar => out.extend(values),
            VariableKind::Vector => out.extend((0..3).map(|i| (0..3).map(|j| q[(i, j)] * values[j]).sum::<f64>())),
            VariableKind::Symmetric => out.extend(turn(values)),
        }
        at += variable.len();
    }
    out
}
