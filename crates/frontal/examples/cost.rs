//! What one matrix costs: `cargo run --release -p frontal --example cost -- hex8 32`; with `symmetric` at the end its symmetric
//! part, as L U and as L D L^T.
//! The last line is the speed of a dense product on the same machine, in the same run.

#[path = "../benches/measure/mod.rs"]
mod measure;
#[path = "../benches/models/mod.rs"]
mod models;

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};
use frontal::{Options, Symbolic};
use measure::{Time, timed};

fn main() {
    let arguments = std::env::args().collect::<Vec<_>>();
    let size = |k: usize, default| arguments.get(k).and_then(|text| text.parse().ok()).unwrap_or(default);
    let (a, b) = (size(2, 16), size(3, size(2, 16)));
    let mut model = match arguments.get(1).map(String::as_str) {
        Some("quad4") => models::quad4([a, b]),
        Some("quad8") => models::quad8([a, b]),
        Some("bordered") => models::bordered([a, b, a], 6),
        _ => models::hex8([a, a, size(3, a)]),
    };
    println!("{}: {} unknowns, {} entries", model.name, model.pattern.len(), model.pattern.nonzeros());
    if arguments.last().is_some_and(|word| word == "symmetric") {
        model.symmetrise();
        cost(&model, true);
    }
    cost(&model, false);
    dense_product();
}

fn cost(model: &models::Model, symmetric: bool) {
    let mut options = Options::default();
    options.symmetric = symmetric;
    println!("{}", if symmetric { "L D L^T" } else { "L U" });
    let (symbolic, analysis) = timed(|| Symbolic::analyse(&model.pattern, &options));
    let symbolic = symbolic.expect("a good pattern");
    let cost = symbolic.prediction();
    println!("{cost:?}");
    println!("analysis       {}", show(analysis));
    let mut factor = symbolic.new_factor();
    for _ in 0..3 {
        let (report, time) = timed(|| symbolic.factorise(&model.values, &mut factor));
        report.expect("a regular matrix");
        println!("factorisation  {}, {:.1} Gflop/s per core", show(time), cost.flops * 1e-9 / time.processor);
    }
    let mut x = vec![1.0; model.pattern.len()];
    let (accuracy, time) = timed(|| factor.solve(&mut x));
    println!("solve          {}, {:?}", show(time), accuracy.expect("a regular matrix"));
    println!("peak           {:.0} MB", measure::peak() as f64 / 1024.0);
}

/// One thread's dense product of order 2000.
fn dense_product() {
    let n = 2000;
    let a = Mat::<f64>::from_fn(n, n, |i, j| (i + 2 * j) as f64);
    let mut c = Mat::<f64>::zeros(n, n);
    for _ in 0..3 {
        let (_, time) = timed(|| matmul(c.as_mut(), Accum::Add, a.as_ref(), a.as_ref(), -1.0, Par::Seq));
        println!("dense product  {}, {:.1} Gflop/s", show(time), 2e-9 * (n as f64).powi(3) / time.processor);
    }
}

fn show(time: Time) -> String {
    format!("{:.4} s of processor time, {:.4} s on the wall", time.processor, time.wall)
}
