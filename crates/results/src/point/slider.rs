//! One point of an interface driven along a path of penetration, pressure and slip.
//!
//! Slip is prescribed. Across the interface one of four holds: a penetration, a pressure, the pressure that was there,
//! or a spring behind it, `p = p_0 + k (u_0 - u)`: the wall of a stiff body that dilation pushes back. What is prescribed
//! as pressure is found by Newton's method with the law's derivative, kept inside a bracket.

use super::table::Record;
use asperity_core::interface::{Interface, Past, Status};
use asperity_core::{Error, Failure};

/// Most times that an increment is halved.
const HALVINGS: u32 = 14;
/// Largest difference from a prescribed pressure, as a ratio to the pressures at hand.
const TOLERANCE: f64 = 1e-12;
/// The same where penetrations cannot be told apart any more.
const ROUNDED: f64 = 1e-6;
const LIMIT: usize = 200;

/// What a stage prescribes across the interface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Normal {
    /// The penetration goes to this value.
    Penetration(f64),
    /// The pressure goes to this value.
    Pressure(f64),
    /// A spring of this stiffness, a stress per length, holds the interface from behind.
    Stiffness(f64),
}

/// A part of a path: what is prescribed goes along a straight line from where it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Slide {
    /// What messages call it.
    pub name: String,
    /// How long it lasts.
    pub duration: f64,
    /// Number of equal increments.
    pub increments: usize,
    /// What is prescribed across the interface.
    pub normal: Normal,
    /// Slip since the beginning of the path, along the two tangents.
    pub slip: [f64; 2],
}

/// A point of an interface: its law and what it has been through.
#[derive(Clone)]
pub struct InterfaceDriver<'a> {
    law: &'a dyn Interface,
    penalties: [f64; 2],
    /// Penetration, negative for a gap.
    pub penetration: f64,
    /// Slip since the beginning of the path.
    pub slip: [f64; 2],
    /// Pressure.
    pub pressure: f64,
    /// Shear stress along the two tangents.
    pub shear: [f64; 2],
    /// The law's variables.
    pub vars: Vec<f64>,
    /// Nothing where the point is open.
    pub status: Option<Status>,
    /// Irreversible slip, accumulated without sign.
    pub slipped: f64,
    /// Irreversible closure; negative for dilation.
    pub closure: f64,
    /// Energy dissipated per area.
    pub dissipated: f64,
    /// Relative excess over the yield surface in the last increment.
    pub violation: f64,
    /// Time.
    pub time: f64,
}

/// A stage as the point meets it.
struct Ends {
    time: f64,
    duration: f64,
    slip: [[f64; 2]; 2],
    normal: Across,
}

/// `p + k u` or `u` from one value to another.
enum Across {
    Penetration([f64; 2]),
    Sum { stiffness: f64, ends: [f64; 2] },
}

/// A trial end of an increment: its point, the pressure and its slope with penetration.
type Trial<'a> = (InterfaceDriver<'a>, f64);

impl<'a> InterfaceDriver<'a> {
    /// A point that just does not touch, with the normal and the tangential penalty.
    pub fn new(law: &'a dyn Interface, penalties: [f64; 2]) -> Self {
        let mut vars = vec![0.0; law.variables().iter().map(|variable| variable.len()).sum()];
        law.initial(&mut vars);
        Self {
            law,
            penalties,
            penetration: 0.0,
            slip: [0.0; 2],
            pressure: 0.0,
            shear: [0.0; 2],
            vars,
            status: None,
            slipped: 0.0,
            closure: 0.0,
            dissipated: 0.0,
            violation: 0.0,
            time: 0.0,
        }
    }

    /// Goes along a stage and calls `seen` at the end of each of its increments. An increment that the law or the
    /// iteration refuses is halved.
    ///
    /// # Errors
    /// [`Error::NotConverged`] with the stage, the time and the reason where the path cannot be followed.
    pub fn follow(&mut self, stage: &Slide, mut seen: impl FnMut(&Self)) -> Result<(), Error> {
        let (ends, steps) = (self.ends(stage), stage.increments as f64);
        for i in 0..stage.increments {
            self.advance(&ends, [i as f64 / steps, (i + 1) as f64 / steps], 0).map_err(|failure| {
                let lost = "the path cannot be followed beyond the time";
                Error::NotConverged(format!("{}: {lost} {}: {failure}", stage.name, self.time))
            })?;
            seen(self);
        }
        Ok(())
    }

    fn ends(&self, stage: &Slide) -> Ends {
        let normal = match stage.normal {
            Normal::Penetration(end) => Across::Penetration([self.penetration, end]),
            Normal::Pressure(end) => Across::Sum { stiffness: 0.0, ends: [self.pressure, end] },
            Normal::Stiffness(stiffness) => {
                let sum = self.pressure + stiffness * self.penetration;
                Across::Sum { stiffness, ends: [sum, sum] }
            }
        };
        Ends { time: self.time, duration: stage.duration, slip: [self.slip, stage.slip], normal }
    }

    fn advance(&mut self, ends: &Ends, [from, to]: [f64; 2], depth: u32) -> Result<(), Failure> {
        match self.attempt(ends, [from, to]) {
            Err(_) if depth < HALVINGS => {
                let middle = 0.5 * (from + to);
                self.advance(ends, [from, middle], depth + 1)?;
                self.advance(ends, [middle, to], depth + 1)
            }
            Err(failure) => Err(failure),
            Ok(next) => {
                *self = next;
                Ok(())
            }
        }
    }

    fn attempt(&self, ends: &Ends, [from, to]: [f64; 2]) -> Result<Self, Failure> {
        let along = |[a, b]: [f64; 2]| a + (b - a) * to;
        let slip = [0, 1].map(|i| along([ends.slip[0][i], ends.slip[1][i]]) - self.slip[i]);
        let dt = ends.duration * (to - from);
        let mut next = match ends.normal {
            Across::Penetration(two) => self.trial(along(two), slip, dt)?.0,
            Across::Sum { stiffness, ends } => self.balance(stiffness, along(ends), slip, dt)?,
        };
        next.time = ends.time + ends.duration * to;
        Ok(next)
    }

    fn past(&self, dt: f64) -> Past<'_> {
        let past = Past {
            penalty: self.penalties[0],
            tangential_penalty: self.penalties[1],
            penetration: self.penetration,
            pressure: self.pressure,
            shear: self.shear,
            vars: &self.vars,
            dt,
        };
        Past { penetration: self.penetration.max(self.law.touch(&past)), ..past }
    }

    /// The end of an increment at a penetration, and the slope of its pressure.
    fn trial(&self, penetration: f64, slip: [f64; 2], dt: f64) -> Result<Trial<'a>, Failure> {
        let (past, mut next) = (self.past(dt), self.clone());
        (next.penetration, next.slip) = (penetration, [0, 1].map(|i| self.slip[i] + slip[i]));
        let touch = self.law.touch(&past);
        if penetration <= self.law.opens(&Past { penetration: self.penetration, ..past }, slip) {
            self.law.release(&self.vars, &mut next.vars);
            (next.pressure, next.shear, next.status, next.violation) = (0.0, [0.0; 2], None, 0.0);
            return Ok((next, 0.0));
        }
        // Slip before the touch is none.
        let before = self.penetration - touch;
        let part = if before < 0.0 { (penetration - touch) / (penetration - self.penetration) } else { 1.0 };
        let response = self.law.respond([penetration, slip[0] * part, slip[1] * part], &past, &mut next.vars)?;
        let stress = response.stress;
        if !stress.iter().chain(&next.vars).all(|x| x.is_finite()) {
            return Err(Failure::new("the stress is not finite"));
        }
        (next.pressure, next.shear) = (stress[0], [stress[1], stress[2]]);
        next.status = Some(response.status);
        next.slipped += response.slipped;
        next.closure += response.closure;
        next.dissipated += response.dissipated;
        next.violation = response.violation;
        Ok((next, response.slopes[0][0]))
    }

    /// The end of an increment at which `p + k u` has a value.
    fn balance(&self, stiffness: f64, wanted: f64, slip: [f64; 2], dt: f64) -> Result<Self, Failure> {
        let scale = wanted.abs().max(self.pressure.abs()) + stiffness * self.penetration.abs();
        let at = |u: f64| self.trial(u, slip, dt);
        let miss = |(next, _): &Trial| next.pressure + stiffness * next.penetration - wanted;
        let [mut low, mut high] = self.bracket(wanted, &at, &miss)?;
        let mut u = self.penetration.clamp(low, high);
        for _ in 0..LIMIT {
            let trial = at(u)?;
            let (error, slope) = (miss(&trial), trial.1 + stiffness);
            let narrow = high - low <= 4.0 * f64::EPSILON * high.abs().max(low.abs());
            if error.abs() <= TOLERANCE * scale || (narrow && error.abs() <= ROUNDED * scale) {
                return Ok(trial.0);
            }
            if narrow {
                return Err(Failure::new("the pressure jumps where the increment begins to touch"));
            }
            *(if error > 0.0 { &mut high } else { &mut low }) = u;
            let newton = u - error / slope;
            u = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        }
        Err(Failure::new("the prescribed pressure is not reached"))
    }

    /// Penetrations between which the miss changes its sign.
    fn bracket(
        &self,
        wanted: f64,
        at: &impl Fn(f64) -> Result<Trial<'a>, Failure>,
        miss: &impl Fn(&Trial) -> f64,
    ) -> Result<[f64; 2], Failure> {
        let unit = (wanted.abs() + self.pressure.abs()) / self.penalties[0] + f64::EPSILON * self.penetration.abs();
        let unit = unit.max(f64::MIN_POSITIVE);
        let beyond = || Failure::new("the prescribed pressure is out of reach");
        let reach = |sign: f64| -> Result<f64, Failure> {
            let mut closed = self.penetration;
            for u in (0..60).map(|k| self.penetration + sign * unit * 2.0_f64.powi(k)) {
                let trial = at(u)?;
                if miss(&trial) * sign >= 0.0 {
                    return Ok(u);
                }
                if trial.0.status.is_some() {
                    closed = u;
                } else if sign < 0.0 {
                    // A bond lets go at its tension: the least pressure is that of the last closed point.
                    let last = self.last_closed([u, closed], at)?;
                    let rounding = TOLERANCE * wanted.abs();
                    return if miss(&at(last)?) <= rounding { Ok(last) } else { Err(beyond()) };
                }
            }
            Err(beyond())
        };
        Ok([reach(-1.0)?, reach(1.0)?])
    }

    /// The last penetration of a closed point between an open and a closed one.
    fn last_closed(
        &self,
        [mut open, mut closed]: [f64; 2],
        at: &impl Fn(f64) -> Result<Trial<'a>, Failure>,
    ) -> Result<f64, Failure> {
        for _ in 0..LIMIT {
            let middle = 0.5 * (open + closed);
            if middle == open || middle == closed {
                break;
            }
            *(if at(middle)?.0.status.is_some() { &mut closed } else { &mut open }) = middle;
        }
        Ok(closed)
    }
}

/// Columns of every law, before those of its variables.
pub const COLUMNS: [&str; 14] = [
    "time",
    "penetration",
    "slip_s",
    "slip_t",
    "slip",
    "pressure",
    "shear_s",
    "shear_t",
    "shear",
    "closure",
    "slip_path",
    "dissipated_energy",
    "status",
    "violation",
];

/// Names of the columns recorded of a law.
pub fn columns(law: &dyn Interface) -> Vec<String> {
    let variables = law.variables().iter().map(|variable| variable.name);
    let new = variables.filter(|name| !COLUMNS.contains(name));
    COLUMNS.into_iter().chain(new).map(str::to_string).collect()
}

/// Drives a law along a path and records a row at the beginning and at the end of each increment; with what stopped it
/// where the path cannot be followed to its end.
pub fn drive(name: &str, law: &dyn Interface, penalties: [f64; 2], stages: &[Slide]) -> (Record, Option<Error>) {
    let mut slider = InterfaceDriver::new(law, penalties);
    let mut record = Record { name: name.into(), columns: columns(law), rows: vec![slider.row()] };
    let mut follow = |stage| slider.follow(stage, |slider| record.rows.push(slider.row()));
    let stopped = stages.iter().try_for_each(&mut follow).err();
    (record, stopped)
}

impl InterfaceDriver<'_> {
    fn row(&self) -> Vec<f64> {
        let size = |v: [f64; 2]| v[0].hypot(v[1]);
        let status = self.status.map_or(0.0, |status| f64::from(status as u8));
        let [slip, shear] = [self.slip, self.shear];
        let common = [
            self.time,
            self.penetration,
            slip[0],
            slip[1],
            size(slip),
            self.pressure,
            shear[0],
            shear[1],
            size(shear),
            self.closure,
            self.slipped,
            self.dissipated,
            status,
            self.violation,
        ];
        let variables = self.law.variables().iter().zip(&self.vars);
        let new = variables.filter(|(variable, _)| !COLUMNS.contains(&variable.name)).map(|(_, value)| *value);
        common.into_iter().chain(new).collect()
    }
}
