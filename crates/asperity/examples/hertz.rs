//! Hertz's contact built in code: a rigid ball is pressed into an elastic body, and its force beside the closed form.
//! `cargo run --release -p asperity --example hertz`

use asperity::interface::laws::Coulomb;
use asperity::material::{Rate, laws::Elastic};
use asperity::mesh::generate::{Grade, Rectangle, Spacing};
use asperity::mesh::{Cell, Space};
use asperity::model::{ContactBuilder, Model, StepBuilder};
use asperity::output::{Parts, Source, global_columns};
use asperity::solid::BodyOptions;
use asperity::solve::Silent;
use asperity::tensor::Vec3;
use asperity::tool::{ProfileTool, shapes};
use std::sync::Arc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (young, poisson, radius, depth) = (1000.0, 0.3, 10.0_f64, 0.02);

    // 1. A mesh, finer towards the contact, whose radius will be sqrt(R d) = 0.45. Groups of it have names.
    let cell = Cell::named("quad8").expect("a registered cell");
    let x = Spacing::from(0.0).run(0.6, 20, Grade::UNIFORM).run(15.0, 16, Grade::Smooth);
    let y = Spacing::graded(-15.0, 0.0, 24, 1.0 / 80.0);
    let mesh = Rectangle { x, y, cell }.mesh("block")?;

    // 2. A tool is a shape; its material lies on the left of its profile.
    let nodes = [Vec3::zero(), Vec3::new(0.6 * radius, 0.2 * radius, 0.0), Vec3::new(radius, radius, 0.0)];
    let ball = ProfileTool::new("ball", vec![vec![shapes::find("arc")?.build(&nodes)?]], Vec3::zero());

    // 3. Bodies, contacts and steps by name; what is not said has the default that a deck has.
    let model = Model::builder(Space::Axisymmetric, mesh)
        .body("block", Arc::new(Rate(Elastic::new(young, poisson))), BodyOptions::default())
        .tool(ball)
        .contact(ContactBuilder::new("sole", "block.top", "ball", Coulomb::new(0.0)))
        .step(
            StepBuilder::new("press")
                .count(4)
                .displace("block.left", [Some(0.0)])
                .hold("block.bottom")
                .displace("ball", [None, Some(-depth)]),
        )
        .build()?;

    // 4. Increment by increment, and what there is to know at the end. The body is not a half-space: it is 3 % stiffer.
    let (parts, mut run) = (Parts::of(&model), model.run(model.problem.initial_state()));
    while run.advance(&mut Silent)?.is_some() {}
    let frame = Source { parts: &parts, state: &run.state, step: 0 }.gather()?;
    let force = global_columns(&frame, true).into_iter().find(|(name, _)| name == "contact.sole.thrust").expect("it").1;

    let hertz = 4.0 / 3.0 * young / (1.0 - poisson * poisson) * radius.sqrt() * depth.powf(1.5);
    println!("force {force:.3}, Hertz {hertz:.3}");
    assert!((force / hertz - 1.0).abs() < 0.04, "{force} beside {hertz}");
    Ok(())
}

#[test]
fn hertz() {
    main().unwrap();
}
