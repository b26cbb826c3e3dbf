//! The drawing of a square cup in space: complete by default between swept tools, and what the way costs.

use crate::bench::{Bench, points, resultant};
use crate::{Case, Measured};
use asperity::Error;
use asperity::model::Model;
use asperity::system::State;

/// The case.
pub const CASE: Case = Case { name: "square-cup", measure };

/// The punch is the first contact of the deck.
const PUNCH: usize = 0;
/// Corners of the quarter of the blank: on its two planes of symmetry, and on the diagonal.
const CORNERS: [[f64; 2]; 3] = [[75.0, 0.0], [0.0, 75.0], [75.0, 75.0]];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let short = ["mesh.part.blank.box.cells=[10, 10, 2]", "step.2.motion.punch.z=-0.5", "step.2.duration=0.5"];
    let sets: Vec<String> = bench.pick(&short[..], &[]).iter().map(|&set| set.to_owned()).collect();
    let mut peak = 0.0_f64;
    let run = bench.follow("square.toml", &sets, |model, state| peak = peak.max(punch(model, state)))?;
    let [x, y, diagonal] = CORNERS.map(|corner| drawn_in(&run.model, &run.state, corner));
    let measured = [
        ("peak", peak),
        ("side", x),
        ("apart", (x - y).abs() / x),
        ("diagonal", diagonal),
        ("iterations", run.solutions() as f64),
        ("cuts", run.cuts() as f64),
    ];
    Ok(measured.map(|(key, value)| (key.to_owned(), value)).into())
}

/// Force of the punch on the quarter, downwards.
fn punch(model: &Model, state: &State) -> f64 {
    -resultant(&points(model, state, PUNCH))[2]
}

/// How far the node of the lower face that stood at a place has come towards the middle.
fn drawn_in(model: &Model, state: &State, [x, y]: [f64; 2]) -> f64 {
    let at = |node: usize| model.mesh.points[node];
    let far = |node: usize| (at(node)[0] - x).hypot(at(node)[1] - y).hypot(at(node)[2]);
    let node = (0..model.mesh.points.len()).min_by(|&a, &b| far(a).total_cmp(&far(b))).unwrap_or(0);
    let first = model.problem.dofs.node(node);
    -(state.u[first] * x + state.u[first + 1] * y) / x.hypot(y)
}
