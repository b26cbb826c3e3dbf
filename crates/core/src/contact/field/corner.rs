//! A corner of a body over a face of another, in space a point of an edge or a vertex: node-to-segment contact (Hallquist, Goudreau & Benson, Comput. Meth. Appl.
//! Mech. Eng. 51, 1985; Wriggers, Computational Contact Mechanics, 2006) beside the mortar field (Farah, Wall & Popp, Int. J. Numer.
//! Meth. Eng. 114, 2018).
//!
//! The field presses along the normals of the surface, and its gaps are means over faces. A corner that touches by itself, both of its flanks
//! rising from what it touches, presses along the normal of that, whichever of both bodies it belongs to. It is a stencil of its own, with
//! the area around it: with `c` the corner and `d` the direction against the outward normal of the face that it touches, the gap is the
//! distance to that along `d`.
//!
//! A flank that lies flat belongs to the field. Between two small angles of the lower flank to the face the corner takes over, and what it has the field
//! does not have at the node. This share and the direction are those of the accepted state, and stay through an increment.

use super::column::PointColumn;
use super::configuration::{Configuration, TargetInPlace};
use super::contact::FieldContact;
use super::corners::{BodyCorner, Flank, WAYS};
use super::cover::{CornerTouch, Patch};
use super::face::{CORNERS, FieldFace, PlacedFace, ShapeFunctions};
use super::faces::{FaceProjection, FaceRay, LEAST_COSINE, project};
use super::nodes::NodesInPlace;
use super::point::{PatchPoint, PointRates, Sight, smoothstep};
use super::points::Recall;
use super::surface::FieldSurface;
use crate::contact::record::{entry, normal_force};
use crate::system::History;
use crate::tensor::{BoundingBox, Vec3};
use std::ops::Range;

/// How a corner touches in an increment, one of the [`WAYS`].
#[derive(Debug, Clone, Copy, Default)]
pub struct Pointing {
    /// From it to the other body, a unit vector times its share of the force; zero where it does not touch by itself.
    pub along: Vec3,
    /// The gap at the accepted state,
    pub gap: f64,
    /// the face that it saw there along that direction, by its number, and where,
    pub saw: Option<(usize, ShapeFunctions)>,
    /// and how deep the field that bore it let it lie in that: it bears where it goes deeper.
    pub laid: f64,
}

/// A face that a corner may touch: where, how far away that is, its normal, and the angles between which a flank rises from it.
#[derive(Clone, Copy)]
struct Touchable {
    face: usize,
    s: [f64; 2],
    gap: f64,
    n: Vec3,
    range: [f64; 2],
    /// and below which, the other way, it cuts into it.
    dips: f64,
    /// Whether a field that bears lies flat on it there, and the corner does not bear yet.
    flat: bool,
}

/// Angles, beyond those by which both sides bend, of the lower flank to what it touches between which a corner takes over from the field: a block that
/// lies flat is strained by less than the first.
const RISES: [f64; 2] = [0.02, 0.08];
/// The same at most over the strain `p / E*` of what bears there: a flank at a larger angle is pressed flat over a small part of a face only, and what
/// is slender bends away from the corner at whatever load. Beneath the corner of a flat punch the angle is 3 to 6 of it.
const STRAINS: [f64; 2] = [16.0, 64.0];
/// and at least: the angle that sides which lie flat may have by their meshes.
const MESHED: [f64; 2] = [1e-5, 2e-5];
/// Part of a flank that lies flat on what it touches and then ends over it between which the field has too little of it to bear,
const ENDS: [f64; 2] = [0.05, 0.25];
/// and at how many places that is looked at.
const PLACES: usize = 8;
/// How far past the end of a face, in reference coordinates, its normal may pass through a corner: below the bottom of a valley pass none.
const BESIDE: f64 = 0.1;
/// The same of the direction of a corner, by rounding.
const ROUNDED: f64 = 1e-6;
/// Gap over the size of the flanks by which another face may be farther and still say that a flank lies flat.
const ALIKE: f64 = 0.05;
/// Depth over the size of the flanks from which on a corner that bears nothing lies in a body by drawing or because it came in elsewhere.
pub(super) const SUNK: f64 = 0.02;
/// Depth over that size in which a corner is looked for.
const DEEPEST: f64 = 1.0;
/// Distance over that size from the plane of a face beyond whose end a corner lies up to which it may come onto that.
const PAST: f64 = 0.3;
/// Reference coordinate of a place so far beyond.
const FARTHEST: f64 = 1.0;
/// Depth over that size to which no corner comes unseen in an increment.
const UNSEEN: f64 = 0.1;

/// The angles between which a flank lies flat no more, of those of what is pressed flat all over a face, under such a strain.
pub(super) fn pressed_flat(angles: [f64; 2], strain: f64) -> [f64; 2] {
    std::array::from_fn(|k| angles[k].min(STRAINS[k] * strain).max(MESHED[k]))
}

impl Configuration<'_> {
    /// A face of a side, and where it is: of the surface, or else of the target.
    pub(super) fn of_side(&self, own: bool, f: usize) -> Option<(&FieldFace, &PlacedFace)> {
        let placed = match &self.target {
            _ if own => &self.placed[f],
            TargetInPlace::Faces(target) => target.placed(f),
            TargetInPlace::Tool(_) => return None,
        };
        Some((self.contact.face_of(own, f)?, placed))
    }

    fn place_of(&self, corner: &BodyCorner) -> Option<Vec3> {
        let Flank { face, xi, .. } = corner.flanks[0];
        let (face, placed) = self.of_side(corner.own, face)?;
        Some(face.shape(xi).value(placed.nodes()))
    }

    /// Where a node of the flanks of a corner is.
    fn node_of_side(&self, corner: &BodyCorner, node: usize) -> Vec3 {
        let find = |flank: &Flank| {
            let (face, placed) = self.of_side(corner.own, flank.face)?;
            Some(placed.nodes()[face.nodes.iter().position(|&other| other == node)?])
        };
        corner.flanks.iter().find_map(find).unwrap_or_default()
    }

    /// Calls `take` with the faces of the other side that are within `reach` of a corner and may touch it.
    fn across(&self, corner: &BodyCorner, c: Vec3, reach: f64, mut take: impl FnMut(usize, &FieldFace, &PlacedFace)) {
        let (flank, mut near) = (corner.flanks[0].face, Vec::new());
        match &self.target {
            TargetInPlace::Faces(target) if corner.own => {
                target.near(&BoundingBox { min: c, max: c }, reach, &mut near);
            }
            _ => near.extend(0..self.placed.len()),
        }
        for f in near {
            let Some((face, placed)) = self.of_side(!corner.own, f) else { continue };
            let is_near = BoundingBox::of(placed.nodes().iter().copied()).distance(c) <= reach;
            let touches = || if corner.own { self.contact.may_meet(flank, f) } else { self.contact.may_meet(f, flank) };
            if is_near && !corner.nodes.iter().any(|node| face.nodes.contains(node)) && touches() {
                take(f, face, placed);
            }
        }
    }

    /// How the corners touch what lies no farther than `far` in an accepted configuration, and what they see within `reach`.
    pub(super) fn pointings(&self, history: &History, (far, reach): (f64, f64)) -> Vec<Pointing> {
        let corners = self.contact.corners.iter().enumerate();
        let ways = corners.flat_map(|(number, corner)| self.pointing((number, corner), history, far));
        let saw = |(number, on): (usize, Pointing)| {
            let found = self.seen_along(CornerTouch { number, along: on.along }, reach);
            Pointing { saw: found.map(|(face, hit)| (face, hit.shape)), ..on }
        };
        ways.enumerate().map(saw).collect()
    }

    /// The face that a corner sees along the direction in which it points, this far before it or behind, and where.
    pub(super) fn seen_along(&self, touch: CornerTouch, reach: f64) -> Option<(usize, FaceProjection)> {
        self.touched_by(touch, [-2.0 * reach, 2.0 * reach])
    }

    fn pointing(&self, (number, corner): (usize, &BodyCorner), history: &History, far: f64) -> [Pointing; WAYS] {
        let (Some(c), Some(other)) = (self.place_of(corner), self.contact.side(!corner.own)) else {
            return Default::default();
        };
        let (bears, first) = (self.contact.bears(number, history), self.contact.nodal_slots() + WAYS * number);
        let (mut before, mut past): (Vec<Touchable>, Vec<Touchable>) = Default::default();
        self.across(corner, c, far.max(DEEPEST * corner.size), |f, face, placed| {
            let n = other.middle_normal(face, placed);
            let Some(hit) = project((face, placed), &FaceRay { x: c, n: -n }, other.plane) else { return };
            // What lay flat on a face that bears may be as deep in it as the mean of its gaps lets it.
            let flat = !bears && !corner.own && self.contact.face_bears(f, history);
            let deepest = if bears || flat { DEEPEST } else { SUNK } * corner.size;
            let held = face.holds(hit.s, BESIDE) && hit.gap <= far && -hit.gap <= deepest;
            let near = hit.gap.abs() <= PAST * corner.size;
            let beyond = near && !face.holds(hit.s, 0.0) && face.holds(hit.s, FARTHEST);
            // A corner of the surface has the stress of its node, which the field hands over at once.
            let strain = match corner.own {
                true => f64::INFINITY,
                false => self.contact.strained((f, corner.area), first..first + WAYS, history),
            };
            let bend = corner.bend + other.bends[f];
            let (range, dips) = (pressed_flat(RISES, strain).map(|angle| angle + bend), RISES[0] + bend);
            let s = face.nearest(hit.s);
            let touchable = Touchable { face: f, s, gap: hit.gap, n: hit.normal(), range, dips, flat };
            before.extend(held.then_some(touchable));
            let end = face.shape(s).value(placed.nodes());
            past.extend(beyond.then_some(Touchable { gap: (c - end).norm(), ..touchable }));
        });
        let nearest = |found: &[Touchable]| found.iter().min_by(|a, b| a.gap.abs().total_cmp(&b.gap.abs())).copied();
        let pointing = |on: Touchable, share: f64| Pointing {
            along: self.normal_in_valley(!corner.own, on.face, on.s) * -share,
            gap: on.gap,
            saw: None,
            laid: if on.flat { (-on.gap).max(0.0) } else { 0.0 },
        };
        let mut ways = [Pointing::default(); WAYS];
        let first = nearest(&before);
        if let Some(first) = first {
            let alike = |on: &&Touchable| {
                other.pieces[on.face] == other.pieces[first.face] && (on.gap - first.gap).abs() <= ALIKE * corner.size
            };
            let shares = before.iter().filter(alike).map(|on| self.share_on(corner, c, on));
            ways[0] = pointing(first, shares.fold(1.0, f64::min));
        }
        past.retain(|on| first.is_none_or(|first| other.pieces[on.face] != other.pieces[first.face]));
        if let Some(past) = nearest(&past) {
            ways[1] = pointing(past, self.share_on(corner, c, &past));
        }
        ways
    }

    /// Whether a corner lies in the other body, deeper than a part of its flanks.
    fn is_sunk(&self, corner: &BodyCorner) -> bool {
        let (Some(c), surface) = (self.place_of(corner), &self.contact.parts.surface) else { return false };
        let mut nearest = f64::INFINITY;
        self.across(corner, c, corner.size, |_, face, placed| {
            let ray = FaceRay { x: c, n: -surface.middle_normal(face, placed) };
            let hit = project((face, placed), &ray, surface.plane);
            let gap = hit.filter(|hit| face.holds(hit.s, ROUNDED)).map_or(f64::INFINITY, |hit| hit.gap);
            nearest = if gap.abs() < nearest.abs() { gap } else { nearest };
        });
        -nearest > UNSEEN * corner.size
    }

    /// The first corner that has come to lie in the other body since a state and bears nothing.
    pub(super) fn unseen_corner(&self, before: &Configuration, bears: impl Fn(usize) -> bool) -> Option<usize> {
        let unseen = |&(number, corner): &(usize, &BodyCorner)| {
            !bears(number) && self.is_sunk(corner) && !before.is_sunk(corner)
        };
        self.contact.corners.iter().enumerate().find(unseen).map(|(number, _)| number)
    }

    /// The part that corners of the body take of what those of a face of the surface stand for over a face of the target: all at one from which the face
    /// rises from that.
    pub(super) fn taken(&self, patch: &Patch) -> [f64; CORNERS] {
        let (mut taken, contact) = ([0.0; CORNERS], self.contact);
        if !contact.parts.surface.creased[patch.face] {
            return taken;
        }
        let (Some(seen), Some((face, placed))) = (contact.side(false), self.of_side(false, patch.target)) else {
            return taken;
        };
        let n = seen.middle_normal(face, placed);
        for corner in contact.corners.iter().filter(|corner| corner.own) {
            for flank in corner.flanks.iter().filter(|flank| flank.face == patch.face) {
                let (Some(at), Some(c)) = (flank.at, self.place_of(corner)) else { continue };
                let range = RISES.map(|angle| angle + corner.bend + seen.bends[patch.target]);
                taken[at] = self.rises((corner, flank), c, (n, range))[1];
            }
        }
        taken
    }

    /// The angle by which a flank rises from a face with this normal, and how much of the way between two angles that is.
    fn rises(&self, (corner, flank): (&BodyCorner, &Flank), c: Vec3, (n, range): (Vec3, [f64; 2])) -> [f64; 2] {
        let Some((face, placed)) = self.of_side(corner.own, flank.face) else { return [0.0; 2] };
        let mut way = face.shape(face.middle()).value(placed.nodes()) - c;
        if let Some([a, b]) = corner.edge.map(|ends| ends.map(|node| self.node_of_side(corner, node))) {
            let along = (b - a).unit();
            way = way - along * along.dot(way);
        }
        let rise = way.unit().dot(n).clamp(-1.0, 1.0).asin();
        [rise, smoothstep((rise - range[0]) / (range[1] - range[0]))[0]]
    }

    /// The share that a corner has of the force on a face: all where both of its flanks rise from that, or end over it at once.
    fn share_on(&self, corner: &BodyCorner, c: Vec3, on: &Touchable) -> f64 {
        let plane = self.contact.parts.surface.plane;
        let lies = |x: Vec3| {
            let (mut meets, ray) = (false, FaceRay { x, n: -on.n });
            self.across(corner, x, corner.size, |_, face, placed| {
                meets |= project((face, placed), &ray, plane).is_some_and(|hit| face.holds(hit.s, ROUNDED));
            });
            meets
        };
        let of_flank = |flank: &Flank| {
            let Some((face, placed)) = self.of_side(corner.own, flank.face) else { return 0.0 };
            let along = |part: f64| face.shape(place_along(face, flank.xi, part)).value(placed.nodes());
            let [rise, rises] = self.rises((corner, flank), c, (on.n, on.range));
            if rises == 1.0 || rise < -on.dips {
                return rises;
            }
            let end = (1..=PLACES).map(|k| ENDS[1] * k as f64 / PLACES as f64).find(|&part| !lies(along(part)));
            let ends = end.map_or(0.0, |end| 1.0 - smoothstep((end - ENDS[0]) / (ENDS[1] - ENDS[0]))[0]);
            rises.max(ends)
        };
        corner.flanks.iter().map(of_flank).fold(1.0, f64::min)
    }

    /// The normal of a face of one of both sides at a place, turned towards that of both faces of a valley the nearer to its bottom: pressed into it, a
    /// corner may lie before neither.
    fn normal_in_valley(&self, own: bool, f: usize, s: [f64; 2]) -> Vec3 {
        let (Some(surface), Some((face, placed))) = (self.contact.side(own), self.of_side(own, f)) else {
            return Vec3::zero();
        };
        let [a, b] = face.shape(s).tangents(placed.nodes(), surface.plane);
        let (n, middle) = (a.cross(b).unit(), face.shape(face.middle()).value(placed.nodes()));
        let of = |g: usize| self.of_side(own, g).map_or(*placed, |(_, placed)| *placed);
        let functions = face.corner_functions(s).n;
        let corners = surface.field[f][..face.corners()].iter().zip(placed.nodes()).zip(functions);
        let averaged = corners.map(|((&node, &x), function)| {
            let both = surface.normal(node, of).unit;
            if both.dot(x - middle) < 0.0 { (both - n) * function } else { Vec3::zero() }
        });
        averaged.fold(n, |n, change| n + change).unit()
    }

    /// The face that a corner sees along the direction in which it points, within `range`, and where.
    pub(super) fn touched_by(&self, touch: CornerTouch, range: [f64; 2]) -> Option<(usize, FaceProjection)> {
        let corner = self.contact.corners.get(touch.number / WAYS).filter(|_| touch.along != Vec3::zero())?;
        let ray = FaceRay { x: self.place_of(corner)?, n: touch.along.unit() };
        let plane = self.contact.parts.surface.plane;
        let mut best: Option<(usize, FaceProjection)> = None;
        self.across(corner, ray.x, range[1].max(-range[0]), |f, face, placed| {
            let Some(hit) = project((face, placed), &ray, plane) else { return };
            let meets = face.holds(hit.s, ROUNDED) && -hit.normal().dot(ray.n) > LEAST_COSINE;
            let nearer = best.is_none_or(|(_, best)| hit.gap.abs() < best.gap.abs());
            if meets && nearer && (range[0]..=range[1]).contains(&hit.gap) {
                best = Some((f, hit));
            }
        });
        best
    }
}

/// The place of a face that is a part of the way from a place at its border over its middle.
fn place_along(face: &FieldFace, xi: [f64; 2], part: f64) -> [f64; 2] {
    std::array::from_fn(|k| xi[k] + 2.0 * part * (face.middle()[k] - xi[k]))
}

impl FieldContact {
    /// The surface, or else a target of bodies.
    fn side(&self, own: bool) -> Option<&FieldSurface> {
        if own { Some(&self.parts.surface) } else { self.parts.target.as_faces().map(|faces| &faces.surface) }
    }

    /// A face of one of them.
    pub(super) fn face_of(&self, own: bool, f: usize) -> Option<&FieldFace> {
        self.side(own)?.faces.get(f)
    }

    /// The patch of a corner that sees a face, and its place on the face of the surface.
    pub(super) fn corner_patch(&self, touch: CornerTouch, (f, s): (usize, [f64; 2])) -> (Patch, [f64; 2]) {
        let corner = &self.corners[touch.number / WAYS];
        let flank = corner.flanks[0];
        let (face, target, place) = if corner.own { (flank.face, f, flank.xi) } else { (f, flank.face, s) };
        (Patch { corner: Some(touch), ..Patch::whole(face, target) }, place)
    }

    /// The corner of a slot.
    pub(super) fn corner_of(&self, slot: usize) -> Option<&BodyCorner> {
        self.corners.get(slot.checked_sub(self.nodal_slots())? / WAYS)
    }

    /// Whether a corner bears, by a stencil of its own or those of its node.
    pub(super) fn bears(&self, number: usize, history: &History) -> bool {
        let (corner, first) = (&self.corners[number], self.nodal_slots() + WAYS * number);
        let flanks = corner.flanks.iter().filter(|_| corner.own);
        let mut nodes = flanks.filter_map(|flank| Some(self.parts.surface.field[flank.face][flank.at?]));
        let own = (first..first + WAYS).any(|slot| history.slot(slot)[entry::STATUS] > 0.0);
        own || nodes.any(|node| self.node_bears(node, history))
    }

    /// The strain by what bears over a face of the surface, at its nodes and in slots beside them: the pressure over the largest area of these, no less than
    /// the given one, over the modulus.
    pub(super) fn strained(&self, (f, area): (usize, f64), beside: Range<usize>, history: &History) -> f64 {
        let surface = &self.parts.surface;
        let nodes = || surface.field[f][..surface.faces[f].corners()].iter().copied();
        let of_nodes = nodes().flat_map(|node| self.slots_of(node, history));
        let force: f64 = of_nodes.chain(beside.map(|slot| history.slot(slot))).map(normal_force).sum();
        let area = nodes().map(|node| self.areas[node]).fold(area, f64::max);
        force / (area * self.parts.options.modulus)
    }

    fn node_bears(&self, node: usize, history: &History) -> bool {
        (0..self.pieces).any(|piece| history.slot(self.slot(node, piece))[entry::STATUS] > 0.0)
    }

    /// Whether a node of a face of the surface bears.
    fn face_bears(&self, f: usize, history: &History) -> bool {
        let surface = &self.parts.surface;
        surface.field[f][..surface.faces[f].corners()].iter().any(|&node| self.node_bears(node, history))
    }

    /// What corners of the body took of what those of a face of the surface stand for in the increment that led to an accepted history.
    pub(super) fn known_taken(&self, patch: &Patch, history: &History) -> [f64; CORNERS] {
        let (mut taken, piece) = ([0.0; CORNERS], self.piece_of(patch.target));
        let nodes = &self.parts.surface.field[patch.face][..self.parts.surface.faces[patch.face].corners()];
        let known = nodes.iter().map(|&node| history.slot(self.slot(node, piece))[entry::TAKEN]);
        taken.iter_mut().zip(known).for_each(|(taken, known)| *taken = known);
        taken
    }

    /// How the corners touched in that increment.
    pub(super) fn known_pointings(&self, history: &History) -> Vec<Pointing> {
        let of = |slot: usize| {
            let [x, y, z] = std::array::from_fn(|axis| history.slot(slot)[entry::POINTS + axis]);
            Pointing { along: Vec3::new(x, y, z), ..Pointing::default() }
        };
        (self.nodal_slots()..self.nodal_slots() + WAYS * self.corners.len()).map(of).collect()
    }
}

/// A corner in place, and what it sees.
struct CornerInPlace<'a> {
    corner: &'a BodyCorner,
    /// Its place,
    c: Vec3,
    /// the nodes of its flank, and their functions there,
    nodes: &'a [usize],
    flank: ShapeFunctions,
    /// the direction to the other body, and where that is.
    along: Vec3,
    hit: FaceProjection,
}

impl NodesInPlace<'_> {
    fn corner(&self, patch: &Patch, touch: CornerTouch) -> Option<CornerInPlace<'_>> {
        let (surface, faces) = (&self.contact.parts.surface, self.contact.parts.target.as_faces()?);
        let corner = &self.contact.corners[touch.number / WAYS];
        let [own, target] = [&surface.faces[patch.face], &faces.surface.faces[patch.target]];
        let (flank, other) = if corner.own { (own, target) } else { (target, own) };
        let (shape, along) = (flank.shape(corner.flanks[0].xi), touch.along.unit());
        let c = shape.value(self.placed(flank).nodes());
        let hit = project((other, &self.placed(other)), &FaceRay { x: c, n: along }, surface.plane)?;
        Some(CornerInPlace { corner, c, nodes: &flank.nodes, flank: shape, along, hit })
    }

    /// The point of a corner.
    pub(super) fn corner_point(
        &self,
        (patch, touch): (&Patch, CornerTouch),
        recall: Recall,
        points: &mut Vec<PatchPoint>,
    ) -> Option<()> {
        let CornerInPlace { corner, c, flank, along, hit, .. } = self.corner(patch, touch)?;
        let at = corner.flanks[0].xi;
        let touched = recall(self, patch, at);
        let way = touched.map_or(Vec3::zero(), |touched| touched.now - c);
        // What the target sees is its corner, where that is the target's.
        let seen = if corner.own { hit } else { FaceProjection { s: at, shape: flank, y: c, ..hit } };
        let (xi, shape) = if corner.own { (at, flank) } else { (hit.s, hit.shape) };
        points.push(PatchPoint {
            number: 0,
            vertex: None,
            xi,
            weight: corner.area * touch.along.norm(),
            functions: ShapeFunctions::constant(1.0),
            dual: ShapeFunctions::constant(0.0),
            shape,
            gap: hit.gap,
            bulge: 0.0,
            n: if corner.own { along } else { -along },
            v: if corner.own { way } else { -way },
            y: seen.y,
            sight: Sight::Corner(seen),
            touched,
        });
        Some(())
    }

    /// Its derivatives along each unknown.
    pub(super) fn corner_rates(
        &self,
        (patch, touch): (&Patch, CornerTouch),
        points: &[PatchPoint],
        columns: &[PointColumn],
        rates: &mut Vec<PointRates>,
    ) {
        let (Some(here), [point]) = (self.corner(patch, touch), points) else { return };
        let (corner, part) = (here.corner, |node: usize, nodes: &[usize], shape: &ShapeFunctions| {
            nodes.iter().position(|&other| other == node).map_or(0.0, |k| shape.n[k])
        });
        let other = |f: usize| self.contact.face_of(!corner.own, f);
        let Some(touches) = other(if corner.own { patch.target } else { patch.face }) else { return };
        for column in columns {
            let &PointColumn::Node { axis, node, .. } = column else {
                rates.push(PointRates::default());
                continue;
            };
            let unit = Vec3::axis(axis);
            let moved = unit * part(node, here.nodes, &here.flank);
            let carried = unit * part(node, &touches.nodes, &here.hit.shape);
            let (gap, s) = here.hit.follow(here.along, moved - carried);
            let foot = carried + here.hit.tangents[0] * s[0] + here.hit.tangents[1] * s[1];
            let recalled = point.touched.and_then(|touched| touched.face);
            let was =
                recalled.and_then(|(f, shape)| Some(unit * part(node, &other(f)?.nodes, &shape))).unwrap_or(moved);
            let way = was - moved;
            let (xi, s, y, v) = if corner.own { ([0.0; 2], s, foot, way) } else { (s, [0.0; 2], moved, -way) };
            rates.push(PointRates { weight: 0.0, xi, gap, bulge: 0.0, n: Vec3::zero(), v, s, y });
        }
    }
}
