//! Externally tagged choices: a table with exactly one key, which says what stands behind it.

use crate::diagnose::Diagnostic;
use crate::reader::Reader;
use crate::tree::{Node, TreeEntry, Value};

/// The only key of a table, if it is one of `valid`; else messages.
pub fn tag<'n>(node: &'n Node, valid: &[&'static str], reader: &mut Reader) -> Option<&'n TreeEntry> {
    let words = valid.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
    let Value::Table(entries) = &node.value else {
        return reader.refuse(node.place, &format!("a table with one of {words}"), node.value.kind());
    };
    let path = reader.path();
    let before = reader.diagnostics.len();
    for entry in entries.iter().filter(|entry| !valid.contains(&entry.key.as_str())) {
        let what = format!("`{path}` cannot be `{}`", entry.key);
        reader.report(Diagnostic::error(what).at(entry.place).suggest(&entry.key, valid.iter().copied()));
    }
    match entries.as_slice() {
        _ if reader.diagnostics.len() > before => None,
        [entry] => Some(entry),
        [] => reader.refuse(node.place, &format!("one of {words}"), "nothing"),
        [_, second, ..] => reader.refuse(second.place, &format!("only one of {words}"), "two of them"),
    }
}

/// Declares an enum of tables, of which a deck gives exactly one, under its key.
macro_rules! one_of {
    ($(#[doc = $about:literal])+ $vis:vis enum $name:ident {
        $($(#[doc = $doc:literal])+ $variant:ident($type:ty) = $key:literal => $form:expr),+ $(,)?
    }) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone)]
        $vis enum $name { $($(#[doc = $doc])+ $variant($type)),+ }

        impl $name {
            /// The form of this choice.
            $vis fn form() -> impl $crate::form::Form<Value = Self> {
                struct Choice;
                impl $crate::form::Form for Choice {
                    type Value = $name;
                    fn schema(&self) -> $crate::schema::Schema {
                        use $crate::form::key;
                        let keys = vec![$(key::<$type>(&$form.required(), $key, concat!($($doc),+))),+];
                        $crate::schema::Schema::OneOf(keys)
                    }
                    fn read(
                        &self,
                        node: &$crate::tree::Node,
                        reader: &mut $crate::reader::Reader,
                    ) -> Option<$name> {
                        let entry = $crate::form::tag(node, &[$($key),+], reader)?;
                        reader.under(entry.key.clone(), |reader| match entry.key.as_str() {
                            $($key => $form.read(&entry.node, reader).map($name::$variant),)+
                            _ => None,
                        })
                    }
                }
                Choice
            }
        }
    };
}
pub(crate) use one_of;
