//! The core of all generators: a lattice of bricks, tiled, mapped point by point and grouped by its sides.

use super::tiling::tiling;
use crate::error::Error;
use crate::mesh::{Cell, Group, Mesh, Side};
use crate::tensor::Vec3;

/// More nodes of cells than this, each counted in every cell, are taken for a slip of the pen; the memory of a common
/// machine would not hold them either.
const MOST_NODES: usize = 50_000_000;

/// A lattice of bricks: stations along each direction, one station along the third of a plane part.
pub(super) struct Lattice<'a> {
    pub stations: &'a [Vec<f64>],
    pub cell: &'static Cell,
    /// The names of the two ends along each direction.
    pub ends: &'a [[&'static str; 2]],
    /// Whether the last station of the second direction is the first again.
    pub closed: bool,
    /// From stations to space.
    pub map: &'a dyn Fn([f64; 3]) -> Vec3,
}

/// Refuses cells that cannot tile the part, by name.
pub(super) fn check_cell(name: &str, part: &str, cell: &Cell, dimension: usize) -> Result<(), Error> {
    if cell.dimension == dimension && !tiling(cell).is_empty() {
        return Ok(());
    }
    let fits = |cell: &&Cell| cell.dimension == dimension && !tiling(cell).is_empty();
    let names: Vec<&str> = crate::mesh::cells::ALL.iter().copied().filter(fits).map(|cell| cell.name).collect();
    let choice = names.join(", ");
    Err(Error::input(format!("{name}: a {part} cannot be made of '{}'; choose one of {choice}", cell.name)))
}

impl Lattice<'_> {
    /// The mesh with its groups, all names beginning with `name`.
    pub(super) fn mesh(&self, name: &str) -> Result<Mesh, Error> {
        let of_brick = tiling(self.cell).iter().map(|tile| tile.len()).sum();
        let nodes = (0..3).try_fold(of_brick, |product: usize, a| product.checked_mul(self.bricks(a)));
        if nodes.is_none_or(|nodes| nodes > MOST_NODES) {
            let bricks: Vec<String> = (0..self.stations.len()).map(|axis| self.bricks(axis).to_string()).collect();
            let what = format!("{name}: {} cells are too many for one mesh", bricks.join(" times "));
            return Err(Error::input(format!("{what}; use fewer along each direction")));
        }
        let (mesh, corners) = self.cells();
        Ok(self.grouped(mesh, &corners, name))
    }

    fn bricks(&self, axis: usize) -> usize {
        self.stations.get(axis).map_or(1, |stations| stations.len() - 1)
    }

    /// Lattice points along a direction, half steps included; one along the missing direction of a plane part.
    fn size(&self, axis: usize) -> usize {
        self.stations.get(axis).map_or(1, |stations| 2 * stations.len() - 1)
    }

    fn wraps(&self, axis: usize) -> bool {
        self.closed && axis == 1
    }

    fn coordinate(&self, axis: usize, step: usize) -> f64 {
        let Some(stations) = self.stations.get(axis) else { return 0.0 };
        match step % 2 {
            0 => stations[step / 2],
            _ => 0.5 * (stations[step / 2] + stations[step / 2 + 1]),
        }
    }

    /// All cells, and beside each node of each cell its lattice point.
    fn cells(&self) -> (Mesh, Vec<[usize; 3]>) {
        let mut lattice = Vec::new();
        let tiles = tiling(self.cell);
        for k in 0..self.bricks(2) {
            for j in 0..self.bricks(1) {
                for i in 0..self.bricks(0) {
                    for point in tiles.iter().flatten() {
                        lattice.push([2 * i + point[0], 2 * j + point[1], 2 * k + point[2]]);
                    }
                }
            }
        }
        (self.numbered(&lattice), lattice)
    }

    /// Numbers the lattice points that cells use, row by row, and maps them to space.
    fn numbered(&self, lattice: &[[usize; 3]]) -> Mesh {
        const UNUSED: usize = usize::MAX;
        let mut numbers = vec![UNUSED; (0..3).map(|a| self.size(a)).product()];
        for &point in lattice {
            numbers[self.index(point)] = 0;
        }
        let mut mesh = Mesh::new();
        for (index, number) in numbers.iter_mut().enumerate().filter(|(_, number)| **number != UNUSED) {
            *number = mesh.points.len();
            let (i, rest) = (index % self.size(0), index / self.size(0));
            let steps = [i, rest % self.size(1), rest / self.size(1)];
            mesh.points.push((self.map)(std::array::from_fn(|a| self.coordinate(a, steps[a]))));
        }
        for cell in lattice.chunks(self.cell.nodes.len()) {
            let nodes: Vec<usize> = cell.iter().map(|&point| numbers[self.index(point)]).collect();
            mesh.push_cell(self.cell, &nodes);
        }
        mesh
    }

    /// Place of a lattice point among all; the last row of a closed direction is the first.
    fn index(&self, mut point: [usize; 3]) -> usize {
        if self.closed && point[1] + 1 == self.size(1) {
            point[1] = 0;
        }
        point[0] + self.size(0) * (point[1] + self.size(1) * point[2])
    }

    fn grouped(&self, mut mesh: Mesh, lattice: &[[usize; 3]], name: &str) -> Mesh {
        let all = Group::new(&mesh, (0..mesh.cell_count()).collect(), vec![], vec![]);
        let mut groups = vec![(name.to_string(), all)];
        for (axis, ends) in self.ends.iter().enumerate().filter(|&(axis, _)| !self.wraps(axis)) {
            for (&end, step) in ends.iter().zip([0, self.size(axis) - 1]) {
                let on_end = |point: &[usize; 3]| point[axis] == step;
                let sides = sides_where(&mesh, lattice, on_end);
                groups.push((format!("{name}.{end}"), Group::new(&mesh, vec![], sides, vec![])));
            }
        }
        if !self.closed {
            self.corners(&mesh, lattice, name, &mut groups);
        }
        mesh.groups.extend(groups);
        mesh
    }

    /// One group of one node for each corner, named by the ends that meet there, the last direction first:
    /// `bottom_left`, `front_top_right`.
    fn corners(&self, mesh: &Mesh, lattice: &[[usize; 3]], name: &str, groups: &mut Vec<(String, Group)>) {
        for corner in 0..1usize << self.ends.len() {
            let end = |axis: usize| corner >> axis & 1;
            let steps: Vec<usize> = (0..self.ends.len()).map(|a| end(a) * (self.size(a) - 1)).collect();
            let words: Vec<&str> = (0..self.ends.len()).rev().map(|a| self.ends[a][end(a)]).collect();
            let place = lattice.iter().position(|point| steps.iter().zip(point).all(|(s, p)| s == p));
            let nodes = place.map(|place| mesh.nodes[place]).into_iter().collect();
            groups.push((format!("{name}.{}", words.join("_")), Group::new(mesh, vec![], vec![], nodes)));
        }
    }
}

/// Sides whose nodes all lie on lattice points that pass a test.
fn sides_where(mesh: &Mesh, lattice: &[[usize; 3]], test: impl Fn(&[usize; 3]) -> bool) -> Vec<Side> {
    let mut sides = Vec::new();
    for cell in 0..mesh.cell_count() {
        let points = &lattice[mesh.starts[cell]..mesh.starts[cell + 1]];
        for (face, nodes) in mesh.kinds[cell].faces.iter().map(|face| face.nodes).enumerate() {
            if nodes.iter().all(|&node| test(&points[node])) {
                sides.push(Side { cell, face });
            }
        }
    }
    sides
}
