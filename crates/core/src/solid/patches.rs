//! Patches of neighbouring simplices and wedges of first degree that share one change of volume (de Souza Neto, Andrade
//! Pires and Owen 2005), since one alone has too few motions for a condition of its own; and pairs of triangles and sixes of
//! tetrahedra of second degree for a linear one.
//!
//! A mesh is cut into patches that do not overlap, from its rim inwards: a patch begins with the cell that has the fewest
//! free neighbours and takes in the one that brings the fewest new nodes, of those the one with the largest common side.
//! Halves of a quadrilateral so find together. Only the undeformed mesh enters.

use super::{Choice, Formulation};
use crate::mesh::Mesh;
use crate::mesh::cells::{Cell, Face};
use std::cmp::Reverse;
use std::collections::BTreeSet;

/// Most nodes of a patch.
pub(super) const WIDEST: usize = 32;
/// Steps in which the size of a side is compared, so that rounding does not order equal ones.
const STEPS: f64 = 1e6;
const NONE: usize = usize::MAX;

/// A partition of a body's cells, by their places in it.
#[derive(Debug, Default)]
pub(super) struct Patches {
    /// Patch of each cell.
    of: Vec<usize>,
    /// Cells, patch by patch.
    cells: Vec<usize>,
    /// Where each patch begins among them; one more than patches.
    starts: Vec<usize>,
    /// Nodes of a cell's patch beside its own, cell by cell.
    others: Vec<usize>,
    /// Where those of each cell begin; one more than cells.
    others_starts: Vec<usize>,
}

/// Cells of a patch of a kind, so that there is about one condition for each node of a mesh of first degree. With three
/// and four triangles metal upset by a fifth is too soft by 7 and 17 %. Six tetrahedra of second degree may be a brick: with four a cantilever that
/// keeps its volume, two through it, L/t = 20 and 10 along, is too stiff by 5.5 %, with six by 2.1 %.
pub(super) fn size(choice: &Choice) -> usize {
    let kind = choice.kind;
    match (kind.degree, kind.dimension, kind.nodes.len()) {
        _ if choice.formulation != Formulation::FBar => 1,
        (_, 2, 3 | 6) | (1, 3, 6) => 2,
        (1, 3, 4) => 8,
        _ if choice.joined => 6,
        _ => 1,
    }
}

impl Patches {
    /// Those of some cells, so many of each kind in one.
    pub fn new(mesh: &Mesh, cells: &[usize], size: impl Fn(&'static Cell) -> usize) -> Self {
        let sizes: Vec<usize> = cells.iter().map(|&cell| size(mesh.cell(cell).kind)).collect();
        let mut cut = Cut {
            mesh,
            cells,
            neighbours: neighbours(mesh, cells, &sizes),
            sizes,
            patches: Vec::new(),
            of: vec![NONE; cells.len()],
        };
        cut.grow();
        cut.join();
        cut.finish()
    }

    /// The cells of the patch of a cell, itself among them.
    pub fn members(&self, slot: usize) -> &[usize] {
        let patch = self.of[slot];
        &self.cells[self.starts[patch]..self.starts[patch + 1]]
    }

    /// The nodes of the patch of a cell that are not its own.
    pub fn others(&self, slot: usize) -> &[usize] {
        &self.others[self.others_starts[slot]..self.others_starts[slot + 1]]
    }
}

/// Neighbours of each cell across its sides, each with the size of the side in steps.
fn neighbours(mesh: &Mesh, cells: &[usize], sizes: &[usize]) -> Vec<Vec<(usize, u64)>> {
    let (mut sides, mut largest) = (Vec::new(), 0.0_f64);
    for (slot, &cell) in cells.iter().enumerate().filter(|&(slot, _)| sizes[slot] > 1) {
        let view = mesh.cell(cell);
        // Wedges pair over their quadrilaterals: those above one another share no edge of the triangle.
        let corners = |face: &Face| face.cell.linear.nodes.len();
        let across = view.kind.faces.iter().map(corners).max().unwrap_or(0);
        for face in view.kind.faces.iter().filter(|face| corners(face) == across) {
            let mut nodes: Vec<usize> = face.nodes[..across].iter().map(|&local| view.nodes[local]).collect();
            let measure = measure(mesh, &nodes);
            nodes.sort_unstable();
            largest = largest.max(measure);
            sides.push((nodes, slot, measure));
        }
    }
    sides.sort_by(|a, b| (&a.0, a.1).cmp(&(&b.0, b.1)));
    let mut all = vec![Vec::new(); cells.len()];
    for pair in sides.windows(2) {
        let [(nodes, one, measure), (same, two, _)] = pair else { continue };
        let alike = || mesh.cell(cells[*one]).kind == mesh.cell(cells[*two]).kind;
        if nodes == same && alike() {
            let steps = (STEPS * measure / largest.max(f64::MIN_POSITIVE)).round() as u64;
            all[*one].push((*two, steps));
            all[*two].push((*one, steps));
        }
    }
    all
}

/// Length of an edge, area of a face.
fn measure(mesh: &Mesh, nodes: &[usize]) -> f64 {
    let from = |node: usize| mesh.points[node] - mesh.points[nodes[0]];
    match nodes.len() {
        2 => from(nodes[1]).norm(),
        _ => nodes[1..].windows(2).map(|pair| 0.5 * from(pair[0]).cross(from(pair[1])).norm()).sum(),
    }
}

/// A partition while it is made.
struct Cut<'a> {
    mesh: &'a Mesh,
    cells: &'a [usize],
    neighbours: Vec<Vec<(usize, u64)>>,
    /// Cells that the patch of each should have.
    sizes: Vec<usize>,
    patches: Vec<Vec<usize>>,
    of: Vec<usize>,
}

impl Cut<'_> {
    fn nodes(&self, slot: usize) -> &[usize] {
        self.mesh.cell(self.cells[slot]).nodes
    }

    fn grow(&mut self) {
        let mut free: Vec<usize> = self.neighbours.iter().map(Vec::len).collect();
        let mut queue: BTreeSet<(usize, usize)> = free.iter().copied().zip(0..).collect();
        while let Some((_, seed)) = queue.pop_first() {
            let (mut nodes, mut next) = (Vec::new(), Some(seed));
            let patch = self.patches.len();
            self.patches.push(Vec::new());
            while let Some(slot) = next {
                queue.remove(&(free[slot], slot));
                self.of[slot] = patch;
                self.patches[patch].push(slot);
                nodes.extend(self.nodes(slot));
                nodes.sort_unstable();
                nodes.dedup();
                for &(other, _) in &self.neighbours[slot] {
                    if self.of[other] == NONE {
                        queue.remove(&(free[other], other));
                        free[other] -= 1;
                        queue.insert((free[other], other));
                    }
                }
                next = self.best(patch, &nodes);
            }
        }
    }

    /// The free cell that a patch of these nodes takes in next.
    fn best(&self, patch: usize, nodes: &[usize]) -> Option<usize> {
        let members = &self.patches[patch];
        let wanted = self.sizes[members[0]];
        let around = members.iter().flat_map(|&slot| &self.neighbours[slot]);
        let open = around.filter(|(other, _)| self.of[*other] == NONE);
        let worth = |&(other, _): &(usize, u64)| {
            let new = self.nodes(other).iter().filter(|node| nodes.binary_search(node).is_err()).count();
            let beside = self.neighbours[other].iter().filter(|(inner, _)| self.of[*inner] == patch);
            (new, Reverse(beside.map(|(_, steps)| steps).sum::<u64>()), other)
        };
        let (new, _, slot) = open.map(worth).min()?;
        (members.len() < wanted || (new == 0 && members.len() < 2 * wanted)).then_some(slot)
    }

    /// Cells of patches that stayed too small go to the neighbouring patch with the largest common side.
    fn join(&mut self) {
        let small =
            |patch: &Vec<usize>, sizes: &[usize]| patch.first().is_some_and(|&slot| 3 * patch.len() < 2 * sizes[slot]);
        for patch in 0..self.patches.len() {
            if !small(&self.patches[patch], &self.sizes) {
                continue;
            }
            for slot in self.patches[patch].clone() {
                let sides = self.neighbours[slot].iter().map(|&(other, steps)| (Reverse(steps), self.of[other]));
                let mut sides: Vec<_> = sides.filter(|&(_, other)| other != patch).collect();
                sides.sort_unstable();
                let Some(&(_, other)) = sides.iter().find(|&&(_, other)| self.width(other, slot) <= WIDEST) else {
                    continue;
                };
                self.patches[patch].retain(|&own| own != slot);
                self.patches[other].push(slot);
                self.of[slot] = other;
            }
        }
    }

    /// Nodes of a patch with one more cell.
    fn width(&self, patch: usize, slot: usize) -> usize {
        let all: BTreeSet<usize> =
            self.patches[patch].iter().chain([&slot]).flat_map(|&slot| self.nodes(slot)).copied().collect();
        all.len()
    }

    fn finish(self) -> Patches {
        let mut found =
            Patches { of: vec![0; self.cells.len()], starts: vec![0], others_starts: vec![0], ..Patches::default() };
        for members in self.patches.iter().filter(|members| !members.is_empty()) {
            members.iter().for_each(|&slot| found.of[slot] = found.starts.len() - 1);
            found.cells.extend(members);
            found.cells[*found.starts.last().unwrap_or(&0)..].sort_unstable();
            found.starts.push(found.cells.len());
        }
        for slot in 0..self.cells.len() {
            let (own, begun) = (self.nodes(slot), found.others.len());
            for member in found.members(slot).to_vec() {
                for &node in self.nodes(member) {
                    if !own.contains(&node) && !found.others[begun..].contains(&node) {
                        found.others.push(node);
                    }
                }
            }
            found.others_starts.push(found.others.len());
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::generate::{Block, Rectangle};

    fn widths(mesh: &Mesh, size: usize) -> (Vec<usize>, Vec<usize>) {
        let cells: Vec<usize> = (0..mesh.cell_count()).collect();
        let patches = Patches::new(mesh, &cells, |_| size);
        let mut seen = vec![0; cells.len()];
        (0..patches.starts.len() - 1).for_each(|patch| {
            patches.cells[patches.starts[patch]..patches.starts[patch + 1]].iter().for_each(|&slot| seen[slot] += 1);
        });
        assert!(seen.iter().all(|&times| times == 1), "every cell lies in one patch");
        let nodes = |slot: usize| mesh.cell(slot).nodes.len() + patches.others(slot).len();
        (
            cells.iter().map(|&slot| patches.members(slot).len()).collect(),
            cells.iter().map(|&slot| nodes(slot)).collect(),
        )
    }

    #[test]
    fn the_halves_of_a_brick_find_together() {
        let plane = |cell| Rectangle::new([0.0; 2], [4.0, 3.0], [4, 3], Cell::named(cell).unwrap()).mesh("b").unwrap();
        let solid =
            |cell| Block::new([0.0; 3], [3.0, 2.0, 2.0], [3, 2, 2], Cell::named(cell).unwrap()).mesh("b").unwrap();
        for (mesh, members, nodes) in
            [(plane("tri3"), 2, 4), (plane("tri6"), 2, 9), (solid("wedge6"), 2, 8), (plane("quad8"), 1, 8)]
        {
            let (sizes, widths) = widths(&mesh, members);
            assert!(sizes.iter().all(|&size| size == members), "{}: {sizes:?}", mesh.kinds[0].name);
            assert!(widths.iter().all(|&width| width == nodes), "{}: {widths:?}", mesh.kinds[0].name);
        }
    }

    #[test]
    fn patches_of_tetrahedra_are_neither_small_nor_wide() {
        let mesh = Block::new([0.0; 3], [3.0, 2.0, 2.0], [3, 2, 2], Cell::named("tet4").unwrap()).mesh("b").unwrap();
        let (sizes, widths) = widths(&mesh, 8);
        assert!(sizes.iter().all(|&size| size >= 6) && widths.iter().all(|&width| width <= WIDEST), "{sizes:?}");
    }

    /// A fan of an odd number of triangles leaves none alone.
    #[test]
    fn no_triangle_stays_alone_beside_others() {
        let mut mesh = Mesh::new();
        mesh.points = (0..8).map(|i| crate::tensor::Vec3::new(f64::from(i), f64::from(i % 2), 0.0)).collect();
        for i in 0..5 {
            mesh.push_cell(Cell::named("tri3").unwrap(), &[i, i + 1, i + 2]);
        }
        let (sizes, _) = widths(&mesh, 2);
        assert!(sizes.iter().all(|size| [2, 3].contains(size)), "{sizes:?}");
    }
}
