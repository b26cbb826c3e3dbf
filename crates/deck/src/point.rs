//! Reads the deck of a material point, and runs it.

use super::diagnose::{Diagnostic, Diagnostics};
use super::form::KeyTable;
use super::keys::{self, PointCurve, PointDeck};
use super::kind::Kind;
use super::reader::Name;
use super::source::Spot;
use super::{folder_of, gathered, text_of, understood};
use asperity_core::Error;
use asperity_core::material::Material;
use asperity_results::point::{Curve, MaterialPointDriver, PointTangentCheck, Record, Stage, columns};
use std::path::Path;
use std::sync::Arc;

/// A deck of a material point that was read, with its laws.
pub struct LoadedPoint {
    /// The deck.
    pub deck: PointDeck,
    /// Each material's name and law.
    pub materials: Vec<(String, Arc<dyn Material>)>,
    /// The path.
    pub stages: Vec<Stage>,
    /// What is drawn.
    pub curves: Vec<Curve>,
    /// Warnings and notes, and the texts that they point into.
    pub diagnostics: Diagnostics,
}

/// Reads the deck of a material point from its file.
///
/// # Errors
/// [`Diagnostics`] with everything that is wrong in it.
pub fn load_point(path: &Path, sets: &[String]) -> Result<LoadedPoint, Diagnostics> {
    let (name, text) = text_of(path)?;
    read_point(&text, &name, folder_of(path), sets)
}

/// Reads the deck of a material point from text that messages call `name`; files are looked for in `folder`.
///
/// # Errors
/// [`Diagnostics`] with everything that is wrong in it.
pub fn read_point(text: &str, name: &str, folder: &Path, sets: &[String]) -> Result<LoadedPoint, Diagnostics> {
    let (deck, mut reader) = understood(text, name, sets, Kind::Point, PointDeck::read);
    let made = deck.filter(|_| reader.errors() == 0).and_then(|deck| {
        let materials = materials(&deck, folder, &mut reader.diagnostics);
        let names: Vec<String> = materials.iter().flat_map(|(_, law)| columns(law.as_ref())).collect();
        let curves = curves(&deck.curve, &names, &mut reader.diagnostics);
        (reader.errors() == 0).then_some((deck, materials, curves))
    });
    let diagnostics = gathered(reader.sources, reader.diagnostics);
    let Some((deck, materials, curves)) = made else { return Err(diagnostics.without_notes()) };
    let stages: Vec<Stage> = deck.step.iter().enumerate().map(|(i, step)| step.stage(i + 1)).collect();
    let curves = if curves.is_empty() { Curve::standard(&stages) } else { curves };
    Ok(LoadedPoint { deck, materials, stages, curves, diagnostics })
}

fn materials(deck: &PointDeck, folder: &Path, found: &mut Vec<Diagnostic>) -> Vec<(String, Arc<dyn Material>)> {
    let mut materials = Vec::new();
    for (name, law) in &deck.material {
        match law.build(&name.text, folder, false).and_then(|(law, _)| integrated(deck, law)) {
            Ok(material) => {
                let note = material.advice().map(|advice| Diagnostic::note(format!("`material.{name}`: {advice}")));
                found.extend(note.map(|note| note.at(law.place())));
                materials.push((name.text.clone(), material));
            }
            Err(why) => found.push(Diagnostic::error(why).at(law.place())),
        }
        refuse_name(name, found);
    }
    materials
}

/// A name that a table's file cannot have.
pub(super) fn refuse_name(name: &Name, found: &mut Vec<Diagnostic>) {
    if !name.text.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-') {
        let what = format!("the name `{name}` cannot name a file");
        found.push(Diagnostic::error(what).at(name.place).help("use letters, digits, `_` and `-`"));
    }
}

fn integrated(deck: &PointDeck, law: Arc<dyn Material>) -> Result<Arc<dyn Material>, String> {
    let material = deck.completed(law)?;
    Ok(keys::integrated(material.as_ref(), deck.rate, deck.update.as_ref())?.map_or(material, Arc::from))
}

pub(super) fn curves(curves: &[PointCurve], names: &[String], found: &mut Vec<Diagnostic>) -> Vec<Curve> {
    let mut check = |name: &Spot<String>| {
        if !names.contains(&name.value) {
            let what = format!("there is no column `{}`", name.value);
            found.push(Diagnostic::error(what).at(name.place).suggest(&name.value, names.iter().map(String::as_str)));
        }
        name.value.clone()
    };
    let mut one = |x: &Spot<String>, y: &[Spot<String>]| Curve {
        x: check(x),
        y: y.iter().map(&mut check).collect(),
        asked: true,
    };
    curves.iter().map(|curve| one(&curve.x, &curve.y)).collect()
}

impl LoadedPoint {
    /// Drives every material along the path.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where the path of one cannot be followed.
    pub fn run(&self) -> Result<Vec<Record>, Error> {
        whole(self.follow())
    }

    /// Drives every material along the path as far as it can be followed; with what stopped the first that was stopped.
    pub fn follow(&self) -> (Vec<Record>, Option<Error>) {
        let stress = self.initial_stress();
        all(self.materials.iter().map(|(name, material)| self.drive(name, material.as_ref(), stress)))
    }

    /// Drives every material along the path as far as it can be followed, and compares its tangents with differences.
    pub fn tangents(&self) -> Vec<(String, PointTangentCheck)> {
        let one = |(name, material): &(String, Arc<dyn Material>)| {
            let mut probe = MaterialPointDriver::new(material.as_ref(), self.initial_stress());
            probe.check = Some(PointTangentCheck::default());
            // Why a path ends is told by `follow`.
            let _ = self.stages.iter().try_for_each(|stage| probe.follow(stage, |_| {}));
            (name.clone(), probe.check.unwrap_or_default())
        };
        self.materials.iter().map(one).collect()
    }

    fn initial_stress(&self) -> Option<[f64; 6]> {
        self.deck.initial_stress.as_ref().map(|s| s.all().map(|s| s.unwrap_or(0.0)))
    }

    fn drive(&self, name: &str, material: &dyn Material, stress: Option<[f64; 6]>) -> (Record, Option<Error>) {
        let mut probe = MaterialPointDriver::new(material, stress);
        let mut record = Record::new(name, material);
        record.push(&probe);
        let mut follow = |stage| probe.follow(stage, |probe| record.push(probe));
        let stopped = self.stages.iter().try_for_each(&mut follow).err();
        (record, stopped)
    }
}

/// All records, and the first thing that stopped one, with its name.
pub(super) fn all(driven: impl Iterator<Item = (Record, Option<Error>)>) -> (Vec<Record>, Option<Error>) {
    let mut first = None;
    let records = driven.map(|(record, stopped)| {
        let named = stopped.map(|error| Error::NotConverged(format!("{}, {error}", record.name)));
        first = first.take().or(named);
        record
    });
    (records.collect(), first)
}

/// The records of paths that were followed to their ends.
pub(super) fn whole((records, stopped): (Vec<Record>, Option<Error>)) -> Result<Vec<Record>, Error> {
    stopped.map_or(Ok(records), Err)
}
