//! The small problem of a step over contact stresses: which points close, open, stick or slip over it, and by how much their stresses
//! then miss those of the linear step.
//!
//! What the linear system leaves of a point is `w = t(y) - t0 - C0 (y - y0)`, so that the step is
//! `du = part d - K^-1 H w` with the factor that is there already, and the coordinates over it are
//! `y = y0 + G du = y0 + part G d - S w`, `S = G K^-1 H`. Over the few stresses `w` that are not zero this is a small dense
//! problem. It knows of the model no more than [`ContactLaws`] says. Where it has no solution for the whole step it may have one for a
//! part of it; taking less of it is a search along its path (Ralph, Math. Oper. Res. 19, 1994).

use super::super::constants::small_problem::{
    DESCENT, ENOUGH, FARTHEST, HALVINGS, ITERATIONS, MOST, NOTHING, PIECES, SHORTEST,
};
use super::Unsolved;
use crate::Failure;
use crate::system::{Answer, COORDINATES, Coordinates};
use frontal::Full;

/// A stress: point and coordinate.
pub(super) type Stress = (usize, usize);

/// What the small problem asks of the contact points.
pub(super) trait ContactLaws {
    /// Stresses of a point over its coordinates, and their slopes.
    ///
    /// # Errors
    /// When the law cannot answer.
    fn response(&self, point: usize, y: &Coordinates) -> Result<Answer, Failure>;
    /// The same of a closed point that sticks, whatever its shear.
    ///
    /// # Errors
    /// When the law cannot answer.
    fn sticking(&self, point: usize, y: &Coordinates) -> Result<Answer, Failure>;
    /// `S`: change of the coordinates of all points under a unit of each stress.
    ///
    /// # Errors
    /// When a solution with the factor fails.
    fn compliance(&mut self, stresses: &[Stress]) -> Result<Vec<Vec<Coordinates>>, Unsolved>;
}

/// The contact points over a linear step.
pub(super) struct SmallProblem {
    /// `y0` of each point and the number of its coordinates, and the response there.
    y0: Vec<Coordinates>,
    counts: Vec<usize>,
    start: Vec<Answer>,
    /// `G d` of each point.
    along: Vec<Coordinates>,
    active: Vec<Stress>,
    /// Which coordinates of each point are active, and the points that have active ones.
    is_active: Vec<[bool; COORDINATES]>,
    bent: Vec<usize>,
    /// `S`: change of the coordinates of all points for a unit of each active stress.
    influence: Vec<Vec<Coordinates>>,
    /// `w`, active stress by active stress, and `y` of each point with it.
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
struct Iterate {
    left: Vec<f64>,
    /// Coordinates of all points, of which those of the active ones count.
    y: Vec<Coordinates>,
    /// `w - w(y)`.
    error: Vec<f64>,
    /// Slopes of each active stress along the coordinates of its point.
    slopes: Vec<Coordinates>,
    /// Largest stress.
    size: f64,
}

impl Iterate {
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
    fn at(&self, point: usize, length: f64) -> Coordinates {
        std::array::from_fn(|c| self.y[point][c] + length * self.motion[point][c])
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

/// Adds a multiple of a motion of all points.
fn add(y: &mut [Coordinates], factor: f64, motion: &[Coordinates]) {
    y.as_flattened_mut().iter_mut().zip(motion.as_flattened()).for_each(|(y, motion)| *y += factor * motion);
}

impl SmallProblem {
    /// For points at `y` with so many coordinates each, which the linear step changes by `along`.
    ///
    /// # Errors
    /// When a law cannot answer.
    pub fn new(
        (y, counts): (Vec<Coordinates>, Vec<usize>),
        along: Vec<Coordinates>,
        laws: &dyn ContactLaws,
    ) -> Result<Self, Failure> {
        let start = y.iter().enumerate().map(|(point, y)| laws.response(point, y)).collect::<Result<_, _>>()?;
        let beyond = vec![Coordinates::default(); y.len()];
        let (is_active, bent) = (vec![[false; COORDINATES]; y.len()], Vec::new());
        let (active, influence, left) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { y0: y.clone(), counts, start, along, active, is_active, bent, influence, left, y, beyond })
    }

    /// Puts the step right and returns the part of it for which that could be done; None if for too little of it. Whole
    /// steps of the small problem, each of which finds anew what is open, sticks and slips, mostly lead to its end; where
    /// they do not, the path of solutions is followed from where the step begins.
    ///
    /// # Errors
    /// When a law cannot answer, or a solution with the factor fails.
    pub fn settle(&mut self, laws: &mut dyn ContactLaws) -> Result<Option<f64>, Unsolved> {
        if self.settle_part((1.0, Steps::Whole), laws)?
            || self.stick(laws)? && self.settle_part((1.0, Steps::Whole), laws)?
        {
            return Ok(Some(1.0));
        }
        self.left.fill(0.0);
        let (mut part, mut stride) = (0.0, 1.0_f64);
        while part < 1.0 && stride >= SHORTEST {
            let (mut before, next) = (self.left.clone(), 1.0_f64.min(part + stride));
            if self.settle_part((next, Steps::Searched), laws)? {
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
            if self.follow(sense, laws)? {
                return Ok(Some(1.0));
            }
        }
        Ok(None)
    }

    /// Begins with the stresses that the whole step leaves where all closed points stick; false where none of them slips. Where all
    /// slip little holds the linear step, which leads far from the piece of the laws that holds.
    fn stick(&mut self, laws: &mut dyn ContactLaws) -> Result<bool, Unsolved> {
        let (mut sticking, mut woken) = (vec![Answer::default(); self.y.len()], Vec::new());
        for (point, (left, start)) in sticking.iter_mut().zip(&self.start).enumerate() {
            let now = laws.sticking(point, &self.y0[point])?;
            if are_alike(&now.slopes, &start.slopes) {
                continue;
            }
            for i in 0..self.counts[point] {
                left.stress[i] = now.stress[i] - start.stress[i];
                (0..self.counts[point]).for_each(|j| left.slopes[i][j] = now.slopes[i][j] - start.slopes[i][j]);
                if !self.is_active[point][i] {
                    woken.push((point, i));
                }
            }
        }
        if woken.is_empty() || self.active.len() + woken.len() > MOST {
            return Ok(false);
        }
        self.activate(&woken, laws)?;
        self.left.fill(0.0);
        let y = self.coordinates(&self.left, 1.0);
        let mut slopes = Vec::new();
        for (left, &(point, c)) in self.left.iter_mut().zip(&self.active) {
            let motion = std::array::from_fn(|j| y[point][j] - self.y0[point][j]);
            *left = sticking[point].stress[c] + dot(&sticking[point].slopes[c], &motion);
            slopes.push(sticking[point].slopes[c]);
        }
        let Some(slopes) = Full::factorise(slopes.len(), self.slopes(&slopes)) else { return Ok(false) };
        slopes.solve(&mut self.left);
        Ok(true)
    }

    /// Puts the same part of the step right again, now that the step is known to change the coordinates by `along` where `before` were
    /// the stresses until the last time; false where that fails.
    ///
    /// # Errors
    /// As those of [`settle`](Self::settle).
    pub fn settle_again(
        &mut self,
        (part, before): (f64, &[f64]),
        along: &[Coordinates],
        laws: &mut dyn ContactLaws,
    ) -> Result<bool, Unsolved> {
        let gap = self.gap(along);
        self.learn(before, &gap);
        Ok(self.settle_part((part, Steps::Whole), laws)? || self.settle_part((part, Steps::Searched), laws)?)
    }

    /// The stresses that were put right last.
    pub fn left(&self) -> &[f64] {
        &self.left
    }

    /// What the coordinates of a step that changes them by `along` are beyond those that were found for it.
    fn gap(&self, along: &[Coordinates]) -> Vec<Coordinates> {
        let mut gap = vec![Coordinates::default(); self.y.len()];
        for (point, (gap, y)) in gap.iter_mut().zip(&self.y).enumerate() {
            (0..self.counts[point]).for_each(|c| gap[c] = self.y0[point][c] + along[point][c] - y[c]);
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

    /// What the stresses over a step that changes the coordinates by `along` are beyond those that were put right.
    ///
    /// # Errors
    /// When a law cannot answer.
    pub fn missed(&self, along: &[Coordinates], laws: &dyn ContactLaws) -> Result<Vec<(Stress, f64)>, Failure> {
        let mut known = vec![Coordinates::default(); self.y.len()];
        self.stresses().for_each(|((point, coordinate), w)| known[point][coordinate] = w);
        let mut missed = Vec::new();
        for (point, along) in along.iter().enumerate() {
            let y = std::array::from_fn(|c| self.y0[point][c] + along[c]);
            let (left, _) = self.left_at(point, &y, laws)?;
            let of = left.stress.iter().zip(known[point]).enumerate().take(self.counts[point]);
            missed.extend(of.map(|(c, (now, known))| ((point, c), now - known)));
        }
        Ok(missed)
    }

    /// The stresses that were put right.
    pub fn stresses(&self) -> impl Iterator<Item = (Stress, f64)> {
        self.active.iter().copied().zip(self.left.iter().copied())
    }

    /// Solves for the active stresses until no other wakes.
    fn settle_part(&mut self, (part, steps): (f64, Steps), laws: &mut dyn ContactLaws) -> Result<bool, Unsolved> {
        while self.solve(part, steps, laws)? {
            let woken = self.awake(laws)?;
            if woken.is_empty() {
                return Ok(true);
            }
            self.activate(&woken, laws)?;
        }
        Ok(false)
    }

    /// Follows the path of solutions of `w = w(y)` for all parts of the step through the pieces of the laws, from the beginning of
    /// the step in this sense to its end; false where it does not lead there. Where the determinant changes its sign from a piece
    /// to the next the path turns back: the forces that are left grow until another point gives way (Allgower & Georg, Numerical
    /// Continuation Methods, 1990, ch. 15; for friction Klarbring & Bjorkman, Comput. Struct. 30, 1988).
    fn follow(&mut self, sense: f64, laws: &mut dyn ContactLaws) -> Result<bool, Unsolved> {
        self.left.fill(0.0);
        let all: Vec<usize> = (0..self.y.len()).collect();
        let (mut part, mut ahead) = (0.0, self.problem(self.left.clone(), self.coordinates(&self.left, 0.0), laws)?);
        for _ in 0..PIECES {
            let n = self.active.len();
            let Some(slopes) = Full::factorise(n, self.slopes(&ahead.slopes)) else { return Ok(false) };
            // What is left of the crossing into this piece.
            let mut rest = ahead.error.clone();
            slopes.solve(&mut rest);
            let left: Vec<f64> = ahead.left.iter().zip(&rest).map(|(w, rest)| w - rest).collect();
            let driven = self.active.iter().zip(&ahead.slopes);
            let mut rates: Vec<f64> = driven.map(|(&(point, _), slopes)| dot(slopes, &self.along[point])).collect();
            slopes.solve(&mut rates);
            let turned = if slopes.has_negative_determinant() { -sense } else { sense };
            let end = if turned > 0.0 { 1.0 - part } else { part + FARTHEST };
            rates.iter_mut().for_each(|rate| *rate *= turned);
            let (y, motion) = (self.coordinates(&left, part), self.motion(&rates, turned));
            let piece = Piece { left, rates, y, motion, size: ahead.size };
            // The last piece ended where a law was off it by little more than nothing; as much, the other way, is on this one.
            if !self.leaving(&piece, 0.0, (&all, 10.0 * NOTHING), laws)?.is_empty() {
                return Ok(false);
            }
            let mut leaving = self.leaving(&piece, end, (&all, NOTHING), laws)?;
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
                let found = self.leaving(&piece, middle, (&leaving, NOTHING), laws)?;
                if found.is_empty() {
                    low = middle;
                } else {
                    (high, leaving) = (middle, found);
                }
            }
            (part, self.left) = (part + turned * high, piece.left(high));
            self.y = self.coordinates(&self.left, part);
            let woken = self.awake(laws)?;
            self.activate(&woken, laws)?;
            ahead = self.problem(self.left.clone(), self.coordinates(&self.left, part), laws)?;
        }
        Ok(false)
    }

    /// Of some points those whose laws are off a piece, by more than a part of the largest stress, at a place along it.
    fn leaving(
        &self,
        piece: &Piece,
        length: f64,
        (points, nothing): (&[usize], f64),
        laws: &dyn ContactLaws,
    ) -> Result<Vec<usize>, Failure> {
        let mut known = vec![[0.0; COORDINATES]; self.y.len()];
        self.active.iter().zip(piece.left(length)).for_each(|(&(point, c), w)| known[point][c] = w);
        let mut leaving = Vec::new();
        for &point in points {
            let (left, size) = self.left_at(point, &piece.at(point, length), laws)?;
            let both = left.stress.iter().zip(&known[point]);
            let [off, size] = both.fold([0.0, size.max(piece.size)], |[off, size]: [f64; 2], (w, known)| {
                [off.max((w - known).abs()), size.max(known.abs())]
            });
            if off > nothing * size {
                leaving.push(point);
            }
        }
        Ok(leaving)
    }

    /// Rates of the coordinates of all points where the part of the step and the stresses that are left change at these rates.
    fn motion(&self, rates: &[f64], part: f64) -> Vec<Coordinates> {
        let mut motion = self.along.clone();
        motion.as_flattened_mut().iter_mut().for_each(|along| *along *= part);
        rates.iter().zip(&self.influence).for_each(|(rate, influence)| add(&mut motion, -rate, influence));
        motion
    }

    /// `y0 + part G d - S w` of all points.
    fn coordinates(&self, left: &[f64], part: f64) -> Vec<Coordinates> {
        let mut y = self.y0.clone();
        add(&mut y, part, &self.along);
        add(&mut y, 1.0, &self.beyond);
        left.iter().zip(&self.influence).for_each(|(w, influence)| add(&mut y, -w, influence));
        y
    }

    /// `w(y)` of a point, its slopes, and the size of its stresses.
    fn left_at(&self, point: usize, y: &Coordinates, laws: &dyn ContactLaws) -> Result<(Answer, f64), Failure> {
        let (y0, count, start) = (&self.y0[point], self.counts[point], &self.start[point]);
        let mut now = laws.response(point, y)?;
        let largest = |t: &Coordinates| t.iter().fold(0.0_f64, |m, t| m.max(t.abs()));
        let size = largest(&now.stress).max(largest(&start.stress));
        for i in 0..count {
            let carried: f64 = (0..count).map(|j| start.slopes[i][j] * (y[j] - y0[j])).sum();
            now.stress[i] -= start.stress[i] + carried;
            (0..count).for_each(|j| now.slopes[i][j] -= start.slopes[i][j]);
        }
        Ok((now, size))
    }

    /// Stresses that the step leaves and that are not yet put right.
    fn awake(&self, laws: &dyn ContactLaws) -> Result<Vec<Stress>, Failure> {
        let (mut found, mut largest) = (Vec::new(), 0.0_f64);
        for (number, y) in self.y.iter().enumerate() {
            let (bent, size) = self.left_at(number, y, laws)?;
            largest = largest.max(size);
            let left = bent.stress.into_iter().enumerate().filter(|(_, w)| *w != 0.0);
            found.extend(left.map(|(coordinate, w)| ((number, coordinate), w.abs())));
        }
        found.retain(|(stress, w)| *w > NOTHING * largest && !self.is_active[stress.0][stress.1]);
        found.truncate(MOST - self.active.len());
        Ok(found.into_iter().map(|(stress, _)| stress).collect())
    }

    /// Puts stresses right from now on.
    fn activate(&mut self, woken: &[Stress], laws: &mut dyn ContactLaws) -> Result<(), Unsolved> {
        if woken.is_empty() {
            return Ok(());
        }
        self.influence.extend(laws.compliance(woken)?);
        self.active.extend_from_slice(woken);
        for &(point, coordinate) in woken {
            if self.is_active[point] == [false; COORDINATES] {
                self.bent.push(point);
            }
            self.is_active[point][coordinate] = true;
        }
        self.left.resize(self.active.len(), 0.0);
        Ok(())
    }

    /// Whether there is anything to put right.
    pub fn is_nonsmooth(&self) -> bool {
        !self.active.is_empty()
    }

    /// Solves the small problem for the active stresses by Newton's method.
    fn solve(&mut self, part: f64, steps: Steps, laws: &dyn ContactLaws) -> Result<bool, Failure> {
        let mut at = self.problem(self.left.clone(), self.coordinates(&self.left, part), laws)?;
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
            let Some(slopes) = Full::factorise(at.error.len(), self.slopes(&at.slopes)) else { return Ok(false) };
            let mut step = at.error.clone();
            slopes.solve(&mut step);
            let moved = |&point: &usize| {
                let all = step.iter().zip(&self.influence);
                all.fold(Coordinates::default(), |sum, (d, s)| std::array::from_fn(|c| sum[c] + d * s[point][c]))
            };
            let motion: Vec<Coordinates> = self.bent.iter().map(moved).collect();
            let next = match steps {
                Steps::Whole => Some(self.step(&at, (&step, &motion), 1.0, laws)?),
                Steps::Searched => self.search(&at, (&step, &motion), laws)?,
            };
            let Some(next) = next else { return Ok(false) };
            at = next;
        }
        Ok(false)
    }

    /// Goes along a step as far as that lowers the error.
    fn search(
        &self,
        at: &Iterate,
        step: (&[f64], &[Coordinates]),
        laws: &dyn ContactLaws,
    ) -> Result<Option<Iterate>, Failure> {
        let (norm, mut length) = (at.norm(), 1.0);
        while length >= SHORTEST {
            let next = self.step(at, step, length, laws)?;
            if next.norm() <= (1.0 - DESCENT * length) * norm {
                return Ok(Some(next));
            }
            length *= 0.5;
        }
        Ok(None)
    }

    /// The problem at the end of a step of this length.
    fn step(
        &self,
        at: &Iterate,
        step: (&[f64], &[Coordinates]),
        length: f64,
        laws: &dyn ContactLaws,
    ) -> Result<Iterate, Failure> {
        let left = at.left.iter().zip(step.0).map(|(w, d)| w - length * d).collect();
        let mut y = at.y.clone();
        for (&point, motion) in self.bent.iter().zip(step.1) {
            (0..COORDINATES).for_each(|c| y[point][c] += length * motion[c]);
        }
        self.problem(left, y, laws)
    }

    fn problem(&self, left: Vec<f64>, y: Vec<Coordinates>, laws: &dyn ContactLaws) -> Result<Iterate, Failure> {
        let mut problem = Iterate { left, y, error: Vec::new(), slopes: Vec::new(), size: 0.0 };
        for (left, &(point, coordinate)) in problem.left.iter().zip(&self.active) {
            let (bent, size) = self.left_at(point, &problem.y[point], laws)?;
            problem.size = problem.size.max(size);
            problem.error.push(left - bent.stress[coordinate]);
            problem.slopes.push(bent.slopes[coordinate]);
        }
        Ok(problem)
    }

    /// Derivative of the error along `w`, by rows, for these slopes of the active stresses.
    fn slopes(&self, along: &[Coordinates]) -> Vec<f64> {
        let mut entries = Vec::with_capacity(self.active.len() * self.active.len());
        for (row, (slopes, &(point, _))) in along.iter().zip(&self.active).enumerate() {
            let start = entries.len();
            entries.extend(self.influence.iter().map(|influence| dot(slopes, &influence[point])));
            entries[start + row] += 1.0;
        }
        entries
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contact points by formulas: what their stresses are, and what each does to all coordinates.
    struct Formulas {
        law: fn(&Coordinates) -> Answer,
        /// Change of each coordinate of each point under a unit of the stress at a coordinate of a point.
        compliance: fn(from: Stress, to: Stress) -> f64,
        points: usize,
        asked: usize,
    }

    impl ContactLaws for Formulas {
        fn response(&self, _: usize, y: &Coordinates) -> Result<Answer, Failure> {
            Ok((self.law)(y))
        }
        fn sticking(&self, _: usize, y: &Coordinates) -> Result<Answer, Failure> {
            let mut answer = (self.law)(&[y[0], 0.0, 0.0, 0.0]);
            answer.stress[1] = answer.slopes[1][1] * y[1];
            Ok(answer)
        }
        fn compliance(&mut self, stresses: &[Stress]) -> Result<Vec<Vec<Coordinates>>, Unsolved> {
            self.asked += stresses.len();
            let column = |&from: &Stress| {
                let point = |point: usize| std::array::from_fn(|c| (self.compliance)(from, (point, c)));
                (0..self.points).map(point).collect()
            };
            Ok(stresses.iter().map(column).collect())
        }
    }

    /// A problem over points that begin at `y` and are led along.
    fn problem(formulas: &Formulas, count: usize, y: &[Coordinates], along: &[Coordinates]) -> SmallProblem {
        SmallProblem::new((y.to_vec(), vec![count; y.len()]), along.to_vec(), formulas).expect("laws that answer")
    }

    fn line(y: f64, t: f64, slope: f64) -> Answer {
        let mut answer = Answer::default();
        (answer.stress[0], answer.slopes[0][0]) = (t + slope * y, slope);
        answer
    }

    fn unilateral(y: &Coordinates) -> Answer {
        if y[0] > 0.0 { line(y[0], 0.0, 10.0) } else { Answer::default() }
    }

    /// Two open points are pressed against a stop; the second is led by what the first does.
    #[test]
    fn points_that_close_over_a_step_bear_from_there() {
        let compliance = |from: Stress, to: Stress| match (from.1, to.1) {
            (0, 0) => 0.3 - 0.1 * from.0.abs_diff(to.0) as f64,
            _ => 0.0,
        };
        let mut laws = Formulas { law: unilateral, compliance, points: 2, asked: 0 };
        let start = [[-0.1, 0.0, 0.0, 0.0], [-0.5, 0.0, 0.0, 0.0]];
        let mut small = problem(&laws, 1, &start, &[[1.0, 0.0, 0.0, 0.0]; 2]);
        assert_eq!(small.settle(&mut laws).expect("a solution"), Some(1.0));
        // 4 w0 + 2 w1 = 9, 2 w0 + 4 w1 = 5, in tenths.
        let left: Vec<f64> = small.stresses().map(|(_, w)| w).collect();
        let expected = [26.0 / 12.0, 2.0 / 12.0];
        assert!(left.iter().zip(expected).all(|(w, e)| (w - e).abs() < 1e-12), "{left:?}");
        assert!(small.is_nonsmooth() && laws.asked == 2);
    }

    #[test]
    fn a_step_over_which_nothing_changes_is_left_alone() {
        let mut laws = Formulas { law: unilateral, compliance: |_, _| 1.0, points: 1, asked: 0 };
        let mut small = problem(&laws, 1, &[[0.2, 0.0, 0.0, 0.0]], &[[-0.1, 0.0, 0.0, 0.0]]);
        assert_eq!(small.settle(&mut laws).expect("a solution"), Some(1.0));
        assert!(!small.is_nonsmooth() && laws.asked == 0);
    }

    /// Pressure and shear over penetration and slip, by Coulomb's law.
    fn coulomb(y: &Coordinates) -> Answer {
        let mut answer = Answer::default();
        if y[0] <= 0.0 {
            return answer;
        }
        (answer.stress[0], answer.slopes[0][0]) = (10.0 * y[0], 10.0);
        let (trial, limit) = (10.0 * y[1], 0.3 * answer.stress[0]);
        if trial.abs() <= limit {
            (answer.stress[1], answer.slopes[1][1]) = (trial, 10.0);
        } else {
            (answer.stress[1], answer.slopes[1][0]) = (limit * trial.signum(), 3.0 * trial.signum());
        }
        answer
    }

    #[test]
    fn a_point_that_slips_over_a_step_keeps_its_law() {
        let compliance = |from: Stress, to: Stress| if from.1 == to.1 && from.1 < 2 { 0.05 } else { 0.0 };
        let mut laws = Formulas { law: coulomb, compliance, points: 1, asked: 0 };
        let (start, along) = ([0.1, 0.0, 0.0, 0.0], [0.02, 0.2, 0.0, 0.0]);
        let mut small = problem(&laws, 2, &[start], &[along]);
        assert_eq!(small.settle(&mut laws).expect("a solution"), Some(1.0));
        let y = small.y[0];
        let after = coulomb(&y);
        assert!((after.stress[1] - 0.3 * after.stress[0]).abs() < 1e-12 && after.slopes[1][1] == 0.0);
        // The pressure goes on in its line; what the shear leaves is what it is beyond that of sticking.
        let left = after.stress[1] - 10.0 * y[1];
        assert!((y[1] - (0.2 - 0.05 * left)).abs() < 1e-12 && (y[0] - 0.12).abs() < 1e-12, "{y:?}");
    }

    /// Two points slip against each other, a third a little, and nothing but a soft spring holds what they are on: a small force leads
    /// the linear step far away, where all slip the same way. The third, once it sticks, bears it.
    #[test]
    fn what_slips_everywhere_is_held_by_a_point_that_sticks_again() {
        let compliance = |from: Stress, to: Stress| if from.1 == 1 && to.1 == 1 { 1e3 } else { 0.0 };
        let mut laws = Formulas { law: coulomb, compliance, points: 3, asked: 0 };
        let start = [0.5, -0.5, -0.04].map(|slip| [0.1, slip, 0.0, 0.0]);
        let mut small = problem(&laws, 2, &start, &[[0.0, 300.0, 0.0, 0.0]; 3]);
        assert!(
            !small.settle_part((1.0, Steps::Whole), &mut laws).expect("laws that answer"),
            "it goes round in a circle"
        );
        assert!(small.stick(&mut laws).expect("a start"));
        assert!(small.settle_part((1.0, Steps::Whole), &mut laws).expect("laws that answer"));
        // 0.001 shift + 10 y + 0.3 = 0.3, shift = y + 0.04.
        let y = -0.00004 / 10.001;
        assert!((small.y[2][1] - y).abs() < 1e-9 && (small.y[0][1] - y - 0.54).abs() < 1e-9, "{:?}", small.y);
    }

    /// It hardens, softens and hardens again, all with the same slope.
    fn snaps(y: &Coordinates) -> Answer {
        match y[0] {
            y if y < 1.0 => line(y, 0.0, 1.0),
            y if y < 2.0 => line(y, 2.0, -1.0),
            y => line(y, -2.0, 1.0),
        }
    }

    /// While the law softens faster than what holds it does, the path of solutions leads back; behind that it goes on.
    #[test]
    fn a_path_that_turns_back_is_followed_to_its_end() {
        let mut laws = Formulas { law: snaps, compliance: |_, to| f64::from(u8::from(to.1 == 0)), points: 1, asked: 0 };
        let mut small = problem(&laws, 1, &[[0.0; 4]], &[[3.0, 0.0, 0.0, 0.0]]);
        // Whole steps jump over it.
        assert_eq!(small.settle(&mut laws).expect("a solution"), Some(1.0));
        assert!(small.follow(1.0, &mut laws).expect("a path"));
        assert!((small.left()[0] + 2.0).abs() < 1e-12 && (small.y[0][0] - 5.0).abs() < 1e-12, "{:?}", small.y);
    }

    /// It softens for ever.
    fn fails(y: &Coordinates) -> Answer {
        if y[0] < 1.0 { line(y[0], 0.0, 1.0) } else { line(y[0], 2.0, -1.0) }
    }

    #[test]
    fn a_step_beyond_what_a_law_can_bear_is_shortened_to_it() {
        let compliance = |_: Stress, to: Stress| f64::from(u8::from(to.1 == 0));
        let mut laws = Formulas { law: fails, compliance, points: 1, asked: 0 };
        for (far, expected) in [(3.0, 0.3..=1.0 / 3.0), (1.5, 0.6..=2.0 / 3.0)] {
            let mut small = problem(&laws, 1, &[[0.0; 4]], &[[far, 0.0, 0.0, 0.0]]);
            let part = small.settle(&mut laws).expect("laws that answer").expect("a part of it");
            assert!(expected.contains(&part) && small.y[0][0] <= 1.0, "{part}");
            assert!(!small.follow(1.0, &mut laws).expect("a path"), "there is no such solution");
        }
        let mut small = problem(&laws, 1, &[[0.0; 4]], &[[9.0, 0.0, 0.0, 0.0]]);
        assert_eq!(small.settle(&mut laws).expect("laws that answer"), None, "too little of it");
    }

    /// By an old factor the compliance is a tenth off; what comes of the stresses tells, solution by solution.
    #[test]
    fn a_compliance_that_is_roughly_known_learns() {
        let compliance = |_: Stress, to: Stress| 0.9 * f64::from(u8::from(to.1 == 0));
        let mut laws = Formulas { law: unilateral, compliance, points: 1, asked: 0 };
        let mut small = problem(&laws, 1, &[[-0.1, 0.0, 0.0, 0.0]], &[[1.0, 0.0, 0.0, 0.0]]);
        assert_eq!(small.settle(&mut laws).expect("a solution"), Some(1.0));
        let (mut before, mut misses) = (Vec::new(), Vec::new());
        for _ in 0..3 {
            let left = small.left().to_vec();
            let along = [[1.0 - left[0], 0.0, 0.0, 0.0]];
            misses.push(small.missed(&along, &laws).expect("an answer")[0].1.abs());
            assert!(small.settle_again((1.0, &before), &along, &mut laws).expect("a solution"));
            before = left;
        }
        assert!((small.left()[0] - 9.0 / 11.0).abs() < 1e-9 && misses[2] < 1e-9 * misses[0], "{misses:?}");
    }
}
