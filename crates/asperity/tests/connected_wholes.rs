//! What hangs together is one body, whatever the groups say: a press fit whose two bodies share one group of cells is that
//! of a group each, in the plane, in axial symmetry and in space; a surface of both that touches itself answers alike in the
//! plane and in space.

mod support;

use asperity::deck::{build, read};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use support::{columns, run};

/// A rectangle of cells, or with a depth a layer of solid cells, as lines of a mesh file; node and cell numbers go on from
/// `start`. Each row of cells ends in the surfaces `NAME_left` and `NAME_right`.
fn block(name: &str, [from, to]: [f64; 2], cells: [usize; 2], start: usize, solid: bool) -> String {
    let (mut nodes, mut elements) = (String::new(), String::new());
    let layers = if solid { 2 } else { 1 };
    let node = |i: usize, j: usize, k: usize| start + (k * (cells[1] + 1) + j) * (cells[0] + 1) + i;
    for k in 0..layers {
        for j in 0..=cells[1] {
            for i in 0..=cells[0] {
                let (x, y) = (from + (to - from) * i as f64 / cells[0] as f64, j as f64 / cells[1] as f64);
                writeln!(nodes, "{}, {x:.12}, {y:.12}, {:.1}", node(i, j, k), k as f64).unwrap();
            }
        }
    }
    let mut sides = [String::new(), String::new(), String::new(), String::new()];
    for j in 0..cells[1] {
        for i in 0..cells[0] {
            let number = start + j * cells[0] + i;
            let ring = |k: usize| {
                [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)]
                    .map(|n| n.to_string())
                    .join(", ")
            };
            let list: Vec<String> = (0..layers).map(ring).collect();
            writeln!(elements, "{number}, {}", list.join(", ")).unwrap();
            // Sides of CPE4 and of C3D8 by their numbers: below, right, above, left.
            let faces = if solid { ["S3", "S4", "S5", "S6"] } else { ["S1", "S2", "S3", "S4"] };
            let ends = [j == 0, i + 1 == cells[0], j + 1 == cells[1], i == 0];
            for ((list, face), _) in sides.iter_mut().zip(faces).zip(ends).filter(|(_, end)| *end) {
                writeln!(list, "{number}, {face}").unwrap();
            }
        }
    }
    let kind = if solid { "C3D8" } else { "CPE4" };
    let mut text = format!("*NODE\n{nodes}*ELEMENT, TYPE={kind}, ELSET={name}\n{elements}");
    for (end, list) in ["bottom", "right", "top", "left"].into_iter().zip(sides) {
        write!(text, "*SURFACE, NAME={name}_{end}, TYPE=ELEMENT\n{list}").unwrap();
    }
    for k in 0..layers {
        let all = (0..=cells[1]).flat_map(|j| (0..=cells[0]).map(move |i| (i, j)));
        let list: Vec<String> = all.map(|(i, j)| node(i, j, k).to_string()).collect();
        write!(text, "*NSET, NSET={name}_layer{k}\n{}\n", list.join(",\n")).unwrap();
    }
    text
}

const DECK: &str = r#"
version = 1
solver.tolerance = 1e-12
material.steel.elastic = { young = 1e3, poisson = 0.3 }
contact.seat = { SEAT, form = "paper", law.coulomb = { friction = 0.1 } }
[[step]]
increments.count = 4
displacement.hub_right = { x = 0.0, y = 0.0 }
displacement.shaft_left = { x = 0.0, y = 0.0 }
[[step]]
increments.count = 4
displacement.shaft_left = { y = 0.02 }
"#;

/// The sides of a surface of a mesh file.
fn sides<'a>(mesh: &'a str, name: &str) -> &'a str {
    let (_, rest) = mesh.split_once(&format!("NAME={name}, TYPE=ELEMENT\n")).unwrap();
    rest.split('*').next().unwrap()
}

static FILES: AtomicUsize = AtomicUsize::new(0);

type Columns = BTreeMap<String, Vec<f64>>;

/// Every column of a run with these bodies, and these sides and keys of the contact.
fn answers(space: &str, bodies: &[&str], contact: &str) -> Columns {
    let solid = space == "solid";
    let (shaft, hub) =
        (block("shaft", [1.0, 2.005], [3, 3], 1, solid), block("hub", [1.995, 3.0], [3, 4], 1001, solid));
    let skin = [sides(&shaft, "shaft_right"), sides(&hub, "hub_left")].concat();
    let both = format!("*ELSET, ELSET=both\nshaft, hub\n*SURFACE, NAME=skin, TYPE=ELEMENT\n{skin}");
    let mesh = [shaft, hub, both];
    // Tests run side by side, each with files of its own.
    let name = format!("connected-{}.inp", FILES.fetch_add(1, Ordering::Relaxed));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(folder.join(&name), mesh.concat()).unwrap();
    let mut deck =
        DECK.replace("version = 1\n", &format!("version = 1\nspace = \"{space}\"\nmesh.file = \"{name}\"\n"));
    deck = deck.replace("SEAT", contact);
    let bodies: String = bodies.iter().map(|body| format!("body.{body}.material = \"steel\"\n")).collect();
    deck = deck.replacen("[[step]]", &format!("{bodies}[[step]]"), 1);
    if solid {
        let held = "displacement.shaft_layer0 = { z = 0.0 }\ndisplacement.shaft_layer1 = { z = 0.0 }\n\
                    displacement.hub_layer0 = { z = 0.0 }\ndisplacement.hub_layer1 = { z = 0.0 }\n";
        deck = deck.replace("increments.count = 4\n", &format!("increments.count = 4\n{held}"));
    }
    let made = read(&deck, "press.toml", folder, &[]).and_then(build);
    let model = made.unwrap_or_else(|found| panic!("{}", found.render(false))).model;
    let keep = run(&model);
    columns(&model, &keep)
}

/// Where a contact is of the right size and the columns of both agree.
fn compare(of: &str, [each, one]: [&Columns; 2], names: impl Fn(&str) -> bool, allowed: f64) {
    assert!(each["contact.seat.max_pressure"][3] > 0.5, "{of}: {:?}", each["contact.seat.max_pressure"]);
    for (name, a) in each.iter().filter(|(name, _)| names(name)) {
        let (b, size) = (&one[name], a.iter().fold(1e-3_f64, |m, x| m.max(x.abs())));
        let same = a.iter().zip(b).all(|(a, b)| (a - b).abs() <= allowed * size);
        assert!(same && a.len() == b.len(), "{of}: {name} is {a:?} and {b:?}");
    }
}

const PAIR: &str = "surface = \"shaft_right\", target = \"hub_left\"";
const ITSELF: &str = "surface = \"skin\", target = \"skin\"";

#[test]
fn a_press_fit_in_one_group_is_that_of_a_group_each() {
    let one = format!("{PAIR}, passes = \"one\"");
    let two = format!("{PAIR}, passes = \"two\"");
    for (space, keys) in [
        ("plane-strain", one.as_str()),
        ("plane-strain", &two),
        ("plane-strain", ITSELF),
        ("axisymmetric", &one),
        ("solid", &one),
    ] {
        let [each, both] = [&["shaft", "hub"][..], &["both"]].map(|bodies| answers(space, bodies, keys));
        compare(&format!("{space}, {keys}"), [&each, &both], |name| name.starts_with("contact"), 1e-10);
    }
}

#[test]
fn a_surface_touches_itself_alike_in_the_plane_and_in_space() {
    let [plane, solid] = ["plane-strain", "solid"].map(|space| answers(space, &["both"], ITSELF));
    let compared = ["contact.seat.area", "contact.seat.max_pressure", "contact.seat.max_penetration", "energy.strain"];
    compare("itself", [&plane, &solid], |name| compared.contains(&name), 1e-8);
}
