//! The name that a misspelt one most likely means.

/// The candidate nearest to `name` in edit distance (one insertion, deletion, replacement or exchange of neighbours
/// costs one; case, `-` and `_` cost nothing), if it is near enough to be meant: a third of the letters at most.
/// Of equally near ones the first is taken.
///
/// ```
/// assert_eq!(asperity_core::declare::nearest("Yuong", ["young", "poisson"]), Some("young"));
/// assert_eq!(asperity_core::declare::nearest("density", ["young", "poisson"]), None);
/// ```
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let wanted = plain(name);
    let near = |candidate: &'a str| {
        let other = plain(candidate);
        let distance = distance(&wanted, &other);
        (distance <= wanted.len().max(other.len()).max(3) / 3).then_some((distance, candidate))
    };
    candidates.into_iter().filter_map(near).min_by_key(|&(distance, _)| distance).map(|(_, candidate)| candidate)
}

fn plain(name: &str) -> Vec<char> {
    name.chars().flat_map(char::to_lowercase).map(|c| if c == '_' { '-' } else { c }).collect()
}

/// Optimal string alignment: three rows of the usual table suffice.
fn distance(a: &[char], b: &[char]) -> usize {
    let mut before: Vec<usize> = vec![0; b.len() + 1];
    let mut above: Vec<usize> = (0..=b.len()).collect();
    for i in 0..a.len() {
        let mut row = vec![i + 1; b.len() + 1];
        for j in 0..b.len() {
            let replaced = above[j] + usize::from(a[i] != b[j]);
            row[j + 1] = replaced.min(above[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j] {
                row[j + 1] = row[j + 1].min(before[j - 1] + 1);
            }
        }
        before = std::mem::replace(&mut above, row);
    }
    above[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn between(a: &str, b: &str) -> usize {
        distance(&plain(a), &plain(b))
    }

    #[test]
    fn distances() {
        assert_eq!(between("", "abc"), 3);
        assert_eq!(between("abc", ""), 3);
        assert_eq!(between("young", "yuong"), 1);
        assert_eq!(between("kitten", "sitting"), 3);
        assert_eq!(between("plane_strain", "Plane-Strain"), 0);
    }

    #[test]
    fn the_nearest_wins_and_far_ones_do_not() {
        assert_eq!(nearest("fiction", ["friction", "fraction"]), Some("friction"));
        assert_eq!(nearest("bor", ["tube", "bore"]), Some("bore"));
        assert_eq!(nearest("x", ["young"]), None);
        assert_eq!(nearest("anything", []), None);
    }
}
