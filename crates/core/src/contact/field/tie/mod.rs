//! Two surfaces glued where they are, by the mortar method with dual multipliers.
//!
//! That the surface follows the target holds as a weighted mean around each of its nodes,
//! ```text
//! int psi_i (u_surface - u_target) dA = 0    D_ii u~_i = sum_j M_ij u_j,   D_ii = int N~_i dA,   M_ij = int psi_i N_j dA
//! ```
//! with functions `psi_i` that are biorthogonal to those of the nodes, `int psi_i N~_k dA = D_ii delta_ik` (Wohlmuth, SIAM J.
//! Numer. Anal. 38, 2000), so that each node follows a few nodes of the target and nothing has to be solved. Both integrals
//! are sums over the same points on the overlap of the meshes: any linear motion is followed to rounding, and since the
//! `psi_i` of a face have the sum one, a uniform stress passes through.
//!
//! On faces of second degree some corners have functions of mean zero. There the functions of the corners take a part
//! `alpha` of those of the nodes between them, `N~_c = N_c + alpha sum N_m` and `N~_m = (1 - 2 alpha) N_m` (Popp, Wohlmuth, Gee
//! & Wall, SIAM J. Sci. Comput. 34, 2012), hence `u_m = (1 - 2 alpha) u~_m + alpha (u_a + u_b)`.

mod dual;
mod places;

use self::dual::{DualBasis, basis};
use self::places::{TieCover, TiePlaces};
use super::faces::TargetFaces;
use super::surface::FieldSurface;
use crate::mesh::{Mesh, Side, Space};
use crate::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// Default of the largest gap, as a part of the mean size of the faces.
const TOLERANCE: f64 = 0.05;
/// Mean size of the faces of the surface over that of its target's from which on the target follows.
const COARSER: f64 = 1.5;
/// A node of whose functions less than this part has something opposite does not follow it.
const COVERED: f64 = 0.2;
/// Factors below this part of that of the node itself are rounding.
const ROUNDING: f64 = 1e-13;

/// What is glued to what.
#[derive(Debug, Clone, Copy)]
pub struct TieParts<'m> {
    /// The mesh, before any motion.
    pub mesh: &'m Mesh,
    /// What its coordinates mean.
    pub space: Space,
    /// Sides whose nodes follow.
    pub surface: &'m [Side],
    /// Sides that they follow.
    pub target: &'m [Side],
    /// The largest gap across which they do, a length; found from the faces where none is given.
    pub tolerance: Option<f64>,
}

/// A weighted mean that is zero, the same for each component of the displacements.
#[derive(Debug, Clone, PartialEq)]
pub struct MeanCondition {
    /// The node that follows.
    pub node: usize,
    /// Nodes and factors, the node itself first. Their sum is zero.
    pub terms: Vec<(usize, f64)>,
    /// Other nodes of the faces around it.
    pub neighbours: Vec<usize>,
    /// Whether the node can follow: it has enough of the target opposite, and is no node of the target.
    pub follows: bool,
    /// The nodes at the ends of the edge of second degree in whose middle it lies.
    between: Option<[usize; 2]>,
}

/// Two surfaces glued.
#[derive(Debug, Clone)]
pub struct TiedSurfaces {
    /// One for each node of the surface that has something opposite.
    pub conditions: Vec<MeanCondition>,
    /// Nodes of surface and target.
    pub nodes: [Vec<usize>; 2],
    /// The largest gap across which something follows, a length.
    pub tolerance: f64,
    /// The largest gap that there is within it.
    pub gap: f64,
    /// The part of the surface's area that has nothing opposite,
    pub bare: f64,
    /// the node around which that is most, and the part of the node's function.
    pub barest: (usize, f64),
    /// Mean size of the faces of the surface over that of its target's.
    pub coarser: f64,
}

/// Why surfaces cannot be glued.
#[derive(Debug, Clone, PartialEq)]
pub enum Apart {
    /// A face of the surface lies beyond the tolerance: the distance, where, and the tolerance.
    Far(f64, Vec3, f64),
    /// Nothing lies opposite: the least distance between nodes, where, and the tolerance.
    Nothing(f64, Vec3, f64),
}

impl TiedSurfaces {
    /// Glues a surface to a target.
    ///
    /// # Errors
    /// [`Apart`] where they are not together.
    pub fn new(parts: &TieParts) -> Result<Self, Apart> {
        let (mesh, surface) = (parts.mesh, FieldSurface::whole(parts.mesh, parts.surface, parts.space, 1.0));
        let target = TargetFaces::new(FieldSurface::whole(mesh, parts.target, parts.space, 1.0), mesh);
        let sizes = [&surface, &target.surface].map(|surface| surface.coarseness(mesh));
        let facets = sizes.iter().map(|[size, part]| size * part).sum::<f64>();
        let tolerance = parts.tolerance.unwrap_or(TOLERANCE * sizes[0][0].max(sizes[1][0]) + facets);
        let places = TiePlaces::new(mesh, &surface, &target, tolerance);
        let [own, others] = [&surface, &target.surface].map(nodes);
        let (mut rows, mut gap, mut far) = (TieRows::default(), 0.0_f64, Vec::new());
        for face in 0..surface.faces.len() {
            let TieCover { places, beyond } = places.of(face);
            far.extend(beyond);
            gap = places.iter().map(|place| place.gap.abs()).fold(gap, f64::max);
            let dual = DualBasis::new(surface.faces[face].kind, &places);
            rows.add((&surface, face), &target.surface, &dual, &places);
        }
        rows.whole(mesh, &surface);
        if let Some((distance, at)) = far.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)) {
            return Err(Apart::Far(distance, at, tolerance));
        }
        let (bare, barest) = rows.bare();
        let conditions = rows.conditions(&others.iter().copied().collect());
        if !conditions.iter().any(|condition| condition.follows) {
            let (distance, at) = nearest(mesh, &own, &others);
            return Err(Apart::Nothing(distance, at, tolerance));
        }
        let coarser = sizes[0][0] / sizes[1][0];
        Ok(Self { conditions, nodes: [own, others], tolerance, gap, bare, barest, coarser })
    }

    /// Glues two surfaces so that the finer one follows, and says whether that is the target: conditions as many as a coarse surface has
    /// nodes leave a fine one between them free. The surface follows where the meshes are about as fine, or some of the target would have
    /// more than the part `bare` of a function without anything opposite.
    ///
    /// # Errors
    /// [`Apart`] where they are not together.
    pub fn finer_follows(parts: &TieParts, bare: f64) -> Result<(Self, bool), Apart> {
        let given = Self::new(parts)?;
        if given.coarser >= COARSER {
            let swapped = TieParts { surface: parts.target, target: parts.surface, ..*parts };
            if let Some(other) = Self::new(&swapped).ok().filter(|other| other.barest.1 < bare) {
                return Ok((other, true));
            }
        }
        Ok((given, false))
    }

    /// Where the nodes that follow must lie so that turning both surfaces as one keeps them together: where the target's
    /// means are.
    pub fn fitted(&self, points: &[Vec3]) -> Vec<(usize, Vec3)> {
        let mut fitted: BTreeMap<usize, Vec3> = BTreeMap::new();
        // Corners first, since what lies between them depends on them.
        for between in [false, true] {
            let all = self.conditions.iter().filter(|c| c.follows && c.between.is_some() == between);
            for MeanCondition { node, terms, .. } in all {
                let place = |other: usize| fitted.get(&other).copied().unwrap_or(points[other]);
                let Some(((_, own), rest)) = terms.split_first() else { continue };
                let sum = rest.iter().fold(Vec3::zero(), |sum, &(other, c)| sum + place(other) * c);
                fitted.insert(*node, sum * -own.recip());
            }
        }
        fitted.into_iter().collect()
    }
}

/// The nodes of a surface.
fn nodes(surface: &FieldSurface) -> Vec<usize> {
    let all: BTreeSet<usize> = surface.faces.iter().flat_map(|face| face.nodes.iter().copied()).collect();
    all.into_iter().collect()
}

/// The least distance between nodes of two surfaces, and where.
fn nearest(mesh: &Mesh, own: &[usize], others: &[usize]) -> (f64, Vec3) {
    let pairs = own.iter().flat_map(|&a| others.iter().map(move |&b| (a, b)));
    let distance = |(a, b): (usize, usize)| ((mesh.points[a] - mesh.points[b]).norm(), mesh.points[a]);
    pairs.map(distance).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, Vec3::zero()))
}

/// What is summed up for a node of the surface.
#[derive(Debug, Default)]
struct TieRow {
    /// Integral of its function where something lies opposite, and everywhere.
    covered: f64,
    whole: f64,
    /// Those of its dual function with the functions of the target.
    others: BTreeMap<usize, f64>,
    neighbours: BTreeSet<usize>,
    /// The corners between which it lies on an edge of second degree, and the part of them in its function.
    between: Option<([usize; 2], f64)>,
}

/// Sums by the nodes of the surface.
#[derive(Debug, Default)]
struct TieRows(BTreeMap<usize, TieRow>);

impl TieRows {
    /// Adds what a face has opposite.
    fn add(
        &mut self,
        (surface, f): (&FieldSurface, usize),
        target: &FieldSurface,
        dual: &DualBasis,
        places: &[places::TiePlace],
    ) {
        let nodes = &surface.faces[f].nodes;
        for (k, &node) in nodes.iter().enumerate() {
            let row = self.0.entry(node).or_default();
            row.neighbours.extend(nodes.iter().filter(|&&other| other != node));
            row.between = dual.basis.between(k).map(|[a, b]| ([nodes[a], nodes[b]], dual.basis.alpha));
            row.covered += dual.weights.get(k).copied().unwrap_or(0.0);
        }
        for place in places {
            let psi = dual.values(&place.shape.n[..nodes.len()]);
            let others = &target.faces[place.target].nodes;
            for (&node, psi) in nodes.iter().zip(psi) {
                let row = self.0.entry(node).or_default();
                for (j, &other) in others.iter().enumerate() {
                    *row.others.entry(other).or_default() += place.area * psi * place.seen.n[j];
                }
            }
        }
    }

    /// Adds up the functions of the nodes over all of the surface.
    fn whole(&mut self, mesh: &Mesh, surface: &FieldSurface) {
        for face in &surface.faces {
            let basis = basis(face.kind);
            for (area, shape) in places::everywhere(mesh, surface, face) {
                let values = basis.values(&shape.n[..face.nodes.len()]);
                for (node, value) in face.nodes.iter().zip(values) {
                    self.0.entry(*node).or_default().whole += area * value;
                }
            }
        }
    }

    /// The part of the area that has nothing opposite, and the node around which that is most with the part of its function.
    fn bare(&self) -> (f64, (usize, f64)) {
        let sum = |of: fn(&TieRow) -> f64| self.0.values().map(of).sum::<f64>();
        let parts = self.0.iter().map(|(&node, row)| (node, 1.0 - row.covered / row.whole));
        let barest = parts.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
        (1.0 - sum(|row| row.covered) / sum(|row| row.whole), barest)
    }

    fn conditions(self, target: &BTreeSet<usize>) -> Vec<MeanCondition> {
        let condition = |(node, row): (usize, TieRow)| {
            let (own, mut terms) = (row.covered, Vec::new());
            match row.between {
                Some(([a, b], alpha)) => {
                    let part = own / (1.0 - 2.0 * alpha);
                    terms.extend([(node, part), (a, -alpha * part), (b, -alpha * part)]);
                }
                None => terms.push((node, own)),
            }
            let counts = |(_, m): &(usize, f64)| m.abs() > ROUNDING * own.abs();
            terms.extend(row.others.into_iter().filter(counts).map(|(other, m)| (other, -m)));
            let follows = own > COVERED * row.whole && !target.contains(&node);
            let neighbours = row.neighbours.into_iter().collect();
            MeanCondition { node, terms, neighbours, follows, between: row.between.map(|(ends, _)| ends) }
        };
        self.0.into_iter().filter(|(_, row)| row.covered != 0.0).map(condition).collect()
    }
}
