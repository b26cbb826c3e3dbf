//! Any bytes as a pattern with values: refused or solved, never a panic and never a silent wrong answer.
#![no_main]

use frontal::{Error, Options, Pattern, Symbolic};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((&n, rest)) = bytes.split_first() else { return };
    let n = (n % 24) as usize;
    // Half of the bytes are places, taken as they are in one run and made symmetric in the other.
    let (places, numbers) = rest.split_at(rest.len() / 2);
    let raw = places.iter().map(|&place| place as usize % (n + 1)).collect::<Vec<_>>();
    let _ = Pattern::new(raw.iter().take(n + 1).copied().collect(), raw.iter().skip(n + 1).copied().collect());
    check(n, places, numbers);
});

fn check(n: usize, places: &[u8], numbers: &[u8]) {
    let mut rows = vec![Vec::new(); n];
    for pair in places.chunks_exact(2).filter(|_| n > 0) {
        let (i, j) = (pair[0] as usize % n, pair[1] as usize % n);
        rows[i].push(j);
        rows[j].push(i);
    }
    let (mut starts, mut columns) = (vec![0], Vec::new());
    for row in &mut rows {
        row.sort_unstable();
        row.dedup();
        columns.extend_from_slice(row);
        starts.push(columns.len());
    }
    let pattern = Pattern::new(starts, columns).expect("a symmetric pattern");
    let number = |k: usize| f64::from(numbers.get(k).copied().unwrap_or(k as u8)) - 128.0;
    let values = (0..pattern.nonzeros()).map(|k| number(k) * 10f64.powi(k as i32 % 5 - 2)).collect::<Vec<_>>();
    let symbolic = Symbolic::analyse(&pattern, &Options::default()).expect("small and symmetric");
    let mut factor = symbolic.new_factor();
    match symbolic.factorise(&values, &mut factor) {
        Ok(_) => {}
        Err(Error::Singular(singular)) => return assert!(!singular.null_vectors.is_empty()),
        Err(other) => panic!("{other}"),
    }
    let mut x = (0..n).map(|k| k as f64 + 1.0).collect::<Vec<_>>();
    match factor.solve(&mut x) {
        Ok(accuracy) => assert!(accuracy.backward_error <= 1e-10),
        Err(Error::Inaccurate { .. }) => {}
        Err(other) => panic!("{other}"),
    }
}
