//! Lists, and tables whose keys are names.

use super::Form;
use super::name::Naming;
use crate::diagnose::Diagnostic;
use crate::reader::{Name, Reader};
use crate::schema::{Key, Schema};
use crate::source::Place;
use crate::tree::{Node, TreeEntry, Value};
use asperity_core::declare::nearest;
use std::ops::RangeInclusive;

/// A list of as many items as `lengths` says.
pub fn list<F: Form>(item: F, lengths: RangeInclusive<usize>) -> List<F> {
    List { item, lengths }
}

/// See [`list`].
pub struct List<F> {
    item: F,
    lengths: RangeInclusive<usize>,
}

impl<F> List<F> {
    /// How many items there must be.
    fn count(&self) -> String {
        let items = |n: &usize| if *n == 1 { "1 item".to_owned() } else { format!("{n} items") };
        match (self.lengths.start(), self.lengths.end()) {
            (0, &usize::MAX) => "any number of items".to_owned(),
            (least, &usize::MAX) => format!("at least {}", items(least)),
            (least, most) if least == most => items(least),
            (least, most) => format!("{least} to {}", items(most)),
        }
    }
}

impl<F: Form> List<F> {
    fn refuse<T>(&self, node: &Node, reader: &mut Reader) -> Option<T> {
        let (path, kind) = (reader.path(), node.value.kind());
        let what = format!("`{path}` must be a list of {}, not {kind}", self.count());
        let diagnostic = Diagnostic::error(what).at(node.place);
        let one_table = matches!((self.item.schema(), &node.value), (Schema::Table(_), Value::Table(_)));
        reader.report(if one_table { diagnostic.help(format!("write [[{path}]]")) } else { diagnostic });
        None
    }
}

impl<F: Form> Form for List<F> {
    type Value = Vec<F::Value>;
    fn schema(&self) -> Schema {
        let (least, most) = (*self.lengths.start(), *self.lengths.end());
        Schema::List { item: Box::new(self.item.schema()), least, most }
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<Self::Value> {
        let Value::List(items) = &node.value else {
            return self.refuse(node, reader);
        };
        if !self.lengths.contains(&items.len()) {
            let has = if items.is_empty() { "none".to_owned() } else { items.len().to_string() };
            let what = format!("`{}` must have {}; it has {has}", reader.path(), self.count());
            reader.report(Diagnostic::error(what).at(node.place));
            return None;
        }
        let read = |(i, item): (usize, &Node), reader: &mut Reader| {
            reader.under((i + 1).to_string(), |reader| self.item.read(item, reader))
        };
        let values: Vec<_> = items.iter().enumerate().map(|item| read(item, reader)).collect();
        values.into_iter().collect()
    }
}

/// A table whose keys are names; values in the order in which they are written.
pub fn map<F: Form>(names: Naming, item: F) -> Map<F> {
    Map { names, item }
}

/// See [`map`].
pub struct Map<F> {
    names: Naming,
    item: F,
}

impl<F: Form> Map<F> {
    /// What to write instead of a name with points that stands without quotes, which TOML reads as table in table.
    fn unquoted(&self, entry: &TreeEntry, reader: &Reader) -> Option<Diagnostic> {
        let Schema::Table(known) = self.item.schema() else { return None };
        let (rest, place) = below(entry, &known).filter(|_| !self.names.defines)?;
        let path = reader.path();
        let (name, kind) = (format!("{}.{rest}", entry.key), path.rsplit('.').next().unwrap_or_default());
        let what = format!("`{path}.{}` has no key `{rest}`", entry.key);
        let diagnostic = Diagnostic::error(what).at(place).label("a name with a point stands in quotes");
        Some(diagnostic.help(format!("write {kind}.\"{name}\"")))
    }
}

/// The tables in an entry that none of the known keys means, not even misspelt: `right` of `block.right = { x = 0 }`.
fn below(entry: &TreeEntry, known: &[Key]) -> Option<(String, Place)> {
    let Value::Table(inner) = &entry.node.value else { return None };
    let is_table = |entry: &&TreeEntry| matches!(entry.node.value, Value::Table(_));
    let is_unknown = |entry: &&TreeEntry| nearest(&entry.key, known.iter().map(|key| key.name)).is_none();
    let unknown = inner.iter().filter(is_table).find(is_unknown)?;
    Some(match below(unknown, known) {
        Some((rest, place)) => (format!("{}.{rest}", unknown.key), place),
        None => (unknown.key.clone(), unknown.place),
    })
}

impl<F: Form> Form for Map<F> {
    type Value = Vec<(Name, F::Value)>;
    fn schema(&self) -> Schema {
        let Naming { names, defines } = self.names;
        Schema::Map { names, defines, item: Box::new(self.item.schema()) }
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<Self::Value> {
        let mut values = Vec::new();
        for entry in reader.table(node)? {
            if let Some(unquoted) = self.unquoted(entry, reader) {
                reader.report(unquoted);
                values.push(None);
                continue;
            }
            let name = Name { text: entry.key.clone(), place: entry.place };
            if name.text.is_empty() && self.names.defines {
                let what = format!("a {} needs a name that is not empty", self.names.names.noun());
                reader.report(Diagnostic::error(what).at(name.place));
            }
            if name.text.contains(char::is_control) && self.names.defines {
                let what = format!("the name of a {} holds control characters", self.names.names.noun());
                let help = "names stand in tables and on screens: give it another";
                reader.report(Diagnostic::error(what).at(name.place).help(help));
            }
            reader.mention(self.names.names, name.clone(), self.names.defines);
            let value = reader.under(entry.key.clone(), |reader| self.item.read(&entry.node, reader));
            values.push(value.map(|value| (name, value)));
        }
        values.into_iter().collect()
    }
}
