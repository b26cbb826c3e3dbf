//! A face of the surface with its nodes in place: where its points stand, along which tangents, and how both move.
//!
//! The tangents are the face's own, or those turned to the averaged normals; they span the same area. All else of a
//! contact point sees only them.

use super::averaged::{Field, Turning, axis, turned};
use super::surface::{Face, MAX_NODES, SurfacePoint};
use crate::tensor::Vec3;

/// A face with its nodes in place.
#[derive(Debug, Clone)]
pub struct Placed<'a> {
    /// The face.
    pub face: &'a Face,
    /// Positions of its nodes.
    pub x: [Vec3; MAX_NODES],
    /// The averaged normals at its nodes, unless its own are meant.
    pub field: Option<Field<'a>>,
}

/// How a foot moves over the face.
pub struct FootRates {
    /// Along the unknowns of the face's own nodes, and of those around that turn its normals.
    pub own: Vec<[f64; 2]>,
    /// Along the position of the vertex.
    pub vertex: [[f64; 2]; 3],
}

/// A place of which a vertex may be the foot's: tangents, the way from the vertex, and what of it lies across the normal.
struct Across {
    tangents: [Vec3; 2],
    way: Vec3,
    normal: Option<Vec3>,
    across: Vec3,
}

/// Feet farther from the face than this, in `xi`, are none.
const FAR: f64 = 50.0;

impl Placed<'_> {
    fn sum(&self, weight: impl Fn(usize) -> f64) -> Vec3 {
        (0..self.face.nodes.len()).fold(Vec3::zero(), |sum, k| sum + self.x[k] * weight(k))
    }

    /// Position and its two derivatives at `xi`.
    pub fn at(&self, xi: [f64; 2]) -> (Vec3, [Vec3; 2]) {
        let (n, dn) = self.face.natural(xi);
        (self.sum(|k| n[k]), [0, 1].map(|a| self.sum(|k| dn[k][a])))
    }

    /// Second derivatives at `xi`: `d g_a / d xi_b` at `[a][b]`.
    fn second(&self, xi: [f64; 2]) -> [[Vec3; 2]; 2] {
        let ddn = self.face.second(xi);
        [0, 1].map(|a| [0, 1].map(|b| self.sum(|k| ddn[k][a][b])))
    }

    /// The averaged normal at `xi`, of any length, and its two derivatives.
    fn normal(&self, xi: [f64; 2]) -> Option<(Vec3, [Vec3; 2])> {
        let (field, (n, dn)) = (self.field.as_ref()?, self.face.natural(xi));
        Some((field.sum(&n), [0, 1].map(|a| field.sum(&dn.map(|dn| dn[a])))))
    }

    /// Position and tangents at `xi`.
    pub fn frame(&self, xi: [f64; 2]) -> (Vec3, [Vec3; 2]) {
        let (x, g) = self.at(xi);
        (x, self.normal(xi).map_or(g, |(m, _)| turned(g, m)))
    }

    /// Derivatives of the tangents at `xi`, `[a][b]` of the one along `xi_b`.
    pub fn bend(&self, xi: [f64; 2]) -> [[Vec3; 2]; 2] {
        let k = self.second(xi);
        let Some((m, slopes)) = self.normal(xi) else { return k };
        let turning = Turning::new(self.at(xi).1, m);
        let [first, second] = [0, 1].map(|b| turning.of([k[0][b], k[1][b], slopes[b]]));
        [0, 1].map(|a| [first[a], second[a]])
    }

    /// Derivatives of the inward unit normal at `xi`.
    pub fn normal_slopes(&self, xi: [f64; 2]) -> [Vec3; 2] {
        if let Some((m, slopes)) = self.normal(xi) {
            return slopes.map(|slope| bent(m, slope));
        }
        let ((_, [g1, g2]), k) = (self.at(xi), self.second(xi));
        [0, 1].map(|b| bent(g2.cross(g1), k[1][b].cross(g1) + g2.cross(k[0][b])))
    }

    /// Position and tangents of a point, the tangents for the part that it stands for.
    pub fn stand(&self, spot: &SurfacePoint) -> (Vec3, [Vec3; 2]) {
        let (a, g) = spot.place(&self.x[..self.face.nodes.len()]);
        (a, self.field.as_ref().map_or(g, |field| turned(g, field.sum(&spot.n))))
    }

    /// Whether the averaged normal at a point looks to the side to which its face looks.
    pub fn is_upright(&self, spot: &SurfacePoint) -> bool {
        self.field.as_ref().is_none_or(|field| {
            let (_, [g1, g2]) = spot.place(&self.x[..self.face.nodes.len()]);
            field.sum(&spot.n).dot(g2.cross(g1)) > 0.0
        })
    }

    /// Changes of the tangents of its own that a node's motion along an axis makes at a point; none for nodes around it.
    fn moved(&self, spot: &SurfacePoint, unknown: usize) -> [Vec3; 2] {
        let own = unknown < 3 * self.face.nodes.len();
        [0, 1].map(|a| if own { axis(unknown % 3) * spot.dn[unknown / 3][a] } else { Vec3::zero() })
    }

    /// Derivatives of the tangents of a point along the unknowns of the nodes, and of those around; none where the
    /// tangents are the face's own.
    pub fn turning(&self, spot: &SurfacePoint) -> Option<Vec<[Vec3; 2]>> {
        let field = self.field.as_ref()?;
        let (_, g) = spot.place(&self.x[..self.face.nodes.len()]);
        let turning = Turning::new(g, field.sum(&spot.n));
        let along = |(unknown, rate): (usize, Vec3)| {
            let [first, second] = self.moved(spot, unknown);
            turning.of([first, second, rate])
        };
        Some(field.rates(&spot.n).into_iter().enumerate().map(along).collect())
    }

    /// Derivatives of the inward unit normal of a point along the same unknowns.
    pub fn normal_rates(&self, spot: &SurfacePoint) -> Vec<Vec3> {
        if let Some(field) = &self.field {
            let m = field.sum(&spot.n);
            return field.rates(&spot.n).into_iter().map(|rate| bent(m, rate)).collect();
        }
        let (_, [g1, g2]) = spot.place(&self.x[..self.face.nodes.len()]);
        let along = |unknown: usize| {
            let [first, second] = self.moved(spot, unknown);
            bent(g2.cross(g1), second.cross(g1) + g2.cross(first))
        };
        (0..3 * self.face.nodes.len()).map(along).collect()
    }

    /// The foot of the normal through a vertex: the way to it has no part across the normal.
    pub fn foot(&self, vertex: Vec3) -> Option<[f64; 2]> {
        let mut xi = self.face.middle();
        for _ in 0..25 {
            let across = self.across(xi, vertex);
            let step = solve(self.slopes(xi, &across), across.residual());
            xi = [xi[0] - step[0], xi[1] - step[1]];
            if !xi.iter().all(|xi| xi.abs() < FAR) {
                return None;
            }
            if step[0].abs().max(step[1].abs()) < 1e-14 {
                break;
            }
        }
        Some(xi)
    }

    fn across(&self, xi: [f64; 2], vertex: Vec3) -> Across {
        let ((x, tangents), normal) = (self.at(xi), self.normal(xi).map(|(m, _)| m));
        let way = x - vertex;
        let across = normal.map_or(way, |m| way - m * (m.dot(way) / m.dot(m)));
        Across { tangents, way, normal, across }
    }

    /// Derivatives of the residual along the two coordinates.
    fn slopes(&self, xi: [f64; 2], at: &Across) -> [[f64; 2]; 2] {
        let (k, normal) = (self.second(xi), self.normal(xi).map_or([Vec3::zero(); 2], |(_, slopes)| slopes));
        let [first, second] = [0, 1].map(|b| at.change([k[0][b], k[1][b]], at.tangents[b], normal[b]));
        [[first[0], second[0]], [first[1], second[1]]]
    }

    /// How the foot of a vertex at `xi` moves: what makes up for the change of its residual.
    pub fn foot_rates(&self, xi: [f64; 2], vertex: Vec3) -> FootRates {
        let (at, (n, dn), own) = (self.across(xi, vertex), self.face.natural(xi), 3 * self.face.nodes.len());
        let slopes = self.slopes(xi, &at);
        let follow = |change: [f64; 2]| solve(slopes, change).map(|step| -step);
        let normals = self.field.as_ref().map_or_else(|| vec![Vec3::zero(); own], |field| field.rates(&n));
        let along = |(unknown, normal): (usize, Vec3)| {
            let (axis, node) = (axis(unknown % 3), unknown / 3);
            let (moved, tangents) = if unknown < own {
                (axis * n[node], dn[node].map(|dn| axis * dn))
            } else {
                (Vec3::zero(), [Vec3::zero(); 2])
            };
            follow(at.change(tangents, moved, normal))
        };
        let vertex = [0, 1, 2].map(|i| follow(at.change([Vec3::zero(); 2], -axis(i), Vec3::zero())));
        FootRates { own: normals.into_iter().enumerate().map(along).collect(), vertex }
    }
}

impl Across {
    fn residual(&self) -> [f64; 2] {
        self.tangents.map(|g| g.dot(self.across))
    }

    /// Its change with the tangents, the way, and the normal.
    fn change(&self, tangents: [Vec3; 2], way: Vec3, normal: Vec3) -> [f64; 2] {
        let across = self.normal.map_or(way, |m| {
            let (size, part) = (m.dot(m), m.dot(self.way) / m.dot(m));
            way - normal * part - m * ((normal.dot(self.way) + m.dot(way) - 2.0 * part * m.dot(normal)) / size)
        });
        [0, 1].map(|a| tangents[a].dot(self.across) + self.tangents[a].dot(across))
    }
}

/// The change of the unit vector along `m` with that of `m`.
fn bent(m: Vec3, change: Vec3) -> Vec3 {
    let unit = m.unit();
    (change - unit * unit.dot(change)) * m.norm().recip()
}

/// The solution of two linear equations.
fn solve([[p, q], [r, s]]: [[f64; 2]; 2], [a, b]: [f64; 2]) -> [f64; 2] {
    let size = 1.0 / (p * s - q * r);
    [(a * s - b * q) * size, (b * p - a * r) * size]
}
