//! The assembly tree: fronts in the order in which they are eliminated, and where every number goes.

use crate::error::FrontalError;
use crate::etree::{NONE, children};
use crate::graph::Graph;
use crate::pattern::Pattern;
use crate::stripes::{Stripes, WIDTH};
use crate::supernode::{Supernode, in_final_order};
use std::ops::Range;

/// A dense matrix of order `pivots + border`, in four parts stored column by column:
///
/// ```text
///    pivots  border
///  [  F11  |  F12  ]  pivots      left   = [F11; F21], leading dimension `size()`
///  [  F21  |  F22  ]  border      right  = F12 transposed, leading dimension `border`
///                                 F22    = what goes to the parent, leading dimension `border`
/// ```
/// `left` and `right` lie next to each other in the factor; F22, the contribution block, lies in working memory. F12
/// is kept transposed so that small fronts, with few pivots and a long border, still work on long columns. Of a symmetric matrix
/// only `left` and F22 are there, both without what is above the diagonal, see [`Stripes`].
#[derive(Debug, Clone)]
pub(crate) struct Front {
    /// First pivot, in elimination order.
    pub first: usize,
    pub pivots: usize,
    pub border: usize,
    /// Where the border's rows start in [`AssemblyTree::rows`].
    pub rows: usize,
    /// Where the front starts in the factor.
    pub factor: usize,
    /// Where its entries of the matrix start in [`AssemblyTree::entries`].
    pub entries: usize,
    /// First front of its subtree, which ends with this front.
    pub first_descendant: usize,
    /// Whether only the lower half is computed.
    pub symmetric: bool,
    /// Distance from its root.
    pub depth: usize,
}

impl Front {
    pub fn size(&self) -> usize {
        self.pivots + self.border
    }

    /// Where the numbers of `[F11; F21]` lie.
    pub fn left(&self) -> Stripes {
        let layout = if self.symmetric { Stripes::lower } else { Stripes::whole };
        layout(self.size(), self.pivots)
    }

    /// Where those of the contribution block lie.
    pub fn block(&self) -> Stripes {
        let layout = if self.symmetric { Stripes::lower } else { Stripes::whole };
        layout(self.border, self.border)
    }

    /// Which of two memories its block lies in: 0 at even depths, 1 at odd ones.
    pub fn side(&self) -> usize {
        self.depth % 2
    }

    /// Numbers in the contribution block.
    pub fn block_len(&self) -> usize {
        self.block().len()
    }

    /// Numbers of room that the elimination of a symmetric front needs besides: the first stripe once more, below its
    /// square.
    pub fn scratch_len(&self) -> usize {
        let columns = self.pivots.min(WIDTH);
        if self.symmetric { columns * (self.size() - columns) } else { 0 }
    }

    /// Numbers kept in the factor.
    pub fn factor_len(&self) -> usize {
        if self.symmetric { self.left_len() } else { self.left_len() + self.right_len() }
    }

    pub fn left_len(&self) -> usize {
        self.left().len()
    }

    pub fn right_len(&self) -> usize {
        self.pivots * self.border
    }

    pub fn factor_range(&self) -> Range<usize> {
        self.factor..self.factor + self.factor_len()
    }

    pub fn pivot_range(&self) -> Range<usize> {
        self.first..self.first + self.pivots
    }

    /// Multiplications and additions of the elimination.
    pub fn flops(&self) -> f64 {
        let (p, b) = (self.pivots as f64, self.border as f64);
        let flops = 2.0 / 3.0 * p * p * p + 2.0 * p * p * b + 2.0 * p * b * b;
        if self.symmetric { 0.5 * flops } else { flops }
    }
}

/// An entry of the matrix and its place in the front where it is assembled.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    /// Index among the values of the pattern.
    pub value: u32,
    /// Index in the front's part of the factor.
    pub place: u32,
}

/// Entries that are assembled: of a symmetric matrix one of each pair.
fn entries_of(pattern: &Pattern, symmetric: bool) -> usize {
    if symmetric { pattern.nonzeros().midpoint(pattern.len()) } else { pattern.nonzeros() }
}

/// All fronts, children before parents.
#[derive(Debug)]
pub(crate) struct AssemblyTree {
    pub fronts: Vec<Front>,
    /// Children of each front, in the order of assembly; the roots are the children of front `n`.
    pub child_starts: Vec<usize>,
    pub child_list: Vec<u32>,
    /// Rows of the borders, as positions in elimination order.
    pub rows: Vec<u32>,
    /// The same rows as indices in the parent's front.
    pub relative: Vec<u32>,
    pub entries: Vec<Entry>,
    /// Unknown at each position of the elimination order, and the position of each unknown.
    pub order: Vec<u32>,
    pub position: Vec<u32>,
}

impl AssemblyTree {
    /// # Errors
    /// [`FrontalError::TooLarge`] if a front has too many entries for 32 bits.
    pub fn new(
        pattern: &Pattern,
        graph: &Graph,
        node_order: &[u32],
        supernodes: &[Supernode],
        symmetric: bool,
    ) -> Result<Self, FrontalError> {
        let (supernodes, parents) = in_final_order(supernodes);
        let (child_starts, child_list) = children(&parents);
        let nodes = supernodes.iter().flat_map(|s| s.nodes.iter().map(|&k| node_order[k as usize]));
        let order = nodes.flat_map(|node| graph.members(node as usize).iter().copied()).collect::<Vec<_>>();
        let mut position = vec![0; order.len()];
        for (k, &unknown) in order.iter().enumerate() {
            position[unknown as usize] = k as u32;
        }
        let mut tree = AssemblyTree {
            fronts: Vec::with_capacity(supernodes.len()),
            child_starts,
            child_list,
            rows: Vec::new(),
            relative: Vec::new(),
            entries: Vec::with_capacity(entries_of(pattern, symmetric)),
            order,
            position,
        };
        tree.lay_out(pattern, &supernodes, &parents, symmetric)?;
        tree.place_entries(pattern);
        tree.find_relative_rows();
        Ok(tree)
    }

    /// The same tree for the other kind of values.
    ///
    /// # Errors
    /// As [`AssemblyTree::new`].
    pub fn for_values(&self, pattern: &Pattern, symmetric: bool) -> Result<Self, FrontalError> {
        let mut tree = AssemblyTree {
            fronts: Vec::with_capacity(self.fronts.len()),
            child_starts: self.child_starts.clone(),
            child_list: self.child_list.clone(),
            rows: self.rows.clone(),
            relative: self.relative.clone(),
            entries: Vec::with_capacity(entries_of(pattern, symmetric)),
            order: self.order.clone(),
            position: self.position.clone(),
        };
        for front in &self.fronts {
            tree.push_front((front.pivots, front.border), front.rows, symmetric)?;
        }
        tree.fronts.iter_mut().zip(&self.fronts).for_each(|(front, other)| front.depth = other.depth);
        tree.place_entries(pattern);
        Ok(tree)
    }

    /// The fronts and how they hang together, without what is in them: enough to know what a factorisation costs.
    ///
    /// # Errors
    /// As [`AssemblyTree::new`].
    pub fn outline(supernodes: &[Supernode], symmetric: bool) -> Result<Self, FrontalError> {
        let (supernodes, parents) = in_final_order(supernodes);
        let (child_starts, child_list) = children(&parents);
        let mut tree = AssemblyTree {
            fronts: Vec::with_capacity(supernodes.len()),
            child_starts,
            child_list,
            rows: Vec::new(),
            relative: Vec::new(),
            entries: Vec::new(),
            order: Vec::new(),
            position: Vec::new(),
        };
        for supernode in supernodes {
            let (pivots, size) = (supernode.pivots as usize, supernode.size as usize);
            tree.push_front((pivots, size - pivots), 0, symmetric)?;
        }
        tree.find_depths(&parents);
        Ok(tree)
    }

    /// Which fronts hold a pivot among these positions or lie above one that does.
    pub fn above(&self, positions: &[u32]) -> Vec<bool> {
        let mut marked = vec![false; self.order.len()];
        positions.iter().for_each(|&position| marked[position as usize] = true);
        let above = |front: &Front| {
            let above = marked[front.pivot_range()].contains(&true);
            if above {
                self.rows(front).iter().for_each(|&row| marked[row as usize] = true);
            }
            above
        };
        self.fronts.iter().map(above).collect()
    }

    pub fn children(&self, front: usize) -> &[u32] {
        &self.child_list[self.child_starts[front]..self.child_starts[front + 1]]
    }

    pub fn rows(&self, front: &Front) -> &[u32] {
        &self.rows[front.rows..front.rows + front.border]
    }

    pub fn relative(&self, front: &Front) -> &[u32] {
        &self.relative[front.rows..front.rows + front.border]
    }

    pub fn entries(&self, front: usize) -> &[Entry] {
        let end = self.fronts.get(front + 1).map_or(self.entries.len(), |next| next.entries);
        &self.entries[self.fronts[front].entries..end]
    }

    /// Numbers in the factor.
    pub fn factor_len(&self) -> usize {
        self.fronts.last().map_or(0, |front| front.factor_range().end)
    }

    fn lay_out(
        &mut self,
        pattern: &Pattern,
        supernodes: &[&Supernode],
        parents: &[u32],
        symmetric: bool,
    ) -> Result<(), FrontalError> {
        let mut seen_by = vec![NONE; self.order.len()];
        let mut first = 0;
        for (s, supernode) in supernodes.iter().enumerate() {
            let pivots = supernode.pivots as usize;
            let rows = self.rows.len();
            self.append_rows(pattern, s, first..first + pivots, &mut seen_by);
            self.push_front((pivots, self.rows.len() - rows), rows, symmetric)?;
            first += pivots;
        }
        self.find_depths(parents);
        Ok(())
    }

    /// Adds a front whose border's rows start at `rows`.
    fn push_front(
        &mut self,
        (pivots, border): (usize, usize),
        rows: usize,
        symmetric: bool,
    ) -> Result<(), FrontalError> {
        let s = self.fronts.len();
        let first = self.fronts.last().map_or(0, |front| front.pivot_range().end);
        let first_descendant = self.children(s).first().map_or(s, |&c| self.fronts[c as usize].first_descendant);
        let factor = self.factor_len();
        let front = Front { first, pivots, border, rows, factor, entries: 0, first_descendant, symmetric, depth: 0 };
        u32::try_from(front.factor_len()).map_err(|_| FrontalError::TooLarge)?;
        self.fronts.push(front);
        Ok(())
    }

    fn find_depths(&mut self, parents: &[u32]) {
        for s in (0..self.fronts.len()).rev().filter(|&s| parents[s] != NONE) {
            self.fronts[s].depth = self.fronts[parents[s] as usize].depth + 1;
        }
    }

    /// Rows of the border: those of the children and of the matrix, past the pivots.
    fn append_rows(&mut self, pattern: &Pattern, s: usize, pivots: Range<usize>, seen_by: &mut [u32]) {
        let start = self.rows.len();
        let end = pivots.end as u32;
        let mut fresh = |row: u32| row >= end && std::mem::replace(&mut seen_by[row as usize], s as u32) != s as u32;
        for k in self.child_starts[s]..self.child_starts[s + 1] {
            let child = &self.fronts[self.child_list[k] as usize];
            for at in child.rows..child.rows + child.border {
                let row = self.rows[at];
                if fresh(row) {
                    self.rows.push(row);
                }
            }
        }
        for pivot in pivots {
            for &column in pattern.row(self.order[pivot] as usize) {
                let row = self.position[column];
                if fresh(row) {
                    self.rows.push(row);
                }
            }
        }
        self.rows[start..].sort_unstable();
    }

    /// An entry belongs to the front that eliminates its row or its column, whichever comes first.
    fn place_entries(&mut self, pattern: &Pattern) {
        let mirror = pattern.mirrors();
        let mut local = vec![0; self.order.len()];
        for s in 0..self.fronts.len() {
            let front = self.fronts[s].clone();
            self.fronts[s].entries = self.entries.len();
            for (k, &row) in self.rows(&front).iter().enumerate() {
                local[row as usize] = front.pivots + k;
            }
            for pivot in front.pivot_range() {
                let unknown = self.order[pivot] as usize;
                let (k, layout) = (pivot - front.first, front.left());
                for (at, column) in pattern.entries(unknown) {
                    let other = self.position[column] as usize;
                    let below = other >= front.first + front.pivots;
                    let j = if below { local[other] } else { other.wrapping_sub(front.first) };
                    if below && !front.symmetric {
                        self.push_entry(at, front.left_len() + k * front.border + j - front.pivots);
                    }
                    if below {
                        self.push_entry(mirror[at] as usize, layout.place(j, k));
                    } else if other >= front.first && (j <= k || !front.symmetric) {
                        self.push_entry(at, layout.place(k, j));
                    }
                }
            }
        }
    }

    fn push_entry(&mut self, value: usize, place: usize) {
        self.entries.push(Entry { value: value as u32, place: place as u32 });
    }

    fn find_relative_rows(&mut self) {
        let mut local = vec![0; self.order.len()];
        self.relative = vec![0; self.rows.len()];
        for s in 0..self.fronts.len() {
            let front = &self.fronts[s];
            for (k, pivot) in front.pivot_range().enumerate() {
                local[pivot] = k as u32;
            }
            for (k, &row) in self.rows(front).iter().enumerate() {
                local[row as usize] = (front.pivots + k) as u32;
            }
            for k in self.child_starts[s]..self.child_starts[s + 1] {
                let child = &self.fronts[self.child_list[k] as usize];
                for at in child.rows..child.rows + child.border {
                    self.relative[at] = local[self.rows[at] as usize];
                }
            }
        }
    }
}
