//! An unstructured grid in VTK's terms: points, cells in VTK's order, arrays on both.

use super::array::{DataArray, Values};
use super::order::{from_vtk, vtk_order};
use asperity_core::Error;
use asperity_core::mesh::Mesh;
use asperity_core::tensor::Vec3;

/// A grid with its arrays, as one file holds it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Grid {
    /// The time it belongs to.
    pub time: f64,
    /// Points.
    pub points: Vec<[f64; 3]>,
    /// Cells.
    pub cells: Cells,
    /// Arrays with one tuple a point.
    pub point_data: Vec<DataArray>,
    /// Arrays with one tuple a cell.
    pub cell_data: Vec<DataArray>,
}

/// Cells by their nodes in VTK's order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cells {
    /// Nodes of all cells, one after another.
    pub connectivity: Vec<i64>,
    /// Where each cell ends in `connectivity`.
    pub offsets: Vec<i64>,
    /// VTK type of each cell.
    pub types: Vec<u8>,
}

impl Cells {
    /// The cells of a mesh.
    ///
    /// # Errors
    /// [`Error::Internal`] for a cell that VTK does not know.
    pub fn of_mesh(mesh: &Mesh) -> Result<Self, Error> {
        let mut cells = Self::default();
        for view in (0..mesh.cell_count()).map(|c| mesh.cell(c)) {
            let order = vtk_order(view.kind)
                .ok_or_else(|| Error::Internal(format!("no VTK order of nodes for the cell {}", view.kind.name)))?;
            cells.push(view.kind.vtk, order.iter().map(|&i| view.nodes[i]));
        }
        Ok(cells)
    }
    /// One vertex for each of `count` points.
    pub fn vertices(count: usize) -> Self {
        let mut cells = Self::default();
        for point in 0..count {
            cells.push(1, [point]);
        }
        cells
    }
    /// Adds a cell.
    pub fn push(&mut self, vtk: u8, nodes: impl IntoIterator<Item = usize>) {
        self.connectivity.extend(nodes.into_iter().map(|n| n as i64));
        self.offsets.push(self.connectivity.len() as i64);
        self.types.push(vtk);
    }
    /// Number of cells.
    pub fn len(&self) -> usize {
        self.types.len()
    }
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.types.is_empty()
    }
    /// Type and nodes of each cell; none when the tables do not fit together.
    pub fn iter(&self) -> impl Iterator<Item = Option<(u8, &[i64])>> {
        let starts = std::iter::once(0).chain(self.offsets.iter().copied());
        let spans = starts.zip(self.offsets.iter().copied());
        self.types.iter().zip(spans).map(|(&vtk, (start, end))| {
            let range = usize::try_from(start).ok()?..usize::try_from(end).ok()?;
            Some((vtk, self.connectivity.get(range)?))
        })
    }
}

impl Grid {
    /// An array on the points.
    pub fn point_array(&self, name: &str) -> Option<&DataArray> {
        self.point_data.iter().find(|array| array.name == name)
    }
    /// An array on the cells.
    pub fn cell_array(&self, name: &str) -> Option<&DataArray> {
        self.cell_data.iter().find(|array| array.name == name)
    }
    /// The mesh, with its cells in our order of nodes and without groups.
    ///
    /// # Errors
    /// [`Error::Input`] when a cell is of a type that we do not write, or names a point that is not there.
    pub fn to_mesh(&self) -> Result<Mesh, Error> {
        let mut mesh = Mesh::new();
        mesh.points = self.points.iter().map(|&p| Vec3(p)).collect();
        for (index, cell) in self.cells.iter().enumerate() {
            let (kind, nodes) = cell
                .and_then(|(vtk, nodes)| self.ours(vtk, nodes))
                .ok_or_else(|| Error::input(format!("cell {index} of the grid is of no known kind")))?;
            mesh.push_cell(kind, &nodes);
        }
        Ok(mesh)
    }
    fn ours(&self, vtk: u8, nodes: &[i64]) -> Option<(&'static asperity_core::mesh::Cell, Vec<usize>)> {
        let (kind, order) = from_vtk(vtk)?;
        let mut own = vec![0; order.len()];
        for (place, &node) in order.iter().zip((nodes.len() == order.len()).then_some(nodes)?) {
            own[*place] = usize::try_from(node).ok().filter(|&n| n < self.points.len())?;
        }
        Some((kind, own))
    }
    /// Coordinates as one array.
    pub(super) fn coordinates(&self) -> DataArray {
        DataArray::new("Points", 3, Values::Real(self.points.as_flattened().to_vec()))
    }
}
