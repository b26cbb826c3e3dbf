//! All places of the good decks of `tests/decks` at which the schema has something to say: what several walks share.
#![allow(dead_code)] // no walk uses all of it

use asperity::deck::schema::{Key, Names, Schema, root};
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// Where the good decks are.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks")
}

/// The good decks with their names.
pub fn decks() -> Vec<(String, Table)> {
    let mut paths: Vec<_> = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    let parse = |path: &PathBuf| {
        let text = std::fs::read_to_string(path).unwrap();
        (path.display().to_string(), text.parse::<Table>().unwrap())
    };
    paths.iter().map(parse).collect()
}

/// Where a deck says something, and what the schema says of it.
pub struct Site {
    /// Keys and positions down to the value.
    pub path: Vec<Step>,
    /// The schema of the value.
    pub schema: Schema,
    /// The key, if the value stands behind one that the schema names.
    pub key: Option<Key>,
    /// Whether the value's key is one of several of which exactly one must stand.
    pub tagged: bool,
    /// If the value's key is a name: what it names, and whether it gives the name.
    pub name: Option<(Names, bool)>,
}

/// One step down a deck.
#[derive(Clone, PartialEq)]
pub enum Step {
    /// To the value of a key.
    Key(String),
    /// To an item of a list.
    Item(usize),
}

/// All sites of a deck.
pub fn sites(value: &Value, schema: &Schema, path: &[Step], found: &mut Vec<Site>) {
    let mut visit = |step: Step, value: &Value, site: Site| {
        let path = [path, &[step]].concat();
        sites(value, &site.schema.clone(), &path, found);
        found.push(Site { path, ..site });
    };
    let plain = |schema: &Schema| Site { path: vec![], schema: schema.clone(), key: None, tagged: false, name: None };
    match (schema, value) {
        (Schema::Table(keys) | Schema::OneOf(keys), Value::Table(table)) => {
            for key in keys {
                if let Some(value) = table.get(key.name) {
                    let tagged = matches!(schema, Schema::OneOf(_));
                    let site = Site { key: Some(key.clone()), tagged, ..plain(&key.schema) };
                    visit(Step::Key(key.name.into()), value, site);
                }
            }
        }
        (Schema::Map { names, defines, item }, Value::Table(table)) => {
            for (name, value) in table {
                visit(Step::Key(name.clone()), value, Site { name: Some((*names, *defines)), ..plain(item) });
            }
        }
        (Schema::List { item, .. }, Value::Array(items)) => {
            for (i, value) in items.iter().enumerate() {
                visit(Step::Item(i), value, plain(item));
            }
        }
        _ => {}
    }
}

/// The value at a path.
pub fn at<'a>(value: &'a mut Value, path: &[Step]) -> &'a mut Value {
    path.iter().fold(value, |value, step| match step {
        Step::Key(key) => &mut value[key.as_str()],
        Step::Item(i) => &mut value[*i],
    })
}

/// The table that holds the last key of a path.
pub fn parent<'a>(value: &'a mut Value, path: &[Step]) -> &'a mut Table {
    at(value, &path[..path.len() - 1]).as_table_mut().unwrap()
}

/// The last key of a path.
pub fn last_key(path: &[Step]) -> String {
    let keys = path.iter().rev().filter_map(|step| if let Step::Key(key) = step { Some(key.clone()) } else { None });
    keys.into_iter().next().unwrap()
}

/// Calls `check` with every site of every deck and a fresh copy of the deck.
pub fn everywhere(mut check: impl FnMut(&Site, &Value)) {
    for (_, table) in decks() {
        let deck = Value::Table(table);
        let mut found = Vec::new();
        sites(&deck, &root(), &[], &mut found);
        found.iter().for_each(|site| check(site, &deck));
    }
}
