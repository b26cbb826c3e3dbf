//! How deep a contact may lie: half the distance from a point, along its inward normal, to where the ray leaves the
//! point's own body, in the accepted state. A face of second degree counts as the triangles between its nodes.

use super::point::Triad;
use super::surface::{Surface, SurfacePoint};
use crate::contact::capture::{Crossing, end_of_body, positions};
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::Vec3;
use crate::tool::space::{Facet, Triangle};
use crate::tool::{Bounds, Ray, Tree};

/// The boundary of a body, and a tree around it before any motion.
pub struct Boundary {
    /// Nodes of the triangles, and the side that each belongs to.
    triangles: Vec<(Side, [usize; 3])>,
    /// The connected whole of each cell.
    wholes: Vec<usize>,
    tree: Tree,
}

/// The boundary in an accepted state.
struct Standing<'a> {
    boundary: &'a Boundary,
    triangles: Vec<Triangle>,
    tree: Tree,
}

/// Triangles between the nodes of a face, by its number of nodes.
fn triangles(nodes: usize) -> &'static [[usize; 3]] {
    match nodes {
        3 => &[[0, 1, 2]],
        4 => &[[0, 1, 2], [0, 2, 3]],
        6 => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
        8 => &[[0, 4, 7], [4, 1, 5], [5, 2, 6], [6, 3, 7], [4, 5, 6], [4, 6, 7]],
        9 => &[[0, 4, 8], [4, 1, 8], [1, 5, 8], [5, 2, 8], [2, 6, 8], [6, 3, 8], [3, 7, 8], [7, 0, 8]],
        _ => &[],
    }
}

/// Margin of the boxes, as a part of the boundary's size.
const MARGIN: f64 = 1e-9;

impl Boundary {
    /// The given sides.
    pub fn new(mesh: &Mesh, sides: &[Side]) -> Self {
        let mut all = Vec::new();
        for &side in sides {
            let nodes: Vec<usize> = mesh.side(side).1.collect();
            all.extend(triangles(nodes.len()).iter().map(|corners| (side, corners.map(|k| nodes[k]))));
        }
        let still = all.iter().map(|(_, nodes)| Triangle(nodes.map(|node| mesh.points[node])).bounds());
        Self { tree: Tree::new(&still.collect::<Vec<_>>(), 0.0), triangles: all, wholes: mesh.wholes() }
    }

    /// The same at displacements `u`.
    fn stand(&self, (mesh, dofs): (&Mesh, &Dofs), u: &[f64]) -> Standing<'_> {
        let at = |nodes: &[usize; 3]| {
            let mut x = positions(mesh, dofs, nodes, u);
            Triangle([(); 3].map(|()| x.next().unwrap_or(Vec3::zero())))
        };
        let triangles: Vec<Triangle> = self.triangles.iter().map(|(_, nodes)| at(nodes)).collect();
        let boxes: Vec<Bounds> = triangles.iter().map(Facet::bounds).collect();
        let size = boxes.iter().fold(Bounds::EMPTY, |sum, &b| sum.union(b)).size();
        Standing { boundary: self, tree: self.tree.refit(&boxes, MARGIN * size), triangles }
    }
}

impl Standing<'_> {
    /// Distance along a ray from a point on the side `own` to where its body ends. A point of a curved side lies off its
    /// triangles, so that these are left out; `least` is a distance within rounding of a corner.
    fn depth(&self, ray: &Ray, own: Side, least: f64) -> f64 {
        let (mut crossings, wholes) = (Vec::new(), &self.boundary.wholes);
        self.tree.along(ray, [least, f64::INFINITY], &mut |i| {
            let side = self.boundary.triangles[i].0;
            if side != own && wholes[side.cell] == wholes[own.cell] {
                self.triangles[i].cast(ray, &mut |place| {
                    if place.u > least {
                        let leaves = ray.direction.dot(self.triangles[i].normal(place.s)) > 0.0;
                        crossings.push(Crossing { u: place.u, leaves });
                    }
                });
            }
        });
        end_of_body(crossings)
    }
}

/// Position and tangents of a point of the surface at displacements `u`.
fn locate(surface: &Surface, point: &SurfacePoint, (mesh, dofs): (&Mesh, &Dofs), u: &[f64]) -> (Vec3, [Vec3; 2]) {
    let face = &surface.faces[point.face];
    point.place(&face.placed((mesh, dofs), u)[..face.nodes.len()])
}

/// The largest admissible penetration at each point of a surface; infinite where the ray never leaves the body.
pub fn depths(surface: &Surface, mesh: &Mesh, dofs: &Dofs, boundary: &Boundary, u: &[f64]) -> Vec<f64> {
    let standing = boundary.stand((mesh, dofs), u);
    let at = |point: &SurfacePoint| {
        let (origin, tangents) = locate(surface, point, (mesh, dofs), u);
        let triad = Triad::new(tangents);
        let ray = Ray { origin, direction: triad.inward };
        0.5 * standing.depth(&ray, surface.faces[point.face].side, 1e-3 * triad.area.sqrt())
    };
    surface.points.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cells::ALL;
    use crate::mesh::generate::Block;

    #[test]
    fn the_middle_of_a_block_is_half_its_depth_away_for_every_cell() {
        for &cell in ALL.iter().filter(|cell| cell.dimension == 3) {
            let mesh = Block::new([0.0; 3], [3.0, 2.0, 4.0], [2, 2, 2], cell).mesh("b").unwrap();
            let dofs = Dofs::new(3, mesh.points.len(), 0);
            let surface = Surface::new(&mesh, &mesh.groups["b.top"].sides, None);
            let sides = mesh.boundary(&(0..mesh.cell_count()).collect::<Vec<_>>());
            let boundary = Boundary::new(&mesh, &sides);
            let depths = depths(&surface, &mesh, &dofs, &boundary, &vec![0.0; dofs.count()]);
            assert!(!depths.is_empty(), "{}", cell.name);
            let high = mesh.bounds();
            let least = (0..3).map(|i| 0.5 * (high[1][i] - high[0][i])).collect::<Vec<_>>();
            let good = |depth: &f64| least.iter().any(|half| (depth - half).abs() < 1e-12);
            assert!(depths.iter().all(good), "{}: {depths:?}", cell.name);
        }
    }
}
