//! Where faces that an edge of a body bounds have dual functions, and how large a part of theirs these are.

use super::contact::{FieldContact, FieldTarget};
use super::cover::Patch;
use super::face::{CORNERS, PlacedFace, ShapeFunctions};
use super::point::smoothstep;
use super::surface::FieldSurface;
use crate::contact::record::entry;
use crate::system::History;

/// Friction, as sliding shear over pressure, between which dual functions of second degree end in space: under more an edge that leads digs
/// in its nodes between the corners, which have no pressure of their own, and springs back.
const STEEP: [f64; 2] = [0.8, 1.0];
/// Angle to the faces beside it between which they end at an end of the surface: the side of a billet that folds onto a tool is no edge.
const BENT: [f64; 2] = [0.05, 0.2];

impl FieldContact {
    /// Largest share of dual functions on each face in a state with these stresses: it ends where friction pushes an edge in, and
    /// at an end of the surface that bends.
    pub(super) fn dual_limits(&self, placed: &[PlacedFace], history: &History) -> Vec<f64> {
        let (surface, law) = (&self.parts.surface, self.parts.law.first());
        let normal = |face: usize| surface.middle_normal(&surface.faces[face], &placed[face]);
        let fade = |x: f64, [from, to]: [f64; 2]| 1.0 - smoothstep((x - from) / (to - from))[0];
        let pressures = || (0..self.nodal_slots()).map(|slot| history.slot(slot)[entry::PRESSURE]).filter(|p| *p > 0.0);
        let sliding: f64 = pressures().filter_map(|p| law.sliding_stress(p)).sum();
        let steep = if sliding > 0.0 { fade(sliding / pressures().sum::<f64>(), STEEP) } else { 1.0 };
        let limit = |face: usize| {
            let (mut bend, corners) = (0.0_f64, surface.faces[face].corners());
            if !surface.creased[face] && !surface.curved[face] {
                for &(other, _) in surface.field[face][..corners].iter().flat_map(|&node| &surface.nodes[node].support) {
                    bend = bend.max(normal(face).cross(normal(other)).norm());
                }
            }
            let is_steep = !surface.plane && surface.faces[face].kind.degree > 1;
            fade(bend, BENT) * if is_steep { steep } else { 1.0 }
        };
        (0..surface.faces.len()).map(|face| if surface.duals[face].is_some() { limit(face) } else { 1.0 }).collect()
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

    /// Whether the gap over a patch cannot but be linear.
    pub(super) fn is_linear(&self, patch: &Patch) -> bool {
        let straight = match &self.parts.target {
            FieldTarget::Tool(tool) => tool.is_straight(patch.target),
            FieldTarget::Faces(faces) => faces.surface.faces[patch.target].kind.degree == 1,
        };
        straight && self.parts.surface.faces[patch.face].kind.degree == 1
    }
}

impl Patch {
    /// Functions of the nodes of the field where those of its corners are these, at a `corner` none; and those by which they have the gap.
    ///
    /// Of a gap that opens from an edge with the square of the distance, as that of a plate which lifts off a table from where it is
    /// clamped, the mean with ordinary functions is a sixth of what it is at the far end of the face, with dual ones as much less than zero.
    /// Where it is collocated the dual part of it is therefore its value at the corner (a Petrov-Galerkin method: the forces are those of
    /// the dual functions all the same, and constant pressures exact).
    pub(super) fn functions(
        &self,
        surface: &FieldSurface,
        corner: Option<usize>,
        corners: &ShapeFunctions,
    ) -> [ShapeFunctions; 2] {
        let (mut functions, share) = (*corners, self.dual);
        if let Some(corner) = corner {
            let [none, mut of_gap] = [ShapeFunctions::constant(0.0); 2];
            of_gap.n[corner] = if self.collocated[corner] == Some(true) { share } else { 0.0 };
            return [none, of_gap];
        }
        if let Some(dual) = surface.duals[self.face].filter(|_| share > 0.0) {
            for (i, row) in dual.iter().enumerate() {
                let of =
                    |value: &dyn Fn(usize) -> f64| -> f64 { row.iter().enumerate().map(|(j, d)| d * value(j)).sum() };
                functions.n[i] += share * (of(&|j| corners.n[j]) - corners.n[i]);
                for a in 0..2 {
                    functions.dn[i][a] += share * (of(&|j| corners.dn[j][a]) - corners.dn[i][a]);
                }
            }
        }
        let mut of_gap = functions;
        for c in (0..CORNERS).filter(|&c| self.collocated[c].is_some()) {
            (of_gap.n[c], of_gap.dn[c]) = ((1.0 - share) * corners.n[c], corners.dn[c].map(|dn| (1.0 - share) * dn));
        }
        [functions, of_gap]
    }
}
