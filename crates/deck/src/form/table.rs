//! Tables: a Rust struct, its reader and its schema from one declaration.

use super::removed::successor;
use super::{Form, KeyField};
use crate::diagnose::Diagnostic;
use crate::reader::Reader;
use crate::schema::{Key, Schema};
use crate::tree::{Node, TreeEntry};
use asperity_core::declare::nearest;
use std::marker::PhantomData;

/// A struct that stands for a table of a deck.
pub trait KeyTable: Sized {
    /// Its keys.
    fn keys() -> Vec<Key>;
    /// The table read, or messages in `reader` and nothing.
    fn read(node: &Node, reader: &mut Reader) -> Option<Self>;
}

/// The form of a table.
pub fn table_of<T: KeyTable>() -> TableForm<T> {
    TableForm(PhantomData)
}

/// See [`table_of`].
pub struct TableForm<T>(PhantomData<T>);

impl<T: KeyTable> Form for TableForm<T> {
    type Value = T;
    fn schema(&self) -> Schema {
        Schema::Table(T::keys())
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<T> {
        T::read(node, reader)
    }
}

/// A table whose keys are being taken one by one; what is left over at the end is unknown.
pub struct Fields<'n> {
    node: &'n Node,
    entries: &'n [TreeEntry],
    known: Vec<&'static str>,
    missing: Vec<&'static str>,
}

impl<'n> Fields<'n> {
    /// Opens a table, or reports that it is none.
    pub fn open(node: &'n Node, reader: &mut Reader) -> Option<Self> {
        Some(Self { node, entries: reader.table(node)?, known: Vec::new(), missing: Vec::new() })
    }

    /// Reads one key.
    pub fn take<F: KeyField>(&mut self, name: &'static str, field: &F, reader: &mut Reader) -> Option<F::Value> {
        let entry = self.entries.iter().find(|entry| entry.key == name);
        self.known.push(name);
        let before = reader.diagnostics.len();
        let value = reader.under(name, |reader| field.read(entry.map(|e| &e.node), self.node, reader));
        if entry.is_none() && value.is_none() && reader.diagnostics.len() == before {
            self.missing.push(name);
        }
        value
    }

    /// Reports unknown and missing keys; whether there are none. A key that is missing because it is misspelt is
    /// reported once.
    pub fn close(self, reader: &mut Reader) -> bool {
        let unknown = self.entries.iter().filter(|entry| !self.known.contains(&entry.key.as_str()));
        let unknown: Vec<&TreeEntry> = unknown.collect();
        let meant = self.meant();
        for entry in &unknown {
            reader.report(Self::unknown(entry, &meant, &reader.path()));
        }
        let misspelt =
            |key: &&&'static str| unknown.iter().any(|e| nearest(&e.key, meant.iter().copied()) == Some(**key));
        let missing: Vec<&str> = self.missing.iter().filter(|key| !misspelt(key)).copied().collect();
        if !missing.is_empty() {
            reader.report(self.lacks(&missing, &reader.path()));
        }
        unknown.is_empty() && self.missing.is_empty()
    }

    /// The known keys in the order in which a misspelt one may mean them: first what is missing, last what is there.
    fn meant(&self) -> Vec<&'static str> {
        let mut keys = self.known.clone();
        let there = |key: &str| self.entries.iter().any(|entry| entry.key == key);
        keys.sort_by_key(|key| (!self.missing.contains(key), there(key)));
        keys
    }

    fn unknown(entry: &TreeEntry, meant: &[&str], path: &str) -> Diagnostic {
        let what = match path {
            "" => format!("a deck has no key `{}`", entry.key),
            _ => format!("`{path}` has no key `{}`", entry.key),
        };
        let unknown = Diagnostic::error(what).at(entry.place);
        match successor(path, &entry.key) {
            Some(help) => unknown.help(help),
            None => unknown.suggest(&entry.key, meant.iter().copied()),
        }
    }

    fn lacks(&self, keys: &[&str], path: &str) -> Diagnostic {
        let keys = keys.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
        let (table, label) = match path {
            "" if self.entries.is_empty() => ("the deck".to_owned(), "the deck is empty"),
            "" => ("the deck".to_owned(), "required in every deck"),
            _ => (format!("`{path}`"), "required here"),
        };
        Diagnostic::error(format!("{table} does not say {keys}")).at(self.node.place).label(label)
    }
}

/// Declares a table once: the doc comments are the words of the schema and the manual, each field's form its reader
/// and its description. `check` names a function that judges several keys together.
macro_rules! table {
    ($(#[doc = $about:literal])+ $vis:vis struct $name:ident $(check $check:path)? {
        $($(#[doc = $doc:literal])+ $field:ident: $type:ty = $form:expr),+ $(,)?
    }) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone)]
        $vis struct $name {
            $($(#[doc = $doc])+ pub $field: $type,)+
            /// Where the table stands.
            pub place: $crate::source::Place,
        }

        impl $crate::form::KeyTable for $name {
            fn keys() -> Vec<$crate::schema::Key> {
                vec![$($crate::form::key::<$type>(&$form, stringify!($field), concat!($($doc),+))),+]
            }

            fn read(
                node: &$crate::tree::Node,
                reader: &mut $crate::reader::Reader,
            ) -> Option<Self> {
                let mut fields = $crate::form::Fields::open(node, reader)?;
                $(let $field = fields.take(stringify!($field), &$form, reader);)+
                let complete = fields.close(reader);
                let table = Self { $($field: $field?,)+ place: node.place };
                let before = reader.errors();
                // What several keys say together is judged when each of them is right.
                $(if complete {
                    $check(&table, reader);
                })?
                (complete && reader.errors() == before).then_some(table)
            }
        }
    };
}
pub(crate) use table;
