//! Which unknowns of a stencil move what.

use std::ops::Range;

/// The unknowns of a stencil, by what they move.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Number of unknowns of its own nodes, which come first.
    pub own: usize,
    /// Those of the segment that is hit.
    pub hit: Range<usize>,
    /// Those of the segment touched at the last accepted state.
    pub touched: Option<Range<usize>>,
    /// Those of the two pieces of the target's border that bound the covered part of an edge or face.
    pub ends: [Option<Range<usize>>; 2],
    /// Those of the nodes around its edge or face that turn its averaged normals.
    pub around: Range<usize>,
}

impl Layout {
    /// By numbers of unknowns, in this order. `touched` is None where nothing was touched, and holds None where its
    /// unknowns are those of the segment that is hit; an end without unknowns is none.
    pub fn new(own: usize, hit: usize, touched: Option<Option<usize>>, ends: [usize; 2], around: usize) -> Self {
        let hit = own..own + hit;
        let mut end = hit.end;
        let mut next = |count: usize| {
            end += count;
            end - count..end
        };
        let touched = touched.map(|count| count.map_or_else(|| hit.clone(), &mut next));
        let ends = ends.map(|count| (count > 0).then(|| next(count)));
        let around = next(around);
        Self { own, hit, touched, ends, around }
    }

    /// Number of the unknowns that move the point itself.
    pub fn count(&self) -> usize {
        self.around.end
    }

    /// The places of the unknowns on which its normal depends: of its own nodes, then of those around.
    pub fn field(&self) -> impl Iterator<Item = usize> {
        (0..self.own).chain(self.around.clone())
    }
}
