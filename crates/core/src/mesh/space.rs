//! What the coordinates of a mesh mean.

/// The space a model lives in. Plane and axisymmetric meshes use x and y; in the axisymmetric case x is r and y is z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Space {
    /// No strain along z.
    PlaneStrain,
    /// No stress along z.
    PlaneStress,
    /// Turned about the y axis; forces are those of the full circumference.
    Axisymmetric,
    /// Three dimensions.
    Solid,
}

impl Space {
    /// The word a deck uses.
    pub fn name(self) -> &'static str {
        match self {
            Self::PlaneStrain => "plane-strain",
            Self::PlaneStress => "plane-stress",
            Self::Axisymmetric => "axisymmetric",
            Self::Solid => "solid",
        }
    }
    /// All spaces.
    pub const ALL: [Space; 4] = [Self::PlaneStrain, Self::PlaneStress, Self::Axisymmetric, Self::Solid];

    /// Displacements a node has.
    pub fn dimension(self) -> usize {
        if self == Self::Solid { 3 } else { 2 }
    }
    /// Names of the axes.
    pub fn axes(self) -> &'static [&'static str] {
        &["x", "y", "z"][..self.dimension()]
    }
}
