//! Motions of cells of first degree that one integration point does not see.
//!
//! Bilinear and trilinear cells move by linear fields and by the products of reference coordinates `xi eta`, `eta zeta`,
//! `zeta xi`, `xi eta zeta`, at whose centre all gradients vanish: without full integration nothing resists them. With
//! `h` such a product at the nodes, `g = h - (h . x_i) grad_i N` leaves linear fields out (Flanagan and Belytschko
//! 1981), and `g . u` is what a cell moves by the product. They are not stabilised here but told.

use super::gradient::{self, Shapes, padded};
use super::{Body, Integration};
use crate::mesh::Space;
use crate::mesh::cells::{Cell, MAX_NODES};

/// Motions, each by an axis, that no stiffness resists in a cell of a kind; zero for other cells and rules.
fn products(kind: &Cell) -> usize {
    match (kind.degree, kind.nodes.len()) {
        (1, 4) if kind.dimension == 2 => 1,
        (1, 8) => 4,
        _ => 0,
    }
}

/// Value of a product of reference coordinates.
fn product(number: usize, [x, y, z]: [f64; 3]) -> f64 {
    [x * y, y * z, z * x, x * y * z][number]
}

impl Body {
    /// How many motions of one of its cells meet no stiffness beside those of a rigid body: none but in cells of
    /// first degree with reduced integration.
    pub fn unseen(&self) -> usize {
        let kinds = self.cells.iter().map(|&cell| self.mesh.cell(cell).kind);
        let unseen = |kind: &'static Cell| if self.sees_all(kind) { 0 } else { products(kind) * kind.dimension };
        kinds.map(unseen).max().unwrap_or(0)
    }

    fn sees_all(&self, kind: &Cell) -> bool {
        self.options.integration != Integration::Reduced || kind.degree > 1 || kind.reduced.is_none()
    }

    /// Part of the motion of its cells about their centres that they do not resist, at displacements `u`: zero for
    /// linear fields, one where there is nothing else. `None` where cells resist all.
    pub fn hourglass(&self, u: &[f64]) -> Option<f64> {
        if self.unseen() == 0 {
            return None;
        }
        let sums = self.cells.iter().filter_map(|&cell| self.hourglass_of(cell, u));
        let [unseen, all] = sums.fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
        Some(if all > 0.0 { (unseen / all).sqrt() } else { 0.0 })
    }

    /// Squares of what a cell moves by the products, and of all it moves about its mean.
    fn hourglass_of(&self, cell: usize, u: &[f64]) -> Option<[f64; 2]> {
        let view = self.mesh.cell(cell);
        if self.sees_all(view.kind) {
            return None;
        }
        let (count, axes) = (view.nodes.len(), self.dofs.per_node());
        let x: Vec<[f64; 3]> = view.nodes.iter().map(|&node| self.mesh.points[node].0).collect();
        // The gradient of the reference configuration; that around the axis is no matter of the cell's plane.
        let space = if axes == 3 { Space::Solid } else { Space::PlaneStrain };
        let mut gradients = Vec::with_capacity(3 * padded(count));
        gradient::at(&Shapes::new(view.kind, view.kind.center(), 1.0), &x, space, &mut gradients)?;
        let mut sums = [0.0; 2];
        for axis in 0..axes {
            let v: Vec<f64> = view.nodes.iter().map(|&node| u[self.dofs.node(node) + axis]).collect();
            let mean = v.iter().sum::<f64>() / count as f64;
            sums[1] += v.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
            for number in 0..products(view.kind) {
                let mut h = [0.0; MAX_NODES];
                h.iter_mut().zip(view.kind.nodes).for_each(|(h, &xi)| *h = product(number, xi));
                let linear = |i: usize| h.iter().zip(&x).map(|(h, x)| h * x[i]).sum::<f64>();
                let slope = [0, 1, 2].map(linear);
                let along =
                    |k: usize| h[k] - (0..axes).map(|i| slope[i] * gradients[i * padded(count) + k]).sum::<f64>();
                let moved: f64 = v.iter().enumerate().map(|(k, v)| along(k) * v).sum();
                sums[0] += moved * moved / count as f64;
            }
        }
        Some(sums)
    }
}

#[cfg(test)]
mod tests {
    use super::super::BodyOptions;
    use super::*;
    use crate::material::Rate;
    use crate::material::laws::Elastic;
    use crate::mesh::Mesh;
    use crate::mesh::generate::{Block, Rectangle};
    use crate::system::Dofs;
    use std::sync::Arc;

    fn body(name: &str, integration: Integration) -> (Body, Arc<Mesh>) {
        let cell = Cell::named(name).unwrap();
        let (mesh, space) = match cell.dimension {
            2 => (Rectangle::new([1.0, 0.0], [2.0, 3.0], [2, 3], cell).mesh("block"), Space::PlaneStrain),
            _ => (Block::new([0.0; 3], [1.0, 2.0, 1.5], [2, 2, 1], cell).mesh("block"), Space::Solid),
        };
        let mesh = Arc::new(mesh.unwrap());
        let dofs = Dofs::new(cell.dimension, mesh.points.len(), 0);
        let options = BodyOptions { integration, ..BodyOptions::default() };
        let all = (0..mesh.cell_count()).collect();
        let law = Arc::new(Rate(Elastic::new(200.0, 0.3)));
        (Body::new("block", (mesh.clone(), dofs, space), all, law, options).unwrap(), mesh)
    }

    fn moved(body: &Body, mesh: &Mesh, field: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
        let axes = body.dofs.per_node();
        mesh.points.iter().flat_map(|x| field(x.0).into_iter().take(axes)).collect()
    }

    #[test]
    fn linear_fields_are_seen_and_waves_are_not() {
        for (name, unseen) in [("quad4", 2), ("hex8", 12)] {
            let (body, mesh) = body(name, Integration::Reduced);
            assert_eq!(body.unseen(), unseen);
            let linear = moved(&body, &mesh, |[x, y, z]| [0.3 * x - y + 0.2, x + 0.5 * y + z, 0.7 * z - y]);
            assert!(body.hourglass(&linear).unwrap() < 1e-14, "{name}");
            // Nodes in turn to either side along x.
            let wave = moved(&body, &mesh, |[x, y, z]| {
                let turns = (2.0 * (x - mesh.points[0].0[0]) + y + z / 1.5).round() as i64;
                [if turns % 2 == 0 { 0.01 } else { -0.01 }, 0.0, 0.0]
            });
            assert!((body.hourglass(&wave).unwrap() - 1.0).abs() < 1e-12, "{name}: {:?}", body.hourglass(&wave));
        }
        let (full, _) = body("quad4", Integration::Full);
        assert_eq!((full.unseen(), full.hourglass(&[0.0; 24])), (0, None));
    }
}
