//! The yield surface of a law of an interface: at each pressure the largest shear stress that is borne without slip.
//!
//! A point that is held slips if its stress lies outside. So much any law tells, and halving finds the surface. A law
//! without a stress at which it sticks, or at which it slips, has none.

use super::table::Record;
use asperity_core::interface::{Interface, Linearised, Past, Status};

/// Pressures at which it is sought.
const PRESSURES: usize = 200;
/// Halvings of the shear stress, and doublings before them.
const HALVINGS: usize = 50;
/// A shear stress that is none, over the largest pressure.
const NONE: f64 = 1e-9;

/// A point of a law before anything has happened to it.
struct Held<'a> {
    law: &'a dyn Interface,
    penalties: [f64; 2],
    vars: Vec<f64>,
}

impl Held<'_> {
    fn past(&self, penetration: f64, pressure: f64, shear: f64) -> Past<'_> {
        let [penalty, tangential_penalty] = self.penalties;
        Past { penalty, tangential_penalty, penetration, pressure, shear: [shear, 0.0], vars: &self.vars, dt: 1.0 }
    }

    /// What the law answers where nothing moves.
    fn answer(&self, past: &Past) -> Option<Linearised> {
        self.law.respond([past.penetration, 0.0, 0.0], past, &mut self.vars.clone()).ok()
    }

    fn slips(&self, penetration: f64, pressure: f64, shear: f64) -> Option<bool> {
        Some(self.answer(&self.past(penetration, pressure, shear))?.status == Status::Slip)
    }

    /// Pressure at a penetration and the largest shear stress there, sought from `scale` on; whether the surface ends.
    fn at(&self, penetration: f64, scale: f64) -> Option<([f64; 2], bool)> {
        let free = self.answer(&self.past(penetration, 0.0, 0.0))?;
        let pressure = free.pressure();
        if free.status == Status::Slip || self.slips(penetration, pressure, NONE * scale)? {
            return Some(([pressure, 0.0], free.closure > 0.0));
        }
        let (mut low, mut high) = (0.0, scale);
        for _ in 0..HALVINGS {
            if self.slips(penetration, pressure, high)? {
                break;
            }
            (low, high) = (high, 2.0 * high);
        }
        if !self.slips(penetration, pressure, high)? {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if self.slips(penetration, pressure, middle)? { &mut high } else { &mut low }) = middle;
        }
        Some(([pressure, 0.5 * (low + high)], false))
    }
}

/// The yield surface of a law before any motion, up to the given pressure: columns `pressure` and `shear`. None where it
/// has no surface.
pub fn yield_surface(name: &str, law: &dyn Interface, penalties: [f64; 2], most: f64) -> Option<Record> {
    let mut vars = vec![0.0; law.variables().iter().map(|variable| variable.len()).sum()];
    law.initial(&mut vars);
    let held = Held { law, penalties, vars };
    let (touch, mut rows) = (law.touch(&held.past(0.0, 0.0, 0.0)), Vec::new());
    for i in 0..=PRESSURES {
        let penetration = touch + most / penalties[0] * (i as f64 / PRESSURES as f64).max(NONE);
        let (stress, ends) = held.at(penetration, most)?;
        rows.push(stress.to_vec());
        if ends {
            break;
        }
    }
    let columns = ["pressure", "shear"].map(String::from).to_vec();
    let bears = rows.iter().any(|row| row[1] > 0.0);
    bears.then(|| Record { name: format!("{name}, yield surface"), columns, rows })
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_core::interface::Law;
    use asperity_core::interface::laws::{CamClayInterface, Coulomb, Dilatant, Sticking};

    fn rows(law: &dyn Interface) -> Vec<Vec<f64>> {
        yield_surface("a", law, [1e3, 700.0], 200.0).unwrap().rows
    }

    #[test]
    fn surfaces_are_those_of_the_laws() {
        let cone =
            Dilatant { friction: 0.6, cohesion: 4.0, tension: 5.0, dilatancy: 0.3, dilation_slip: 1.0, reset: 0.0 };
        for row in rows(&Law(Coulomb::new(0.3))) {
            assert!((row[1] - 0.3 * row[0]).abs() < 1e-6, "{row:?}");
        }
        let bonded = rows(&Law(cone));
        assert!((bonded[0][0] + 5.0).abs() < 1e-6);
        for row in &bonded {
            // The bond breaks without shear strength.
            let limit = (0.6 * row[0] + 4.0).min(10.0 * (row[0] + 5.0));
            assert!((row[1] - limit).abs() < 1e-6, "{row:?}");
        }
        let ellipse = rows(&Law(CamClayInterface::perfect(0.8, 100.0, 10.0)));
        for row in &ellipse {
            // A cone of ten times the slope cuts the tip off.
            let (p, f) = (row[0] + 10.0, row[1] * row[1] + 0.64 * (row[0] + 10.0) * (row[0] - 100.0));
            let met = 110.0 / 101.0;
            let apart = if p < met { row[1] - 8.0 * p } else { f };
            assert!(apart.abs() < 1e-3, "{row:?} {apart}");
        }
        assert!((ellipse.last().unwrap()[0] - 100.0).abs() < 1e-6 && ellipse.len() < PRESSURES);
    }

    #[test]
    fn what_sticks_slips_only_as_it_opens() {
        for row in rows(&Law(Sticking)) {
            assert!((row[1] - 10.0 * row[0]).abs() < 1e-6 * (1.0 + row[0]), "{row:?}");
        }
    }
}
