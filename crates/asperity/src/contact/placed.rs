//! An edge of the surface with its nodes in place: where its points stand, along which tangent, and how both move.
//!
//! The tangent `T = |dx/dxi| e_S` has the length of the edge's own and the direction of the triad: its own, or that of the
//! averaged field `s`, `e_S = s / |s|`. All else of a contact point sees only `T`.

use super::averaged::{Field, MAX_FIELD};
use super::surface::{Edge, MAX_EDGE_NODES, SurfacePoint};
use crate::tensor::Vec3;

/// One end of the covered part, and how it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct End {
    /// Its place on the edge, from -1 to 1.
    pub xi: f64,
    /// Derivatives along the unknowns of the edge's own nodes, and those around that turn its normals.
    pub own: [f64; MAX_FIELD],
    /// Derivatives along the position of the vertex.
    pub vertex: [f64; 2],
}

/// An edge with its nodes in place.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    /// The edge.
    pub edge: &'a Edge,
    /// Positions of its nodes.
    pub x: [Vec3; MAX_EDGE_NODES],
    /// The averaged tangents at its nodes, unless its own are meant.
    pub field: Option<Field<'a>>,
}

/// A place on an edge.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// Position.
    pub x: Vec3,
    /// Its derivative.
    pub slope: Vec3,
    /// The tangent.
    pub tangent: Vec3,
    /// Its derivative.
    pub bend: Vec3,
}

impl Placed<'_> {
    fn sum(&self, weights: &[f64; MAX_EDGE_NODES]) -> Vec3 {
        self.x.iter().zip(weights).fold(Vec3::zero(), |sum, (&x, &weight)| sum + x * weight)
    }

    /// Position, first and second derivative at `xi`; and a vector along the tangent there, and its derivative.
    fn at(&self, xi: f64) -> ([Vec3; 3], [Vec3; 2]) {
        let (n, dn) = self.edge.shape_at(xi);
        let [x, slope, second] = [self.sum(&n), self.sum(&dn), self.sum(&self.edge.curvature)];
        let direction = self.field.as_ref().map(|field| [field.sum(&n), field.sum(&dn)]);
        ([x, slope, second], direction.unwrap_or([slope, second]))
    }

    /// Derivatives of that vector along the unknowns of the nodes, and of those around.
    fn direction_rates(&self, xi: f64) -> [Vec3; MAX_FIELD] {
        let (n, dn) = self.edge.shape_at(xi);
        self.field.as_ref().map_or_else(|| along_axes(&dn), |field| field.rates(&n))
    }

    /// What lies between a place and `vertex`, the direction there, and the slope of their product.
    fn way(&self, xi: f64, vertex: Vec3) -> (Vec3, Vec3, f64) {
        let ([x, t, _], [s, k]) = self.at(xi);
        (x - vertex, s, t.dot(s) + (x - vertex).dot(k))
    }

    /// Where the foot of the normal through `vertex` is: `(x(xi) - x_V).s(xi) = 0`.
    pub fn foot_place(&self, vertex: Vec3) -> f64 {
        let mut xi = 0.0;
        // A straight edge needs one step; one that bends little, a few.
        for _ in 0..20 {
            let (to, s, slope) = self.way(xi, vertex);
            let step = to.dot(s) / slope;
            xi -= step;
            if step.abs() < 1e-15 || !step.is_finite() {
                break;
            }
        }
        xi
    }

    /// The foot of the normal through `vertex`, and how it moves.
    pub fn foot(&self, vertex: Vec3) -> End {
        let xi = self.foot_place(vertex);
        let ((to, s, slope), (n, _)) = (self.way(xi, vertex), self.edge.shape_at(xi));
        let (mut own, turning) = ([0.0; MAX_FIELD], self.direction_rates(xi));
        for (j, (rate, turning)) in own.iter_mut().zip(turning).enumerate() {
            let n = n.get(j / 2).filter(|_| j < 2 * self.edge.nodes.len()).copied().unwrap_or(0.0);
            *rate = -(n * s[j % 2] + to.dot(turning)) / slope;
        }
        End { xi, own, vertex: [s[0] / slope, s[1] / slope] }
    }

    /// Position and tangent of a point, the tangent along the part that it stands for.
    pub fn stand(&self, spot: &SurfacePoint) -> (Vec3, Vec3) {
        let (a, tangent) = spot.place(&self.x[..self.edge.nodes.len()]);
        match &self.field {
            None => (a, tangent),
            Some(field) => (a, field.sum(&spot.n).unit() * tangent.norm()),
        }
    }

    /// Whether the averaged normal at a point looks to the side to which its edge looks.
    pub fn is_upright(&self, spot: &SurfacePoint, tangent: Vec3) -> bool {
        self.field.is_none() || tangent.dot(self.sum(&spot.dn)) > 0.0
    }

    /// Derivatives of the tangent of a point along the unknowns of the nodes, and of those around:
    /// `dT = e (t.dt) / |t| + |t| (ds - e (e.ds)) / |s|` with `t` the edge's own.
    pub fn turning(&self, spot: &SurfacePoint) -> [Vec3; MAX_FIELD] {
        let (mut rates, Some(field)) = (along_axes(&spot.dn), &self.field) else { return along_axes(&spot.dn) };
        let (t, s) = (self.sum(&spot.dn), field.sum(&spot.n));
        let (length, e) = (t.norm(), s.unit());
        let part = length / s.norm();
        for (rate, turned) in rates.iter_mut().zip(field.rates(&spot.n)) {
            *rate = e * (t.dot(*rate) / length) + (turned - e * e.dot(turned)) * part;
        }
        rates
    }

    /// A place on the edge.
    pub fn frame(&self, xi: f64) -> Frame {
        let ([x, slope, second], [s, k]) = self.at(xi);
        if self.field.is_none() {
            return Frame { x, slope, tangent: slope, bend: second };
        }
        let (length, e) = (slope.norm(), s.unit());
        let turned = (k - e * e.dot(k)) * (length / s.norm());
        Frame { x, slope, tangent: e * length, bend: e * (slope.dot(second) / length) + turned }
    }
}

/// The vectors `w_k` along each axis, for each unknown of the nodes of an edge.
fn along_axes(weights: &[f64; MAX_EDGE_NODES]) -> [Vec3; MAX_FIELD] {
    let mut rates = [Vec3::zero(); MAX_FIELD];
    for (k, rate) in rates[..2 * MAX_EDGE_NODES].iter_mut().enumerate() {
        rate[k % 2] = weights[k / 2];
    }
    rates
}
