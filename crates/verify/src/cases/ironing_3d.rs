//! Ironing in space after Puso and Laursen: a stiff half-cylinder pressed into a soft block and dragged along it by more than
//! its imprint. The forces of two meshes are compared.

use crate::bench::{Bench, points};
use crate::{Case, Measured};
use asperity::Error;

/// The case.
pub const CASE: Case = Case { name: "ironing-3d", measure };

/// Time of the drag from which on the die slides everywhere.
const SLIDING: f64 = 1.4;

/// What one mesh gives.
struct Level {
    /// Force down and along on the half block, pressed, and its mean while all slides.
    pressed: f64,
    down: f64,
    along: f64,
    /// Difference of the forces down of the two sides over their mean, pressed and while all slides.
    apart: [f64; 2],
    iterations: f64,
    cuts: f64,
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let coarse = level(bench, &[])?;
    let mut measured = vec![
        ("pressed".into(), coarse.pressed),
        ("down".into(), coarse.down),
        ("along".into(), coarse.along),
        ("apart_pressed".into(), coarse.apart[0]),
        ("apart".into(), coarse.apart[1]),
        ("iterations".into(), coarse.iterations),
        ("cuts".into(), coarse.cuts),
    ];
    if bench.pick(false, true) {
        let sets = ["mesh.file=fine.msh", "mesh.part.block.box.cells=[18, 4, 6]"].map(str::to_owned);
        let fine = level(bench, &sets)?;
        let change = |a: f64, b: f64| (a / b - 1.0).abs();
        measured.push(("change_pressed".into(), change(coarse.pressed, fine.pressed)));
        measured.push(("change_down".into(), change(coarse.down, fine.down)));
        measured.push(("change_along".into(), change(coarse.along, fine.along)));
        measured.push(("fine_iterations".into(), fine.iterations));
    }
    Ok(measured)
}

fn level(bench: &Bench, sets: &[String]) -> Result<Level, Error> {
    let (mut pressed, mut sliding) = ([0.0; 2], Vec::new());
    let steps = bench.pick(20, 40);
    let sets: Vec<String> = sets.iter().cloned().chain([format!("step.2.increments.count={steps}")]).collect();
    let run = bench.follow("ironing.toml", &sets, |model, state| {
        let on = |side: usize, axis: usize| points(model, state, side).iter().map(|p| p.force()[axis]).sum::<f64>();
        // The mean of what the points of the two sides bear, down and along, and how far they differ.
        let [down, along] = [2, 0].map(|axis| 0.5 * (on(0, axis) - on(1, axis)));
        let (down, apart) = (-down, (on(0, 2) + on(1, 2)).abs() / down.abs());
        if state.time < 1.0 + 1e-9 {
            pressed = [down, apart];
        } else if state.time > SLIDING {
            sliding.push([down, along, apart]);
        }
    })?;
    let mean = |k: usize| sliding.iter().map(|force: &[f64; 3]| force[k]).sum::<f64>() / sliding.len() as f64;
    let (pressed, apart) = (pressed[0], [pressed[1], mean(2)]);
    Ok(Level { pressed, down: mean(0), along: mean(1), apart, iterations: run.iterations(), cuts: run.cuts() as f64 })
}
