//! The order in which nodes are eliminated.

use crate::error::Error;
use crate::graph::Graph;
use crate::options::{Options, Ordering};
use crate::pattern::{Pattern, check_length};

/// The graph to be eliminated and the order of its nodes.
///
/// # Errors
/// [`Error::InvalidOrder`] or [`Error::WrongLength`] if a given order is not a permutation; those of METIS.
pub(crate) fn order(pattern: &Pattern, options: &Options) -> Result<(Graph, Vec<u32>), Error> {
    check_distinct(&options.last, pattern.len())?;
    let graph = match &options.ordering {
        Ordering::NestedDissection | Ordering::MinimumDegree => Graph::of(pattern),
        // A given order need not keep the unknowns of a node together.
        Ordering::Given(_) => Graph::of_unknowns(pattern),
    };
    let (last, is_last) = nodes_of(&graph, &options.last);
    let mut order = match &options.ordering {
        Ordering::Given(order) => {
            check_length("the given order", pattern.len(), order.len())?;
            check_distinct(order, pattern.len())?;
            order.iter().map(|&unknown| unknown as u32).filter(|&node| !is_last[node as usize]).collect()
        }
        by if last.is_empty() => reduce_fill(by, &graph)?,
        by => {
            let (rest, kept) = graph.without(&is_last);
            reduce_fill(by, &rest)?.into_iter().map(|node| kept[node as usize]).collect::<Vec<_>>()
        }
    };
    order.extend(last);
    Ok((graph, order))
}

/// The order of a library that was built in.
fn reduce_fill(by: &Ordering, graph: &Graph) -> Result<Vec<u32>, Error> {
    match by {
        #[cfg(feature = "metis")]
        Ordering::NestedDissection => crate::metis::nested_dissection(graph),
        #[cfg(all(feature = "feral", not(feature = "metis")))]
        Ordering::NestedDissection => crate::feral::nested_dissection(graph),
        #[cfg(feature = "feral")]
        Ordering::MinimumDegree => crate::feral::minimum_degree(graph),
        _ => {
            let _ = graph;
            Err(Error::OrderingNotBuilt)
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

fn check_distinct(unknowns: &[usize], n: usize) -> Result<(), Error> {
    let mut seen = vec![false; if unknowns.is_empty() { 0 } else { n }];
    for &unknown in unknowns {
        match seen.get_mut(unknown) {
            Some(seen) if !*seen => *seen = true,
            _ => return Err(Error::InvalidOrder { unknown }),
        }
    }
    Ok(())
}
