//! Bodies that steps take away and bring back, against closed forms of a column in layers.

mod support;

use asperity::deck::{build, read};
use asperity::output::{Parts, QuantityPlace, Source};
use std::path::Path;
use support::{columns, model, run};

/// Two layers of height 1 and width 2 that share the nodes between them, without contraction, in small strain.
fn layers(body: &str, more: &str, steps: &str) -> String {
    format!(
        "version = 1
        space = \"plane-strain\"
        mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [2.0, 2.0], cells = [2, 4], cell = \"quad4\" }}
        group.low = {{ of = \"block\", y = [-0.1, 1.1] }}
        group.high = {{ of = \"block\", y = [0.9, 2.1] }}
        material.m.elastic = {{ young = 1e3, poisson = 0.0 }}
        body.low = {{ material = \"m\", strain = \"small\", formulation = \"standard\" {body} }}
        body.high = {{ material = \"m\", strain = \"small\", formulation = \"standard\" {body} }}
        solver.tolerance = 1e-11
        {more}
        [[step]]
        increments.count = 2
        symmetry = [\"block.left\", \"block.right\"]
        displacement.\"block.bottom\".y = 0.0
        {steps}"
    )
}

/// A plate upon the layers.
const PLATE: &str = "tool.plate.profile = [{ line = [[-9.0, 2.0], [9.0, 2.0]] }]
    contact.plate = { surface = \"block.top\", target = \"plate\", law.frictionless = {} }";

/// Displacements along y at each state of the nodes between the layers and at the top.
fn sunk(deck: &str) -> Vec<[f64; 2]> {
    let model = model(deck, &[]);
    let at = |y: f64| 2 * model.mesh.points.iter().position(|x| (x[1] - y).abs() < 1e-9).unwrap() + 1;
    let [middle, top] = [at(1.0), at(2.0)];
    run(&model).states.iter().map(|state| [state.u[middle], state.u[top]]).collect()
}

fn assert_near(found: &[[f64; 2]], expected: &[[f64; 2]]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        let near = |i: usize| (found[i] - expected[i]).abs() < 1e-11;
        assert!(near(0) && near(1), "{found:?} {expected:?}");
    }
}

/// A layer is dug away and filled in again: what it bore and weighed fades over the step, and it comes back without stress, under its
/// weight. Under 10 a unit of volume `u(1) = -(10 + 5)/E`, `u(2) = -20/E`.
#[test]
fn a_layer_is_dug_away_and_filled_in() {
    let deck = layers(
        ", density = 1.0",
        "",
        "gravity = { y = -10.0, amplitude = [[0.0, 0.0], [1.0, 1.0]] }
        [[step]]
        increments.count = 2
        remove = [\"high\"]
        [[step]]
        increments.count = 2
        add = [\"high\"]",
    );
    let expected =
        [[-0.0075, -0.01], [-0.015, -0.02], [-0.01, -0.02], [-0.005, -0.02], [-0.01, -0.0275], [-0.015, -0.035]];
    assert_near(&sunk(&deck), &expected);
}

/// What stays in the means at the nodes that both share is that of the layer which is left; its ends stay where they are.
#[test]
fn a_layer_that_is_gone_leaves_no_stress_at_shared_nodes() {
    let deck = layers("", "", "").replace(
        "symmetry = [\"block.left\", \"block.right\"]",
        "displacement.\"block.left\".x = 0.0\ndisplacement.\"block.right\".x = 0.02",
    ) + "\n[[step]]\nincrements.count = 2\nremove = [\"high\"]";
    let model = model(&deck, &[]);
    let states = run(&model).states;
    let parts = Parts::of(&model);
    for (state, step) in states.iter().zip([0, 0, 1, 1]).skip(1) {
        let frame = Source { parts: &parts, state, step }.gather().unwrap();
        for (name, expected) in [("cauchy_stress_averaged", 10.0), ("logarithmic_strain_averaged", 0.01)] {
            let quantity = frame.get(QuantityPlace::Node, name).unwrap();
            for node in model.mesh.groups["low"].cells.iter().flat_map(|&cell| model.mesh.cell(cell).nodes) {
                let value = quantity.at(*node)[0];
                assert!((value / expected - 1.0).abs() < 1e-9, "{name} {step} {node}: {value}");
            }
        }
    }
}

/// Under a pressure the layers are shortened by `p/E` each; the pressure goes with the layer that it acts on.
#[test]
fn a_load_goes_with_its_body() {
    let deck =
        layers("", "", "pressure.\"block.top\".value = 20.0\n[[step]]\nincrements.count = 1\nremove = [\"high\"]");
    assert_near(&sunk(&deck), &[[-0.01, -0.02], [-0.02, -0.04], [0.0, -0.04]]);
}

/// So does a contact, whose force fades.
#[test]
fn a_contact_goes_with_its_body() {
    let steps = "motion.plate.y = -0.02
        [[step]]
        increments.count = 2
        remove = [\"high\"]";
    let model = model(&layers("", PLATE, steps), &[]);
    let keep = run(&model);
    let force: Vec<f64> = columns(&model, &keep)["contact.plate.force.y"].iter().map(|force| force.abs()).collect();
    assert!(force[1] > 15.0 && force[2].abs() + force[3].abs() < 1e-9, "{force:?}");
    let middle = 2 * model.mesh.points.iter().position(|x| (x[1] - 1.0).abs() < 1e-9).unwrap() + 1;
    let sunk: Vec<f64> = keep.states.iter().map(|state| state.u[middle]).collect();
    assert!((sunk[2] / sunk[1] - 0.5).abs() < 1e-9 && sunk[3].abs() < 1e-12, "{sunk:?}");
}

/// A tool that is removed stays where it is, and its load ends with its contact: what it pressed comes back.
#[test]
fn a_loaded_tool_is_removed_in_one_line() {
    let steps = "load.plate.y = -40.0
        [[step]]
        increments.count = 2
        remove = [\"plate\"]";
    let sunk = sunk(&layers("", PLATE, steps));
    assert!((sunk[1][1] / -0.04 - 1.0).abs() < 1e-9 && (sunk[2][1] / -0.02 - 1.0).abs() < 1e-9, "{sunk:?}");
    assert!(sunk[3].iter().all(|u| u.abs() < 1e-12), "{sunk:?}");
}

/// A layer comes back without stress at the temperature that it then has, and expands from there.
#[test]
fn a_heated_layer_comes_back_without_stress() {
    let steps = |more: &str| {
        format!(
            "temperature.low.value = 1.0\ntemperature.high{more} = 1.0
            [[step]]
            increments.count = 1
            remove = [\"high\"]
            [[step]]
            increments.count = 2
            add = [\"high\"]
            [[step]]
            increments.count = 2
            temperature.low.value = 2.0\ntemperature.high{more} = 2.0"
        )
    };
    for (kind, strain) in [("standard", "small"), ("f-bar", "small"), ("incompatible", "finite")] {
        let body = format!("strain = \"{strain}\", formulation = \"{kind}\", expansion = 1e-4");
        let deck = layers("", "", &steps(".value")).replace("strain = \"small\", formulation = \"standard\"", &body);
        let found = sunk(&deck);
        let a = 1e-4;
        // Of a finite strain the parts multiply.
        let late = if strain == "small" { 0.5 * a } else { 0.5 * a / (1.0 + 0.5 * a) };
        for (state, [middle, top]) in
            [(0, [0.5, 1.0]), (1, [1.0, 2.0]), (2, [1.0, 2.0]), (3, [1.0, 2.0]), (4, [1.0, 2.0])]
        {
            assert!(
                (found[state][0] - middle * a).abs() < 1e-9 && (found[state][1] - top * a).abs() < 1e-9,
                "{found:?} {late}"
            );
        }
        assert!((found[6][0] - 2.0 * a).abs() < 1e-9 && (found[6][1] - 4.0 * a).abs() < 2e-8, "{kind}: {:?}", found[6]);
    }
}

/// An initial stress is of the beginning: the layer comes back without it. `E = 1000`.
#[test]
fn an_initial_stress_does_not_come_back() {
    let deck = layers(
        ", initial_stress.uniform.yy = -5.0",
        "",
        "pressure.\"block.top\" = { value = 5.0, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
        [[step]]
        increments.count = 2
        remove = [\"high\"]
        [[step]]
        increments.count = 2
        add = [\"high\"]",
    );
    let expected = [[0.0, 0.0], [0.0, 0.0], [0.0025, 0.0], [0.005, 0.0], [0.0025, -0.005], [0.0, -0.01]];
    assert_near(&sunk(&deck), &expected);
}

/// A layer that is glued to the other, on meshes that do not match, leaves and comes back, whichever of the two follows.
#[test]
fn a_glued_layer_is_dug_away_and_filled_in() {
    for (surface, target) in [("top", "base.bottom"), ("base.bottom", "top")] {
        let [surface, target] = [surface, target].map(|name| if name == "top" { "ground.top" } else { name });
        let deck = format!(
            "version = 1
            space = \"plane-strain\"
            mesh.part.ground.rectangle = {{ from = [0.0, 0.0], to = [2.0, 1.0], cells = [2, 2], cell = \"quad4\" }}
            mesh.part.base.rectangle = {{ from = [0.0, 1.0], to = [2.0, 2.0], cells = [3, 2], cell = \"quad4\" }}
            material.m.elastic = {{ young = 1e3, poisson = 0.0 }}
            body.ground = {{ material = \"m\", strain = \"small\", density = 1.0 }}
            body.base = {{ material = \"m\", strain = \"small\", density = 1.0 }}
            solver.tolerance = 1e-11
            [[tie]]
            surface = \"{surface}\"
            target = \"{target}\"
            [[step]]
            increments.count = 2
            symmetry = [\"ground.left\", \"ground.right\", \"base.left\", \"base.right\"]
            displacement.\"ground.bottom\".y = 0.0
            gravity = {{ y = -10.0, amplitude = [[0.0, 0.0], [1.0, 1.0]] }}
            [[step]]
            increments.count = 2
            remove = [\"base\"]
            [[step]]
            increments.count = 2
            add = [\"base\"]"
        );
        let expected =
            [[-0.0075, -0.01], [-0.015, -0.02], [-0.01, -0.02], [-0.005, -0.02], [-0.01, -0.0275], [-0.015, -0.035]];
        assert_near(&sunk(&deck), &expected);
    }
}

#[test]
fn what_cannot_be_removed_is_refused() {
    let refused = |body: &str, more: &str, steps: &str| {
        let text = layers(body, more, steps);
        read(&text, "test.toml", Path::new(""), &[]).and_then(build).err().unwrap().render(false)
    };
    let both = "body_force.block.y = -1.0\n[[step]]\nremove = [\"high\"]";
    assert!(refused("", "", both).contains("acts on a body that is removed and on others"));
    let twice = "[[step]]\nremove = [\"high\"]\n[[step]]\nremove = [\"high\"]";
    assert!(refused("", "", twice).contains("`high` is removed already"));
    assert!(refused("", "", "[[step]]\nremove = [\"block\"]").contains("it is no body"));
}
