//! An edge of a tool in space over the faces of the surface: points along it, each a tip in node-to-surface contact with the faces that
//! lie beneath (Hallquist, Goudreau & Benson, Comput. Meth. Appl. Mech. Eng. 51, 1985).
//!
//! With `c` the point, `d` the direction in which it points, and `x(xi)` the place of a face that lies over `c` along `d`, the gap is
//! `(c - x) . n`, `n` the normal of the face there. Faces are carried on a little beyond their borders, where each of two has a part of the area
//! that goes from one to none over the border: in the valley that an edge presses into the surface it touches both sides alike, however
//! deep it lies, as it would not by the closest places of both.

use super::column::{PointColumn, tool_motion};
use super::configuration::Configuration;
use super::contact::FieldContact;
use super::cover::{FEET, Landing, Patch};
use super::face::{FieldFace, PlacedFace, ShapeFunctions};
use super::nodes::NodesInPlace;
use super::point::{PatchPoint, PointRates, Sight, Touched, smoothstep};
use super::points::Recall;
use super::tip::{TipPlace, left_behind};
use super::tool::ToolInPlace;
use crate::tensor::{BoundingBox, Vec3};
use crate::tool::{BoxTree, Tip};

/// How far beyond its borders a face is carried on, in reference coordinates.
const BEYOND: f64 = 0.1;
/// Iterations of Newton's method for the place over a point,
const ITERATIONS: usize = 20;
/// and the step with which it ends.
const CLOSE: f64 = 1e-14;

/// A line along which a point of an edge is seen: the point, and two unit vectors across.
#[derive(Clone, Copy)]
struct PointLine {
    c: Vec3,
    across: [Vec3; 2],
}

impl PointLine {
    fn of(c: Vec3, points: Vec3) -> Self {
        let one = Vec3::axis(points.least_axis()).cross(points).unit();
        Self { c, across: [one, points.cross(one)] }
    }
}

/// Where a line meets a face.
struct FacePlace {
    xi: [f64; 2],
    shape: ShapeFunctions,
    tangents: [Vec3; 2],
    /// `x,11`, `x,12` and `x,22`.
    bends: [Vec3; 3],
    n: Vec3,
    /// The way from it to the point,
    to: Vec3,
    /// and the slopes of what of it is across the line, negative.
    slopes: [[f64; 2]; 2],
}

impl FacePlace {
    fn at(face: &FieldFace, placed: &PlacedFace, xi: [f64; 2], line: PointLine) -> Self {
        let tangents = |xi: [f64; 2]| face.shape(xi).tangents(placed.nodes(), false);
        let shape = face.shape(xi);
        let [a, b] = tangents(xi);
        // Shape functions have slopes of second degree, of which a central difference is exact.
        let [[aa, ab], [_, bb]] = [0, 1].map(|k| {
            let near = |step: f64| tangents([0, 1].map(|i| if i == k { xi[i] + step } else { xi[i] }));
            let ([a, b], [c, d]) = (near(0.5), near(-0.5));
            [a - c, b - d]
        });
        let slopes = line.across.map(|e| [e.dot(a), e.dot(b)]);
        let to = line.c - shape.value(placed.nodes());
        Self { xi, shape, tangents: [a, b], bends: [aa, ab, bb], n: a.cross(b).unit(), to, slopes }
    }

    /// The change of the place for one of what is across the line.
    fn follow(&self, [r, s]: [f64; 2]) -> [f64; 2] {
        let [[a, b], [c, d]] = self.slopes;
        let det = a * d - b * c;
        [(d * r - b * s) / det, (a * s - c * r) / det]
    }

    /// Where the line meets the face, from `xi` on; none that is far from it.
    fn find(face: &FieldFace, placed: &PlacedFace, mut xi: [f64; 2], line: PointLine) -> Option<Self> {
        let mut place = Self::at(face, placed, xi, line);
        for _ in 0..ITERATIONS {
            let step = place.follow(line.across.map(|e| e.dot(place.to)));
            if !step.iter().all(|step| step.is_finite()) || !face.holds(xi, 2.0) {
                return None;
            }
            (0..2).for_each(|k| xi[k] += step[k].clamp(-1.0, 1.0));
            place = Self::at(face, placed, xi, line);
            if step.iter().all(|step| step.abs() < CLOSE) {
                break;
            }
        }
        Some(place)
    }
}

/// The part of the area that a face has at a place, with its slopes: one within it, none beyond its borders.
fn part(face: &FieldFace, [a, b]: [f64; 2]) -> [f64; 3] {
    let ramp = |inside: f64, band: f64| {
        let [value, slope] = smoothstep(0.5 + 0.5 * inside / band);
        [value, 0.5 * slope / band]
    };
    if face.corners() == 3 {
        let [[u, du], [v, dv], [w, dw]] = [a, b, 1.0 - a - b].map(|inside| ramp(inside, 0.5 * BEYOND));
        return [u * v * w, (du * w - u * dw) * v, (dv * w - v * dw) * u];
    }
    let [[u, du], [v, dv]] = [a, b].map(|x| ramp(1.0 - x.abs(), BEYOND));
    [u * v, -a.signum() * du * v, -b.signum() * dv * u]
}

impl Configuration<'_> {
    /// A tree over the faces of the surface.
    pub(super) fn tree(&self) -> BoxTree {
        let boxes: Vec<BoundingBox> =
            self.placed.iter().map(|placed| BoundingBox::of(placed.nodes().iter().copied())).collect();
        BoxTree::new(&boxes, 0.0)
    }

    /// The places that a point of an edge may touch, closest first: the closest, and those on faces beside it.
    pub(super) fn places_in_space(
        &self,
        (tip, tool): (&Tip, &ToolInPlace),
        reach: f64,
        faces: &BoxTree,
    ) -> Vec<TipPlace> {
        let (surface, c, points) = (&self.contact.parts.surface, tool.place(tip.centre), tool.rotate(tip.outward));
        let (mut near, mut found) = (Vec::new(), Vec::new());
        let (reach, line) = (reach.min(self.contact.longest), PointLine::of(c, points));
        faces.near(&BoundingBox { min: c, max: c }.widened(reach), &mut |f| near.push(f));
        near.sort_unstable();
        let mut outside = Vec::new();
        for f in near {
            let face = &surface.faces[f];
            let Some(place) = FacePlace::find(face, &self.placed[f], face.middle(), line) else { continue };
            let FacePlace { xi, n, to, .. } = place;
            let gap = to.dot(n);
            if part(face, xi)[0] == 0.0 || -n.dot(points) < tip.least_cosine || gap.abs() > reach {
                continue;
            }
            if gap > 0.0 && face.holds(xi, 0.0) {
                outside.push((surface.pieces[f], gap));
            }
            let functions = face.corner_functions(xi);
            let corners = 0..face.corners();
            let nearer = corners.max_by(|&a, &b| functions.n[a].total_cmp(&functions.n[b])).unwrap_or(0);
            let (corner, border, rest, centre, radius) = (None, None, None, tip.centre, 0.0);
            found.push(TipPlace { face: f, xi, nearer, corner, border, rest, centre, radius, n, q: gap, gap });
        }
        // Beside a corner of the body the point lies below what carries a face on, and yet outside.
        let passes = |place: &TipPlace| {
            let beside = |&(piece, gap): &(usize, f64)| piece != surface.pieces[place.face] && -gap > place.gap;
            !outside.iter().any(beside)
        };
        found.retain(|place| surface.faces[place.face].holds(place.xi, 0.0) || passes(place));
        found.sort_by(|a, b| a.gap.abs().total_cmp(&b.gap.abs()));
        let first = found.first().map(|place| place.face);
        found.retain(|place| first.is_some_and(|first| self.adjoin(first, place.face)));
        found.truncate(FEET);
        found
    }
}

impl FieldContact {
    /// The undeformed area that a point of an edge has in a face, with its slopes: that of its length across the face.
    pub(super) fn edge_area(&self, f: usize, landing: &Landing) -> [f64; 3] {
        let whole = landing.length * self.parts.surface.size(f, &self.parts.mesh);
        part(&self.parts.surface.faces[f], landing.xi).map(|part| whole * part)
    }
}

impl NodesInPlace<'_> {
    fn edge(&self, patch: &Patch, landing: Landing) -> Option<(FacePlace, PointLine, [f64; 3])> {
        let (tool, face) = (self.tool.as_ref()?, &self.contact.parts.surface.faces[patch.face]);
        let tip = &self.contact.tips()[patch.target / FEET];
        let line = PointLine::of(tool.place(landing.centre), tool.rotate(tip.outward));
        let place = FacePlace::find(face, &self.placed(face), landing.xi, line)?;
        let area = self.contact.edge_area(patch.face, &Landing { xi: place.xi, ..landing });
        Some((place, line, area.map(|area| area * landing.share)))
    }

    /// The point of an edge.
    pub(super) fn edge_point(
        &self,
        (patch, landing): (&Patch, Landing),
        recall: Recall,
        points: &mut Vec<PatchPoint>,
    ) -> Option<()> {
        let (FacePlace { xi, shape, n, to, .. }, line, [weight, ..]) = self.edge(patch, landing)?;
        let touched = recall(self, patch, xi);
        points.push(PatchPoint {
            number: 0,
            vertex: None,
            xi,
            weight,
            functions: ShapeFunctions::constant(1.0),
            dual: ShapeFunctions::constant(0.0),
            shape,
            gap: to.dot(n) - self.contact.parts.surface.rise(patch.face, &self.arcs.own, xi).0,
            bulge: 0.0,
            n,
            v: touched.map_or(Vec3::zero(), |touched| touched.tip - touched.now),
            y: line.c - to,
            sight: Sight::Tip,
            touched,
        });
        Some(())
    }

    /// Its derivatives along each unknown.
    pub(super) fn edge_rates(
        &self,
        (patch, landing): (&Patch, Landing),
        points: &[PatchPoint],
        columns: &[PointColumn],
        rates: &mut Vec<PointRates>,
    ) {
        let (Some((place, line, area)), Some(tool), [point]) = (self.edge(patch, landing), &self.tool, points) else {
            return;
        };
        let FacePlace { shape, tangents: [a, b], bends: [aa, ab, bb], n, to, .. } = &place;
        let (_, slopes) = self.contact.parts.surface.rise(patch.face, &self.arcs.own, place.xi);
        for column in columns {
            let (mut apart, spin) = tool_motion(tool, column, line.c);
            let (carried, mut turned) = (apart, [Vec3::zero(); 2]);
            if let PointColumn::Node { axis, own: Some(k), .. } = column {
                apart -= Vec3::axis(*axis) * shape.n[*k];
                turned = shape.dn[*k].map(|slope| Vec3::axis(*axis) * slope);
            }
            let dxi = place.follow(line.across.map(|e| e.dot(apart) + spin.cross(e).dot(*to)));
            let da = turned[0] + *aa * dxi[0] + *ab * dxi[1];
            let db = turned[1] + *ab * dxi[0] + *bb * dxi[1];
            let dn = a.cross(*b).turned(da.cross(*b) + a.cross(db));
            let change = apart - *a * dxi[0] - *b * dxi[1];
            let slid = |touched: &Touched| {
                tool_motion(tool, column, touched.tip).0 - left_behind(self.contact, column, touched)
            };
            rates.push(PointRates {
                weight: area[1] * dxi[0] + area[2] * dxi[1],
                xi: dxi,
                bulge: 0.0,
                gap: n.dot(change) + dn.dot(*to) - slopes[0] * dxi[0] - slopes[1] * dxi[1],
                n: dn,
                v: point.touched.as_ref().map_or(Vec3::zero(), slid),
                s: [0.0; 2],
                y: carried - change,
            });
        }
    }
}
