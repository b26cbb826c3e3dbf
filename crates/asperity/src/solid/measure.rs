//! Total strain at the integration points of a body, from displacements alone.

use super::{Body, Strain};
use crate::mesh::Space;
use crate::tensor::{Tensor2, Vec3, principal};

impl Body {
    /// Strain at each integration point of the cell in place `slot` of the body's cells, XX YY ZZ XY YZ XZ with tensor
    /// shears: Hencky's logarithmic strain `ln V = 1/2 ln(F F^T)` on the present axes, in small strain the symmetric part of
    /// the displacement gradient. `states` are the points' histories, one after another.
    pub fn total_strains<'a>(
        &'a self,
        slot: usize,
        u: &'a [f64],
        states: &'a [f64],
    ) -> impl Iterator<Item = [f64; 6]> + 'a {
        let points = states.chunks_exact(self.point_len()).enumerate();
        points.map(move |(point, state)| {
            let f = self.total_gradient((self.cells[slot], point), u, state);
            match self.options.strain {
                Strain::Small => {
                    let mut strain = f.sym();
                    (0..3).for_each(|i| strain[(i, i)] -= 1.0);
                    strain.to_voigt()
                }
                Strain::Finite => logarithm(&f),
            }
        })
    }

    /// Deformation gradient of a point from the undeformed state on; in plane stress with the stretch of the thickness.
    fn total_gradient(&self, (cell, point): (usize, usize), u: &[f64], state: &[f64]) -> Tensor2 {
        let view = self.mesh.cell(cell);
        let shapes = &self.shapes(view.kind).points[point];
        let (mut jacobian, mut along) = (Tensor2::<f64>::zero(), Tensor2::<f64>::zero());
        let (mut radius, mut outward) = (0.0, 0.0);
        for (&node, (n, dn)) in view.nodes.iter().zip(shapes.n.iter().zip(&shapes.dn)) {
            let (x, first) = (self.mesh.points[node], self.dofs.node(node));
            let mut moved = Vec3::zero();
            (0..self.dofs.per_node()).for_each(|a| moved[a] = u[first + a]);
            for i in 0..3 {
                for a in 0..3 {
                    jacobian[(i, a)] += x[i] * dn[a];
                    along[(i, a)] += moved[i] * dn[a];
                }
            }
            radius += n * x[0];
            outward += n * moved[0];
        }
        if self.space != Space::Solid {
            jacobian[(2, 2)] = 1.0;
        }
        let inverse = jacobian.inverse();
        let mut f = Tensor2::from_fn(|i, j| (0..3).map(|a| along[(i, a)] * inverse[(a, j)]).sum());
        (0..3).for_each(|i| f[(i, i)] += 1.0);
        match self.space {
            Space::Axisymmetric => f[(2, 2)] = 1.0 + outward / radius,
            Space::PlaneStress => f[(2, 2)] = state[self.material().state_len()],
            Space::PlaneStrain | Space::Solid => {}
        }
        f
    }
}

/// `1/2 ln(F F^T)`.
fn logarithm(f: &Tensor2) -> [f64; 6] {
    let left = Tensor2::from_fn(|i, j| (0..3).map(|a| f[(i, a)] * f[(j, a)]).sum());
    let (squares, axes) = principal(&left);
    let strain = |i: usize, j: usize| (0..3).map(|a| 0.5 * squares[a].ln() * axes[(i, a)] * axes[(j, a)]).sum();
    Tensor2::from_fn(strain).to_voigt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_logarithm_of_a_stretch_that_was_turned_is_turned_with_it() {
        let (s, c) = 0.7_f64.sin_cos();
        let stretch = [1.5, 0.8, 1.2];
        let turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
        let found = logarithm(&Tensor2::from_fn(|i, j| turn[i][j] * stretch[j]));
        let [a, b] = [stretch[0].ln(), stretch[1].ln()];
        let wanted = [c * c * a + s * s * b, s * s * a + c * c * b, 1.2_f64.ln(), s * c * (a - b), 0.0, 0.0];
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-14), "{found:?}");
    }
}
