//! Bonds that break: where and when is a matter of the loads, and not of increments or iterations.

mod support;

use support::{columns, model, run};

/// Force at the end and largest force on the upper arm of a double cantilever beam whose arms are glued from a third of their length on,
/// energy of bonds, what was set free beyond it, and what is missing.
fn peeled(increments: usize) -> [f64; 5] {
    let deck = format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.up.rectangle = {{ from = [0.0, 0.0], to = [60.0, 2.0], cells = [120, 2], cell = "quad4" }}
mesh.part.lo.rectangle = {{ from = [0.0, -2.0], to = [60.0, 0.0], cells = [120, 2], cell = "quad4" }}
group.bond = {{ of = "up.bottom", x = [20.0, 60.0] }}
material.al.elastic = {{ young = 70e3, poisson = 0.0 }}
body.up.material = "al"
body.lo.material = "al"
contact.glue = {{ surface = "bond", target = "lo.top", law.cohesive = {{ friction = 0.3, cohesion = 20.0, tension = 20.0 }}, penalty = 5000.0, tangential_penalty = 5000.0 }}
[[step]]
increments.count = {increments}
displacement."up.top_left" = {{ x = 0.0, y = 0.5 }}
displacement."lo.bottom_left" = {{ x = 0.0, y = -0.5 }}
"#
    );
    let model = model(&deck, &[]);
    let keep = run(&model);
    let table = columns(&model, &keep);
    let last = |name: &str| *table[name].last().unwrap();
    let force = &table["reaction.up.top_left.y"];
    let bonds = keep.states.last().unwrap().energies.iter().map(|energies| energies.bonds).sum();
    let most = force.iter().copied().fold(0.0, f64::max);
    [*force.last().unwrap(), most, bonds, last("energy.released"), last("energy.missing")]
}

/// An iterate, or the last increment carried on, broke bonds that equilibrium does not: the end force was 1.13 to 1.56.
#[test]
fn a_crack_grows_alike_in_all_increments() {
    let [force, _, bonds, _, _] = peeled(100);
    // Half the square of the strength over the penalty for each unit of area, of which some 13 are broken.
    let nodes = bonds / (0.5 * 20.0 * 20.0 / 5000.0 * 0.5);
    assert!(force > 1.4 && force < 1.7 && nodes > 20.0 && nodes < 35.0, "{force} {nodes}");
    for increments in [5, 10, 30] {
        let [other, most, own, released, missing] = peeled(increments);
        assert!((other / force - 1.0).abs() < 1e-4 && (own / bonds - 1.0).abs() < 2e-3, "{increments}: {other} {own}");
        assert!(most < 2.7 && released > 0.0 && missing.abs() < 1e-3 * bonds, "{most} {released} {missing}");
    }
}

/// A block glued to a plate comes off as a whole at its strength times its area.
#[test]
fn a_block_comes_off_at_its_strength() {
    for count in [1, 7, 40] {
        let deck = |pulled: f64| {
            format!(
                r#"
version = 1
space = "plane-strain"
mesh.part.b.rectangle = {{ from = [0.0, 0.0], to = [4.0, 10.0], cells = [4, 10], cell = "quad4" }}
material.m.elastic = {{ young = 1000.0, poisson = 0.0 }}
body.b = {{ material = "m", strain = "small" }}
tool.p.profile = [{{ line = [[20.0, 0.0], [-20.0, 0.0]] }}]
contact.c = {{ surface = "b.bottom", target = "p", law.cohesive = {{ friction = 0.3, cohesion = 20.0, tension = 20.0 }}, penalty = 1e5 }}
[[step]]
increments.count = {count}
displacement."b.top" = {{ x = 0.0, y = {pulled} }}
"#
            )
        };
        // The block stretches by 20 / 1000 of its height, and the bond opens by 20 / 1e5.
        for (pulled, right) in [(0.2001, 80.0 * 0.2001 / 0.2002), (0.2003, 0.0)] {
            let model = model(&deck(pulled), &[]);
            let table = columns(&model, &run(&model));
            let last = |name: &str| *table[name].last().unwrap();
            let force = last("reaction.b.top.y");
            assert!((force - right).abs() < 1e-3 * 80.0, "{count} {pulled}: {force}");
            assert!(last("energy.missing").abs() < 1e-6 * 8.0, "{}", last("energy.missing"));
        }
    }
}

/// A ring glued into another, whose facets do not match, is pulled at: nodes before which the other side stands off by its facets had no bond, and what
/// overlaps by them pressed the others apart, so that none or half of the force was left.
#[test]
fn facets_that_stand_off_are_glued() {
    for ([inner, outer], cell) in [([40, 34], "quad4"), ([24, 60], "quad4"), ([38, 36], "quad4"), ([40, 34], "tri3")] {
        for overlap in ["", ", overlap = \"adjust\"", ", overlap = \"fit\""] {
            let deck = format!(
                r#"
version = 1
space = "plane-strain"
mesh.part.i.annulus = {{ from = [10.0, 0.0], to = [20.0, 360.0], cells = [4, {inner}], cell = "{cell}" }}
mesh.part.o.annulus = {{ from = [20.0, 7.0], to = [30.0, 367.0], cells = [4, {outer}], cell = "{cell}" }}
material.s.elastic = {{ young = 2e5, poisson = 0.3 }}
body.i.material = "s"
body.o.material = "s"
contact.glue = {{ surface = "i.outer", target = "o.inner", law.cohesive = {{ friction = 0.3, cohesion = 50.0, tension = 50.0 }}{overlap} }}
[[step]]
displacement."i.inner" = {{ x = 0.0, y = 0.0 }}
displacement."o.outer" = {{ x = 0.004, y = 0.0 }}
"#
            );
            let model = model(&deck, &[]);
            let force = *columns(&model, &run(&model))["reaction.o.outer.x"].last().unwrap();
            // Of rings of second degree that match.
            assert!((force / 3528.0 - 1.0).abs() < 0.01, "{inner} {outer} {cell}{overlap}: {force}");
        }
    }
}
