//! Numbers to NumPy and back, structures of serde to Python's own.

use asperity::mesh::{Cell, Group, Mesh, cells};
use asperity::output::Quantity;
use asperity::output::vtk::{Cells, DataArray, Grid, Values};
use pyo3::exceptions::PyValueError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};
use std::collections::BTreeMap;

/// A number that arrays hold: NumPy's name of its type, and its bytes.
pub trait Element: Copy {
    /// The name.
    const NAME: &'static str;
    /// The bytes, as the machine orders them.
    fn append_to(self, bytes: &mut Vec<u8>);
}

impl Element for f64 {
    const NAME: &'static str = "float64";
    fn append_to(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_ne_bytes());
    }
}

impl Element for i64 {
    const NAME: &'static str = "int64";
    fn append_to(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_ne_bytes());
    }
}

impl Element for u8 {
    const NAME: &'static str = "uint8";
    fn append_to(self, bytes: &mut Vec<u8>) {
        bytes.push(self);
    }
}

/// Numbers as an array of their own, of rows where a row is wider than one.
pub fn table<'py, T: Element>(
    py: Python<'py>,
    values: impl IntoIterator<Item = T>,
    width: usize,
) -> PyResult<Bound<'py, PyAny>> {
    let mut bytes = Vec::new();
    values.into_iter().for_each(|value| value.append_to(&mut bytes));
    let numpy = py.import(intern!(py, "numpy"))?;
    let flat = numpy.call_method1(intern!(py, "frombuffer"), (PyByteArray::new(py, &bytes), T::NAME))?;
    if width == 1 { Ok(flat) } else { flat.call_method1(intern!(py, "reshape"), (-1, width)) }
}

/// The values of a quantity: integers where they are, one row a place.
pub fn values<'py>(py: Python<'py>, quantity: &Quantity) -> PyResult<Bound<'py, PyAny>> {
    use asperity::output::Number;
    let width = quantity.width.size();
    match quantity.number {
        Number::Real => table(py, quantity.values.iter().copied(), width),
        Number::Integer => table(py, quantity.values.iter().map(|&x| x as i64), width),
        Number::Byte => table(py, quantity.values.iter().map(|&x| x as u8), width),
    }
}

/// A grid of VTK as a dict: points, connectivity, offsets, types, and the arrays on points and cells.
pub fn grid<'py>(py: Python<'py>, grid: Grid) -> PyResult<Bound<'py, PyDict>> {
    let arrays = |list: Vec<DataArray>| -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for array in list {
            let values = match array.values {
                Values::Real(values) => table(py, values, array.components),
                Values::Integer(values) => table(py, values, array.components),
                Values::Byte(values) => table(py, values, array.components),
            };
            dict.set_item(array.name, values?)?;
        }
        Ok(dict)
    };
    let dict = PyDict::new(py);
    dict.set_item("points", table(py, grid.points.into_iter().flatten(), 3)?)?;
    dict.set_item("connectivity", table(py, grid.cells.connectivity, 1)?)?;
    dict.set_item("offsets", table(py, grid.cells.offsets, 1)?)?;
    dict.set_item("types", table(py, grid.cells.types, 1)?)?;
    dict.set_item("point_data", arrays(grid.point_data)?)?;
    dict.set_item("cell_data", arrays(grid.cell_data)?)?;
    Ok(dict)
}

/// What serde writes, as dicts, lists and numbers.
pub fn plain(py: Python<'_>, value: &impl serde::Serialize) -> PyResult<Py<PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok(py.import("json")?.call_method1("loads", (text,))?.unbind())
}

/// A mesh in arrays, as `asperity._deck` hands it over: coordinates row by row, cells by kind in VTK's order of nodes, groups
/// as nodes and cells.
#[derive(FromPyObject)]
pub struct MeshArrays {
    #[pyo3(item)]
    nodes: Vec<[f64; 3]>,
    #[pyo3(item)]
    cells: Vec<(String, Vec<Vec<i64>>)>,
    #[pyo3(item)]
    groups: BTreeMap<String, (Vec<i64>, Vec<i64>)>,
}

impl MeshArrays {
    /// The mesh.
    pub fn mesh(self) -> PyResult<Mesh> {
        let mut grid = Grid { points: self.nodes, cells: Cells::default(), ..Grid::default() };
        for (name, rows) in &self.cells {
            let kind = Cell::named(name).filter(|kind| kind.dimension > 1).ok_or_else(|| unknown_cell(name))?;
            for row in rows {
                if row.len() != kind.nodes.len() {
                    let (wants, has) = (kind.nodes.len(), row.len());
                    return Err(PyValueError::new_err(format!(
                        "mesh.cells['{name}'] has {has} columns, {wants} are needed"
                    )));
                }
                let nodes = row.iter().map(|&node| index(node, grid.points.len(), || format!("mesh.cells['{name}']")));
                grid.cells.push(kind.vtk, nodes.collect::<PyResult<Vec<_>>>()?);
            }
        }
        let mut mesh = grid.to_mesh().map_err(|error| PyValueError::new_err(error.to_string()))?;
        let mut groups = BTreeMap::new();
        for (name, (nodes, cells)) in self.groups {
            let place = || format!("mesh.groups['{name}']");
            let within = |list: Vec<i64>, count| list.into_iter().map(|i| index(i, count, place)).collect();
            let (nodes, cells): (Vec<usize>, PyResult<Vec<usize>>) =
                (within(nodes, mesh.points.len())?, within(cells, mesh.cell_count()));
            let group = Group::new(&mesh, cells?, mesh.sides_among(&nodes), nodes);
            groups.insert(name, group);
        }
        mesh.groups = groups;
        Ok(mesh)
    }
}

fn index(number: i64, count: usize, place: impl Fn() -> String) -> PyResult<usize> {
    usize::try_from(number).ok().filter(|&i| i < count).ok_or_else(|| {
        PyValueError::new_err(format!("{} holds {number}; indices go from 0 to {}", place(), count.saturating_sub(1)))
    })
}

fn unknown_cell(name: &str) -> PyErr {
    let all = || cells::ALL.iter().filter(|cell| cell.dimension > 1).map(|cell| cell.name);
    let near =
        asperity::declare::nearest(name, all()).map_or(String::new(), |near| format!("; did you mean '{near}'?"));
    let all = all().collect::<Vec<_>>().join(", ");
    PyValueError::new_err(format!("mesh.cells has no kind '{name}'{near} There are: {all}"))
}
