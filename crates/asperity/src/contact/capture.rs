//! How deep a contact may lie: half the distance from a point, along its inward normal, to where the ray leaves the
//! point's own body. Derived from the accepted state, so that no depth has to be given.

use super::point::triad;
use super::surface::Surface;
use crate::mesh::{Mesh, Side};
use crate::system::Dofs;
use crate::tensor::Vec3;
use crate::{Failure, Kind};
use std::f64::consts::FRAC_PI_2;

/// Chords of the boundary in the accepted state, each with the connected whole behind it.
pub struct Boundary {
    chords: Vec<(Side, usize, [Vec3; 2])>,
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
    pub fn new((mesh, wholes): (&Mesh, &[usize]), dofs: &Dofs, sides: &[Side], u: &[f64]) -> Self {
        let mut chords = Vec::new();
        for &side in sides {
            let (nodes, whole): (Vec<usize>, _) = (mesh.side(side).1.collect(), wholes[side.cell]);
            let x: Vec<Vec3> = positions(mesh, dofs, &nodes, u).collect();
            match x.as_slice() {
                [a, b] => chords.push((side, whole, [*a, *b])),
                [a, b, middle] => chords.extend([[*a, *middle], [*middle, *b]].map(|chord| (side, whole, chord))),
                _ => {}
            }
        }
        Self { chords }
    }

    /// Distance along `direction` from `origin`, which lies on the side `own` of a whole, to where that ends. A point of a
    /// curved side lies off its chords, so that these are left out; `least` is a distance within rounding of a corner.
    fn depth(&self, (origin, direction): (Vec3, Vec3), (own, whole): (Side, usize), least: f64) -> f64 {
        let mut crossings = Vec::new();
        for (_, _, [a, b]) in self.chords.iter().filter(|(side, behind, _)| *side != own && *behind == whole) {
            let (d, to) = (*b - *a, *a - origin);
            let cross = |v: Vec3, w: Vec3| v[0] * w[1] - v[1] * w[0];
            let span = cross(direction, d);
            let (u, s) = (cross(to, d) / span, cross(to, direction) / span);
            if u > least && (-1e-9..=1.0 + 1e-9).contains(&s) {
                // The solid lies on the left of its chords.
                crossings.push(Crossing { u, leaves: span > 0.0 });
            }
        }
        end_of_body(crossings)
    }
}

/// Where a ray crosses the boundary of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Distance along the ray.
    pub u: f64,
    /// Whether it leaves the body there, or enters it.
    pub leaves: bool,
}

/// Crossings of one kind that are no farther apart than this part of their distance are one: a ray through a common node.
const TOGETHER: f64 = 1e-9;

/// Where a ray that begins on a body's boundary and goes inward leaves the body. Where the body penetrates itself the ray
/// begins inside it twice, and the first face that it leaves by is that of the other part: the end is where it is inside
/// nothing.
pub fn end_of_body(mut crossings: Vec<Crossing>) -> f64 {
    crossings.sort_unstable_by(|a, b| a.u.total_cmp(&b.u));
    crossings.dedup_by(|b, a| a.leaves == b.leaves && b.u - a.u <= TOGETHER * b.u);
    let way = |crossing: &Crossing| if crossing.leaves { -1 } else { 1 };
    let mut inside = 1.max(-crossings.iter().map(way).sum::<i32>());
    let end = crossings.iter().find(|crossing| {
        inside += way(crossing);
        inside <= 0
    });
    end.map_or(f64::INFINITY, |crossing| crossing.u)
}

/// The largest admissible penetration at each point of a surface; infinite where the ray never leaves the body.
pub fn depths(
    surface: &Surface,
    (mesh, wholes): (&Mesh, &[usize]),
    dofs: &Dofs,
    boundary: &[Side],
    u: &[f64],
) -> Vec<f64> {
    let boundary = Boundary::new((mesh, wholes), dofs, boundary, u);
    let at = |point: &super::surface::SurfacePoint| {
        let x: Vec<Vec3> = positions(mesh, dofs, surface.nodes(point), u).collect();
        let (a, tangent) = point.place(&x);
        let (_, inward, length) = triad(tangent);
        let own = surface.edges[point.edge].side;
        0.5 * boundary.depth((a, inward), (own, wholes[own.cell]), 1e-3 * length)
    };
    surface.points.iter().map(at).collect()
}

/// Refuses a point that nothing was seen from before and that now lies deep: it has jumped over the target's face.
/// `depth` is its largest admissible penetration.
pub fn refuse_jump(penetration: f64, depth: f64, name: impl FnOnce() -> String) -> Result<(), Failure> {
    if penetration > 0.25 * depth {
        let reason = format!("{} came to lie {penetration:.3e} deep in one increment", name());
        return Err(Failure::new(reason).of(Kind::Passage));
    }
    Ok(())
}

/// Refuses a touching tool that turned by more than a quarter of a turn, in radians: the slip is a chord, and half a turn
/// brings what was touched to the other side, where none is seen.
pub fn refuse_turn(turned: f64, name: impl FnOnce() -> String) -> Result<(), Failure> {
    if turned.abs() > FRAC_PI_2 {
        let degrees = turned.abs().to_degrees();
        let reason = format!("{}: its tool turned by {degrees:.0} degrees in one increment", name());
        return Err(Failure::new(reason).of(Kind::Turn));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Cell, generate::Annulus};

    #[test]
    fn a_body_that_penetrates_itself_does_not_end_at_its_other_part() {
        let at = |list: &[f64]| end_of_body(list.iter().map(|&u| Crossing { u: u.abs(), leaves: u > 0.0 }).collect());
        assert_eq!(at(&[2.0]), 2.0);
        // Out of the other part, then out of its own.
        assert_eq!(at(&[2.0, 0.1]), 2.0);
        // Through a ring, whose far wall is met in a node.
        assert_eq!(at(&[1.0, -7.0, 8.0, 8.0 + 1e-13]), 1.0);
        assert_eq!(at(&[0.1, 1.0, -7.0, 8.0]), 1.0);
        assert_eq!(at(&[]), f64::INFINITY);
        // Beyond a gap that was missed.
        assert_eq!(at(&[1.0, -3.0]), 1.0);
    }

    /// A point of a coarse curved edge lies well outside its chords: they are not what is behind it.
    #[test]
    fn the_body_behind_a_curved_edge_is_not_the_edge_itself() {
        let ring = Annulus::new([0.0, 0.0], [2.0, 10.0], [0.0, 360.0], [4, 16], Cell::named("quad8").unwrap());
        let mesh = ring.mesh("ring").unwrap();
        let dofs = Dofs::new(2, mesh.points.len(), 0);
        let surface = Surface::new(&mesh, &mesh.groups["ring.outer"].sides, None);
        let boundary = mesh.boundary(&(0..mesh.cell_count()).collect::<Vec<_>>());
        let depths = depths(&surface, (&mesh, &mesh.wholes()), &dofs, &boundary, &vec![0.0; dofs.count()]);
        assert_eq!(depths.len(), 32);
        assert!(depths.iter().all(|depth| (depth - 4.0).abs() < 0.05), "{depths:?}");
    }
}
