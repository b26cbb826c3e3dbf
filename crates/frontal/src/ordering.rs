//! The order in which nodes are eliminated.

use crate::error::FrontalError;
use crate::graph::Graph;
use crate::options::{Options, Ordering};
use crate::pattern::{Pattern, check_length};

/// The graph to be eliminated and the order of its nodes.
///
/// # Errors
/// [`FrontalError::InvalidOrder`] or [`FrontalError::WrongLength`] if a given order is not a permutation; those of METIS.
pub(crate) fn order(pattern: &Pattern, options: &Options) -> Result<(Graph, Vec<u32>), FrontalError> {
    check_distinct(&options.last, pattern.len())?;
    let graph = match &options.ordering {
        Ordering::NestedDissection | Ordering::MinimumDegree => Graph::of(pattern),
        // A given order need not keep the unknowns of a node together.
        Ordering::Given(_) => Graph::of_unknowns(pattern),
    };
    let (last, is_last) = nodes_of(&graph, &options.last);
    let order = match &options.ordering {
        Ordering::Given(order) => {
            check_length("the given order", pattern.len(), order.len())?;
            check_distinct(order, pattern.len())?;
            let nodes = order.iter().map(|&unknown| unknown as u32).filter(|&node| !is_last[node as usize]);
            nodes.chain(last).collect()
        }
        by => with_last(&graph, (last, &is_last), by)?,
    };
    Ok((graph, order))
}

/// The order of the nodes of a graph by a library, with those to come last behind it.
///
/// # Errors
/// [`FrontalError::InvalidOrder`] for a node that is not there or stands twice in `last`; [`FrontalError::OrderingNotBuilt`] for a given
/// order, which is one of unknowns; those of METIS.
pub(crate) fn order_nodes(graph: &Graph, last: &[usize], by: &Ordering) -> Result<Vec<u32>, FrontalError> {
    check_distinct(last, graph.len())?;
    let mut is_last = vec![false; graph.len()];
    last.iter().for_each(|&node| is_last[node] = true);
    with_last(graph, (last.iter().map(|&node| node as u32).collect(), &is_last), by)
}

fn with_last(graph: &Graph, (last, is_last): (Vec<u32>, &[bool]), by: &Ordering) -> Result<Vec<u32>, FrontalError> {
    if last.is_empty() {
        return reduce_fill(by, graph);
    }
    let (rest, kept) = graph.without(is_last);
    let order = reduce_fill(by, &rest)?;
    Ok(order.into_iter().map(|node| kept[node as usize]).chain(last).collect())
}

/// The order of a library that was built in.
fn reduce_fill(by: &Ordering, graph: &Graph) -> Result<Vec<u32>, FrontalError> {
    match by {
        #[cfg(feature = "metis")]
        Ordering::NestedDissection => crate::metis::nested_dissection(graph),
        #[cfg(all(feature = "feral", not(feature = "metis")))]
        Ordering::NestedDissection => crate::feral::nested_dissection(graph),
        #[cfg(feature = "feral")]
        Ordering::MinimumDegree => crate::feral::minimum_degree(graph),
        _ => {
            let _ = graph;
            Err(FrontalError::OrderingNotBuilt)
        }
    }
}

/// The nodes of some unknowns, each once, and a mark on each.
fn nodes_of(graph: &Graph, unknowns: &[usize]) -> (Vec<u32>, Vec<bool>) {
    let mut marked = vec![false; graph.len()];
    let mut nodes = Vec::new();
    for &unknown in unknowns {
        let node = graph.node_of[unknown];
        if !std::mem::replace(&mut marked[node as usize], true) {
            nodes.push(node);
        }
    }
    (nodes, marked)
}

fn check_distinct(unknowns: &[usize], n: usize) -> Result<(), FrontalError> {
    let mut seen = vec![false; if unknowns.is_empty() { 0 } else { n }];
    for &unknown in unknowns {
        match seen.get_mut(unknown) {
            Some(seen) if !*seen => *seen = true,
            _ => return Err(FrontalError::InvalidOrder { unknown }),
        }
    }
    Ok(())
}
