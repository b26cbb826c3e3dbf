//! A rigid tool in space and its surface for drawing.

use super::nearest::RigidFacet;
use super::{FacetFinding, ToolFacet, check};
use crate::tensor::Vec3;
use crate::tool::{FacetTool, Pose};

/// A rigid tool in space: facets with the material behind them.
pub type SpaceTool = FacetTool<dyn RigidFacet>;

/// The surface of a tool as triangles and quadrilaterals, for drawing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tiles {
    /// Points.
    pub points: Vec<Vec3>,
    /// Three or four points a tile, outward by the right-hand rule, with the facet it lies on.
    pub tiles: Vec<(usize, Vec<usize>)>,
}

impl SpaceTool {
    /// A tool of facets; `reference` is the point that its translation moves and about which it turns. Anything is
    /// accepted here; [`check`](Self::check) says what is wrong with it.
    pub fn new(name: impl Into<String>, facets: Vec<Box<dyn RigidFacet>>, reference: Vec3) -> Self {
        Self::of(name.into(), facets, reference)
    }
    /// What is wrong with its facets or worth knowing.
    pub fn check(&self) -> Vec<FacetFinding> {
        check::findings(self)
    }

    /// Its surface in space, nowhere much farther than `sagitta` from it.
    pub fn surface(&self, pose: &Pose, sagitta: f64) -> Tiles {
        let mut out = Tiles::default();
        for (i, facet) in self.facets().iter().enumerate() {
            tile(i, facet.as_ref(), sagitta, &mut out);
        }
        out.points.iter_mut().for_each(|p| *p = pose.place(self.reference(), *p));
        out
    }
}

/// The tiles of one facet.
fn tile(number: usize, facet: &dyn ToolFacet, sagitta: f64, out: &mut Tiles) {
    let first = out.points.len();
    if let corners @ [_, _, _] = facet.corners() {
        out.points.extend(corners);
        out.tiles.push((number, (first..first + 3).collect()));
        return;
    }
    let [n, m] = facet.parts(sagitta);
    let at = |i: usize, j: usize| facet.point([i as f64 / n as f64, j as f64 / m as f64]);
    out.points.extend((0..=n).flat_map(|i| (0..=m).map(move |j| (i, j))).map(|(i, j)| at(i, j)));
    let place = |i: usize, j: usize| first + i * (m + 1) + j;
    let tiles = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    out.tiles
        .extend(tiles.map(|(i, j)| (number, vec![place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)])));
}
