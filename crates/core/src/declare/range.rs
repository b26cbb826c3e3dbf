//! Which numbers are admissible.

use std::fmt;

/// An interval of finite numbers, each end included or not. Neither NaN nor an infinite number lies in any range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The lower end and whether it is included.
    pub least: Option<(f64, bool)>,
    /// The upper end and whether it is included.
    pub most: Option<(f64, bool)>,
}

impl Range {
    /// Any finite number.
    pub const ANY: Range = Range { least: None, most: None };
    /// Above zero.
    pub const POSITIVE: Range = Range { least: Some((0.0, false)), most: None };
    /// Zero or above.
    pub const NOT_NEGATIVE: Range = Range { least: Some((0.0, true)), most: None };

    /// `a <= x`.
    pub const fn at_least(a: f64) -> Range {
        Range { least: Some((a, true)), most: None }
    }
    /// `a <= x <= b`.
    pub const fn from_to(a: f64, b: f64) -> Range {
        Range { least: Some((a, true)), most: Some((b, true)) }
    }
    /// `a < x < b`.
    pub const fn between(a: f64, b: f64) -> Range {
        Range { least: Some((a, false)), most: Some((b, false)) }
    }
    /// `a < x <= b`.
    pub const fn above_to(a: f64, b: f64) -> Range {
        Range { least: Some((a, false)), most: Some((b, true)) }
    }

    /// Whether a number is finite and lies between the ends.
    pub fn contains(&self, x: f64) -> bool {
        let above = self.least.is_none_or(|(a, included)| x > a || (included && x == a));
        let below = self.most.is_none_or(|(b, included)| x < b || (included && x == b));
        x.is_finite() && above && below
    }
}

/// A number as people write it: with a power of ten where it would else be a row of zeros.
pub fn short(x: f64) -> String {
    if x != 0.0 && !(1e-5..1e16).contains(&x.abs()) { format!("{x:e}") } else { x.to_string() }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let short = |end: Option<(f64, bool)>| end.map(|(x, included)| (short(x), included));
        if self.least == Some((0.0, false)) && self.most.is_none() {
            return f.write_str("positive");
        }
        if self.least == Some((0.0, true)) && self.most.is_none() {
            return f.write_str("zero or positive");
        }
        match (short(self.least), short(self.most)) {
            (None, None) => f.write_str("a finite number"),
            (Some(a), None) => write!(f, "{} {}", if a.1 { "at least" } else { "above" }, a.0),
            (None, Some(b)) => write!(f, "{} {}", if b.1 { "at most" } else { "below" }, b.0),
            (Some((a, true)), Some((b, true))) => write!(f, "from {a} to {b}"),
            (Some((a, false)), Some((b, false))) => write!(f, "between {a} and {b}, both excluded"),
            (Some((a, false)), Some((b, true))) => write!(f, "above {a} and at most {b}"),
            (Some((a, true)), Some((b, false))) => write!(f, "at least {a} and below {b}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_are_included_as_said_and_nothing_infinite_is() {
        assert!(Range::NOT_NEGATIVE.contains(0.0) && !Range::POSITIVE.contains(0.0));
        assert!(Range::from_to(0.0, 1.0).contains(1.0) && !Range::between(-1.0, 0.5).contains(0.5));
        assert!(Range::above_to(0.0, 1.0).contains(1.0) && !Range::above_to(0.0, 1.0).contains(0.0));
        for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(!Range::ANY.contains(x));
        }
    }

    #[test]
    fn words() {
        assert_eq!(Range::between(-1.0, 0.5).to_string(), "between -1 and 0.5, both excluded");
        assert_eq!(Range::POSITIVE.to_string(), "positive");
        assert_eq!(Range::at_least(3.0).to_string(), "at least 3");
        assert_eq!(Range::from_to(1e-12, 1.0).to_string(), "from 1e-12 to 1");
    }
}
