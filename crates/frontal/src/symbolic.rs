//! The analysis: all that can be known before any value is.

use crate::assembly_tree::AssemblyTree;
use crate::error::FrontalError;
use crate::etree::{NONE, children, column_counts, elimination_tree, postorder};
use crate::factor::{Factor, LARGE, Memory};
use crate::graph::Graph;
use crate::options::Options;
use crate::ordering;
use crate::pattern::Pattern;
use crate::plan::Plan;
use crate::supernode::{Supernode, supernodes};
use std::sync::Arc;

/// What a factorisation will cost, known exactly from the pattern.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Prediction {
    /// Multiplications and additions of one factorisation.
    pub flops: f64,
    /// Numbers in the factors, stored zeros included.
    pub factor_entries: usize,
    /// Numbers in the stack of contribution blocks, for one thread.
    pub stack_entries: usize,
    /// Order of the largest front.
    pub largest_front: usize,
    /// Number of fronts.
    pub fronts: usize,
    /// Bytes of the analysis, one factor and its working memory, for one thread.
    pub bytes: usize,
    /// Whether the factors are L and D.
    pub symmetric: bool,
}

impl Prediction {
    /// Bytes beyond [`bytes`](Self::bytes) where the factor is to be kept in single precision too: large working memory is given
    /// back for that.
    pub fn single_bytes(&self) -> usize {
        let working = 8 * self.stack_entries;
        (4 * self.factor_entries).saturating_sub(if working > LARGE { working } else { 0 })
    }

    /// Work of a factorisation, in flops at full speed: moving a number of the factor costs as much as so many flops.
    pub fn factorisation_work(&self) -> f64 {
        self.flops + 200.0 * self.factor_entries as f64
    }

    /// Work of one solution in the same unit: each number of L and U is read once, each of L in L D L^T twice.
    pub fn solve_work(&self) -> f64 {
        (if self.symmetric { 60.0 } else { 30.0 }) * self.factor_entries as f64
    }
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
    pub prediction: Prediction,
}

impl Symbolic {
    /// Orders the unknowns, finds the fronts and predicts the cost: a pure function of pattern and options.
    ///
    /// # Errors
    /// [`FrontalError::InvalidOrder`] or [`FrontalError::WrongLength`] for bad options, [`FrontalError::TooLarge`],
    /// [`FrontalError::OrderingFailed`], and [`FrontalError::MemoryLimit`] if the prediction exceeds the limit.
    pub fn analyse(pattern: &Pattern, options: &Options) -> Result<Self, FrontalError> {
        u32::try_from(pattern.nonzeros().max(pattern.len() + 1)).map_err(|_| FrontalError::TooLarge)?;
        let (graph, order) = ordering::order(pattern, options)?;
        let (order, supernodes) = divided(&graph, order, options);
        Self::laid_out(pattern, options, AssemblyTree::new(pattern, &graph, &order, &supernodes, options.symmetric)?)
    }

    /// The same analysis for values that are symmetric, or are not: what is ordered and found out stays, numbers get other
    /// places.
    ///
    /// # Errors
    /// [`FrontalError::TooLarge`], and [`FrontalError::MemoryLimit`] if the prediction exceeds the limit.
    pub fn for_values(&self, symmetric: bool) -> Result<Self, FrontalError> {
        let Inner { pattern, options, tree, .. } = &*self.inner;
        if options.symmetric == symmetric {
            return Ok(self.clone());
        }
        Self::laid_out(pattern, &Options { symmetric, ..options.clone() }, tree.for_values(pattern, symmetric)?)
    }

    fn laid_out(pattern: &Pattern, options: &Options, tree: AssemblyTree) -> Result<Self, FrontalError> {
        let prediction = predict((pattern.len(), pattern.nonzeros()), &tree, Plan::new(&tree, 1).len());
        check_limit(prediction.bytes, options.memory_limit)?;
        let inner = Inner { pattern: pattern.clone(), options: options.clone(), tree, prediction };
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
    ///
    /// The memory is laid out for as many threads as the current rayon pool has. More threads need more of it; where
    /// that would exceed [`Options::memory_limit`] one thread does all. Results are the same
    /// to the last bit for any number of threads.
    pub fn new_factor(&self) -> Factor {
        self.new_factor_in(Memory::default())
    }

    /// The same in the memory of an earlier factor.
    pub(crate) fn new_factor_in(&self, memory: Memory) -> Factor {
        Factor::new(self.inner.clone(), rayon::current_num_threads(), memory)
    }
}

/// Nodes with a number of unknowns each, all of which couple to all of their neighbours': a pattern in a twentieth of its
/// memory, for finite elements in space.
#[derive(Debug, Clone)]
pub struct NodeGraph {
    /// Row starts: one more than there are nodes.
    pub starts: Vec<usize>,
    /// Neighbours of all nodes, never themselves, in ascending order for each.
    pub neighbours: Vec<u32>,
    /// Unknowns of each node.
    pub weights: Vec<u32>,
}

impl NodeGraph {
    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.weights.iter().map(|&weight| weight as usize).sum()
    }

    /// Entries of a row of each node.
    fn row_lengths(&self) -> impl Iterator<Item = usize> + '_ {
        let weight = |node: u32| self.weights[node as usize] as usize;
        let neighbours = |node: usize| &self.neighbours[self.starts[node]..self.starts[node + 1]];
        (0..self.weights.len())
            .map(move |node| weight(node as u32) + neighbours(node).iter().map(|&other| weight(other)).sum::<usize>())
    }

    /// Entries of the matrix.
    pub fn nonzeros(&self) -> usize {
        self.row_lengths().zip(&self.weights).map(|(length, &weight)| length * weight as usize).sum()
    }

    /// Nodes whose rows have more entries than `most`.
    pub fn rows_beyond(&self, most: f64) -> Vec<usize> {
        self.row_lengths().enumerate().filter(|&(_, length)| length as f64 > most).map(|(node, _)| node).collect()
    }

    /// The order in which a factorisation would eliminate the nodes, `last` after all others.
    ///
    /// # Errors
    /// Those of [`Prediction::of_nodes`].
    pub fn order(self, last: &[usize], options: &Options) -> Result<Vec<u32>, FrontalError> {
        let graph = Graph::of_nodes(self.starts, self.neighbours, self.weights);
        let order = ordering::order_nodes(&graph, last, &options.ordering)?;
        Ok(divided(&graph, order, options).0)
    }
}

impl Prediction {
    /// The cost of factorising unsymmetric and symmetric values with so many threads, from the graph of the nodes alone: the
    /// same as that of [`Symbolic::prediction`] for the pattern of all unknowns, the stack being that of so many threads. `last`
    /// are the nodes to eliminate after all others; the ordering must be one that works on nodes.
    ///
    /// # Errors
    /// Those of [`Symbolic::analyse`].
    pub fn of_nodes(
        graph: NodeGraph,
        last: &[usize],
        options: &Options,
        threads: usize,
    ) -> Result<[Self; 2], FrontalError> {
        let (unknowns, nonzeros) = (graph.unknowns(), graph.nonzeros());
        u32::try_from(nonzeros.max(unknowns + 1)).map_err(|_| FrontalError::TooLarge)?;
        let graph = Graph::of_nodes(graph.starts, graph.neighbours, graph.weights);
        let order = ordering::order_nodes(&graph, last, &options.ordering)?;
        let (_, supernodes) = divided(&graph, order, options);
        let of = |symmetric: bool| {
            let tree = AssemblyTree::outline(&supernodes, symmetric)?;
            Ok(predict((unknowns, nonzeros), &tree, Plan::new(&tree, threads).len()))
        };
        Ok([of(false)?, of(true)?])
    }
}

/// The order with every subtree contiguous, and the supernodes in it.
fn divided(graph: &Graph, order: Vec<u32>, options: &Options) -> (Vec<u32>, Vec<Supernode>) {
    let order = postordered(graph, order);
    let position = inverse(&order);
    let parent = elimination_tree(graph, &order, &position);
    let counts = column_counts(graph, &order, &position, &parent);
    let weight = |k: usize| u64::from(graph.weights[order[k] as usize]);
    let supernodes = supernodes(&parent, &counts, weight, &options.amalgamation);
    (order, supernodes)
}

/// The same elimination with every subtree of the elimination tree contiguous.
fn postordered(graph: &Graph, order: Vec<u32>) -> Vec<u32> {
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

impl Inner {
    /// The plan for so many threads, or that for one if the memory limit leaves no room for more.
    pub fn plan(&self, threads: usize) -> Plan {
        let plan = Plan::new(&self.tree, threads);
        let more = 8 * plan.len().saturating_sub(self.prediction.stack_entries);
        match self.options.memory_limit {
            Some(limit) if self.prediction.bytes + more > limit => Plan::new(&self.tree, 1),
            _ => plan,
        }
    }
}

fn predict((unknowns, nonzeros): (usize, usize), tree: &AssemblyTree, stack_entries: usize) -> Prediction {
    let rows: usize = tree.fronts.iter().map(|front| front.border).sum();
    let symmetric = tree.fronts.iter().any(|front| front.symmetric);
    let entries = if symmetric { nonzeros.midpoint(unknowns) } else { nonzeros };
    let indices = 4 * (rows * 2 + unknowns * 3) + 8 * entries;
    let pattern_bytes = 8 * (unknowns + 1 + nonzeros);
    let values = 8 * (nonzeros + 2 * unknowns);
    Prediction {
        flops: tree.fronts.iter().map(|front| front.flops()).sum(),
        factor_entries: tree.factor_len(),
        stack_entries,
        largest_front: tree.fronts.iter().map(|front| front.size()).max().unwrap_or(0),
        fronts: tree.fronts.len(),
        bytes: 8 * (tree.factor_len() + stack_entries) + indices + pattern_bytes + values,
        symmetric,
    }
}

fn check_limit(needed: usize, limit: Option<usize>) -> Result<(), FrontalError> {
    match limit {
        Some(limit) if needed > limit => Err(FrontalError::MemoryLimit { needed, limit }),
        _ => Ok(()),
    }
}
