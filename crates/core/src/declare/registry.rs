//! Registries: what may stand behind a name, with the numbers it takes.

use super::Parameter;

/// A registered thing that is built from numbers: a law of a material or of an interface.
///
/// ```
/// use asperity_core::declare::{Entry, Parameter, Range, find, unit};
///
/// struct Spring(f64);
/// const STIFFNESS: Parameter = Parameter {
///     key: "stiffness",
///     meaning: "force for one unit of travel",
///     unit: unit::STIFFNESS,
///     range: Range::POSITIVE,
///     default: None,
/// };
/// static SPRINGS: &[Entry<Spring>] =
///     &[Entry { name: "linear", meaning: "f = k u", parameters: &[STIFFNESS], pairs: None, build: |v| Ok(Spring(v[0])) }];
/// let spring = (find(SPRINGS, "linear").unwrap().build)(&[2.0]).unwrap();
/// assert_eq!(spring.0, 2.0);
/// ```
pub struct Entry<T: 'static> {
    /// The word a deck uses: `elastic`, `coulomb`.
    pub name: &'static str,
    /// What it is, in one line.
    pub meaning: &'static str,
    /// The numbers it takes.
    pub parameters: &'static [Parameter],
    /// The list of pairs it takes besides, if any.
    pub pairs: Option<Pairs>,
    /// Builds it from the values of its parameters, in the order in which they are declared, each already inside its
    /// own range, followed by its pairs, one after the other. The error says what is wrong with several of them
    /// together.
    pub build: fn(values: &[f64]) -> Result<T, String>,
}

/// A list of pairs of numbers: the points of a curve, the terms of a sum.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pairs {
    /// The key a deck uses: `curve`.
    pub key: &'static str,
    /// What the pairs are, with the unit of each column.
    pub meaning: &'static str,
    /// Fewest pairs.
    pub least: usize,
    /// Most pairs.
    pub most: usize,
}

/// Looks an entry up by its name.
pub fn find<'a, T>(registry: &'a [Entry<T>], name: &str) -> Option<&'a Entry<T>> {
    registry.iter().find(|entry| entry.name == name)
}
