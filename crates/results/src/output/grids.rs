//! Frames as VTK grids: bodies, integration points, contact points, tools. Points stand where they were before any
//! motion; `displacement` moves them ("Warp By Vector").

use super::quantities::Source;
use super::quantity::{Frame, Number, Quantity, QuantityPlace, REFERENCE_POSITION};
use super::vtk::{Cells, DataArray, Grid, Values, vtk_order};
use asperity_core::Error;
use asperity_core::mesh::Mesh;
use asperity_core::tool::Pose;

/// Lines of a tool's outline leave its curves by no more than this part of its size.
const SAGITTA: f64 = 1e-4;
/// Tiles of a tool in space leave its surface by about this part of its size.
const SOLID_SAGITTA: f64 = 1e-3;

/// The grid of the bodies, whose cells and groups are the same in all frames.
#[derive(Debug, Clone)]
pub struct BodyGrid {
    points: Vec<[f64; 3]>,
    cells: Cells,
    point_masks: Vec<DataArray>,
    cell_masks: Vec<DataArray>,
}

impl BodyGrid {
    /// The grid of a mesh, with a mask for each of its groups.
    ///
    /// # Errors
    /// [`Error::Internal`] for a cell that VTK does not know.
    pub fn new(mesh: &Mesh) -> Result<Self, Error> {
        let mask = |name: &str, count: usize, members: &[usize]| {
            let mut mask = vec![0; count];
            members.iter().for_each(|&i| mask[i] = 1);
            DataArray::new(format!("group.{name}"), 1, Values::Byte(mask))
        };
        let groups = mesh.groups.iter();
        let with_cells = groups.clone().filter(|(_, group)| !group.cells.is_empty());
        Ok(Self {
            points: mesh.places().map(|place| place.0).collect(),
            cells: Cells::of_mesh(mesh)?,
            point_masks: groups.map(|(name, group)| mask(name, mesh.points.len(), &group.nodes)).collect(),
            cell_masks: with_cells.map(|(name, group)| mask(name, mesh.cell_count(), &group.cells)).collect(),
        })
    }
    /// The grid with the nodal and cell quantities of a frame, which are taken out of it.
    pub fn at(&self, frame: &mut Frame) -> Grid {
        let mut arrays =
            |place, masks: &[DataArray]| frame.take(place).map(array).chain(masks.iter().cloned()).collect();
        let (point_data, cell_data) =
            (arrays(QuantityPlace::Node, &self.point_masks), arrays(QuantityPlace::Cell, &self.cell_masks));
        Grid { time: frame.time, points: self.points.clone(), cells: self.cells.clone(), point_data, cell_data }
    }
}

/// One vertex for each integration point of a place, with the quantities there, which are taken out of the frame.
pub fn cloud(frame: &mut Frame, place: QuantityPlace) -> Grid {
    let (positions, others): (Vec<_>, Vec<_>) = frame.take(place).partition(|q| q.name == REFERENCE_POSITION);
    let points = positions.first().map_or(vec![], |q| q.values.as_chunks().0.to_vec());
    Grid {
        time: frame.time,
        cells: Cells::vertices(points.len()),
        points,
        point_data: others.into_iter().map(array).collect(),
        cell_data: Vec::new(),
    }
}

/// The bodies with their points where they are now.
pub fn deformed(grid: &Grid) -> Grid {
    let mut grid = grid.clone();
    let moved = grid.point_array("displacement").map(|array| array.values.to_real()).unwrap_or_default();
    for (point, by) in grid.points.iter_mut().zip(moved.as_chunks::<3>().0) {
        point.iter_mut().zip(by).for_each(|(x, u)| *x += u);
    }
    grid
}

/// The faces of the surfaces of all contacts, with the quantities there, which are taken out of the frame; the points are the
/// nodes of the mesh that they use.
///
/// # Errors
/// [`Error::Internal`] for a face that VTK does not know.
pub fn surfaces(source: &Source, frame: &mut Frame) -> Result<Grid, Error> {
    let mesh = source.parts.mesh;
    let mut grid = Grid { time: frame.time, ..Grid::default() };
    let (mut place, mut displacement) = (vec![usize::MAX; mesh.points.len()], Vec::new());
    for side in source.parts.contacts.iter().flat_map(|(_, _, contact)| contact.sides()) {
        let (kind, nodes) = mesh.side(side);
        let nodes: Vec<usize> = nodes.collect();
        for &node in &nodes {
            if place[node] == usize::MAX {
                place[node] = grid.points.len();
                grid.points.push(mesh.place(node).0);
                displacement.extend(source.displacement(node));
            }
        }
        let order =
            vtk_order(kind).ok_or_else(|| Error::Internal(format!("no VTK order of nodes for {}", kind.name)))?;
        grid.cells.push(kind.vtk, order.iter().map(|&i| place[nodes[i]]));
    }
    grid.point_data = vec![DataArray::new("displacement", 3, Values::Real(displacement))];
    grid.cell_data = frame.take(QuantityPlace::Face).map(array).collect();
    Ok(grid)
}

/// The outlines of the tools as lines, their material on the left.
pub fn tools(source: &Source, frame: &Frame) -> Grid {
    let mut grid = Grid { time: frame.time, ..Grid::default() };
    let (mut displacement, mut number) = (Vec::new(), Vec::new());
    for (index, tool) in source.parts.tools.iter().enumerate() {
        let (pose, sagitta) = (source.pose(index), SAGITTA * tool.size());
        let chains = tool.outline(&Pose::default(), sagitta).into_iter().zip(tool.outline(&pose, sagitta));
        for (before, now) in chains {
            let first = grid.points.len();
            displacement.extend(before.iter().zip(&now).flat_map(|(before, now)| (*now - *before).0));
            grid.points.extend(before.iter().map(|&p| (p + source.parts.mesh.origin).0));
            for end in first + 1..grid.points.len() {
                grid.cells.push(3, [end - 1, end]);
                number.push(index as i64);
            }
        }
    }
    for index in 0..source.parts.solid_tools.len() {
        solid_tool(source, index, &mut grid, (&mut displacement, &mut number));
    }
    grid.point_data = vec![DataArray::new("displacement", 3, Values::Real(displacement))];
    grid.cell_data = vec![DataArray::new("tool", 1, Values::Integer(number))];
    grid
}

/// The surface of a tool in space as triangles and quadrilaterals.
fn solid_tool(source: &Source, index: usize, grid: &mut Grid, (displacement, number): (&mut Vec<f64>, &mut Vec<i64>)) {
    let (tool, pose) = (source.parts.solid_tools[index], source.pose(index));
    let before = tool.surface(&Pose::default(), SOLID_SAGITTA * tool.size());
    let first = grid.points.len();
    for point in &before.points {
        grid.points.push((*point + source.parts.mesh.origin).0);
        displacement.extend((pose.place(tool.reference(), *point) - *point).0);
    }
    for (_, corners) in &before.tiles {
        grid.cells.push(if corners.len() == 3 { 5 } else { 9 }, corners.iter().map(|corner| first + corner));
        number.push(index as i64);
    }
}

/// A quantity as an array.
fn array(quantity: Quantity) -> DataArray {
    let values = match quantity.number {
        Number::Real => Values::Real(quantity.values),
        Number::Integer => Values::Integer(quantity.values.iter().map(|&x| x as i64).collect()),
        Number::Byte => Values::Byte(quantity.values.iter().map(|&x| x as u8).collect()),
    };
    DataArray::new(quantity.name, quantity.width.size(), values)
}
