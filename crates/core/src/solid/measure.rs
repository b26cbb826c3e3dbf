//! Total strain at the integration points of a body, from displacements and incompatible modes.

use super::{Body, Strain};
use crate::mesh::Space;
use crate::tensor::{Tensor2, principal};

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
        let points = states.chunks_exact(self.point_len());
        let inside_out = || Tensor2::from_fn(|_, _| f64::NAN);
        let mut gradients: Vec<_> = self
            .displacement_gradients(self.cells[slot], u)
            .map(|gradient| gradient.unwrap_or_else(inside_out))
            .collect();
        let enhancements = self.enhancements(slot, states, &gradients);
        gradients.iter_mut().zip(enhancements).for_each(|(gradient, by)| *gradient = *gradient + by);
        points.zip(gradients).map(|(state, mut gradient)| {
            if self.space == Space::PlaneStress {
                gradient[(2, 2)] = state[self.material().state_len()] - 1.0;
            }
            match self.options.strain {
                Strain::Small => gradient.sym().to_voigt(),
                Strain::Finite => logarithm(&(gradient + Tensor2::identity())),
            }
        })
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
