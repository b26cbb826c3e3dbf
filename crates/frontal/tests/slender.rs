//! Slender bodies that are held: pivots that are small and true.

#[path = "../benches/models/mod.rs"]
mod models;

use frontal::{Options, Symbolic};

/// A strip clamped at one end is `cells` times as long as it is thick: its softest motion meets `cells^-4` of its largest stiffness.
/// Its tip sinks under its weight by `3/2 (1 - nu^2) rho L^4/(E t^2)`, so that doubling it gives sixteen times as much but for shear
/// and the ends, of the order of `1/cells`.
#[test]
fn slender_strips_are_solved_to_rounding() {
    let deflection = |cells: usize, symmetric: bool| {
        let mut model = models::quad8([cells, 1]);
        model.symmetrise();
        let mut options = Options::default();
        options.symmetric = symmetric;
        let symbolic = Symbolic::analyse(&model.pattern, &options).expect("a good pattern");
        let mut factor = symbolic.new_factor();
        let report = symbolic.factorise(&model.values, &mut factor).expect("a strip that is held");
        assert!(report.perturbed.is_empty(), "{cells}: {report:?}");
        let mut x = (0..model.pattern.len()).map(|k| (k % 2) as f64).collect::<Vec<_>>();
        let accuracy = factor.solve(&mut x).expect("a solution");
        assert!(accuracy.backward_error < 1e-14, "{cells}: {accuracy:?}");
        x.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    for (cells, symmetric) in [(50, true), (500, true), (500, false), (750, true), (750, false)] {
        let ratio = deflection(2 * cells, symmetric) / deflection(cells, symmetric);
        assert!((ratio / 16.0 - 1.0).abs() < 0.01 + 1.0 / cells as f64, "{cells}: {ratio}");
    }
}
