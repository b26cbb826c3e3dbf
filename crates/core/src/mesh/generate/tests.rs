use super::*;
use crate::mesh::cells::ALL;
use crate::mesh::{Cell, Mesh};
use crate::tensor::Vec3;
use std::f64::consts::PI;

fn cells(dimension: usize) -> impl Iterator<Item = &'static Cell> {
    ALL.iter().copied().filter(move |cell| cell.dimension == dimension)
}

fn measure(mesh: &Mesh) -> f64 {
    (0..mesh.cell_count()).map(|cell| mesh.measure(cell)).sum()
}

/// Every side belongs to exactly one cell or is shared by two that see the same nodes; so parts have no gaps.
fn outer_sides(mesh: &Mesh) -> usize {
    let mut seen = std::collections::BTreeMap::<Vec<usize>, usize>::new();
    for cell in 0..mesh.cell_count() {
        for face in 0..mesh.kinds[cell].faces.len() {
            let mut nodes: Vec<usize> = mesh.side(crate::mesh::Side { cell, face }).1.collect();
            nodes.sort_unstable();
            *seen.entry(nodes).or_default() += 1;
        }
    }
    assert!(seen.values().all(|&uses| uses <= 2));
    seen.values().filter(|&&uses| uses == 1).count()
}

fn group_sides(mesh: &Mesh) -> usize {
    mesh.groups.values().map(|group| group.sides.len()).sum()
}

#[test]
fn every_cell_fills_its_rectangle_without_gaps() {
    for cell in cells(2) {
        let rectangle = Rectangle {
            x: Spacing::graded(1.0, 3.0, 4, 5.0),
            y: Spacing::from(0.0).run(1.0, 2, Grade::UNIFORM).run(4.0, 3, Grade::Smooth),
            cell,
        };
        let mesh = rectangle.mesh("r").unwrap();
        assert!((measure(&mesh) - 8.0).abs() < 1e-13, "{cell:?}");
        assert!((0..mesh.cell_count()).all(|cell| mesh.measure(cell) > 0.0), "{cell:?}");
        assert_eq!(outer_sides(&mesh), group_sides(&mesh), "{cell:?}");
        for (name, axis, value) in [("left", 0, 1.0), ("right", 0, 3.0), ("bottom", 1, 0.0), ("top", 1, 4.0)] {
            let group = &mesh.groups[&format!("r.{name}")];
            assert!(!group.sides.is_empty() && group.nodes.iter().all(|&node| mesh.points[node][axis] == value));
        }
        let corner = &mesh.groups["r.top_left"];
        assert_eq!((corner.nodes.len(), mesh.points[corner.nodes[0]]), (1, Vec3([1.0, 4.0, 0.0])));
    }
}

#[test]
fn every_cell_fills_its_box_without_gaps() {
    for cell in cells(3) {
        let mesh = Block::new([0.0, 1.0, 2.0], [2.0, 4.0, 3.0], [2, 3, 2], cell).mesh("b").unwrap();
        assert!((measure(&mesh) - 6.0).abs() < 1e-13, "{cell:?}");
        assert!((0..mesh.cell_count()).all(|cell| mesh.measure(cell) > 0.0), "{cell:?}");
        assert_eq!(outer_sides(&mesh), group_sides(&mesh), "{cell:?}");
        for (name, axis, value) in [("left", 0, 0.0), ("top", 1, 4.0), ("back", 2, 2.0), ("front", 2, 3.0)] {
            let group = &mesh.groups[&format!("b.{name}")];
            assert!(!group.sides.is_empty() && group.nodes.iter().all(|&node| mesh.points[node][axis] == value));
        }
        assert_eq!(mesh.points[mesh.groups["b.front_top_right"].nodes[0]], Vec3([2.0, 4.0, 3.0]));
    }
}

#[test]
fn all_nodes_of_the_ends_of_an_annulus_lie_on_its_arcs() {
    for cell in cells(2) {
        let mesh = Annulus::new([1.0, 2.0], [3.0, 5.0], [-90.0, 0.0], [2, 9], cell).mesh("a").unwrap();
        for (name, radius) in [("inner", 3.0), ("outer", 5.0)] {
            let group = &mesh.groups[&format!("a.{name}")];
            assert_eq!(group.sides.len(), 9);
            let distance = |&node: &usize| (mesh.points[node] - Vec3([1.0, 2.0, 0.0])).norm();
            assert!(group.nodes.iter().all(|node| (distance(node) - radius).abs() < 1e-14));
        }
        assert!(mesh.groups["a.start"].nodes.iter().all(|&node| mesh.points[node][0] == 1.0));
        assert!(mesh.groups["a.end"].nodes.iter().all(|&node| mesh.points[node][1] == 2.0));
        let error = (measure(&mesh) / (4.0 * PI) - 1.0).abs();
        assert!(error < if cell.degree == 1 { 6e-3 } else { 5e-6 }, "{cell:?}: {error}");
    }
}

#[test]
fn a_full_turn_closes_the_ring() {
    for cell in cells(2) {
        let mesh = Annulus::new([0.0, 0.0], [1.0, 2.0], [0.0, 360.0], [2, 12], cell).mesh("a").unwrap();
        assert_eq!(outer_sides(&mesh), 24);
        assert_eq!(mesh.groups.keys().collect::<Vec<_>>(), ["a", "a.inner", "a.outer"]);
        let unused = (0..mesh.points.len()).filter(|&node| mesh.adjacency().cells(node).is_empty()).count();
        assert_eq!(unused, 0);
    }
}

#[test]
fn what_cannot_be_generated_is_refused() {
    let named = |name| Cell::named(name).unwrap();
    let quad = named("quad4");
    let refused = [
        (Rectangle::new([0.0; 2], [1.0; 2], [2, 2], named("line2")).mesh("p"), "choose one of"),
        (Rectangle::new([0.0; 2], [1.0; 2], [2, 0], quad).mesh("p"), "p, y: the number of cells is zero"),
        (Rectangle::new([0.0; 2], [1.0; 2], [60_000, 60_000], quad).mesh("p"), "60000 times 60000 cells are too many"),
        (Block::new([0.0; 3], [1.0; 3], [1, 1, 1], quad).mesh("p"), "a box cannot be made of 'quad4'"),
        (Annulus::new([0.0; 2], [0.0, 1.0], [0.0, 90.0], [1, 1], quad).mesh("p"), "inner radius"),
        (Annulus::new([0.0; 2], [1.0, 2.0], [0.0, 400.0], [1, 9], quad).mesh("p"), "full turn"),
        (Annulus::new([0.0; 2], [1.0, 2.0], [0.0, 360.0], [1, 2], quad).mesh("p"), "at least three"),
    ];
    for (mesh, word) in refused {
        let text = mesh.unwrap_err().to_string();
        assert!(text.starts_with("p") && text.contains(word), "{text}");
    }
}

#[test]
fn parts_of_different_names_stand_side_by_side() {
    let quad = Cell::named("quad4").unwrap();
    let mut mesh = Rectangle::new([0.0; 2], [1.0; 2], [2, 2], quad).mesh("one").unwrap();
    let other = Rectangle::new([0.0, 1.0], [1.0, 2.0], [3, 1], quad).mesh("two").unwrap();
    let clash = mesh.append(Rectangle::new([0.0; 2], [1.0; 2], [1, 1], quad).mesh("one").unwrap());
    assert!(clash.unwrap_err().to_string().contains("'one'"));
    mesh.append(other.clone()).unwrap();
    assert_eq!((mesh.points.len(), mesh.cell_count()), (9 + 8, 4 + 3));
    assert_eq!(mesh.groups["two"].cells, [4, 5, 6]);
    for (whole, part) in mesh.groups["two.right"].sides.iter().zip(&other.groups["two.right"].sides) {
        assert!(mesh.side(*whole).1.map(|node| node - 9).eq(other.side(*part).1));
    }
}
