//! Whole runs with averaged normals: the force along a surface of first degree ripples less as a die passes its edges;
//! the number of threads and a restart change no bit; they serve self-contact, two passes and augmentation.

mod support;

use asperity::system::State;
use std::collections::BTreeMap;
use support::{all_bytes, bytes, columns, go_on, model, run, with_threads};

/// Half of a wheel of flat facets against a round die that is pressed into it and turned about its axle: on a round
/// wheel, without friction, nothing would hold the die back.
const WHEEL: &str = r#"
version = 1
space = "plane-strain"
mesh.part.wheel.annulus = { from = [0.5, 180.0], to = [1.0, 360.0], cells = [4, 18], cell = "quad4" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.wheel.material = "rubber"
tool.die = { profile = [{ arc = [[0.3, -1.2], [0.0, -0.95], [-0.3, -1.2]] }], reference = [0.0, 0.0] }
contact.track = { surface = "wheel.outer", target = "die", gauss = 3, law.coulomb = { friction = 0.0 } }
[[step]]
increments.count = 4
displacement."wheel.inner" = { x = 0.0, y = 0.0 }
motion.die = { rotation = 0.0 }
[[step]]
increments.count = 80
motion.die = { rotation = 30.0 }
"#;

/// A round die pressed into a slab and dragged along it.
const SLAB: &str = r#"
version = 1
space = "plane-strain"
mesh.part.slab.rectangle = { from = [-1.0, -1.0], to = [3.0, 0.0], cells = [40, 5], cell = "quad4" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.slab.material = "rubber"
tool.die = { profile = [{ arc = [[0.0, 0.5], [0.5, 0.0], [1.0, 0.5]] }], reference = [0.0, 0.0] }
contact.track = { surface = "slab.top", target = "die", law.coulomb = { friction = 0.0 } }
[[step]]
increments.count = 8
displacement."slab.bottom" = { x = 0.0, y = 0.0 }
motion.die = { y = -0.1 }
[[step]]
increments.count = 100
motion.die = { x = 1.0, y = -0.1 }
"#;

/// A ball pressed into half of a slab and dragged along it.
const BALL: &str = r#"
version = 1
space = "solid"
mesh.part.slab.box = { from = [-1.0, 0.0, -0.6], to = [1.6, 0.8, 0.0], cells = [20, 6, 3], cell = "hex8" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.slab.material = "rubber"
tool.ball.sphere = { center = [0.0, 0.0, 0.5], radius = 0.5 }
contact.track = { surface = "slab.front", target = "ball", law.coulomb = { friction = 0.0 } }
[[step]]
increments.count = 4
symmetry = ["slab.bottom"]
displacement."slab.back" = { x = 0.0, y = 0.0, z = 0.0 }
motion.ball = { z = -0.08 }
[[step]]
increments.count = 40
motion.ball = { x = 0.5, z = -0.08 }
"#;

/// A small block pressed and drawn over a larger one.
const BLOCKS: &str = r#"
version = 1
space = "solid"
mesh.part.bed.box = { from = [0.0, 0.0, -0.5], to = [1.5, 1.0, 0.0], cells = [4, 3, 2], cell = "hex8" }
mesh.part.shoe.box = { from = [0.2, 0.2, 0.0], to = [0.8, 0.7, 0.4], cells = [2, 2, 1], cell = "hex8" }
material.rubber.neo_hookean = { shear = 4.0, bulk = 10.0 }
body.bed.material = "rubber"
body.shoe.material = "rubber"
contact.track = { surface = "shoe.back", target = "bed.front", normals = "averaged", guard = "warn", law.coulomb = { friction = 0.3 } }
[[step]]
increments.count = 2
displacement."bed.back" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."shoe.front" = { x = 0.0, y = 0.0, z = -0.04 }
[[step]]
increments.count = 4
displacement."shoe.front" = { x = 0.2, y = 0.05, z = -0.04 }
"#;

/// From the largest to the least value, from increment `from` on.
fn span(values: &[f64], from: usize) -> f64 {
    let [most, least] = [f64::max, f64::min].map(|pick| values[from..].iter().copied().reduce(pick).unwrap());
    most - least
}

/// The force along and across the surface, in the axes of the die that has turned by `turn` degrees at the end, and the
/// number of iterations.
fn forces(deck: &str, sets: &[&str], turn: f64) -> ([Vec<f64>; 2], usize) {
    let model = model(deck, sets);
    let keep = run(&model);
    let columns: BTreeMap<String, Vec<f64>> = columns(&model, &keep);
    let [x, y] = ["x", "y"].map(|axis| &columns[&format!("contact.track.force.{axis}")]);
    let turned = |along: [f64; 2], i: usize| {
        let (sin, cos) = (turn * (i as f64 - 3.0).max(0.0) / 80.0).to_radians().sin_cos();
        x[i] * (along[0] * cos - along[1] * sin) + y[i] * (along[0] * sin + along[1] * cos)
    };
    let values = [[1.0, 0.0], [0.0, 1.0]].map(|along| (0..x.len()).map(|i| turned(along, i)).collect());
    (values, keep.attempts.iter().map(|attempt| attempt.iterations.len()).sum())
}

/// Ripple of the force along the surface with own normals over that with averaged ones, and how many iterations are
/// spared; the mean force across the surface stays.
fn ratio((deck, from): (&str, usize), gauss: &str, turn: f64) -> (f64, isize) {
    let gauss = format!("contact.track.gauss={gauss}");
    let [(own, more), (averaged, less)] =
        ["own", "averaged"].map(|normals| forces(deck, &[&gauss, &format!("contact.track.normals={normals}")], turn));
    let mean = |values: &[f64]| values[from..].iter().sum::<f64>() / (values.len() - from) as f64;
    let (a, b) = (mean(&own[1]), mean(&averaged[1]));
    assert!(a.abs() > 30.0 && (a / b - 1.0).abs() < 0.02, "{a} {b}");
    let [a, b] = [&own, &averaged].map(|forces| span(&forces[0], from));
    println!("{gauss}: {a:.4} own, {b:.4} averaged, ratio {:.2}; {more} and {less} iterations", a / b);
    (a / b, more as isize - less as isize)
}

/// Measured: 11.0 with three points an edge, 3.8 with two, 4.0 on the wheel; with one point in the middle of each edge,
/// the default, there is little to be gained.
#[test]
fn the_force_along_the_surface_ripples_less() {
    let ((three, spared), (two, _)) = (ratio((SLAB, 30), "3", 0.0), ratio((SLAB, 30), "2", 0.0));
    assert!(three > 8.0 && two > 3.0 && spared > 10, "{three} {two} {spared}");
    let (wheel, _) = ratio((WHEEL, 10), "3", 30.0);
    assert!(wheel > 3.0, "{wheel}");
}

/// In space: 9.2 times less with two points along each side of a face.
#[test]
fn the_force_of_a_ball_ripples_less() {
    let [own, averaged] = ["own", "averaged"].map(|normals| {
        let model = model(BALL, &["contact.track.gauss=2", &format!("contact.track.normals={normals}")]);
        let columns = columns(&model, &run(&model));
        let [along, down] = ["x", "z"].map(|axis| &columns[&format!("contact.track.force.{axis}")]);
        assert!((down[43] / -18.6 - 1.0).abs() < 0.03, "{}", down[43]);
        span(along, 12)
    });
    println!("{own:.4} own, {averaged:.4} averaged, ratio {:.2}", own / averaged);
    assert!(own > 6.0 * averaged, "{own} {averaged}");
}

/// A curved shoe drawn along a curved bed, both of first degree: edges covered in part on both sides.
const SHOE: &str = r#"
version = 1
space = "plane-strain"
mesh.part.bed.annulus = { from = [20.0, 45.0], to = [24.0, 135.0], cells = [2, 15], cell = "quad4" }
mesh.part.shoe.annulus = { from = [24.05, 80.0], to = [27.0, 100.0], cells = [2, 4], cell = "quad4" }
material.rubber.neo_hookean = { shear = 4.0, bulk = 10.0 }
body.bed.material = "rubber"
body.shoe.material = "rubber"
contact.track = { surface = "shoe.inner", target = "bed.outer", normals = "averaged", guard = "warn", law.coulomb = { friction = 0.3 } }
[[step]]
increments.count = 3
displacement."bed.inner" = { x = 0.0, y = 0.0 }
displacement."shoe.outer" = { x = 0.0, y = -0.4 }
[[step]]
increments.count = 6
displacement."shoe.outer" = { x = 1.5, y = -0.45 }
"#;

/// A ring squeezed between two points until its bore touches itself.
const CRUSHED: &str = r#"
version = 1
space = "plane-strain"
mesh.part.ring.annulus = { from = [9.0, 0.0], to = [10.0, 360.0], cells = [2, 48], cell = "quad4" }
group.top = { of = "ring.outer", x = [-0.01, 0.01], y = [9.99, 10.01] }
group.foot = { of = "ring.outer", x = [-0.01, 0.01], y = [-10.01, -9.99] }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.ring = { material = "rubber", formulation = "f-bar" }
contact.track = { surface = "ring.inner", target = "ring.inner", normals = "averaged", guard = "warn", law.coulomb = { friction = 0.1 } }
[[step]]
increments.count = 25
displacement.foot = { x = 0.0, y = 0.0 }
displacement.top = { x = 0.0, y = -18.25 }
"#;

/// Same bits on one thread and on three, and when a run goes on from any of its states.
#[test]
fn threads_and_restarts_change_nothing() {
    let cases: [(&str, &[&str]); 7] = [
        (SHOE, &["contact.track.passes=one"]),
        (SHOE, &["contact.track.passes=two"]),
        (SHOE, &["contact.track.passes=two", "contact.track.augmentation={penetration=1e-3,slip=1e-3,loops=40}"]),
        (CRUSHED, &[]),
        (BALL, &["contact.track.normals=averaged", "contact.track.gauss=2", "step.2.increments.count=5"]),
        (BLOCKS, &["contact.track.passes=one"]),
        (BLOCKS, &["contact.track.passes=two"]),
    ];
    for (deck, sets) in cases {
        let model = model(deck, sets);
        let keep = with_threads(1, || run(&model));
        let pressure = columns(&model, &keep)["contact.track.max_pressure"].last().copied();
        assert!(pressure > Some(1e-3), "{sets:?}: {pressure:?}");
        let whole = all_bytes(&keep);
        assert!(whole == with_threads(3, || all_bytes(&run(&model))), "{sets:?}: threads");
        let middle = whole.len() / 2;
        let begun = go_on(&model, model.problem.initial_state(), Some(middle));
        let restarted: State = postcard::from_bytes(&bytes(begun.states.last().unwrap())).unwrap();
        let rest = go_on(&model, restarted, None);
        assert!(whole[middle..] == all_bytes(&rest)[..], "{sets:?}: restart");
    }
}

/// The whole system's iterations converge as Newton's: what a step leaves out of the tangent would cost many.
#[test]
fn newton_converges_as_with_own_normals() {
    for passes in ["one", "two"] {
        let passes = format!("contact.track.passes={passes}");
        let [own, averaged] = ["own", "averaged"].map(|normals| {
            let model = model(SHOE, &[&passes, &format!("contact.track.normals={normals}")]);
            run(&model).attempts.iter().map(|attempt| attempt.iterations.len()).sum::<usize>()
        });
        assert!(averaged <= own + own / 5, "{passes}: {averaged} against {own}");
    }
}
