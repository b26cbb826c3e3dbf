//! A tree of boxes around pieces, for rays: segments of the plane or facets of space.
//!
//! The tree is built once (for a tool in its own frame) by halving the pieces at the median of their middles along the
//! longest side of the box around them; pieces that move keep their tree and have its boxes fitted anew. It only leaves
//! out what a ray cannot meet; what it finds is found without it too. A ray passes by a box if it does so seen along one
//! of the axes.

use super::shapes::ProfileRay;
use crate::tensor::{BoundingBox, Vec3};

/// Fewer pieces than this are tried one after another.
const LEAF: usize = 4;

/// Boxes around boxes around pieces.
#[derive(Debug, Clone)]
pub struct BoxTree {
    /// The root first; the first child of an inner node stands right behind it.
    nodes: Vec<BoxNode>,
    /// Pieces, in the order of the leaves.
    order: Vec<usize>,
    /// Their boxes, in that order.
    pieces: Vec<BoundingBox>,
}

#[derive(Debug, Clone)]
struct BoxNode {
    bounds: BoundingBox,
    content: BoxContent,
}

#[derive(Debug, Clone, Copy)]
enum BoxContent {
    /// `order[from..to]`.
    Leaf(usize, usize),
    /// The place of the second child.
    Inner(usize),
}

impl BoxTree {
    /// A tree over boxes, each widened by `margin` on all sides.
    pub fn new(boxes: &[BoundingBox], margin: f64) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len()).collect(), pieces: Vec::new() };
        tree.grow(boxes, margin, 0, boxes.len());
        tree.pieces = tree.order.iter().map(|&i| boxes[i].widened(margin)).collect();
        tree
    }

    fn grow(&mut self, boxes: &[BoundingBox], margin: f64, from: usize, to: usize) {
        let all = self.order[from..to].iter().fold(BoundingBox::EMPTY, |b, &i| b.union(boxes[i]));
        let here = self.nodes.len();
        self.nodes.push(BoxNode { bounds: all.widened(margin), content: BoxContent::Leaf(from, to) });
        if to - from <= LEAF {
            return;
        }
        let sides = all.max - all.min;
        let longer = |a: usize, b: usize| if sides[b] > sides[a] { b } else { a };
        let axis = longer(longer(0, 1), 2);
        let key = |i: &usize| boxes[*i].min[axis] + boxes[*i].max[axis];
        self.order[from..to].sort_by(|a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let middle = from + (to - from) / 2;
        self.grow(boxes, margin, from, middle);
        self.nodes[here].content = BoxContent::Inner(self.nodes.len());
        self.grow(boxes, margin, middle, to);
    }

    /// The same tree around pieces that have moved, each box widened by `margin` on all sides.
    pub fn refit(&self, boxes: &[BoundingBox], margin: f64) -> Self {
        let mut tree = self.clone();
        let mut all = vec![BoundingBox::EMPTY; tree.nodes.len()];
        for here in (0..tree.nodes.len()).rev() {
            all[here] = match tree.nodes[here].content {
                BoxContent::Leaf(from, to) => {
                    self.order[from..to].iter().fold(BoundingBox::EMPTY, |b, &i| b.union(boxes[i]))
                }
                BoxContent::Inner(second) => all[here + 1].union(all[second]),
            };
            tree.nodes[here].bounds = all[here].widened(margin);
        }
        tree.pieces = self.order.iter().map(|&i| boxes[i].widened(margin)).collect();
        tree
    }

    /// Calls `found` with every piece whose box the part of the ray from `back` to `ahead` may meet.
    pub fn along(&self, ray: &ProfileRay, [back, ahead]: [f64; 2], found: &mut dyn FnMut(usize)) {
        let sides = Vec3(ray.direction.0.map(f64::abs));
        self.visit(
            0,
            &mut |node| {
                let (to, half) = (node.bounds.centre() - ray.origin, (node.bounds.max - node.bounds.min) * 0.5);
                let (along, reach) = (to.dot(ray.direction), sides.dot(half));
                let aside = ray.direction.cross(to);
                let meets = (0..3).all(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    aside[i].abs() <= sides[j] * half[k] + sides[k] * half[j]
                });
                meets && along + reach >= back && along - reach <= ahead
            },
            found,
        );
    }

    /// Calls `found` with every piece whose box may overlap `bounds`.
    pub fn near(&self, bounds: &BoundingBox, found: &mut dyn FnMut(usize)) {
        self.visit(
            0,
            &mut |node| (0..3).all(|i| node.bounds.max[i] >= bounds.min[i] && node.bounds.min[i] <= bounds.max[i]),
            found,
        );
    }

    /// Asks `of` for the distances of `x` from pieces, but for those whose boxes are farther than the least so far.
    pub fn closest(&self, x: Vec3, of: &mut dyn FnMut(usize) -> f64) {
        self.approach((0, self.nodes[0].bounds.distance(x)), x, &mut { f64::INFINITY }, of);
    }

    fn approach(&self, (at, distance): (usize, f64), x: Vec3, least: &mut f64, of: &mut dyn FnMut(usize) -> f64) {
        if distance > *least {
            return;
        }
        match self.nodes[at].content {
            BoxContent::Leaf(from, to) => {
                for (&i, bounds) in self.order[from..to].iter().zip(&self.pieces[from..to]) {
                    if bounds.distance(x) <= *least {
                        *least = least.min(of(i));
                    }
                }
            }
            BoxContent::Inner(second) => {
                let mut both = [at + 1, second].map(|child| (child, self.nodes[child].bounds.distance(x)));
                if both[1].1 < both[0].1 {
                    both.swap(0, 1);
                }
                both.into_iter().for_each(|child| self.approach(child, x, least, of));
            }
        }
    }

    fn visit(&self, at: usize, wanted: &mut dyn FnMut(&BoxNode) -> bool, found: &mut dyn FnMut(usize)) {
        let node = &self.nodes[at];
        if !wanted(node) {
            return;
        }
        match node.content {
            BoxContent::Leaf(from, to) => self.order[from..to].iter().for_each(|&i| found(i)),
            BoxContent::Inner(second) => {
                self.visit(at + 1, wanted, found);
                self.visit(second, wanted, found);
            }
        }
    }
}
