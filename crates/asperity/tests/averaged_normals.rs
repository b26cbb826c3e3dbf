//! Averaged normals in the plane: tangents against central differences, on tools and between bodies, stick and slip, with
//! edges that the target covers wholly and in part, with the variational form and with friction by a mean pressure; the
//! same answer turned; that of each edge's own normals where the surface is flat.

mod perturbed;

use asperity::contact::{Contact, ContactForm, ContactOptions, Faces, Guard, Loads, Normals, Surface, Target};
use asperity::interface::{
    Rule,
    laws::{Coulomb, OdenPires},
};
use asperity::mesh::generate::Rectangle;
use asperity::mesh::{Cell, Mesh, Space};
use asperity::system::{Dofs, State, Stencils, Term};
use asperity::tensor::Vec3;
use asperity::tool::{Tool, shapes};
use perturbed::{Random, check, commit, instant, largest, state};
use std::sync::Arc;

/// Largest difference of an entry over the largest entry.
const ALLOWED: f64 = 1e-7;
/// A pressure of some steps of the differences, times the penalty.
const LITTLE: f64 = 2e-3;

/// What a block touches.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Against {
    /// A tool of one segment of that shape.
    Tool(&'static str),
    /// A wider block below it.
    Wide,
    /// Seen from the wide one: a block that covers its edges in part.
    Narrow,
}

struct Scene {
    contact: Contact,
    mesh: Arc<Mesh>,
    dofs: Dofs,
}

/// A block of two cells above one of three, the faces between them bent by `bow`.
fn mesh(cell: &str, bow: f64) -> Mesh {
    let cell = Cell::named(cell).unwrap();
    let mut mesh = Rectangle::new([0.5, -1.0], [2.9, 0.0], [3, 1], cell).mesh("wide").unwrap();
    mesh.append(Rectangle::new([1.35, 0.0], [2.05, 1.0], [2, 1], cell).mesh("narrow").unwrap()).unwrap();
    for x in &mut mesh.points {
        let from = x[0] - 1.7;
        *x += Vec3::new(0.0, bow * (0.3 - from * from), 0.0) * (1.0 - x[1].abs());
    }
    mesh
}

fn options(normals: Normals, loads: Loads) -> ContactOptions {
    ContactOptions { thickness: 0.8, guard: Guard::Warn, normals, ..perturbed::options(loads) }
}

fn tool(shape: &str) -> Arc<Tool> {
    let point = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let nodes = match shape {
        "line" => vec![point(5.0, 0.1), point(-1.0, -0.1)],
        _ => vec![point(4.4, -0.3), point(1.6, 0.0), point(-1.0, -0.3)],
    };
    let profile = vec![shapes::find(shape).unwrap().build(&nodes).unwrap()];
    Arc::new(Tool::new("t", vec![profile], point(1.5, -1.0)))
}

fn scene_of((mesh, space): (Mesh, Space), against: Against, law: Rule, options: ContactOptions) -> Scene {
    let dofs = Dofs::new(2, mesh.points.len(), 1);
    let mesh = Arc::new(mesh);
    let sides = |group: &str| mesh.groups[group].sides.as_slice();
    let faces = |group: &str| Target::Faces(Faces::new(mesh.clone(), dofs.clone(), sides(group)));
    let (own, target) = match against {
        Against::Tool(shape) => ("narrow.bottom", Target::tool(tool(shape), 0, &dofs)),
        Against::Wide => ("narrow.bottom", faces("wide.top")),
        Against::Narrow => ("wide.top", faces("narrow.bottom")),
    };
    let boundary = mesh.boundary(&mesh.groups[own.split('.').next().unwrap()].cells);
    let surface = Surface::new(&mesh, sides(own), None);
    let contact = Contact::new("c", (mesh.clone(), dofs.clone(), space), (surface, boundary), target, (law, options));
    Scene { contact, mesh, dofs }
}

fn scene(cell: &str, against: Against, space: Space, options: ContactOptions) -> Scene {
    scene_of((mesh(cell, 0.2), space), against, Coulomb::new(0.4).into(), options)
}

impl Scene {
    fn start(&self) -> State {
        state(vec![0.0; self.dofs.count()], self.contact.initial())
    }

    /// The narrow block by up to a tenth and downwards by about `down`, all nodes and the tool by a little.
    fn motion(&self, down: f64, random: &mut Random) -> Vec<f64> {
        let by = [0.08 * random.next(), -down * (1.0 + 0.6 * random.next())];
        let mut u = vec![0.0; self.dofs.count()];
        for node in 0..self.dofs.nodes() {
            let narrow = self.mesh.groups["narrow"].nodes.contains(&node);
            for (axis, by) in by.into_iter().enumerate() {
                u[self.dofs.node(node) + axis] = if narrow { by } else { 0.0 } + 0.02 * random.next();
            }
        }
        let tool = self.dofs.tool(0);
        (tool..tool + 3).for_each(|dof| u[dof] = 0.03 * random.next());
        u
    }

    /// Checks the tangents at random states, each after a random accepted one that itself follows another.
    fn check(&self, down: f64) -> Met {
        let (mut random, mut met, start) = (Random(11), Met::default(), self.start());
        for _ in 0..400 {
            let first = commit(&self.contact, &start, self.motion(down, &mut random));
            let accepted = first.and_then(|first| commit(&self.contact, &first, self.motion(down, &mut random)));
            // A point that came to lie deep where nothing was refuses the increment.
            let Ok(accepted) = accepted else { continue };
            let attempt = self.contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
            let (trial, mut stencils) = (self.motion(down, &mut random), Stencils::default());
            attempt.stencils(&trial, &mut stencils).unwrap();
            met.cut += stencils.list.iter().filter(|stencil| stencil.also[..2] != [0; 2]).count();
            met.unknowns = stencils.list.iter().map(|stencil| stencil.len).fold(met.unknowns, usize::max);
            let Ok(end) = commit(&self.contact, &accepted, trial.clone()) else { continue };
            let records = self.contact.records(&trial, &end.histories[0]);
            for (result, record) in check(attempt.as_ref(), &trial).into_iter().flatten().zip(records) {
                met.branches[usize::from(result.branch)] += 1;
                // Just closed, the steps of the differences are not small against the penetration.
                let smooth = result.smooth && !(record.pressure > 0.0 && record.pressure < LITTLE);
                met.skipped += usize::from(!smooth);
                assert!(result.error.is_finite());
                met.worst = if smooth { met.worst.max(result.error) } else { met.worst };
            }
        }
        met
    }
}

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
    fn good(&self) -> bool {
        let total = self.branches.iter().sum::<usize>();
        self.branches.iter().all(|&met| met >= 20) && 20 * self.skipped <= total && self.worst < ALLOWED
    }
}

#[test]
fn tangents_are_exact() {
    let cases = [
        (Against::Tool("line"), Loads::Both),
        (Against::Tool("parabola"), Loads::Both),
        (Against::Wide, Loads::Both),
        (Against::Wide, Loads::Own),
        (Against::Narrow, Loads::Both),
        (Against::Narrow, Loads::Own),
    ];
    for (cell, around) in [("quad4", 1), ("quad8", 2)] {
        for (i, (against, loads)) in cases.into_iter().enumerate() {
            let space = [Space::PlaneStrain, Space::Axisymmetric][i % 2];
            let down = if matches!(against, Against::Tool(_)) { 0.1 } else { 0.04 };
            let [own, met] = [Normals::Own, Normals::Averaged]
                .map(|normals| scene(cell, against, space, options(normals, loads)).check(down));
            let name = format!("{cell}, {against:?}, {loads:?}, {space:?}: {met:?}");
            assert!(met.good(), "{name}");
            assert!((met.cut > 200) == (against == Against::Narrow), "{name}");
            // The nodes of the edges beside its own are unknowns too; the middle one of the three has two such.
            let more = if against == Against::Narrow { 4 * around } else { 2 * around };
            assert_eq!(met.unknowns, own.unknowns + more, "{name}");
        }
    }
}

/// Also in the form that is the gradient of a potential, whose forces then act on the nodes around as well, and with
/// friction by the mean pressure of points whose own normals depend on more nodes.
#[test]
fn tangents_of_other_forms_are_exact() {
    for space in [Space::PlaneStrain, Space::Axisymmetric] {
        let variational = ContactOptions { form: ContactForm::Variational, ..options(Normals::Averaged, Loads::Both) };
        let met = scene("quad8", Against::Tool("parabola"), space, variational).check(0.13);
        assert!(met.good(), "{met:?}");
        let law = OdenPires { friction: 0.4, length: 0.05, radius: 0.5 }.into();
        let parts = (mesh("quad4", 0.2), space);
        let nonlocal = scene_of(parts, Against::Tool("line"), law, options(Normals::Averaged, Loads::Both));
        let met = nonlocal.check(0.25);
        assert!(met.branches[1] + met.branches[2] > 200 && met.worst < ALLOWED, "{met:?}");
    }
}

fn forces(scene: &Scene, first: Vec<f64>, second: &[f64]) -> Option<Vec<f64>> {
    perturbed::forces(&scene.contact, &scene.start(), first, second)
}

/// Both states turned as a whole, bodies and tool: the forces turn with them.
#[test]
fn a_turned_state_has_turned_forces() {
    let (sin, cos) = 0.7_f64.sin_cos();
    for against in [Against::Tool("parabola"), Against::Wide, Against::Narrow] {
        let scene = scene("quad4", against, Space::PlaneStrain, options(Normals::Averaged, Loads::Both));
        let (mut random, mut compared) = (Random(5), 0);
        let turn = |v: [f64; 2]| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]];
        let turned = |u: &[f64]| {
            let mut turned = u.to_vec();
            let mut set = |first: usize, x: Vec3| {
                let [a, b] = turn([x[0] + u[first], x[1] + u[first + 1]]);
                (turned[first], turned[first + 1]) = (a - x[0], b - x[1]);
            };
            (0..scene.dofs.nodes()).for_each(|node| set(scene.dofs.node(node), scene.mesh.points[node]));
            set(scene.dofs.tool(0), Vec3::new(1.5, -1.0, 0.0));
            turned[scene.dofs.tool(0) + 2] += 0.7;
            turned
        };
        for _ in 0..60 {
            let [first, second] = [0, 1].map(|_| scene.motion(0.1, &mut random));
            let plain = forces(&scene, first.clone(), &second);
            // The first motion turns the tool by less than what is refused as a turn, since nothing touches before it.
            let Some((plain, moved)) = plain.zip(forces(&scene, turned(&first), &turned(&second))) else { continue };
            for node in 0..scene.dofs.nodes() {
                let at = scene.dofs.node(node);
                let expected = turn([plain[at], plain[at + 1]]);
                let error = (expected[0] - moved[at]).hypot(expected[1] - moved[at + 1]);
                assert!(error <= 1e-11 * largest(&plain), "{against:?}: {error:.1e}");
            }
            compared += usize::from(largest(&plain) > 0.0);
        }
        assert!(compared > 20, "{against:?}: {compared}");
    }
}

/// On flat faces that stay flat both normals are one; on bent ones they are not.
#[test]
fn a_flat_surface_answers_as_with_its_own_normals() {
    for against in [Against::Tool("line"), Against::Wide, Against::Narrow] {
        let [flat, bent] = [0.0, 0.2].map(|bow| {
            let law: Rule = Coulomb::new(0.4).into();
            let both = [Normals::Own, Normals::Averaged].map(|normals| {
                let parts = (mesh("quad4", bow), Space::PlaneStrain);
                scene_of(parts, against, law.clone(), options(normals, Loads::Both))
            });
            // Each block turns, stretches and sinks as a whole.
            let moved = |down: f64| {
                let (scene, mut u) = (&both[0], vec![0.0; both[0].dofs.count()]);
                for (node, x) in scene.mesh.points.iter().enumerate() {
                    let narrow = f64::from(scene.mesh.groups["narrow"].nodes.contains(&node));
                    let at = scene.dofs.node(node);
                    u[at] = 0.03 * narrow + 0.05 * x[0];
                    u[at + 1] = -down * narrow + 0.02 * narrow * x[0];
                }
                u
            };
            let [own, averaged] = both.each_ref().map(|scene| forces(scene, moved(0.08), &moved(0.1)).unwrap());
            let differences: Vec<f64> = own.iter().zip(&averaged).map(|(a, b)| a - b).collect();
            assert!(largest(&own) > 1e-3, "{against:?}");
            largest(&differences) / largest(&own)
        });
        assert!(flat < 1e-13 && bent > 1e-3, "{against:?}: {flat:.1e} {bent:.1e}");
    }
}
