//! `expect.toml`: what each measured figure must be. A table a figure:
//!
//! ```toml
//! [p0]
//! what = "largest pressure p0, N/mm2"
//! value = 1212.07                          # of the source; the error is relative, absolute where this is zero
//! within = { quick = 0.03, full = 0.01 }   # the error allowed; a size that is not named is not measured
//! ```
//! In place of `value` and `within`, `least` and `most` bound a figure by size; a figure without any is only shown.

use crate::{Measured, Size, bench};
use asperity::Error;
use serde::Deserialize;
use std::path::{Path, PathBuf};

#[derive(Debug, Default, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct Limits {
    quick: Option<f64>,
    full: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Expectation {
    what: String,
    value: Option<f64>,
    #[serde(default)]
    within: Limits,
    #[serde(default)]
    least: Limits,
    #[serde(default)]
    most: Limits,
}

/// The figures that a case must show.
pub struct Expectations {
    path: PathBuf,
    all: Vec<(String, Expectation)>,
}

/// A figure and what became of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// What is measured.
    pub what: String,
    /// What came out.
    pub value: f64,
    /// What the source says; or the bounds, in words.
    pub reference: String,
    /// The error, where there is a reference.
    pub error: Option<f64>,
    /// The error allowed.
    pub allowed: Option<f64>,
    /// Whether the error is one relative to the reference.
    pub relative: bool,
    /// Whether the value lies within its limits.
    pub holds: bool,
}

impl Limits {
    fn of(self, size: Size) -> Option<f64> {
        match size {
            Size::Quick => self.quick,
            Size::Full => self.full,
        }
    }
}

impl Expectation {
    /// Whether the figure must be measured in a size.
    fn wanted(&self, size: Size) -> bool {
        [self.within, self.least, self.most].iter().any(|limits| limits.of(size).is_some())
    }

    fn line(&self, value: f64, size: Size) -> Line {
        let (least, most) = (self.least.of(size), self.most.of(size));
        let relative = self.value.is_some_and(|reference| reference != 0.0);
        let scale = if relative { self.value.map_or(1.0, f64::abs) } else { 1.0 };
        let error = self.value.map(|reference| (value - reference) / scale);
        let allowed = self.within.of(size);
        let near = allowed.is_none_or(|allowed| error.is_some_and(|error| error.abs() <= allowed));
        let bounded = least.is_none_or(|least| value >= least) && most.is_none_or(|most| value <= most);
        let reference = match (self.value, least, most) {
            (Some(reference), ..) => format!("{reference}"),
            (None, Some(least), Some(most)) => format!("{least} to {most}"),
            (None, Some(least), None) => format!("at least {least}"),
            (None, None, Some(most)) => format!("at most {most}"),
            (None, None, None) => "-".into(),
        };
        let holds = near && bounded && value.is_finite();
        Line { what: self.what.clone(), value, reference, error, allowed, relative, holds }
    }
}

impl Expectations {
    /// Reads the file.
    ///
    /// # Errors
    /// [`Error::File`] where it cannot be read or says what has no meaning.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let table: toml::Table = bench::read(path)?.parse().map_err(|error| Error::file(path, error))?;
        let entry = |(key, value): (String, toml::Value)| {
            let expectation: Expectation = value.try_into().map_err(|error| Error::file(path, error))?;
            Ok((key, expectation))
        };
        let all = table.into_iter().map(entry).collect::<Result<_, Error>>()?;
        Ok(Self { path: path.into(), all })
    }

    /// The lines of the figures measured. What is expected and not measured, or measured and not expected, is an error.
    ///
    /// # Errors
    /// [`Error::File`] with the figure's key.
    pub fn compare(&self, measured: &Measured, size: Size) -> Result<Vec<Line>, Error> {
        let refuse = |what: String| Err(Error::file(&self.path, what));
        let mut lines = Vec::new();
        for (key, value) in measured {
            match self.all.iter().find(|(known, _)| known == key) {
                Some((_, expectation)) => lines.push(expectation.line(*value, size)),
                None => return refuse(format!("'{key}' is measured but not expected")),
            }
        }
        let missing = |(key, expectation): &&(String, Expectation)| {
            expectation.wanted(size) && measured.iter().all(|(other, _)| other != key)
        };
        match self.all.iter().find(missing) {
            Some((key, _)) => refuse(format!("'{key}' is expected but not measured")),
            None => Ok(lines),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str, value: f64) -> Line {
        let expectation: Expectation = toml::from_str(text).unwrap();
        expectation.line(value, Size::Quick)
    }

    #[test]
    fn limits_are_limits() {
        let near = "what = 'x'\nvalue = -2.0\nwithin.quick = 0.01";
        assert!(line(near, -2.019).holds && line(near, -1.981).holds);
        assert!(!line(near, -2.021).holds && !line(near, 2.0).holds && !line(near, f64::NAN).holds);
        let zero = "what = 'x'\nvalue = 0.0\nwithin.quick = 1e-12";
        assert!(line(zero, -1e-12).holds && !line(zero, 2e-12).holds);
        let bounds = "what = 'x'\nleast.quick = 1.0\nmost.quick = 2.0";
        assert!(line(bounds, 1.5).holds && !line(bounds, 0.9).holds && !line(bounds, 2.1).holds);
    }
}
