//! The schema as a page of the manual, in Markdown.

use super::{Key, Presence, Schema, interface_root, point_root, root};
use std::fmt::Write;

/// The heading of the outermost table.
const TOP: &str = "the deck";

/// The page: a section for each table of a deck, a line for each key.
pub fn manual() -> String {
    titled("Keys of a deck", "--manual", &root())
}

/// The page of a deck for one material point.
pub fn point_manual() -> String {
    titled("Keys of a deck for a material point", "--manual --point", &point_root())
}

/// The page of a deck for one point of an interface.
pub fn interface_manual() -> String {
    titled("Keys of a deck for a point of an interface", "--manual --interface", &interface_root())
}

fn titled(title: &str, option: &str, root: &Schema) -> String {
    let mut page = format!("# {title}\n\nPrinted by `asperity schema {option}`.\n");
    let about = "The keys at the top. `NAME[]` below stands for each item of a list, capitals for a name.";
    section(TOP, about, root, &mut page);
    page
}

/// Heads of the two kinds of lists.
const KEYS: &str = "| key | meaning | value | if not given |\n|---|---|---|---|\n";
const TAGS: &str = "| key | meaning | value |\n|---|---|---|\n";

fn section(path: &str, about: &str, schema: &Schema, page: &mut String) {
    let (keys, tagged) = match schema {
        Schema::Table(keys) => (keys, false),
        Schema::OneOf(keys) => (keys, true),
        Schema::List { item, .. } => return section(&format!("{path}[]"), about, item, page),
        Schema::Map { names, item, .. } => {
            let name = names.noun().split(' ').next().unwrap_or_default().to_uppercase();
            return section(&format!("{path}.{name}"), about, item, page);
        }
        _ => return,
    };
    // Writing into a String cannot fail.
    let _ = writeln!(page, "\n## `{path}`\n\n{about}\n");
    if tagged {
        page.push_str("Exactly one of:\n\n");
    }
    page.push_str(if tagged { TAGS } else { KEYS });
    for key in keys {
        line(key, tagged, page);
    }
    let inner = |key: &str| if path == TOP { key.to_owned() } else { format!("{path}.{key}") };
    for key in keys {
        section(&inner(key.name), key.doc, &key.schema, page);
    }
}

fn line(key: &Key, tagged: bool, page: &mut String) {
    if tagged {
        let _ = writeln!(page, "| `{}` | {} | {} |", key.name, key.doc, value(&key.schema));
        return;
    }
    let unless = match &key.presence {
        Presence::Required => "required",
        Presence::Default(text) if matches!(text.as_str(), "{}" | "[]") => "nothing",
        Presence::Default(text) => &format!("`{text}`"),
        Presence::Optional(words) => words,
    };
    let _ = writeln!(page, "| `{}` | {} | {} | {unless} |", key.name, key.doc, value(&key.schema));
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
