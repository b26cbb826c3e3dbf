//! Rolling of strips in plane strain beside von Karman's theory of plane sections.

use crate::bench::{Bench, both_forms, points};
use crate::von_karman::Gap;
use crate::{Case, Measured};
use asperity::Error;
use asperity::contact::ContactRecord;
use asperity::output::figure::Chart;

/// The case.
pub const CASE: Case = Case { name: "rolling", measure };

/// A pass, and the neutral angle of the theory in degrees.
struct Pass {
    name: &'static str,
    gap: Gap,
    neutral: f64,
}

const fn pass(name: &'static str, thickness: [f64; 2], [radius, friction, neutral]: [f64; 3]) -> Pass {
    Pass { name, gap: Gap { thickness, radius, friction }, neutral }
}

const PASSES: [Pass; 4] = [
    pass("strip_20", [2.0, 1.6], [65.0, 0.1, 1.361]),
    pass("strip_30", [2.0, 1.4], [65.0, 0.1, 1.422]),
    pass("slab_20", [10.0, 8.0], [100.0, 0.2, 2.601]),
    pass("slab_30", [10.0, 7.0], [100.0, 0.3, 3.471]),
];

/// Time at which the pass has become steady; the last step ends at 4.
const STEADY: f64 = 3.4;

const TITLE: &str = "Pressure, and friction below; thin: von Karman";

fn measure(bench: &Bench) -> Result<Measured, Error> {
    both_forms(&["contact.nip.form=paper", "contact.nip.gauss=2"], |form| rolled(bench, form))
}

fn rolled(bench: &Bench, form: &[String]) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    for (picture, passes) in [("rolling-strips", &PASSES[..2]), ("rolling-slabs", &PASSES[2..])] {
        let mut chart = Chart::new(TITLE, "angle beyond the exit in degrees", "stress over 2k");
        for pass in &passes[..bench.pick(usize::from(picture == "rolling-strips"), 2)] {
            let (mean, arc, iterations) = pass.roll(bench, form)?;
            for (what, value) in ["force", "torque", "neutral", "pressure"].into_iter().zip(mean) {
                measured.push((format!("{}_{what}", pass.name), value));
            }
            measured.push((format!("{}_iterations", pass.name), iterations as f64));
            pass.draw(&mut chart, &arc);
        }
        if form.is_empty() {
            bench.draw(picture, &chart)?;
        }
    }
    Ok(measured)
}

impl Pass {
    fn sets(&self, bench: &Bench) -> Vec<String> {
        let [before, after] = self.gap.thickness.map(|h| 0.5 * h);
        let r = self.gap.radius;
        let arc = (2.0 * r * (before - after)).sqrt();
        let turn: f64 = bench.pick(9.0, 16.0);
        let (from, to) = (-turn.to_radians() * r - 1.5 * arc, 1.6 * arc);
        let (fine, rows, increments) = bench.pick((16.0, 3, [0.04, 0.04]), (25.0, 5, [0.02, 0.01]));
        let cells = ((to - from) / arc * fine).round();
        let (centre, top) = (before + r, before + 2.0 * r);
        let arcs = format!(
            "[{{ arc = [[0.0, {before:?}], [{r:?}, {centre:?}], [0.0, {top:?}]] }}, \
             {{ arc = [[0.0, {top:?}], [{:?}, {centre:?}], [0.0, {before:?}]] }}]",
            -r
        );
        let set = after - before;
        vec![
            format!("mesh.part.strip.rectangle.from=[{from:?}, 0.0]"),
            format!("mesh.part.strip.rectangle.to=[{to:?}, {before:?}]"),
            format!("mesh.part.strip.rectangle.cells=[{cells}, {rows}]"),
            format!("tool.roll.profile={arcs}"),
            format!("tool.roll.reference=[0.0, {centre:?}]"),
            format!("contact.nip.law.coulomb.friction={:?}", self.gap.friction),
            format!("step.touch.motion.roll.y={:?}", 0.2 * set),
            format!("step.set.motion.roll.y={set:?}"),
            format!("step.turn.motion.roll.y={set:?}"),
            format!("step.set.increments={{ first = 0.005, largest = {} }}", increments[0]),
            format!("step.turn.motion.roll.rotation={turn:?}"),
            format!("step.turn.increments={{ first = {0}, largest = {0} }}", increments[1]),
        ]
    }

    /// Means over the steady part of force, torque, neutral angle less that of the theory, and pressure there; the
    /// points of the arc at the end; and the iterations of the run.
    fn roll(&self, bench: &Bench, form: &[String]) -> Result<([f64; 4], Vec<ContactRecord>, usize), Error> {
        let (mut sum, mut count, mut arc) = ([0.0; 4], 0.0, Vec::new());
        let run = bench.follow("strip.toml", &[&self.sets(bench), form].concat(), |model, state| {
            if state.time < STEADY {
                return;
            }
            arc = points(model, state, 0).into_iter().filter(|p| p.pressure > 0.0).collect();
            arc.sort_by(|a, b| a.position[0].total_cmp(&b.position[0]));
            sum.iter_mut().zip(self.state(&arc)).for_each(|(sum, x)| *sum += x);
            count += 1.0;
        })?;
        Ok((sum.map(|sum| sum / count), arc, run.solutions()))
    }

    /// Degrees from the line through the axes of the rolls to the place of a point, against the way of the strip.
    fn angle(&self, place: f64) -> f64 {
        (-place / self.gap.radius).asin().to_degrees()
    }

    /// Draws pressure and friction along the way of the strip, and the pressure of the theory in thin lines.
    fn draw(&self, chart: &mut Chart, arc: &[ContactRecord]) {
        let ([before, after], style) = (self.gap.thickness, chart.series.len() / 3);
        let at = |y: &dyn Fn(&ContactRecord) -> f64| arc.iter().map(|p| [-self.angle(p.position[0]), y(p)]).collect();
        chart.line(format!("{before} to {after}"), at(&|p| p.pressure)).styled(style);
        chart.line("", at(&friction)).styled(style);
        let theory = self.gap.theory().pressure.iter().map(|&[a, p]| [-a.to_degrees(), p]).collect();
        chart.line("", theory).styled(style).thin();
    }

    fn state(&self, arc: &[ContactRecord]) -> [f64; 4] {
        let force: f64 = arc.iter().map(|p| -p.force()[1]).sum();
        // Only friction turns a circle about its centre.
        let torque: f64 = arc.iter().map(|p| friction(p) * p.area * self.gap.radius).sum();
        let [place, pressure] = neutral(arc);
        [force, torque, self.angle(place) - self.neutral, pressure]
    }
}

/// Friction on the strip along its way.
fn friction(point: &ContactRecord) -> f64 {
    point.shear * point.along[0].signum()
}

/// Where friction changes its direction, from forwards to backwards, and the pressure there.
fn neutral(arc: &[ContactRecord]) -> [f64; 2] {
    let Some(two) = arc.windows(2).find(|two| friction(&two[0]) > 0.0 && friction(&two[1]) <= 0.0) else {
        return [f64::NAN; 2];
    };
    let part = friction(&two[0]) / (friction(&two[0]) - friction(&two[1]));
    let between = |a: f64, b: f64| a + part * (b - a);
    [between(two[0].position[0], two[1].position[0]), between(two[0].pressure, two[1].pressure)]
}
