//! A tree of boxes around the segments of a tool, for rays.
//!
//! The tree is built once, in the tool's own frame, by halving the segments at the median of their middles along the
//! longer side of the box around them. It only leaves out what a ray cannot meet; what it finds is found without it too.

use super::shapes::{Bounds, Ray, turn};
use crate::tensor::Vec3;

/// Fewer segments than this are tried one after another.
const LEAF: usize = 4;

#[derive(Debug)]
pub(super) struct Tree {
    /// The root first; the first child of an inner node stands right behind it.
    nodes: Vec<Node>,
    /// Segments, in the order of the leaves.
    order: Vec<usize>,
}

#[derive(Debug)]
struct Node {
    centre: Vec3,
    half: Vec3,
    content: Content,
}

#[derive(Debug)]
enum Content {
    /// `order[from..to]`.
    Leaf(usize, usize),
    /// The place of the second child.
    Inner(usize),
}

impl Tree {
    /// A tree over boxes, each widened by `margin` on all sides.
    pub(super) fn new(boxes: &[Bounds], margin: f64) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len()).collect() };
        tree.grow(boxes, margin, 0, boxes.len());
        tree
    }

    fn grow(&mut self, boxes: &[Bounds], margin: f64, from: usize, to: usize) {
        let all = self.order[from..to].iter().fold(Bounds::EMPTY, |b, &i| b.union(boxes[i]));
        let half = (all.max - all.min) * 0.5 + Vec3([margin; 3]);
        let here = self.nodes.len();
        self.nodes.push(Node { centre: all.centre(), half, content: Content::Leaf(from, to) });
        if to - from <= LEAF {
            return;
        }
        let axis = usize::from(half[1] > half[0]);
        let key = |i: &usize| boxes[*i].min[axis] + boxes[*i].max[axis];
        self.order[from..to].sort_by(|a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let middle = from + (to - from) / 2;
        self.grow(boxes, margin, from, middle);
        self.nodes[here].content = Content::Inner(self.nodes.len());
        self.grow(boxes, margin, middle, to);
    }

    /// Calls `found` with every segment whose box the part of the ray from `back` to `ahead` may meet.
    pub(super) fn along(&self, ray: &Ray, [back, ahead]: [f64; 2], found: &mut dyn FnMut(usize)) {
        let sides = Vec3(ray.direction.0.map(f64::abs));
        self.visit(
            0,
            &mut |node| {
                let to = node.centre - ray.origin;
                let (along, reach) = (to.dot(ray.direction), sides.dot(node.half));
                let aside = turn(ray.direction, to).abs() <= sides[0] * node.half[1] + sides[1] * node.half[0];
                aside && along + reach >= back && along - reach <= ahead
            },
            found,
        );
    }

    /// Calls `found` with every segment whose box may overlap `bounds`.
    pub(super) fn near(&self, bounds: &Bounds, found: &mut dyn FnMut(usize)) {
        self.visit(
            0,
            &mut |node| {
                (0..2).all(|i| {
                    node.centre[i] + node.half[i] >= bounds.min[i] && node.centre[i] - node.half[i] <= bounds.max[i]
                })
            },
            found,
        );
    }

    fn visit(&self, at: usize, wanted: &mut dyn FnMut(&Node) -> bool, found: &mut dyn FnMut(usize)) {
        let node = &self.nodes[at];
        if !wanted(node) {
            return;
        }
        match node.content {
            Content::Leaf(from, to) => self.order[from..to].iter().for_each(|&i| found(i)),
            Content::Inner(second) => {
                self.visit(at + 1, wanted, found);
                self.visit(second, wanted, found);
            }
        }
    }
}
