//! `results.frd` and `results.dat` read back column by column, as their formats are fixed, and compared with the frames.

mod support;

use asperity::mesh::Mesh;
use asperity::output::vtk::{read_grid, read_series};
use std::collections::BTreeMap;
use std::path::Path;
use support::{made, write_results};

/// One block of values: its name, its components, and the values by node.
struct Block {
    time: f64,
    name: String,
    components: Vec<String>,
    values: BTreeMap<u64, Vec<f64>>,
}

/// A file, read strictly.
#[derive(Default)]
struct Frd {
    nodes: BTreeMap<u64, [f64; 3]>,
    cells: BTreeMap<u64, (usize, Vec<u64>)>,
    blocks: Vec<Block>,
}

/// The field from one column to before another, counted from 0, as a number.
fn field<T: std::str::FromStr>(line: &str, from: usize, to: usize) -> T {
    let text = line.get(from..to).unwrap_or_else(|| panic!("'{line}' is too short for {from}..{to}"));
    text.trim().parse().unwrap_or_else(|_| panic!("'{text}' in '{line}'"))
}

/// Twelve columns each.
fn reals(line: &str, count: usize) -> Vec<f64> {
    assert_eq!(line.len(), 13 + 12 * count, "'{line}'");
    (0..count).map(|i| field(line, 13 + 12 * i, 25 + 12 * i)).collect()
}

/// Nodes of each kind of cell.
const NODES: [usize; 13] = [0, 8, 6, 4, 20, 15, 10, 3, 6, 4, 8, 2, 3];

fn read_frd(text: &str) -> Frd {
    let (mut frd, mut lines) = (Frd::default(), text.lines());
    while let Some(line) = lines.next() {
        match line.get(..6).unwrap_or(line) {
            "    1C" | "    1U" | "    1P" => {}
            "    2C" => {
                let count: usize = field(line, 24, 36);
                assert_eq!(field::<u8>(line, 73, 74), 1, "long numbers");
                for line in lines.by_ref().take(count) {
                    assert!(line.starts_with(" -1"), "{line}");
                    let x = reals(line, 3);
                    assert!(frd.nodes.insert(field(line, 3, 13), [x[0], x[1], x[2]]).is_none(), "twice: {line}");
                }
                assert_eq!(lines.next(), Some(" -3"));
            }
            "    3C" => {
                for _ in 0..field::<usize>(line, 24, 36) {
                    let head = lines.next().unwrap();
                    assert!(head.starts_with(" -1") && head.len() == 28, "{head}");
                    let (number, kind): (u64, usize) = (field(head, 3, 13), field(head, 13, 18));
                    let mut nodes = Vec::new();
                    while nodes.len() < NODES[kind] {
                        let line = lines.next().unwrap();
                        assert!(line.starts_with(" -2"), "{line}");
                        let count = 10.min(NODES[kind] - nodes.len());
                        assert_eq!(line.len(), 3 + 10 * count, "{line}");
                        nodes.extend((0..count).map(|i| field::<u64>(line, 3 + 10 * i, 13 + 10 * i)));
                    }
                    assert!(nodes.iter().all(|node| frd.nodes.contains_key(node)));
                    assert!(frd.cells.insert(number, (kind, nodes)).is_none());
                }
                assert_eq!(lines.next(), Some(" -3"));
            }
            "  100C" => {
                let (time, count): (f64, usize) = (field(line, 12, 24), field(line, 24, 36));
                assert_eq!((field::<u8>(line, 56, 58), line.len()), (0, 75), "{line}");
                let head = lines.next().unwrap();
                assert!(head.starts_with(" -4  "));
                let (name, number): (String, usize) = (field(head, 5, 13), field(head, 13, 18));
                let mut block = Block { time, name, components: vec![], values: BTreeMap::new() };
                for _ in 0..number {
                    let line = lines.next().unwrap();
                    assert!(line.starts_with(" -5  "), "{line}");
                    // What exists in the viewer alone has no values.
                    if field::<u8>(line, 33, 38) == 0 {
                        block.components.push(field(line, 5, 13));
                    }
                }
                for line in lines.by_ref().take(count) {
                    assert!(line.starts_with(" -1"), "{line}");
                    block.values.insert(field(line, 3, 13), reals(line, block.components.len()));
                }
                assert_eq!((lines.next(), block.values.len()), (Some(" -3"), count));
                frd.blocks.push(block);
            }
            " 9999" => assert_eq!(lines.next(), None),
            _ => panic!("'{line}'"),
        }
    }
    assert!(text.ends_with(" 9999\n"));
    frd
}

/// A block on a plate, of cells of any kind.
fn deck(space: &str, mesh: &str, plate: &str) -> String {
    format!(
        r#"
version = 1
space = "{space}"
[mesh.part.block]
{mesh}
[material.steel.von_mises]
young = 1000.0
poisson = 0.3
yield_stress = 5.0
hardening = 50.0
[body.block]
material = "steel"
{}
[tool.plate]
{plate}
[contact.base]
surface = "block.bottom"
target = "plate"
law.coulomb = {{ friction = 0.2 }}
[[step]]
increments.count = 2
displacement."block.top" = {{ x = 0.1, y = -0.04{} }}
[output]
export = ["frd", "xdmf", "deformed"]
[[output.print]]
of.nodes = "block.top"
quantities = ["displacement", "reaction"]
totals = "yes"
[[output.print]]
of.cells = "block"
quantities = ["cauchy_stress", "equivalent_plastic_strain"]
[[output.print]]
of.contact = "base"
quantities = ["contact_pressure"]
"#,
        if ["tri3", "tet4", "wedge6"].iter().any(|cell| mesh.contains(cell)) { "degree = 1" } else { "" },
        if space == "solid" { ", z = 0.0" } else { "" }
    )
}

const PLATE: &str = "profile = [{ line = [[9.0, 0.0], [-9.0, 0.0]] }]";

fn run(deck: &str, directory: &Path) -> Mesh {
    let made = made(deck, &[]);
    write_results(&made, directory);
    (*made.model.mesh).clone()
}

#[test]
fn an_frd_file_holds_what_the_frames_hold() {
    for cell in ["tri3", "tri6", "quad4", "quad8", "quad9"] {
        let mesh = format!("rectangle = {{ from = [0.0, 0.0], to = [2.0, 1.0], cells = [2, 2], cell = \"{cell}\" }}");
        let folder = tempfile::tempdir().unwrap();
        let mesh = run(&deck("plane-strain", &mesh, PLATE), folder.path());
        let frd = read_frd(&std::fs::read_to_string(folder.path().join("results.frd")).unwrap());
        compare(&frd, &mesh, folder.path());
        for (kind, nodes) in frd.cells.values() {
            let corners = [3, 3, 4, 4][kind - 7];
            let x = |i: usize| frd.nodes[&nodes[i % corners]];
            let area: f64 = (0..corners).map(|i| 0.5 * (x(i)[0] * x(i + 1)[1] - x(i + 1)[0] * x(i)[1])).sum();
            assert!(area > 0.0);
            for (middle, number) in nodes.iter().enumerate().skip(corners) {
                let (a, b, m) = (x(middle), x(middle + 1), frd.nodes[number]);
                assert!((0..2).all(|i| (0.5 * (a[i] + b[i]) - m[i]).abs() < 1e-5), "{cell}: middle {middle}");
            }
        }
        dat(folder.path(), &mesh);
    }
}

#[test]
fn cells_of_space_have_their_nodes_in_the_order_of_the_format() {
    // Middles of edges in the order of the format.
    let hexa = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 5], [2, 6], [3, 7], [4, 5], [5, 6], [6, 7], [7, 4]];
    let wedge = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 4], [2, 5], [3, 4], [4, 5], [5, 3]];
    let tetra = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    let plate = "plane = { at = [1.0, 0.0, 0.5], normal = [0.0, 1.0, 0.0], side = 9.0 }";
    for cell in ["tet4", "tet10", "wedge6", "wedge15", "hex8", "hex20", "hex27"] {
        let mesh =
            format!("box = {{ from = [0.0, 0.0, 0.0], to = [2.0, 1.0, 1.0], cells = [2, 1, 1], cell = \"{cell}\" }}");
        let text = deck("solid", &mesh, plate);
        let folder = tempfile::tempdir().unwrap();
        let mesh = run(&text, folder.path());
        let frd = read_frd(&std::fs::read_to_string(folder.path().join("results.frd")).unwrap());
        compare(&frd, &mesh, folder.path());
        for (kind, nodes) in frd.cells.values() {
            let (corners, edges): (usize, &[[usize; 2]]) = match kind {
                1 | 4 => (8, &hexa),
                2 | 5 => (6, &wedge),
                _ => (4, &tetra),
            };
            let x = |i: usize| frd.nodes[&nodes[i]];
            for (middle, [a, b]) in (corners..nodes.len()).zip(edges) {
                assert!((0..3).all(|i| (0.5 * (x(*a)[i] + x(*b)[i]) - x(middle)[i]).abs() < 1e-5), "{cell}: {middle}");
            }
        }
    }
}

/// Nodes, cells and values of the file are those of the mesh and of the last frame.
fn compare(frd: &Frd, mesh: &Mesh, folder: &Path) {
    assert_eq!((frd.nodes.len(), frd.cells.len()), (mesh.points.len(), mesh.cell_count()));
    for (node, point) in mesh.points.iter().enumerate() {
        assert!((0..3).all(|i| (frd.nodes[&mesh.node_number(node)][i] - point[i]).abs() < 1e-5));
    }
    let frames = read_series(&folder.join("bodies.pvd")).unwrap();
    let last = read_grid(&folder.join(&frames.last().unwrap().1)).unwrap();
    let names = ["DISP", "STRESS", "TOSTRAIN", "PE", "FORC", "CONTACT"];
    let found: Vec<&str> = frd.blocks.iter().map(|block| block.name.as_str()).collect();
    // All frames but the first, before any increment.
    assert_eq!(found, names.repeat(frames.len() - 1));
    for (block, name) in frd.blocks[names.len() * (frames.len() - 2)..].iter().zip([
        "displacement",
        "cauchy_stress_averaged",
        "logarithmic_strain_averaged",
        "equivalent_plastic_strain_averaged",
        "reaction",
    ]) {
        assert!((block.time - last.time).abs() < 1e-5, "{name}");
        let mut values = last.point_array(name).unwrap().values.to_real();
        if name == "reaction" {
            let load = last.point_array("load").unwrap().values.to_real();
            values.iter_mut().zip(load).for_each(|(value, load)| *value += load);
        }
        let width = values.len() / mesh.points.len();
        assert_eq!(block.components.len(), width);
        for node in 0..mesh.points.len() {
            let found = &block.values[&mesh.node_number(node)];
            let wanted = &values[node * width..][..width];
            let same = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-5 * b.abs() + 1e-90;
            assert!(found.iter().zip(wanted).all(same), "{name} at {node}: {found:?} {wanted:?}");
        }
    }
    let contact = &frd.blocks[names.len() * (frames.len() - 1) - 1];
    assert_eq!(contact.components, ["COPEN", "CSLIP1", "CSLIP2", "CPRESS", "CSHEAR1", "CSHEAR2"]);
    assert!(
        contact.values.len() >= mesh.groups["block.bottom"].nodes.len() - 1
            && contact.values.values().any(|v| v[3] > 0.0)
    );
    let moved = read_series(&folder.join("deformed.pvd")).unwrap();
    let moved = read_grid(&folder.join(&moved.last().unwrap().1)).unwrap();
    let u = last.point_array("displacement").unwrap().values.to_real();
    for (node, point) in moved.points.iter().enumerate() {
        assert!((0..3).all(|i| point[i] == last.points[node][i] + u[3 * node + i]));
    }
}

/// The tables: their heads, rows of nodes and the total force, which is the sum of the forces.
fn dat(folder: &Path, mesh: &Mesh) {
    let text = std::fs::read_to_string(folder.join("results.dat")).unwrap();
    let rows = |head: &str| -> Vec<Vec<f64>> {
        let at = text.rfind(head).unwrap_or_else(|| panic!("no '{head}' in {text}"));
        let rows = text[at..].lines().skip(2).take_while(|line| !line.is_empty());
        rows.map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect()).collect()
    };
    let top = &mesh.groups["block.top"].nodes;
    let displacements = rows(" displacements (vx,vy,vz) for set block.top and time  0.1000000E+01");
    assert_eq!(displacements.len(), top.len());
    for (row, node) in displacements.iter().zip(top) {
        assert_eq!(row[..], [mesh.node_number(*node) as f64, 0.1, -0.04, 0.0]);
    }
    let (forces, total) = (rows(" forces (fx,fy,fz) for"), rows(" total force (fx,fy,fz) for"));
    let sum: f64 = forces.iter().map(|row| row[2]).sum();
    assert!((sum - total[0][1]).abs() < 1e-5 * sum.abs() && sum < 0.0, "{sum} {total:?}");
    let stresses = rows(" stresses (elem, integ.pnt.,sxx,syy,szz,sxy,sxz,syz) for set block");
    assert!(stresses.len().is_multiple_of(mesh.cell_count()) && stresses.iter().all(|row| row.len() == 8));
    assert!(rows(" contact pressure (point,value) for contact base").iter().any(|row| row[1] > 0.0));
}
