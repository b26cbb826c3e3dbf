//! How long and how thick the cells of a body are, against its own thickness, how much they taper and how far they are curved: what
//! cells get wrong in bending.

use super::{Formulation, incompatible};
use crate::mesh::cells::Cell;
use crate::mesh::{Mesh, Side, median};
use crate::tensor::Vec3;
use std::collections::{BTreeMap, BTreeSet};

/// By what part some cells of first degree are too stiff in bending by the simplices or prisms among them, where that is much: that
/// of a body of these alone, times their part of it.
pub fn too_stiff(mesh: &Mesh, cells: &[usize]) -> Option<f64> {
    let plain = |&cell: &usize| incompatible::modes(mesh.kinds[cell]) == 0;
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

/// Of a body's cells, simplices taken together to quadrilaterals and bricks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slenderness {
    /// Length along the body over its thickness.
    pub along: f64,
    /// How many of them lie through it.
    pub through: f64,
    /// How much longer one of their sides along it is than the other, as half the slope of those between, times their length over their
    /// own thickness; where neighbours taper the same way, as around a curved body, that times the slope and a factor.
    pub taper: f64,
    /// Height of their arcs over the thickness, root of the mean square over both surfaces of a body of that; zero in first degree.
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
        let taper = median(tapers(mesh, &boundary));
        let squares: f64 = boundary.iter().map(|&side| arc(mesh, side).powi(2) * mesh.extent(side)).sum();
        let arc = (squares / (2.0 * volume * thickness)).sqrt();
        let through = thickness / deep(mesh, &boundary);
        Self { along: along / thickness, through, taper, arc, alone: alone(mesh, &boundary) }
    }

    /// By what part of its deflection a body of such cells is too stiff in bending, roughly: the shear that comes along goes with the
    /// square of their length, the stretch across that is not free with that of their thickness. The factors are those of cantilevers
    /// with one to eight cells through them, Poisson's ratio 0.3. Cells with incompatible modes bend, but as trapezoids they cannot
    /// do so without shear either, whatever passes the patch test (MacNeal 1987). Curved cells of second degree stretch along their
    /// middle as they bend, against which full integration resists (membrane locking, Stolarski and Belytschko 1983): the factors are
    /// those of rings. With F-bar and one cell through them they lose stiffness instead, a part that is negative here; with more cells
    /// that is a bound of what they lose or win.
    pub fn stiff(&self, kind: &Cell, formulation: Formulation) -> f64 {
        let (long, thick) = (self.along.powi(2), self.through.powi(-2));
        match (kind.degree, formulation) {
            (1, Formulation::Incompatible) => 0.7 * self.taper.powi(2) * thick,
            (1, Formulation::FBar) if incompatible::modes(kind) > 0 => 0.35 * long,
            (1, _) if incompatible::modes(kind) > 0 => 0.35 * long + 0.3 * thick,
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

    /// Whether reduced integration serves cells of a kind that full integration makes wrong in bending by some part: quadrilaterals and bricks
    /// of second degree without a node in the middle, for those with one have a mechanism, as bricks have in a stack that is one wide.
    /// With one of them through a body that `flows` two points carry too much of it.
    pub fn reduces(&self, kind: &Cell, wrong: f64, flows: bool) -> bool {
        let least = if flows && self.through < 1.5 { TWO_POINTS } else { CURVED };
        matches!(kind.name, "quad8" | "hex20") && !self.alone && wrong.abs() > least
    }

    /// Whether cells through a body share their change of volume, so that much of its stiffness in bending is lost: one or two
    /// quadrilaterals or bricks of first degree, one tetrahedron of second.
    pub fn soft(&self, kind: &Cell, formulation: Formulation) -> bool {
        let few = match (kind.degree, together(kind)) {
            (1, 1.0) => 2.5,
            (2, 6.0) => 1.5,
            _ => 0.0,
        };
        formulation == Formulation::FBar && self.through < few
    }

    /// By what part tetrahedra of second degree, one through a body of a law that keeps its volume, are too stiff in bending without F-bar:
    /// that of cantilevers of Poisson's ratio 0.499 and of metal that flows, with cells once and twice as long as they are thick.
    pub fn plain(&self) -> f64 {
        0.05 * self.along.powi(2)
    }
}

/// Square of what a cell that tapers as its neighbours do is stiffer in bending than one among those that taper against it, over that of
/// its slope: of rings with 4 to 16 cells a quarter.
const TOGETHER: f64 = 1.6;

/// What sides of the boundary taper, in the measure of [`Slenderness::taper`], with their extents.
fn tapers(mesh: &Mesh, boundary: &[Side]) -> Vec<(f64, f64)> {
    let own: Vec<[f64; 2]> = boundary.iter().map(|&side| taper(mesh, side)).collect();
    let mut rims = BTreeMap::<Vec<usize>, Vec<usize>>::new();
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
    for (number, side) in boundary.iter().enumerate() {
        rims_of(side).into_iter().for_each(|rim| rims.entry(rim).or_default().push(number));
    }
    let of = |(side, [taper, slope]): (&Side, &[f64; 2])| {
        let beside = rims_of(side).into_iter().flat_map(|rim| rims[&rim].clone()).map(|other| own[other][0]);
        let against = beside.filter(|other| other * taper < 0.0).map(|other| 0.5 * (taper - other).abs());
        let against = against.fold(0.0, f64::max);
        let measure = if against > 0.0 { against } else { TOGETHER.sqrt() * (taper * slope).abs() };
        (measure, mesh.extent(*side))
    };
    boundary.iter().zip(&own).map(of).collect()
}

/// The slope between a side of a quadrilateral or brick and the one across from it that makes the difference of their extents, half of it
/// times their length over their distance and it alone; none of other cells.
fn taper(mesh: &Mesh, side: Side) -> [f64; 2] {
    let view = mesh.cell(side.cell);
    if incompatible::modes(view.kind) == 0 {
        return [0.0; 2];
    }
    let Some(across) = across(mesh, side) else { return [0.0; 2] };
    let (near, far) = (mesh.extent(side), mesh.extent(across));
    let mean = 0.5 * (near + far);
    let (depth, length) = (mesh.measure(side.cell) / mean, if view.kind.dimension == 3 { mean.sqrt() } else { mean });
    let slope = (near - far) / mean * length / depth;
    [0.5 * slope * length / depth, slope]
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

/// Length of a side: of a quadrilateral the longer one between the middles of its edges, of a triangle the root of twice its area.
fn length(mesh: &Mesh, side: Side) -> f64 {
    let (kind, nodes) = mesh.side(side);
    let x: Vec<Vec3> = nodes.map(|node| mesh.points[node]).collect();
    match kind.linear.nodes.len() {
        4 => 0.5 * (x[1] + x[2] - x[0] - x[3]).norm().max((x[2] + x[3] - x[0] - x[1]).norm()),
        3 => (2.0 * mesh.extent(side)).sqrt(),
        _ => mesh.extent(side),
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
        // MacNeal's slender beam of six trapezoids, with modes.
        for (angle, found) in [(45.0_f64, 0.05), (11.25, 0.40)] {
            let kind = Cell::named("quad4").unwrap();
            let mut mesh = Rectangle::new([0.0; 2], [6.0, 0.2], [6, 1], kind).mesh("b").unwrap();
            for (node, x) in mesh.points.iter_mut().enumerate().filter(|(node, _)| !matches!(node % 7, 0 | 6)) {
                let way = if node % 7 % 2 == node / 7 { 0.1 } else { -0.1 };
                x[0] += way * angle.to_radians().tan();
            }
            let of = Slenderness::of(&mesh, &(0..6).collect::<Vec<_>>(), [false; 3]);
            let (told, found) = (of.stiff(kind, Formulation::Incompatible), 1.0 / found - 1.0);
            assert!((0.3..1.5).contains(&(told / found)), "{angle}: {told}, {found}");
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
            [("hex8", 1, true), ("hex8", 2, true), ("hex8", 3, false), ("tet10", 1, true), ("tet10", 2, false)]
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
