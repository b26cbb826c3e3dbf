//! A quadrature point of a patch: gap, slip, directions and weights there, and the derivative of each along one unknown.
//!
//! With `xi` the place on the face, `x = N_L(xi) x_L`. On a body `n` is the averaged normal of the surface and
//! `x + gamma n = N_K(s) x_K`; on a tool `n` is the opposite of the tool's normal at the closest point and `gamma` the signed
//! distance, so that pressure is along the gradient of the gap. The slip of the increment is the way between the target's
//! material point that this place of the surface saw at the accepted state and the place itself, both as they are now: under
//! a common rigid motion it is along `n`, and nothing is left of it in the tangent plane.

use super::column::{PointColumn, tool_motion};
use super::cover::FaceFrame;
use super::face::{CORNERS, ShapeFunctions};
use super::faces::{FaceProjection, FaceRay};
use super::patch::{BoundRates, PatchInPlace};
use super::spot::FaceSpot;
use crate::tensor::Vec3;
use crate::tool::NearestPoint;

/// What a point sees of the target.
#[derive(Debug, Clone, Copy)]
pub enum Sight {
    /// A face of a body.
    Face(FaceProjection),
    /// The closest point of a tool.
    Tool(NearestPoint),
    /// A tip of a tool.
    Tip,
    /// A face of a body, by a corner of either.
    Corner(FaceProjection),
}

/// The target's material point that a place of the surface saw at the accepted state, as it is now.
#[derive(Debug, Clone, Copy)]
pub struct Touched {
    /// Present position.
    pub now: Vec3,
    /// Its derivatives along the reference coordinates of the place.
    pub slopes: [Vec3; 2],
    /// Over a tool: how the surface stood there.
    pub facing: Option<Facing>,
    /// The face of a body and the shape functions there.
    pub face: Option<(usize, ShapeFunctions)>,
    /// Of a tip, over whose place on the surface this is: present position of the tool's point that lay there.
    pub tip: Vec3,
}

/// How a surface stood over a tool at the accepted state, moved with the tool.
#[derive(Debug, Clone, Copy)]
pub struct Facing {
    /// The direction of the gap,
    pub n: Vec3,
    /// and its derivatives along the reference coordinates of the place.
    pub slopes: [Vec3; 2],
    /// In space the contravariant base vectors in the middle of the face.
    pub contravariant: [Vec3; 2],
}

/// A quadrature point of a patch.
#[derive(Debug, Clone, Copy)]
pub struct PatchPoint {
    /// Its number among the places of the quadrature.
    pub number: usize,
    /// The corner of the face that it is, where it stands for no area of its own.
    pub vertex: Option<usize>,
    /// Reference coordinates on the face.
    pub xi: [f64; 2],
    /// Undeformed area it stands for.
    pub weight: f64,
    /// Functions of the nodes of the field at the corners of the face,
    pub functions: ShapeFunctions,
    /// and what of these is dual.
    pub dual: ShapeFunctions,
    /// Shape functions of the face.
    pub shape: ShapeFunctions,
    /// Gap between the smooth surfaces that faces stand for, negative for penetration.
    pub gap: f64,
    /// By how much the face lies nearer to the target than one of first degree between its corners.
    pub bulge: f64,
    /// Outward direction of the gap.
    pub n: Vec3,
    /// The way of the increment, from the place to what it saw at the accepted state.
    pub v: Vec3,
    /// Where the target is loaded.
    pub y: Vec3,
    /// What it sees.
    pub sight: Sight,
    /// What it saw.
    pub touched: Option<Touched>,
}

/// Derivatives of a point along one unknown.
#[derive(Debug, Clone, Copy, Default)]
pub struct PointRates {
    /// Of the weight.
    pub weight: f64,
    /// Of the reference coordinates.
    pub xi: [f64; 2],
    /// Of the gap.
    pub gap: f64,
    /// Of the bulge.
    pub bulge: f64,
    /// Of the direction.
    pub n: Vec3,
    /// Of the way.
    pub v: Vec3,
    /// Of the reference coordinates of what is seen.
    pub s: [f64; 2],
    /// Of the place where the target is loaded.
    pub y: Vec3,
}

/// A density at a place: its value and its slopes.
type Density = (f64, [f64; 2]);

/// Cosines between the surface's own normal and that opposite to a tool's between which a place comes into sight.
const SIGHT: [f64; 2] = [0.1, 0.5];

/// Weight of a place by that cosine: zero, a cubic, one. With its slope.
fn sight(cosine: f64) -> [f64; 2] {
    let width = SIGHT[1] - SIGHT[0];
    let [weight, slope] = smoothstep((cosine - SIGHT[0]) / width);
    [weight, slope / width]
}

/// A cubic that rises from zero at zero to one at one, with its slope (smoothstep).
pub fn smoothstep(t: f64) -> [f64; 2] {
    let t = t.clamp(0.0, 1.0);
    [t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t)]
}

impl PatchInPlace<'_> {
    /// What is seen from a place of the face.
    pub fn look(&self, at: &FaceFrame) -> Option<(Sight, Vec3, f64, Vec3)> {
        if let Some(tool) = &self.tool {
            let foot = tool.closest(self.patch.target, at.x);
            return Some((Sight::Tool(foot), -foot.normal, foot.gap, foot.point));
        }
        let (faces, seen) = self.seen.as_ref()?;
        let n = at.normal.unit();
        let hit = faces.project(self.patch.target, seen, &FaceRay { x: at.x, n })?;
        Some((Sight::Face(hit), n, hit.gap, hit.y))
    }

    /// How far the smooth surfaces that faces of first degree stand for rise above both of these, with the slopes along the coordinates of the
    /// face and of what it sees. Of a polygon in place of a circle, which stands off by the height of its chords, bodies that fit would be
    /// told apart by that.
    pub fn rise(&self, xi: [f64; 2], sight: &Sight) -> (f64, [[f64; 2]; 2]) {
        let (own, slopes) = self.surface.rise(self.patch.face, &self.arcs.own, xi);
        let (seen, others) = match (sight, &self.seen) {
            (Sight::Face(hit), Some((faces, _))) => faces.surface.rise(self.patch.target, &self.arcs.seen, hit.s),
            _ => (0.0, [0.0; 2]),
        };
        (own + seen, [slopes, others])
    }

    /// The weight of a place by whether it looks at what it sees, and its slope along the cosine.
    pub fn facing(&self, xi: [f64; 2], n: Vec3) -> [f64; 2] {
        if self.tool.is_none() {
            return [1.0, 0.0];
        }
        match &self.middle {
            Some((_, foot)) => sight(-self.face.own_normal(self.face.face.middle()).dot(foot.normal)),
            None => sight(self.face.own_normal(xi).dot(n)),
        }
    }

    /// Derivatives of a point along an unknown: `frame` is its place with its weight by what it looks at, then the slopes of
    /// what the smooth surfaces rise above both sides, `density` the undeformed area density with its slopes.
    pub fn rates(
        &self,
        point: &PatchPoint,
        column: &PointColumn,
        (spot, frame, facing): (&FaceSpot, &FaceFrame, [f64; 2]),
        [slopes, others]: [[f64; 2]; 2],
        density: &Density,
        (bounds, turning): (&BoundRates, &[Vec3; CORNERS]),
    ) -> PointRates {
        let (xi, (dxi, darea)) = (spot.xi, self.spot_rates(spot, column, bounds));
        let dx = self.moved(column, &point.shape) + frame.tangents[0] * dxi[0] + frame.tangents[1] * dxi[1];
        let (mut gap, n, s, y) = self.sight_rates(point, column, (frame, dx, dxi), turning);
        gap -= (0..2).map(|k| slopes[k] * dxi[k] + others[k] * s[k]).sum::<f64>();
        let mut dfacing = 0.0;
        if facing[1] != 0.0 {
            let (xi, dxi, n, dn) = match (&self.middle, &self.tool) {
                (Some((at, foot)), Some(tool)) => {
                    let (rate, spin) = tool_motion(tool, column, at.x);
                    let dn = -(foot.turned(self.moved(column, &at.shape) - rate) + spin.cross(foot.normal));
                    (self.face.face.middle(), [0.0; 2], -foot.normal, dn)
                }
                _ => (xi, dxi, point.n, n),
            };
            let cosine = self.own_normal_rate(column, xi, dxi).dot(n) + self.face.own_normal(xi).dot(dn);
            dfacing = facing[1] * cosine;
        }
        let slope: f64 = (0..2).map(|k| density.1[k] * dxi[k]).sum();
        let weight = darea * density.0 * facing[0] + spot.weight * (slope * facing[0] + density.0 * dfacing);
        let follow = |touched: &Touched| {
            let carried = touched.slopes[0] * dxi[0] + touched.slopes[1] * dxi[1];
            self.touched_rate(column, touched) + carried - dx
        };
        let v = point.touched.as_ref().map_or(Vec3::zero(), follow);
        let mut bulge = 0.0;
        if self.straightens {
            let (straight, corners) = (&frame.corners, self.face.corners());
            let [a, b] = straight.tangents(corners, self.face.plane);
            let corner = match column {
                PointColumn::Node { axis, own: Some(k), .. } => {
                    let at = self.face.face.corner_at(*k).map_or(0.0, |corner| straight.n[corner]);
                    Vec3::axis(*axis) * at
                }
                _ => Vec3::zero(),
            };
            bulge = n.dot(frame.x - straight.value(corners)) + point.n.dot(dx - corner - a * dxi[0] - b * dxi[1]);
        }
        PointRates { weight, xi: dxi, gap, bulge, n, v, s, y }
    }

    /// Derivatives of gap, direction, coordinates of what is seen, and of the place where it is loaded.
    fn sight_rates(
        &self,
        point: &PatchPoint,
        column: &PointColumn,
        (at, dx, dxi): (&FaceFrame, Vec3, [f64; 2]),
        turning: &[Vec3; CORNERS],
    ) -> (f64, Vec3, [f64; 2], Vec3) {
        match (&point.sight, &self.tool) {
            (Sight::Tool(foot), Some(tool)) => {
                let (rate, spin) = tool_motion(tool, column, at.x);
                let motion = dx - rate;
                let n = -(foot.turned(motion) + spin.cross(foot.normal));
                let (rate, _) = tool_motion(tool, column, foot.point);
                (foot.normal.dot(motion), n, [0.0; 2], rate + foot.slide(motion))
            }
            (Sight::Face(hit), _) => {
                let moved = at.normal_slopes[0] * dxi[0] + at.normal_slopes[1] * dxi[1];
                let dn = at.normal.turned(self.sum_turned(&at.corners, turning) + moved);
                let carried = match column {
                    PointColumn::Node { axis, seen: Some(k), .. } => Vec3::axis(*axis) * hit.shape.n[*k],
                    _ => Vec3::zero(),
                };
                let (gap, s) = hit.follow(point.n, dx + dn * hit.gap - carried);
                let y = carried + hit.tangents[0] * s[0] + hit.tangents[1] * s[1];
                (gap, dn, s, y)
            }
            (Sight::Tool(_), None) | (Sight::Tip | Sight::Corner(_), _) => (0.0, Vec3::zero(), [0.0; 2], Vec3::zero()),
        }
    }

    /// Derivative of the face's own unit normal.
    fn own_normal_rate(&self, column: &PointColumn, xi: [f64; 2], dxi: [f64; 2]) -> Vec3 {
        let (face, shape) = (self.face.face, self.face.face.shape(xi));
        let [a, b] = shape.tangents(self.face.placed.nodes(), self.face.plane);
        let [mut da, mut db] = match column {
            PointColumn::Node { axis, own: Some(k), .. } => shape.dn[*k].map(|slope| Vec3::axis(*axis) * slope),
            _ => [Vec3::zero(); 2],
        };
        // Shape functions have slopes of second degree, of which a central difference is exact.
        for (k, dxi) in dxi.into_iter().enumerate().filter(|(_, dxi)| *dxi != 0.0) {
            let at = |step: f64| {
                let xi = std::array::from_fn(|i| if i == k { xi[i] + step } else { xi[i] });
                face.shape(xi).tangents(self.face.placed.nodes(), self.face.plane)
            };
            let ([a, b], [c, d]) = (at(0.5), at(-0.5));
            (da, db) = (da + (a - c) * dxi, db + (b - d) * dxi);
        }
        if self.face.plane {
            db = Vec3::zero();
        }
        a.cross(b).turned(da.cross(b) + a.cross(db))
    }

    fn touched_rate(&self, column: &PointColumn, touched: &Touched) -> Vec3 {
        match (column, &touched.face, &self.tool) {
            (PointColumn::Node { axis, node, .. }, Some((face, shape)), _) => {
                let nodes = self.seen.as_ref().map(|(faces, _)| &faces.surface.faces[*face].nodes);
                let place = nodes.and_then(|nodes| nodes.iter().position(|other| other == node));
                place.map_or(Vec3::zero(), |k| Vec3::axis(*axis) * shape.n[k])
            }
            (PointColumn::Tool(j), None, Some(tool)) => tool.rates(touched.now)[*j],
            _ => Vec3::zero(),
        }
    }
}
