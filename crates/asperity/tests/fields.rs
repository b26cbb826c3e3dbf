//! What acts on all of a body: its weight, stresses before the first increment, temperature. Each against its closed
//! form, in every space.

mod support;

use asperity::model::Model;
use asperity::system::{Instant, State, Stencils, check_tangent};
use support::{Keep, columns, model, run};

/// A block of 2 by 10 (by 3) with rollers on the left, below and behind, and with `walls` on the other sides too.
fn block((space, cell): (&str, &str), walls: bool, body: &str, step: &str) -> Model {
    let (part, sides, others) = match space {
        "solid" => ("box = { from = [0.0, 0.0, 0.0], to = [2.0, 10.0, 3.0], cells = [2, 4, 2]", BEHIND, ALL_AROUND),
        _ => ("rectangle = { from = [0.0, 0.0], to = [2.0, 10.0], cells = [2, 4]", "", ", \"block.right\""),
    };
    let others = if walls { others } else { "" };
    let deck = format!(
        "version = 1
        space = \"{space}\"
        mesh.part.block.{part}, cell = \"{cell}\" }}
        material.ground.elastic = {{ young = 2e4, poisson = 0.25 }}
        material.rubber.neo_hookean = {{ shear = 1.0, bulk = 3.0 }}
        material.steel.von_mises = {{ young = 2e4, poisson = 0.25, yield_stress = 1e3, hardening = 100.0 }}
        solver.tolerance = 1e-10
        body.block = {{ {body} }}
        [[step]]
        increments.count = 1
        symmetry = [\"block.left\", \"block.bottom\"{sides}{others}]
        {step}"
    );
    model(&deck, &[])
}

const BEHIND: &str = ", \"block.back\"";
const ALL_AROUND: &str = ", \"block.right\", \"block.front\"";

/// Spaces with cells of both degrees, and the formulation that suits.
const SPACES: [(&str, &str, &str); 6] = [
    ("plane-strain", "quad4", "formulation = \"f-bar\""),
    ("plane-strain", "quad8", "integration = \"reduced\""),
    ("axisymmetric", "quad4", "formulation = \"f-bar\""),
    ("axisymmetric", "quad8", "integration = \"full\""),
    ("solid", "hex8", "formulation = \"f-bar\""),
    ("solid", "hex20", "integration = \"reduced\""),
];

fn last(keep: &Keep) -> &State {
    keep.states.last().unwrap()
}

/// The displacement along y of the nodes of a group; all alike.
fn lift(model: &Model, state: &State, group: &str) -> f64 {
    let nodes = &model.mesh.groups[group].nodes;
    let along: Vec<f64> = nodes.iter().map(|&node| state.u[model.problem.dofs.node(node) + 1]).collect();
    let spread = along.iter().fold(0.0_f64, |m, u| m.max((u - along[0]).abs()));
    assert!(spread <= 1e-9 * along[0].abs() + 1e-14, "{group}: {along:?}");
    along[0]
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Stress of all points of the only body.
fn stresses(model: &Model, state: &State) -> Vec<(f64, [f64; 6])> {
    let records = model.bodies[0].0.records(&state.u, &state.histories[0]);
    records.map(|r| (r.reference[1], std::array::from_fn(|i| r.state[i]))).collect()
}

/// `u = -rho g H^2 / (2 M)` at the top of a confined column, `M = E (1 - nu)/((1 + nu)(1 - 2 nu)) = 1.2 E`.
#[test]
fn a_column_sinks_under_its_weight() {
    for (space, cell, how) in SPACES {
        let body = format!("material = \"ground\", {how}, density = 2e-6");
        let model = block((space, cell), true, &body, "gravity.y = -10.0");
        let exact = -2e-5 * 100.0 / (2.0 * 24e3);
        let error = lift(&model, last(&run(&model)), "block.top") / exact - 1.0;
        // A mean strain of 4e-9 is small.
        assert!(error.abs() < 1e-7, "{space} {cell}: {error:e}");
    }
}

/// Ground that carries its weight and a surcharge from the beginning stays where it is, and sinks under more.
#[test]
fn geostatic_stress_is_in_equilibrium() {
    let step = "gravity.y = -10.0
        pressure.\"block.top\" = { value = 30.0, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
        [[step]]
        increments.count = 1
        pressure.\"block.top\" = { value = 30.06 }";
    for (space, cell, how) in SPACES {
        let body = format!(
            "material = \"ground\", {how}, density = 2.0,
            initial_stress.geostatic = {{ surface = 10.0, surcharge = 30.0, unit_weight = 20.0, k0 = 0.6 }}"
        );
        let model = block((space, cell), true, &body.replace('\n', " "), step);
        let keep = run(&model);
        assert!(largest(&keep.states[0].u) < 1e-13, "{space} {cell}: {:e}", largest(&keep.states[0].u));
        for (y, stress) in stresses(&model, &keep.states[0]) {
            let vertical = -(30.0 + 20.0 * (10.0 - y));
            let exact = [0.6 * vertical, vertical, 0.6 * vertical, 0.0, 0.0, 0.0];
            (0..6).for_each(|i| assert!((stress[i] - exact[i]).abs() < 1e-9, "{space} {cell} at {y}: {stress:?}"));
        }
        // The stresses themselves add a hundredth to the stiffness.
        let sunk = lift(&model, &keep.states[1], "block.top") / (-0.06 * 10.0 / 24e3);
        assert!((sunk - 1.0).abs() < 0.02, "{space} {cell}: {sunk}");
    }
}

/// Uniform stress against the loads that hold it, in every component; the energy stored at the beginning counts as
/// supplied, so that none is missing when more is done.
#[test]
fn uniform_stress_is_in_equilibrium_and_keeps_its_energy() {
    let model = model(UNIFORM, &[]);
    let keep = run(&model);
    assert!(largest(&keep.states[0].u) < 1e-14, "{:e}", largest(&keep.states[0].u));
    for (_, stress) in stresses(&model, &keep.states[0]) {
        let exact = [-3.0, -5.0, -2.0, 1.0, 0.5, -0.7];
        (0..6).for_each(|i| assert!((stress[i] - exact[i]).abs() < 1e-12, "{stress:?}"));
    }
    let columns = columns(&model, &keep);
    let external = &columns["energy.external"];
    let done = external[external.len() - 1] - external[0];
    assert!(external[0] > 0.0 && done > external[0]);
    let missing = largest(&columns["energy.missing"]) / done;
    assert!(missing < 1e-3, "{missing:e} of what was done is missing");
}

const UNIFORM: &str = r#"
version = 1
space = "solid"
mesh.part.block.box = { from = [0.0, 0.0, 0.0], to = [2.0, 1.0, 3.0], cells = [2, 2, 2], cell = "hex8" }
material.ground.elastic = { young = 2e4, poisson = 0.25 }
body.block = { material = "ground", initial_stress.uniform = { xx = -3.0, yy = -5.0, zz = -2.0, xy = 1.0, yz = 0.5, xz = -0.7 } }
[[step]]
increments.count = 1
displacement."block.left" = { x = 0.0, y = 0.0, z = 0.0 }
[step.traction]
"block.right" = { x = -3.0, y = 1.0, z = -0.7, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
"block.top" = { x = 1.0, y = -5.0, z = 0.5, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
"block.bottom" = { x = -1.0, y = 5.0, z = -0.5, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
"block.front" = { x = -0.7, y = 0.5, z = -2.0, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
"block.back" = { x = 0.7, y = -0.5, z = 2.0, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
[[step]]
increments.count = 4
traction."block.right" = { x = -60.0, y = 1.0, z = -0.7 }
"#;

/// Free thermal expansion is `1 + alpha T`, without stress; cooled down again the body is what it was.
#[test]
fn a_free_body_grows_with_its_temperature() {
    let step = "temperature.block.value = 20.0
        [[step]]
        increments.count = 2
        release = [\"temperature.block\"]";
    let flat = ("plane-stress", "quad8", "integration = \"reduced\"");
    for (space, cell, how) in SPACES.into_iter().filter(|space| space.0 != "plane-strain").chain([flat]) {
        for material in ["ground", "rubber", "steel"] {
            let body = format!("material = \"{material}\", {how}, expansion = 1e-3");
            let model = block((space, cell), false, &body, step);
            let keep = run(&model);
            let what = format!("{space} {cell} {material}");
            let grown = lift(&model, &keep.states[0], "block.top");
            assert!((grown - 0.2).abs() < 1e-9, "{what}: {grown}");
            let stress =
                stresses(&model, &keep.states[0]).iter().flat_map(|s| s.1).fold(0.0_f64, |m, s| m.max(s.abs()));
            assert!(stress < 1e-5, "{what}: {stress:e}");
            assert!(largest(&last(&keep).u) < 1e-8, "{what}: {:e}", largest(&last(&keep).u));
        }
    }
}

/// A body that may not grow at all is under `p = K ln(1 + alpha T)^3`, and what heat supplied is stored.
#[test]
fn a_confined_body_is_pressed_by_its_temperature() {
    let step = "displacement.\"block.top\".y = 0.0\ntemperature.block.value = 100.0";
    for (space, cell, how) in SPACES {
        let body = format!("material = \"ground\", {how}, expansion = 1e-3");
        let model = block((space, cell), true, &body, step);
        let keep = run(&model);
        let exact = -3.0 * 2e4 / (3.0 * (1.0 - 2.0 * 0.25)) * 1.1_f64.ln();
        for (_, stress) in stresses(&model, last(&keep)) {
            // One increment: the midpoint rule of a strain of 0.095.
            (0..3).for_each(|i| assert!((stress[i] / exact - 1.0).abs() < 1e-3, "{space} {cell}: {stress:?} {exact}"));
        }
        let columns = columns(&model, &keep);
        let (missing, external) = (columns["energy.missing"][0], columns["energy.external"][0]);
        assert!(external > 0.0 && (missing / external).abs() < 2e-3, "{space} {cell}: {missing} of {external}");
    }
}

/// In plane strain a free block is held across the plane only: `s_zz = -E ln(1 + alpha T)`, and it grows in the plane by
/// `(1 + alpha T)^(1 + nu)`.
#[test]
fn a_long_body_is_held_along_its_length() {
    let step = "temperature.block = { value = 50.0 }
        [[step]]
        increments.count = 40
        temperature.block = { value = 100.0 }";
    for (cell, how) in [("quad4", "formulation = \"f-bar\""), ("quad8", "integration = \"reduced\"")] {
        let body = format!("material = \"ground\", {how}, expansion = 1e-3");
        let model = block(("plane-strain", cell), false, &body, step);
        let keep = run(&model);
        let grown = lift(&model, last(&keep), "block.top") / 10.0 + 1.0;
        assert!((grown / 1.1_f64.powf(1.25) - 1.0).abs() < 1e-4, "{cell}: {grown}");
        for (_, stress) in stresses(&model, last(&keep)) {
            assert!((stress[2] / (-2e4 * 1.1_f64.ln()) - 1.0).abs() < 1e-3, "{cell}: {stress:?}");
            assert!(stress[0].abs() + stress[1].abs() + stress[3].abs() < 1e-3, "{cell}: {stress:?}");
        }
    }
}

/// The tangent of a heated, prestressed body is exact.
#[test]
fn the_tangent_of_a_heated_body_is_exact() {
    for (space, cell, how) in SPACES {
        for material in ["ground", "steel"] {
            let body = format!(
                "material = \"{material}\", {how}, expansion = 2e-3, initial_stress.uniform = {{ xx = -90.0, xy = 40.0 }}"
            );
            let model = block((space, cell), false, &body, "temperature.block.value = 100.0");
            let (body, state) = (&model.problem.terms[0], model.problem.initial_state());
            let at = Instant { step_time: 1.0, time: 1.0, dt: 1.0, ..Instant::default() };
            let attempt = body.attempt(&state, &state.histories[0], at).unwrap();
            let u: Vec<f64> = (0..state.u.len()).map(|i| 0.1 * (1.0 + 7.3 * i as f64).sin()).collect();
            let mut stencils = Stencils::default();
            attempt.stencils(&u, &mut stencils).unwrap();
            for (i, stencil) in stencils.list.iter().enumerate().take(3) {
                let own: Vec<f64> = stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect();
                let check = check_tangent(attempt.as_ref(), i, stencil, &own, &vec![1.0; own.len()]).unwrap();
                assert!(check.error < 1e-7, "{space} {cell} {material}: {:e}", check.error);
            }
        }
    }
}

/// A bar that yields under a growing load leaps where its increments are long, and says so; short ones do not.
#[test]
fn an_increment_that_leaps_is_told() {
    let leap = |count: usize| {
        let deck = format!(
            "version = 1
            space = \"plane-stress\"
            mesh.part.bar.rectangle = {{ from = [0.0, 0.0], to = [4.0, 1.0], cells = [1, 1], cell = \"quad4\" }}
            material.steel.von_mises = {{ young = 1e4, poisson = 0.3, yield_stress = 1.0, hardening = 4.0 }}
            body.bar.material = \"steel\"
            [[step]]
            increments.count = {count}
            symmetry = [\"bar.left\", \"bar.bottom\"]
            traction.\"bar.right\" = {{ x = 1.5 }}"
        );
        let keep = run(&model(&deck, &[]));
        assert_eq!(keep.states.len(), count);
        keep.states.iter().fold(0.0, |most: f64, state| most.max(state.leap))
    };
    // A true stress of 1 + 4 e over an area of exp(-e) bears 1.5 at e = 0.215; the last of three increments goes there.
    let one = leap(3);
    assert!((0.2..0.26).contains(&one), "{one}");
    assert_eq!(leap(300), 0.0);
}
