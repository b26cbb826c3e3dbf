//! Averaged normals in space: tangents against central differences on faces of every kind, over tools and between bodies,
//! stick and slip, on faces that the target covers wholly and in part, with the variational form and with friction by a
//! mean pressure; the same answer turned; that of each face's own normals where the surface is flat.

mod cubes;
mod pairs;
mod perturbed;

use asperity::contact::space::Contact;
use asperity::contact::{ContactForm, ContactOptions, Loads, Normals};
use asperity::interface::laws::{Coulomb, OdenPires};
use asperity::mesh::generate::Block;
use asperity::mesh::{Cell, Mesh};
use asperity::system::{Dofs, State, Stencils, Term};
use asperity::tensor::Vec3;
use asperity::tool::space::Pose;
use cubes::at;
use pairs::Carrier;
use perturbed::{Random, check, commit, instant, largest, options, state};

/// Largest difference of an entry over the largest entry.
const ALLOWED: f64 = 1e-7;
/// A pressure of some steps of the differences, times the penalty.
const LITTLE: f64 = 1e-2;
/// A small part of the smallest face.
const SLIVER: f64 = 0.01;

/// What a check met.
#[derive(Debug, Default)]
struct Met {
    branches: [usize; 3],
    cut: usize,
    skipped: usize,
    unknowns: usize,
    worst: f64,
}

impl Met {
    /// Tangents at a trial state that follows an accepted one.
    fn look(&mut self, contact: &Contact, accepted: &State, trial: &[f64]) {
        let attempt = contact.attempt(accepted, &accepted.histories[0], instant()).unwrap();
        let mut stencils = Stencils::default();
        attempt.stencils(trial, &mut stencils).unwrap();
        self.cut += stencils.list.iter().filter(|stencil| stencil.border[0] > 0).count();
        self.unknowns = stencils.list.iter().map(|stencil| stencil.len).fold(self.unknowns, usize::max);
        let Ok(end) = commit(contact, accepted, trial.to_vec()) else { return };
        let records = contact.records(trial, &end.histories[0]);
        for (result, record) in check(attempt.as_ref(), trial).unwrap().into_iter().zip(records) {
            self.branches[usize::from(result.branch)] += 1;
            // Where hardly anything is left of the pressure or of the face, the steps of the differences are not small.
            let little = (record.pressure > 0.0 && record.pressure < LITTLE) || record.area < SLIVER;
            self.skipped += usize::from(!result.smooth || little);
            assert!(result.error.is_finite());
            self.worst = if result.smooth && !little { self.worst.max(result.error) } else { self.worst };
        }
    }

    /// Enough that sticks and slips; what is open has no tangent.
    fn good(&self, least: usize) -> bool {
        self.branches[1..].iter().all(|&met| met >= least) && self.worst < ALLOWED
    }
}

fn averaged(options: &mut ContactOptions) {
    options.normals = Normals::Averaged;
}

#[test]
fn tangents_on_tools_are_exact() {
    for (cell, around) in [("tet4", 4), ("tet10", 9), ("hex8", 4), ("hex20", 6), ("hex27", 10)] {
        for kind in ["triangle", "sphere", "torus", "parabola"] {
            let [own, met] = [Normals::Own, Normals::Averaged].map(|normals| {
                let with = |options: &mut ContactOptions| options.normals = normals;
                let (contact, dofs) = cubes::contact_with((cell, 2), kind, Coulomb::new(0.4), with);
                let (mut random, mut met) = (Random(7), Met::default());
                let start = state(vec![0.0; dofs.count()], contact.initial());
                for _ in 0..if normals == Normals::Own { 1 } else { 12 } {
                    let accepted = commit(&contact, &start, cubes::motion(&dofs, &mut random)).unwrap();
                    met.look(&contact, &accepted, &cubes::motion(&dofs, &mut random));
                }
                met
            });
            let name = format!("{cell}, {kind}: {met:?}");
            println!("{name} {}", own.unknowns);
            assert!(met.good(4), "{name}");
            assert!(met.unknowns >= own.unknowns + 3 * around, "{name}: {} own", own.unknowns);
        }
    }
}

#[test]
fn tangents_of_other_forms_are_exact() {
    // Shear over the limit of `oden_pires` bends sharply: differences over it are worth fewer digits than elsewhere.
    for cell in ["hex8", "hex20"] {
        let variational = |options: &mut ContactOptions| {
            averaged(options);
            options.form = ContactForm::Variational;
        };
        let law = OdenPires { friction: 0.4, length: 0.05, radius: 0.6 };
        let contacts = [
            (cubes::contact_with((cell, 2), "sphere", Coulomb::new(0.4), variational), ALLOWED),
            (cubes::contact_with((cell, 2), "triangle", law, averaged), 1e-5),
        ];
        for ((contact, dofs), allowed) in contacts {
            let (mut random, mut met) = (Random(13), Met::default());
            let start = state(vec![0.0; dofs.count()], contact.initial());
            for _ in 0..10 {
                let mut pressed = || {
                    let mut u = cubes::motion(&dofs, &mut random);
                    (0..dofs.nodes()).for_each(|node| u[dofs.node(node) + 2] -= 0.15);
                    u
                };
                let Ok(accepted) = commit(&contact, &start, pressed()) else { continue };
                met.look(&contact, &accepted, &pressed());
            }
            println!("{met:?}");
            assert!(met.branches[1] + met.branches[2] > 20 && met.worst < allowed, "{cell}: {met:?}");
        }
    }
}

/// A small block of two cells above a large one, the faces between them bent by `bow`.
fn mesh([upper, lower]: [&str; 2], bow: f64) -> Mesh {
    let block = |from, to, cells, cell: &str, name: &str| {
        Block::new(from, to, cells, Cell::named(cell).unwrap()).mesh(name).unwrap()
    };
    let mut mesh = block([-1.0, -1.0, -1.0], [2.0, 2.0, 0.0], [3, 2, 1], lower, "lower");
    mesh.append(block([0.1, 0.05, 0.0], [0.9, 0.9, 1.0], [2, 1, 1], upper, "upper")).unwrap();
    for x in &mut mesh.points {
        let [a, b, c] = x.0;
        *x += at(0.06 * a * b, 0.05 * b * a * a, bow * (a * (1.0 - b) + 2.0 * a * a) * (1.0 - c.abs()));
    }
    mesh
}

fn bodies(mesh: Mesh, carrier: Carrier, loads: Loads, normals: Normals) -> (Contact, Dofs) {
    pairs::pair(mesh, carrier, 0.4, ContactOptions { normals, ..options(loads) })
}

fn motion(contact: &Contact, dofs: &Dofs, random: &mut Random) -> Vec<f64> {
    pairs::motion((contact, dofs), [0.04, 0.05], random)
}

#[test]
fn tangents_between_bodies_are_exact() {
    let carriers = [(Carrier::Small, Loads::Both), (Carrier::Large, Loads::Own), (Carrier::Large, Loads::Both)];
    for cells in [["hex8", "hex8"], ["tet4", "hex20"], ["hex20", "tet10"], ["hex27", "tet4"]] {
        for (carrier, loads) in carriers {
            let (contact, dofs) = bodies(mesh(cells, 0.05), carrier, loads, Normals::Averaged);
            let (mut random, mut met) = (Random(11), Met::default());
            let start = state(vec![0.0; dofs.count()], contact.initial());
            let points = contact.surface().points.len();
            for _ in 0..if carrier == Carrier::Large { 6 + 300 / points } else { 10 + 60 / points } {
                let first = commit(&contact, &start, motion(&contact, &dofs, &mut random));
                // A point that came to lie deep where nothing was refuses the increment.
                let next = first.and_then(|first| commit(&contact, &first, motion(&contact, &dofs, &mut random)));
                let Ok(accepted) = next else { continue };
                met.look(&contact, &accepted, &motion(&contact, &dofs, &mut random));
            }
            let name = format!("{cells:?}, {carrier:?}, {loads:?}: {met:?}");
            println!("{name}");
            assert!(met.good(2), "{name}");
            assert!((met.cut > 30) == (carrier == Carrier::Large), "{name}");
        }
    }
}

fn forces((contact, dofs): &(Contact, Dofs), first: Vec<f64>, second: &[f64]) -> Option<Vec<f64>> {
    perturbed::forces(contact, &state(vec![0.0; dofs.count()], contact.initial()), first, second)
}

/// Both states turned as a whole by 40 degrees about a slanting axis: the forces turn with them.
#[test]
fn a_turned_state_has_turned_forces() {
    let turn = Pose { translation: Vec3::zero(), rotation: at(0.3, -0.4, 0.5) };
    let turned = |x: Vec3| turn.place(Vec3::zero(), x);
    for carrier in [Carrier::Small, Carrier::Large] {
        let pair = bodies(mesh(["hex8", "hex20"], 0.05), carrier, Loads::Both, Normals::Averaged);
        let (mut random, mut compared) = (Random(5), 0);
        let moved = |u: &[f64]| {
            let mut all = u.to_vec();
            for (node, &x) in pair.0.mesh().points.iter().enumerate() {
                let first = pair.1.node(node);
                let now = turned(x + at(u[first], u[first + 1], u[first + 2])) - x;
                all[first..first + 3].copy_from_slice(&now.0);
            }
            all
        };
        for _ in 0..12 {
            let [first, second] = [0, 1].map(|_| motion(&pair.0, &pair.1, &mut random));
            let plain = forces(&pair, first.clone(), &second);
            let Some((plain, other)) = plain.zip(forces(&pair, moved(&first), &moved(&second))) else { continue };
            for node in 0..pair.1.nodes() {
                let k = pair.1.node(node);
                let force = |all: &[f64]| at(all[k], all[k + 1], all[k + 2]);
                let error = (turned(force(&plain)) - force(&other)).norm();
                assert!(error <= 1e-10 * largest(&plain), "{carrier:?}: {error:.1e}");
            }
            compared += usize::from(largest(&plain) > 0.0);
        }
        assert!(compared > 4, "{carrier:?}: {compared}");
    }
}

/// On flat faces that stay flat both normals are one; on bent ones they are not.
#[test]
fn a_flat_surface_answers_as_with_its_own_normals() {
    for (carrier, cells) in [(Carrier::Small, ["hex8", "hex20"]), (Carrier::Large, ["tet10", "tet4"])] {
        let [flat, bent] = [0.0, 0.05].map(|bow| {
            let both = [Normals::Own, Normals::Averaged]
                .map(|normals| bodies(mesh(cells, bow), carrier, Loads::Both, normals));
            // Each block stretches, leans and sinks as a whole.
            let moved = |down: f64| {
                let ((contact, dofs), mut u) = (&both[0], vec![0.0; both[0].1.count()]);
                for (node, x) in contact.mesh().points.iter().enumerate() {
                    let upper = f64::from(contact.mesh().groups["upper"].nodes.contains(&node));
                    let by = at(0.03 * upper + 0.05 * x[0], 0.02 * x[0], upper * (0.02 * x[1] - down));
                    u[dofs.node(node)..dofs.node(node) + 3].copy_from_slice(&by.0);
                }
                u
            };
            let [own, averaged] = both.each_ref().map(|pair| forces(pair, moved(0.06), &moved(0.08)).unwrap());
            let differences: Vec<f64> = own.iter().zip(&averaged).map(|(a, b)| a - b).collect();
            assert!(largest(&own) > 1e-4, "{carrier:?}");
            largest(&differences) / largest(&own)
        });
        assert!(flat < 1e-12 && bent > 1e-3, "{carrier:?}: {flat:.1e} {bent:.1e}");
    }
}
