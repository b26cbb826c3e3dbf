//! The elimination tree of a graph under an order, and what follows from it without forming the factor.

use crate::graph::Graph;

/// No parent: the node is a root.
pub(crate) const NONE: u32 = u32::MAX;

/// Parent of each node in the elimination tree; nodes are numbered by elimination (Liu, ACM TOMS 12, 1986).
pub(crate) fn elimination_tree(graph: &Graph, order: &[u32], position: &[u32]) -> Vec<u32> {
    let n = order.len();
    let mut parent = vec![NONE; n];
    // Shortcut towards the root of the tree built so far.
    let mut ancestor = vec![NONE; n];
    for k in 0..n as u32 {
        for &neighbour in graph.neighbours(order[k as usize] as usize) {
            let mut i = position[neighbour as usize];
            while i < k {
                let next = std::mem::replace(&mut ancestor[i as usize], k);
                if next == NONE {
                    parent[i as usize] = k;
                    break;
                }
                i = next;
            }
        }
    }
    parent
}

/// Children of each node as starts and list, in ascending order; the roots are the children of node `n`.
pub(crate) fn children(parent: &[u32]) -> (Vec<usize>, Vec<u32>) {
    let n = parent.len();
    let slot = |p: u32| if p == NONE { n } else { p as usize };
    let mut starts = vec![0; n + 2];
    for &p in parent {
        starts[slot(p) + 1] += 1;
    }
    for k in 0..=n {
        starts[k + 1] += starts[k];
    }
    let mut next = starts.clone();
    let mut list = vec![0; n];
    for (k, &p) in parent.iter().enumerate() {
        list[next[slot(p)]] = k as u32;
        next[slot(p)] += 1;
    }
    (starts, list)
}

/// Nodes so that each follows its descendants, which are contiguous before it; children keep the order of `list`.
pub(crate) fn postorder(starts: &[usize], list: &[u32]) -> Vec<u32> {
    let n = list.len();
    let mut next = starts.to_vec();
    let mut order = Vec::with_capacity(n);
    let mut path = vec![n as u32];
    while let Some(&node) = path.last() {
        let node = node as usize;
        if next[node] < starts[node + 1] {
            path.push(list[next[node]]);
            next[node] += 1;
        } else {
            order.push(node as u32);
            path.pop();
        }
    }
    order.pop();
    order
}

/// Number of unknowns in each column of the factor, the node's own included, for a tree in postorder.
///
/// Gilbert, Ng & Peyton, SIAM J. Matrix Anal. Appl. 15, 1994: row `i` of the factor is a subtree rooted at `i`, the
/// union of the paths from its leaves; each leaf adds the weight of `i` where its path starts, and the least common
/// ancestor of consecutive leaves takes it away where two paths meet.
pub(crate) fn column_counts(graph: &Graph, order: &[u32], position: &[u32], parent: &[u32]) -> Vec<u64> {
    let n = order.len();
    let weight = |k: usize| i64::from(graph.weights[order[k] as usize]);
    let first = first_descendants(parent);
    let mut delta = (0..n).map(|k| if first[k] as usize == k { weight(k) } else { 0 }).collect::<Vec<_>>();
    let mut latest_first = vec![NONE; n];
    let mut previous_leaf = vec![NONE; n];
    let mut ancestor = (0..n as u32).collect::<Vec<_>>();
    for j in 0..n {
        if parent[j] != NONE {
            delta[parent[j] as usize] -= weight(j);
        }
        for &neighbour in graph.neighbours(order[j] as usize) {
            let i = position[neighbour as usize] as usize;
            let is_leaf = i > j && (latest_first[i] == NONE || first[j] > latest_first[i]);
            if !is_leaf {
                continue;
            }
            latest_first[i] = first[j];
            delta[j] += weight(i);
            let previous = std::mem::replace(&mut previous_leaf[i], j as u32);
            if previous != NONE {
                delta[find(&mut ancestor, previous) as usize] -= weight(i);
            }
        }
        if parent[j] != NONE {
            ancestor[j] = parent[j];
        }
    }
    for j in 0..n {
        if parent[j] != NONE {
            delta[parent[j] as usize] += delta[j];
        }
    }
    delta.into_iter().map(|count| count as u64).collect()
}

/// First descendant of each node of a tree in postorder; a leaf is its own.
fn first_descendants(parent: &[u32]) -> Vec<u32> {
    let mut first = (0..parent.len() as u32).collect::<Vec<_>>();
    for j in 0..parent.len() {
        if parent[j] != NONE {
            let p = parent[j] as usize;
            first[p] = first[p].min(first[j]);
        }
    }
    first
}

/// Root of the set of `k`, with path compression.
fn find(ancestor: &mut [u32], k: u32) -> u32 {
    let mut root = k;
    while ancestor[root as usize] != root {
        root = ancestor[root as usize];
    }
    let mut k = k;
    while k != root {
        k = std::mem::replace(&mut ancestor[k as usize], root);
    }
    root
}
