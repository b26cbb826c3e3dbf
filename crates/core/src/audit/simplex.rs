//! A piece of a boundary: a segment in the plane, a triangle in space. Closest points, the side on which a point lies, and
//! where lines meet it, written out here and nowhere shared with the contact search.

use crate::tensor::Vec3;

/// How far beyond its ends or edges a line still meets it, as a part of its size: none slips between two neighbours.
const EDGE: f64 = 1e-9;

/// A segment (its first two corners, the material on its left) or a triangle (outward by the right-hand rule).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Simplex {
    /// The corners; in the plane the third repeats the second.
    pub corners: [Vec3; 3],
    /// Whether it is a segment of the plane.
    pub plane: bool,
}

/// Where a line meets a simplex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Part of the way from the first to the second point of the line.
    pub part: f64,
    /// Whether the line leads out of the material there.
    pub leaves: bool,
}

impl Simplex {
    /// A segment of the plane.
    pub fn segment(a: Vec3, b: Vec3) -> Self {
        Self { corners: [a, b, b], plane: true }
    }
    /// A triangle in space.
    pub fn triangle(corners: [Vec3; 3]) -> Self {
        Self { corners, plane: false }
    }
    /// The outward normal, with the length of the segment or twice the area of the triangle.
    pub fn normal(&self) -> Vec3 {
        let [a, b, c] = self.corners;
        if self.plane { -(b - a).left() } else { (b - a).cross(c - a) }
    }
    /// The unit outward normal; zero where it has none.
    pub fn direction(&self) -> Vec3 {
        let (n, size) = (self.normal(), self.normal().norm());
        if size > 0.0 { n * size.recip() } else { Vec3::zero() }
    }
    /// The point of it that is closest to `p`.
    pub fn closest(&self, p: Vec3) -> Vec3 {
        let [a, b, c] = self.corners;
        if self.plane { on_segment([a, b], p) } else { on_triangle([a, b, c], p) }
    }
    /// Height of `p` above its line or plane, outward.
    pub fn height(&self, p: Vec3) -> f64 {
        (p - self.corners[0]).dot(self.direction())
    }
    /// Whether the foot of `p` on its line or plane, seen along the normal, lies on it.
    pub fn holds(&self, p: Vec3) -> bool {
        let ([a, b, c], n) = (self.corners, self.normal());
        let size = n.dot(n);
        if size <= 0.0 {
            return false;
        }
        if self.plane {
            let s = (p - a).dot(b - a) / size;
            return (-EDGE..=1.0 + EDGE).contains(&s);
        }
        let part = |from: Vec3, to: Vec3| (to - from).cross(p - from).dot(n) / size;
        part(a, b) >= -EDGE && part(b, c) >= -EDGE && part(c, a) >= -EDGE
    }
    /// Where the straight way from `from` to `to` meets it, its ends included; ways along it do not.
    pub fn crossing(&self, [from, to]: [Vec3; 2]) -> Option<Crossing> {
        let n = self.normal();
        let (begin, end) = ((from - self.corners[0]).dot(n), (to - self.corners[0]).dot(n));
        let leaves = crosses(begin, end)?;
        let part = begin / (begin - end);
        let place = from + (to - from) * part;
        self.holds(place).then_some(Crossing { part, leaves })
    }
}

/// Whether heights at the two ends of a way mean that it goes out (`true`) or in (`false`): a point on the surface is outside.
pub fn crosses(begin: f64, end: f64) -> Option<bool> {
    match (begin >= 0.0, end >= 0.0) {
        (true, false) => Some(false),
        (false, true) => Some(true),
        _ => None,
    }
}

fn on_segment([a, b]: [Vec3; 2], p: Vec3) -> Vec3 {
    let along = b - a;
    let size = along.dot(along);
    let part = if size > 0.0 { ((p - a).dot(along) / size).clamp(0.0, 1.0) } else { 0.0 };
    a + along * part
}

/// The foot on the plane where it lies on the triangle, else the closest point of the three edges.
fn on_triangle(corners: [Vec3; 3], p: Vec3) -> Vec3 {
    let [a, b, c] = corners;
    let n = (b - a).cross(c - a);
    let size = n.dot(n);
    let inside = |from: Vec3, to: Vec3| (to - from).cross(p - from).dot(n) >= 0.0;
    if size > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return p - n * ((p - a).dot(n) / size);
    }
    let feet = [[a, b], [b, c], [c, a]].map(|edge| on_segment(edge, p));
    let off = |q: &Vec3| (*q - p).dot(*q - p);
    feet.into_iter().fold(a, |best, q| if off(&q) < off(&best) { q } else { best })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z)
    }

    fn point() -> impl Strategy<Value = Vec3> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(Vec3)
    }

    #[test]
    fn a_line_through_a_segment_and_a_triangle() {
        let ground = Simplex::segment(at(2.0, 0.0, 0.0), at(0.0, 0.0, 0.0));
        assert_eq!(ground.direction(), at(0.0, 1.0, 0.0), "the material is on the left of the way");
        let down = ground.crossing([at(0.5, 1.0, 0.0), at(0.5, -3.0, 0.0)]);
        assert_eq!(down, Some(Crossing { part: 0.25, leaves: false }));
        assert_eq!(ground.crossing([at(2.5, 1.0, 0.0), at(2.5, -3.0, 0.0)]), None);
        let face = Simplex::triangle([at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 0.0)]);
        let up = face.crossing([at(0.2, 0.2, -1.0), at(0.2, 0.2, 1.0)]);
        assert_eq!(up, Some(Crossing { part: 0.5, leaves: true }));
        assert_eq!(face.crossing([at(0.6, 0.6, -1.0), at(0.6, 0.6, 1.0)]), None);
    }

    proptest! {
        /// Against the best of many points of the triangle.
        #[test]
        fn no_point_of_a_triangle_is_closer_than_the_closest(a in point(), b in point(), c in point(), p in point()) {
            let near = Simplex::triangle([a, b, c]).closest(p);
            let (mut least, count) = (f64::INFINITY, 40);
            for i in 0..=count {
                for j in 0..=count - i {
                    let (s, t) = (f64::from(i) / f64::from(count), f64::from(j) / f64::from(count));
                    least = least.min((a + (b - a) * s + (c - a) * t - p).norm());
                }
            }
            let found = (near - p).norm();
            prop_assert!(found <= least + 1e-12, "{found} {least}");
            prop_assert!(least - found < 0.1);
        }
    }
}
