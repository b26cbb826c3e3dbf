//! Where faces that an edge of a body bounds have dual functions, and how large a part of theirs these are.

use super::contact::{FieldContact, FieldTarget};
use super::cover::Patch;
use super::face::PlacedFace;
use super::point::smoothstep;
use crate::contact::record::{entry, stresses};
use crate::system::History;

/// Friction, as sliding shear over pressure, between which dual functions of second degree end where a contact is about to slide: under
/// more, an edge that leads digs itself in and springs back.
const STEEP: [f64; 2] = [0.8, 1.0];
/// Shear over pressure of all of it between which it is.
const SLIDING: [f64; 2] = [0.3, 0.6];
/// Angle to the faces beside it between which they end at an end of the surface: the side of a billet that folds onto a tool is no edge.
const BENT: [f64; 2] = [0.05, 0.2];

/// Share of dual functions of whose sum with ordinary ones a gap that opens with the square of the distance has the mean zero.
pub(super) const BLENDED: f64 = 0.5;

/// A cubic that falls from one to zero over a range.
fn fade(x: f64, [from, to]: [f64; 2]) -> f64 {
    1.0 - smoothstep((x - from) / (to - from))[0]
}

impl FieldContact {
    /// Largest share of dual functions of second degree after an accepted history: none where friction pushes an edge in.
    pub(super) fn second_degree_share(&self, history: &History) -> f64 {
        let (law, [mut sliding, mut shear, mut pressure]) = (self.parts.law.first(), [0.0; 3]);
        for slot in (0..self.nodal_slots()).map(|slot| history.slot(slot)) {
            let ([p, s, t, _], area) = (stresses(slot), slot[entry::XI]);
            sliding += area * law.sliding_stress(p).unwrap_or(0.0);
            (shear, pressure) = (shear + s.hypot(t) * area, pressure + p * area);
        }
        let [smooth, rests] = [(sliding, STEEP), (shear, SLIDING)].map(|(stress, range)| {
            if pressure > 0.0 { fade(stress / pressure, range) } else { 1.0 }
        });
        smooth + (1.0 - smooth) * rests
    }

    /// Largest share of dual functions on a face by how it bends into those beside it.
    pub(super) fn unbent_share(&self, face: usize, placed: &[PlacedFace]) -> f64 {
        let surface = &self.parts.surface;
        if surface.creased[face] || surface.curved[face] {
            return 1.0;
        }
        let normal = |face: usize| surface.middle_normal(&surface.faces[face], &placed[face]);
        let nodes = surface.field[face][..surface.faces[face].corners()].iter();
        let beside = nodes.flat_map(|&node| &surface.nodes[node].support);
        let bend = beside.map(|&(other, _)| normal(face).cross(normal(other)).norm());
        fade(bend.fold(0.0, f64::max), BENT)
    }

    /// Whether dual functions (Wohlmuth, SIAM J. Numer. Anal. 38, 2000) are those of the nodes on a patch: their means are the gaps at the
    /// corners, where others let an edge in as far as the rest of the face stands off and have its pressure a third of the face away.
    /// So it is at a crease of the surface; at its end where it and what it sees are flat, since it may end on a plane of symmetry; and
    /// where facets of first degree of a curve touch by their corners what is straight.
    pub(super) fn is_sharp(&self, patch: &Patch) -> bool {
        let (surface, face) = (&self.parts.surface, patch.face);
        let flat = || match &self.parts.target {
            FieldTarget::Tool(tool) => tool.is_straight(patch.target),
            FieldTarget::Faces(faces) => !faces.surface.curved[patch.target],
        };
        let facet = surface.plane && surface.faces[face].kind.degree == 1 && surface.curved[face];
        surface.creased[face] || ((surface.ending[face] && !surface.curved[face] || facet) && flat())
    }

    /// Largest share of dual functions on a patch. Of a gap that opens from an edge with the square of the distance the mean with ordinary
    /// functions is a sixth of what it is at the far end of the face, with dual ones as much less than zero. The square of a face itself, as
    /// of a plate which lifts off a table from where it is clamped, is therefore none of what the dual part has for the gap, but where it
    /// lies in the target (a Petrov-Galerkin method: forces are those of dual functions all the same, and constant pressures exact); over a
    /// round target there is half of each.
    pub(super) fn most_dual(&self, patch: &Patch) -> f64 {
        let straight = match &self.parts.target {
            FieldTarget::Tool(tool) => tool.is_straight(patch.target),
            FieldTarget::Faces(faces) => !faces.surface.curved[patch.target],
        };
        if straight { 1.0 } else { BLENDED }
    }
}
