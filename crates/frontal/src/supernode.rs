//! Supernodes: neighbouring columns of the factor with (nearly) the same rows, eliminated together in one front.

use crate::etree::{NONE, children, postorder};
use crate::options::Amalgamation;

/// A group of nodes eliminated in one front, before the fronts are put in their final order.
pub(crate) struct Supernode {
    /// Nodes by elimination position in the postordered tree, descendants first.
    pub nodes: Vec<u32>,
    /// Unknowns eliminated.
    pub pivots: u64,
    /// Order of the front: pivots and the unknowns of later fronts they couple to.
    pub size: u64,
    /// Zeros stored in the lower half of the front's factor because of merges.
    zeros: u64,
    /// Supernode that receives this one's contribution.
    pub parent: u32,
}

/// Supernodes of a postordered tree, relaxed; each comes after its descendants.
pub(crate) fn supernodes(
    parent: &[u32],
    counts: &[u64],
    weights: impl Fn(usize) -> u64,
    rule: &Amalgamation,
) -> Vec<Supernode> {
    merge(fundamental(parent, counts, weights), rule)
}

/// Maximal chains of nodes in which each is the only child of the next and has the same rows but its own.
fn fundamental(parent: &[u32], counts: &[u64], weights: impl Fn(usize) -> u64) -> Vec<Supernode> {
    let (child_starts, _) = children(parent);
    let continues = |k: usize| {
        k > 0
            && parent[k - 1] == k as u32
            && child_starts[k + 1] - child_starts[k] == 1
            && counts[k - 1] == counts[k] + weights(k - 1)
    };
    let mut list: Vec<Supernode> = Vec::new();
    let mut supernode_of = vec![NONE; parent.len()];
    for k in 0..parent.len() {
        if !continues(k) {
            list.push(Supernode { nodes: Vec::new(), pivots: 0, size: counts[k], zeros: 0, parent: NONE });
        }
        supernode_of[k] = list.len() as u32 - 1;
        if let Some(supernode) = list.last_mut() {
            supernode.nodes.push(k as u32);
            supernode.pivots += weights(k);
        }
    }
    for supernode in &mut list {
        let above = supernode.nodes.last().map_or(NONE, |&k| parent[k as usize]);
        supernode.parent = if above == NONE { NONE } else { supernode_of[above as usize] };
    }
    list
}

/// Merges children into parents, from the leaves upwards, wherever the rule allows it (Ashcraft & Grimes, ACM TOMS 15,
/// 1989). The child that adds the fewest zeros comes first.
fn merge(mut list: Vec<Supernode>, rule: &Amalgamation) -> Vec<Supernode> {
    let mut parents = list.iter().map(|supernode| supernode.parent).collect::<Vec<_>>();
    let (starts, child_list) = children(&parents);
    for s in 0..list.len() {
        let mut candidates = child_list[starts[s]..starts[s + 1]].to_vec();
        candidates.sort_by_key(|&child| (zeros_of_merge(&list, child as usize, s), child));
        for child in candidates {
            if allowed(&list, child as usize, s, rule) {
                absorb(&mut list, child as usize, s);
            }
        }
    }
    for s in (0..list.len()).rev() {
        // A parent that was absorbed stands for the one that absorbed it.
        let p = parents[s];
        if p != NONE && list[p as usize].nodes.is_empty() {
            parents[s] = parents[p as usize];
        }
    }
    compact(list, &parents)
}

/// Zeros in the lower half of the factor added when the child joins its parent: the child's columns get all rows of
/// the merged front.
fn zeros_of_merge(list: &[Supernode], child: usize, parent: usize) -> u64 {
    let (child, parent) = (&list[child], &list[parent]);
    child.pivots * (child.pivots + parent.size - child.size)
}

fn allowed(list: &[Supernode], child: usize, parent: usize, rule: &Amalgamation) -> bool {
    let pivots = list[child].pivots + list[parent].pivots;
    if pivots <= rule.always as u64 {
        return true;
    }
    let size = list[child].pivots + list[parent].size;
    let zeros = list[child].zeros + list[parent].zeros + zeros_of_merge(list, child, parent);
    let entries = pivots * (2 * size - pivots + 1) / 2;
    let share = rule.shares.iter().find(|&&(bound, _)| pivots <= bound as u64).or(rule.shares.last());
    share.is_some_and(|&(_, share)| (zeros as f64) <= share * entries as f64)
}

fn absorb(list: &mut [Supernode], child: usize, parent: usize) {
    let zeros = zeros_of_merge(list, child, parent);
    let child = &mut list[child];
    let (nodes, pivots, own_zeros) = (std::mem::take(&mut child.nodes), child.pivots, child.zeros);
    let parent = &mut list[parent];
    parent.nodes.splice(0..0, nodes);
    parent.pivots += pivots;
    parent.size += pivots;
    parent.zeros += own_zeros + zeros;
}

/// Drops the supernodes that were absorbed.
fn compact(list: Vec<Supernode>, parents: &[u32]) -> Vec<Supernode> {
    let mut new_number = vec![NONE; list.len()];
    let mut count = 0;
    for (s, supernode) in list.iter().enumerate() {
        if !supernode.nodes.is_empty() {
            new_number[s] = count;
            count += 1;
        }
    }
    let renumbered = |s: usize| if parents[s] == NONE { NONE } else { new_number[parents[s] as usize] };
    let with_parent = |(s, supernode)| Supernode { parent: renumbered(s), ..supernode };
    list.into_iter().enumerate().map(with_parent).filter(|supernode| !supernode.nodes.is_empty()).collect()
}

/// Supernodes in the postorder that needs the least memory for contribution blocks, and their parents in it.
///
/// The children with the largest excess of their subtree's peak over what they leave behind go first (Liu, ACM TOMS
/// 12, 1986).
pub(crate) fn in_final_order(supernodes: &[Supernode]) -> (Vec<&Supernode>, Vec<u32>) {
    let parents = supernodes.iter().map(|s| s.parent).collect::<Vec<_>>();
    let (starts, mut list) = children(&parents);
    let block = |s: usize| (supernodes[s].size - supernodes[s].pivots).pow(2);
    let mut peak = vec![0; supernodes.len()];
    for s in 0..supernodes.len() {
        let own = &mut list[starts[s]..starts[s + 1]];
        own.sort_by_key(|&child| (block(child as usize) as i128 - i128::from(peak[child as usize]), child));
        let mut left_behind = 0;
        for &child in own.iter() {
            peak[s] = peak[s].max(left_behind + peak[child as usize]);
            left_behind += block(child as usize);
        }
        peak[s] = peak[s].max(left_behind + block(s));
    }
    let order = postorder(&starts, &list);
    let mut number = vec![NONE; supernodes.len()];
    for (new, &old) in order.iter().enumerate() {
        number[old as usize] = new as u32;
    }
    let parent = |&s: &u32| match parents[s as usize] {
        NONE => NONE,
        p => number[p as usize],
    };
    (order.iter().map(|&s| &supernodes[s as usize]).collect(), order.iter().map(parent).collect())
}
