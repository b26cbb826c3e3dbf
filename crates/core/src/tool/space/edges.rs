//! Edges of a tool in space that turn outward, and its free ends, as points along them: what may touch a body within one of its faces.

use super::distance::TOGETHER;
use super::nearest::RigidFacet;
use super::tool::SpaceTool;
use crate::tensor::Vec3;
use crate::tool::Tip;
use crate::tool::distance::CREASE;

/// Most points of a tool.
const MOST: usize = 20_000;
/// Chords by which the length of an edge is measured.
const CHORDS: usize = 16;
/// Sine of an inward turn that is none, by rounding.
const STRAIGHT: f64 = 1e-6;

/// Corners of a facet in reference coordinates, counter-clockwise.
const TRIANGLE: &[[f64; 2]] = &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
const SQUARE: &[[f64; 2]] = &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

/// One edge of a facet.
#[derive(Clone, Copy)]
struct BorderEdge<'a> {
    facet: &'a dyn RigidFacet,
    ends: [[f64; 2]; 2],
}

impl BorderEdge<'_> {
    fn at(&self, part: f64) -> [f64; 2] {
        let [from, to] = self.ends;
        [0, 1].map(|k| from[k] + part * (to[k] - from[k]))
    }
    fn point(&self, part: f64) -> Vec3 {
        self.facet.point(self.at(part))
    }
    fn length(&self) -> f64 {
        let chord = |k: usize| {
            let [a, b] = [k, k + 1].map(|k| self.point(k as f64 / CHORDS as f64));
            (b - a).norm()
        };
        (0..CHORDS).map(chord).sum()
    }
    /// Unit tangent, the facet on its left.
    fn tangent(&self, part: f64) -> Vec3 {
        let ([a, b], [from, to]) = (self.facet.tangents(self.at(part)), self.ends);
        (a * (to[0] - from[0]) + b * (to[1] - from[1])).unit()
    }
}

impl SpaceTool {
    /// Points along its outward edges, as far apart as said or farther where they would be too many.
    pub fn tips(&self, spacing: f64) -> Vec<Tip> {
        let facets = self.facets().iter().enumerate();
        let edges: Vec<_> = facets.flat_map(|(number, facet)| facet_edges(number, facet.as_ref())).collect();
        let sharp = |&&(number, edge): &&(usize, BorderEdge)| self.tip((number, &edge), 0.5, 0.0).is_some();
        let edges: Vec<_> = edges.iter().filter(sharp).map(|&(number, edge)| (number, edge, edge.length())).collect();
        let spacing = spacing.max(edges.iter().map(|(.., length)| length).sum::<f64>() / MOST as f64);
        let along = |&(number, edge, length): &(usize, BorderEdge, f64)| {
            let count = (length / spacing).ceil().max(1.0) as usize;
            let part = move |k: usize| (k as f64 + 0.5) / count as f64;
            (0..count)
                .filter_map(move |k| self.tip((number, &edge), part(k), length / count as f64))
                .collect::<Vec<_>>()
        };
        edges.iter().flat_map(along).collect()
    }

    /// A point of an edge of a facet, if the tool ends or turns outward there; of two facets the first has the edge.
    fn tip(&self, (number, edge): (usize, &BorderEdge), part: f64, length: f64) -> Option<Tip> {
        let (point, tangent, normal) = (edge.point(part), edge.tangent(part), edge.facet.normal(edge.at(part)));
        let (away, together) = (tangent.cross(normal), TOGETHER * self.size());
        let mut free = true;
        for other in self.around(point, together).into_iter().filter(|&other| other != number) {
            let found = self.facets()[other].nearest(point);
            if (found.point - point).norm() > together {
                continue;
            }
            if found.normal.dot(normal) > CREASE.cos() {
                return None;
            }
            free = false;
            if number < other && found.normal.dot(away) > -STRAIGHT {
                let outward = (away - tangent.cross(found.normal)).unit();
                return Some(Tip::on_edge(point, outward, [normal, found.normal], length));
            }
        }
        free.then(|| Tip::on_edge(point, away, [normal; 2], length))
    }
}

/// The edges of a facet at which the tool may end: of a swept one not the two that it was swept from and to.
fn facet_edges(number: usize, facet: &dyn RigidFacet) -> impl Iterator<Item = (usize, BorderEdge<'_>)> {
    let straight = facet.corners().len();
    let corners = if straight == 3 { TRIANGLE } else { SQUARE };
    (0..corners.len()).filter(move |k| straight > 0 || k % 2 == 1).map(move |k| {
        let ends = [corners[k], corners[(k + 1) % corners.len()]];
        (number, BorderEdge { facet, ends })
    })
}
