//! Numbers, whole numbers, flags and text.

use super::Form;
use crate::diagnose::Diagnostic;
use crate::reader::Reader;
use crate::schema::Schema;
use crate::source::Place;
use crate::tree::{Node, Value};
use asperity_core::declare::{Range, short};
use std::ops::RangeInclusive;

/// Refuses a value of another kind; what only stands in quotes is to be written without them.
fn refuse_kind<T>(place: Place, must: &str, found: &Value, reader: &mut Reader) -> Option<T> {
    let what = format!("`{}` must be {must}, not {}", reader.path(), found.kind());
    let diagnostic = Diagnostic::error(what).at(place);
    let advice = match found {
        Value::Text(text) if text.parse::<f64>().is_ok() || text.parse::<bool>().is_ok() => {
            format!("write {}, without quotes", with_digits(text))
        }
        Value::Text(text) if text.starts_with(|c: char| c.is_ascii_digit()) => {
            "a number stands alone, without quotes and without a unit: 210e3".to_owned()
        }
        _ => String::new(),
    };
    reader.report(if advice.is_empty() { diagnostic } else { diagnostic.help(advice) });
    None
}

/// A number as TOML has it, with a digit on both sides of its point.
fn with_digits(text: &str) -> String {
    let (sign, digits) = text.split_at(usize::from(text.starts_with(['+', '-'])));
    let before = if digits.starts_with('.') { "0" } else { "" };
    let behind = if digits.ends_with('.') { "0" } else { "" };
    format!("{sign}{before}{digits}{behind}")
}

/// A number of a unit within a range.
pub fn number(unit: &'static str, range: Range) -> Number {
    Number { unit, range, meaning: "" }
}

/// See [`number`].
pub struct Number {
    pub(super) unit: &'static str,
    pub(super) range: Range,
    /// What it is, where no key's words say it.
    pub(super) meaning: &'static str,
}

impl Number {
    fn refuse(&self, x: f64, place: Place, reader: &mut Reader) {
        let path = reader.path();
        let what = match x.is_infinite() {
            true => format!("`{path}` is infinite, or too large for a number; it must be {}", self.range),
            false => format!("`{path}` must be {}, not {}", self.range, short(x)),
        };
        let words = [self.meaning, self.unit].iter().filter(|w| !w.is_empty()).copied().collect::<Vec<_>>();
        let diagnostic = Diagnostic::error(what).at(place);
        reader.report(if words.is_empty() { diagnostic } else { diagnostic.label(words.join(", ")) });
    }
}

impl Form for Number {
    type Value = f64;
    fn schema(&self) -> Schema {
        Schema::Number { unit: self.unit, range: self.range }
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<f64> {
        let x = match node.value {
            Value::Whole(whole) => whole as f64,
            Value::Real(real) => real,
            ref other => return refuse_kind(node.place, "a number", other, reader),
        };
        if self.range.contains(x) {
            return Some(x);
        }
        self.refuse(x, node.place, reader);
        None
    }
}

/// A whole number within a range.
pub fn whole(range: RangeInclusive<u64>) -> Whole {
    Whole(range)
}

/// See [`whole`].
pub struct Whole(RangeInclusive<u64>);

impl Form for Whole {
    type Value = usize;
    fn schema(&self) -> Schema {
        Schema::Whole { least: *self.0.start(), most: *self.0.end() }
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<usize> {
        let must = match (self.0.start(), self.0.end()) {
            (least, most) if least == most => format!("{least}"),
            (least, &u64::MAX) => format!("a whole number, {least} or more"),
            (least, most) => format!("a whole number from {least} to {most}"),
        };
        match node.value {
            Value::Whole(x) => match u64::try_from(x).ok().filter(|x| self.0.contains(x)) {
                Some(x) => usize::try_from(x).ok(),
                None => reader.refuse(node.place, &must, &x.to_string()),
            },
            Value::Real(x) => reader.refuse(node.place, &must, &x.to_string()),
            ref other => refuse_kind(node.place, &must, other, reader),
        }
    }
}

/// `true` or `false`.
pub fn flag() -> Flag {
    Flag
}

/// See [`flag`].
pub struct Flag;

impl Form for Flag {
    type Value = bool;
    fn schema(&self) -> Schema {
        Schema::Flag
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<bool> {
        match node.value {
            Value::Flag(flag) => Some(flag),
            ref other => refuse_kind(node.place, "true or false", other, reader),
        }
    }
}

/// Free text; `what` says what it is.
pub fn text(what: &'static str) -> Text {
    Text(what)
}

/// See [`text`].
pub struct Text(&'static str);

impl Form for Text {
    type Value = String;
    fn schema(&self) -> Schema {
        Schema::Text(self.0)
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<String> {
        match &node.value {
            Value::Text(text) => Some(text.clone()),
            other => reader.refuse(node.place, &format!("{}, a string in quotes", self.0), other.kind()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::with_digits;

    #[test]
    fn points_stand_between_digits() {
        for (text, told) in [(".02", "0.02"), ("-.5", "-0.5"), ("3.", "3.0"), ("210e3", "210e3"), ("true", "true")] {
            assert_eq!(with_digits(text), told);
        }
    }
}
