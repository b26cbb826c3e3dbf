//! The tangent of every stencil against central differences with Richardson's extrapolation, in scaled variables: all
//! bodies by a walk over the registered cells, contact points on edges of both degrees against every shape of target,
//! open, sticking and slipping. A state whose branch differs between perturbed evaluations is skipped and counted.

mod perturbed;

use asperity::Failure;
use asperity::contact::field::{FieldSurface, FieldTarget};
use asperity::contact::{ContactOptions, ContactParts, LoadedSides, PaperContact};
use asperity::declare::find;
use asperity::interface::{
    Rule,
    laws::{Coulomb, OdenPires},
};
use asperity::material::{Material, Rate, laws::Elastic};
use asperity::mesh::cells::ALL;
use asperity::mesh::generate::{Block, Rectangle};
use asperity::mesh::{Cell, Mesh, Side, Space};
use asperity::solid::{Body, BodyOptions, Formulation, Integration, Strain};
use asperity::system::{Attempt, Branch, Dofs, Local, Origin, Stencil, Stencils, Term};
use asperity::tensor::Vec3;
use asperity::tool::{ProfileTool, shapes};
use perturbed::{Random, check, commit, instant, state};
use std::sync::Arc;

/// Largest difference of an entry over the largest entry.
const ALLOWED: f64 = 2e-7;

/// A unit square or cube at radius 1, bent so that no cell is a rectangle.
fn mesh(cell: &'static Cell) -> Mesh {
    let mut mesh = match cell.dimension {
        2 => Rectangle::new([0.0; 2], [1.0; 2], [1; 2], cell).mesh("b").unwrap(),
        _ => Block::new([0.0; 3], [1.0; 3], [1; 3], cell).mesh("b").unwrap(),
    };
    for x in &mut mesh.points {
        let [a, b, c] = x.0;
        *x += Vec3::new(1.0 + 0.1 * a * b, 0.1 * b * (1.0 - a), if cell.dimension == 3 { 0.1 * a * c } else { 0.0 });
    }
    mesh
}

#[test]
fn tangents_of_all_bodies_are_exact() {
    bodies_are_exact(&(Arc::new(Rate(Elastic::new(2.0, 0.3))) as Arc<dyn Material>));
}

/// Strains of some per cent at a yield strain of a quarter of one.
#[test]
fn tangents_of_flowing_bodies_are_exact() {
    let von_mises = find(asperity::material::laws::ALL, "von_mises").unwrap();
    let flowing = (von_mises.build)(&[2.0, 0.3, 0.005, 0.1, 0.01, 5.0, 0.0, 0.0, 0.05, 2.0]).unwrap();
    bodies_are_exact(&Arc::from(flowing));
}

fn bodies_are_exact(material: &Arc<dyn Material>) {
    let (mut random, mut bodies) = (Random(1), 0);
    for cell in ALL.iter().copied().filter(|cell| cell.dimension > 1) {
        let mesh = Arc::new(mesh(cell));
        let spaces = [Space::PlaneStrain, Space::PlaneStress, Space::Axisymmetric, Space::Solid];
        for space in spaces.into_iter().filter(|space| space.dimension() == cell.dimension) {
            for integration in [Integration::Full, Integration::Reduced] {
                for formulation in [Formulation::Standard, Formulation::FBar, Formulation::Incompatible] {
                    for strain in [Strain::Finite, Strain::Small] {
                        let options = BodyOptions { formulation, integration, strain, ..BodyOptions::default() };
                        bodies += usize::from(body_is_exact(&mesh, space, (material, options), &mut random));
                    }
                }
            }
        }
    }
    assert!(bodies >= 2 * ALL.iter().filter(|cell| cell.dimension > 1).count(), "{bodies} bodies");
}

/// Whether there is such a body; its tangent is checked from a stressed and turned state.
fn body_is_exact(
    mesh: &Arc<Mesh>,
    space: Space,
    (material, options): (&Arc<dyn Material>, BodyOptions),
    random: &mut Random,
) -> bool {
    let dofs = Dofs::new(space.dimension(), mesh.points.len(), 0);
    let cells = (0..mesh.cell_count()).collect();
    let Ok(body) = Body::new("b", (mesh.clone(), dofs.clone(), space), cells, material.clone(), options) else {
        return false;
    };
    for _ in 0..3 {
        let mut about = |u: &[f64]| -> Vec<f64> { u.iter().map(|u| u + 0.04 * random.next()).collect() };
        let start = state(vec![0.0; dofs.count()], body.initial());
        let middle = about(&start.u);
        let accepted = commit(&body, &start, middle).unwrap();
        let attempt = body.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
        for result in check(attempt.as_ref(), &about(&accepted.u)).unwrap() {
            assert!(result.error < ALLOWED, "{} {space:?} {options:?}: {}", mesh.kinds[0].name, result.error);
        }
    }
    true
}

/// Volume of a brick of eight nodes: a third of the flux of the position through its bilinear sides, by two by two Gauss points.
fn volume(x: &[[f64; 3]]) -> f64 {
    let sides = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    let gauss = [0.5 - 0.75_f64.sqrt() / 3.0, 0.5 + 0.75_f64.sqrt() / 3.0];
    let points = || gauss.iter().flat_map(|a| gauss.iter().map(move |b| (*a, *b)));
    let flux = |side: &[usize; 4]| -> f64 {
        let [p, q, r, s] = side.map(|node| Vec3(x[node]));
        let at = |(a, b): (f64, f64)| {
            let (bottom, top) = (p + (q - p) * a, s + (r - s) * a);
            let along = [(q - p) * (1.0 - b) + (r - s) * b, top - bottom];
            (bottom + along[1] * b).dot(along[0].cross(along[1]))
        };
        points().map(at).sum::<f64>() / 4.0
    };
    sides.iter().map(flux).sum::<f64>() / 3.0
}

/// The shared volume of a brick bends the tangent by its second derivative times the mean stress: that of the trial state where the
/// tangent is the derivative of the forces, of the accepted state at a first guess, and after a step that of the volume to which it
/// leads linearly, but for the cube of the step. Here the mean stress is `K/2 (theta - 1/theta)`.
#[test]
fn the_shared_volume_bends_with_the_mean_stress_of_the_origin() {
    const BULK: f64 = 20.0;
    let law = find(asperity::material::laws::ALL, "neo_hookean").unwrap();
    let material: Arc<dyn Material> = Arc::from((law.build)(&[1.0, BULK]).unwrap());
    let mesh = Arc::new(mesh(Cell::named("hex8").unwrap()));
    let dofs = Dofs::new(3, mesh.points.len(), 0);
    let options = BodyOptions { formulation: Formulation::FBar, ..BodyOptions::default() };
    let body = Body::new("b", (mesh.clone(), dofs.clone(), Space::Solid), vec![0], material, options).unwrap();
    let nodes = mesh.cell(0).nodes;
    let mut random = Random(3);
    let mut about = |u: &[f64]| -> Vec<f64> { u.iter().map(|u| u + 0.04 * random.next()).collect() };
    let start = state(vec![0.0; dofs.count()], body.initial());
    let accepted = commit(&body, &start, about(&start.u)).unwrap();
    let attempt = body.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
    let mut stencils = Stencils::default();
    attempt.stencils(&accepted.u, &mut stencils).unwrap();
    let (stencil, unknowns) = (&stencils.list[0], stencils.dofs(&stencils.list[0]));
    let of_stencil = |u: &[f64]| -> Vec<f64> { unknowns.iter().map(|&dof| u[dof]).collect() };
    let from = about(&accepted.u);
    let mut u = from.clone();
    for &node in nodes {
        let upset = [1e-3, 1e-3, -2e-3];
        (0..3).for_each(|i| u[dofs.node(node) + i] += upset[i] * mesh.points[node].0[i]);
    }
    let tangent = |origin: Origin| {
        let mut local =
            Local { wants_tangent: true, u: of_stencil(&u), origin, from: of_stencil(&from), ..Local::default() };
        local.reset(stencil.len);
        attempt.evaluate(0, stencil, &mut attempt.scratch(0), &mut local).unwrap();
        local.tangent
    };
    let present = |u: &[f64]| -> f64 {
        let place = |&node: &usize| std::array::from_fn(|i| mesh.points[node].0[i] + u[dofs.node(node) + i]);
        volume(&nodes.iter().map(place).collect::<Vec<_>>())
    };
    let moved = |u: &[f64], by: &[(usize, f64)]| -> f64 {
        let mut u = u.to_vec();
        by.iter().for_each(|&(dof, by)| u[dof] += by);
        present(&u)
    };
    // The volume is linear in each coordinate, so that any difference is its derivative.
    let along = |dof: usize| 0.5 * (moved(&from, &[(dof, 1.0)]) - moved(&from, &[(dof, -1.0)]));
    let linear = present(&from) + (0..u.len()).map(|dof| along(dof) * (u[dof] - from[dof])).sum::<f64>();
    let [trial, before, linear] = [present(&u), present(&accepted.u), linear].map(|volume| {
        let theta = volume / present(&start.u);
        0.5 * BULK * (theta - 1.0 / theta)
    });
    assert!((trial - linear).abs() > 1e-6 * BULK && (trial - before).abs() > 1e-3 * BULK, "{trial} {linear} {before}");
    let exact = tangent(Origin::Unknown);
    for (origin, stress, allowed) in [(Origin::Accepted, before, 1e-9), (Origin::Step, linear, 1e-2)] {
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        for ((place, exact), with) in exact.iter().enumerate().zip(tangent(origin)) {
            let (i, j) = (unknowns[place / u.len()], unknowns[place % u.len()]);
            let second = if i == j {
                0.0
            } else {
                let corner = |a: f64, b: f64| a * b * moved(&u, &[(i, 0.5 * a), (j, 0.5 * b)]);
                corner(1.0, 1.0) + corner(1.0, -1.0) + corner(-1.0, 1.0) + corner(-1.0, -1.0)
            };
            let bent = (trial - stress) * second;
            (worst, largest) = (worst.max((exact - with - bent).abs()), largest.max(bent.abs()));
        }
        assert!(worst < allowed * largest, "{origin:?}: {worst:.1e} of {largest:.1e}");
    }
}

/// A contact of the lower side of one cell with a target of one segment below it, its tool free to move.
fn contact(cell: &str, shape: &str, space: Space) -> (PaperContact, Dofs) {
    let mesh = Rectangle::new([1.0, 0.0], [2.0, 1.0], [1; 2], Cell::named(cell).unwrap()).mesh("b").unwrap();
    let dofs = Dofs::new(2, mesh.points.len(), 1);
    let mesh = Arc::new(mesh);
    let point = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let nodes = match shape {
        "line" => vec![point(4.0, 0.1), point(-1.0, -0.1)],
        _ => vec![point(4.0, -0.3), point(1.4, 0.0), point(-1.0, -0.3)],
    };
    let profile = vec![shapes::find(shape).unwrap().build(&nodes).unwrap()];
    let tool = Arc::new(ProfileTool::new("t", vec![profile], point(1.5, -1.0)));
    let boundary = (0..mesh.kinds[0].faces.len()).map(|face| Side { cell: 0, face }).collect();
    (made((mesh, &dofs, space), boundary, tool, Coulomb::new(0.4).into()), dofs)
}

/// The contact of the lower side of a body with a tool.
fn made(
    (mesh, dofs, space): (Arc<Mesh>, &Dofs, Space),
    boundary: Vec<Side>,
    tool: Arc<ProfileTool>,
    law: Rule,
) -> PaperContact {
    let parts = ContactParts {
        name: "c".into(),
        surface: FieldSurface::whole(&mesh, &mesh.groups["b.bottom"].sides, space, 0.8),
        mesh,
        dofs: dofs.clone(),
        space,
        boundary,
        target: FieldTarget::tool(tool, 0, dofs),
        law,
        options: ContactOptions { thickness: 0.8, ..perturbed::options(LoadedSides::Both) },
    };
    PaperContact::new(parts, None)
}

/// Random motion: the cell by up to a tenth and downwards, its nodes and the tool by a little.
fn motion(dofs: &Dofs, random: &mut Random) -> Vec<f64> {
    let (right, down) = (0.08 * random.next(), -0.1 - 0.13 * random.next());
    let mut u = vec![0.0; dofs.count()];
    for node in 0..dofs.nodes() {
        u[dofs.node(node)] = right + 0.02 * random.next();
        u[dofs.node(node) + 1] = down + 0.02 * random.next();
    }
    let tool = dofs.tool(0);
    (tool..tool + 3).for_each(|dof| u[dof] = 0.03 * random.next());
    u
}

/// Looks at random states, each after a random accepted one.
fn contact_states(cell: &str, shape: &str, space: Space, look: &mut dyn FnMut(&dyn Attempt, &[f64])) {
    let ((contact, dofs), mut random) = (contact(cell, shape, space), Random(7));
    let start = state(vec![0.0; dofs.count()], contact.initial());
    for _ in 0..1500 {
        let accepted = commit(&contact, &start, motion(&dofs, &mut random)).unwrap();
        let attempt = contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
        look(attempt.as_ref(), &motion(&dofs, &mut random));
    }
}

#[test]
fn tangents_of_contact_are_exact() {
    for cell in ["quad4", "quad8"] {
        for shape in ["line", "parabola", "arc"] {
            for space in [Space::PlaneStrain, Space::Axisymmetric] {
                let (mut met, mut skipped, mut worst) = ([0; 3], 0, 0.0_f64);
                contact_states(cell, shape, space, &mut |attempt, u| {
                    for result in check(attempt, u).unwrap() {
                        met[usize::from(result.branch)] += 1;
                        skipped += usize::from(!result.smooth);
                        assert!(result.error.is_finite());
                        worst = if result.smooth { worst.max(result.error) } else { worst };
                    }
                });
                let name = format!("{cell}, {shape}, {space:?}: {met:?} skipped {skipped} worst {worst:.1e}");
                assert!(met.iter().all(|&met| met >= 100), "{name}");
                assert!(20 * skipped <= met.iter().sum::<usize>(), "{name}");
                assert!(worst < ALLOWED, "{name}");
            }
        }
    }
}

/// An attempt whose largest derivative is wrong by a part of 1e-5.
struct Spoilt<'a>(&'a dyn Attempt);

impl Attempt for Spoilt<'_> {
    fn scratch(&self, index: usize) -> Vec<f64> {
        self.0.scratch(index)
    }
    fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        self.0.stencils(u, out)
    }
    fn evaluate(&self, index: usize, stencil: &Stencil, new: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let branch = self.0.evaluate(index, stencil, new, local)?;
        if let Some(entry) = local.tangent.iter_mut().max_by(|a, b| a.abs().total_cmp(&b.abs())) {
            *entry *= 1.0 + 1e-5;
        }
        Ok(branch)
    }
}

#[test]
fn a_wrong_derivative_is_found() {
    let mut found = 0;
    contact_states("quad8", "arc", Space::Axisymmetric, &mut |attempt, u| {
        for result in check(&Spoilt(attempt), u).unwrap().iter().filter(|result| result.smooth && result.branch > 0) {
            assert!(result.error > 10.0 * ALLOWED, "{}", result.error);
            found += 1;
        }
    });
    assert!(found > 100);
}

/// A strip of three cells on a slanted line, with friction by the mean pressure within a radius.
fn nonlocal(radius: f64, space: Space) -> (PaperContact, Dofs) {
    let mesh = Rectangle::new([1.0, 0.0], [2.0, 1.0], [3, 1], Cell::named("quad8").unwrap()).mesh("b").unwrap();
    let dofs = Dofs::new(2, mesh.points.len(), 1);
    let mesh = Arc::new(mesh);
    let nodes = [Vec3::new(4.0, 0.1, 0.0), Vec3::new(-1.0, -0.1, 0.0)];
    let profile = vec![shapes::find("line").unwrap().build(&nodes).unwrap()];
    let tool = Arc::new(ProfileTool::new("t", vec![profile], Vec3::new(1.5, -1.0, 0.0)));
    let boundary = mesh.boundary(&[0, 1, 2]);
    let law = OdenPires { friction: 0.4, length: 0.05, radius }.into();
    (made((mesh, &dofs, space), boundary, tool, law), dofs)
}

/// Pressed by enough to be closed everywhere: the mean has no other bends.
fn pressed(dofs: &Dofs, random: &mut Random) -> Vec<f64> {
    let mut u = motion(dofs, random);
    (0..dofs.nodes()).for_each(|node| u[dofs.node(node) + 1] -= 0.12);
    u
}

/// Friction by the mean pressure at the trial displacements: its tangent is exact along the unknowns of the neighbours.
#[test]
fn tangents_of_nonlocal_friction_are_exact() {
    for space in [Space::PlaneStrain, Space::Axisymmetric] {
        let ((contact, dofs), mut random) = (nonlocal(0.5, space), Random(19));
        let start = state(vec![0.0; dofs.count()], contact.initial());
        let (mut met, mut worst, mut most) = (0, 0.0_f64, 0);
        for _ in 0..100 {
            let accepted = commit(&contact, &start, pressed(&dofs, &mut random)).unwrap();
            let attempt = contact.attempt(&accepted, &accepted.histories[0], instant()).unwrap();
            let trial = pressed(&dofs, &mut random);
            let mut stencils = Stencils::default();
            attempt.stencils(&trial, &mut stencils).unwrap();
            most = stencils.list.iter().map(|stencil| stencil.len).max().unwrap();
            // Some lie too deep to be taken for contact.
            let Ok(results) = check(attempt.as_ref(), &trial) else { continue };
            for result in results.iter().filter(|result| result.smooth) {
                (met, worst) = (met + usize::from(result.branch > 0), worst.max(result.error));
            }
        }
        // Three nodes of its own, the tool, three of each of the other two edges.
        assert!(met > 300 && most == 6 + 3 + 12 && worst < ALLOWED, "{space:?}: {met} {most} {worst:.1e}");
    }
}

/// The mean pressure is that of the points around by the weights that the law states; far ones do not count.
#[test]
fn nonlocal_friction_takes_the_mean() {
    let ((wide, dofs), mut random) = (nonlocal(0.5, Space::PlaneStrain), Random(23));
    let (narrow, _) = nonlocal(1e-3, Space::PlaneStrain);
    let u = pressed(&dofs, &mut random);
    let records = |contact: &PaperContact| {
        let start = state(vec![0.0; dofs.count()], contact.initial());
        let first = commit(contact, &start, pressed(&dofs, &mut Random(29))).unwrap();
        let end = commit(contact, &first, u.clone()).unwrap();
        contact.records(&end.u, &end.histories[0])
    };
    let (mean, local) = (records(&wide), records(&narrow));
    let rest = |i: usize| 1.0 + (i / 2) as f64 / 3.0 + (0.5 + [-0.5, 0.5][i % 2] / 3.0_f64.sqrt()) / 3.0;
    let mut apart = 0.0_f64;
    for i in 0..6 {
        let weight = |j: usize| {
            let part = ((rest(i) - rest(j)) / 0.5).powi(2);
            if part < 1.0 { (1.0 / (part - 1.0)).exp() } else { 0.0 }
        };
        let sum = |of: &dyn Fn(usize) -> f64| (0..6).map(|j| weight(j) * of(j)).sum::<f64>();
        let expected = sum(&|j| local[j].pressure) / sum(&|_| 1.0);
        assert!((mean[i].pressure / local[i].pressure - 1.0).abs() < 1e-12);
        let ratio = mean[i].shear / local[i].shear;
        assert!((ratio * local[i].pressure / expected - 1.0).abs() < 1e-10, "{i}: {ratio} {expected}");
        apart = apart.max((ratio - 1.0).abs());
    }
    assert!(apart > 0.01, "{apart}");
}
