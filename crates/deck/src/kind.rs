//! Which kind of deck a text is, of a model or of one point: who takes the one for the other reads that first, and not
//! all the keys that the other kind does not know.

use super::diagnose::Diagnostic;
use super::tree::{Node, TreeEntry, Value};

/// What a deck is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Bodies on a mesh.
    Model,
    /// One point of a solid or of an interface.
    Point,
}

/// Says that a deck is of the other kind, if what it says shows that.
pub fn mistaken(tree: &Node, wanted: Kind) -> Option<Diagnostic> {
    let (found, entry) = kind(tree)?;
    let (what, verb) = match found {
        Kind::Model => ("this deck is of a model with a mesh, not of one point", "run"),
        Kind::Point => ("this deck drives one point of a law and has no bodies", "point"),
    };
    (found != wanted).then(|| {
        let diagnostic = Diagnostic::error(what).at(entry.place);
        diagnostic.help(format!("it is for `asperity {verb}`"))
    })
}

/// The kind and the key that shows it.
fn kind(tree: &Node) -> Option<(Kind, &TreeEntry)> {
    let model = ["mesh", "body"].into_iter().find_map(|key| under(tree, key));
    let point = || under(tree, "interface").or_else(|| driven(under(tree, "step")?));
    model.map(|entry| (Kind::Model, entry)).or_else(|| Some((Kind::Point, point()?)))
}

/// What a step prescribes of a point of a solid, and of nothing else.
fn driven(steps: &TreeEntry) -> Option<&TreeEntry> {
    let Value::List(steps) = &steps.node.value else { return None };
    steps.iter().flat_map(|step| ["strain", "stress"].map(|key| under(step, key))).find_map(|entry| entry)
}

fn under<'n>(node: &'n Node, key: &str) -> Option<&'n TreeEntry> {
    let Value::Table(entries) = &node.value else { return None };
    entries.iter().find(|entry| entry.key == key)
}

#[cfg(test)]
mod tests {
    use crate::{read, read_interface, read_point};
    use std::path::Path;

    const POINT: &str =
        "version = 1\nmaterial.m.elastic = { young = 2.0, poisson = 0.25 }\n[[step]]\nstrain.xx = 0.1\n";
    const JOINT: &str =
        "version = 1\npenalty = 1e3\ninterface.j.coulomb = { friction = 0.2 }\n[[step]]\npressure = 1.0\n";

    #[test]
    fn a_deck_of_the_other_kind_is_told_so_and_nothing_else() {
        for deck in [POINT, JOINT] {
            let messages = read(deck, "deck", Path::new(""), &[]).unwrap_err().list;
            assert_eq!(messages.len(), 1, "{messages:?}");
            assert_eq!(messages[0].help, ["it is for `asperity point`"]);
        }
        let model = format!("{POINT}[body.block]\nmaterial = \"m\"\n");
        let messages = read_point(&model, "deck", Path::new(""), &[]).err().unwrap().list;
        assert_eq!((messages.len(), messages[0].help[0].as_str()), (1, "it is for `asperity run`"));
    }

    #[test]
    fn a_deck_of_the_right_kind_is_read() {
        assert!(read_point(POINT, "deck", Path::new(""), &[]).is_ok() && read_interface(JOINT, "deck", &[]).is_ok());
        let lost = read("version = 1\n", "deck", Path::new(""), &[]).unwrap_err().list;
        assert!(lost[0].what.contains("the deck does not say"), "{lost:?}");
    }
}
