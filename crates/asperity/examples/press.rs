//! A ring on a shaft that is too thick for it, increment by increment, and Lamé's pressure beside it.
//! `cargo run --release -p asperity --example press`

use asperity::deck::{build, read};
use asperity::output::{Parts, Source, global_columns};
use asperity::solve::Silent;
use std::collections::BTreeMap;

const DECK: &str = r#"
version = 1
space = "axisymmetric"
mesh.part.shaft.rectangle = { from = [0.0, 0.0], to = [20.02, 10.0], cells = [10, 5], cell = "quad8" }
mesh.part.ring.rectangle = { from = [20.0, 0.0], to = [40.0, 10.0], cells = [10, 6], cell = "quad8" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.shaft.material = "steel"
body.ring.material = "steel"
contact.fit = { surface = "ring.left", target = "shaft.right", overlap = "ramp", law.frictionless = {} }

[[step]]
name = "fit"
increments = { count = 4 }
displacement."shaft.bottom" = { y = 0.0 }
displacement."ring.bottom" = { y = 0.0 }
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // All that is wrong with a deck is told at once, with lines.
    let deck = read(DECK, "press.toml", ".".as_ref(), &[]).map_err(|found| found.render(false))?;
    let model = build(deck).map_err(|found| found.render(false))?.model;
    let parts = Parts::of(&model);

    // A run is the accepted state and the memory around it; the state can be cloned, kept, and run on from.
    let mut run = model.run(model.problem.initial_state());
    let mut pressure = 0.0;
    while let Some(attempt) = run.advance(&mut Silent)? {
        // Everything that there is to know of a state: quantities at nodes, cells, contact points, and of the whole.
        let frame = Source { parts: &parts, state: &run.state, step: attempt.step }.gather()?;
        let totals: BTreeMap<String, f64> = global_columns(&frame, parts.is_plane()).into_iter().collect();
        pressure = totals["contact.fit.thrust"] / totals["contact.fit.area"];
        println!(
            "time {:.2}: {} iterations, mean pressure {pressure:.2}",
            run.state.time,
            attempt.iterations.len() - 1
        );
    }

    // Lamé, for a ring on a solid shaft of the same material.
    let (young, excess, r, b) = (210e3, 0.02, 20.0_f64, 40.0_f64);
    let lame = young * excess * (b * b - r * r) / (2.0 * r * b * b);
    println!("Lamé: {lame:.2}");
    assert!((pressure / lame - 1.0).abs() < 0.005, "{pressure} beside {lame}");
    Ok(())
}

#[test]
fn lame() {
    main().unwrap();
}
