//! Contact stress as a field of nodal values in space: exact tangents, the patch test, Coulomb's limit, the weight of stacked
//! blocks, objectivity, and a strip of one layer of cells against the plane.

mod perturbed;
mod support;

use asperity::contact::field::FieldContact;
use asperity::deck::{build, read};
use asperity::model::Model;
use asperity::system::{Dofs, State, Term};
use asperity::system::{Stencil, Stencils, check_tangent};
use perturbed::{Random, commit, instant, state};
use std::f64::consts::PI;
use std::path::Path;
use support::{Keep, columns, keep_degree, model, run};

/// Largest difference of an entry of a tangent over the largest entry.
const ALLOWED: f64 = 1e-6;
/// The same over a tool that turns by half a radian, where up to 1.4e-6 was seen, and 1.9e-6 with the chord for the slip; why is not known.
const TURNING: f64 = 1e-5;

/// A block over a tool, given by its table.
fn over_tool(cell: &str, tool: &str) -> String {
    format!(
        r#"
version = 1
space = "solid"
mesh.part.block.box = {{ from = [0.0, 0.0, 0.0], to = [1.5, 0.8, 1.0], cells = [3, 1, 2], cell = "{cell}" }}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block = {{ material = "rubber" }}
tool.die = {tool}
contact.joint = {{ surface = "block.bottom", target = "die", form = "field", tangential_penalty = 1e5, law.coulomb = {{ friction = 0.3 }} }}
[[step]]
displacement."block.top" = {{ x = 0.0, y = -0.1, z = 0.0 }}
"#
    )
}

/// Two blocks that do not match, the upper one narrower.
fn blocks(cells: [&str; 2]) -> String {
    format!(
        r#"
version = 1
space = "solid"
mesh.part.low.box = {{ from = [-0.2, -0.5, -0.1], to = [1.6, 0.0, 1.2], cells = [3, 1, 2], cell = "{}" }}
mesh.part.high.box = {{ from = [0.1, 0.0, 0.05], to = [1.1, 0.5, 0.95], cells = [2, 1, 2], cell = "{}" }}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.low = {{ material = "rubber"{} }}
body.high = {{ material = "rubber"{} }}
contact.joint = {{ surface = "high.bottom", target = "low.top", form = "field", roles = "given", tangential_penalty = 1e5, law.coulomb = {{ friction = 0.3 }} }}
[[step]]
displacement."low.bottom" = {{ x = 0.0, y = 0.0, z = 0.0 }}
displacement."high.top" = {{ x = 0.0, y = -0.1, z = 0.0 }}
"#,
        cells[0],
        cells[1],
        keep_degree(cells[0]),
        keep_degree(cells[1])
    )
}

/// Random states of a contact after random accepted ones: all nodes move by up to `size`, those of the block down and aside, and its
/// tool turns by up to `turn`.
fn look_at(
    contact: &FieldContact,
    dofs: &Dofs,
    (moving, size, turn): (&[usize], f64, [f64; 3]),
    rounds: usize,
) -> ([usize; 3], usize, f64) {
    let mut random = Random(11);
    let start = state(vec![0.0; dofs.count()], contact.initial());
    let mut motion = || {
        let mut u: Vec<f64> = (0..dofs.count()).map(|_| size * random.next()).collect();
        let down = 0.02 * random.next() - 0.02;
        let along = [0.01 * random.next(), 0.01 * random.next()];
        for &node in moving {
            let first = dofs.node(node);
            u[first] += along[0];
            u[first + 1] += down;
            u[first + 2] += along[1];
        }
        if let Some(rigid) = contact.target().as_tool().filter(|_| turn != [0.0; 3]) {
            u[rigid.unknowns()][3..].iter_mut().zip(turn).for_each(|(angle, turn)| *angle += turn * random.next());
        }
        u
    };
    let (mut met, mut skipped, mut worst) = ([0; 3], 0, 0.0_f64);
    for _ in 0..rounds {
        let Ok(accepted) = commit(contact, &start, motion()) else { continue };
        let attempt = contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
        let (u, mut stencils) = (motion(), Stencils::default());
        attempt.stencils(&u, &mut stencils).unwrap();
        let one = |(i, stencil): (usize, &Stencil)| {
            let here: Vec<f64> = stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect();
            // Steps that are small beside the slips.
            check_tangent(attempt.as_ref(), i, stencil, &here, &vec![0.02; here.len()])
        };
        let Ok(results) = stencils.list.iter().enumerate().map(one).collect::<Result<Vec<_>, _>>() else { continue };
        for result in results {
            met[usize::from(result.branch)] += 1;
            skipped += usize::from(!result.smooth);
            worst = if result.smooth { worst.max(result.error) } else { worst };
        }
    }
    (met, skipped, worst)
}

fn tangents(name: &str, deck: &str, part: &str, rounds: usize, turn: [f64; 3]) {
    let model = model(deck, &[]);
    let contact = &model.field_contacts[0];
    let moving = &model.mesh.groups[part].nodes;
    let (met, skipped, worst) = look_at(contact, &model.problem.dofs, (moving, 0.004, turn), rounds);
    let said = format!("{name}: {met:?} skipped {skipped} worst {worst:.1e}");
    assert!((met[1] > 0 || turn != [0.0; 3]) && met[2] > 2, "{said}");
    assert!(10 * skipped <= met.iter().sum::<usize>(), "{said}");
    assert!(worst < if turn == [0.0; 3] { ALLOWED } else { TURNING }, "{said}");
}

#[test]
fn tangents_over_tools_are_exact() {
    let tools = [
        ("plane", "{ plane = { at = [0.5, 0.0, 0.5], normal = [0.05, 1.0, -0.03], side = 20.0 } }"),
        ("sphere", "{ sphere = { center = [0.7, -1.42, 0.5], radius = 1.5 } }"),
        ("cylinder", "{ cylinder = { from = [-3.0, -0.74, 0.3], to = [3.0, -0.74, 0.7], radius = 0.8 } }"),
        (
            "triangle",
            "{ facets = { nodes = [[-3.0, 0.0, -3.0], [0.0, -0.01, 6.0], [6.0, 0.02, -3.0]], faces = [[1, 2, 3]] } }",
        ),
        // Borders within faces: a rim, a corner.
        ("rim", "{ cylinder = { from = [0.7, -1.0, 0.45], to = [0.72, 0.03, 0.44], radius = 0.57 } }"),
        (
            "corner",
            "{ facets = { nodes = [[-3.0, 0.0, -3.0], [0.3, -0.01, 6.0], [1.1, 0.01, 0.3]], faces = [[1, 2, 3]] } }",
        ),
        (
            "ridge",
            "{ profile = [{ line = [[1.7, -1.0], [0.73, 0.01]] }, { line = [[0.73, 0.01], [-0.3, -1.0]] }], extrude = { origin = [0.0, 0.0, -0.5], along = [0.02, 0.0, 2.0] } }",
        ),
    ];
    for (name, tool) in tools {
        for cell in ["hex8", "hex20", "tet10"] {
            tangents(&format!("{name} {cell}"), &over_tool(cell, tool), "block", 20, [0.0; 3]);
        }
    }
}

#[test]
fn tangents_between_bodies_are_exact() {
    for cells in [["hex8", "hex8"], ["tet4", "hex8"], ["hex20", "tet10"]] {
        tangents(&format!("{cells:?}"), &blocks(cells), "high", 4, [0.0; 3]);
    }
}

/// At the edges of a body functions are dual, and vertices bear that lie deep in another body.
#[test]
fn tangents_at_edges_are_exact() {
    let tools = [
        ("plane", "{ plane = { at = [0.5, 0.0, 0.5], normal = [0.05, 1.0, -0.03], side = 20.0 } }"),
        ("rim", "{ cylinder = { from = [0.7, -1.0, 0.45], to = [0.72, 0.03, 0.44], radius = 0.57 } }"),
    ];
    for (name, tool) in tools {
        for cell in ["hex8", "tet4", "wedge6"] {
            let outside =
                "group.outside = { of = \"block.bottom\", with = [\"block.left\", \"block.back\"] }\nmaterial.rubber";
            let deck =
                over_tool(cell, tool).replace("\"block.bottom\"", "\"outside\"").replace("material.rubber", outside);
            tangents(&format!("{name} {cell}"), &deck, "block", 6, [0.0; 3]);
        }
    }
    for cells in [["hex8", "hex8"], ["tet4", "hex8"], ["hex20", "tet10"]] {
        let model = model(&blocks(cells), &[]);
        let (contact, moving) = (&model.field_contacts[0], &model.mesh.groups["high"].nodes);
        let (met, skipped, worst) = look_at(contact, &model.problem.dofs, (moving, 0.04, [0.0; 3]), 20);
        assert!(
            met[1] + met[2] > 20 && 10 * skipped <= met.iter().sum::<usize>() && worst < TURNING,
            "{cells:?}: {met:?} {skipped} {worst:.1e}"
        );
    }
}

/// A slab with sharp edges is pressed into one that is held around, by a part of its thickness and by many of it, at once: its corners
/// lie in that by no more than the audit allows, as they did where the mean of their faces was all that a node felt.
#[test]
fn corners_of_a_slab_stay_on_a_soft_one() {
    for (cell, down) in [("hex8", 0.6), ("hex20", 0.6), ("tet10", 0.2), ("hex8", 1.2)] {
        let cells = if cell == "hex8" { ["[9, 2, 9]", "[4, 2, 3]"] } else { ["[5, 1, 5]", "[2, 1, 2]"] };
        let deck = format!(
            r#"
version = 1
space = "solid"
mesh.part.low.box = {{ from = [-2.0, -0.4, -2.0], to = [2.0, 0.0, 2.0], cells = {}, cell = "{cell}" }}
mesh.part.high.box = {{ from = [-0.7, 0.01, -0.6], to = [0.8, 0.41, 0.7], cells = {}, cell = "{cell}" }}
material.rubber.neo_hookean = {{ shear = 1.0, bulk = 3.0 }}
body.low.material = "rubber"
body.high.material = "rubber"
contact.joint = {{ surface = "high.bottom", target = "low.top", law.coulomb.friction = 0.2 }}
[[step]]
increments.count = {}
[step.displacement]
"low.left" = {{ x = 0.0, y = 0.0, z = 0.0 }}
"low.right" = {{ x = 0.0, y = 0.0, z = 0.0 }}
"low.back" = {{ x = 0.0, y = 0.0, z = 0.0 }}
"low.front" = {{ x = 0.0, y = 0.0, z = 0.0 }}
"high.top" = {{ x = 0.0, y = -{down}, z = 0.0 }}
"#,
            cells[0],
            cells[1],
            if down > 1.0 { 6 } else { 1 }
        );
        let model = model(&deck, &[]);
        let worst = run(&model).states.last().unwrap().worst_interpenetration.relative;
        assert!(worst < 0.1, "{cell} {down}: {worst}");
    }
}

#[test]
fn tangents_over_tools_that_turn_are_exact() {
    let tools = [
        ("plane", "{ plane = { at = [0.5, 0.0, 0.5], normal = [0.0, 1.0, 0.0], side = 20.0 } }", [0.0, 0.5, 0.0]),
        (
            "sphere",
            "{ sphere = { center = [0.7, -1.42, 0.5], radius = 1.5 }, reference = [0.7, -1.42, 0.5] }",
            [0.3, 0.5, 0.2],
        ),
        (
            "rim",
            "{ cylinder = { from = [0.7, -1.0, 0.45], to = [0.7, 0.03, 0.45], radius = 0.57 }, reference = [0.7, 0.0, 0.45] }",
            [0.0, 0.5, 0.0],
        ),
        (
            "ridge",
            "{ profile = [{ line = [[1.7, -1.0], [0.73, 0.01]] }, { line = [[0.73, 0.01], [-0.3, -1.0]] }], extrude = { origin = [0.0, 0.0, -0.5], along = [0.02, 0.0, 2.0] }, reference = [0.7, 0.0, 0.45] }",
            [0.01, 0.3, 0.2],
        ),
    ];
    for (name, tool, turn) in tools {
        for cell in ["hex8", "hex20", "tet10"] {
            tangents(&format!("{name} {cell}"), &over_tool(cell, tool), "block", 20, turn);
        }
    }
}

/// A plate pressed on a block and turned by 45 degrees, and the block turned under the plate: moment and heat depend neither on the number of
/// increments nor on which of the two turns.
#[test]
fn friction_of_a_plate_that_turns_follows_the_arc() {
    let turned = |cell: &str, count: usize, plate: bool| {
        let turn = if plate { "motion.plate = { rotation_z = 45.0 }" } else { "motion.hub = { rotation_z = -45.0 }" };
        let deck = format!(
            r#"
version = 1
space = "solid"
mesh.part.block.box = {{ from = [-1.0, -1.0, 0.0], to = [1.0, 1.0, 0.5], cells = [5, 5, 1], cell = "{cell}" }}
material.rubber.elastic = {{ young = 1e3, poisson = 0.0 }}
body.block = {{ material = "rubber"{} }}
tool.plate.plane = {{ at = [0.0, 0.0, 0.5], normal = [0.0, 0.0, -1.0], side = 8.0 }}
contact.face = {{ surface = "block.front", target = "plate", law.coulomb = {{ friction = 0.2 }} }}
rigid.hub = {{ group = "block.back", reference = [0.0, 0.0, 0.0] }}
[[step]]
motion.hub = {{ z = 0.0 }}
motion.plate = {{ z = -0.005 }}
increments.count = 1
[[step]]
{turn}
increments.count = {count}
"#,
            keep_degree(cell)
        );
        let model = model(&deck, &[]);
        let keep = run(&model);
        assert_eq!(keep.states.len(), 1 + count, "{cell}");
        let state = keep.states.last().unwrap();
        let records = model.field_contacts[0].records(&state.u, &state.histories[model.first_contact()]);
        assert!(records.iter().all(|record| (record.shear / (0.2 * record.pressure) - 1.0).abs() < 1e-10), "{cell}");
        let arm = |record: &asperity::contact::ContactRecord| record.position[0].hypot(record.position[1]);
        let limit: f64 = records.iter().map(|record| 0.2 * record.force()[2].abs() * arm(record)).sum();
        let columns = columns(&model, &keep);
        ["tool.plate.moment.z", "energy.missing"].map(|name| last(&columns, name) / limit)
    };
    for cell in ["hex8", "hex20"] {
        let often = turned(cell, 6, true);
        for plate in [true, false] {
            let once = turned(cell, 1, plate);
            assert!((once[0] / often[0] - 1.0).abs() < 1e-3, "{cell}: {once:?} {often:?}");
            assert!(once[1].abs() < 0.01, "{cell}: {once:?}");
        }
    }
}

fn last(columns: &std::collections::BTreeMap<String, Vec<f64>>, name: &str) -> f64 {
    *columns[name].last().unwrap()
}

/// A box of height 1 above `from` and length 2 with a depth, one cell high.
fn slab(name: &str, (from, depth): (f64, f64), [n, m]: [usize; 2], cell: &str) -> String {
    let to = from + 1.0;
    format!(
        "mesh.part.{name}.box = {{ from = [0.0, {from:.1}, 0.0], to = [2.0, {to:.1}, {depth:.1}], cells = [{n}, 1, {m}], cell = \"{cell}\" }}\n"
    )
}

/// Blocks of equal cross section whose meshes do not match bear a uniform pressure.
#[test]
fn uniform_pressure_passes_between_meshes_that_do_not_match() {
    for (cells, counts, allowed) in [
        (["hex8", "hex8"], [[3, 2], [2, 3]], 1e-10),
        (["tet4", "hex8"], [[2, 2], [3, 2]], 1e-8),
        (["hex20", "hex20"], [[2, 1], [1, 2]], 1e-8),
        (["tet10", "tet10"], [[2, 1], [1, 1]], 1e-8),
        (["tet10", "tet10"], [[3, 3], [2, 2]], 1e-8),
        (["tet10", "tet10"], [[2, 3], [5, 4]], 1e-8),
        (["tet10", "hex8"], [[3, 2], [2, 3]], 1e-8),
        (["tet10", "hex20"], [[2, 2], [3, 2]], 1e-8),
        (["hex20", "tet10"], [[3, 3], [2, 2]], 1e-8),
        (["wedge15", "hex20"], [[3, 2], [2, 2]], 1e-8),
    ] {
        let part = |k: usize, name: &str, from: f64| slab(name, (from, 1.5), counts[k], cells[k]);
        let deck = format!(
            r#"
version = 1
space = "solid"
{}{}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.low = {{ material = "rubber"{} }}
body.high = {{ material = "rubber"{} }}
contact.joint = {{ surface = "high.bottom", target = "low.top", form = "field", law.coulomb = {{ friction = 0.0 }} }}
[solver]
tolerance = 1e-13
[[step]]
increments.count = 1
symmetry = ["low.bottom", "low.left", "low.back", "high.left", "high.back"]
pressure."high.top" = {{ value = 10.0 }}
"#,
            part(0, "low", 0.0),
            part(1, "high", 1.0),
            keep_degree(cells[0]),
            keep_degree(cells[1])
        );
        let model = model(&deck, &[]);
        let keep: Keep = run(&model);
        let state = keep.states.last().unwrap();
        let records = model.field_contacts[0].records(&state.u, &state.histories[model.first_contact()]);
        let worst = records.iter().map(|r| (r.pressure / 10.0 - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < allowed, "{cells:?}: {worst:.1e}");
    }
}

/// Nodes of second degree moved within a flat joint, so that edges curve by a fifth of their length: places in the slivers beyond them
/// see what carries the faces on, and the pressure is uniform within a few per cent (it was up to 20 times too high).
#[test]
fn edges_that_curve_within_a_joint_spread_its_pressure() {
    const JOINT: &str = r#"
version = 1
space = "solid"
mesh.part.low.box = { from = [0.0, 0.0, 0.0], to = [4.0, 2.0, 4.0], cells = [4, 2, 4], cell = "tet10" }
mesh.part.high.box = { from = [0.0, 2.0, 0.0], to = [4.0, 4.0, 4.0], cells = [5, 2, 3], cell = "hex20" }
material.m.elastic = { young = 1e3, poisson = 0.3 }
body.low.material = "m"
body.high.material = "m"
contact.joint = { surface = "high.bottom", target = "low.top", law.frictionless = {} }
[[step]]
increments.count = 1
symmetry = ["low.left", "low.right", "low.front", "low.back", "low.bottom", "high.left", "high.right", "high.front", "high.back"]
pressure."high.top".value = 5.0
"#;
    let mut loaded = read(JOINT, "test.toml", Path::new(""), &[]).unwrap();
    for (body, phase) in [("low", 0.3), ("high", 1.1)] {
        for node in loaded.mesh.groups[body].nodes.clone() {
            let x = &mut loaded.mesh.points[node].0;
            let [u, w] = [0, 2].map(|axis| PI * x[axis] / 4.0);
            if [u, w].iter().all(|v| (1e-9..PI - 1e-9).contains(v)) {
                x[0] += 0.3 * (2.0 * u + phase).sin() * w.sin();
                x[2] += 0.3 * u.sin() * (2.0 * w + 2.0 * phase).sin();
            }
        }
    }
    let model = build(loaded).unwrap().model;
    let keep: Keep = run(&model);
    let state = keep.states.last().unwrap();
    let records = model.field_contacts[0].records(&state.u, &state.histories[model.first_contact()]);
    let worst = records.iter().map(|r| (r.pressure / 5.0 - 1.0).abs()).fold(0.0, f64::max);
    assert!(worst < 0.08, "{worst:.1e}");
}

/// Every closed node of a block that slides over a plane bears the limit, and so does their sum.
#[test]
fn a_sliding_block_bears_the_limit_of_friction() {
    for cell in ["hex8", "hex20", "tet10"] {
        for friction in [0.0, 0.1, 1.2] {
            let deck = format!(
                r#"
version = 1
space = "solid"
mesh.part.block.box = {{ from = [0.0, 0.0, 0.0], to = [2.0, 1.0, 1.0], cells = [3, 2, 2], cell = "{cell}" }}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block = {{ material = "rubber" }}
tool.floor = {{ plane = {{ at = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0], side = 40.0 }} }}
contact.joint = {{ surface = "block.bottom", target = "floor", form = "field", law.coulomb = {{ friction = {friction} }} }}
[[step]]
increments.count = 1
displacement."block.top" = {{ x = 0.0, y = -0.01, z = 0.0 }}
[[step]]
increments.count = 12
displacement."block.top" = {{ x = 6.0, y = -0.01, z = 3.0 }}
"#
            );
            let model = model(&deck, &[]);
            let keep: Keep = run(&model);
            let columns = columns(&model, &keep);
            let [x, n, z] = ["x", "y", "z"].map(|axis| last(&columns, &format!("tool.floor.force.{axis}")));
            assert!((x.hypot(z) - friction * n.abs()).abs() <= 1e-10 * n.abs(), "{cell} {friction}: {x} {n} {z}");
            let state = keep.states.last().unwrap();
            let contact = &model.field_contacts[0];
            let records = contact.records(&state.u, &state.histories[model.first_contact()]);
            let closed: Vec<_> = records.iter().filter(|record| record.pressure > 0.0).collect();
            assert!(closed.len() >= 3, "{cell} {friction}");
            closed.iter().for_each(|r| assert!((r.shear.abs() - friction * r.pressure).abs() <= 1e-10 * r.pressure));
        }
    }
}

/// The force of a flat cylinder depends little on where the mesh has its rim, and each mesh converges as usual.
#[test]
fn a_rim_may_lie_anywhere_over_a_mesh() {
    for (cell, cells) in [("hex8", 5), ("hex8", 7), ("tet10", 3), ("tet10", 4)] {
        let deck = format!(
            r#"
version = 1
space = "solid"
mesh.part.block.box = {{ from = [-1.0, 0.0, -1.0], to = [1.0, 1.0, 1.0], cells = [{cells}, 2, {cells}], cell = "{cell}" }}
material.rubber.elastic = {{ young = 100.0, poisson = 0.3 }}
body.block.material = "rubber"
tool.punch.cylinder = {{ from = [0.0, 1.0, 0.0], to = [0.0, 3.0, 0.0], radius = 0.8 }}
contact.face = {{ surface = "block.top", target = "punch", law.coulomb = {{ friction = 0.3 }} }}
[[step]]
increments.count = 4
displacement."block.bottom" = {{ x = 0.0, y = 0.0, z = 0.0 }}
motion.punch.y = -0.1
"#
        );
        let model = model(&deck, &[]);
        let keep: Keep = run(&model);
        let (state, force) = (keep.states.last().unwrap(), last(&columns(&model, &keep), "contact.face.force.y"));
        assert!(state.iterations <= 40, "{cell} {cells}: {}", state.iterations);
        // Three cells of second degree have their middles beyond the rim.
        let allowed = if (cell, cells) == ("tet10", 3) { 0.15 } else { 0.1 };
        assert!((-force / 33.8 - 1.0).abs() < allowed, "{cell} {cells}: {force}");
    }
}

/// The corners of a flowing cube roll onto the plates in large increments: a step of Newton's that leads farther away is shortened even
/// where contact changes over it (47 and 60 iterations without that).
#[test]
fn a_cube_is_upset_in_few_increments() {
    let deck = include_str!("../../../cases/upsetting/upsetting.toml");
    for (cells, increments, most) in [(5, 6, 40), (9, 10, 55)] {
        let cells = format!("mesh.part.cube.box.cells=[{cells}, {cells}, {cells}]");
        let model = model(deck, &[&cells, &format!("step.upset.increments.count={increments}")]);
        let keep: Keep = run(&model);
        let state = keep.states.last().unwrap();
        assert!(state.iterations <= most, "{cells}: {}", state.iterations);
    }
}

/// Forces on the two sides are opposite, and so are their moments about the normal part.
#[test]
fn action_is_reaction() {
    for cells in [["hex8", "hex8"], ["tet10", "hex20"]] {
        let model = model(&blocks(cells), &[]);
        let (contact, dofs) = (&model.field_contacts[0], &model.problem.dofs);
        let mut random = Random(3);
        let start = state(vec![0.0; dofs.count()], contact.initial());
        let mut motion = || {
            let mut u: Vec<f64> = (0..dofs.count()).map(|_| 0.004 * random.next()).collect();
            for &node in &model.mesh.groups["high"].nodes {
                u[dofs.node(node) + 1] -= 0.02;
                u[dofs.node(node)] += 0.02 * random.next();
            }
            u
        };
        for _ in 0..4 {
            let Some(forces) = perturbed::forces(&**contact, &start, motion(), &motion()) else { continue };
            let size: f64 = forces.iter().map(|f| f.abs()).sum();
            assert!(size > 0.0);
            for axis in 0..3 {
                let sum: f64 = forces.chunks_exact(3).map(|f| f[axis]).sum();
                assert!(sum.abs() < 1e-12 * size, "{cells:?}: {sum} of {size}");
            }
        }
    }
}

/// Blocks under their weight rest on each other with it, whatever their meshes.
#[test]
fn stacked_blocks_bear_their_weight() {
    for (cells, counts) in [(["hex8", "hex8"], [3, 2]), (["hex20", "hex20"], [1, 2]), (["tet10", "hex8"], [1, 2])] {
        for friction in [0.0, 0.4] {
            let part = |k: usize, name: &str, from: f64| slab(name, (from, 2.0), [counts[k], counts[k]], cells[k]);
            let deck = format!(
                r#"
version = 1
space = "solid"
{}{}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.low = {{ material = "rubber" }}
body.high = {{ material = "rubber" }}
tool.floor = {{ plane = {{ at = [0.0, 0.0, 0.0], normal = [0.0, 1.0, 0.0], side = 40.0 }} }}
contact.ground = {{ surface = "low.bottom", target = "floor", form = "field", law.coulomb = {{ friction = {friction} }} }}
contact.joint = {{ surface = "high.bottom", target = "low.top", form = "field", law.coulomb = {{ friction = {friction} }} }}
[solver]
tolerance = 1e-10
[[step]]
symmetry = ["low.left", "low.back", "high.left", "high.back"]
body_force.low = {{ y = -1.0 }}
body_force.high = {{ y = -1.0 }}
"#,
                part(0, "low", 0.0),
                part(1, "high", 1.0)
            );
            let model = model(&deck, &[]);
            let keep: Keep = run(&model);
            let columns = columns(&model, &keep);
            let [ground, joint] = ["ground", "joint"].map(|name| last(&columns, &format!("contact.{name}.force.y")));
            assert!(
                (ground / 8.0 - 1.0).abs() < 1e-8 && (joint / 4.0 - 1.0).abs() < 1e-8,
                "{cells:?} {ground} {joint}"
            );
        }
    }
}

/// The rotation by an angle about an axis, of a point.
fn turned([x, y, z]: [f64; 3], [a, b, c]: [f64; 3], angle: f64) -> [f64; 3] {
    let (sin, cos) = angle.sin_cos();
    let along = (a * x + b * y + c * z) * (1.0 - cos);
    [
        x * cos + (b * z - c * y) * sin + a * along,
        y * cos + (c * x - a * z) * sin + b * along,
        z * cos + (a * y - b * x) * sin + c * along,
    ]
}

/// A common rotation of 63 degrees in one increment leaves pressure and shear of every node as they are, over a tool and
/// between bodies.
#[test]
fn a_stick_state_that_is_turned_keeps_its_stress() {
    let tool = over_tool("hex8", "{ plane = { at = [0.5, -0.005, 0.5], normal = [0.002, 1.0, -0.003], side = 9.0 } }");
    let bodies = blocks(["hex8", "hex8"]);
    for (deck, top) in [(tool, "block.top"), (bodies, "high.top")] {
        let sets = [
            format!("step.1.displacement.\"{top}\"={{ x = 0.004, y = -0.02, z = 0.003 }}"),
            "contact.joint.law.coulomb.friction=0.9".to_owned(),
        ];
        let model = model(&deck, &sets.iter().map(String::as_str).collect::<Vec<_>>());
        let keep: Keep = run(&model);
        let (state, dofs) = (keep.states.last().unwrap(), &model.problem.dofs);
        let contact: &FieldContact = &model.field_contacts[0];
        let before = &state.histories[model.first_contact()];
        let (axis, angle) = ([1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0], 63.0_f64.to_radians());
        let mut u = state.u.clone();
        for (node, x) in model.mesh.points.iter().enumerate() {
            let first = dofs.node(node);
            let now = turned([0, 1, 2].map(|i| x[i] + u[first + i]), axis, angle);
            (0..3).for_each(|i| u[first + i] = now[i] - x[i]);
        }
        if top == "block.top" {
            let (first, reference) = (dofs.tool(0), model.solid_tools[0].reference().0);
            let now = turned(reference, axis, angle);
            (0..3).for_each(|i| (u[first + i], u[first + 3 + i]) = (now[i] - reference[i], axis[i] * angle));
        }
        let accepted = State { histories: vec![before.clone()], ..perturbed::state(state.u.clone(), before.clone()) };
        let turned = commit(contact, &accepted, u.clone()).unwrap();
        let [old, new] = [(&state.u, before), (&turned.u, &turned.histories[0])].map(|(u, h)| contact.records(u, h));
        assert!(old.iter().any(|record| record.shear.abs() > 0.1), "{top}");
        let most = old.iter().map(|record| record.pressure).fold(0.0, f64::max);
        let off = old
            .iter()
            .zip(&new)
            .map(|(old, new)| ((old.pressure - new.pressure).abs() / most).max((old.shear - new.shear).abs() / most));
        let worst = off.fold(0.0, f64::max);
        // Lengths to rounding, times the penalty over the pressure.
        assert!(worst < 1e-10, "{top}: {worst:.1e}");
    }
}

/// A strip of one layer of cells in space, held flat, answers as the plane does.
#[test]
fn a_strip_in_space_is_the_plane() {
    let deck = |space: &str, deep: bool| {
        let part = |name: &str, from: [f64; 2], to: [f64; 2], cells: [usize; 2]| {
            let ([a, b], [c, d], [n, m]) = (from, to, cells);
            if deep {
                format!(
                    "mesh.part.{name}.box = {{ from = [{a:.2}, {b:.2}, 0.0], to = [{c:.2}, {d:.2}, 0.5], cells = [{n}, {m}, 1], cell = \"hex8\" }}\n"
                )
            } else {
                format!(
                    "mesh.part.{name}.rectangle = {{ from = [{a:.2}, {b:.2}], to = [{c:.2}, {d:.2}], cells = [{n}, {m}], cell = \"quad4\" }}\n"
                )
            }
        };
        let floor = if deep {
            "tool.floor = { plane = { at = [0.0, -1.0, 0.0], normal = [0.0, 1.0, 0.0], side = 40.0 } }"
        } else {
            "tool.floor = { profile = [{ line = [[20.0, -1.0], [-20.0, -1.0]] }] }"
        };
        let flat = if deep { ", z = 0.0" } else { "" };
        let thick = if deep { "" } else { "thickness = 0.5\n" };
        let held = if deep { "displacement.low = { z = 0.0 }\ndisplacement.high = { z = 0.0 }\n" } else { "" };
        format!(
            r#"
version = 1
space = "{space}"
{thick}{}{}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.low = {{ material = "rubber" }}
body.high = {{ material = "rubber" }}
{floor}
contact.ground = {{ surface = "low.bottom", target = "floor", form = "field", penalty = 1e5, tangential_penalty = 1e5, law.coulomb = {{ friction = 0.3 }} }}
contact.joint = {{ surface = "high.bottom", target = "low.top", form = "field", penalty = 1e5, tangential_penalty = 1e5, roles = "given", law.coulomb = {{ friction = 0.3 }} }}
[solver]
tolerance = 1e-10
[[step]]
increments.count = 3
{held}displacement."high.top" = {{ x = 0.05, y = -0.05{flat} }}
displacement."low.left" = {{ x = 0.0{flat} }}
"#,
            part("low", [0.0, -1.0], [4.0, 0.0], [5, 1]),
            part("high", [0.5, 0.0], [3.1, 1.0], [4, 1]),
        )
    };
    let forces = |deck: String| {
        let model = model(&deck, &[]);
        let keep: Keep = run(&model);
        let columns = columns(&model, &keep);
        ["ground", "joint"].map(|name| ["x", "y"].map(|axis| last(&columns, &format!("contact.{name}.force.{axis}"))))
    };
    let (plane, space) = (forces(deck("plane-strain", false)), forces(deck("solid", true)));
    for (plane, space) in plane.iter().zip(&space) {
        let size = plane[1].abs();
        assert!((0..2).all(|axis| (plane[axis] - space[axis]).abs() < 1e-3 * size), "{plane:?} {space:?}");
    }
}

/// A rubber wheel of hex20, `around` cells around, pressed on a plane by the middle of a cell, which lies `deep` in that; its outer sides are
/// curved.
fn wheel(around: usize, friction: f64, deep: f64) -> Model {
    let node = |i: usize, j: usize, k: usize| 1 + i + 3 * (j % (2 * around) + 2 * around * k);
    let (mut nodes, mut cells, mut outer) = (String::new(), String::new(), String::new());
    for (k, j) in (0..3).flat_map(|k| (0..2 * around).map(move |j| (k, j))) {
        for i in (0..3).filter(|i| i % 2 + j % 2 + k % 2 < 2) {
            let (radius, angle) = (6.0 + 2.0 * i as f64, PI * (j as f64 - 1.0) / around as f64);
            let [x, y] = [radius * angle.cos(), radius * angle.sin()];
            nodes += &format!("{}, {x:.12}, {y:.12}, {}\n", node(i, j, k), 2 * k);
        }
    }
    let corners = [[0, 0], [2, 0], [2, 2], [0, 2]];
    for cell in 0..around {
        let at = |[i, j]: [usize; 2], k: usize| node(i, 2 * cell + j, k);
        let middle = |n: usize| [0, 1].map(|c: usize| (corners[n][c] + corners[(n + 1) % 4][c]) / 2);
        let ring = |k: usize| corners.map(|corner| at(corner, k));
        let middles = |k: usize| [0, 1, 2, 3].map(|n| at(middle(n), k));
        let all = [ring(0), ring(2), middles(0), middles(2), ring(1)].concat();
        cells += &format!("{}, {}\n", cell + 1, all.iter().map(usize::to_string).collect::<Vec<_>>().join(", "));
        outer += &format!("{}, S4\n", cell + 1);
    }
    let inner: Vec<String> = (0..3)
        .flat_map(|k| (0..2 * around).map(move |j| (j, k)))
        .filter(|(j, k)| j % 2 + k % 2 < 2)
        .map(|(j, k)| node(0, j, k).to_string())
        .collect();
    let file = format!(
        "*NODE\n{nodes}*ELEMENT, TYPE=C3D20, ELSET=wheel\n{cells}*SURFACE, NAME=outer, TYPE=ELEMENT\n{outer}*NSET, NSET=inner\n{}\n",
        inner.join(",\n")
    );
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("wheel.inp"), file).unwrap();
    let deck = format!(
        r#"
version = 1
space = "solid"
mesh.file = "wheel.inp"
material.rubber.neo_hookean = {{ shear = 1.0, bulk = 10.0 }}
body.wheel.material = "rubber"
tool.road.plane = {{ at = [0.0, {}, 2.0], normal = [0.0, 1.0, 0.0], side = 200.0 }}
contact.tread = {{ surface = "outer", target = "road", tangential_penalty = 1e3, law.coulomb = {{ friction = {friction:?} }} }}
[[step]]
increments.count = 4
displacement.inner = {{ x = 0.0, y = -0.4, z = 0.0 }}
"#,
        deep - 10.0
    );
    let made = read(&deck, "wheel.toml", folder.path(), &[]).and_then(build);
    made.unwrap_or_else(|found| panic!("{}", found.render(false))).model
}

/// A wheel is felt as soon as it touches: the field lives at all nodes of curved faces of second degree, whose mean over whole faces is
/// open until their middle lies in by their sagitta (no force at all up to 0.3). Against three times as many cells.
#[test]
fn the_middle_of_a_curved_face_is_felt() {
    let [coarse, fine] = [16, 48].map(|around| {
        let model = wheel(around, 0.0, 0.0);
        let keep: Keep = run(&model);
        columns(&model, &keep)["contact.tread.force.y"].clone()
    });
    assert!(coarse.iter().zip(&fine).all(|(a, b)| (a / b - 1.0).abs() < 0.13), "{coarse:?} {fine:?}");
}

#[test]
fn tangents_of_pieces_are_exact() {
    let model = wheel(16, 0.3, 0.25);
    let (contact, moving) = (&model.field_contacts[0], &model.mesh.groups["wheel"].nodes);
    let (met, skipped, worst) = look_at(contact, &model.problem.dofs, (moving, 0.004, [0.0; 3]), 8);
    let said = format!("{met:?} skipped {skipped} worst {worst:.1e}");
    assert!(met[1] + met[2] > 8 && 10 * skipped <= met.iter().sum::<usize>() && worst < ALLOWED, "{said}");
}
