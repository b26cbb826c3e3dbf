//! Materials of a deck: a law of the registry with its numbers, or a law of a shared library.

use crate::diagnose::Diagnostic;
use crate::form::{ChosenLaw, Form, KeyTable, flag, key, law, list, number, table, table_of, tag, text, whole};
use crate::reader::Reader;
use crate::schema::Schema;
use crate::source::{Place, Spot};
use crate::tree::Node;
use asperity_core::declare::{Range, unit};
use asperity_core::files;
use asperity_core::material::external::{Library, load};
use asperity_core::material::{External, Material, laws};
use std::fmt;
use std::path::Path;
use std::sync::Arc;

table! {
    /// A law in a shared library with the customary interface of a UMAT.
    pub struct UmatKeys check lengths {
        /// The library, from the folder of the deck.
        library: Spot<String> = text("the path of a shared library").spot().required(),
        /// What the law is told as CMNAME.
        name: Option<Spot<String>> = text("a name").spot().unless_given("the name of the material"),
        /// Numbers of the law, PROPS.
        properties: Vec<f64> = list(number(unit::NONE, Range::ANY), 0..=usize::MAX).or("[]"),
        /// Number of its states, NSTATV.
        states: usize = whole(0..=10_000).or("0"),
        /// Its states before the first increment.
        initial_states: Option<Spot<Vec<f64>>> =
            list(number(unit::NONE, Range::ANY), 0..=usize::MAX).spot().unless_given("zeros"),
        /// Whether it keeps nothing between calls, so that several threads may call it at once.
        thread_safe: bool = flag().or("false"),
        /// Number of calls whose DDSDDE is compared with differences; one that differs ends the run.
        check_tangent: usize = whole(0..=1_000_000_000).or("0"),
    }
}

/// Longest CMNAME.
const NAME: usize = 80;

fn lengths(keys: &UmatKeys, reader: &mut Reader) {
    if let Some(initial) = keys.initial_states.as_ref().filter(|initial| initial.len() != keys.states) {
        let what =
            format!("`{}.initial_states` has {} values for {} states", reader.path(), initial.len(), keys.states);
        reader.report(Diagnostic::error(what).at(initial.place));
    }
    if let Some(name) = keys.name.as_ref().filter(|name| name.len() > NAME || !name.is_ascii()) {
        let what = format!("`{}.name` must be at most {NAME} letters of ASCII", reader.path());
        reader.report(Diagnostic::error(what).at(name.place));
    }
}

/// What a material is made of.
#[derive(Clone)]
pub enum SolidLaw {
    /// A law of the registry.
    Own(ChosenLaw<Box<dyn Material>>),
    /// A law of a library.
    Umat(UmatKeys),
}

impl fmt::Debug for SolidLaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Own(law) => law.fmt(f),
            Self::Umat(keys) => write!(f, "umat of {} {:?}", keys.library.value, keys.properties),
        }
    }
}

/// A law that was built, and the files that it comes from.
pub type BuiltLaw = (Arc<dyn Material>, Option<Vec<u8>>);

impl SolidLaw {
    /// The word of the deck.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Own(law) => law.entry.name,
            Self::Umat(_) => UMAT,
        }
    }

    /// Its numbers by their keys; those of a library have none.
    pub fn numbers(&self) -> Vec<(&'static str, f64)> {
        match self {
            Self::Own(law) => law.entry.parameters.iter().map(|p| p.key).zip(law.values.iter().copied()).collect(),
            Self::Umat(_) => Vec::new(),
        }
    }

    /// What a user should know of its calls, in words.
    pub fn advice(&self) -> Option<&'static str> {
        match self {
            Self::Umat(UmatKeys { thread_safe: false, .. }) => Some(SERIAL),
            _ => None,
        }
    }

    /// Where its fault is shown.
    pub fn place(&self) -> Place {
        match self {
            Self::Own(law) => law.place,
            Self::Umat(keys) => keys.library.place,
        }
    }

    /// The law of the material called `name` for a body in the plane or in space, and the bytes of its library, which is
    /// looked for in `folder`.
    ///
    /// # Errors
    /// In words, what the law says against its numbers, or why the library cannot be used.
    pub fn build(&self, name: &str, folder: &Path, plane: bool) -> Result<BuiltLaw, String> {
        let keys = match self {
            Self::Own(law) => return Ok((Arc::from(law.build()?), None)),
            Self::Umat(keys) => keys,
        };
        let path = folder.join(&keys.library.value);
        let bytes = files::read(&path).map_err(|error| error.to_string())?;
        let library = Library {
            path,
            name: keys.name.as_ref().map_or(name, |name| &name.value).to_owned(),
            properties: keys.properties.clone(),
            thread_safe: keys.thread_safe,
        };
        let states = keys.initial_states.as_ref().map_or_else(|| vec![0.0; keys.states], |states| states.value.clone());
        let law = External::new(load(&library)?, states, plane, keys.check_tangent)?;
        Ok((Arc::new(law), Some(bytes)))
    }
}

const UMAT: &str = "umat";

/// What is said of a law that is called by one thread at a time.
const SERIAL: &str =
    "the calls of the library are made one at a time; say `thread_safe = true` if it keeps nothing between them";

/// A law of a solid under its name.
pub fn solid_law() -> impl Form<Value = SolidLaw> {
    Choice
}

struct Choice;

impl Form for Choice {
    type Value = SolidLaw;

    fn schema(&self) -> Schema {
        let umat = key(&table_of::<UmatKeys>().required(), UMAT, "a law in a shared library, called as a UMAT is");
        match law(laws::ALL).schema() {
            Schema::OneOf(keys) => Schema::OneOf(keys.into_iter().chain([umat]).collect()),
            other => other,
        }
    }

    fn read(&self, node: &Node, reader: &mut Reader) -> Option<SolidLaw> {
        let names: Vec<&str> = laws::ALL.iter().map(|entry| entry.name).chain([UMAT]).collect();
        match tag(node, &names, reader)? {
            entry if entry.key == UMAT => {
                reader.under(UMAT, |reader| UmatKeys::read(&entry.node, reader)).map(SolidLaw::Umat)
            }
            _ => law(laws::ALL).read(node, reader).map(SolidLaw::Own),
        }
    }
}
