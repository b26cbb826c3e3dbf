//! What a surface may touch: a rigid tool, or the faces of a body.
//!
//! A target is made of segments, each of which depends on a few unknowns: the motion of the tool's reference node, or
//! the displacements of a face's nodes. It is asked for two things. [`Standing`] is the whole target at given unknowns,
//! on which rays are cast. All else concerns one segment at given values of its own unknowns: where it is met, where a
//! material point of it is, how that point moves along each unknown, and what a force there does to them. The contact
//! point knows no more of its target, so that a new kind of target is one more arm here.

use super::faces::Faces;
use super::rigid::Rigid;
use crate::system::Dofs;
use crate::tensor::{Scalar, Vec3};
use crate::tool::{self, Met, Pose, Ray, Rejected, Rules, Tool, select};
use std::sync::Arc;

/// Most unknowns of a segment in the plane: those of an edge with three nodes.
pub const MAX_UNKNOWNS: usize = 6;

/// A place where a ray meets a target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// The segment.
    pub segment: usize,
    /// Coordinates on the segment; in the plane the second is zero.
    pub s: [f64; 2],
    /// Signed distance along the ray.
    pub u: f64,
    /// Outward unit normal of the target there, in space.
    pub normal: Vec3,
}

impl Hit {
    pub(super) fn plane(hit: tool::Hit) -> Self {
        Self { segment: hit.segment, s: [hit.s, 0.0], u: hit.u, normal: hit.normal }
    }
}

/// What a surface may touch.
#[derive(Debug)]
pub enum Target {
    /// A rigid tool.
    Tool(Rigid),
    /// Faces of bodies.
    Faces(Faces),
}

/// A target at given unknowns.
pub enum Standing<'a> {
    /// A tool in its place.
    Tool(&'a Rigid, Pose),
    /// Faces where their nodes are.
    Faces(super::faces::Standing<'a>),
}

/// A ray to be cast, and what it may meet.
#[derive(Debug, Clone, Copy)]
pub struct Cast<'a> {
    /// The ray, along the inward normal of the surface.
    pub ray: Ray,
    /// Largest gap at which the target is seen, a length.
    pub reach: f64,
    /// Largest admissible penetration, a length.
    pub depth: f64,
    /// Segments that share a node with the face the ray comes from.
    pub relatives: &'a [usize],
}

/// Memory of a search, so that casting a ray allocates nothing, and what it counts.
#[derive(Debug)]
pub struct Memory<H = tool::Hit> {
    pub(super) hits: Vec<H>,
    /// False contacts.
    pub rejected: Rejected,
}

impl<H> Default for Memory<H> {
    fn default() -> Self {
        Self { hits: Vec::new(), rejected: Rejected::default() }
    }
}

/// Depth, in units of the largest admissible one, up to which a face that is met is surely not the body's own far side.
const WITHIN: f64 = 1.8;
/// Least cosine between a ray and the normal of a face next to the one that the ray comes from: such faces are no
/// contact unless a fold is closing.
const FOLD: f64 = 0.5;

impl Target {
    /// A rigid tool, number `number` in the numbering of the unknowns.
    pub fn tool(tool: Arc<Tool>, number: usize, dofs: &Dofs) -> Self {
        Self::Tool(Rigid::new(tool, number, dofs))
    }

    /// The tool, if it is one.
    pub fn as_tool(&self) -> Option<&Rigid> {
        match self {
            Self::Tool(rigid) => Some(rigid),
            Self::Faces(_) => None,
        }
    }

    /// The faces, if it is made of faces.
    pub fn as_faces(&self) -> Option<&Faces> {
        match self {
            Self::Tool(_) => None,
            Self::Faces(faces) => Some(faces),
        }
    }

    /// Whether it deforms.
    pub fn deforms(&self) -> bool {
        matches!(self, Self::Faces(_))
    }

    /// A length as large as the target.
    pub fn size(&self) -> f64 {
        match self {
            Self::Tool(rigid) => rigid.tool().size(),
            Self::Faces(faces) => faces.size(),
        }
    }

    /// The target at unknowns `u`.
    pub fn stand<'a>(&'a self, u: &[f64]) -> Standing<'a> {
        match self {
            Self::Tool(rigid) => Standing::Tool(rigid, rigid.pose(rigid.motion(u))),
            Self::Faces(faces) => Standing::Faces(faces.stand(u)),
        }
    }

    /// Appends the unknowns of a segment.
    pub fn unknowns(&self, segment: usize, out: &mut Vec<usize>) {
        match self {
            Self::Tool(rigid) => out.extend(rigid.unknowns()),
            Self::Faces(faces) => out.extend(faces.unknowns(segment)),
        }
    }

    /// Number of unknowns of a segment.
    pub fn count(&self, segment: usize) -> usize {
        match self {
            Self::Tool(rigid) => rigid.unknowns().len(),
            Self::Faces(faces) => 2 * faces.nodes(segment).len(),
        }
    }

    /// Whether two segments depend on the same unknowns.
    pub fn together(&self, one: usize, other: usize) -> bool {
        !self.deforms() || one == other
    }

    /// Where a ray meets a segment whose unknowns are `u`, near `near`; None if it runs along it.
    pub fn meet(&self, segment: usize, u: &[f64], ray: &Ray, near: [f64; 2]) -> Option<Hit> {
        match self {
            Self::Tool(rigid) => rigid.tool().cast_segment(&rigid.pose(u), segment, ray, near[0]).map(Hit::plane),
            Self::Faces(faces) => faces.meet(segment, u, ray, near),
        }
    }

    /// Present place of the material point at `s` on a segment whose unknowns are `u`.
    pub fn point(&self, segment: usize, s: [f64; 2], u: &[f64]) -> Vec3 {
        match self {
            Self::Tool(rigid) => rigid.tool().point(&rigid.pose(u), segment, s[0]),
            Self::Faces(faces) => faces.point(segment, s, u),
        }
    }

    /// Derivatives of that point, which is now at `at`, along each unknown of the segment.
    pub fn rates(&self, segment: usize, s: [f64; 2], u: &[f64], at: Vec3) -> [Vec3; MAX_UNKNOWNS] {
        match self {
            Self::Tool(rigid) => rigid.rates(u, at),
            Self::Faces(faces) => faces.rates(segment, s),
        }
    }

    /// What `force` does to the unknowns of the hit segment: its work along their rates. `at` is where it acts, and `b`
    /// the material point there; their derivatives differ by the sliding of the one over the other.
    pub(super) fn receive<T: Scalar>(
        &self,
        (hit, u): (&Hit, &[f64]),
        (at, b): (Vec3<T>, Vec3<T>),
        force: Vec3<T>,
    ) -> [T; MAX_UNKNOWNS] {
        match self {
            Self::Tool(rigid) => rigid.receive(u, at, force),
            Self::Faces(faces) => faces.receive((hit, u), at - b, force),
        }
    }

    /// What the rates of the hit segment's own unknowns add to the derivatives of `receive` besides
    /// those of place and force: entries `(row, column, value)`.
    pub fn stiffen(&self, force: Vec3) -> Vec<(usize, usize, f64)> {
        match self {
            Self::Tool(_) => Rigid::stiffen(force),
            Self::Faces(_) => Vec::new(),
        }
    }
}

impl Standing<'_> {
    /// All that a ray meets within a range.
    pub(super) fn all<'m>(&self, ray: &Ray, range: [f64; 2], memory: &'m mut Memory) -> &'m [tool::Hit] {
        match self {
            Self::Tool(rigid, pose) => rigid.tool().cast(pose, ray, range, &mut memory.hits),
            Self::Faces(faces) => faces.cast(ray, range, &mut memory.hits),
        }
        &memory.hits
    }

    /// What a ray meets by the rules against false contacts; what they reject is counted.
    pub fn cast(&self, cast: &Cast, memory: &mut Memory) -> Option<Hit> {
        match self {
            Self::Tool(rigid, pose) => {
                rigid.tool().cast(pose, &cast.ray, cast.range(), &mut memory.hits);
                cast.select(rigid.tool().size(), memory).map(Hit::plane)
            }
            Self::Faces(faces) => faces.select(cast, memory),
        }
    }
}

impl Cast<'_> {
    /// To the far side of the body: what lies beyond its middle is refused, and counted.
    pub(super) fn range(&self) -> [f64; 2] {
        [-self.reach, 2.0 * self.depth]
    }

    /// Whether a face that looks at the surface, among the hits in memory, lies deeper than is admissible and yet within the
    /// body: the target has come through. The body's own far side, which self-contact sees, is not meant.
    pub(super) fn lies_within<H: Met>(&self, memory: &Memory<H>) -> bool {
        let looks = |hit: &H| self.ray.direction.dot(hit.normal()) > Rules::LEAST_COSINE;
        let within = |hit: &H| hit.u() > self.depth && hit.u() < WITHIN * self.depth;
        memory.hits.iter().any(|hit| looks(hit) && within(hit))
    }

    /// The contact among the hits in memory, on a target of the given size.
    pub(super) fn select<H: Met>(&self, size: f64, memory: &mut Memory<H>) -> Option<H> {
        let direction = self.ray.direction;
        let relative = |hit: &H| self.relatives.contains(&hit.piece());
        memory.hits.retain(|hit| !relative(hit) || direction.dot(hit.normal()) > FOLD);
        select(direction, &memory.hits, &Rules::new(self.depth, size), &mut memory.rejected)
    }
}
