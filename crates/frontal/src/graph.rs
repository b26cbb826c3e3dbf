//! The undirected graph of the nodes of a pattern.

use crate::pattern::Pattern;

/// Nodes and their neighbours (never themselves), with the unknowns of each node.
pub(crate) struct Graph {
    pub starts: Vec<usize>,
    pub neighbours: Vec<u32>,
    /// Number of unknowns of each node.
    pub weights: Vec<u32>,
    /// Unknowns node by node, and where those of each node start.
    pub members: Vec<u32>,
    pub member_starts: Vec<usize>,
    /// Node of each unknown.
    pub node_of: Vec<u32>,
}

impl Graph {
    /// The quotient of the pattern by its nodes. Numbers without unknowns leave no vertex behind.
    pub fn of(pattern: &Pattern) -> Self {
        match pattern.node_of() {
            Some(given) => Self::quotient(pattern, renumber(given)),
            None => Self::of_unknowns(pattern),
        }
    }

    /// The graph in which every unknown is a node.
    pub fn of_unknowns(pattern: &Pattern) -> Self {
        Self::quotient(pattern, (0..pattern.len() as u32).collect())
    }

    /// Of nodes alone, whose unknowns are counted and not known.
    pub fn of_nodes(starts: Vec<usize>, neighbours: Vec<u32>, weights: Vec<u32>) -> Self {
        let empty = Vec::new;
        Graph { starts, neighbours, weights, members: empty(), member_starts: Vec::new(), node_of: empty() }
    }

    fn quotient(pattern: &Pattern, node_of: Vec<u32>) -> Self {
        let (member_starts, members) = group(&node_of);
        let weights = member_starts.windows(2).map(|pair| (pair[1] - pair[0]) as u32).collect::<Vec<_>>();
        let mut graph = Graph { starts: vec![0], neighbours: Vec::new(), weights, members, member_starts, node_of };
        graph.connect(pattern);
        graph
    }

    pub fn len(&self) -> usize {
        self.weights.len()
    }

    pub fn neighbours(&self, node: usize) -> &[u32] {
        &self.neighbours[self.starts[node]..self.starts[node + 1]]
    }

    pub fn members(&self, node: usize) -> &[u32] {
        &self.members[self.member_starts[node]..self.member_starts[node + 1]]
    }

    fn connect(&mut self, pattern: &Pattern) {
        let mut last_seen_by = vec![u32::MAX; self.len()];
        for node in 0..self.len() {
            last_seen_by[node] = node as u32;
            for &unknown in &self.members[self.member_starts[node]..self.member_starts[node + 1]] {
                for &column in pattern.row(unknown as usize) {
                    let other = self.node_of[column];
                    if last_seen_by[other as usize] != node as u32 {
                        last_seen_by[other as usize] = node as u32;
                        self.neighbours.push(other);
                    }
                }
            }
            self.starts.push(self.neighbours.len());
        }
    }

    /// The graph without some of its nodes, and the nodes that are left in ascending order.
    pub fn without(&self, removed: &[bool]) -> (Graph, Vec<u32>) {
        let kept = (0..self.len() as u32).filter(|&node| !removed[node as usize]).collect::<Vec<_>>();
        let mut new_number = vec![u32::MAX; self.len()];
        for (new, &old) in kept.iter().enumerate() {
            new_number[old as usize] = new as u32;
        }
        let (mut starts, mut neighbours) = (vec![0], Vec::new());
        for &node in &kept {
            let numbers = self.neighbours(node as usize).iter().map(|&other| new_number[other as usize]);
            neighbours.extend(numbers.filter(|&number| number != u32::MAX));
            starts.push(neighbours.len());
        }
        let weights = kept.iter().map(|&node| self.weights[node as usize]).collect();
        (Graph::of_nodes(starts, neighbours, weights), kept)
    }
}

/// Numbers the nodes from zero without gaps, in the order in which they first occur.
fn renumber(given: &[usize]) -> Vec<u32> {
    let mut number = vec![u32::MAX; given.len()];
    let mut count = 0;
    let mut numbered = |&node: &usize| {
        if number[node] == u32::MAX {
            number[node] = count;
            count += 1;
        }
        number[node]
    };
    given.iter().map(&mut numbered).collect()
}

/// Unknowns sorted by node: starts and members.
fn group(node_of: &[u32]) -> (Vec<usize>, Vec<u32>) {
    let nodes = node_of.iter().map(|&node| node as usize + 1).max().unwrap_or(0);
    let mut starts = vec![0; nodes + 1];
    for &node in node_of {
        starts[node as usize + 1] += 1;
    }
    for node in 0..nodes {
        starts[node + 1] += starts[node];
    }
    let mut next = starts.clone();
    let mut members = vec![0; node_of.len()];
    for (unknown, &node) in node_of.iter().enumerate() {
        members[next[node as usize]] = unknown as u32;
        next[node as usize] += 1;
    }
    (starts, members)
}
