//! VTK XML files: one `.vtu` a frame and series, gathered by a `.pvd` that is valid after every frame. Arrays are
//! binary, little-endian, appended, with 64-bit headers; ParaView, PyVista and meshio read them. Format: "VTK XML
//! Formats", docs.vtk.org. Nothing here knows what the arrays mean.

mod array;
mod grid;
mod order;
mod pvd;
mod read;
#[cfg(test)]
mod tests;
mod write;

pub use array::{DataArray, Values};
pub use grid::{Cells, Grid};
pub use order::{from_vtk, vtk_order};
pub use pvd::{PvdSeries, read_series};
pub use read::read_grid;
pub use write::Encoding;
pub(super) use write::escape;
