//! A bent unit cube over a tool of any kind, and random motions that press the one on the other.

use super::perturbed::{Random, options};
use asperity::contact::field::{FieldSurface, FieldTarget};
use asperity::contact::{ContactParts, LoadedSides, PaperContact};
use asperity::interface::InterfaceLaw;
use asperity::mesh::{Cell, Space, generate::Block};
use asperity::system::Dofs;
use asperity::tensor::Vec3;
use asperity::tool::shapes;
use asperity::tool::space::solids::{Facets, cone, extruded, polygons, sphere, torus};
use asperity::tool::space::{ProfileFrame, SpaceTool};
use std::sync::Arc;

/// A point.
pub fn at(x: f64, y: f64, z: f64) -> Vec3 {
    Vec3::new(x, y, z)
}

/// Something of the target's kind whose highest place is near the middle of the unit square `z = 0`.
fn target(kind: &str) -> Facets {
    let corners = [at(-3.0, -3.0, -0.2), at(4.0, -3.0, 0.1), at(4.0, 4.0, -0.1), at(-3.0, 4.0, 0.2)];
    match kind {
        "triangle" => polygons([vec![at(-4.0, -4.0, -0.1), at(6.0, -4.0, 0.1), at(0.5, 7.0, 0.0)]]).unwrap(),
        "quad" => polygons([corners.to_vec()]).unwrap(),
        "sphere" => sphere(at(0.5, 0.4, -4.0), 4.0).unwrap(),
        "cone" => cone(at(-5.0, 0.5, -3.0), at(6.0, 0.6, -3.0), [2.8, 3.2], 0.0).unwrap(),
        "torus" => torus(at(0.5, 0.4, -5.0), at(0.1, 1.0, 0.1), 3.0, 2.0).unwrap(),
        _ => {
            let nodes = [at(4.0, -0.3, 0.0), at(0.5, -0.02, 0.0), at(-3.0, -0.3, 0.0)];
            let shape = shapes::find(kind).unwrap().build(&nodes).unwrap();
            let frame = ProfileFrame::across(at(0.0, 4.0, 0.0), at(0.0, -1.0, 0.01), at(1.0, 0.0, 0.0)).unwrap();
            extruded(vec![shape], frame, 8.0)
        }
    }
}

/// A contact of the lower faces of a bent unit cube of `n` times `n` cells with a target below it, its tool free to move.
pub fn contact<L: InterfaceLaw>((cell, n): (&str, usize), kind: &str, law: L) -> (PaperContact, Dofs) {
    let mut mesh = Block::new([0.0; 3], [1.0; 3], [n, n, 1], Cell::named(cell).unwrap()).mesh("b").unwrap();
    for x in &mut mesh.points {
        let [a, b, c] = x.0;
        *x += at(0.1 * a * b, 0.15 * b * (1.0 - a), 0.04 * a * (1.0 - b) * (1.0 - c));
    }
    let dofs = Dofs::new(3, mesh.points.len(), 1);
    let mesh = Arc::new(mesh);
    let tool = Arc::new(SpaceTool::new("t", target(kind), at(0.5, 0.3, -1.0)));
    let boundary = mesh.boundary(&(0..mesh.cell_count()).collect::<Vec<_>>());
    let lower = mesh.groups["b.back"].sides.clone();
    let parts = ContactParts {
        name: "c".into(),
        surface: FieldSurface::whole(&mesh, &lower, Space::Solid, 1.0),
        space: Space::Solid,
        mesh,
        dofs: dofs.clone(),
        boundary,
        target: FieldTarget::solid_tool(tool, 0, &dofs),
        law: law.into(),
        options: options(LoadedSides::Both),
    };
    (PaperContact::new(parts, None), dofs)
}

/// Random motion: the cube by up to a tenth and downwards, its nodes and the tool by a little.
pub fn motion(dofs: &Dofs, random: &mut Random) -> Vec<f64> {
    let (right, back, down) = (0.06 * random.next(), 0.06 * random.next(), -0.08 - 0.1 * random.next());
    let mut u = vec![0.0; dofs.count()];
    for node in 0..dofs.nodes() {
        for (axis, by) in [right, back, down].into_iter().enumerate() {
            u[dofs.node(node) + axis] = by + 0.01 * random.next();
        }
    }
    let tool = dofs.tool(0);
    (tool..tool + 6).for_each(|dof| u[dof] = 0.03 * random.next());
    u
}
