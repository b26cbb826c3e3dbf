//! Contact stress as a field of nodal values: exact tangents, balance of the two sides, Coulomb's limit, the patch test,
//! curved non-matching interfaces, corners, and objectivity.

mod perturbed;
mod support;

use asperity::contact::field::FieldContact;
use asperity::model::Model;
use asperity::system::{Dofs, State, Term};
use perturbed::{Random, check, commit, instant, state};
use support::{Keep, columns, keep_degree, model, run};

/// Largest difference of an entry of a tangent over the largest entry, between bodies,
const ALLOWED: f64 = 1e-7;
/// and over a tool, where up to 1.2e-6 was seen at edges of second degree; why is not known.
const OVER_TOOLS: f64 = 1e-5;

/// A block above a tool whose profile has curved pieces, convex and concave creases, and free ends.
const OVER_TOOL: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.3, 0.0], to = [3.3, 1.0], cells = [5, 2], cell = "quad4" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.block = { material = "rubber" }
group.sole = { of = "block.bottom", with = ["block.right"] }
tool.die = { profile = [
    { arc = [[4.0, -0.02], [2.6, 0.02], [1.2, -0.02]] },
    { line = [[1.2, -0.02], [1.2, -0.6]] },
    { line = [[1.2, -0.6], [0.9, -0.6]] },
    { line = [[0.9, -0.6], [0.8, 0.01]] },
    { parabola = [[0.8, 0.01], [0.4, 0.03], [0.0, 0.01]] },
] }
contact.joint = { surface = "block.bottom", target = "die", form = "field", law.coulomb = { friction = 0.3 } }
[[step]]
displacement."block.top" = { x = 0.0, y = -0.1 }
"#;

/// A block above a wedge of 69 degrees, whose tip lies within an edge or at a node.
const OVER_WEDGE: &str = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.3, 0.0], to = [3.3, 1.0], cells = [5, 2], cell = "quad4" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.block = { material = "rubber" }
tool.wedge = { profile = [{ line = [[2.6, -1.0], [1.9, 0.0]] }, { line = [[1.9, 0.0], [1.2, -1.0]] }] }
contact.joint = { surface = "block.bottom", target = "wedge", law.coulomb = { friction = 0.3 } }
[[step]]
displacement."block.top" = { x = 0.0, y = -0.1 }
"#;

/// Two blocks that do not match, the upper one narrower.
const BLOCKS: &str = r#"
version = 1
space = "plane-strain"
mesh.part.low.rectangle = { from = [0.5, -1.0], to = [2.9, 0.0], cells = [3, 1], cell = "quad4" }
mesh.part.high.rectangle = { from = [1.1, 0.0], to = [2.5, 1.0], cells = [2, 1], cell = "quad4" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.low = { material = "rubber" }
body.high = { material = "rubber" }
contact.joint = { surface = "high.bottom", target = "low.top", form = "field", roles = "given", law.coulomb = { friction = 0.3 } }
[[step]]
displacement."low.bottom" = { x = 0.0, y = 0.0 }
displacement."high.top" = { x = 0.0, y = -0.1 }
"#;

fn second_degree(parts: &[&str]) -> Vec<String> {
    parts.iter().map(|part| format!("mesh.part.{part}.rectangle.cell=quad8")).collect()
}

fn made(deck: &str, sets: &[String]) -> Model {
    model(deck, &sets.iter().map(String::as_str).collect::<Vec<_>>())
}

/// Of a wedge, and of a roller that fits between two nodes or not.
#[test]
fn tangents_of_a_tip_are_exact() {
    let roller = |radius: f64| format!("tool.wedge.profile=[{}]", circle([1.9, 0.02 - radius], radius).join(", "));
    for (degree, shape) in [
        (1, None),
        (2, None),
        (1, Some(0.4)),
        (1, Some(3.0)),
        (2, Some(0.4)),
        (2, Some(3.0)),
        (1, Some(1.0)),
        (2, Some(1.0)),
        (1, Some(2.0)),
    ] {
        let mut sets = if degree == 2 { second_degree(&["block"]) } else { Vec::new() };
        sets.extend(shape.map(roller));
        let model = made(OVER_WEDGE, &sets);
        let (contact, moving) = (&model.field_contacts[0], &model.mesh.groups["block"].nodes);
        let (met, skipped, worst) = look_at(contact, &model.problem.dofs, (moving, 0.01));
        let name = format!("degree {degree} radius {shape:?}: {met:?} skipped {skipped} worst {worst:.1e}");
        assert!(met.iter().all(|&met| met >= 10) && 10 * skipped <= met.iter().sum::<usize>(), "{name}");
        assert!(worst < OVER_TOOLS, "{name}");
    }
}

/// Force on the tool, and pressures at its tips, where the block comes down onto it by a twentieth of an edge.
fn pressed(profile: &str) -> (f64, Vec<f64>) {
    let tool = format!("tool.wedge.profile={profile}");
    let model = model(OVER_WEDGE, &[&tool, "step.1.displacement.'block.top'.y=-0.03", "step.1.increments.count=1"]);
    let keep = run(&model);
    let state = keep.states.last().unwrap();
    let contact = &model.field_contacts[0];
    let records = contact.records(&state.u, &state.histories[model.first_contact()]);
    let nodes = contact.surface().nodes.len() * contact.target().as_tool().unwrap().pieces();
    let tips = records[nodes..].iter().map(|record| record.pressure).collect();
    (last(&columns(&model, &keep), "tool.wedge.force.y"), tips)
}

#[test]
fn a_tip_is_felt_over_a_node_and_within_an_edge_and_the_corner_of_a_punch_is_none() {
    for x in [1.5, 1.6, 1.8] {
        let [left, right] = [x - 1.0, x + 1.0];
        let (force, tips) = pressed(&format!(
            "[{{ line = [[{right}, -2.0], [{x}, 0.0]] }}, {{ line = [[{x}, 0.0], [{left}, -2.0]] }}]"
        ));
        assert!(force > 1.0 && tips.len() == 1 && tips[0] > 0.0, "{x}: {force} {tips:?}");
    }
    let sides = "{ line = [[2.4, -1.0], [2.4, 0.0]] }, { line = [[2.4, 0.0], [1.3, 0.0]] }, { line = [[1.3, 0.0], [1.3, -1.0]] }";
    let (force, tips) = pressed(&format!("[{sides}]"));
    assert!(force > 1.0 && tips.iter().all(|&pressure| pressure == 0.0), "{force} {tips:?}");
}

/// Both halves of a circle, the right one first, as segments of a profile.
fn circle([x, y]: [f64; 2], radius: f64) -> [String; 2] {
    [radius, -radius].map(|r| format!("{{ arc = [[{x}, {}], [{}, {y}], [{x}, {}]] }}", y - r, x + r, y + r))
}

/// Three-point bending: a plate upon round supports under a round punch, all of which just touch it.
fn bent(cell: &str, [nx, ny]: [usize; 2], [support, punch]: [f64; 2], (depth, increments): (f64, usize)) -> f64 {
    let tool = |name: &str, [x, y]: [f64; 2], radius: f64| {
        let profile = circle([x, y], radius).join(", ");
        format!("tool.{name} = {{ profile = [{profile}], reference = [{x}, {y}] }}\n")
    };
    let [left, right] = [("left", -15.0), ("right", 15.0)].map(|(name, x)| tool(name, [x, -support], support));
    let tools = left + &right + &tool("punch", [0.0, 2.0 + punch], punch);
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.plate.rectangle = {{ from = [-20.0, 0.0], to = [20.0, 2.0], cells = [{nx}, {ny}], cell = "{cell}" }}
material.steel.elastic = {{ young = 1e3, poisson = 0.3 }}
body.plate = {{ material = "steel" }}
{tools}
contact.a = {{ surface = "plate.bottom", target = "left", law.coulomb = {{ friction = 0.1 }} }}
contact.b = {{ surface = "plate.bottom", target = "right", law.coulomb = {{ friction = 0.1 }} }}
contact.c = {{ surface = "plate.top", target = "punch", law.coulomb = {{ friction = 0.1 }} }}
[[step]]
increments.count = {increments}
motion.punch = {{ y = -{depth} }}
spring."plate.bottom_left" = {{ x = 0.01 }}
"#
    );
    let model = made(&deck, &[]);
    -last(&columns(&model, &run(&model)), "tool.punch.force.y")
}

/// The means of the gap over the faces around a node are up to 0.06 where the plate touches, so that nothing would hold it; the
/// deflection would lack as much.
#[test]
fn a_plate_is_bent_between_round_tools_that_just_touch_it() {
    let radii = [1.5, 3.0];
    let right = bent("quad8", [160, 8], radii, (1.0, 5));
    for (cell, cells) in [("quad8", [40, 2]), ("quad8", [37, 2]), ("quad4", [40, 4]), ("quad4", [53, 4])] {
        let force = bent(cell, cells, radii, (1.0, 60));
        assert!((force / right - 1.0).abs() < 0.05, "{cell} {cells:?}: {force} for {right}");
    }
    let [quickly, slowly] = [2, 80].map(|increments| bent("quad8", [80, 4], radii, (0.05, increments)));
    assert!((slowly / quickly - 1.0).abs() < 1e-3, "{slowly} and {quickly}");
}

/// Also where its tools are large beside its edges: an edge stands into a circle by a quarter to a half of this deflection.
#[test]
fn a_plate_is_bent_a_little_between_large_round_tools() {
    for radius in [9.9, 10.1, 20.0, 24.0] {
        let right = bent("quad8", [160, 8], [radius; 2], (0.1, 5));
        for (cell, cells) in [("quad8", [16, 1]), ("quad4", [16, 2])] {
            let force = bent(cell, cells, [radius; 2], (0.1, 10));
            assert!((force / right - 1.0).abs() < 0.05, "{radius} {cell}: {force} for {right}");
        }
    }
}

/// Forces across and down on a roller that is pressed into a block by a fifth of an edge from `gap` above it in `increments`; on the half
/// of both, twice.
fn pressed_by_a_roller((radius, gap, increments): (f64, f64, usize), half: bool) -> [f64; 2] {
    let (y, depth) = (4.0 + gap + radius, gap + 0.2);
    let arcs = circle([0.0, y], radius);
    let profile = if half { &arcs[..1] } else { &arcs[..] }.join(", ");
    let (from, cells) = if half { (0.0, 5) } else { (-5.0, 10) };
    let symmetry = if half { "symmetry = [\"block.left\"]" } else { "" };
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [{from}, 0.0], to = [5.0, 4.0], cells = [{cells}, 4], cell = "quad4" }}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block = {{ material = "rubber" }}
tool.roller = {{ profile = [{profile}], reference = [0.0, {y}] }}
contact.joint = {{ surface = "block.top", target = "roller", law.frictionless = {{}} }}
[[step]]
increments.count = {increments}
displacement."block.bottom" = {{ x = 0.0, y = 0.0 }}
{symmetry}
motion.roller = {{ y = -{depth} }}
"#
    );
    let model = made(&deck, &[]);
    let columns = columns(&model, &run(&model));
    ["x", "y"].map(|axis| -last(&columns, &format!("tool.roller.force.{axis}")) * if half { 2.0 } else { 1.0 })
}

/// Where a roller comes from and in how many increments does not matter. In a valley over a node it touches both sides, of half the
/// model one with all of its area.
#[test]
fn a_roller_is_felt_wherever_it_comes_from() {
    for radius in [0.7, 1.0, 2.0, 3.5] {
        let [across, right] = pressed_by_a_roller((radius, 0.0, 4), false);
        assert!(across.abs() < 1e-6 * right, "{radius}: {across} across");
        for (gap, increments) in [(0.05, 4), (0.2, 4), (0.2, 20), (0.5, 2)] {
            let [_, force] = pressed_by_a_roller((radius, gap, increments), false);
            assert!((force / right - 1.0).abs() < 0.01, "{radius} {gap} {increments}: {force} for {right}");
        }
        let [_, half] = pressed_by_a_roller((radius, 0.1, 4), true);
        assert!((half / right - 1.0).abs() < 0.04, "{radius}: half {half} for {right}");
    }
}

/// Random states of a contact after random accepted ones: all nodes move by up to `size`, the upper ones down.
fn look_at(contact: &FieldContact, dofs: &Dofs, (moving, size): (&[usize], f64)) -> ([usize; 3], usize, f64) {
    let mut random = Random(11);
    let start = state(vec![0.0; dofs.count()], contact.initial());
    let mut motion = || {
        let mut u: Vec<f64> = (0..dofs.count()).map(|_| size * random.next()).collect();
        let down = 0.02 * random.next() - 0.02;
        let along = 0.3 * random.next();
        for &node in moving {
            u[dofs.node(node)] += along;
            u[dofs.node(node) + 1] += down;
        }
        u
    };
    let (mut met, mut skipped, mut worst) = ([0; 3], 0, 0.0_f64);
    for _ in 0..400 {
        let Ok(accepted) = commit(contact, &start, motion()) else { continue };
        let attempt = contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
        let Ok(results) = check(attempt.as_ref(), &motion()) else { continue };
        for result in results {
            met[usize::from(result.branch)] += 1;
            skipped += usize::from(!result.smooth);
            worst = if result.smooth { worst.max(result.error) } else { worst };
        }
    }
    (met, skipped, worst)
}

#[test]
fn tangents_of_the_field_are_exact() {
    let over_tool_and_crease = OVER_TOOL.replace("surface = \"block.bottom\"", "surface = \"sole\"");
    let flat = "rectangle = { from = [1.1, 0.0], to = [2.5, 1.0], cells = [2, 1]";
    let round = "annulus = { from = [9.0, -95.0], to = [10.0, -85.0], centre = [1.8, 10.0], cells = [1, 2]";
    let convex = BLOCKS.replace(flat, round).replace("high.bottom", "high.outer").replace("high.top", "high.inner");
    for (deck, part) in [(OVER_TOOL, "block"), (&over_tool_and_crease, "block"), (BLOCKS, "high"), (&convex, "high")] {
        for degree in [1, 2] {
            for space in ["plane-strain", "axisymmetric"] {
                let cell = if degree == 2 { "quad8" } else { "quad4" };
                let model = model(&deck.replace("quad4", cell), &[&format!("space={space}")]);
                let contact = &model.field_contacts[0];
                let moving = &model.mesh.groups[part].nodes;
                let (met, skipped, worst) = look_at(contact, &model.problem.dofs, (moving, 0.006));
                let name = format!("{part}, degree {degree}, {space}: {met:?} skipped {skipped} worst {worst:.1e}");
                assert!(met.iter().all(|&met| met >= 10), "{name}");
                assert!(10 * skipped <= met.iter().sum::<usize>(), "{name}");
                assert!(worst < if part == "block" { OVER_TOOLS } else { ALLOWED }, "{name}");
            }
        }
    }
}

/// A block whose sides belong to the surface as well as its foot bears a uniform pressure uniformly.
#[test]
fn a_crease_passes_the_patch_test() {
    for space in ["plane-strain", "axisymmetric"] {
        for cell in ["quad4", "quad8"] {
            let deck = format!(
                r#"
version = 1
space = "{space}"
mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [3.0, 1.0], cells = [3, 2], cell = "{cell}" }}
material.steel.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block = {{ material = "steel" }}
group.sole = {{ of = "block.bottom", with = ["block.right"] }}
tool.floor = {{ profile = [{{ line = [[20.0, 0.0], [0.0, 0.0]] }}] }}
contact.joint = {{ surface = "sole", target = "floor", law.frictionless = {{}} }}
[solver]
tolerance = 1e-12
[[step]]
increments.count = 1
symmetry = ["block.left"]
traction."block.top".y = -1.0
"#
            );
            let model = model(&deck, &[]);
            let keep = run(&model);
            let state = keep.states.last().unwrap();
            let records = model.field_contacts[0].records(&state.u, &state.histories[model.first_contact()]);
            let closed: Vec<f64> = records.iter().map(|record| record.pressure).filter(|p| *p > 0.0).collect();
            assert!(closed.len() >= 4, "{space} {cell}: {closed:?}");
            assert!(closed.iter().all(|p| (p / closed[0] - 1.0).abs() < 1e-9), "{space} {cell}: {closed:?}");
        }
    }
}

/// The sides of a rubber pad roll onto the plates that press it. Of a mean over a face its corners would go through them, fold, and have
/// the run cut or end: the force of the two meshes differs little, and that of 12 by 9 cells of second degree is 14.30.
#[test]
fn a_rubber_pad_is_pressed_between_rough_plates() {
    for [across, up] in [[8, 6], [16, 12], [24, 18]] {
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.pad.rectangle = {{ from = [0.0, 0.0], to = [4.0, 3.0], cells = [{across}, {up}], cell = "quad4" }}
material.rubber.neo_hookean = {{ shear = 1.0, bulk = 20.0 }}
body.pad.material = "rubber"
group.head = {{ of = "pad.top", with = ["pad.right"] }}
group.foot = {{ of = "pad.bottom", with = ["pad.right"] }}
tool.up.profile = [{{ line = [[-20.0, 3.0], [20.0, 3.0]] }}]
tool.down.profile = [{{ line = [[20.0, 0.0], [-20.0, 0.0]] }}]
contact.up = {{ surface = "head", target = "up", law.coulomb.friction = 0.3 }}
contact.down = {{ surface = "foot", target = "down", law.coulomb.friction = 0.3 }}
[[step]]
increments.count = 10
symmetry = ["pad.left"]
motion.up.y = -0.9
"#
        );
        let model = model(&deck, &[]);
        let keep = run(&model);
        let force = last(&columns(&model, &keep), "contact.down.force.y");
        let allowed = if across == 8 { 0.08 } else { 0.03 };
        assert!((force / 14.3 - 1.0).abs() < allowed, "{across}: {force}");
        assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none()), "{across}");
    }
}

/// A thin ring between flat plates touches them where its circle does. Of means over its edges as they are it would go in by a part of what
/// the rest stands off, 4 to 36 % of the force; 320 edges give 1.45.
#[test]
fn a_ring_of_facets_is_crushed_between_flat_plates() {
    for around in [30, 40, 80] {
        let deck = format!(
            r#"
version = 1
space = "plane-stress"
mesh.part.r.annulus = {{ from = [19.5, -90.0], to = [20.5, 90.0], cells = [1, {around}], cell = "quad4" }}
material.s.elastic = {{ young = 210e3, poisson = 0.3 }}
body.r.material = "s"
tool.lo.profile = [{{ line = [[60.0, -20.5], [-10.0, -20.5]] }}]
tool.up.profile = [{{ line = [[-10.0, 20.5], [60.0, 20.5]] }}]
contact.a = {{ surface = "r.outer", target = "lo", law.coulomb.friction = 0.1 }}
contact.b = {{ surface = "r.outer", target = "up", law.coulomb.friction = 0.1 }}
[[step]]
symmetry = ["r.start", "r.end"]
motion.up.y = -0.2
"#
        );
        let model = model(&deck, &[]);
        let force = last(&columns(&model, &run(&model)), "contact.a.force.y");
        // As it flattens its chords stand off less than they did before.
        assert!((force / 1.452 - 1.0).abs() < 0.018, "{around}: {force}");
    }
}

fn last(columns: &std::collections::BTreeMap<String, Vec<f64>>, name: &str) -> f64 {
    *columns[name].last().unwrap()
}

/// Every closed node of a block that slides over a plane bears the limit, and so does their sum.
#[test]
fn a_sliding_block_bears_the_limit_of_friction() {
    for cell in ["quad4", "quad8", "tri3", "tri6"] {
        for friction in [0.0, 0.1, 0.5, 1.2] {
            let deck = format!(
                r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [4.0, 1.0], cells = [9, 3], cell = "{cell}" }}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block = {{ material = "rubber"{} }}
tool.floor = {{ profile = [{{ line = [[20.0, 0.0], [-20.0, 0.0]] }}] }}
contact.joint = {{ surface = "block.bottom", target = "floor", form = "field", law.coulomb = {{ friction = {friction} }} }}
[[step]]
increments.count = 2
displacement."block.top" = {{ x = 0.0, y = -0.01 }}
[[step]]
increments.count = 4
displacement."block.top" = {{ x = 1.0, y = -0.01 }}
"#,
                keep_degree(cell)
            );
            let model = model(&deck, &[]);
            let keep: Keep = run(&model);
            let columns = columns(&model, &keep);
            let [t, n] = ["x", "y"].map(|axis| last(&columns, &format!("tool.floor.force.{axis}")));
            assert!((t.abs() - friction * n.abs()).abs() <= 1e-10 * n.abs(), "{cell} {friction}: {t} {n}");
            let state = keep.states.last().unwrap();
            let contact = &model.field_contacts[0];
            let records = contact.records(&state.u, &state.histories[model.first_contact()]);
            let closed = records.iter().filter(|record| record.pressure > 0.0);
            closed.for_each(|r| assert!((r.shear.abs() - friction * r.pressure).abs() <= 1e-10 * r.pressure));
        }
    }
}

/// Blocks under their weight rest on each other with it, whatever their meshes.
#[test]
fn stacked_blocks_bear_their_weight() {
    for (cell, edges) in [("quad4", [4, 5]), ("quad8", [5, 4]), ("quad8", [4, 8]), ("tri6", [3, 5])] {
        for friction in [0.0, 0.4] {
            let part = |name: &str, from: f64, edges: usize| {
                format!(
                    "mesh.part.{name}.rectangle = {{ from = [0.0, {from:.1}], to = [4.0, {:.1}], cells = [{edges}, 2], cell = \"{cell}\" }}\n",
                    from + 1.0
                )
            };
            let deck = format!(
                r#"
version = 1
space = "plane-strain"
{}{}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.low = {{ material = "rubber" }}
body.high = {{ material = "rubber" }}
tool.floor = {{ profile = [{{ line = [[20.0, 0.0], [-20.0, 0.0]] }}] }}
contact.ground = {{ surface = "low.bottom", target = "floor", form = "field", law.coulomb = {{ friction = {friction} }} }}
contact.joint = {{ surface = "high.bottom", target = "low.top", form = "field", law.coulomb = {{ friction = {friction} }} }}
[solver]
tolerance = 1e-10
[[step]]
body_force.low = {{ y = -1.0 }}
body_force.high = {{ y = -1.0 }}
displacement."low.left" = {{ x = 0.0 }}
displacement."high.left" = {{ x = 0.0 }}
"#,
                part("low", 0.0, edges[0]),
                part("high", 1.0, edges[1])
            );
            let model = model(&deck, &[]);
            let keep: Keep = run(&model);
            let columns = columns(&model, &keep);
            let [ground, joint] = ["ground", "joint"].map(|name| last(&columns, &format!("contact.{name}.force.y")));
            assert!((ground / 8.0 - 1.0).abs() < 1e-8 && (joint / 4.0 - 1.0).abs() < 1e-8, "{cell} {ground} {joint}");
        }
    }
}

fn rings(cells: [usize; 2], surface: &str, more: &str) -> String {
    let target = if surface == "inner.outer" { "outer.inner" } else { "inner.outer" };
    format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.inner.annulus = {{ from = [0.2, 0.0], to = [0.6, 90.0], cells = [10, {}], cell = "quad4" }}
mesh.part.outer.annulus = {{ from = [0.6, 0.0], to = [1.0, 90.0], cells = [10, {}], cell = "quad4" }}
material.steel.elastic = {{ young = 1e9, poisson = 0.2 }}
body.inner = {{ material = "steel" }}
body.outer = {{ material = "steel" }}
contact.joint = {{ surface = "{surface}", target = "{target}", form = "field", law.coulomb = {{ friction = 0.0 }}, {more} }}
[[step]]
symmetry = ["inner.start", "outer.start", "inner.end", "outer.end"]
pressure."outer.outer" = {{ value = 1e6 }}
increments.count = 1
"#,
        cells[0], cells[1]
    )
}

/// Lame's pressure between two rings, on facets that do not match: root mean square of the error, and open nodes.
fn ring_error(cells: [usize; 2], surface: &str, more: &str) -> (f64, usize) {
    let model = model(&rings(cells, surface, more), &[]);
    let keep: Keep = run(&model);
    let state: &State = keep.states.last().unwrap();
    let records = model.field_contacts[0].records(&state.u, &state.histories[model.first_contact()]);
    let (mut area, mut sum) = (0.0, 0.0);
    for record in &records {
        let error = record.pressure / 925_925.93 - 1.0;
        (area, sum) = (area + record.area, sum + record.area * error * error);
    }
    ((sum / area).sqrt(), records.iter().filter(|record| record.pressure == 0.0).count())
}

/// The limits are those of the mortar method with small displacements on the same meshes, see the chapter on contact.
#[test]
fn pressure_between_rings_does_not_depend_on_their_facets() {
    for (cells, own, other) in [([24, 31], 0.16, 0.28), ([48, 62], 0.06, 0.15)] {
        for surface in ["inner.outer", "outer.inner"] {
            let limit = if surface == "inner.outer" { own } else { other };
            let (error, open) = ring_error(cells, surface, "roles = \"given\"");
            assert!(error < limit && open == 0, "{cells:?} {surface}: {error} {open}");
            let (error, open) = ring_error(cells, surface, "");
            assert!(error < own && open == 0, "{cells:?} {surface} by default: {error} {open}");
            let (error, _) = ring_error(cells, surface, "roles = \"given\", overlap = \"fit\"");
            assert!(error < 0.003, "{cells:?} {surface} fitted: {error}");
        }
    }
}

/// Without friction the line of action of force and moment crosses a flat interface at the centre of the contact.
#[test]
fn the_centre_of_a_contact_is_that_of_pressure() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.low.rectangle = { from = [0.0, 0.0], to = [6.0, 2.0], cells = [5, 2], cell = "quad4" }
mesh.part.high.rectangle = { from = [0.0, 2.0], to = [6.0, 4.0], cells = [8, 2], cell = "quad4" }
material.steel.elastic = { young = 1e5, poisson = 0.3 }
body.low = { material = "steel", strain = "small" }
body.high = { material = "steel", strain = "small" }
contact.joint = { surface = "low.top", target = "high.bottom", law.frictionless = {} }
group.part = { of = "high.top", x = [3.0, 6.0] }
[[step]]
symmetry = ["low.left", "high.left", "low.bottom"]
pressure.part.value = 3.0
increments.count = 1
"#;
    let model = model(deck, &[]);
    let columns = support::columns(&model, &run(&model));
    let [force, moment, x] =
        ["force.y", "moment.z", "center.x"].map(|name| columns[&format!("contact.joint.{name}")][0]);
    assert!((x - moment / force).abs() < 1e-3, "{x} {}", moment / force);
    assert!((x - 3.0).abs() > 0.5, "not in the middle: {x}");
}

/// A block pressed into a rigid corner by two different pressures bears each of them on its own wall.
#[test]
fn a_corner_bears_two_pressures() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [2.0, 1.0], cells = [5, 3], cell = "quad4" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.block = { material = "rubber" }
tool.corner = { profile = [{ line = [[9.0, 0.0], [0.0, 0.0]] }, { line = [[0.0, 0.0], [0.0, 9.0]] }] }
contact.floor = { surface = "block.bottom", target = "corner", form = "field", law.coulomb = { friction = 0.0 } }
contact.wall = { surface = "block.left", target = "corner", form = "field", law.coulomb = { friction = 0.0 } }
[solver]
tolerance = 1e-12
[[step]]
increments.count = 1
pressure."block.top" = { value = 10.0 }
pressure."block.right" = { value = 3.0 }
"#;
    let model = model(deck, &[]);
    let keep: Keep = run(&model);
    let state = keep.states.last().unwrap();
    for (number, stress) in [(0, 10.0), (1, 3.0)] {
        let history = &state.histories[model.first_contact() + number];
        let records = model.field_contacts[number].records(&state.u, history);
        let closed: Vec<f64> = records.iter().filter(|r| r.pressure > 0.0).map(|r| r.pressure).collect();
        assert!(!closed.is_empty());
        closed.iter().for_each(|p| assert!((p / stress - 1.0).abs() < 1e-8, "{number}: {closed:?}"));
    }
}

/// A common rotation of 63 degrees in one increment leaves pressure and shear of every node as they are.
#[test]
fn a_stick_state_that_is_turned_keeps_its_stress() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [2.0, 1.0], cells = [5, 2], cell = "quad4" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.block = { material = "rubber" }
tool.floor = { profile = [{ line = [[9.0, 0.0], [-9.0, 0.0]] }] }
contact.joint = { surface = "block.bottom", target = "floor", form = "field", law.coulomb = { friction = 0.9 } }
[[step]]
increments.count = 2
displacement."block.top" = { x = 0.004, y = -0.02 }
"#;
    let model = model(deck, &[]);
    let keep: Keep = run(&model);
    let (state, dofs) = (keep.states.last().unwrap(), &model.problem.dofs);
    let contact: &FieldContact = &model.field_contacts[0];
    let before = &state.histories[model.first_contact()];
    // 63 degrees about the origin, in one increment.
    let (sin, cos) = 63.0_f64.to_radians().sin_cos();
    let mut u = state.u.clone();
    for (node, x) in model.mesh.points.iter().enumerate() {
        let first = dofs.node(node);
        let [a, b] = [x[0] + u[first], x[1] + u[first + 1]];
        (u[first], u[first + 1]) = (cos * a - sin * b - x[0], sin * a + cos * b - x[1]);
    }
    u[dofs.tool(0) + 2] = 63.0_f64.to_radians();
    let accepted = State { histories: vec![before.clone()], u: state.u.clone(), ..State::default() };
    let turned = commit(contact, &accepted, u.clone()).unwrap();
    let [old, new] = [(&state.u, before), (&turned.u, &turned.histories[0])].map(|(u, h)| contact.records(u, h));
    assert!(old.iter().any(|record| record.shear.abs() > 0.1));
    for (old, new) in old.iter().zip(&new) {
        assert!((old.pressure - new.pressure).abs() < 1e-9 * old.pressure.max(1.0), "{old:?} {new:?}");
        assert!((old.shear - new.shear).abs() < 1e-9 * old.pressure.max(1.0), "{old:?} {new:?}");
    }
}

/// A roller turned by 45 degrees on a block that stands still: heat is its friction times the arc, in one increment as in many.
#[test]
fn friction_of_a_roller_that_turns_follows_the_arc() {
    for count in [1, 4] {
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [-1.0, -1.0], to = [1.0, 0.0], cells = [20, 10], cell = "quad4" }}
material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
body.block = {{ material = "rubber" }}
tool.roller = {{ reference = [0.0, 2.0], profile = [
    {{ arc = [[0.0, 0.0], [2.0, 2.0], [0.0, 4.0]] }},
    {{ arc = [[0.0, 4.0], [-2.0, 2.0], [0.0, 0.0]] }},
] }}
contact.face = {{ surface = "block.top", target = "roller", law.coulomb = {{ friction = 0.2 }} }}
[[step]]
displacement."block.bottom" = {{ x = 0.0, y = 0.0 }}
motion.roller = {{ y = -0.02 }}
increments.count = 2
[[step]]
motion.roller = {{ rotation = 45.0 }}
increments.count = {count}
"#
        );
        let model = model(&deck, &[]);
        let columns = columns(&model, &run(&model));
        let work = last(&columns, "tool.roller.moment.z").abs() * std::f64::consts::FRAC_PI_4;
        let ratio = last(&columns, "contact.face.dissipation") / work;
        assert!((ratio - 1.0).abs() < 0.01, "{count}: {ratio}");
    }
}

/// A block sheared under a dead load on an ellipse: all nodes come to it in the increments that were asked for, and what has dilated or
/// closed is no penetration of a penalty.
#[test]
fn a_block_flows_on_an_interface_like_cam_clay() {
    for pressure in [5.0_f64, 15.0] {
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.block.rectangle = {{ from = [0.0, 0.0], to = [2.0, 1.0], cells = [6, 3], cell = "quad4" }}
material.rock.elastic = {{ young = 1e3, poisson = 0.2 }}
body.block.material = "rock"
tool.base.profile = [{{ line = [[10.0, 0.0], [-10.0, 0.0]] }}]
contact.joint = {{ surface = "block.bottom", target = "base", law.cam_clay = {{ critical_slope = 0.8, preconsolidation = 20.0 }} }}
[[step]]
displacement."block.top" = {{ x = 0.0 }}
pressure."block.top" = {{ value = {pressure:?} }}
increments.count = 4
[[step]]
displacement."block.top" = {{ x = 0.1 }}
pressure."block.top" = {{ value = {pressure:?} }}
increments.count = 20
"#
        );
        let model = model(&deck, &[]);
        let keep = run(&model);
        assert!(keep.attempts.len() == 24 && keep.attempts.iter().all(|attempt| attempt.failure.is_none()));
        let state = keep.states.last().unwrap();
        let records = model.field_contacts[0].records(&state.u, &state.histories[model.first_contact()]);
        // Up to where it meets the ellipse the law has a cone of ten times the critical slope in place of that's blunt end.
        let flows = |p: f64, shear: f64| match p < 0.64 * 20.0 / (64.0 + 0.64) {
            true => (shear.abs() - 8.0 * p).abs() < 1e-9 * 20.0,
            false => (shear * shear + 0.64 * p * (p - 20.0)).abs() < 1e-9 * 400.0,
        };
        assert!(records.iter().all(|record| flows(record.pressure, record.shear)), "{records:?}");
        let certificate = support::certificate(&model, &keep);
        let wasted = certificate.figure("penalty_energy").unwrap();
        assert!(wasted < 0.05, "{pressure}: {wasted}");
    }
}

/// A strip that is peeled off a plane, pulled along it at its end: the shear stress is gone as each node opens.
#[test]
fn bonds_are_peeled() {
    for law in [
        "cohesive = { friction = 0.3, cohesion = 20.0, tension = 1.0 }",
        "dilatant = { friction = 0.3, dilatancy = 0.1, dilation_slip = 0.01, cohesion = 2.0 }",
    ] {
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.strip.rectangle = {{ from = [0.0, 0.0], to = [8.0, 0.5], cells = [16, 2], cell = "quad8" }}
material.foam.elastic = {{ young = 1000.0, poisson = 0.3 }}
body.strip.material = "foam"
tool.plane.profile = [{{ line = [[90.0, 0.0], [-90.0, 0.0]] }}]
contact.sole = {{ surface = "strip.bottom", target = "plane", law.{law} }}
[[step]]
increments.count = 10
symmetry = ["strip.left"]
displacement."strip.right" = {{ x = 0.1, y = 0.5 }}
pressure."strip.top".value = 0.1
"#
        );
        let model = model(&deck, &[]);
        let columns = columns(&model, &run(&model));
        assert!(*columns["contact.sole.area"].last().unwrap() < 4.0, "{law}");
    }
}
