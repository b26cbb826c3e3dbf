//! Hertz's pressure `p = p0 sqrt(1 - x^2/a^2)` under a round body on a rigid plane, beside that of contact points on
//! meshes ever finer.

use crate::bench::{Bench, both_forms, points, resultant};
use crate::{Measured, fit};
use asperity::Error;
use asperity::contact::ContactRecord;

/// A deck with its theory.
pub struct Study {
    /// The deck, in the folder of the case.
    pub deck: &'static str,
    /// Changes of the deck that cut every cell into `n` by `n`.
    pub refined: fn(n: usize) -> Vec<String>,
    /// Whole force over that of the contact points: 2 if half of the body is modelled.
    pub share: f64,
    /// The whole force at the end.
    pub force: f64,
    /// Radius of contact `a` and largest pressure `p0` under a force.
    pub theory: fn(force: f64) -> (f64, f64),
}

impl Study {
    /// With the contact that is the default, and with points.
    pub fn measure(&self, bench: &Bench) -> Result<Measured, Error> {
        both_forms(&["contact.foot.form=paper"], |form| self.measure_form(bench, form))
    }

    /// `a`, `p0`, the error of the pressure and the force on the finest mesh; the order of the error if there are more.
    fn measure_form(&self, bench: &Bench, form: &[String]) -> Result<Measured, Error> {
        let levels = (0..bench.pick(1, 3)).map(|level| self.solve(bench, 1 << level, form));
        let levels = levels.collect::<Result<Vec<_>, _>>()?;
        let errors: Vec<f64> = levels.iter().map(|(_, error)| *error).collect();
        let finest = &levels[levels.len() - 1].0;
        let (a, p0) = fit::hertz(&finest.iter().map(|p| (p.position[0], p.pressure)).collect::<Vec<_>>());
        let mut measured = vec![
            ("a".into(), a),
            ("p0".into(), p0),
            ("pressure".into(), errors[errors.len() - 1]),
            ("force".into(), self.carried(finest)),
        ];
        if errors.len() > 1 {
            measured.push(("order".into(), fit::order(&errors)));
        }
        Ok(measured)
    }

    /// The points at the end, and the mean error of the pressure over the increments of the second half of the load, as it
    /// depends on where within an edge the contact ends.
    fn solve(&self, bench: &Bench, n: usize, form: &[String]) -> Result<(Vec<ContactRecord>, f64), Error> {
        let mut errors = Vec::new();
        let run = bench.follow(self.deck, &[&(self.refined)(n), form].concat(), |model, state| {
            let points = points(model, state, 0);
            if self.carried(&points) > 0.5 * self.force {
                errors.push(self.pressure_error(&points));
            }
        })?;
        Ok((run.points(0), errors.iter().sum::<f64>() / errors.len() as f64))
    }

    fn carried(&self, points: &[ContactRecord]) -> f64 {
        self.share * resultant(points)[1]
    }

    /// `|p - p_Hertz| / |p_Hertz|` in L2 over the contact points, with Hertz's pressure for the force that they carry.
    fn pressure_error(&self, points: &[ContactRecord]) -> f64 {
        let (a, p0) = (self.theory)(self.carried(points));
        let (mut error, mut norm) = (0.0, 0.0);
        for point in points {
            let exact = p0 * (1.0 - (point.position[0] / a).powi(2)).max(0.0).sqrt();
            error += point.area * (point.pressure - exact).powi(2);
            norm += point.area * exact * exact;
        }
        (error / norm).sqrt()
    }
}
