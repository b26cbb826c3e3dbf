//! The result store: every number that a run reports is a [`Quantity`], computed once per accepted increment and kept
//! in one [`Frame`]. Files, tables, the summary and the pictures only read frames, so that they can never disagree.
//! Nothing here knows how a quantity is computed or written.

use super::certificate::Reading;
use asperity_core::Error;
use asperity_core::tensor::Vec3;

/// Name of where a point or a face was before any motion.
pub const REFERENCE_POSITION: &str = "reference_position";

/// Where the values of a quantity live.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum QuantityPlace {
    /// One value a node of the mesh.
    Node,
    /// One value a cell of the mesh.
    Cell,
    /// One value an integration point of a body.
    Gauss,
    /// One value an integration point of a contact surface.
    Contact,
    /// One value a face of a contact surface, contact after contact.
    Face,
    /// One value for the whole model.
    Global,
}

/// What a value is: how many numbers it has and what they are called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// One number.
    Scalar,
    /// Three components x, y, z; (r, z) stand in (x, y) when axisymmetric.
    Vector,
    /// Three components of a moment or rotation; in a plane only z is of interest.
    Axial,
    /// Six components XX YY ZZ XY YZ XZ of a symmetric tensor.
    Symmetric,
}

/// The dimension of a quantity. The program has no units: these words name what the user's own consistent units make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// A pure number.
    One,
    /// An angle, in degrees.
    Angle,
    /// Time.
    Time,
    /// Length.
    Length,
    /// Length squared.
    Area,
    /// Length cubed.
    Volume,
    /// Force.
    Force,
    /// Force times length.
    Moment,
    /// Force over area.
    Stress,
    /// Force times length, as work.
    Energy,
    /// Work per area.
    EnergyDensity,
}

/// What kind of number the values are; the store keeps all as `f64`, files write the narrowest fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    /// A measured value.
    Real,
    /// An index or a count.
    Integer,
    /// A small code or a yes and no.
    Byte,
}

/// One reported thing: its name, dimension, place, width and values, tuple after tuple.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantity {
    /// The name that every file uses: `displacement`, `contact.bore.force`.
    pub name: String,
    /// Its dimension.
    pub unit: Unit,
    /// Where it lives.
    pub place: QuantityPlace,
    /// What one value is made of.
    pub width: Width,
    /// What kind of number.
    pub number: Number,
    /// The values; as many as places times [`Width::size`].
    pub values: Vec<f64>,
}

/// Everything reported at one accepted increment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Frame {
    /// Step, counted from 1; 0 before the first.
    pub step: usize,
    /// Accepted increment, counted from 1 over all steps; 0 at the start.
    pub increment: usize,
    /// Total time.
    pub time: f64,
    quantities: Vec<Quantity>,
    readings: Vec<Reading>,
}

impl Width {
    /// Number of components that are stored.
    pub fn size(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vector | Self::Axial => 3,
            Self::Symmetric => 6,
        }
    }
    /// The components worth a column in a table, each with its suffix; a plane has no z forces and no x, y moments.
    pub fn columns(self, plane: bool) -> &'static [(usize, &'static str)] {
        match (self, plane) {
            (Self::Scalar, _) => &[(0, "")],
            (Self::Vector, true) => &[(0, ".x"), (1, ".y")],
            (Self::Axial, true) => &[(2, ".z")],
            (Self::Vector | Self::Axial, false) => &[(0, ".x"), (1, ".y"), (2, ".z")],
            (Self::Symmetric, _) => &[(0, ".xx"), (1, ".yy"), (2, ".zz"), (3, ".xy"), (4, ".yz"), (5, ".xz")],
        }
    }
}

impl Unit {
    /// The dimension in words, for axes and documentation; empty for a pure number.
    pub fn text(self) -> &'static str {
        match self {
            Self::One => "",
            Self::Angle => "degrees",
            Self::Time => "time",
            Self::Length => "length",
            Self::Area => "length^{2}",
            Self::Volume => "length^{3}",
            Self::Force => "force",
            Self::Moment | Self::Energy => "force · length",
            Self::Stress => "force / length^{2}",
            Self::EnergyDensity => "force / length",
        }
    }
}

impl Quantity {
    /// A quantity of real values.
    pub fn new(name: impl Into<String>, unit: Unit, place: QuantityPlace, width: Width, values: Vec<f64>) -> Self {
        Self { name: name.into(), unit, place, width, number: Number::Real, values }
    }
    /// One number for the whole model.
    pub fn scalar(name: impl Into<String>, unit: Unit, value: f64) -> Self {
        Self::new(name, unit, QuantityPlace::Global, Width::Scalar, vec![value])
    }
    /// A whole number at every place: an index, a count, a code.
    pub fn integer(name: impl Into<String>, place: QuantityPlace, values: Vec<f64>) -> Self {
        Self { number: Number::Integer, ..Self::new(name, Unit::One, place, Width::Scalar, values) }
    }
    /// A small code at every place, 0 to 255.
    pub fn byte(name: impl Into<String>, place: QuantityPlace, values: Vec<f64>) -> Self {
        Self { number: Number::Byte, ..Self::new(name, Unit::One, place, Width::Scalar, values) }
    }
    /// How many places have a value.
    pub fn count(&self) -> usize {
        self.values.len() / self.width.size()
    }
    /// The value at one place.
    pub fn at(&self, index: usize) -> &[f64] {
        let size = self.width.size();
        &self.values[index * size..(index + 1) * size]
    }
    /// The value at one place as a vector of space; only for [`Width::Vector`] and [`Width::Axial`].
    pub fn vector(&self, index: usize) -> [f64; 3] {
        let value = self.at(index);
        [value[0], value[1], value[2]]
    }
}

impl Frame {
    /// An empty frame.
    pub fn new(step: usize, increment: usize, time: f64) -> Self {
        Self { step, increment, time, ..Self::default() }
    }
    /// Adds a quantity.
    ///
    /// # Errors
    /// When its name is taken at that place, or its number of values differs from that of the quantities there.
    pub fn push(&mut self, quantity: Quantity) -> Result<(), Error> {
        let name = &quantity.name;
        if self.get(quantity.place, name).is_some() {
            return Err(Error::Internal(format!("result '{name}' is given twice")));
        }
        let count = self.count(quantity.place).unwrap_or(quantity.count());
        if count * quantity.width.size() != quantity.values.len() {
            let (place, found) = (quantity.place, quantity.values.len());
            return Err(Error::Internal(format!("result '{name}' has {found} numbers for {count} of {place:?}")));
        }
        self.quantities.push(quantity);
        Ok(())
    }
    /// Moves what says where things are by the origin of a mesh.
    pub(super) fn shift(&mut self, origin: Vec3) {
        self.readings.iter_mut().filter_map(|reading| reading.position.as_mut()).for_each(|x| *x += origin);
        for quantity in self.quantities.iter_mut().filter(|quantity| quantity.name == REFERENCE_POSITION) {
            quantity.values.as_chunks_mut::<3>().0.iter_mut().for_each(|x| *x = (Vec3(*x) + origin).0);
        }
    }
    /// Hands in a reading for the certificate.
    pub fn certify(&mut self, reading: Reading) {
        self.readings.push(reading);
    }
    /// The readings for the certificate, in the order in which they were handed in.
    pub fn readings(&self) -> &[Reading] {
        &self.readings
    }
    /// A quantity by place and name.
    pub fn get(&self, place: QuantityPlace, name: &str) -> Option<&Quantity> {
        self.at(place).find(|quantity| quantity.name == name)
    }
    /// The quantities of one place, in the order in which they were added.
    pub fn at(&self, place: QuantityPlace) -> impl Iterator<Item = &Quantity> {
        self.quantities.iter().filter(move |quantity| quantity.place == place)
    }
    /// Takes the quantities of one place out of the frame, in the order in which they were added.
    pub fn take(&mut self, place: QuantityPlace) -> impl Iterator<Item = Quantity> {
        self.quantities.extract_if(.., move |quantity| quantity.place == place)
    }
    /// How many places of this kind there are; none when nothing is reported there.
    pub fn count(&self, place: QuantityPlace) -> Option<usize> {
        self.at(place).next().map(Quantity::count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_refuses_what_does_not_fit() {
        let mut frame = Frame::new(1, 1, 0.5);
        let nodal = |name: &str, n| Quantity::new(name, Unit::Length, QuantityPlace::Node, Width::Vector, vec![0.0; n]);
        assert!(frame.push(nodal("displacement", 12)).is_ok());
        assert!(frame.push(nodal("displacement", 12)).is_err(), "taken name");
        assert!(frame.push(nodal("reaction", 9)).is_err(), "three nodes instead of four");
        assert!(frame.push(nodal("reaction", 13)).is_err(), "not whole vectors");
        assert!(frame.push(Quantity::scalar("displacement", Unit::Length, 1.0)).is_ok(), "another place, same name");
        assert_eq!(frame.count(QuantityPlace::Node), Some(4));
        assert_eq!(frame.count(QuantityPlace::Cell), None);
    }

    #[test]
    fn columns_name_what_the_space_has() {
        assert_eq!(Width::Vector.columns(true).len(), 2);
        assert_eq!(Width::Axial.columns(true), &[(2, ".z")]);
        assert_eq!(Width::Axial.columns(false).len(), Width::Axial.size());
        assert_eq!(Width::Symmetric.columns(true).len(), Width::Symmetric.size());
    }
}
