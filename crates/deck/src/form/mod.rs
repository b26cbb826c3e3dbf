//! Forms: how one kind of value is described and read. A form is declared once behind its key and serves both.

mod law;
mod list;
mod name;
mod one_of;
mod removed;
mod scalar;
mod table;
mod word;

pub use law::{ChosenLaw, law};
pub use list::{list, map};
pub use name::{defines, refers};
pub(super) use one_of::one_of;
pub use one_of::tag;
pub use scalar::{flag, number, text, whole};
pub(super) use table::table;
pub use table::{Fields, KeyTable, table_of};
pub(super) use word::words;
pub use word::{Words, word};

use super::reader::Reader;
use super::schema::{Key, Presence, Schema};
use super::source::Spot;
use super::tree::Node;

/// How one kind of value is described and read.
pub trait Form: Sized {
    /// What reading gives.
    type Value;
    /// The description.
    fn schema(&self) -> Schema;
    /// The value, or messages in `reader` and nothing.
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<Self::Value>;

    /// With its place.
    fn spot(self) -> Placed<Self> {
        Placed(self)
    }
    /// Behind a key that must be given.
    fn required(self) -> Required<Self> {
        Required(self)
    }
    /// Behind a key with a default, written as a deck would.
    fn or(self, default: &'static str) -> Defaulted<Self> {
        Defaulted(self, default)
    }
    /// Behind a key without which nothing holds; the words say so.
    fn unless_given(self, words: &'static str) -> Optional<Self> {
        Optional { form: self, words, computed: false }
    }
    /// Behind a key whose value is found by the program when it is not given; the words say how.
    fn computed(self, words: &'static str) -> Optional<Self> {
        Optional { form: self, words, computed: true }
    }
}

/// A form whose value keeps its place.
pub struct Placed<F>(F);

impl<F: Form> Form for Placed<F> {
    type Value = Spot<F::Value>;
    fn schema(&self) -> Schema {
        self.0.schema()
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<Self::Value> {
        Some(Spot { value: self.0.read(node, reader)?, place: node.place })
    }
}

/// What stands behind a key: a form, and what holds when the key is not given.
pub trait KeyField {
    /// What reading gives.
    type Value;
    /// The description under the name and words of the key.
    fn key(&self, name: &'static str, doc: &'static str) -> Key;
    /// The value of the key's node; of no node when the key is not given. A required key that is missing is reported
    /// by the table that lacks it.
    fn read(&self, node: Option<&Node>, table: &Node, reader: &mut Reader) -> Option<Self::Value>;
}

/// The description of a key whose value is a `T`; `doc` as the compiler hands doc comments on, joined.
pub fn key<T>(field: &impl KeyField<Value = T>, name: &'static str, doc: &'static str) -> Key {
    field.key(name, doc.trim_start())
}

/// See [`Form::required`].
pub struct Required<F>(F);
/// See [`Form::or`].
pub struct Defaulted<F>(F, &'static str);
/// See [`Form::unless_given`] and [`Form::computed`].
pub struct Optional<F> {
    form: F,
    words: &'static str,
    computed: bool,
}

impl<F: Form> KeyField for Required<F> {
    type Value = F::Value;
    fn key(&self, name: &'static str, doc: &'static str) -> Key {
        Key { name, doc, schema: self.0.schema(), presence: Presence::Required }
    }
    fn read(&self, node: Option<&Node>, _: &Node, reader: &mut Reader) -> Option<F::Value> {
        self.0.read(node?, reader)
    }
}

impl<F: Form> KeyField for Defaulted<F> {
    type Value = F::Value;
    fn key(&self, name: &'static str, doc: &'static str) -> Key {
        Key { name, doc, schema: self.0.schema(), presence: Presence::Default(self.1.to_owned()) }
    }
    fn read(&self, node: Option<&Node>, table: &Node, reader: &mut Reader) -> Option<F::Value> {
        match node {
            Some(node) => self.0.read(node, reader),
            None => {
                reader.leave_unsaid(self.1);
                self.0.read(&Node::written(self.1, table.place), reader)
            }
        }
    }
}

impl<F: Form> KeyField for Optional<F> {
    type Value = Option<F::Value>;
    fn key(&self, name: &'static str, doc: &'static str) -> Key {
        Key { name, doc, schema: self.form.schema(), presence: Presence::Optional(self.words) }
    }
    fn read(&self, node: Option<&Node>, _: &Node, reader: &mut Reader) -> Option<Self::Value> {
        let Some(node) = node else {
            if self.computed {
                reader.leave_unsaid(self.words);
            }
            return Some(None);
        };
        self.form.read(node, reader).map(Some)
    }
}
