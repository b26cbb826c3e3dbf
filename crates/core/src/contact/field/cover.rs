//! Which part of a face of the surface sees which part of the target.
//!
//! A patch is the part of one face that sees one smooth piece of a tool or one face of a body. In the plane it is an interval
//! of the edge, between the edge's own ends and the places that see an end of what is touched: of a body, where the averaged
//! normal of the surface passes through the vertex, `(x_V - x(xi)) . e_S(xi) = 0`; of a tool, where the surface crosses the
//! line that ends a piece of its profile, `(x(xi) - x_V) . t_V = 0`, across its tangent or along the bisector of a crease. The ends of an interval move with all of these.

use super::face::{CORNERS, FieldFace, PlacedFace, ShapeFunctions, WHOLE};
use super::space::SeenNodes;
use super::surface::FieldSurface;
use super::tool::ToolInPlace;
use crate::tensor::{Vec3, root};

/// The part of a face that sees one piece of the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// The face of the surface.
    pub face: usize,
    /// The smooth piece of a tool, or the face of a body.
    pub target: usize,
    /// What bounds the interval below and above: an end of the target, or none for the edge's own end.
    pub ends: [Option<usize>; 2],
    /// Where the interval ends, roughly: from where its ends are found anew.
    pub near: [f64; 2],
    /// In space, where the border of a piece of a tool cuts the face, the nodes of a grid on it that see the piece.
    pub seen: Option<SeenNodes>,
    /// Share of dual functions among those of its nodes.
    pub dual: f64,
    /// Corners of the face at an end of the surface that see the target here.
    pub vertices: [bool; CORNERS],
    /// Where a tip of the tool lies over the face, instead of a piece of it; `target` is then its number.
    pub tip: Option<Landing>,
    /// Part of what each corner of the face stands for that a corner of the body there takes, where the face rises from what it sees,
    pub taken: [f64; CORNERS],
    /// and that it bears.
    pub left: [f64; CORNERS],
    /// Where it is that of a corner of a body.
    pub corner: Option<CornerTouch>,
}

impl Patch {
    /// One of a whole face that sees a piece or a face of the target.
    pub fn whole(face: usize, target: usize) -> Self {
        let (seen, dual, vertices, tip, taken, corner) = Default::default();
        let (ends, left) = ([None; 2], [1.0; CORNERS]);
        Self { face, target, ends, near: WHOLE, seen, dual, vertices, tip, taken, left, corner }
    }

    /// Numbers of the corners at an end of the surface that see the target here.
    pub fn vertices(&self) -> impl Iterator<Item = usize> + use<> {
        self.vertices.into_iter().enumerate().filter(|(_, sees)| *sees).map(|(corner, _)| corner)
    }
}

/// Most places of the surface that one tip touches: in a valley both sides, what lies between them, and what follows; in space the faces around
/// a node.
pub const FEET: usize = 8;

/// Where a tip touches the face beside one that it lies over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FootBeside {
    /// The face.
    pub face: usize,
    /// Which of its corners is that of the other.
    pub corner: usize,
    /// The place of it that is closest, roughly.
    pub xi: f64,
    /// What touches it, as in [`Landing`].
    pub centre: Vec3,
}

/// Where a tip lies over a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// The place of the face that is closest, roughly.
    pub xi: [f64; 2],
    /// In space the length of the tool's edge that it stands for.
    pub length: f64,
    /// The corner of the face that is closest, where the tip lies in a valley.
    pub corner: Option<usize>,
    /// The corner that it lies over where the surface ends, as on a plane or axis of symmetry.
    pub border: Option<usize>,
    /// Part of the face's area that it has,
    pub share: f64,
    /// whether that is more than where all that lies at so small an angle is pressed flat,
    pub slender: bool,
    /// and how deep the field that bore it let it lie in the face: it bears where it goes deeper.
    pub laid: f64,
    /// What touches the face: the centre of the tip or an end of its arc, in the tool's own frame, and the radius about that.
    pub centre: Vec3,
    /// Zero for the end of an arc.
    pub radius: f64,
    /// Beside each corner, where it touches the other face there.
    pub beside: [Option<FootBeside>; 2],
    /// The tool's point that lies over the place, in the tool's own frame.
    pub own: Vec3,
}

/// A corner in a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerTouch {
    /// The number of the corner times [`WAYS`], and that of the way.
    pub number: usize,
    /// From it to the other body, a unit vector times its share of the force.
    pub along: Vec3,
}

/// A face of the surface in place, with the outward normals at its corners.
#[derive(Debug, Clone, Copy)]
pub struct FaceInPlace<'a> {
    /// The face.
    pub face: &'a FieldFace,
    /// The nodes of its side,
    pub placed: PlacedFace,
    /// and its corners.
    corners: PlacedFace,
    /// Unit normals at its corners.
    pub normals: [Vec3; CORNERS],
    /// Whether it is an edge of the plane.
    pub plane: bool,
}

/// A place on a face in place.
#[derive(Debug, Clone, Copy)]
pub struct FaceFrame {
    /// Position.
    pub x: Vec3,
    /// Tangents.
    pub tangents: [Vec3; 2],
    /// Interpolated normal, not of unit length.
    pub normal: Vec3,
    /// Its derivatives along the reference coordinates.
    pub normal_slopes: [Vec3; 2],
    /// Shape functions of the face.
    pub shape: ShapeFunctions,
    /// Functions of its corners.
    pub corners: ShapeFunctions,
}

impl<'a> FaceInPlace<'a> {
    /// A face of a surface in place, with the unit normals at the nodes of the field, none where nothing asks for them.
    pub fn of(surface: &'a FieldSurface, number: usize, placed: PlacedFace, normals: &[Vec3]) -> Self {
        let normals = surface.field[number].map(|node| normals.get(node).copied().unwrap_or_default());
        Self::with(surface, number, placed, normals)
    }
    /// The same with the unit normals at its own corners.
    pub fn with(surface: &'a FieldSurface, number: usize, placed: PlacedFace, normals: [Vec3; CORNERS]) -> Self {
        let face = &surface.faces[number];
        Self { face, placed, corners: face.corner_positions(&placed), normals, plane: surface.plane }
    }
    /// Its corners.
    pub fn corners(&self) -> &[Vec3] {
        self.corners.nodes()
    }

    /// A place of it.
    pub fn at(&self, xi: [f64; 2]) -> FaceFrame {
        let (shape, corners) = (self.face.shape(xi), self.face.corner_functions(xi));
        let normals = &self.normals[..self.face.corners()];
        let slope = |a: usize| normals.iter().zip(&corners.dn).fold(Vec3::zero(), |sum, (&n, dn)| sum + n * dn[a]);
        FaceFrame {
            x: shape.value(self.placed.nodes()),
            tangents: shape.tangents(self.placed.nodes(), self.plane),
            normal: corners.value(normals),
            normal_slopes: [slope(0), slope(1)],
            shape,
            corners,
        }
    }

    /// Its own outward unit normal.
    pub fn own_normal(&self, xi: [f64; 2]) -> Vec3 {
        let [a, b] = self.face.shape(xi).tangents(self.placed.nodes(), self.plane);
        a.cross(b).unit()
    }

    /// How far a vertex lies along the surface from the place whose normal passes through it, and the slope of that.
    pub fn vertex_offset(&self, xi: f64, vertex: Vec3) -> [f64; 2] {
        let at = self.at([xi, 0.0]);
        let (along, to) = (at.normal.left(), vertex - at.x);
        [to.dot(along), to.dot(at.normal_slopes[0].left()) - at.tangents[0].dot(along)]
    }

    /// How far a place lies beyond the line that ends a piece of a profile, and the slope of that.
    pub fn end_offset(&self, xi: f64, (end, along): (Vec3, Vec3)) -> [f64; 2] {
        let at = self.at([xi, 0.0]);
        [(at.x - end).dot(along), at.tangents[0].dot(along)]
    }
}

/// Ends of an interval nearer to those of the edge than this, in reference coordinates, cut nothing off.
const END: f64 = 1e-9;

/// The zero near `xi` of a function with its slope, by Newton's method; where it does not settle, `xi`.
pub fn root_near(xi: f64, f: impl Fn(f64) -> [f64; 2]) -> f64 {
    let mut at = xi;
    for _ in 0..20 {
        let [value, slope] = f(at);
        let next = at - value / slope;
        if !next.is_finite() || (next - xi).abs() > 1.0 {
            return xi;
        }
        if (next - at).abs() < 1e-15 {
            return next;
        }
        at = next;
    }
    at
}

/// The interval of an edge that sees the edge of a body between two vertices, in the order in which the surface passes
/// them, and which of them bound it.
pub fn between_vertices(face: &FaceInPlace, vertices: [Vec3; 2]) -> Option<([f64; 2], [bool; 2])> {
    let (mut ends, mut bounded) = (WHOLE, [false; 2]);
    for k in 0..2 {
        let offset = |xi: f64| face.vertex_offset(xi, vertices[k]);
        let [before, behind] = WHOLE.map(|xi| offset(xi)[0]);
        let (covers, misses) = if k == 0 { (before <= 0.0, behind >= 0.0) } else { (behind >= 0.0, before <= 0.0) };
        if covers {
            continue;
        }
        if misses {
            return None;
        }
        let xi = root(WHOLE, offset);
        if (xi - ends[k]).abs() > END {
            (ends[k], bounded[k]) = (xi, true);
        }
    }
    (ends[1] - ends[0] > END).then_some((ends, bounded))
}

/// Samples along an edge that tell where it sees a piece of a tool.
const SAMPLES: usize = 4;

/// The intervals of an edge that see a smooth piece of a tool, and the ends of the piece that bound them.
pub fn over_piece(
    face: &FaceInPlace,
    (tool, piece): (&ToolInPlace, usize),
    mut take: impl FnMut([f64; 2], [Option<usize>; 2]),
) {
    let ends = tool.ends(piece);
    let sees = |xi: f64| tool.closest(piece, face.at([xi, 0.0]).x).beyond.map(|(end, _)| end);
    let mut samples: Vec<f64> = (0..=SAMPLES).map(|k| 2.0 * k as f64 / SAMPLES as f64 - 1.0).collect();
    if let [Some((a, _)), Some((b, _))] = ends {
        // A piece shorter than an edge shows between its own ends.
        let [tangent, _] = face.at([0.0; 2]).tangents;
        let along = |x: Vec3| tangent.dot(x - face.at([0.0; 2]).x) / tangent.dot(tangent);
        samples.push((0.5 * (along(a) + along(b))).clamp(-1.0, 1.0));
        samples.sort_unstable_by(f64::total_cmp);
    }
    // The side on which the piece is seen, then the place itself.
    let cut = |mut inside: f64, mut outside: f64, end: usize| {
        for _ in 0..30 {
            let middle = 0.5 * (inside + outside);
            if sees(middle).is_none() { inside = middle } else { outside = middle }
        }
        let Some(line) = ends[end] else { return inside };
        root_near(inside, |xi| face.end_offset(xi, line))
    };
    let mut found = |from: (f64, Option<usize>), to: (f64, Option<usize>)| {
        let (mut interval, mut bounds) = ([from.0, to.0], [from.1, to.1]);
        for k in 0..2 {
            if (interval[k] - WHOLE[k]).abs() <= END {
                (interval[k], bounds[k]) = (WHOLE[k], None);
            }
        }
        if interval[1] - interval[0] > END {
            take(interval, bounds);
        }
    };
    let (mut before, mut from) = ((-1.0, sees(-1.0)), (-1.0, None));
    for here in samples.into_iter().skip(1).map(|xi| (xi, sees(xi))) {
        match (before.1, here.1) {
            (Some(end), None) => from = (cut(here.0, before.0, end), Some(end)),
            (None, Some(end)) => found(from, (cut(before.0, here.0, end), Some(end))),
            _ => {}
        }
        before = here;
    }
    if before.1.is_none() {
        found(from, (1.0, None));
    }
}
