//! Signed distance to a tool in space: positive outside the material, with the closest point, the outward normal and the
//! principal curvatures of the surface of equal distance there.
//!
//! Facets that meet along an edge at less than a crease form a smooth piece. Beyond the border of a piece nothing of it is
//! seen, nor within an outward edge where another piece is nearer, but at an inward crease, where two faces bound one corner of the
//! material around it, each goes on straight.

use super::nearest::{FacetBorder, FacetPoint};
use super::tool::SpaceTool;
use crate::tensor::{BoundingBox, DisjointSets, Vec3};
use crate::tool::distance::CREASE;
use crate::tool::{BoxTree, NearestPoint};

/// Points of two facets are the same within this part of the tool's size.
pub(super) const TOGETHER: f64 = 1e-7;
/// The facet behind an inward crease looks back at least by this sine.
const INWARD: f64 = 0.1;
/// Flanks of an edge look away from each other by less than this cosine.
const BACK: f64 = -0.99;
/// Normals of a flat piece agree to rounding.
const FLAT: f64 = 1e-12;

/// The smooth pieces of a tool in space.
#[derive(Debug, Clone)]
pub struct SmoothPieces {
    /// The piece of each facet.
    labels: Vec<usize>,
    /// The facets of each piece, with a tree over them.
    pieces: Vec<(Vec<usize>, BoxTree)>,
    /// Whether each is flat.
    flat: Vec<bool>,
}

impl SmoothPieces {
    /// How many there are.
    pub fn count(&self) -> usize {
        self.pieces.len()
    }
    /// Whether a piece is flat.
    pub fn is_flat(&self, piece: usize) -> bool {
        self.flat[piece]
    }
}

/// Middles of the edges of a facet with so many corners, in reference coordinates.
fn edge_middles(corners: usize) -> &'static [[f64; 2]] {
    if corners == 3 { &[[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]] } else { &[[0.5, 0.0], [1.0, 0.5], [0.5, 1.0], [0.0, 0.5]] }
}

impl SpaceTool {
    /// Its smooth pieces.
    pub fn smooth_pieces(&self) -> SmoothPieces {
        let mut sets = DisjointSets::new(self.facets().len());
        for (i, facet) in self.facets().iter().enumerate() {
            for &s in edge_middles(facet.corners().len()) {
                let (point, normal) = (facet.point(s), facet.normal(s));
                for j in self.around(point, TOGETHER * self.size()) {
                    let other = self.facets()[j].nearest(point);
                    let cosine = other.normal.dot(normal);
                    if j != i && (other.point - point).norm() <= TOGETHER * self.size() && cosine > CREASE.cos() {
                        sets.join(i, j);
                    }
                }
            }
        }
        let labels = sets.labels();
        let mut pieces = vec![Vec::new(); labels.iter().max().map_or(0, |last| last + 1)];
        labels.iter().enumerate().for_each(|(facet, &piece)| pieces[piece].push(facet));
        let flat = |facets: &Vec<usize>| {
            let normals = || {
                let facets = facets.iter().map(|&facet| &self.facets()[facet]);
                facets.flat_map(|facet| edge_middles(facet.corners().len()).iter().map(|&s| facet.normal(s)))
            };
            normals().zip(normals().skip(1)).all(|(one, next)| one.dot(next) > 1.0 - FLAT)
        };
        let flat = pieces.iter().map(flat).collect();
        let tree = |facets: Vec<usize>| {
            let boxes: Vec<BoundingBox> = facets.iter().map(|&facet| self.facets()[facet].bounds()).collect();
            (facets, BoxTree::new(&boxes, TOGETHER * self.size()))
        };
        SmoothPieces { labels, pieces: pieces.into_iter().map(tree).collect(), flat }
    }

    /// The middle of a piece that is smaller than `size`.
    pub fn middle(&self, pieces: &SmoothPieces, piece: usize, size: f64) -> Option<Vec3> {
        let bounds =
            pieces.pieces[piece].0.iter().map(|&facet| self.facets()[facet].bounds()).reduce(BoundingBox::union)?;
        (bounds.size() <= size).then(|| self.closest(pieces, piece, bounds.centre()).point)
    }

    /// Facets whose boxes come within `reach` of a point, ascending.
    pub(super) fn around(&self, x: Vec3, reach: f64) -> Vec<usize> {
        let mut found = Vec::new();
        self.tree().near(&BoundingBox { min: x, max: x }.widened(reach), &mut |facet| found.push(facet));
        found.sort_unstable();
        found
    }

    /// The closest points of the facets of a piece that may be the closest of all.
    fn candidates(&self, (pieces, piece): (&SmoothPieces, usize), x: Vec3) -> Vec<FacetPoint> {
        let (facets, tree) = &pieces.pieces[piece];
        let (mut all, mut least): (Vec<(usize, FacetPoint, f64)>, f64) = (Vec::new(), f64::INFINITY);
        // What shares an edge with the closest is as close.
        let together = TOGETHER * self.size();
        tree.closest(x, &mut |number| {
            let found = self.facets()[facets[number]].nearest(x);
            let distance = (found.point - x).norm();
            if distance < least {
                least = distance;
                all.retain(|(_, _, distance)| *distance <= least + together);
            }
            if distance <= least + together {
                all.push((number, found, distance));
            }
            distance
        });
        all.sort_unstable_by_key(|(number, _, _)| *number);
        all.into_iter().map(|(_, found, _)| found).collect()
    }

    /// The point of a piece closest to `x`, in the tool's own frame; `x` itself, beyond the piece, if it has no facet.
    pub fn closest(&self, pieces: &SmoothPieces, piece: usize, x: Vec3) -> NearestPoint {
        let found = self.candidates((pieces, piece), x);
        let (mut best, mut least): (Option<&FacetPoint>, f64) = (None, f64::INFINITY);
        for place in &found {
            let distance = (x - place.point).norm();
            // Of equals the first, but rather the inside of a facet than an edge.
            let equal = (distance - least).abs() <= 1e-14 * self.size();
            let inside =
                equal && place.border == FacetBorder::Inside && best.is_some_and(|b| b.border != FacetBorder::Inside);
            if inside || (!equal && distance < least) {
                (best, least) = (Some(place), distance);
            }
        }
        let Some(&FacetPoint { point, normal, bends, border }) = best else {
            let (normal, bends) = (Vec3::axis(2), [(Vec3::zero(), 0.0); 2]);
            return NearestPoint { gap: 0.0, normal, point: x, bends, beyond: Some((0, Vec3::zero())) };
        };
        let gap = normal.dot(x - point);
        if border == FacetBorder::Inside {
            let bends = bends.map(|(e, k)| (e, k / (1.0 + k * gap)));
            let beyond = self.nearer((pieces, piece), x, (gap, normal)).map(|way| (0, way));
            return NearestPoint { gap, normal, point, bends, beyond };
        }
        let same = |place: &&FacetPoint| (place.point - point).norm() <= TOGETHER * self.size();
        let joined = found.iter().filter(same);
        let (count, sum) = joined.fold((0, Vec3::zero()), |(count, sum), place| (count + 1, sum + place.normal));
        let (mean, way) = (sum.unit(), (x - point).unit());
        if count > 1 && way.dot(mean).abs() >= CREASE.cos() {
            let gap = least.copysign(way.dot(mean));
            let normal = (x - point) * gap.recip();
            let round = match border {
                FacetBorder::Edge(along, q) => [(normal.cross(along), gap.recip()), (along, q / ((1.0 + q) * gap))],
                _ => {
                    let first = normal.cross(bends[0].0).unit();
                    [(first, gap.recip()), (normal.cross(first), gap.recip())]
                }
            };
            return NearestPoint { gap, normal, point, bends: round, beyond: None };
        }
        // A straight continuation, whether or not it is seen.
        let normal = if count > 1 { mean } else { normal };
        let gap = normal.dot(x - point);
        let aside = (x - point) - normal * gap;
        let beyond = (!self.goes_on((pieces, piece), point, aside.unit())).then_some((0, aside));
        let flat = bends.map(|(e, _)| (e, 0.0));
        NearestPoint { gap, normal, point: x - normal * gap, bends: flat, beyond }
    }

    /// Within an outward edge of the material, and beside it behind a piece with this gap and normal, another may be nearer: then the way from
    /// the bisector.
    fn nearer(&self, (pieces, piece): (&SmoothPieces, usize), x: Vec3, (gap, normal): (f64, Vec3)) -> Option<Vec3> {
        if gap >= 0.0 {
            return None;
        }
        let others = self.around(x, -gap).into_iter().filter(|&facet| pieces.labels[facet] != piece);
        let seen =
            others.map(|facet| self.facets()[facet].nearest(x)).filter(|other| other.border == FacetBorder::Inside);
        let gaps = seen.map(|other| (other.normal.dot(x - other.point), other.normal));
        // The far side of a plate is no flank of an edge.
        let flank = gaps.filter(|(other, n)| *other > gap && *other < -gap && n.dot(normal) > BACK);
        let (other, n) = flank.max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((n - normal) * ((other - gap) / (n - normal).dot(n - normal)))
    }

    /// Whether a step along `aside` from a border point leads into the material: whether the facet of another piece that is then the
    /// closest of those that meet there looks back.
    fn goes_on(&self, (pieces, piece): (&SmoothPieces, usize), border: Vec3, aside: Vec3) -> bool {
        let together = TOGETHER * self.size();
        let beyond = border + aside * (10.0 * together);
        let others = self.around(border, together).into_iter().filter(|&facet| pieces.labels[facet] != piece);
        let meet =
            others.map(|facet| &self.facets()[facet]).filter(|f| (f.nearest(border).point - border).norm() <= together);
        let seen = meet.map(|facet| facet.nearest(beyond)).map(|f| ((f.point - beyond).norm(), f.normal.dot(aside)));
        let seen: Vec<(f64, f64)> = seen.collect();
        let least = seen.iter().fold(f64::INFINITY, |least, (distance, _)| least.min(*distance));
        // In a vertex several are as close, and the sum of their normals tells (Baerentzen and Aanaes 2005).
        seen.iter().filter(|(distance, _)| *distance <= least + 0.01 * together).map(|(_, cosine)| cosine).sum::<f64>()
            < -INWARD
    }
}
