//! A model far from the origin of the coordinates, as in those of a land survey, is that near it.

mod support;

use asperity::output::{BodyGrid, FIGURES, Limits, Parts, Source, tool_outlines};
use std::collections::BTreeMap;
use support::{certificate, columns, model, run};

/// Ground under its own weight and a round tool on it, turned about a point of its own; a strip of a material with axes around a point on
/// the ground; probes.
fn plane([x, y]: [f64; 2]) -> String {
    format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.ground.rectangle = {{ from = [{}, {}], to = [{}, {}], cells = [8, 4], cell = "quad4" }}
mesh.part.strip.rectangle = {{ from = [{}, {y}], to = [{}, {}], cells = [3, 1], cell = "quad8" }}
group.corner = {{ of = "ground", x = [{}, {}], y = [{}, {}] }}
material.soil.elastic = {{ young = 1e4, poisson = 0.3 }}
material.wood.orthotropic = {{ young_1 = 5e5, young_2 = 2e5, young_3 = 1e5, poisson_12 = 0.1, poisson_13 = 0.1, poisson_23 = 0.1, shear_12 = 5e4, shear_13 = 5e4, shear_23 = 5e4 }}
body.ground = {{ material = "soil", density = 2.0, initial_stress.geostatic = {{ surface = {y}, unit_weight = 20.0, k0 = 0.6 }} }}
body.strip = {{ material = "wood", density = 1.0, axes = {{ origin = [{}, {y}, 0.0], along = [0.0, 0.0, 1.0] }} }}
tool.roller = {{ reference = [{}, {}], profile = [{{ line = [[{}, {}], [{}, {}]] }}] }}
contact.foot = {{ surface = "strip.bottom", target = "ground.top", law.coulomb = {{ friction = 0.3 }} }}
contact.roller = {{ surface = "strip.top", target = "roller", law.coulomb = {{ friction = 0.2 }} }}
probe.inside = {{ at.point = [{}, {}], quantities = ["displacement"] }}
[[step]]
increments.count = 3
gravity = {{ y = -10.0 }}
symmetry = ["ground.left", "ground.right", "ground.bottom"]
motion.roller = {{ y = -0.125, rotation = 2.0 }}
"#,
        x - 4.0,
        y - 4.0,
        x + 4.0,
        y,
        x - 1.0,
        x + 1.0,
        y + 0.5,
        x - 4.0,
        x - 3.0,
        y - 4.0,
        y - 3.0,
        x - 8.0,
        x + 0.5,
        y + 1.0,
        x + 3.0,
        y + 0.5625,
        x - 3.0,
        y + 0.5625,
        x + 0.25,
        y - 0.75,
    )
}

/// A block under a ball and on a floor, in space.
fn solid([x, y, z]: [f64; 3]) -> String {
    format!(
        r#"
version = 1
space = "solid"
mesh.part.block.box = {{ from = [{x}, {y}, {z}], to = [{}, {}, {}], cells = [3, 3, 2], cell = "hex8" }}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block.material = "rubber"
tool.floor.plane = {{ at = [{x}, {y}, {z}], normal = [0.0, 0.0, 1.0], side = 40.0 }}
tool.ball.sphere = {{ center = [{}, {}, {}], radius = 1.0 }}
contact.floor = {{ surface = "block.back", target = "floor", law.coulomb = {{ friction = 0.5 }} }}
contact.ball = {{ surface = "block.front", target = "ball", law.coulomb = {{ friction = 0.1 }} }}
[[step]]
increments.count = 2
motion.ball = {{ z = -0.25 }}
"#,
        x + 2.0,
        y + 2.0,
        z + 1.0,
        x + 1.0,
        y + 1.0,
        z + 2.0,
    )
}

/// Iterations, the columns of the history, and where the nodes, the points of the tools and the worst places are.
fn told(deck: &str) -> (usize, BTreeMap<String, Vec<f64>>, Vec<[f64; 3]>) {
    let model = model(deck, &[]);
    let keep = run(&model);
    let (parts, state) = (Parts::of(&model), keep.states.last().unwrap());
    let source = Source { parts: &parts, state, step: 0 };
    let mut frame = source.gather().unwrap();
    let tools = tool_outlines(&source, &frame).points;
    let nodes = BodyGrid::new(&model.mesh).unwrap().at(&mut frame).points;
    let (certificate, limits) = (certificate(&model, &keep), Limits::default());
    let worst = FIGURES.iter().filter_map(|figure| certificate.worst(figure.name, &limits)?.position);
    let worst = worst.collect::<Vec<_>>();
    assert!(!worst.is_empty());
    (state.iterations, columns(&model, &keep), [nodes, tools, worst].concat())
}

fn is_near(far: &str, near: &str, by: [f64; 3]) {
    let (far, near) = (told(far), told(near));
    assert_eq!(far.0, near.0, "iterations");
    assert!(far.1.keys().eq(near.1.keys()));
    for (name, values) in far.1.iter().filter(|(name, _)| !name.contains("moment")) {
        let size = near.1[name].iter().fold(0.1_f64, |size, value| size.max(value.abs()));
        let moved = ["x", "y", "z"].iter().position(|axis| name.ends_with(&format!(".center.{axis}")));
        let moved = moved.map_or(0.0, |axis| by[axis]);
        let off = values.iter().zip(&near.1[name]).fold(0.0_f64, |off, (a, b)| off.max((a - b - moved).abs()));
        assert!(off <= 1e-8 * size, "{name}: {off} of {size}");
    }
    assert_eq!(far.2.len(), near.2.len());
    for (far, near) in far.2.iter().zip(&near.2) {
        let off = (0..3).map(|axis| (far[axis] - near[axis] - by[axis]).abs()).fold(0.0, f64::max);
        assert!(off < 1e-8, "{far:?} and {near:?}");
    }
}

#[test]
fn in_the_plane() {
    is_near(&plane([345_123.0, 5_812_345.0]), &plane([0.0, 0.0]), [345_123.0, 5_812_345.0, 0.0]);
}

#[test]
fn about_an_axis() {
    let axisymmetric = |deck: String| deck.replace("plane-strain", "axisymmetric");
    let deck = |y| axisymmetric(plane([8.0, y])).replace(", rotation = 2.0", "");
    is_near(&deck(-5e5), &deck(0.0), [0.0, -5e5, 0.0]);
}

#[test]
fn in_space() {
    let by = [-3e5, 2e6, 1e5];
    is_near(&solid(by), &solid([0.0; 3]), by);
}
