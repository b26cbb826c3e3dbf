//! The audit: strips, slabs and round tools driven through one another never end well, with increments of a twentieth to
//! five thicknesses, with and without a contact declared; what touches, slides, folds or fits is left alone.

mod support;

use asperity::audit::{Audit, Subject};
use asperity::mesh::generate::{Block, Grade, Spacing};
use asperity::mesh::{Cell, Mesh};
use asperity::solve::{RunOptions, Silent};
use asperity::system::Dofs;
use asperity::tensor::Vec3;
use std::sync::Arc;
use support::{bytes, go_on, model, run};

/// Two strips of thickness 1, a tenth apart; the upper one is driven down by 5.
const STRIPS: &str = r#"
version = 1
space = "plane-strain"
[mesh.part.held.rectangle]
from = [0.0, 0.0]
to = [8.0, 1.0]
cells = [8, 1]
cell = "quad4"
[mesh.part.driven.rectangle]
from = [2.3, 1.1]
to = [5.3, 2.1]
cells = [3, 1]
cell = "quad4"
[material.rubber.elastic]
young = 10.0
poisson = 0.3
[body.held]
material = "rubber"
[body.driven]
material = "rubber"
[contact.touch]
surface = "driven.bottom"
target = "held.top"
law.frictionless = {}
[solver]
relax = false
[[step]]
displacement."held.bottom" = { x = 0.0, y = 0.0 }
displacement."driven.top" = { x = 0.0, y = -5.0 }
increments = { count = 1, smallest = 1e-3 }
"#;

/// A slab in space, held below, and a slab driven through it.
const SLABS: &str = r#"
version = 1
space = "solid"
[mesh.part.held.box]
from = [0.0, 0.0, 0.0]
to = [4.0, 4.0, 1.0]
cells = [4, 4, 1]
cell = "hex8"
[mesh.part.driven.box]
from = [1.3, 1.3, 1.1]
to = [2.7, 2.7, 2.1]
cells = [2, 2, 1]
cell = "hex8"
[material.rubber.elastic]
young = 10.0
poisson = 0.3
[body.held]
material = "rubber"
[body.driven]
material = "rubber"
[solver]
relax = false
[[step]]
displacement."held.bottom" = { x = 0.0, y = 0.0, z = 0.0 }
displacement."driven.top" = { x = 0.0, y = 0.0, z = -5.0 }
increments = { count = 1, smallest = 1e-2 }
"#;

/// What a run ends with.
fn end(deck: &str, sets: &[&str]) -> Result<f64, String> {
    let model = model(deck, sets);
    let mut run = model.run(model.problem.initial_state());
    let ended = run.run(&RunOptions::default(), &mut Silent);
    ended.map(|_| run.state.worst_interpenetration.relative).map_err(|error| error.to_string())
}

/// Increments of 5, 2.5, 1, 0.5, 0.25 and 0.05 thicknesses.
const COUNTS: [usize; 6] = [1, 2, 5, 10, 20, 100];

#[test]
fn strips_do_not_pass_through_one_another() {
    for count in COUNTS {
        let count = format!("step.1.increments.count={count}");
        let fixed = end(STRIPS, &[&count]).unwrap_err();
        assert!(fixed.contains("fails"), "{count}: {fixed}");
        let strangers = STRIPS.replace("driven.bottom\"\ntarget = \"held.top", "held.left\"\ntarget = \"held.right");
        let said = end(&strangers, &[&count]).unwrap_err();
        assert!(said.contains("'driven'") && said.contains("'held'"), "{count}: {said}");
    }
}

#[test]
fn slabs_do_not_pass_through_one_another_in_space() {
    for count in [1, 4, 20] {
        let said = end(SLABS, &[&format!("step.1.increments.count={count}")]).unwrap_err();
        assert!(said.contains("'driven'") && said.contains("'held'"), "{count}: {said}");
    }
    let touch = "[contact.touch]\nsurface = \"driven.bottom\"\ntarget = \"held.top\"\nlaw.frictionless = {}\n[solver]";
    assert!(end(&SLABS.replace("[solver]", touch), &[]).is_err());
}

/// A strip held at its bottom and a round tool that is driven through it.
const ROUND: &str = r#"
version = 1
space = "plane-strain"
[mesh.part.strip.rectangle]
from = [0.0, 0.0]
to = [8.0, 1.0]
cells = [8, 1]
cell = "quad8"
[material.rubber.elastic]
young = 10.0
poisson = 0.3
[body.strip]
material = "rubber"
[tool.roll]
profile = [{ arc = [[3.1, 1.6], [4.6, 1.6], [3.85, 2.35]] }]
[solver]
relax = false
[[step]]
displacement."strip.bottom" = { x = 0.0, y = 0.0 }
motion.roll = { y = -5.0 }
increments = { count = 1, smallest = 1e-2 }
"#;

#[test]
fn round_and_flat_tools_do_not_pass_through_a_strip() {
    let circle = "{ arc = [[3.1, 1.85], [3.85, 1.1], [4.6, 1.85]] }, { arc = [[4.6, 1.85], [3.85, 2.6], [3.1, 1.85]] }";
    let thin = "{ line = [[2.1, 1.1], [4.6, 1.1]] }, { line = [[4.6, 1.1], [4.6, 1.2]] }, \
                { line = [[4.6, 1.2], [2.1, 1.2]] }, { line = [[2.1, 1.2], [2.1, 1.1]] }";
    let old = "{ arc = [[3.1, 1.6], [4.6, 1.6], [3.85, 2.35]] }";
    for profile in [circle, thin] {
        for count in COUNTS {
            let said = end(&ROUND.replace(old, profile), &[&format!("step.1.increments.count={count}")]).unwrap_err();
            assert!(said.contains("tool 'roll'") && said.contains("'strip'"), "{count}: {said}");
        }
    }
}

/// A needle narrower than a face, driven between two nodes.
#[test]
fn a_needle_between_two_nodes_is_found() {
    let needle = "{ line = [[3.4, 1.3], [3.5, 1.05]] }, { line = [[3.5, 1.05], [3.6, 1.3]] }, { line = [[3.6, 1.3], [3.4, 1.3]] }";
    let old = "{ arc = [[3.1, 1.6], [4.6, 1.6], [3.85, 2.35]] }";
    let deck = ROUND.replace(old, needle).replace("quad8", "quad4");
    for count in [1, 20] {
        let said = end(&deck, &[&format!("step.1.increments.count={count}")]).unwrap_err();
        assert!(said.contains("tool 'roll'"), "{said}");
    }
}

/// A body that begins in another that no contact of it knows, and one whose contact takes the overlap out.
#[test]
fn what_was_there_before_is_shown_and_refused_only_where_it_grows() {
    let still = STRIPS.replace("[2.3, 1.1]", "[2.3, 0.8]").replace("y = -5.0", "y = 0.0");
    let still = still.replace("driven.bottom\"\ntarget = \"held.top", "held.left\"\ntarget = \"held.right");
    let shown = end(&still, &[]).unwrap();
    assert!((shown - 0.2).abs() < 1e-9, "{shown}");
    let grows = still.replace("y = 0.0 }\nincrements", "y = -0.5 }\nincrements");
    assert!(end(&grows, &[]).unwrap_err().contains("deep in body"));
    // The same with a contact that takes the overlap out.
    let known = STRIPS.replace("[2.3, 1.1]", "[2.3, 0.9]").replace("y = -5.0", "y = 0.0");
    assert!(end(&known, &[]).unwrap() < 0.01);
}

#[test]
fn nothing_crosses_the_axis() {
    let deck = r#"
version = 1
space = "axisymmetric"
mesh.part.tube.rectangle = { from = [0.2, 0.0], to = [1.2, 1.0], cells = [4, 4], cell = "quad4" }
material.rubber.elastic = { young = 10.0, poisson = 0.0 }
body.tube.material = "rubber"
[[step]]
displacement."tube.left" = { x = -0.3 }
displacement."tube.bottom" = { y = 0.0 }
increments = { count = 3, smallest = 1e-2 }
"#;
    let said = end(deck, &[]).unwrap_err();
    assert!(said.contains("axis") || said.contains("turned inside out"), "{said}");
}

/// The worst increment, its place and its pair come through a restart to the bit.
#[test]
fn the_worst_is_kept_through_a_restart() {
    let slides = STRIPS.replace("[2.3, 1.1]", "[2.3, 0.9]").replace("x = 0.0, y = -5.0", "x = 1.0, y = 0.02");
    let slides = slides.replace("driven.bottom\"\ntarget = \"held.top", "held.left\"\ntarget = \"held.right");
    let slides = slides.replace("count = 1", "count = 4");
    let model = model(&slides, &[]);
    let whole = run(&model);
    let worst = &whole.states.last().unwrap().worst_interpenetration;
    let mut pair = worst.pair.clone();
    pair.sort();
    assert_eq!((worst.increment, pair), (1, ["body 'driven'", "body 'held'"].map(String::from)), "{worst:?}");
    let rest = go_on(&model, whole.states[1].clone(), None);
    assert_eq!(bytes(rest.states.last().unwrap()), bytes(whole.states.last().unwrap()));
}

/// A ring of curved cells from `0` to `angle` degrees, the outermost layer thinner than their sagitta, as block and as ring.
fn ring(cell: &str, angle: f64) -> [Mesh; 2] {
    let radii = Spacing::from(5.0).run(9.8, 3, Grade::Ratio(1.0)).run(10.0, 1, Grade::Ratio(1.0));
    let [angles, z] = [Spacing::uniform(0.0, angle, (angle / 30.0) as usize), Spacing::uniform(0.0, 0.5, 1)];
    let block = Block { x: radii, y: angles, z, cell: Cell::named(cell).unwrap() }.mesh("ring").unwrap();
    let mut ring = block.clone();
    ring.points = block.points.iter().map(|&x| around(x, 1.0)).collect();
    [block, ring]
}

/// Where radius, angle and height are in space, the angle stretched.
fn around(Vec3([r, angle, z]): Vec3, stretch: f64) -> Vec3 {
    let (sin, cos) = (stretch * angle).to_radians().sin_cos();
    Vec3::new(r * cos, r * sin, z)
}

/// Curved cells thinner than they are curved: facets of a face reach over those of the next. What is not there at rest, a ring
/// closed beyond its ends, is found as ever.
#[test]
fn thin_curved_cells_do_not_lie_in_themselves() {
    for cell in ["tet4", "tet10", "hex8", "hex20", "hex27", "wedge15"] {
        for (angle, closes) in [(90.0, false), (330.0, true)] {
            let [block, ring] = ring(cell, angle);
            let dofs = Dofs::new(3, ring.points.len(), 0);
            let (mut small, mut shut) = (vec![0.0; dofs.count()], vec![0.0; dofs.count()]);
            for (node, (&at, &x)) in block.points.iter().zip(&ring.points).enumerate() {
                let closed = around(at, 370.0 / angle) - x;
                for axis in 0..3 {
                    small[dofs.node(node) + axis] = 1e-4 * ((7 * node + 3 * axis) as f64).sin();
                    shut[dofs.node(node) + axis] = closed[axis];
                }
            }
            let subject = Subject {
                bodies: vec![("ring".into(), (0..ring.cell_count()).collect())],
                mesh: Arc::new(ring),
                axisymmetric: false,
                tools: Vec::new(),
                solid_tools: Vec::new(),
                claims: Vec::new(),
                cell_size: 0.2,
                limit: 0.01,
                contact_limit: 0.25,
                dofs,
            };
            let audit = Audit::new(subject);
            let still = vec![0.0; small.len()];
            let found = audit.check([&still, &small], (&[], &[]), true);
            assert!(found.is_ok(), "{cell}, {angle}: {}", found.unwrap_err().reason);
            if closes {
                let said = audit.check([&small, &shut], (&[], &[]), true).unwrap_err().reason;
                assert!(said.contains("itself"), "{cell}: {said}");
            }
        }
    }
}
