use super::*;
use crate::mesh::cells::{ALL, Cell};
use crate::mesh::generate::{Block, Rectangle};
use crate::mesh::{Group, Side};
use crate::tensor::Vec3;

fn plane(name: &str, from: [f64; 2], to: [f64; 2], cells: [usize; 2]) -> Mesh {
    Rectangle::new(from, to, cells, Cell::named("quad4").unwrap()).mesh(name).unwrap()
}

fn square() -> Mesh {
    plane("p", [0.0; 2], [1.0; 2], [2, 2])
}

/// The only finding, which must be of this kind and severity and contain these words.
fn expect(mesh: &Mesh, kind: LintKind, severity: LintSeverity, words: &str) -> LintFinding {
    let findings = check(mesh);
    assert_eq!(findings.len(), 1, "{findings:#?}");
    assert_eq!((findings[0].kind, findings[0].severity), (kind, severity), "{findings:#?}");
    assert!(findings[0].text.contains(words), "{}", findings[0].text);
    findings[0].clone()
}

#[test]
fn every_generated_mesh_is_sound() {
    for &cell in ALL {
        let mesh = match cell.dimension {
            2 => Rectangle::new([0.0; 2], [1e-3, 1e3], [3, 2], cell).mesh("p").unwrap(),
            3 => Block::new([0.0; 3], [1.0; 3], [2, 2, 2], cell).mesh("p").unwrap(),
            _ => continue,
        };
        assert_eq!(check(&mesh), [], "{cell:?}");
    }
}

#[test]
fn an_empty_mesh_is_named() {
    expect(&Mesh::new(), LintKind::NoCells, LintSeverity::Error, "no cells");
}

#[test]
fn a_coordinate_that_is_no_number_is_named_once() {
    let mut mesh = square();
    mesh.numbers.nodes = (0..9).map(|node| 10 * node + 7).collect();
    mesh.points[4][1] = f64::NAN;
    assert_eq!(expect(&mesh, LintKind::NotFinite, LintSeverity::Error, "node 47 with a coordinate").nodes, [4]);
}

#[test]
fn a_plane_mesh_off_the_plane_is_named() {
    let mut mesh = square();
    mesh.points[8][2] = 0.1;
    assert_eq!(expect(&mesh, LintKind::NotPlane, LintSeverity::Error, "z = 0").nodes, [8]);
}

#[test]
fn folded_and_flat_cells_are_told_apart() {
    let mut mesh = square();
    mesh.points[8] = Vec3([0.4, 0.4, 0.0]);
    assert_eq!(expect(&mesh, LintKind::Inverted, LintSeverity::Error, "cell 4 folded").cells, [3]);
    let mut mesh = plane("p", [0.0; 2], [1.0; 2], [1, 1]);
    mesh.points.iter_mut().for_each(|point| point[1] = 0.5 * point[0] + 1e-15 * point[1]);
    mesh.points[2] = Vec3([0.2, 0.1, 0.0]);
    mesh.points[3] = Vec3([0.8, 0.4, 0.0]);
    expect(&mesh, LintKind::Flat, LintSeverity::Error, "without area");
}

#[test]
fn cells_of_every_kind_are_turned_around_with_their_sides() {
    for &cell in ALL {
        let straight = match cell.dimension {
            2 => Rectangle::new([0.0; 2], [1.0; 2], [2, 2], cell).mesh("p").unwrap(),
            3 => Block::new([0.0; 3], [1.0; 3], [2, 1, 1], cell).mesh("p").unwrap(),
            _ => continue,
        };
        let mut mesh = straight.clone();
        mesh.points.iter_mut().for_each(|point| point[0] = -point[0]);
        let all: Vec<usize> = (0..mesh.cell_count()).collect();
        assert_eq!(expect(&mesh, LintKind::Reversed, LintSeverity::Error, "wrong way round").cells, all, "{cell:?}");
        let note = mesh.orient().unwrap();
        assert_eq!((note.severity, note.cells), (LintSeverity::Note, all));
        assert_eq!((check(&mesh), mesh.orient()), (vec![], None));
        for (name, group) in &straight.groups {
            assert_eq!(mesh.groups[name].nodes, group.nodes, "{cell:?}, {name}");
            let nodes = |mesh: &Mesh, sides: &[Side]| Group::new(mesh, vec![], sides.to_vec(), vec![]).nodes;
            assert_eq!(nodes(&mesh, &mesh.groups[name].sides), nodes(&straight, &group.sides), "{cell:?}, {name}");
        }
    }
}

#[test]
fn unused_nodes_and_empty_groups_are_named() {
    let mut mesh = square();
    mesh.points.push(Vec3([5.0, 5.0, 0.0]));
    assert_eq!(expect(&mesh, LintKind::Unused, LintSeverity::Note, "node 10 used by no cell").nodes, [9]);
    let mut mesh = square();
    mesh.groups.insert("nothing".into(), Group::default());
    expect(&mesh, LintKind::EmptyGroup, LintSeverity::Warning, "group 'nothing'");
    let inner = vec![[Side { cell: 0, face: 1 }, Side { cell: 1, face: 3 }]];
    mesh.groups.insert("nothing".into(), Group { nodes: vec![1, 4], inner, ..Group::default() });
    expect(&mesh, LintKind::InnerFaces, LintSeverity::Note, "group 'nothing'");
}

/// Two squares side by side, the second moved by a part of an edge, as parts of one group or of two.
fn neighbours(offset: f64, one_body: bool) -> Mesh {
    let mut mesh = square();
    mesh.append(plane("q", [1.0 + offset, 0.0], [2.0 + offset, 1.0], [2, 2])).unwrap();
    if one_body {
        mesh.groups = [("all".to_string(), Group::new(&mesh, (0..8).collect(), vec![], vec![]))].into();
    }
    mesh
}

#[test]
fn a_crack_is_told_from_bodies_that_touch() {
    let crack = expect(&neighbours(1e-12, true), LintKind::Crack, LintSeverity::Warning, "2 pairs of faces");
    assert_eq!((crack.cells, crack.nodes), (vec![1, 3, 4, 6], vec![2, 5, 8, 9, 12, 15]));
    expect(&neighbours(-1e-12, false), LintKind::Touching, LintSeverity::Note, "separate bodies touch");
    assert_eq!(check(&neighbours(1e-7, true)), []);
    let mut mesh = neighbours(0.0, false);
    mesh.groups.insert("all".into(), Group::new(&mesh, (0..8).collect(), vec![], vec![]));
    expect(&mesh, LintKind::Touching, LintSeverity::Note, "only contact");
}

#[test]
fn a_crack_that_ends_inside_a_body_is_found() {
    let mut mesh = square();
    mesh.points.push(mesh.points[1]);
    let slit = mesh.cell(1).nodes.iter().position(|&node| node == 1).unwrap();
    let entry = mesh.starts[1] + slit;
    mesh.nodes[entry] = 9;
    mesh.groups.clear();
    assert_eq!(expect(&mesh, LintKind::Crack, LintSeverity::Warning, "1 pair of faces").nodes, [1, 4, 9]);
}

#[test]
fn nodes_that_coincide_without_a_face_are_duplicates() {
    let mut mesh = square();
    mesh.append(plane("q", [1.0, 1.0], [2.0, 2.0], [2, 2])).unwrap();
    assert_eq!(expect(&mesh, LintKind::Duplicate, LintSeverity::Note, "9 = 10").nodes, [8, 9]);
    mesh.groups.clear();
    let all = Group::new(&mesh, (0..8).collect(), vec![], vec![]);
    mesh.groups.insert("all".into(), all);
    expect(&mesh, LintKind::Duplicate, LintSeverity::Warning, "in one body");
}

#[test]
fn neighbours_that_do_not_fit_are_named() {
    let mut mesh = Rectangle::new([0.0; 2], [1.0; 2], [2, 1], Cell::named("quad8").unwrap()).mesh("p").unwrap();
    mesh.groups.clear();
    let first: Vec<usize> = mesh.cell(0).nodes.to_vec();
    let second: Vec<usize> = mesh.cell(1).nodes[..4].to_vec();
    let mut mixed = Mesh { points: mesh.points.clone(), ..Mesh::new() };
    mixed.push_cell(Cell::named("quad8").unwrap(), &first);
    mixed.push_cell(Cell::named("quad4").unwrap(), &second);
    assert!(check(&mixed).iter().any(|finding| finding.kind == LintKind::Mismatched && finding.cells == [0, 1]));

    let mut mesh = square();
    let nodes = mesh.cell(2).nodes.to_vec();
    mesh.push_cell(Cell::named("quad4").unwrap(), &nodes);
    let twice = check(&mesh).into_iter().find(|finding| finding.kind == LintKind::RepeatedCell).unwrap();
    assert_eq!((twice.cells, twice.severity), (vec![2, 4], LintSeverity::Error));

    let mut mesh = square();
    let [a, b] = [mesh.cell(0).nodes[2], mesh.cell(0).nodes[3]];
    mesh.points.push(Vec3([0.1, 0.9, 0.0]));
    mesh.push_cell(Cell::named("tri3").unwrap(), &[b, a, 9]);
    assert_eq!(expect(&mesh, LintKind::Overlap, LintSeverity::Error, "overlaps itself").cells, [0, 2, 4]);
}

#[test]
fn a_node_twice_in_a_cell_is_named() {
    let mut mesh = plane("p", [0.0; 2], [1.0; 2], [1, 1]);
    mesh.nodes[3] = mesh.nodes[2];
    mesh.points.truncate(4);
    let findings = check(&mesh);
    assert!(findings.iter().any(|finding| finding.kind == LintKind::RepeatedNode && finding.cells == [0]));
}

#[test]
fn findings_do_not_depend_on_the_unit_of_length() {
    for scale in [1e-6, 1.0, 1e6] {
        let mut mesh = neighbours(1e-12, true);
        mesh.points.iter_mut().for_each(|point| *point = *point * scale);
        expect(&mesh, LintKind::Crack, LintSeverity::Warning, "2 pairs");
    }
}

/// A quadrilateral beside two of half its height: the node between them hangs.
#[test]
fn nodes_that_hang_are_found() {
    let quad = crate::mesh::Cell::named("quad4").unwrap();
    let mut mesh = Mesh::new();
    mesh.points = [[0, 0], [2, 0], [0, 2], [2, 2], [4, 0], [4, 1], [2, 1], [4, 2]]
        .map(|[x, y]| Vec3::new(x.into(), y.into(), 0.0))
        .to_vec();
    for nodes in [[0, 1, 3, 2], [1, 4, 5, 6], [6, 5, 7, 3]] {
        mesh.push_cell(quad, &nodes);
    }
    let hanging: Vec<_> = check(&mesh).into_iter().filter(|found| found.kind == LintKind::Hanging).collect();
    assert_eq!(hanging.len(), 1);
    assert_eq!((&hanging[0].nodes[..], &hanging[0].cells[..]), (&[6][..], &[0][..]));
    let whole = crate::mesh::generate::Block::new(
        [0.0; 3],
        [1.0, 2.0, 3.0],
        [3, 4, 5],
        crate::mesh::Cell::named("tet4").unwrap(),
    );
    assert!(check(&whole.mesh("b").unwrap()).iter().all(|found| found.kind != LintKind::Hanging));
}
