//! A rigid tool as a target: signed distance to its smooth pieces, and how it moves with the unknowns of its reference node.

use crate::system::Dofs;
use crate::tensor::Vec3;
use crate::tool::space::{self, SmoothPieces};
use crate::tool::{Hit, NearestPoint, PieceEnd, Pose, ProfileRay, ProfileTool, SmoothPiece, Tip};
use crate::{Failure, FailureKind};
use std::cell::RefCell;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Most unknowns of a tool.
pub const MOST: usize = 6;

/// Closest points that a thread keeps: all nodes of a face ask for the same ones, and twice.
const KEPT: usize = 8192;

/// Which shape, which of its pieces, and the point in its own frame.
type Asked = (usize, usize, Vec3);

thread_local! {
    static CLOSEST: RefCell<Vec<Option<(Asked, NearestPoint)>>> = RefCell::new(vec![None; KEPT]);
}

/// The closest point that a thread found for a point, or a new one.
fn remembered(asked: Asked, find: impl FnOnce() -> NearestPoint) -> NearestPoint {
    // Fibonacci hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    let mix = |hash: u64, x: &f64| (hash.rotate_left(9) ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let place = (asked.2.0.iter().fold(asked.1 as u64, mix) >> 32) as usize % KEPT;
    if let Some((_, found)) = CLOSEST.with_borrow(|kept| kept[place]).filter(|(other, _)| *other == asked) {
        return found;
    }
    let found = find();
    CLOSEST.with_borrow_mut(|kept| kept[place] = Some((asked, found)));
    found
}

/// A tool, its smooth pieces and the place of its unknowns.
#[derive(Debug)]
pub struct RigidTool {
    shape: RigidShape,
    /// No other shape of the program has it.
    identity: usize,
    tips: Vec<Tip>,
    /// In space, the middles of pieces that may lie within a face.
    middles: Vec<Option<Vec3>>,
    number: usize,
    unknowns: Range<usize>,
}

/// A tool with its smooth pieces.
#[derive(Debug)]
enum RigidShape {
    /// Profiles in the plane.
    Plane(Arc<ProfileTool>, Vec<SmoothPiece>),
    /// Facets in space.
    Space(Arc<space::SpaceTool>, SmoothPieces),
}

fn identity() -> usize {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    COUNT.fetch_add(1, Ordering::Relaxed)
}

/// A tool in its place.
#[derive(Debug, Clone, Copy)]
pub struct ToolInPlace<'a> {
    rigid: &'a RigidTool,
    pose: Pose,
    spins: [Vec3; 3],
}

impl RigidTool {
    /// Tool number `number` in the numbering of the unknowns.
    pub fn new(tool: Arc<ProfileTool>, number: usize, dofs: &Dofs) -> Self {
        let pieces = tool.smooth_pieces(0.0);
        Self::made(RigidShape::Plane(tool, pieces), number, dofs)
    }
    /// The same in space.
    pub fn in_space(tool: Arc<space::SpaceTool>, number: usize, dofs: &Dofs) -> Self {
        let pieces = tool.smooth_pieces();
        Self::made(RigidShape::Space(tool, pieces), number, dofs)
    }
    fn made(shape: RigidShape, number: usize, dofs: &Dofs) -> Self {
        let first = dofs.tool(number);
        Self {
            shape,
            identity: identity(),
            tips: Vec::new(),
            middles: Vec::new(),
            number,
            unknowns: first..first + dofs.per_tool(),
        }
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
        match &self.shape {
            RigidShape::Plane(_, pieces) => pieces.len(),
            RigidShape::Space(_, pieces) => pieces.count(),
        }
    }
    /// Whether a piece is straight, flat in space.
    pub fn is_straight(&self, piece: usize) -> bool {
        match &self.shape {
            RigidShape::Plane(tool, pieces) => tool.is_straight(&pieces[piece]),
            RigidShape::Space(_, pieces) => pieces.is_flat(piece),
        }
    }
    /// Has what is small lie within a face. In the plane roundings of radii up to `edge` part the tool as edges do, and those up to
    /// `rounding` and edges are tips; in space pieces may lie within a face of `size`, and edges have tips a half of `edge` apart.
    pub fn sharpen(&mut self, [edge, rounding]: [f64; 2], size: f64) {
        match &mut self.shape {
            RigidShape::Plane(tool, pieces) => {
                (*pieces, self.tips) = (tool.smooth_pieces(edge), tool.tips());
                self.tips.retain(|tip| tip.radius <= rounding);
                self.identity = identity();
            }
            RigidShape::Space(tool, pieces) => {
                self.tips = tool.tips(0.5 * edge);
                self.middles = (0..pieces.count()).map(|piece| tool.middle(pieces, piece, size)).collect();
            }
        }
    }
    /// Its tips.
    pub fn tips(&self) -> &[Tip] {
        &self.tips
    }
    /// Diagonal of the box around it, a length.
    pub fn size(&self) -> f64 {
        match &self.shape {
            RigidShape::Plane(tool, _) => tool.size(),
            RigidShape::Space(tool, _) => tool.size(),
        }
    }
    /// Number of its translations.
    fn axes(&self) -> usize {
        if let RigidShape::Plane(..) = self.shape { 2 } else { 3 }
    }
    /// What belongs to its unknowns, of that which belongs to three translations and a rotation vector; behind it what has none.
    fn own(&self, mut all: [Vec3; MOST]) -> [Vec3; MOST] {
        if self.axes() == 2 {
            all.swap(2, 5);
        }
        all
    }
    fn rest(&self) -> Vec3 {
        match &self.shape {
            RigidShape::Plane(tool, _) => tool.reference(),
            RigidShape::Space(tool, _) => tool.reference(),
        }
    }
    /// The closest point of a smooth piece, in its own frame.
    fn nearest(&self, piece: usize, own: Vec3) -> NearestPoint {
        match &self.shape {
            RigidShape::Plane(tool, pieces) => tool.closest(&pieces[piece], own),
            RigidShape::Space(tool, pieces) => tool.closest(pieces, piece, own),
        }
    }
    /// The tool for values of its unknowns.
    pub fn in_place(&self, motion: &[f64]) -> ToolInPlace<'_> {
        let pose = Pose::new(&motion[..self.unknowns.len()]);
        ToolInPlace { rigid: self, pose, spins: pose.spins() }
    }
    /// The tool at all unknowns.
    pub fn at(&self, u: &[f64]) -> ToolInPlace<'_> {
        self.in_place(&u[self.unknowns()])
    }
    /// Refuses that it touches after more than a quarter of a turn, in space about a steady axis, from all accepted unknowns to its
    /// own: half a turn brings what was touched to the other side, where none is seen, and what came by within the increment was not.
    pub fn refuse_turn(&self, own: &[f64], accepted: &[f64], name: impl FnOnce() -> String) -> Result<(), Failure> {
        let turns = own.iter().zip(&accepted[self.unknowns()]).skip(self.axes());
        let turned = turns.map(|(now, before)| (now - before).powi(2)).sum::<f64>().sqrt();
        if turned > FRAC_PI_2 {
            let reason = format!("{}: its tool turned by {:.0} degrees in one increment", name(), turned.to_degrees());
            return Err(Failure::new(reason).of(FailureKind::Turn));
        }
        Ok(())
    }
}

impl ToolInPlace<'_> {
    /// Present place of its reference point.
    pub fn reference(&self) -> Vec3 {
        self.place(self.rigid.rest())
    }
    /// Present place of the material point that stood at `point`.
    pub fn place(&self, point: Vec3) -> Vec3 {
        self.pose.place(self.rigid.rest(), point)
    }
    /// Where the material point that is now at `placed` stood.
    pub fn withdraw(&self, placed: Vec3) -> Vec3 {
        self.pose.withdraw(self.rigid.rest(), placed)
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
    pub fn closest(&self, piece: usize, x: Vec3) -> NearestPoint {
        let own = self.withdraw(x);
        let found = remembered((self.rigid.identity, piece, own), || self.rigid.nearest(piece, own));
        let bends = found.bends.map(|(along, bend)| (self.rotate(along), bend));
        let beyond = found.beyond.map(|(end, way)| (end, self.rotate(way)));
        NearestPoint { normal: self.rotate(found.normal), point: self.place(found.point), bends, beyond, ..found }
    }
    /// The middle of a piece that may lie within a face.
    pub fn middle(&self, piece: usize) -> Option<Vec3> {
        self.rigid.middles.get(piece).copied().flatten().map(|middle| self.place(middle))
    }
    /// Ends of a piece in the plane beyond which it is not seen: present point and normal of the line there.
    pub fn ends(&self, piece: usize) -> [Option<(Vec3, Vec3)>; 2] {
        let RigidShape::Plane(_, pieces) = &self.rigid.shape else { return [None; 2] };
        let place = |end: PieceEnd| (self.place(end.point), self.rotate(end.along));
        pieces[piece].ends.map(|end| end.map(place))
    }
    /// Derivatives along its unknowns of the place of a material point that is now at `at`.
    pub fn rates(&self, at: Vec3) -> [Vec3; MOST] {
        self.rigid.own(self.pose.rates(&self.spins, self.rigid.rest(), at))
    }
    /// Derivatives along its unknowns of its rotation, as vectors.
    pub fn spins(&self) -> [Vec3; MOST] {
        let ([a, b, c], none) = (self.spins, Vec3::zero());
        self.rigid.own([none, none, none, a, b, c])
    }
    /// Derivatives of [`spins`](Self::spins) along the unknown `along`.
    pub fn spin_rates(&self, along: usize) -> [Vec3; MOST] {
        let mut rates = [Vec3::zero(); MOST];
        if let (RigidShape::Space(..), Some(axis)) = (&self.rigid.shape, along.checked_sub(3)) {
            rates[3..].copy_from_slice(&self.pose.spin_rates(axis));
        }
        rates
    }
    /// Forces on its unknowns of a force `f` at `y`, for derivatives of both: `f . r_i(y)`.
    pub fn receive(&self, y: Vec3, f: Vec3) -> [f64; MOST] {
        self.rates(y).map(|rate| rate.dot(f))
    }
    /// Derivative of [`receive`](Self::receive) along its unknown `along`, with the [`spin_rates`](Self::spin_rates) along that,
    /// (none for a node) where `y` moves by `dy` and `f` by `df`.
    pub fn receive_rate(
        &self,
        (y, f): (Vec3, Vec3),
        (dy, df): (Vec3, Vec3),
        along: Option<(usize, &[Vec3; MOST])>,
    ) -> [f64; MOST] {
        let mut rates = self.receive(y, df);
        // The arm grows with the place and shortens as the reference point moves; a turning tool has other axes.
        let arm = dy - along.filter(|&(j, _)| j < self.rigid.axes()).map_or(Vec3::zero(), |(j, _)| Vec3::axis(j));
        let still = [Vec3::zero(); MOST];
        let turned = along.map_or(&still, |(_, turned)| turned);
        let whole = y - self.reference();
        for (rate, (spin, turned)) in rates.iter_mut().zip(self.spins().iter().zip(turned)) {
            *rate += spin.cross(arm).dot(f) + turned.cross(whole).dot(f);
        }
        rates
    }
}

impl ToolInPlace<'_> {
    /// All places within a range where a ray meets the tool's segments; `hits` is cleared first.
    pub fn cast(&self, ray: &ProfileRay, range: [f64; 2], hits: &mut Vec<Hit>) {
        match &self.rigid.shape {
            RigidShape::Plane(tool, _) => tool.cast(&self.pose, ray, range, hits),
            RigidShape::Space(tool, _) => tool.cast(&self.pose, ray, range, hits),
        }
    }
    /// Where a ray meets one segment or what continues it, near a place on it.
    pub fn meet(&self, segment: usize, ray: &ProfileRay, near: [f64; 2]) -> Option<Hit> {
        match &self.rigid.shape {
            RigidShape::Plane(tool, _) => tool.meet(&self.pose, segment, ray, near),
            RigidShape::Space(tool, _) => tool.meet(&self.pose, segment, ray, near),
        }
    }
    /// Present place of the material point at `s` on a segment.
    pub fn point(&self, segment: usize, s: [f64; 2]) -> Vec3 {
        self.place(match &self.rigid.shape {
            RigidShape::Plane(tool, _) => tool.segments()[segment].point(s[0]),
            RigidShape::Space(tool, _) => tool.facets()[segment].point(s),
        })
    }
}
