//! Curved boundaries: raised cells of second degree follow them, and contact takes those that do not for what they stand for.

mod support;

use asperity::deck::{build, read_with};
use asperity::mesh::Mesh;
use asperity::model::Model;
use std::path::Path;
use support::{columns, made, run};

/// Rings pressed into one another with an interference of 0.03 or what else the mesh has.
fn rings(mesh: &str, contact: &str) -> String {
    format!(
        "version = 1
        space = \"plane-strain\"
        {mesh}
        material.m.elastic = {{ young = 210e3, poisson = 0.3 }}
        body.i = {{ material = \"m\" }}
        body.o = {{ material = \"m\" }}
        contact.c = {{ surface = \"i.outer\", target = \"o.inner\", law.frictionless = {{}}{contact} }}
        [[step]]
        increments.count = 1
        symmetry = [\"i.start\", \"i.end\", \"o.start\", \"o.end\"]"
    )
}

/// Pressure of that fit by Lame.
const LAME: f64 = 34.27;

fn annuli(cell: &str, outer: f64) -> String {
    format!(
        "mesh.part.i.annulus = {{ from = [16.0, 0.0], to = [{outer}, 90.0], cells = [3, 20], cell = \"{cell}\" }}
        mesh.part.o.annulus = {{ from = [19.985, 0.0], to = [24.0, 90.0], cells = [3, 26], cell = \"{cell}\" }}"
    )
}

fn max_pressure(model: &Model) -> f64 {
    columns(model, &run(model))["contact.c.max_pressure"][0]
}

/// Mean of the pressures over that of the fit less one, and the largest difference of one at a node, likewise.
fn errors(model: &Model) -> [f64; 2] {
    let state = run(model).states.remove(0);
    let records = model.field_contacts[0].records(&state.u, &state.histories[model.first_contact()]);
    let area = records.iter().map(|record| record.area).sum::<f64>();
    let mean = records.iter().map(|record| record.pressure * record.area).sum::<f64>() / area;
    let off = records.iter().map(|record| (record.pressure / LAME - 1.0).abs());
    [mean / LAME - 1.0, off.fold(0.0, f64::max)]
}

/// Triangles that are raised by themselves, and quadrilaterals that are asked to be, carry the pressure of a press fit.
#[test]
fn a_press_fit_of_raised_cells_has_its_pressure() {
    for (cell, degree) in [("tri3", ""), ("quad4", ", degree = 2")] {
        let deck = rings(&annuli(cell, 20.015), "").replace("\"m\" }", &format!("\"m\"{degree} }}"));
        let made = made(&deck, &[]);
        assert!(made.model.mesh.kinds.iter().all(|kind| kind.degree == 2), "{cell}");
        let found = max_pressure(&made.model) / LAME;
        assert!((0.97..1.06).contains(&found), "{cell}: {found}");
    }
}

/// A mesh of second degree with straight edges, as some meshers write it, carries the pressure of the circles too.
#[test]
fn straight_edges_of_second_degree_stand_for_circles() {
    let straight = |outer: f64| -> Mesh {
        let mut mesh = (*made(&rings(&annuli("tri6", outer), ""), &[]).model.mesh).clone();
        for cell in 0..mesh.cell_count() {
            let view = mesh.cell(cell);
            let middles: Vec<_> =
                view.kind.middles().map(|(m, ends)| (view.nodes[m], ends.map(|e| view.nodes[e]))).collect();
            for (middle, [a, b]) in middles {
                mesh.points[middle] = (mesh.points[a] + mesh.points[b]) * 0.5;
            }
        }
        mesh
    };
    let made = |outer: f64, contact: &str, step: &str| {
        let deck = rings("mesh.file = \"rings.msh\"", contact) + step;
        let made = read_with(&deck, "test.toml", Path::new(""), &[], Some(straight(outer))).and_then(build);
        made.unwrap_or_else(|found| panic!("{}", found.render(false))).model
    };
    let press = made(20.015, "", "");
    let [mean, off] = errors(&press);
    assert!(mean.abs() < 0.02 && off < 0.1, "{mean} {off}");
    // Without a gap the two are one ring under the pressure outside.
    let fit = made(19.985, ", overlap = \"fit\"", "\npressure.\"o.outer\" = { value = 100.0 }");
    let keep = run(&fit);
    let state = &keep.states[0];
    let records = fit.field_contacts[0].records(&state.u, &state.histories[fit.first_contact()]);
    let exact = 100.0 * 576.0 / 320.0 * (1.0 - 256.0 / (19.985 * 19.985));
    for record in records {
        assert!((record.pressure / exact - 1.0).abs() < 0.05, "{} of {exact}", record.pressure);
    }
}

/// A pin that is moved in a hole of its own radius or a little larger bears as much with chords of first degree, which stand off by as much as
/// the motion, as with those of second degree.
#[test]
fn a_pin_in_a_hole_of_its_radius_bears_on_its_circle() {
    let deck = |cell: &str| {
        format!(
            "version = 1
            space = \"plane-strain\"
            mesh.part.pin.annulus = {{ from = [6.0, -90.0], to = [10.0, 90.0], cells = [3, 37], cell = \"{cell}\" }}
            mesh.part.hole.annulus = {{ from = [10.0, -90.0], to = [20.0, 90.0], cells = [5, 48], cell = \"{cell}\" }}
            material.steel.elastic = {{ young = 2e5, poisson = 0.3 }}
            body.pin.material = \"steel\"
            body.hole.material = \"steel\"
            contact.fit = {{ surface = \"pin.outer\", target = \"hole.inner\", law.frictionless = {{}} }}
            [[step]]
            increments.count = 1
            displacement.\"pin.inner\" = {{ x = 0.0, y = -0.006 }}
            displacement.\"hole.outer\" = {{ x = 0.0, y = 0.0 }}
            displacement.\"pin.start\".x = 0.0
            displacement.\"pin.end\".x = 0.0
            displacement.\"hole.start\".x = 0.0
            displacement.\"hole.end\".x = 0.0"
        )
    };
    let narrow = |cell: &str| made(&deck(cell), &[]).model;
    // With a clearance it is the motion beyond that which presses.
    let loose = |cell: &str| {
        let moved = deck(cell).replace("from = [10.0, -90.0]", "from = [10.05, -90.0]").replace("-0.006", "-0.08");
        made(&moved, &[]).model
    };
    let force = |model: Model| columns(&model, &run(&model))["contact.fit.force.y"][0];
    for models in [["quad4", "quad8"].map(narrow), ["quad4", "quad8"].map(loose)] {
        let [first, second] = models.map(force);
        assert!((first / second - 1.0).abs() < 0.03, "{first} {second}");
    }
}

/// The same rings in space with cells of first degree, `[around, along]` of each.
fn rings_in_space([i, o]: [[usize; 2]; 2]) -> Model {
    let part = |name: &str, [from, to]: [f64; 2], [around, along]: [usize; 2]| {
        format!(
            "mesh.part.{name}.box = {{ from = [{from}, 0.0, 0.0], to = [{to}, 90.0, 4.0], cells = [3, {around}, {along}], cell = \"hex8\" }}\n"
        )
    };
    let parts = part("i", [16.0, 20.015], i) + &part("o", [19.985, 24.0], o);
    let deck = |mesh: &str| {
        rings(mesh, "")
            .replace("plane-strain", "solid")
            .replace(".outer", ".right")
            .replace(".inner", ".left")
            .replace(".start", ".bottom")
            .replace("\"i.end\"", "\"i.top\"")
            .replace("\"o.end\"", "\"o.top\", \"i.back\", \"o.back\", \"i.front\", \"o.front\"")
    };
    let mut mesh = (*made(&deck(&parts), &[]).model.mesh).clone();
    for x in &mut mesh.points {
        let (sin, cos) = x[1].to_radians().sin_cos();
        (x[0], x[1]) = (x[0] * cos, x[0] * sin);
    }
    let made =
        read_with(&deck("mesh.file = \"rings.msh\""), "test.toml", Path::new(""), &[], Some(mesh)).and_then(build);
    made.unwrap_or_else(|found| panic!("{}", found.render(false))).model
}

/// Rings of facets that do not match bear the pressure of the circles that they stand for, whatever the shape of the faces.
#[test]
fn facets_of_rings_bear_the_pressure_of_their_circles() {
    let plane = |[i, o]: [usize; 2]| {
        let annuli = annuli("quad4", 20.015).replace("[3, 20]", &format!("[3, {i}]"));
        made(&rings(&annuli.replace("[3, 26]", &format!("[3, {o}]")), ""), &[]).model
    };
    for (cells, [most, at_node]) in [
        ([8, 6], [0.025, 0.12]),
        ([6, 8], [0.01, 0.08]),
        ([16, 12], [0.01, 0.03]),
        ([24, 31], [0.006, 0.006]),
        ([12, 12], [0.006, 0.012]),
    ] {
        let [i, o] = cells;
        for model in [plane(cells), rings_in_space([[i, 1], [o, 2]]), rings_in_space([[i, 3], [o, 1]])] {
            let [mean, off] = errors(&model);
            assert!(mean.abs() < most && off < at_node, "{cells:?}: {mean} {off}");
        }
    }
}

/// Three to five edges of second degree on a quarter, whose parabolas are up to a tenth of the interference off their circles.
#[test]
fn coarse_edges_of_second_degree_bear_as_their_circles() {
    for cell in ["quad8", "tri6", "quad9"] {
        for [i, o] in [[3, 4], [4, 3], [3, 3], [5, 4]] {
            let annuli = annuli(cell, 20.015).replace("[3, 20]", &format!("[3, {i}]"));
            let model = made(&rings(&annuli.replace("[3, 26]", &format!("[3, {o}]")), ""), &[]).model;
            let [mean, off] = errors(&model);
            assert!(mean.abs() < 0.01 && off < 0.16, "{cell} {i} {o}: {mean} {off}");
        }
    }
}

/// A sheet that is clamped at the lowest place of a drum and bent away from it by a roller that goes round does not touch the drum: the chord beside the clamp would.
#[test]
fn chords_of_a_sheet_that_bends_are_those_of_its_arc() {
    let deck = "version = 1
        space = \"plane-strain\"
        mesh.part.s.rectangle = { from = [0.0, 0.0], to = [40.0, 0.5], cells = [40, 1], cell = \"quad4\" }
        material.m.elastic = { young = 1e4, poisson = 0.3 }
        body.s.material = \"m\"
        tool.drum.profile = [{ arc = [[0.0, 16.5], [-8.0, 8.5], [0.0, 0.5]] }, { arc = [[0.0, 0.5], [8.0, 8.5], [0.0, 16.5]] }]
        tool.roll.profile = [{ arc = [[14.0, -4.0], [12.0, -2.0], [10.0, -4.0]] }, { arc = [[10.0, -4.0], [12.0, -6.0], [14.0, -4.0]] }]
        tool.roll.reference = [0.0, 8.5]
        contact.d = { surface = \"s.top\", target = \"drum\", law.frictionless = {} }
        contact.r = { surface = \"s.bottom\", target = \"roll\", law.frictionless = {} }
        [[step]]
        displacement.\"s.left\" = { x = 0.0, y = 0.0 }
        motion.roll = { y = 1.9, rotation = 0.0 }
        [[step]]
        motion.roll = { y = 1.9, rotation = 120.0 }";
    let made = made(deck, &[]);
    let columns = columns(&made.model, &run(&made.model));
    let forces = &columns["contact.d.thrust"];
    // The first increments that bend it know nothing of what it will be.
    let late = &forces[forces.len() * 2 / 3..];
    assert!(late.iter().all(|force| force.abs() < 0.1), "{late:?}");
}

/// Of a disc in chords that is dragged over a block the flat side carries: friction is that of the law.
#[test]
fn a_flat_side_carries_beside_chords() {
    for cells in [12, 16, 24] {
        let deck = format!(
            "version = 1
            space = \"plane-strain\"
            mesh.part.d.annulus = {{ from = [3.0, -180.0], to = [10.0, 0.0], cells = [4, {cells}], cell = \"quad4\" }}
            mesh.part.b.rectangle = {{ from = [-16.0, -16.0], to = [16.0, -10.0], cells = [21, 4], cell = \"quad4\" }}
            material.m.elastic = {{ young = 100.0, poisson = 0.3 }}
            body.d.material = \"m\"
            body.b.material = \"m\"
            contact.c = {{ surface = \"d.outer\", target = \"b.top\", law.coulomb.friction = 0.3 }}
            [[step]]
            displacement.\"b.bottom\" = {{ x = 0.0, y = 0.0 }}
            displacement.\"d.inner\" = {{ x = 0.0, y = -0.5 }}
            [[step]]
            displacement.\"d.inner\" = {{ x = 3.0, y = -0.5 }}"
        );
        let made = made(&deck, &[]);
        let columns = columns(&made.model, &run(&made.model));
        let ratios = columns["contact.c.force.x"].iter().zip(&columns["contact.c.force.y"]).map(|(x, y)| (x / y).abs());
        let all: Vec<f64> = ratios.collect();
        let sliding = &all[all.len() - 5..];
        assert!(sliding.iter().all(|ratio| (ratio / 0.3 - 1.0).abs() < 0.03), "{cells}: {sliding:?}");
    }
}

/// Blocks of which the upper one ends a little beyond a row of nodes of the lower, which carries: the pressure beyond is not what the field goes on to.
#[test]
fn nodes_beyond_what_touches_have_its_pressure() {
    for cell in ["hex8", "hex20"] {
        for width in [2.02, 2.1, 2.4] {
            let deck = format!(
                "version = 1
                space = \"solid\"
                mesh.part.l.box = {{ from = [0.0, 0.0, 0.0], to = [4.0, 1.0, 1.0], cells = [4, 1, 1], cell = \"{cell}\" }}
                mesh.part.u.box = {{ from = [0.0, 0.0, 1.0], to = [{width}, 1.0, 2.0], cells = [3, 1, 1], cell = \"{cell}\" }}
                material.m.elastic = {{ young = 1e3, poisson = 0.3 }}
                body.l.material = \"m\"
                body.u.material = \"m\"
                contact.c = {{ surface = \"l.front\", target = \"u.back\", law.frictionless = {{}}, roles = \"given\" }}
                [[step]]
                symmetry = [\"l.back\", \"l.left\", \"u.left\", \"l.bottom\", \"l.top\", \"u.bottom\", \"u.top\"]
                pressure.\"u.front\" = {{ value = 1.0 }}"
            );
            let made = made(&deck, &[]);
            let columns = columns(&made.model, &run(&made.model));
            let [most, thrust] =
                ["max_pressure", "thrust"].map(|name| *columns[&format!("contact.c.{name}")].last().unwrap());
            assert!(most < 1.7 && (thrust / width - 1.0).abs() < 1e-2, "{cell} {width}: {most} {thrust}");
        }
    }
}

/// A disc of facets on a flat tool bears what its circle would, and a ring of them in a round bore that it grows into.
#[test]
fn facets_on_a_tool_bear_as_their_circle() {
    let disc = |cell: &str, cells: usize| {
        format!(
            "version = 1
            space = \"plane-strain\"
            mesh.part.disc.annulus = {{ from = [2.0, -90.0], to = [5.0, 0.0], cells = [8, {cells}], cell = \"{cell}\" }}
            material.rubber.elastic = {{ young = 1e3, poisson = 0.3 }}
            body.disc.material = \"rubber\"
            tool.floor.profile = [{{ line = [[20.0, -5.0], [-20.0, -5.0]] }}]
            contact.c = {{ surface = \"disc.outer\", target = \"floor\", law.frictionless = {{}} }}
            [[step]]
            displacement.\"disc.start\" = {{ x = 0.0 }}
            displacement.\"disc.end\" = {{ y = -0.05 }}"
        )
    };
    let bore = |cell: &str, cells: usize| {
        format!(
            "version = 1
            space = \"plane-strain\"
            mesh.part.ring.annulus = {{ from = [12.0, 0.0], to = [24.99, 90.0], cells = [6, {cells}], cell = \"{cell}\" }}
            material.steel.elastic = {{ young = 2.1e5, poisson = 0.3 }}
            body.ring.material = \"steel\"
            tool.bore.profile = [{{ arc = [[0.0, 25.0], [17.67766953, 17.67766953], [25.0, 0.0]] }}]
            contact.c = {{ surface = \"ring.outer\", target = \"bore\", law.frictionless = {{}} }}
            [[step]]
            symmetry = [\"ring.start\", \"ring.end\"]
            pressure.\"ring.inner\" = {{ value = 200.0 }}"
        )
    };
    let thrust = |deck: String| {
        let made = made(&deck, &[]).model;
        *columns(&made, &run(&made))["contact.c.thrust"].last().unwrap()
    };
    let (flat, round) = (thrust(disc("quad8", 60)), thrust(bore("quad8", 24)));
    // Chords that grow to five times their length stand for the same circle.
    let graded = bore("quad4", 16)
        .replace("from = [12.0, 0.0], to = [24.99, 90.0], cells = [6, 16]", "from = [12.0, 0.0], along_radius = [{ to = 24.99, cells = 6 }], along_angle = [{ to = 90.0, cells = 16, ratio = 5.0 }]");
    assert!(graded.contains("ratio"));
    for (found, exact, within) in [
        (thrust(disc("quad4", 18)), flat, 0.06),
        (thrust(disc("quad4", 36)), flat, 0.04),
        (thrust(bore("quad4", 12)), round, 0.02),
        (thrust(bore("quad4", 24)), round, 0.02),
        (thrust(graded), round, 0.02),
    ] {
        assert!((found / exact - 1.0).abs() < within, "{found} {exact}");
    }
}
