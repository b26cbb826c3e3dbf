//! Mesh files that Gmsh itself wrote, read in every version and form; the geometries stand beside them.

use asperity::mesh::formats::{self, Note};
use asperity::mesh::{CellView, Mesh, Side, lint};
use asperity::tensor::Vec3;
use std::path::PathBuf;

fn path(file: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/meshes").join(file)
}

fn read(file: &str) -> (Mesh, Vec<Note>) {
    formats::read(path(file)).unwrap()
}

/// The four forms in which Gmsh wrote each mesh.
const FORMS: [&str; 4] = ["22a.msh", "22b.msh", "41a.msh", "41b.msh"];

/// All nodes of straight cells lie where the corners put them: a wrong order of nodes cannot pass.
fn assert_nodes_in_order(mesh: &Mesh, file: &str) {
    for cell in 0..mesh.cell_count() {
        let view = mesh.cell(cell);
        for (&node, &xi) in view.nodes.iter().zip(view.kind.nodes) {
            let linear = view.kind.linear;
            let straight = CellView { kind: linear, nodes: &view.nodes[..linear.nodes.len()] };
            let distance = (straight.map(&mesh.points, xi).0 - mesh.points[node]).norm();
            assert!(distance < 1e-9, "{file}: cell {cell} ({:?}), {xi:?}: off by {distance}", view.kind);
        }
    }
}

fn volume(mesh: &Mesh, group: &str) -> f64 {
    mesh.groups[group].cells.iter().map(|&cell| mesh.measure(cell)).sum()
}

/// The kinds of a group's cells.
fn kinds(mesh: &Mesh, group: &str) -> Vec<&'static str> {
    let mut kinds: Vec<_> = mesh.groups[group].cells.iter().map(|&cell| mesh.kinds[cell].name).collect();
    kinds.dedup();
    kinds
}

fn area_of_sides(mesh: &Mesh, sides: &[Side]) -> f64 {
    let area = |&side: &Side| {
        let (kind, nodes) = mesh.side(side);
        let nodes: Vec<usize> = nodes.collect();
        let view = CellView { kind, nodes: &nodes };
        let ratio = |xi| {
            let [u, v, _] = view.map(&mesh.points, xi).1;
            if kind.dimension == 1 { u.norm() } else { u.cross(v).norm() }
        };
        kind.full.points.iter().zip(kind.full.weights).map(|(&xi, weight)| weight * ratio(xi)).sum::<f64>()
    };
    sides.iter().map(area).sum()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

#[test]
fn plane_meshes_of_gmsh_are_read_in_every_form() {
    let meshes = [("plane1", "tri3", "quad4"), ("plane2", "tri6", "quad8"), ("plane2full", "tri6", "quad9")];
    for (name, triangle, quad) in meshes {
        for form in FORMS {
            let file = format!("{name}-{form}");
            let (mesh, notes) = read(&file);
            assert_eq!((kinds(&mesh, "triangles"), kinds(&mesh, "quads")), (vec![triangle], vec![quad]), "{file}");
            assert_eq!(mesh.groups["all cells"].cells.len(), mesh.cell_count(), "{file}");
            assert!(close(volume(&mesh, "triangles"), 0.93) && close(volume(&mesh, "quads"), 1.1), "{file}");
            assert_nodes_in_order(&mesh, &file);

            let bottom = mesh.surface("bottom").unwrap();
            let length = f64::sqrt(1.01) + f64::sqrt(1.45);
            assert!(bottom.len() == 5 && close(area_of_sides(&mesh, bottom), length), "{file}");
            let (weld, left) = (&mesh.groups["weld"], &mesh.groups["curve_17"]);
            assert_eq!((weld.sides.len(), weld.inner.len(), left.sides.len()), (0, 2, 2), "{file}");
            assert!(mesh.surface("weld").unwrap_err().to_string().contains("'weld' is no surface"));
            let corner = &mesh.groups["corner"].nodes;
            assert_eq!((corner.len(), mesh.points[corner[0]]), (1, Vec3([2.0, 1.3, 0.0])), "{file}");
            assert_eq!(notes.len(), 1, "{notes:?}");
            assert!(notes[0].text.contains("'curve_17'"), "{notes:?}");
            assert!(lint::check(&mesh).iter().all(|finding| finding.kind == lint::LintKind::InnerFaces), "{file}");
        }
    }
}

#[test]
fn solid_meshes_of_gmsh_are_read_in_every_form() {
    for (name, cells) in [("solid1", ["tet4", "hex8", "wedge6"]), ("solid2", ["tet10", "hex20", "wedge15"])] {
        for form in FORMS {
            let file = format!("{name}-{form}");
            let (mesh, _) = read(&file);
            for (group, cell) in ["tets", "hexes", "wedges"].into_iter().zip(cells) {
                assert_eq!(kinds(&mesh, group), [cell], "{file}");
                let exact = if group == "hexes" { 0.9175 } else { 0.93 };
                assert!(close(volume(&mesh, group), exact), "{file}: {}", volume(&mesh, group));
            }
            assert_nodes_in_order(&mesh, &file);
            let flanks = area_of_sides(&mesh, mesh.surface("flanks").unwrap());
            assert!(close(flanks, 3.0 * f64::sqrt(1.0164)), "{file}: {flanks}");
            assert!(mesh.surface("tops").unwrap().len() >= 5, "{file}");
            let edge = &mesh.groups["edge"];
            assert!(edge.sides.is_empty() && edge.nodes.len() >= 6, "{file}");
            assert!(edge.nodes.iter().all(|&node| mesh.points[node][2] == 0.0));
            let unused = |finding: &lint::LintFinding| finding.kind == lint::LintKind::Unused;
            assert!(lint::check(&mesh).iter().all(unused), "{file}: {:?}", lint::check(&mesh));
        }
    }
}

#[test]
fn bricks_of_27_nodes_are_read_in_every_form() {
    for form in FORMS {
        let file = format!("brick27-{form}");
        let (mesh, notes) = read(&file);
        assert_eq!((kinds(&mesh, "brick"), mesh.cell_count(), mesh.points.len()), (vec!["hex27"], 2, 45), "{file}");
        assert_nodes_in_order(&mesh, &file);
        let top = mesh.surface("top").unwrap();
        assert_eq!((top.len(), mesh.side(top[0]).0.name), (1, "quad9"), "{file}");
        assert_eq!((notes, lint::check(&mesh)), (vec![], vec![]), "{file}");
    }
}

#[test]
fn all_forms_of_a_file_give_the_same_mesh() {
    for name in ["plane1", "plane2", "plane2full", "solid1", "solid2", "brick27"] {
        let meshes = FORMS.map(|form| read(&format!("{name}-{form}")).0);
        for (one, other) in meshes.iter().zip(&meshes[1..]) {
            let cells = |mesh: &Mesh| (0..mesh.cell_count()).map(|cell| mesh.measure(cell)).collect::<Vec<_>>();
            assert_eq!(one.kinds, other.kinds, "{name}");
            assert!(cells(one).iter().zip(cells(other)).all(|(a, b)| close(*a, b)), "{name}");
            assert!(one.groups.keys().eq(other.groups.keys()), "{name}");
            for (group, name) in one.groups.values().zip(other.groups.keys()) {
                let other = &other.groups[name];
                assert_eq!((&group.cells, &group.sides, &group.inner), (&other.cells, &other.sides, &other.inner));
            }
        }
    }
}

/// A binary file of the other byte order, made from one of this by turning every number around.
#[test]
fn binary_files_of_either_byte_order_are_read() {
    let straight = std::fs::read(path("plane1-22b.msh")).unwrap();
    let turned = turn_bytes_v2(&straight);
    let read = |bytes: &[u8]| (formats::ALL[0].read)(&path("turned.msh"), bytes).unwrap().0;
    let (one, other) = (read(&straight), read(&turned));
    assert_ne!(straight, turned);
    assert_eq!((one.points, one.nodes, one.groups), (other.points, other.nodes, other.groups));
}

/// Reverses each number of a binary file of version 2.2, section by section.
fn turn_bytes_v2(bytes: &[u8]) -> Vec<u8> {
    let mut turned = bytes.to_vec();
    let find = |word: &str| bytes.windows(word.len()).position(|window| window == word.as_bytes()).unwrap();
    let after_lines = |word: &str, lines: usize| {
        let start = find(word);
        let ends = bytes[start..].iter().enumerate().filter(|(_, byte)| **byte == b'\n');
        start + ends.map(|(place, _)| place + 1).nth(lines - 1).unwrap()
    };
    let mut reverse = |start: usize, end: usize| turned[start..end].reverse();
    let one = after_lines("$MeshFormat", 2);
    reverse(one, one + 4);
    let (mut at, end) = (after_lines("$Nodes", 2), find("$EndNodes") - 1);
    while at < end {
        reverse(at, at + 4);
        (0..3).for_each(|a| reverse(at + 4 + 8 * a, at + 12 + 8 * a));
        at += 28;
    }
    (at..=at).for_each(|at| assert_eq!(at, end));
    let (start, end) = (after_lines("$Elements", 2), find("$EndElements") - 1);
    (start..end).step_by(4).for_each(|at| reverse(at, at + 4));
    turned
}

#[test]
fn input_files_of_gmsh_hold_the_same_mesh() {
    for (name, groups) in [
        ("plane1", ["bottom", "weld", "triangles", "quads"]),
        ("plane2", ["bottom", "weld", "triangles", "quads"]),
        ("solid1", ["tops", "flanks", "tets", "wedges"]),
        ("solid2", ["tops", "edge", "hexes", "wedges"]),
    ] {
        let (inp, notes) = read(&format!("{name}.inp"));
        let (msh, _) = read(&format!("{name}-41a.msh"));
        assert_eq!(inp.kinds, msh.kinds, "{name}");
        assert_nodes_in_order(&inp, name);
        for group in groups {
            let (one, other) = (&inp.groups[group], &msh.groups[group]);
            assert_eq!((&one.cells, &one.sides, &one.inner), (&other.cells, &other.sides, &other.inner), "{group}");
            let places = |mesh: &Mesh, nodes: &[usize]| nodes.iter().map(|&node| mesh.points[node]).collect::<Vec<_>>();
            let pairs = places(&inp, &one.nodes).into_iter().zip(places(&msh, &other.nodes));
            assert!(one.nodes.len() == other.nodes.len() && pairs.into_iter().all(|(a, b)| (a - b).norm() < 1e-9));
        }
        assert!(notes.iter().any(|note| note.text.contains("they only mark its sides")), "{notes:?}");
    }
}

#[test]
fn an_input_file_written_by_hand_is_read_whole() {
    let (mesh, notes) = read("written.inp");
    assert_eq!((mesh.points.len(), mesh.cell_count(), mesh.kinds[0].name), (32, 2, "hex20"));
    assert_eq!((mesh.numbers.nodes[31], mesh.numbers.cells.as_slice()), (32, &[1, 2][..]));
    assert_nodes_in_order(&mesh, "written.inp");
    assert_eq!(lint::check(&mesh).iter().map(|finding| finding.kind).collect::<Vec<_>>(), [lint::LintKind::InnerFaces]);
    let nodes = |group: &str| mesh.groups[group].nodes.iter().map(|&node| mesh.node_number(node)).collect::<Vec<_>>();
    assert_eq!(nodes("FEW"), [9, 10, 11, 12, 25, 27, 29]);
    assert_eq!(nodes("Ground"), [1, 2, 3, 4, 9, 13, 14, 15, 16]);
    assert_eq!(nodes("both"), [1, 2, 3, 4, 9, 10, 11, 12, 13, 14, 15, 16, 25, 27, 29]);
    assert_eq!((nodes("Nall").len(), &mesh.groups["again"].cells[..]), (32, &[0, 1][..]));
    assert_eq!(mesh.groups["EALL"].cells, [0, 1]);

    let area = |group: &str| area_of_sides(&mesh, mesh.surface(group).unwrap());
    assert!(close(area("Top"), 2.0) && close(area("flank"), 6.0) && close(area("skin"), 22.0));
    assert!(mesh.groups["Top"].nodes.iter().all(|&node| mesh.points[node][2] == 3.0));
    assert!(mesh.groups["flank"].nodes.iter().all(|&node| mesh.points[node][1] == 0.0));
    assert!(mesh.surface("between").unwrap_err().to_string().contains("between cells 1 and 2"));

    let texts: Vec<String> = notes.iter().map(|note| note.text.clone()).collect();
    let expected = [
        "keywords that are no part of the mesh are not used (with lines): *MATERIAL (37), *ELASTIC (38), *STEP (40), \
         *STATIC (41), *CLOAD (42), *END STEP (44)",
        "only the shape of C3D20R is read; the deck chooses the integration",
        "set 'EALL': 2 numbers of its ranges do not exist",
    ];
    assert_eq!(texts, expected);
    assert_eq!(notes[0].line, Some(37));
}

/// Every cell written with its own coordinates as nodes: the faces of an input file are those of the manual.
#[test]
fn faces_of_input_files_are_numbered_as_in_the_manual() {
    let corners = "1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n4, 0., 1., 0.\n5, 0., 0., 1.\n6, 1., 0., 1.\n7, 1., 1., 1.\n8, 0., 1., 1.\n";
    let faces = [("S1", [1, 2, 3, 4]), ("S2", [5, 6, 7, 8]), ("S3", [1, 2, 5, 6]), ("S4", [2, 3, 6, 7])];
    for (label, wanted) in faces.into_iter().chain([("S5", [3, 4, 7, 8]), ("S6", [1, 4, 5, 8])]) {
        let text = format!(
            "*NODE\n{corners}*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*SURFACE, NAME=face\n1, {label}\n"
        );
        let (mesh, _) = (formats::ALL[1].read)(&path("face.inp"), text.as_bytes()).unwrap();
        let found: Vec<u64> = mesh.groups["face"].nodes.iter().map(|&node| mesh.node_number(node)).collect();
        assert_eq!(found, wanted, "{label}");
    }
}
