//! Loss of stability, from the signs of the pivots: those of L D L^T have as many negative ones as the matrix has negative
//! eigenvalues (Sylvester's law of inertia), those of L U the sign of the determinant. Where these change from one accepted
//! increment to the next the path went through a bifurcation or a limit point. The eigenvalue nearest to zero is followed by one
//! inverse iteration an increment, so that where it changes its sign the time between can be told.
//!
//! An increment that was solved with an older factor has no signs of its own. The vector is then improved by one step of steepest
//! descent of the Rayleigh quotient, with the old factor as preconditioner: two products with the matrix of the last iteration and
//! a substitution. A negative quotient proves a negative eigenvalue of the symmetric part (Courant and Fischer); where its sign is
//! not the one that the last pivots said, this matrix is factorised and counted. Increments are passed over in which the quotient,
//! carried on in time, keeps more than half of itself.

use super::constants::stability::{BACKWARDS, BEGUN, CHANGED, DEFORMS, FOLLOWED, KEPT, PASSED, SAME, SETTLED, TOWARDS};
use super::linear::LinearSystem;
use super::newton::Memory;
use super::observer::AttemptRecord;
use super::path::Sprung;
use super::problem::{Problem, largest};
use super::snap::Snap;
use super::step::norm;
use crate::system::{Constraints, Signs, Softest, State};
use std::time::{Duration, Instant};

/// A change of the number of negative eigenvalues of the tangent between two accepted states.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// Times of the states.
    pub times: [f64; 2],
    /// Negative eigenvalues at them,
    pub negative: [usize; 2],
    /// if they were counted; else those of an unsymmetric tangent, of which the first makes the determinant negative and its symmetric part
    /// tells of more.
    pub counted: bool,
    /// When the eigenvalue nearest to zero passes it, linear between the two, if it was followed.
    pub critical: Option<f64>,
    /// Its mode on all unknowns, the largest entry one.
    pub mode: Vec<f64>,
    /// The unknown that moves most, in words.
    pub largest: String,
}

impl std::fmt::Display for Turn {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ([from, to], [before, after]) = (self.times, self.negative);
        let what =
            if after > before { "bifurcation or limit point" } else { "return from a bifurcation or limit point" };
        write!(f, "{what} between time {from:.5} and {to:.5}")?;
        if let Some(critical) = self.critical {
            write!(f, ", at about {critical:.5}")?;
        }
        match self.counted {
            true => write!(f, ": {before} negative eigenvalues of the stiffness before and {after} after")?,
            false => write!(f, ": the determinant of the stiffness changes its sign")?,
        }
        if !self.counted && after > 1 {
            write!(f, " once more, and its symmetric part has {after} negative eigenvalues")?;
        }
        write!(f, "; the mode is largest at {}", self.largest)
    }
}

impl Turn {
    /// Whether the way to `u` over which stability was lost leads back along the mode, by a good part of what the increment before led along it:
    /// a shape that is not perfect leaves towards one side, and Newton's method has come to the branch beyond, which is not stable. Of a first
    /// increment nothing tells the side: one that is shorter does.
    pub(super) fn crosses(&self, state: &State, (u, dt): (&[f64], f64), size: f64) -> bool {
        if self.negative[1] < self.negative[0] || state.last_dt == 0.0 {
            return self.negative[1] > self.negative[0];
        }
        let change =
            u.iter().zip(&state.u).zip(&self.mode).map(|((now, before), mode)| (now - before) * mode).sum::<f64>();
        let carried = dot(&state.last_change, &self.mode) * (dt / state.last_dt);
        change * carried < 0.0
            && change.abs() > (BACKWARDS * carried.abs()).max(TOWARDS * size * dot(&self.mode, &self.mode))
    }

    /// Whether its mode deforms bodies: one that carries them along as they are is held by contact alone, which may snap to and fro.
    pub(super) fn deforms(&self, problem: &Problem) -> bool {
        let squares = problem.wholes.iter().map(|whole| whole.squares(&problem.dofs, &self.mode));
        let [all, left] = squares.fold([0.0; 2], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
        left > DEFORMS * DEFORMS * all
    }
}

/// What a run knows of its stability, besides what its state holds.
#[derive(Debug, Default)]
pub struct Stability {
    /// Changes so far, without their modes.
    pub turns: Vec<Turn>,
    /// Increments that jumped.
    pub snaps: Vec<Snap>,
    /// Matrices that were factorised to count their signs.
    pub counted: usize,
    /// Time that it took.
    pub spent: Duration,
}

/// An accepted increment whose matrix is looked at.
pub(super) struct Look<'a> {
    pub problem: &'a Problem,
    pub record: &'a AttemptRecord,
    /// The matrix of the last iteration, with its pattern in the memory.
    pub values: &'a [f64],
    pub memory: &'a Memory,
    pub system: &'a mut LinearSystem,
    /// What the factor has besides the stiffness.
    pub sprung: Option<Sprung>,
}

impl<'a> Look<'a> {
    fn constraints(&self) -> &'a Constraints {
        &self.problem.steps[self.record.step].constraints
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn scale(x: &mut [f64], factor: f64) {
    x.iter_mut().for_each(|x| *x *= factor);
}

impl Stability {
    /// Looks at the matrix of an attempt that is about to be accepted and says whether the number of negative eigenvalues has
    /// changed since it was known last.
    pub(super) fn look(&mut self, state: &mut State, mut look: Look) -> Option<Turn> {
        let begun = Instant::now();
        let fresh = look.record.iterations.iter().any(|line| line.factorised);
        let turn = match look.record.relaxed {
            true => None,
            false if fresh => self.count(state, &mut look),
            false => self.suspects(state, &mut look).then(|| self.factorise(state, &mut look)).flatten(),
        };
        self.keep(&turn, begun);
        turn
    }

    /// The same with a matrix that has no factor yet.
    pub(super) fn look_at(&mut self, state: &mut State, mut look: Look) -> Option<Turn> {
        let begun = Instant::now();
        let turn = self.factorise(state, &mut look);
        self.keep(&turn, begun);
        turn
    }

    /// Keeps a turn that was found, and the time that it took.
    fn keep(&mut self, turn: &Option<Turn>, begun: Instant) {
        self.turns.extend(turn.clone().map(|turn| Turn { mode: Vec::new(), ..turn }));
        self.spent += begun.elapsed();
    }

    /// Forgets the turn that was found last: its increment is not accepted, or it is looked at again.
    pub(super) fn forget_last(&mut self) {
        self.turns.pop();
    }

    /// Improves the softest mode by the old factor; whether its quotient has not the sign that the last pivots said.
    fn suspects(&self, state: &mut State, look: &mut Look) -> bool {
        let (pattern, record) = (look.memory.workspace.pattern(), look.record);
        let (Some(softest), Some(signs)) = (&mut state.softest, state.signs) else { return false };
        let same = look.problem.steps[softest.step].constraints.free() == look.constraints().free();
        if softest.step == record.step && passes_over(softest, record.time) {
            softest.passed += 1;
            return false;
        }
        if !same || softest.mode.len() != look.constraints().free_count() || look.values.len() != pattern.columns.len()
        {
            return false;
        }
        let x = &softest.mode;
        let times = |x: &[f64]| {
            let mut product = pattern.times(look.values, x);
            look.memory.workspace.shares().complete(&mut product).ok().map(|()| product)
        };
        let Some(image) = times(x) else { return false };
        let quotient = dot(x, &image);
        let mut way: Vec<f64> = image.iter().zip(x).map(|(image, x)| image - quotient * x).collect();
        if !look.system.substitute(&mut way) {
            return false;
        }
        let along = dot(x, &way);
        way.iter_mut().zip(x).for_each(|(way, x)| *way -= along * x);
        let length = norm(&way);
        if !(length > 0.0 && length.is_finite()) {
            return false;
        }
        scale(&mut way, 1.0 / length);
        // The lesser eigenvector of the matrix on the plane of both.
        let Some(moved) = times(&way) else { return false };
        let (mixed, other) = (0.5 * (dot(x, &moved) + dot(&way, &image)), dot(&way, &moved));
        let (mean, half) = (0.5 * (quotient + other), 0.5 * (other - quotient));
        let least = mean - half.hypot(mixed);
        let (c, s) = if mixed == 0.0 && half >= 0.0 { (1.0, 0.0) } else { (half + half.hypot(mixed), -mixed) };
        let size = c.hypot(s);
        let (c, s) = if size > 0.0 { (c / size, s / size) } else { (0.0, 1.0) };
        softest.mode.iter_mut().zip(&way).for_each(|(x, way)| *x = c * *x + s * way);
        let suspected = (least < 0.0) != (signs.negative > 0) && least.abs() > 2.0 * softest.refuted.abs();
        if suspected {
            // What it was before tells when it passed zero.
            softest.refuted = least;
        } else {
            let slope = softest.slope_to((record.step, record.time), least);
            let (step, time) = (record.step, record.time);
            *softest = Softest { eigenvalue: least, time, step, slope, passed: 0, ..std::mem::take(softest) };
        }
        suspected
    }

    /// Counts the signs of a matrix that has no factor of its own. The factor is that of the accepted state then, and serves on.
    fn factorise(&mut self, state: &mut State, look: &mut Look) -> Option<Turn> {
        self.counted += 1;
        look.sprung = None;
        let workspace = &look.memory.workspace;
        look.system.set_pattern(workspace.analysis(), workspace.pattern(), look.constraints().free());
        let factorised = look.system.factorise(look.values);
        factorised.ok().and_then(|()| self.count(state, look))
    }

    /// Negative eigenvalues of the symmetric part of a matrix that is factorised, where all of it is known here. Its own factor is there again
    /// after that.
    fn negative_in_symmetric_part(&mut self, look: &mut Look) -> Option<usize> {
        let pattern = look.memory.workspace.pattern();
        if pattern.rows() != look.constraints().free_count() || look.sprung.is_some() {
            return None;
        }
        self.counted += 1;
        let factorised = look.system.factorise(&pattern.symmetric_part(look.values)).ok();
        let signs = look.system.signs().filter(|signs| factorised.is_some() && signs.symmetric);
        look.system.factorise(look.values).ok()?;
        signs.map(|signs| signs.negative)
    }

    /// Takes the signs of the factor there is.
    fn count(&mut self, state: &mut State, look: &mut Look) -> Option<Turn> {
        let (problem, record) = (look.problem, look.record);
        let frontal::PivotSigns { symmetric, mut negative } = look.system.signs()?;
        let more = look.sprung.as_ref().map_or(0, Sprung::more);
        negative = if symmetric { negative + more } else { (negative + more) % 2 };
        let constraints = look.constraints();
        let now = Signs { time: record.time, step: record.step, symmetric, negative };
        let last = state.signs.take();
        // An undeformed model is taken for stable, and its determinant for positive; numbers can be compared whatever is free,
        // determinants cannot.
        let begun = Signs { time: record.time - record.dt, step: record.step, symmetric: true, negative: 0 };
        let last = if record.increment == 1 { Some(begun) } else { last };
        let alike = |step: usize| problem.steps[step].constraints.free() == constraints.free();
        let same = last.filter(|last| symmetric && last.symmetric || alike(last.step));
        let before = state.softest.take().filter(|softest| {
            same.is_some_and(|last| last.time <= softest.time) && alike(softest.step) && record.increment > 1
        });
        // Of what is not symmetric at both no more is known than whether the number is odd.
        let counted = same.is_some_and(|last| last.symmetric && symmetric);
        let changed =
            same.filter(|last| if counted { last.negative != negative } else { last.negative % 2 != negative % 2 });
        // The second of them makes the determinant positive again.
        if let Some(last) = changed.filter(|last| !symmetric && last.negative > 0) {
            let all = self.negative_in_symmetric_part(look).filter(|all| *all > last.negative);
            negative = all.map_or(negative, |all| all - (all + negative) % 2);
        } else if let Some(last) = same.filter(|_| !symmetric && changed.is_none()) {
            negative = last.negative;
        }
        state.signs = Some(Signs { negative, ..now });
        // Something of every mode.
        let any = |k: usize| ((k + 1) as f64 * 1.618_033_988_749_895).fract() - 0.5;
        let begin = || (0..constraints.free_count()).map(any).collect();
        let iterations = match (changed, &before) {
            (Some(_), _) => CHANGED,
            (None, Some(_)) => FOLLOWED,
            (None, None) => BEGUN,
        };
        let mode = before.as_ref().map_or_else(begin, |before| before.mode.clone());
        let (mode, eigenvalue) = nearest((look.system, look.sprung.as_ref()), mode, iterations)?;
        let turn = changed.map(|last| {
            let passed = before.as_ref().and_then(|before| {
                let same = dot(&before.mode, &mode).abs() >= SAME && before.eigenvalue * eigenvalue < 0.0;
                let part = before.eigenvalue / (before.eigenvalue - eigenvalue);
                same.then_some((before.time, before.time + part * (record.time - before.time)))
            });
            let mut all = vec![0.0; state.u.len()];
            constraints.expand(&mode, &mut all);
            let most = largest(&all).unwrap_or(0);
            let size = all[most];
            all.iter_mut().for_each(|x| *x /= size);
            Turn {
                times: [passed.map_or(last.time, |(from, _)| from), record.time],
                negative: [last.negative, negative],
                counted,
                critical: passed.map(|(_, critical)| critical),
                largest: problem.name_of(most),
                mode: all,
            }
        });
        let refuted = before.as_ref().filter(|_| changed.is_none()).map_or(0.0, |before| before.refuted);
        let slope = before.and_then(|before| before.slope_to((record.step, record.time), eigenvalue));
        let (step, time) = (record.step, record.time);
        state.softest = Some(Softest { mode, eigenvalue, time, step, slope, passed: 0, refuted });
        turn
    }
}

/// Whether the softest mode loses so much of its stiffness, carried on over an increment, that it must be looked at.
pub(super) fn softens(state: &State, dt: f64) -> bool {
    let falls = |softest: &Softest| {
        let left = softest.carried(state.time + dt);
        softest.step == state.step && left.is_some_and(|left| left <= KEPT * softest.eigenvalue)
    };
    state.softest.as_ref().is_some_and(falls)
}

/// Whether the quotient, carried on to a time, stays where it need not be looked at.
fn passes_over(softest: &Softest, time: f64) -> bool {
    softest.passed < PASSED && softest.carried(time).is_some_and(|carried| carried / softest.eigenvalue > KEPT)
}

/// The eigenvector nearest to the null space by inverse iterations, and its eigenvalue; none where they lead nowhere.
fn nearest(
    (system, sprung): (&mut LinearSystem, Option<&Sprung>),
    mut mode: Vec<f64>,
    most: usize,
) -> Option<(Vec<f64>, f64)> {
    let mut eigenvalue = f64::INFINITY;
    for _ in 0..most {
        let length = norm(&mode);
        scale(&mut mode, 1.0 / length);
        let mut image = mode.clone();
        if !system.substitute(&mut image) {
            return None;
        }
        sprung.iter().for_each(|sprung| sprung.without(&mut image));
        let inverse = dot(&mode, &image);
        let (before, length) = (std::mem::replace(&mut eigenvalue, 1.0 / inverse), norm(&image));
        if !(length > 0.0 && length.is_finite() && inverse != 0.0) {
            return None;
        }
        mode = image;
        scale(&mut mode, 1.0 / length);
        if (before - eigenvalue).abs() <= SETTLED * eigenvalue.abs() {
            break;
        }
    }
    Some((mode, eigenvalue))
}
