//! A hierarchy of boxes around the pieces of a boundary, after which what is near and what lies along a line is found
//! without asking all: the R*-tree of `rstar`, packed at once.

use super::simplex::Simplex;
use crate::tensor::Vec3;
use rstar::{AABB, PointDistance, RTree, RTreeObject, SelectionFunction};

/// An axis-parallel box: its least and largest coordinates.
pub type Bounds = [Vec3; 2];

/// The smallest box around points.
pub fn bounds(points: impl IntoIterator<Item = Vec3>) -> Bounds {
    points.into_iter().fold([Vec3([f64::INFINITY; 3]), Vec3([f64::NEG_INFINITY; 3])], |[low, high], p| {
        [Vec3(std::array::from_fn(|i| low[i].min(p[i]))), Vec3(std::array::from_fn(|i| high[i].max(p[i])))]
    })
}

/// Whether two boxes meet.
pub fn meet([low, high]: &Bounds, [other_low, other_high]: &Bounds) -> bool {
    (0..3).all(|i| low[i] <= other_high[i] && other_low[i] <= high[i])
}

/// One piece, and a box that holds it and where it was before.
#[derive(Debug, Clone, Copy)]
struct Leaf<const N: usize> {
    simplex: Simplex,
    number: usize,
    envelope: AABB<[f64; N]>,
}

impl<const N: usize> RTreeObject for Leaf<N> {
    type Envelope = AABB<[f64; N]>;
    fn envelope(&self) -> Self::Envelope {
        self.envelope
    }
}

impl<const N: usize> PointDistance for Leaf<N> {
    fn distance_2(&self, point: &[f64; N]) -> f64 {
        let p = Vec3(std::array::from_fn(|i| point.get(i).copied().unwrap_or(0.0)));
        let to = self.simplex.closest(p) - p;
        to.dot(to)
    }
}

/// Boxes that a straight way from a point meets.
struct Along<const N: usize> {
    from: [f64; N],
    way: [f64; N],
}

impl<const N: usize> Along<N> {
    fn meets(&self, envelope: &AABB<[f64; N]>) -> bool {
        let (low, high) = (envelope.lower(), envelope.upper());
        let (mut begin, mut end) = (0.0_f64, 1.0_f64);
        for i in 0..N {
            if self.way[i] == 0.0 {
                if self.from[i] < low[i] || self.from[i] > high[i] {
                    return false;
                }
                continue;
            }
            let [a, b] = [low[i], high[i]].map(|bound| (bound - self.from[i]) / self.way[i]);
            (begin, end) = (begin.max(a.min(b)), end.min(a.max(b)));
        }
        begin <= end
    }
}

impl<const N: usize> SelectionFunction<Leaf<N>> for Along<N> {
    fn should_unpack_parent(&self, envelope: &AABB<[f64; N]>) -> bool {
        self.meets(envelope)
    }
    fn should_unpack_leaf(&self, leaf: &Leaf<N>) -> bool {
        self.meets(&leaf.envelope)
    }
}

/// The pieces of one boundary.
#[derive(Debug)]
pub enum Hierarchy {
    /// Segments.
    Plane(Tree<2>),
    /// Triangles.
    Space(Tree<3>),
}

/// A packed tree.
#[derive(Debug)]
pub struct Tree<const N: usize>(RTree<Leaf<N>>);

impl<const N: usize> Tree<N> {
    fn new(pieces: impl Iterator<Item = (Simplex, Bounds)>) -> Self {
        let leaf = |(number, (simplex, [low, high])): (usize, (Simplex, Bounds))| {
            let envelope = AABB::from_corners(cut(low), cut(high));
            Leaf { simplex, number, envelope }
        };
        Self(RTree::bulk_load(pieces.enumerate().map(leaf).collect()))
    }
    fn nearest(&self, p: Vec3, most: f64, wanted: &mut dyn FnMut(usize, &Simplex, f64) -> bool) {
        for (leaf, squared) in self.0.nearest_neighbor_iter_with_distance_2(cut(p)) {
            if squared > most * most || !wanted(leaf.number, &leaf.simplex, squared.sqrt()) {
                return;
            }
        }
    }
    fn along(&self, [from, to]: [Vec3; 2], found: &mut dyn FnMut(usize, &Simplex)) {
        let along = Along { from: cut(from), way: cut(to - from) };
        self.0.locate_with_selection_function(along).for_each(|leaf| found(leaf.number, &leaf.simplex));
    }
    fn within(&self, [low, high]: Bounds, found: &mut dyn FnMut(usize, &Simplex)) {
        let envelope = AABB::from_corners(cut(low), cut(high));
        self.0.locate_in_envelope_intersecting(envelope).for_each(|leaf| found(leaf.number, &leaf.simplex));
    }
}

fn cut<const N: usize>(p: Vec3) -> [f64; N] {
    std::array::from_fn(|i| p[i])
}

impl Hierarchy {
    /// Around pieces, each with a box that holds it.
    pub fn new(plane: bool, pieces: impl Iterator<Item = (Simplex, Bounds)>) -> Self {
        if plane { Self::Plane(Tree::new(pieces)) } else { Self::Space(Tree::new(pieces)) }
    }
    /// Shows pieces with their numbers and distances from `p`, the nearest first, as long as they are wanted and not farther
    /// than `most`.
    pub fn nearest(&self, p: Vec3, most: f64, wanted: &mut dyn FnMut(usize, &Simplex, f64) -> bool) {
        match self {
            Self::Plane(tree) => tree.nearest(p, most, wanted),
            Self::Space(tree) => tree.nearest(p, most, wanted),
        }
    }
    /// Pieces whose boxes a straight way meets, in no order that means anything.
    pub fn along(&self, way: [Vec3; 2], found: &mut dyn FnMut(usize, &Simplex)) {
        match self {
            Self::Plane(tree) => tree.along(way, found),
            Self::Space(tree) => tree.along(way, found),
        }
    }
    /// Pieces whose boxes meet a box, in no order that means anything.
    pub fn within(&self, bounds: Bounds, found: &mut dyn FnMut(usize, &Simplex)) {
        match self {
            Self::Plane(tree) => tree.within(bounds, found),
            Self::Space(tree) => tree.within(bounds, found),
        }
    }
}
