//! Convex polygons in the coordinates of a face, cut by lines, and the affine map that lays a quadrature rule on one.
//!
//! With area `A`, centroid `c` and covariance `C` of the polygon, and `A0`, `c0`, `C0` those of the whole face, the map is
//! `c + C^(1/2) C0^(-1/2) (xi - c0)`, the weights times `A / A0`. A rule of degree two or more then integrates
//! polynomials of degree two exactly over any polygon, and on a part cut off along the face's coordinates it is the rule
//! of that part, with all of its degree. All is a function of the vertices, generic in the numbers.

use crate::mesh::cells::{QUAD4, TRI3};
use crate::tensor::Scalar;
use std::sync::LazyLock;

/// Coordinates on a face.
pub type Point<T> = [T; 2];

/// Most vertices: four and one more for each cut.
const MOST: usize = 10;

/// Distance from a line within which a vertex is on it, where faces have sizes of about one.
const ON: f64 = 1e-11;

/// A determinant of the covariance below this part of the square of its trace is lost in rounding, which leaves either sign: of a strip a
/// millionth as wide as it is long.
const STRIP: f64 = 1e-12;

/// A convex polygon, its vertices counter-clockwise.
#[derive(Debug, Clone, Copy)]
pub struct Polygon<T> {
    vertices: [Point<T>; MOST],
    count: usize,
}

/// How far a point lies to the left of the line from `a` to `b`, times the length of `ab`.
pub fn left_of<T: Scalar>([a, b]: [Point<T>; 2], p: Point<T>) -> T {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// Area, centroid and covariance (xx, xy, yy).
#[derive(Debug, Clone, Copy)]
pub struct Moments<T> {
    /// Area.
    pub area: T,
    /// Centroid.
    pub centre: Point<T>,
    spread: [T; 3],
}

impl<T: Scalar> Polygon<T> {
    /// The whole of a face with so many corners.
    pub fn whole(corners: usize) -> Self {
        let cell = if corners == 3 { &TRI3 } else { &QUAD4 };
        Self::of(cell.nodes.iter().map(|&[a, b, _]| [a, b].map(T::from)))
    }

    /// Of so many vertices, counter-clockwise.
    pub fn of(vertices: impl IntoIterator<Item = Point<T>>) -> Self {
        let mut polygon = Self { vertices: [[T::zero(); 2]; MOST], count: 0 };
        vertices.into_iter().for_each(|vertex| polygon.push(vertex));
        polygon
    }

    /// Its vertices.
    pub fn vertices(&self) -> &[Point<T>] {
        &self.vertices[..self.count]
    }

    /// Adds a vertex.
    pub fn push(&mut self, vertex: Point<T>) {
        if self.count < MOST {
            self.vertices[self.count] = vertex;
            self.count += 1;
        }
    }

    /// Its edges.
    pub fn edges(&self) -> impl Iterator<Item = [Point<T>; 2]> + '_ {
        (0..self.count).map(|i| [self.vertices[i], self.vertices[(i + 1) % self.count]])
    }

    /// What of it lies to the left of a line, where vertices within the part [`ON`] of the line's length are on it: common
    /// edges of two polygons make no sliver, whose vertices would run along them.
    pub fn clip(&self, line: [Point<T>; 2]) -> Self {
        let [x, y] = [0, 1].map(|i| line[1][i].re() - line[0][i].re());
        let near = ON * (x * x + y * y).max(f64::MIN_POSITIVE).sqrt();
        let side = |off: T| if off.re().abs() <= near { 0.0 } else { off.re().signum() };
        let mut part = Self { count: 0, ..*self };
        for [p, q] in self.edges() {
            let (here, there) = (left_of(line, p), left_of(line, q));
            if side(here) >= 0.0 {
                part.push(p);
            }
            if side(here) * side(there) < 0.0 {
                let at = here / (here - there);
                part.push([0, 1].map(|i| p[i] + (q[i] - p[i]) * at));
            }
        }
        part
    }

    /// Integrals of the [`monomials`] about a point.
    pub fn integrals(&self, o: Point<f64>) -> [T; INTEGRALS] {
        let mut sums = [T::zero(); INTEGRALS];
        for edge in self.edges() {
            let [p, q] = edge.map(|p| [p[0] - T::from(o[0]), p[1] - T::from(o[1])]);
            let cross = p[0] * q[1] - p[1] * q[0];
            sums[0] += cross * 0.5;
            (0..2).for_each(|i| sums[1 + i] += cross * (p[i] + q[i]) * (1.0 / 6.0));
            for (k, (i, j)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                let product = p[i] * p[j] + q[i] * q[j] + (p[i] + q[i]) * (p[j] + q[j]);
                sums[3 + k] += cross * product * (1.0 / 24.0);
            }
        }
        sums
    }

    /// Its moments; the area is zero where nothing is left.
    pub fn moments(&self) -> Moments<T> {
        let o: [f64; 2] = self.vertices[0].map(T::re);
        Moments::of(self.integrals(o), o)
    }
}

/// How many integrals have the moments of a part of a face.
pub const INTEGRALS: usize = 6;

/// What is integrated: 1, x, y, xx, xy and yy.
pub fn monomials([x, y]: Point<f64>) -> [f64; INTEGRALS] {
    [1.0, x, y, x * x, x * y, y * y]
}

impl<T: Scalar> Moments<T> {
    /// From integrals of the [`monomials`] about a point.
    pub fn of([area, x, y, xx, xy, yy]: [T; INTEGRALS], o: Point<f64>) -> Self {
        let c = [x / area, y / area];
        let spread = [xx / area - c[0] * c[0], xy / area - c[0] * c[1], yy / area - c[1] * c[1]];
        Self { area, centre: [c[0] + T::from(o[0]), c[1] + T::from(o[1])], spread }
    }
    fn is_strip(&self) -> bool {
        let [a, b, c] = self.spread.map(T::re);
        a * c - b * b <= STRIP * (a + c).powi(2)
    }
    /// The symmetric root of the covariance: xx, xy, yy. `(C + s I) / t` with `s^2 = det C`, `t^2 = tr C + 2 s`; of a strip `s` is zero,
    /// and its places lie on a line.
    fn root(&self) -> [T; 3] {
        let [a, b, c] = self.spread;
        let s = if self.is_strip() { T::zero() } else { (a * c - b * b).sqrt() };
        let t = (a + c + s * 2.0).sqrt().recip();
        [(a + s) * t, b * t, (c + s) * t]
    }
}

/// Radii of the rings of the rule of third degree where the covariance is one, and how many places each has. The outer one lies on any
/// convex polygon (Kannan, Lovasz & Simonovits, Discrete Comput. Geom. 13, 1995), and alone has the moments up to the second.
const RINGS: [(f64, usize); 2] = [(std::f64::consts::SQRT_2, 7), (0.5 * std::f64::consts::SQRT_2, 5)];

/// Cosines and sines of the places of a ring, and of three times their angles.
static HARMONICS: LazyLock<[Vec<[f64; 4]>; 2]> = LazyLock::new(|| {
    RINGS.map(|(_, count)| {
        let angles = (0..count).map(|k| std::f64::consts::TAU * k as f64 / count as f64);
        angles.map(|angle| [angle.cos(), angle.sin(), (3.0 * angle).cos(), (3.0 * angle).sin()]).collect()
    })
});

impl<T: Scalar> Polygon<T> {
    /// Places and areas of a rule that is exact up to the third degree: on two rings in the frame of the symmetric root of the covariance,
    /// with weights of the first and the third harmonic that have the third moments.
    pub fn cubic(&self) -> impl Iterator<Item = (Point<T>, T)> {
        let to = self.moments();
        let [a, b, c] = to.root();
        let det = a * c - b * b;
        let mut third = [T::zero(); 4];
        if !to.is_strip() {
            let whitened = |v: Point<T>| {
                let [x, y] = [0, 1].map(|i| v[i] - to.centre[i]);
                [(c * x - b * y) / det, (a * y - b * x) / det]
            };
            for edge in self.edges() {
                let [p, q] = edge.map(whitened);
                let part = (p[0] * q[1] - p[1] * q[0]) * det / (to.area * 60.0);
                for (sum, [i, j, k]) in third.iter_mut().zip([[0, 0, 0], [0, 0, 1], [0, 1, 1], [1, 1, 1]]) {
                    let ends = p[i] * p[j] * p[k] + q[i] * q[j] * q[k];
                    *sum += part * ((p[i] + q[i]) * (p[j] + q[j]) * (p[k] + q[k]) + ends * 2.0);
                }
            }
        }
        let [xxx, xxy, xyy, yyy] = third;
        let ([(outer, many), (inner, few)], first) = (RINGS, [xxx + xyy, yyy + xxy]);
        let last = [xxx - xyy * 3.0, xxy * 3.0 - yyy].map(|sum| sum * (2.0 / (many as f64 * outer.powi(3))));
        let large = first.map(|sum| sum * (2.0 / (many as f64 * outer * (outer * outer - inner * inner))));
        let small = large.map(|part| part * (-(many as f64) * outer / (few as f64 * inner)));
        let rings = [(outer, 1.0 / many as f64, large, last), (inner, 0.0, small, [T::zero(); 2])];
        rings.into_iter().zip(&*HARMONICS).flat_map(move |((radius, mean, one, three), places)| {
            places.iter().map(move |&[x, y, x3, y3]| {
                let weight = one[0] * x + one[1] * y + three[0] * x3 + three[1] * y3;
                let place = [(a * x + b * y) * radius + to.centre[0], (b * x + c * y) * radius + to.centre[1]];
                (place, to.area * (weight + mean))
            })
        })
    }
}

/// The map from a whole face to a part of it.
#[derive(Debug, Clone, Copy)]
pub struct PartMap<T> {
    from: Moments<f64>,
    to: Moments<T>,
    map: [[T; 2]; 2],
}

impl<T: Scalar> PartMap<T> {
    /// From the face with so many corners to a part of it.
    pub fn new(corners: usize, to: Moments<T>) -> Self {
        let from = Polygon::<f64>::whole(corners).moments();
        let ([a, b, c], [p, q, r]) = (from.root(), to.root());
        let inverse = [c, -b, a].map(|x| x / (a * c - b * b));
        let [i, j, k] = inverse;
        Self { from, to, map: [[p * i + q * j, p * j + q * k], [q * i + r * j, q * j + r * k]] }
    }
    /// Where a point of the rule comes to lie.
    pub fn place(&self, xi: [f64; 2]) -> Point<T> {
        let d = [xi[0] - self.from.centre[0], xi[1] - self.from.centre[1]];
        [0, 1].map(|i| self.to.centre[i] + self.map[i][0] * d[0] + self.map[i][1] * d[1])
    }
    /// Ratio of the areas.
    pub fn share(&self) -> T {
        self.to.area * (1.0 / self.from.area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cells::{QUAD4, TRI3};

    /// Strips along the edges of a face, down to those that are left out, have places in them.
    #[test]
    fn strips_have_places() {
        let corners: [Point<f64>; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        for (k, power, tilt) in (0..3).flat_map(|k| (4..10).flat_map(move |p| (0..50).map(move |t| (k, p, t)))) {
            let [a, b] = [corners[k], corners[(k + 1) % 3]];
            let (width, normal) = (10.0_f64.powi(-power), [a[1] - b[1], b[0] - a[0]]);
            let inward = |p: Point<f64>, by: f64| [0, 1].map(|i| p[i] + normal[i] * width * by);
            let part = Polygon::whole(3).clip([inward(b, 1.0), inward(a, f64::from(tilt) / 49.0)]);
            let laid = PartMap::new(3, part.moments());
            for &[x, y, _] in TRI3.gauss[1].unwrap().points {
                let place = laid.place([x, y]);
                // Rounding in their integrals is that of their vertices.
                let off = left_of([a, b], place);
                assert!(off.abs() < 2.0 * width + 1e-7, "{k} {power} {tilt}: {place:?} {off}");
            }
            for (place, area) in part.cubic() {
                let off = left_of([a, b], place);
                assert!(off.abs() < 2.0 * width + 1e-7, "{k} {power} {tilt}: {place:?} {off}");
                assert!(area.abs() < 2.0 * part.moments().area, "{k} {power} {tilt}: {area}");
            }
        }
    }

    /// Monomials up to the third degree, against Gauss' rule of the fourth on fans of triangles; all places lie on the part.
    #[test]
    fn the_cubic_rule_is_exact_on_any_part() {
        let fan = TRI3.gauss[2].unwrap();
        for angle in (0..40).map(|k| 0.37 * f64::from(k)) {
            let line = |off: f64, turn: f64| {
                let [x, y] = [(angle + turn).cos(), (angle + turn).sin()];
                [[0.1 - off * y, 0.2 + off * x], [0.1 - off * y + x, 0.2 + off * x + y]]
            };
            let whole = Polygon::<f64>::whole(if angle < 7.0 { 3 } else { 4 });
            let part = whole.clip(line(-0.2, 0.0)).clip(line(-0.3, 1.3 + 0.02 * angle));
            let places: Vec<_> = part.cubic().collect();
            for (i, j) in (0..4).flat_map(|i| (0..4 - i).map(move |j| (i, j))) {
                let f = |p: Point<f64>| p[0].powi(i) * p[1].powi(j);
                let first = part.vertices[0];
                let exact: f64 = part
                    .edges()
                    .map(|[p, q]| {
                        let at =
                            |x: f64, y: f64| [0, 1].map(|k| first[k] + x * (p[k] - first[k]) + y * (q[k] - first[k]));
                        let points = fan.points.iter().zip(fan.weights);
                        left_of([first, p], q) * points.map(|(&[x, y, _], w)| w * f(at(x, y))).sum::<f64>()
                    })
                    .sum();
                let found: f64 = places.iter().map(|&(place, area)| area * f(place)).sum();
                assert!((found - exact).abs() < 1e-14, "{angle} {i} {j}: {found} {exact}");
            }
            let inside = |p: Point<f64>| part.edges().all(|edge| left_of(edge, p) > -1e-12);
            assert!(places.iter().all(|&(place, _)| inside(place)), "{angle}");
        }
    }

    /// Integrals of monomials over a polygon by the rule laid on it, against Gauss' rule on fans of triangles.
    #[test]
    fn rules_of_second_degree_stay_exact_on_any_part() {
        let lines: [&[[Point<f64>; 2]]; 4] = [
            &[],
            &[[[0.3, 1.0], [0.3, -1.0]], [[-1.0, 0.45], [1.0, 0.45]].map(|[x, y]: [f64; 2]| [-x, y])],
            &[[[0.5, 0.3], [-0.2, 0.9]]],
            &[[[0.6, 0.1], [0.1, 0.8]], [[-0.1, 0.1], [0.7, -0.05]].map(|[x, y]: [f64; 2]| [x, y])],
        ];
        for (corners, cell) in [(3, &TRI3), (4, &QUAD4)] {
            let rule = cell.gauss[1].unwrap();
            for cuts in lines {
                let part = cuts.iter().fold(Polygon::whole(corners), |part, &line| part.clip(line));
                let laid = PartMap::new(corners, part.moments());
                assert!(part.moments().area > 1e-3);
                for (i, j) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)] {
                    let f = |p: Point<f64>| p[0].powi(i) * p[1].powi(j);
                    let share = laid.share();
                    let points = rule.points.iter().zip(rule.weights);
                    let found: f64 = points.map(|(&[x, y, _], w)| share * w * f(laid.place([x, y]))).sum();
                    let first = part.vertices[0];
                    let exact: f64 = part
                        .edges()
                        .map(|[p, q]| {
                            let middle = |a: Point<f64>, b: Point<f64>| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
                            let sum = f(middle(first, p)) + f(middle(p, q)) + f(middle(q, first));
                            0.5 * left_of([first, p], q) * sum / 3.0
                        })
                        .sum();
                    assert!((found - exact).abs() < 1e-14, "{corners} {cuts:?} {i} {j}: {found} {exact}");
                }
                let inside = |p: Point<f64>| part.edges().all(|edge| left_of(edge, p) > 0.0);
                assert!(rule.points.iter().all(|&[x, y, _]| inside(laid.place([x, y]))), "{corners} {cuts:?}");
            }
        }
    }
}
