//! Tables of values at the nodes of a group, the integration points of its cells or the points of a contact, as CalculiX
//! prints them: `results.dat`. Source: "CalculiX CrunchiX user's manual", `*NODE PRINT`, `*EL PRINT`, `*CONTACT PRINT`.

use super::frd::{distinct, fortran};
use super::growing::Growing;
use crate::output::quantities::Source;
use crate::output::{Frame, Quantity, QuantityPlace, Unit, Width};
use asperity_core::Error;
use std::fmt::Write;
use std::path::Path;

/// Name of the file in the result directory.
pub const DAT: &str = "results.dat";
const HEAD: &str = "\n";
/// How the tables of a frame begin.
const MARK: &str = "\n                        S T E P";

/// What is printed of a group or a contact.
#[derive(Debug, Clone, PartialEq)]
pub struct Printed {
    /// Whose values.
    pub whose: Whose,
    /// The quantities: names at nodes, at integration points, at contact points.
    pub quantities: Vec<String>,
    /// Whether values, the sum of forces or both are printed.
    pub totals: Totals,
}

/// Whose values are printed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Whose {
    /// The nodes of a group.
    Nodes(String),
    /// The integration points of the cells of a group.
    Cells(String),
    /// The points of a contact.
    Contact(String),
}

/// Values or sums.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Totals {
    /// Values.
    No,
    /// Values and their sum.
    Yes,
    /// The sum.
    Only,
}

impl Whose {
    /// Where the quantities live.
    pub fn place(&self) -> QuantityPlace {
        match self {
            Self::Nodes(_) => QuantityPlace::Node,
            Self::Cells(_) => QuantityPlace::Gauss,
            Self::Contact(_) => QuantityPlace::Contact,
        }
    }
    fn name(&self) -> &str {
        match self {
            Self::Nodes(name) | Self::Cells(name) | Self::Contact(name) => name,
        }
    }
}

/// Writes the tables.
#[derive(Debug)]
pub struct Dat {
    file: Growing,
    printed: Vec<Printed>,
}

impl Dat {
    /// Begins the file.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written.
    pub fn create(directory: &Path, printed: &[Printed]) -> Result<Self, Error> {
        Ok(Self { file: Growing::create(&directory.join(DAT), HEAD, "")?, printed: printed.to_vec() })
    }
    /// Continues the file of a run after its increment; what came later is dropped.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read or written.
    pub fn resume(directory: &Path, printed: &[Printed], increment: usize) -> Result<Self, Error> {
        let at = |block: &str| block.lines().nth(1)?.rsplit_once("INCREMENT")?.1.trim().parse::<usize>().ok();
        let keep = |block: &str| at(block).is_some_and(|at| at <= increment);
        let file = Growing::resume(&directory.join(DAT), (HEAD, ""), MARK, keep)?;
        Ok(Self { file, printed: printed.to_vec() })
    }
    /// Adds the tables of a frame.
    ///
    /// # Errors
    /// [`Error::Write`] when they cannot be written.
    pub fn push(&mut self, source: &Source, frame: &Frame) -> Result<(), Error> {
        let mut text = format!("{MARK}{:>8}   INCREMENT{:>8}\n", frame.step, frame.increment);
        for printed in &self.printed {
            let rows = rows(source, frame, &printed.whose);
            for name in &printed.quantities {
                if let Some(quantity) = frame.get(printed.whose.place(), name) {
                    table(&mut text, (printed, quantity), &rows, frame.time);
                }
            }
        }
        self.file.push(&text)
    }
}

/// Places of the values, each with what its row begins with.
fn rows(source: &Source, frame: &Frame, whose: &Whose) -> Vec<(usize, String)> {
    let mesh = source.parts.mesh;
    match whose {
        Whose::Nodes(name) => {
            let numbers = distinct(mesh.points.len(), |node| mesh.node_number(node));
            let nodes = mesh.groups.get(name).map_or(&[][..], |group| &group.nodes);
            nodes.iter().map(|&node| (node, format!("{:>10}", numbers[node]))).collect()
        }
        Whose::Cells(name) => {
            let numbers = distinct(mesh.cell_count(), |cell| mesh.cell_number(cell));
            let wanted = mesh.groups.get(name).map_or(&[][..], |group| &group.cells);
            let cells = frame.get(QuantityPlace::Gauss, "cell").map_or(&[][..], |quantity| &quantity.values);
            let (mut before, mut point, mut found) = (None, 0, Vec::new());
            for (place, &cell) in cells.iter().enumerate() {
                point = if before == Some(cell as usize) { point + 1 } else { 1 };
                before = Some(cell as usize);
                if wanted.binary_search(&(cell as usize)).is_ok() {
                    found.push((place, format!("{:>10}{point:>4}", numbers[cell as usize])));
                }
            }
            found
        }
        Whose::Contact(name) => {
            let number = source.parts.contacts.iter().position(|(_, own, _)| own == name);
            let all = frame.get(QuantityPlace::Contact, "contact").map_or(&[][..], |quantity| &quantity.values);
            let own = all.iter().enumerate().filter(|(_, contact)| Some(**contact as usize) == number);
            own.enumerate().map(|(i, (place, _))| (place, format!("{:>10}", i + 1))).collect()
        }
    }
}

/// The order of a symmetric tensor in these tables: XX YY ZZ XY XZ YZ.
const TENSOR: [usize; 6] = [0, 1, 2, 3, 5, 4];

fn table(text: &mut String, (printed, quantity): (&Printed, &Quantity), rows: &[(usize, String)], at: f64) {
    let (words, components) = words(quantity);
    let lead = match printed.whose {
        Whose::Nodes(_) => "",
        Whose::Cells(_) => "elem, integ.pnt.,",
        Whose::Contact(_) => "point,",
    };
    let kind = if matches!(printed.whose, Whose::Contact(_)) { "contact" } else { "set" };
    let end = format!("for {kind} {} and time {}\n\n", printed.whose.name(), time(at));
    let order: &[usize] =
        if quantity.width == Width::Symmetric { &TENSOR } else { &[0, 1, 2][..quantity.width.size()] };
    if printed.totals != Totals::Only {
        let _ = write!(text, "\n {words} ({lead}{components}) {end}");
        for (place, begin) in rows {
            text.push_str(begin);
            let value = quantity.at(*place);
            order.iter().for_each(|&i| text.push_str(&e14(value[i])));
            text.push('\n');
        }
    }
    // Fields do not add up.
    if printed.totals != Totals::No && quantity.unit == Unit::Force {
        let words = if words == "forces" { "force" } else { &words };
        let _ = write!(text, "\n total {words} ({components}) {end}          ");
        for &i in order {
            let sum: f64 = rows.iter().map(|(place, _)| quantity.at(*place)[i]).filter(|x| !x.is_nan()).sum();
            text.push_str(&e14(sum));
        }
        text.push('\n');
    }
}

/// What the tables call a quantity and its components.
fn words(quantity: &Quantity) -> (String, &'static str) {
    let (words, components) = match quantity.name.as_str() {
        "displacement" => ("displacements", "vx,vy,vz"),
        "reaction" => ("forces", "fx,fy,fz"),
        "cauchy_stress" => ("stresses", "sxx,syy,szz,sxy,sxz,syz"),
        "logarithmic_strain" => ("strains", "exx,eyy,ezz,exy,exz,eyz"),
        "equivalent_plastic_strain" => ("equivalent plastic strain", "pe"),
        name => {
            let components = match quantity.width {
                Width::Scalar => "value",
                Width::Vector | Width::Axial => "x,y,z",
                Width::Symmetric => "xx,yy,zz,xy,xz,yz",
            };
            return (name.replace('_', " "), components);
        }
    };
    (words.to_owned(), components)
}

/// A number in fourteen places, as Fortran's `1P,E14.6`.
fn e14(x: f64) -> String {
    format!("{:>14}", if x.is_nan() { "NaN".into() } else { fortran(x, 6) })
}

/// A time as Fortran's `E14.7`, whose digits begin behind the point.
fn time(x: f64) -> String {
    let text = fortran(x, 6);
    let (mantissa, exponent) = text.trim().split_once('E').unwrap_or(("0.000000", "+00"));
    let exponent = exponent.parse::<i32>().unwrap_or(0) + i32::from(x != 0.0);
    let digits = mantissa.replace('.', "");
    format!("{:>14}", format!("0.{digits}E{}{:02}", if exponent < 0 { '-' } else { '+' }, exponent.abs()))
}

#[cfg(test)]
mod tests {
    use super::{e14, time};

    #[test]
    fn numbers_take_fourteen_places() {
        assert_eq!((e14(-0.02), e14(0.0)), (" -2.000000E-02".to_owned(), "  0.000000E+00".to_owned()));
        assert_eq!((time(1.0), time(0.25)), (" 0.1000000E+01".to_owned(), " 0.2500000E+00".to_owned()));
        assert_eq!((time(0.0), time(1234.5)), (" 0.0000000E+00".to_owned(), " 0.1234500E+04".to_owned()));
        for x in [f64::NAN, f64::MAX, f64::MIN_POSITIVE, 9.9999999e-5] {
            assert_eq!(e14(x).len(), 14, "{x}");
        }
    }
}
