//! Where probes read: shares of nodes in a group, and points by the shape functions of the cells that hold them.

use asperity_core::mesh::cells::MAX_NODES;
use asperity_core::mesh::{CellView, Group, Mesh, Space};
use asperity_core::tensor::{Tensor2, Vec3};

/// A node and its share of a group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Share {
    /// The node.
    pub node: usize,
    /// Area, volume or number that its shape function stands for before any motion.
    pub part: f64,
}

/// A point of a body: where it lies before any motion, and the nodes that carry it with their shape functions.
#[derive(Debug, Clone, PartialEq)]
pub struct ProbeSpot {
    /// Position before any motion.
    pub point: Vec3,
    /// Nodes with their shape functions there.
    pub nodes: Vec<(usize, f64)>,
}

/// The shares of the nodes of a group: of its sides, else of its cells, else each one.
pub fn shares(mesh: &Mesh, group: &Group, space: Space) -> Vec<Share> {
    let mut parts = vec![0.0; mesh.points.len()];
    let around = |x: Vec3| if space == Space::Axisymmetric { x[0] } else { 1.0 };
    let mut add = |kind: &'static asperity_core::mesh::Cell, nodes: &[usize]| {
        let view = CellView { kind, nodes };
        for (&xi, &weight) in kind.full.points.iter().zip(kind.full.weights) {
            let (x, [u, v, w]) = view.map(&mesh.points, xi);
            let measure = match kind.dimension {
                1 => u.norm(),
                2 => u.cross(v).norm(),
                _ => u.cross(v).dot(w),
            };
            let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            (kind.shape)(xi, &mut n, &mut dn);
            nodes.iter().zip(n).for_each(|(&node, n)| parts[node] += n * weight * measure * around(x));
        }
    };
    for &side in &group.sides {
        let (kind, nodes) = mesh.side(side);
        add(kind, &nodes.collect::<Vec<_>>());
    }
    if group.sides.is_empty() {
        for view in group.cells.iter().map(|&cell| mesh.cell(cell)) {
            add(view.kind, view.nodes);
        }
    }
    let counted = group.sides.is_empty() && group.cells.is_empty();
    let share = |&node: &usize| Share { node, part: if counted { 1.0 } else { parts[node] } };
    group.nodes.iter().map(share).collect()
}

/// Steps of Newton's method for the place in a cell.
const STEPS: usize = 30;
/// Part of a cell by which a point may lie outside of it.
const MARGIN: f64 = 1e-6;

/// The point of a body at `point` before any motion; none where there is no material.
pub fn spot(mesh: &Mesh, cells: impl Iterator<Item = usize>, point: Vec3) -> Option<ProbeSpot> {
    let mut best: Option<(f64, ProbeSpot)> = None;
    for view in cells.map(|cell| mesh.cell(cell)) {
        let corners = || view.nodes.iter().map(|&node| mesh.points[node]);
        let apart = (0..3).any(|axis| {
            let [low, high] = corners().fold([f64::MAX, f64::MIN], |[l, h], x| [l.min(x[axis]), h.max(x[axis])]);
            // Curved sides bulge beyond their nodes.
            let room =
                0.3 * corners().map(|x| (x - point).norm()).fold(0.0, f64::max).min(high - low) + 1e-9 * high.abs();
            !(point[axis] >= low - room && point[axis] <= high + room)
        });
        if apart {
            continue;
        }
        let Some(xi) = place(mesh, &view, point) else { continue };
        let outside = beyond(&view, xi);
        if outside <= MARGIN && best.as_ref().is_none_or(|(least, _)| outside < *least) {
            let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            (view.kind.shape)(xi, &mut n, &mut dn);
            let nodes = view.nodes.iter().copied().zip(n).filter(|(_, n)| n.abs() > 1e-14).collect();
            best = Some((outside, ProbeSpot { point, nodes }));
        }
    }
    best.map(|(_, spot)| spot)
}

/// Coordinates of a point in a cell of a mesh, by Newton's method.
fn place(mesh: &Mesh, view: &CellView, point: Vec3) -> Option<[f64; 3]> {
    let mut xi = view.kind.center();
    for _ in 0..STEPS {
        let (x, tangents) = view.map(&mesh.points, xi);
        let off = point - x;
        let size = tangents.iter().map(|tangent| tangent.norm()).fold(0.0, f64::max);
        let mut jacobian = Tensor2::from_fn(|i, a| tangents[a][i]);
        if view.kind.dimension == 2 {
            jacobian[(2, 2)] = 1.0;
        }
        let inverse = jacobian.inverse();
        let step: [f64; 3] = std::array::from_fn(|a| (0..3).map(|i| inverse[(a, i)] * off[i]).sum());
        if step.iter().any(|step| !step.is_finite()) {
            return None;
        }
        (0..view.kind.dimension).for_each(|a| xi[a] = (xi[a] + step[a]).clamp(-3.0, 3.0));
        if off.norm() < 1e-13 * size {
            return Some(xi);
        }
        if step.iter().map(|step| step.abs()).fold(0.0, f64::max) < 1e-12 {
            return Some(xi);
        }
    }
    None
}

/// How far a place lies outside of its reference cell.
fn beyond(view: &CellView, [x, y, z]: [f64; 3]) -> f64 {
    let simplex = |x: f64, y: f64, z: f64| [-x, -y, -z, x + y + z - 1.0].into_iter().fold(f64::MIN, f64::max);
    let along = |x: f64| x.abs() - 1.0;
    match view.kind.linear.name {
        "tri3" => simplex(x, y, 0.0),
        "tet4" => simplex(x, y, z),
        "wedge6" => simplex(x, y, 0.0).max(along(z)),
        _ if view.kind.dimension == 2 => along(x).max(along(y)),
        _ => along(x).max(along(y)).max(along(z)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::mesh::cells::{ALL, QUAD8};

    /// A cell of every kind, stretched and sheared.
    fn single(kind: &'static asperity_core::mesh::Cell) -> Mesh {
        let mut mesh = Mesh::new();
        let place = |&[x, y, z]: &[f64; 3]| {
            let depth = if kind.dimension == 3 { 1.5 * z + 0.2 * x } else { 0.0 };
            Vec3::new(2.0 * x + 0.3 * y + 5.0, 1.2 * y - 0.1 * x, depth)
        };
        mesh.points = kind.nodes.iter().map(place).collect();
        mesh.push_cell(kind, &(0..kind.nodes.len()).collect::<Vec<_>>());
        mesh
    }

    #[test]
    fn a_point_is_carried_by_the_nodes_of_its_cell() {
        for kind in ALL.iter().filter(|kind| kind.dimension > 1) {
            let mesh = single(kind);
            let view = mesh.cell(0);
            for &xi in kind.full.points {
                let point = view.map(&mesh.points, xi).0;
                let found = spot(&mesh, 0..1, point).unwrap_or_else(|| panic!("{}: {xi:?}", kind.name));
                let back = found.nodes.iter().fold(Vec3::zero(), |sum, &(node, n)| sum + mesh.points[node] * n);
                assert!((back - point).norm() < 1e-12, "{}", kind.name);
            }
            for node in &mesh.points {
                assert!(spot(&mesh, 0..1, *node).is_some(), "{}: a node is a point of its cell", kind.name);
            }
            assert_eq!(spot(&mesh, 0..1, Vec3::new(20.0, 0.0, 0.0)), None);
        }
    }

    #[test]
    fn shares_are_the_measure_that_shape_functions_stand_for() {
        let mesh = single(&QUAD8);
        let group = Group::new(&mesh, vec![0], vec![], vec![]);
        let whole: f64 = shares(&mesh, &group, Space::PlaneStrain).iter().map(|share| share.part).sum();
        assert!((whole - mesh.measure(0)).abs() < 1e-12);
        let nodes = Group::new(&mesh, vec![], vec![], vec![0, 2]);
        assert_eq!(
            shares(&mesh, &nodes, Space::PlaneStrain).iter().map(|share| share.part).collect::<Vec<_>>(),
            [1.0; 2]
        );
    }
}
