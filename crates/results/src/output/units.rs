//! The user's units by name. The program computes in any consistent units and converts nothing: names are written beside
//! numbers, on pictures and in headers of tables.

use super::quantity::Unit;
use asperity_core::declare::nearest;
use std::fmt;

/// Names of the units of force, length and time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Units {
    force: String,
    length: String,
    time: Option<String>,
}

const FORCES: &[&str] =
    &["N", "mN", "µN", "uN", "nN", "daN", "kN", "MN", "GN", "kgf", "gf", "tf", "lbf", "ozf", "kip", "dyn"];
const LENGTHS: &[&str] = &["m", "mm", "µm", "um", "nm", "cm", "dm", "km", "in", "ft", "yd", "mil"];
const TIMES: &[&str] = &["s", "ms", "µs", "us", "ns", "min", "h", "d", "a"];

/// Units of stress with a name of their own, by those of force and length.
const STRESSES: &[(&str, &str, &str)] = &[
    ("N", "m", "Pa"),
    ("N", "mm", "MPa"),
    ("kN", "m", "kPa"),
    ("kN", "mm", "GPa"),
    ("MN", "m", "MPa"),
    ("mN", "mm", "kPa"),
    ("µN", "µm", "MPa"),
    ("uN", "um", "MPa"),
    ("lbf", "in", "psi"),
    ("kip", "in", "ksi"),
];

impl Units {
    /// Units from their names: `N, mm` or `N, mm, s`.
    ///
    /// # Errors
    /// In words, with the nearest name.
    pub fn parse(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split(',').map(str::trim).collect();
        let (force, length, time) = match words[..] {
            [force, length] => (force, length, None),
            [force, length, time] => (force, length, Some(time)),
            _ => {
                return Err(format!(
                    "units are those of force and length, and maybe of time: \"N, mm, s\", not \"{text}\""
                ));
            }
        };
        let known = |word: &str, what: &str, all: &[&str]| match all.contains(&word) {
            true => Ok(word.to_owned()),
            false => {
                let near = nearest(word, all.iter().copied());
                let near = near.map_or("; ".to_owned(), |near| format!("; did you mean \"{near}\"? "));
                Err(format!("\"{word}\" is no unit of {what}{near}there are {}", all.join(", ")))
            }
        };
        Ok(Self {
            force: known(force, "force", FORCES)?,
            length: known(length, "length", LENGTHS)?,
            time: time.map(|time| known(time, "time", TIMES)).transpose()?,
        })
    }
    /// The name of the unit of a quantity, with powers as text; empty for a pure number, and for time without a name.
    pub fn name(&self, unit: Unit) -> String {
        let Self { force, length, time } = self;
        match unit {
            Unit::One => String::new(),
            Unit::Angle => "degrees".into(),
            Unit::Time => time.clone().unwrap_or_default(),
            Unit::Length => length.clone(),
            Unit::Area => format!("{length}^2"),
            Unit::Volume => format!("{length}^3"),
            Unit::Force => force.clone(),
            Unit::Moment | Unit::Energy => format!("{force} {length}"),
            Unit::EnergyDensity => format!("{force}/{length}"),
            Unit::Stress => {
                let own = STRESSES.iter().find(|(f, l, _)| f == force && l == length);
                own.map_or_else(|| format!("{force}/{length}^2"), |(_, _, name)| (*name).to_owned())
            }
        }
    }
    /// A column's header with its unit behind: `force.x [N]`.
    pub fn header(units: Option<&Self>, column: &str, unit: Unit) -> String {
        let name = units.map_or(String::new(), |units| units.name(unit));
        if name.is_empty() { column.to_owned() } else { format!("{column} [{name}]") }
    }
    /// What stands behind the name of a quantity on a picture: its unit, or without named units its dimension in words.
    pub fn label(units: Option<&Self>, unit: Unit) -> String {
        match units.map(|units| units.name(unit)) {
            Some(name) => name.replace("^2", "^{2}").replace("^3", "^{3}"),
            None => unit.text().to_owned(),
        }
    }
}

/// A header without the unit behind it.
pub fn bare(header: &str) -> &str {
    match header.strip_suffix(']').and_then(|rest| rest.rsplit_once(" [")) {
        Some((name, _)) => name,
        None => header,
    }
}

impl fmt::Display for Units {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.force, self.length)?;
        self.time.as_ref().map_or(Ok(()), |time| write!(f, ", {time}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_named_for_every_quantity() {
        let units = Units::parse("N, mm").unwrap();
        assert_eq!(units.name(Unit::Stress), "MPa");
        assert_eq!(units.name(Unit::Moment), "N mm");
        assert_eq!(Units::header(Some(&units), "force.x", Unit::Force), "force.x [N]");
        assert_eq!((bare("force.x [N]"), bare("force.x")), ("force.x", "force.x"));
        let odd = Units::parse("kN,cm, min").unwrap();
        assert_eq!((odd.name(Unit::Stress).as_str(), odd.name(Unit::Time).as_str()), ("kN/cm^2", "min"));
        assert_eq!(Units::label(Some(&odd), Unit::Stress), "kN/cm^{2}");
        assert_eq!(Units::parse(&odd.to_string()), Ok(odd));
    }

    #[test]
    fn a_unit_that_is_none_is_told_with_the_nearest() {
        assert!(Units::parse("KN, mm").unwrap_err().contains("\"kN\""));
        assert!(Units::parse("mm, N").unwrap_err().contains("no unit of force"));
        assert!(Units::parse("N").unwrap_err().contains("force and length"));
    }
}
