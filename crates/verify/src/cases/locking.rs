//! Solids that hardly change their volume, on every cell of first and second degree at the formulation and degree that a deck gets
//! without a word: no cell may be too stiff. Simplices that are too few through a body to bend are raised to second degree, as a deck's
//! are: those of the cantilevers, and of the slabs, which are two layers deep.
//!
//! The problems are in plane strain; cells of space fill a slab of two layers whose faces stay in their planes. The
//! meshes are lattices of the unit square or box that are mapped onto the body, so that all cells share them.

use crate::bench::Bench;
use crate::{Case, Measured};
use asperity::Error;
use asperity::amplitude::{Amplitude, Change, Timeline};
use asperity::load::{dead_pressure, traction};
use asperity::material::laws::{BackStress, Elastic, Hardening, NeoHookean, VonMises};
use asperity::material::{Hyper, Material, Rate};
use asperity::mesh::generate::{Block, Rectangle};
use asperity::mesh::{Cell, Mesh, Space};
use asperity::model::{Model, StepBuilder};
use asperity::solid::{BodyOptions, Strain, too_stiff};
use asperity::solve::Silent;
use asperity::system::State;
use asperity::tensor::Vec3;
use std::sync::Arc;

/// The case.
pub const CASE: Case = Case { name: "locking", measure };

const PLANE: [&str; 4] = ["tri3", "tri6", "quad4", "quad8"];
const SOLID: [&str; 4] = ["tet4", "tet10", "hex8", "hex20"];

fn measure(bench: &Bench) -> Result<Measured, Error> {
    let mut measured = Measured::new();
    let all = [&PLANE[..], &SOLID[..]].concat();
    let problems =
        [tube(), punch(), cook(), billet(), rubber(), cantilever("cantilever", 2), cantilever("thin_cantilever", 1)];
    for problem in &problems {
        for name in bench.pick(&PLANE[..], &all[..]) {
            let cell = Cell::named(name).ok_or_else(|| Error::input(format!("there is no cell '{name}'")))?;
            let key = format!("{}_{name}", problem.name);
            measured.push((key, problem.solve(cell)?));
        }
    }
    Ok(measured)
}

/// What is done to a body that was a square.
struct Problem {
    name: &'static str,
    /// From the unit square to the body.
    map: fn(f64, f64) -> [f64; 2],
    /// Size of the body, by which the depth of a slab is multiplied.
    size: f64,
    /// Cells along the sides of the square, in first degree.
    cells: [usize; 2],
    law: Arc<dyn Material>,
    strain: Strain,
    /// Displacements of sides: side, axis, value.
    moves: Vec<(&'static str, usize, f64)>,
    /// Loads of sides.
    load: Option<(&'static str, Load)>,
    increments: usize,
    /// What is measured of a state, from the reactions or displacements of the nodes of a side.
    answer: (&'static str, usize, Answer),
}

#[derive(Clone, Copy)]
enum Load {
    Pressure(f64),
    Traction([f64; 2]),
}

#[derive(Clone, Copy)]
enum Answer {
    /// Sum of the forces, over this.
    Force(f64),
    /// Displacement of the node that is moved farthest, over this.
    Displacement(f64),
}

/// A tube of radii 1 and 2 under pressure, E = 1, nu = 0.4999: the displacement of its bore over the exact one.
fn tube() -> Problem {
    let (nu, pressure) = (0.4999, 1e-3);
    let exact = pressure * (1.0 + nu) / 3.0 * ((1.0 - 2.0 * nu) + 4.0);
    Problem {
        name: "tube",
        map: |r, a| {
            let (sine, cosine) = (a * std::f64::consts::FRAC_PI_2).sin_cos();
            [(1.0 + r) * cosine, (1.0 + r) * sine]
        },
        size: 1.0,
        cells: [16, 16],
        law: Arc::new(Rate(Elastic::new(1.0, nu))),
        strain: Strain::Small,
        moves: vec![("b.bottom", 1, 0.0), ("b.top", 0, 0.0)],
        load: Some(("b.left", Load::Pressure(pressure))),
        increments: 1,
        answer: ("b.left", 0, Answer::Displacement(exact)),
    }
}

/// A rigid smooth punch of half width 1 on perfectly plastic ground 3 by 1.5, E / k = 1e4, in cells that grow from its
/// edge: its mean pressure over `(2 + pi) k`.
fn punch() -> Problem {
    let hardening = Hardening::linear(3.0_f64.sqrt(), 0.0);
    Problem {
        name: "punch",
        map: |x, y| {
            let from_edge = 2.0 * x - 1.0;
            let reach = if from_edge < 0.0 { 1.0 } else { 2.0 };
            [1.0 + reach * from_edge.signum() * from_edge.abs().powf(1.7), -1.5 * (1.0 - y).powf(1.7)]
        },
        size: 1.0,
        cells: [16, 16],
        law: Arc::new(Rate(VonMises { elastic: Elastic::new(1e4, 0.3), hardening, back: [BackStress::default()] })),
        strain: Strain::Small,
        moves: vec![
            ("b.bottom", 0, 0.0),
            ("b.bottom", 1, 0.0),
            ("b.left", 0, 0.0),
            ("b.right", 0, 0.0),
            ("punch", 1, -4e-3),
        ],
        load: None,
        increments: 20,
        answer: ("punch", 1, Answer::Force(-(2.0 + std::f64::consts::PI))),
    }
}

/// Cook's membrane, E = 250, nu = 0.4999, shear 6.25 on its free side: the rise of its upper corner.
fn cook() -> Problem {
    Problem {
        name: "cook",
        map: |x, y| [48.0 * x, 44.0 * x + y * (44.0 - 28.0 * x)],
        size: 45.0,
        cells: [16, 16],
        law: Arc::new(Rate(Elastic::new(250.0, 0.4999))),
        strain: Strain::Small,
        moves: vec![("b.left", 0, 0.0), ("b.left", 1, 0.0)],
        load: Some(("b.right", Load::Traction([0.0, 6.25]))),
        increments: 1,
        answer: ("b.right", 1, Answer::Displacement(1.0)),
    }
}

/// A quarter of a billet as high as wide between plates that stick, 8 % upset, with some hardening: its force over that
/// of its width at yield.
fn billet() -> Problem {
    let hardening = Hardening::linear(3.0_f64.sqrt(), 1.0);
    Problem {
        name: "billet",
        map: |x, y| [x, y],
        size: 1.0,
        cells: [16, 16],
        law: Arc::new(Rate(VonMises { elastic: Elastic::new(1e3, 0.3), hardening, back: [BackStress::default()] })),
        strain: Strain::Finite,
        moves: vec![("b.left", 0, 0.0), ("b.bottom", 1, 0.0), ("b.top", 0, 0.0), ("b.top", 1, -0.08)],
        load: None,
        increments: 30,
        answer: ("b.top", 1, Answer::Force(-2.0)),
    }
}

/// A quarter of a block of rubber, K / G = 1000, under a dead pressure of 6 G over the middle half of its top, which slides
/// nowhere: how far its middle sinks, over its height (after Reese and Wriggers).
fn rubber() -> Problem {
    Problem {
        name: "rubber",
        map: |x, y| [x, y],
        size: 1.0,
        cells: [16, 16],
        law: Arc::new(Hyper(NeoHookean { shear: 1.0, bulk: 1000.0 })),
        strain: Strain::Finite,
        // A top that is free across the slab wrinkles under the dead load from a fifth of it on.
        moves: vec![("b.left", 0, 0.0), ("b.bottom", 1, 0.0), ("b.top", 0, 0.0), ("b.top", 2, 0.0)],
        load: Some(("punch", Load::Traction([0.0, -6.0]))),
        increments: 30,
        answer: ("punch", 1, Answer::Displacement(-1.0)),
    }
}

/// A cantilever 20 long and 1 high, one or two cells of first degree or one of second through its height, nu = 0.3: its sinking
/// over that of a beam with shear.
fn cantilever(name: &'static str, through: usize) -> Problem {
    let (young, nu, shear, length) = (1e6, 0.3, 1.0, 20.0_f64);
    let bending = 4.0 * length.powi(3) * (1.0 - nu * nu) / young;
    let exact = shear * (bending + 1.2 * length * 2.0 * (1.0 + nu) / young);
    Problem {
        name,
        map: |x, y| [20.0 * x, y],
        size: 1.0,
        cells: [40, through],
        law: Arc::new(Rate(Elastic::new(young, nu))),
        strain: Strain::Small,
        moves: vec![("b.left", 0, 0.0), ("b.left", 1, 0.0)],
        load: Some(("b.right", Load::Traction([0.0, -shear]))),
        increments: 1,
        answer: ("b.right", 1, Answer::Displacement(-exact)),
    }
}

impl Problem {
    fn solve(&self, cell: &'static Cell) -> Result<f64, Error> {
        let cells = self.cells.map(|count| (count / cell.degree).max(1));
        let depth = 2.0 / cells[1] as f64;
        let mut mesh = match cell.dimension {
            2 => Rectangle::new([0.0; 2], [1.0; 2], cells, cell).mesh("b")?,
            _ => Block::new([0.0; 3], [1.0, 1.0, depth], [cells[0], cells[1], 2], cell).mesh("b")?,
        };
        let mut punch = mesh.groups["b.top"].clone();
        let under = |node: usize| mesh.points[node][0] < 0.5 + 1e-9;
        punch.nodes.retain(|&node| under(node));
        punch.sides.retain(|&side| mesh.side(side).1.all(under));
        mesh.groups.insert("punch".into(), punch);
        for x in &mut mesh.points {
            let [a, b] = (self.map)(x[0], x[1]);
            *x = Vec3::new(a, b, self.size * x[2]);
        }
        let all: Vec<usize> = (0..mesh.cell_count()).collect();
        if too_stiff(&mesh, &all).is_some() {
            mesh = mesh.raised(&all);
        }
        let depth = if cell.dimension == 2 { 1.0 } else { self.size * depth };
        let model = self.model(Arc::new(mesh), cell.dimension)?;
        let mut run = model.run(model.problem.initial_state());
        run.run(&Default::default(), &mut Silent)?;
        Ok(self.read(&model, &run.state, depth))
    }

    fn model(&self, mesh: Arc<Mesh>, dimension: usize) -> Result<Model, Error> {
        let space = if dimension == 2 { Space::PlaneStrain } else { Space::Solid };
        let flat = [("b.back", 2, 0.0), ("b.front", 2, 0.0)];
        let mut step = StepBuilder::new("go").count(self.increments);
        for &(side, axis, value) in self.moves.iter().chain(&flat).filter(|(_, axis, _)| *axis < dimension) {
            step = step.displace(side, (0..=axis).map(|a| (a == axis).then_some(value)).collect::<Vec<_>>());
        }
        let options = BodyOptions { strain: self.strain, held: [false, false, true], ..BodyOptions::default() };
        let mut builder = Model::builder(space, mesh).body("b", self.law.clone(), options).step(step);
        let ramp = |value: f64| Timeline::new([(1.0, Change::To(value, Amplitude::ramp()))]);
        if let Some((side, load)) = self.load {
            builder = builder.load(move |site| {
                let sides = &site.mesh.groups[side].sides;
                Ok(match load {
                    Load::Pressure(value) => Box::new(dead_pressure("load", site, sides, ramp(value))?),
                    Load::Traction([x, y]) => {
                        let all = [x, y, 0.0][..dimension].iter().map(|&value| ramp(value)).collect();
                        Box::new(traction("load", site, sides, all)?)
                    }
                })
            });
        }
        builder.build()
    }

    fn read(&self, model: &Model, state: &State, depth: f64) -> f64 {
        let (side, axis, answer) = self.answer;
        let dofs = model.mesh.groups[side].nodes.iter().map(|&node| model.problem.dofs.node(node) + axis);
        match answer {
            Answer::Force(over) => dofs.map(|dof| state.internal[dof] - state.load[dof]).sum::<f64>() / (over * depth),
            Answer::Displacement(over) => dofs.map(|dof| state.u[dof] / over).fold(0.0, f64::max),
        }
    }
}
