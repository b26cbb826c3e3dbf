//! A patch in place: where its interval lies, and how that moves with its unknowns.

use super::arc::Arcs;
use super::column::{PointColumn, tool_motion};
use super::contact::FieldTarget;
use super::cover::{FaceFrame, FaceInPlace, Patch, root_near};
use super::face::{CORNERS, PlacedFace, ShapeFunctions, WHOLE};
use super::faces::TargetFaces;
use super::nodes::NodesInPlace;
use super::space::{CutFace, INTEGRALS};
use super::surface::{FieldSurface, NodalNormal};
use super::tool::ToolInPlace;
use crate::tensor::Vec3;
use crate::tool::NearestPoint;

/// A patch in place, with all that its points have in common.
pub struct PatchInPlace<'a> {
    /// The surface,
    pub surface: &'a FieldSurface,
    /// how far the smooth surfaces that faces of both sides stand for rise above them,
    pub arcs: &'a Arcs,
    /// and its face there.
    pub face: FaceInPlace<'a>,
    /// The averaged normals at the corners.
    pub normals: [Option<NodalNormal>; CORNERS],
    /// The tool, if it sees one.
    pub tool: Option<ToolInPlace<'a>>,
    /// The face that is seen, as it lies in the target's list, if it sees a body.
    pub seen: Option<(&'a TargetFaces, PlacedFace)>,
    /// The patch itself.
    pub patch: Patch,
    /// Where its interval begins and ends, in the plane.
    pub interval: [f64; 2],
    /// Whether functions on an overlap are of third degree, in space.
    pub cubic: bool,
    /// Middle of the face and the closest point of the tool where it has dual functions, some of which are negative: they are in sight
    /// together.
    pub middle: Option<(FaceFrame, NearestPoint)>,
    /// Whether the dual part of the gap is that of a straight face between the corners.
    pub straightens: bool,
    /// The part of the face that it is, where the border of a piece of a tool cuts that in space.
    pub cut: Option<CutFace>,
}

/// Derivatives along one unknown of what bounds a patch: of both ends of an interval, or of the integrals of a part of a face.
pub type BoundRates = [f64; INTEGRALS];

impl<'a> PatchInPlace<'a> {
    /// A patch with its nodes and the tool in place.
    pub fn new(at: &NodesInPlace<'a>, patch: &Patch) -> Self {
        let surface = &at.contact.parts.surface;
        let face = &surface.faces[patch.face];
        let (mut normals, mut units) = ([None; CORNERS], [Vec3::zero(); CORNERS]);
        if at.contact.needs_normals() {
            for c in 0..face.corners() {
                let normal: NodalNormal =
                    surface.normal(surface.field[patch.face][c], |f| at.placed(&surface.faces[f]));
                (normals[c], units[c]) = (Some(normal), normal.unit);
            }
        }
        let face = FaceInPlace::with(surface, patch.face, at.placed(face), units);
        let (tool, seen) = match &at.contact.parts.target {
            FieldTarget::Tool(_) => (at.tool, None),
            FieldTarget::Faces(faces) => (None, Some((&**faces, at.placed(&faces.surface.faces[patch.target])))),
        };
        let mut patch = Self {
            surface,
            arcs: at.arcs,
            face,
            normals,
            tool,
            seen,
            patch: *patch,
            interval: WHOLE,
            cubic: at.contact.is_cubic(patch),
            middle: None,
            straightens: patch.dual > 0.0 && face.face.kind.degree > 1 && !surface.curved[patch.face],
            cut: None,
        };
        if let Some(tool) = patch.tool.filter(|_| patch.patch.dual > 0.0) {
            let middle = patch.face.at(patch.face.face.middle());
            patch.middle = Some((middle, tool.closest(patch.patch.target, middle.x)));
        }
        for (k, end) in patch.patch.ends.into_iter().enumerate() {
            if let Some(end) = end {
                patch.interval[k] = root_near(patch.patch.near[k], |xi| patch.offset(xi, end));
            }
        }
        if let (Some(tool), Some(seen)) = (&patch.tool, patch.patch.seen) {
            patch.cut = CutFace::new(&patch.face, (tool, patch.patch.target), seen);
        }
        patch
    }

    /// How far a place lies from an end of what is seen, and the slope of that.
    fn offset(&self, xi: f64, end: usize) -> [f64; 2] {
        match (&self.tool, &self.seen) {
            (Some(tool), _) => {
                tool.ends(self.patch.target)[end].map_or([0.0, 1.0], |line| self.face.end_offset(xi, line))
            }
            (None, Some((_, seen))) => self.face.vertex_offset(xi, seen.nodes()[end]),
            (None, None) => [0.0, 1.0],
        }
    }

    /// Derivatives of what bounds it along an unknown. `turning` are those of the sums of area vectors at the corners.
    pub fn bound_rates(&self, column: &PointColumn, turning: &[Vec3; CORNERS]) -> BoundRates {
        let mut rates = [0.0; INTEGRALS];
        if let (Some(cut), Some(tool)) = (&self.cut, &self.tool) {
            for crossing in &cut.crossings {
                let motion = self.moved(column, &crossing.shape) - tool_motion(tool, column, crossing.x).0;
                let along = -crossing.across.dot(motion);
                rates.iter_mut().zip(crossing.rates).for_each(|(sum, rate)| *sum += rate * along);
            }
            return rates;
        }
        let rate = |k: usize| {
            let Some(end) = self.patch.ends[k] else { return 0.0 };
            let xi = self.interval[k];
            let at = self.face.at([xi, 0.0]);
            let slope = self.offset(xi, end)[1];
            let moved = self.moved(column, &self.face.face.shape([xi, 0.0]));
            let change = match (&self.tool, &self.seen) {
                (Some(tool), _) => {
                    let Some((point, along)) = tool.ends(self.patch.target)[end] else { return 0.0 };
                    let (rate, spin) = tool_motion(tool, column, point);
                    (moved - rate).dot(along) + (at.x - point).dot(spin.cross(along))
                }
                (None, Some((_, seen))) => {
                    let vertex = match column {
                        PointColumn::Node { axis, seen: Some(k), .. } if *k == end => Vec3::axis(*axis),
                        _ => Vec3::zero(),
                    };
                    let turned = self.sum_turned(&at.corners, turning);
                    (vertex - moved).dot(at.normal.left()) + (seen.nodes()[end] - at.x).dot(turned.left())
                }
                (None, None) => 0.0,
            };
            -change / slope
        };
        (rates[0], rates[1]) = (rate(0), rate(1));
        rates
    }

    /// Displacement of a place of the face along an unknown, at fixed reference coordinates.
    pub(super) fn moved(&self, column: &PointColumn, shape: &ShapeFunctions) -> Vec3 {
        match column {
            PointColumn::Node { axis, own: Some(k), .. } => Vec3::axis(*axis) * shape.n[*k],
            _ => Vec3::zero(),
        }
    }

    /// Derivative of the interpolated normal along an unknown, at fixed reference coordinates.
    pub(super) fn sum_turned(&self, functions: &ShapeFunctions, turning: &[Vec3; CORNERS]) -> Vec3 {
        let turned = self.normals.iter().zip(turning).zip(&functions.n);
        turned.fold(Vec3::zero(), |sum, ((normal, dm), m)| sum + normal.map_or(Vec3::zero(), |n| n.turned(*dm)) * *m)
    }

    /// Where a point of the rule lies on the interval.
    pub fn place(&self, eta: f64) -> f64 {
        let [from, to] = self.interval;
        0.5 * (from + to) + 0.5 * (to - from) * eta
    }
}
