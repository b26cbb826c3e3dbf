//! How much nearer a target lies to the faces around a node than in the mean.
//!
//! The gap of a node is a mean over its faces: under flat faces of length `h` a cylinder of radius `R` is felt when it stands
//! `h^2 / 12 R` in them, and up to `5 h^2 / 24 R` where it comes between two rows of nodes; a facet that leans against the next one
//! by `t`, flat on what it rests on, when that lies `h t / 6` in it. What a bar takes for a support would be beside it by a good part of what
//! bends it. A node therefore closes when the target touches the part of its faces that is nearer to it than to other nodes: to its
//! penetration is added by how much the least gap there is less than the mean, so far as the gap is not linear.
//!
//! As for a tip in the plane ([`tip`](super::tip)) this is so where one or two rows of nodes touch. Where the surface follows the target
//! the mean gap is nearer to that of the curved surface: around a node of a third row no other has a larger gap, and nothing is added to
//! it and to those beside it. It is found at the beginning of an increment, from the accepted state, and constant over it: forces keep a
//! potential. What pressures do over its change from one increment to the next is accounted as supplied.

use super::configuration::{Configuration, TargetInPlace};
use super::cover::FaceInPlace;
use super::faces::{FaceProjection, FaceRay, LEAST_COSINE};
use crate::contact::record::entry;
use crate::system::History;
use crate::tensor::Vec3;

/// The mean gap less the least one over the half faces around a node, over the range of what a linear gap leaves: of a parabola
/// `5/24` over `1/2` at most, with its vertex half a face away, of facets that lean against each other `1/6` over `1/2`.
const MOST: f64 = 5.0 / 12.0;
/// That range around a node inside the surface over that on one of its faces, of a parabola.
const WITHIN: f64 = 4.0;
/// Where the centre of a node's function lies on the way from it to the middle of a face.
const CENTRE: f64 = 2.0 / 3.0;
/// By how much the gap of a node around is larger, over what may be added, from which on all of it is: under flat faces it is 2.4 times that
/// and more.
const BESIDE: f64 = 2.0;
/// Edges from a node that has no larger gaps around it to what it has nothing added.
const ROWS: usize = 2;
/// Places along each half edge at which the gap is looked at.
const PLACES: [f64; 3] = [0.0, 0.5, 1.0];

impl Configuration<'_> {
    /// For each slot of an accepted configuration how much nearer the target is than in the mean, if its gap is no larger than `far`. Nothing over
    /// tools in the plane, which have tips, and dual functions where they are straight, nor where a surface folds onto itself. `depths` are
    /// those of its faces.
    pub(super) fn nearer(&self, history: &History, (far, depths): (f64, &[f64])) -> Vec<f64> {
        let (contact, surface) = (self.contact, &self.contact.parts.surface);
        let mean = |slot: usize| {
            let values = history.slot(slot);
            (values[entry::SEGMENT] >= 0.0).then(|| -values[entry::PENETRATION])
        };
        let mut nearer = vec![0.0; contact.slots()];
        if contact.roles.itself || surface.plane && matches!(self.target, TargetInPlace::Tool(_)) {
            return nearer;
        }
        for piece in 0..contact.pieces {
            let gap = |node: usize| mean(contact.slot(node, piece));
            // By how much farther from the target than a node one of those around it is, and the least of that up to two edges away.
            let beside = |node: usize| {
                let Some(own) = gap(node) else { return f64::INFINITY };
                surface
                    .neighbours(node)
                    .map(|other| gap(other).map_or(f64::INFINITY, |gap| gap - own))
                    .fold(0.0, f64::max)
            };
            let spread = |values: Vec<f64>, of: fn(f64, f64) -> f64| -> Vec<f64> {
                let around = |node: usize| surface.neighbours(node).map(|other| values[other]).fold(values[node], of);
                (0..values.len()).map(around).collect()
            };
            let closed = |node: usize| history.slot(contact.slot(node, piece))[entry::STATUS] > 0.0;
            let mut straight: Vec<f64> = (0..surface.nodes.len()).map(beside).collect();
            let mut bears: Vec<f64> = (0..surface.nodes.len()).map(|node| f64::from(u8::from(closed(node)))).collect();
            for _ in 0..ROWS {
                straight = spread(straight, f64::min);
                bears = spread(spread(bears, f64::max), f64::max);
            }
            // A surface that folds, slides or spreads onto a flat tool or a body touches it beside what bears already.
            let follows = |node: usize| !contact.is_round(piece) && !closed(node) && bears[node] > 0.0;
            let near =
                |&node: &usize| straight[node] > 0.0 && gap(node).is_some_and(|gap| gap <= far) && !follows(node);
            for node in (0..surface.nodes.len()).filter(near) {
                let Some((least, most)) = self.least(node, piece, (far, depths)) else { continue };
                let more = gap(node).map_or(0.0, |gap| gap - least).min(most);
                if more > 0.0 {
                    let (slot, added) = (contact.slot(node, piece), more.min(straight[node] / BESIDE));
                    // What bears is not pushed any farther.
                    nearer[slot] = if closed(node) { added.min(history.slot(slot)[entry::NEARER]) } else { added };
                }
            }
        }
        nearer
    }

    /// The least gap of a piece over the half faces around a node, and the most that this may be less than the mean. What leans against
    /// a flat tool or a body does not touch it with the node: the least gap is then of what is left by the linear one.
    fn least(&self, node: usize, piece: usize, (far, depths): (f64, &[f64])) -> Option<(f64, f64)> {
        let support = &self.contact.parts.surface.nodes[node].support;
        let (mut within, mut gaps, mut half, mut center) = (0.0, Vec::new(), Vec::new(), Vec3::zero());
        let part = (support.len() as f64).recip();
        for &(number, corner) in support {
            let (begin, face) = (gaps.len(), self.face(number));
            let range = [-2.0 * depths[number], far + 2.0 * self.contact.longest];
            for (nearest, xi) in places(&face, corner) {
                if let Some(gap) = self.gap_at((&face, number), xi, (piece, range)) {
                    half.extend(nearest.then_some(gap));
                    gaps.push(gap);
                }
            }
            within += WITHIN * part * beyond_linear(&gaps[begin..]).1;
            let [own, middle] = [face.face.corner_place(corner), face.face.middle()].map(|xi| face.at(xi).x);
            center += (own + (middle - own) * CENTRE) * part;
        }
        let (slope, range) = beyond_linear(&gaps);
        let leans = |gap: &Gap| if self.contact.is_round(piece) { 0.0 } else { slope.dot(gap.x - center) };
        let least = half.iter().map(|gap| gap.gap - leans(gap)).fold(f64::INFINITY, f64::min);
        least.is_finite().then_some((least, MOST * range.max(within)))
    }

    /// A place of a face, and the gap of a piece there.
    fn gap_at(
        &self,
        (face, number): (&FaceInPlace, usize),
        xi: [f64; 2],
        (piece, range): (usize, [f64; 2]),
    ) -> Option<Gap> {
        let at = face.at(xi);
        let (x, n) = (at.x, at.normal.unit());
        match &self.target {
            TargetInPlace::Tool(tool) => {
                let foot = tool.closest(piece, x);
                foot.beyond.is_none().then_some(Gap { x, n: foot.normal, gap: foot.gap })
            }
            TargetInPlace::Faces(faces) => {
                let ray = FaceRay { x, n };
                let admits = |other: usize, hit: &FaceProjection| {
                    let faces_it = -hit.normal().dot(ray.n) > LEAST_COSINE;
                    faces_it && self.contact.piece_of(other) == piece && self.contact.may_touch(number, other)
                };
                faces.nearest(&ray, range, admits).map(|(_, hit)| Gap { x, n, gap: hit.gap })
            }
        }
    }
}

/// The gap at a place of the surface.
#[derive(Clone, Copy)]
struct Gap {
    x: Vec3,
    /// Its direction.
    n: Vec3,
    gap: f64,
}

/// Places of a face, and whether they belong to the part that is nearest to a corner.
fn places<'a>(face: &'a FaceInPlace, corner: usize) -> impl Iterator<Item = (bool, [f64; 2])> + 'a {
    let count = face.face.corners();
    let between = |x: [f64; 2], y: [f64; 2], t: f64| std::array::from_fn(|i| x[i] + t * (y[i] - x[i]));
    let middle = face.face.middle();
    (0..count).flat_map(move |k| {
        let [at, a, b] = [0, 1, count - 1].map(|step| face.face.corner_place((k + step) % count));
        // An edge of the plane has two corners, and no width.
        let across: &[f64] = if count == 2 { &PLACES[..1] } else { &PLACES };
        across.iter().flat_map(move |&s| {
            PLACES.into_iter().map(move |t| {
                let [from, to] = [between(at, between(at, a, 0.5), t), between(between(at, b, 0.5), middle, t)];
                (k == corner, between(from, to, s))
            })
        })
    })
}

/// The slope of the linear function along the surface that is nearest to gaps at places, with their normals, and the range of what it leaves.
fn beyond_linear(gaps: &[Gap]) -> (Vec3, f64) {
    let part = (gaps.len() as f64).recip();
    let [middle, normal] = [|gap: &Gap| gap.x, |gap: &Gap| gap.n]
        .map(|of| gaps.iter().fold(Vec3::zero(), |sum, gap| sum + of(gap)) * part);
    let (mean, n) = (gaps.iter().map(|gap| gap.gap).sum::<f64>() * part, normal.unit());
    let along = |gap: &Gap| {
        let x = gap.x - middle;
        x - n * n.dot(x)
    };
    let farthest = |from: Vec3| {
        let across = gaps.iter().map(|gap| along(gap) - from * from.dot(along(gap)));
        across.max_by(|a, b| a.norm().total_cmp(&b.norm())).unwrap_or(Vec3::zero())
    };
    let first = farthest(Vec3::zero());
    let second = farthest(first.unit());
    let axes = [first.unit(), if second.norm() > THIN * first.norm() { second.unit() } else { Vec3::zero() }];
    // Normal equations of both slopes.
    let (mut squares, mut moments) = ([0.0; 3], [0.0; 2]);
    for gap in gaps {
        let ([s, t], rest) = (axes.map(|axis| axis.dot(along(gap))), gap.gap - mean);
        squares = [squares[0] + s * s, squares[1] + s * t, squares[2] + t * t];
        moments = [moments[0] + s * rest, moments[1] + t * rest];
    }
    let ([a, b, c], [p, q]) = (squares, moments);
    let det = a * c - b * b;
    let slopes = if c > 0.0 && det > 0.0 { [(c * p - b * q) / det, (a * q - b * p) / det] } else { [p / a, 0.0] };
    let slope = axes[0] * slopes[0] + axes[1] * slopes[1];
    let left = gaps.iter().map(|gap| gap.gap - mean - slope.dot(along(gap)));
    let [least, most] =
        left.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], left| [least.min(left), most.max(left)]);
    if most > least { (slope, most - least) } else { (Vec3::zero(), 0.0) }
}

/// Part of the size of places across which they have no width.
const THIN: f64 = 1e-3;
