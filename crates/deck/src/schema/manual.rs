//! The schema as a page of the manual, in Markdown.

use super::{Key, Presence, Schema, interface_root, point_root, root};
use std::fmt::Write;

/// The heading of the outermost table.
const TOP: &str = "the deck";

/// An example of each key, from decks that the tests run: the kind of deck, the path of the key, and what may stand behind it.
const EXAMPLES: &str = include_str!("examples.txt");

/// The page: a section for each table of a deck, a line for each key.
pub fn manual() -> String {
    titled("Keys of a deck", ("deck", "--manual"), &root())
}

/// The page of a deck for one material point.
pub fn point_manual() -> String {
    titled("Keys of a deck for a material point", ("point", "--manual --point"), &point_root())
}

/// The page of a deck for one point of an interface.
pub fn interface_manual() -> String {
    titled("Keys of a deck for a point of an interface", ("interface", "--manual --interface"), &interface_root())
}

/// The path of a key as the manual and its examples write it.
pub fn path_of(table: &str, key: &str) -> String {
    if table.is_empty() || table == TOP { key.to_owned() } else { format!("{table}.{key}") }
}

/// The path of the tables that stand behind a path: each item of a list, each name of a map.
pub fn path_behind(path: &str, schema: &Schema) -> String {
    match schema {
        Schema::List { .. } => format!("{path}[]"),
        Schema::Map { names, .. } => {
            format!("{path}.{}", names.noun().split(' ').next().unwrap_or_default().to_uppercase())
        }
        _ => path.to_owned(),
    }
}

fn titled(title: &str, (kind, option): (&'static str, &str), root: &Schema) -> String {
    let mut page = Page { text: format!("# {title}\n\nPrinted by `asperity schema {option}`.\n"), kind };
    let about = "The keys at the top. `NAME[]` below stands for each item of a list, capitals for a name.";
    section(TOP, about, root, &mut page);
    page.text
}

/// A page that is written.
struct Page {
    text: String,
    /// The kind of deck, as the examples call it.
    kind: &'static str,
}

impl Page {
    /// What may stand behind a key.
    fn example(&self, path: &str) -> &'static str {
        let of = |line: &'static str| {
            let mut parts = line.splitn(3, '\t');
            (parts.next() == Some(self.kind) && parts.next() == Some(path)).then(|| parts.next()).flatten()
        };
        EXAMPLES.lines().find_map(of).unwrap_or_default()
    }
}

/// Heads of the two kinds of lists.
const KEYS: &str = "| key | meaning | value | if not given | example |\n|---|---|---|---|---|\n";
const TAGS: &str = "| key | meaning | value | example |\n|---|---|---|---|\n";

fn section(path: &str, about: &str, schema: &Schema, page: &mut Page) {
    let (keys, tagged) = match schema {
        Schema::Table(keys) => (keys, false),
        Schema::OneOf(keys) => (keys, true),
        Schema::List { item, .. } | Schema::Map { item, .. } => {
            return section(&path_behind(path, schema), about, item, page);
        }
        _ => return,
    };
    // Writing into a String cannot fail.
    let _ = writeln!(page.text, "\n## `{path}`\n\n{about}\n");
    if tagged {
        page.text.push_str("Exactly one of:\n\n");
    }
    page.text.push_str(if tagged { TAGS } else { KEYS });
    for key in keys {
        line(path, key, tagged, page);
    }
    for key in keys {
        section(&path_of(path, key.name), key.doc, &key.schema, page);
    }
}

fn line(table: &str, key: &Key, tagged: bool, page: &mut Page) {
    let example = match page.example(&path_of(table, key.name)) {
        "" => String::new(),
        example => format!("`{example}`"),
    };
    if tagged {
        let _ = writeln!(page.text, "| `{}` | {} | {} | {example} |", key.name, key.doc, value(&key.schema));
        return;
    }
    let unless = match &key.presence {
        Presence::Required => "required",
        Presence::Default(text) if matches!(text.as_str(), "{}" | "[]") => "nothing",
        Presence::Default(text) => &format!("`{text}`"),
        Presence::Optional(words) => words,
    };
    let _ = writeln!(page.text, "| `{}` | {} | {} | {unless} | {example} |", key.name, key.doc, value(&key.schema));
}

fn value(schema: &Schema) -> String {
    match schema {
        Schema::Number { unit: "", range } => format!("number, {range}"),
        Schema::Number { unit, range } => format!("{unit}, {range}"),
        Schema::Whole { least, most } if least == most => format!("{least}"),
        Schema::Whole { least, most } if *most == u64::MAX => format!("whole number, {least} or more"),
        Schema::Whole { least, most } => format!("whole number from {least} to {most}"),
        Schema::Flag => "true or false".into(),
        Schema::Text(what) => (*what).into(),
        Schema::Word(words) => {
            words.iter().map(|(word, meaning)| format!("`\"{word}\"` {meaning}")).collect::<Vec<_>>().join("; ")
        }
        Schema::Name(names) => format!("name of a {}", names.noun()),
        Schema::List { item, least, most } if least == most => format!("list of {least}: {}", value(item)),
        Schema::List { item, .. } => format!("list: {}", value(item)),
        Schema::Map { names, .. } => format!("a table for each {}", names.noun()),
        Schema::Table(_) => "table".into(),
        Schema::OneOf(keys) => {
            format!("one of {}", keys.iter().map(|key| format!("`{}`", key.name)).collect::<Vec<_>>().join(", "))
        }
    }
}
