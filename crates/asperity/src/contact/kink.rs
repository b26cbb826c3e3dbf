//! Penetration and slip of a point as the coordinates over which its forces bend.

use super::geometry::{Geometry, MAX_DOFS};
use super::open::OpenContact;
use super::point::{in_contact, triad};
use super::variational::ContactForm;
use crate::Failure;
use crate::interface::{Interface, MOST_VARIABLES, Past};
use crate::system::{Answer, COORDINATES, Coordinates, Kinks, Stencil};
use crate::tensor::Dual;

impl OpenContact<'_> {
    /// Adds the coordinates of a point at values `u` of its unknowns to the stencil begun last.
    pub(super) fn bend(&self, (index, stencil): (usize, &Stencil), g: &Geometry, u: &[f64], out: &mut Kinks) {
        let ([penetration, slip], rates) = self.rates(g, u);
        let (along, inward, _) = triad(g.place.tangent);
        let present = self.contact.area(&g.spot, g.place.a, g.place.tangent);
        let undeformed = self.contact.undeformed_area(index);
        let coordinates = [(penetration + self.closure(index), inward), (slip, along)];
        for ((y, direction), rates) in coordinates.into_iter().zip(&rates) {
            let beyond = std::iter::repeat_n(0.0, stencil.len.saturating_sub(MAX_DOFS));
            let rates = rates.iter().take(stencil.len).copied().chain(beyond.clone());
            match self.contact.options.form {
                ContactForm::Traction => {
                    let rows = self.rows::<f64>((g, u), (g.place.b, g.place.b), direction * present);
                    out.coordinate(y, rates, rows.into_iter().take(stencil.len).chain(beyond));
                }
                ContactForm::Variational | ContactForm::Field => {
                    out.coordinate(y, rates.clone(), rates.map(|rate| rate * undeformed))
                }
            }
        }
        if let Some(mean) = self.mean_pressure(index, g, u) {
            let penalty = self.contact.options.penalty;
            let rates = mean.slopes.iter().map(|slope| slope / penalty);
            out.coordinate(mean.pressure / penalty, rates, std::iter::repeat_n(0.0, stencil.len));
        }
    }
}

/// The same where friction goes by the mean pressure around the point: over penetration, `slips` slips, and the
/// penetration that the mean stands for, to which no stress of its own belongs.
pub(in crate::contact) fn answer_by_mean(
    law: &dyn Interface,
    past: &Past,
    (least, slips): (f64, usize),
    y: &Coordinates,
) -> Result<Answer, Failure> {
    let (mut local, mean) = (*y, slips + 1);
    local[mean] = 0.0;
    let mut whole = answer(law, past, least, &local)?;
    if y[0] <= law.opens(past, [local[1], local[2]]) + least {
        return Ok(whole);
    }
    let mut motion = motion(law, past, least, &local);
    motion[0] = Coordinate::variable(y[mean], mean);
    let [_, shear @ ..] = stress_of(law, past, motion)?;
    for (i, shear) in shear.iter().enumerate().take(slips) {
        (whole.stress[i + 1], whole.slopes[i + 1]) = (shear.re, shear.du);
    }
    (whole.stress[mean], whole.slopes[mean]) = (0.0, [0.0; COORDINATES]);
    Ok(whole)
}

/// Pressure and shear over penetration and slip `y`, for what `past` is before the increment; a point that is farther
/// than `least` beyond touching is closed.
pub(in crate::contact) fn answer(
    law: &dyn Interface,
    past: &Past,
    least: f64,
    y: &Coordinates,
) -> Result<Answer, Failure> {
    let mut answer = Answer::default();
    if y[0] <= law.opens(past, [y[1], y[2]]) + least {
        return Ok(answer);
    }
    for (i, stress) in stress_of(law, past, motion(law, past, least, y))?.into_iter().enumerate() {
        (answer.stress[i], answer.slopes[i]) = (stress.re, stress.du);
    }
    Ok(answer)
}

type Coordinate = Dual<COORDINATES>;

/// What the law is asked at coordinates `y`: penetration, and the slips from the touch on.
fn motion(law: &dyn Interface, past: &Past, least: f64, y: &Coordinates) -> [Coordinate; 3] {
    let (touch, penetration) = (law.touch(past), Coordinate::variable(y[0] - least, 0));
    let part = in_contact(penetration - touch, past.penetration - touch);
    let [s, t] = [1, 2].map(|i| Coordinate::variable(y[i], i) * part);
    [penetration, s, t]
}

/// The stresses of a motion with its derivatives.
fn stress_of(law: &dyn Interface, past: &Past, motion: [Coordinate; 3]) -> Result<[Coordinate; 3], Failure> {
    let past = Past { penetration: past.penetration.max(law.touch(past)), ..*past };
    let mut vars = [0.0; MOST_VARIABLES];
    let vars = &mut vars[..past.vars.len()];
    vars.copy_from_slice(past.vars);
    Ok(law.respond(motion.map(|y| y.re), &past, vars)?.chained(motion))
}
