//! Averaged normals of a surface in the plane: a field that is continuous where edges meet.
//!
//! The normal of a surface of first degree jumps from edge to edge. Here each node carries the mean of the tangents of
//! the edges that meet in it, weighted by their lengths, `t_k = T_k / |T_k|` with `T_k = sum_e dx/dxi`, and along an edge
//! `e_S = s / |s|`, `s = N_k t_k` (Yang, Laursen & Meng, Int. J. Numer. Meth. Engng 62, 2005). Edges that meet in a corner
//! keep their own, and so does the end of a surface, unless it lies on the axis of revolution: there the tangent is that of
//! the edge and its mirror image, across the axis. Which edges do is decided on the undeformed surface, so that the
//! field is a smooth function of the nodes. `T_k` is linear in the nodes of an edge and of its neighbours; those of the
//! neighbours beyond its own are called the nodes around it. What the field is used for is not known here.

use super::faces::neighbours;
use super::guard::{CORNER, angle};
use super::surface::{Edge, MAX_EDGE_NODES};
use crate::mesh::Mesh;
use crate::tensor::Vec3;

/// Most nodes around an edge: two of each neighbour.
pub const MAX_AROUND: usize = 4;
/// Most nodes on which the field on an edge depends.
const MOST: usize = MAX_EDGE_NODES + MAX_AROUND;
/// Most unknowns on which it depends.
pub const MAX_FIELD: usize = 2 * MOST;

/// The nodes around an edge, and how the sums of tangents at its own nodes follow from all.
#[derive(Debug, Clone, Default)]
pub struct Around {
    /// The nodes of its neighbours that are not its own.
    pub nodes: Vec<usize>,
    weights: [[f64; MOST]; MAX_EDGE_NODES],
    /// Whether its ends lie smoothly on the axis of revolution.
    on_axis: [bool; 2],
}

/// The unit tangents at the nodes of an edge in place.
#[derive(Clone, Copy)]
pub struct Field<'a> {
    around: &'a Around,
    units: [Vec3; MAX_EDGE_NODES],
    /// Lengths of the sums; zero where nothing turns the unit tangent.
    lengths: [f64; MAX_EDGE_NODES],
}

/// Coordinates of the nodes of an edge, by their number.
const PLACES: [f64; MAX_EDGE_NODES] = [-1.0, 1.0, 0.0];

impl Around {
    /// Those of each of `edges`, which turn about the axis `x = 0` or not.
    pub fn of(mesh: &Mesh, edges: &[Edge], revolves: bool) -> Vec<Self> {
        let neighbours = neighbours(edges);
        let one = |(i, edge): (usize, &Edge)| {
            let on_axis = [0, 1].map(|end| revolves && ends_on_axis(mesh, edge, end));
            let mut around = Self { on_axis, ..Self::default() };
            for (k, _) in edge.nodes.iter().enumerate() {
                around.add(edge, k, (edge, PLACES[k]));
                let beside = neighbours[i].get(k).copied().flatten().map(|other| (&edges[other], -PLACES[k]));
                let smooth = |other: &(&Edge, f64)| meet_smoothly(mesh, (edge, PLACES[k]), *other);
                beside.filter(smooth).into_iter().for_each(|other| around.add(edge, k, other));
            }
            around
        };
        edges.iter().enumerate().map(one).collect()
    }

    /// Adds the tangent of an edge at a place to the sum at node number `k` of an edge.
    fn add(&mut self, own: &Edge, k: usize, (edge, at): (&Edge, f64)) {
        let slopes = edge.shape_at(at).1;
        for (node, slope) in edge.nodes.iter().zip(slopes) {
            let place = number_of(*node, &own.nodes, &mut self.nodes);
            self.weights[k][place] += slope;
        }
    }

    /// The field for the nodes of an edge and those around it at `x`.
    pub fn field(&self, x: impl Iterator<Item = Vec3>) -> Field<'_> {
        let mut sums = [Vec3::zero(); MAX_EDGE_NODES];
        for (j, x) in x.enumerate() {
            sums.iter_mut().zip(&self.weights).for_each(|(sum, weights)| *sum += x * weights[j]);
        }
        let (mut lengths, mut units) = (sums.map(|sum| sum.norm()), [Vec3::zero(); MAX_EDGE_NODES]);
        for k in (0..MAX_EDGE_NODES).filter(|&k| lengths[k] > 0.0) {
            units[k] = sums[k] * lengths[k].recip();
        }
        for end in (0..2).filter(|&end| self.on_axis[end]) {
            (units[end], lengths[end]) = (Vec3::new(sums[end][0].signum(), 0.0, 0.0), 0.0);
        }
        Field { around: self, units, lengths }
    }
}

/// The number of a node among the own ones of an edge or a face and those around it, to which it is added if it is new.
pub fn number_of(node: usize, own: &[usize], around: &mut Vec<usize>) -> usize {
    let known = own.iter().chain(around.iter()).position(|&other| other == node);
    known.unwrap_or_else(|| {
        around.push(node);
        own.len() + around.len() - 1
    })
}

/// Tangent of an undeformed edge at a place on it.
fn tangent(mesh: &Mesh, (edge, at): (&Edge, f64)) -> Vec3 {
    let slopes = edge.shape_at(at).1;
    edge.nodes.iter().zip(slopes).fold(Vec3::zero(), |sum, (&node, slope)| sum + mesh.points[node] * slope)
}

/// Whether two edges meet without a corner where both have a node, at places on them.
fn meet_smoothly(mesh: &Mesh, one: (&Edge, f64), other: (&Edge, f64)) -> bool {
    angle(tangent(mesh, one), tangent(mesh, other)) < CORNER
}

/// Whether an end of an edge lies on the axis, where it meets its mirror image without a corner.
fn ends_on_axis(mesh: &Mesh, edge: &Edge, end: usize) -> bool {
    let t = tangent(mesh, (edge, PLACES[end]));
    mesh.points[edge.nodes[end]][0].abs() < 1e-9 * t.norm() && angle(t, Vec3::new(t[0], -t[1], 0.0)) < CORNER
}

impl Field<'_> {
    /// `sum_k w_k t_k`, the field itself for shape functions, its slope for their derivatives.
    pub fn sum(&self, weights: &[f64; MAX_EDGE_NODES]) -> Vec3 {
        self.units.iter().zip(weights).fold(Vec3::zero(), |sum, (&unit, &weight)| sum + unit * weight)
    }

    /// The derivatives of such a sum along the unknowns of the nodes of the edge and of those around it.
    pub fn rates(&self, weights: &[f64; MAX_EDGE_NODES]) -> [Vec3; MAX_FIELD] {
        let mut rates = [Vec3::zero(); MAX_FIELD];
        for (k, &weight) in weights.iter().enumerate().filter(|(k, _)| self.lengths[*k] > 0.0) {
            let (unit, part) = (self.units[k], weight / self.lengths[k]);
            // Only what is across a unit vector turns it.
            let across = unit.left();
            for (i, rate) in rates.iter_mut().enumerate() {
                *rate += across * (across[i % 2] * part * self.around.weights[k][i / 2]);
            }
        }
        rates
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Cell;
    use crate::mesh::generate::{Annulus, Rectangle};

    fn edges(mesh: &Mesh, group: &str) -> Vec<Edge> {
        mesh.groups[group].sides.iter().map(|&side| Edge::new(mesh, side)).collect()
    }

    fn field_at(mesh: &Mesh, edge: &Edge, around: &Around, xi: f64) -> Vec3 {
        let nodes = edge.nodes.iter().chain(&around.nodes);
        around.field(nodes.map(|&node| mesh.points[node])).sum(&edge.shape_at(xi).0).unit()
    }

    /// On a ring of equal edges the tangents at the nodes are those of the circle, from both sides.
    #[test]
    fn the_field_of_a_ring_is_continuous_and_true_at_its_nodes() {
        for name in ["quad4", "quad8"] {
            let ring = Annulus::new([0.0, 0.0], [1.0, 2.0], [0.0, 360.0], [1, 16], Cell::named(name).unwrap());
            let mesh = ring.mesh("ring").unwrap();
            let edges = edges(&mesh, "ring.outer");
            for (edge, around) in edges.iter().zip(Around::of(&mesh, &edges, false)) {
                assert_eq!(around.nodes.len(), if name == "quad4" { 2 } else { 4 });
                for (k, &node) in edge.nodes.iter().enumerate() {
                    let along = mesh.points[node].unit().left();
                    let error = (field_at(&mesh, edge, &around, PLACES[k]) - along).norm();
                    assert!(error < 1e-12, "{name} node {k}: {error:.1e}");
                }
            }
        }
    }

    /// On the axis of revolution the tangent is across it, whatever becomes of the edge.
    #[test]
    fn the_top_of_a_ball_is_level() {
        let ball = Annulus::new([0.0, 0.0], [1.0, 2.0], [0.0, 90.0], [1, 4], Cell::named("quad4").unwrap());
        let mesh = ball.mesh("ball").unwrap();
        let edges = edges(&mesh, "ball.outer");
        let tops = |revolves: bool| {
            let all = Around::of(&mesh, &edges, revolves);
            let top = edges.iter().zip(all).find(|(edge, _)| mesh.points[edge.nodes[1]][0].abs() < 1e-12).unwrap();
            field_at(&mesh, top.0, &top.1, 1.0)
        };
        assert!((tops(true) + Vec3::new(1.0, 0.0, 0.0)).norm() < 1e-15);
        assert!((tops(false)[1] - (11.25_f64).to_radians().sin()).abs() < 1e-12);
    }

    /// A square keeps its corners; the end of a side has only one neighbour.
    #[test]
    fn corners_stay() {
        let cell = Cell::named("quad4").unwrap();
        let mesh = Rectangle::new([0.0; 2], [1.0; 2], [2, 2], cell).mesh("b").unwrap();
        let sides = mesh.boundary(&mesh.groups["b"].cells);
        let edges: Vec<Edge> = sides.iter().map(|&side| Edge::new(&mesh, side)).collect();
        for (edge, around) in edges.iter().zip(Around::of(&mesh, &edges, false)) {
            assert_eq!(around.nodes.len(), 1);
            let own = (mesh.points[edge.nodes[1]] - mesh.points[edge.nodes[0]]).unit();
            assert!([-1.0, 0.3, 1.0].iter().all(|&xi| (field_at(&mesh, edge, &around, xi) - own).norm() < 1e-15));
        }
    }
}
