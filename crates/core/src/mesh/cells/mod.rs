//! Reference cells: shape functions, quadratures and faces; each cell is data plus one function, a family to a file.
//!
//! The order of the nodes is that of VTK, so that results are written without a permutation; the orders of other
//! formats stand in `formats`. Shape functions as in Zienkiewicz and Taylor, "The finite element method".
//! To add a cell: its file here, its `mod` line and its name in [`ALL`]; `tests` then walks it.

mod hex;
mod line;
mod quad;
mod rules;
mod tet;
mod tri;
mod wedge;

pub use hex::{HEX8, HEX20, HEX27};
pub use line::{LINE2, LINE3};
pub use quad::{QUAD4, QUAD8, QUAD9};
pub use tet::{TET4, TET10};
pub use tri::{TRI3, TRI6};
pub use wedge::{WEDGE6, WEDGE15};

use crate::tensor::legendre;

/// Every cell the program knows.
pub static ALL: &[&Cell] =
    &[&LINE2, &LINE3, &TRI3, &TRI6, &QUAD4, &QUAD8, &QUAD9, &TET4, &TET10, &HEX8, &HEX20, &HEX27, &WEDGE6, &WEDGE15];

/// A reference cell. Coordinates are in its own system: `[-1, 1]` along a line, the sides of a quad or hex and the
/// uprights of a wedge, area coordinates in `[0, 1]` for triangles and tetrahedra.
pub struct Cell {
    /// The name a deck and a message use: `quad8`.
    pub name: &'static str,
    /// Dimension of the cell itself: 1, 2 or 3.
    pub dimension: usize,
    /// Degree of its edges: 1 or 2.
    pub degree: usize,
    /// The cell of first degree on its corners, which are the first of its nodes; itself if it is of first degree.
    pub linear: &'static Cell,
    /// Reference coordinates of its nodes.
    pub nodes: &'static [[f64; 3]],
    /// Values `n[i]` and gradients `dn[i][a]` of the shape functions at a reference point.
    pub shape: fn(xi: [f64; 3], n: &mut [f64], dn: &mut [[f64; 3]]),
    /// Edges of a plane cell (counter-clockwise: the cell lies on the left), faces of a solid one (normal outward by
    /// the right-hand rule).
    pub faces: &'static [Face],
    /// Quadrature that integrates the stiffness of an undistorted cell exactly.
    pub full: &'static Quadrature,
    /// Quadrature with fewer points, as programs of the field call it; absent where that is meaningless.
    pub reduced: Option<&'static Quadrature>,
    /// Quadratures for surfaces with 1, 2 and 3 points an edge; empty for cells that are never a face.
    pub gauss: [Option<&'static Quadrature>; 3],
    /// VTK cell type.
    pub vtk: u8,
}

/// One edge or face of a cell.
pub struct Face {
    /// The reference cell of the face itself.
    pub cell: &'static Cell,
    /// The face's nodes as positions in the cell's node list.
    pub nodes: &'static [usize],
}

/// A quadrature rule: points in reference coordinates and weights that sum to the reference measure.
pub struct Quadrature {
    /// Polynomials up to this total degree are integrated exactly.
    pub degree: usize,
    /// Points.
    pub points: &'static [[f64; 3]],
    /// Weights.
    pub weights: &'static [f64],
}

/// The largest number of nodes of any cell (hex27).
pub const MAX_NODES: usize = 27;

impl Cell {
    /// Points and weights of a rule of this order on a cell that is a side: so many points along an edge or each side of a
    /// quadrilateral; on a triangle 1, 3, 6, and from order 4 on a square whose one side is drawn together to a corner. None on others.
    pub fn surface_rule(&self, order: usize) -> Vec<([f64; 3], f64)> {
        if let Some(known) = self.gauss.get(order.saturating_sub(1)) {
            return known
                .iter()
                .flat_map(|rule| rule.points.iter().copied().zip(rule.weights.iter().copied()))
                .collect();
        }
        let line = legendre(order);
        match (self.dimension, self.linear.nodes.len()) {
            (1, _) => line.iter().map(|&(x, weight)| ([x, 0.0, 0.0], weight)).collect(),
            (2, corners) => {
                let square = line.iter().flat_map(|&(y, b)| line.iter().map(move |&(x, a)| ([x, y, 0.0], a * b)));
                let folded = |([x, y, _], weight): ([f64; 3], f64)| {
                    let (a, b) = (0.5 * (1.0 + x), 0.5 * (1.0 + y));
                    ([a * (1.0 - b), b, 0.0], 0.25 * weight * (1.0 - b))
                };
                if corners == 3 { square.map(folded).collect() } else { square.collect() }
            }
            _ => Vec::new(),
        }
    }
}

impl std::fmt::Debug for Cell {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Cell {
    /// Looks a cell up by its name.
    pub fn named(name: &str) -> Option<&'static Cell> {
        ALL.iter().copied().find(|cell| cell.name == name)
    }

    /// Reference coordinates of the centroid.
    pub fn center(&self) -> [f64; 3] {
        let corners = self.linear.nodes;
        let sum = |a: usize| corners.iter().map(|corner| corner[a]).sum::<f64>();
        std::array::from_fn(|a| sum(a) / corners.len() as f64)
    }

    /// The pairs of corners that its edges join; an edge that two faces share comes twice.
    pub fn edges(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.faces.iter().flat_map(|face| match face.cell.dimension {
            1 => vec![[face.nodes[0], face.nodes[1]]],
            _ => face.cell.faces.iter().map(|edge| [0, 1].map(|end| face.nodes[edge.nodes[end]])).collect(),
        })
    }

    /// The serendipity cell of second degree on its corners; the first of [`ALL`].
    pub fn raised(&self) -> Option<&'static Cell> {
        ALL.iter().copied().find(|cell| cell.degree == 2 && cell.linear == self.linear)
    }

    /// Its nodes in the middle of edges, each with the corners at the ends of its edge.
    pub fn middles(&self) -> impl Iterator<Item = (usize, [usize; 2])> + '_ {
        let nodes = self.nodes;
        let middle = move |[a, b]: [usize; 2]| std::array::from_fn(|i| 0.5 * (nodes[a][i] + nodes[b][i]));
        let ends = move |node: usize| self.edges().find(|&ends| middle(ends) == nodes[node]);
        (self.linear.nodes.len()..nodes.len()).filter_map(move |node| Some((node, ends(node)?)))
    }

    /// The order of the nodes that turns the cell inside out: node `i` of the turned cell is node `mirror()[i]` of the
    /// cell. Along a line the ends change places, elsewhere the first two reference coordinates.
    pub fn mirror(&self) -> Vec<usize> {
        let reflect = |[x, y, z]: [f64; 3]| if self.dimension == 1 { [-x, y, z] } else { [y, x, z] };
        let place = |image: [f64; 3]| self.nodes.iter().position(|&node| node == image);
        self.nodes.iter().enumerate().map(|(i, &node)| place(reflect(node)).unwrap_or(i)).collect()
    }

    /// Where a face stands in the list of faces after the cell has been turned inside out by [`Cell::mirror`].
    pub fn mirrored_face(&self, face: usize) -> usize {
        let mirror = self.mirror();
        let sorted = |nodes: &mut dyn Iterator<Item = usize>| {
            let mut nodes: Vec<usize> = nodes.collect();
            nodes.sort_unstable();
            nodes
        };
        let wanted = sorted(&mut self.faces[face].nodes.iter().map(|&node| mirror[node]));
        let found = self.faces.iter().position(|other| sorted(&mut other.nodes.iter().copied()) == wanted);
        found.unwrap_or(face)
    }
}

#[cfg(test)]
mod tests;
