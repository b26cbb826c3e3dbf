//! Newton's step on a piecewise smooth function: the solution of the linear system, put right for the stencils that
//! close, open, stick or slip over it.
//!
//! What the linear system leaves of a stencil that bends is `w = t(y) - t0 - C0 (y - y0)`, so that the step is
//! `du = part d - K^-1 H w` with the factor that is there already, and the coordinates over it are
//! `y = y0 + G du = y0 + part G d - S w`, `S = G K^-1 H`. Over the few stresses `w` that are not zero this is a small dense
//! problem. Where it has no solution for the whole step it may have one for a part of it. The step is that of Newton's
//! method for B-differentiable functions (Pang, Math. Oper. Res. 15, 1990), taking less of it a search along its path
//! (Ralph, Math. Oper. Res. 19, 1994).

use super::influences::{Influences, Site};
use super::linear::LinearSolver;
use crate::Failure;
use crate::system::{Answer, COORDINATES, Coordinates};
use frontal::Full;

/// Stresses that the linear system leaves count from this part of the largest stress on.
const NOTHING: f64 = 1e-9;
/// Iterations for the small problem.
const ITERATIONS: usize = 40;
/// Shortest step of its line search and along its path, and what a searched step must lower the error by, over its length.
const SHORTEST: f64 = 0.01;
const DESCENT: f64 = 0.1;
/// Part of a step below which the whole linear step does better: what bends has met its limit, and only another geometry
/// may carry more.
const ENOUGH: f64 = 0.25;
/// Most pieces that a path is followed through, halvings of the way to the end of one, and how far back it may lead.
const PIECES: usize = 40;
const HALVINGS: usize = 50;
const FARTHEST: f64 = 100.0;
/// Most stresses that are put right: more cost as much as a new matrix.
const MOST: usize = 512;

/// The columns of the factor there is, and the solver that holds it.
type Factored<'s> = (&'s mut Influences, &'s dyn LinearSolver);

/// A stress: kink and coordinate.
type Stress = (usize, usize);

/// The stencils that bend over a linear step.
pub(super) struct Piecewise<'a> {
    site: Site<'a>,
    start: Vec<Answer>,
    /// `G d` of each kink.
    along: Vec<Coordinates>,
    active: Vec<Stress>,
    /// Which coordinates of each kink are active, and the kinks that have active ones.
    is_active: Vec<[bool; COORDINATES]>,
    bent: Vec<usize>,
    /// `S`: change of the coordinates of all kinks for a unit of each active stress.
    influence: Vec<Vec<Coordinates>>,
    /// `w`, active stress by active stress, and `y` of each kink with it.
    left: Vec<f64>,
    y: Vec<Coordinates>,
    /// What the coordinates are beyond those that `S` leads to, which is that of an old factor put right.
    beyond: Vec<Coordinates>,
}

/// How far the steps of the small problem go.
#[derive(Clone, Copy)]
enum Steps {
    /// All the way.
    Whole,
    /// As far as they lower the error.
    Searched,
}

/// The small problem at some `w`.
struct Problem {
    left: Vec<f64>,
    /// Coordinates of all kinks, of which those of the active ones count.
    y: Vec<Coordinates>,
    /// `w - w(y)`.
    error: Vec<f64>,
    /// Slopes of each active stress along the coordinates of its kink.
    slopes: Vec<Coordinates>,
    /// Largest stress.
    size: f64,
}

impl Problem {
    fn norm(&self) -> f64 {
        self.error.iter().map(|e| e * e).sum::<f64>().sqrt()
    }
}

/// The solutions on one piece of the laws: along them stresses and coordinates change linearly.
struct Piece {
    left: Vec<f64>,
    rates: Vec<f64>,
    y: Vec<Coordinates>,
    motion: Vec<Coordinates>,
    /// Largest stress where it begins.
    size: f64,
}

impl Piece {
    fn left(&self, length: f64) -> Vec<f64> {
        self.left.iter().zip(&self.rates).map(|(w, rate)| w + length * rate).collect()
    }
    fn at(&self, kink: usize, length: f64) -> Coordinates {
        std::array::from_fn(|c| self.y[kink][c] + length * self.motion[kink][c])
    }
}

fn dot(a: &Coordinates, b: &Coordinates) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Whether slopes of laws differ by no more than rounding.
fn are_alike(a: &[Coordinates], b: &[Coordinates]) -> bool {
    let (a, b) = (a.as_flattened(), b.as_flattened());
    let size = a.iter().fold(0.0_f64, |size, slope| size.max(slope.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= NOTHING * size)
}

/// Adds a multiple of a motion of all kinks.
fn add(y: &mut [Coordinates], factor: f64, motion: &[Coordinates]) {
    y.as_flattened_mut().iter_mut().zip(motion.as_flattened()).for_each(|(y, motion)| *y += factor * motion);
}

impl<'a> Piecewise<'a> {
    /// For the linear step `direction`, on all unknowns.
    pub fn new(site: Site<'a>, direction: &[f64]) -> Result<Self, Failure> {
        let Site { attempts, kinks, .. } = site;
        let start = kinks.list().iter().map(|kink| attempts[kink.term].answer(kink.stencil, &kink.y));
        let start = start.collect::<Result<_, _>>()?;
        let along = kinks.list().iter().map(|kink| kinks.along(kink, direction)).collect();
        let y: Vec<Coordinates> = kinks.list().iter().map(|kink| kink.y).collect();
        let beyond = vec![Coordinates::default(); y.len()];
        let (is_active, bent) = (vec![[false; COORDINATES]; y.len()], Vec::new());
        let (active, influence, left) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { site, start, along, active, is_active, bent, influence, left, y, beyond })
    }

    /// Puts the step right and returns the part of it for which that could be done; None if for too little of it. Whole
    /// steps of the small problem, each of which finds anew what is open, sticks and slips, mostly lead to its end; where
    /// they do not, the path of solutions is followed from where the step begins.
    ///
    /// # Errors
    /// When a law cannot answer, or a solution with the factor fails.
    pub fn settle(&mut self, (influences, solver): Factored) -> Result<Option<f64>, Failure> {
        if self.settle_part((1.0, Steps::Whole), (influences, solver))? {
            return Ok(Some(1.0));
        }
        self.left.fill(0.0);
        let (mut part, mut stride) = (0.0, 1.0_f64);
        while part < 1.0 && stride >= SHORTEST {
            let (mut before, next) = (self.left.clone(), 1.0_f64.min(part + stride));
            if self.settle_part((next, Steps::Searched), (influences, solver))? {
                (part, stride) = (next, 2.0 * stride);
            } else {
                before.resize(self.left.len(), 0.0);
                self.left = before;
                stride *= 0.25;
            }
        }
        self.y = self.coordinates(&self.left, part);
        if part >= ENOUGH {
            return Ok(Some(part));
        }
        for sense in [1.0, -1.0] {
            if self.follow(sense, (influences, solver))? {
                return Ok(Some(1.0));
            }
        }
        Ok(None)
    }

    /// Puts the same part of the step right again, now that the step is known to be `du` where `before` were the stresses
    /// until the last time; false where that fails.
    ///
    /// # Errors
    /// As those of [`settle`](Self::settle).
    pub fn settle_again(
        &mut self,
        (part, before): (f64, &[f64]),
        du: &[f64],
        factored: Factored,
    ) -> Result<bool, Failure> {
        let gap = self.gap(du);
        self.learn(before, &gap);
        let (influences, solver) = factored;
        Ok(self.settle_part((part, Steps::Whole), (influences, solver))?
            || self.settle_part((part, Steps::Searched), (influences, solver))?)
    }

    /// The stresses that were put right last.
    pub fn left(&self) -> &[f64] {
        &self.left
    }

    /// What the coordinates of the step `du` are beyond those that were found for it.
    fn gap(&self, du: &[f64]) -> Vec<Coordinates> {
        let mut gap = vec![Coordinates::default(); self.y.len()];
        for ((kink, gap), y) in self.site.kinks.list().iter().zip(&mut gap).zip(&self.y) {
            let change = self.site.kinks.along(kink, du);
            (0..kink.count).for_each(|c| gap[c] = kink.y[c] + change[c] - y[c]);
        }
        gap
    }

    /// Has `S` say of the last change of the stresses what came of it, with the least change of `S` (Broyden, Math. Comp.
    /// 19, 1965).
    fn learn(&mut self, before: &[f64], gap: &[Coordinates]) {
        let before = before.iter().copied().chain(std::iter::repeat(0.0));
        let change: Vec<f64> = self.left.iter().zip(before).map(|(now, before)| now - before).collect();
        let square: f64 = change.iter().map(|c| c * c).sum();
        if square == 0.0 {
            return add(&mut self.beyond, 1.0, gap);
        }
        for (influence, change) in self.influence.iter_mut().zip(&change) {
            add(influence, -change / square, gap);
        }
        let said: f64 = change.iter().zip(&self.left).map(|(change, left)| change * left).sum();
        add(&mut self.beyond, 1.0 - said / square, gap);
    }

    /// The forces that the step `du` leaves because its stresses are not those that were put right.
    ///
    /// # Errors
    /// When a law cannot answer.
    pub fn miss(&self, du: &[f64]) -> Result<Vec<f64>, Failure> {
        let mut forces = vec![0.0; du.len()];
        let mut known = vec![Coordinates::default(); self.y.len()];
        self.active.iter().zip(&self.left).for_each(|(&(kink, coordinate), w)| known[kink][coordinate] = *w);
        for (number, kink) in self.site.kinks.list().iter().enumerate() {
            let change = self.site.kinks.along(kink, du);
            let (bent, _) = self.bend(number, &std::array::from_fn(|c| kink.y[c] + change[c]))?;
            for (c, (now, known)) in bent.stress.iter().zip(known[number]).enumerate().take(kink.count) {
                self.site.kinks.push(kink, c, now - known, &mut forces);
            }
        }
        Ok(forces)
    }

    /// Solves for the active stresses until no other wakes.
    fn settle_part(&mut self, (part, steps): (f64, Steps), (influences, solver): Factored) -> Result<bool, Failure> {
        while self.solve(part, steps)? {
            let woken = self.awake()?;
            if woken.is_empty() {
                return Ok(true);
            }
            self.activate(&woken, (influences, solver))?;
        }
        Ok(false)
    }

    /// Follows the path of solutions of `w = w(y)` for all parts of the step through the pieces of the laws, from the beginning of
    /// the step in this sense to its end; false where it does not lead there. Where the determinant changes its sign from a piece
    /// to the next the path turns back: the forces that are left grow until another stencil gives way (Allgower & Georg, Numerical
    /// Continuation Methods, 1990, ch. 15; for friction Klarbring & Bjorkman, Comput. Struct. 30, 1988).
    fn follow(&mut self, sense: f64, (influences, solver): Factored) -> Result<bool, Failure> {
        self.left.fill(0.0);
        let all: Vec<usize> = (0..self.y.len()).collect();
        let (mut part, mut ahead) = (0.0, self.problem(self.left.clone(), self.coordinates(&self.left, 0.0))?);
        for _ in 0..PIECES {
            let n = self.active.len();
            let Some(slopes) = Full::factorise(n, self.slopes(&ahead)) else { return Ok(false) };
            // What is left of the crossing into this piece.
            let mut rest = ahead.error.clone();
            slopes.solve(&mut rest);
            let left: Vec<f64> = ahead.left.iter().zip(&rest).map(|(w, rest)| w - rest).collect();
            let driven = self.active.iter().zip(&ahead.slopes);
            let mut rates: Vec<f64> = driven.map(|(&(kink, _), slopes)| dot(slopes, &self.along[kink])).collect();
            slopes.solve(&mut rates);
            let turned = if slopes.has_negative_determinant() { -sense } else { sense };
            let end = if turned > 0.0 { 1.0 - part } else { part + FARTHEST };
            rates.iter_mut().for_each(|rate| *rate *= turned);
            let (y, motion) = (self.coordinates(&left, part), self.motion(&rates, turned));
            let piece = Piece { left, rates, y, motion, size: ahead.size };
            if !self.leaving(&piece, 0.0, &all)?.is_empty() {
                return Ok(false);
            }
            let mut leaving = self.leaving(&piece, end, &all)?;
            if leaving.is_empty() {
                if turned < 0.0 {
                    return Ok(false);
                }
                self.left = piece.left(end);
                self.y = self.coordinates(&self.left, 1.0);
                return Ok(true);
            }
            let [mut low, mut high] = [0.0, end];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                let found = self.leaving(&piece, middle, &leaving)?;
                if found.is_empty() {
                    low = middle;
                } else {
                    (high, leaving) = (middle, found);
                }
            }
            (part, self.left) = (part + turned * high, piece.left(high));
            self.y = self.coordinates(&self.left, part);
            let woken = self.awake()?;
            self.activate(&woken, (influences, solver))?;
            ahead = self.problem(self.left.clone(), self.coordinates(&self.left, part))?;
        }
        Ok(false)
    }

    /// Of some kinks those whose laws are on another piece at a place along one.
    fn leaving(&self, piece: &Piece, length: f64, kinks: &[usize]) -> Result<Vec<usize>, Failure> {
        let mut known = vec![[0.0; COORDINATES]; self.y.len()];
        self.active.iter().zip(piece.left(length)).for_each(|(&(kink, c), w)| known[kink][c] = w);
        let mut leaving = Vec::new();
        for &kink in kinks {
            let (bent, size) = self.bend(kink, &piece.at(kink, length))?;
            let off = bent.stress.iter().zip(&known[kink]).fold(0.0_f64, |off, (w, known)| off.max((w - known).abs()));
            if off > NOTHING * size.max(piece.size) {
                leaving.push(kink);
            }
        }
        Ok(leaving)
    }

    /// Rates of the coordinates of all kinks where the part of the step and the stresses that are left change at these rates.
    fn motion(&self, rates: &[f64], part: f64) -> Vec<Coordinates> {
        let mut motion: Vec<Coordinates> = self.along.clone();
        motion.as_flattened_mut().iter_mut().for_each(|along| *along *= part);
        rates.iter().zip(&self.influence).for_each(|(rate, influence)| add(&mut motion, -rate, influence));
        motion
    }

    /// `y0 + part G d - S w` of all kinks.
    fn coordinates(&self, left: &[f64], part: f64) -> Vec<Coordinates> {
        let mut y: Vec<Coordinates> = self.site.kinks.list().iter().map(|kink| kink.y).collect();
        add(&mut y, part, &self.along);
        add(&mut y, 1.0, &self.beyond);
        left.iter().zip(&self.influence).for_each(|(w, influence)| add(&mut y, -w, influence));
        y
    }

    /// `w(y)` of a kink, its slopes, and the size of its stresses.
    fn bend(&self, number: usize, y: &Coordinates) -> Result<(Answer, f64), Failure> {
        let (kink, start) = (&self.site.kinks.list()[number], &self.start[number]);
        let mut now = self.site.attempts[kink.term].answer(kink.stencil, y)?;
        let largest = |t: &Coordinates| t.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
        let size = largest(&now.stress).max(largest(&start.stress));
        for i in 0..kink.count {
            let carried: f64 = (0..kink.count).map(|j| start.slopes[i][j] * (y[j] - kink.y[j])).sum();
            now.stress[i] -= start.stress[i] + carried;
            (0..kink.count).for_each(|j| now.slopes[i][j] -= start.slopes[i][j]);
        }
        Ok((now, size))
    }

    /// Stresses that the step leaves and that are not yet put right.
    fn awake(&self) -> Result<Vec<Stress>, Failure> {
        let (mut found, mut largest) = (Vec::new(), 0.0_f64);
        for (number, y) in self.y.iter().enumerate() {
            let (bent, size) = self.bend(number, y)?;
            largest = largest.max(size);
            let left = bent.stress.into_iter().enumerate().filter(|(_, w)| *w != 0.0);
            found.extend(left.map(|(coordinate, w)| ((number, coordinate), w.abs())));
        }
        found.retain(|(stress, w)| *w > NOTHING * largest && !self.is_active[stress.0][stress.1]);
        found.truncate(MOST - self.active.len());
        Ok(found.into_iter().map(|(stress, _)| stress).collect())
    }

    /// Puts stresses right from now on.
    fn activate(&mut self, woken: &[Stress], (influences, solver): Factored) -> Result<(), Failure> {
        if woken.is_empty() {
            return Ok(());
        }
        let (kinks, columns) = (self.site.kinks, &mut self.influence);
        let take = |motion: &[f64]| columns.push(kinks.list().iter().map(|kink| kinks.along(kink, motion)).collect());
        let responded = influences.respond(woken, (self.site, solver), take);
        responded.map_err(|error| Failure::from(&error))?;
        self.active.extend_from_slice(woken);
        for &(kink, coordinate) in woken {
            if self.is_active[kink] == [false; COORDINATES] {
                self.bent.push(kink);
            }
            self.is_active[kink][coordinate] = true;
        }
        self.left.resize(self.active.len(), 0.0);
        Ok(())
    }

    /// Whether there is anything to put right.
    pub fn bends(&self) -> bool {
        !self.active.is_empty()
    }

    /// The forces of what was put right, on so many unknowns.
    pub fn forces(&self, unknowns: usize) -> Vec<f64> {
        let mut forces = vec![0.0; unknowns];
        for (&(kink, coordinate), &w) in self.active.iter().zip(&self.left) {
            self.site.kinks.push(&self.site.kinks.list()[kink], coordinate, w, &mut forces);
        }
        forces
    }

    /// Solves the small problem for the active stresses by Newton's method.
    fn solve(&mut self, part: f64, steps: Steps) -> Result<bool, Failure> {
        let mut at = self.problem(self.left.clone(), self.coordinates(&self.left, part))?;
        let mut met: Vec<Vec<Coordinates>> = Vec::new();
        for _ in 0..ITERATIONS {
            if at.norm() <= NOTHING * at.size {
                self.y = self.coordinates(&at.left, part);
                self.left = at.left;
                return Ok(true);
            }
            // A whole step from a piece of linear laws that it came to before leads round in a circle.
            if matches!(steps, Steps::Whole) {
                if met.iter().any(|met| are_alike(met, &at.slopes)) {
                    return Ok(false);
                }
                met.push(at.slopes.clone());
            }
            let Some(slopes) = Full::factorise(at.error.len(), self.slopes(&at)) else { return Ok(false) };
            let mut step = at.error.clone();
            slopes.solve(&mut step);
            let moved = |&kink: &usize| {
                let all = step.iter().zip(&self.influence);
                all.fold(Coordinates::default(), |sum, (d, s)| std::array::from_fn(|c| sum[c] + d * s[kink][c]))
            };
            let motion: Vec<Coordinates> = self.bent.iter().map(moved).collect();
            let next = match steps {
                Steps::Whole => Some(self.along(&at, (&step, &motion), 1.0)?),
                Steps::Searched => self.search(&at, (&step, &motion))?,
            };
            let Some(next) = next else { return Ok(false) };
            at = next;
        }
        Ok(false)
    }

    /// Goes along a step as far as that lowers the error.
    fn search(&self, at: &Problem, step: (&[f64], &[Coordinates])) -> Result<Option<Problem>, Failure> {
        let (norm, mut length) = (at.norm(), 1.0);
        while length >= SHORTEST {
            let next = self.along(at, step, length)?;
            if next.norm() <= (1.0 - DESCENT * length) * norm {
                return Ok(Some(next));
            }
            length *= 0.5;
        }
        Ok(None)
    }

    /// The problem at the end of a step of this length.
    fn along(&self, at: &Problem, step: (&[f64], &[Coordinates]), length: f64) -> Result<Problem, Failure> {
        let left = at.left.iter().zip(step.0).map(|(w, d)| w - length * d).collect();
        let mut y = at.y.clone();
        for (&kink, motion) in self.bent.iter().zip(step.1) {
            (0..COORDINATES).for_each(|c| y[kink][c] += length * motion[c]);
        }
        self.problem(left, y)
    }

    fn problem(&self, left: Vec<f64>, y: Vec<Coordinates>) -> Result<Problem, Failure> {
        let mut problem = Problem { left, y, error: Vec::new(), slopes: Vec::new(), size: 0.0 };
        for (left, &(kink, coordinate)) in problem.left.iter().zip(&self.active) {
            let (bent, size) = self.bend(kink, &problem.y[kink])?;
            problem.size = problem.size.max(size);
            problem.error.push(left - bent.stress[coordinate]);
            problem.slopes.push(bent.slopes[coordinate]);
        }
        Ok(problem)
    }

    /// Derivative of the error along `w`, by rows.
    fn slopes(&self, at: &Problem) -> Vec<f64> {
        let mut entries = Vec::with_capacity(self.active.len() * self.active.len());
        for (row, (slopes, &(kink, _))) in at.slopes.iter().zip(&self.active).enumerate() {
            let start = entries.len();
            entries.extend(self.influence.iter().map(|influence| dot(slopes, &influence[kink])));
            entries[start + row] += 1.0;
        }
        entries
    }
}
