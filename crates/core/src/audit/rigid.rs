//! Rigid tools as pieces in their own frame, and where they stand.

use super::hierarchy::{Bounds, Hierarchy, bounds};
use super::inside::{Depth, depth, is_inside};
use super::simplex::Simplex;
use super::surface::CURVED;
use crate::system::Dofs;
use crate::tensor::Vec3;
use crate::tool::space::ToolFacet;
use crate::tool::{self, Pose, ProfileShape, ProfileTool};

/// A tool.
#[derive(Debug)]
pub struct Rigid {
    /// The user's name for it.
    pub name: String,
    /// First of its unknowns.
    first: usize,
    plane: bool,
    reference: Vec3,
    /// Its surface, in its own frame.
    pub tree: Hierarchy,
    /// Its pieces, in its own frame.
    pub pieces: Vec<Simplex>,
    /// Points of its surface in its own frame, with the curvature there.
    pub points: Vec<(Vec3, f64)>,
    /// The box around it in its own frame.
    pub bounds: Bounds,
    /// Whether it has an inside.
    pub closed: bool,
    /// How far its pieces may lie from it.
    pub sagitta: f64,
}

/// Sagitta of the pieces over the size of the smallest cell, but over the size of the tool at least
const FINE: [f64; 2] = [1e-3, 5e-3];
/// so much, in the plane and in space.
const LEAST: [f64; 2] = [1e-8, 1e-4];
/// Points of a tool are set with a sagitta of so many of the smallest cells,
const SPARSE: f64 = 0.02;
/// but no more than these parts a segment or along each direction of a facet.
const MOST: usize = 64;
/// Motion of a tool over an increment is followed in turns of no more than this angle.
const TURN: f64 = 0.05;
/// Most of them.
const TURNS: f64 = 200.0;

impl Rigid {
    /// A tool in the plane, number `number`; `cell` is the size of the smallest cell.
    pub fn plane(tool: &ProfileTool, number: usize, dofs: &Dofs, cell: f64) -> Self {
        let sagitta = (FINE[0] * cell).max(LEAST[0] * tool.size());
        let flat = |shape: &dyn ProfileShape, sagitta: f64| shape.flatten(sagitta);
        let chords = |shape: &dyn ProfileShape| -> Vec<Simplex> {
            flat(shape, sagitta).windows(2).map(|ends| Simplex::segment(ends[0], ends[1])).collect()
        };
        let pieces: Vec<Simplex> = tool.segments().iter().flat_map(|shape| chords(shape.as_ref())).collect();
        let points = tool.segments().iter().flat_map(|shape| points_of(shape.as_ref(), cell)).collect();
        let closed = tool.chains().iter().all(|chain| chain.closed);
        Self::new((tool.name(), tool.reference()), dofs.tool(number), true, pieces, points, (closed, sagitta))
    }

    /// A tool in space.
    pub fn space(tool: &tool::space::SpaceTool, number: usize, dofs: &Dofs, cell: f64) -> Self {
        let sagitta = (FINE[1] * cell).max(LEAST[1] * tool.size());
        let pieces: Vec<Simplex> = tool.facets().iter().flat_map(|facet| tiles(facet.as_ref(), sagitta)).collect();
        let points = tool.facets().iter().flat_map(|facet| grid(facet.as_ref(), SPARSE * cell)).collect();
        let open = |finding: &tool::space::FacetFinding| matches!(finding, tool::space::FacetFinding::OpenEdges(..));
        let swept = tool.facets().iter().any(|facet| facet.corners().is_empty());
        let closed = !swept && !tool.check().iter().any(open);
        Self::new((tool.name(), tool.reference()), dofs.tool(number), false, pieces, points, (closed, sagitta))
    }

    fn new(
        (name, reference): (&str, Vec3),
        first: usize,
        plane: bool,
        pieces: Vec<Simplex>,
        points: Vec<(Vec3, f64)>,
        (closed, sagitta): (bool, f64),
    ) -> Self {
        let own = pieces.iter().map(|piece| (*piece, bounds(piece.corners)));
        let tree = Hierarchy::new(plane, own);
        let bounds = bounds(pieces.iter().flat_map(|piece| piece.corners));
        Self { name: name.into(), first, plane, reference, tree, pieces, points, bounds, closed, sagitta }
    }

    /// Distance of a point from it where it stands first, negative in its material.
    pub fn distance(&self, p: Vec3) -> f64 {
        if let Some(found) = depth(&self.tree, p, (f64::INFINITY, false), &|_, _| true) {
            return -found.depth;
        }
        let mut least = f64::INFINITY;
        self.tree.nearest(p, f64::INFINITY, &mut |_, _, distance| {
            least = distance;
            false
        });
        least
    }
    /// Where it stands at a part of the way from the accepted unknowns to `u`.
    pub fn pose(&self, accepted: &[f64], u: &[f64], part: f64) -> Pose {
        let at = |i: usize| accepted[self.first + i] + (u[self.first + i] - accepted[self.first + i]) * part;
        if self.plane { Pose::new(&[at(0), at(1), at(2)]) } else { Pose::new(&std::array::from_fn::<_, 6, _>(at)) }
    }
    /// Into how many parts its way is divided, so that it turns little in each.
    pub fn turns(&self, accepted: &[f64], u: &[f64]) -> usize {
        let angles = if self.plane { 2..3 } else { 3..6 };
        let turn = |i: usize| (u[self.first + i] - accepted[self.first + i]).abs();
        (angles.map(turn).sum::<f64>() / TURN).min(TURNS).ceil() as usize
    }
    /// How far a side of length `length` at `p` that the tool bears at some of its points may lie in it between and beyond them,
    /// since its surface turns over that length: by an angle `t`, no farther than `t / 4` times the length.
    pub fn bulge(&self, p: Vec3, piece: usize, length: f64) -> f64 {
        0.25 * self.turn(p, piece, length) * length
    }
    /// How far a point `p` of its surface, where it has a curvature, may lie in a straight side of length `length` that rests on it beside the
    /// point: by the sagitta, or as much as that where facets stand for a round surface.
    pub fn nose(&self, (p, curvature): (Vec3, f64), length: f64) -> f64 {
        let (reach, mut nose) = (0.5 * length, curvature * length * length / 8.0);
        self.tree.nearest(p, reach, &mut |piece, _, distance| {
            let touches = distance <= self.sagitta;
            if touches {
                nose = nose.max(0.25 * self.turn(p, piece, reach) * length);
            }
            touches
        });
        nose.min(reach)
    }
    /// The largest angle by which pieces within `reach` of `p` are turned from one of them; what is turned far is a corner.
    fn turn(&self, p: Vec3, piece: usize, reach: f64) -> f64 {
        let (own, reach) = (self.pieces[piece].direction(), Vec3([reach; 3]));
        let mut turn = 0.0_f64;
        self.tree.within([p - reach, p + reach], &mut |_, other| {
            let here = (other.direction() - own).norm();
            if here < CURVED {
                turn = turn.max(here);
            }
        });
        turn
    }
    /// How deep a point of its own frame lies in its material; behind a profile without an inside no farther than `reach`.
    pub fn depth(&self, p: Vec3, reach: f64) -> Option<Depth> {
        let most = if self.closed { f64::INFINITY } else { reach };
        let found = depth(&self.tree, p, (most, !self.closed), &|_, _| true)?;
        let out = self.pieces[found.piece].direction();
        let truly = !self.closed || is_inside(&self.tree, self.bounds, (p, out), &|_| true);
        truly.then_some(found)
    }
    /// Where a point in space stands in its own frame.
    pub fn withdraw(&self, pose: &Pose, p: Vec3) -> Vec3 {
        pose.withdraw(self.reference, p)
    }
    /// Where a point of its own frame stands in space.
    pub fn place(&self, pose: &Pose, p: Vec3) -> Vec3 {
        pose.place(self.reference, p)
    }
}

/// Points along a segment and its curvature at them.
fn points_of(shape: &dyn ProfileShape, cell: f64) -> Vec<(Vec3, f64)> {
    let parts = shape.pieces(SPARSE * cell).clamp(1, MOST);
    let s = |i: usize| i as f64 / parts as f64;
    let turn = |i: usize| (shape.tangent(s(i + 1)).unit() - shape.tangent(s(i)).unit()).norm();
    let chord = |i: usize| (shape.point(s(i + 1)) - shape.point(s(i))).norm();
    let curvature = (0..parts).map(|i| turn(i) / chord(i)).fold(0.0, f64::max);
    (0..=parts).map(|i| (shape.point(s(i)), curvature)).collect()
}

/// Points on a facet and its largest curvature.
fn grid(facet: &dyn ToolFacet, sagitta: f64) -> Vec<(Vec3, f64)> {
    if !facet.corners().is_empty() {
        return facet.corners().iter().map(|&corner| (corner, 0.0)).collect();
    }
    let [n, m] = facet.parts(sagitta).map(|parts| parts.clamp(1, MOST));
    let s = |i: usize, j: usize| [i as f64 / n as f64, j as f64 / m as f64];
    let bend = |a: [f64; 2], b: [f64; 2]| {
        let far = (facet.point(b) - facet.point(a)).norm();
        if far > 0.0 { (facet.normal(b) - facet.normal(a)).norm() / far } else { 0.0 }
    };
    let all = || (0..=n).flat_map(|i| (0..=m).map(move |j| (i, j)));
    let bends = all().flat_map(|(i, j)| {
        let along = (i < n).then(|| bend(s(i, j), s(i + 1, j)));
        let across = (j < m).then(|| bend(s(i, j), s(i, j + 1)));
        along.into_iter().chain(across)
    });
    let curvature = bends.filter(|bend| bend.is_finite()).fold(0.0, f64::max);
    all().map(|(i, j)| (facet.point(s(i, j)), curvature)).collect()
}

/// Triangles nowhere much farther than `sagitta` from a facet.
fn tiles(facet: &dyn ToolFacet, sagitta: f64) -> Vec<Simplex> {
    if let &[a, b, c] = facet.corners() {
        return vec![Simplex::triangle([a, b, c])];
    }
    let [n, m] = facet.parts(sagitta);
    let at = |i: usize, j: usize| facet.point([i as f64 / n as f64, j as f64 / m as f64]);
    let both = |(i, j): (usize, usize)| {
        let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        [[0, 1, 2], [0, 2, 3]].map(|three| Simplex::triangle(three.map(|k| corners[k])))
    };
    let all = (0..n).flat_map(|i| (0..m).map(move |j| (i, j))).flat_map(both);
    all.filter(|tile| tile.normal().norm() > 0.0).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tool::shapes::find;
    use crate::tool::space::SpaceTool;
    use crate::tool::space::solids::polygons;

    /// Far from a roof its flanks, carried on, have a point before it in their material, and in a groove one behind it before them.
    #[test]
    fn what_lies_before_a_roof_is_outside() {
        let line =
            |nodes: [[f64; 2]; 2]| find("line").unwrap().build(&nodes.map(|[x, y]| Vec3::new(x, y, 0.0))).unwrap();
        let corners = [[-5.0, -6.0], [5.0, -6.0], [5.0, -2.0], [0.5, 1.0], [-3.0, -0.5], [-5.0, -6.0]];
        let sides = corners.windows(2).map(|ends| line([ends[0], ends[1]])).collect();
        let tool = ProfileTool::new("roof", vec![sides], Vec3::zero());
        let rigid = Rigid::plane(&tool, 0, &Dofs::new(2, 0, 1), 0.1);
        for (x, y) in [(0.5, 3.0), (-11.0, 1.0), (30.0, 2.0), (-4.9, -0.5), (5.5, -4.0)] {
            assert!(rigid.distance(Vec3::new(x, y, 0.0)) > 0.0, "{x} {y}");
        }
        assert!((rigid.distance(Vec3::new(0.5, 3.0, 0.0)) - 2.0).abs() < 1e-12);
        assert!((rigid.distance(Vec3::new(4.0, -4.0, 0.0)) + 1.0).abs() < 1e-12);
        assert!(rigid.distance(Vec3::new(0.5, 0.9, 0.0)) < 0.0);
    }
    /// A gutter of flat strips around an arc of radius 4, each turned from the last by `angle` degrees.
    fn gutter(angle: f64) -> Rigid {
        let at = |k: f64, y: f64| {
            let (sin, cos) = (angle * k).to_radians().sin_cos();
            Vec3::new(4.0 * sin, y, -4.0 * cos)
        };
        let strip = |k: f64| vec![at(k, -5.0), at(k, 5.0), at(k + 1.0, 5.0), at(k + 1.0, -5.0)];
        let facets = polygons((-4..4).map(|k| strip(f64::from(k)))).unwrap();
        Rigid::space(&SpaceTool::new("gutter", facets, Vec3::zero()), 0, &Dofs::new(3, 0, 1), 0.4)
    }

    #[test]
    fn a_side_lies_on_facets_by_the_sagitta_of_the_arc_for_which_they_stand() {
        let bottom = (Vec3::new(0.0, -5.0, -4.0), 0.0);
        for (angle, length) in [(5.0, 2.0), (10.0, 2.0), (10.0, 1.5), (3.0, 1.0)] {
            let (nose, sagitta) = (gutter(angle).nose(bottom, length), length * length / 32.0);
            assert!((0.6..2.0).contains(&(nose / sagitta)), "{angle}, {length}: {nose} of {sagitta}"); // by whole facets
        }
        assert_eq!(gutter(60.0).nose(bottom, 2.0), 0.0, "a corner stands for nothing round");
        assert_eq!(gutter(60.0).nose((bottom.0, 0.25), 2.0), 0.125, "the sagitta of a round tool");
    }
}
