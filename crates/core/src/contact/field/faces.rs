//! Faces of bodies as a target: where rays from the surface meet them, by Newton's method on
//! `x + gamma n = sum_K N_K(s) x_K`.

use super::face::{FieldFace, PlacedFace, ShapeFunctions};
use super::surface::FieldSurface;
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::{BoundingBox, Vec3};
use crate::tool::BoxTree;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Iterations of a projection.
const ITERATIONS: usize = 20;
/// A step from which the next one is below rounding.
const SETTLED: f64 = 1e-9;
/// Reference coordinates farther out than this are given up.
const ASTRAY: f64 = 1e3;
/// A face looks at the surface if the cosine between the normals is at least this.
pub const LEAST_COSINE: f64 = 0.1;

/// A ray from the surface along its outward normal.
#[derive(Debug, Clone, Copy)]
pub struct FaceRay {
    /// Its origin.
    pub x: Vec3,
    /// Outward unit normal.
    pub n: Vec3,
}

impl FaceRay {
    /// Into the body from a place of a face, with the length from which on it may leave the body where the face is curved.
    pub fn inward((face, placed): (&FieldFace, &PlacedFace), xi: [f64; 2], plane: bool) -> (Self, f64) {
        let shape = face.shape(xi);
        let [a, b] = shape.tangents(placed.nodes(), plane);
        (Self { x: shape.value(placed.nodes()), n: -a.cross(b).unit() }, LEAST * a.norm())
    }
}

/// Where a ray meets a face.
#[derive(Debug, Clone, Copy)]
pub struct FaceProjection {
    /// Signed distance along the ray, negative for penetration.
    pub gap: f64,
    /// Reference coordinates.
    pub s: [f64; 2],
    /// Shape functions there.
    pub shape: ShapeFunctions,
    /// Position.
    pub y: Vec3,
    /// Tangents there.
    pub tangents: [Vec3; 2],
}

impl FaceProjection {
    /// Derivatives of gap and reference coordinates, for the derivative `r = dx + gamma dn - sum N_K dx_K` of what the
    /// equation leaves along the ray's own motion.
    pub fn follow(&self, n: Vec3, r: Vec3) -> (f64, [f64; 2]) {
        let [a, b] = self.tangents;
        let across = n.dot(a.cross(b)).recip();
        (-r.dot(a.cross(b)) * across, [r.dot(b.cross(n)) * across, r.dot(n.cross(a)) * across])
    }

    /// The target's outward unit normal.
    pub fn normal(&self) -> Vec3 {
        let [a, b] = self.tangents;
        a.cross(b).unit()
    }
}

/// Target faces with their numbers.
#[derive(Debug)]
pub struct TargetFaces {
    /// Faces, smooth pieces, corners.
    pub surface: FieldSurface,
    tree: BoxTree,
    size: f64,
    /// How deep the body behind each side is before any motion.
    thickness: OnceLock<BTreeMap<Side, f64>>,
}

/// Target faces at given unknowns.
pub struct FacesInPlace<'a> {
    faces: &'a TargetFaces,
    mesh: &'a Mesh,
    placed: Vec<PlacedFace>,
    tree: BoxTree,
}

/// Margin of the boxes as a part of the size: what is found must not depend on rounding.
const MARGIN: f64 = 1e-9;

impl TargetFaces {
    /// Of a surface.
    pub fn new(surface: FieldSurface, mesh: &Mesh) -> Self {
        let boxes: Vec<BoundingBox> = surface.faces.iter().map(|face| bounds(&face.at_rest(mesh))).collect();
        let size = boxes.iter().fold(BoundingBox::EMPTY, |all, &b| all.union(b)).size();
        let tree = BoxTree::new(&boxes, MARGIN * size);
        Self { surface, tree, size, thickness: OnceLock::new() }
    }

    /// Diagonal of the box around them before any motion, a length.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// The faces at unknowns `u`.
    pub fn in_place<'a>(&'a self, (mesh, dofs): (&'a Mesh, &Dofs), u: &[f64]) -> FacesInPlace<'a> {
        let placed: Vec<PlacedFace> = self.surface.faces.iter().map(|face| face.placed(mesh, dofs, u)).collect();
        let boxes: Vec<BoundingBox> = placed.iter().map(bounds).collect();
        FacesInPlace { faces: self, mesh, tree: self.tree.refit(&boxes, MARGIN * self.size), placed }
    }

    /// How deep the body is behind the middle of a side before any motion, when it does not lie within itself; others may overlap it.
    fn thickness(&self, of: Side, mesh: &Mesh) -> f64 {
        let all = || {
            let placed: Vec<PlacedFace> = self.surface.faces.iter().map(|face| face.at_rest(mesh)).collect();
            let wholes = mesh.wholes();
            let behind = |(number, face): (usize, &FieldFace)| {
                let (ray, least) = FaceRay::inward((face, &placed[number]), face.middle(), self.surface.plane);
                let mut first = f64::INFINITY;
                self.meet((&self.tree, &placed), &ray, [least, f64::MAX], |other, hit| {
                    let side = self.surface.faces[other].side;
                    let own = side != face.side && wholes[side.cell] == wholes[face.side.cell];
                    if own && hit.normal().dot(ray.n) > 0.0 {
                        first = first.min(hit.gap);
                    }
                });
                (face.side, first)
            };
            self.surface.faces.iter().enumerate().map(behind).collect()
        };
        self.thickness.get_or_init(all).get(&of).copied().unwrap_or(f64::INFINITY)
    }

    /// Calls `take` with the faces, placed so, that a ray meets within `range`, by their numbers.
    fn meet(
        &self,
        (tree, placed): (&BoxTree, &[PlacedFace]),
        ray: &FaceRay,
        range: [f64; 2],
        mut take: impl FnMut(usize, FaceProjection),
    ) {
        let along = crate::tool::ProfileRay { origin: ray.x, direction: ray.n };
        let mut found = Vec::new();
        tree.along(&along, range, &mut |number| found.push(number));
        found.sort_unstable();
        for number in found {
            let Some(hit) = self.project(number, &placed[number], ray) else { continue };
            if self.surface.faces[number].holds(hit.s, 1e-9) && (range[0]..=range[1]).contains(&hit.gap) {
                take(number, hit);
            }
        }
    }

    /// Where a ray meets face `number`, placed so, or what continues it.
    pub fn project(&self, number: usize, placed: &PlacedFace, ray: &FaceRay) -> Option<FaceProjection> {
        project((&self.surface.faces[number], placed), ray, self.surface.plane)
    }
}

/// Where a ray meets a face, or what continues it.
pub fn project(of: (&FieldFace, &PlacedFace), ray: &FaceRay, plane: bool) -> Option<FaceProjection> {
    let (mut s, mut gap) = (of.0.middle(), 0.0);
    let at = |s: [f64; 2], gap: f64| {
        let shape = of.0.extended_shape(s);
        let tangents = shape.tangents(of.1.nodes(), plane);
        FaceProjection { gap, s, shape, y: shape.value(of.1.nodes()), tangents }
    };
    for _ in 0..ITERATIONS {
        let here = at(s, gap);
        let r = ray.x + ray.n * gap - here.y;
        let (dg, ds) = here.follow(ray.n, r);
        let size = here.tangents[0].norm();
        gap += dg;
        (0..2).for_each(|a| s[a] += ds[a]);
        if !s.iter().all(|s| s.abs() < ASTRAY) || !gap.is_finite() {
            return None;
        }
        // The steps of Newton's method are squared: the next would be lost in rounding.
        if ds.iter().all(|ds| ds.abs() < SETTLED) && dg.abs() <= SETTLED * size {
            return Some(at(s, gap));
        }
    }
    // A ray that passes by a curved face has no foot on it, and the iteration wanders.
    None
}

fn bounds(placed: &PlacedFace) -> BoundingBox {
    let all = BoundingBox::of(placed.nodes().iter().copied());
    // Faces of second degree bulge beyond the box around their nodes.
    all.widened(if placed.nodes().len() > 4 || placed.nodes().len() == 3 { 0.25 * all.size() } else { 0.0 })
}

impl FacesInPlace<'_> {
    /// The corners of a face.
    pub fn corners(&self, number: usize) -> &[Vec3] {
        &self.placed[number].nodes()[..self.faces.surface.faces[number].corners()]
    }

    /// A face in place.
    pub fn placed(&self, number: usize) -> &PlacedFace {
        &self.placed[number]
    }

    /// Where a ray meets face `number` or what continues it.
    pub fn project(&self, number: usize, ray: &FaceRay) -> Option<FaceProjection> {
        self.faces.project(number, &self.placed[number], ray)
    }

    /// Whether reference coordinates lie on a face, up to a part `beyond` past its edges.
    pub fn holds(&self, number: usize, s: [f64; 2], beyond: f64) -> bool {
        self.faces.surface.faces[number].holds(s, beyond)
    }

    /// Numbers of the faces whose boxes come within `margin` of a box, ascending.
    pub fn near(&self, around: &BoundingBox, margin: f64, out: &mut Vec<usize>) {
        out.clear();
        self.tree.near(&around.widened(margin), &mut |number| out.push(number));
        out.sort_unstable();
    }

    /// Where a ray meets the nearest face that `admits` (face, projection).
    pub fn nearest(
        &self,
        ray: &FaceRay,
        range: [f64; 2],
        mut admits: impl FnMut(usize, &FaceProjection) -> bool,
    ) -> Option<(usize, FaceProjection)> {
        let mut best: Option<(usize, FaceProjection)> = None;
        self.meet(ray, range, |number, hit| {
            if admits(number, &hit) && best.is_none_or(|(_, b)| hit.gap.abs() < b.gap.abs()) {
                best = Some((number, hit));
            }
        });
        best
    }

    /// How far a ray stays in the body where it begins, on the face `own` or, where that is curved, within `least` of it.
    pub fn depth(&self, own: Side, ray: &FaceRay, least: f64) -> f64 {
        let mut crossings = Vec::new();
        self.meet(ray, [least, f64::MAX], |number, hit| {
            if self.faces.surface.faces[number].side != own {
                crossings.push(BodyCrossing { u: hit.gap, leaves: hit.normal().dot(ray.n) > 0.0 });
            }
        });
        end_of_body(crossings, || SWOLLEN * self.faces.thickness(own, self.mesh))
    }

    /// Calls `take` with the faces that a ray meets within `range`, by their numbers.
    pub fn meet(&self, ray: &FaceRay, range: [f64; 2], take: impl FnMut(usize, FaceProjection)) {
        self.faces.meet((&self.tree, &self.placed), ray, range, take);
    }
}

/// Depth of a body behind a side, over that before any motion, up to which it is searched for behind parts that overlap it.
const SWOLLEN: f64 = 2.0;
/// Part of a tangent of a face from which on a ray inward may leave the body.
const LEAST: f64 = 1e-3;

/// Where a ray crosses the boundary of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
struct BodyCrossing {
    /// Distance along the ray.
    u: f64,
    /// Whether it leaves the body there, or enters it.
    leaves: bool,
}

/// Crossings of one kind that are no farther apart than this part of their distance are one: a ray through a common node.
const TOGETHER: f64 = 1e-9;

/// Where a ray that begins on a body's boundary and goes inward leaves the body. Where the body penetrates itself the ray
/// begins inside it more than once, or enters another part before it leaves its own: parts that overlap a little are left in the order
/// in which they were entered, that of the beginning last of those that the ray begins in. Of a face that it grazes a ray may miss one of two
/// crossings, as if it began in one part more: the end of one that it begins in is not searched for beyond `most`.
fn end_of_body(mut crossings: Vec<BodyCrossing>, most: impl FnOnce() -> f64) -> f64 {
    crossings.sort_unstable_by(|a, b| a.u.total_cmp(&b.u));
    crossings.dedup_by(|b, a| a.leaves == b.leaves && b.u - a.u <= TOGETHER * b.u);
    let mut leaves = crossings.iter().filter(|crossing| crossing.leaves);
    let entered = crossings.iter().filter(|crossing| !crossing.leaves).count();
    let others = leaves.clone().count().saturating_sub(entered + 1);
    if others == 0 {
        return leaves.next().map_or(f64::INFINITY, |crossing| crossing.u);
    }
    let most = most();
    let reached = leaves.take(others + 1).enumerate().filter(|(k, crossing)| *k == 0 || crossing.u <= most);
    reached.last().map_or(f64::INFINITY, |(_, crossing)| crossing.u)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_that_penetrates_itself_does_not_end_at_its_other_part() {
        let crossing = |&u: &f64| BodyCrossing { u: u.abs(), leaves: u > 0.0 };
        let at = |list: &[f64]| end_of_body(list.iter().map(crossing).collect(), || 2.0);
        assert_eq!(at(&[2.0]), 2.0);
        // Out of the other part, then out of its own.
        assert_eq!(at(&[2.0, 0.1]), 2.0);
        // Through a ring, whose far wall is met in a node.
        assert_eq!(at(&[1.0, -7.0, 8.0, 8.0 + 1e-13]), 1.0);
        assert_eq!(at(&[0.1, 1.0, -7.0, 8.0]), 1.0);
        assert_eq!(at(&[]), f64::INFINITY);
        // Beyond a gap that was missed.
        assert_eq!(at(&[1.0, -3.0]), 1.0);
        // A wall that another one, and that a third one lies against, each a little within the last.
        assert_eq!(at(&[-0.999, 1.0, -1.998, 2.0, 3.0]), 1.0);
        assert_eq!(at(&[0.001, -0.999, 1.0, 2.0]), 1.0);
        // Legs of a spring, the last of which it grazes where it enters it.
        assert_eq!(at(&[1.5, -5.5, 8.8, -13.8, 17.2, -22.1, 25.6, 28.2]), 1.5);
    }
}
