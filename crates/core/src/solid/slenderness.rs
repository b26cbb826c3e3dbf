//! How long and how thick the cells of a body are, against its own thickness, how much they taper and how far they are curved: what
//! cells get wrong in bending.

use super::{Body, Formulation, Integration, incompatible};
use crate::mesh::cells::Cell;
use crate::mesh::{CREASE, CellView, Mesh, Side, median};
use crate::tensor::{Tensor2, Vec3};
use std::collections::{BTreeMap, BTreeSet};

/// By what part some cells of first degree are too stiff in bending by the simplices or prisms among them, where that is much: that
/// of a body of these alone, times their part of it.
pub fn too_stiff(mesh: &Mesh, cells: &[usize]) -> Option<f64> {
    let plain = |&cell: &usize| !incompatible::has_modes(mesh.kinds[cell]);
    let kind = cells.iter().copied().find(plain).map(|cell| mesh.kinds[cell])?;
    if cells.iter().any(|&cell| mesh.kinds[cell].degree != 1) {
        return None;
    }
    let volume = |cells: &mut dyn Iterator<Item = usize>| cells.map(|cell| mesh.measure(cell)).sum::<f64>();
    let part = volume(&mut cells.iter().copied().filter(plain)) / volume(&mut cells.iter().copied());
    let stiff = part * Slenderness::of(mesh, cells, [false; 3]).stiff(kind, Formulation::Standard);
    (stiff > STIFF).then_some(stiff)
}

/// How many cells, simplices taken together, lie through a body with a `boundary` behind some `sides` of it.
pub fn layers(mesh: &Mesh, sides: &[Side], boundary: &[Side]) -> f64 {
    mesh.thickness(sides, boundary) / deep(mesh, sides)
}

/// The median over some sides of the height of the cell behind.
fn deep(mesh: &Mesh, sides: &[Side]) -> f64 {
    median(sides.iter().map(|&side| (height(mesh, side), mesh.extent(side))).collect())
}

/// Volume of the cell behind a side over the area, of a simplex over its base, of a wedge over one of its quadrilaterals.
fn height(mesh: &Mesh, side: Side) -> f64 {
    let kind = mesh.cell(side.cell).kind;
    let part = match (kind.linear.nodes.len(), mesh.side(side).0.linear.nodes.len()) {
        (nodes, _) if nodes == kind.dimension + 1 => kind.dimension as f64,
        (6, 4) => 2.0,
        _ => 1.0,
    };
    part * mesh.depth(side)
}

/// Part by which a body may be too stiff in bending without a word.
pub(super) const STIFF: f64 = 0.1;

/// Part by which curved cells of second degree may be wrong in bending before reduced integration takes over.
const CURVED: f64 = 0.025;
/// Part by which the plastic moment is too large with two Gauss points through a body, `2 / sqrt(3) - 1`.
pub(super) const TWO_POINTS: f64 = 0.155;
/// Part by which it is too small with three, `1 - 10/9 sqrt(3/5)`.
const THREE_POINTS: f64 = 0.139;
/// Cells through a body below which one lies through it.
pub(super) const ONE: f64 = 1.5;
/// Part by which a plastic moment may be wrong without a word.
pub(super) const PLASTIC: f64 = 0.05;

/// Of a body's cells, simplices taken together to quadrilaterals and bricks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slenderness {
    /// Length along the body over its thickness.
    pub along: f64,
    /// How many of them lie through it.
    pub through: f64,
    /// How much longer one of their sides along it is than the other, as the sine of half the slope of those between, times their length over
    /// the body's thickness; where neighbours taper the same way, as around a curved body, that times the slope and a factor.
    pub taper: f64,
    /// Height of their arcs over the thickness, root of the mean square over both surfaces of a body of that; in first degree, in space,
    /// of those that their facets stand for.
    pub arc: f64,
    /// Whether some have no neighbour but those along one axis in space, or none at all in the plane.
    pub alone: bool,
}

impl Slenderness {
    /// That of some cells: the medians, over their surface, of the thickness behind a side, and of length and height of the cell there;
    /// without sides that face an axis along which they are held.
    pub fn of(mesh: &Mesh, cells: &[usize], held: [bool; 3]) -> Self {
        let mut boundary = mesh.boundary(cells);
        boundary.retain(|&side| mesh.faces(side).is_none_or(|axis| !held[axis]));
        if boundary.is_empty() {
            return Self { along: 0.0, through: f64::INFINITY, taper: 0.0, arc: 0.0, alone: false };
        }
        let volume: f64 = cells.iter().map(|&cell| mesh.measure(cell)).sum();
        let thickness = mesh.thickness(&boundary, &boundary);
        let along = median(boundary.iter().map(|&side| (length(mesh, side), mesh.extent(side))).collect());
        let beside = beside(mesh, &boundary);
        let taper = median(tapers(mesh, &boundary, &beside)) / thickness;
        let facets = facets(mesh, &boundary, &beside);
        let square = |(&side, facet): (&Side, &f64)| (arc(mesh, side).powi(2) + facet) * mesh.extent(side);
        let squares: f64 = boundary.iter().zip(&facets).map(square).sum();
        let arc = (squares / (2.0 * volume * thickness)).sqrt();
        let through = thickness / deep(mesh, &boundary);
        Self { along: along / thickness, through, taper, arc, alone: alone(mesh, &boundary) }
    }

    /// By what part of its deflection a body of such cells is too stiff in bending, roughly: the shear that comes along goes with the
    /// square of their length, the stretch across that is not free with that of their thickness. The factors are those of cantilevers
    /// with one to eight cells through them, Poisson's ratio 0.3. Cells with incompatible modes bend, but as trapezoids none
    /// does so without shear, whatever passes the patch test (MacNeal 1987). Curved cells of second degree stretch along their
    /// middle as they bend, against which full integration resists (membrane locking, Stolarski and Belytschko 1983): the factors are
    /// those of rings. With F-bar and one cell through them they lose stiffness instead, a part that is negative here; with more cells
    /// that is a bound of what they lose or win.
    pub fn stiff(&self, kind: &Cell, formulation: Formulation) -> f64 {
        let (long, thick) = (self.along.powi(2), self.through.powi(-2));
        let trapezoids = 2.0 * self.taper.powi(2);
        match (kind.degree, formulation) {
            (1, Formulation::Incompatible) => trapezoids,
            (1, Formulation::FBar) if incompatible::has_modes(kind) => 0.35 * long + trapezoids,
            (1, _) if incompatible::has_modes(kind) => 0.35 * long + 0.3 * thick + trapezoids,
            (1, _) => long + 2.7 * thick,
            (2, Formulation::FBar) => {
                let lost = [3.0, 1.5, 0.8, 0.0][match together(kind) {
                    1.0 => kind.dimension - 2,
                    2.0 => 2,
                    _ => 3,
                }];
                -lost * self.arc.powi(2)
            }
            (2, Formulation::Standard) if together(kind) > 1.0 => 1.4 * self.arc.powi(2),
            (2, Formulation::Standard) => 4.5 * self.arc.powi(2),
            _ => 0.0,
        }
    }

    /// By what part the plastic moment of a body of such cells is too large, at most. Incompatible modes do not free cells that flow from
    /// shear: the factor is that of beams bent far. Simplices of second degree have points enough.
    pub fn plastic(&self, kind: &Cell, formulation: Formulation, integration: Integration) -> f64 {
        let simplex = matches!(kind.name, "tri6" | "tet10");
        match (kind.degree, formulation) {
            (1, Formulation::Incompatible) if self.through < ONE => TWO_POINTS + 0.3 * self.along,
            (1, Formulation::Incompatible) => 0.3 * self.along,
            (1, _) => self.stiff(kind, formulation),
            _ if self.through > ONE || simplex => 0.0,
            _ if integration == Integration::Reduced => TWO_POINTS,
            _ => -THREE_POINTS,
        }
    }

    /// By what part more than that a curved body of bricks of first degree is too stiff in bending. An arc of length `l` and curvature `k`
    /// has a chord shorter by `k^2 l^3 / 24`, so that a facet whose nodes lie on a surface that bends by `c` without stretch is stretched
    /// by `k c l^2 / 12`, which takes `(k l^2 / t)^2 / 12` of the energy of bending, `16 / 3` of the square of the arc's height over
    /// the thickness (membrane locking, Stolarski and Belytschko 1983). A ring or tube that bends alike all along its axis makes
    /// up for it by a change of its length.
    pub fn stretched(&self, kind: &Cell) -> f64 {
        if incompatible::has_modes(kind) { 16.0 / 3.0 * self.arc.powi(2) } else { 0.0 }
    }

    /// Whether reduced integration serves cells of a kind that full integration makes wrong in bending by some part: quadrilaterals and bricks
    /// of second degree without a node in the middle, for those with one have a mechanism, as bricks have in a stack that is one wide.
    /// With one of them through a body that `flows` two points carry too much of it.
    pub fn reduces(&self, kind: &Cell, wrong: f64, flows: bool) -> bool {
        let least = if flows && self.through < ONE { TWO_POINTS } else { CURVED };
        matches!(kind.name, "quad8" | "hex20") && !self.alone && wrong.abs() > least
    }

    /// Whether cells through a body share their change of volume, so that much of its stiffness in bending is lost: one or two
    /// quadrilaterals or bricks of first degree, one to three tetrahedra of second, with 65, 12 and 5 % where it keeps its volume.
    pub fn soft(&self, kind: &Cell, formulation: Formulation) -> bool {
        let few = match (kind.degree, together(kind)) {
            (1, 1.0) => 2.5,
            (2, 6.0) => 3.5,
            _ => 0.0,
        };
        formulation == Formulation::FBar && self.through < few
    }
}

/// Square of what a cell that tapers as its neighbours do is stiffer in bending than one among those that taper against it, over that of
/// its slope: of rings with 4 to 16 cells a quarter.
const TOGETHER: f64 = 0.56;

/// Sides of the boundary that meet each of some at each of its ends or edges.
fn beside(mesh: &Mesh, boundary: &[Side]) -> Vec<Vec<Vec<usize>>> {
    let mut known = BTreeMap::<Vec<usize>, Vec<usize>>::new();
    let rims_of = |&side: &Side| {
        let (kind, nodes) = mesh.side(side);
        let corners: Vec<usize> = nodes.take(kind.linear.nodes.len()).collect();
        let mut rims: Vec<Vec<usize>> = match kind.dimension {
            1 => corners.iter().map(|&corner| vec![corner]).collect(),
            _ => kind.faces.iter().map(|edge| [0, 1].map(|end| corners[edge.nodes[end]]).to_vec()).collect(),
        };
        rims.iter_mut().for_each(|rim| rim.sort_unstable());
        rims
    };
    let rims: Vec<Vec<Vec<usize>>> = boundary.iter().map(rims_of).collect();
    for (number, rim) in rims.iter().enumerate().flat_map(|(number, rims)| rims.iter().map(move |rim| (number, rim))) {
        known.entry(rim.clone()).or_default().push(number);
    }
    let others =
        |number: usize, rim: &Vec<usize>| known[rim].iter().copied().filter(|&other| other != number).collect();
    rims.iter().enumerate().map(|(number, rims)| rims.iter().map(|rim| others(number, rim)).collect()).collect()
}

/// What sides of the boundary taper, in the measure of [`Slenderness::taper`] times the thickness, with their extents.
fn tapers(mesh: &Mesh, boundary: &[Side], beside: &[Vec<Vec<usize>>]) -> Vec<(f64, f64)> {
    let own: Vec<[f64; 2]> = boundary.iter().map(|&side| taper(mesh, side)).collect();
    let of = |((side, [taper, slope]), beside): ((&Side, &[f64; 2]), &Vec<Vec<usize>>)| {
        let against = beside.iter().flatten().map(|&other| own[other][0]).filter(|other| other * taper < 0.0);
        let against = against.map(|other| 0.5 * (taper - other).abs()).fold(0.0, f64::max);
        let measure = if against > 0.0 { against } else { TOGETHER.sqrt() * (taper * slope).abs() };
        (measure, mesh.extent(*side))
    };
    boundary.iter().zip(&own).zip(beside).map(of).collect()
}

/// The slope between a side of a quadrilateral or brick and the one across from it that makes the difference of their lengths, the sine of
/// half of it times their length and it alone, along the way of the two where that is more; none of other cells.
fn taper(mesh: &Mesh, side: Side) -> [f64; 2] {
    let view = mesh.cell(side.cell);
    if !incompatible::has_modes(view.kind) {
        return [0.0; 2];
    }
    let Some(across) = across(mesh, side) else { return [0.0; 2] };
    let depth = 2.0 * mesh.measure(side.cell) / (mesh.extent(side) + mesh.extent(across));
    let way = |near: Vec3, far: Vec3| {
        let [near, far] = [near, far].map(Vec3::norm);
        let slope = (near - far) / depth;
        [0.5 * slope * (near + far) / slope.hypot(2.0), slope]
    };
    let ([a, b], [c, d]) = (ways(mesh, side), ways(mesh, across));
    let [c, d] = if a.dot(c).abs() < a.dot(d).abs() { [d, c] } else { [c, d] };
    let (one, other) = (way(a, c), way(b, d));
    if one[0].abs() < other[0].abs() { other } else { one }
}

/// Squares of the heights of the arcs, along both ways, that the quadrilaterals of first degree among some sides stand for: an eighth of
/// their length times the turn to the next. Where those beside one another meet others along one way alone, they bend alike across it.
fn facets(mesh: &Mesh, boundary: &[Side], beside: &[Vec<Vec<usize>>]) -> Vec<f64> {
    let frames: Vec<(Vec3, Vec3)> = boundary.iter().map(|&side| mesh.frame(side)).collect();
    let height = |number: usize, others: &[usize]| {
        let (x, n) = frames[number];
        let turn = |&other: &usize| {
            let (y, m) = frames[other];
            let turn = n.cross(m).norm().atan2(n.dot(m));
            (turn < CREASE).then(|| turn * (x - y).norm() / 8.0)
        };
        others.iter().filter_map(turn).max_by(f64::total_cmp)
    };
    let of = |(number, beside): (usize, &Vec<Vec<usize>>)| {
        let kind = mesh.side(boundary[number]).0;
        let [a, b, c, d] = &beside[..] else { return 0.0 };
        let way = |ends: [&Vec<usize>; 2]| ends.iter().filter_map(|end| height(number, end)).max_by(f64::total_cmp);
        match (kind.degree, way([a, c]), way([b, d])) {
            (1, Some(one), Some(other)) => one.powi(2) + other.powi(2),
            _ => 0.0,
        }
    };
    beside.iter().enumerate().map(of).collect()
}

/// The side of a cell that shares no node with one of them.
fn across(mesh: &Mesh, side: Side) -> Option<Side> {
    let own: Vec<usize> = mesh.side(side).1.collect();
    let mut sides = (0..mesh.cell(side.cell).kind.faces.len()).map(|face| Side { cell: side.cell, face });
    sides.find(|&other| mesh.side(other).1.all(|node| !own.contains(&node)))
}

/// Whether some quadrilaterals or bricks have two pairs of opposite sides or more on the boundary.
fn alone(mesh: &Mesh, boundary: &[Side]) -> bool {
    let outer: BTreeSet<(usize, usize)> = boundary.iter().map(|side| (side.cell, side.face)).collect();
    let mut paired = BTreeMap::<usize, usize>::new();
    for &side in boundary {
        if across(mesh, side).is_some_and(|other| outer.contains(&(other.cell, other.face))) {
            *paired.entry(side.cell).or_default() += 1;
        }
    }
    paired.values().any(|&sides| sides > 2)
}

/// Length of a side: of a quadrilateral the longer of its ways, of a triangle the root of twice its area.
fn length(mesh: &Mesh, side: Side) -> f64 {
    match mesh.side(side).0.linear.nodes.len() {
        4 => ways(mesh, side).map(Vec3::norm).into_iter().fold(0.0, f64::max),
        3 => (2.0 * mesh.extent(side)).sqrt(),
        _ => mesh.extent(side),
    }
}

/// The ways along a side, between the middles of opposite edges; of an edge the one.
fn ways(mesh: &Mesh, side: Side) -> [Vec3; 2] {
    let x: Vec<Vec3> = mesh.side(side).1.map(|node| mesh.points[node]).collect();
    match x[..] {
        [a, b] => [b - a, Vec3::zero()],
        _ => [(x[1] + x[2] - x[0] - x[3]) * 0.5, (x[2] + x[3] - x[0] - x[1]) * 0.5],
    }
}

/// Part of a body's largest strain by which that within a cell must vary for it to bend: what does so by a thousandth carries a millionth of the
/// energy.
const VARIES: f64 = 1e-3;

/// Part by which the force of a body whose cells have incompatible modes is too large over the square of the strain by which they bend, half
/// of the difference of those on both sides of a cell: of rings and folds of rubber with two of them through, 4 to 12.
const BENT: f64 = 5.0;

/// Such a part that is taken without a word.
const FAR: f64 = 0.05;

/// What the displacements of a cell's nodes are besides those of an even strain.
struct Rest {
    /// Where the nodes are from the middle of the cell, undeformed and as the even strain puts them.
    from: Vec<Vec3>,
    even: Vec<Vec3>,
    /// How far they are from there.
    left: Vec<Vec3>,
    /// The even strain.
    strain: f64,
}

impl Body {
    fn rest(&self, cell: usize, u: &[f64]) -> Rest {
        let view = self.mesh.cell(cell);
        let x: Vec<Vec3> = view.nodes.iter().map(|&node| self.mesh.points[node]).collect();
        let moved = |&node: &usize| {
            let mut moved = Vec3::zero();
            self.dofs.displacements(node).enumerate().for_each(|(axis, dof)| moved[axis] = u[dof]);
            moved
        };
        let moved: Vec<Vec3> = view.nodes.iter().map(moved).collect();
        let nodes: Vec<usize> = (0..x.len()).collect();
        let at_middle = |points: &[Vec3]| CellView { kind: view.kind, nodes: &nodes }.map(points, view.kind.center());
        let ((middle, mut to), (still, by)) = (at_middle(&x), at_middle(&moved));
        if view.kind.dimension == 2 {
            to[2] = Vec3::axis(2);
        }
        let gradient = Tensor2::from_fn(|i, a| by[a][i]) * Tensor2::from_fn(|i, a| to[a][i]).inverse();
        let strain = gradient.sym() + gradient.transpose() * gradient * 0.5;
        let from: Vec<Vec3> = x.iter().map(|x| *x - middle).collect();
        let even: Vec<Vec3> = from.iter().map(|from| *from + gradient * *from).collect();
        let left = (0..x.len()).map(|node| x[node] + moved[node] - middle - still - even[node]).collect();
        Rest { from, even, left, strain: strain.contract(strain).sqrt() }
    }

    /// Whether the strain of some cell varies within it at unknowns `u`, as it does in bending; in one that stretches or shears evenly no
    /// cell is too stiff. A body without strain may have bent before.
    pub fn bends(&self, u: &[f64]) -> bool {
        let (mut varies, mut most) = (0.0_f64, 0.0_f64);
        for Rest { from, left, strain, .. } in self.cells.iter().map(|&cell| self.rest(cell, u)) {
            most = most.max(strain);
            varies = left.iter().zip(&from).fold(varies, |varies, (left, from)| varies.max(left.norm() / from.norm()));
        }
        most == 0.0 || varies > VARIES * most
    }

    /// By what part the force of a body is too large whose cells have incompatible modes and bend far at unknowns `u`, where that is much:
    /// modes make the strain of a cell linear, which in a tight fold it is not.
    pub fn too_far_bent(&self, u: &[f64]) -> Option<f64> {
        let (mut energy, mut excess) = (0.0, 0.0);
        let has_modes = |&&cell: &&usize| self.shapes(self.mesh.cell(cell).kind).modes > 0;
        for &cell in self.cells.iter().filter(has_modes) {
            let Rest { even, left, strain, .. } = self.rest(cell, u);
            let bent = |[a, b]: [usize; 2]| {
                let edge = even[b] - even[a];
                (left[b] - left[a]).dot(edge).abs() / edge.dot(edge)
            };
            let square = self.mesh.cell(cell).kind.edges().map(bent).fold(0.0, f64::max).powi(2);
            // With two cells through a body that bends alone both are alike.
            energy += square.max(strain * strain) * self.mesh.measure(cell);
            excess += BENT * square * square * self.mesh.measure(cell);
        }
        Some(excess / energy).filter(|part| *part > FAR)
    }
}

/// How far the middles of a side's edges lie off the chords, along its normal.
fn arc(mesh: &Mesh, side: Side) -> f64 {
    let (kind, nodes) = mesh.side(side);
    let x: Vec<Vec3> = nodes.map(|node| mesh.points[node]).collect();
    if kind.dimension == 1 {
        return x.get(2).map_or(0.0, |&middle| (middle - (x[0] + x[1]) * 0.5).norm());
    }
    let normal = (x[1] - x[0]).cross(x[2] - x[0]).unit();
    let height = |(middle, [a, b]): (usize, [usize; 2])| (x[middle] - (x[a] + x[b]) * 0.5).dot(normal).abs();
    kind.middles().map(height).fold(0.0, f64::max)
}

/// Cells of a kind that fill a quadrilateral or a brick.
fn together(kind: &Cell) -> f64 {
    match (kind.dimension, kind.linear.nodes.len()) {
        (2, 3) | (3, 6) => 2.0,
        (3, 4) => 6.0,
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::generate::{Annulus, Block, Rectangle, Spacing};

    /// Deflections of cantilevers of `verify locking` and of ones 100 long and 2 high.
    #[test]
    fn stiffness_is_that_of_cantilevers_and_rings() {
        for (name, size, cells, found) in [
            ("tri3", [20.0, 1.0], [40, 2], 0.517),
            ("tri3", [20.0, 1.0], [40, 1], 0.255),
            ("tri3", [100.0, 2.0], [10, 8], 0.037),
            ("quad4", [100.0, 2.0], [10, 4], 0.103),
            ("quad4", [100.0, 2.0], [20, 4], 0.317),
            ("quad4", [100.0, 2.0], [50, 4], 0.763),
        ] {
            let kind = Cell::named(name).unwrap();
            let mesh = Rectangle::new([0.0; 2], size, cells, kind).mesh("b").unwrap();
            let of = Slenderness::of(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>(), [false; 3]);
            let (told, found) = (of.stiff(kind, Formulation::Standard), 1.0 / found - 1.0);
            assert!((0.7..1.4).contains(&(told / found)), "{name} {cells:?}: {told}, {found}");
        }
        // Beams of trapezoids: MacNeal's slender one, with modes, and cantilevers of bricks 20 long and 1 high, deflections over those of rectangles
        // with modes.
        let modes = Formulation::Incompatible;
        for (length, high, [cells, through], angle, formulation, found) in [
            (6.0, 0.2, [6, 1], 45.0_f64, modes, 0.05),
            (6.0, 0.2, [6, 1], 11.25, modes, 0.40),
            (20.0, 1.0, [10, 1], 10.0, modes, 0.81),
            (20.0, 1.0, [20, 1], 15.0, modes, 0.884),
            (20.0, 1.0, [20, 2], 15.0, modes, 0.860),
            (20.0, 1.0, [20, 2], 30.0, modes, 0.596),
            (20.0, 1.0, [20, 3], 15.0, Formulation::Standard, 0.646),
            (20.0, 1.0, [20, 3], 30.0, Formulation::Standard, 0.485),
        ] {
            let kind = Cell::named("quad4").unwrap();
            let mut mesh = Rectangle::new([0.0; 2], [length, high], [cells, through], kind).mesh("b").unwrap();
            let columns = cells + 1;
            for (node, x) in mesh.points.iter_mut().enumerate().filter(|(node, _)| node % columns % cells != 0) {
                let way = if node % columns % 2 == 0 { 1.0 } else { -1.0 };
                x[0] += way * (0.5 * high - x[1]) * angle.to_radians().tan();
            }
            let of = Slenderness::of(&mesh, &(0..cells * through).collect::<Vec<_>>(), [false; 3]);
            let (told, found) = (of.stiff(kind, formulation), 1.0 / found - 1.0);
            assert!((0.7..1.4).contains(&(told / found)), "{cells} {through} {angle}: {told}, {found}");
        }
        // Thin rings of radius 20 with quarters of some cells, sides of one load: (pi / 4 - 2 / pi) F R^3 / EI.
        for (name, cells, thickness, found) in [
            ("quad4", [1, 8], 0.2, 0.834),
            ("quad4", [1, 4], 0.4, 0.2505),
            ("quad4", [2, 8], 0.1, 0.5965),
            ("quad8", [1, 8], 0.4, 0.790),
            ("quad8", [1, 8], 0.2, 0.495),
            ("quad8", [4, 8], 0.4, 0.790),
            ("quad9", [1, 8], 0.4, 0.790),
            ("tri6", [1, 8], 0.2, 0.7575),
            // Poisson's ratio 0.45 to 0.499, with F-bar.
            ("quad8", [1, 8], 0.4, 1.274),
            ("quad8", [1, 8], 0.2, 3.168),
            ("quad9", [1, 8], 0.2, 3.138),
        ] {
            let kind = Cell::named(name).unwrap();
            let [radius, angle] = [
                Spacing::graded(20.0 - 0.5 * thickness, 20.0 + 0.5 * thickness, cells[0], 1.0),
                Spacing::graded(0.0, 90.0, cells[1], 1.0),
            ];
            let mesh = Annulus { centre: [0.0; 2], radius, angle, cell: kind }.mesh("b").unwrap();
            let of = Slenderness::of(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>(), [false; 3]);
            let formulation = match kind.degree {
                1 => Formulation::Incompatible,
                _ if found > 1.0 => Formulation::FBar,
                _ => Formulation::Standard,
            };
            let (told, found) = (of.stiff(kind, formulation), 1.0 / found - 1.0);
            assert!((0.7..1.4).contains(&(told / found)), "{name} {cells:?} {thickness}: {told}, {found}");
        }
        // Facets of shells, one brick through them: the hemisphere with a hole of 18 degrees (MacNeal and Harder 1985), of which 32 by 32 are 2 %
        // too stiff, and the pinched cylinder; displacements over those of hex20 with reduced integration.
        let sphere = |[along, up]: [f64; 2], deep: f64| {
            let (along, up, r) = (90.0 * along, 72.0 * up, 9.98 + 0.04 * deep);
            let [(sine, cosine), (high, wide)] = [along, up].map(|a: f64| a.to_radians().sin_cos());
            Vec3([r * wide * cosine, r * wide * sine, r * high])
        };
        let tube = |[along, up]: [f64; 2], deep: f64| {
            let ((sine, cosine), r) = ((90.0 * along).to_radians().sin_cos(), 298.5 + 3.0 * deep);
            Vec3([r * cosine, r * sine, 300.0 * up])
        };
        type Shell<'a> = (&'a dyn Fn([f64; 2], f64) -> Vec3, usize, usize, f64);
        let shells: [Shell; 5] = [
            (&sphere, 8, 1, 0.01525 / 0.0925),
            (&sphere, 16, 1, 0.0697 / 0.0925),
            (&sphere, 16, 2, 0.0698 / 0.0925),
            (&sphere, 32, 1, 0.0906 / 0.0925),
            (&tube, 12, 1, 1.272 / 1.81),
        ];
        for (place, cells, through, found) in shells {
            let kind = Cell::named("hex8").unwrap();
            let mut mesh = Block::new([0.0; 3], [1.0; 3], [cells, cells, through], kind).mesh("b").unwrap();
            mesh.points.iter_mut().for_each(|x| *x = place([x[0], x[1]], x[2]));
            let of = Slenderness::of(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>(), [false; 3]);
            let (told, found) = (of.stiff(kind, Formulation::Incompatible) + of.stretched(kind), 1.0 / found - 1.0);
            assert!((0.5..2.0).contains(&(told / found)), "{cells} {through}: {told}, {found}");
        }
        // A strip of a tube, one wide, has the length of its chords.
        let kind = Cell::named("hex8").unwrap();
        let mut mesh = Block::new([0.0; 3], [1.0; 3], [12, 1, 1], kind).mesh("b").unwrap();
        mesh.points.iter_mut().for_each(|x| *x = tube([x[0], x[1]], x[2]));
        let of = Slenderness::of(&mesh, &(0..12).collect::<Vec<_>>(), [false; 3]);
        assert_eq!(of.stretched(kind), 0.0);
        // A ring of bricks, as high as thick: reduced integration only with two beside one another, and with one through it that flows only where
        // full is wrong by more than two points are.
        for high in [1, 2] {
            let kind = Cell::named("hex20").unwrap();
            let size = [0.4, std::f64::consts::FRAC_PI_2, 0.4];
            let mut mesh = Block::new([0.0; 3], size, [1, 8, high], kind).mesh("b").unwrap();
            for x in &mut mesh.points {
                let (r, angle) = (19.8 + x[0], x[1]);
                *x = Vec3([r * angle.cos(), r * angle.sin(), x[2]]);
            }
            let of = Slenderness::of(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>(), [false; 3]);
            let told = of.stiff(kind, Formulation::Standard);
            assert!(high > 1 || (0.9..1.1).contains(&(told / (1.0 / 0.785 - 1.0))), "{told}");
            let reduces = [(0.1, false), (0.02, false), (0.1, true), (-0.2, true)]
                .map(|(part, flows)| of.reduces(kind, part, flows));
            assert_eq!(reduces, [high > 1, false, false, high > 1]);
            assert!(!of.reduces(Cell::named("hex27").unwrap(), 0.1, false));
        }
        for (name, through, soft) in
            [("hex8", 1, true), ("hex8", 2, true), ("hex8", 3, false), ("tet10", 3, true), ("tet10", 4, false)]
        {
            let kind = Cell::named(name).unwrap();
            let mesh = Block::new([0.0; 3], [50.0, 50.0, 2.0], [20, 20, through], kind).mesh("b").unwrap();
            let of = Slenderness::of(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>(), [false; 3]);
            assert_eq!(of.soft(kind, Formulation::FBar), soft, "{name} {through}: {of:?}");
        }
        // Slender beams of bricks with F-bar; Poisson's ratio 0.3, force over that of hex20 with reduced integration.
        for (cells, found) in [([20, 3, 3], 1.352), ([10, 3, 3], 2.504), ([20, 5, 5], 1.373), ([10, 5, 5], 2.526)] {
            let kind = Cell::named("hex8").unwrap();
            let mesh = Block::new([0.0; 3], [20.0, 1.0, 1.0], cells, kind).mesh("b").unwrap();
            let of = Slenderness::of(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>(), [false; 3]);
            let told = of.stiff(kind, Formulation::FBar) / (found - 1.0);
            assert!((0.9..1.1).contains(&told), "{cells:?}: {told}");
        }
    }

    /// Reduced integration leaves motions without resistance in a single quadrilateral and in a stack of bricks that is one wide: 6 in one brick
    /// of second degree and one more for each further one, none in two beside one another.
    #[test]
    fn stacks_of_bricks_keep_full_integration() {
        for (cells, alone) in [([1, 1, 1], true), ([8, 1, 1], true), ([8, 2, 1], false), ([8, 4, 1], false)] {
            let mesh = Block::new([0.0; 3], [20.0, 1.0, 1.0], cells, Cell::named("hex20").unwrap()).mesh("b").unwrap();
            let all: Vec<usize> = (0..mesh.cell_count()).collect();
            assert_eq!(Slenderness::of(&mesh, &all, [false; 3]).alone, alone, "{cells:?}");
            // As a slice between planes.
            assert_eq!(Slenderness::of(&mesh, &all, [false, false, true]).alone, cells == [1, 1, 1], "{cells:?}");
        }
        for (cells, alone) in [([1, 1], true), ([2, 1], false), ([2, 2], false)] {
            let mesh = Rectangle::new([0.0; 2], [2.0, 1.0], cells, Cell::named("quad8").unwrap()).mesh("b").unwrap();
            let all: Vec<usize> = (0..mesh.cell_count()).collect();
            assert_eq!(Slenderness::of(&mesh, &all, [false; 3]).alone, alone, "{cells:?}");
        }
    }
}
