//! The surface that carries the field: its faces, and the nodes of the field with their averaged normals.
//!
//! A node of the field is a corner of the mesh together with the faces around it that meet without a crease: where they do,
//! the corner belongs to several nodes, one for each smooth piece. Each node has the mean of the area vectors of its
//! faces, `m = sum_f g1 x g2`, `n = m / |m|`, outward (Yang, Laursen & Meng 2005).

use super::face::{CORNERS, FieldFace, MOST, PlacedFace, ShapeFunctions};
use crate::mesh::{CREASE, Mesh, Side, Space};
use crate::tensor::{DisjointSets, Vec3, invert};
use std::collections::{BTreeMap, BTreeSet};

/// Factors of the functions of the corners of a face that make another set of them.
pub type DualFactors = [[f64; CORNERS]; CORNERS];

/// A face so thin has no such set.
const SINGULAR: f64 = 1e-12;

/// A node of the field.
#[derive(Debug, Clone)]
pub struct FieldNode {
    /// The node of the mesh.
    pub node: usize,
    /// The faces around it, each with the number of the corner that the node is.
    pub support: Vec<(usize, usize)>,
    /// Whether the surface ends here, in space, so that the node bears as a vertex where it lies deep in another body: not all edges of its
    /// faces that meet at the node have one on either side. Of faces of second degree at corners of the body alone, not between the ends of
    /// an edge. Where it goes on round a crease it does not end: a vertex of a side that slides along another body
    /// would look past that.
    pub is_vertex: bool,
    /// Normals of planes of symmetry in which the smooth surface ends here, and its normal therefore lies, at right angles to each other; zero without one. So of the
    /// axis of revolution where it goes through that without a crease.
    pub(super) mirrors: [Vec3; 2],
}

/// Nodes that conditions hold together, and the normal of the plane in which they stay, if they do.
#[derive(Debug, Clone)]
pub struct HeldNodes {
    /// The nodes.
    pub nodes: BTreeSet<usize>,
    /// The normal.
    pub normal: Option<Vec3>,
}

/// What of a vector lies in planes with these normals, at right angles to each other.
pub(super) fn mirrored(v: Vec3, mirrors: &[Vec3; 2]) -> Vec3 {
    mirrors.iter().fold(v, |v, m| v - *m * v.dot(*m))
}

/// Faces that meet at a larger angle form a crease in the plane where at their other ends they turn by less than this part of it: what goes round
/// in chords turns at each.
const KINK: f64 = 0.1;
pub(super) const ALONE: f64 = 0.1;

/// The sum of area vectors at a node of the field.
#[derive(Debug, Clone, Copy)]
pub struct NodalNormal {
    /// Outward unit normal.
    pub unit: Vec3,
    /// Length of the sum.
    length: f64,
    mirrors: [Vec3; 2],
}

impl NodalNormal {
    /// Derivative of the unit normal for a derivative `dm` of the sum.
    pub fn turned(&self, dm: Vec3) -> Vec3 {
        let dm = mirrored(dm, &self.mirrors);
        (dm - self.unit * self.unit.dot(dm)) * self.length.recip()
    }
}

/// Faces and nodes of the field.
#[derive(Debug, Clone, Default)]
pub struct FieldSurface {
    /// The faces.
    pub faces: Vec<FieldFace>,
    /// The nodes of the field.
    pub nodes: Vec<FieldNode>,
    /// For each face the nodes of the field at its corners.
    pub field: Vec<[usize; CORNERS]>,
    /// For each face the smooth piece it belongs to, counted from zero.
    pub pieces: Vec<usize>,
    /// For each face whether a crease of the surface bounds it, of an edge in both its halves,
    pub creased: Vec<bool>,
    /// whether the surface ends there, likewise,
    pub ending: Vec<bool>,
    /// and whether it turns smoothly at one of its corners.
    pub curved: Vec<bool>,
    /// The largest angle of each face to those beside it of its smooth piece before any motion.
    pub bends: Vec<f64>,
    /// For each face of any of these what makes the functions of its corners biorthogonal to these.
    pub duals: Vec<Option<DualFactors>>,
    /// Whether faces are edges of a plane model.
    pub plane: bool,
    /// Whether the model is axisymmetric.
    pub revolves: bool,
    pub(super) thickness: f64,
    /// What conditions hold.
    pub(super) held: Vec<HeldNodes>,
}

impl FieldSurface {
    /// The faces `sides` of a mesh in a space; `thickness` counts in the plane cases.
    pub fn new(mesh: &Mesh, sides: &[Side], space: Space, thickness: f64) -> Self {
        Self::held(mesh, sides, (space, thickness), &[])
    }

    /// The same where groups of nodes are `held` by conditions: an end of the surface in one of these, as on a plane of symmetry, is no edge
    /// of a body, and where what is round ends in a plane its normal lies in that.
    pub fn held(mesh: &Mesh, sides: &[Side], (space, thickness): (Space, f64), held: &[HeldNodes]) -> Self {
        let faces = sides.iter().flat_map(|&side| FieldFace::new(mesh, side).pieces());
        Self::of(mesh, faces.collect(), (space, thickness), held)
    }

    /// The same with sides of second degree in one piece, as a target has them.
    pub fn whole(mesh: &Mesh, sides: &[Side], space: Space, thickness: f64) -> Self {
        let faces = sides.iter().map(|&side| FieldFace::new(mesh, side)).collect();
        Self::of(mesh, faces, (space, thickness), &[])
    }

    fn of(mesh: &Mesh, faces: Vec<FieldFace>, (space, thickness): (Space, f64), held: &[HeldNodes]) -> Self {
        let (plane, revolves) = (space != Space::Solid, space == Space::Axisymmetric);
        let thickness = if plane && !revolves { thickness } else { 1.0 };
        let mut surface = Self { faces, plane, revolves, thickness, ..Self::default() };
        surface.number(mesh, held);
        surface.held = held.to_vec();
        surface
    }

    /// The faces around each node of the mesh at their corners, each with the number of the corner there.
    fn around(&self) -> BTreeMap<usize, Vec<(usize, usize)>> {
        let mut around: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (f, face) in self.faces.iter().enumerate() {
            (0..face.corners()).for_each(|c| around.entry(face.corner_node(c)).or_default().push((f, c)));
        }
        around
    }

    /// Finds the smooth pieces and numbers the nodes of the field.
    pub(super) fn number(&mut self, mesh: &Mesh, held: &[HeldNodes]) {
        let is_held = |nodes: &[usize]| held.iter().any(|held| nodes.iter().all(|node| held.nodes.contains(node)));
        let axis = 1e-9 * mesh.size();
        let around = self.around();
        let normals: Vec<Vec3> = self.faces.iter().map(|face| self.middle_normal(face, &face.at_rest(mesh))).collect();
        let angle = |f: usize, g: usize| normals[f].dot(normals[g]).clamp(-1.0, 1.0).acos();
        // In the plane the largest angle at the other ends of two faces.
        let beside = |f: usize, g: usize| {
            let ends = [f, g].into_iter().flat_map(|face| (0..2).map(move |c| (face, c)));
            let others = ends
                .flat_map(|(face, c)| around[&self.faces[face].corner_node(c)].iter().map(move |&(h, _)| (face, h)));
            let turns = others.filter(|&(face, h)| h != f && h != g && h != face).map(|(face, h)| angle(face, h));
            turns.filter(|turn| *turn < CREASE).fold(0.0, f64::max)
        };
        let smooth = |f: usize, g: usize| {
            let turn = angle(f, g);
            let bent = turn < CREASE && !(self.plane && turn > KINK && beside(f, g) < ALONE * turn);
            bent && shared(&self.faces[f], &self.faces[g]) >= if self.plane { 1 } else { 2 }
        };
        let (mut pieces, mut field) =
            (DisjointSets::new(self.faces.len()), vec![[usize::MAX; CORNERS]; self.faces.len()]);
        let (mut nodes, mut curved) = (Vec::new(), vec![false; self.faces.len()]);
        let (mut creased, mut ending) = (BTreeSet::new(), BTreeSet::new());
        for (&node, corners) in &around {
            let mut sets = DisjointSets::new(corners.len());
            for i in 0..corners.len() {
                for j in 0..i {
                    if smooth(corners[i].0, corners[j].0) {
                        sets.join(i, j);
                        let pair = [corners[i].0, corners[j].0];
                        if normals[pair[0]].cross(normals[pair[1]]).norm() > CURVED {
                            pair.into_iter().for_each(|face| curved[face] = true);
                        }
                        pieces.join(corners[i].0, corners[j].0);
                    }
                }
            }
            let roots: Vec<usize> = (0..corners.len()).filter(|&i| sets.root(i) == i).collect();
            let sides = || corners.iter().map(|&(f, _)| self.faces[f].side);
            let axial = self.revolves && mesh.points[node][0].abs() <= axis;
            // The axis of revolution is no edge either.
            let ends = || match self.plane {
                true => corners.len() == 1 && !is_held(&[node]) && !axial,
                false => self.borders(corners).any(|end| !is_held(&[node, end])),
            };
            if roots.len() > 1 {
                creased.extend(sides());
            } else if ends() {
                ending.extend(sides());
            }
            for &root in &roots {
                let members = (0..corners.len()).filter(|&i| sets.root(i) == root);
                let support: Vec<(usize, usize)> = members.map(|i| corners[i]).collect();
                support.iter().for_each(|&(f, c)| field[f][c] = nodes.len());
                let on_axis = axial && support.iter().all(|&(f, _)| normals[f][1].abs() > CREASE.cos());
                let is_vertex = roots.len() == 1 && self.is_vertex(&support, mesh);
                let mirrors = [if on_axis { Vec3::axis(0) } else { Vec3::zero() }, Vec3::zero()];
                nodes.push(FieldNode { node, support, is_vertex, mirrors });
            }
        }
        let of = |sides: BTreeSet<Side>| self.faces.iter().map(|face| sides.contains(&face.side)).collect();
        (self.creased, self.ending) = (of(creased), of(ending));
        let mut edges: BTreeMap<[usize; 2], Vec<(usize, usize)>> = BTreeMap::new();
        for (f, face) in self.faces.iter().enumerate().filter(|(_, face)| face.corners() == CORNERS) {
            for k in 0..CORNERS {
                let mut ends = [k, (k + 1) % CORNERS].map(|corner| face.corner_node(corner));
                ends.sort_unstable();
                edges.entry(ends).or_default().push((f, k));
            }
        }
        // Of a quadrilateral those along its first and its second coordinate that an edge of the body bounds.
        let mut across = vec![[false; 2]; self.faces.len()];
        let bounds = |(ends, around): &(&[usize; 2], &Vec<(usize, usize)>)| {
            let inner = matches!(around[..], [(f, _), (g, _)] if smooth(f, g));
            !(inner || around.len() == 1 && is_held(&ends[..]))
        };
        for (_, around) in edges.iter().filter(bounds) {
            around.iter().for_each(|&(f, k)| across[f][(k + 1) % 2] = true);
        }
        let dual = |f: usize| {
            let corners = match across[f] {
                [true, false] => [0, 0, 1, 1],
                [false, true] => [0, 1, 1, 0],
                _ => [0; CORNERS],
            };
            (self.creased[f] || self.ending[f] || curved[f]).then(|| self.dual(f, corners, mesh))?
        };
        self.duals = (0..self.faces.len()).map(dual).collect();
        let bend = |f: usize| {
            let around = field[f][..self.faces[f].corners()].iter().flat_map(|&node: &usize| &nodes[node].support);
            around.map(|&(g, _)| normals[f].dot(normals[g]).clamp(-1.0, 1.0).acos()).fold(0.0, f64::max)
        };
        self.bends = (0..self.faces.len()).map(bend).collect();
        (self.pieces, self.nodes, self.field, self.curved) = (pieces.labels(), nodes, field, curved);
    }

    /// Factors `D M^-1` of the functions of the corners of a face, with `M = int N N^t dA` and `D` its sums (Wohlmuth, SIAM J. Numer.
    /// Anal. 38, 2000), between those `corners` that have the same number: along one coordinate alone where pairs have.
    fn dual(&self, face: usize, corners: [usize; CORNERS], mesh: &Mesh) -> Option<DualFactors> {
        let face = &self.faces[face];
        let (rest, count) = (face.at_rest(mesh), face.corners());
        let (mut mass, mut inverse) = ([[0.0; CORNERS]; CORNERS], [[0.0; CORNERS]; CORNERS]);
        let rule = face.cell().gauss[2]?;
        for (point, weight) in rule.points.iter().zip(rule.weights) {
            let xi = [point[0], point[1]];
            let (n, area) = (face.corner_functions(xi).n, weight * self.density_at(face, &rest, xi));
            for i in 0..count {
                let alike = || (0..count).filter(|&j| corners[i] == corners[j]);
                let together: f64 = alike().map(|j| n[j]).sum();
                alike().for_each(|j| mass[i][j] += area * n[i] * n[j] / together);
            }
        }
        let sums = mass.map(|row| row.iter().sum::<f64>());
        invert(&mut mass[..count], &mut inverse[..count], SINGULAR).then(|| {
            inverse.iter_mut().zip(sums).for_each(|(row, sum)| row.iter_mut().for_each(|entry| *entry *= sum));
            inverse
        })
    }

    /// Functions of the nodes of the field on a face with a `share` of dual ones where those of its corners are these, and what of
    /// them is dual.
    pub fn functions(&self, face: usize, share: f64, corners: &ShapeFunctions) -> [ShapeFunctions; 2] {
        let (mut functions, mut part) = (*corners, ShapeFunctions::constant(0.0));
        if let Some(dual) = self.duals[face].filter(|_| share > 0.0) {
            for (i, row) in dual.iter().enumerate() {
                let of =
                    |value: &dyn Fn(usize) -> f64| -> f64 { row.iter().enumerate().map(|(j, d)| d * value(j)).sum() };
                part.n[i] = share * of(&|j| corners.n[j]);
                functions.n[i] += part.n[i] - share * corners.n[i];
                for a in 0..2 {
                    part.dn[i][a] = share * of(&|j| corners.dn[j][a]);
                    functions.dn[i][a] += part.dn[i][a] - share * corners.dn[i][a];
                }
            }
        }
        [functions, part]
    }

    /// Where edges end that faces in space around a common corner leave open.
    fn borders(&self, around: &[(usize, usize)]) -> impl Iterator<Item = usize> + use<> {
        let mut edges = BTreeMap::new();
        for &(f, corner) in around.iter().filter(|_| !self.plane) {
            let (face, count) = (&self.faces[f], self.faces[f].corners());
            // Along the edges to the corners before and after it.
            [1, count - 1].iter().for_each(|step| {
                *edges.entry(face.corner_node((corner + step) % count)).or_insert(0) += 1;
            });
        }
        edges.into_iter().filter(|(_, count)| *count == 1).map(|(end, _)| end)
    }

    /// Whether faces around a common corner end there with a vertex.
    fn is_vertex(&self, around: &[(usize, usize)], mesh: &Mesh) -> bool {
        let first = around.iter().all(|&(f, _)| self.faces[f].kind.degree == 1);
        self.borders(around).next().is_some() && (first || self.angle(around, mesh) < CORNER)
    }

    /// Angle that faces around a common corner fill, before any motion.
    fn angle(&self, around: &[(usize, usize)], mesh: &Mesh) -> f64 {
        let of = |&(f, corner): &(usize, usize)| {
            let (face, count) = (&self.faces[f], self.faces[f].corners());
            let [here, next, last] =
                [0, 1, count - 1].map(|step| mesh.points[face.corner_node((corner + step) % count)]);
            (next - here).unit().dot((last - here).unit()).clamp(-1.0, 1.0).acos()
        };
        around.iter().map(of).sum()
    }

    /// The nodes of the mesh between which the line runs that tangents at a node of the field follow in space.
    pub fn line(&self, node: usize) -> [usize; 2] {
        let (f, corner) = self.nodes[node].support[0];
        let face = &self.faces[f];
        [corner, (corner + 1) % face.corners()].map(|corner| face.corner_node(corner))
    }

    /// The outward unit normal in the middle of a face in place.
    pub fn middle_normal(&self, face: &FieldFace, placed: &PlacedFace) -> Vec3 {
        let [a, b] = face.shape(face.middle()).tangents(placed.nodes(), self.plane);
        a.cross(b).unit()
    }

    /// The outward area vector at a corner of a face in place.
    pub(super) fn area_vector(&self, face: &FieldFace, placed: &PlacedFace, corner: usize) -> Vec3 {
        let [a, b] = face.shape(face.corner_place(corner)).tangents(placed.nodes(), self.plane);
        a.cross(b)
    }

    /// The normal of a node of the field, with the faces placed by `placed`.
    pub fn normal(&self, node: usize, placed: impl Fn(usize) -> PlacedFace) -> NodalNormal {
        let FieldNode { support, mirrors, .. } = &self.nodes[node];
        let mut sum = Vec3::zero();
        for &(f, corner) in support {
            sum += self.area_vector(&self.faces[f], &placed(f), corner);
        }
        let sum = mirrored(sum, mirrors);
        NodalNormal { unit: sum.unit(), length: sum.norm(), mirrors: *mirrors }
    }

    /// Calls `add` with a node of the mesh and the derivatives of that sum of area vectors along its three displacements.
    pub fn normal_rates(
        &self,
        node: usize,
        placed: impl Fn(usize) -> PlacedFace,
        mut add: impl FnMut(usize, [Vec3; 3]),
    ) {
        for &(f, corner) in &self.nodes[node].support {
            let (face, placed) = (&self.faces[f], placed(f));
            let shape = face.shape(face.corner_place(corner));
            let tangents = shape.tangents(placed.nodes(), self.plane);
            face.nodes.iter().enumerate().for_each(|(k, &node)| add(node, shape.area_rates(k, tangents)));
        }
    }

    /// Undeformed area for a unit of the reference coordinates at a place of a face, the circumference and the thickness
    /// included, and its derivatives along them.
    pub fn density(&self, face: &FieldFace, rest: &PlacedFace, xi: [f64; 2]) -> (f64, [f64; 2]) {
        let value = |xi: [f64; 2]| self.density_at(face, rest, xi);
        let slope = |axis: usize| {
            // The density of straight-sided faces is a polynomial, of which a central difference leaves rounding.
            let at = |step: f64| value(std::array::from_fn(|a| if a == axis { xi[a] + step } else { xi[a] }));
            (8.0 * (at(STEP) - at(-STEP)) - (at(2.0 * STEP) - at(-2.0 * STEP))) / (12.0 * STEP)
        };
        (value(xi), [slope(0), if self.plane { 0.0 } else { slope(1) }])
    }

    /// The same in any placement, value alone.
    pub fn density_at(&self, face: &FieldFace, placed: &PlacedFace, xi: [f64; 2]) -> f64 {
        let shape = face.shape(xi);
        let [a, b] = shape.tangents(placed.nodes(), self.plane);
        let around = if self.revolves { std::f64::consts::TAU * shape.value(placed.nodes())[0] } else { 1.0 };
        a.cross(b).norm() * around * self.thickness
    }

    /// Which smooth pieces consist of curved faces alone.
    pub fn round_pieces(&self) -> Vec<bool> {
        let mut round = vec![true; self.pieces.iter().max().map_or(0, |last| last + 1)];
        self.pieces.iter().zip(&self.curved).for_each(|(&piece, curved)| round[piece] &= curved);
        round
    }

    /// Whether all faces around a node of the field are curved.
    pub fn is_round_at(&self, node: usize) -> bool {
        self.nodes[node].support.iter().all(|&(face, _)| self.curved[face])
    }

    /// Whether a part of a face of second degree around it is.
    pub fn is_curved_at(&self, node: usize) -> bool {
        self.nodes[node].support.iter().any(|&(face, _)| self.curved[face] && self.faces[face].is_piece())
    }

    /// Whether the surface ends at a node of the field.
    pub fn ends_at(&self, node: usize) -> bool {
        let around = &self.nodes[node].support;
        if self.plane { around.len() == 1 } else { self.borders(around).next().is_some() }
    }

    /// The nodes of the field along the edges that leave one, face by face.
    pub fn neighbours(&self, node: usize) -> impl Iterator<Item = usize> {
        self.nodes[node].support.iter().flat_map(|&(face, corner)| {
            let (field, count) = (&self.field[face], self.faces[face].corners());
            [1, count - 1].map(|step| field[(corner + step) % count])
        })
    }

    /// Edges of the body at which two smooth pieces meet, where it is convex; in the plane its corners.
    pub fn edges(&self, mesh: &Mesh) -> Vec<BodyEdge> {
        let (mut edges, together) = (Vec::new(), if self.plane { 1 } else { 2 });
        let middle = |face: &FieldFace| {
            let rest = face.at_rest(mesh);
            (face.shape(face.middle()).value(rest.nodes()), self.middle_normal(face, &rest))
        };
        let meet = |&[f, g]: &[usize; 2]| f < g && self.pieces[f] != self.pieces[g];
        let around = self.around();
        let pairs =
            around.values().flat_map(|all| all.iter().flat_map(|&(f, _)| all.iter().map(move |&(g, _)| [f, g])));
        for pair in pairs.filter(meet).collect::<BTreeSet<_>>() {
            let [own, other] = pair.map(|f| &self.faces[f]);
            let is_shared =
                |&corner: &usize| (0..other.corners()).any(|c| other.corner_node(c) == own.corner_node(corner));
            let ends: Vec<usize> = (0..own.corners()).filter(is_shared).collect();
            let [(x, n), (y, _)] = [own, other].map(middle);
            if ends.len() >= together && n.dot(y - x) < 0.0 {
                edges.push(BodyEdge { faces: pair, ends: [ends[0], ends[ends.len() - 1]] });
            }
        }
        edges
    }

    /// Size of a face, a length: its chord, or the root of its area.
    pub fn size(&self, face: usize, mesh: &Mesh) -> f64 {
        let face = &self.faces[face];
        let rest = face.at_rest(mesh);
        let [a, b] = face.shape(face.middle()).tangents(rest.nodes(), self.plane);
        let whole = if face.corners() == 3 { 0.5 } else { 4.0 };
        if self.plane { 2.0 * a.norm() } else { (whole * a.cross(b).norm()).sqrt() }
    }

    /// How far the faces around a node stand off a smooth surface, `h theta / 8` with `theta` the angle between neighbours where they
    /// meet; next to nothing for faces of second degree that follow it.
    pub fn sagitta(&self, node: usize, mesh: &Mesh) -> f64 {
        let of = |&(f, corner): &(usize, usize)| {
            let face = &self.faces[f];
            // Halves of an edge meet their neighbours at its end.
            let (corner, parts) = face.end().map_or((corner, 1.0), |end| (end, 2.0));
            let own = match face.kind.degree {
                1 => self.middle_normal(face, &face.at_rest(mesh)),
                _ => self.area_vector(face, &face.at_rest(mesh), corner).unit(),
            };
            let normal = self.normal(self.field[f][corner], |f| self.faces[f].at_rest(mesh)).unit;
            0.25 * parts * self.size(f, mesh) * own.dot(normal).clamp(-1.0, 1.0).acos()
        };
        self.nodes[node].support.iter().map(of).fold(0.0, f64::max)
    }

    /// Mean size of its faces.
    pub fn mean_size(&self, mesh: &Mesh) -> f64 {
        (0..self.faces.len()).map(|f| self.size(f, mesh)).sum::<f64>() / self.faces.len().max(1) as f64
    }

    /// Length of its edges in all, in space the root of the area of its faces.
    pub fn extent(&self, mesh: &Mesh) -> f64 {
        let sizes = (0..self.faces.len()).map(|f| self.size(f, mesh));
        if self.plane { sizes.sum() } else { sizes.map(|size| size * size).sum::<f64>().sqrt() }
    }

    /// Mean size of its faces, and the largest sagitta over it.
    pub fn coarseness(&self, mesh: &Mesh) -> [f64; 2] {
        let mean = self.mean_size(mesh);
        [mean, self.largest_sagitta(mesh) / mean]
    }

    /// How far its facets stand off a smooth surface at most, a length.
    pub fn largest_sagitta(&self, mesh: &Mesh) -> f64 {
        (0..self.nodes.len()).map(|node| self.sagitta(node, mesh)).fold(0.0, f64::max)
    }

    /// Shortest and longest size of its faces.
    pub fn sizes(&self, mesh: &Mesh) -> [f64; 2] {
        let sizes = (0..self.faces.len()).map(|f| self.size(f, mesh));
        sizes.fold([f64::INFINITY, 0.0], |[least, most], size| [least.min(size), most.max(size)])
    }

    /// The part of a face in place that belongs to one of its corners, `int M_c da`, and its derivatives along the
    /// displacements of its nodes.
    pub fn corner_area(&self, face: &FieldFace, placed: &PlacedFace, corner: usize) -> (f64, [Vec3; MOST]) {
        let (mut area, mut slopes) = (0.0, [Vec3::zero(); MOST]);
        let Some(rule) = face.cell().gauss[1] else { return (area, slopes) };
        for (point, weight) in rule.points.iter().zip(rule.weights) {
            let xi = [point[0], point[1]];
            let (shape, part) = (face.shape(xi), weight * self.thickness * face.corner_functions(xi).n[corner]);
            let [a, b] = shape.tangents(placed.nodes(), self.plane);
            let m = a.cross(b);
            let around = if self.revolves { std::f64::consts::TAU * shape.value(placed.nodes())[0] } else { 1.0 };
            area += part * m.norm() * around;
            let (along_b, along_a) = (b.cross(m.unit()), m.unit().cross(a));
            for (k, slope) in slopes[..face.nodes.len()].iter_mut().enumerate() {
                *slope += (along_b * shape.dn[k][0] + along_a * shape.dn[k][1]) * (part * around);
                if self.revolves {
                    slope[0] += part * m.norm() * std::f64::consts::TAU * shape.n[k];
                }
            }
        }
        (area, slopes)
    }
}

/// Angle between faces from which on they stand for a curved piece.
const CURVED: f64 = 1e-4;

/// Angle below which an open piece of the surface has a corner at a node, between that of a block and that of a straight edge.
const CORNER: f64 = 0.75 * std::f64::consts::PI;

/// Step of the differences of the area density, in reference coordinates.
const STEP: f64 = 1e-3;

/// An edge of a body at which two smooth pieces of its surface meet, in the plane a corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BodyEdge {
    /// A face of either.
    pub faces: [usize; 2],
    /// Corners of the first face at its ends, in the plane one.
    pub ends: [usize; 2],
}

/// Number of corners that two faces have in common.
fn shared(one: &FieldFace, other: &FieldFace) -> usize {
    let has = |face: &FieldFace, node: usize| (0..face.corners()).any(|c| face.corner_node(c) == node);
    (0..one.corners()).filter(|&c| has(other, one.corner_node(c))).count()
}
