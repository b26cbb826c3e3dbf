//! A tip of a tool over one face of the surface: node-to-segment contact (Hallquist, Goudreau & Benson, Comput. Meth. Appl. Mech.
//! Eng. 51, 1985; Wriggers, Computational Contact Mechanics, 2006) of the tip with the edge that lies closest. Point contact beside
//! a mortar field: Farah, Wall & Popp, Int. J. Numer. Meth. Eng. 114 (2018).
//!
//! The gap of a node of the field is a mean over the faces around it: a wedge lies in them by a good part of a face before that
//! closes, and a circle of radius R stands `h^2 / 12 R` in. A tip therefore is a stencil of its own, beside those of the nodes, with
//! the area of the face that it lies over. With `c` its edge or the centre of its rounding, `R` the radius, and `x(xi)` the place of
//! the edge of the surface closest to `c`, the gap is `(c - x) . n - R`, `n` the outward normal there; where two edges meet it is
//! `|c - x| - R` along `c - x`, and `-|c - x| - R` in a valley into which the tip has pushed them.
//!
//! Where the surface follows a rounding its nodes feel that, and the tip has the less of the area the more it does: by the distances
//! `d` of the nodes around from `c`, with `q = |c - x|` and `s` how far they lie aside, from all of it where `sum w (d - q)` is
//! `sum w (sqrt(s^2 + q^2) - q)`, as on a straight surface, to none at half of that. The part changes between increments, and once
//! one has converged, never within its iterations: the forces keep a potential.

use super::column::{PointColumn, tool_motion};
use super::configuration::{Configuration, TargetInPlace};
use super::contact::FieldContact;
use super::cover::{Landing, Patch, root_near};
use super::face::{FieldFace, MOST, PlacedFace, ShapeFunctions};
use super::nodes::NodesInPlace;
use super::point::{PatchPoint, PointRates, Sight, Touched, smoothstep};
use super::points::Recall;
use super::tool::ToolInPlace;
use crate::contact::record::entry;
use crate::mesh::Side;
use crate::system::History;
use crate::tensor::Vec3;
use crate::tool::Tip;

/// What the search finds of a tip.
#[derive(Debug, Clone, Copy)]
pub struct TipFoot {
    /// The face and the place on it.
    pub patch: Patch,
    /// The gap.
    pub gap: f64,
}

/// Angles between the surface and the nearer flank of a tip between which that comes to lie flat on it, as the corner of a punch does:
/// the flank's own nodes then feel all that there is, and the tip nothing. Of a rounding larger than the face, over that.
const FLAT: [f64; 2] = [0.45, 0.72];
/// How far beside the end of the surface, over half of its face there, a tip may lie that lies over that end,
const BESIDE: f64 = 0.5;
/// and how far from it along the face, likewise.
const AT_END: f64 = 1e-3;
/// Starts of the search for the closest place of an edge.
const STARTS: [f64; 3] = [-0.5, 0.0, 0.5];

/// A place of the surface that a tip may touch.
#[derive(Debug, Clone, Copy)]
struct TipPlace {
    face: usize,
    xi: f64,
    /// The corner of the face that is nearer.
    nearer: usize,
    /// As those of a [`Landing`].
    corner: Option<usize>,
    border: Option<usize>,
    /// At the end of the surface, the outward normal that the face had there.
    rest: Option<Vec3>,
    /// Direction of the gap, the distance of the tip's centre along it, and the gap.
    n: Vec3,
    q: f64,
    gap: f64,
}

/// An edge with its position and tangents along it.
struct PlacedEdge<'a> {
    face: &'a FieldFace,
    placed: &'a PlacedFace,
}

/// A place of an edge.
struct EdgePlace {
    shape: ShapeFunctions,
    x: Vec3,
    tangent: Vec3,
    bend: Vec3,
}

impl PlacedEdge<'_> {
    fn tangent(&self, xi: f64) -> Vec3 {
        self.face.shape([xi, 0.0]).tangents(self.placed.nodes(), true)[0]
    }
    fn at(&self, xi: f64) -> EdgePlace {
        let shape = self.face.shape([xi, 0.0]);
        // Shape functions of second degree have linear slopes, of which a central difference is exact.
        EdgePlace {
            x: shape.value(self.placed.nodes()),
            tangent: self.tangent(xi),
            bend: self.tangent(xi + 0.5) - self.tangent(xi - 0.5),
            shape,
        }
    }
    /// Whether all of it is farther than this from `c`.
    fn is_beyond(&self, distance: f64, c: Vec3) -> bool {
        let at = self.at(0.0);
        (at.x - c).norm() > distance + at.tangent.norm() + 0.5 * at.bend.norm()
    }
    /// Derivative of half the square of the distance to `c`, with its slope.
    fn offset(&self, xi: f64, c: Vec3) -> [f64; 2] {
        let EdgePlace { x, tangent, bend, .. } = self.at(xi);
        let r = x - c;
        [r.dot(tangent), tangent.dot(tangent) + r.dot(bend)]
    }
    /// The place closest to `c`, between its ends.
    fn closest(&self, c: Vec3) -> f64 {
        let distance = |xi: &f64| (self.at(*xi).x - c).norm();
        let found = STARTS.map(|start| root_near(start, |xi| self.offset(xi, c)).clamp(-1.0, 1.0));
        let places = found.into_iter().chain([-1.0, 1.0]);
        places.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0.0)
    }
}

/// Outward unit normal of an edge with this tangent.
fn outward(tangent: Vec3) -> Vec3 {
    tangent.cross(Vec3::axis(2)).unit()
}

impl Configuration<'_> {
    /// Where the tips of the tool lie, up to `reach` away from the surface: tip after tip. The part that a tip has in a face is the
    /// one it had `before`, at the accepted state, so that it stays over an increment; all of it where that is not given.
    pub fn tips(&self, reach: f64, before: Option<&[Option<TipFoot>]>) -> Vec<Option<TipFoot>> {
        let TargetInPlace::Tool(tool) = &self.target else { return Vec::new() };
        let land = |(number, tip): (usize, &Tip)| {
            let last = before.map(|before| before.get(number).copied().flatten());
            let face = last.flatten().map(|found| found.patch.face);
            let place = self.closest(tip, tool, (reach, face)).filter(|place| place.gap <= reach)?;
            let share = match last {
                None => 1.0,
                Some(last) => last
                    .and_then(|found| found.patch.tip)
                    .map_or_else(|| self.share(&place, tip, tool), |landing| landing.share),
            };
            let own = tip.centre - tool.rotate_back(place.n) * tip.radius;
            let TipPlace { face, xi, corner, border, gap, .. } = place;
            let landing = Some(Landing { xi, corner, border, share, own });
            let patch = Patch { face, target: number, ends: [None; 2], near: [xi, xi], seen: None, tip: landing };
            Some(TipFoot { patch, gap })
        };
        self.contact.tips().iter().enumerate().map(land).collect()
    }

    /// The place of the surface closest to a tip, of those that it points at; on the face that was the `last`, where that meets the
    /// other.
    fn closest(&self, tip: &Tip, tool: &ToolInPlace, (reach, last): (f64, Option<usize>)) -> Option<TipPlace> {
        let (centre, points, radius) = (tool.place(tip.centre), tool.rotate(tip.outward), tip.radius);
        let (mut best, mut valleys): (Option<TipPlace>, Vec<(usize, Side)>) = (None, Vec::new());
        let mut kept = None;
        let surface = &self.contact.parts.surface;
        for (f, face) in surface.faces.iter().enumerate() {
            let edge = PlacedEdge { face, placed: &self.placed[f] };
            if edge.is_beyond(radius + reach, centre) {
                continue;
            }
            let xi = edge.closest(centre);
            let at = edge.at(xi);
            let (n, to) = (outward(at.tangent), centre - at.x);
            let nearer = usize::from(xi > 0.0);
            let ends = surface.nodes[surface.field[f][nearer]].support.len() == 1;
            let inner = if ends { 1.0 - AT_END } else { 1.0 };
            let corner = if xi.abs() < inner { None } else { Some(nearer) };
            // On a plane of symmetry the edge comes to lie along the flank, and would turn away without its other half.
            let rest = corner.filter(|_| ends).map(|_| self.undeformed_normal(face));
            // Where two edges meet in a valley or on a ridge.
            let crest = corner.filter(|_| !ends || radius > 0.0).map(|_| to.dot(n) > 0.0);
            let facing = if crest == Some(true) { to.unit() } else { rest.unwrap_or(n) };
            if -facing.dot(points) < tip.least_cosine {
                continue;
            }
            let mut offer = |corner: Option<usize>, border: Option<usize>| {
                let n = if corner.is_some() { facing_centre(to, n) } else { n };
                let place =
                    TipPlace { face: f, xi, nearer, corner, border, rest, q: to.dot(n), n, gap: to.dot(n) - radius };
                if best.is_none_or(|best| place.q.abs() < best.q.abs()) {
                    best = Some(place);
                }
                if corner.is_none() && last == Some(f) {
                    kept = Some(place);
                }
            };
            match corner {
                None => offer(None, None),
                // A rounding touches a ridge and the end of the surface.
                Some(corner) if crest == Some(true) && radius > 0.0 => offer(Some(corner), ends.then_some(corner)),
                Some(corner) if ends => {
                    if to.dot(at.tangent).abs() <= BESIDE * at.tangent.dot(at.tangent) {
                        offer(None, Some(corner));
                    }
                }
                // Within both edges that meet there.
                Some(corner) if crest == Some(false) => {
                    let node = face.corner_node(corner);
                    match valleys.iter().find(|(other, _)| *other == node) {
                        // Both halves of an edge of second degree meet without a crease.
                        Some((_, side)) if *side == face.side => offer(None, None),
                        Some(_) => offer(Some(corner), None),
                        None => valleys.push((node, face.side)),
                    }
                }
                Some(_) => {}
            }
        }
        // In a valley it stays on its side over an increment.
        let adjoins = |kept: &TipPlace| best.is_some_and(|best| self.adjoin(kept.face, best.face));
        kept.filter(adjoins).or(best)
    }

    /// Whether two faces of the surface have a node of the field in common.
    fn adjoin(&self, one: usize, other: usize) -> bool {
        let [one, other] = [one, other].map(|f| &self.contact.parts.surface.field[f][..2]);
        one.iter().any(|node| other.contains(node))
    }

    /// How far the surface around a place stands off a rounding about `centre`, over how far it would if it were straight; one for an
    /// edge.
    fn straightness(&self, &TipPlace { face: f, xi, q, n, .. }: &TipPlace, centre: Vec3, radius: f64) -> f64 {
        let surface = &self.contact.parts.surface;
        if radius == 0.0 || q <= 0.0 {
            return 1.0;
        }
        let (mut stands, mut straight) = (0.0, 0.0);
        let mut add = |weight: f64, (f, corner): (usize, usize)| {
            let face = &surface.faces[f];
            let z = face.shape(face.corner_place(corner)).value(self.placed[f].nodes()) - centre;
            stands += weight * (z.norm() - q);
            straight += weight * (z.dot(n.left()).hypot(q) - q);
        };
        for (corner, half) in [(0, -0.5), (1, 0.5)] {
            add(1.0, (f, corner));
            for &(beside, c) in surface.nodes[surface.field[f][corner]].support.iter().filter(|(g, _)| *g != f) {
                add(0.5 + half * xi, (beside, 1 - c));
            }
        }
        stands / straight
    }

    fn undeformed_normal(&self, face: &FieldFace) -> Vec3 {
        let rest = face.at_rest(&self.contact.parts.mesh);
        outward(face.shape(face.middle()).tangents(rest.nodes(), true)[0])
    }

    /// The part that a tip has in a face by how flat its flanks lie on it, or on it and its neighbour at a corner taken together; at
    /// the end of the surface on the normal it had, which a plane of symmetry keeps.
    fn share(&self, place: &TipPlace, tip: &Tip, tool: &ToolInPlace) -> f64 {
        let (&TipPlace { face: f, nearer: corner, rest, .. }, radius) = (place, tip.radius);
        let flanks = tip.flanks.map(|flank| tool.rotate(flank));
        let surface = &self.contact.parts.surface;
        let area = |f: usize| {
            let face = &surface.faces[f];
            face.shape(face.middle()).tangents(self.placed[f].nodes(), true)[0].cross(Vec3::axis(2))
        };
        let both =
            surface.nodes[surface.field[f][corner]].support.iter().fold(Vec3::zero(), |sum, &(f, _)| sum + area(f));
        let flat = |n: Vec3| flanks.iter().map(|flank| -flank.dot(n)).fold(-1.0, f64::max);
        let cosine = rest.map_or_else(|| flat(area(f).unit()).min(flat(both.unit())), flat);
        let size = 2.0 * area(f).norm();
        let angle = cosine.clamp(-1.0, 1.0).acos() * radius.max(size) / size;
        let [apart, _] = smoothstep((angle - FLAT[0]) / (FLAT[1] - FLAT[0]));
        apart * smoothstep(2.0 * self.straightness(place, tool.place(tip.centre), radius) - 1.0)[0]
    }
}

impl FieldContact {
    /// The undeformed area of a face under a tip by what it is at a place, with its slope along the edge.
    fn tip_area(&self, face: &FieldFace, landing: &Landing, xi: f64) -> [f64; 2] {
        // Where the surface ends it has half of the face, whose area at an axis is not that of its end.
        let (over, length) = if landing.border.is_some() { (0.0, 1.0) } else { (xi, 2.0) };
        let rest = face.at_rest(&self.parts.mesh);
        let (density, [slope, _]) = self.parts.surface.density(face, &rest, [over, 0.0]);
        [length * density, length * slope]
    }

    /// Where the tips of the tool lie in an accepted configuration: one that bears has no more of its face than it had.
    pub(super) fn tips_before(&self, before: &Configuration, history: &History) -> Vec<Option<TipFoot>> {
        let mut tips = before.tips(f64::INFINITY, Some(&[]));
        for (number, found) in tips.iter_mut().enumerate() {
            let values = history.slot(self.nodal_slots() + number);
            let Some(TipFoot { patch: Patch { face, tip: Some(landing), .. }, .. }) = found else { continue };
            if values[entry::STATUS] > 0.0 {
                let whole = self.tip_area(&self.parts.surface.faces[*face], landing, landing.xi)[0];
                landing.share = landing.share.min(values[entry::XI] / whole);
            }
        }
        tips
    }
}

/// Unit vector from a corner to or from a tip that lies `to` away, on the outer side of an edge with this normal or within it.
fn facing_centre(to: Vec3, n: Vec3) -> Vec3 {
    to.unit() * to.dot(n).signum()
}

/// A tip over its place of the edge.
struct TipInPlace<'a> {
    tool: &'a ToolInPlace<'a>,
    landing: Landing,
    centre: Vec3,
    radius: f64,
    xi: f64,
    at: EdgePlace,
    /// From the place to the centre, and the outward normal of the gap.
    to: Vec3,
    n: Vec3,
    /// Undeformed area of the face by what it is at the place, with its slope along the edge.
    area: f64,
    slope: f64,
}

impl NodesInPlace<'_> {
    fn tip(&self, patch: &Patch, landing: Landing) -> Option<TipInPlace<'_>> {
        let (tool, contact) = (self.tool.as_ref()?, self.contact);
        let face = &contact.parts.surface.faces[patch.face];
        let placed = self.placed(face);
        let edge = PlacedEdge { face, placed: &placed };
        let Tip { centre, radius, .. } = contact.tips()[patch.target];
        let centre = tool.place(centre);
        let xi = match landing.corner.or(landing.border) {
            Some(corner) => face.corner_place(corner)[0],
            None => root_near(landing.xi, |xi| edge.offset(xi, centre)),
        };
        let [area, slope] = contact.tip_area(face, &landing, xi);
        let at = edge.at(xi);
        let (to, own) = (centre - at.x, outward(at.tangent));
        let n = if landing.corner.is_some() { facing_centre(to, own) } else { own };
        Some(TipInPlace { tool, landing, centre, radius, xi, at, to, n, area, slope })
    }

    /// The point of a tip.
    pub(super) fn tip_point(
        &self,
        (patch, landing): (&Patch, Landing),
        recall: Recall,
        points: &mut Vec<PatchPoint>,
    ) -> Option<()> {
        let tip = self.tip(patch, landing)?;
        let (xi, n) = ([tip.xi, 0.0], tip.n);
        let touched = recall(self, patch, xi);
        points.push(PatchPoint {
            number: 0,
            xi,
            weight: tip.area * landing.share,
            functions: ShapeFunctions { n: [1.0; MOST], dn: [[0.0; 2]; MOST] },
            shape: tip.at.shape,
            gap: tip.to.dot(n) - tip.radius,
            n,
            v: touched.map_or(Vec3::zero(), |touched| touched.tip - touched.now),
            y: tip.centre - n * tip.radius,
            sight: Sight::Tip,
            touched,
        });
        Some(())
    }

    /// Its derivatives along each unknown.
    pub(super) fn tip_rates(
        &self,
        (patch, landing): (&Patch, Landing),
        points: &[PatchPoint],
        columns: &[PointColumn],
        rates: &mut Vec<PointRates>,
    ) {
        let (Some(tip), [point]) = (self.tip(patch, landing), points) else { return };
        let TipInPlace { tool, landing, ref at, to, n, .. } = tip;
        for column in columns {
            let (dx, dtangent) = match column {
                PointColumn::Node { axis, own: Some(k), .. } => {
                    (Vec3::axis(*axis) * at.shape.n[*k], Vec3::axis(*axis) * at.shape.dn[*k][0])
                }
                _ => (Vec3::zero(), Vec3::zero()),
            };
            let carried = |place: Vec3| tool_motion(tool, column, place).0;
            let apart = carried(tip.centre) - dx;
            let stays = landing.border.is_some();
            let (dxi, dn) = if landing.corner.is_some() {
                (0.0, (n * to.norm()).turned(apart * to.dot(n).signum()))
            } else {
                let stiff = at.tangent.dot(at.tangent) - to.dot(at.bend);
                let dxi = if stays { 0.0 } else { (apart.dot(at.tangent) + to.dot(dtangent)) / stiff };
                (dxi, at.tangent.turned(dtangent + at.bend * dxi).cross(Vec3::axis(2)))
            };
            let slid = |touched: &Touched| carried(touched.tip) - left_behind(self.contact, column, touched);
            rates.push(PointRates {
                weight: tip.slope * dxi * landing.share,
                xi: [dxi, 0.0],
                gap: n.dot(apart) + if stays { dn.dot(to) } else { 0.0 },
                n: dn,
                v: point.touched.as_ref().map_or(Vec3::zero(), slid),
                s: [0.0; 2],
                y: carried(tip.centre) - dn * tip.radius,
            });
        }
    }
}

/// Displacement along an unknown of the place of the surface over which a tip lay at the accepted state.
fn left_behind(contact: &FieldContact, column: &PointColumn, touched: &Touched) -> Vec3 {
    let (PointColumn::Node { axis, node, .. }, Some((face, shape))) = (column, &touched.face) else {
        return Vec3::zero();
    };
    let place = contact.parts.surface.faces[*face].nodes.iter().position(|other| other == node);
    place.map_or(Vec3::zero(), |k| Vec3::axis(*axis) * shape.n[k])
}
