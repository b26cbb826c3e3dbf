//! What a field saw at the accepted state: the faces on which its points, tips and corners lay.

use super::FieldAttempt;
use crate::contact::field::configuration::{Configuration, TargetInPlace};
use crate::contact::field::contact::FieldTarget;
use crate::contact::field::corners::WAYS;
use crate::contact::field::cover::{CornerTouch, FEET, Landing, Patch};
use crate::contact::field::face::{FieldFace, ShapeFunctions, moved};
use crate::contact::field::faces::{FaceProjection, FaceRay, LEAST_COSINE};
use crate::contact::field::nodes::NodesInPlace;
use crate::contact::field::point::{Facing, Touched};
use crate::contact::field::space::{Spread, spread};
use crate::contact::field::spot::{GAUSS, IntervalPoint};
use crate::contact::field::stencil::StencilInPlace;
use crate::contact::record::entry;
use crate::interface::Status;
use crate::tensor::Vec3;

impl FieldAttempt<'_> {
    /// Nodes of the faces that the points of a patch saw at the accepted state.
    pub(super) fn list_touched(&self, now: &Configuration, patch: &Patch, nodes: &mut Vec<usize>) {
        if patch.tip.is_some() {
            let seen = self.before_tip(patch).map(|(face, _)| face);
            seen.into_iter().for_each(|face| nodes.extend_from_slice(&self.contact.parts.surface.faces[face].nodes));
            return;
        }
        if let Some(touch) = patch.corner {
            let seen = self.before_corner(touch).map(|(_, face, _)| face);
            seen.into_iter().for_each(|face| nodes.extend_from_slice(&face.nodes));
            return;
        }
        let Some(faces) = self.contact.parts.target.as_faces() else { return };
        let mut places = Vec::new();
        if let (TargetInPlace::Faces(target), false) = (&now.target, self.contact.parts.surface.plane) {
            let (cubic, own) = (self.contact.is_cubic(patch), now.face(patch.face));
            spread(cubic, own.corners(), target.corners(patch.target), |place: Spread<f64>| places.push(place.xi));
        } else {
            let [from, to] = patch.near;
            let place = |point: &IntervalPoint| [0.5 * (from + to) + 0.5 * (to - from) * point.eta, 0.0];
            places.extend(GAUSS.iter().map(place));
        }
        let own = &self.contact.parts.surface.faces[patch.face];
        places.extend(patch.vertices().map(|corner| own.corner_place(corner)));
        for xi in places {
            if let Some((face, _)) = self.seen_before(patch, xi, |_| true) {
                nodes.extend_from_slice(&faces.surface.faces[face].nodes);
            }
        }
    }

    /// The face that a place saw at the accepted state: of those that are `known` the nearest that looked at it, or what continues
    /// the one seen now.
    fn seen_before(
        &self,
        patch: &Patch,
        xi: [f64; 2],
        known: impl Fn(usize) -> bool,
    ) -> Option<(usize, FaceProjection)> {
        let TargetInPlace::Faces(before) = &self.before.target else { return None };
        let at = self.before.face(patch.face).at(xi);
        let ray = FaceRay { x: at.x, n: at.normal.unit() };
        let range = [-2.0 * self.depths[patch.face], 2.0 * self.reach];
        let admits = |face: usize, hit: &FaceProjection| {
            self.contact.may_touch(patch.face, face) && -hit.normal().dot(ray.n) > LEAST_COSINE && known(face)
        };
        let present = before.project(patch.target, &ray).map(|hit| (patch.target, hit));
        let same = |&(face, hit): &(usize, FaceProjection)| {
            let within = before.holds(face, hit.s, 1e-9) && (range[0]..=range[1]).contains(&hit.gap);
            within && admits(face, &hit)
        };
        // In space the search is dear, and most places see what they saw.
        if let Some(present) = present.filter(|present| !self.contact.parts.surface.plane && same(present)) {
            return Some(present);
        }
        before.nearest(&ray, range, admits).or(present)
    }

    /// The face on which a foot of a tip lay at the accepted state.
    pub(super) fn foot_before(&self, foot: usize) -> Option<usize> {
        Some(self.tips_before.get(foot)?.as_ref()?.patch.face)
    }

    /// Face over which a foot of a tip lay at the accepted state, and where; if it has none, that of another foot of the tip.
    fn before_tip(&self, patch: &Patch) -> Option<(usize, Landing)> {
        let first = patch.target / FEET * FEET;
        let feet = [patch.target].into_iter().chain(first..first + FEET);
        let found = feet.filter_map(|foot| self.tips_before.get(foot).copied().flatten()).next()?;
        Some((found.patch.face, found.patch.tip?))
    }

    /// The face of the other side that a corner saw at the accepted state along the direction in which it points, by its number, and where.
    fn before_corner(&self, touch: CornerTouch) -> Option<(usize, &FieldFace, ShapeFunctions)> {
        let own = self.contact.corners[touch.number / WAYS].own;
        let (face, shape) = self.pointings[touch.number].saw?;
        Some((face, self.contact.face_of(!own, face)?, shape))
    }

    pub(super) fn recall(&self, at: &NodesInPlace, patch: &Patch, xi: [f64; 2]) -> Option<Touched> {
        if patch.tip.is_some() {
            let (number, landing) = self.before_tip(patch)?;
            let face = &self.contact.parts.surface.faces[number];
            let shape = face.shape(landing.xi);
            let (now, tip) = (shape.value(at.placed(face).nodes()), at.tool.as_ref()?.place(landing.own));
            let face = Some((number, shape));
            return Some(Touched { now, slopes: [Vec3::zero(); 2], facing: None, face, tip });
        }
        if let Some(touch) = patch.corner {
            let (number, face, shape) = self.before_corner(touch)?;
            let (now, face) = (shape.value(at.placed(face).nodes()), Some((number, shape)));
            return Some(Touched { now, slopes: [Vec3::zero(); 2], facing: None, face, tip: now });
        }
        let face = self.before.face(patch.face);
        let place = face.at(xi);
        match (&self.before.target, &self.contact.parts.target) {
            (TargetInPlace::Tool(before), FieldTarget::Tool(_)) => {
                let (foot, now) = (before.closest(patch.target, place.x), at.tool.as_ref()?);
                let carry = |v: Vec3| now.rotate(before.rotate_back(v));
                let slopes = place.tangents.map(|tangent| carry(foot.slide(tangent)));
                let [a, b] = face.at(face.face.middle()).tangents;
                let m = a.cross(b);
                let facing = Facing {
                    n: -carry(foot.normal),
                    slopes: place.tangents.map(|tangent| -carry(foot.turned(tangent))),
                    contravariant: [b.cross(m), m.cross(a)].map(|base| carry(base * m.dot(m).recip())),
                };
                Some(Touched {
                    now: now.place(before.withdraw(foot.point)),
                    slopes,
                    facing: Some(facing),
                    face: None,
                    tip: Vec3::zero(),
                })
            }
            (TargetInPlace::Faces(_), FieldTarget::Faces(faces)) => {
                // A state beside the one that was searched may have seen others by a hair.
                let nodes = |face: usize| faces.surface.faces[face].nodes.iter();
                let known = |face: usize| nodes(face).all(|node| at.place(*node).is_some());
                let (number, hit) = self.seen_before(patch, xi, known)?;
                let n = place.normal.unit();
                let placed = at.placed(&faces.surface.faces[number]);
                let [a, b] = hit.shape.tangents(placed.nodes(), self.contact.parts.surface.plane);
                let slopes = [0, 1].map(|k| {
                    let (_, s) =
                        hit.follow(n, place.tangents[k] + place.normal.turned(place.normal_slopes[k]) * hit.gap);
                    a * s[0] + b * s[1]
                });
                let (now, face) = (hit.shape.value(placed.nodes()), Some((number, hit.shape)));
                Some(Touched { now, slopes, facing: None, face, tip: Vec3::zero() })
            }
            _ => None,
        }
    }

    /// How deep a corner or a tip lay in what it begins to touch in this increment.
    pub(super) fn laid(&self, slot: usize) -> f64 {
        let begins = self.history.slot(slot)[entry::OVERLAP] == 0.0;
        let tip = || {
            let foot = slot.checked_sub(self.contact.nodal_slots())?;
            self.tips_before.get(foot)?.as_ref()?.patch.tip
        };
        let laid = || match self.pointing(slot) {
            Some(pointing) => pointing.laid,
            None => tip().map_or(0.0, |landing| landing.laid),
        };
        if begins { laid() } else { 0.0 }
    }

    /// The line that the tangents of a node followed at the accepted state, moved with the tool.
    pub(super) fn carried(&self, stencil: &StencilInPlace) -> Option<Vec3> {
        let (TargetInPlace::Tool(before), Some(now)) = (&self.before.target, &stencil.at.tool) else { return None };
        let (mesh, dofs) = (&self.contact.parts.mesh, &self.contact.parts.dofs);
        let [from, to] =
            stencil.line()?.nodes.map(|node| moved(mesh.points[node], &self.accepted[dofs.displacements(node)]));
        Some(now.rotate(before.rotate_back(to - from)))
    }

    /// The gap at the accepted state of a node that closes.
    pub(super) fn gap_before(&self, slot: usize) -> f64 {
        let (old, node) = (self.history.slot(slot), self.contact.node_of(slot));
        match node.filter(|_| old[entry::SEGMENT] < 0.0) {
            Some(node) => self.before.parted(node, slot % self.contact.pieces),
            None if old[entry::SEGMENT] < 0.0 && self.contact.corner_of(slot).is_some() => {
                self.pointings[slot - self.contact.nodal_slots()].gap.max(0.0)
            }
            None => -(old[entry::PENETRATION] + self.closure(slot)),
        }
    }

    /// By how much a node that slipped has slid over the face of a body that it saw at the accepted state, along its shear, where it sees none any
    /// more.
    pub(super) fn slid_out_of_sight(&self, slot: usize, node: usize, now: &Configuration) -> [f64; 2] {
        let (old, surface) = (self.history.slot(slot), &self.contact.parts.surface);
        let shear = [old[entry::SHEAR], old[entry::SHEAR2]];
        let size = shear[0].hypot(shear[1]);
        if size == 0.0 || old[entry::STATUS] != f64::from(Status::Slip as u8) || old[entry::SEGMENT] < 0.0 {
            return [0.0; 2];
        }
        let moved = |own: bool, f: usize, xi: &dyn Fn(&FieldFace) -> [f64; 2]| {
            let ((face, before), (_, now)) = (self.before.of_side(own, f)?, now.of_side(own, f)?);
            let shape = face.shape(xi(face));
            let [a, b] = shape.tangents(before.nodes(), surface.plane);
            Some((shape.value(now.nodes()) - shape.value(before.nodes()), a.cross(b).unit()))
        };
        let (f, corner) = surface.nodes[node].support[0];
        let of_node = moved(true, f, &|face| face.corner_place(corner));
        let of_target = moved(false, old[entry::SEGMENT] as usize, &FieldFace::middle);
        let (Some((own, _)), Some((carried, n))) = (of_node, of_target) else { return [0.0; 2] };
        let way = own - carried;
        let slid = (way - n * way.dot(n)).norm();
        shear.map(|component| component / size * slid)
    }
}
