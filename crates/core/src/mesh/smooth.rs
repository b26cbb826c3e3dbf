//! The middles of boundary edges of raised cells, off their chords onto a smooth surface through the corners.
//!
//! Sides of the boundary that meet at a corner without a crease share a normal there, `n = sum d1 x d2 / (|d1|^2 |d2|^2)` over their
//! edges `d1`, `d2` at the corner, which is that of a sphere through its neighbours (Max, J. Graphics Tools 4(2), 1999); in the plane
//! the sum of their normals over their lengths, that of a circle. The normal at an end of an edge makes it an arc; its middle goes to the mean
//! of the middles of the arcs of both ends (to leading order the middle of the cubic of Vlachos, Peters, Boyd and Mitchell, Curved PN triangles, 2001).

use super::raise::{Ends, ends};
use super::{CellView, Mesh, Side};
use crate::tensor::{DisjointSets, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// Sides of the boundary that meet at a larger angle, in radians, form a crease.
pub const CREASE: f64 = 0.7;
/// Sides whose normals differ by less are in one plane.
const FLAT: f64 = 1e-6;
/// Cosine to an edge from which on another one goes on along it beyond the end.
pub const ALONG: f64 = 0.5;
/// What goes on beyond the end of an edge says how it curves if it is no shorter than this part of it.
const SHORTEST: f64 = 0.25;
/// Cosine of normals below which a piece ends at right angles to a plane, but for half the angle between its sides.
const ACROSS: f64 = 0.3;
/// Surfaces that meet at an edge with normals whose cosine is larger, also of opposite ones, leave its middle on the chord.
const SHARP: f64 = 0.95;
/// The determinant of a raised cell is nowhere less than this part of that of the cell with straight edges.
const THINNEST: f64 = 0.2;

/// What a face with this area vector between its edges at a corner has in the normal there of the sphere, in the plane of the circle, through the
/// corners around (Max 1999).
pub fn round_share(area: Vec3, edges: &[Vec3]) -> Vec3 {
    area * edges.iter().map(|edge| 1.0 / edge.dot(*edge)).product::<f64>()
}

/// Height of an arc over its chord of this length, which it leaves at an angle of this sine.
pub fn arc_height(length: f64, sine: f64) -> f64 {
    0.5 * length * sine / (1.0 + (1.0 - sine * sine).sqrt())
}

/// By what the way of a middle is shortened where a cell is crushed, and the part of it from which on the chord is kept.
const EASED: f64 = 0.8;
const LEAST: f64 = 0.1;

/// The way of a middle off its chord, and the part of it that is gone.
struct Bow {
    chord: Vec3,
    by: Vec3,
    part: f64,
}

/// A corner of the boundary on one smooth piece.
#[derive(Default)]
struct Corner {
    /// Sum of the weighted normals of the sides around it.
    normal: Vec3,
    /// Unit normals of these sides.
    sides: Vec<Vec3>,
    /// Their edges that leave the corner.
    edges: Vec<Vec3>,
    /// How often each other node is the end of such an edge.
    times: BTreeMap<usize, usize>,
    /// Whether the piece ends here at right angles to planes, as at planes of symmetry, and the normal is in them.
    is_mirrored: bool,
    /// Whether all of the piece is in one plane, not only what of it is around the corner.
    lies_in_plane: bool,
    /// Whether a curve of the plane leaves here what is flat: its normal is that of the flat, and the circle through the corners beside it tells nothing.
    leaves_flat: bool,
}

impl Corner {
    fn is_flat(&self) -> bool {
        self.sides.iter().all(|normal| (*normal - self.sides[0]).norm() < FLAT)
    }
    /// Whether the piece goes on in one plane, which its end at a plane of symmetry may only seem to do.
    fn is_plane(&self) -> bool {
        self.is_flat() && (self.normal.unit() - self.sides[0]).norm() < FLAT
    }
    /// Whether sides of the piece lie all around it.
    fn is_inside(&self, plane: bool) -> bool {
        if plane { self.sides.len() == 2 } else { self.times.values().all(|&times| times == 2) }
    }
    /// Its edges that end the piece in a plane with a normal, if they are two.
    fn rim(&self, across: Vec3) -> [Option<Vec3>; 2] {
        let once = |edge: &&Vec3| self.edges.iter().filter(|other| other == edge).count() == 1;
        let within = |edge: &&Vec3| edge.dot(across).abs() < FLAT * edge.norm();
        let mut rim = self.edges.iter().filter(once).filter(within);
        let ends = [rim.next().copied(), rim.next().copied()];
        if rim.next().is_some() { [None; 2] } else { ends }
    }

    /// Whether its piece says how an edge that leaves it curves.
    fn says(&self, edge: Vec3) -> bool {
        if self.is_mirrored {
            return true;
        }
        let on = self.edges.iter().map(|other| -other.dot(edge) / edge.norm()).fold(0.0, f64::max);
        on > SHORTEST * edge.norm()
    }
    /// Whether its piece goes on beyond it along an edge.
    fn goes_on(&self, edge: Vec3) -> bool {
        self.edges.iter().any(|other| -other.dot(edge) > ALONG * other.norm() * edge.norm())
    }
    /// From the middle of an edge that leaves it to that of an arc which is at right angles to the normal here.
    fn arc(&self, edge: Vec3) -> Vec3 {
        let (normal, along) = (self.normal.unit(), edge.unit());
        let (sine, across) = (normal.dot(along), normal - along * normal.dot(along));
        if sine.abs() > CREASE.sin() {
            return Vec3::zero();
        }
        across.unit() * -arc_height(edge.norm(), sine)
    }
}

/// The corners of the boundary, each once for every smooth piece that meets there.
struct Boundary {
    plane: bool,
    corners: Vec<Corner>,
    /// Corners of each side, as nodes and as places in `corners`.
    sides: Vec<Vec<(usize, usize)>>,
    normals: Vec<Vec3>,
}

impl Boundary {
    fn of(mesh: &Mesh, sides: &[Side]) -> Self {
        let plane = mesh.dimension() == 2;
        let nodes = |&side: &Side| {
            let (kind, nodes) = mesh.side(side);
            nodes.take(kind.linear.nodes.len()).collect::<Vec<_>>()
        };
        let nodes: Vec<Vec<usize>> = sides.iter().map(nodes).collect();
        let normal = |own: &Vec<usize>| {
            let x = |corner: usize| mesh.points[own[corner]];
            match own.len() {
                2 => (x(1) - x(0)).cross(Vec3::axis(2)).unit(),
                3 => (x(1) - x(0)).cross(x(2) - x(0)).unit(),
                _ => (x(2) - x(0)).cross(x(3) - x(1)).unit(),
            }
        };
        let normals: Vec<Vec3> = nodes.iter().map(normal).collect();
        let mut around: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (side, own) in nodes.iter().enumerate() {
            own.iter().enumerate().for_each(|(corner, &node)| around.entry(node).or_default().push((side, corner)));
        }
        let mut boundary = Self { plane, corners: Vec::new(), sides: Vec::new(), normals };
        let flat = boundary.in_planes(&nodes, &around);
        let mut places: Vec<Vec<(usize, usize)>> =
            nodes.iter().map(|own| own.iter().map(|&node| (node, 0)).collect()).collect();
        for around in around.values() {
            let (mut left, first) = (around.clone(), boundary.corners.len());
            while let Some(one) = left.pop() {
                let mut piece = vec![one];
                let mut next = 0;
                while next < piece.len() {
                    let side = piece[next].0;
                    let (joined, others) = left.iter().partition(|&&(other, _)| boundary.joins(&nodes, [side, other]));
                    left = others;
                    piece.extend::<Vec<_>>(joined);
                    next += 1;
                }
                for &(side, corner) in &piece {
                    places[side][corner].1 = boundary.corners.len();
                }
                let corner = boundary.corner(mesh, &nodes, &piece);
                boundary.corners.push(Corner { lies_in_plane: flat[one.0], ..corner });
            }
            mirror(&mut boundary.corners[first..], plane);
        }
        boundary.sides = places;
        boundary.find_flats();
        boundary
    }

    /// Finds the corners of the plane beside which one side goes on flat and the other does not.
    fn find_flats(&mut self) {
        let mut beside = vec![Vec::new(); self.corners.len()];
        for side in self.sides.iter().filter(|_| self.plane) {
            for (&(_, own), &(_, other)) in side.iter().zip(side.iter().rev()) {
                beside[own].push(self.corners[other].sides.len() == 2 && self.corners[other].is_flat());
            }
        }
        for (corner, beside) in self.corners.iter_mut().zip(beside) {
            corner.leaves_flat = matches!(beside[..], [one, other] if one != other) && !corner.is_flat();
        }
    }

    /// For each side whether all of its smooth piece is in one plane.
    fn in_planes(&self, nodes: &[Vec<usize>], around: &BTreeMap<usize, Vec<(usize, usize)>>) -> Vec<bool> {
        let mut pieces = DisjointSets::new(nodes.len());
        let pairs =
            around.values().flat_map(|all| all.iter().flat_map(|&(f, _)| all.iter().map(move |&(g, _)| [f, g])));
        pairs.filter(|&[f, g]| f < g && self.joins(nodes, [f, g])).for_each(|[f, g]| pieces.join(f, g));
        let labels = pieces.labels();
        let mut first: BTreeMap<usize, (Vec3, bool)> = BTreeMap::new();
        for (side, normal) in self.normals.iter().enumerate() {
            let (one, flat) = first.entry(labels[side]).or_insert((*normal, true));
            *flat &= (*normal - *one).norm() < FLAT;
        }
        labels.iter().map(|label| first[label].1).collect()
    }

    /// Whether two sides around a corner meet without a crease.
    fn joins(&self, nodes: &[Vec<usize>], [one, other]: [usize; 2]) -> bool {
        let shared = nodes[one].iter().filter(|node| nodes[other].contains(node)).count();
        shared >= if self.plane { 1 } else { 2 } && self.is_smooth([one, other])
    }

    fn is_smooth(&self, [one, other]: [usize; 2]) -> bool {
        self.normals[one].dot(self.normals[other]) > CREASE.cos()
    }

    fn corner(&self, mesh: &Mesh, nodes: &[Vec<usize>], piece: &[(usize, usize)]) -> Corner {
        let mut found = Corner::default();
        for &(side, corner) in piece {
            let (own, count) = (&nodes[side], nodes[side].len());
            let ends =
                if self.plane { vec![1 - corner] } else { vec![(corner + 1) % count, (corner + count - 1) % count] };
            let edges: Vec<Vec3> = ends.iter().map(|&end| mesh.points[own[end]] - mesh.points[own[corner]]).collect();
            let area = if self.plane { self.normals[side] * edges[0].norm() } else { edges[0].cross(edges[1]) };
            found.normal += round_share(area, &edges);
            found.sides.push(self.normals[side]);
            found.edges.extend(edges);
            ends.iter().for_each(|&end| *found.times.entry(own[end]).or_default() += 1);
        }
        found
    }

    /// From the middle of an edge to that on a piece with these corners at its ends, and the unit normal there.
    fn bow(&self, [one, other]: [usize; 2], edge: Vec3) -> [Vec3; 2] {
        let corners = [(&self.corners[one], edge), (&self.corners[other], -edge)];
        let mean = corners[0].0.normal.unit() + corners[1].0.normal.unit();
        let normal = (mean - edge * (mean.dot(edge) / edge.dot(edge))).unit();
        let said = |(corner, edge): &(&Corner, Vec3)| corner.says(*edge) && !corner.leaves_flat;
        let (inside, border): (Vec<_>, Vec<_>) =
            corners.into_iter().filter(said).partition(|(corner, _)| corner.is_inside(self.plane));
        let by = if inside.is_empty() {
            let (mirrored, others): (Vec<_>, Vec<_>) = border.into_iter().partition(|(corner, _)| corner.is_mirrored);
            if mirrored.iter().any(|(corner, _)| !corner.is_flat()) {
                mean_arc(&mirrored)
            } else {
                // Where a surface ends otherwise, its normal is that of the last side.
                let others = others.into_iter().filter(|(corner, edge)| !corner.is_flat() && corner.goes_on(*edge));
                let arcs = others.map(|(corner, edge)| corner.arc(edge));
                arcs.reduce(|one, other| if other.norm() > one.norm() { other } else { one })
            }
        } else {
            mean_arc(&inside)
        };
        [by.unwrap_or_else(Vec3::zero), normal]
    }
}

impl Mesh {
    /// Moves new middles of boundary edges, each given with its ends, off their chords, as far as no cell of theirs is crushed by it.
    pub(super) fn smooth(&mut self, fresh: &[(Ends, usize)]) {
        let all: Vec<usize> = (0..self.cell_count()).collect();
        let middles: BTreeMap<Ends, usize> = fresh.iter().copied().collect();
        let boundary = Boundary::of(self, &self.boundary(&all));
        let mut edges: BTreeMap<Ends, Vec<(usize, [usize; 2])>> = BTreeMap::new();
        for (side, corners) in boundary.sides.iter().enumerate() {
            let count = if boundary.plane { 1 } else { corners.len() };
            for k in 0..count {
                let [a, b] = [corners[k], corners[(k + 1) % corners.len()]];
                let places = if a.0 < b.0 { [a.1, b.1] } else { [b.1, a.1] };
                edges.entry(ends(a.0, b.0)).or_default().push((side, places));
            }
        }
        let mut bows = BTreeMap::new();
        for (edge, sides) in edges {
            let Some(&middle) = middles.get(&edge) else { continue };
            let along = self.points[edge[1]] - self.points[edge[0]];
            let ways: Vec<[Vec3; 2]> = sides.iter().map(|&(_, corners)| boundary.bow(corners, along)).collect();
            let by = match ways[..] {
                [[by, _]] => by,
                [[by, _], _] if boundary.is_smooth([sides[0].0, sides[1].0]) => by,
                [one, other] => crossing(one, other),
                _ => continue,
            };
            if by.norm() > 0.0 {
                bows.insert(middle, Bow { chord: self.points[middle], by, part: 1.0 });
                self.points[middle] += by;
            }
        }
        self.ease(&all, bows);
    }

    /// Takes middles back towards their chords where a cell is crushed.
    fn ease(&mut self, cells: &[usize], mut bows: BTreeMap<usize, Bow>) {
        loop {
            let moved = |cell: usize| self.cell(cell).nodes.iter().filter(|node| bows.contains_key(node));
            let crushed = cells.iter().filter(|&&cell| moved(cell).next().is_some() && self.is_crushed(cell));
            let back: BTreeSet<usize> = crushed.flat_map(|&cell| moved(cell).copied()).collect();
            if back.is_empty() {
                return;
            }
            for node in back {
                let Some(bow) = bows.get_mut(&node) else { continue };
                bow.part *= EASED;
                self.points[node] = bow.chord + bow.by * bow.part;
                if bow.part < LEAST {
                    self.points[node] = bow.chord;
                    bows.remove(&node);
                }
            }
        }
    }

    /// Whether the determinant of a cell falls much below that of the cell of first degree on its corners.
    fn is_crushed(&self, cell: usize) -> bool {
        let view = self.cell(cell);
        let straight = CellView { kind: view.kind.linear, nodes: &view.nodes[..view.kind.linear.nodes.len()] };
        let places = view.kind.nodes.iter().chain(view.kind.full.points);
        places.into_iter().any(|&xi| view.jacobian(&self.points, xi) < THINNEST * straight.jacobian(&self.points, xi))
    }
}

/// The mean of the arcs of an edge from its corners; none where one of them is in a plane part.
fn mean_arc(corners: &[(&Corner, Vec3)]) -> Option<Vec3> {
    let sum = corners.iter().fold(Vec3::zero(), |sum, (corner, edge)| sum + corner.arc(*edge));
    corners.iter().all(|(corner, _)| !corner.is_plane()).then(|| sum * (1.0 / corners.len() as f64))
}

/// Puts the normals of pieces that end at a node into the planes across which they end there.
fn mirror(corners: &mut [Corner], plane: bool) {
    let flat: Vec<Option<Vec3>> = corners.iter().map(|corner| corner.is_flat().then(|| corner.sides[0])).collect();
    let ends = |(_, corner): &(usize, &mut Corner)| !corner.is_inside(plane) && !corner.lies_in_plane;
    for (own, corner) in corners.iter_mut().enumerate().filter(ends) {
        for across in flat.iter().enumerate().filter_map(|(other, normal)| normal.filter(|_| other != own)) {
            if corner.sides.iter().all(|side| side.dot(across).abs() < ACROSS) {
                corner.normal -= across * corner.normal.dot(across);
                corner.is_mirrored = true;
                // Along the rim a circle goes through the node and those beside it, however many sides are on either.
                if let [Some(one), Some(other)] = corner.rim(across) {
                    let of = |edge: Vec3| {
                        let n = edge.cross(across);
                        n * (corner.normal.dot(n).signum() / edge.dot(edge))
                    };
                    corner.normal = of(one) + of(other);
                }
            }
        }
    }
}

/// The shortest way onto two surfaces that cross at an edge, from the way onto either and its normal.
fn crossing([one, n]: [Vec3; 2], [other, m]: [Vec3; 2]) -> Vec3 {
    let (cosine, [d, e]) = (n.dot(m), [one.dot(n), other.dot(m)]);
    if cosine.abs() > SHARP {
        return Vec3::zero();
    }
    let rest = 1.0 - cosine * cosine;
    n * ((d - cosine * e) / rest) + m * ((e - cosine * d) / rest)
}

#[cfg(test)]
mod tests {
    use crate::mesh::generate::{Annulus, Block, Rectangle};
    use crate::mesh::{Cell, Mesh};
    use crate::tensor::Vec3;

    fn raised(mesh: Mesh) -> Mesh {
        let all: Vec<usize> = (0..mesh.cell_count()).collect();
        mesh.raised(&all)
    }

    fn ring(cell: &str, angles: [f64; 2], cells: [usize; 2]) -> Mesh {
        Annulus::new([0.0; 2], [1.0, 2.0], angles, cells, Cell::named(cell).unwrap()).mesh("r").unwrap()
    }

    /// Farthest off a radius that nodes of a group lie.
    fn off(mesh: &Mesh, group: &str, radius: f64) -> f64 {
        let nodes = mesh.groups[group].nodes.iter().map(|&node| mesh.points[node]);
        nodes.map(|x| (x[0].hypot(x[1]) - radius).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn middles_of_rings_lie_on_their_circles() {
        for cell in ["tri3", "quad4"] {
            for (angles, count) in [([0.0, 90.0], 5), ([30.0, 75.0], 3), ([0.0, 360.0], 12)] {
                let mut mesh = ring(cell, angles, [2, count]);
                // Uneven edges.
                for x in &mut mesh.points {
                    let (radius, angle) = (x[0].hypot(x[1]), x[1].atan2(x[0]));
                    let angle = angle + 0.08 * (4.0 * angle).sin();
                    *x = Vec3::new(radius * angle.cos(), radius * angle.sin(), 0.0);
                }
                let mesh = raised(mesh);
                for (group, radius) in [("r.inner", 1.0), ("r.outer", 2.0)] {
                    assert!(off(&mesh, group, radius) < 1e-12, "{cell} {angles:?} {}", off(&mesh, group, radius));
                }
            }
        }
    }

    /// A quarter of a tube: its rims, their ends and the edges between stay on it, and its plane sides plane.
    #[test]
    fn middles_of_tubes_lie_on_their_cylinders() {
        for (cell, layers) in ["tet4", "hex8", "wedge6"].into_iter().flat_map(|cell| [(cell, 1), (cell, 3)]) {
            let kind = Cell::named(cell).unwrap();
            let mut mesh = Block::new([0.0; 3], [1.0, 1.0, 1.0], [2, 5, layers], kind).mesh("b").unwrap();
            for x in &mut mesh.points {
                let (radius, angle) = (1.0 + x[0], 90.0_f64.to_radians() * x[1]);
                *x = Vec3::new(radius * angle.cos(), radius * angle.sin(), x[2]);
            }
            let mesh = raised(mesh);
            for (group, radius) in [("b.left", 1.0), ("b.right", 2.0)] {
                let (off, chord) = (off(&mesh, group, radius), radius * (1.0 - 9.0_f64.to_radians().cos()));
                assert!(off < 0.02 * chord, "{cell} {group}: {off} of {chord}");
            }
            for (group, axis, value) in
                [("b.back", 2, 0.0), ("b.front", 2, 1.0), ("b.bottom", 1, 0.0), ("b.top", 0, 0.0)]
            {
                let plane = |&node: &usize| (mesh.points[node][axis] - value).abs() < 1e-14;
                assert!(mesh.groups[group].nodes.iter().all(plane), "{cell} {group}");
            }
        }
    }

    /// A sector of a thick ball, of two cells along its edges: the planes that bound it stay plane, although each of their corners is at right angles to what is
    /// nearly plane of the sphere.
    #[test]
    fn planes_that_bound_a_ball_stay_plane() {
        let mut mesh = Block::new([0.0; 3], [1.0; 3], [1, 2, 2], Cell::named("tet4").unwrap()).mesh("b").unwrap();
        for x in &mut mesh.points {
            let [a, b] = [x[1], x[2]].map(|part| (45.0_f64.to_radians() * part).tan());
            *x = Vec3::new(a, -1.0, b).unit() * (2.0 + 6.0 * x[0]);
        }
        let mesh = raised(mesh);
        for (group, axis) in [("b.bottom", 0), ("b.back", 2)] {
            assert!(mesh.groups[group].nodes.iter().all(|&node| mesh.points[node][axis].abs() < 1e-14), "{group}");
        }
    }

    /// A ball of cells of very different shapes, some with several sides on its surface, which a sphere would leave without volume.
    #[test]
    fn middles_of_balls_lie_on_their_spheres() {
        for cell in ["tet4", "hex8"] {
            let kind = Cell::named(cell).unwrap();
            let mut mesh = Block::new([-1.0; 3], [1.0; 3], [6, 6, 6], kind).mesh("b").unwrap();
            for x in mesh.points.iter_mut().filter(|x| x.norm() > 0.0) {
                let [a, b, c] = x.0;
                let shaken = *x + Vec3::new((9.0 * b).sin(), (8.0 * c).sin(), (7.0 * a).sin()) * 0.04;
                *x = shaken * (a.abs().max(b.abs()).max(c.abs()) / shaken.norm());
            }
            let mesh = raised(mesh);
            let skin = mesh.boundary(&(0..mesh.cell_count()).collect::<Vec<_>>());
            let (mut sum, mut chords) = (0.0, 0.0);
            for side in skin {
                let (kind, nodes) = mesh.side(side);
                let x: Vec<Vec3> = nodes.map(|node| mesh.points[node]).collect();
                for (middle, [a, b]) in kind.middles() {
                    sum += (x[middle].norm() - 1.0).abs();
                    chords += 1.0 - ((x[a] + x[b]) * 0.5).norm();
                }
            }
            assert!(sum < 0.15 * chords, "{cell}: {}", sum / chords);
        }
    }

    /// A plate of one layer that runs into an arc bends there alone: its plane part keeps chords.
    #[test]
    fn plane_parts_before_an_arc_stay_plane() {
        for cell in ["tet4", "hex8"] {
            let kind = Cell::named(cell).unwrap();
            let mut mesh = Block::new([0.0; 3], [1.0, 2.0, 0.5], [2, 10, 1], kind).mesh("b").unwrap();
            for x in mesh.points.iter_mut().filter(|x| x[1] > 1.0) {
                let angle = 0.8 * (x[1] - 1.0);
                *x = Vec3::new((x[0] + 1.0) * angle.cos() - 1.0, 1.0 + (x[0] + 1.0) * angle.sin(), x[2]);
            }
            let mesh = raised(mesh);
            for (group, at) in [("b.left", 0.0), ("b.right", 1.0)] {
                let nodes = mesh.groups[group].nodes.iter().map(|&node| mesh.points[node]);
                assert!(nodes.clone().filter(|x| x[1] < 1.0).all(|x| x[0] == at), "{cell} {group}");
                assert!(off_centre(nodes.filter(|x| x[1] > 1.2), 1.0 + at) < 2e-4, "{cell} {group}");
            }
        }
    }

    fn off_centre(points: impl Iterator<Item = Vec3>, radius: f64) -> f64 {
        points.map(|x| ((x[0] + 1.0).hypot(x[1] - 1.0) - radius).abs()).fold(0.0, f64::max)
    }

    /// Straight sides keep their middles to the bit, leaning or with a blunt corner between them; a layer that an arc would
    /// cut through keeps its chords.
    #[test]
    fn straight_sides_and_thin_cells_keep_chords() {
        let mut blunt = Rectangle::new([0.0; 2], [4.0, 1.0], [8, 2], Cell::named("quad4").unwrap()).mesh("b").unwrap();
        for x in &mut blunt.points {
            let [a, b, _] = x.0;
            *x = Vec3::new(a + 0.1 * b, b + 0.2 * (a - 2.0).abs(), 0.0);
        }
        let cell = Cell::named("tri3").unwrap();
        let thin = Annulus::new([0.0; 2], [1.0, 1.004], [0.0, 90.0], [1, 8], cell).mesh("b").unwrap();
        for (mesh, all) in [(blunt, true), (thin, false)] {
            let (count, mesh) = (mesh.points.len(), raised(mesh));
            let mut straight = 0;
            for cell in (0..mesh.cell_count()).map(|cell| mesh.cell(cell)) {
                for (middle, [a, b]) in cell.kind.middles() {
                    let [middle, a, b] = [middle, a, b].map(|place| cell.nodes[place]);
                    let [least, most] = [a.min(b), a.max(b)];
                    assert!(middle >= count);
                    straight += usize::from(mesh.points[middle] == (mesh.points[least] + mesh.points[most]) * 0.5);
                    assert!(!all || mesh.points[middle] == (mesh.points[least] + mesh.points[most]) * 0.5);
                }
                assert!(cell.kind.nodes.iter().all(|&xi| cell.jacobian(&mesh.points, xi) > 0.0));
            }
            assert!(straight > 0);
        }
    }
}
