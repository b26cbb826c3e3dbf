//! Names: of things that the deck makes, and of things that it or the mesh has.

use super::Form;
use crate::reader::{Name, Reader};
use crate::schema::{Names, Schema};
use crate::tree::{Node, Value};

/// The name of something that must exist.
pub fn refers(names: Names) -> Naming {
    Naming { names, defines: false }
}

/// A name given to something new.
pub fn defines(names: Names) -> Naming {
    Naming { names, defines: true }
}

/// See [`refers`] and [`defines`].
pub struct Naming {
    pub(super) names: Names,
    pub(super) defines: bool,
}

impl Form for Naming {
    type Value = Name;
    fn schema(&self) -> Schema {
        Schema::Name(self.names)
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<Name> {
        let Value::Text(text) = &node.value else {
            let must = format!("the name of a {}, a string", self.names.noun());
            return reader.refuse(node.place, &must, node.value.kind());
        };
        let name = Name { text: text.clone(), place: node.place };
        reader.mention(self.names, name.clone(), self.defines);
        Some(name)
    }
}
