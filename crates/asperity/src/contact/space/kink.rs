//! Penetration and the two slips of a point in space as the coordinates over which its forces bend.

use super::geometry::{DIRECTIONS, Geometry};
use super::open::{D, OpenContact};
use super::point::Triad;
use crate::system::Kinks;
use crate::tensor::{Scalar, Vec3};

impl OpenContact<'_> {
    /// Adds the coordinates of a point at values `u` of its unknowns to the stencil begun last.
    pub(super) fn bend(&self, index: usize, g: &Geometry, u: &[f64], out: &mut Kinks) {
        let place = Self::variable(g);
        let (triad, normal) = (Triad::new(place.tangents), g.hit.normal.lift::<D>());
        let penetration = normal.dot(place.b - place.a) / normal.dot(triad.inward) + self.closure(index);
        let slip = |e: Vec3<D>| place.touched.map_or(D::zero(), |touched| e.dot(touched - place.a));
        let area = triad.area.re() * g.spot.weight;
        let columns = self.columns(g, u);
        let coordinates = [(penetration, triad.inward)].into_iter().chain(triad.along.map(|e| (slip(e), e)));
        for (y, direction) in coordinates {
            let rate = |column: &[f64; DIRECTIONS]| y.du.iter().zip(column).map(|(s, c)| s * c).sum();
            let rows = self.rows::<f64>((g, u), (g.place.b, g.place.b), direction.re() * area);
            out.coordinate(y.re(), columns[..u.len()].iter().map(rate), rows.into_iter().take(u.len()));
        }
    }
}
