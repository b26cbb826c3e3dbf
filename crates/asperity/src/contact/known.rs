//! What a search has found for nodes already.

/// A list of nodes, short enough to be gone through, and what was found for each.
#[derive(Debug)]
pub struct Known<T>(Vec<(usize, T)>);

impl<T> Default for Known<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: Copy> Known<T> {
    /// What was found for a node, or is found now.
    pub fn of(&mut self, node: usize, find: impl FnOnce() -> T) -> T {
        if let Some((_, known)) = self.0.iter().find(|(known, _)| *known == node) {
            return *known;
        }
        let found = find();
        self.0.push((node, found));
        found
    }
}
