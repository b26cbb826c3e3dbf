//! Averaged normals of a surface in space: as in the plane, nodes carry the means of what meets in them.
//!
//! Here these are the inward normals of the faces, weighted by their areas: `m_k = M_k / |M_k|` with
//! `M_k = sum_f A_f g_2 x g_1` at the node, `A_f` the area of the face in its own coordinates, and over a face
//! `e_R = m / |m|`, `m = N_k m_k`. Faces around a node that look to sides further apart than a corner's angle, and are not
//! joined by others between them, keep their own, decided on the undeformed surface. The tangents of a point are those
//! of its face turned by the smallest rotation that brings its normal to `e_R`; they span the same area.

use super::surface::{Face, MAX_NODES};
use crate::contact::averaged::number_of;
use crate::contact::guard::{CORNER, angle};
use crate::mesh::Mesh;
use crate::tensor::{Dual, Scalar, Vec3};
use std::collections::BTreeMap;

/// Tangents of one face at a node: for each of the nodes on which they depend, its place in the list and its parts.
type Spans = Vec<(usize, [f64; 2])>;

/// The nodes around a face, and which tangents make up the normals at its own nodes.
#[derive(Debug, Clone, Default)]
pub struct Around {
    /// Nodes of its neighbours that are not its own, and turn its normals.
    pub nodes: Vec<usize>,
    sums: Vec<Vec<Spans>>,
}

/// The unit normals at the nodes of a face in place.
#[derive(Debug, Clone)]
pub struct Field<'a> {
    around: &'a Around,
    /// Positions of the nodes of the face and of those around it.
    x: Vec<Vec3>,
    units: [Vec3; MAX_NODES],
    lengths: [f64; MAX_NODES],
}

/// A face and the number of one of its nodes.
type At = (usize, usize);

impl Around {
    /// Those of each of `faces`.
    pub fn of(mesh: &Mesh, faces: &[Face]) -> Vec<Self> {
        let mut meeting: BTreeMap<usize, Vec<At>> = BTreeMap::new();
        for (i, face) in faces.iter().enumerate() {
            face.nodes.iter().enumerate().for_each(|(k, node)| meeting.entry(*node).or_default().push((i, k)));
        }
        let mut all = vec![Self::default(); faces.len()];
        for (around, face) in all.iter_mut().zip(faces) {
            around.sums = vec![Vec::new(); face.nodes.len()];
        }
        for group in meeting.values().flat_map(|at| groups(mesh, faces, at)) {
            for &(i, k) in &group {
                for &(j, other) in &group {
                    let spans = all[i].spans(&faces[i], (&faces[j], other));
                    all[i].sums[k].push(spans);
                }
            }
        }
        all
    }

    /// The tangents of a face at its node number `k`, over the nodes of `own` and those around it.
    fn spans(&mut self, own: &Face, (face, k): (&Face, usize)) -> Spans {
        let slopes = face.natural(place_of(face, k)).1;
        let part = if face.corners() == 3 { 0.5_f64 } else { 4.0 }.sqrt();
        let parts = face.nodes.iter().zip(slopes).filter(|(_, slopes)| *slopes != [0.0; 2]);
        parts
            .map(|(&node, slopes)| (number_of(node, &own.nodes, &mut self.nodes), slopes.map(|slope| slope * part)))
            .collect()
    }

    /// The field for the nodes of a face and those around it at `x`.
    pub fn field(&self, x: Vec<Vec3>) -> Field<'_> {
        let mut field = Field { around: self, x, units: [Vec3::zero(); MAX_NODES], lengths: [0.0; MAX_NODES] };
        for (k, sum) in self.sums.iter().enumerate() {
            let normal = sum.iter().fold(Vec3::zero(), |normal, spans| {
                let [g1, g2] = field.tangents(spans);
                normal + g2.cross(g1)
            });
            field.lengths[k] = normal.norm();
            if field.lengths[k] > 0.0 {
                field.units[k] = normal * field.lengths[k].recip();
            }
        }
        field
    }
}

/// The coordinates of node number `k` on its face.
fn place_of(face: &Face, k: usize) -> [f64; 2] {
    let [xi, eta, _] = face.kind.nodes[k];
    [xi, eta]
}

/// The faces at a node, parted where they meet in a corner.
fn groups(mesh: &Mesh, faces: &[Face], at: &[At]) -> Vec<Vec<At>> {
    let normal = |&(i, k): &At| {
        let slopes = faces[i].natural(place_of(&faces[i], k)).1;
        let [g1, g2] = [0, 1].map(|a| {
            faces[i].nodes.iter().zip(&slopes).fold(Vec3::zero(), |sum, (&node, dn)| sum + mesh.points[node] * dn[a])
        });
        g2.cross(g1)
    };
    let mut groups: Vec<Vec<(At, Vec3)>> = Vec::new();
    for one in at {
        let n = normal(one);
        let smooth = |group: &Vec<(At, Vec3)>| group.iter().any(|(_, m)| angle(n, *m) < CORNER);
        let (mut joined, rest): (Vec<_>, Vec<_>) = groups.into_iter().partition(smooth);
        joined.push(vec![(*one, n)]);
        groups = rest;
        groups.push(joined.concat());
    }
    groups.into_iter().map(|group| group.into_iter().map(|(at, _)| at).collect()).collect()
}

impl Field<'_> {
    fn tangents(&self, spans: &Spans) -> [Vec3; 2] {
        [0, 1].map(|a| spans.iter().fold(Vec3::zero(), |sum, (j, parts)| sum + self.x[*j] * parts[a]))
    }

    /// `sum_k w_k m_k`, the field itself for shape functions, its slopes for their derivatives.
    pub fn sum(&self, weights: &[f64; MAX_NODES]) -> Vec3 {
        self.units.iter().zip(weights).fold(Vec3::zero(), |sum, (&unit, &weight)| sum + unit * weight)
    }

    /// The derivatives of such a sum along the unknowns of the nodes of the face and of those around it.
    pub fn rates(&self, weights: &[f64; MAX_NODES]) -> Vec<Vec3> {
        let mut rates = vec![Vec3::zero(); 3 * self.x.len()];
        for (k, sum) in self.around.sums.iter().enumerate().filter(|(k, _)| self.lengths[*k] > 0.0) {
            let (unit, part) = (self.units[k], weights[k] / self.lengths[k]);
            for spans in sum {
                let [g1, g2] = self.tangents(spans);
                for &(j, [first, second]) in spans {
                    // g_2 x g_1 changes by `axis x (second g_1 - first g_2)` with the node.
                    let arm = (g1 * second - g2 * first) * part;
                    for (i, rate) in rates[3 * j..3 * j + 3].iter_mut().enumerate() {
                        let turned = axis(i).cross(arm);
                        *rate += turned - unit * unit.dot(turned);
                    }
                }
            }
        }
        rates
    }
}

/// A unit vector along an axis.
pub fn axis(i: usize) -> Vec3 {
    let mut axis = Vec3::zero();
    axis[i] = 1.0;
    axis
}

/// The tangents of a face turned by the smallest rotation that brings their normal `g_2 x g_1` to the direction of `m`.
pub fn turned<T: Scalar>([g1, g2]: [Vec3<T>; 2], m: Vec3<T>) -> [Vec3<T>; 2] {
    let (n, e) = (g2.cross(g1).unit(), m.unit());
    let (w, part) = (n.cross(e), (n.dot(e) + T::from(1.0)).recip());
    [g1, g2].map(|g| {
        let first = w.cross(g);
        g + first + w.cross(first) * part
    })
}

/// How turned tangents follow from the tangents and `m`: derivatives of six components along nine.
#[derive(Debug, Clone, Copy)]
pub struct Turning([Dual<9>; 6]);

impl Turning {
    /// For these.
    pub fn new([g1, g2]: [Vec3; 2], m: Vec3) -> Self {
        let seed = |v: Vec3, first: usize| Vec3(std::array::from_fn(|i| Dual::variable(v[i], first + i)));
        let [a, b] = turned([seed(g1, 0), seed(g2, 3)], seed(m, 6));
        Self([a[0], a[1], a[2], b[0], b[1], b[2]])
    }

    /// The change of the turned tangents with that of the three vectors.
    pub fn of(&self, changes: [Vec3; 3]) -> [Vec3; 2] {
        let along = |row: &Dual<9>| (0..9).map(|i| row.du[i] * changes[i / 3][i % 3]).sum::<f64>();
        [0, 3].map(|first| Vec3(std::array::from_fn(|i| along(&self.0[first + i]))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::space::Surface;
    use crate::contact::space::point::Triad;
    use crate::mesh::Cell;
    use crate::mesh::generate::Block;

    /// The front of a block, bent to a cylinder of radius 4 for faces of every kind.
    fn bent(name: &str) -> (Mesh, Vec<Face>) {
        let cell = Cell::named(name).unwrap();
        let mut mesh = Block::new([-1.0, -1.0, -1.0], [1.0, 1.0, 0.0], [4, 3, 1], cell).mesh("b").unwrap();
        for x in &mut mesh.points {
            let (sin, cos) = (0.25 * x[0]).sin_cos();
            *x = Vec3::new((4.0 + x[2]) * sin, x[1], (4.0 + x[2]) * cos - 4.0);
        }
        let faces = Surface::new(&mesh, &mesh.groups["b.front"].sides, None).faces;
        (mesh, faces)
    }

    #[test]
    fn nodes_carry_one_normal_close_to_the_true_one() {
        for name in ["hex8", "hex20", "hex27", "tet4", "tet10"] {
            let (mesh, faces) = bent(name);
            let (mut seen, mut inner) = (BTreeMap::<usize, Vec3>::new(), 0);
            for (face, around) in faces.iter().zip(Around::of(&mesh, &faces)) {
                let all = face.nodes.iter().chain(&around.nodes).map(|&node| mesh.points[node]).collect();
                let field = around.field(all);
                for (k, &node) in face.nodes.iter().enumerate() {
                    let normal = field.sum(&face.natural(place_of(face, k)).0).unit();
                    let first = *seen.entry(node).or_insert(normal);
                    assert!((normal - first).norm() < 1e-14, "{name}");
                    let x = mesh.points[node];
                    if x[0].abs() < 0.8 && x[1].abs() < 0.8 {
                        let error = (normal + Vec3::new(x[0], 0.0, x[2] + 4.0).unit()).norm();
                        let allowed = if name.starts_with("hex") { 1e-3 } else { 0.05 };
                        assert!(error < allowed, "{name}: {error:.1e}");
                        inner += 1;
                    }
                }
            }
            assert!(inner > 10, "{name}");
        }
    }

    /// Around the corner of a cube three normals stay three.
    #[test]
    fn corners_stay() {
        let mesh = Block::new([0.0; 3], [1.0; 3], [2; 3], Cell::named("hex8").unwrap()).mesh("b").unwrap();
        let faces = Surface::new(&mesh, &mesh.boundary(&mesh.groups["b"].cells), None).faces;
        for (face, around) in faces.iter().zip(Around::of(&mesh, &faces)) {
            let x = |nodes: &[usize]| nodes.iter().map(|&node| mesh.points[node]).collect::<Vec<_>>();
            let own = x(&face.nodes);
            let normal = (own[1] - own[0]).cross(own[3] - own[0]).unit();
            let field = around.field([own, x(&around.nodes)].concat());
            assert!(around.nodes.len() == 4 && (field.units[0] + normal).norm() < 1e-15);
            assert!(field.units[..4].iter().all(|unit| (*unit + normal).norm() < 1e-15));
        }
    }

    #[test]
    fn turned_tangents_span_the_same_area_across_the_given_normal() {
        let (g, m) = ([Vec3::new(2.0, 0.1, 0.3), Vec3::new(0.7, 1.5, -0.2)], Vec3::new(0.3, -0.2, -2.0));
        let (before, after) = (Triad::new(g), Triad::new(turned(g, m)));
        assert!((after.inward - m.unit()).norm() < 1e-15 && (after.area - before.area).abs() < 1e-15);
        let along = Triad::new(turned(g, before.inward * 3.0)).along[0];
        assert!((along - before.along[0]).norm() < 1e-15);
    }
}
