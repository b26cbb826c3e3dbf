//! Archard's wear, `k` times the pressure times the slip: its volume is `k N s` however narrow the contact is, and stays where it was made.

mod support;

use support::{columns, model, run};

/// Volume of wear for a unit of depth, its work and that of friction, and the largest depth, at the end of a deck whose surface has faces
/// of one length.
fn worn(deck: &str, face: f64) -> (f64, [f64; 2], f64) {
    let model = model(deck, &[]);
    let keep = run(&model);
    let (state, contact) = (keep.states.last().unwrap(), &model.field_contacts[0]);
    let records = contact.records(&state.u, &state.histories[model.first_contact()]);
    let mut depth = vec![0.0; contact.surface().nodes.len()];
    let pieces = contact.target().as_tool().map_or(1, |tool| tool.pieces());
    for (slot, record) in records.iter().take(pieces * depth.len()).enumerate() {
        depth[slot / pieces] += 1e-3 * record.worn;
    }
    let ends = 0.5 * (depth[0] + depth[depth.len() - 1]);
    let table = columns(&model, &keep);
    let last = |name: &str| *table[name].last().unwrap();
    let volume = face * (depth.iter().sum::<f64>() - ends);
    (volume, [last("contact.k.dissipation"), last("energy.friction")], depth.into_iter().fold(0.0, f64::max))
}

/// A roller over the top of a block, pressed by a force and pulled along, with cells of half a unit: it touches one node or two.
fn under_roller(radius: f64, force: f64, recedes: bool) -> String {
    let top = 2.0 + 2.0 * radius;
    let middle = 2.0 + radius;
    format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.b.rectangle = {{ from = [0.0, 0.0], to = [10.0, 2.0], cells = [20, 4], cell = "quad4" }}
material.s.elastic = {{ young = 2000.0, poisson = 0.35 }}
body.b.material = "s"
tool.p.profile = [{{ arc = [[2.0, {top}], [{}, {middle}], [2.0, 2.0]] }}, {{ arc = [[2.0, 2.0], [{}, {middle}], [2.0, {top}]] }}]
contact.k = {{ surface = "b.top", target = "p", law.coulomb.friction = 0.2, wear = {{ coefficient = 1e-3, recedes = {recedes} }} }}
[[step]]
displacement."b.bottom" = {{ x = 0.0, y = 0.0 }}
load.p.y = -{force}
[[step]]
motion.p.x = 5.0
load.p.y = -{force}
increments.count = 100
"#,
        2.0 - radius,
        2.0 + radius
    )
}

/// Under one node or two there had been none: a tip of the tool bore the pressure, and had its wear itself.
#[test]
fn a_narrow_contact_wears_what_it_slides_over() {
    for (radius, force) in [(0.4, 10.0), (8.0, 1.0), (8.0, 10.0), (8.0, 100.0)] {
        for recedes in [false, true] {
            let (volume, [own, friction], _) = worn(&under_roller(radius, force, recedes), 0.5);
            let right = 1e-3 * force * 5.0;
            assert!((volume / right - 1.0).abs() < 0.06, "{radius} {force} {recedes}: {volume} {right}");
            assert!((own - friction).abs() < 1e-9 * friction && friction > 0.9 * 0.2 * force * 5.0, "{own} {friction}");
        }
    }
}

/// A block that slid over another and is lifted far off keeps its wear, and the work of friction does not come back.
#[test]
fn what_is_worn_stays_worn_where_nothing_is_seen() {
    let deck = |up: f64| {
        format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.c.rectangle = {{ from = [0.0, 0.0], to = [6.0, 4.0], cells = [6, 4], cell = "quad4" }}
mesh.part.b.rectangle = {{ from = [-20.0, -4.0], to = [26.0, 0.0], cells = [46, 4], cell = "quad4" }}
material.s.elastic = {{ young = 10000.0, poisson = 0.0 }}
body.c.material = "s"
body.b.material = "s"
rigid.top.group = "c.top"
contact.k = {{ surface = "c.bottom", target = "b.top", roles = "given", law.coulomb.friction = 0.0, wear.coefficient = 1e-3 }}
[[step]]
displacement."b.bottom" = {{ x = 0.0, y = 0.0 }}
load.top.y = -60.0
[[step]]
load.top.y = -60.0
motion.top.x = 10.0
[[step]]
release = ["load.top"]
motion.top = {{ x = 10.0, y = {up} }}
"#
        )
    };
    for up in [0.5, 5.0] {
        let (volume, [own, friction], depth) = worn(&deck(up), 1.0);
        assert!((volume / 0.6 - 1.0).abs() < 0.01 && depth > 0.099, "{up}: {volume} {depth}");
        assert!((own - friction).abs() <= 1e-9 * friction.abs(), "{own} {friction}");
    }
}

/// A strip drawn over the edge of a die rests there on one node after another. What each slides over in the increment in which the next
/// takes over from it had neither work nor wear: in 50 increments a third of both was missing, in 200 a tenth.
#[test]
fn what_slides_from_node_to_node_has_its_work_and_wear() {
    let drawn = |increments: usize| {
        let deck = format!(
            r#"
version = 1
space = "plane-strain"
mesh.part.b.rectangle = {{ from = [0.0, 0.0], to = [40.0, 1.0], cells = [80, 2], cell = "quad8" }}
material.s.elastic = {{ young = 70000.0, poisson = 0.33 }}
body.b.material = "s"
tool.die = {{ profile = [{{ line = [[12.0, -10.0], [12.0, 0.0]] }}, {{ line = [[12.0, 0.0], [-5.0, 0.0]] }}], fillet = 1.0 }}
contact.k = {{ surface = "b.bottom", target = "die", law.coulomb.friction = 0.1, wear.coefficient = 1e-3 }}
[[step]]
displacement."b.left" = {{ x = 0.0, y = 0.0 }}
displacement."b.right" = {{ y = -4.0 }}
[[step]]
displacement."b.left" = {{ x = 5.0, y = 0.0 }}
displacement."b.right" = {{ y = -4.0 }}
increments.count = {increments}
"#
        );
        let (volume, [own, friction], _) = worn(&deck, 0.25);
        assert!((own - friction).abs() < 1e-9 * friction, "{own} {friction}");
        // Archard's volume for a unit of pressure times slip is the work of friction for one of stress times slip.
        assert!((volume / (1e-3 * friction / 0.1) - 1.0).abs() < 0.05, "{increments}: {volume} {friction}");
        friction
    };
    let [coarse, fine] = [50, 200].map(drawn);
    assert!((coarse / fine - 1.0).abs() < 0.02, "{coarse} {fine}");
}

/// A stiff block on a longer soft one, which carries the field where nothing wears: nodes come under the block at its front, where the pressure is large, and
/// had its work over all of their area for all of the increment, 1.44 of it in 45 increments.
fn dragged(increments: usize, wear: &str) -> String {
    format!(
        r#"
version = 1
space = "plane-strain"
mesh.part.b.rectangle = {{ from = [0.0, 0.0], to = [60.0, 8.0], cells = [36, 2], cell = "quad4" }}
mesh.part.s.rectangle = {{ from = [5.0, 8.0], to = [17.0, 14.0], cells = [12, 3], cell = "quad4" }}
material.m.elastic = {{ young = 200.0, poisson = 0.3 }}
material.r.elastic = {{ young = 2000.0, poisson = 0.4 }}
body.b.material = "m"
body.s.material = "r"
rigid.g.group = "s.top"
contact.k = {{ surface = "s.bottom", target = "b.top", law.coulomb.friction = 0.4{wear} }}
[[step]]
displacement."b.bottom" = {{ x = 0.0, y = 0.0 }}
motion.g = {{ x = 0.0, y = -0.02, rotation = 0.0 }}
[[step]]
motion.g = {{ x = 0.0, rotation = 0.0 }}
load.g.y = -120.0
[[step]]
motion.g = {{ x = 30.0, rotation = 0.0 }}
load.g.y = -120.0
increments.count = {increments}
"#
    )
}

#[test]
fn what_travels_along_a_surface_has_the_work_of_its_friction() {
    for (increments, within) in [(20, 0.1), (40, 0.04)] {
        let model = model(&dragged(increments, ""), &[]);
        assert_eq!(model.field_contacts[0].surface().nodes.len(), 37);
        let table = columns(&model, &run(&model));
        let part = table["energy.friction"].last().unwrap() / (0.4 * 120.0 * 30.0);
        assert!((part - 1.0).abs() < within, "{increments}: {part}");
    }
}

/// What the deck names as the surface wears, whatever the meshes: the other side had, and the block sank by half.
#[test]
fn the_named_side_wears() {
    let model = model(&dragged(20, ", wear = { coefficient = 1e-4, recedes = true }"), &[]);
    assert_eq!(model.field_contacts[0].surface().nodes.len(), 13);
    let volume = 1e-4 * 120.0 * 30.0;
    let records = |state: &asperity::system::State| {
        let contact = &model.field_contacts[0];
        contact.records(&state.u, &state.histories[model.first_contact()])
    };
    let keep = run(&model);
    let worn: f64 = records(keep.states.last().unwrap()).iter().map(|record| 1e-4 * record.worn * record.area).sum();
    assert!((worn / volume - 1.0).abs() < 0.05, "{worn} {volume}");
}
