//! Reads the deck of a point of an interface, and runs it.

use super::diagnose::{Diagnostic, Diagnostics};
use super::form::KeyTable;
use super::keys::InterfaceDeck;
use super::kind::Kind;
use super::point::{LoadedPoint, all, curves, refuse_name, whole};
use super::tree::{self, Value};
use super::{folder_of, gathered, text_of, understood};
use asperity_core::Error;
use asperity_core::interface::Interface;
use asperity_results::point::{Curve, PointTangentCheck, Record, Slide, drive, slider_columns, yield_surface};
use std::path::Path;

/// A deck of a point of an interface that was read, with its laws.
pub struct LoadedInterface {
    /// The deck.
    pub deck: InterfaceDeck,
    /// Each interface's name and law.
    pub laws: Vec<(String, Box<dyn Interface>)>,
    /// The path.
    pub stages: Vec<Slide>,
    /// What is drawn.
    pub curves: Vec<Curve>,
    /// Warnings and notes, and the texts that they point into.
    pub diagnostics: Diagnostics,
}

/// A deck of one point, of a solid or of an interface.
pub enum Driven {
    /// Of a solid.
    Solid(Box<LoadedPoint>),
    /// Of an interface.
    Interface(Box<LoadedInterface>),
}

/// Reads the deck of a point from its file: that of an interface if it has the key `interface`.
///
/// # Errors
/// [`Diagnostics`] with everything that is wrong in it.
pub fn load_driven(path: &Path, sets: &[String]) -> Result<Driven, Diagnostics> {
    let (name, text) = text_of(path)?;
    read_driven(&text, &name, folder_of(path), sets)
}

/// Reads the deck of a point from text that messages call `name`; files are looked for in `folder`.
///
/// # Errors
/// [`Diagnostics`] with everything that is wrong in it.
pub fn read_driven(text: &str, name: &str, folder: &Path, sets: &[String]) -> Result<Driven, Diagnostics> {
    if has_interface(text) {
        return read_interface(text, name, sets).map(|loaded| Driven::Interface(Box::new(loaded)));
    }
    super::read_point(text, name, folder, sets).map(|loaded| Driven::Solid(Box::new(loaded)))
}

fn has_interface(text: &str) -> bool {
    matches!(&tree::parse(text, 0).0.value, Value::Table(entries) if entries.iter().any(|e| e.key == "interface"))
}

/// Reads the deck of a point of an interface from text that messages call `name`.
///
/// # Errors
/// [`Diagnostics`] with everything that is wrong in it.
pub fn read_interface(text: &str, name: &str, sets: &[String]) -> Result<LoadedInterface, Diagnostics> {
    let (deck, mut reader) = understood(text, name, sets, Kind::Point, InterfaceDeck::read);
    let made = deck.filter(|_| reader.errors() == 0).and_then(|deck| {
        let laws = laws(&deck, &mut reader.diagnostics);
        let names: Vec<String> = laws.iter().flat_map(|(_, law)| slider_columns(law.as_ref())).collect();
        let curves = curves(&deck.curve, &names, &mut reader.diagnostics);
        (reader.errors() == 0).then_some((deck, laws, curves))
    });
    let diagnostics = gathered(reader.sources, reader.diagnostics);
    let Some((deck, laws, curves)) = made else { return Err(diagnostics.without_notes()) };
    let mut slip = [0.0; 2];
    let stages = deck.step.iter().enumerate().map(|(i, step)| step.slide(i + 1, &mut slip)).collect();
    let curves = if curves.is_empty() { Curve::of_interfaces() } else { curves };
    Ok(LoadedInterface { deck, laws, stages, curves, diagnostics })
}

fn laws(deck: &InterfaceDeck, found: &mut Vec<Diagnostic>) -> Vec<(String, Box<dyn Interface>)> {
    let mut laws = Vec::new();
    for (name, law_keys) in &deck.interface {
        match law_keys.build().and_then(|law| integrated(deck, law)) {
            Ok(law) if law.radius() > 0.0 => {
                let what = "a single point has no neighbours over which `radius` could take the mean of the pressure";
                found.push(Diagnostic::error(what).at(law_keys.place));
            }
            Ok(law) => laws.push((name.text.clone(), law)),
            Err(why) => found.push(Diagnostic::error(why).at(law_keys.place)),
        }
        refuse_name(name, found);
    }
    laws
}

fn integrated(deck: &InterfaceDeck, law: Box<dyn Interface>) -> Result<Box<dyn Interface>, String> {
    match &deck.update {
        Some(keys) => law.with_update(keys.update()),
        None => Ok(law),
    }
}

impl LoadedInterface {
    /// Drives every law along the path.
    ///
    /// # Errors
    /// [`Error::NotConverged`] where the path of one cannot be followed.
    pub fn run(&self) -> Result<Vec<Record>, Error> {
        whole(self.follow())
    }

    /// Drives every law along the path as far as it can be followed; with what stopped the first that was stopped.
    pub fn follow(&self) -> (Vec<Record>, Option<Error>) {
        let penalties = [self.deck.penalty, self.deck.tangential_penalty.unwrap_or(self.deck.penalty)];
        all(self.laws.iter().map(|(name, law)| drive(name, law.as_ref(), penalties, &self.stages)))
    }

    /// The yield surfaces of the laws before any motion, up to twice the pressure of their records; of those that have one.
    pub fn surfaces(&self, records: &[Record]) -> Vec<Record> {
        let penalties = [self.deck.penalty, self.deck.tangential_penalty.unwrap_or(self.deck.penalty)];
        let most = |record: &Record| record.column("pressure").into_iter().flatten().fold(0.0, f64::max);
        let one = |((name, law), record): (&(String, Box<dyn Interface>), &Record)| {
            yield_surface(name, law.as_ref(), penalties, 2.0 * most(record))
        };
        self.laws.iter().zip(records).filter_map(one).collect()
    }
}

impl Driven {
    /// What pictures call it.
    pub fn title(&self) -> &str {
        match self {
            Self::Solid(loaded) => &loaded.deck.title,
            Self::Interface(loaded) => &loaded.deck.title,
        }
    }
    /// What is drawn.
    pub fn curves(&self) -> &[Curve] {
        match self {
            Self::Solid(loaded) => &loaded.curves,
            Self::Interface(loaded) => &loaded.curves,
        }
    }
    /// Warnings and notes.
    pub fn diagnostics(&self) -> &Diagnostics {
        match self {
            Self::Solid(loaded) => &loaded.diagnostics,
            Self::Interface(loaded) => &loaded.diagnostics,
        }
    }
    /// What is drawn beside the records: yield surfaces of interfaces, as columns `pressure` and `shear`.
    pub fn surfaces(&self, records: &[Record]) -> Vec<Record> {
        match self {
            Self::Solid(_) => Vec::new(),
            Self::Interface(loaded) => loaded.surfaces(records),
        }
    }
    /// The tangents of the laws along the path against differences, by the names of their materials.
    ///
    /// # Errors
    /// In words, for laws of interfaces.
    pub fn tangents(&self) -> Result<Vec<(String, PointTangentCheck)>, Error> {
        match self {
            Self::Solid(loaded) => Ok(loaded.tangents()),
            Self::Interface(_) => Err(Error::input(
                "tangents are compared along paths of laws of solids, and these are laws of interfaces",
            )),
        }
    }
    /// Drives every law along the path as far as it can be followed; with what stopped the first that was stopped.
    pub fn follow(&self) -> (Vec<Record>, Option<Error>) {
        match self {
            Self::Solid(loaded) => loaded.follow(),
            Self::Interface(loaded) => loaded.follow(),
        }
    }
}
