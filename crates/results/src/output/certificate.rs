//! The certificate of a run: how far the accepted increments were from what they claim. Reports hand in readings with each
//! frame; of every figure and every thing that it is read of the worst is kept, with where and when it was.

use super::figures::{FIGURES, Figure, Fold};
use super::quantity::Frame;
use asperity_core::tensor::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// One figure of one thing at an accepted increment.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The figure's name in [`FIGURES`].
    pub figure: &'static str,
    /// What it is read of, in words: "contact 'bore'". Empty for the model.
    pub of: String,
    /// The reading.
    pub value: f64,
    /// What the reading is to be divided by, where the figure is a ratio to something that grows with the run, as the
    /// forces in play: the largest of all increments is taken.
    pub scale: Option<f64>,
    /// Where it was read; none where that is nowhere in particular.
    pub position: Option<Vec3>,
}

/// A figure at its worst.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Occasion {
    /// The figure; not a number where that is what was read.
    #[serde(deserialize_with = "or_not_a_number")]
    pub value: f64,
    /// What it may be; none where the figure has no limit.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub limit: Option<f64>,
    /// Of what; empty for the model.
    pub of: String,
    /// Where; null where that is nowhere in particular.
    pub position: Option<[f64; 3]>,
    /// In which step, counted from one.
    pub step: usize,
    /// In which accepted increment, counted from one over all steps.
    pub increment: usize,
    /// When.
    pub time: f64,
}

/// What is no finite number is null in JSON.
fn or_not_a_number<'de, D: serde::Deserializer<'de>>(value: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(value)?.unwrap_or(f64::NAN))
}

/// The worst of each figure of each thing over all accepted increments. A figure is absent, never zero, when no frame
/// reported it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Certificate(BTreeMap<&'static str, BTreeMap<String, Extreme>>);

/// The worst reading of a figure of one thing, and the largest scale.
#[derive(Debug, Clone, PartialEq)]
struct Extreme {
    value: f64,
    /// The last reading.
    last: f64,
    scale: Option<f64>,
    position: Option<Vec3>,
    step: usize,
    increment: usize,
    time: f64,
}

/// What figures may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Limits(BTreeMap<&'static str, f64>);

/// A figure beyond its limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubt {
    /// The figure.
    pub figure: &'static Figure,
    /// When and where it was worst.
    pub worst: Occasion,
}

impl Reading {
    /// A reading of a figure of a thing.
    pub fn new(figure: &'static str, of: impl Into<String>, value: f64) -> Self {
        Self { figure, of: of.into(), value, scale: None, position: None }
    }
    /// Relative to the largest of such scales.
    pub fn over(self, scale: f64) -> Self {
        Self { scale: Some(scale), ..self }
    }
    /// Somewhere; nowhere in particular if that is not finite.
    pub fn at(self, position: Vec3) -> Self {
        Self { position: Some(position).filter(|x| x.is_finite()), ..self }
    }
}

impl Fold {
    /// Whether a reading is worse than the one before. What is not a number is worse than any number.
    fn is_worse(self, new: f64, old: f64) -> bool {
        match self {
            _ if old.is_nan() => false,
            Self::Largest | Self::Lasting => new.is_nan() || new > old,
            Self::Least => new.is_nan() || new < old,
            Self::Sum => new != 0.0,
        }
    }
}

impl Extreme {
    fn figure(&self) -> f64 {
        match self.scale {
            None => self.value,
            Some(scale) if scale > 0.0 => self.value / scale,
            // Where nothing is in play nothing is missing.
            Some(_) => 0.0,
        }
    }
}

impl Certificate {
    /// Takes in the readings of an accepted frame.
    pub fn observe(&mut self, frame: &Frame) {
        frame.readings().iter().for_each(|reading| self.take(reading, (frame.step, frame.increment, frame.time)));
    }

    /// Takes in a reading of an increment: its step, its number and its time.
    pub(super) fn take(&mut self, reading: &Reading, (step, increment, time): (usize, usize, f64)) {
        let Some(figure) = Figure::named(reading.figure) else { return };
        let &Reading { value, scale, position, .. } = reading;
        let of = self.0.entry(figure.name).or_default();
        let before = of.get(&reading.of).map_or(0.0, |worst| worst.last);
        let (last, lasts) = (value, figure.fold == Fold::Lasting && !value.is_nan());
        let value = if lasts { value.min(before) } else { value };
        let new = Extreme { value, last, scale, position, step, increment, time };
        let Some(worst) = of.get_mut(&reading.of) else {
            of.insert(reading.of.clone(), new);
            return;
        };
        let scale = worst.scale.zip(scale).map(|(old, new)| old.max(new)).or(scale);
        let (old, sum) = (worst.value, worst.value + value);
        if figure.fold.is_worse(value, old) {
            *worst = new;
        }
        if figure.fold == Fold::Sum {
            worst.value = sum;
        }
        (worst.scale, worst.last) = (scale, last);
    }

    /// A figure at its worst of all things; what is counted is the sum over them.
    pub fn figure(&self, name: &str) -> Option<f64> {
        let figure = Figure::named(name)?;
        if figure.fold == Fold::Sum {
            return Some(self.0.get(figure.name)?.values().map(|extreme| extreme.value).sum());
        }
        Some(self.worst_of(figure)?.1.figure())
    }

    /// A figure of each thing that it was read of.
    pub fn each(&self, name: &str) -> impl Iterator<Item = (&str, f64)> {
        self.0.get(name).into_iter().flatten().map(|(of, extreme)| (of.as_str(), extreme.figure()))
    }

    /// When and where a figure was worst.
    pub fn worst(&self, name: &str, limits: &Limits) -> Option<Occasion> {
        let (of, extreme) = self.worst_of(Figure::named(name)?)?;
        let &Extreme { step, increment, time, .. } = extreme;
        let (value, position) = (self.figure(name)?, extreme.position.map(|x| x.0));
        Some(Occasion { value, limit: limits.of(name), of: of.into(), position, step, increment, time })
    }

    fn worst_of(&self, figure: &Figure) -> Option<(&str, &Extreme)> {
        let all = self.0.get(figure.name)?.iter().map(|(of, extreme)| (of.as_str(), extreme));
        all.reduce(|a, b| if figure.fold.is_worse(b.1.figure(), a.1.figure()) { b } else { a })
    }

    /// The figures that passed their limits.
    pub fn doubts(&self, limits: &Limits) -> Vec<Doubt> {
        let doubt = |figure: &'static Figure| {
            let worst = self.worst(figure.name, limits)?;
            // What is not a number is within no limit.
            let within = worst.value <= worst.limit?;
            (!within).then_some(Doubt { figure, worst })
        };
        FIGURES.iter().filter_map(doubt).collect()
    }
}

impl Default for Limits {
    /// Those that hold where a deck says nothing.
    fn default() -> Self {
        let limit = |figure: &Figure| Some((figure.name, figure.limit?.default.parse().ok()?));
        Self(FIGURES.iter().filter_map(limit).collect())
    }
}

impl Limits {
    /// The limit of a figure, if it has one.
    pub fn of(&self, name: &str) -> Option<f64> {
        self.0.get(name).copied()
    }
    /// Changes the limit of a figure that has one.
    pub fn set(&mut self, name: &str, limit: f64) {
        if let Some(old) = self.0.get_mut(name) {
            *old = limit;
        }
    }
}

impl std::fmt::Display for Doubt {
    /// Figure, place, time, limit and what helps.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { figure, worst } = self;
        write!(f, "doubtful: {} {:.2e}{}", figure.words.trim(), worst.value, worst.place())?;
        let (limit, name) = (worst.limit.unwrap_or(f64::NAN), figure.name);
        write!(f, ", beyond the limit of {limit} (`limits.{name}`)")?;
        figure.limit.map_or(Ok(()), |limit| write!(f, "; what helps: {}", limit.remedy))
    }
}

impl Occasion {
    /// Of what, where and when, as the end of a sentence.
    pub fn place(&self) -> String {
        let of = if self.of.is_empty() { String::new() } else { format!(" at {}", self.of) };
        let near = self.position.map_or(String::new(), |[x, y, z]| match z {
            0.0 => format!(" near ({x:.4}, {y:.4})"),
            _ => format!(" near ({x:.4}, {y:.4}, {z:.4})"),
        });
        format!("{of}{near} in increment {} (time {:.4})", self.increment, self.time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A certificate of readings, a list an increment.
    fn certificate(increments: &[&[Reading]]) -> Certificate {
        let mut certificate = Certificate::default();
        for (i, readings) in increments.iter().enumerate() {
            let mut frame = Frame::new(1, i + 1, 0.5 * (i + 1) as f64);
            readings.iter().for_each(|reading| frame.certify(reading.clone()));
            certificate.observe(&frame);
        }
        certificate
    }

    #[test]
    fn the_worst_of_all_increments_stands_with_where_and_when_it_was() {
        let at = |value, x| Reading::new("max_penetration", "contact 'bore'", value).at(Vec3::new(x, 0.0, 0.0));
        let found = certificate(&[&[at(1e-3, 1.0)], &[at(2e-3, 2.0)], &[at(5e-4, 3.0)]]);
        let worst = found.worst("max_penetration", &Limits::default()).unwrap();
        assert_eq!((worst.value, worst.increment, worst.time), (2e-3, 2, 1.0));
        assert_eq!((worst.of.as_str(), worst.position, worst.limit), ("contact 'bore'", Some([2.0, 0.0, 0.0]), None));
    }

    #[test]
    fn ratios_are_taken_to_the_largest_scale_of_the_run() {
        let energy = |missing, scale| Reading::new("energy_balance", "", missing).over(scale);
        let found = certificate(&[&[energy(0.1, 0.1)], &[energy(2.0, 10.0)], &[energy(1.0, 40.0)]]);
        assert_eq!(found.figure("energy_balance"), Some(0.05));
        assert_eq!(certificate(&[&[energy(0.0, 0.0)]]).figure("energy_balance"), Some(0.0));
    }

    #[test]
    fn counts_are_summed_and_the_least_is_the_worst_of_what_must_not_be_small() {
        let refused = |of: &str, n| Reading::new("rejected_false_contacts", of, n);
        let rubbed = |w| Reading::new("least_dissipation", "", w);
        let found = certificate(&[&[refused("a", 2.0), rubbed(-1e-18)], &[refused("a", 3.0), refused("b", 1.0)]]);
        assert_eq!(found.figure("rejected_false_contacts"), Some(6.0));
        assert_eq!(found.figure("least_dissipation"), Some(-1e-18));
        assert_eq!(found.figure("leap"), None, "absent, not zero");
        assert_eq!(found.each("rejected_false_contacts").collect::<Vec<_>>(), [("a", 5.0), ("b", 1.0)]);
    }

    /// Each figure with a limit is doubted beyond it and not at it, by the default and by another number.
    #[test]
    fn every_limit_is_held() {
        let limited = || FIGURES.iter().filter(|figure| figure.limit.is_some());
        assert!(limited().count() >= 4);
        for figure in limited() {
            let default: f64 = figure.limit.unwrap().default.parse().unwrap();
            let doubts = |value: f64, limits: &Limits| {
                let reading = [Reading::new(figure.name, "contact 'c'", value)];
                certificate(&[&reading, &reading]).doubts(limits)
            };
            assert!(doubts(default, &Limits::default()).is_empty(), "{}", figure.name);
            let mut wider = Limits::default();
            let bad = 2.0 * default.max(0.5);
            wider.set(figure.name, 3.0 * bad);
            assert!(doubts(bad, &wider).is_empty());
            for bad in [bad, f64::NAN] {
                let found = doubts(bad, &Limits::default());
                let [doubt] = &found[..] else { panic!("one doubt of {}", figure.name) };
                let told = doubt.to_string();
                let when = if figure.fold == Fold::Lasting && !bad.is_nan() {
                    "increment 2 ("
                } else {
                    "increment 1 (time 0.5"
                };
                let parts = [figure.name, figure.limit.unwrap().remedy, "contact 'c'", when];
                assert!(parts.iter().all(|part| told.contains(part)), "{told}");
            }
        }
    }

    #[test]
    fn what_does_not_last_is_not_counted() {
        let unstable = |n| Reading::new("unstable", "", n);
        let of = |counts: &[f64]| {
            let frames: Vec<_> = counts.iter().map(|n| [unstable(*n)]).collect();
            let frames: Vec<&[Reading]> = frames.iter().map(|frame| &frame[..]).collect();
            certificate(&frames).figure("unstable")
        };
        assert_eq!([of(&[1.0, 0.0, 2.0, 0.0]), of(&[0.0, 1.0, 3.0, 2.0])], [Some(0.0), Some(2.0)]);
    }

    #[test]
    fn names_are_unique() {
        let names: std::collections::BTreeSet<_> = FIGURES.iter().map(|figure| figure.name).collect();
        assert_eq!(names.len(), FIGURES.len());
    }
}
