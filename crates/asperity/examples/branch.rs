//! One state, two futures: a block is pressed once and then dragged with two coefficients of friction.
//! `cargo run --release -p asperity --example branch`

use asperity::deck::{build, read};
use asperity::model::Model;
use asperity::output::{Parts, Source, global_columns};
use asperity::solve::{RunOptions, Silent};

const DECK: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [8, 4], cell = "quad8" }
material.rubber.neo_hookean = { shear = 1.0, bulk = 10.0 }
body.block.material = "rubber"
tool.floor.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]
contact.sole = { surface = "block.bottom", target = "floor", law.coulomb = { friction = 0.1 } }

[[step]]
name = "press"
increments.count = 4
displacement."block.top" = { x = 0.0, y = -0.2 }
[[step]]
name = "drag"
increments = { count = 10 }
displacement."block.top" = { x = 1.0 }
friction.sole.value = FRICTION
"#;

fn model(friction: f64) -> Result<Model, Box<dyn std::error::Error>> {
    let text = DECK.replace("FRICTION", &format!("{friction:?}"));
    let deck = read(&text, "branch.toml", ".".as_ref(), &[]).map_err(|found| found.render(false))?;
    Ok(build(deck).map_err(|found| found.render(false))?.model)
}

/// Runs on to the end; shear over normal force there.
fn ratio(model: &Model, from: asperity::system::State) -> Result<f64, Box<dyn std::error::Error>> {
    let (parts, mut run) = (Parts::of(model), model.run(from));
    run.run(&RunOptions::default(), &mut Silent)?;
    let frame = Source { parts: &parts, state: &run.state, step: model.problem.steps.len() - 1 }.gather()?;
    let totals = global_columns(&frame, parts.is_plane());
    let of = |name: &str| totals.iter().find(|(column, _)| column == name).expect("a contact").1;
    Ok(of("contact.sole.force.x").abs() / of("contact.sole.force.y"))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let models = [model(0.1)?, model(0.3)?];
    let mut pressed = models[0].run(models[0].problem.initial_state());
    pressed.run(&RunOptions { increments: Some(4) }, &mut Silent)?;
    for (model, friction) in models.iter().zip([0.1, 0.3]) {
        let found = ratio(model, pressed.state.clone())?;
        println!("friction {friction}: shear over normal force {found:.6}");
        assert!((found / friction - 1.0).abs() < 0.02, "{found}");
    }
    Ok(())
}

#[test]
fn ratios() {
    main().unwrap();
}
