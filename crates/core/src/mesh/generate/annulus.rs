//! A sector of an annulus, or the whole ring.

use super::Spacing;
use super::lattice::{Lattice, check_cell};
use crate::error::Error;
use crate::mesh::{Cell, Mesh};
use crate::tensor::Vec3;

/// A sector of an annulus, its sides `inner`, `outer` (radius), `start`, `end` (angle), its corners `start_inner`,
/// `start_outer`, `end_inner`, `end_outer`. Over 360 degrees the ring closes: `start`, `end` and the corners are no
/// more.
#[derive(Debug, Clone, PartialEq)]
pub struct Annulus {
    /// Centre of the circles.
    pub centre: [f64; 2],
    /// Stations along the radius.
    pub radius: Spacing,
    /// Stations along the circles, degrees counter-clockwise from the x axis.
    pub angle: Spacing,
    /// A plane cell.
    pub cell: &'static Cell,
}

impl Annulus {
    /// Equal steps between two `[inner, outer]` radii and two `[start, end]` angles in degrees; `[radial, angular]`
    /// cells.
    pub fn new(centre: [f64; 2], radii: [f64; 2], angles: [f64; 2], cells: [usize; 2], cell: &'static Cell) -> Self {
        let radius = Spacing::uniform(radii[0], radii[1], cells[0]);
        Self { centre, radius, angle: Spacing::uniform(angles[0], angles[1], cells[1]), cell }
    }

    /// The mesh of a part called `name`; mid-side nodes lie on the arcs.
    ///
    /// # Errors
    /// [`Error::Input`] for a cell that is not plane, a spacing that cannot be, an inner radius that is not positive,
    /// more than a full turn, or far too many cells.
    pub fn mesh(&self, name: &str) -> Result<Mesh, Error> {
        check_cell(name, "sector of an annulus", self.cell, 2)?;
        let stations =
            [self.radius.stations(&format!("{name}, radius"))?, self.angle.stations(&format!("{name}, angle"))?];
        let closed = self.closes(name)?;
        let map = |[radius, angle, _]: [f64; 3]| {
            let [cosine, sine] = direction(angle);
            Vec3([self.centre[0] + radius * cosine, self.centre[1] + radius * sine, 0.0])
        };
        let ends = &[["inner", "outer"], ["start", "end"]];
        Lattice { stations: &stations, cell: self.cell, ends, closed, map: &map }.mesh(name)
    }

    fn closes(&self, name: &str) -> Result<bool, Error> {
        let refuse = |why: &str| Err(Error::input(format!("{name}: {why}")));
        let turn = self.angle.end() - self.angle.from;
        if self.radius.from <= 0.0 {
            return refuse("the inner radius must be positive");
        }
        if !self.centre.iter().all(|x| x.is_finite()) {
            return refuse("the centre is not a finite point");
        }
        if turn > 360.0 {
            return refuse("the angles span more than a full turn of 360 degrees");
        }
        if turn == 360.0 && self.angle.cells() < 3 {
            return refuse("a closed ring needs at least three cells along the circle");
        }
        Ok(turn == 360.0)
    }
}

/// Cosine and sine of an angle in degrees, exact at quarter turns so that planes of symmetry are met exactly.
fn direction(degrees: f64) -> [f64; 2] {
    let quarter = (degrees / 90.0).round();
    let (sine, cosine) = (degrees - 90.0 * quarter).to_radians().sin_cos();
    match quarter.rem_euclid(4.0) as u8 {
        0 => [cosine, sine],
        1 => [-sine, cosine],
        2 => [-cosine, -sine],
        _ => [sine, -cosine],
    }
}
