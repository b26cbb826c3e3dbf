//! Quadrilaterals and bricks of first degree, few through a body of a law that keeps its volume, at the formulation that comes without a
//! word: they bend, and faces that are held do not make a body thin.

mod support;

use asperity::solid::Formulation;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_4};
use support::{columns, made, model, run};

/// What the first body became, and the mean displacement along `axis` of a side at the end.
fn ended(deck: &str, side: &str, axis: usize) -> (Formulation, f64) {
    let made = made(deck, &[]);
    let (model, keep) = (&made.model, run(&made.model));
    let (nodes, u) = (&model.mesh.groups[side].nodes, &keep.states.last().unwrap().u);
    let sum: f64 = nodes.iter().map(|&node| u[model.problem.dofs.node(node) + axis]).sum();
    (model.bodies[0].0.choices()[0].formulation, sum / nodes.len() as f64)
}

/// A cantilever 20 long, 1 high, nu = 0.4999, under a shear of 1, in plane strain or as one layer between planes.
fn cantilever(cell: &str, through: usize) -> String {
    let (space, part, held) = match cell {
        "quad4" => (
            "plane-strain",
            format!("rectangle = {{ from = [0.0, 0.0], to = [20.0, 1.0], cells = [40, {through}], cell = \"quad4\" }}"),
            "",
        ),
        _ => (
            "solid",
            format!(
                "box = {{ from = [0.0, 0.0, 0.0], to = [20.0, 1.0, 0.5], cells = [40, {through}, 1], cell = \"{cell}\" }}"
            ),
            "symmetry = [\"b.back\", \"b.front\"]",
        ),
    };
    format!(
        "version = 1
        space = \"{space}\"
        mesh.part.b.{part}
        material.m.elastic = {{ young = 1e6, poisson = 0.4999 }}
        body.b = {{ material = \"m\", strain = \"small\" }}
        [[step]]
        increments.count = 1
        {held}
        displacement.\"b.left\" = {{ x = 0.0, y = 0.0 }}
        traction.\"b.right\" = {{ y = -1.0 }}"
    )
}

#[test]
fn what_keeps_its_volume_bends() {
    let beam = (4.0 * 20.0_f64.powi(3) * (1.0 - 0.4999_f64.powi(2)) + 1.2 * 20.0 * 2.0 * 1.4999) / 1e6;
    for (through, formulation) in
        [(1, Formulation::Incompatible), (2, Formulation::Incompatible), (3, Formulation::FBar)]
    {
        let found = ["quad4", "hex8"].map(|cell| ended(&cantilever(cell, through), "b.right", 1));
        for (chosen, sinking) in found {
            assert_eq!(chosen, formulation, "{through}");
            assert!((-sinking / beam - 1.0).abs() < 0.05, "{through}: {}", -sinking / beam);
        }
        // F-bar shares the change of volume over the two axes of the plane or the three of space.
        let apart = if formulation == Formulation::FBar { 0.02 } else { 1e-6 };
        assert!((found[0].1 / found[1].1 - 1.0).abs() < apart, "{through}: {found:?}");
    }
}

/// One to three tetrahedra of second degree through a cantilever: with a change of volume of their own they are too soft by 65, 9 and 4 %.
#[test]
fn few_tetrahedra_that_keep_their_volume_bend() {
    let beam = (4.0 * 20.0_f64.powi(3) * (1.0 - 0.4999_f64.powi(2)) + 1.2 * 20.0 * 2.0 * 1.4999) / 1e6;
    for through in [1, 2, 3] {
        let (chosen, sinking) = ended(&cantilever("tet10", through), "b.right", 1);
        assert_eq!(chosen, Formulation::FBar, "{through}");
        assert!((0.97..1.0).contains(&(-sinking / beam)), "{through}: {}", -sinking / beam);
    }
}

/// Half of a square bar of bricks that keeps its volume: towards the held end it curves ever more across its length.
#[test]
fn bars_that_keep_their_volume_curve_across() {
    let beam = (4.0 * 20.0_f64.powi(3) + 1.2 * 20.0 * 2.0 * 1.4999) / 1e6;
    for through in [1, 2] {
        let bar = cantilever("hex8", through).replace(", \"b.front\"", "");
        let sinking = -ended(&bar, "b.right", 1).1 / beam;
        assert!((sinking - 1.0).abs() < 0.02, "{through}: {sinking}");
    }
}

/// A block of steel upset between plates that stick: one layer of bricks between planes is not thin, and what quadrilaterals are in plane
/// strain but for the axes over which F-bar shares the change of volume; with a free face it is a thin sheet.
#[test]
fn a_slice_is_not_thin() {
    let deck = |space: &str, part: &str, more: &str| {
        format!(
            "version = 1
            space = \"{space}\"
            mesh.part.b.{part}
            material.m.von_mises = {{ young = 1e3, poisson = 0.3, yield_stress = 1.0, hardening = 1.0 }}
            body.b.material = \"m\"
            [[step]]
            increments.count = 4
            {more}
            displacement.\"b.bottom\" = {{ x = 0.0, y = 0.0 }}
            displacement.\"b.top\" = {{ x = 0.0, y = -0.1 }}"
        )
    };
    let plane = "rectangle = { from = [0.0, 0.0], to = [1.0, 1.0], cells = [6, 6], cell = \"quad4\" }";
    let solid = "box = { from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 0.2], cells = [6, 6, 1], cell = \"hex8\" }";
    let held = "displacement.\"b.back\" = { z = 0.0 }\ndisplacement.\"b.front\" = { z = 0.0 }";
    let [flat, slice, sheet] =
        [("plane-strain", plane, ""), ("solid", solid, held), ("solid", solid, "symmetry = [\"b.back\"]")]
            .map(|(space, part, more)| ended(&deck(space, part, more), "b.right", 0));
    assert_eq!([flat.0, slice.0, sheet.0], [Formulation::FBar, Formulation::FBar, Formulation::Incompatible]);
    assert!((slice.1 / flat.1 - 1.0).abs() < 3e-3 && flat.1 > 0.0, "{flat:?} {slice:?}");
}

/// A pad of rubber or metal bonded at both faces is told where one to three cells of first degree lie through it, and its force is above
/// that of cells of second degree by what is said; one that is not bonded, or gives way, is not.
#[test]
fn few_cells_through_a_bonded_layer_are_told() {
    let pad = |cells: [usize; 2], cell: &str, law: &str, side: &str| {
        let deck = format!(
            "version = 1
            space = \"plane-strain\"
            mesh.part.s.rectangle = {{ from = [0.0, 0.0], to = [6.0, 1.0], cells = {cells:?}, cell = \"{cell}\" }}
            material.m.{law}
            body.s.material = \"m\"
            [[step]]
            increments.count = 1
            symmetry = [\"s.left\"]
            displacement = {{ \"s.bottom\" = {{ {side}y = 0.0 }}, \"s.top\" = {{ {side}y = -0.01 }} }}"
        );
        let made = made(&deck, &[]);
        let (columns, choice) = (columns(&made.model, &run(&made.model)), &made.model.bodies[0].0.choices()[0]);
        (columns["reaction.s.top.y"].last().unwrap().abs(), choice.advice().find(|note| note.contains("bonded")))
    };
    let (rubber, held) = ("neo_hookean = { shear = 1.0, bulk = 1000.0 }", "x = 0.0, ");
    let (exact, note) = pad([24, 8], "quad8", rubber, held);
    assert_eq!(note, None);
    assert!(pad([6, 2], "quad8", rubber, held).1.is_some_and(|note| note.starts_with("two quad8")));
    for (through, count, part) in [(1, "one", 3.0..20.0), (2, "two", 1.2..1.4), (3, "three", 1.05..1.2)] {
        let (force, note) = pad([6 * through, through], "quad4", rubber, held);
        assert!(
            note.is_some_and(|note| note.starts_with(count)) && part.contains(&(force / exact)),
            "{}",
            force / exact
        );
    }
    let metal = "von_mises = { young = 2e3, poisson = 0.3, yield_stress = 3.0, hardening = 1.0 }";
    assert!(pad([12, 2], "quad4", metal, held).1.is_some());
    for (cells, law, side) in
        [([24, 4], rubber, held), ([12, 2], rubber, ""), ([12, 2], "elastic = { young = 1.0, poisson = 0.3 }", held)]
    {
        assert_eq!(pad(cells, "quad4", law, side).1, None, "{cells:?} {law} {side}");
    }
}

/// A block of rubber, twice as wide as high and bonded below and above: F-bar, and the same is told of a quarter between planes of symmetry as of
/// the whole. Force over that of 10 x 10 x 10 cells.
#[test]
fn symmetry_is_no_surface() {
    for (cell, more) in [("hex8", 1.05..1.15), ("hex20", 1.0..1.05), ("wedge15", 1.1..1.25)] {
        let told = [("0.0", "2, 2, 2", "symmetry = [\"b.left\", \"b.back\"]"), ("-1.0", "4, 2, 4", "")].map(|(from, cells, planes)| {
            let deck = format!(
                "version = 1
                space = \"solid\"
                mesh.part.b.box = {{ from = [{from}, 0.0, {from}], to = [1.0, 1.0, 1.0], cells = [{cells}], cell = \"{cell}\" }}
                material.m.neo_hookean = {{ shear = 1.0, bulk = 1000.0 }}
                body.b.material = \"m\"
                [[step]]
                increments.count = 2
                {planes}
                displacement = {{ \"b.bottom\" = {{ x = 0.0, y = 0.0, z = 0.0 }}, \"b.top\" = {{ x = 0.0, y = -0.1, z = 0.0 }} }}"
            );
            let made = made(&deck, &[]);
            let choice = made.model.bodies[0].0.choices()[0].clone();
            assert_eq!(choice.formulation, Formulation::FBar, "{cell}");
            if !planes.is_empty() {
                let force = columns(&made.model, &run(&made.model))["reaction.b.top.y"].last().unwrap().abs();
                assert!(more.contains(&(force / 0.602)), "{cell}: {force}");
            }
            choice.advice().collect::<Vec<_>>()
        });
        assert!(told[0].len() == 1 && told[0] == told[1] && told[0][0].starts_with("two"), "{cell}: {told:?}");
    }
}

/// A quarter of a thin ring: the figure that is told of fully integrated cells of second degree is that of the closed form, with reduced integration
/// nothing is told, nor of quadrilaterals of first degree that are a little too stiff.
#[test]
fn curved_cells_are_told_to_lock() {
    let bent = |cell: &str, more: &str, [space, poisson]: [&str; 2]| {
        let deck = format!(
            "version = 1
            space = \"{space}\"
            mesh.part.b.annulus = {{ from = [19.8, 0.0], to = [20.2, 90.0], cells = [1, 8], cell = \"{cell}\" }}
            material.m.elastic = {{ young = 210e3, poisson = {poisson} }}
            body.b = {{ material = \"m\", strain = \"small\"{more} }}
            [[step]]
            increments.count = 1
            symmetry = [\"b.start\", \"b.end\"]
            traction.\"b.end\" = {{ y = -0.0025 }}"
        );
        let exact = 0.001 * 20.0_f64.powi(3) / (210e3 * 0.4_f64.powi(3) / 12.0) * (FRAC_PI_4 - FRAC_2_PI);
        let notes = made(&deck, &[]).model.bodies[0].0.choices()[0].advice().collect::<Vec<_>>();
        (-ended(&deck, "b.end", 1).1 / exact, notes)
    };
    let ring = |cell: &str, more: &str| bent(cell, more, ["plane-stress", "0.3"]);
    let rubber = |more: &str| {
        let (found, told) = bent("quad8", more, ["plane-strain", "0.499"]);
        (found / (1.0 - 0.499 * 0.499), told)
    };
    let (found, told) = ring("quad8", ", integration = \"full\"");
    assert!(
        (0.78..0.8).contains(&found) && told.len() == 1 && told[0].contains("some 26 %") && told[0].contains("reduced"),
        "{found} {told:?}"
    );
    let (found, told) = ring("quad8", ", integration = \"reduced\"");
    assert!((0.998..1.001).contains(&found) && told.is_empty(), "{found} {told:?}");
    // F-bar, in plane strain: too soft.
    let (found, told) = rubber(", integration = \"full\"");
    assert!(
        (1.26..1.29).contains(&found)
            && told.len() == 1
            && told[0].contains("too soft")
            && told[0].contains("up to 17 %"),
        "{found} {told:?}"
    );
    let (found, told) = rubber(", integration = \"reduced\"");
    assert!((0.998..1.001).contains(&found) && told.is_empty(), "{found} {told:?}");
    // Without a word, reduced.
    for (found, told) in [ring("quad8", ""), rubber(""), ring("quad8", ", formulation = \"standard\"")] {
        assert!((0.998..1.001).contains(&found) && told.is_empty(), "{found} {told:?}");
    }
    let (found, told) = ring("quad9", "");
    assert!((0.78..0.8).contains(&found) && told.len() == 1, "{found} {told:?}");
    let (found, told) = ring("quad4", "");
    assert!((0.92..0.94).contains(&found) && told.is_empty(), "{found} {told:?}");
}

/// A plate 20 long and 4 wide, held at one end and moved at the other: what it became, the force over that of `hex20` with reduced integration, and
/// what is told.
fn plate([cell, law, more]: [&str; 3], cells: [usize; 3], size: [f64; 2]) -> (Formulation, f64, Vec<String>) {
    let force = |cell: &str, cells: [usize; 3], more: &str| {
        let [high, wide] = size;
        let deck = format!(
            "version = 1
            space = \"solid\"
            mesh.part.b.box = {{ from = [0.0, 0.0, 0.0], to = [20.0, {high}, {wide}], cells = {cells:?}, cell = \"{cell}\" }}
            material.m.{law}
            body.b = {{ material = \"m\", strain = \"small\"{more} }}
            [[step]]
            increments.count = 5
            displacement.\"b.left\" = {{ x = 0.0, y = 0.0, z = 0.0 }}
            displacement.\"b.right\" = {{ y = -1.0 }}"
        );
        let made = made(&deck, &[]);
        let choice = made.model.bodies[0].0.choices()[0].clone();
        let force = *columns(&made.model, &run(&made.model))["reaction.b.right.y"].last().unwrap();
        (choice.formulation, force, choice.advice().collect())
    };
    let (formulation, found, told) = force(cell, cells, more);
    (formulation, found / force("hex20", [20, 2, 2], ", integration = \"reduced\"").1, told)
}

const RUBBER: &str = "elastic = { young = 1e3, poisson = 0.499 }";
const METAL: &str = "von_mises = { young = 1e3, poisson = 0.3, yield_stress = 1.0, hardening = 1.0 }";

/// Tetrahedra of second degree through a plate: one and two share a linear change of volume with their neighbours, as standard they are too stiff by
/// up to a fifth.
#[test]
fn few_tetrahedra_of_second_degree_bend() {
    for (law, right) in [(RUBBER, 0.98..1.02), (METAL, 1.0..1.09)] {
        let (formulation, force, told) = plate(["tet10", law, ""], [20, 1, 4], [1.0, 4.0]);
        assert_eq!((formulation, told.len()), (Formulation::FBar, 0), "{told:?}");
        assert!(right.contains(&force), "{force}");
    }
    let (_, force, told) = plate(["tet10", RUBBER, ""], [10, 1, 2], [1.0, 4.0]);
    assert!((0.98..1.02).contains(&force) && told.is_empty(), "{force} {told:?}");
    let (_, force, told) = plate(["tet10", RUBBER, ""], [20, 2, 4], [1.0, 4.0]);
    assert!((0.97..1.02).contains(&force) && told.is_empty(), "{force} {told:?}");
}

/// Bricks as long as a beam is thick, three through it: incompatible modes, with F-bar it is too stiff by a third, which is told.
#[test]
fn long_bricks_bend() {
    for law in [RUBBER, METAL] {
        let (formulation, force, told) = plate(["hex8", law, ""], [20, 3, 3], [1.0, 1.0]);
        assert_eq!((formulation, told.len()), (Formulation::Incompatible, 0), "{told:?}");
        assert!((1.0..1.08).contains(&force), "{force}");
        let (_, force, told) = plate(["hex8", law, ", formulation = \"f-bar\""], [20, 3, 3], [1.0, 1.0]);
        assert!((1.2..1.36).contains(&force) && told[0].contains("some 35 %"), "{force} {told:?}");
        assert_eq!(plate(["hex8", law, ""], [40, 3, 3], [1.0, 1.0]).0, Formulation::FBar);
    }
}

/// One brick that is pulled has an exact answer, of which nothing is told; where its strain varies it bends.
#[test]
fn what_is_stretched_evenly_does_not_bend() {
    for (moved, bends) in [
        ("symmetry = [\"b.left\", \"b.bottom\", \"b.back\"]\ndisplacement.\"b.right\".x = 0.3", false),
        ("displacement.\"b.left\" = { x = 0.0, y = 0.0, z = 0.0 }\ndisplacement.\"b.right\".y = 0.3", true),
    ] {
        let deck = format!(
            "version = 1
            space = \"solid\"
            mesh.part.b.box = {{ from = [0.0, 0.0, 0.0], to = [1.0, 1.0, 1.0], cells = [1, 1, 1], cell = \"hex8\" }}
            material.m.{METAL}
            body.b = {{ material = \"m\", formulation = \"f-bar\" }}
            [[step]]
            increments.count = 2
            {moved}"
        );
        let made = made(&deck, &[]);
        let (body, keep) = (&made.model.bodies[0].0, run(&made.model));
        assert!(body.choices()[0].advice().next().is_some());
        assert_eq!(body.bends(&keep.states.last().unwrap().u), bends, "{moved}");
    }
}

/// A strip thinner than a quarter of the cells of the block on which it slides was refused as one that the block passes through.
#[test]
fn a_strip_slides_on_a_block_of_coarse_cells() {
    for (cell, thickness, young) in [("quad4", 0.2, 1000.0), ("quad8", 0.1, 1000.0), ("quad4", 0.2, 200e3)] {
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.a.rectangle = {{ from = [0.0, -5.0], to = [10.0, 0.0], cells = [10, 5], cell = "{cell}" }}
mesh.part.s.rectangle = {{ from = [-3.0, 0.0], to = [9.0, {thickness}], cells = [30, 1], cell = "{cell}" }}
material.m.elastic = {{ young = 1000.0, poisson = 0.3 }}
material.n.elastic = {{ young = {young}, poisson = 0.3 }}
body.a.material = "m"
body.s.material = "n"
contact.c = {{ surface = "s.bottom", target = "a.top", law.coulomb.friction = 0.3 }}
group.pr = {{ of = "s.top", x = [1.9, 7.1] }}
[[step]]
displacement."a.bottom" = {{ x = 0.0, y = 0.0 }}
displacement."s.left".x = 0.0
pressure.pr = {{ value = 2.0, kind = "dead" }}
[[step]]
displacement."s.left".x = -2.0
"#
        );
        let model = model(&deck, &[]);
        let table = columns(&model, &run(&model));
        let [pulled, pressed] = ["x", "y"].map(|axis| *table[&format!("contact.c.force.{axis}")].last().unwrap());
        assert!(pressed > 9.0 && (pulled / pressed - 0.3).abs() < 0.01, "{cell} {thickness}: {pulled} {pressed}");
    }
}
