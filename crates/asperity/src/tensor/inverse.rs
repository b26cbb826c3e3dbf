//! Inverse of a small dense matrix.

/// The inverse of a matrix, row by row, by Gauss and Jordan's elimination with row exchanges; none where a
/// pivot is at most the part `singular` of the largest diagonal entry.
pub fn inverse(mut a: Vec<Vec<f64>>, singular: f64) -> Option<Vec<Vec<f64>>> {
    let n = a.len();
    let mut b: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    let size = (0..n).map(|i| a[i][i]).fold(0.0, f64::max);
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs()))?;
        if a[pivot][k].abs() <= singular * size {
            return None;
        }
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (row, right) = (a[k].clone(), b[k].clone());
        for i in 0..n {
            let factor = if i == k { 1.0 - 1.0 / row[k] } else { a[i][k] / row[k] };
            (0..n).for_each(|j| a[i][j] -= factor * row[j]);
            (0..n).for_each(|j| b[i][j] -= factor * right[j]);
        }
    }
    Some(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverses() {
        let found = inverse(vec![vec![0.0, 2.0], vec![4.0, 1.0]], 1e-12).unwrap();
        assert_eq!(found, [[-0.125, 0.25], [0.5, 0.0]]);
        assert_eq!(inverse(vec![vec![1.0, 2.0], vec![2.0, 4.0]], 1e-12), None);
        assert_eq!(inverse(vec![vec![0.0]], 1e-12), None);
    }
}
