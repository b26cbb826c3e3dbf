//! Disjoint sets of numbers.

/// Sets of numbers that are joined pair by pair; the least of a set is its root.
pub struct DisjointSets(Vec<usize>);

impl DisjointSets {
    /// Of so many numbers, each alone.
    pub fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// The root of the set of a number.
    pub fn root(&self, mut i: usize) -> usize {
        while self.0[i] != i {
            i = self.0[i];
        }
        i
    }

    /// Makes the sets of two numbers one; the way to its root is shortened.
    pub fn join(&mut self, i: usize, j: usize) {
        let root = self.root(i).min(self.root(j));
        for mut i in [i, j] {
            while i != root {
                i = std::mem::replace(&mut self.0[i], root);
            }
        }
    }

    /// For each number the number of its set, counted from zero by their least members.
    pub fn labels(&self) -> Vec<usize> {
        let mut labels = Vec::with_capacity(self.0.len());
        let mut count = 0;
        for i in 0..self.0.len() {
            let root = self.root(i);
            labels.push(if root == i { count } else { labels[root] });
            count += usize::from(root == i);
        }
        labels
    }
}
