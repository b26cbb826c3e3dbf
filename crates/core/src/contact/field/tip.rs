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
//! A rounding in a valley touches every side of it: each place of the surface that is closest of those around is a foot, with a stencil
//! of its own. Of two feet beside a node, `a` and `b` in reference coordinates away from it, the first has `a / (a + b)` of its area, so
//! that one which comes in or leaves over the node does so with nothing. A side that lies along a flank, or turns further away,
//! touches the end of the arc there.
//!
//! Where the surface follows a rounding its nodes feel that, and the tip has the less of the area the more it does: all where the surface
//! is straight, none from a curvature `k / R` on at which the mean gap errs less; the least of all places that it touches, so that it does
//! not come and go as the closest of them changes. The part changes between increments, and once one has converged, never within its
//! iterations: the forces keep a potential.

use super::column::{PointColumn, tool_motion};
use super::configuration::{Configuration, TargetInPlace};
use super::contact::FieldContact;
use super::corner::pressed_flat;
use super::cover::{FEET, FootBeside, Landing, Patch, root_near};
use super::face::{FieldFace, PlacedFace, ShapeFunctions};
use super::nodes::NodesInPlace;
use super::point::{PatchPoint, PointRates, Sight, Touched, smoothstep};
use super::points::Recall;
use super::tool::ToolInPlace;
use crate::contact::record::entry;
use crate::system::History;
use crate::tensor::Vec3;
use crate::tool::Tip;
use std::cell::OnceCell;

/// What the search finds of a tip.
#[derive(Debug, Clone, Copy)]
pub struct TipFoot {
    /// The face and the place on it.
    pub patch: Patch,
    /// The gap.
    pub gap: f64,
}

/// Where a tip of these feet lies, by the first of them that there is.
pub(super) fn landing(feet: &[Option<TipFoot>]) -> Option<Landing> {
    feet.iter().flatten().find_map(|foot| foot.patch.tip)
}

/// The same of all of them.
pub(super) fn landings(feet: &mut [Option<TipFoot>]) -> impl Iterator<Item = &mut Landing> {
    feet.iter_mut().flatten().filter_map(|foot| foot.patch.tip.as_mut())
}

/// Angles between the surface and the nearer flank of a tip between which that comes to lie flat on it, as the corner of a punch does:
/// the flank's own nodes then feel all that there is, and the tip nothing. Of a rounding larger than the face, over that.
const FLAT: [f64; 2] = [0.45, 0.72];
/// The same of a vertex.
const FLAT_AT_VERTEX: [f64; 2] = [0.05, 0.15];
/// Curvature of the surface over that of a rounding from which on the mean gap of its nodes is nearer to that of the curved surface than the
/// gap of the closest place of its edges is: `(1 - k) h^2 / 12 R` beside `k^2 h^2 / 8 R`.
const CONFORMING: f64 = 0.55;
/// How far beside the end of the surface, over half of its face there, a tip may lie that lies over that end,
const BESIDE: f64 = 0.5;
/// and how far from it along the face, likewise.
const AT_END: f64 = 1e-3;
/// Starts of the search for the closest place of an edge.
const STARTS: [f64; 3] = [-0.5, 0.0, 0.5];

/// A place of the surface that a tip may touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct TipPlace {
    pub face: usize,
    pub xi: [f64; 2],
    /// The corner of the face that is nearer.
    pub nearer: usize,
    /// As those of a [`Landing`].
    pub corner: Option<usize>,
    pub border: Option<usize>,
    /// At the end of the surface, the outward normal that the face had there.
    pub rest: Option<Vec3>,
    /// What touches it: the tip's own centre, or the end of its arc, and the radius about that.
    pub centre: Vec3,
    pub radius: f64,
    /// Direction of the gap, the distance of the tip's centre along it, and the gap.
    pub n: Vec3,
    pub q: f64,
    pub gap: f64,
}

/// An edge with its position and tangents along it.
struct PlacedEdge<'a> {
    face: &'a FieldFace,
    placed: &'a PlacedFace,
}

/// A place of an edge.
#[derive(Clone, Copy)]
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

/// The place of an edge that is closest to a centre, and how it lies to that.
struct EdgeFoot {
    xi: f64,
    corner: Option<usize>,
    ends: bool,
    nearer: usize,
    rest: Option<Vec3>,
    crest: Option<bool>,
    to: Vec3,
    n: Vec3,
    tangent: Vec3,
    facing: Vec3,
}

/// Tangent at the middle of an edge.
fn middle_tangent(face: &FieldFace, placed: &PlacedFace) -> Vec3 {
    face.shape(face.middle()).tangents(placed.nodes(), true)[0]
}

/// Outward unit normal of an edge with this tangent.
fn outward(tangent: Vec3) -> Vec3 {
    tangent.cross(Vec3::axis(2)).unit()
}

impl Configuration<'_> {
    /// Where the tips of the tool touch, up to `reach` away from the surface: for tip after tip its feet, each where the one of the
    /// accepted state was that had its face, `known`, or the one beside it. The part that a tip has in a face is the one it had
    /// `before`, at the accepted state, so that it stays over an increment; all of it where that is not given.
    pub fn tips(
        &self,
        reach: f64,
        before: Option<&[Option<TipFoot>]>,
        known: impl Fn(usize) -> Option<usize>,
        history: Option<&History>,
    ) -> Vec<Option<TipFoot>> {
        let TargetInPlace::Tool(tool) = &self.target else { return Vec::new() };
        let mut feet = vec![None; FEET * self.contact.tips().len()];
        let faces = OnceCell::new();
        for (number, tip) in self.contact.tips().iter().enumerate() {
            let (found, places) = if self.contact.parts.surface.plane {
                let found = self.places(tip, tool, reach);
                let places = self.touched(&found, tip.radius);
                (found, places)
            } else {
                let found = self.places_in_space((tip, tool), reach, faces.get_or_init(|| self.tree()));
                (found.iter().take(1).copied().collect(), found)
            };
            let first = FEET * number;
            let last = |before: &[Option<TipFoot>]| {
                landing(before.get(first..first + FEET)?).map(|landing| (landing.share, false))
            };
            let share = || {
                let slots = self.contact.nodal_slots() + first..self.contact.nodal_slots() + first + FEET;
                let strain = |f: usize| {
                    history.map_or(f64::INFINITY, |history| self.contact.strained((f, 0.0), slots.clone(), history))
                };
                let least = |strain: &dyn Fn(usize) -> f64| self.least_share((&found, tip), tool, strain);
                let share = least(&strain);
                (share, share > least(&|_| f64::INFINITY))
            };
            let share = before.map_or((1.0, false), |before| last(before).unwrap_or_else(share));
            let rank = |place: &TipPlace, foot: usize| match known(foot) {
                Some(face) if face == place.face => 0,
                Some(face) if self.adjoin(face, place.face) => 1,
                Some(_) => 3,
                None => 2,
            };
            let near = places.iter().filter(|place| place.gap <= reach);
            let mut pairs: Vec<_> =
                near.flat_map(|place| (first..first + FEET).map(move |foot| (place, foot))).collect();
            pairs.sort_by_key(|&(place, foot)| rank(place, foot));
            for (place, foot) in pairs {
                let has_foot = feet[first..first + FEET].iter().flatten().any(|f: &TipFoot| f.patch.face == place.face);
                if feet[foot].is_none() && !has_foot {
                    let tip = Some(self.landing((place, tip.length), &places, tool, share));
                    let patch = Patch { near: [place.xi[0]; 2], tip, ..Patch::whole(place.face, foot) };
                    feet[foot] = Some(TipFoot { patch, gap: place.gap });
                }
            }
        }
        feet
    }

    fn landing(
        &self,
        (place, length): (&TipPlace, f64),
        places: &[TipPlace],
        tool: &ToolInPlace,
        (share, slender): (f64, bool),
    ) -> Landing {
        let &TipPlace { face, xi, corner, border, centre, radius, .. } = place;
        let own = centre - tool.rotate_back(place.n) * radius;
        let surface = &self.contact.parts.surface;
        let beside = [0, 1].map(|corner| {
            if !surface.plane {
                return None;
            }
            let node = surface.field[face][corner];
            let at_node = |other: &&TipPlace| other.face != face && surface.field[other.face][..2].contains(&node);
            let other = places.iter().find(at_node)?;
            let corner = usize::from(surface.field[other.face][1] == node);
            Some(FootBeside { face: other.face, corner, xi: other.xi[0], centre: other.centre })
        });
        Landing { xi, length, corner, border, share, slender, laid: 0.0, own, centre, radius, beside }
    }

    /// The places of the surface that a tip may touch, of those that it points at, closest first.
    fn places(&self, tip: &Tip, tool: &ToolInPlace, reach: f64) -> Vec<TipPlace> {
        let points = tool.rotate(tip.outward);
        let (mut found, mut valleys): (Vec<TipPlace>, Vec<usize>) = (Vec::new(), Vec::new());
        let surface = &self.contact.parts.surface;
        for (f, face) in surface.faces.iter().enumerate() {
            let edge = PlacedEdge { face, placed: &self.placed[f] };
            if edge.is_beyond(tip.radius + reach, tool.place(tip.centre)) {
                continue;
            }
            let (mut centre, mut radius) = (tip.centre, tip.radius);
            let mut foot = self.foot((f, &edge), tool.place(centre), radius);
            if -foot.facing.dot(points) < tip.least_cosine {
                // What lies along a flank, or turns further away, touches the end of the arc there.
                let along = |end: &Vec3| -foot.facing.dot(tool.rotate(*end));
                let end = tip.flanks.into_iter().max_by(|a, b| along(a).total_cmp(&along(b))).filter(|_| radius > 0.0);
                let Some(end) = end.filter(|end| along(end) > 0.0) else { continue };
                (centre, radius) = (centre + end * radius, 0.0);
                foot = self.foot((f, &edge), tool.place(centre), radius);
                if foot.corner.is_some() {
                    continue;
                }
            }
            let EdgeFoot { xi, corner, ends, nearer, rest, crest, to, n, tangent, .. } = foot;
            let mut offer = |corner: Option<usize>, border: Option<usize>| {
                let n = if corner.is_some() { facing_centre(to, n) } else { n };
                let gap = to.dot(n) - radius;
                let q = gap + tip.radius;
                let xi = [xi, 0.0];
                found.push(TipPlace { face: f, xi, nearer, corner, border, rest, centre, radius, q, n, gap });
            };
            // Both halves of an edge of second degree meet without a crease.
            let is_middle = |corner: usize| face.end().is_some_and(|end| end != corner);
            match corner {
                None => offer(None, None),
                // A rounding touches a ridge and the end of the surface.
                Some(corner) if crest == Some(true) && radius > 0.0 && !is_middle(corner) => {
                    offer(Some(corner), ends.then_some(corner))
                }
                Some(corner) if ends => {
                    if to.dot(tangent).abs() <= BESIDE * tangent.dot(tangent) {
                        offer(None, Some(corner));
                    }
                }
                // Within both edges that meet there.
                Some(corner) if crest == Some(false) || is_middle(corner) => {
                    let node = face.corner_node(corner);
                    if !valleys.contains(&node) {
                        valleys.push(node);
                    } else {
                        offer(Some(corner).filter(|corner| !is_middle(*corner)), None);
                    }
                }
                Some(_) => {}
            }
        }
        found.sort_by(|a, b| a.q.abs().total_cmp(&b.q.abs()));
        found
    }

    /// Of the places that a tip of this radius may touch, closest first, those that it does: the closest, and where a rounding lies in a
    /// valley those on the other sides of that.
    fn touched(&self, found: &[TipPlace], radius: f64) -> Vec<TipPlace> {
        let lies_within = |place: &TipPlace| place.corner.is_none() && place.border.is_none() && place.q > 0.0;
        let mut places: Vec<TipPlace> = Vec::new();
        for place in found {
            let beside = |other: &TipPlace| lies_within(other) && self.adjoin(other.face, place.face);
            let touches = radius > 0.0 && lies_within(place) && places.iter().any(beside);
            if places.is_empty() || (touches && places.len() < FEET) {
                places.push(*place);
            }
        }
        places
    }

    /// The place of a face that is closest to `centre`.
    fn foot(&self, (f, edge): (usize, &PlacedEdge), centre: Vec3, radius: f64) -> EdgeFoot {
        let surface = &self.contact.parts.surface;
        let xi = edge.closest(centre);
        let EdgePlace { x, tangent, .. } = edge.at(xi);
        let (n, to) = (outward(tangent), centre - x);
        let nearer = usize::from(xi > 0.0);
        let ends = surface.ends_at(surface.field[f][nearer]);
        let inner = if ends { 1.0 - AT_END } else { 1.0 };
        let corner = if xi.abs() < inner { None } else { Some(nearer) };
        // On a plane of symmetry the edge comes to lie along the flank, and would turn away without its other half.
        let rest = corner.filter(|_| ends).map(|_| self.undeformed_normal(edge.face));
        // Where two edges meet in a valley or on a ridge.
        let crest = corner.filter(|_| !ends || radius > 0.0).map(|_| to.dot(n) > 0.0);
        let facing = if crest == Some(true) { to.unit() } else { rest.unwrap_or(n) };
        EdgeFoot { xi, corner, ends, nearer, rest, crest, to, n, tangent, facing }
    }

    /// Whether two faces of the surface have a node of the field in common.
    pub(super) fn adjoin(&self, one: usize, other: usize) -> bool {
        let surface = &self.contact.parts.surface;
        let [one, other] = [one, other].map(|f| &surface.field[f][..surface.faces[f].corners()]);
        one.iter().any(|node| other.contains(node))
    }

    /// Curvature of the surface around a place, from the turns between the middles of its face and of those beside it, times the radius of a
    /// rounding about `centre`. Where the surface ends beneath that, as on a plane of symmetry, its mirror image is beside it.
    fn conformity(&self, &TipPlace { face: f, xi: [xi, _], q, .. }: &TipPlace, centre: Vec3, radius: f64) -> f64 {
        let surface = &self.contact.parts.surface;
        if radius == 0.0 || q <= 0.0 {
            return 0.0;
        }
        let tangent = |f: usize| middle_tangent(&surface.faces[f], &self.placed[f]);
        let (face, own) = (&surface.faces[f], tangent(f));
        let mirrored = |corner: usize| {
            let to = centre - face.shape(face.corner_place(corner)).value(self.placed[f].nodes());
            let beneath = to.dot(self.undeformed_normal(face).left()).abs() <= own.norm();
            beneath.then(|| own - to * (2.0 * own.dot(to) / to.dot(to)))
        };
        let (mut curvature, mut weights) = (0.0, f64::MIN_POSITIVE);
        for (corner, weight) in [(0, 0.5 - 0.5 * xi), (1, 0.5 + 0.5 * xi)] {
            let support = &surface.nodes[surface.field[f][corner]].support;
            let beside = support.iter().find(|(g, _)| *g != f).map(|&(g, _)| tangent(g));
            let Some(beside) = beside.or_else(|| mirrored(corner)) else { continue };
            let [first, second] = if corner == 0 { [beside, own] } else { [own, beside] };
            curvature += weight * second.cross(first)[2].atan2(first.dot(second)) / (own.norm() + beside.norm());
            weights += weight;
        }
        radius * curvature / weights
    }

    fn undeformed_normal(&self, face: &FieldFace) -> Vec3 {
        outward(middle_tangent(face, &face.at_rest(&self.contact.parts.mesh)))
    }

    /// The least part that a tip has in the faces that it touches or nearly so: no farther than an arc stands off a chord of their length.
    fn least_share(&self, (found, tip): (&[TipPlace], &Tip), tool: &ToolInPlace, strain: &dyn Fn(usize) -> f64) -> f64 {
        let (surface, mesh) = (&self.contact.parts.surface, &self.contact.parts.mesh);
        let near = |(i, place): &(usize, &TipPlace)| {
            *i == 0 || 8.0 * tip.radius * place.gap < surface.size(place.face, mesh).powi(2)
        };
        let shares =
            found.iter().enumerate().filter(near).map(|(_, place)| self.share((place, tip), tool, strain(place.face)));
        shares.fold(1.0, f64::min)
    }

    /// The part that a tip has in a face by how flat its flanks lie on it, or on it and its neighbour at a corner taken together; at
    /// the end of the surface on the normal it had, which a plane of symmetry keeps. What bears there strains it by so much.
    fn share(&self, (place, tip): (&TipPlace, &Tip), tool: &ToolInPlace, strain: f64) -> f64 {
        let (&TipPlace { face: f, nearer: corner, rest, .. }, radius) = (place, tip.radius);
        let flanks = tip.flanks.map(|flank| tool.rotate(flank));
        let surface = &self.contact.parts.surface;
        let area = |f: usize| {
            let face = &surface.faces[f];
            let [a, b] = face.shape(face.middle()).tangents(self.placed[f].nodes(), surface.plane);
            a.cross(b)
        };
        let support = &surface.nodes[surface.field[f][corner]].support;
        let both = support.iter().fold(Vec3::zero(), |sum, &(f, _)| sum + area(f));
        let flat = |n: Vec3| flanks.iter().map(|flank| -flank.dot(n)).fold(-1.0, f64::max);
        let cosine = rest.map_or_else(|| flat(area(f).unit()).min(flat(both.unit())), flat);
        let size = 2.0 * area(f).norm();
        let over = radius.max(size) / size;
        let angle = cosine.clamp(-1.0, 1.0).acos() * over;
        let flat = if radius > 0.0 { FLAT } else { FLAT_AT_VERTEX };
        let [from, to] = pressed_flat(flat, strain * over);
        let [apart, _] = smoothstep((angle - from) / (to - from));
        apart * smoothstep(1.0 - self.conformity(place, tool.place(tip.centre), radius) / CONFORMING)[0]
    }
}

impl FieldContact {
    /// The undeformed area of a face under a tip by what it is at a place, with its slope along the edge. Where the surface ends, it has
    /// half of the face, by the middle of that: at an axis the area is not that of the end.
    fn tip_area(&self, f: usize, xi: f64) -> [f64; 2] {
        let (surface, face) = (&self.parts.surface, &self.parts.surface.faces[f]);
        let rest = face.at_rest(&self.parts.mesh);
        let (density, [slope, _]) = surface.density(face, &rest, [xi, 0.0]);
        if !surface.ends_at(surface.field[f][usize::from(xi > 0.0)]) {
            return [2.0 * density, 2.0 * slope];
        }
        let half = surface.density(face, &rest, face.middle()).0;
        let [within, rise] = smoothstep(1.0 - xi.abs());
        let area = half + within * (2.0 * density - half);
        [area, 2.0 * within * slope - xi.signum() * rise * (2.0 * density - half)]
    }

    /// The area that a tip has in a face of which it has all.
    fn whole_area(&self, f: usize, landing: &Landing) -> f64 {
        if self.parts.surface.plane {
            self.tip_area(f, landing.xi[0])[0] * landing.part()
        } else {
            self.edge_area(f, landing)[0]
        }
    }

    /// The faces on which the feet of the tips lay in an accepted state.
    pub(super) fn known_feet<'a>(&'a self, history: &'a History) -> impl Fn(usize) -> Option<usize> + 'a {
        let face = |foot: usize| history.slot(self.nodal_slots() + foot)[entry::SEGMENT];
        move |foot| Some(face(foot)).filter(|face| *face >= 0.0).map(|face| face as usize)
    }

    /// Where the tips of the tool lie in an accepted configuration: one that bears has no more of its face than it had, and one that lies
    /// in the body and bears nothing, as nodes do there, has none: it would bear at once all that it lies in; or, where what is slender bends away from
    /// it, all but that.
    pub(super) fn tips_before(&self, before: &Configuration, history: &History) -> Vec<Option<TipFoot>> {
        let mut tips = before.tips(f64::INFINITY, Some(&[]), self.known_feet(history), Some(history));
        let nodes_bear = (0..self.nodal_slots()).any(|slot| history.slot(slot)[entry::STATUS] > 0.0);
        for (number, feet) in tips.chunks_mut(FEET).enumerate() {
            let values = |foot: usize| history.slot(self.nodal_slots() + FEET * number + foot);
            let has = |(foot, found): (usize, &Option<TipFoot>)| {
                let &TipFoot { patch: Patch { face, tip, .. }, gap } = found.as_ref()?;
                let (landing, values) = (tip?, values(foot));
                let whole = self.whole_area(face, &landing);
                if values[entry::STATUS] > 0.0 {
                    return (whole > 0.0).then(|| values[entry::XI] / whole);
                }
                (gap < 0.0 && nodes_bear && !landing.slender).then_some(0.0)
            };
            let share = feet.iter().enumerate().filter_map(has).fold(f64::INFINITY, f64::min);
            for (foot, found) in feet.iter_mut().enumerate() {
                let Some(TipFoot { patch: Patch { tip: Some(landing), .. }, gap }) = found else { continue };
                landing.share = landing.share.min(share);
                if landing.slender && nodes_bear && values(foot)[entry::STATUS] == 0.0 {
                    landing.laid = (-*gap).max(0.0);
                }
            }
        }
        tips
    }
}

impl Landing {
    /// The part of the weight that the place has among those beside it.
    fn part(&self) -> f64 {
        let part = |(corner, beside): (usize, &Option<FootBeside>)| {
            beside.map_or(1.0, |other| part([(corner, self.xi[0]), (other.corner, other.xi)])[0])
        };
        self.beside.iter().enumerate().map(part).product()
    }
}

/// The weight of one of two places of adjoining edges, by how far each lies from the node between them in reference coordinates, with its
/// slopes along both; the place on the other edge has the rest.
fn part([(one, xi), (other, eta)]: [(usize, f64); 2]) -> [f64; 3] {
    let [to_one, to_other] = [one, other].map(|corner| if corner == 0 { 1.0 } else { -1.0 });
    let [a, b] = [1.0 + to_one * xi, 1.0 + to_other * eta];
    let sum = (a + b).max(f64::MIN_POSITIVE);
    [a / sum, to_one * b / (sum * sum), -to_other * a / (sum * sum)]
}

/// Unit vector from a corner to or from a tip that lies `to` away, on the outer side of an edge with this normal or within it.
fn facing_centre(to: Vec3, n: Vec3) -> Vec3 {
    to.unit() * to.dot(n).signum()
}

/// The place of an edge that is closest to the centre of a tip.
struct FootInPlace<'a> {
    nodes: &'a [usize],
    xi: f64,
    at: EdgePlace,
    /// The centre, and the way to it from the place.
    centre: Vec3,
    to: Vec3,
}

/// A tip over its place of the edge.
struct TipInPlace<'a> {
    tool: &'a ToolInPlace<'a>,
    landing: Landing,
    foot: FootInPlace<'a>,
    /// The outward normal of the gap.
    n: Vec3,
    /// Undeformed area of the face by what it is at the place, with its slope along the edge.
    area: [f64; 2],
    /// The places on the edges beside this, and the weights beside them with their slopes.
    beside: [Option<(FootInPlace<'a>, [f64; 3])>; 2],
}

impl FootInPlace<'_> {
    /// Derivatives along an unknown: of its reference coordinate, of the way to the centre at that fixed, and of the tangent.
    fn rates(&self, tool: &ToolInPlace, column: &PointColumn) -> (f64, Vec3, Vec3) {
        let (mut apart, mut dtangent) = (tool_motion(tool, column, self.centre).0, Vec3::zero());
        let EdgePlace { shape, tangent, bend, .. } = self.at;
        if let PointColumn::Node { axis, node, .. } = column
            && let Some(k) = self.nodes.iter().position(|other| other == node)
        {
            apart -= Vec3::axis(*axis) * shape.n[k];
            dtangent = Vec3::axis(*axis) * shape.dn[k][0];
        }
        let dxi = (apart.dot(tangent) + self.to.dot(dtangent)) / (tangent.dot(tangent) - self.to.dot(bend));
        (dxi, apart, dtangent)
    }
}

impl NodesInPlace<'_> {
    fn tip(&self, patch: &Patch, landing: Landing) -> Option<TipInPlace<'_>> {
        let (tool, contact) = (self.tool.as_ref()?, self.contact);
        let faces = &contact.parts.surface.faces;
        let foot = |face: usize, (near, fixed): (f64, Option<usize>), centre: Vec3| {
            let (face, centre) = (&faces[face], tool.place(centre));
            let placed = self.placed(face);
            let edge = PlacedEdge { face, placed: &placed };
            let closest = || root_near(near, |xi| edge.offset(xi, centre));
            let xi = fixed.map_or_else(closest, |corner| face.corner_place(corner)[0]);
            let at = edge.at(xi);
            FootInPlace { nodes: &face.nodes, xi, centre, to: centre - at.x, at }
        };
        let own = foot(patch.face, (landing.xi[0], landing.corner.or(landing.border)), landing.centre);
        let area = contact.tip_area(patch.face, own.xi);
        let n = outward(own.at.tangent);
        let n = if landing.corner.is_some() { facing_centre(own.to, n) } else { n };
        let beside = [0, 1].map(|corner| {
            let FootBeside { face, corner: other, xi, centre } = landing.beside[corner]?;
            let beside = foot(face, (xi, None), centre);
            let part = part([(corner, own.xi), (other, beside.xi)]);
            Some((beside, part))
        });
        Some(TipInPlace { tool, landing, foot: own, n, area, beside })
    }

    /// The point of a tip.
    pub(super) fn tip_point(
        &self,
        (patch, landing): (&Patch, Landing),
        recall: Recall,
        points: &mut Vec<PatchPoint>,
    ) -> Option<()> {
        if !self.contact.parts.surface.plane {
            return self.edge_point((patch, landing), recall, points);
        }
        let tip = self.tip(patch, landing)?;
        let (xi, n) = ([tip.foot.xi, 0.0], tip.n);
        let touched = recall(self, patch, xi);
        points.push(PatchPoint {
            number: 0,
            vertex: None,
            xi,
            weight: tip.weight(),
            functions: ShapeFunctions::constant(1.0),
            dual: ShapeFunctions::constant(0.0),
            shape: tip.foot.at.shape,
            gap: tip.foot.to.dot(n)
                - landing.radius
                - self.contact.parts.surface.rise(patch.face, &self.arcs.own, xi).0,
            bulge: 0.0,
            n,
            v: touched.map_or(Vec3::zero(), |touched| touched.tip - touched.now),
            y: tip.foot.centre - n * landing.radius,
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
        if !self.contact.parts.surface.plane {
            return self.edge_rates((patch, landing), points, columns, rates);
        }
        let (Some(tip), [point]) = (self.tip(patch, landing), points) else { return };
        let TipInPlace { tool, landing, ref foot, n, .. } = tip;
        let FootInPlace { ref at, centre, to, .. } = *foot;
        let (_, [slope, _]) = self.contact.parts.surface.rise(patch.face, &self.arcs.own, point.xi);
        for column in columns {
            let carried = |place: Vec3| tool_motion(tool, column, place).0;
            let (dxi, apart, dtangent) = foot.rates(tool, column);
            let stays = landing.border.is_some();
            let (dxi, dn) = if landing.corner.is_some() {
                (0.0, (n * to.norm()).turned(apart * to.dot(n).signum()))
            } else {
                let dxi = if stays { 0.0 } else { dxi };
                (dxi, at.tangent.turned(dtangent + at.bend * dxi).cross(Vec3::axis(2)))
            };
            let slid = |touched: &Touched| carried(touched.tip) - left_behind(self.contact, column, touched);
            rates.push(PointRates {
                weight: tip.weight_rate(dxi, column),
                xi: [dxi, 0.0],
                bulge: 0.0,
                gap: n.dot(apart) + if stays { dn.dot(to) } else { 0.0 } - slope * dxi,
                n: dn,
                v: point.touched.as_ref().map_or(Vec3::zero(), slid),
                s: [0.0; 2],
                y: carried(centre) - dn * landing.radius,
            });
        }
    }
}

impl TipInPlace<'_> {
    fn weight(&self) -> f64 {
        let parts = self.beside.iter().flatten().map(|(_, [part, ..])| part);
        self.area[0] * self.landing.share * parts.product::<f64>()
    }
    /// Its derivative along an unknown.
    fn weight_rate(&self, dxi: f64, column: &PointColumn) -> f64 {
        let (mut product, mut rate) = (self.area[0], self.area[1] * dxi);
        for (beside, [part, own, other]) in self.beside.iter().flatten() {
            rate = rate * part + product * (own * dxi + other * beside.rates(self.tool, column).0);
            product *= part;
        }
        rate * self.landing.share
    }
}

/// Displacement along an unknown of the place of the surface over which a tip lay at the accepted state.
pub(super) fn left_behind(contact: &FieldContact, column: &PointColumn, touched: &Touched) -> Vec3 {
    let (PointColumn::Node { axis, node, .. }, Some((face, shape))) = (column, &touched.face) else {
        return Vec3::zero();
    };
    let place = contact.parts.surface.faces[*face].nodes.iter().position(|other| other == node);
    place.map_or(Vec3::zero(), |k| Vec3::axis(*axis) * shape.n[k])
}
