//! The part of one face that sees another, as a polygon with a quadrature (Puso & Laursen, CMAME 193, 2004).
//!
//! Both faces are projected on a plane through the middle of the face of the surface, across its mean normal; the face that
//! is seen cuts the other one's polygon, on which the rule of the face is laid by area, centroid and covariance. These change
//! smoothly where an edge of one face runs along one of the other, while the vertex in which they meet runs far: a rule on
//! triangles between the vertices has derivatives there that hold for no step worth taking. Coordinates in the plane are those
//! of the face's affine part, `x = c + alpha a + beta b`: of a triangle its own, of a quadrilateral `(alpha, beta) =
//! (xi, eta) + h xi eta` with its twist `h`, solved for `(xi, eta)` at each point of the rule. All is a function of the
//! corners of both, generic in the numbers. Faces of second degree are laid out between their corners.

use super::polygon::{PartMap, Polygon, left_of};
use crate::mesh::cells::{QUAD4, TRI3};
use crate::tensor::{Scalar, Vec3};

/// Coordinates of the corners of two faces.
pub const DIRECTIONS: usize = 24;
/// Most corners of a face.
const CORNERS: usize = 4;
/// Parts of a face smaller than this share of it are left out.
const LEAST: f64 = 1e-9;

/// A place of a rule on a part of a face, with the area in reference coordinates that it stands for.
#[derive(Debug, Clone, Copy)]
pub struct Spread<T> {
    /// Reference coordinates.
    pub xi: [T; 2],
    /// Area.
    pub weight: T,
}

/// A face as it lies in its own plane.
struct FlatFace<T> {
    middle: Vec3<T>,
    /// Vectors whose products with `x - middle` are the coordinates in the plane.
    duals: [Vec3<T>; 2],
    /// The twist of a quadrilateral in these coordinates.
    twist: Option<[T; 2]>,
}

impl<T: Scalar> FlatFace<T> {
    fn new(x: &[Vec3<T>]) -> Self {
        let (middle, a, b, h) = match *x {
            [p, q, r, s] => {
                let quarter = T::from(0.25);
                let sum = |i: f64, j: f64, k: f64, l: f64| {
                    (p * T::from(i) + q * T::from(j) + r * T::from(k) + s * T::from(l)) * quarter
                };
                let twist = sum(1.0, -1.0, 1.0, -1.0);
                (sum(1.0, 1.0, 1.0, 1.0), sum(-1.0, 1.0, 1.0, -1.0), sum(-1.0, -1.0, 1.0, 1.0), Some(twist))
            }
            [p, q, r, ..] => (p, q - p, r - p, None),
            _ => (Vec3::zero(), Vec3::zero(), Vec3::zero(), None),
        };
        let n = a.cross(b);
        let size = n.dot(n).recip();
        let duals = [b.cross(n) * size, n.cross(a) * size];
        Self { middle, duals, twist: h.map(|h| duals.map(|dual| dual.dot(h))) }
    }

    fn coordinates(&self, x: Vec3<T>) -> [T; 2] {
        self.duals.map(|dual| dual.dot(x - self.middle))
    }

    /// The polygon of the face itself.
    fn outline(&self) -> Polygon<T> {
        let Some(h) = self.twist else { return Polygon::whole(3) };
        let twisted = |s: &[f64; 2]| [0, 1].map(|i| h[i] * (s[0] * s[1]) + T::from(s[i]));
        Polygon::of(Polygon::whole(CORNERS).vertices().iter().map(twisted))
    }

    /// Reference coordinates of a place in the plane, and what of their area one of the plane's is.
    fn pull_back(&self, p: [T; 2]) -> ([T; 2], T) {
        let Some(h) = self.twist else { return (p, T::one()) };
        let (g, q) = (h.map(T::re), p.map(T::re));
        let mut xi = q;
        for _ in 0..ITERATIONS {
            let d = step(g, xi, [0, 1].map(|i| xi[i] + g[i] * xi[0] * xi[1] - q[i]));
            (0..2).for_each(|i| xi[i] -= d[i]);
            if d.iter().all(|d| d.abs() < 1e-15) {
                break;
            }
        }
        // One step with derivatives, at the solution.
        let d = step(g, xi, [0, 1].map(|i| h[i] * (xi[0] * xi[1]) + T::from(xi[i]) - p[i]));
        let xi = [0, 1].map(|i| T::from(xi[i]) - d[i]);
        (xi, (h[0] * xi[1] + h[1] * xi[0] + 1.0).recip())
    }
}

/// What the matrix `[1 + g0 eta, g0 xi; g1 eta, 1 + g1 xi]` makes `r` of.
fn step<T: Scalar>(g: [f64; 2], xi: [f64; 2], r: [T; 2]) -> [T; 2] {
    let det = 1.0 + g[0] * xi[1] + g[1] * xi[0];
    [
        r[0] * ((1.0 + g[1] * xi[0]) / det) - r[1] * (g[0] * xi[0] / det),
        r[1] * ((1.0 + g[0] * xi[1]) / det) - r[0] * (g[1] * xi[1] / det),
    ]
}

/// Iterations for the coordinates of a place on a quadrilateral.
const ITERATIONS: usize = 20;

/// The polygon of face `own`, in its plane, that sees face `other`; none if that looks away or elsewhere.
fn common<T: Scalar>(flat: &FlatFace<T>, other: &[Vec3<T>]) -> Option<Polygon<T>> {
    let mut seen = [[T::zero(); 2]; CORNERS];
    let count = other.len().min(CORNERS);
    // Faces that look at each other run around in opposite directions.
    for (vertex, &x) in seen.iter_mut().zip(other.iter().rev()) {
        *vertex = flat.coordinates(x);
    }
    let seen = &seen[..count];
    let turns = (1..count - 1).map(|k| left_of([seen[0], seen[k]], seen[k + 1]).re()).sum::<f64>();
    let mut part = flat.outline();
    let whole = part.moments().area.re();
    if turns <= LEAST * whole {
        return None;
    }
    for k in 0..count {
        part = part.clip([seen[k], seen[(k + 1) % count]]);
    }
    (part.moments().area.re() > LEAST * whole).then_some(part)
}

/// Calls `take` with the places of a rule on the part of face `own` that sees face `other`, given by their corners: of second degree, or
/// where functions are `cubic`, as on quadrilaterals with eight nodes, of third. All lie on the part (see [`Polygon::cubic`]): those of a
/// higher rule would lie beyond the face, where its functions are not known.
pub fn spread<T: Scalar>(cubic: bool, own: &[Vec3<T>], other: &[Vec3<T>], mut take: impl FnMut(Spread<T>)) {
    let flat = FlatFace::new(own);
    let Some(part) = common(&flat, other) else { return };
    let mut lay = |place, area: T, weight: f64| {
        let (xi, density) = flat.pull_back(place);
        take(Spread { xi, weight: area * density * weight });
    };
    if cubic {
        part.cubic().for_each(|(place, area)| lay(place, area, 1.0));
    } else {
        let laid = PartMap::new(own.len(), part.moments());
        rule(1, own.len()).for_each(|place| lay(laid.place(place.xi), laid.share(), place.weight));
    }
}

/// Reference coordinates of the place of a face, given by its corners, over which a point lies.
pub fn foot(own: &[Vec3], x: Vec3) -> [f64; 2] {
    let flat = FlatFace::new(own);
    flat.pull_back(flat.coordinates(x)).0
}

/// A part of a face, in its plane: its vertices and its centroid in reference coordinates come first.
pub struct PolygonPart {
    flat: FlatFace<f64>,
    polygon: Polygon<f64>,
    places: Vec<[f64; 2]>,
}

impl PolygonPart {
    /// Of face `own` where it sees face `other`, given by their corners.
    pub fn new(own: &[Vec3], other: &[Vec3]) -> Option<Self> {
        let flat = FlatFace::new(own);
        let polygon = common(&flat, other)?;
        let places =
            polygon.vertices().iter().chain([&polygon.moments().centre]).map(|&p| flat.pull_back(p).0).collect();
        Some(Self { flat, polygon, places })
    }

    /// Its vertices and then its centroid, in reference coordinates.
    pub fn places(&self) -> &[[f64; 2]] {
        &self.places
    }

    /// Places all over it, by a rule of the interval from -1 to 1 laid on triangles about one of its vertices, two of whose
    /// sides it is drawn together to.
    pub fn spread(&self, rule: &[(f64, f64)]) -> impl Iterator<Item = Spread<f64>> {
        let vertices = self.polygon.vertices();
        let triangles = (2..vertices.len()).map(|k| [vertices[0], vertices[k - 1], vertices[k]]);
        triangles.flat_map(move |[o, a, b]| {
            let twice = left_of([o, a], b);
            rule.iter().flat_map(move |&(s, ws)| {
                rule.iter().map(move |&(t, wt)| {
                    let (r, q) = (0.5 * (s + 1.0), 0.5 * (t + 1.0));
                    let at = [0, 1].map(|i| o[i] + r * (a[i] - o[i] + q * (b[i] - a[i])));
                    let (xi, density) = self.flat.pull_back(at);
                    Spread { xi, weight: 0.25 * ws * wt * r * twice * density }
                })
            })
        })
    }

    /// Whether it covers more than half of another.
    pub fn covers(&self, other: &Self) -> bool {
        let both = other.polygon.edges().fold(self.polygon, |part, edge| part.clip(edge));
        both.moments().area > 0.5 * other.polygon.moments().area
    }
}

/// Reference coordinates and areas of the places of a rule on a whole face with so many corners.
pub fn whole(corners: usize) -> impl Iterator<Item = Spread<f64>> {
    rule(2, corners)
}

fn rule(order: usize, corners: usize) -> impl Iterator<Item = Spread<f64>> {
    let cell = if corners == 3 { &TRI3 } else { &QUAD4 };
    let rule = cell.gauss[order].into_iter();
    rule.flat_map(|rule| {
        rule.points.iter().zip(rule.weights).map(|(&[a, b, _], &weight)| Spread { xi: [a, b], weight })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tensor::Dual;

    fn quad() -> [Vec3; 4] {
        [[0.0, 0.0, 0.0], [1.0, 0.1, 0.1], [1.2, 0.9, -0.1], [-0.1, 1.1, 0.05]].map(Vec3)
    }

    /// Four faces that tile what a face sees cover each of its places once.
    #[test]
    fn tiles_cover_a_face_once() {
        let grid = |i: usize, j: usize| {
            Vec3::new(-0.7 + 1.1 * i as f64 + 0.07 * j as f64, -0.6 + j as f64 - 0.1 * i as f64, 0.2 * (i * j) as f64)
        };
        let (mut area, mut moments, mut faces) = (0.0, [0.0; 2], 0);
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let other = [grid(i, j), grid(i, j + 1), grid(i + 1, j + 1), grid(i + 1, j)];
            let before = area;
            spread(true, &quad(), &other, |place| {
                area += place.weight;
                (0..2).for_each(|k| moments[k] += place.weight * place.xi[k]);
            });
            faces += usize::from(area > before);
        }
        // The density of a twisted face is rational.
        assert!((area - 4.0).abs() < 1e-3, "{area}");
        assert!(moments.iter().all(|m| m.abs() < 3e-3) && faces >= 4, "{moments:?} {faces}");
    }

    /// Derivatives against central differences.
    #[test]
    fn derivatives_of_polygons_are_exact() {
        let other = [[0.3, -0.4, 0.1], [0.2, 0.7, 0.15], [1.4, 0.8, 0.2], [1.5, -0.5, 0.1]].map(Vec3);
        let pairs = [(4, 4), (4, 3), (3, 4), (3, 3)];
        for ((own, seen), cubic) in pairs.into_iter().flat_map(|pair| [(pair, false), (pair, true)]) {
            type D = Dual<DIRECTIONS>;
            let lift = |x: &[Vec3], first: usize| -> Vec<Vec3<D>> {
                let place =
                    |(k, x): (usize, &Vec3)| Vec3(std::array::from_fn(|i| D::variable(x[i], first + 3 * k + i)));
                x.iter().enumerate().map(place).collect()
            };
            let mut exact = Vec::new();
            spread(cubic, &lift(&quad()[..own], 0), &lift(&other[..seen], 12), |place| exact.push(place));
            assert!(!exact.is_empty());
            for k in 0..DIRECTIONS {
                let at = |h: f64| {
                    let (mut own_x, mut other_x) = (quad(), other);
                    if k < 12 {
                        own_x[k / 3][k % 3] += h
                    } else {
                        other_x[k / 3 - 4][k % 3] += h
                    }
                    let mut places = Vec::new();
                    spread(cubic, &own_x[..own], &other_x[..seen], |place| places.push(place));
                    places
                };
                let (up, down) = (at(1e-6), at(-1e-6));
                for ((up, down), exact) in up.iter().zip(&down).zip(&exact) {
                    let slope = |up: f64, down: f64| (up - down) / 2e-6;
                    assert!((slope(up.weight, down.weight) - exact.weight.du[k]).abs() < 1e-7);
                    for i in 0..2 {
                        assert!((slope(up.xi[i], down.xi[i]) - exact.xi[i].du[k]).abs() < 1e-7);
                    }
                }
            }
        }
    }
}
