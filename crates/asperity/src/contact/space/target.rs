//! What a surface in space may touch: a rigid tool, or the faces of a body. As in the plane, a target is made of segments
//! that depend on a few unknowns each, and a contact point knows no more of it than what is asked here.

pub use super::faces::Faces;
pub use super::rigid::Rigid;
use crate::contact::target;
pub use crate::contact::target::Cast;
use crate::system::Dofs;
use crate::tensor::{Scalar, Vec3};
use crate::tool::Ray;
use crate::tool::space::{Hit, Pose, Tool};
use std::sync::Arc;

use super::rigid;
use super::surface::MAX_NODES;

/// Most unknowns of a segment: those of a face with nine nodes.
pub const MAX_UNKNOWNS: usize = 3 * MAX_NODES;

/// Memory of a search.
pub type Memory = target::Memory<Hit>;

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

impl Target {
    /// A rigid tool, number `number` in the numbering of the unknowns.
    pub fn tool(tool: Arc<Tool>, number: usize, dofs: &Dofs) -> Self {
        Self::Tool(Rigid::new(tool, number, dofs))
    }
    /// The tool, if it is one.
    pub fn as_tool(&self) -> Option<&Rigid> {
        if let Self::Tool(rigid) = self { Some(rigid) } else { None }
    }
    /// The faces, if it is made of faces.
    pub fn as_faces(&self) -> Option<&Faces> {
        if let Self::Faces(faces) = self { Some(faces) } else { None }
    }
    /// Whether it deforms.
    pub fn deforms(&self) -> bool {
        self.as_faces().is_some()
    }

    /// The target at unknowns `u`.
    pub fn stand(&self, u: &[f64]) -> Standing<'_> {
        match self {
            Self::Tool(rigid) => Standing::Tool(rigid, rigid.pose(u)),
            Self::Faces(faces) => Standing::Faces(faces.stand(u)),
        }
    }

    pub(super) fn unknowns(&self, segment: usize, out: &mut Vec<usize>) {
        match self {
            Self::Tool(rigid) => out.extend(rigid.unknowns()),
            Self::Faces(faces) => out.extend(faces.unknowns(segment)),
        }
    }

    /// Number of unknowns of a segment.
    pub(super) fn count(&self, segment: usize) -> usize {
        self.as_faces().map_or(rigid::COUNT, |faces| 3 * faces.nodes(segment).len())
    }

    /// Whether two segments depend on the same unknowns.
    pub(super) fn together(&self, one: usize, other: usize) -> bool {
        !self.deforms() || one == other
    }

    /// Where a ray meets a segment whose unknowns are `u`, near `near`; None if it runs along it.
    pub(super) fn meet(&self, segment: usize, u: &[f64], ray: &Ray, near: [f64; 2]) -> Option<Hit> {
        match self {
            Self::Tool(rigid) => rigid.tool().cast_facet(&rigid::pose(u), segment, ray, near),
            Self::Faces(faces) => faces.meet(segment, u, ray, near),
        }
    }

    /// Present place of the material point at `s` on a segment whose unknowns are `u`.
    pub(super) fn point(&self, segment: usize, s: [f64; 2], u: &[f64]) -> Vec3 {
        match self {
            Self::Tool(rigid) => rigid.tool().point(&rigid::pose(u), segment, s),
            Self::Faces(faces) => faces.point(segment, s, u),
        }
    }

    /// Derivatives of that point, which is now at `at`, along each unknown of the segment.
    pub(super) fn rates(&self, segment: usize, s: [f64; 2], u: &[f64], at: Vec3) -> [Vec3; MAX_UNKNOWNS] {
        match self {
            Self::Tool(rigid) => padded(rigid.rates(u, at), Vec3::zero()),
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
            Self::Tool(rigid) => padded(rigid.receive(u, at, force), T::zero()),
            Self::Faces(faces) => faces.receive((hit, u), at - b, force),
        }
    }

    /// What the rates of the hit segment's own unknowns `u` add to the derivatives of `receive` besides those of place
    /// and force: calls `add` with row, column and value.
    pub(super) fn stiffen(&self, u: &[f64], load: (Vec3, Vec3), add: &mut dyn FnMut(usize, usize, f64)) {
        if let Self::Tool(rigid) = self {
            rigid.stiffen(u, load, add);
        }
    }
}

fn padded<V: Copy>(values: [V; rigid::COUNT], zero: V) -> [V; MAX_UNKNOWNS] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(zero))
}

impl Standing<'_> {
    /// All that a ray meets within a range.
    pub(super) fn all<'m>(&self, ray: &Ray, range: [f64; 2], memory: &'m mut Memory) -> &'m [Hit] {
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
                cast.select(rigid.tool().size(), memory)
            }
            Self::Faces(faces) => faces.select(cast, memory),
        }
    }
}
