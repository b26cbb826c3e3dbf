//! Penetration and the two slips of a point in space as the coordinates over which its forces bend.

use super::geometry::{DIRECTIONS, Geometry, TOOL};
use super::open::{D, OpenContact, seed};
use super::point::Triad;
use crate::system::Kinks;
use crate::tensor::{Scalar, Vec3};

impl OpenContact<'_> {
    /// Adds the coordinates of a point with `count` unknowns to the stencil begun last.
    pub(super) fn bend(&self, index: usize, g: &Geometry, count: usize, out: &mut Kinks) {
        let triad = Triad::new([seed::<D>(g.place.tangents[0], 3), seed(g.place.tangents[1], 6)]);
        let (a, b, normal) = (seed::<D>(g.place.a, 0), seed::<D>(g.place.b, 9), g.hit.normal.lift::<D>());
        let penetration = normal.dot(b - a) / normal.dot(triad.inward);
        let slip = |e: Vec3<D>| g.place.touched.map_or(D::zero(), |touched| e.dot(seed::<D>(touched, 12) - a));
        let area = triad.area.re() * self.contact.parts.surface.points[index].weight;
        let columns = self.columns(index, g, count - TOOL);
        let coordinates = [(penetration, triad.inward)].into_iter().chain(triad.along.map(|e| (slip(e), e)));
        for (y, direction) in coordinates {
            let rate = |column: &[f64; DIRECTIONS]| y.du.iter().zip(column).map(|(s, c)| s * c).sum();
            let rows = self.rows::<f64>(index, g, g.place.b, direction.re() * area);
            out.coordinate(y.re(), columns[..count].iter().map(rate), (0..count).map(|k| rows.of(k)));
        }
    }
}
