//! The analysis: all that can be known before any value is.

use crate::assembly_tree::AssemblyTree;
use crate::error::Error;
use crate::etree::{NONE, children, column_counts, elimination_tree, postorder};
use crate::factor::Factor;
use crate::options::Options;
use crate::ordering;
use crate::pattern::Pattern;
use crate::supernode::supernodes;
use std::sync::Arc;

/// What a factorisation will cost, known exactly from the pattern.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Prediction {
    /// Multiplications and additions of one factorisation.
    pub flops: f64,
    /// Numbers in the factors L and U, stored zeros included.
    pub factor_entries: usize,
    /// Numbers in the stack of contribution blocks.
    pub stack_entries: usize,
    /// Order of the largest front.
    pub largest_front: usize,
    /// Number of fronts.
    pub fronts: usize,
    /// Bytes of the analysis, one factor and its working memory.
    pub bytes: usize,
}

/// The analysis of a pattern: order, fronts, places, cost. Cheap to clone.
#[derive(Debug, Clone)]
pub struct Symbolic {
    pub(crate) inner: Arc<Inner>,
}

#[derive(Debug)]
pub(crate) struct Inner {
    pub pattern: Pattern,
    pub options: Options,
    pub tree: AssemblyTree,
    pub stack: Stack,
    pub prediction: Prediction,
}

/// Where each contribution block lies in the working memory.
///
/// A front is assembled while its children's blocks are still there. Blocks of even depth therefore grow from the
/// front of the memory and those of odd depth from its back: on either side the last block in is the first out, and
/// none is ever moved.
#[derive(Debug)]
pub(crate) struct Stack {
    pub offsets: Vec<usize>,
    pub len: usize,
}

impl Symbolic {
    /// Orders the unknowns, finds the fronts and predicts the cost: a pure function of pattern and options.
    ///
    /// # Errors
    /// [`Error::InvalidOrder`] or [`Error::WrongLength`] for bad options, [`Error::TooLarge`],
    /// [`Error::OrderingFailed`], and [`Error::MemoryLimit`] if the prediction exceeds the limit.
    pub fn analyse(pattern: &Pattern, options: &Options) -> Result<Self, Error> {
        u32::try_from(pattern.nonzeros().max(pattern.len() + 1)).map_err(|_| Error::TooLarge)?;
        let (graph, order) = ordering::order(pattern, options)?;
        let order = postordered(&graph, order);
        let position = inverse(&order);
        let parent = elimination_tree(&graph, &order, &position);
        let counts = column_counts(&graph, &order, &position, &parent);
        let weight = |k: usize| u64::from(graph.weights[order[k] as usize]);
        let supernodes = supernodes(&parent, &counts, weight, &options.amalgamation);
        let tree = AssemblyTree::new(pattern, &graph, &order, &supernodes)?;
        let stack = Stack::new(&tree);
        let prediction = predict(pattern, &tree, &stack);
        check_limit(prediction.bytes, options.memory_limit)?;
        let inner = Inner { pattern: pattern.clone(), options: options.clone(), tree, stack, prediction };
        Ok(Symbolic { inner: Arc::new(inner) })
    }

    /// Whether values of this pattern may be factorised with this analysis: the patterns must be the same.
    pub fn covers(&self, pattern: &Pattern) -> bool {
        self.inner.pattern.starts() == pattern.starts() && self.inner.pattern.columns() == pattern.columns()
    }

    /// The pattern that was analysed.
    pub fn pattern(&self) -> &Pattern {
        &self.inner.pattern
    }

    /// The cost of a factorisation.
    pub fn prediction(&self) -> Prediction {
        self.inner.prediction
    }

    /// The unknowns in the order in which they are eliminated.
    pub fn order(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.inner.tree.order.iter().map(|&unknown| unknown as usize)
    }

    /// Room for a factorisation; every factorisation into it re-uses the same memory.
    pub fn new_factor(&self) -> Factor {
        Factor::new(self.inner.clone())
    }
}

/// The same elimination with every subtree of the elimination tree contiguous.
fn postordered(graph: &crate::graph::Graph, order: Vec<u32>) -> Vec<u32> {
    let parent = elimination_tree(graph, &order, &inverse(&order));
    let (starts, list) = children(&parent);
    postorder(&starts, &list).into_iter().map(|k| order[k as usize]).collect()
}

fn inverse(order: &[u32]) -> Vec<u32> {
    let mut position = vec![NONE; order.len()];
    for (k, &node) in order.iter().enumerate() {
        position[node as usize] = k as u32;
    }
    position
}

impl Stack {
    fn new(tree: &AssemblyTree) -> Self {
        let mut offsets = vec![0; tree.fronts.len()];
        // Filled lengths of the two sides and the most that both ever took together.
        let (mut filled, mut len) = ([0, 0], 0);
        for (s, front) in tree.fronts.iter().enumerate() {
            let side = (front.depth % 2) as usize;
            offsets[s] = filled[side];
            filled[side] += front.border * front.border;
            len = len.max(filled[0] + filled[1]);
            for &child in tree.children(s) {
                filled[1 - side] -= tree.fronts[child as usize].border.pow(2);
            }
        }
        // The back side counts from the end.
        for (s, front) in tree.fronts.iter().enumerate().filter(|(_, front)| front.depth % 2 == 1) {
            offsets[s] = len - offsets[s] - front.border * front.border;
        }
        Stack { offsets, len }
    }
}

fn predict(pattern: &Pattern, tree: &AssemblyTree, stack: &Stack) -> Prediction {
    let indices = 4 * (tree.rows.len() * 2 + tree.order.len() * 3) + 8 * tree.entries.len();
    let pattern_bytes = 8 * (pattern.starts().len() + pattern.columns().len());
    let values = 8 * (pattern.nonzeros() + 2 * pattern.len());
    Prediction {
        flops: tree.fronts.iter().map(|front| front.flops()).sum(),
        factor_entries: tree.factor_len(),
        stack_entries: stack.len,
        largest_front: tree.fronts.iter().map(|front| front.size()).max().unwrap_or(0),
        fronts: tree.fronts.len(),
        bytes: 8 * (tree.factor_len() + stack.len) + indices + pattern_bytes + values,
    }
}

fn check_limit(needed: usize, limit: Option<usize>) -> Result<(), Error> {
    match limit {
        Some(limit) if needed > limit => Err(Error::MemoryLimit { needed, limit }),
        _ => Ok(()),
    }
}
