//! The plane is space with the thickness held: a strip of plane strain and one layer of solid cells give the same forces,
//! pressures and energies in every increment, for tools, two bodies, self-contact, one pass and two, with friction, moved
//! and turned as a whole.

mod support;

use std::collections::BTreeMap;
use support::{columns, model, run};

/// Where the plane lies in space: the axis of space along which x, y and the thickness go, and where the origin is.
#[derive(Clone, Copy)]
struct Frame {
    axes: [usize; 3],
    origin: [f64; 3],
}

/// As drawn; turned so that the thickness goes along x, and moved.
const FRAMES: [Frame; 2] =
    [Frame { axes: [0, 1, 2], origin: [0.0; 3] }, Frame { axes: [1, 2, 0], origin: [7.0, -3.0, 0.5] }];
/// Names of the two sides across each axis of space.
const ENDS: [[&str; 2]; 3] = [["left", "right"], ["bottom", "top"], ["back", "front"]];
const NAMES: [&str; 3] = ["x", "y", "z"];

/// A block: its name, its corners, its cells.
type Block = (&'static str, [f64; 2], [f64; 2], [usize; 2]);
/// A support or motion: of a body, its side `left`, `right`, `bottom` or `top`, by so much.
type Moved = (&'static str, &'static str, [f64; 2]);

/// One problem, drawn in the plane.
struct Case {
    name: &'static str,
    degree: usize,
    blocks: &'static [Block],
    /// An arc or a line as a tool.
    tool: Option<&'static str>,
    /// Sides that touch: of a body, or `die`.
    contact: [[&'static str; 2]; 2],
    keys: &'static str,
    /// Steps: supports, and the motion of the tool.
    steps: &'static [(&'static [Moved], [f64; 2])],
}

const LINE: &str = "{ line = [[-1.0, 0.0], [3.0, 0.0]] }";
const ARC: &str = "{ arc = [[-0.6, 0.2], [0.5, 0.0], [1.6, 0.2]] }";
const ONE: &[Block] = &[("block", [0.0, -1.0], [1.2, 0.0], [4, 3])];
const TWO: &[Block] = &[("slab", [-0.5, -0.8], [2.0, 0.0], [6, 2]), ("block", [0.2, 0.0], [1.3, 0.7], [4, 2])];
const HELD: Moved = ("block", "bottom", [0.0, 0.0]);
const SLAB: Moved = ("slab", "bottom", [0.0, 0.0]);
/// Pressed, then drawn along, then all is carried off and the drag goes on.
const TOOLED: &[(&[Moved], [f64; 2])] =
    &[(&[HELD], [0.0, -0.02]), (&[HELD], [0.05, -0.03]), (&[("block", "bottom", [2.0, 1.0])], [2.1, 0.965])];
/// Where points may lose a target that ends, an equilibrium need not exist: pressed and drawn only.
const DRAWN: &[(&[Moved], [f64; 2])] = &[PAIRED[0], PAIRED[1]];
const PAIRED: &[(&[Moved], [f64; 2])] = &[
    (&[SLAB, ("block", "top", [0.0, -0.02])], [0.0; 2]),
    (&[SLAB, ("block", "top", [0.2, -0.03])], [0.0; 2]),
    (&[("slab", "bottom", [1.0, 2.0]), ("block", "top", [1.3, 1.97])], [0.0; 2]),
];

const CASES: &[Case] = &[
    Case {
        name: "a flat tool",
        degree: 1,
        blocks: ONE,
        tool: Some(LINE),
        contact: [["block", "top"], ["die", ""]],
        keys: "form = \"paper\", law.coulomb = { friction = 0.3 }",
        steps: TOOLED,
    },
    Case {
        name: "a round tool",
        degree: 2,
        blocks: ONE,
        tool: Some(ARC),
        contact: [["block", "top"], ["die", ""]],
        keys: "form = \"paper\", law.coulomb = { friction = 0.3 }",
        steps: TOOLED,
    },
    Case {
        name: "two bodies, one pass",
        degree: 1,
        blocks: TWO,
        tool: None,
        contact: [["block", "bottom"], ["slab", "top"]],
        keys: "law.coulomb = { friction = 0.2 }, passes = \"one\"",
        steps: PAIRED,
    },
    Case {
        name: "two bodies, one pass, the larger carries the points",
        degree: 1,
        blocks: TWO,
        tool: None,
        contact: [["slab", "top"], ["block", "bottom"]],
        keys: "law.coulomb = { friction = 0.2 }, passes = \"one\"",
        steps: DRAWN,
    },
    Case {
        name: "two bodies, two passes",
        degree: 2,
        blocks: TWO,
        tool: None,
        contact: [["block", "bottom"], ["slab", "top"]],
        keys: "law.coulomb = { friction = 0.2 }, passes = \"two\"",
        steps: DRAWN,
    },
];

/// The deck of a case in the plane.
fn plane(case: &Case) -> String {
    let cell = ["quad4", "quad8"][case.degree - 1];
    let mut deck = head("plane-strain");
    for (name, from, to, cells) in case.blocks {
        deck += &format!("[mesh.part.{name}.rectangle]\nfrom = {from:?}\nto = {to:?}\ncells = {cells:?}\n");
        deck += &format!("cell = \"{cell}\"\n[body.{name}]\nmaterial = \"rubber\"\n");
    }
    if let Some(profile) = case.tool {
        deck += &format!("[tool.die]\nprofile = [{profile}]\n");
    }
    let side = |[of, side]: [&str; 2]| if side.is_empty() { of.to_string() } else { format!("{of}.{side}") };
    deck += &contact(case, case.contact.map(side));
    for (supports, tool) in case.steps {
        deck += STEP;
        for &(body, end, [x, y]) in *supports {
            deck += &format!("displacement.\"{}\" = {{ x = {x:?}, y = {y:?} }}\n", side([body, end]));
        }
        if case.tool.is_some() {
            deck += &format!("motion.die = {{ x = {:?}, y = {:?} }}\n", tool[0], tool[1]);
        }
    }
    deck
}

/// The same as one layer of solid cells.
fn space(case: &Case, frame: Frame) -> String {
    let cell = ["hex8", "hex20"][case.degree - 1];
    let at = |[x, y]: [f64; 2], z: f64| {
        let mut place = frame.origin;
        [x, y, z].into_iter().zip(frame.axes).for_each(|(value, axis)| place[axis] += value);
        place
    };
    let along = |vector: [f64; 3]| {
        let mut turned = [0.0; 3];
        vector.into_iter().zip(frame.axes).for_each(|(value, axis)| turned[axis] = value);
        turned
    };
    let side = |[of, side]: [&str; 2]| {
        let find = |k: usize| ENDS[k].iter().position(|end| *end == side).map(|end| ENDS[frame.axes[k]][end]);
        find(0).or_else(|| find(1)).map_or_else(|| of.to_string(), |end| format!("{of}.{end}"))
    };
    let mut deck = head("solid");
    for (name, from, to, cells) in case.blocks {
        let mut counts = [1; 3];
        (0..2).for_each(|k| counts[frame.axes[k]] = cells[k]);
        let (from, to) = (at(*from, 0.0), at(*to, 1.0));
        deck += &format!("[mesh.part.{name}.box]\nfrom = {from:?}\nto = {to:?}\ncells = {counts:?}\n");
        deck += &format!("cell = \"{cell}\"\n[body.{name}]\nmaterial = \"rubber\"\n");
    }
    if let Some(profile) = case.tool {
        let (origin, line, x) = (at([0.0; 2], -0.5), along([0.0, 0.0, 2.0]), along([1.0, 0.0, 0.0]));
        deck += &format!("[tool.die]\nprofile = [{profile}]\n");
        deck += &format!("extrude = {{ origin = {origin:?}, along = {line:?}, x = {x:?} }}\n");
    }
    deck += &contact(case, case.contact.map(side));
    let axis = |k: usize| NAMES[frame.axes[k]];
    for (supports, tool) in case.steps {
        deck += STEP;
        for (name, ..) in case.blocks {
            for end in ENDS[frame.axes[2]] {
                deck += &format!("displacement.\"{name}.{end}\" = {{ {} = 0.0 }}\n", axis(2));
            }
        }
        for &(body, end, [x, y]) in *supports {
            let name = side([body, end]);
            deck += &format!("displacement.\"{name}\" = {{ {} = {x:?}, {} = {y:?} }}\n", axis(0), axis(1));
        }
        if case.tool.is_some() {
            deck += &format!("motion.die = {{ {} = {:?}, {} = {:?} }}\n", axis(0), tool[0], axis(1), tool[1]);
        }
    }
    deck
}

const STEP: &str = "[[step]]\nincrements.count = 4\n";

fn head(space: &str) -> String {
    format!(
        "version = 1\nspace = \"{space}\"\nsolver.tolerance = 1e-11\nmaterial.rubber.neo_hookean = {{ shear = 4.0, bulk = 10.0 }}\n"
    )
}

fn contact(case: &Case, [surface, target]: [String; 2]) -> String {
    format!("[contact]\nsole = {{ surface = \"{surface}\", target = \"{target}\", {} }}\n", case.keys)
}

/// Columns of space by the names that they have in the plane.
fn drawn(columns: BTreeMap<String, Vec<f64>>, frame: Frame) -> BTreeMap<String, Vec<f64>> {
    let rename = |name: &str| {
        let (head, last) = name.rsplit_once('.')?;
        let axis = NAMES.iter().position(|axis| *axis == last)?;
        let drawn = frame.axes.iter().position(|&of| of == axis)?;
        Some(format!("{head}.{}", NAMES[drawn]))
    };
    columns.into_iter().map(|(name, values)| (rename(&name).unwrap_or(name), values)).collect()
}

/// What is compared: forces, the areas in contact, pressures and penetrations, points, dissipation, energies.
const COMPARED: [&str; 9] = [
    "contact.sole.force.x",
    "contact.sole.force.y",
    "contact.sole.area",
    "contact.sole.max_pressure",
    "contact.sole.max_penetration",
    "contact.sole.dissipation",
    "energy.strain",
    "energy.contact",
    "energy.friction",
];
/// Largest difference, over the largest value of the column.
const ALLOWED: f64 = 1e-7;
#[test]
fn a_strip_and_a_layer_of_solid_cells_answer_alike() {
    let mut found = Vec::new();
    for case in CASES {
        let of = |deck: &str| {
            let model = model(deck, &[]);
            columns(&model, &run(&model))
        };
        let flat = of(&plane(case));
        assert!(
            flat["contact.sole.force.y"].iter().all(|force| force.abs() > 1e-3),
            "{}: nothing is carried",
            case.name
        );
        for frame in FRAMES {
            let solid = drawn(of(&space(case, frame)), frame);
            let others = ["contact.sole.target.force.x", "contact.sole.target.force.y"];
            for name in COMPARED.into_iter().chain(others.into_iter().filter(|name| flat.contains_key(*name))) {
                let (a, b) = (&flat[name], &solid[name]);
                let size = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let off = a.iter().zip(b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
                if a.len() != b.len() || off > ALLOWED * size {
                    found.push(format!("{}, {:?}: {name} differs by {off:.1e} of {size:.3e}", case.name, frame.axes));
                }
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}
