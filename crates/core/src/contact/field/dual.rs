//! Where faces that an edge of a body bounds have dual functions, and how large a part of theirs these are.

use super::contact::{FieldContact, FieldTarget};
use super::cover::Patch;
use super::face::PlacedFace;
use super::point::smoothstep;
use super::surface::FieldNode;
use crate::contact::record::{entry, stresses};
use crate::system::History;
use crate::tensor::Vec3;

/// Friction, as sliding shear over pressure, between which dual functions of second degree end where a contact is about to slide: under
/// more, an edge that leads digs itself in and springs back.
const STEEP: [f64; 2] = [0.8, 1.0];
/// Shear of all of it, over that under which it slides, between which it is.
const SLIDING: [f64; 2] = [0.35, 0.6];
/// Angle to the faces beside it between which they end at an end of the surface: the side of a billet that folds onto a tool is no edge.
const BENT: [f64; 2] = [0.05, 0.2];

/// Share of dual functions of whose sum with ordinary ones a gap that opens with the square of the distance has the mean zero.
pub(super) const BLENDED: f64 = 0.5;

/// A cubic that falls from one to zero over a range.
fn fade(x: f64, [from, to]: [f64; 2]) -> f64 {
    1.0 - smoothstep((x - from) / (to - from))[0]
}

impl FieldContact {
    /// Largest shares of dual functions at each node after an accepted history: less where the surface bends, and of those of second degree
    /// where friction pushes an edge in.
    pub(super) fn dual_limits(&self, placed: &[PlacedFace], history: &History) -> Vec<[f64; 2]> {
        let (law, [mut sliding, mut shear, mut pressure]) = (self.parts.law.first(), [0.0; 3]);
        // It does not rise again while anything touches, or it went to and fro from increment to increment.
        let mut at_rest = 1.0_f64;
        for slot in (0..self.nodal_slots()).map(|slot| history.slot(slot)).filter(|slot| slot[entry::STATUS] > 0.0) {
            let ([p, s, t, _], area) = (stresses(slot), slot[entry::XI]);
            sliding += area * law.sliding_stress(p).unwrap_or(0.0);
            (shear, pressure) = (shear + s.hypot(t) * area, pressure + p * area);
            at_rest = at_rest.min(slot[entry::AT_REST]);
        }
        if sliding > 0.0 {
            let smooth = fade(sliding / pressure, STEEP);
            at_rest = at_rest.min(smooth + (1.0 - smooth) * fade(shear / sliding, SLIDING));
        }
        self.unbent(placed).map(|unbent| [unbent, at_rest]).collect()
    }

    /// The same before any history.
    pub(super) fn first_limits(&self, placed: &[PlacedFace]) -> Vec<[f64; 2]> {
        self.unbent(placed).map(|unbent| [unbent, 1.0]).collect()
    }

    /// Of these how far the surface does not bend at each node.
    fn unbent(&self, placed: &[PlacedFace]) -> impl Iterator<Item = f64> {
        let surface = &self.parts.surface;
        let normals: Vec<Vec3> =
            surface.faces.iter().zip(placed).map(|(face, placed)| surface.middle_normal(face, placed)).collect();
        surface.nodes.iter().map(move |node: &FieldNode| {
            let pairs = node.support.iter().flat_map(|&(f, _)| node.support.iter().map(move |&(g, _)| (f, g)));
            fade(pairs.map(|(f, g)| normals[f].cross(normals[g]).norm()).fold(0.0, f64::max), BENT)
        })
    }

    /// Those by which the stresses of an accepted history were found.
    pub(super) fn known_limits(&self, history: &History) -> Vec<[f64; 2]> {
        let of = |node: usize, entry: usize| {
            let slots = (0..self.pieces).map(|piece| history.slot(self.slot(node, piece))[entry]);
            slots.fold(0.0, f64::max)
        };
        (0..self.parts.surface.nodes.len()).map(|node| [entry::UNBENT, entry::AT_REST].map(|e| of(node, e))).collect()
    }

    /// Largest share of dual functions on a face with these limits at its nodes.
    pub(super) fn dual_limit(&self, face: usize, limits: &[[f64; 2]]) -> f64 {
        let surface = &self.parts.surface;
        let corners = &surface.field[face][..surface.faces[face].corners()];
        let least =
            |which: usize| corners.iter().filter_map(|&node| limits.get(node)).map(|l| l[which]).fold(1.0, f64::min);
        let unbent = if surface.creased[face] || surface.curved[face] { 1.0 } else { least(0) };
        if surface.faces[face].kind.degree > 1 { unbent * least(1) } else { unbent }
    }

    /// Whether dual functions (Wohlmuth, SIAM J. Numer. Anal. 38, 2000) are those of the nodes on a patch: their means are the gaps at the
    /// corners, where others let an edge in as far as the rest of the face stands off and have its pressure a third of the face away.
    /// So it is at a crease of the surface; at its end where it and what it sees are flat, since it may end on a plane of symmetry; and
    /// where facets of first degree of a curve touch by their corners what is straight.
    pub(super) fn is_sharp(&self, patch: &Patch) -> bool {
        let (surface, face) = (&self.parts.surface, patch.face);
        let facet = surface.plane && surface.faces[face].kind.degree == 1 && surface.curved[face];
        surface.creased[face]
            || ((surface.ending[face] && !surface.curved[face] || facet) && self.is_straight(patch.target))
    }

    /// Whether a piece or face of the target is no part of a curve.
    fn is_straight(&self, target: usize) -> bool {
        match &self.parts.target {
            FieldTarget::Tool(tool) => tool.is_straight(target),
            FieldTarget::Faces(faces) => !faces.surface.curved[target],
        }
    }

    /// Largest share of dual functions on a patch. Of a gap that opens from an edge with the square of the distance the mean with ordinary
    /// functions is a sixth of what it is at the far end of the face, with dual ones as much less than zero. The square of a face itself, as
    /// of a plate which lifts off a table from where it is clamped, is therefore none of what the dual part has for the gap, but where it
    /// lies in the target (a Petrov-Galerkin method: forces are those of dual functions all the same, and constant pressures exact). Where
    /// the target or what the face stands for is round before any motion there is half of each.
    pub(super) fn most_dual(&self, patch: &Patch) -> f64 {
        let (surface, face) = (&self.parts.surface, patch.face);
        let round = surface.curved[face] && (surface.faces[face].kind.degree > 1 || self.rest.own[face].is_some());
        if self.is_straight(patch.target) && !round { 1.0 } else { BLENDED }
    }
}
