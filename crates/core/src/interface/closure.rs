//! Pressure over penetration by a table, in place of the straight line of a penalty: rough or coated surfaces, which grow
//! stiffer as they come closer.
//!
//! With the pressure `p(u)` of the table and a penalty `K`, a law sees the penetration `p(u)/K` that the penalty would need, so
//! that friction stays what it is. Stresses are those of undeformed area, as a penalty gives them.

use super::{Interface, Linearised, Past};
use crate::Failure;
use crate::declare::Variable;
use crate::integrate::Update;
use std::sync::Arc;

/// A table of pressure over penetration, straight between its rows and beyond the last.
#[derive(Debug, Clone, PartialEq)]
pub struct Closure {
    rows: Vec<[f64; 2]>,
}

impl Closure {
    /// From rows of penetration and pressure.
    ///
    /// # Errors
    /// In words, where they do not begin at zero or do not rise.
    pub fn new(rows: Vec<[f64; 2]>) -> Result<Self, String> {
        if rows.len() < 2 || rows[0] != [0.0, 0.0] {
            return Err("pressure over penetration begins with [0.0, 0.0], and has two rows at least".into());
        }
        match rows.windows(2).find(|two| two[1][0] <= two[0][0] || two[1][1] <= two[0][1]) {
            Some([_, [u, p]]) => {
                Err(format!("penetration and pressure must rise from row to row; [{u}, {p}] does not"))
            }
            _ => Ok(Self { rows }),
        }
    }

    /// The largest slope, a stress per length.
    pub fn steepest(&self) -> f64 {
        self.rows.windows(2).map(slope).fold(0.0, f64::max)
    }

    /// Pressure and its slope at a penetration.
    fn at(&self, penetration: f64) -> (f64, f64) {
        let two = self.piece(|row| row[0] <= penetration);
        (two[0][1] + slope(two) * (penetration - two[0][0]), slope(two))
    }

    /// Energy of an undeformed area under a pressure, `int p du`.
    fn stored(&self, pressure: f64) -> f64 {
        let last = self.piece(|row| row[1] <= pressure);
        let whole = self.rows.windows(2).take_while(|two| two[0] != last[0]);
        let sum: f64 = whole.map(|two| 0.5 * (two[0][1] + two[1][1]) * (two[1][0] - two[0][0])).sum();
        sum + 0.5 * (pressure * pressure - last[0][1] * last[0][1]) / slope(last)
    }

    /// The rows around what lies behind all rows that are `below`.
    fn piece(&self, below: impl Fn(&[f64; 2]) -> bool) -> &[[f64; 2]] {
        let first = self.rows.partition_point(below).clamp(1, self.rows.len() - 1) - 1;
        &self.rows[first..first + 2]
    }
}

fn slope(two: &[[f64; 2]]) -> f64 {
    (two[1][1] - two[0][1]) / (two[1][0] - two[0][0])
}

/// A law whose pressure follows from a table.
pub struct Closing {
    law: Arc<dyn Interface>,
    closure: Arc<Closure>,
    steepest: f64,
}

impl Closing {
    /// A law under a table; with another penalty than the steepest slope the pressures are in proportion to it.
    ///
    /// # Errors
    /// In words, for a law whose pressure is not the penalty times the penetration.
    pub fn new(law: Arc<dyn Interface>, closure: Arc<Closure>) -> Result<Self, String> {
        let (steepest, mut old) = (closure.steepest(), vec![0.0; law.variables().iter().map(|v| v.len()).sum()]);
        law.initial(&mut old);
        let (mut new, depth, mut straight) = (old.clone(), closure.rows[1][0], true);
        let (penalty, shear) = (steepest, [0.0; 2]);
        let past =
            Past { penalty, tangential_penalty: penalty, penetration: 0.0, pressure: 0.0, shear, vars: &old, dt: 1.0 };
        for [into, slip] in [[depth, 0.0], [depth, depth], [2.0 * depth, 10.0 * depth]] {
            let answer = law.respond([into, slip, 0.0], &past, &mut new).map_err(|failure| failure.to_string())?;
            straight &= (answer.pressure() / (penalty * into) - 1.0).abs() < 1e-9;
        }
        if straight && law.radius() == 0.0 && law.touch(&past) == 0.0 {
            Ok(Self { law, closure, steepest })
        } else {
            Err("pressure over penetration is for laws whose pressure follows from the penalty at the point".into())
        }
    }

    /// The penetration that the penalty would need, and its derivative.
    fn equivalent(&self, penetration: f64) -> (f64, f64) {
        let (pressure, slope) = self.closure.at(penetration);
        (pressure / self.steepest, slope / self.steepest)
    }

    fn seen<'a>(&self, past: &Past<'a>) -> Past<'a> {
        Past { penetration: self.equivalent(past.penetration).0, ..*past }
    }
}

impl Interface for Closing {
    fn variables(&self) -> &'static [Variable] {
        self.law.variables()
    }
    fn initial(&self, vars: &mut [f64]) {
        self.law.initial(vars);
    }
    fn release(&self, old: &[f64], new: &mut [f64]) {
        self.law.release(old, new);
    }
    fn touch(&self, past: &Past) -> f64 {
        self.law.touch(&self.seen(past))
    }
    fn keeps(&self, past: &Past) -> f64 {
        self.law.keeps(&self.seen(past))
    }
    fn opens(&self, past: &Past, slip: [f64; 2]) -> f64 {
        self.law.opens(&self.seen(past), slip)
    }
    fn respond(&self, [penetration, s, t]: [f64; 3], past: &Past, vars: &mut [f64]) -> Result<Linearised, Failure> {
        let (equivalent, slope) = self.equivalent(penetration);
        let mut answer = self.law.respond([equivalent, s, t], &self.seen(past), vars)?;
        answer.slopes.iter_mut().for_each(|row| row[0] *= slope);
        Ok(answer)
    }
    fn stored(&self, pressure: f64, penalty: f64) -> f64 {
        let part = penalty / self.steepest;
        part * self.closure.stored(pressure / part)
    }
    fn is_compliant(&self) -> bool {
        true
    }
    fn radius(&self) -> f64 {
        0.0
    }
    fn sliding_stress(&self, pressure: f64) -> Option<f64> {
        self.law.sliding_stress(pressure)
    }
    fn with_update(&self, update: Update) -> Result<Box<dyn Interface>, String> {
        let law = Arc::from(self.law.with_update(update)?);
        Ok(Box::new(Self { law, closure: self.closure.clone(), steepest: self.steepest }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::Law;
    use crate::interface::laws::Coulomb;

    fn table() -> Closure {
        Closure::new(vec![[0.0, 0.0], [0.1, 1.0], [0.3, 11.0]]).unwrap()
    }

    #[test]
    fn a_table_is_straight_between_its_rows_and_beyond() {
        let table = table();
        assert!((table.steepest() - 50.0).abs() < 1e-12);
        for (u, p, k) in [(0.05, 0.5, 10.0), (0.2, 6.0, 50.0), (0.4, 16.0, 50.0), (-0.1, -1.0, 10.0)] {
            let (pressure, slope) = table.at(u);
            assert!((pressure - p).abs() < 1e-13 && (slope - k).abs() < 1e-12, "{u}: {pressure} {slope}");
        }
        // 0.05 under the first piece, 0.1 (1 + 6) / 2 under half of the second.
        assert!((table.stored(6.0) - 0.4).abs() < 1e-13 && (table.stored(0.5) - 0.0125).abs() < 1e-15);
    }

    #[test]
    fn friction_is_that_of_the_pressure_of_the_table() {
        let law: Arc<dyn Interface> = Arc::new(Law(Coulomb::new(0.3)));
        let law = Closing::new(law, Arc::new(table())).unwrap();
        let past = Past {
            penalty: 50.0,
            tangential_penalty: 50.0,
            penetration: 0.05,
            pressure: 0.5,
            shear: [0.0; 2],
            vars: &[],
            dt: 1.0,
        };
        let answer = law.respond([0.2, 1.0, 0.0], &past, &mut []).unwrap();
        assert!((answer.pressure() - 6.0).abs() < 1e-13 && (answer.shear()[0] - 1.8).abs() < 1e-13);
        let step = 1e-6;
        let other = law.respond([0.2 + step, 1.0, 0.0], &past, &mut []).unwrap();
        for i in 0..2 {
            let slope = (other.stress[i] - answer.stress[i]) / step;
            assert!((answer.slopes[i][0] - slope).abs() < 1e-6 * 50.0, "{slope} {:?}", answer.slopes);
        }
        // Per undeformed area: twice the penalty bears twice as much.
        assert!((law.stored(12.0, 100.0) - 0.8).abs() < 1e-13);
        assert!((Law(Coulomb::new(0.3)).stored(12.0, 100.0) - 0.72).abs() < 1e-13);
    }

    #[test]
    fn tables_that_do_not_rise_are_refused() {
        for rows in [vec![], vec![[0.0, 0.0]], vec![[0.1, 0.0], [0.2, 1.0]], vec![[0.0, 0.0], [0.1, 1.0], [0.2, 1.0]]] {
            assert!(Closure::new(rows).is_err());
        }
    }
}
