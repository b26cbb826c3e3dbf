//! How long and how thick the cells of a body are, against its own thickness, and how much they taper: what cells of first degree
//! get wrong in bending.

use super::{Formulation, incompatible};
use crate::mesh::cells::Cell;
use crate::mesh::{Mesh, Side, median};

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

/// Part by which a body may be too stiff in bending without a word.
pub(super) const STIFF: f64 = 0.1;

/// Of a body's cells of first degree, simplices taken together to quadrilaterals and bricks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Slenderness {
    /// Length along the body over its thickness.
    pub along: f64,
    /// How many of them lie through it.
    pub through: f64,
    /// How much longer one of their sides along it is than the other, as the slope of those between, times their length over their
    /// own thickness.
    pub taper: f64,
}

impl Slenderness {
    /// That of some cells: the median, over their surface, of the thickness behind a side, and of the volume of the cell there over the
    /// area of the side; without sides that face an axis along which they are held.
    pub fn of(mesh: &Mesh, cells: &[usize], held: [bool; 3]) -> Self {
        let mut boundary = mesh.boundary(cells);
        boundary.retain(|&side| mesh.faces(side).is_none_or(|axis| !held[axis]));
        if boundary.is_empty() {
            return Self { along: 0.0, through: f64::INFINITY, taper: 0.0 };
        }
        let sides = boundary.iter().map(|&side| {
            let kind = mesh.cell(side.cell).kind;
            // Of a simplex over its base.
            let part = if kind.linear.nodes.len() == kind.dimension + 1 { kind.dimension as f64 } else { 1.0 };
            (part * mesh.depth(side), mesh.extent(side))
        });
        let deep = median(sides.collect());
        let volume: f64 = cells.iter().map(|&cell| mesh.measure(cell)).sum();
        let bricks: f64 = cells.iter().map(|&cell| 1.0 / together(mesh.cell(cell).kind)).sum();
        let thickness = mesh.thickness(&boundary);
        let dimension = cells.first().map_or(2, |&cell| mesh.cell(cell).kind.dimension);
        let area = volume / bricks / deep;
        let along = if dimension == 3 { area.sqrt() } else { area };
        let taper = median(boundary.iter().map(|&side| (taper(mesh, side), mesh.extent(side))).collect());
        Self { along: along / thickness, through: thickness / deep, taper }
    }

    /// By what part of its deflection a body of such cells is too stiff in bending, roughly: the shear that comes along goes with the
    /// square of their length, the stretch across that is not free with that of their thickness. The factors are those of cantilevers
    /// with one to eight cells through them, Poisson's ratio 0.3. Cells with incompatible modes bend, but as trapezoids they cannot
    /// do so without shear either, whatever passes the patch test (MacNeal 1987).
    pub fn stiff(&self, kind: &Cell, formulation: Formulation) -> f64 {
        let (long, thick) = (self.along.powi(2), self.through.powi(-2));
        match (kind.degree, formulation) {
            (1, Formulation::Incompatible) => 0.7 * self.taper.powi(2) * thick,
            (1, Formulation::FBar) if incompatible::modes(kind) > 0 => 0.35 * long,
            (1, _) if incompatible::modes(kind) > 0 => 0.35 * long + 0.3 * thick,
            (1, _) => long + 2.7 * thick,
            _ => 0.0,
        }
    }

    /// Whether one or two cells through a body share their change of volume, so that much of its stiffness in bending is lost.
    pub fn soft(&self, kind: &Cell, formulation: Formulation) -> bool {
        let barred = kind.degree == 1 && formulation == Formulation::FBar && incompatible::modes(kind) > 0;
        barred && self.through < 2.5
    }
}

/// The slope between a side of a quadrilateral or brick and the one across from it that makes the difference of their extents, times their length
/// over their distance; none of other cells.
fn taper(mesh: &Mesh, side: Side) -> f64 {
    let view = mesh.cell(side.cell);
    if incompatible::modes(view.kind) == 0 {
        return 0.0;
    }
    let own: Vec<usize> = mesh.side(side).1.collect();
    let across = (0..view.kind.faces.len()).map(|face| Side { cell: side.cell, face });
    let Some(across) = across.into_iter().find(|&other| mesh.side(other).1.all(|node| !own.contains(&node))) else {
        return 0.0;
    };
    let (near, far) = (mesh.extent(side), mesh.extent(across));
    let mean = 0.5 * (near + far);
    let (depth, length) = (mesh.measure(side.cell) / mean, if view.kind.dimension == 3 { mean.sqrt() } else { mean });
    0.5 * (near - far).abs() / mean * (length / depth).powi(2)
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
    use crate::mesh::generate::{Block, Rectangle};

    /// Deflections of cantilevers of `verify locking` and of ones 100 long and 2 high.
    #[test]
    fn stiffness_is_that_of_cantilevers() {
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
        for (through, soft) in [(1, true), (2, true), (3, false)] {
            let kind = Cell::named("hex8").unwrap();
            let mesh = Block::new([0.0; 3], [50.0, 50.0, 2.0], [20, 20, through], kind).mesh("b").unwrap();
            let of = Slenderness::of(&mesh, &(0..mesh.cell_count()).collect::<Vec<_>>(), [false; 3]);
            assert_eq!(of.soft(kind, Formulation::FBar), soft, "{through}: {of:?}");
        }
    }
}
