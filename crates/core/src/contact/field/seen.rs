//! What the nodes of a field see of its target.

use super::configuration::{Configuration, SeenPart, TargetInPlace};
use super::contact::FieldContact;
use super::corner::{Pointing, SUNK};
use super::corners::WAYS;
use super::cover::{CornerTouch, Patch};
use super::face::{CORNERS, FieldFace, PlacedFace};
use super::faces::{FaceProjection, FaceRay, FacesInPlace, LEAST_COSINE};
use super::point::smoothstep;
use super::stencil::{NodeSums, StencilInPlace};
use super::support::{FieldSearch, FoundPatch, Support};
use super::tip::TipFoot;
use crate::contact::Overlap;
use crate::contact::record::entry;
use crate::mesh::CREASE;
use crate::system::History;
use crate::tensor::BoundingBox;
use std::cell::OnceCell;

/// What corners of the body take of the nodes of a face, patch by patch.
type Taken<'a> = dyn Fn(&Patch) -> [f64; CORNERS] + 'a;

impl FieldContact {
    /// What each node sees at unknowns `u`, within `reach` and no deeper than `depths` of the accepted state `before`.
    pub(super) fn find(
        &self,
        (now, tips, pointings, taken): (&Configuration, Vec<Option<TipFoot>>, &[Pointing], &Taken),
        reach: f64,
        (depths, before): (&[f64], (&Configuration, &[f64])),
        history: Option<&History>,
        mut touched: impl FnMut(&Configuration, &Patch, &mut Vec<usize>),
    ) -> FieldSearch {
        let (mut near, mut patches) = (Vec::new(), Vec::new());
        let (mut supports, mut least) = (vec![Support::default(); self.slots()], vec![f64::INFINITY; self.slots()]);
        let mut see = |slot: usize, (number, corner): (usize, usize), [middle, nearest]: [f64; 2], depth: f64| {
            if -middle > depth {
                // Deeper than the middle of the body, and not the body's own far side.
                supports[slot].through |= -middle < THROUGH * depth;
                return;
            }
            supports[slot].patches.push((number, corner));
            least[slot] = least[slot].min(nearest);
        };
        let boundary = OnceCell::new();
        let whole = || boundary.get_or_init(|| self.boundary.in_place(self.site(), before.1));
        for (number, &most) in depths.iter().enumerate() {
            let mut parts = now.patches(number, reach, &mut near);
            parts.retain(|seen| !history.is_some_and(|history| self.is_beside(seen, (before.0, history))));
            self.leave_to_corners(&mut parts, taken);
            let corners = self.parts.surface.faces[number].corners();
            for seen in parts {
                let depth = self.depth_at(&seen, most, (before.0, &whole));
                let piece = self.piece_of(seen.patch.target);
                let bears = |corner: &usize| seen.patch.left[*corner] > 0.0;
                for corner in (0..corners).filter(bears) {
                    let slot = self.slot(self.parts.surface.field[number][corner], piece);
                    see(slot, (patches.len(), corner), [seen.middle, seen.least], depth);
                }
                patches.push(FoundPatch { patch: seen.patch, place: seen.place, nodes: Vec::new() });
            }
        }
        for (number, found) in tips.into_iter().enumerate() {
            if let Some(found) = found.filter(|found| found.patch.tip.is_some_and(|tip| tip.share > 0.0)) {
                let depth = depths[found.patch.face];
                see(self.nodal_slots() + number, (patches.len(), 0), [found.gap; 2], depth);
                patches.push(FoundPatch { patch: found.patch, place: found.patch.near, nodes: Vec::new() });
            }
        }
        for (k, (corner, ways)) in self.corners.iter().zip(pointings.chunks(WAYS)).enumerate() {
            let touch = |(way, on): (usize, &Pointing)| CornerTouch { number: k * WAYS + way, along: on.along };
            let touches = ways.iter().enumerate().map(touch);
            // What comes past the end of a face comes from before it.
            let deepest =
                |touch: &CornerTouch| if touch.number.is_multiple_of(WAYS) { corner.size } else { SUNK * corner.size };
            let sees = |touch: CornerTouch| Some((touch, now.touched_by(touch, [-deepest(&touch), reach])?));
            let Some((touch, (face, hit))) = touches.filter_map(sees).next() else { continue };
            let (patch, place) = self.corner_patch(touch, (face, hit.s));
            let slot = self.nodal_slots() + touch.number;
            see(slot, (patches.len(), 0), [hit.gap; 2], depths[patch.face].max(corner.size));
            patches.push(FoundPatch { patch, place, nodes: Vec::new() });
        }
        for (support, least) in supports.iter_mut().zip(least) {
            if least > reach {
                support.patches.clear();
            }
            for &(number, _) in &support.patches {
                let FoundPatch { patch, nodes, .. } = &mut patches[number];
                if nodes.is_empty() {
                    self.list_nodes(patch, nodes);
                    touched(now, patch, nodes);
                    nodes.sort_unstable();
                    nodes.dedup();
                }
                support.nodes.extend_from_slice(nodes);
            }
            if let (Some((number, corner)), false) = (support.patches.first(), self.parts.surface.plane) {
                let patch = &patches[*number].patch;
                support.nodes.extend(match patch.corner {
                    Some(touch) => self.corners[touch.number / WAYS].line(),
                    None => self.parts.surface.line(self.parts.surface.field[patch.face][*corner]),
                });
            }
            support.nodes.sort_unstable();
            support.nodes.dedup();
        }
        let mut found = FieldSearch::new(patches, supports, now.arcs.clone());
        for slot in 0..found.supports.len() {
            let mut areas = [0.0; 2];
            for (number, corner) in found.faces(slot) {
                let face = &self.parts.surface.faces[number];
                areas[0] += self.parts.surface.corner_area(face, &now.placed[number], corner).0;
                areas[1] += self.parts.surface.corner_area(face, &face.at_rest(&self.parts.mesh), corner).0;
            }
            found.supports[slot].stretch = if areas[1] > 0.0 { areas[0] / areas[1] } else { 1.0 };
        }
        found
    }

    /// What corners of the body leave to the nodes of a face, part by part. Dual functions are negative somewhere: where a corner of an edge of the plane
    /// has only some of the parts that see a smooth piece these have none. Nor has the other node of such an edge what that sees beside the corner alone,
    /// which it would bear over next to no area.
    fn leave_to_corners(&self, parts: &mut [SeenPart], taken: &Taken) {
        for SeenPart { patch, .. } in &mut *parts {
            patch.taken = taken(patch);
            patch.left = patch.taken.map(|taken| 1.0 - taken);
        }
        let none = [0.0; CORNERS];
        if !self.parts.surface.plane || parts.iter().all(|seen| seen.patch.taken == none) {
            return;
        }
        for k in 0..parts.len() {
            let Patch { target, taken: [first, second, ..], .. } = parts[k].patch;
            let mut same = parts.iter().filter(|seen| self.piece_of(seen.patch.target) == self.piece_of(target));
            let differs = same.any(|seen| seen.patch.taken[..2] != [first, second]);
            let patch = &mut parts[k].patch;
            patch.dual = if differs { 0.0 } else { patch.dual };
            let face = &self.parts.surface.faces[patch.face];
            let ([a, _], [b, _]) = (face.corner_place(0), face.corner_place(1));
            let part = (0.5 * (patch.near[0] + patch.near[1]) - a) / (b - a);
            let beside = |part: f64| smoothstep((part - 0.5) / (ALL - 0.5))[0];
            patch.left[0] *= 1.0 - second * beside(part);
            patch.left[1] *= 1.0 - first * beside(1.0 - part);
        }
    }

    /// Nodes on which a patch depends.
    fn list_nodes(&self, patch: &Patch, nodes: &mut Vec<usize>) {
        nodes.extend_from_slice(&self.parts.surface.faces[patch.face].nodes);
        let beside = patch.tip.into_iter().flat_map(|landing| landing.beside).flatten();
        beside.for_each(|foot| nodes.extend_from_slice(&self.parts.surface.faces[foot.face].nodes));
        if let Some(faces) = self.parts.target.as_faces() {
            nodes.extend_from_slice(&faces.surface.faces[patch.target].nodes);
        }
        if self.needs_normals() {
            for corner in 0..self.parts.surface.faces[patch.face].corners() {
                let support = &self.parts.surface.nodes[self.parts.surface.field[patch.face][corner]].support;
                support.iter().for_each(|&(f, _)| nodes.extend_from_slice(&self.parts.surface.faces[f].nodes));
            }
        }
    }

    /// Half the distance from the middle of each face, along its inward normal, to where the ray leaves the body.
    pub(super) fn depths(&self, u: &[f64]) -> Vec<f64> {
        let boundary = self.boundary.in_place(self.site(), u);
        let placed = |face: &FieldFace| face.placed(&self.parts.mesh, &self.parts.dofs, u);
        let depth = |face: &FieldFace| self.behind((face, &placed(face)), face.middle(), &boundary);
        self.parts.surface.faces.iter().map(depth).collect()
    }

    /// The same from a place of a face.
    fn behind(&self, (face, placed): (&FieldFace, &PlacedFace), xi: [f64; 2], boundary: &FacesInPlace) -> f64 {
        let (ray, least) = FaceRay::inward((face, placed), xi, self.parts.surface.plane);
        0.5 * boundary.depth(face.side, &ray, least)
    }

    /// How deep a patch may lie: of a surface that touches itself no deeper than half of the body behind its own middle, where that is less than
    /// behind the middle of the face, as beside a corner.
    fn depth_at<'a>(
        &self,
        seen: &SeenPart,
        depth: f64,
        (before, whole): (&Configuration, &dyn Fn() -> &'a FacesInPlace<'a>),
    ) -> f64 {
        if !self.roles.itself || -seen.middle <= DEEP * depth {
            return depth;
        }
        let number = seen.patch.face;
        let face = &self.parts.surface.faces[number];
        depth.min(self.behind((face, &before.placed[number]), seen.place, whole()))
    }

    /// Whether a patch lies behind a face of a body beside whose border it came there. What has entered one side of a body near an edge by a hair lies
    /// behind the other side as deep as it is away from that, and is no business of it.
    fn is_beside(&self, seen: &SeenPart, accepted: (&Configuration, &History)) -> bool {
        let deep = BEHIND * self.parts.surface.size(seen.patch.face, &self.parts.mesh);
        -seen.middle > deep && self.lay_beside((&seen.patch, seen.place), deep, accepted)
    }

    /// Whether a place of a patch that has closed was beside the border of its face so, and has come out through it.
    pub(super) fn comes_out(&self, found: &FoundPatch, accepted: (&Configuration, &History)) -> bool {
        let deep = OUT * self.parts.surface.size(found.patch.face, &self.parts.mesh);
        self.lay_beside((&found.patch, found.place), deep, accepted)
    }

    /// Whether a place of a patch was deeper than this behind its face at the accepted state, bore nothing though it does not fit, and was outside of the body past the border of the
    /// smooth piece of that face, or nearer to another piece, on either side of that.
    fn lay_beside(
        &self,
        (patch, place): (&Patch, [f64; 2]),
        deep: f64,
        (before, history): (&Configuration, &History),
    ) -> bool {
        let (TargetInPlace::Faces(target), Some(faces)) = (&before.target, self.parts.target.as_faces()) else {
            return false;
        };
        let (surface, piece) = (&self.parts.surface, self.piece_of(patch.target));
        let mut corners = 0..surface.faces[patch.face].corners();
        let values = |corner: usize| history.slot(self.slot(surface.field[patch.face][corner], piece));
        if corners.any(|corner| values(corner)[entry::STATUS] > 0.0 || Overlap::fits(values(corner))) {
            return false;
        }
        let at = before.face(patch.face).at(place);
        let ray = FaceRay { x: at.x, n: at.normal.unit() };
        let Some(lay) = target.project(patch.target, &ray).map(|hit| -hit.gap).filter(|lay| *lay > deep) else {
            return false;
        };
        let own = |face: usize, hit: &FaceProjection| {
            self.piece_of(face) == piece && -hit.normal().dot(ray.n) > LEAST_COSINE && hit.gap <= deep
        };
        let Some((_, hit)) = target.nearest(&ray, [-2.0 * lay, deep], own) else { return true };
        if hit.gap >= -deep {
            return false;
        }
        let mut near = Vec::new();
        target.near(&BoundingBox::of([ray.x]), lay, &mut near);
        let normal = |face: usize| faces.surface.middle_normal(&faces.surface.faces[face], target.placed(face));
        let seen = normal(patch.target);
        // A chamfer may turn by less than a crease at each of its ends.
        let other = |face: usize| self.piece_of(face) != piece || normal(face).dot(seen) < CREASE.cos();
        near.iter().filter(|&&face| other(face) && self.may_touch(patch.face, face)).any(|&face| {
            let n = -normal(face);
            let out = target.project(face, &FaceRay { x: ray.x, n });
            out.is_some_and(|hit| target.holds(face, hit.s, PAST) && hit.gap.abs() < lay)
        })
    }

    /// What each node sees at displacements `u`, as far as the accepted state alone tells; of the tips all feet, where that has a
    /// history.
    pub(super) fn supports(&self, u: &[f64], reach: f64, history: Option<&History>) -> FieldSearch {
        let (now, depths) = (Configuration::new(self, u), self.depths(u));
        let duals = history.map_or_else(|| self.first_limits(&now.placed), |history| self.known_limits(history));
        let now = Configuration { duals: &duals, ..now };
        let tips = match history {
            Some(history) => now.tips(self.longest, None, self.known_feet(history), None),
            None => now.tips(self.longest, Some(&[]), |_| None, None),
        };
        let pointings = history.map_or(Vec::new(), |history| self.known_pointings(history));
        let taken = |patch: &Patch| match history {
            Some(history) => self.known_taken(patch, history),
            None => now.taken(patch),
        };
        self.find((&now, tips, &pointings, &taken), reach, (&depths, (&now, u)), history, |_, _, _| {})
    }

    /// Values of a stencil's unknowns.
    fn values(&self, support: &Support, u: &[f64]) -> Vec<f64> {
        let nodes = support.nodes.iter().flat_map(|&node| self.parts.dofs.displacements(node));
        let tool = self.parts.target.as_tool().into_iter().flat_map(|rigid| rigid.unknowns());
        nodes.chain(tool).map(|dof| u[dof]).collect()
    }

    /// How much deeper closed nodes lie in an accepted state by the arcs of that than they did by those that it was found with.
    pub(super) fn redrawn(&self, u: &[f64], history: &History) -> Vec<f64> {
        let mut deeper = vec![0.0; self.slots()];
        self.each_seen(u, (self.reach(&vec![0.0; u.len()]), Some(history)), |slot, _, sums| {
            let values = history.slot(slot);
            if values[entry::STATUS] > 0.0 && slot < self.tip_slots().end {
                deeper[slot] = sums.y[0] - values[entry::PENETRATION];
            }
        });
        deeper
    }

    /// Calls `take` with the slots that see something at displacements `u`.
    pub(super) fn each_seen(
        &self,
        u: &[f64],
        (reach, history): (f64, Option<&History>),
        mut take: impl FnMut(usize, &StencilInPlace, &NodeSums),
    ) {
        let mut sums = NodeSums::default();
        let found = self.supports(u, reach, history);
        for (slot, support) in found.supports.iter().enumerate().filter(|(_, s)| !s.patches.is_empty()) {
            let values = self.values(support, u);
            let stencil = StencilInPlace::new(self, (&found, slot), &values);
            if stencil.sum((&|_, _, _| None, None), false, &mut sums).is_some() {
                take(slot, &stencil, &sums);
            }
        }
    }
}

/// Depth, in units of the largest admissible one, up to which a face is surely not the body's own far side.
const THROUGH: f64 = 1.8;
/// Depth over the size of a face from which on it is asked through which piece of a body a place came to lie behind a face,
const BEHIND: f64 = 0.02;
/// and from which on it does not come out there in one increment.
const OUT: f64 = 0.1;
/// How far past the edges of a face, in reference coordinates, it counts as one that is near.
const PAST: f64 = 0.1;
/// Mean function of a node of a patch from which on that is all of the node.
const ALL: f64 = 0.9;
/// Part of the largest admissible depth from which on a patch of a surface that touches itself is asked for its own.
const DEEP: f64 = 0.25;
