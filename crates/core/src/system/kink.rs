//! How stencils bend within a step: stresses over a few coordinates each, such as pressure and shear over penetration and
//! slip.
//!
//! With the geometry of an evaluation kept, the forces of such a stencil are `H t(y)` with `y = y0 + G du`, and its tangent
//! is `H C(y0) G` besides what geometry adds. `t` is piecewise smooth: a point closes, opens, sticks or slips. What it
//! does over a whole step is known without evaluating anything else anew.

use std::ops::Range;

/// Most coordinates of a stencil.
pub const COORDINATES: usize = 4;

/// Coordinates, or stresses over them; those that a stencil does not have are zero.
pub type Coordinates = [f64; COORDINATES];

/// Stresses over the coordinates of a stencil, and their slopes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Answer {
    /// `t`.
    pub stress: Coordinates,
    /// Derivative of `t[i]` along `y[j]` at `[i][j]`.
    pub slopes: [Coordinates; COORDINATES],
}

/// One stencil that bends.
#[derive(Debug, Clone, PartialEq)]
pub struct Kink {
    /// Its term.
    pub term: usize,
    /// Its number among the stencils of the term.
    pub stencil: usize,
    /// Number of its coordinates.
    pub count: usize,
    /// `y0`.
    pub y: Coordinates,
    dofs: Range<usize>,
    first: usize,
}

/// The stencils that bend at one evaluation.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Kinks {
    list: Vec<Kink>,
    dofs: Vec<usize>,
    rates: Vec<f64>,
    forces: Vec<f64>,
}

impl Kinks {
    /// Forgets all and keeps the memory.
    pub fn clear(&mut self) {
        self.list.clear();
        self.dofs.clear();
        self.rates.clear();
        self.forces.clear();
    }
    /// Begins stencil number `stencil` of a term, with its unknowns; its coordinates follow.
    pub fn begin(&mut self, (term, stencil): (usize, usize), dofs: &[usize]) {
        let (start, first) = (self.dofs.len(), self.rates.len());
        self.dofs.extend_from_slice(dofs);
        let (dofs, y) = (start..self.dofs.len(), Coordinates::default());
        self.list.push(Kink { term, stencil, count: 0, y, dofs, first });
    }
    /// Forgets the stencil begun last if it turned out to have no coordinates.
    pub fn end(&mut self) {
        if let Some(kink) = self.list.pop_if(|kink| kink.count == 0) {
            self.dofs.truncate(kink.dofs.start);
        }
    }
    /// Adds a coordinate to the stencil begun last: its value, its rates along the unknowns (a row of `G`), and the
    /// forces on them of a unit of its stress (a column of `H`).
    pub fn coordinate(&mut self, y: f64, rates: impl Iterator<Item = f64>, forces: impl Iterator<Item = f64>) {
        let Some(kink) = self.list.last_mut() else { return };
        kink.y[kink.count] = y;
        kink.count += 1;
        self.rates.extend(rates);
        self.forces.extend(forces);
    }
    /// The stencils.
    pub fn list(&self) -> &[Kink] {
        &self.list
    }
    /// Change of a stencil's coordinates along a motion of all unknowns.
    pub fn along(&self, kink: &Kink, motion: &[f64]) -> Coordinates {
        let (dofs, mut y) = (&self.dofs[kink.dofs.clone()], Coordinates::default());
        let rates = self.rates[kink.first..].chunks_exact(dofs.len().max(1));
        for (y, rates) in y[..kink.count].iter_mut().zip(rates) {
            *y = rates.iter().zip(dofs).map(|(rate, &dof)| rate * motion[dof]).sum();
        }
        y
    }
    /// The unknowns of all stencils, as often as they occur.
    pub fn dofs(&self) -> &[usize] {
        &self.dofs
    }
    /// Rates of one coordinate, unknown by unknown.
    pub fn rates(&self, kink: &Kink, coordinate: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.by_unknown(kink, coordinate, &self.rates)
    }
    /// Forces of a unit of stress at one coordinate, unknown by unknown.
    pub fn forces(&self, kink: &Kink, coordinate: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.by_unknown(kink, coordinate, &self.forces)
    }
    fn by_unknown<'a>(
        &'a self,
        kink: &Kink,
        coordinate: usize,
        values: &'a [f64],
    ) -> impl Iterator<Item = (usize, f64)> + use<'a> {
        let dofs = &self.dofs[kink.dofs.clone()];
        dofs.iter().copied().zip(values[kink.first + coordinate * dofs.len()..].iter().copied())
    }
    /// Adds to `forces` on all unknowns those of stress `t` at one coordinate.
    pub fn push(&self, kink: &Kink, coordinate: usize, t: f64, forces: &mut [f64]) {
        self.forces(kink, coordinate).for_each(|(dof, force)| forces[dof] += t * force);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_move_with_the_unknowns_and_push_them() {
        let mut kinks = Kinks::default();
        kinks.begin((0, 7), &[4]);
        kinks.coordinate(0.5, [2.0].into_iter(), [-1.0].into_iter());
        kinks.begin((0, 9), &[1, 3]);
        kinks.coordinate(0.1, [1.0, -1.0].into_iter(), [10.0, 20.0].into_iter());
        kinks.coordinate(0.2, [0.5, 0.0].into_iter(), [30.0, 40.0].into_iter());
        kinks.begin((0, 10), &[0, 2]);
        kinks.end();
        kinks.end();
        let [_, kink] = kinks.list() else { panic!("two have coordinates") };
        assert_eq!((kink.stencil, kink.count, kink.y), (9, 2, [0.1, 0.2, 0.0, 0.0]));
        assert_eq!(kinks.along(kink, &[0.0, 3.0, 0.0, 2.0, 0.0]), [1.0, 1.5, 0.0, 0.0]);
        let mut forces = [0.0; 5];
        kinks.push(kink, 1, 2.0, &mut forces);
        assert_eq!(forces, [0.0, 60.0, 0.0, 80.0, 0.0]);
    }
}
