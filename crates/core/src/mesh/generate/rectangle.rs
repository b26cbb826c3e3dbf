//! A rectangle along the axes of the plane.

use super::Spacing;
use super::lattice::{Lattice, check_cell};
use crate::error::Error;
use crate::mesh::{Cell, Mesh};
use crate::tensor::Vec3;

/// A rectangle, its sides `left`, `right` (x), `bottom`, `top` (y), its corners `bottom_left`, `bottom_right`,
/// `top_left`, `top_right`.
#[derive(Debug, Clone, PartialEq)]
pub struct Rectangle {
    /// Stations along x.
    pub x: Spacing,
    /// Stations along y.
    pub y: Spacing,
    /// A plane cell.
    pub cell: &'static Cell,
}

impl Rectangle {
    /// Equal cells between two opposite corners.
    pub fn new(from: [f64; 2], to: [f64; 2], cells: [usize; 2], cell: &'static Cell) -> Self {
        let [x, y] = [0, 1].map(|a| Spacing::uniform(from[a], to[a], cells[a]));
        Self { x, y, cell }
    }

    /// The mesh of a part called `name`.
    ///
    /// # Errors
    /// [`Error::Input`] for a cell that is not plane, a spacing that cannot be, or far too many cells.
    pub fn mesh(&self, name: &str) -> Result<Mesh, Error> {
        check_cell(name, "rectangle", self.cell, 2)?;
        let stations = [self.x.stations(&format!("{name}, x"))?, self.y.stations(&format!("{name}, y"))?];
        let ends = &[["left", "right"], ["bottom", "top"]];
        Lattice { stations: &stations, cell: self.cell, ends, closed: false, map: &Vec3 }.mesh(name)
    }
}
