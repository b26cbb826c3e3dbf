//! How deep a contact may lie: half the distance from a point, along its inward normal, to where the ray leaves the
//! point's own body. Derived from the accepted state, so that no depth has to be given.

use super::point::triad;
use super::surface::Surface;
use crate::Failure;
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::Vec3;
use std::f64::consts::FRAC_PI_2;

/// Chords of the body's boundary in the accepted state.
pub struct Boundary {
    chords: Vec<(Side, [Vec3; 2])>,
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
                [a, b] => chords.push((side, [*a, *b])),
                [a, b, middle] => chords.extend([(side, [*a, *middle]), (side, [*middle, *b])]),
                _ => {}
            }
        }
        Self { chords }
    }

    /// Distance along `direction` from `origin`, which lies on the side `own`, to the next crossing. A point of a
    /// curved side lies off its chords, so that these are left out; `least` is a distance within rounding of a corner.
    fn depth(&self, origin: Vec3, direction: Vec3, own: Side, least: f64) -> f64 {
        let mut depth = f64::INFINITY;
        for (_, [a, b]) in self.chords.iter().filter(|(side, _)| *side != own) {
            let (d, to) = (*b - *a, *a - origin);
            let cross = |v: Vec3, w: Vec3| v[0] * w[1] - v[1] * w[0];
            let span = cross(direction, d);
            let (u, s) = (cross(to, d) / span, cross(to, direction) / span);
            if u > least && u < depth && (-1e-9..=1.0 + 1e-9).contains(&s) {
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
        0.5 * boundary.depth(a, inward, surface.edges[point.edge].side, 1e-3 * length)
    };
    surface.points.iter().map(at).collect()
}

/// Refuses a point that nothing was seen from before and that now lies deep: it has jumped over the target's face.
/// `depth` is its largest admissible penetration.
pub fn refuse_jump(penetration: f64, depth: f64, name: impl FnOnce() -> String) -> Result<(), Failure> {
    if penetration > 0.25 * depth {
        return Err(Failure::new(format!("{} came to lie {penetration:.3e} deep in one increment", name())));
    }
    Ok(())
}

/// Refuses a touching tool that turned by more than a quarter of a turn, in radians: the slip is a chord, and half a turn
/// brings what was touched to the other side, where none is seen.
pub fn refuse_turn(turned: f64, name: impl FnOnce() -> String) -> Result<(), Failure> {
    if turned.abs() > FRAC_PI_2 {
        let degrees = turned.abs().to_degrees();
        return Err(Failure::new(format!("{}: its tool turned by {degrees:.0} degrees in one increment", name())));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Cell, generate::Annulus};

    /// A point of a coarse curved edge lies well outside its chords: they are not what is behind it.
    #[test]
    fn the_body_behind_a_curved_edge_is_not_the_edge_itself() {
        let ring = Annulus::new([0.0, 0.0], [2.0, 10.0], [0.0, 360.0], [4, 16], Cell::named("quad8").unwrap());
        let mesh = ring.mesh("ring").unwrap();
        let dofs = Dofs::new(2, mesh.points.len(), 0);
        let surface = Surface::new(&mesh, &mesh.groups["ring.outer"].sides, None);
        let boundary = mesh.boundary(&(0..mesh.cell_count()).collect::<Vec<_>>());
        let depths = depths(&surface, &mesh, &dofs, &boundary, &vec![0.0; dofs.count()]);
        assert_eq!(depths.len(), 32);
        assert!(depths.iter().all(|depth| (depth - 4.0).abs() < 0.05), "{depths:?}");
    }
}
