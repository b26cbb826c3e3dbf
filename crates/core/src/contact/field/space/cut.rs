//! The part of a face that lies over a smooth piece of a tool in space, by its integrals of second degree.
//!
//! A grid on the face tells where the piece is seen; where the border of the piece crosses a line of the grid is found by Newton's
//! method on the distance from the border, which [`NearestPoint`](crate::tool::NearestPoint) tells, from the side on which the piece
//! is not seen. Between these crossings the border is straight. They move along their lines with the unknowns, and by Reynolds'
//! theorem the integrals with them: `d int f = int f v.n ds` over the border.

use super::polygon::{INTEGRALS, Moments, Point, Polygon, left_of, monomials};
use crate::contact::field::cover::FaceInPlace;
use crate::contact::field::face::ShapeFunctions;
use crate::contact::field::tool::ToolInPlace;
use crate::tensor::{Scalar, Vec3};

/// Squares along each side of the grid, each of two triangles.
const SQUARES: usize = 4;
/// Steps of the search for a crossing, and the part of a line of the grid below which the last of them, whose error is its square,
/// is taken as it is.
const STEPS: usize = 60;
const CLOSE: f64 = 1e-7;
/// A place nearer than this part of the line lies on the border; which way from it is lost in rounding.
const ROUNDING: f64 = 1e-11;
/// Parts of a face smaller than this share of it are left out.
const LEAST: f64 = 1e-6;
/// Nodes of a grid are on a face within this part of it.
const ON_FACE: f64 = 1e-9;
/// The edge between the second and the third corner of a triangle, which lies on its left.
const SLANT: [Point<f64>; 2] = [[1.0, 0.0], [0.0, 1.0]];

/// Which nodes of a grid on a face see a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenNodes {
    /// One bit for each node.
    bits: u32,
    /// Where the middle lines of the grid meet: over the middle of a piece that is smaller than the face.
    focus: Point<f64>,
}

/// Nodes of the grid.
const NODES: usize = (SQUARES + 1) * (SQUARES + 1);

impl SeenNodes {
    /// With a grid about the middle, or about a place near the face.
    pub fn new(face: &FaceInPlace, (tool, piece): (&ToolInPlace, usize), focus: Option<Point<f64>>) -> Self {
        let focus = focus.unwrap_or(if face.corners().len() == 3 { [0.5; 2] } else { [0.0; 2] });
        let mut seen = Self { bits: 0, focus };
        for (k, &xi) in seen.grid(face).iter().enumerate() {
            seen.bits |= u32::from(tool.closest(piece, face.at(xi).x).beyond.is_none()) << k;
        }
        seen
    }

    fn sees(self, node: usize) -> bool {
        self.bits >> node & 1 == 1
    }

    /// Reference coordinates of the nodes.
    fn grid(self, face: &FaceInPlace) -> [Point<f64>; NODES] {
        let (least, half) = (if face.corners().len() == 3 { 0.0 } else { -1.0 }, SQUARES / 2);
        let line = |k: usize, middle: f64| {
            let (from, to) = if k < half { (least, middle) } else { (middle, 1.0) };
            from + (to - from) * (k - if k < half { 0 } else { half }) as f64 / half as f64
        };
        std::array::from_fn(|k| [line(k % (SQUARES + 1), self.focus[0]), line(k / (SQUARES + 1), self.focus[1])])
    }

    /// Reference coordinates of those nodes on the face that see the piece.
    pub fn places(self, face: &FaceInPlace) -> Vec<Point<f64>> {
        let all = self.grid(face).into_iter().enumerate();
        all.filter(|&(k, xi)| self.sees(k) && face.face.holds(xi, ON_FACE)).map(|(_, xi)| xi).collect()
    }
}

/// Numbers of the nodes of the triangles of the grid, counter-clockwise.
fn triangles() -> impl Iterator<Item = [usize; 3]> {
    let node = |i: usize, j: usize| j * (SQUARES + 1) + i;
    let squares = (0..SQUARES).flat_map(|j| (0..SQUARES).map(move |i| (i, j)));
    squares.flat_map(move |(i, j)| {
        [[node(i, j), node(i + 1, j), node(i, j + 1)], [node(i + 1, j + 1), node(i, j + 1), node(i + 1, j)]]
    })
}

/// The place on a face nearest to one near it, in reference coordinates; none where that lies farther away than half of the face.
pub fn nearby(face: &FaceInPlace, xi: Point<f64>) -> Option<Point<f64>> {
    let least = if face.corners().len() == 3 { 0.0 } else { -1.0 };
    let margin = 0.25 * (1.0 - least);
    let near = xi.iter().all(|x| (least - margin..=1.0 + margin).contains(x));
    near.then(|| face.face.nearest(xi))
}

/// Where the border of a piece crosses a line of the grid.
pub struct BorderCrossing {
    /// Position,
    pub x: Vec3,
    /// and the shape functions of the face there.
    pub shape: ShapeFunctions,
    xi: Point<f64>,
    along: Point<f64>,
    /// The part of the line by which it comes closer to where the piece is seen is the product of this with the motion of the face
    /// relative to the tool.
    pub across: Vec3,
    /// Derivatives of the integrals along its way on the line.
    pub rates: [f64; INTEGRALS],
}

impl BorderCrossing {
    /// On the line between a node that sees the piece and one that does not.
    fn new(face: &FaceInPlace, (tool, piece): (&ToolInPlace, usize), [from, to]: [Point<f64>; 2]) -> Self {
        let along = [to[0] - from[0], to[1] - from[1]];
        let place = |t: f64| [from[0] + along[0] * t, from[1] + along[1] * t];
        // Beyond the border the part of the line back to it, and its normal over its slope along the line.
        let border = |t: f64| {
            let at = face.at(place(t));
            let (_, way) = tool.closest(piece, at.x).beyond?;
            let line = at.tangents[0] * along[0] + at.tangents[1] * along[1];
            let across = way * way.dot(line).recip();
            let landed = way.norm() < ROUNDING * line.norm();
            Some((if landed { 0.0 } else { across.dot(way) }, across))
        };
        let (mut t, mut outside) = (1.0, None);
        for _ in 0..STEPS {
            let Some((step, _)) = border(t) else {
                // Beside the state that was searched the piece may be seen from all of the line.
                t = outside.map_or(t + 0.25, |outside| t + 0.125 * (outside - t));
                continue;
            };
            outside = Some(t);
            let meets = step >= 0.0 && step < t + 1.0;
            t = if meets { t - step } else { 0.5 * t };
            if meets && step < CLOSE {
                // The bisector within an edge may follow the border at once.
                if border(t - CLOSE).is_none() {
                    break;
                }
                t -= CLOSE;
            }
        }
        // Next to the border its normal is lost in rounding.
        let across =
            border(t + CLOSE).map(|(_, across)| across).filter(|across| across.is_finite()).unwrap_or_default();
        let xi = place(t);
        let shape = face.face.shape(xi);
        Self { x: shape.value(face.placed.nodes()), shape, xi, along, across, rates: [0.0; INTEGRALS] }
    }
}

/// The part of a face that lies over a piece.
pub struct CutFace {
    about: Point<f64>,
    /// Integrals of 1, x, y, xx, xy and yy over it, in reference coordinates.
    integrals: [f64; INTEGRALS],
    /// Where the border crosses the grid, once for each triangle there.
    pub crossings: Vec<BorderCrossing>,
}

impl CutFace {
    /// Of a face with the nodes of its grid that see the piece; none where next to nothing of it is left.
    pub fn new(face: &FaceInPlace, piece: (&ToolInPlace, usize), seen: SeenNodes) -> Option<Self> {
        let (corners, nodes) = (face.corners().len(), seen.grid(face));
        let about = nodes.get(seen.bits.trailing_zeros() as usize).copied().unwrap_or_default();
        let mut cut = Self { about, integrals: [0.0; INTEGRALS], crossings: Vec::new() };
        for triangle in triangles() {
            let outside = |&k: &usize| corners == 3 && left_of(SLANT, nodes[k]) <= ON_FACE;
            if triangle.iter().all(outside) {
                continue;
            }
            let (mut part, first) = (Polygon::of([]), cut.crossings.len());
            for (k, &a) in triangle.iter().enumerate() {
                let b = triangle[(k + 1) % 3];
                if seen.sees(a) {
                    part.push(nodes[a]);
                }
                if seen.sees(a) != seen.sees(b) {
                    let [inside, outside] = if seen.sees(a) { [a, b] } else { [b, a] };
                    let crossing = BorderCrossing::new(face, piece, [nodes[inside], nodes[outside]]);
                    part.push(crossing.xi);
                    cut.crossings.push(crossing);
                }
            }
            if corners == 3 {
                part = part.clip(SLANT);
            }
            cut.integrals.iter_mut().zip(part.integrals(about)).for_each(|(sum, more)| *sum += more);
            if let [p, q] = &mut cut.crossings[first..] {
                // The border runs from where the way around the triangle leaves the piece to where it comes back.
                bound(if seen.sees(triangle[0]) { [p, q] } else { [q, p] }, (about, corners == 3));
            }
        }
        (cut.integrals[0] > LEAST).then_some(cut)
    }

    /// Its moments, of its integrals with derivatives along them.
    pub fn moments<T: Scalar>(&self, lift: impl Fn(f64, usize) -> T) -> Moments<T> {
        Moments::of(std::array::from_fn(|k| lift(self.integrals[k], k)), self.about)
    }
}

/// Adds what the two ends of a straight piece of the border, the part on its left, do to the integrals about a point; of a triangle as
/// far as it lies on that.
fn bound([p, q]: [&mut BorderCrossing; 2], (about, triangle): (Point<f64>, bool)) {
    let normal = [q.xi[1] - p.xi[1], p.xi[0] - q.xi[0]];
    let speeds = [&p.along, &q.along].map(|along| along[0] * normal[0] + along[1] * normal[1]);
    let off = if triangle { [left_of(SLANT, p.xi), left_of(SLANT, q.xi)] } else { [1.0; 2] };
    let leaves = off[0] / (off[0] - off[1]);
    let [from, to] = [if off[0] < 0.0 { leaves } else { 0.0 }, if off[1] < 0.0 { leaves } else { 1.0 }];
    if off[0].max(off[1]) <= 0.0 {
        return;
    }
    // Simpson's rule is exact for the third degree.
    for (at, weight) in [(0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0)] {
        let (s, weight) = (from + (to - from) * at, weight * (to - from));
        let values = monomials([0, 1].map(|i| p.xi[i] + (q.xi[i] - p.xi[i]) * s - about[i]));
        for (k, value) in values.into_iter().enumerate() {
            p.rates[k] += weight * value * (1.0 - s) * speeds[0];
            q.rates[k] += weight * value * s * speeds[1];
        }
    }
}
