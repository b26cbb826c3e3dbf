//! Surfaces that are glued: a uniform stress passes through meshes that do not match, turning strains nothing, rings agree
//! with one that is whole.

mod support;

use asperity::contact::field::MeanCondition;
use asperity::model::Model;
use asperity::tensor::Vec3;
use support::{made, model, run};

/// Two blocks in the plane, `CELLS` of `low` and `up`.
fn blocks(space: &str, [low, up]: [&str; 2]) -> String {
    format!(
        r#"
version = 1
space = "{space}"
mesh.part.low.rectangle = {{ from = [0.0, 0.0], to = [3.0, 1.0], cells = [5, 2], ratio = [1.7, 1.0], cell = "{low}" }}
mesh.part.up.rectangle = {{ from = [0.0, 1.0], to = [3.0, 2.0], cells = [7, 3], ratio = [0.6, 1.0], cell = "{up}" }}
material.m.elastic = {{ young = 10.0, poisson = 0.3 }}
body.low.material = "m"
body.up.material = "m"
solver.tolerance = 1e-12
[[tie]]
surface = "up.bottom"
target = "low.top"
[[step]]
increments = {{ count = 2 }}
symmetry = ["low.left", "up.left", "low.bottom"]
pressure."up.top" = {{ value = 3.0 }}
"#
    )
}

/// The same in space.
fn boxes([low, up]: [&str; 2]) -> String {
    let deck = blocks("solid", [low, up]);
    let deck = deck
        .replace("rectangle", "box")
        .replace("from = [0.0, 0.0], to = [3.0, 1.0]", "from = [0.0, 0.0, 0.0], to = [3.0, 1.0, 2.0]");
    let deck = deck.replace("from = [0.0, 1.0], to = [3.0, 2.0]", "from = [0.0, 1.0, 0.0], to = [3.0, 2.0, 2.0]");
    let deck = deck.replace("[5, 2], ratio = [1.7, 1.0]", "[3, 2, 2], ratio = [1.7, 1.0, 1.3]");
    let deck = deck.replace("[7, 3], ratio = [0.6, 1.0]", "[2, 2, 3], ratio = [0.6, 1.0, 1.0]");
    deck.replace("\"low.bottom\"]", "\"low.bottom\", \"low.back\", \"up.back\"]")
}

/// Largest difference of a stress from the mean, over the pressure.
fn scatter(deck: &str) -> f64 {
    let model = model(deck, &[]);
    let keep = run(&model);
    let state = keep.states.last().unwrap();
    let bodies = model.bodies.iter().zip(&state.histories);
    let stresses: Vec<Vec<f64>> = bodies
        .flat_map(|((body, _), history)| body.records(&state.u, history))
        .map(|record| record.state[..4].to_vec())
        .collect();
    let mean = |k: usize| stresses.iter().map(|s| s[k]).sum::<f64>() / stresses.len() as f64;
    let means = [0, 1, 2, 3].map(mean);
    stresses.iter().flat_map(|s| (0..4).map(|k| (s[k] - means[k]).abs() / 3.0)).fold(0.0, f64::max)
}

#[test]
fn a_uniform_stress_passes() {
    for space in ["plane-strain", "plane-stress", "axisymmetric"] {
        for cells in [["quad4", "quad4"], ["quad8", "quad8"], ["quad4", "tri6"], ["tri6", "quad9"]] {
            let scatter = scatter(&blocks(space, cells));
            assert!(scatter < 1e-12, "{space} {cells:?}: {scatter:e}");
        }
    }
    for cells in [["hex8", "hex8"], ["hex20", "hex20"], ["tet10", "hex27"], ["tet4", "wedge15"]] {
        let scatter = scatter(&boxes(cells));
        assert!(scatter < 1e-12, "{cells:?}: {scatter:e}");
    }
}

/// Four blocks meet in a point, where each is tied to two others.
#[test]
fn a_uniform_stress_passes_where_four_meet() {
    for cell in ["quad4", "quad8"] {
        let part = |name: &str, from: [f64; 2], cells: [usize; 2]| {
            let to = from.map(|x| x + 1.0);
            format!(
                "mesh.part.{name}.rectangle = {{ from = {from:?}, to = {to:?}, cells = {cells:?}, cell = \"{cell}\" }}\nbody.{name}.material = \"m\"\n"
            )
        };
        let parts = [
            ("a", [0.0, 0.0], [3, 2]),
            ("b", [1.0, 0.0], [2, 3]),
            ("c", [0.0, 1.0], [4, 3]),
            ("d", [1.0, 1.0], [5, 4]),
        ];
        let parts: String = parts.into_iter().map(|(name, from, cells)| part(name, from, cells)).collect();
        let pairs = [("b.left", "a.right"), ("d.left", "c.right"), ("c.bottom", "a.top"), ("d.bottom", "b.top")];
        let ties: String = pairs
            .map(|(surface, target)| format!("[[tie]]\nsurface = \"{surface}\"\ntarget = \"{target}\"\n"))
            .concat();
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
material.m.elastic = {{ young = 10.0, poisson = 0.3 }}
solver.tolerance = 1e-12
{parts}{ties}
[[step]]
increments = {{ count = 2 }}
symmetry = ["a.left", "c.left", "a.bottom", "b.bottom"]
pressure."c.top" = {{ value = 3.0 }}
pressure."d.top" = {{ value = 3.0 }}
"#
        );
        let scatter = scatter(&deck);
        assert!(scatter < 1e-12, "{cell}: {scatter:e}");
    }
}

/// A bar glued to a shorter one, both stretched alike along the interface; faces and a part of a face reach beyond.
#[test]
fn what_reaches_beyond_the_target_is_told_and_free() {
    for (space, cells) in
        [("plane-strain", ["quad4", "quad8"]), ("plane-stress", ["quad8", "quad4"]), ("solid", ["hex8", "hex20"])]
    {
        let deck = if space == "solid" { boxes(cells) } else { blocks(space, cells) };
        let deck = deck.replace("to = [3.0, 1.0", "to = [2.1, 1.0").replace("count = 2", "count = 1").replace(
            "pressure.\"up.top\" = { value = 3.0 }",
            "displacement.\"low.right\" = { x = 0.021 }\ndisplacement.\"up.right\" = { x = 0.03 }",
        );
        let made = made(&deck, &[]);
        let notes: Vec<&str> = made.diagnostics.list.iter().map(|note| note.what.as_str()).collect();
        let told = "0.300 of the area of `up.bottom` has no face of `low.top` opposite and is not glued";
        assert!(notes.iter().any(|note| note.contains(told) && note.contains("follow nothing")), "{notes:?}");
        let states = run(&made.model).states;
        let (mesh, u) = (&made.model.mesh, &states[0].u);
        let per = if space == "solid" { 3 } else { 2 };
        for (node, x) in mesh.points.iter().enumerate() {
            assert!((u[per * node] - 0.01 * x[0]).abs() < 1e-11, "{space} {cells:?}: {} at {x:?}", u[per * node]);
        }
    }
}

/// Two quarters of rings, one in the other.
fn rings(cell: &str) -> Model {
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.in.annulus = {{ centre = [0.0, 0.0], from = [1.0, 0.0], to = [2.0, 90.0], cells = [3, 7], cell = "{cell}" }}
mesh.part.out.annulus = {{ centre = [0.0, 0.0], from = [2.0, 0.0], to = [3.0, 90.0], cells = [3, 10], cell = "{cell}" }}
material.m.elastic = {{ young = 10.0, poisson = 0.3 }}
body.in.material = "m"
body.out.material = "m"
tie = [{{ surface = "out.inner", target = "in.outer" }}]
[[step]]
increments = {{ count = 1 }}
symmetry = ["in.start", "in.end", "out.start", "out.end"]
pressure."in.inner" = {{ value = 1e-3 }}
"#
    );
    model(&deck, &[])
}

/// The nodes of a curved surface are moved so that whatever turns target and surface as one is followed exactly.
#[test]
fn turning_both_sides_strains_nothing() {
    for cell in ["quad4", "quad8"] {
        let model = rings(cell);
        let points = &model.mesh.points;
        let tie = &model.ties[0].1;
        let ends: Vec<usize> =
            tie.nodes[0].iter().copied().filter(|&n| points[n][0] < 1e-9 || points[n][1] < 1e-9).collect();
        assert!(tie.gap > 1e-3 || cell == "quad8", "{}", tie.gap);
        // The ends stay in the planes that hold them.
        let apart = |c: &&MeanCondition| c.terms.iter().all(|(node, _)| !ends.contains(node));
        for condition in tie.conditions.iter().filter(apart) {
            let sum = condition.terms.iter().fold(Vec3::zero(), |sum, &(node, c)| sum + points[node] * c);
            assert!(sum.norm() < 1e-14, "{cell}: {sum:?}");
        }
    }
}

/// Lamé's displacements of the whole ring.
#[test]
fn a_ring_in_a_ring_is_one() {
    for (cell, allowed) in [("quad4", 0.03), ("quad8", 3e-4)] {
        let model = rings(cell);
        let keep = run(&model);
        let u = &keep.states.last().unwrap().u;
        for (node, x) in model.mesh.points.iter().enumerate() {
            let (r, moved) = (x.norm(), (x[0] * u[2 * node] + x[1] * u[2 * node + 1]) / x.norm());
            let exact = 1.3 / 10.0 * 1e-3 / 8.0 * (0.4 * r + 9.0 / r);
            assert!((moved / exact - 1.0).abs() < allowed, "{cell}: {moved} {exact} at {r}");
        }
    }
}

/// A strip glued on a layer a fourth as fine: whichever is named first, the finer one follows, and a note says so. The coarse one, following,
/// leaves the strip free between its nodes: 11 % too soft.
#[test]
fn the_finer_surface_follows() {
    let force = |tie: &str| {
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.strip.rectangle = {{ from = [0.0, 1.0], to = [8.0, 2.0], cells = [32, 4], cell = "quad4" }}
mesh.part.layer.rectangle = {{ from = [0.0, 0.0], to = [8.0, 1.0], cells = [8, 2], cell = "quad4" }}
material.m.neo_hookean = {{ shear = 1.0, bulk = 2.0 }}
body.strip.material = "m"
body.layer.material = "m"
group.pressed = {{ of = "strip.top", x = [3.4, 4.6] }}
[[tie]]
{tie}
[[step]]
increments = {{ count = 5 }}
displacement."layer.bottom" = {{ x = 0.0, y = 0.0 }}
displacement.pressed = {{ y = -0.9 }}
"#
        );
        let made = made(&deck, &[]);
        let notes = made.diagnostics.render(false);
        let columns = support::columns(&made.model, &run(&made.model));
        (columns["reaction.pressed.y"].last().copied().unwrap(), notes)
    };
    let (given, without) = force("surface = \"strip.bottom\"\ntarget = \"layer.top\"");
    let (swapped, notes) = force("surface = \"layer.top\"\ntarget = \"strip.bottom\"");
    assert!(((given - swapped) / given).abs() < 1e-9, "{given} {swapped}");
    assert!(notes.contains("4.0 times as long"), "{notes}");
    assert!(!without.contains("times as long"), "{without}");
}
