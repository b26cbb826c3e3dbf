//! What one matrix costs: `cargo run --release -p frontal --example cost -- hex8 32`.
//! Times are processor time, user and system.

#[path = "../benches/models/mod.rs"]
mod models;

use frontal::{Options, Symbolic};

fn main() {
    let arguments = std::env::args().collect::<Vec<_>>();
    let size = |k: usize, default| arguments.get(k).and_then(|text| text.parse().ok()).unwrap_or(default);
    let (a, b) = (size(2, 16), size(3, size(2, 16)));
    let model = match arguments.get(1).map(String::as_str) {
        Some("quad4") => models::quad4([a, b]),
        Some("quad8") => models::quad8([a, b]),
        Some("bordered") => models::bordered([a, b, a], 6),
        _ => models::hex8([a, a, size(3, a)]),
    };
    let n = model.pattern.len();
    println!("{}: {n} unknowns, {} entries", model.name, model.pattern.nonzeros());
    let (symbolic, analysis) = timed(|| Symbolic::analyse(&model.pattern, &Options::default()));
    let symbolic = symbolic.expect("a good pattern");
    let cost = symbolic.prediction();
    println!("{cost:?}");
    println!("analysis {analysis:.3} s");
    let mut factor = symbolic.new_factor();
    for _ in 0..3 {
        let (report, time) = timed(|| symbolic.factorise(&model.values, &mut factor));
        report.expect("a regular matrix");
        println!("factorisation {time:.4} s, {:.1} Gflop/s", cost.flops * 1e-9 / time);
    }
    let mut x = vec![1.0; n];
    let (accuracy, time) = timed(|| factor.solve(&mut x));
    println!("solve {time:.4} s, {:?}", accuracy.expect("a regular matrix"));
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = std::time::Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}
