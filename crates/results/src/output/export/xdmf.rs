//! All frames of the bodies in one file: `results.xdmf`, a temporal collection whose numbers stand in the text, so that no
//! other file and no library goes with it. The mesh stands in the first frame; the others refer to it.
//! Source of the format: "XDMF model and format", xdmf.org.

use super::growing::Growing;
use crate::output::vtk::{escape, vtk_order};
use crate::output::{Frame, Quantity, QuantityPlace, Width};
use asperity_core::Error;
use asperity_core::mesh::Mesh;
use std::fmt::Write;
use std::path::Path;

/// Name of the file in the result directory.
pub const XDMF: &str = "results.xdmf";
const HEAD: &str = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n\
                    <Grid Name=\"results\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
const END: &str = "</Grid>\n</Domain>\n</Xdmf>\n";
const MARK: &str = "<Grid Name=\"increment ";

/// Writes the frames of a run.
#[derive(Debug)]
pub struct Xdmf {
    file: Growing,
    /// Topology and geometry, until they are written.
    mesh: Option<String>,
}

/// Name and number of a kind of cell, by VTK's number.
fn topology(vtk: u8) -> Option<(&'static str, u8)> {
    Some(match vtk {
        3 => ("Polyline", 2),
        5 => ("Triangle", 4),
        9 => ("Quadrilateral", 5),
        10 => ("Tetrahedron", 6),
        12 => ("Hexahedron", 9),
        13 => ("Wedge", 8),
        21 => ("Edge_3", 34),
        22 => ("Triangle_6", 36),
        23 => ("Quadrilateral_8", 37),
        24 => ("Tetrahedron_10", 38),
        25 => ("Hexahedron_20", 48),
        26 => ("Wedge_15", 40),
        28 => ("Quadrilateral_9", 35),
        29 => ("Hexahedron_27", 50),
        _ => return None,
    })
}

/// Topology and geometry of a mesh.
fn described(mesh: &Mesh) -> Result<String, Error> {
    let lost = |name: &str| Error::Internal(format!("no XDMF topology for the cell {name}"));
    let (mut numbers, mut text) = (String::new(), String::new());
    let count = mesh.cell_count();
    let same = mesh.kinds.windows(2).all(|pair| pair[0] == pair[1]);
    let mut entries = 0;
    for cell in 0..count {
        let view = mesh.cell(cell);
        let (_, number) = topology(view.kind.vtk).ok_or_else(|| lost(view.kind.name))?;
        let order = vtk_order(view.kind).ok_or_else(|| lost(view.kind.name))?;
        if !same {
            let _ = write!(numbers, "{number} ");
            entries += 1;
            if number == 2 {
                // A polyline says how many nodes it has.
                let _ = write!(numbers, "{} ", order.len());
                entries += 1;
            }
        }
        numbers.extend(order.iter().map(|&i| format!("{} ", view.nodes[i])));
        numbers.push('\n');
        entries += order.len();
    }
    let (name, dimensions) = match mesh.kinds.first() {
        Some(kind) if same => {
            let (name, _) = topology(kind.vtk).ok_or_else(|| lost(kind.name))?;
            (name, format!("{count} {}", kind.nodes.len()))
        }
        _ => ("Mixed", entries.to_string()),
    };
    let _ = write!(
        text,
        "<Topology TopologyType=\"{name}\" NumberOfElements=\"{count}\">\n<DataItem DataType=\"Int\" Precision=\"8\" \
         Dimensions=\"{dimensions}\" Format=\"XML\">\n{numbers}</DataItem>\n</Topology>\n<Geometry GeometryType=\"XYZ\">\n\
         <DataItem DataType=\"Float\" Precision=\"8\" Dimensions=\"{} 3\" Format=\"XML\">\n",
        mesh.points.len()
    );
    for point in mesh.places() {
        let _ = writeln!(text, "{:?} {:?} {:?}", point[0], point[1], point[2]);
    }
    Ok(text + "</DataItem>\n</Geometry>\n")
}

/// The order of a symmetric tensor in the file: XX XY XZ YY YZ ZZ.
const TENSOR: [usize; 6] = [0, 3, 5, 1, 4, 2];

/// A quantity. What is not a number is a zero, which readers of text all know.
fn attribute(quantity: &Quantity, center: &str) -> String {
    let (kind, order): (&str, &[usize]) = match quantity.width {
        Width::Scalar => ("Scalar", &[0]),
        Width::Vector | Width::Axial => ("Vector", &[0, 1, 2]),
        Width::Symmetric => ("Tensor6", &TENSOR),
    };
    let dimensions = match order.len() {
        1 => quantity.count().to_string(),
        width => format!("{} {width}", quantity.count()),
    };
    let mut text = format!(
        "<Attribute Name=\"{}\" AttributeType=\"{kind}\" Center=\"{center}\">\n<DataItem DataType=\"Float\" Precision=\"8\" \
         Dimensions=\"{dimensions}\" Format=\"XML\">\n",
        escape(&quantity.name)
    );
    for value in quantity.values.chunks_exact(order.len()) {
        for &place in order {
            let x = value[place];
            let _ = write!(text, "{:?} ", if x.is_finite() { x } else { 0.0 });
        }
        text.push('\n');
    }
    text + "</DataItem>\n</Attribute>\n"
}

impl Xdmf {
    /// Begins the file.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written.
    pub fn create(directory: &Path, mesh: &Mesh) -> Result<Self, Error> {
        let file = Growing::create(&directory.join(XDMF), HEAD, END)?;
        Ok(Self { file, mesh: Some(described(mesh)?) })
    }
    /// Continues the file of a run after its increment; what came later is dropped.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read or written.
    pub fn resume(directory: &Path, mesh: &Mesh, increment: usize) -> Result<Self, Error> {
        let number = |block: &str| {
            let digits = block.strip_prefix(MARK)?.split('"').next()?;
            digits.parse::<usize>().ok()
        };
        let kept = std::cell::Cell::new(false);
        let keep = |block: &str| {
            let keeps = number(block).is_some_and(|at| at <= increment);
            kept.set(kept.get() || keeps);
            keeps
        };
        let file = Growing::resume(&directory.join(XDMF), (HEAD, END), MARK, keep)?;
        let mesh = if kept.get() { None } else { Some(described(mesh)?) };
        Ok(Self { file, mesh })
    }
    /// Adds a frame.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be written.
    pub fn push(&mut self, frame: &Frame) -> Result<(), Error> {
        let mut text =
            format!("{MARK}{}\" GridType=\"Uniform\">\n<Time Value=\"{:?}\"/>\n", frame.increment, frame.time);
        match self.mesh.take() {
            Some(mesh) => text += &mesh,
            None => {
                for part in ["Topology", "Geometry"] {
                    let _ = writeln!(text, "<{part} Reference=\"XML\">/Xdmf/Domain/Grid/Grid[1]/{part}</{part}>");
                }
            }
        }
        text.extend(frame.at(QuantityPlace::Node).map(|quantity| attribute(quantity, "Node")));
        text.extend(frame.at(QuantityPlace::Cell).map(|quantity| attribute(quantity, "Cell")));
        self.file.push(&(text + "</Grid>\n"))
    }
}
