//! Fingerprints of the parts of a deck, by which a restart finds out what has changed. They are those of the values: comments,
//! the order of keys and `1` for `1.0` make no difference.

use super::tree::{Node, TreeEntry, Value};
use asperity_core::mesh::Mesh;
use asperity_results::output::Part;
use asperity_results::output::checkpoint::InputHash;

/// Tables whose keys are names, each a part of its own.
const NAMED: [&str; 6] = ["material", "body", "tool", "contact", "rigid", "distributing"];

/// The parts of a deck and its mesh.
pub fn of(tree: &Node, made: &Mesh) -> Vec<Part> {
    let mesh_bytes = mesh(made);
    let mut parts = vec![part("mesh", &mesh_bytes.iter().map(Vec::as_slice).collect::<Vec<_>>())];
    for (name, group) in &made.groups {
        parts.push(part(&format!("group {name}"), &[format!("{group:?}").as_bytes()]));
    }
    for TreeEntry { key, node, .. } in entries(tree) {
        match (key.as_str(), &node.value) {
            ("mesh" | "group", _) => {}
            ("step", Value::List(steps)) => steps.iter().enumerate().for_each(|(i, one)| step(i + 1, one, &mut parts)),
            (named, Value::Table(items)) if NAMED.contains(&named) => {
                parts.extend(items.iter().map(|item| part(&format!("{named}.{}", item.key), &[&bytes(&item.node)])));
            }
            _ => parts.push(part(key, &[&bytes(node)])),
        }
    }
    parts
}

/// The conditions of a step, and its increments apart; its name is a mere word.
fn step(number: usize, node: &Node, parts: &mut Vec<Part>) {
    let apart = |key: &str| ["name", "increments"].contains(&key);
    let said: Vec<u8> = sorted(entries(node)).filter(|entry| !apart(&entry.key)).flat_map(of_entry).collect();
    parts.push(part(&format!("step {number}"), &[&said]));
    let increments = entries(node).iter().find(|entry| entry.key == "increments");
    let said = increments.map_or_else(Vec::new, |entry| bytes(&entry.node));
    parts.push(part(&format!("step {number} increments"), &[&said]));
}

/// Places, cells and kinds of cells of a mesh, as bytes.
pub fn mesh(mesh: &Mesh) -> [Vec<u8>; 3] {
    let points = mesh.points.iter().flat_map(|point| point.0).flat_map(f64::to_le_bytes).collect();
    let cells = mesh.starts.iter().chain(&mesh.nodes).flat_map(|&i| (i as u64).to_le_bytes()).collect();
    let kinds: String = mesh.kinds.iter().flat_map(|kind| [kind.name, " "]).collect();
    [points, cells, kinds.into_bytes()]
}

fn part(key: &str, texts: &[&[u8]]) -> Part {
    Part { key: key.into(), print: InputHash::of(texts) }
}

fn entries(node: &Node) -> &[TreeEntry] {
    match &node.value {
        Value::Table(entries) => entries,
        _ => &[],
    }
}

fn sorted(entries: &[TreeEntry]) -> impl Iterator<Item = &TreeEntry> {
    let mut sorted: Vec<&TreeEntry> = entries.iter().collect();
    sorted.sort_by(|a, b| a.key.cmp(&b.key));
    sorted.into_iter()
}

fn of_entry(entry: &TreeEntry) -> Vec<u8> {
    [lengthy(b'k', entry.key.as_bytes()), bytes(&entry.node)].concat()
}

/// A mark, a length and as many bytes.
fn lengthy(mark: u8, bytes: &[u8]) -> Vec<u8> {
    [&[mark][..], &(bytes.len() as u64).to_le_bytes(), bytes].concat()
}

/// A value as bytes from which it could be read again.
fn bytes(node: &Node) -> Vec<u8> {
    match &node.value {
        Value::Text(text) => lengthy(b't', text.as_bytes()),
        Value::Whole(number) => number_bytes(*number as f64),
        Value::Real(number) => number_bytes(*number),
        Value::Flag(flag) => vec![b'f', u8::from(*flag)],
        Value::Date => vec![b'd'],
        Value::List(items) => lengthy(b'l', &items.iter().flat_map(bytes).collect::<Vec<_>>()),
        Value::Table(entries) => lengthy(b'm', &sorted(entries).flat_map(of_entry).collect::<Vec<_>>()),
    }
}

fn number_bytes(number: f64) -> Vec<u8> {
    [&b"n"[..], &number.to_le_bytes()].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::parse;

    fn keys_that_differ(a: &str, b: &str) -> Vec<String> {
        let [a, b] = [a, b].map(|text| of(&parse(text, 0).0, &Mesh::new()));
        let gone = a.iter().filter(|part| !b.contains(part));
        let come = b.iter().filter(|part| !a.iter().any(|other| other.key == part.key));
        gone.chain(come).map(|part| part.key.clone()).collect()
    }

    #[test]
    fn parts_are_told_apart_by_their_values() {
        let deck =
            "title = 'a'\nmaterial.m.elastic = { young = 1, poisson = 0.3 }\n[[step]]\nname = 'x'\nduration = 1.0\n";
        let same =
            "material.m.elastic = { poisson = 0.3, young = 1.0 } # the same\ntitle = 'a'\n[[step]]\nduration = 1\n";
        assert!(keys_that_differ(deck, same).is_empty());
        let other = deck.replace("young = 1", "young = 2") + "increments.count = 3\n[[step]]\n";
        let found = keys_that_differ(deck, &other);
        assert_eq!(found, ["material.m", "step 1 increments", "step 2", "step 2 increments"]);
    }
}
