//! Bodies, contact points and tools with everything that is stored of them at nodes, cells and contact points, for each frame.

mod points;
mod surface;

use crate::folder::{Folder, Frames};
use crate::pack::{Blobs, Packed, whole};
use asperity_core::Error;
use asperity_core::mesh::Mesh;
use asperity_results::output::vtk::Grid;
use points::{PackedPoints, Points};
use serde::Serialize;
use std::collections::BTreeMap;
use surface::{Surface, tetrahedra};

/// Characters that the packed arrays of a page may have.
const ROOM: usize = 12_000_000;
/// Values of all frames together that are read.
const VALUES: usize = 24_000_000;
/// Frames at most.
const FRAMES: usize = 200;
/// Bits of displacements and of other values, from the best down.
const PRECISIONS: [[u32; 2]; 4] = [[20, 14], [18, 12], [16, 10], [16, 8]];

/// The body of a page.
#[derive(Debug, Serialize)]
pub struct Body {
    /// Whether the model is plane or axisymmetric.
    plane: bool,
    /// Times of the frames.
    times: Vec<f64>,
    /// Frames that were written by the run.
    written: usize,
    /// Nodes and cells.
    body: PackedPoints,
    /// Numbers of the nodes in the mesh; none where all are here, in their order.
    nodes: Option<Packed>,
    /// Nodes here.
    count: usize,
    /// Cells here.
    cell_count: usize,
    /// Three nodes a triangle.
    triangles: Packed,
    /// Triangles.
    triangle_count: usize,
    /// The cell of each triangle, by its place among the cells here.
    triangle_cells: Packed,
    /// Two nodes a piece of an edge.
    edges: Packed,
    /// Pieces of edges, and those of them that bound a plane body: they come first.
    edge_count: [usize; 2],
    /// Four nodes a tetrahedron, and the cell of each: what a plane cuts. Empty for plane bodies and where only the surface
    /// is here.
    tetrahedra: Packed,
    /// Tetrahedra.
    tetrahedron_count: usize,
    /// The cell of each.
    tetrahedron_cells: Packed,
    /// Points of the contacts.
    contacts: Option<PackedPoints>,
    /// Tools.
    tools: Option<Tools>,
}

/// Tools of a page.
#[derive(Debug, Serialize)]
struct Tools {
    points: PackedPoints,
    lines: Packed,
    line_count: usize,
    triangles: Packed,
    triangle_count: usize,
}

impl Body {
    /// The body of a run, with its texts; none where no frame was written.
    ///
    /// # Errors
    /// [`Error::File`] when a frame cannot be read.
    pub fn of(folder: &Folder) -> Result<Option<(Self, Blobs)>, Error> {
        let frames = folder.frames("bodies")?;
        let Some(first) = frames.0.first().map(|(time, _)| frames.at(*time)).transpose()?.flatten() else {
            return Ok(None);
        };
        let raw = Raw::read(folder, &frames, &first)?;
        let plane = folder.summary.space != "solid";
        let mut chosen: Vec<usize> = (0..raw.times.len()).collect();
        loop {
            let thinned = raw.chosen(&chosen);
            for [motion, value] in PRECISIONS {
                let (body, blobs) = thinned.packed(plane, frames.0.len(), motion, value);
                if blobs.size() <= ROOM || (chosen.len() <= 2 && value == PRECISIONS[3][1]) {
                    return Ok(Some((body, blobs)));
                }
                // Far too much: less precision will not do.
                if blobs.size() > 2 * ROOM {
                    break;
                }
            }
            chosen = halved(&chosen);
        }
    }
}

/// Every second of a list, counted from its end, and its first.
fn halved(list: &[usize]) -> Vec<usize> {
    let last = list.len() - 1;
    let kept = list.iter().enumerate().filter(|(i, _)| *i == 0 || (last - i).is_multiple_of(2));
    let mut kept: Vec<usize> = kept.map(|(_, frame)| *frame).collect();
    if kept.len() == list.len() && kept.len() > 2 {
        kept.remove(1);
    }
    kept
}

/// Everything before it is packed.
struct Raw {
    times: Vec<f64>,
    mesh: Mesh,
    /// Nodes and cells that are kept.
    nodes: Vec<usize>,
    cells: Vec<usize>,
    surface: Surface,
    whole: bool,
    body: Points,
    contacts: Points,
    tools: Points,
    lines: Vec<u32>,
    tiles: Vec<u32>,
}

impl Raw {
    fn read(folder: &Folder, frames: &Frames, first: &Grid) -> Result<Self, Error> {
        let mesh = first.to_mesh()?;
        let surface = Surface::of(&mesh);
        let size = |grid: &Grid, nodes: usize, cells: usize| {
            let sum = |arrays: &[asperity_results::output::vtk::DataArray]| {
                arrays.iter().filter(|a| !a.name.starts_with("group.")).map(|a| a.components).sum::<usize>()
            };
            nodes * sum(&grid.point_data) + cells * sum(&grid.cell_data)
        };
        let count = frames.0.len().min(FRAMES);
        let solid = folder.summary.space == "solid";
        let whole = !solid || size(first, mesh.points.len(), mesh.cell_count()) * count <= VALUES;
        let (nodes, cells) = if whole {
            ((0..mesh.points.len()).collect(), (0..mesh.cell_count()).collect())
        } else {
            (sorted(surface.triangles.iter().flatten().copied()), sorted(surface.cells.iter().copied()))
        };
        let most = (VALUES / size(first, nodes.len(), cells.len()).max(1)).clamp(2, FRAMES);
        let mut chosen: Vec<usize> = (0..frames.0.len()).collect();
        while chosen.len() > most {
            chosen = halved(&chosen);
        }
        let times: Vec<f64> = chosen.iter().map(|&frame| frames.0[frame].0).collect();
        let (contact_frames, tool_frames) = (folder.frames("contacts")?, folder.frames("tools")?);
        let (mut body, mut contacts, mut tools) = (Points::default(), Points::default(), Points::default());
        let (mut lines, mut tiles) = (Vec::new(), Vec::new());
        for &time in &times {
            let grid = frames.at(time)?.unwrap_or_default();
            body.add(&grid, Some((&nodes, &cells)));
            contacts.add(&contact_frames.at(time)?.unwrap_or_default(), None);
            let grid = tool_frames.at(time)?.unwrap_or_default();
            (lines, tiles) = shapes(&grid);
            tools.add(&grid, None);
        }
        Ok(Self { times, mesh, nodes, cells, surface, whole, body, contacts, tools, lines, tiles })
    }

    /// The same with these frames only.
    fn chosen(&self, frames: &[usize]) -> Thinned<'_> {
        Thinned {
            raw: self,
            times: frames.iter().map(|&frame| self.times[frame]).collect(),
            body: self.body.chosen(frames),
            contacts: self.contacts.chosen(frames),
            tools: self.tools.chosen(frames),
        }
    }
}

/// Some of the frames.
struct Thinned<'a> {
    raw: &'a Raw,
    times: Vec<f64>,
    body: Points,
    contacts: Points,
    tools: Points,
}

impl Thinned<'_> {
    fn packed(&self, plane: bool, written: usize, motion: u32, value: u32) -> (Body, Blobs) {
        let raw = self.raw;
        let mut blobs = Blobs::default();
        let place = |list: &[usize]| list.iter().enumerate().map(|(i, &n)| (n, i as u32)).collect::<BTreeMap<_, _>>();
        let (nodes, cells) = (place(&raw.nodes), place(&raw.cells));
        let node = |n: &usize| nodes.get(n).copied().unwrap_or(0);
        let mut ints = |values: Vec<u32>| blobs.take(whole(&values));
        let triangles = ints(raw.surface.triangles.iter().flatten().map(node).collect());
        let triangle_cells = ints(raw.surface.cells.iter().map(|c| cells.get(c).copied().unwrap_or(0)).collect());
        let edges = ints(raw.surface.edges.iter().flatten().map(node).collect());
        let (mut corners, mut of) = (Vec::new(), Vec::new());
        for (at, &cell) in raw.cells.iter().enumerate().filter(|_| raw.whole && !plane) {
            let view = raw.mesh.cell(cell);
            for tetrahedron in tetrahedra(view.kind) {
                corners.extend(tetrahedron.iter().map(|&i| node(&view.nodes[i])));
                of.push(at as u32);
            }
        }
        let (tetrahedron_count, tetrahedra, tetrahedron_cells) = (of.len(), ints(corners), ints(of));
        let numbers = (!raw.whole).then(|| ints(raw.nodes.iter().map(|&n| n as u32).collect()));
        let tools = (!self.tools.is_empty()).then(|| Tools {
            lines: blobs.take(whole(&raw.lines)),
            line_count: raw.lines.len() / 2,
            triangles: blobs.take(whole(&raw.tiles)),
            triangle_count: raw.tiles.len() / 3,
            points: self.tools.packed(plane, 20, value, &mut blobs),
        });
        let body = Body {
            plane,
            times: self.times.clone(),
            written,
            body: self.body.packed(plane, motion, value, &mut blobs),
            nodes: numbers,
            count: raw.nodes.len(),
            cell_count: raw.cells.len(),
            triangles,
            triangle_count: raw.surface.triangles.len(),
            triangle_cells,
            edges,
            edge_count: [raw.surface.edges.len(), if plane { raw.surface.boundary } else { 0 }],
            tetrahedra,
            tetrahedron_count,
            tetrahedron_cells,
            contacts: (!self.contacts.is_empty())
                .then(|| self.contacts.packed(plane, motion.max(18), value.max(12), &mut blobs)),
            tools,
        };
        (body, blobs)
    }
}

fn sorted(list: impl Iterator<Item = usize>) -> Vec<usize> {
    let mut list: Vec<usize> = list.collect();
    list.sort_unstable();
    list.dedup();
    list
}

/// Lines and triangles of the tools, by point.
fn shapes(grid: &Grid) -> (Vec<u32>, Vec<u32>) {
    let (mut lines, mut tiles) = (Vec::new(), Vec::new());
    for (_, nodes) in grid.cells.iter().flatten() {
        let nodes: Vec<u32> = nodes.iter().filter_map(|&n| u32::try_from(n).ok()).collect();
        match nodes[..] {
            [a, b] => lines.extend([a, b]),
            [a, b, c] => tiles.extend([a, b, c]),
            [a, b, c, d] => tiles.extend([a, b, c, a, c, d]),
            _ => {}
        }
    }
    (lines, tiles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_the_first_and_the_last_and_comes_to_an_end() {
        let mut list: Vec<usize> = (0..21).collect();
        for _ in 0..8 {
            list = halved(&list);
            assert!(list[0] == 0 && list[list.len() - 1] == 20, "{list:?}");
        }
        assert_eq!(list, [0, 20]);
        assert_eq!(halved(&[0, 1, 2]), [0, 2]);
        assert_eq!(halved(&[0]), [0]);
    }
}
