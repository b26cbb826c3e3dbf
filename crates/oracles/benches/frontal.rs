//! Analysis, factorisation and solution of elastic bodies in the plane and in space, and of a body whose surface
//! couples to a rigid tool: `cargo bench -p oracles`.

#[path = "../../frontal/benches/models/mod.rs"]
mod models;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use frontal::{Options, Symbolic};
use std::time::Duration;

fn bodies() -> Vec<models::Model> {
    vec![
        models::quad4([8, 160]),
        models::quad8([28, 28]),
        models::quad8([90, 90]),
        models::quad8([134, 134]),
        models::hex8([11, 11, 11]),
        models::hex8([24, 24, 24]),
        models::hex8([32, 32, 32]),
        models::bordered([14, 14, 14], 6),
    ]
}

fn solver(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frontal");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    for model in bodies() {
        let symbolic = Symbolic::analyse(&model.pattern, &Options::default()).expect("a good pattern");
        let mut factor = symbolic.new_factor();
        let name = format!("{} ({} unknowns)", model.name, model.pattern.len());
        group.bench_with_input(BenchmarkId::new("analyse", &name), &model, |bencher, model| {
            bencher.iter(|| Symbolic::analyse(&model.pattern, &Options::default()));
        });
        group.bench_with_input(BenchmarkId::new("factorise", &name), &model, |bencher, model| {
            bencher.iter(|| symbolic.factorise(&model.values, &mut factor).expect("a regular matrix"));
        });
        group.bench_with_input(BenchmarkId::new("solve", &name), &model, |bencher, model| {
            let mut x = vec![1.0; model.pattern.len()];
            bencher.iter(|| factor.solve(&mut x).expect("a regular matrix"));
        });
    }
    group.finish();
}

criterion_group!(benches, solver);
criterion_main!(benches);
