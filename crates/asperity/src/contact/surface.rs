//! The surface that carries the contact points: edges of a body with their integration points.

use crate::mesh::cells::Cell;
use crate::mesh::{Mesh, Side};
use crate::tensor::{Scalar, Vec3};

/// Change of the radius over an edge, as a part of the sum of those of its ends, from which one point does not integrate it:
/// that of the tenth of equal edges from the axis on. Beyond, the nodes between two edges get what is theirs within a
/// hundredth.
const MARKED: f64 = 0.05;

/// Most nodes of an edge.
pub const MAX_EDGE_NODES: usize = 3;

/// One edge of the surface.
#[derive(Debug, Clone)]
pub struct Edge {
    /// Where it lies in the mesh.
    pub side: Side,
    /// Its reference cell.
    pub kind: &'static Cell,
    /// Its nodes.
    pub nodes: Vec<usize>,
    /// Second derivatives of the shape functions, which are constant.
    pub curvature: [f64; MAX_EDGE_NODES],
}

impl Edge {
    /// A side of the mesh.
    pub fn new(mesh: &Mesh, side: Side) -> Self {
        let (kind, nodes) = mesh.side(side);
        let mut edge = Self { side, kind, nodes: nodes.collect(), curvature: [0.0; MAX_EDGE_NODES] };
        let (left, right) = (edge.shape_at(-0.5).1, edge.shape_at(0.5).1);
        edge.curvature = std::array::from_fn(|k| right[k] - left[k]);
        edge
    }

    /// Distance between its ends before any motion.
    pub fn chord(&self, mesh: &Mesh) -> f64 {
        (mesh.points[self.nodes[1]] - mesh.points[self.nodes[0]]).norm()
    }

    /// Shape functions at `xi` from -1 to 1, and their derivatives.
    pub fn shape_at(&self, xi: f64) -> ([f64; MAX_EDGE_NODES], [f64; MAX_EDGE_NODES]) {
        let (mut n, mut gradient) = ([0.0; MAX_EDGE_NODES], [[0.0; 3]; MAX_EDGE_NODES]);
        let nodes = self.nodes.len();
        (self.kind.shape)([xi, 0.0, 0.0], &mut n[..nodes], &mut gradient[..nodes]);
        (n, gradient.map(|g| g[0]))
    }
}

/// One integration point of the surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoint {
    /// The edge it lies on.
    pub edge: usize,
    /// Its place in Gauss' rule, from -1 to 1.
    pub rule: f64,
    /// Its place on the edge, from -1 to 1: that in the rule, unless the rule is laid on a part of the edge.
    pub xi: f64,
    /// Half of the length of that part in `xi`, at most 1.
    pub half: f64,
    /// Shape functions there.
    pub n: [f64; MAX_EDGE_NODES],
    /// Their derivatives along the part.
    pub dn: [f64; MAX_EDGE_NODES],
    /// Quadrature weight.
    pub weight: f64,
}

/// Edges and integration points, in a fixed order.
#[derive(Debug, Clone)]
pub struct Surface {
    /// The edges.
    pub edges: Vec<Edge>,
    /// The integration points, edge by edge.
    pub points: Vec<SurfacePoint>,
}

impl Surface {
    /// The surface made of `sides`, with `gauss` points an edge (1, 2 or 3); by default as many as the degree of the
    /// edge. More points than the edge adds nodes enforce more conditions than it can meet: on a curved target the
    /// pressure then oscillates, and the force on a tool ripples as edges pass.
    pub fn new(mesh: &Mesh, sides: &[Side], gauss: Option<usize>) -> Self {
        Self::with(mesh, sides, |edge| gauss.unwrap_or(edge.kind.degree))
    }

    /// The same around the axis of axial symmetry, where a point stands for a circumference: by default two points also on
    /// an edge of first degree over which the radius changes markedly. One point would share a pressure out between the two
    /// nodes evenly, by half of what belongs to the axis too much there.
    pub fn around_axis(mesh: &Mesh, sides: &[Side], gauss: Option<usize>) -> Self {
        let radius = |edge: &Edge, end: usize| mesh.points[edge.nodes[end]][0];
        let changes = |edge: &Edge| {
            let [from, to] = [0, 1].map(|end| radius(edge, end));
            (to - from).abs() > MARKED * (from + to).abs()
        };
        let least = |edge: &Edge| if changes(edge) { 2 } else { 1 };
        Self::with(mesh, sides, |edge| gauss.unwrap_or_else(|| edge.kind.degree.max(least(edge))))
    }

    /// The surface made of `sides`, with so many points on each edge.
    fn with(mesh: &Mesh, sides: &[Side], order: impl Fn(&Edge) -> usize) -> Self {
        let mut surface = Self { edges: Vec::new(), points: Vec::new() };
        for &side in sides {
            let edge = Edge::new(mesh, side);
            let order = order(&edge).clamp(1, 3);
            let Some(rule) = edge.kind.gauss[order - 1] else { continue };
            for (&xi, &weight) in rule.points.iter().zip(rule.weights) {
                let ((n, dn), number) = (edge.shape_at(xi[0]), surface.edges.len());
                surface.points.push(SurfacePoint { edge: number, rule: xi[0], xi: xi[0], half: 1.0, n, dn, weight });
            }
            surface.edges.push(edge);
        }
        surface
    }

    /// The same with the rule repeated on each of `parts` equal parts of an edge: for contact that is narrower than an edge,
    /// which would else pass from one point to the next as over the teeth of a rack.
    pub fn divided(mut self, parts: usize) -> Self {
        let (half, whole) = (1.0 / parts as f64, std::mem::take(&mut self.points));
        for edge in 0..self.edges.len() {
            let rule = &whole[whole.partition_point(|p| p.edge < edge)..whole.partition_point(|p| p.edge <= edge)];
            for point in (0..parts).flat_map(|part| rule.iter().map(move |point| (part, point))) {
                let xi = half * (2.0 * point.0 as f64 + 1.0 + point.1.xi) - 1.0;
                let (n, dn) = self.edges[edge].shape_at(xi);
                let weight = half * point.1.weight;
                self.points.push(SurfacePoint { edge, rule: xi, xi, half: 1.0, n, dn, weight });
            }
        }
        self
    }

    /// A point where it stands when the rule is laid on a part of its edge: at `xi`, on a part of half length `half`.
    pub fn moved(&self, point: usize, [xi, half]: [f64; 2]) -> SurfacePoint {
        let point = self.points[point];
        if [xi, half] == [point.xi, point.half] {
            return point;
        }
        let (n, dn) = self.edges[point.edge].shape_at(xi);
        SurfacePoint { xi, half, n, dn: dn.map(|dn| dn * half), ..point }
    }

    /// The points of an edge, which follow each other.
    pub fn points_of(&self, edge: usize) -> std::ops::Range<usize> {
        let place = |edge: usize| self.points.partition_point(|point| point.edge < edge);
        place(edge)..place(edge + 1)
    }

    /// Nodes of the edge a point lies on.
    pub fn nodes(&self, point: &SurfacePoint) -> &[usize] {
        &self.edges[point.edge].nodes
    }
}

impl SurfacePoint {
    /// Position and tangent `dx/dxi` for edge nodes at `x`.
    pub fn place<T: Scalar>(&self, x: &[Vec3<T>]) -> (Vec3<T>, Vec3<T>) {
        let (mut a, mut tangent) = (Vec3::zero(), Vec3::zero());
        for (k, &x) in x.iter().enumerate() {
            a += x * T::from(self.n[k]);
            tangent += x * T::from(self.dn[k]);
        }
        (a, tangent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::generate::Annulus;

    /// Near the axis two points, and one on edges along it or far away; what the user says holds everywhere.
    #[test]
    fn edges_near_the_axis_have_two_points() {
        let cell = crate::mesh::Cell::named("quad4").unwrap();
        let plate =
            crate::mesh::generate::Rectangle::new([0.0, 0.0], [15.0, 1.0], [15, 1], cell).mesh("plate").unwrap();
        let counts = |group: &str, gauss| {
            let surface = Surface::around_axis(&plate, &plate.groups[group].sides, gauss);
            (0..surface.edges.len()).map(|edge| surface.points_of(edge).len()).collect::<Vec<_>>()
        };
        let mut top = counts("plate.top", None);
        top.sort_unstable();
        assert_eq!(top, [[1; 5].as_slice(), &[2; 10]].concat());
        assert_eq!(counts("plate.right", None), [1]);
        assert_eq!(counts("plate.top", Some(1)), [1; 15]);
    }

    /// Edges with more points have the same length and the same moment.
    #[test]
    fn a_divided_edge_is_as_long_as_the_whole() {
        let ring = Annulus::new([0.0, 0.0], [2.0, 10.0], [0.0, 90.0], [2, 3], Cell::named("quad8").unwrap());
        let mesh = ring.mesh("ring").unwrap();
        let whole = Surface::new(&mesh, &mesh.groups["ring.outer"].sides, Some(3));
        let moments = |surface: &Surface, edge: usize| {
            let points = surface.points_of(edge).map(|i| surface.points[i]);
            points.fold([0.0; 2], |[length, moment], point| {
                let x: Vec<Vec3> = surface.nodes(&point).iter().map(|&node| mesh.points[node]).collect();
                let (a, tangent) = point.place(&x);
                let part = point.weight * tangent.norm();
                [length + part, moment + part * a[0]]
            })
        };
        for parts in [1, 2, 5] {
            let divided = whole.clone().divided(parts);
            assert_eq!(divided.points.len(), parts * whole.points.len());
            for edge in 0..3 {
                let (a, b) = (moments(&whole, edge), moments(&divided, edge));
                assert!((0..2).all(|k| (a[k] / b[k] - 1.0).abs() < 1e-4), "{a:?} {b:?}");
            }
        }
    }
}
