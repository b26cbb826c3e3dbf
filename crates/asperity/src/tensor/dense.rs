//! Small dense systems whose size is known at run time only.

/// Solves a system given by rows with the right-hand side last, by elimination with partial pivoting; None if it is
/// singular. The rows are overwritten.
pub fn eliminate(rows: &mut [Vec<f64>]) -> Option<Vec<f64>> {
    let n = rows.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| rows[i][k].abs().total_cmp(&rows[j][k].abs()))?;
        rows.swap(k, pivot);
        if rows[k][k] == 0.0 {
            return None;
        }
        let (upper, lower) = rows.split_at_mut(k + 1);
        let upper = &upper[k][k..];
        for row in lower.iter_mut().map(|row| &mut row[k..]).filter(|row| row[0] != 0.0) {
            let factor = row[0] / upper[0];
            row.iter_mut().zip(upper).for_each(|(x, y)| *x -= factor * y);
        }
    }
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| rows[k][j] * x[j]).sum();
        x[k] = (rows[k][n] - known) / rows[k][k];
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}

#[cfg(test)]
mod tests {
    use super::eliminate;

    #[test]
    fn pivots_are_sought_and_singular_systems_refused() {
        let mut rows = vec![vec![0.0, 2.0, 4.0], vec![3.0, 1.0, 5.0]];
        assert_eq!(eliminate(&mut rows), Some(vec![1.0, 2.0]));
        assert_eq!(eliminate(&mut [vec![1.0, 2.0, 3.0], vec![2.0, 4.0, 6.0]]), None);
        assert_eq!(eliminate(&mut []), Some(vec![]));
    }
}
