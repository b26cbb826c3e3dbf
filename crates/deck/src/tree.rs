//! The deck as a tree of values that know their places; what TOML says, before anyone asks what it means.

use super::diagnose::Diagnostic;
use super::source::Place;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value and its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// What stands there.
    pub value: Value,
    /// Where.
    pub place: Place,
}

/// What TOML can say. Dates have no use in a deck and are kept only to be refused by their name.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A string.
    Text(String),
    /// A whole number.
    Whole(i64),
    /// Any other number, NaN and the infinite ones too; whole numbers beyond 64 bits.
    Real(f64),
    /// `true` or `false`.
    Flag(bool),
    /// A date or a time.
    Date,
    /// An array, or an array of tables.
    List(Vec<Node>),
    /// A table, in the order in which its keys were written.
    Table(Vec<TreeEntry>),
}

/// One key of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct TreeEntry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub place: Place,
    /// Its value.
    pub node: Node,
}

impl Value {
    /// What a message calls this kind of value.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Whole(_) => "a whole number",
            Self::Real(_) => "a number",
            Self::Flag(_) => "true or false",
            Self::Date => "a date",
            Self::List(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

impl Node {
    /// An empty table: what is read where a table with defaults is not given.
    pub fn empty(place: Place) -> Self {
        Self { value: Value::Table(Vec::new()), place }
    }

    /// A value written as in a deck, as if it stood at `place`; text that is no value is a string.
    pub fn written(text: &str, place: Place) -> Self {
        let (tree, faults) = parse(&format!("value = {text}"), place.source);
        let value = match tree.value {
            Value::Table(entries) if faults.is_empty() && entries.len() == 1 => entries.into_iter().next(),
            _ => None,
        };
        let text = || Self { value: Value::Text(text.to_owned()), place };
        value.map_or_else(text, |entry| entry.node.moved(place))
    }

    /// The same value with everything in it at one place.
    fn moved(mut self, place: Place) -> Self {
        self.place = place;
        match &mut self.value {
            Value::List(items) => items.iter_mut().for_each(|item| *item = item.clone().moved(place)),
            Value::Table(entries) => entries.iter_mut().for_each(|entry| {
                entry.place = place;
                entry.node = entry.node.clone().moved(place);
            }),
            _ => {}
        }
        self
    }
}

/// Reads TOML. What cannot be read is left out of the tree and reported; all faults of the text are found at once.
pub fn parse(text: &str, source: usize) -> (Node, Vec<Diagnostic>) {
    let (table, errors) = DeTable::parse_recoverable(text);
    let whole = Place::new(source, 0..text.len().min(1));
    let faults = told(&errors, text).into_iter().map(|error| fault(error, text, source)).collect();
    (Node { value: entries(table.get_ref(), source), place: whole }, faults)
}

/// The errors worth telling: the first of each line, and nothing after a bracket that is left open, behind which
/// everything looks wrong.
fn told<'e>(errors: &'e [toml::de::Error], text: &str) -> Vec<&'e toml::de::Error> {
    let line = |error: &toml::de::Error| {
        let start = error.span().map_or(text.len(), |span| span.start.min(text.len()));
        text.as_bytes()[..start].iter().filter(|&&byte| byte == b'\n').count()
    };
    let open = errors.iter().position(open_bracket).map_or(errors.len(), |i| i + 1);
    let mut told: Vec<&toml::de::Error> = errors[..open].iter().collect();
    told.dedup_by_key(|error| line(error));
    told
}

fn open_bracket(error: &toml::de::Error) -> bool {
    error.message().contains("array") || error.message().contains("inline table")
}

fn fault(error: &toml::de::Error, text: &str, source: usize) -> Diagnostic {
    let span = error.span().unwrap_or(text.len()..text.len());
    let duplicate = error.message() == "duplicate key";
    let what = match text.get(span.clone()) {
        Some(key) if duplicate => format!("`{key}` is given twice"),
        _ => format!("not valid TOML: {}", error.message()),
    };
    let unquoted = error.message().contains("string values must be quoted");
    let help = match duplicate {
        true => "keep one of the two",
        false if open_bracket(error) => "a bracket may have been left open before this",
        false if text.get(span.start..).is_some_and(|rest| rest.starts_with(',')) => {
            "a number has a point, not a comma: 0.5"
        }
        false if unquoted => "text stands in quotes: \"steel\"; a number stands alone, without a unit: 210e3",
        false => "see toml.io for the format",
    };
    Diagnostic::error(what).at(Place::new(source, span)).help(help)
}

fn entries(table: &DeTable<'_>, source: usize) -> Value {
    let mut entries: Vec<TreeEntry> = table
        .iter()
        .map(|(key, value)| TreeEntry {
            key: key.get_ref().to_string(),
            place: Place::new(source, key.span()),
            node: node(value, source),
        })
        .collect();
    entries.sort_by_key(|entry| entry.place.start);
    Value::Table(entries)
}

fn node(value: &Spanned<DeValue<'_>>, source: usize) -> Node {
    let place = Place::new(source, value.span());
    let value = match value.get_ref() {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(digits) => whole(digits.as_str(), digits.radix()),
        DeValue::Float(digits) => Value::Real(digits.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(items) => Value::List(items.iter().map(|item| node(item, source)).collect()),
        DeValue::Table(table) => entries(table, source),
    };
    Node { value, place }
}

fn whole(digits: &str, radix: u32) -> Value {
    match i64::from_str_radix(digits, radix) {
        Ok(number) => Value::Whole(number),
        Err(_) => Value::Real(digits.parse().unwrap_or(f64::INFINITY)),
    }
}
