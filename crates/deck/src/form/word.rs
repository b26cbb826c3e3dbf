//! One of a few words.

use super::Form;
use super::removed::successor;
use crate::diagnose::Diagnostic;
use crate::reader::Reader;
use crate::schema::Schema;
use crate::tree::{Node, Value};
use asperity_core::declare::nearest;
use std::marker::PhantomData;

/// Something that a deck names by one of a few words.
pub trait Words: Copy + 'static {
    /// Each with its word and its meaning.
    fn words() -> Vec<(Self, &'static str, &'static str)>;
}

/// One of the words of `T`.
pub fn word<T: Words>() -> Word<T> {
    Word(PhantomData)
}

/// See [`word`].
pub struct Word<T>(PhantomData<T>);

impl<T: Words> Form for Word<T> {
    type Value = T;
    fn schema(&self) -> Schema {
        Schema::Word(T::words().into_iter().map(|(_, word, meaning)| (word, meaning)).collect())
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<T> {
        let words = T::words();
        let Value::Text(text) = &node.value else {
            let must = format!("a string, one of {}", list(&words));
            return reader.refuse(node.place, &must, node.value.kind());
        };
        let found = words.iter().find(|(_, word, _)| word == text).map(|&(value, ..)| value);
        if found.is_none() {
            let what = format!("`{}` cannot be `{text}`", reader.path());
            let near = nearest(text, words.iter().map(|&(_, word, _)| word));
            let label = near.map(|near| format!("did you mean `{near}`?")).unwrap_or_default();
            let help =
                successor(&reader.path(), text).map_or_else(|| format!("one of {}", list(&words)), str::to_owned);
            reader.report(Diagnostic::error(what).at(node.place).label(label).help(help));
        }
        found
    }
}

fn list<T>(words: &[(T, &'static str, &'static str)]) -> String {
    words.iter().map(|(_, word, _)| format!("\"{word}\"")).collect::<Vec<_>>().join(", ")
}

/// An enum whose variants a deck names by words: the doc comment of each variant is its meaning in the schema.
macro_rules! words {
    ($(#[doc = $doc:literal])+ $vis:vis enum $name:ident {
        $($(#[doc = $meaning:literal])+ $variant:ident = $word:literal),+ $(,)?
    }) => {
        $(#[doc = $doc])+
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        $vis enum $name { $($(#[doc = $meaning])+ $variant),+ }

        impl $crate::form::Words for $name {
            fn words() -> Vec<(Self, &'static str, &'static str)> {
                vec![$((Self::$variant, $word, concat!($($meaning),+).trim_start())),+]
            }
        }
    };
}
pub(crate) use words;
