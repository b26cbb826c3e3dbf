//! Element types: what each is, its corners and faces, and which formulation of ours stands for its variants.

/// What the coordinates of an element mean, or what it is if it is no cell of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Three dimensions.
    Solid,
    /// Plane, no strain across the plane.
    PlaneStrain,
    /// Plane, no stress across the plane.
    PlaneStress,
    /// Turned about the y axis.
    Axisymmetric,
    /// Rigid: part of a tool.
    Rigid,
    /// A truss, shell or membrane: meshers leave them behind as marks of sides.
    Skin,
}

impl Family {
    /// Its name as a `space` of a deck.
    pub fn space(self) -> &'static str {
        match self {
            Self::PlaneStrain => "plane-strain",
            Self::PlaneStress => "plane-stress",
            Self::Axisymmetric => "axisymmetric",
            Self::Solid | Self::Rigid | Self::Skin => "solid",
        }
    }
}

/// An element type without the letters of its variant.
#[derive(Debug)]
pub struct Type {
    /// Its name: `C3D8`.
    pub name: &'static str,
    /// How many nodes it has.
    pub nodes: usize,
    /// What it is.
    pub family: Family,
    /// Degree of its shape functions.
    pub degree: usize,
    /// Corners of its faces S1, S2, ...
    pub faces: &'static [&'static [usize]],
}

const TRI: &[&[usize]] = &[&[0, 1], &[1, 2], &[2, 0]];
const QUAD: &[&[usize]] = &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]];
const TET: &[&[usize]] = &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]];
const WEDGE: &[&[usize]] = &[&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]];
const HEX: &[&[usize]] = &[&[0, 1, 2, 3], &[4, 7, 6, 5], &[0, 4, 5, 1], &[1, 5, 6, 2], &[2, 6, 7, 3], &[3, 7, 4, 0]];

macro_rules! types {
    ($($name:literal $nodes:literal $family:ident $degree:literal $faces:expr;)*) => {
        /// The types that are read. Names that begin with another's come first.
        pub static TYPES: &[Type] = &[$(
            Type { name: $name, nodes: $nodes, family: Family::$family, degree: $degree, faces: $faces },
        )*];
    };
}

types! {
    "C3D10" 10 Solid 2 TET; "C3D15" 15 Solid 2 WEDGE; "C3D20" 20 Solid 2 HEX; "C3D27" 27 Solid 2 HEX;
    "C3D4" 4 Solid 1 TET; "C3D6" 6 Solid 1 WEDGE; "C3D8" 8 Solid 1 HEX;
    "CPE3" 3 PlaneStrain 1 TRI; "CPE4" 4 PlaneStrain 1 QUAD; "CPE6" 6 PlaneStrain 2 TRI; "CPE8" 8 PlaneStrain 2 QUAD;
    "CPS3" 3 PlaneStress 1 TRI; "CPS4" 4 PlaneStress 1 QUAD; "CPS6" 6 PlaneStress 2 TRI; "CPS8" 8 PlaneStress 2 QUAD;
    "CAX3" 3 Axisymmetric 1 TRI; "CAX4" 4 Axisymmetric 1 QUAD; "CAX6" 6 Axisymmetric 2 TRI; "CAX8" 8 Axisymmetric 2 QUAD;
    "R2D2" 2 Rigid 1 &[&[0, 1]]; "RAX2" 2 Rigid 1 &[&[0, 1]];
    "R3D3" 3 Rigid 1 &[&[0, 1, 2]]; "R3D4" 4 Rigid 1 &[&[0, 1, 2, 3]];
    "SFM3D3" 3 Skin 1 &[]; "SFM3D4" 4 Skin 1 &[]; "SFM3D6" 6 Skin 2 &[]; "SFM3D8" 8 Skin 2 &[];
    "M3D3" 3 Skin 1 &[]; "M3D4" 4 Skin 1 &[]; "M3D6" 6 Skin 2 &[]; "M3D8" 8 Skin 2 &[];
    "S3" 3 Skin 1 &[]; "S4" 4 Skin 1 &[]; "S6" 6 Skin 2 &[]; "S8" 8 Skin 2 &[];
    "T2D2" 2 Skin 1 &[]; "T2D3" 3 Skin 2 &[]; "T3D2" 2 Skin 1 &[]; "T3D3" 3 Skin 2 &[];
}

/// Letters behind a name that choose integration or formulation.
const VARIANTS: &str = "RHIMSTPE5";

/// The type of a name and the letters of its variant.
pub fn named(name: &str) -> Option<(&'static Type, String)> {
    let name = name.to_ascii_uppercase();
    let variant = |found: &Type| {
        let rest = name.strip_prefix(found.name)?;
        rest.chars().all(|letter| VARIANTS.contains(letter)).then(|| rest.to_string())
    };
    TYPES.iter().find_map(|found| Some((found, variant(found)?)))
}

/// Whose input deck it is: the same element names mean different formulations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Dialect {
    /// Plain full integration of bricks of first degree.
    #[default]
    CalculiX,
    /// Bricks of first degree with a mean change of volume.
    Abaqus,
}

/// How a cell is integrated, in our words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Formulation {
    /// Full integration of what each point sees.
    Standard,
    /// Full integration with one change of volume for a cell or a patch of cells.
    FBar,
    /// Full integration with incompatible modes.
    Incompatible,
    /// Reduced integration.
    Reduced,
}

impl Formulation {
    /// Its keys of a body: a type says how it is computed, so nothing is left to be chosen.
    pub fn keys(self) -> &'static str {
        match self {
            Self::Standard => "formulation = \"standard\"\nintegration = \"full\"\n",
            Self::FBar => "formulation = \"f-bar\"\n",
            Self::Incompatible => "formulation = \"incompatible\"\n",
            Self::Reduced => "integration = \"reduced\"\n",
        }
    }
}

impl Type {
    /// Whether it is a cell of a body.
    pub fn is_cell(&self) -> bool {
        !matches!(self.family, Family::Rigid | Family::Skin)
    }

    /// What stands for a variant of this type in a dialect, and a remark where that is not the same.
    pub fn formulation(&self, variant: &str, dialect: Dialect) -> (Formulation, Option<&'static str>) {
        let brick = matches!(self.faces.len(), 4 | 6) && self.faces != TET;
        let (reduced, modes) = (variant.contains('R'), variant.contains('I'));
        let hybrid = variant.contains('H') && self.family != Family::PlaneStress;
        match (self.degree, brick, self.family) {
            (2, true, _) if reduced => (Formulation::Reduced, hybrid.then_some(NO_PRESSURE)),
            (2, ..) if hybrid => (Formulation::FBar, Some(MEAN)),
            (2, ..) => (Formulation::Standard, modified(variant)),
            (1, true, _) if modes => (Formulation::Incompatible, None),
            (1, true, Family::PlaneStress) if reduced => {
                (Formulation::Incompatible, Some("one point with hourglass control becomes incompatible modes"))
            }
            (1, true, Family::PlaneStress) => (Formulation::Standard, None),
            (1, true, _) if reduced => {
                (Formulation::FBar, Some("one point with hourglass control becomes F-bar, which bends otherwise"))
            }
            (1, true, _) if dialect == Dialect::Abaqus || hybrid => (Formulation::FBar, None),
            (1, true, _) => (
                Formulation::Standard,
                Some("full integration as in CalculiX; `formulation = \"f-bar\"` does not lock"),
            ),
            _ if hybrid => (Formulation::FBar, Some(MEAN)),
            _ => (Formulation::Standard, None),
        }
    }
}

const NO_PRESSURE: &str = "the pressure is no unknown of its own: reduced integration stands for it";
const MEAN: &str =
    "the pressure is no unknown of its own: one change of volume for a cell, or a patch of simplices, stands for it";

fn modified(variant: &str) -> Option<&'static str> {
    variant.contains('M').then_some("modified second degree becomes plain second degree")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_their_variants() {
        for (name, base, variant) in
            [("c3d20R", "C3D20", "R"), ("C3D10MH", "C3D10", "MH"), ("CAX4", "CAX4", ""), ("S8R5", "S8", "R5")]
        {
            let (found, letters) = named(name).unwrap();
            assert_eq!((found.name, letters.as_str()), (base, variant));
        }
        assert!(["B31", "C3D", "C3D5", "DC3D8", ""].iter().all(|name| named(name).is_none()));
    }

    #[test]
    fn bricks_of_first_degree_are_what_their_dialect_means() {
        let of = |name: &str, dialect| {
            let (found, variant) = named(name).unwrap();
            found.formulation(&variant, dialect).0
        };
        for name in ["C3D8", "CPE4", "CAX4"] {
            assert_eq!(of(name, Dialect::Abaqus), Formulation::FBar, "{name}");
            assert_eq!(of(name, Dialect::CalculiX), Formulation::Standard, "{name}");
        }
        for dialect in [Dialect::Abaqus, Dialect::CalculiX] {
            for name in ["C3D8R", "CAX4R"] {
                assert_eq!(of(name, dialect), Formulation::FBar, "{name}");
            }
            for name in ["C3D8I", "CPE4I", "CPS4I", "CPS4R"] {
                assert_eq!(of(name, dialect), Formulation::Incompatible, "{name}");
            }
            for name in ["C3D20", "CPE8", "CAX8"] {
                assert!(of(name, dialect).keys().contains("integration = \"full\""), "{name}");
            }
            for name in ["C3D20R", "CPE8R", "CPS8R"] {
                assert_eq!(of(name, dialect), Formulation::Reduced, "{name}");
            }
            for name in ["C3D4H", "C3D10H", "C3D20H", "C3D8H", "CPE3H", "C3D10MH"] {
                assert_eq!(of(name, dialect), Formulation::FBar, "{name}");
            }
            for name in ["C3D20", "C3D4", "C3D10", "CPS4", "CPE6", "C3D6", "C3D15"] {
                assert_eq!(of(name, dialect), Formulation::Standard, "{name}");
            }
        }
    }
}
