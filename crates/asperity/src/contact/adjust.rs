//! Moving the nodes of a surface out of its target before the first increment, without strain.
//!
//! A node is moved along the mean normal of the contact points around it to where that ray leaves the target. Between the
//! nodes a curved target may still be penetrated by what the edges do not follow.

use super::pair::Contact;
use super::point::triad;
use super::space;
use super::target::{Cast, Memory};
use crate::tensor::Vec3;
use crate::tool::Ray;
use std::collections::BTreeMap;

/// A node that is to be moved, by how much, and the cell behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    /// The node.
    pub node: usize,
    /// The way.
    pub by: Vec3,
    /// A cell behind it.
    pub cell: usize,
}

/// Sum of normals at each node, and a point beside it.
type Normals = BTreeMap<usize, (Vec3, usize)>;

fn gather<'a>(points: impl Iterator<Item = (&'a [usize], Vec3)>) -> Normals {
    let mut normals = Normals::new();
    for (i, (nodes, inward)) in points.enumerate() {
        nodes.iter().for_each(|&node| normals.entry(node).or_insert((Vec3::zero(), i)).0 += inward);
    }
    normals
}

impl Contact {
    /// What takes the nodes of the undeformed surface out of the target.
    pub fn moves(&self) -> Vec<Move> {
        let still = vec![0.0; self.dofs.count()];
        let points = &self.surface.points;
        let inward = |i: usize| triad(self.locate(&points[i], &still).1).1;
        let normals = gather((0..points.len()).map(|i| (self.surface.nodes(&points[i]), inward(i))));
        let depths = self.depths(&still);
        let (standing, mut memory) = (self.target.stand(&still), Memory::default());
        let moved = normals.into_iter().filter_map(|(node, (sum, i))| {
            let ray = Ray { origin: self.mesh.points[node], direction: sum.unit() };
            let hit = standing.cast(&Cast { ray, ..self.bounds(i, depths[i], f64::INFINITY) }, &mut memory)?;
            let cell = self.surface.edges[points[i].edge].side.cell;
            (hit.u > self.least).then(|| Move { node, by: ray.direction * hit.u, cell })
        });
        moved.collect()
    }
}

impl space::Contact {
    /// What takes the nodes of the undeformed surface out of the target.
    pub fn moves(&self) -> Vec<Move> {
        let (points, rays) = (&self.surface().points, self.rays());
        let normals = gather(points.iter().zip(&rays).map(|(point, ray)| (self.surface().nodes(point), ray.direction)));
        let ray = |node: usize, sum: Vec3| Ray { origin: self.mesh().points[node], direction: sum.unit() };
        let rays: Vec<_> = normals.iter().map(|(&node, &(sum, i))| (ray(node, sum), i)).collect();
        let moved = normals.keys().zip(&rays).zip(self.penetrations(&rays)).filter_map(|((&node, (ray, i)), u)| {
            let (u, cell) = (u?, self.surface().faces[points[*i].face].side.cell);
            (u > self.least).then(|| Move { node, by: ray.direction * u, cell })
        });
        moved.collect()
    }
}
