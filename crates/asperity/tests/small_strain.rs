//! Bodies in small strain: linear however far they move, beside closed forms from which finite strain is far away.

mod support;

use asperity::deck::{build, read};
use asperity::model::Model;
use asperity::system::{Instant, State, Stencils, check_tangent};
use std::path::Path;
use support::{Keep, certificate, columns, model, run};

/// Spaces with cells of both degrees, and the formulation that suits.
const SPACES: [(&str, &str, &str); 7] = [
    ("plane-strain", "quad4", "formulation = \"f-bar\""),
    ("plane-strain", "quad8", "integration = \"reduced\""),
    ("plane-stress", "quad8", "integration = \"full\""),
    ("axisymmetric", "quad4", "formulation = \"f-bar\""),
    ("axisymmetric", "quad8", "integration = \"reduced\""),
    ("solid", "hex8", "formulation = \"f-bar\""),
    ("solid", "hex20", "integration = \"reduced\""),
];

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;
const YIELD: f64 = 50.0;
const HARDENING: f64 = 250.0;

/// A block of 2 by 4 (by 3) from radius 1 on, upon rollers, in small strain.
fn deck((space, cell, how): (&str, &str, &str), body: &str, steps: &str) -> String {
    let (part, behind) = match space {
        "solid" => ("box = { from = [1.0, 0.0, 0.0], to = [3.0, 4.0, 3.0], cells = [2, 3, 2]", ", \"block.back\""),
        _ => ("rectangle = { from = [1.0, 0.0], to = [3.0, 4.0], cells = [2, 3]", ""),
    };
    let left = if space == "axisymmetric" { "" } else { ", \"block.left\"" };
    format!(
        "version = 1
        space = \"{space}\"
        mesh.part.block.{part}, cell = \"{cell}\" }}
        material.soft.elastic = {{ young = {YOUNG}, poisson = {POISSON} }}
        material.metal.von_mises = {{ young = {YOUNG}, poisson = {POISSON}, yield_stress = {YIELD}, hardening = {HARDENING} }}
        material.rubber.neo_hookean = {{ shear = 1.0, bulk = 3.0 }}
        solver.tolerance = 1e-11
        body.block = {{ strain = \"small\", {how}, {body} }}
        [[step]]
        symmetry = [\"block.bottom\"{left}{behind}]
        {steps}"
    )
}

fn last(keep: &Keep) -> &State {
    keep.states.last().unwrap()
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |m, x| m.max(x.abs()))
}

/// Stress of all points of the only body.
fn stresses(model: &Model, state: &State) -> Vec<[f64; 6]> {
    let records = model.bodies[0].0.records(&state.u, &state.histories[0]);
    records.map(|r| std::array::from_fn(|i| r.state[i])).collect()
}

/// Twice the load moves twice as far, and the number of increments changes nothing, at strains of some tenths; all work is
/// stored, and the run says how far from small the strains are.
#[test]
fn an_elastic_body_is_linear() {
    for space in SPACES {
        let moved = |load: f64, count: usize| {
            let steps = format!(
                "increments.count = {count}
                traction.\"block.top\" = {{ x = {load}, y = {} }}",
                -2.0 * load
            );
            let model = model(&deck(space, "material = \"soft\"", &steps), &[]);
            let keep = run(&model);
            let gradient = certificate(&model, &keep).figure("small_strain").unwrap();
            (columns(&model, &keep), last(&keep).u.clone(), gradient)
        };
        let ((_, once, _), (_, twice, _), (columns, many, gradient)) =
            (moved(40.0, 1), moved(80.0, 1), moved(80.0, 13));
        let size = largest(twice.iter().copied());
        assert!(size > 0.5, "{space:?}: {size}");
        let apart = largest(once.iter().zip(&twice).map(|(a, b)| 2.0 * a - b));
        assert!(apart < 1e-12 * size, "{space:?}: twice the load is off by {apart:e}");
        let apart = largest(many.iter().zip(&twice).map(|(a, b)| a - b));
        assert!(apart < 1e-12 * size, "{space:?}: increments move it by {apart:e}");
        let (missing, external) = (&columns["energy.missing"], &columns["energy.external"]);
        // F-bar, finite or small, has a potential only where the centre has the mean strain of its cell.
        let potential = space.0 != "axisymmetric" || !space.2.contains("f-bar");
        assert!(
            !potential || missing[12].abs() < 1e-11 * external[12],
            "{space:?}: {} of {}",
            missing[12],
            external[12]
        );
        assert_eq!(columns["energy.residue"][12], 0.0);
        assert!((0.15..2.0).contains(&gradient), "{space:?}: {gradient}");
    }
}

/// Uniaxial stress: `u = eps L` on the free side too, `sigma = E eps`, at a compression of a half.
#[test]
fn a_bar_is_hookes() {
    let eps = -0.5;
    for space in SPACES {
        let steps = format!("increments.count = 2\ndisplacement.\"block.top\".y = {}", 4.0 * eps);
        let model = model(&deck(space, "material = \"soft\"", &steps), &[]);
        let keep = run(&model);
        let flat = space.0 == "plane-strain";
        let (young, ratio) =
            if flat { (YOUNG / (1.0 - POISSON * POISSON), POISSON / (1.0 - POISSON)) } else { (YOUNG, POISSON) };
        for stress in stresses(&model, last(&keep)) {
            assert!((stress[1] / (young * eps) - 1.0).abs() < 1e-12, "{space:?}: {stress:?}");
            let across = if flat { stress[2] - POISSON * stress[1] } else { stress[2] };
            assert!(stress[0].abs().max(across.abs()) < 1e-9, "{space:?}: {stress:?}");
        }
        let node = model.mesh.groups["block.right"].nodes[0];
        let x = model.mesh.points[node][0] - if space.0 == "axisymmetric" { 0.0 } else { 1.0 };
        let side = last(&keep).u[model.problem.dofs.node(node)] / (-ratio * eps * x);
        assert!((side - 1.0).abs() < 1e-12, "{space:?}: {side}");
    }
}

/// Lame's thick tube under an inner pressure of a third of Young's modulus, `u(a) = p a ((1 - 2 nu) + b^2/a^2) (1 + nu) /
/// (E (b^2/a^2 - 1))`; finite strain is far from it.
#[test]
fn a_tube_is_lames() {
    let pressure = 0.3 * YOUNG;
    let wall = |strain: &str| {
        let deck = format!(
            "version = 1
            space = \"axisymmetric\"
            mesh.part.tube.rectangle = {{ from = [1.0, 0.0], to = [2.0, 0.1], cells = [40, 1], cell = \"quad8\" }}
            material.soft.elastic = {{ young = {YOUNG}, poisson = {POISSON} }}
            body.tube = {{ material = \"soft\", integration = \"reduced\", strain = \"{strain}\" }}
            [[step]]
            increments.count = 10
            symmetry = [\"tube.bottom\", \"tube.top\"]
            traction.\"tube.left\" = {{ x = {pressure} }}"
        );
        let model = model(&deck, &[]);
        let node = model.mesh.groups["tube.left"].nodes[0];
        last(&run(&model)).u[model.problem.dofs.node(node)]
    };
    let exact = pressure * (1.0 - 2.0 * POISSON + 4.0) * (1.0 + POISSON) / (YOUNG * 3.0);
    let (small, finite) = (wall("small") / exact - 1.0, wall("finite") / exact - 1.0);
    assert!(small.abs() < 1e-6, "{small:e}");
    assert!(finite.abs() > 0.05, "{finite:e}");
}

/// `sigma = sigma_y + E H/(E + H) (eps - eps_y)` up to a strain of a half.
#[test]
fn a_metal_bar_flows_along_its_curve() {
    for space in SPACES.into_iter().filter(|space| space.0 != "plane-strain") {
        for count in [1, 7] {
            let steps = format!("increments.count = {count}\ndisplacement.\"block.top\".y = 2.0");
            let model = model(&deck(space, "material = \"metal\"", &steps), &[]);
            let keep = run(&model);
            let exact = YIELD + YOUNG * HARDENING / (YOUNG + HARDENING) * (0.5 - YIELD / YOUNG);
            for stress in stresses(&model, last(&keep)) {
                assert!((stress[1] / exact - 1.0).abs() < 1e-9, "{space:?} {count}: {stress:?} {exact}");
            }
        }
    }
}

/// Heat: a free body grows by `alpha T` and not by a logarithm of it; one that may not is under `3 K alpha T`, which heat
/// has supplied.
#[test]
fn heat_strains_by_alpha_t() {
    for space in SPACES {
        let body = "material = \"soft\", expansion = 2e-3";
        let hot = "increments.count = 3\ntemperature.block.value = 100.0";
        let free = model(&deck(space, body, hot), &[]);
        let keep = run(&free);
        let (node, flat) = (free.mesh.groups["block.top"].nodes[0], space.0 == "plane-strain");
        let grown = last(&keep).u[free.problem.dofs.node(node) + 1] / 4.0;
        let exact = if flat { 0.2 * (1.0 + POISSON) } else { 0.2 };
        assert!((grown - exact).abs() < 1e-12, "{space:?}: {grown}");
        for stress in stresses(&free, last(&keep)) {
            let along = if flat { -YOUNG * 0.2 } else { 0.0 };
            assert!((stress[2] - along).abs() + stress[1].abs() + stress[0].abs() < 1e-9, "{space:?}: {stress:?}");
        }
        if space.0 == "plane-stress" {
            continue;
        }
        let wall = match space.0 {
            "solid" => "displacement.\"block.front\".z = 0.0",
            "axisymmetric" => "displacement.\"block.left\".x = 0.0",
            _ => "",
        };
        let shut = "displacement.\"block.top\".y = 0.0\ndisplacement.\"block.right\".x = 0.0";
        let held = model(&deck(space, body, &format!("{hot}\n{shut}\n{wall}")), &[]);
        let keep = run(&held);
        for stress in stresses(&held, last(&keep)) {
            let exact = -YOUNG * 0.2 / (1.0 - 2.0 * POISSON);
            (0..3).for_each(|i| assert!((stress[i] / exact - 1.0).abs() < 1e-12, "{space:?}: {stress:?} {exact}"));
        }
        let columns = columns(&held, &keep);
        let (missing, external) = (columns["energy.missing"][2], columns["energy.external"][2]);
        assert!(external > 0.0 && (missing / external).abs() < 1e-12, "{space:?}: {missing} of {external}");
    }
}

/// Stresses at the beginning hold the loads that go with them, and add nothing to the stiffness.
#[test]
fn stresses_at_the_beginning_stay() {
    for space in SPACES {
        let body = "material = \"soft\", initial_stress.uniform = { yy = -200.0 }";
        let load = |y: f64, from: f64| {
            format!("traction.\"block.top\" = {{ y = {y}, amplitude = [[0.0, {from}], [1.0, 1.0]] }}")
        };
        let steps = format!(
            "increments.count = 1\n{}\n[[step]]\nincrements.count = 1\n{}",
            load(-200.0, 1.0),
            load(-300.0, 2.0 / 3.0)
        );
        let model = model(&deck(space, body, &steps), &[]);
        let keep = run(&model);
        assert!(largest(keep.states[0].u.iter().copied()) < 1e-13, "{space:?}");
        for stress in stresses(&model, last(&keep)) {
            assert!((stress[1] + 300.0).abs() < 1e-9 && stress[0].abs() < 1e-9, "{space:?}: {stress:?}");
        }
        let node = model.mesh.groups["block.top"].nodes[0];
        let sunk = last(&keep).u[model.problem.dofs.node(node) + 1] / 4.0;
        let young = if space.0 == "plane-strain" { YOUNG / (1.0 - POISSON * POISSON) } else { YOUNG };
        assert!((sunk / (-100.0 / young) - 1.0).abs() < 1e-12, "{space:?}: {sunk}");
    }
}

/// The tangent of a heated body with stresses at the beginning is exact, elastic and flowing.
#[test]
fn tangents_of_heated_bodies_are_exact() {
    for space in SPACES {
        for material in ["soft", "metal"] {
            let body = format!(
                "material = \"{material}\", expansion = 2e-3, initial_stress.uniform = {{ xx = -30.0, xy = 10.0 }}"
            );
            let model = model(&deck(space, &body, "temperature.block.value = 100.0"), &[]);
            let (body, state) = (&model.problem.terms[0], model.problem.initial_state());
            let at = Instant { step_time: 1.0, time: 1.0, dt: 1.0, ..Instant::default() };
            let attempt = body.attempt(&state, &state.histories[0], at).unwrap();
            let u: Vec<f64> = (0..state.u.len()).map(|i| 0.1 * (1.0 + 7.3 * i as f64).sin()).collect();
            let mut stencils = Stencils::default();
            attempt.stencils(&u, &mut stencils).unwrap();
            for (i, stencil) in stencils.list.iter().enumerate().take(3) {
                let own: Vec<f64> = stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect();
                let check = check_tangent(attempt.as_ref(), i, stencil, &own, &vec![1.0; own.len()]).unwrap();
                assert!(check.error < 1e-7, "{space:?} {material}: {:e}", check.error);
            }
        }
    }
}

/// What has no small strain is refused at its line.
#[test]
fn laws_without_small_strain_are_refused() {
    for (body, why) in [
        ("material = \"rubber\"", "use the law `elastic`"),
        ("material = \"soft\", rate = \"green-naghdi\"", "leave `rate` out"),
    ] {
        let text = deck(SPACES[0], body, "");
        let found = read(&text, "test.toml", Path::new(""), &[]).and_then(build).err().unwrap().render(false);
        assert!(found.contains(why) && found.contains("test.toml:8:"), "{found}");
    }
}
