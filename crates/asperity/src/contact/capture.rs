//! How deep a contact may lie: half the distance from a point, along its inward normal, to where the ray leaves the
//! point's own body. Derived from the accepted state, so that no depth has to be given.

use super::point::triad;
use super::surface::Surface;
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::Vec3;

/// Chords of the body's boundary in the accepted state.
pub struct Boundary {
    chords: Vec<[Vec3; 2]>,
}

/// Present positions of nodes.
pub fn positions<'a>(
    mesh: &'a Mesh,
    dofs: &'a Dofs,
    nodes: &'a [usize],
    u: &'a [f64],
) -> impl Iterator<Item = Vec3> + 'a {
    nodes.iter().map(move |&node| {
        let (mut x, first) = (mesh.points[node], dofs.node(node));
        (0..dofs.per_node()).for_each(|c| x[c] += u[first + c]);
        x
    })
}

impl Boundary {
    /// The chords of the given sides at displacements `u`; second-degree edges count as two.
    pub fn new(mesh: &Mesh, dofs: &Dofs, sides: &[Side], u: &[f64]) -> Self {
        let mut chords = Vec::new();
        for &side in sides {
            let nodes: Vec<usize> = mesh.side(side).1.collect();
            let x: Vec<Vec3> = positions(mesh, dofs, &nodes, u).collect();
            match x.as_slice() {
                [a, b] => chords.push([*a, *b]),
                [a, b, middle] => chords.extend([[*a, *middle], [*middle, *b]]),
                _ => {}
            }
        }
        Self { chords }
    }

    /// Distance along `direction` from `origin`, which lies on the boundary, to the next crossing.
    fn depth(&self, origin: Vec3, direction: Vec3, own: f64) -> f64 {
        let mut depth = f64::INFINITY;
        for [a, b] in &self.chords {
            let (d, to) = (*b - *a, *a - origin);
            let cross = |v: Vec3, w: Vec3| v[0] * w[1] - v[1] * w[0];
            let span = cross(direction, d);
            let (u, s) = (cross(to, d) / span, cross(to, direction) / span);
            if u > own && u < depth && (-1e-9..=1.0 + 1e-9).contains(&s) {
                depth = u;
            }
        }
        depth
    }
}

/// The largest admissible penetration at each point of a surface; infinite where the ray never leaves the body.
pub fn depths(surface: &Surface, mesh: &Mesh, dofs: &Dofs, boundary: &[Side], u: &[f64]) -> Vec<f64> {
    let boundary = Boundary::new(mesh, dofs, boundary, u);
    let at = |point: &super::surface::SurfacePoint| {
        let x: Vec<Vec3> = positions(mesh, dofs, surface.nodes(point), u).collect();
        let (a, tangent) = point.place(&x);
        let (_, inward, length) = triad(tangent);
        0.5 * boundary.depth(a, inward, 1e-3 * length)
    };
    surface.points.iter().map(at).collect()
}
