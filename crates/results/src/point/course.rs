//! What a path prescribes.

/// Names of the six components, in the order of every list of six.
pub const COMPONENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// What a stage prescribes of one component.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PathControl {
    /// Its strain goes to this value.
    Strain(f64),
    /// Its stress goes to this value.
    Stress(f64),
    /// Its stress stays what it is.
    Kept,
}

/// A part of a path: every prescribed value goes along a straight line from where it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Stage {
    /// What messages call it.
    pub name: String,
    /// How long it lasts.
    pub duration: f64,
    /// Number of equal increments.
    pub increments: usize,
    /// What is prescribed of each component.
    pub controls: [PathControl; 6],
    /// The temperature at its end; none where it stays.
    pub temperature: Option<f64>,
}

impl PathControl {
    /// The prescribed stress at the end, if a stress is prescribed.
    pub(super) fn stress(self, now: f64) -> Option<f64> {
        match self {
            Self::Strain(_) => None,
            Self::Stress(stress) => Some(stress),
            Self::Kept => Some(now),
        }
    }
}
