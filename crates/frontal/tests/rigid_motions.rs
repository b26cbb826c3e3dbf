//! A body that nothing holds: the six rigid motions are found and named.

#[path = "../benches/models/mod.rs"]
mod models;

use frontal::{FrontalError, Options, Singular, Symbolic};

fn free_block(cells: usize, symmetric: bool) -> Singular {
    let mut model = models::hex8([cells; 3]);
    model.release((cells + 1) * (cells + 1));
    model.symmetrise();
    let mut options = Options::default();
    options.symmetric = symmetric;
    let symbolic = Symbolic::analyse(&model.pattern, &options).expect("a good pattern");
    match symbolic.factorise(&model.values, &mut symbolic.new_factor()) {
        Err(FrontalError::Singular(singular)) => *singular,
        other => panic!("{other:?}"),
    }
}

/// What is left of a displacement when its best rigid motion is taken away, as a share of the whole.
fn deformation(cells: usize, u: &[f64]) -> f64 {
    let side = cells + 1;
    let mut motions = Vec::<Vec<f64>>::new();
    for k in 0..6 {
        let motion = (0..u.len()).map(|unknown| {
            let (node, i) = (unknown / 3, unknown % 3);
            let place = [node % side, node / side % side, node / (side * side)].map(|c| c as f64 - 0.5 * cells as f64);
            match k {
                0..3 if i == k => 1.0,
                0..3 => 0.0,
                _ if i == (k + 1) % 3 => -place[(k + 2) % 3],
                _ if i == (k + 2) % 3 => place[(k + 1) % 3],
                _ => 0.0,
            }
        });
        motions.push(motion.collect());
    }
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let mut rest = u.to_vec();
    for motion in &motions {
        let share = dot(&rest, motion) / dot(motion, motion);
        rest.iter_mut().zip(motion).for_each(|(rest, motion)| *rest -= share * motion);
    }
    (dot(&rest, &rest) / dot(u, u)).sqrt()
}

#[test]
fn a_free_block_has_six_rigid_motions() {
    for (cells, symmetric) in [(1, false), (5, false), (5, true), (12, true), (18, false)] {
        let singular = free_block(cells, symmetric);
        assert_eq!(singular.null_vectors.len(), 6, "{cells} cells: {singular}");
        for vector in &singular.null_vectors {
            assert!(deformation(cells, &vector.entries) < 1e-6, "{cells} cells: {}", vector.residual);
        }
    }
}
