//! Temperatures that differ from node to node, against closed forms: what is linear in space strains a free body without
//! stress, a plate bends by `alpha T'`, a bar that is held bears the mean.

mod support;

use asperity::deck::{build, read};
use asperity::model::Model;
use asperity::tensor::Vec3;
use std::path::Path;
use support::{model, run};

const ALPHA: f64 = 1e-5;

/// A block of 4 by 1 (by 1) in small strain, and what a step says.
fn deck((space, cell, how): (&str, &str, &str), poisson: f64, step: &str) -> String {
    let part = match space {
        "solid" => "box = { from = [0.0, 0.0, 0.0], to = [4.0, 1.0, 1.0], cells = [3, 2, 2], ratio = [1.5, 1.0, 1.0]",
        _ => "rectangle = { from = [0.0, 0.0], to = [4.0, 1.0], cells = [3, 2], ratio = [1.5, 1.0]",
    };
    format!(
        "version = 1
        space = \"{space}\"
        mesh.part.block.{part}, cell = \"{cell}\" }}
        group.origin = {{ of = \"block\", x = [-0.01, 0.01], y = [-0.01, 0.01] }}
        material.m.elastic = {{ young = 1e3, poisson = {poisson} }}
        body.block = {{ material = \"m\", expansion = {ALPHA:e}, strain = \"small\", formulation = \"{how}\" }}
        solver.tolerance = 1e-11
        {step}"
    )
}

/// Pairs of node and temperature.
fn pairs(points: &[Vec3], temperature: impl Fn(&Vec3) -> f64) -> String {
    let pairs: Vec<String> =
        points.iter().enumerate().map(|(i, x)| format!("[{}, {:?}]", i + 1, temperature(x))).collect();
    format!("[{}]", pairs.join(", "))
}

/// The largest difference of displacements from exact ones, over the largest of these.
fn off(model: &Model, exact: impl Fn(&Vec3) -> [f64; 3]) -> f64 {
    let keep = run(model);
    let (u, per) = (&keep.states.last().unwrap().u, model.problem.dofs.per_node());
    let (mut off, mut size) = (0.0_f64, 0.0_f64);
    for (node, x) in model.mesh.points.iter().enumerate() {
        for (axis, exact) in exact(x).into_iter().enumerate().take(per) {
            off = off.max((u[per * node + axis] - exact).abs());
            size = size.max(exact.abs());
        }
    }
    off / size
}

const QUADRATIC: [(&str, &str, &str); 9] = [
    ("plane-strain", "quad8", "standard\", integration = \"reduced"),
    ("plane-stress", "quad8", "standard"),
    ("plane-stress", "tri6", "standard"),
    ("plane-strain", "quad8", "standard"),
    ("plane-strain", "quad9", "f-bar"),
    ("plane-strain", "tri6", "f-bar"),
    ("solid", "hex20", "standard"),
    ("solid", "hex20", "f-bar"),
    ("solid", "tet10", "standard"),
];

/// `T = c x`: `u = alpha c (x^2 - y^2 - z^2) / 2, alpha c x y, alpha c x z`, in plane strain `1 + nu` times as much.
#[test]
fn a_bar_grows_by_the_integral_of_its_temperature() {
    for (space, cell, how) in QUADRATIC {
        let behind = if space == "solid" { ", \"block.back\"" } else { "" };
        let step = "[[step]]
            increments.count = 1
            symmetry = [\"block.bottom\"BEHIND]
            displacement.origin.x = 0.0
            temperature.block.nodes = NODES"
            .replace("BEHIND", behind);
        let step = match space {
            "solid" => {
                step.replace("displacement.origin.x = 0.0", "displacement.corner.x = 0.0")
                    + "\n[group.corner]\nof = \"origin\"\nz = [-0.01, 0.01]"
            }
            _ => step,
        };
        let bare = model(&deck((space, cell, how), 0.3, &step.replace("NODES", "[[1, 1.0]]")), &[]);
        let nodes = pairs(&bare.mesh.points, |x| 3.0 * x[0]);
        let model = model(&deck((space, cell, how), 0.3, &step.replace("NODES", &nodes)), &[]);
        let a = 3.0 * ALPHA * if space == "plane-strain" { 1.3 } else { 1.0 };
        let z = |x: &Vec3| if space == "solid" { x[2] } else { 0.0 };
        let exact = |x: &Vec3| [0.5 * a * (x[0] * x[0] - x[1] * x[1] - z(x) * z(x)), a * x[0] * x[1], a * x[0] * z(x)];
        let off = off(&model, exact);
        assert!(off < 1e-10, "{space} {cell} {how}: {off:e}");
    }
}

/// `T = c z` in axial symmetry: `u = alpha c r z, alpha c (z^2 - r^2) / 2`.
#[test]
fn a_shaft_grows_by_the_integral_of_its_temperature() {
    let step = "[[step]]
        increments.count = 1
        displacement.origin.y = 0.0
        temperature.block.nodes = NODES";
    for case in [("axisymmetric", "quad8", "standard"), ("axisymmetric", "quad8", "f-bar")] {
        let bare = model(&deck(case, 0.3, &step.replace("NODES", "[[1, 1.0]]")), &[]);
        let nodes = pairs(&bare.mesh.points, |x| 3.0 * x[1]);
        let model = model(&deck(case, 0.3, &step.replace("NODES", &nodes)), &[]);
        let a = 3.0 * ALPHA;
        let off = off(&model, |x| [a * x[0] * x[1], 0.5 * a * (x[1] * x[1] - x[0] * x[0]), 0.0]);
        assert!(off < 1e-10, "{case:?}: {off:e}");
    }
}

/// A plate whose temperature runs through its thickness bends to the curvature `alpha T'`.
#[test]
fn a_plate_bends_by_the_gradient_of_its_temperature() {
    let step = "[[step]]
        increments.count = 1
        symmetry = [\"block.left\"]
        displacement.origin.y = 0.0
        temperature.block.nodes = NODES";
    for (case, curvature) in
        [(("plane-stress", "quad8", "standard"), 1.0), (("plane-strain", "quad8", "standard"), 1.3)]
    {
        let bare = model(&deck(case, 0.3, &step.replace("NODES", "[[1, 1.0]]")), &[]);
        let nodes = pairs(&bare.mesh.points, |x| 5.0 * x[1]);
        let model = model(&deck(case, 0.3, &step.replace("NODES", &nodes)), &[]);
        let curvature = curvature * 5.0 * ALPHA;
        let off = off(&model, |x| [curvature * x[0] * x[1], 0.5 * curvature * (x[1] * x[1] - x[0] * x[0]), 0.0]);
        assert!(off < 1e-10, "{case:?}: {off:e}");
    }
}

/// Between walls all around, without contraction: `s_xx = -E alpha (mean T)`, `s_yy = -E alpha T` of the place.
#[test]
fn a_bar_that_is_held_bears_the_mean() {
    let step = "[[step]]
        increments.count = 1
        symmetry = [\"block.left\", \"block.right\", \"block.bottom\", \"block.top\"]
        temperature.block.nodes = NODES";
    for case in [("plane-stress", "quad4", "standard"), ("plane-stress", "quad8", "standard")] {
        let bare = model(&deck(case, 0.0, &step.replace("NODES", "[[1, 1.0]]")), &[]);
        let nodes = pairs(&bare.mesh.points, |x| 3.0 * x[0]);
        let model = model(&deck(case, 0.0, &step.replace("NODES", &nodes)), &[]);
        let keep = run(&model);
        let state = keep.states.last().unwrap();
        for record in model.bodies[0].0.records(&state.u, &state.histories[0]) {
            assert!((record.state[0] / (-1e3 * ALPHA * 6.0) - 1.0).abs() < 1e-10, "{case:?}: {:?}", record.state);
            let local = -1e3 * ALPHA * 3.0 * record.reference[0];
            assert!(case.1 == "quad4" || (record.state[1] / local - 1.0).abs() < 1e-10, "{:?}", record.state);
        }
    }
}

/// A body's temperature, that of a group of its nodes along an amplitude, the body's again and the release of the group's.
#[test]
fn temperatures_of_groups_follow_their_steps() {
    let step = "[group.end]
        of = \"block.right\"
        y = [-0.1, 1.1]
        [[step]]
        increments.count = 1
        symmetry = [\"block.left\", \"block.bottom\"]
        temperature.block.value = 10.0
        [[step]]
        increments.count = 4
        temperature.end = { value = 30.0, amplitude = [[0.0, 0.0], [0.5, 1.5], [1.0, 1.0]] }
        [[step]]
        increments.count = 2
        release = [\"temperature.end\"]
        [[step]]
        increments.count = 1
        temperature.block.value = 4.0";
    let text = deck(("plane-stress", "quad4", "standard"), 0.0, step)
        .replace("cells = [3, 2], ratio = [1.5, 1.0]", "cells = [1, 1]");
    let model = model(&text, &[]);
    let node = model.mesh.points.iter().position(|x| x[0] > 3.9 && x[1] < 0.1).unwrap();
    let grown: Vec<f64> = run(&model).states.iter().map(|state| state.u[2 * node] / (4.0 * ALPHA)).collect();
    let expected = [10.0, 17.5, 25.0, 22.5, 20.0, 12.5, 5.0, 4.0];
    assert_eq!(grown.len(), expected.len());
    for (grown, expected) in grown.iter().zip(expected) {
        assert!((grown / expected - 1.0).abs() < 1e-10, "{grown} {expected}");
    }
}

#[test]
fn nodes_that_are_not_there_are_refused() {
    let refused = |step: &str| {
        let text =
            deck(("plane-stress", "quad4", "standard"), 0.0, &format!("[[step]]\nsymmetry = [\"block.left\"]\n{step}"));
        read(&text, "test.toml", Path::new(""), &[]).and_then(build).err().unwrap().render(false)
    };
    assert!(refused("temperature.block.nodes = [[99, 1.0]]").contains("there is no node 99 in `block`"));
    assert!(refused("temperature.block.nodes = [[1.5, 1.0]]").contains("there is no node 1.5 in `block`"));
    assert!(refused("temperature.block.nodes = []").contains("either `value` or `nodes`"));
    assert!(refused("temperature.block = { value = 1.0, nodes = [[1, 1.0]] }").contains("either `value` or `nodes`"));
}

/// Drawn while its temperature differs over its height, each point flows at the stress of its own temperature.
#[test]
fn each_point_flows_at_its_own_temperature() {
    let step = "[[step]]
        increments.count = 10
        symmetry = [\"block.left\", \"block.bottom\"]
        displacement.\"block.right\" = { x = 0.08 }
        temperature.block.nodes = NODES";
    let deck = |cell: &str, how: &str, strain: &str, nodes: &str| {
        deck(("plane-strain", cell, how), 0.3, &step.replace("NODES", nodes))
            .replace("elastic = { young = 1e3, poisson = 0.3 }", "von_mises_johnson_cook = { young = 1e3, poisson = 0.3, yield_stress = 2.0, strength = 1.0, exponent = 0.5, melting_temperature = 100.0 }")
            .replace("\"small\"", &format!("{strain:?}"))
    };
    let cases = [
        ("quad8", "standard", "finite"),
        ("quad8", "f-bar", "finite"),
        ("quad4", "f-bar", "finite"),
        ("quad8", "standard", "small"),
    ];
    for (cell, how, strain) in cases {
        let bare = model(&deck(cell, how, strain, "[[1, 1.0]]"), &[]);
        let nodes = pairs(&bare.mesh.points, |x| 60.0 * x[1]);
        let model = model(&deck(cell, how, strain, &nodes), &[]);
        let keep = run(&model);
        let state = keep.states.last().unwrap();
        let (mut hottest, mut coldest) = (f64::INFINITY, 0.0_f64);
        for record in model.bodies[0].0.records(&state.u, &state.histories[0]) {
            let s = asperity::tensor::Tensor2::from_voigt(std::array::from_fn(|i| record.state[i])).deviator();
            let flow = (1.5 * s.contract(s)).sqrt() / (2.0 + record.state[6].sqrt());
            // In first degree a cell has the temperature of its middle.
            let y =
                if cell == "quad4" { if record.reference[1] < 0.5 { 0.25 } else { 0.75 } } else { record.reference[1] };
            assert!((flow - (1.0 - 0.6 * y)).abs() < 1e-6 && record.state[6] > 0.01, "{cell} {how}: {flow} at {y}");
            (hottest, coldest) = (hottest.min(flow), coldest.max(flow));
        }
        assert!(hottest < 0.6 && coldest > 0.8, "{hottest} {coldest}");
    }
}
