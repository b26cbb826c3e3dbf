//! A rigid tool as a target: signed distance to its smooth pieces, and how it moves with the unknowns of its reference node.

use super::surface::unit;
use crate::system::Dofs;
use crate::tensor::Vec3;
use crate::tool::{Pose, SmoothPiece, Tool};
use std::ops::Range;
use std::sync::Arc;

/// Most unknowns of a tool.
pub const MOST: usize = 6;

/// A tool, its smooth pieces and the place of its unknowns.
#[derive(Debug)]
pub struct RigidTool {
    tool: Arc<Tool>,
    pieces: Vec<SmoothPiece>,
    number: usize,
    unknowns: Range<usize>,
}

/// A tool in its place.
#[derive(Debug, Clone, Copy)]
pub struct ToolInPlace<'a> {
    rigid: &'a RigidTool,
    pose: Pose,
}

/// The point of a tool that is closest to a point of the surface.
#[derive(Debug, Clone, Copy)]
pub struct Foot {
    /// Signed distance, negative for penetration.
    pub gap: f64,
    /// Outward unit normal of the tool.
    pub normal: Vec3,
    /// The closest point.
    pub point: Vec3,
    /// The end of the piece beyond which the point of the surface lies.
    pub beyond: Option<usize>,
    /// Curvature of the surface of equal distance.
    curvature: f64,
}

impl Foot {
    /// Change of the normal for a motion of the point of the surface relative to the tool.
    pub fn turned(&self, motion: Vec3) -> Vec3 {
        let along = self.normal.left();
        along * (self.curvature * along.dot(motion))
    }
    /// Motion of the closest point, as one of the tool's material, for that motion.
    pub fn slide(&self, motion: Vec3) -> Vec3 {
        motion - self.normal * self.normal.dot(motion) - self.turned(motion) * self.gap
    }
}

impl RigidTool {
    /// Tool number `number` in the numbering of the unknowns.
    pub fn new(tool: Arc<Tool>, number: usize, dofs: &Dofs) -> Self {
        let first = dofs.tool(number);
        Self { pieces: tool.smooth_pieces(), tool, number, unknowns: first..first + dofs.per_tool() }
    }
    /// Its number among the tools.
    pub fn number(&self) -> usize {
        self.number
    }
    /// Its unknowns.
    pub fn unknowns(&self) -> Range<usize> {
        self.unknowns.clone()
    }
    /// Number of its smooth pieces.
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }
    /// Diagonal of the box around it, a length.
    pub fn size(&self) -> f64 {
        self.tool.size()
    }
    /// The tool for values of its unknowns.
    pub fn in_place(&self, motion: &[f64]) -> ToolInPlace<'_> {
        ToolInPlace { rigid: self, pose: Pose::new(motion[0], motion[1], motion[2]) }
    }
    /// The tool at all unknowns.
    pub fn at(&self, u: &[f64]) -> ToolInPlace<'_> {
        self.in_place(&u[self.unknowns()])
    }
}

impl ToolInPlace<'_> {
    /// Present place of its reference point.
    pub fn reference(&self) -> Vec3 {
        self.place(self.rigid.tool.reference())
    }
    /// Present place of the material point that stood at `point`.
    pub fn place(&self, point: Vec3) -> Vec3 {
        self.pose.place(self.rigid.tool.reference(), point)
    }
    /// Where the material point that is now at `placed` stood.
    pub fn withdraw(&self, placed: Vec3) -> Vec3 {
        self.pose.withdraw(self.rigid.tool.reference(), placed)
    }
    /// A vector turned with the tool.
    pub fn rotate(&self, v: Vec3) -> Vec3 {
        self.pose.rotate(v)
    }
    /// A vector turned back into the tool's own frame.
    pub fn rotate_back(&self, v: Vec3) -> Vec3 {
        self.pose.rotate_back(v)
    }
    /// The closest point of a smooth piece.
    pub fn closest(&self, piece: usize, x: Vec3) -> Foot {
        let tool = &self.rigid.tool;
        let found = tool.closest(&self.rigid.pieces[piece], self.withdraw(x));
        Foot {
            gap: found.gap,
            normal: self.rotate(found.normal),
            point: self.place(found.point),
            beyond: found.beyond,
            curvature: found.curvature,
        }
    }
    /// Ends of a piece beyond which it is not seen: present point and tangent.
    pub fn ends(&self, piece: usize) -> [Option<(Vec3, Vec3)>; 2] {
        let place = |end: crate::tool::PieceEnd| (self.place(end.point), self.rotate(end.along));
        self.rigid.tool.piece_ends(&self.rigid.pieces[piece]).map(|end| end.map(place))
    }
    /// Derivatives along its unknowns of the place of a material point that is now at `at`.
    pub fn rates(&self, at: Vec3) -> [Vec3; MOST] {
        let mut rates = [Vec3::zero(); MOST];
        rates[..3].copy_from_slice(&self.pose.rates(self.rigid.tool.reference(), at));
        rates
    }
    /// Derivatives along its unknowns of its rotation, as vectors.
    pub fn spins(&self) -> [Vec3; MOST] {
        let mut spins = [Vec3::zero(); MOST];
        spins[2] = unit(2);
        spins
    }
    /// Forces on its unknowns of a force `f` at `y`, for derivatives of both: `f . r_i(y)`.
    pub fn receive(&self, y: Vec3, f: Vec3) -> [f64; MOST] {
        self.rates(y).map(|rate| rate.dot(f))
    }
    /// Derivative of [`receive`](Self::receive) along its unknown `along` (none for a node) where `y` moves by `dy` and `f` by `df`.
    pub fn receive_rate(&self, (y, f): (Vec3, Vec3), (dy, df): (Vec3, Vec3), along: Option<usize>) -> [f64; MOST] {
        let mut rates = self.receive(y, df);
        // The arm grows with the place and shortens as the reference point moves.
        let arm = dy - along.filter(|&j| j < 2).map_or(Vec3::zero(), unit);
        rates[2] += arm.left().dot(f);
        rates
    }
}
