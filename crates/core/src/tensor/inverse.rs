//! Inverse of a small dense matrix.

/// The inverse of a matrix, row by row, by Gauss and Jordan's elimination with row exchanges; none where a
/// pivot is at most the part `singular` of the largest diagonal entry.
pub fn inverse(mut a: Vec<Vec<f64>>, singular: f64) -> Option<Vec<Vec<f64>>> {
    let mut b = a.clone();
    invert(&mut a, &mut b, singular).then_some(b)
}

/// The same in place: `a` becomes the unit matrix and `b` the inverse; says no where there is none. Rows may be longer than there
/// are rows.
pub fn invert<R: AsMut<[f64]> + AsRef<[f64]> + Clone>(a: &mut [R], b: &mut [R], singular: f64) -> bool {
    let n = a.len();
    for (i, row) in b.iter_mut().enumerate() {
        row.as_mut().iter_mut().enumerate().for_each(|(j, entry)| *entry = f64::from(u8::from(i == j)));
    }
    let size = (0..n).map(|i| a[i].as_ref()[i]).fold(0.0, f64::max);
    for k in 0..n {
        let column = |i: usize| a[i].as_ref()[k].abs();
        let pivot = (k..n).max_by(|&i, &j| column(i).total_cmp(&column(j))).unwrap_or(k);
        if column(pivot) <= singular * size {
            return false;
        }
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (row, right) = (a[k].clone(), b[k].clone());
        let (row, right) = (row.as_ref(), right.as_ref());
        for i in 0..n {
            let factor = if i == k { 1.0 - 1.0 / row[k] } else { a[i].as_ref()[k] / row[k] };
            let (a, b) = (a[i].as_mut(), b[i].as_mut());
            (0..n).for_each(|j| a[j] -= factor * row[j]);
            (0..n).for_each(|j| b[j] -= factor * right[j]);
        }
    }
    true
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
