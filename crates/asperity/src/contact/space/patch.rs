//! A face of a body as a facet: flat triangles and bilinear quadrilaterals as tools have them, and faces of second
//! degree, `x(s) = N_k(s) x_k`.
//!
//! Across a ray two equations are left for the two coordinates; Newton's method solves them from the middle of the face
//! and of its quarters, each being so little bent that it finds what is near. The coordinates `s` run from 0 to 1.

use super::surface::{Face, MAX_NODES, natural};
use crate::mesh::cells::Cell;
use crate::tensor::Vec3;
use crate::tool::space::{Facet, Meeting, Quad, Triangle};
use crate::tool::{Bounds, Ray};

/// A face with its nodes in place.
#[derive(Debug, Clone, Copy)]
pub enum Patch {
    /// Three nodes.
    Triangle(Triangle),
    /// Four nodes.
    Quad(Quad),
    /// Six, eight or nine nodes.
    Curved(Curved),
}

/// A face of second degree.
#[derive(Debug, Clone, Copy)]
pub struct Curved {
    kind: &'static Cell,
    x: [Vec3; MAX_NODES],
}

/// Most iterations for a meeting,
const ITERATIONS: usize = 25;
/// the step at which they end, in `s`,
const END: f64 = 1e-13;
/// and how far outside the face they may lead.
const STRAY: f64 = 2.0;

impl Patch {
    /// Of the given kind through nodes at `x`.
    pub fn through(kind: &'static Cell, x: [Vec3; MAX_NODES]) -> Self {
        let [a, b, c, d, ..] = x;
        match kind.nodes.len() {
            3 => Self::Triangle(Triangle([a, b, c])),
            4 => Self::Quad(Quad([a, b, c, d])),
            _ => Self::Curved(Curved { kind, x }),
        }
    }
    /// Where corner number `k` is.
    pub fn corner(&self, k: usize) -> Vec3 {
        match self {
            Self::Triangle(Triangle(x)) => x[k],
            Self::Quad(Quad(x)) => x[k],
            Self::Curved(curved) => curved.x[k],
        }
    }
    /// Outward unit normal at its middle.
    pub fn normal(&self) -> Vec3 {
        let middle = match self {
            Self::Triangle(_) => [1.0 / 3.0; 2],
            Self::Quad(_) => [0.5; 2],
            Self::Curved(curved) => curved.middle(),
        };
        self.facet().normal(middle)
    }
    /// What it is to a ray.
    pub fn facet(&self) -> &dyn Facet {
        match self {
            Self::Triangle(triangle) => triangle,
            Self::Quad(quad) => quad,
            Self::Curved(curved) => curved,
        }
    }
}

/// Whether a face has three corners.
fn is_triangle(kind: &Cell) -> bool {
    kind.linear.nodes.len() == 3
}

impl Face {
    /// Shape functions at `s`, each from 0 to 1, and their derivatives along `s`.
    pub fn shape_at(&self, s: [f64; 2]) -> ([f64; MAX_NODES], [[f64; 2]; MAX_NODES]) {
        shape(self.kind, s)
    }
}

impl Face {
    /// A place given by `s`, each from 0 to 1, in the face's own coordinates.
    pub fn own_place(&self, s: [f64; 2]) -> [f64; 2] {
        if is_triangle(self.kind) { s } else { s.map(|s| 2.0 * s - 1.0) }
    }
}

fn shape(kind: &Cell, s: [f64; 2]) -> ([f64; MAX_NODES], [[f64; 2]; MAX_NODES]) {
    let (scale, from) = if is_triangle(kind) { (1.0, 0.0) } else { (2.0, -1.0) };
    let (n, dn) = natural(kind, s.map(|s| from + scale * s));
    (n, dn.map(|dn| dn.map(|slope| scale * slope)))
}

impl Curved {
    fn middle(&self) -> [f64; 2] {
        if is_triangle(self.kind) { [1.0 / 3.0; 2] } else { [0.5; 2] }
    }

    fn sum(&self, weights: impl Iterator<Item = f64>) -> Vec3 {
        self.x.iter().zip(weights).fold(Vec3::zero(), |sum, (&x, weight)| sum + x * weight)
    }

    fn place(&self, s: [f64; 2]) -> (Vec3, [Vec3; 2]) {
        let (n, dn) = shape(self.kind, s);
        (self.sum(n.into_iter()), [0, 1].map(|i| self.sum(dn.iter().map(|dn| dn[i]))))
    }

    /// The meeting that Newton's method finds from `s`.
    fn solve(&self, ray: &Ray, mut s: [f64; 2]) -> Option<Meeting> {
        let e = ray.direction;
        for _ in 0..ITERATIONS {
            let (x, [a, b]) = self.place(s);
            let (to, span) = (ray.origin - x, a.cross(b).dot(e));
            let step = [to.cross(b).dot(e) / span, a.cross(to).dot(e) / span];
            s = [s[0] + step[0], s[1] + step[1]];
            // A place that is not a number ends it too.
            if !s.iter().all(|s| (s - 0.5).abs() < STRAY) {
                return None;
            }
            if step[0].abs().max(step[1].abs()) < END {
                return Some(Meeting { u: (self.place(s).0 - ray.origin).dot(e), s });
            }
        }
        None
    }

    /// Points whose box holds the face: its control points as a Bezier patch.
    fn hull(&self) -> impl Iterator<Item = Vec3> {
        let corners = self.kind.linear.nodes.len();
        let x = self.x;
        let all = |range: std::ops::Range<usize>| range.fold(Vec3::zero(), |sum, k| sum + x[k]);
        let middle = match self.kind.nodes.len() {
            8 => Some(all(4..8) - all(0..4) * 0.75),
            9 => Some(x[8] * 4.0 - all(4..8) + all(0..4) * 0.25),
            _ => None,
        };
        let edges = (0..corners).map(move |k| x[corners + k] * 2.0 - (x[k] + x[(k + 1) % corners]) * 0.5);
        x.into_iter().take(corners).chain(edges).chain(middle)
    }
}

impl Facet for Curved {
    fn point(&self, s: [f64; 2]) -> Vec3 {
        self.place(s).0
    }
    fn tangents(&self, s: [f64; 2]) -> [Vec3; 2] {
        self.place(s).1
    }
    fn meet(&self, ray: &Ray, found: &mut dyn FnMut(Meeting)) {
        let starts: &[[f64; 2]] = match is_triangle(self.kind) {
            true => &[[1.0 / 3.0; 2], [1.0 / 6.0; 2], [2.0 / 3.0, 1.0 / 6.0], [1.0 / 6.0, 2.0 / 3.0]],
            false => &[[0.5; 2], [0.25; 2], [0.75, 0.25], [0.75; 2], [0.25, 0.75]],
        };
        let (mut places, mut count) = ([[f64::INFINITY; 2]; 5], 0);
        for &start in starts {
            let Some(meeting) = self.solve(ray, start) else { continue };
            let same = |s: &[f64; 2]| (s[0] - meeting.s[0]).hypot(s[1] - meeting.s[1]) < 1e-8;
            if !places[..count].iter().any(same) {
                (places[count], count) = (meeting.s, count + 1);
                found(meeting);
            }
        }
    }
    fn meet_near(&self, ray: &Ray, near: [f64; 2], found: &mut dyn FnMut(Meeting)) {
        self.solve(ray, near).into_iter().for_each(found);
    }
    fn bounds(&self) -> Bounds {
        Bounds::of(self.hull())
    }
    fn parts(&self, _: f64) -> [usize; 2] {
        [2, 2]
    }
    fn holds(&self, [s, t]: [f64; 2], beyond: f64) -> bool {
        let within = s >= -beyond && t >= -beyond;
        within && if is_triangle(self.kind) { s + t <= 1.0 + beyond } else { s.max(t) <= 1.0 + beyond }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cells::{QUAD8, QUAD9, TRI6};

    /// Numbers in (-1, 1) from a linear congruence (Knuth's MMIX).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Any place on a bent face is found by a ray that crosses it there, and lies in the box.
    #[test]
    fn bent_faces_are_met_where_they_are() {
        for kind in [&TRI6, &QUAD8, &QUAD9] {
            let mut state = 3;
            for _ in 0..400 {
                let mut x = [Vec3::zero(); MAX_NODES];
                for (x, node) in x.iter_mut().zip(kind.nodes) {
                    *x = Vec3(std::array::from_fn(|i| node[i] + 0.08 * random(&mut state)));
                }
                let curved = Curved { kind, x };
                let s = loop {
                    let s = [0, 1].map(|_| 0.5 + 0.5 * random(&mut state));
                    if curved.holds(s, 0.0) {
                        break s;
                    }
                };
                let direction = Vec3::new(0.2 * random(&mut state), 0.2 * random(&mut state), 1.0).unit();
                let (point, u) = (curved.point(s), random(&mut state));
                let ray = Ray { origin: point - direction * u, direction };
                let mut nearest = f64::INFINITY;
                curved.meet(&ray, &mut |place| {
                    assert!((curved.point(place.s) - ray.point(place.u)).norm() < 1e-12, "{}", kind.name);
                    nearest = nearest.min((place.s[0] - s[0]).hypot(place.s[1] - s[1]));
                });
                assert!(nearest < 1e-9, "{} {s:?} {nearest}", kind.name);
                let bounds = curved.bounds();
                assert!((0..3).all(|i| bounds.min[i] <= point[i] && point[i] <= bounds.max[i]), "{}", kind.name);
            }
        }
    }
}
