//! Friction by a mean pressure with tools in space: tangents against differences, the weights of the mean, and a whole run.

mod cubes;
mod perturbed;
mod support;

use asperity::contact::PaperContact;
use asperity::interface::laws::OdenPires;
use asperity::system::{Dofs, State, Stencils, Term};
use cubes::{contact, motion};
use perturbed::{Random, check, commit, instant, state};
use support::{go_on, model, run};

/// Largest difference of an entry over the largest entry.
const ALLOWED: f64 = 1e-7;

/// Two by two cells, with friction by the mean pressure within a radius.
fn nonlocal(cell: &str, radius: f64) -> (PaperContact, Dofs) {
    contact((cell, 2), "quad", OdenPires { friction: 0.4, length: 0.05, radius })
}

/// Pressed by enough to be closed everywhere: the mean has no other bends.
fn pressed(dofs: &Dofs, random: &mut Random) -> Vec<f64> {
    let mut u = motion(dofs, random);
    (0..dofs.nodes()).for_each(|node| u[dofs.node(node) + 2] -= 0.12);
    u
}

#[test]
fn tangents_of_nonlocal_friction_are_exact() {
    for (cell, nodes) in [("hex8", 4), ("hex20", 8)] {
        let ((contact, dofs), mut random) = (nonlocal(cell, 0.8), Random(19));
        let start = state(vec![0.0; dofs.count()], contact.initial());
        let (mut met, mut bends, mut worst, mut most) = (0, 0, 0.0_f64, 0);
        for _ in 0..40 {
            let accepted = commit(&contact, &start, pressed(&dofs, &mut random)).unwrap();
            let attempt = contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
            let trial = pressed(&dofs, &mut random);
            let mut stencils = Stencils::default();
            attempt.stencils(&trial, &mut stencils).unwrap();
            most = stencils.list.iter().map(|stencil| stencil.len).max().unwrap();
            // Some lie too deep to be taken for contact.
            let Ok(results) = check(attempt.as_ref(), &trial) else { continue };
            for result in results.iter().filter(|result| result.smooth) {
                met += usize::from(result.branch > 0);
                // Where an increment begins to load the curvature jumps, once within the differences.
                let bent = result.error >= ALLOWED && result.error < 1e-2;
                bends += usize::from(bent);
                worst = if bent { worst } else { worst.max(result.error) };
            }
        }
        // Its own face, the tool, the three other faces.
        let exact = worst < ALLOWED && bends <= 1;
        assert!(met > 80 && most == 4 * 3 * nodes + 6 && exact, "{cell}: {met} {most} {bends} {worst:.1e}");
    }
}

/// The mean is that of the points around by the weights that the law states.
#[test]
fn nonlocal_friction_takes_the_mean() {
    let ((wide, dofs), (narrow, _)) = (nonlocal("hex8", 0.8), nonlocal("hex8", 1e-3));
    let u = pressed(&dofs, &mut Random(23));
    let records = |contact: &PaperContact| {
        let start = state(vec![0.0; dofs.count()], contact.initial());
        let first = commit(contact, &start, pressed(&dofs, &mut Random(29))).unwrap();
        let end = commit(contact, &first, u.clone()).unwrap();
        contact.records(&end.u, &end.histories[0])
    };
    let (mean, local) = (records(&wide), records(&narrow));
    let rest = wide.records(&vec![0.0; dofs.count()], &wide.initial());
    let mut apart = 0.0_f64;
    for i in 0..4 {
        let weight = |j: usize| {
            let part = ((rest[i].position - rest[j].position).norm() / 0.8).powi(2);
            if part < 1.0 { rest[j].area * (1.0 / (part - 1.0)).exp() } else { 0.0 }
        };
        let sum = |of: &dyn Fn(usize) -> f64| (0..4).map(|j| weight(j) * of(j)).sum::<f64>();
        let expected = sum(&|j| local[j].pressure) / sum(&|_| 1.0);
        assert!((mean[i].pressure / local[i].pressure - 1.0).abs() < 1e-12);
        let ratio = mean[i].shear / local[i].shear;
        assert!((ratio * local[i].pressure / expected - 1.0).abs() < 1e-10, "{i}: {ratio} {expected}");
        apart = apart.max((ratio - 1.0).abs());
    }
    assert!(apart > 0.01, "{apart}");
}

/// A block is pressed onto a ball and drawn along it.
const BLOCK: &str = r#"
version = 1
space = "solid"
mesh.part.block.box = { from = [-1.0, -1.0, 0.0], to = [1.0, 1.0, 1.0], cells = [4, 4, 2], cell = "hex8" }
material.rubber.neo_hookean = { shear = 3.0, bulk = 5.0 }
body.block.material = "rubber"
tool.ball.sphere = { center = [0.0, 0.0, -4.0], radius = 4.0 }
contact.base = { surface = "block.back", target = "ball", law.frictionless = {} }
solver.tolerance = 1e-9
[[step]]
name = "push"
increments.count = 8
displacement."block.front" = { x = 0.0, y = 0.0, z = -0.2 }
[[step]]
name = "draw"
increments.count = 8
displacement."block.front" = { x = 0.2, y = 0.1, z = -0.2 }
"#;

#[test]
fn neighbours_are_in_the_matrix_and_in_no_state() {
    let law = "contact.base.law={ oden_pires = { friction = 0.3, length = 0.01, radius = 0.6 } }";
    let [mean, local] = [law.to_owned(), law.replace("0.6", "0.0")].map(|law| {
        let model = model(BLOCK, &[&law]);
        let keep = run(&model);
        assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none()));
        keep.attempts.iter().map(|attempt| attempt.solutions()).sum::<usize>()
    });
    assert!(mean <= local + local / 2, "{mean} and {local} iterations");
    let model = model(BLOCK, &[law]);
    let bytes = |states: &[State]| states.iter().map(|s| postcard::to_stdvec(s).unwrap()).collect::<Vec<_>>();
    let whole = bytes(&run(&model).states);
    let begun = go_on(&model, model.problem.initial_state(), Some(10));
    let state: State = postcard::from_bytes(&bytes(&begun.states)[9]).unwrap();
    assert!(whole[10..] == bytes(&go_on(&model, state, None).states)[..]);
}
