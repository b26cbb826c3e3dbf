//! Steps that follow a path by arc length: snap-through and snap-back of a truss in closed form, an arch against prescribed
//! displacement, a tool on it, restart, what a deck cannot ask for; increments that jump.

mod support;

use asperity::Failure;
use asperity::amplitude::{Amplitude, Change, Timeline};
use asperity::load::force_on_nodes;
use asperity::solve::{ArcLength, Frontal, Increments, NewtonOptions, Problem, Run, RunOptions, Silent, Step, Until};
use asperity::system::{
    Attempt, Branch, Constraints, Dofs, Following, History, Instant, Local, State, Stencil, Stencils, Term,
};
use std::sync::Arc;
use support::{model, run};

/// Two bars from supports at `(-1, 0)` and `(1, 0)` to an apex at a height `RISE`, of Green strain and unit stiffness `E A`: the
/// apex goes down by `w` under `P = (h^2 - z^2) z / L^3` with `z = h - w` (von Mises 1923), pulled by a spring at whose other end
/// the load acts.
const RISE: f64 = 0.4;

fn apex_force(w: f64) -> [f64; 2] {
    let (z, cube) = (RISE - w, (1.0 + RISE * RISE).powf(1.5));
    [(RISE * RISE - z * z) * z / cube, (3.0 * z * z - RISE * RISE) / cube]
}

/// Loads at the limit points, where `3 z^2 = h^2`.
fn limit() -> f64 {
    apex_force(RISE * (1.0 - 1.0 / 3.0_f64.sqrt()))[0]
}

#[derive(Debug)]
struct Truss {
    /// Stiffness of the spring between the apex, unknown 1, and the loaded point, unknown 3.
    spring: f64,
}

impl Term for Truss {
    fn name(&self) -> &str {
        "truss"
    }
    fn initial(&self) -> History {
        History::new([0])
    }
    fn attempt<'a>(&'a self, _: &'a State, _: &'a History, _: Instant) -> Result<Box<dyn Attempt + 'a>, Failure> {
        Ok(Box::new(Open(self.spring)))
    }
    fn name_of(&self, _: usize) -> String {
        "the truss".into()
    }
}

struct Open(f64);

impl Attempt for Open {
    fn scratch(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        out.push([1, 3], 0);
        Ok(())
    }
    fn evaluate(&self, _: usize, _: &Stencil, _: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let (k, [apex, end]) = (self.0, [-local.u[0], -local.u[1]]);
        let ([force, slope], pull) = (apex_force(apex), k * (end - apex));
        local.force.copy_from_slice(&[pull - force, -pull]);
        if local.wants_tangent {
            local.tangent.copy_from_slice(&[slope + k, -k, -k, k]);
        }
        let depth = |z: f64| (RISE * RISE * z * z / 2.0 - z.powi(4) / 4.0) / (1.0 + RISE * RISE).powf(1.5);
        local.energies.stored = depth(RISE) - depth(RISE - apex) + 0.5 * k * (end - apex).powi(2);
        Ok(0)
    }
}

/// The truss under a load that grows to `load` at the end of its step, by arc length up to a motion of the loaded point.
fn truss(spring: f64, load: f64, until: Option<f64>, arc: bool) -> Problem {
    let dofs = Dofs::new(2, 2, 0);
    let ramp = Timeline::new([(1.0, Change::To(-load, Amplitude::ramp()))]);
    let loaded = force_on_nodes("load", &dofs, &[1], vec![Timeline::new([]), ramp]);
    let until = until.map(|value| Until { dofs: vec![3], value: -value });
    let mut step = Step::new("load", Constraints::new(dofs.count(), &[0, 2], &[]), vec![]);
    step.increments = Increments { first: 0.02, largest: 0.02, ..Increments::default() };
    step.arc_length = arc.then_some(ArcLength { until, grows: false });
    Problem {
        terms: vec![Arc::new(Truss { spring }), Arc::new(loaded)],
        contacts: 0..0,
        removable: 0..0,
        steps: vec![step],
        newton: NewtonOptions { tolerance: 1e-9, ..NewtonOptions::default() },
        size: 2.0,
        cell_size: 1.0,
        wholes: vec![],
        audit: None,
        tools: vec![],
        following: Arc::new(Following::default()),
        node_name: Box::new(|node| format!("node {node}")),
        dofs,
    }
}

fn states(problem: &Problem) -> (Vec<State>, usize) {
    let mut run = Run::new(problem, problem.initial_state(), Box::new(Frontal::default()));
    let mut states = Vec::new();
    while run.advance(&mut Silent).unwrap().is_some() {
        states.push(run.state.clone());
    }
    (states, run.stability.turns.len())
}

#[test]
fn a_truss_snaps_through_and_back_in_closed_form() {
    // The soft spring lets the loaded point come back on its way: snap-back.
    for (spring, back) in [(10.0, false), (0.1, true)] {
        let (path, turns) = states(&truss(spring, 4.0 * limit(), Some(0.9 + limit() / spring), true));
        let mut loads = Vec::new();
        for state in &path {
            let (apex, end, load) = (-state.u[1], -state.u[3], 4.0 * limit() * state.factor);
            let [exact, _] = apex_force(apex);
            assert!((load - exact).abs() < 1e-7 * limit(), "{load} {exact}");
            assert!((end - apex - load / spring).abs() < 1e-6);
            loads.push(load);
        }
        let end = path.last().unwrap();
        assert!((-end.u[3] - 0.9 - limit() / spring).abs() < 1e-9, "ends where it is told to");
        let (most, least) = (loads.iter().copied().fold(0.0, f64::max), loads.iter().copied().fold(0.0, f64::min));
        let early = loads.iter().take(loads.len() / 2).copied().fold(0.0, f64::max);
        assert!(early > 0.95 * limit() && least < -0.95 * limit() && most >= early, "{early} {least} of {}", limit());
        let returns = path.windows(2).any(|two| two[1].u[3] > two[0].u[3] + 1e-6);
        assert_eq!(returns, back);
        assert_eq!(turns, 2, "both limit points are noted");
    }
}

#[test]
fn a_step_by_arc_length_ends_at_its_whole_load() {
    let problem = truss(10.0, 2.0 * limit(), None, true);
    let (path, _) = states(&problem);
    let end = path.last().unwrap();
    assert!((end.factor - 1.0).abs() < 1e-9 && (apex_force(-end.u[1])[0] - 2.0 * limit()).abs() < 1e-8);
    assert!(end.load_factors.is_empty() && path.len() > 5);
}

/// A path that no load leads, one that is to end where it begins, and one that goes the other way.
#[test]
fn a_path_to_nowhere_is_told() {
    let told = |problem: &Problem| {
        let mut run = Run::new(problem, problem.initial_state(), Box::new(Frontal::default()));
        loop {
            match run.advance(&mut Silent) {
                Ok(Some(_)) => {}
                Ok(None) => return String::new(),
                Err(error) => return error.to_string(),
            }
        }
    };
    let idle = told(&truss(0.5, 0.0, Some(0.1), true));
    assert!(idle.contains("no load on what is free changes"), "{idle}");
    let over = told(&truss(0.5, 1.0, Some(0.0), true));
    assert!(over.contains("over before it begins"), "{over}");
    let mut wrong = truss(0.5, 0.1, Some(-0.5), true);
    wrong.steps[0].increments.most = 10;
    let wrong = told(&wrong);
    assert!(wrong.contains("`until` is -") && wrong.contains("is to be 5.000000e-1"), "{wrong}");
}

#[test]
fn a_run_on_a_path_goes_on_from_a_state_to_the_same_bits() {
    let problem = truss(0.1, 4.0 * limit(), Some(0.9 + limit() / 0.1), true);
    let (path, _) = states(&problem);
    // As a checkpoint keeps it.
    let kept = postcard::to_stdvec(&path[path.len() / 2]).unwrap();
    let mut run = Run::new(&problem, postcard::from_bytes(&kept).unwrap(), Box::new(Frontal::default()));
    run.run(&RunOptions::default(), &mut Silent).unwrap();
    assert_eq!((&run.state.u, run.state.factor), (&path.last().unwrap().u, path.last().unwrap().factor));
    assert!((run.state.load_factors[0].1 - run.state.factor).abs() == 0.0);
}

/// A shallow clamped arch under a load at its crown.
const ARCH: &str = r#"
version = 1
space = "plane-stress"
mesh.part.arch.annulus = { centre = [0.0, -100.0], from = [99.5, 76.0], to = [100.5, 104.0], cells = [2, 32], cell = "quad8" }
group.crown = { of = "arch.outer", x = [-0.01, 0.01] }
material.rubber.neo_hookean = { shear = 1000.0, bulk = 2166.6666666666665 }
body.arch.material = "rubber"
[[step]]
control = "arc-length"
until = { group = "crown", y = -5.0 }
displacement."arch.start" = { x = 0.0, y = 0.0 }
displacement."arch.end" = { x = 0.0, y = 0.0 }
force.crown = { y = -2.0 }
"#;

/// Depths of the crown and load factors, increment by increment.
struct Curve {
    depths: Vec<f64>,
    factors: Vec<f64>,
    states: Vec<State>,
}

impl Curve {
    fn of(deck: &str, sets: &[&str]) -> Self {
        let (model, crown) = (model(deck, sets), crown());
        let states = run(&model).states;
        let depths = states.iter().map(|state| -state.u[crown]).collect();
        Self { depths, factors: states.iter().map(|state| state.factor).collect(), states }
    }

    /// A value where the crown is first at a depth, by lines between increments.
    fn at(&self, depth: f64, value: impl Fn(usize) -> f64) -> f64 {
        let (w, after) = (&self.depths, self.depths.iter().position(|&w| w >= depth).unwrap());
        let part = (depth - w[after - 1]) / (w[after] - w[after - 1]);
        value(after - 1) + part * (value(after) - value(after - 1))
    }

    fn factor(&self, depth: f64) -> f64 {
        self.at(depth, |i| self.factors[i])
    }

    /// The first largest load factor.
    fn peak(&self) -> f64 {
        self.factors.windows(2).find(|two| two[1] < two[0]).unwrap()[0]
    }
}

/// The unknown of the crown along y.
fn crown() -> usize {
    let model = model(ARCH, &[]);
    model.problem.steps[0].arc_length.as_ref().unwrap().until.as_ref().unwrap().dofs[0]
}

#[test]
fn an_arch_goes_where_a_prescribed_displacement_leads_it() {
    let path = Curve::of(ARCH, &["step.1.increments.largest=0.02", "step.1.force.crown.y=-20.0"]);
    let lines =
        ARCH.replace("control = \"arc-length\"\nuntil = { group = \"crown\", y = -5.0 }", "increments.count = 200");
    let led = Curve::of(&lines.replace("force.crown = { y = -2.0 }", "displacement.crown = { y = -5.0 }"), &[]);
    for depth in [0.2, 1.0, 2.0, 3.0, 4.0, 4.8] {
        let [load, reaction] = [20.0 * path.factor(depth), led.at(depth, |i| -led.states[i].internal[crown()])];
        assert!((load / reaction - 1.0).abs() < 0.01, "{depth}: {load} {reaction}");
    }
}

/// The elastica: a column whose end has gone sideways by three tenths of its length bears `(2 K(k)/pi)^2` of Euler's load, `2 k/K(k) = 0.3`,
/// `k = 0.2391`. Before that it is shortened by 1/5000 in the load that measures its path.
#[test]
fn a_column_bends_far_in_few_increments() {
    let deck = "version = 1
        space = \"plane-stress\"
        mesh.part.c.rectangle = { from = [0.0, 0.0], to = [1.0, 40.0], cells = [2, 40], cell = \"quad8\" }
        material.m.elastic = { young = 210e3, poisson = 0.3 }
        body.c.material = \"m\"
        [[step]]
        control = \"arc-length\"
        increments.first = 0.2
        until = { group = \"c.top\", x = 12.0 }
        displacement.\"c.bottom\" = { x = 0.0, y = 0.0 }
        traction.\"c.top\" = { y = -40.0, x = 0.01 }";
    let keep = run(&model(deck, &[]));
    let euler = std::f64::consts::PI.powi(2) * 210e3 / 12.0 / 6400.0;
    let load = keep.states.last().unwrap().load_factors[0].1 * 40.0 / euler;
    eprintln!("{load} in {} increments", keep.states.len());
    assert!((load / 1.02975 - 1.0).abs() < 2e-3, "{load}");
    assert!(keep.states.len() < 200, "{} increments", keep.states.len());
}

/// The first increment of the load, .05 by default, lies beyond that at the limit point of a shallow arch, .0441, and is taken shorter.
#[test]
fn the_first_increment_does_not_pass_a_limit_point() {
    let deck = "version = 1
        space = \"plane-strain\"
        mesh.part.a.annulus = { from = [100.0, 75.0], to = [101.0, 105.0], cells = [2, 40], cell = \"quad8\" }
        material.m.elastic = { young = 1000.0, poisson = 0.0 }
        body.a.material = \"m\"
        group.crown = { of = \"a.outer\", x = [-0.1, 0.1] }
        [[step]]
        control = \"arc-length\"
        until = { group = \"crown\", y = -6.0 }
        displacement.\"a.start\" = { x = 0.0, y = 0.0 }
        displacement.\"a.end\" = { x = 0.0, y = 0.0 }
        pressure.\"a.outer\".value = 0.5";
    let peak = |sets: &[&str]| {
        let keep = run(&model(deck, sets));
        let factors: Vec<f64> = keep.states.iter().map(|state| state.factor).collect();
        let falls = factors.windows(2).position(|two| two[1] < two[0]).expect("a limit point");
        (factors[falls], factors.len())
    };
    let ((peak, count), (fine, _)) = (peak(&[]), peak(&["step.1.increments.first=0.001"]));
    eprintln!("{peak} in {count} increments, {fine}");
    assert!((peak / fine - 1.0).abs() < 0.03, "{peak} instead of {fine}");
}

/// What a step after the path says of its load begins where the path ended.
#[test]
fn a_load_stays_where_its_path_ended() {
    let deck = format!(
        "{ARCH}\n[[step]]\nincrements.count = 2\n[[step]]\nincrements.count = 2\nrelease = [\"force.crown\"]\n"
    );
    let Curve { depths: w, factors, .. } = Curve::of(&deck, &["step.1.until.y=-0.3"]);
    let ended = w.len() - 5;
    assert!((w[ended] - 0.3).abs() < 1e-6 && factors[ended] > 0.1 && factors[ended] < 1.0);
    assert!(w[ended + 1..ended + 3].iter().all(|w| (w - 0.3).abs() < 1e-6), "{w:?}");
    assert!(w[ended + 4].abs() < 1e-6 && w[ended + 3] > 0.05, "let go: {w:?}");
}

/// Loads beside prescribed motion: both go with the load factor.
#[test]
fn prescribed_motion_goes_with_the_load() {
    let deck = model(ARCH, &[]);
    let feet = &deck.mesh.groups["arch.end"].nodes;
    let fine = "step.1.increments.largest=0.02";
    let [alone, beside] = [0.0, 0.2].map(|x| {
        let curve = Curve::of(ARCH, &[fine, &format!("step.1.displacement.\"arch.end\".x={x:.1}")]);
        let goes = |state: &State| (state.u[deck.problem.dofs.node(feet[0])] - x * state.factor).abs() < 1e-9;
        assert!(curve.states.iter().all(goes));
        curve.peak()
    });
    // Feet that come together lift the crown, and bear more.
    assert!(beside > 1.1 * alone, "{beside} {alone}");
}

#[test]
fn yield_and_a_tool_go_with_a_path() {
    let steel =
        "material.rubber={ von_mises = { young = 2600.0, poisson = 0.3, yield_stress = 20.0, hardening = 50.0 } }";
    let [elastic, plastic] = [Curve::of(ARCH, &[]), Curve::of(ARCH, &[steel])];
    assert!(plastic.factor(2.0) < 0.9 * elastic.factor(2.0));
    let pushed = Curve::of(&ARCH.replace("[[step]]\n", TOOL).replace("force.crown", "load.ball"), &[]);
    for depth in [1.0, 3.0, 4.5] {
        assert!((pushed.factor(depth) / elastic.factor(depth) - 1.0).abs() < 0.02, "{depth}");
    }
}

/// A tool that touches the crown before its load follows.
const TOOL: &str = r#"
tool.ball.profile = [{ arc = [[-2.5, 2.5], [0.0, 0.505], [2.5, 2.5]] }]
contact.top = { surface = "arch.outer", target = "ball", law.coulomb.friction = 0.2 }
[[step]]
displacement."arch.start" = { x = 0.0, y = 0.0 }
displacement."arch.end" = { x = 0.0, y = 0.0 }
motion.ball.y = -0.02
[[step]]
"#;

/// Under its load an arch jumps where increments are long, and says so; along its path it does not.
#[test]
fn an_increment_that_jumps_is_told() {
    let snaps = |deck: &str| {
        let model = model(deck, &[]);
        let mut run = model.run(model.problem.initial_state());
        run.run(&RunOptions::default(), &mut Silent).unwrap();
        run.stability.snaps
    };
    let loaded =
        ARCH.replace("control = \"arc-length\"\nuntil = { group = \"crown\", y = -5.0 }", "increments.count = 3");
    let [snap] = &snaps(&loaded)[..] else { panic!("one jump") };
    // The area under the limit load of 1.1 down to where the path comes up to it again.
    assert!((0.3..1.3).contains(&snap.energy) && snap.largest.contains("along y"), "{snap:?}");
    assert!(snaps(ARCH).is_empty());
}

/// A column under 1.2 and 0.8 of Euler's load in its first increment: the undeformed one is stable, and the other is told, of a rate law
/// whose tangent is not symmetric too.
#[test]
fn an_instability_within_the_first_increment_is_noted() {
    let critical = std::f64::consts::PI.powi(2) * 1e6 / 12.0 / (4.0 * 40.0_f64.powi(2));
    for law in ["elastic", "saint_venant_kirchhoff"] {
        for (part, noted) in [(0.8, false), (1.2, true)] {
            let deck = format!(
                r#"
version = 1
space = "plane-stress"
mesh.part.column.rectangle = {{ from = [0.0, 0.0], to = [1.0, 40.0], cells = [2, 30], cell = "quad8" }}
material.steel.{law} = {{ young = 1e6, poisson = 0.0 }}
body.column.material = "steel"
[[step]]
increments.count = 1
displacement."column.bottom" = {{ x = 0.0, y = 0.0 }}
traction."column.top".y = {}
"#,
                -part * critical
            );
            let turn = run(&model(&deck, &[])).attempts.last().unwrap().turn.is_some();
            assert_eq!(turn, noted, "{law} {part}");
        }
    }
}

/// A column that a small side load bends, shortened far beyond Euler's load in steps of any size: it buckles to the side to which it is
/// bent, and not to the other; nor does it come to its straight shape, which is not stable, where an increment goes past the bifurcation.
#[test]
fn a_column_that_is_bent_buckles_to_its_side() {
    let deck = r#"
version = 1
space = "plane-stress"
mesh.part.column.rectangle = { from = [0.0, 0.0], to = [4.0, 200.0], cells = [2, 50], cell = "quad4" }
material.steel.elastic = { young = 200e3, poisson = 0.3 }
body.column.material = "steel"
group.middle = { of = "column.right", y = [98.0, 102.0] }
[[step]]
displacement."column.bottom" = { x = 0.0, y = 0.0 }
displacement."column.top" = { x = 0.0, y = -0.5 }
traction."column.left" = { x = 0.001 }
"#;
    let euler = 4.0 * std::f64::consts::PI.powi(2) * 200e3 * 64.0 / 12.0 / 40_000.0;
    for count in ["", "step.1.increments.count=5", "step.1.increments.count=20", "step.1.increments.count=50"] {
        let sets: Vec<&str> = [count].into_iter().filter(|set| !set.is_empty()).collect();
        let model = support::model(deck, &sets);
        let keep = support::run(&model);
        let columns = support::columns(&model, &keep);
        let last = |name: &str| *columns[name].last().unwrap();
        let load = last("reaction.column.bottom.y") / euler;
        assert!((load - 1.0).abs() < 0.02, "{count}: {load} of Euler's load");
        let state = keep.states.last().unwrap();
        let middle = model.mesh.groups["middle"].nodes.iter().map(|&node| state.u[2 * node]).sum::<f64>();
        assert!(middle > 4.0, "{count}: {middle}");
    }
}

/// A slender column with a side load, shortened to seven times its Euler load, clamped at both ends and under a platen with friction: the second increment goes past
/// the first mode, and came to the straight shape, of two negative eigenvalues, whose determinant is positive.
#[test]
fn a_column_does_not_stay_straight_past_two_modes() {
    let deck = |height: f64, rest: &str| {
        format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.c.rectangle = {{ from = [-1.0, 0.0], to = [1.0, {height}], cells = [2, {}], cell = "quad8" }}
material.m.elastic = {{ young = 1e5, poisson = 0.3 }}
body.c.material = "m"
group.mid = {{ of = "c.left", y = [{}, {}] }}
{rest}"#,
            height / 2.0,
            height / 2.0 - 1.0,
            height / 2.0 + 1.0
        )
    };
    let clamped = r#"
[[step]]
displacement."c.bottom" = { x = 0.0, y = 0.0 }
displacement."c.top" = { x = 0.0, y = -1.0 }
force.mid = { x = 0.01, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
"#;
    let platen = r#"
tool.p.profile = [{ line = [[-20.0, 60.0], [20.0, 60.0]] }]
contact.c = { surface = "c.top", target = "p", law.coulomb = { friction = 0.3 } }
[[step]]
displacement."c.bottom" = { x = 0.0, y = 0.0 }
motion.p = { y = -2.0 }
force.mid = { x = 0.3, amplitude = [[0.0, 1.0], [1.0, 1.0]] }
"#;
    // In increments of a fiftieth and of a hundredth: 291.7 and 465.
    for (height, rest, force) in [(100.0, clamped, 291.7), (60.0, platen, 465.0)] {
        let model = model(&deck(height, rest), &[]);
        let found = support::columns(&model, &run(&model))["reaction.c.bottom.y"].last().copied().unwrap();
        assert!((found / force - 1.0).abs() < 0.02, "{height}: {found}");
    }
    // Without an imperfection it stays straight, and is doubted.
    let model = model(&deck(100.0, &clamped.replace("0.01", "0.0")), &[]);
    let keep = run(&model);
    let turns: Vec<_> = keep.attempts.iter().filter_map(|attempt| attempt.turn.as_ref()).collect();
    let last = turns.last().unwrap();
    assert!(turns.len() > 1 && last.negative[1] > last.negative[0], "{turns:?}");
    assert!(support::certificate(&model, &keep).figure("unstable").unwrap() >= 2.0);
}

/// Rubber under a pressure all round of 50 times its shear modulus is stable. The matrix of a first iteration turns with the stress before the
/// increment, under the pressure after it, and had 10 negative eigenvalues.
#[test]
fn pressure_all_round_is_no_bifurcation() {
    for (cell, largest) in [("quad4", 0.1), ("quad4", 0.05), ("quad8", 0.1)] {
        let deck = format!(
            r#"
version = 1
space = "axisymmetric"
mesh.part.c.rectangle = {{ from = [0.0, 0.0], to = [1.0, 1.0], cells = [6, 6], cell = "{cell}" }}
material.n.neo_hookean = {{ shear = 1.0, bulk = 1000.0 }}
body.c.material = "n"
[[step]]
displacement."c.bottom".y = 0.0
displacement."c.left".x = 0.0
pressure."c.top".value = 50.0
pressure."c.right".value = 50.0
increments = {{ first = 0.05, largest = {largest} }}
"#
        );
        let attempts = run(&model(&deck, &[])).attempts;
        assert!(attempts.len() > 5 && attempts.iter().all(|record| record.turn.is_none()), "{cell} {largest}");
    }
}

/// A strut that has buckled comes to lie on a plate: there the path turns by a corner, and goes on to where steps in time lead too.
#[test]
fn a_path_goes_round_the_corner_at_which_contact_closes() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.b.rectangle = { from = [0.0, 0.0], to = [20.0, 1.0], cells = [20, 2], cell = "quad8" }
material.e.elastic = { young = 1000.0, poisson = 0.3 }
body.b.material = "e"
tool.t.profile = [{ line = [[30.0, -2.0], [-10.0, -2.0]] }]
contact.k = { surface = "b.bottom", target = "t", law.coulomb.friction = 0.2 }
[[step]]
displacement."b.left" = { x = 0.0, y = 0.0 }
force."b.bottom_right" = { x = -4.0, y = -0.1 }
control = "time"
"#;
    let ends = ["time", "arc-length"].map(|control| {
        let model = model(&deck.replace("\"time\"", &format!("{control:?}")), &[]);
        let keep = run(&model);
        assert!(keep.attempts.iter().map(|record| record.solutions()).sum::<usize>() < 250, "{control}");
        let state = keep.states.last().unwrap();
        let records = model.field_contacts[0].records(&state.u, &state.histories[model.first_contact()]);
        records.iter().map(|record| record.pressure * record.area).sum::<f64>()
    });
    assert!((ends[0] / 1.1304 - 1.0).abs() < 0.01 && (ends[1] / ends[0] - 1.0).abs() < 0.01, "{ends:?}");
}
