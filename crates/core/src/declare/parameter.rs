//! One number that a user may give.

use super::Range;

/// A number with its name, meaning, unit, admissible range and default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// The key a deck uses: `young`.
    pub key: &'static str,
    /// What it is, as the manual and the schema say it: `Young's modulus`.
    pub meaning: &'static str,
    /// Its dimension in the program's words, see [`unit`](mod@unit).
    pub unit: &'static str,
    /// What it may be.
    pub range: Range,
    /// Its value when a deck does not give it; without one it must be given.
    pub default: Option<f64>,
}

impl Parameter {
    /// What is wrong with a value, if anything: `must be positive (Young's modulus, in stress)`.
    pub fn refuse(&self, value: f64) -> Option<String> {
        let Parameter { meaning, unit, range, .. } = self;
        let of = if unit.is_empty() { String::new() } else { format!(", a {unit}") };
        (!range.contains(value)).then(|| format!("must be {range} ({meaning}{of})"))
    }
}

/// The words for dimensions. The program is free of units: a user keeps one consistent set.
pub mod unit {
    /// A number without dimension.
    pub const NONE: &str = "";
    /// A length.
    pub const LENGTH: &str = "length";
    /// An angle in degrees.
    pub const DEGREES: &str = "angle in degrees";
    /// A time.
    pub const TIME: &str = "time";
    /// A force.
    pub const FORCE: &str = "force";
    /// A force times a length.
    pub const TORQUE: &str = "torque";
    /// A stress or a pressure.
    pub const STRESS: &str = "stress";
    /// A force per length of displacement.
    pub const STIFFNESS: &str = "force per length";
    /// A stress per length: the penalty of a contact.
    pub const PENALTY: &str = "stress per length";
    /// A mass per volume.
    pub const DENSITY: &str = "mass per volume";
    /// An acceleration.
    pub const ACCELERATION: &str = "acceleration";
    /// A temperature.
    pub const TEMPERATURE: &str = "temperature";
    /// One over a temperature.
    pub const EXPANSION: &str = "strain per temperature";
    /// A force per volume.
    pub const BODY_FORCE: &str = "force per volume";
    /// A length per time.
    pub const VELOCITY: &str = "velocity";
    /// A work per area.
    pub const WORK: &str = "work per area";
    /// A stress per velocity.
    pub const VISCOSITY: &str = "stress per velocity";
    /// One over a time.
    pub const RATE: &str = "rate";
}
