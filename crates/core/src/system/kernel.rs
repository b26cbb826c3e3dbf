//! Which combinations of a few vectors vanish.

/// Combinations of companions `(vector, companion)` whose vectors cancel up to `tolerance`, by Gram and Schmidt's elimination
/// of the largest vector first; with them the number of vectors that do not.
pub fn kernel(mut pairs: Vec<(Vec<f64>, Vec<f64>)>, tolerance: f64) -> (Vec<Vec<f64>>, usize) {
    let mut independent = 0;
    loop {
        let norms = pairs.iter().map(|(vector, _)| dot(vector, vector).sqrt());
        let Some((largest, norm)) = norms.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        if norm <= tolerance {
            break;
        }
        let (vector, companion) = pairs.swap_remove(largest);
        for (other, theirs) in &mut pairs {
            let part = dot(other, &vector) / (norm * norm);
            other.iter_mut().zip(&vector).for_each(|(x, v)| *x -= part * v);
            theirs.iter_mut().zip(&companion).for_each(|(x, v)| *x -= part * v);
        }
        independent += 1;
    }
    (pairs.into_iter().map(|(_, companion)| companion).collect(), independent)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cancels_is_found() {
        let pair = |vector: [f64; 2], k: usize| (vector.to_vec(), (0..3).map(|i| f64::from(i == k)).collect());
        let (found, independent) = kernel(vec![pair([1.0, 2.0], 0), pair([2.0, 4.0], 1), pair([0.0, 3.0], 2)], 1e-9);
        assert_eq!((found.len(), independent), (1, 2));
        let sum = [found[0][0] + 2.0 * found[0][1], 2.0 * found[0][0] + 4.0 * found[0][1] + 3.0 * found[0][2]];
        assert!(sum.iter().all(|x| x.abs() < 1e-12) && found[0].iter().any(|x| x.abs() > 0.1), "{found:?}");
    }
}
