//! Models built in code: the same as those of decks, with what is wrong told by name.

use asperity::deck;
use asperity::interface::laws::Coulomb;
use asperity::material::{Material, Rate, laws::Elastic};
use asperity::mesh::generate::Rectangle;
use asperity::mesh::{Cell, Mesh, Space};
use asperity::model::{ContactBuilder, Model, ModelBuilder, StepBuilder};
use asperity::solid::BodyOptions;
use asperity::solve::{RunOptions, Silent};
use asperity::system::State;
use asperity::tensor::Vec3;
use asperity::tool::{ProfileTool, shapes};
use std::sync::Arc;

fn steel() -> Arc<dyn Material> {
    Arc::new(Rate(Elastic::new(210e3, 0.3)))
}

fn block(cells: [usize; 2]) -> Mesh {
    Rectangle::new([0.0, 0.0], [4.0, 2.0], cells, Cell::named("quad8").unwrap()).mesh("block").unwrap()
}

fn plate() -> ProfileTool {
    let nodes = [Vec3::new(20.0, 0.0, 0.0), Vec3::new(-20.0, 0.0, 0.0)];
    ProfileTool::new("plate", vec![vec![shapes::find("line").unwrap().build(&nodes).unwrap()]], Vec3::zero())
}

fn pressed(surface: &str, target: &str, moved: &str) -> ModelBuilder {
    Model::builder(Space::PlaneStrain, block([4, 2]))
        .body("block", steel(), BodyOptions::default())
        .tool(plate())
        .contact(ContactBuilder::new("sole", surface, target, Coulomb::new(0.2)))
        .step(StepBuilder::new("press").count(2).displace(moved, [Some(0.0), Some(-0.01)]))
        .step(StepBuilder::new("slide").count(3).displace("plate", [Some(0.02)]))
}

fn end(model: &Model) -> State {
    let mut run = model.run(model.problem.initial_state());
    run.run(&RunOptions::default(), &mut Silent).unwrap();
    run.state
}

#[test]
fn code_and_deck_make_the_same_model() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [4, 2], cell = "quad8" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.block.material = "steel"
tool.plate.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]
contact.sole = { surface = "block.bottom", target = "plate", law.coulomb = { friction = 0.2 } }
[[step]]
name = "press"
increments = { count = 2 }
displacement."block.top" = { x = 0.0, y = -0.01 }
[[step]]
name = "slide"
increments = { count = 3 }
motion.plate = { x = 0.02 }
"#;
    let said = deck::build(deck::read(deck, "d.toml", ".".as_ref(), &[]).unwrap()).unwrap().model;
    let built = pressed("block.bottom", "plate", "block.top").build().unwrap();
    let (said, built) = (end(&said), end(&built));
    assert_eq!(said.u, built.u);
    assert_eq!(said.internal, built.internal);
    let shear: f64 = built.internal[built.internal.len() - 3..].iter().map(|force| force.abs()).sum();
    assert!(shear > 1.0, "the plate feels nothing: {shear}");
}

#[test]
fn two_bodies_touch() {
    let cell = Cell::named("quad4").unwrap();
    let mut mesh = block([4, 2]);
    mesh.append(Rectangle::new([1.0, 2.0], [3.0, 3.0], [3, 2], cell).mesh("punch").unwrap()).unwrap();
    let model = Model::builder(Space::PlaneStrain, mesh)
        .body("block", steel(), BodyOptions::default())
        .body("punch", steel(), BodyOptions::default())
        .contact(ContactBuilder::new("joint", "punch.bottom", "block.top", Coulomb::new(0.1)))
        .step(StepBuilder::new("press").count(2).hold("block.bottom").displace("punch.top", [Some(0.0), Some(-0.01)]))
        .build()
        .unwrap();
    let state = end(&model);
    let force = |group: &str| -> f64 {
        model.mesh.groups[group].nodes.iter().map(|&node| state.internal[model.problem.dofs.node(node) + 1]).sum()
    };
    let [below, above] = ["block.bottom", "punch.top"].map(force);
    assert!(below > 100.0 && (below + above).abs() < 1e-6 * below, "{below} and {above}");
}

#[test]
fn what_is_wrong_is_told_by_name_and_at_once() {
    let said = |builder: ModelBuilder| match builder.build() {
        Err(error) => error.to_string(),
        Ok(_) => String::new(),
    };
    let all = said(pressed("block.botom", "plat", "blok.top"));
    for near in ["'block.bottom'", "'plate'", "'block.top'"] {
        assert!(all.contains(&format!("did you mean {near}?")), "{all}");
    }
    let twice = pressed("block.bottom", "plate", "block.top")
        .step(StepBuilder::new("again").hold("block.top").displace("block.top_left", [Some(1.0)]));
    assert!(said(twice).contains("contradict"));
    let none = Model::builder(Space::PlaneStrain, block([1, 1]));
    assert!(said(none).contains("a body and a step"));
    let flat = Model::builder(Space::Solid, block([1, 1])).body("block", steel(), BodyOptions::default());
    assert!(said(flat).contains("dimension 2"));
    let still = pressed("block.bottom", "plate", "block.top").step(StepBuilder::new("now").duration(0.0));
    assert!(said(still).contains("duration"));
    let wrong = pressed("block", "plate", "block.top");
    assert!(said(wrong).contains("no sides"));
    let turned = pressed("block.bottom", "plate", "block.top")
        .step(StepBuilder::new("turn").displace("block.top", [None, None, Some(1.0)]));
    assert!(said(turned).contains("2 motions"));
}

#[test]
fn a_state_of_another_model_is_refused() {
    let (one, other) = (pressed("block.bottom", "plate", "block.top").build().unwrap(), {
        let builder = Model::builder(Space::PlaneStrain, block([6, 2]))
            .body("block", steel(), BodyOptions::default())
            .step(StepBuilder::new("press").hold("block.top"));
        builder.build().unwrap()
    });
    let mut run = one.run(other.problem.initial_state());
    assert!(run.advance(&mut Silent).unwrap_err().to_string().contains("another model"));
    let mut run = other.run(one.problem.initial_state());
    assert!(run.run(&RunOptions::default(), &mut Silent).unwrap_err().to_string().contains("another model"));
}
