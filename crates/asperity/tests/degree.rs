//! Cells of first degree raised to second: where simplices are too few through a body to bend, and where a deck says so.

mod support;

use asperity::deck::{build, read, review};
use std::path::Path;
use support::{made, model, run};

/// A cantilever 20 long and 1 high under an end load of 1, one cell through it.
fn cantilever(cell: &str, body: &str) -> String {
    format!(
        "version = 1
        space = \"plane-strain\"
        mesh.part.b.rectangle = {{ from = [0.0, 0.0], to = [20.0, 1.0], cells = [40, 1], cell = \"{cell}\" }}
        material.m.elastic = {{ young = 1e6, poisson = 0.3 }}
        body.b = {{ material = \"m\", strain = \"small\"{body} }}
        [[step]]
        increments.count = 1
        displacement.\"b.left\" = {{ x = 0.0, y = 0.0 }}
        traction.\"b.right\" = {{ y = -1.0 }}"
    )
}

/// Kind of the cells, number of nodes, mean sinking of the tip over that of a beam with shear, and whether `check` tells of the degree.
fn bent(deck: &str) -> (&'static str, usize, f64, bool) {
    let made = made(deck, &[]);
    let told = review(&made).unwrap().text.contains("degree = 1 keeps them")
        || made.diagnostics.list.iter().any(|found| found.what.contains("degree = 1 keeps them"));
    let keep = run(&made.model);
    let (tip, u) = (&made.model.mesh.groups["b.right"].nodes, &keep.states.last().unwrap().u);
    let sinking = -tip.iter().map(|&node| u[2 * node + 1]).sum::<f64>() / tip.len() as f64;
    let beam = (4.0 * 20.0_f64.powi(3) * 0.91 + 1.2 * 20.0 * 2.6) / 1e6;
    (made.model.mesh.kinds[0].name, made.model.mesh.points.len(), sinking / beam, told)
}

#[test]
fn simplices_too_few_to_bend_are_raised() {
    for (cell, body, (kind, nodes), range, noted) in [
        ("tri3", "", ("tri6", 243), 0.98..1.0, true),
        ("tri3", ", degree = 1", ("tri3", 82), 0.2..0.3, false),
        ("tri3", ", degree = 2", ("tri6", 243), 0.98..1.0, false),
        ("tri3", ", formulation = \"standard\"", ("tri3", 82), 0.2..0.3, false),
        ("quad4", "", ("quad4", 82), 0.98..1.0, false),
        ("quad4", ", degree = 2", ("quad8", 203), 0.98..1.0, false),
    ] {
        let found = bent(&cantilever(cell, body));
        assert_eq!((found.0, found.1, found.3), (kind, nodes, noted), "{cell}{body}");
        assert!(range.contains(&found.2), "{cell}{body}: {}", found.2);
    }
}

/// A square of 20 by 20 cells bends as it should, and one of more nodes than are raised unasked keeps its own.
#[test]
fn what_is_thick_or_large_is_not_raised() {
    let cells = |cells: &str| cantilever("tri3", "").replace("[40, 1]", cells);
    for deck in [cells("[20, 20]").replace("[20.0, 1.0]", "[5.0, 5.0]"), cells("[20000, 1]")] {
        assert_eq!(made(&deck, &[]).model.mesh.kinds[0].name, "tri3");
    }
}

/// Bodies that share nodes are raised together, or not at all.
#[test]
fn bodies_that_share_nodes_have_one_degree() {
    let two = |low: &str, high: &str| {
        let halves = "group.low = { of = \"b\", y = [0.0, 0.5] }\ngroup.high = { of = \"b\", y = [0.5, 1.0] }\n";
        let of = |name: &str, more: &str| format!("body.{name} = {{ material = \"m\"{more} }}\n");
        let deck = cantilever("quad4", "").replace("[40, 1]", "[40, 2]");
        deck.replace(
            "body.b = { material = \"m\", strain = \"small\" }",
            &(halves.to_string() + &of("low", low) + &of("high", high)),
        )
    };
    let raised = model(&two(", degree = 2", ""), &[]);
    assert!(raised.mesh.kinds.iter().all(|kind| kind.name == "quad8"));
    assert_eq!(raised.mesh.points.len(), 123 + 40 * 3 + 41 * 2);
    let found =
        read(&two(", degree = 2", ", degree = 1"), "test.toml", Path::new(""), &[]).and_then(build).err().unwrap();
    assert!(found.list.iter().any(|found| found.what.contains("share nodes")), "{found:?}");
    let second = cantilever("quad8", ", degree = 1");
    let found = read(&second, "test.toml", Path::new(""), &[]).and_then(build).err().unwrap();
    assert!(found.list.iter().any(|found| found.what.contains("of second degree")), "{found:?}");
}

/// Temperatures said of the corners alone hold between them: a bar with `T = x` that is free grows by `alpha x^2 / 2`.
#[test]
fn nodes_between_corners_have_their_temperature() {
    let deck = cantilever("quad4", ", degree = 2, expansion = 1e-3").replace("[40, 1]", "[4, 1]");
    let (head, _) = deck.split_once("displacement").unwrap();
    let corners = |node: usize| format!("[{}, {}.0]", node + 1, 5 * (node % 5));
    let nodes = (0..10).map(corners).collect::<Vec<_>>().join(", ");
    let deck = format!(
        "{head}displacement.\"b.left\" = {{ x = 0.0 }}\nsymmetry = [\"b.bottom\"]\ntemperature.b.nodes = [{nodes}]"
    )
    .replace("plane-strain", "plane-stress")
    .replace("poisson = 0.3", "poisson = 0.0");
    let model = model(&deck, &[]);
    let keep = run(&model);
    let u = &keep.states.last().unwrap().u;
    // The left end stays straight, where it would bow by alpha h^2 / 2.
    for &node in &model.mesh.groups["b.bottom"].nodes {
        let x = model.mesh.points[node][0];
        assert!((u[2 * node] - 0.5e-3 * x * x).abs() < 1e-3, "{x}: {}", u[2 * node]);
    }
}

/// Forces and springs on each node of a side or of nodes alone are those of the nodes that the mesh had, so many of them.
#[test]
fn raised_cells_keep_nodal_forces_and_springs() {
    let group = "group.end = { of = \"b\", x = [20.0, 20.0] }\nmaterial";
    let deck = |body: &str, name: &str, load: &str| {
        let (head, _) = cantilever("tri3", body)
            .replace("[40, 1]", "[40, 2]")
            .replacen("material", group, 1)
            .split_once("traction")
            .map(|(head, rest)| (head.to_string(), rest.to_string()))
            .unwrap();
        head + &load.replace("END", name)
    };
    for name in ["b.right", "end"] {
        for body in ["", ", degree = 2", ", degree = 1"] {
            let model = model(&deck(body, name, "force.\"END\" = { y = -0.1 }"), &[]);
            let found = support::columns(&model, &run(&model))["reaction.b.left.y"][0];
            assert!((found - 0.3).abs() < 1e-6, "{name}{body}: {found}");
        }
        // Three springs of 1e3 bear a load of 1.
        let load =
            "displacement.\"b.left\" = { x = 0.0 }\ntraction.\"b.right\" = { y = -1.0 }\nspring.\"END\" = { y = 1e3 }";
        let deck = deck("", name, load).replace("displacement.\"b.left\" = { x = 0.0, y = 0.0 }", "");
        let model = support::model(&deck, &[]);
        let found = support::columns(&model, &run(&model))["displacement.b.left.y"][0];
        assert!((found + 1.0 / 3e3).abs() < 1e-6, "{name}: {found}");
    }
}

/// Triangles and quadrilaterals that share nodes are raised together where the triangles are too stiff.
#[test]
fn triangles_among_quadrilaterals_are_raised_with_them() {
    let mixed = |triangles: usize| {
        let mut mesh = made(&cantilever("quad4", "").replace("[40, 1]", "[40, 2]"), &[]).model.mesh.as_ref().clone();
        let mut halved = asperity::mesh::Mesh::new();
        (halved.points, halved.numbers) = (mesh.points.clone(), mesh.numbers.clone());
        let tri3 = asperity::mesh::Cell::named("tri3").unwrap();
        for cell in 0..mesh.cell_count() {
            let view = mesh.cell(cell);
            match view.nodes {
                &[a, b, c, d] if cell % 40 < triangles => {
                    halved.push_cell(tri3, &[a, b, c]);
                    halved.push_cell(tri3, &[a, c, d]);
                }
                nodes => _ = halved.push_cell(view.kind, nodes),
            }
        }
        let all = (0..halved.cell_count()).collect();
        let ends = ["b.left", "b.right"].map(|name| (name, mesh.groups.remove(name).unwrap().nodes));
        halved.groups.insert("b".into(), asperity::mesh::Group::new(&halved, all, vec![], vec![]));
        for (name, nodes) in ends {
            let sides = halved.sides_among(&nodes);
            halved.groups.insert(name.into(), asperity::mesh::Group::new(&halved, vec![], sides, nodes));
        }
        halved
    };
    let deck = |degree: &str| {
        let deck = cantilever("quad4", degree);
        let part = deck.lines().find(|line| line.contains("rectangle")).unwrap();
        deck.replace(part, "mesh.file = \"mixed.msh\"")
    };
    for (triangles, degree, kinds) in
        [(25, "", ["tri6", "quad8"]), (25, ", degree = 1", ["tri3", "quad4"]), (1, "", ["tri3", "quad4"])]
    {
        let read = asperity::deck::read_with(&deck(degree), "test.toml", Path::new(""), &[], Some(mixed(triangles)));
        let model = read.and_then(build).unwrap_or_else(|found| panic!("{}", found.render(false))).model;
        assert!(model.mesh.kinds.iter().all(|kind| kinds.contains(&kind.name)), "{triangles}{degree}");
        let keep = run(&model);
        let (tip, u) = (&model.mesh.groups["b.right"].nodes, &keep.states.last().unwrap().u);
        let sinking = -tip.iter().map(|&node| u[2 * node + 1]).sum::<f64>() / tip.len() as f64;
        let beam = (4.0 * 20.0_f64.powi(3) * 0.91 + 1.2 * 20.0 * 2.6) / 1e6;
        let range = if kinds[0] == "tri6" {
            0.98..1.0
        } else if triangles == 1 {
            0.9..1.01
        } else {
            0.5..0.8
        };
        assert!(range.contains(&(sinking / beam)), "{triangles}{degree}: {}", sinking / beam);
    }
}

/// A thin liner of tri3 shrunk into a tri3 housing: both become tri6, and bear Lame's pressure; where the housing is kept, so is the liner.
#[test]
fn both_sides_of_a_curved_joint_are_raised_or_neither() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.liner.annulus = { from = [10.0, 0.0], to = [11.02, 90.0], cells = [1, 30], cell = "tri3" }
mesh.part.housing.annulus = { from = [11.0, 0.0], to = [20.0, 90.0], cells = [12, 30], cell = "tri3" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.liner.material = "steel"
body.housing.material = "steel"
contact.fit = { surface = "housing.inner", target = "liner.outer", law.frictionless = {} }
[[step]]
symmetry = ["liner.start", "liner.end", "housing.start", "housing.end"]
"#;
    // Pressure by the radial compliance of both rings per unit of pressure, in plane strain.
    let stiff = |a: f64, b: f64| (a * a + b * b) / (b * b - a * a) / (210e3 / 0.91);
    let (inner, outer) =
        (stiff(10.0, 11.0) - 0.3 / 0.7 / (210e3 / 0.91), stiff(11.0, 20.0) + 0.3 / 0.7 / (210e3 / 0.91));
    let pressure = 0.02 / 11.0 / (inner + outer);
    let model = model(deck, &[]);
    assert!(model.mesh.kinds.iter().all(|kind| kind.name == "tri6"));
    let columns = support::columns(&model, &run(&model));
    let largest = *columns["contact.fit.max_pressure"].last().unwrap();
    assert!((largest / pressure - 1.0).abs() < 0.03, "{largest} for {pressure}");
    let kept = support::model(deck, &["body.housing.degree=1"]);
    assert!(kept.mesh.kinds.iter().all(|kind| kind.name == "tri3"));
}
