//! A tip of a tool over one face of the surface: node-to-segment contact (Hallquist, Goudreau & Benson, Comput. Meth. Appl. Mech.
//! Eng. 51, 1985; Wriggers, Computational Contact Mechanics, 2006) of the tip with the edge that lies closest.
//!
//! The gap of a node of the field is a mean over the faces around it, and a wedge lies in them by a good part of a face before that
//! closes. A tip therefore is a stencil of its own, beside those of the nodes, with the area of the face that it lies over. With
//! `v` its foremost point and `x(xi)` the place of the edge closest to it, the gap is `(v - x) . n`, `n` the edge's outward normal;
//! where two edges meet that the tip has pushed into a valley, it is `-|v - x|` along `x - v`.

use super::column::PointColumn;
use super::configuration::{Configuration, TargetInPlace};
use super::contact::FieldContact;
use super::cover::{Landing, Patch, root_near};
use super::face::{FieldFace, MOST, PlacedFace, ShapeFunctions};
use super::nodes::NodesInPlace;
use super::point::{PatchPoint, PointRates, Sight, Touched};
use super::points::Recall;
use super::tool::ToolInPlace;
use crate::mesh::Side;
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

/// Cosine of the angle between the surface's normal and the direction that a tip points against above which it points at it.
const POINTS: f64 = 0.1;
/// Cosines of the angle between the surface and the nearer flank of a tip between which that comes to lie flat on it, as the corner
/// of a punch does: the flank's own nodes then feel all that there is, and the tip nothing.
const FLAT: [f64; 2] = [0.75, 0.9];
/// How far beside the end of the surface, over half of its face there, a tip may lie that lies over that end,
const BESIDE: f64 = 0.5;
/// and how far from it along the face, likewise.
const AT_END: f64 = 1e-3;
/// Starts of the search for the closest place of an edge.
const STARTS: [f64; 3] = [-0.5, 0.0, 0.5];

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
    /// Whether a tip that points so points at no place of the edge, along which the tangent changes linearly.
    fn looks_away(&self, points: Vec3) -> bool {
        let ends = [-1.0, 1.0].map(|xi| self.tangent(xi));
        let least = POINTS * (ends[0].norm() - (ends[1] - ends[0]).norm());
        ends.iter().all(|tangent| tangent.cross(Vec3::axis(2)).dot(points) > -least)
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
            let mut found = self.land((number, tip), tool)?;
            if let Some(landing) = &mut found.patch.tip {
                let had = before.map(|before| before.get(number).copied().flatten().and_then(|found| found.patch.tip));
                landing.share = had.map_or(1.0, |had| had.map_or(landing.share, |had| had.share));
            }
            Some(found).filter(|found| found.gap <= reach && found.patch.tip.is_some_and(|tip| tip.share > 0.0))
        };
        self.contact.tips().iter().enumerate().map(land).collect()
    }

    fn land(&self, (number, tip): (usize, &Tip), tool: &ToolInPlace) -> Option<TipFoot> {
        let (vertex, points) = (tool.place(tip.point), tool.rotate(tip.outward));
        let flanks = tip.flanks.map(|flank| tool.rotate(flank));
        let (mut best, mut valleys): (Option<TipFoot>, Vec<(usize, Side)>) = (None, Vec::new());
        let mut offer = |found: TipFoot| {
            let nearer = best.is_none_or(|best| found.gap.abs() < best.gap.abs());
            best = if nearer { Some(found) } else { best };
        };
        let surface = &self.contact.parts.surface;
        for (f, face) in surface.faces.iter().enumerate() {
            let edge = PlacedEdge { face, placed: &self.placed[f] };
            let is_end = |corner: usize| surface.nodes[surface.field[f][corner]].support.len() == 1;
            // Most edges do not see the end of a plate that lies along them.
            if edge.looks_away(points) && !(0..2).any(is_end) {
                continue;
            }
            let xi = edge.closest(vertex);
            let at = edge.at(xi);
            let (n, to) = (outward(at.tangent), vertex - at.x);
            let nearer = usize::from(xi > 0.0);
            let ends = is_end(nearer);
            let inner = if ends { 1.0 - AT_END } else { 1.0 };
            let corner = if xi.abs() < inner { None } else { Some(nearer) };
            // On a plane of symmetry the edge comes to lie along the flank, and would turn away without its other half.
            let rest = corner.filter(|_| ends).map(|_| self.undeformed_normal(face));
            if rest.unwrap_or(n).dot(points) > -POINTS {
                continue;
            }
            let landed = |corner: Option<usize>, border: Option<usize>| {
                let share = self.share((f, nearer), flanks, rest);
                let tip = Some(Landing { xi, corner, border, share });
                Patch { face: f, target: number, ends: [None; 2], near: [xi, xi], seen: None, tip }
            };
            let patch = |corner: Option<usize>| landed(corner, None);
            match corner {
                None => offer(TipFoot { patch: patch(None), gap: to.dot(n) }),
                Some(corner) if ends => {
                    if to.dot(at.tangent).abs() <= BESIDE * at.tangent.dot(at.tangent) {
                        offer(TipFoot { patch: landed(None, Some(corner)), gap: to.dot(n) });
                    }
                }
                // Within both edges that meet there.
                Some(corner) if to.dot(n) < 0.0 => {
                    let (node, gap) = (face.corner_node(corner), -to.norm());
                    match valleys.iter().find(|(other, _)| *other == node) {
                        // Both halves of an edge of second degree meet without a crease.
                        Some((_, side)) if *side == face.side => offer(TipFoot { patch: patch(None), gap: to.dot(n) }),
                        Some(_) => offer(TipFoot { patch: patch(Some(corner)), gap }),
                        None => valleys.push((node, face.side)),
                    }
                }
                Some(_) => {}
            }
        }
        best
    }

    fn undeformed_normal(&self, face: &FieldFace) -> Vec3 {
        let rest = face.at_rest(&self.contact.parts.mesh);
        outward(face.shape(face.middle()).tangents(rest.nodes(), true)[0])
    }

    /// The part that a tip has in a face by how flat its flanks lie on it, or on it and its neighbour at a corner taken together; at
    /// the end of the surface on the normal it had, which a plane of symmetry keeps.
    fn share(&self, (f, corner): (usize, usize), flanks: [Vec3; 2], rest: Option<Vec3>) -> f64 {
        let surface = &self.contact.parts.surface;
        let area = |f: usize| {
            let face = &surface.faces[f];
            face.shape(face.middle()).tangents(self.placed[f].nodes(), true)[0].cross(Vec3::axis(2))
        };
        let both =
            surface.nodes[surface.field[f][corner]].support.iter().fold(Vec3::zero(), |sum, &(f, _)| sum + area(f));
        let flat = |n: Vec3| flanks.iter().map(|flank| -flank.dot(n)).fold(-1.0, f64::max);
        let cosine = rest.map_or_else(|| flat(area(f).unit()).min(flat(both.unit())), flat);
        let t = ((cosine - FLAT[0]) / (FLAT[1] - FLAT[0])).clamp(0.0, 1.0);
        1.0 - t * t * (3.0 - 2.0 * t)
    }
}

/// A tip over its place of the edge.
struct TipInPlace<'a> {
    tool: &'a ToolInPlace<'a>,
    vertex: Vec3,
    xi: f64,
    at: EdgePlace,
    /// Undeformed area for a unit of the reference coordinate there, with its slope, times the length that it stands for.
    area: f64,
    slope: f64,
}

impl NodesInPlace<'_> {
    fn tip(&self, patch: &Patch, landing: Landing) -> Option<TipInPlace<'_>> {
        let (tool, contact) = (self.tool.as_ref()?, self.contact);
        let face = &contact.parts.surface.faces[patch.face];
        let placed = self.placed(face);
        let edge = PlacedEdge { face, placed: &placed };
        let vertex = tool.place(contact.tips()[patch.target].point);
        let xi = match landing.corner.or(landing.border) {
            Some(corner) => face.corner_place(corner)[0],
            None => root_near(landing.xi, |xi| edge.offset(xi, vertex)),
        };
        // Where the surface ends it has half of the face, whose area at an axis is not that of its end.
        let (over, length) = if landing.border.is_some() { (0.0, 1.0) } else { (xi, 2.0) };
        let rest = face.at_rest(&contact.parts.mesh);
        let (density, [slope, _]) = contact.parts.surface.density(face, &rest, [over, 0.0]);
        Some(TipInPlace { tool, vertex, xi, at: edge.at(xi), area: length * density, slope })
    }

    /// The point of a tip.
    pub(super) fn tip_point(
        &self,
        (patch, landing): (&Patch, Landing),
        recall: Recall,
        points: &mut Vec<PatchPoint>,
    ) -> Option<()> {
        let TipInPlace { vertex, xi, at, area, .. } = self.tip(patch, landing)?;
        let (xi, to) = ([xi, 0.0], vertex - at.x);
        let n = if landing.corner.is_some() { -to.unit() } else { outward(at.tangent) };
        let touched = recall(self, patch, xi);
        points.push(PatchPoint {
            number: 0,
            xi,
            weight: area * landing.share,
            functions: ShapeFunctions { n: [1.0; MOST], dn: [[0.0; 2]; MOST] },
            shape: at.shape,
            gap: to.dot(n),
            n,
            v: touched.map_or(Vec3::zero(), |touched| vertex - touched.now),
            y: vertex,
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
        let TipInPlace { tool, vertex, at, slope, .. } = tip;
        let to = vertex - at.x;
        for column in columns {
            let (dx, dtangent, dvertex) = match column {
                PointColumn::Node { axis, own: Some(k), .. } => {
                    (Vec3::axis(*axis) * at.shape.n[*k], Vec3::axis(*axis) * at.shape.dn[*k][0], Vec3::zero())
                }
                PointColumn::Node { .. } => (Vec3::zero(), Vec3::zero(), Vec3::zero()),
                PointColumn::Tool(j) => (Vec3::zero(), Vec3::zero(), tool.rates(vertex)[*j]),
            };
            let apart = dvertex - dx;
            let stays = landing.border.is_some();
            let (dxi, dn) = if landing.corner.is_some() {
                (0.0, (-to).turned(-apart))
            } else {
                let stiff = at.tangent.dot(at.tangent) - to.dot(at.bend);
                let dxi = if stays { 0.0 } else { (apart.dot(at.tangent) + to.dot(dtangent)) / stiff };
                (dxi, at.tangent.turned(dtangent + at.bend * dxi).cross(Vec3::axis(2)))
            };
            let left = |touched: &Touched| dvertex - left_behind(self.contact, column, touched);
            rates.push(PointRates {
                weight: 2.0 * slope * dxi * landing.share,
                xi: [dxi, 0.0],
                gap: point.n.dot(apart) + if stays { dn.dot(to) } else { 0.0 },
                n: dn,
                v: point.touched.as_ref().map_or(Vec3::zero(), left),
                s: [0.0; 2],
                y: dvertex,
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
