//! Loads against closed forms, against the volume they work on, and their tangents against perturbation.

use super::*;
use crate::amplitude::{Amplitude, Change, Timeline};
use crate::mesh::cells::ALL;
use crate::mesh::generate::{Block, Rectangle};
use crate::mesh::{Cell, Faces, Side};
use crate::system::{Attempt, Instant, Local, State, Stencils, Term, check_tangent};
use std::f64::consts::{PI, TAU};

/// Forces of a term on all unknowns at displacements `u`, at the end of its first step.
fn forces(term: &dyn Term, dofs: &Dofs, u: &[f64]) -> Vec<f64> {
    let state = State { u: u.to_vec(), ..State::default() };
    let history = term.initial();
    let at = Instant { step: 0, step_time: 1.0, time: 1.0, dt: 1.0, factor: None };
    let attempt = term.attempt(&state, &history, at).unwrap();
    let mut sum = vec![0.0; dofs.count()];
    each_stencil(attempt.as_ref(), u, &mut |dofs, local| {
        dofs.iter().zip(&local.force).for_each(|(&dof, force)| sum[dof] += force);
    });
    sum
}

fn each_stencil(attempt: &dyn Attempt, u: &[f64], then: &mut dyn FnMut(&[usize], &Local)) {
    let (mut stencils, mut local) = (Stencils::default(), Local::default());
    attempt.stencils(u, &mut stencils).unwrap();
    for (index, stencil) in stencils.list.iter().enumerate() {
        let dofs = stencils.dofs(stencil);
        local.u = dofs.iter().map(|&dof| u[dof]).collect();
        local.reset(stencil.len);
        attempt.evaluate(index, stencil, &mut attempt.scratch(index), &mut local).unwrap();
        then(dofs, &local);
    }
}

fn resultant(site: &Site, forces: &[f64]) -> Vec3 {
    let mut sum = Vec3::zero();
    for (i, force) in forces.iter().enumerate() {
        sum[i % site.dofs.per_node()] += force;
    }
    sum
}

fn at_once(value: f64) -> Timeline {
    Timeline::constant(value)
}

const THICKNESS: f64 = 0.7;

fn site(mesh: Mesh, space: Space) -> Site {
    let dofs = Dofs::new(space.dimension(), mesh.points.len(), 1);
    Site { mesh: Arc::new(mesh), dofs, space, thickness: THICKNESS }
}

/// Every registered cell in every space that it can fill: a 3 x 4 rectangle at `x = 2` or a 3 x 4 x 2 block there.
fn sites() -> Vec<(String, Site)> {
    let mut all = Vec::new();
    for &cell in ALL {
        for space in Space::ALL.into_iter().filter(|space| space.dimension() == cell.dimension) {
            all.push((format!("{} {}", cell.name, space.name()), site(block(cell), space)));
        }
    }
    assert_eq!(all.len(), 5 * 3 + 7);
    all
}

fn block(cell: &'static Cell) -> Mesh {
    let mesh = match cell.dimension {
        2 => Rectangle::new([2.0, 1.0], [5.0, 5.0], [2, 3], cell).mesh("b"),
        _ => Block::new([2.0, 1.0, -1.0], [5.0, 5.0, 1.0], [2, 2, 1], cell).mesh("b"),
    };
    mesh.unwrap()
}

/// The sides of the block's group of that name.
fn group(site: &Site, side: &str) -> Vec<Side> {
    let mut named = site.mesh.groups.iter().filter(|(name, group)| name.ends_with(side) && !group.sides.is_empty());
    named.next().unwrap().1.sides.clone()
}

/// Reproducible displacements of some size, different for every unknown.
fn shaken(site: &Site, size: f64) -> Vec<f64> {
    (0..site.dofs.count()).map(|i| size * (1.7 * i as f64 + 0.3 * (i * i % 17) as f64).sin()).collect()
}

/// What an area of the plane is multiplied by: thickness, or circumference at the radius `r`.
fn depth(site: &Site, r: f64) -> f64 {
    match site.space {
        Space::Axisymmetric => TAU * r,
        Space::Solid => 2.0,
        _ => THICKNESS,
    }
}

fn near(a: Vec3, b: Vec3, what: &str) {
    assert!((a - b).norm() < 1e-12 * b.norm().max(1.0), "{what}: {a:?} instead of {b:?}");
}

#[test]
fn pressure_on_a_flat_side_is_pressure_times_area_along_its_inward_normal() {
    for (name, site) in sites() {
        let at_rest = vec![0.0; site.dofs.count()];
        // The mean radius of a flat ring is that of its middle circle: pi (b^2 - a^2) = 2 pi (a + b) / 2 (b - a).
        let cases = [
            ("left", Vec3::new(4.0 * depth(&site, 2.0), 0.0, 0.0)),
            ("right", Vec3::new(-4.0 * depth(&site, 5.0), 0.0, 0.0)),
            ("top", Vec3::new(0.0, -3.0 * depth(&site, 3.5), 0.0)),
        ];
        for (side, area) in cases {
            let sides = group(&site, side);
            let follower = FollowerPressure::new("p", site.clone(), &sides, at_once(10.0)).unwrap();
            let dead = dead_pressure("p", &site, &sides, at_once(10.0)).unwrap();
            for term in [&follower as &dyn Term, &dead] {
                near(resultant(&site, &forces(term, &site.dofs, &at_rest)), area * 10.0, &format!("{name} {side}"));
            }
            // A dead load does not notice displacements; a follower does.
            let u = shaken(&site, 0.1);
            near(resultant(&site, &forces(&dead, &site.dofs, &u)), area * 10.0, &name);
            let moved = resultant(&site, &forces(&follower, &site.dofs, &u));
            assert!((moved - area * 10.0).norm() > 1e-3, "{name} {side}");
        }
    }
}

#[test]
fn tractions_and_body_forces_sum_to_area_and_volume_times_their_value() {
    for (name, site) in sites() {
        let u = shaken(&site, 0.1);
        let given = Vec3::new(3.0, -2.0, if site.space == Space::Solid { 5.0 } else { 0.0 });
        let components = || given.0[..site.space.dimension()].iter().map(|&v| at_once(v)).collect::<Vec<_>>();
        let load = traction("t", &site, &group(&site, "top"), components()).unwrap();
        let area = 3.0 * depth(&site, 3.5);
        near(resultant(&site, &forces(&load, &site.dofs, &u)), given * area, &name);
        let cells: Vec<usize> = (0..site.mesh.cell_count()).collect();
        let load = body_force("b", &site, &cells, components());
        near(resultant(&site, &forces(&load, &site.dofs, &u)), given * (4.0 * area), &name);
    }
    // The ring of the axisymmetric block once more, without the helper.
    let ring = site(block(Cell::named("quad8").unwrap()), Space::Axisymmetric);
    let load = body_force("b", &ring, &[0, 1, 2, 3, 4, 5], vec![at_once(0.0), at_once(1.0)]);
    let volume = resultant(&ring, &forces(&load, &ring.dofs, &shaken(&ring, 0.0)))[1];
    assert!((volume - PI * (25.0 - 4.0) * 4.0).abs() < 1e-11, "{volume}");
}

/// Volume of the whole mesh after displacements, with thickness or circumference.
fn volume(site: &Site, u: &[f64]) -> f64 {
    let dim = site.dofs.per_node();
    let moved = |(i, &x): (usize, &Vec3)| {
        let mut x = x;
        (0..dim).for_each(|axis| x[axis] += u[i * dim + axis]);
        x
    };
    let points: Vec<Vec3> = site.mesh.points.iter().enumerate().map(moved).collect();
    let cell = |c: usize| {
        let view = site.mesh.cell(c);
        let rule = view.kind.gauss[2].unwrap_or(view.kind.full);
        let part = |(&xi, w): (&[f64; 3], &f64)| w * view.jacobian(&points, xi) * site.depth(view.map(&points, xi).0);
        rule.points.iter().zip(rule.weights).map(part).sum::<f64>()
    };
    (0..site.mesh.cell_count()).map(cell).sum()
}

/// On a closed surface a follower pressure has no resultant, and its forces are `-p dV/du` at any displacements: it
/// has the potential `p V`.
#[test]
fn follower_pressure_on_a_closed_surface_works_on_the_volume() {
    for (name, site) in sites() {
        let (u, p) = (shaken(&site, 0.08), 10.0);
        let outer = Faces::of(&site.mesh, 0..site.mesh.cell_count()).outer();
        let load = FollowerPressure::new("p", site.clone(), &outer, at_once(p)).unwrap();
        let forces = forces(&load, &site.dofs, &u);
        let scale = forces.iter().map(|f| f.abs()).fold(0.0, f64::max);
        let mut sum = resultant(&site, &forces);
        if site.space == Space::Axisymmetric {
            assert!(sum[0] < -1.0, "{name}: a ring under pressure is pushed inwards");
            sum[0] = 0.0;
        }
        assert!(sum.norm() < 1e-13 * scale, "{name}: {sum:?}");
        for dof in (0..site.dofs.per_node() * site.dofs.nodes()).step_by(3) {
            let h = 1e-3;
            let side = |h: f64| {
                let mut moved = u.clone();
                moved[dof] += h;
                volume(&site, &moved)
            };
            // The volume is at most a cubic of one displacement: Richardson's extrapolation is exact.
            let slope = |h: f64| (side(h) - side(-h)) / (2.0 * h);
            let work = -p * (4.0 * slope(h) - slope(2.0 * h)) / 3.0;
            // The full rules of these two are too coarse for the volume of a curved cell.
            if !matches!(site.mesh.kinds[0].name, "tet10" | "wedge15") {
                assert!((forces[dof] - work).abs() < 1e-9 * scale, "{name} {dof}: {} {work}", forces[dof]);
            }
        }
    }
}

/// The resultant moment of a follower pressure on a closed surface vanishes too.
#[test]
fn follower_pressure_on_a_closed_surface_has_no_moment() {
    for (name, site) in sites().into_iter().filter(|(_, site)| site.space != Space::Axisymmetric) {
        let (u, dim) = (shaken(&site, 0.08), site.dofs.per_node());
        let outer = Faces::of(&site.mesh, 0..site.mesh.cell_count()).outer();
        let load = FollowerPressure::new("p", site.clone(), &outer, at_once(10.0)).unwrap();
        let forces = forces(&load, &site.dofs, &u);
        let vector =
            |of: &[f64], node: usize| Vec3(std::array::from_fn(|a| if a < dim { of[node * dim + a] } else { 0.0 }));
        let mut moment = Vec3::zero();
        for (node, &x) in site.mesh.points.iter().enumerate() {
            moment += (x + vector(&u, node)).cross(vector(&forces, node));
        }
        assert!(moment.norm() < 1e-11, "{name}: {moment:?}");
    }
}

fn check(name: &str, term: &dyn Term, u: &[f64]) -> usize {
    let state = State { u: u.to_vec(), ..State::default() };
    let history = term.initial();
    let at = Instant { step: 0, step_time: 1.0, time: 1.0, dt: 1.0, factor: None };
    let attempt = term.attempt(&state, &history, at).unwrap();
    let mut stencils = Stencils::default();
    attempt.stencils(u, &mut stencils).unwrap();
    for (index, stencil) in stencils.list.iter().enumerate() {
        let here: Vec<f64> = stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect();
        let found = check_tangent(attempt.as_ref(), index, stencil, &here, &vec![1.0; here.len()]).unwrap();
        assert!(found.smooth && found.error < 1e-9, "{name}: {} has {:.1e}", term.name_of(index), found.error);
    }
    stencils.list.len()
}

#[test]
fn tangents_of_follower_pressure_equal_perturbation() {
    let mut faces = 0;
    for (name, site) in sites() {
        let outer = Faces::of(&site.mesh, 0..site.mesh.cell_count()).outer();
        let load = FollowerPressure::new("p", site.clone(), &outer, at_once(10.0)).unwrap();
        faces += check(&name, &load, &shaken(&site, 0.15));
    }
    assert!(faces > 300, "{faces}");
}

#[test]
fn springs_pull_back_store_energy_and_have_their_stiffness_as_tangent() {
    let site = site(block(Cell::named("quad4").unwrap()), Space::PlaneStrain);
    let springs = Springs::new("s", site.dofs.clone(), vec![3, 5], vec![at_once(2.0), at_once(7.0)]);
    let u = shaken(&site, 0.4);
    let forces = forces(&springs, &site.dofs, &u);
    assert_eq!((forces[6], forces[7], forces[11]), (2.0 * u[6], 7.0 * u[7], 7.0 * u[11]));
    assert_eq!(forces.iter().filter(|&&f| f != 0.0).count(), 4);
    assert_eq!(check("springs", &springs, &u), 2);
    let (state, history) = (State { u: u.clone(), ..State::default() }, springs.initial());
    let attempt = springs.attempt(&state, &history, Instant::default()).unwrap();
    let mut stored = 0.0;
    each_stencil(attempt.as_ref(), &u, &mut |_, local| stored += local.energies.stored);
    let expected: f64 = [6, 7, 10, 11].iter().map(|&i| 0.5 * if i % 2 == 0 { 2.0 } else { 7.0 } * u[i] * u[i]).sum();
    assert!((stored - expected).abs() < 1e-15);
}

#[test]
fn forces_go_to_their_nodes_and_tools_and_follow_their_timeline() {
    let site = site(block(Cell::named("quad4").unwrap()), Space::PlaneStrain);
    let u = vec![0.0; site.dofs.count()];
    let ramp = Timeline::new([(2.0, Change::To(8.0, Amplitude::ramp())), (1.0, Change::Keep), (1.0, Change::Release)]);
    let load = force_on_nodes("f", &site.dofs, &[1, 4], vec![at_once(3.0), ramp]);
    let (state, history) = (State::default(), load.initial());
    for (step, step_time, expected) in [(0, 0.5, 2.0), (0, 2.0, 8.0), (1, 0.4, 8.0), (2, 0.25, 6.0), (2, 1.0, 0.0)] {
        let at = Instant { step, step_time, ..Instant::default() };
        let attempt = load.attempt(&state, &history, at).unwrap();
        each_stencil(attempt.as_ref(), &u, &mut |_, local| assert_eq!(local.force, [3.0, expected]));
    }
    let on_tool = force_on_tool("g", &site.dofs, 0, vec![at_once(1.0), at_once(-2.0), at_once(9.0)]);
    let forces = forces(&on_tool, &site.dofs, &u);
    assert_eq!(forces[site.dofs.tool(0)..], [1.0, -2.0, 9.0]);
    assert!(forces[..site.dofs.tool(0)].iter().all(|&f| f == 0.0));
}

#[test]
fn loads_name_what_they_act_on() {
    let site = site(block(Cell::named("quad4").unwrap()), Space::PlaneStrain);
    let top = group(&site, "top");
    let load = FollowerPressure::new("lid", site.clone(), &top, at_once(1.0)).unwrap();
    assert_eq!(load.name_of(0), format!("face 2 of cell {} under pressure 'lid'", top[0].cell));
    let load = force_on_nodes("pull", &site.dofs, &[4], vec![]);
    assert_eq!(load.name_of(0), "node 4 under load 'pull'");
    assert_eq!(forces(&load, &site.dofs, &[0.0; 100]).iter().sum::<f64>(), 0.0);
}
