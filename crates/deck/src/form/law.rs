//! Laws and their numbers, as their registries declare them.

use super::scalar::Number;
use super::{Fields, Form, KeyField, list, number, tag};
use crate::diagnose::Diagnostic;
use crate::reader::Reader;
use crate::schema::{Key, Presence, Schema};
use crate::source::Place;
use crate::tree::Node;
use asperity_core::declare::{Entry, Pairs, Parameter, Range, find, unit};
use std::fmt;

/// One of the laws of a registry, under its name: `elastic = { young = 210e3, poisson = 0.3 }`.
pub fn law<T>(registry: &'static [Entry<T>]) -> LawForm<T> {
    LawForm(registry)
}

/// See [`law`].
pub struct LawForm<T: 'static>(&'static [Entry<T>]);

/// A law of a registry with its numbers.
pub struct ChosenLaw<T: 'static> {
    /// Its entry.
    pub entry: &'static Entry<T>,
    /// Its numbers in the order of the entry's parameters, then its pairs.
    pub values: Vec<f64>,
    /// Where it stands.
    pub place: Place,
}

impl<T> ChosenLaw<T> {
    /// The law itself; its numbers were found good when the deck was read.
    ///
    /// # Errors
    /// What the law says against its numbers.
    pub fn build(&self) -> Result<T, String> {
        (self.entry.build)(&self.values)
    }
}

impl<T> Clone for ChosenLaw<T> {
    fn clone(&self) -> Self {
        Self { entry: self.entry, values: self.values.clone(), place: self.place }
    }
}

impl<T> fmt::Debug for ChosenLaw<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {:?}", self.entry.name, self.values)
    }
}

impl<T> Form for LawForm<T> {
    type Value = ChosenLaw<T>;

    fn schema(&self) -> Schema {
        let key = |entry: &Entry<T>| Key {
            name: entry.name,
            doc: entry.meaning,
            schema: Schema::Table(keys(entry)),
            presence: Presence::Required,
        };
        Schema::OneOf(self.0.iter().map(key).collect())
    }

    fn read(&self, node: &Node, reader: &mut Reader) -> Option<ChosenLaw<T>> {
        let names: Vec<&str> = self.0.iter().map(|entry| entry.name).collect();
        let written = tag(node, &names, reader)?;
        let entry = find(self.0, &written.key)?;
        reader.under(entry.name, |reader| {
            let values = numbers(entry, &written.node, reader)?;
            let law = ChosenLaw { entry, values, place: written.place };
            if let Err(against) = law.build() {
                let what = format!("`{}`: {against}", reader.path());
                reader.report(Diagnostic::error(what).at(written.place));
                return None;
            }
            Some(law)
        })
    }
}

/// The keys of a law.
fn keys<T>(entry: &Entry<T>) -> Vec<Key> {
    let pairs = entry.pairs.iter().map(|p| pairs_of(p).required().key(p.key, p.meaning));
    entry.parameters.iter().map(|p| p.key(p.key, p.meaning)).chain(pairs).collect()
}

fn pairs_of(pairs: &Pairs) -> impl Form<Value = Vec<Vec<f64>>> {
    list(list(number(unit::NONE, Range::ANY), 2..=2), pairs.least..=pairs.most)
}

fn numbers<T>(entry: &Entry<T>, node: &Node, reader: &mut Reader) -> Option<Vec<f64>> {
    let mut fields = Fields::open(node, reader)?;
    let mut values: Vec<Option<f64>> = entry.parameters.iter().map(|p| fields.take(p.key, p, reader)).collect();
    if let Some(pairs) = &entry.pairs {
        let given = fields.take(pairs.key, &pairs_of(pairs).required(), reader);
        values.extend(given.map_or(vec![None], |rows| rows.concat().into_iter().map(Some).collect()));
    }
    let complete = fields.close(reader);
    values.into_iter().collect::<Option<_>>().filter(|_| complete)
}

impl KeyField for Parameter {
    type Value = f64;
    fn key(&self, name: &'static str, doc: &'static str) -> Key {
        let presence = self.default.map_or(Presence::Required, |value| Presence::Default(value.to_string()));
        Key { name, doc, schema: Schema::Number { unit: self.unit, range: self.range }, presence }
    }
    fn read(&self, node: Option<&Node>, _: &Node, reader: &mut Reader) -> Option<f64> {
        let form = Number { unit: self.unit, range: self.range, meaning: self.meaning };
        match (node, self.default) {
            (Some(node), _) => form.read(node, reader),
            (None, Some(value)) => {
                reader.leave_unsaid(&value.to_string());
                Some(value)
            }
            (None, None) => None,
        }
    }
}
