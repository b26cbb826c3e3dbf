//! Ironing in space after Puso and Laursen: a stiff half-cylinder pressed into a soft block and dragged along it by more than
//! its imprint. The forces over the way of three meshes are compared.

use crate::bench::{Bench, sides};
use crate::{Case, Measured};
use asperity::Error;
use asperity::output::figure::Chart;

/// The case.
pub const CASE: Case = Case { name: "ironing-3d", measure };

/// Way from which on the die slides everywhere.
const SLIDING: f64 = 1.61;

/// Meshes: name, file of the die, cells of the block.
const MESHES: [[&str; 3]; 3] = [
    ["coarse", "coarse.msh", "[15, 4, 5]"],
    ["fine", "fine.msh", "[21, 5, 7]"],
    ["finest", "finest.msh", "[27, 6, 9]"],
];

/// Forces on the half block at a place of the drag.
struct Moment {
    way: f64,
    /// Down and along, the mean of what the points of the two sides bear.
    force: [f64; 2],
    /// Difference of the forces down of the two sides over their mean.
    apart: f64,
}

/// What one mesh gives.
struct Level {
    /// From the die pressed on.
    curve: Vec<Moment>,
    iterations: f64,
    cuts: f64,
}

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    let mut chart = Chart::new("Ironing in space", "way", "force down and along on half of the block");
    let mut coarser: Option<Level> = None;
    let points = level(bench, &MESHES[0], &["contact.track.form=paper".to_owned()])?;
    points.tell(&mut |what, value| measured.push((format!("points_{what}"), value)));
    for mesh in &MESHES[..bench.pick(1, 3)] {
        let level = level(bench, mesh, &[])?;
        let mut tell = |what: &str, value: f64| measured.push((format!("{}_{what}", mesh[0]), value));
        level.tell(&mut tell);
        if let Some(coarser) = &coarser {
            level.compare(coarser, &mut tell);
        }
        for (axis, what) in ["down", "along"].iter().enumerate() {
            let line = level.curve.iter().map(|at| [at.way, at.force[axis]]).collect();
            chart.line(format!("{what}, {}", mesh[0]), line);
        }
        coarser = Some(level);
    }
    bench.draw("ironing-3d", &chart)?;
    Ok(measured)
}

fn level(bench: &Bench, [_, die, block]: &[&str; 3], form: &[String]) -> Result<Level, Error> {
    let (whole, increments, press) = bench.pick((2.4, 12, 8), (4.0, 40, 10));
    let sets = [
        format!("step.press.increments.count={press}"),
        format!("step.slide.displacement.ends.x={whole:?}"),
        format!("step.slide.increments.count={increments}"),
        format!("mesh.file={die}"),
        format!("mesh.part.block.box.cells={block}"),
    ];
    let mut curve = Vec::new();
    let run = bench.follow("ironing.toml", &[&sets[..], form].concat(), |model, state| {
        let sides = sides(model, state);
        let on = |side: usize, axis: usize| sides[side].iter().map(|p| p.force()[axis]).sum::<f64>();
        let [down, along] = [2, 0].map(|axis| 0.5 * (on(0, axis) - on(1, axis)));
        if state.time > 1.0 - 1e-9 {
            let apart = (on(0, 2) + on(1, 2)).abs() / down.abs();
            curve.push(Moment { way: whole * (state.time - 1.0), force: [-down, along], apart });
        }
    })?;
    Ok(Level { curve, iterations: run.iterations(), cuts: run.cuts() as f64 })
}

impl Level {
    /// Mean of a figure while all slides.
    fn mean(&self, of: impl Fn(&Moment) -> f64) -> f64 {
        let sliding: Vec<f64> = self.curve.iter().filter(|at| at.way > SLIDING).map(of).collect();
        sliding.iter().sum::<f64>() / sliding.len() as f64
    }

    /// Half the range of a force while all slides over its mean.
    fn ripple(&self, axis: usize) -> f64 {
        let sliding = self.curve.iter().filter(|at| at.way > SLIDING).map(|at| at.force[axis]);
        let [least, most] = sliding.fold([f64::INFINITY, 0.0], |[l, m], force| [l.min(force), m.max(force)]);
        0.5 * (most - least) / self.mean(|at| at.force[axis])
    }

    fn tell(&self, tell: &mut impl FnMut(&str, f64)) {
        tell("pressed", self.curve[0].force[0]);
        tell("down", self.mean(|at| at.force[0]));
        tell("along", self.mean(|at| at.force[1]));
        tell("apart_pressed", self.curve[0].apart);
        tell("apart", self.mean(|at| at.apart));
        tell("ripple_down", self.ripple(0));
        tell("ripple_along", self.ripple(1));
        tell("iterations", self.iterations);
        tell("cuts", self.cuts);
    }

    /// Differences to a coarser mesh: of the means, and the largest over the way, both over the mean.
    fn compare(&self, coarser: &Self, tell: &mut impl FnMut(&str, f64)) {
        for (axis, what) in ["down", "along"].iter().enumerate() {
            let mean = self.mean(|at| at.force[axis]);
            tell(&format!("change_{what}"), (coarser.mean(|at| at.force[axis]) / mean - 1.0).abs());
            let gap = self.curve.iter().filter_map(|at| Some((coarser.force(at.way)?[axis] - at.force[axis]).abs()));
            tell(&format!("curve_{what}"), gap.fold(0.0, f64::max) / mean);
        }
    }

    /// The forces of the increment that ended at a place, if one did.
    fn force(&self, way: f64) -> Option<[f64; 2]> {
        self.curve.iter().find(|at| (at.way - way).abs() < 1e-9).map(|at| at.force)
    }
}
