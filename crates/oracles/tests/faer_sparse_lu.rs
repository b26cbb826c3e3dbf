//! The same solutions as faer's sparse LU.

#[path = "../../frontal/benches/models/mod.rs"]
mod models;

use frontal::{Options, Symbolic};

#[test]
fn solutions_agree_with_faer() {
    for model in [models::hex8([6, 7, 8]), models::quad8([20, 20]), models::bordered([5, 5, 5], 6)] {
        let n = model.pattern.len();
        let b = (0..n).map(|k| (k as f64).sin()).collect::<Vec<_>>();
        let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
        let mut factor = symbolic.new_factor();
        symbolic.factorise(&model.values, &mut factor).expect("a regular matrix");
        let mut x = b.clone();
        factor.solve(&mut x).expect("a regular matrix");

        let matrix = oracles::matrix(&model.pattern, &model.values);
        let mut y = b;
        oracles::solve(&oracles::factorise(&oracles::analyse(&matrix), &matrix).expect("a regular matrix"), &mut y);
        let size = y.iter().fold(0.0, |size: f64, y| size.max(y.abs()));
        let difference = x.iter().zip(&y).fold(0.0, |worst: f64, (x, y)| worst.max((x - y).abs()));
        assert!(difference < 1e-9 * size, "{}: {difference} of {size}", model.name);
    }
}
