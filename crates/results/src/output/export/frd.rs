//! Results for CalculiX GraphiX, PrePoMax and FreeCAD: `results.frd`, formatted, with long numbers.
//! Source of the format: G. Dhondt, K. Wittig, "CalculiX GraphiX user's manual", section "Result format".

use super::growing::Growing;
use crate::output::{Frame, Quantity, QuantityPlace};
use asperity_core::Error;
use asperity_core::mesh::{Cell, Mesh};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;

/// Name of the file in the result directory.
pub const FRD: &str = "results.frd";
/// The last line.
const END: &str = " 9999\n";
/// What stands before each block of values.
const MARK: &str = "    1PSTEP";

/// Writes the frames of a run.
#[derive(Debug)]
pub struct Frd {
    file: Growing,
    /// The number of each node in the file.
    numbers: Vec<u64>,
    /// Blocks of values that were written.
    blocks: usize,
}

/// One block of values: what the format calls it, its components, and the quantities that they come from.
struct Block {
    name: &'static str,
    components: &'static [&'static str],
    kind: Kind,
    /// Nodal quantities, one after another.
    from: &'static [&'static str],
    /// Components of those, by place, which are added up; of none zero.
    places: &'static [&'static [usize]],
}

/// How viewers take the components together.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Scalar,
    Vector,
    Tensor,
}

const XYZ: &[&[usize]] = &[&[0], &[1], &[2]];
const SIX: &[&[usize]] = &[&[0], &[1], &[2], &[3], &[4], &[5]];

/// What is written, in the order of the file. Stress and strain run XX YY ZZ XY YZ ZX.
static BLOCKS: &[Block] = &[
    Block { name: "DISP", components: &["D1", "D2", "D3"], kind: Kind::Vector, from: &["displacement"], places: XYZ },
    Block {
        name: "STRESS",
        components: &["SXX", "SYY", "SZZ", "SXY", "SYZ", "SZX"],
        kind: Kind::Tensor,
        from: &["cauchy_stress_averaged"],
        places: SIX,
    },
    Block {
        name: "TOSTRAIN",
        components: &["EXX", "EYY", "EZZ", "EXY", "EYZ", "EZX"],
        kind: Kind::Tensor,
        from: &["logarithmic_strain_averaged"],
        places: SIX,
    },
    Block {
        name: "PE",
        components: &["PE"],
        kind: Kind::Scalar,
        from: &["equivalent_plastic_strain_averaged"],
        places: &[&[0]],
    },
    // All that acts on a node from outside, as CalculiX has it.
    Block {
        name: "FORC",
        components: &["F1", "F2", "F3"],
        kind: Kind::Vector,
        from: &["reaction", "load"],
        places: &[&[0, 3], &[1, 4], &[2, 5]],
    },
    // The second slip and shear stress are those along a second tangent, on which nothing is told apart.
    Block {
        name: "CONTACT",
        components: &["COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2"],
        kind: Kind::Tensor,
        from: &["contact_gap_averaged", "contact_slip_averaged", "contact_pressure_averaged", "contact_shear_averaged"],
        places: &[&[0], &[1], &[], &[2], &[3], &[]],
    },
];

/// Number of a cell's kind in the format, and the order of its nodes there; cells with nodes in the middle of faces are written
/// without those.
pub fn frd_cell(cell: &Cell) -> Option<(u8, Vec<usize>)> {
    let twisted = |corners: usize, edges: usize| {
        // Middles below, then those of the uprights, then those above.
        let (below, above) = (corners..corners + edges, corners + edges..corners + 2 * edges);
        (0..corners).chain(below).chain(corners + 2 * edges..corners + 3 * edges).chain(above).collect()
    };
    Some(match cell.name {
        "line2" => (11, vec![0, 1]),
        "line3" => (12, vec![0, 1, 2]),
        "tri3" => (7, (0..3).collect()),
        "tri6" => (8, (0..6).collect()),
        "quad4" => (9, (0..4).collect()),
        "quad8" | "quad9" => (10, (0..8).collect()),
        "tet4" => (3, (0..4).collect()),
        "tet10" => (6, (0..10).collect()),
        "wedge6" => (2, (0..6).collect()),
        "wedge15" => (5, twisted(6, 3)),
        "hex8" => (1, (0..8).collect()),
        "hex20" | "hex27" => (4, twisted(8, 4)),
        _ => return None,
    })
}

/// A number in twelve places, as Fortran's `1P,E12.5`.
fn e12(x: f64) -> String {
    fortran(x, 5)
}

/// A number with so many digits behind the point and seven places more; what has no place there is the nearest that has.
pub fn fortran(x: f64, digits: usize) -> String {
    let x = if x.is_nan() || x.abs() < 1e-99 { 0.0 } else { x.clamp(-9.99999e99, 9.99999e99) };
    let (text, width) = (format!("{x:.digits$E}"), digits + 7);
    let (mantissa, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, digits) = exponent.strip_prefix('-').map_or(("+", exponent), |digits| ("-", digits));
    format!("{:>width$}", format!("{mantissa}E{sign}{digits:0>2}"))
}

/// A time in twelve places, with as many digits as there is room for.
fn time(x: f64) -> String {
    if x == 0.0 || (1e-3..1e3).contains(&x) { format!("{x:>12.8}") } else { e12(x) }
}

/// The numbers by which a file with one list of nodes or cells may call them: the user's where all differ and fit.
pub fn distinct(count: usize, number: impl Fn(usize) -> u64) -> Vec<u64> {
    let numbers: Vec<u64> = (0..count).map(number).collect();
    let all: BTreeSet<u64> = numbers.iter().copied().collect();
    let fits = all.len() == count && all.first() != Some(&0) && all.last().is_none_or(|&last| last < 10_000_000_000);
    if fits { numbers } else { (1..=count as u64).collect() }
}

impl Frd {
    /// Begins the file with the mesh.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written.
    pub fn create(directory: &Path, mesh: &Mesh, bodies: &[usize]) -> Result<Self, Error> {
        let (head, numbers) = head(mesh, bodies);
        Ok(Self { file: Growing::create(&directory.join(FRD), &head, END)?, numbers, blocks: 0 })
    }
    /// Continues the file of a run after its increment; what came later is dropped.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read or written.
    pub fn resume(directory: &Path, mesh: &Mesh, bodies: &[usize], increment: usize) -> Result<Self, Error> {
        let (head, numbers) = head(mesh, bodies);
        let kept = std::cell::Cell::new(0);
        let keep = |block: &str| {
            let fits = block.get(36..48).and_then(|field| field.trim().parse::<usize>().ok());
            let fits = fits.is_some_and(|at| at <= increment);
            kept.set(kept.get() + usize::from(fits));
            fits
        };
        let file = Growing::resume(&directory.join(FRD), (&head, END), MARK, keep)?;
        Ok(Self { file, numbers, blocks: kept.get() })
    }
    /// Adds a frame.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be written.
    pub fn push(&mut self, frame: &Frame) -> Result<(), Error> {
        let mut all = String::new();
        for block in BLOCKS {
            if let Some(text) = self.block(block, frame) {
                self.blocks += 1;
                let _ = writeln!(all, "{MARK:<24}{:>12}{:>12}{:>12}", self.blocks, frame.increment, frame.step);
                all += &text;
            }
        }
        self.file.push(&all)
    }

    /// A block of values; none where the model has no such quantity. Nodes without a value are left out.
    fn block(&self, block: &Block, frame: &Frame) -> Option<String> {
        let from: Option<Vec<&Quantity>> = block.from.iter().map(|name| frame.get(QuantityPlace::Node, name)).collect();
        let from = from?;
        let values = |node: usize| -> Vec<f64> {
            let all: Vec<f64> = from.iter().flat_map(|quantity| quantity.at(node)).copied().collect();
            block.places.iter().map(|places| places.iter().map(|&place| all[place]).sum()).collect()
        };
        let known = |node: &usize| from.iter().all(|quantity| quantity.at(*node).iter().all(|x| !x.is_nan()));
        let nodes: Vec<usize> = (0..self.numbers.len()).filter(known).collect();
        let (count, vector) = (block.components.len(), block.kind == Kind::Vector);
        let mut text = format!(
            "  100CL  101{}{:>12}{:20}{:>2}{:>5}{:10}{:>2}\n",
            time(frame.time),
            nodes.len(),
            "",
            0,
            frame.increment,
            "",
            1
        );
        let _ = writeln!(text, " -4  {:<8}{:>5}{:>5}", block.name, count + usize::from(vector), 1);
        for (i, name) in block.components.iter().enumerate() {
            let [kind, row, column] = match block.kind {
                Kind::Scalar => [1, 0, 0],
                Kind::Vector => [2, i + 1, 0],
                Kind::Tensor => [4, [1, 2, 3, 1, 2, 3][i], [1, 2, 3, 2, 3, 1][i]],
            };
            let _ = writeln!(text, " -5  {name:<8}{:>5}{kind:>5}{row:>5}{column:>5}{:>5}", 1, 0);
        }
        if vector {
            let _ = writeln!(text, " -5  {:<8}{:>5}{:>5}{:>5}{:>5}{:>5}{:<8}", "ALL", 1, 2, 0, 0, 1, "ALL");
        }
        for node in nodes {
            let _ = write!(text, " -1{:>10}", self.numbers[node]);
            values(node).into_iter().for_each(|value| text.push_str(&e12(value)));
            text.push('\n');
        }
        Some(text + " -3\n")
    }
}

/// The lines of nodes and cells, and the numbers of the nodes; `bodies` says for each cell which body it is of.
fn head(mesh: &Mesh, bodies: &[usize]) -> (String, Vec<u64>) {
    let nodes = distinct(mesh.points.len(), |node| mesh.node_number(node));
    let cells = distinct(mesh.cell_count(), |cell| mesh.cell_number(cell));
    let mut text =
        format!("    1C{:<6}\n    1U{:<20}{}\n", "run", "PGM", concat!("Asperity ", env!("CARGO_PKG_VERSION")));
    let _ = writeln!(text, "    2C{:18}{:>12}{:37}1", "", nodes.len(), "");
    for (number, point) in nodes.iter().zip(mesh.places()) {
        let _ = writeln!(text, " -1{number:>10}{}{}{}", e12(point[0]), e12(point[1]), e12(point[2]));
    }
    let _ = writeln!(text, " -3\n    3C{:18}{:>12}{:37}1", "", cells.len(), "");
    for (cell, number) in cells.iter().enumerate() {
        let view = mesh.cell(cell);
        let Some((kind, order)) = frd_cell(view.kind) else { continue };
        let body = bodies.get(cell).copied().unwrap_or(0);
        let _ = writeln!(text, " -1{number:>10}{kind:>5}{body:>5}{body:>5}");
        for line in order.chunks(10) {
            text.push_str(" -2");
            text.extend(line.iter().map(|&i| format!("{:>10}", nodes[view.nodes[i]])));
            text.push('\n');
        }
    }
    (text + " -3\n", nodes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::mesh::cells::ALL;

    #[test]
    fn numbers_take_twelve_places_whatever_they_are() {
        assert_eq!(e12(0.1), " 1.00000E-01");
        assert_eq!(e12(-123456.0), "-1.23456E+05");
        for x in [0.0, f64::MIN_POSITIVE, f64::MAX, -f64::MAX, f64::NAN, 9.999999e99, 1e-99] {
            assert_eq!(e12(x).len(), 12, "{x}");
        }
    }

    #[test]
    fn every_cell_has_its_kind_and_uses_no_node_twice() {
        for cell in ALL {
            let (_, order) = frd_cell(cell).unwrap_or_else(|| panic!("{}", cell.name));
            let all: BTreeSet<usize> = order.iter().copied().collect();
            assert_eq!(all.len(), order.len(), "{}", cell.name);
        }
        let (_, hex) = frd_cell(Cell::named("hex20").unwrap()).unwrap();
        assert_eq!(hex[12..], [16, 17, 18, 19, 12, 13, 14, 15]);
    }

    #[test]
    fn numbers_that_repeat_are_counted_anew() {
        assert_eq!(distinct(3, |i| [7, 3, 7][i]), [1, 2, 3]);
        assert_eq!(distinct(3, |i| [7, 3, 5][i]), [7, 3, 5]);
    }
}
