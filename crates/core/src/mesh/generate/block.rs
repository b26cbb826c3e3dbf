//! A box along the axes of space.

use super::Spacing;
use super::lattice::{Lattice, check_cell};
use crate::error::Error;
use crate::mesh::{Cell, Mesh};
use crate::tensor::Vec3;

/// A box, its sides `left`, `right` (x), `bottom`, `top` (y), `back`, `front` (z, which points at the viewer), its
/// corners `back_bottom_left` to `front_top_right`.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Stations along x.
    pub x: Spacing,
    /// Stations along y.
    pub y: Spacing,
    /// Stations along z.
    pub z: Spacing,
    /// A solid cell.
    pub cell: &'static Cell,
}

impl Block {
    /// Equal cells between two opposite corners.
    pub fn new(from: [f64; 3], to: [f64; 3], cells: [usize; 3], cell: &'static Cell) -> Self {
        let [x, y, z] = [0, 1, 2].map(|a| Spacing::uniform(from[a], to[a], cells[a]));
        Self { x, y, z, cell }
    }

    /// The mesh of a part called `name`.
    ///
    /// # Errors
    /// [`Error::Input`] for a cell that is not solid, a spacing that cannot be, or far too many cells.
    pub fn mesh(&self, name: &str) -> Result<Mesh, Error> {
        check_cell(name, "box", self.cell, 3)?;
        let along = |axis: &str, spacing: &Spacing| spacing.stations(&format!("{name}, {axis}"));
        let stations = [along("x", &self.x)?, along("y", &self.y)?, along("z", &self.z)?];
        let ends = &[["left", "right"], ["bottom", "top"], ["back", "front"]];
        Lattice { stations: &stations, cell: self.cell, ends, closed: false, map: &Vec3 }.mesh(name)
    }
}
