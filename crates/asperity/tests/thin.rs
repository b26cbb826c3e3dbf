//! Quadrilaterals and bricks of first degree, few through a body of a law that keeps its volume, at the formulation that comes without a
//! word: they bend, and faces that are held do not make a body thin.

mod support;

use asperity::solid::Formulation;
use support::{columns, made, run};

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
                "box = {{ from = [0.0, 0.0, 0.0], to = [20.0, 1.0, 0.5], cells = [40, {through}, 1], cell = \"hex8\" }}"
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
