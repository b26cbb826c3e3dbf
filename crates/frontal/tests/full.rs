//! Full matrices.

use frontal::Full;

#[test]
fn systems_of_every_size_are_solved() {
    for n in [0, 1, 2, 3, 5, 17, 64, 130] {
        // Sines of the position: far from diagonally dominant, so that rows are exchanged.
        let entry = |k: usize| (1.0 + k as f64 * k as f64).sin();
        let rows: Vec<f64> = (0..n * n).map(entry).collect();
        let wanted: Vec<f64> = (0..n).map(|k| 1.0 + k as f64).collect();
        let times = |row: &[f64]| row.iter().zip(&wanted).map(|(a, x)| a * x).sum();
        let mut x: Vec<f64> = rows.chunks_exact(n.max(1)).map(times).collect();
        Full::factorise(n, rows).expect("a regular matrix").solve(&mut x);
        assert!(x.iter().zip(&wanted).all(|(x, wanted)| (x / wanted - 1.0).abs() < 1e-9), "{n}: {x:?}");
    }
}

#[test]
fn what_has_no_inverse_is_refused() {
    assert!(Full::factorise(3, vec![1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).is_none());
    assert!(Full::factorise(2, vec![1.0, f64::NAN, 0.0, 1.0]).is_none());
    assert!(Full::factorise(1, vec![f64::INFINITY]).is_none());
}
