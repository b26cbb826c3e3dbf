//! Which edges or faces of cells lie outside, which lie between two cells, and which cell stands behind given nodes.
//!
//! Two faces are the same if they have the same corners; the mid-side nodes of conforming cells follow from that, and
//! the lint reports where they do not. Every side looks outward as its cell does, so a boundary is oriented by the
//! cells behind it.

use super::{Group, Mesh, Side};
use crate::declare::nearest;
use crate::error::Error;

/// The sorted corners of an edge or face; unused places hold `usize::MAX`.
type Key = [usize; 4];

/// All edges or faces of a set of cells, found by their corners.
#[derive(Debug, Clone)]
pub struct Faces {
    sorted: Vec<(Key, Side)>,
}

/// The cells found behind an edge or face that is given by its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Behind {
    /// No cell: the element stands for itself.
    Nothing,
    /// One cell: it is a side of the boundary.
    One(Side),
    /// A cell on either side: it lies inside the mesh, and which side is meant is open.
    Two([Side; 2]),
    /// More than two cells: the mesh overlaps itself.
    Many(usize),
}

fn key(corners: impl Iterator<Item = usize>) -> Key {
    let mut key = [usize::MAX; 4];
    key.iter_mut().zip(corners).for_each(|(place, corner)| *place = corner);
    key.sort_unstable();
    key
}

/// Sorts faces: first into one bucket for each least corner, then inside the buckets, which are small.
fn sorted_by_bucket(listed: Vec<(Key, Side)>, nodes: usize) -> Vec<(Key, Side)> {
    let mut starts = vec![0; nodes + 1];
    listed.iter().for_each(|(key, _)| starts[key[0] + 1] += 1);
    (1..starts.len()).for_each(|node| starts[node] += starts[node - 1]);
    let mut sorted = listed.clone();
    for entry in listed {
        let place = &mut starts[entry.0[0]];
        sorted[*place] = entry;
        *place += 1;
    }
    sorted.chunk_by_mut(|one, other| one.0[0] == other.0[0]).for_each(<[_]>::sort_unstable);
    sorted
}

impl Faces {
    /// The edges or faces of some cells of a mesh.
    pub fn of(mesh: &Mesh, cells: impl IntoIterator<Item = usize>) -> Self {
        Self::renamed(mesh, cells, |node| node)
    }

    /// The same after nodes have been given other names, with which coincident nodes can be made one.
    pub(super) fn renamed(
        mesh: &Mesh,
        cells: impl IntoIterator<Item = usize>,
        rename: impl Fn(usize) -> usize,
    ) -> Self {
        let mut listed = Vec::new();
        for cell in cells {
            for (face, reference) in mesh.kinds[cell].faces.iter().enumerate() {
                let side = Side { cell, face };
                let corners = mesh.side(side).1.take(reference.cell.linear.nodes.len());
                listed.push((key(corners.map(&rename)), side));
            }
        }
        Self { sorted: sorted_by_bucket(listed, mesh.points.len()) }
    }

    /// Sides with one cell behind them, in the order of cells and faces.
    pub fn outer(&self) -> Vec<Side> {
        let mut outer: Vec<Side> = self.runs().filter(|run| run.len() == 1).map(|run| run[0].1).collect();
        outer.sort_unstable();
        outer
    }

    /// Sides that share their corners, run by run.
    pub(super) fn runs(&self) -> impl Iterator<Item = &[(Key, Side)]> {
        self.sorted.chunk_by(|one, other| one.0 == other.0)
    }

    /// The cells behind the edge or face with these corners, in any order.
    pub fn behind(&self, corners: &[usize]) -> Behind {
        let key = key(corners.iter().copied());
        let start = self.sorted.partition_point(|entry| entry.0 < key);
        let run = self.sorted[start..].iter().take_while(|entry| entry.0 == key).count();
        match self.sorted[start..start + run] {
            [] => Behind::Nothing,
            [(_, side)] => Behind::One(side),
            [(_, one), (_, other)] => Behind::Two([one, other]),
            _ => Behind::Many(run),
        }
    }
}

impl Mesh {
    /// The outer sides of a set of cells: those that no other cell of the set shares.
    pub fn boundary(&self, cells: &[usize]) -> Vec<Side> {
        Faces::of(self, cells.iter().copied()).outer()
    }

    /// The outer sides all of whose nodes are among these: the surface that a set of nodes means.
    pub fn sides_among(&self, nodes: &[usize]) -> Vec<Side> {
        let mut chosen = vec![false; self.points.len()];
        nodes.iter().for_each(|&node| chosen[node] = true);
        let mut sides = Faces::of(self, 0..self.cell_count()).outer();
        sides.retain(|&side| self.side(side).1.all(|node| chosen[node]));
        sides
    }

    /// A group by its name.
    ///
    /// # Errors
    /// [`Error::Input`] with the nearest name if there is none.
    pub fn group(&self, name: &str) -> Result<&Group, Error> {
        self.groups.get(name).ok_or_else(|| {
            let hint = match nearest(name, self.groups.keys().map(String::as_str)) {
                Some(near) => format!("did you mean '{near}'?"),
                None if self.groups.is_empty() => "the mesh has no groups at all".into(),
                None => format!("there are: {}", self.groups.keys().cloned().collect::<Vec<_>>().join(", ")),
            };
            Error::input(format!("the mesh has no group '{name}'; {hint}"))
        })
    }

    /// The sides of a group that is to be a surface of contact or load.
    ///
    /// # Errors
    /// [`Error::Input`] if there is no such group, if it holds no sides, or if some of them lie inside the mesh with
    /// a cell on either side.
    pub fn surface(&self, name: &str) -> Result<&[Side], Error> {
        let group = self.group(name)?;
        let refuse = |why: String| Err(Error::input(format!("group '{name}' {why}")));
        if let Some([one, other]) = group.inner.first() {
            let (count, cells) = (group.inner.len(), [self.cell_number(one.cell), self.cell_number(other.cell)]);
            return refuse(format!(
                "is no surface: {count} of its faces lie inside the mesh, the first between cells {} and {}; choose \
                 faces of the outer boundary, or give the two bodies nodes of their own",
                cells[0], cells[1]
            ));
        }
        match group.sides.is_empty() {
            false => Ok(&group.sides),
            true if !group.cells.is_empty() => refuse("holds cells, not a surface; name a group of their sides".into()),
            true => refuse("holds nodes but no edges or faces of cells; a surface is needed here".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cells::ALL;
    use crate::mesh::generate::{Block, Rectangle};

    #[test]
    fn the_boundary_is_what_the_generator_calls_its_sides() {
        for &cell in ALL.iter().filter(|cell| cell.dimension > 1) {
            let mesh = match cell.dimension {
                2 => Rectangle::new([0.0; 2], [1.0; 2], [3, 2], cell).mesh("p").unwrap(),
                _ => Block::new([0.0; 3], [1.0; 3], [3, 2, 2], cell).mesh("p").unwrap(),
            };
            let mut sides: Vec<Side> = mesh.groups.values().flat_map(|group| group.sides.clone()).collect();
            sides.sort_unstable();
            assert_eq!(mesh.boundary(&mesh.groups["p"].cells), sides, "{cell:?}");
            for group in mesh.groups.values().filter(|group| !group.sides.is_empty()) {
                assert_eq!(mesh.sides_among(&group.nodes), group.sides, "{cell:?}");
            }
        }
    }

    #[test]
    fn an_edge_is_found_by_its_nodes_in_any_order() {
        let mesh = Rectangle::new([0.0; 2], [1.0; 2], [2, 1], super::super::Cell::named("quad8").unwrap());
        let mesh = mesh.mesh("p").unwrap();
        let faces = Faces::of(&mesh, 0..2);
        for cell in 0..2 {
            for face in 0..4 {
                let side = Side { cell, face };
                let nodes: Vec<usize> = mesh.side(side).1.collect();
                let found = faces.behind(&[nodes[1], nodes[0]]);
                match (cell, face) {
                    (0, 1) | (1, 3) => {
                        let pair = [Side { cell: 0, face: 1 }, Side { cell: 1, face: 3 }];
                        assert_eq!(found, Behind::Two(pair));
                    }
                    _ => assert_eq!(found, Behind::One(side)),
                }
            }
        }
        assert_eq!(faces.behind(&[0, 1]), Behind::Nothing);
        assert_eq!(Faces::of(&mesh, [0, 0, 0]).behind(&[0, 2]), Behind::Many(3));
    }

    #[test]
    fn a_surface_is_refused_by_name_with_the_reason() {
        let mut mesh =
            Rectangle::new([0.0; 2], [1.0; 2], [2, 1], super::super::Cell::named("quad4").unwrap()).mesh("p").unwrap();
        let inner = Group { inner: vec![[Side { cell: 0, face: 1 }, Side { cell: 1, face: 3 }]], ..Group::default() };
        mesh.groups.insert("weld".into(), inner);
        assert_eq!(mesh.surface("p.left").unwrap(), [Side { cell: 0, face: 3 }]);
        for (name, text) in [
            ("p.lefd", "did you mean 'p.left'?"),
            ("p", "holds cells, not a surface"),
            ("p.top_left", "holds nodes but no edges"),
            ("weld", "'weld' is no surface: 1 of its faces lie inside the mesh, the first between cells 1 and 2"),
        ] {
            let error = mesh.surface(name).unwrap_err().to_string();
            assert!(error.contains(text), "{error}");
        }
    }
}
