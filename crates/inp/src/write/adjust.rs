//! Nodes that `ADJUST` moves onto the other surface of a contact pair before the first step, or `CLEARANCE` to a distance from it,
//! without strain.

use super::Writer;
use crate::elements::Family;
use crate::model::{Element, Pair, SurfaceKind};
use crate::vector::{cross, dot, less, unit};
use std::collections::{BTreeMap, BTreeSet};

/// A facet: three corners, or two in the plane, and its outward normal.
struct Facet {
    corners: Vec<[f64; 3]>,
    normal: [f64; 3],
}

/// Corners of the edges in the middle of which the nodes beyond the corners lie.
const MIDDLES: [(&str, &[[usize; 2]]); 3] = [
    ("C3D10", &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]]),
    ("C3D15", &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]]),
    ("C3D20", &[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]]),
];

impl Writer<'_> {
    /// Moves nodes of the slave onto the faces of the master that they stand off from by no more than the deck says. Those that
    /// lie inside are moved out by the contact.
    pub(super) fn adjust(&mut self, pair: &Pair) {
        let Some(adjust) = &pair.adjust else { return };
        let (Some(slave), Some(master)) = (self.model.surface(&pair.slave), self.model.surface(&pair.master)) else {
            return;
        };
        let rigid = |element: usize| self.model.elements[element].kind.family == Family::Rigid;
        let faces = match &master.kind {
            SurfaceKind::Faces(faces) if !faces.iter().any(|&(element, ..)| rigid(element)) => faces,
            _ => {
                let what = "gaps to a rigid surface stay as wide as they are, whatever ADJUST or CLEARANCE say";
                return self.note(pair.place, what);
            }
        };
        let boundary = self.boundary();
        let whole = |(element, face): (usize, Option<usize>)| match face {
            Some(face) => vec![(element, face)],
            None => boundary.range((element, 0)..(element + 1, 0)).copied().collect(),
        };
        let facets: Vec<Facet> = faces
            .iter()
            .flat_map(|&(element, face, _)| whole((element, face)))
            .flat_map(|(element, face)| self.facets_of(&self.model.elements[element], face))
            .collect();
        let nodes: BTreeSet<usize> = match &slave.kind {
            SurfaceKind::Nodes(nodes) => nodes.iter().copied().collect(),
            SurfaceKind::Faces(faces) => faces
                .iter()
                .flat_map(|&(element, face, _)| whole((element, face)))
                .flat_map(|(element, face)| nodes_of(&self.model.elements[element], face))
                .collect(),
            SurfaceKind::Analytical(_) => return,
        };
        let chosen = |node: &usize| adjust.nodes.as_ref().is_none_or(|set| set.contains(node));
        let mut moved: BTreeMap<usize, [f64; 3]> = BTreeMap::new();
        let mut most = 0.0_f64;
        for node in nodes.into_iter().filter(chosen) {
            let x = self.model.nodes[node].x;
            let under = facets.iter().filter_map(|facet| Some((facet.under(x)?, facet.normal)));
            let Some((gap, normal)) = under.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs())) else { continue };
            let clearance = adjust.clearance.unwrap_or(0.0);
            if adjust.clearance.is_some() || (gap > 0.0 && gap <= adjust.distance) {
                moved.insert(node, std::array::from_fn(|i| x[i] + (clearance - gap) * normal[i]));
                most = most.max((clearance - gap).abs());
            }
        }
        if !moved.is_empty() {
            let (count, which) = (moved.len(), if adjust.clearance.is_some() { "CLEARANCE" } else { "ADJUST" });
            let what = format!(
                "{which}: {count} nodes are moved along the normals of the other surface, by {most:.3e} at most"
            );
            self.note(pair.place, what);
        }
        self.moved.extend(moved);
    }

    /// The facets of a face of an element.
    fn facets_of(&self, element: &Element, face: usize) -> Vec<Facet> {
        let x = |corner: usize| self.model.nodes[element.nodes[corner]].x;
        let Some(corners) = element.kind.faces.get(face - 1) else { return vec![] };
        let all: BTreeSet<usize> = element.kind.faces.iter().flat_map(|face| face.iter().copied()).collect();
        let middle = mean(&all.into_iter().map(x).collect::<Vec<_>>());
        let pieces: Vec<Vec<[f64; 3]>> = match corners {
            [a, b] => vec![vec![x(*a), x(*b)]],
            [a, b, c] => vec![vec![x(*a), x(*b), x(*c)]],
            several => {
                let centre = mean(&several.iter().map(|&corner| x(corner)).collect::<Vec<_>>());
                let next = |at: usize| x(several[(at + 1) % several.len()]);
                (0..several.len()).map(|at| vec![x(several[at]), next(at), centre]).collect()
            }
        };
        let facet = |corners: Vec<[f64; 3]>| {
            let first = less(corners[1], corners[0]);
            let normal = match corners.get(2) {
                Some(third) => cross(first, less(*third, corners[0])),
                None => [first[1], -first[0], 0.0],
            };
            let outward = dot(normal, less(corners[0], middle)).signum();
            unit(normal).map(|normal| Facet { corners, normal: normal.map(|n| outward * n) })
        };
        pieces.into_iter().filter_map(facet).collect()
    }
}

impl Facet {
    /// How far a point stands off, if its foot lies within the facet.
    fn under(&self, x: [f64; 3]) -> Option<f64> {
        let gap = dot(self.normal, less(x, self.corners[0]));
        let foot: [f64; 3] = std::array::from_fn(|i| x[i] - gap * self.normal[i]);
        let count = self.corners.len();
        let within = (0..count).all(|at| {
            let (a, b) = (self.corners[at], self.corners[(at + 1) % count]);
            let third = self.corners.get((at + 2) % count).filter(|_| count == 3);
            let inward = match third {
                Some(third) => {
                    let across = cross(self.normal, less(b, a));
                    across.map(|c| c * dot(across, less(*third, a)).signum())
                }
                None => less(b, a),
            };
            dot(inward, less(foot, a)) >= -1e-6 * dot(inward, inward).sqrt() * dot(less(b, a), less(b, a)).sqrt()
        });
        within.then_some(gap)
    }
}

/// Corners of a face of an element and the nodes in the middle of its edges.
pub(super) fn nodes_of(element: &Element, face: usize) -> Vec<usize> {
    let Some(corners) = element.kind.faces.get(face - 1) else { return vec![] };
    let mut nodes: Vec<usize> = corners.iter().map(|&corner| element.nodes[corner]).collect();
    let count = element.kind.faces.iter().flat_map(|face| face.iter()).max().map_or(0, |most| most + 1);
    if element.kind.degree == 2 {
        let round: Vec<[usize; 2]> = (0..count).map(|at| [at, (at + 1) % count]).collect();
        let edges =
            MIDDLES.iter().find(|(name, _)| *name == element.kind.name).map_or(round.as_slice(), |found| found.1);
        let on_face = edges.iter().enumerate().filter(|(_, edge)| edge.iter().all(|corner| corners.contains(corner)));
        nodes.extend(on_face.filter_map(|(at, _)| element.nodes.get(count + at)));
    }
    nodes
}

fn mean(points: &[[f64; 3]]) -> [f64; 3] {
    std::array::from_fn(|i| points.iter().map(|x| x[i]).sum::<f64>() / points.len().max(1) as f64)
}
