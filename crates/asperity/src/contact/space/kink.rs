//! Penetration and the two slips of a point in space as the coordinates over which its forces bend.

use super::geometry::Geometry;
use super::open::OpenContact;
use super::point::Triad;
use crate::contact::ContactForm;
use crate::system::{Kinks, Stencil};

impl OpenContact<'_> {
    /// Adds the coordinates of a point at values `u` of its unknowns to the stencil begun last.
    pub(super) fn bend(&self, (index, stencil): (usize, &Stencil), g: &Geometry, u: &[f64], out: &mut Kinks) {
        let ([penetration, s, t], rates) = self.rates(g, u);
        let Triad { inward, along, area } = Triad::new(g.place.tangents);
        let coordinates = [(penetration + self.closure(index), inward), (s, along[0]), (t, along[1])];
        for ((y, direction), rates) in coordinates.into_iter().zip(&rates) {
            let rates = rates.iter().copied();
            match self.contact.parts.options.form {
                ContactForm::Traction => {
                    let force = direction * (area * g.spot.weight);
                    let rows = self.rows::<f64>((g, u), (g.place.b, g.place.b), force);
                    out.coordinate(y, rates, rows.into_iter().chain(std::iter::repeat(0.0)).take(stencil.len));
                }
                ContactForm::Variational | ContactForm::Field => {
                    let undeformed = self.contact.undeformed_area(index);
                    out.coordinate(y, rates.clone(), rates.map(|rate| rate * undeformed));
                }
            }
        }
        if let Some(mean) = self.mean_pressure(index, g, u) {
            let penalty = self.contact.parts.options.penalty;
            let rates = mean.slopes.iter().map(|slope| slope / penalty);
            out.coordinate(mean.pressure / penalty, rates, std::iter::repeat_n(0.0, stencil.len));
        }
    }
}
