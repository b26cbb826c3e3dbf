//! What holds where a contact says nothing of itself, and what two passes say of themselves.

mod support;

use support::{Keep, columns, model, run};

/// A block pressed onto a longer one and pushed along it.
const BLOCKS: &str = r#"
version = 1
space = "plane-strain"
mesh.part.big.rectangle = { from = [0.0, 0.0], to = [6.0, 2.0], cells = [12, 4], cell = "quad4" }
mesh.part.small.rectangle = { from = [2.0, 2.0], to = [3.5, 3.0], cells = [5, 3], cell = "quad4" }
material.rubber.elastic = { young = 1e3, poisson = 0.3 }
body.big = { material = "rubber", formulation = "f-bar" }
body.small = { material = "rubber", formulation = "f-bar" }
contact.joint = { surface = "small.bottom", target = "big.top", form = "paper", law.coulomb = { friction = 0.3 } }
[[step]]
increments.count = 4
displacement."big.bottom" = { x = 0.0, y = 0.0 }
displacement."small.top" = { x = 0.0, y = -0.1 }
[[step]]
increments.count = 6
displacement."small.top" = { x = 1.0 }
"#;

/// What the supports of the two blocks take, along x and y, at the end.
fn reactions(columns: &std::collections::BTreeMap<String, Vec<f64>>) -> [[f64; 2]; 2] {
    ["big.bottom", "small.top"]
        .map(|group| ["x", "y"].map(|axis| *columns[&format!("reaction.{group}.{axis}")].last().unwrap()))
}

/// Sides of first degree take one pass: contact bends them into facets, of which two passes would make pressures.
#[test]
fn blocks_of_first_degree_press_on_each_other_alike() {
    let model = model(BLOCKS, &[]);
    let keep: Keep = run(&model);
    assert_eq!(model.contacts.len(), 1);
    let [[x, y], [x2, y2]] = reactions(&columns(&model, &keep));
    assert!(y > 10.0 && (y + y2).abs() < 1e-5 * y && (x + x2).abs() < 1e-5 * y, "{x} {y} {x2} {y2}");
}

/// Sides of second degree take two passes, and what their forces leave over is told.
#[test]
fn two_passes_tell_by_how_much_their_forces_differ() {
    let sets = [
        "mesh.part.big.rectangle.cell=quad8",
        "mesh.part.small.rectangle.cell=quad8",
        "body.big.formulation=standard",
        "body.small.formulation=standard",
    ];
    let model = model(BLOCKS, &sets);
    let keep: Keep = run(&model);
    assert_eq!(model.contacts.len(), 2);
    let columns = columns(&model, &keep);
    let [[x, y], [x2, y2]] = reactions(&columns);
    let told = *columns["contact.joint.imbalance"].last().unwrap();
    let left = (x + x2).hypot(y + y2) / x.hypot(y).max(x2.hypot(y2));
    assert!(told > 1e-4 && (told / left - 1.0).abs() < 1e-3, "{told} {left}");
}

/// The default penalty goes by the confined modulus, but of nearly incompressible solids by four shear moduli.
#[test]
fn the_penalty_knows_what_a_surface_resists() {
    let penalty = |poisson: f64| {
        let model = model(BLOCKS, &[&format!("material.rubber.elastic.poisson={poisson}")]);
        model.contacts[0].options().penalty
    };
    let shear = |poisson: f64| 1e3 / (2.0 * (1.0 + poisson));
    let depth = 0.5; // of the big block's cells; the small one's are 1/3
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-6;
    let confined = 2.0 * shear(0.3) * 0.7 / 0.4;
    assert!(close(penalty(0.3), 50.0 * confined / depth), "{}", penalty(0.3));
    assert!(close(penalty(0.499), 50.0 * 4.0 * shear(0.499) / depth), "{}", penalty(0.499));
}

/// That of a thin sheet goes by its bending, with the secant modulus at a strain of 0.2 % where it flows: in plane strain the difference of
/// two stresses that are not more than `2 sy / sqrt(3)` apart. A block of the same steel keeps the elastic one.
#[test]
fn the_penalty_of_a_sheet_knows_that_it_flows() {
    let penalty = |law: &str, height: f64| {
        let deck = format!(
            "version = 1
            space = \"plane-strain\"
            mesh.part.b.rectangle = {{ from = [0.0, 0.0], to = [50.0, {height}], cells = [50, 2], cell = \"quad4\" }}
            material.m.{law}
            body.b.material = \"m\"
            tool.die.profile = [{{ line = [[60.0, 0.0], [-10.0, 0.0]] }}]
            contact.c = {{ surface = \"b.bottom\", target = \"die\", form = \"paper\", law.coulomb.friction = 0.1 }}
            [[step]]
            displacement.\"b.left\" = {{ x = 0.0 }}"
        );
        model(&deck, &[]).contacts[0].options().penalty
    };
    let (elastic, flowing) = (
        "elastic = { young = 2e5, poisson = 0.3 }",
        "von_mises = { young = 2e5, poisson = 0.3, yield_stress = 300.0, hardening = 0.0 }",
    );
    let (sheet, block) =
        ([elastic, flowing].map(|law| penalty(law, 1.0)), [elastic, flowing].map(|law| penalty(law, 10.0)));
    let secant = 0.25 * 2.0 * 300.0 / 3.0_f64.sqrt() / (2e5 / 2.6 * 0.002);
    assert!((sheet[1] / sheet[0] / secant - 1.0).abs() < 1e-3, "{sheet:?}");
    assert_eq!(block[0], block[1]);
}

/// Rubber that is squeezed to less than half its height between planes without friction bears what its law says, to what its
/// compressibility and the penalty leave: the penalty of the undeformed modulus would take 7 to 15 % of it.
#[test]
fn rubber_squeezed_to_less_than_half_bears_what_its_law_says() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.pad.rectangle = { from = [0.0, 0.0], to = [4.0, 3.0], cells = [4, 3], cell = "quad4" }
material.rubber.neo_hookean = { shear = 1.0, bulk = 1000.0 }
body.pad.material = "rubber"
tool.up.profile = [{ line = [[-20.0, 3.0], [20.0, 3.0]] }]
tool.down.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]
contact.up = { surface = "pad.top", target = "up", law.frictionless = {} }
contact.down = { surface = "pad.bottom", target = "down", law.frictionless = {} }
[[step]]
increments.count = 10
symmetry = ["pad.left"]
motion.up.y = -1.8
"#;
    for (cells, cell, left, increments) in [
        ("[4, 3]", "quad4", 0.4, 10),
        ("[7, 6]", "quad4", 0.4, 10),
        ("[4, 3]", "quad8", 0.4, 10),
        ("[4, 3]", "tri3", 0.4, 10),
        ("[4, 3]", "quad4", 0.35, 5),
        ("[4, 3]", "quad4", 0.35, 20),
        ("[4, 3]", "quad4", 0.5, 10),
    ] {
        let left: f64 = left;
        let force = 4.0 * (1.0 / left.powi(2) - left.powi(2)) / left;
        let sets = [
            format!("mesh.part.pad.rectangle.cells={cells}"),
            format!("mesh.part.pad.rectangle.cell=\"{cell}\""),
            format!("step.1.increments.count={increments}"),
            format!("step.1.motion.up.y={}", -3.0 * (1.0 - left)),
        ];
        let model = model(deck, &sets.each_ref().map(String::as_str));
        let keep: Keep = run(&model);
        let found = *columns(&model, &keep)["contact.down.force.y"].last().unwrap();
        assert!((found / force - 1.0).abs() < 0.035, "{cell} {cells} {left}: {found} in place of {force}");
        assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none()));
    }
}

/// A block that is confined on all sides bears its bulk modulus, which is far above the four shear moduli of the default penalty.
#[test]
fn a_confined_block_bears_its_bulk_modulus() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.plug.rectangle = { from = [0.0, 0.0], to = [4.0, 1.0], cells = [8, 4], cell = "quad4" }
material.rubber.neo_hookean = { shear = 1.0, bulk = 1000.0 }
body.plug.material = "rubber"
tool.ram.profile = [{ line = [[-20.0, 1.0], [20.0, 1.0]] }]
contact.head = { surface = "plug.top", target = "ram", law.frictionless = {} }
[[step]]
increments.count = 4
symmetry = ["plug.left", "plug.right", "plug.bottom"]
motion.ram.y = -0.02
"#;
    for bulk in [1e3, 1e4, 1e6] {
        let model = model(deck, &[&format!("material.rubber.neo_hookean.bulk={bulk}")]);
        let found = -*columns(&model, &run(&model))["contact.head.force.y"].last().unwrap();
        let force = 4.0 * (bulk + 4.0 / 3.0) * (1.0 / 0.98_f64).ln();
        assert!((found / force - 1.0).abs() < 0.015, "{found} in place of {force}");
    }
}

/// A thin disc that is squeezed between plates bears what a bar of its cross-section does, though its penalty begins as that of a sheet
/// that bends.
#[test]
fn a_thin_disc_that_is_squeezed_bears_what_its_law_says() {
    let deck = r#"
version = 1
space = "axisymmetric"
mesh.part.disc.rectangle = { from = [0.0, 0.0], to = [40.0, 1.0], cells = [30, 2], cell = "quad4" }
material.m.elastic = { young = 1000.0, poisson = 0.3 }
body.disc.material = "m"
tool.up.profile = [{ line = [[0.0, 1.0], [90.0, 1.0]] }]
tool.down.profile = [{ line = [[90.0, 0.0], [0.0, 0.0]] }]
contact.up = { surface = "disc.top", target = "up", law.frictionless = {} }
contact.down = { surface = "disc.bottom", target = "down", law.frictionless = {} }
[[step]]
increments.count = 3
symmetry = ["disc.left"]
motion.up.y = -0.02
"#;
    let strain = (1.0 / 0.98_f64).ln();
    let force = 1000.0 * strain * std::f64::consts::PI * 1600.0 * (2.0 * 0.3 * strain).exp();
    for cell in ["quad4", "quad8", "tri6"] {
        let model = model(deck, &[&format!("mesh.part.disc.rectangle.cell=\"{cell}\"")]);
        let found = *columns(&model, &run(&model))["contact.down.force.y"].last().unwrap();
        assert!((found / force - 1.0).abs() < 0.01, "{cell}: {found} in place of {force}");
    }
}

/// A ring that two round tools pinch until it touches itself: the force there is that of its half on a plane of symmetry, 0.120, whichever
/// part lies in the other. The part is seen up to the middle of the wall and not of what the other laps over.
#[test]
fn a_ring_that_touches_itself_tells_its_force() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.r.annulus = { centre = [0.0, 0.0], from = [4.7, -90.0], to = [5.0, 90.0], cells = [1, 52], cell = "quad4" }
material.m.neo_hookean = { shear = 10.0, bulk = 100.0 }
body.r.material = "m"
tool.u.profile = [{ arc = [[-1.5, 6.5], [0.0, 5.0], [1.5, 6.5]] }, { arc = [[1.5, 6.5], [0.0, 8.0], [-1.5, 6.5]] }]
tool.d.profile = [{ arc = [[-1.5, -6.5], [0.0, -8.0], [1.5, -6.5]] }, { arc = [[1.5, -6.5], [0.0, -5.0], [-1.5, -6.5]] }]
contact.u = { surface = "r.outer", target = "u", law.frictionless = {} }
contact.d = { surface = "r.outer", target = "d", law.frictionless = {} }
contact.s = { surface = "r.inner", target = "r.inner", law.frictionless = {} }
[[step]]
increments = { first = 0.05, largest = 0.05 }
symmetry = ["r.start", "r.end"]
motion.u.y = -4.71
motion.d.y = 4.71
"#;
    for cell in ["quad4", "quad8"] {
        let model = model(deck, &[&format!("mesh.part.r.annulus.cell=\"{cell}\"")]);
        let columns = columns(&model, &run(&model));
        let last = |name: &str| *columns[name].last().unwrap();
        assert!((last("contact.s.thrust") / 0.12 - 1.0).abs() < 0.05, "{cell}: {}", last("contact.s.thrust"));
        assert!(last("contact.s.area") > 0.03, "{cell}: {}", last("contact.s.area"));
    }
}

/// A plate that is pressed against a thicker one, their whole surface in one contact with itself: the way into the plate ends at its own far
/// side and not at that of the other, which it has entered before; the far side is no contact.
#[test]
fn a_surface_that_touches_itself_leaves_its_far_side_out() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.a.rectangle = { from = [0.0, 1.0], to = [8.0, 3.0], cells = [8, 2], cell = "quad4" }
mesh.part.b.rectangle = { from = [2.0, 0.0], to = [6.0, 1.0], cells = [5, 2], cell = "quad4" }
material.m.elastic = { young = 1000.0, poisson = 0.0 }
body.a.material = "m"
body.b.material = "m"
group.skin = { of = "a.bottom", with = ["b.bottom", "b.top"] }
contact.s = { surface = "skin", target = "skin", law.frictionless = {} }
[[step]]
increments.count = 2
displacement."a.top" = { x = 0.0, y = 0.0 }
displacement."b.left".x = 0.0
traction."b.bottom".y = 10.0
"#;
    let model = model(deck, &[]);
    let found = *columns(&model, &run(&model))["contact.s.force.y"].last().unwrap();
    assert!((found.abs() - 40.0).abs() < 1e-4, "{found}");
}

/// A hollow under a lid that slides along above it: the normals of its walls cross before they come to the lid, which it does not touch.
#[test]
fn a_hollow_touches_nothing_beyond_where_its_normals_cross() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.cup.annulus = { centre = [0.0, 0.0], from = [0.5, 140.0], to = [0.7, 400.0], cells = [1, 7], cell = "quad4" }
mesh.part.lid.rectangle = { from = [-2.0, 0.6], to = [2.0, 1.0], cells = [20, 1], cell = "quad4" }
material.m.elastic = { young = 1000.0, poisson = 0.3 }
body.cup.material = "m"
body.lid.material = "m"
contact.c = { surface = "cup.inner", target = "lid.bottom", law.frictionless = {} }
[[step]]
increments.count = 5
displacement."cup.outer" = { x = 0.0, y = 0.0 }
displacement."lid.top" = { x = 0.5, y = 0.0 }
"#;
    for cells in [7, 9] {
        for far in [0.5, 2.0] {
            let sets = [
                format!("mesh.part.cup.annulus.cells=[1,{cells}]"),
                format!("step.1.displacement.\"lid.top\".x={far}"),
            ];
            let model = model(deck, &[&sets[0], &sets[1]]);
            let keep = run(&model);
            assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none()), "{cells} {far}");
            assert_eq!(*columns(&model, &keep)["contact.c.thrust"].last().unwrap(), 0.0, "{cells} {far}");
        }
    }
}

/// A block over the seam of two flush blocks stands as on one: the sliver of either beyond the seam hides nothing of the other.
#[test]
fn a_block_stands_on_two_flush_blocks() {
    let deck = r#"
version = 1
space = "plane-strain"
mesh.part.a.rectangle = { from = [-1.0, 0.0], to = [3.0, 2.0], cells = [6, 2], cell = "quad4" }
mesh.part.b.rectangle = { from = [3.0, 0.0], to = [9.0, 2.0], cells = [8, 2], cell = "quad4" }
mesh.part.top.rectangle = { from = [0.0, 2.0], to = [6.0, 4.0], cells = [14, 3], cell = "quad4" }
material.m.elastic = { young = 1000.0, poisson = 0.3 }
body.a.material = "m"
body.b.material = "m"
body.top = { material = "m", density = 1.0 }
group.tops = { of = "a.top", with = ["b.top"] }
contact.seam = { surface = "a.right", target = "b.left", law.frictionless = {} }
contact.joint = { surface = "top.bottom", target = "tops", law.coulomb = { friction = 0.3 } }
[[step]]
gravity.y = -1.0
increments.count = 2
displacement."a.bottom" = { x = 0.0, y = 0.0 }
displacement."b.bottom" = { x = 0.0, y = 0.0 }
displacement."a.left".x = 0.0
displacement."top.bottom_left".x = 0.0
"#;
    for cells in [14, 13, 6] {
        let model = model(deck, &[&format!("mesh.part.top.rectangle.cells=[{cells},3]")]);
        let keep: Keep = run(&model);
        let found = *columns(&model, &keep)["contact.joint.force.y"].last().unwrap();
        assert!((found.abs() - 12.0).abs() < 1e-4, "{cells}: {found}");
        assert!(keep.attempts.iter().all(|attempt| attempt.failure.is_none() && attempt.iterations.len() < 12));
    }
}

/// A ball under a load goes from face to face of a metal that flows: a rounding that lies in the surface while nodes bear does not come to
/// bear in it of a sudden (after that a tenth of the load left the ball on a stop), and the hardness is near 2.8 yield stresses.
#[test]
fn a_ball_is_pressed_by_its_load_into_a_metal_that_flows() {
    let deck = r#"
version = 1
space = "axisymmetric"
mesh.part.b.rectangle = { from = [0.0, -40.0], along_x = [{ to = 4.0, cells = 24 }, { to = 40.0, cells = 14, ratio = 20.0 }], along_y = [{ to = -3.0, cells = 14, ratio = 0.05 }, { to = 0.0, cells = 20 }], cell = "quad4" }
material.m.von_mises = { young = 200e3, poisson = 0.3, yield_stress = 200.0 }
body.b.material = "m"
tool.ball.profile = [{ arc = [[0.0, 0.0], [3.535534, 1.464466], [5.0, 5.0]] }]
contact.c = { surface = "b.top", target = "ball", law.coulomb = { friction = 0.1 } }
[[step]]
displacement."b.bottom" = { y = 0.0 }
displacement."b.left" = { x = 0.0 }
load.ball = { y = -2000.0 }
"#;
    let model = model(deck, &[]);
    let keep: Keep = run(&model);
    let (columns, state) = (columns(&model, &keep), keep.states.last().unwrap());
    let [force, area, depth] =
        ["contact.c.force.y", "contact.c.area", "tool.ball.translation.y"].map(|name| *columns[name].last().unwrap());
    assert!((force / -2000.0 - 1.0).abs() < 1e-4 && state.held == 0, "{force} {}", state.held);
    assert!((-depth / 0.0905 - 1.0).abs() < 0.05 && (2.3..3.1).contains(&(-force / area / 200.0)), "{depth} {area}");
    assert!(state.iterations < 400, "{}", state.iterations);
}
