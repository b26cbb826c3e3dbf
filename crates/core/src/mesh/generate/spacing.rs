//! Stations along one direction: where the lattice lines of a generated part stand.

use crate::error::Error;

/// More cells than this along one direction are taken for a slip of the pen.
const MOST_CELLS: usize = 10_000_000;

/// Stations along one direction: a start and one or more runs of cells, each to the next breakpoint.
///
/// A Hertz mesh, fine over the contact and growing away from it without a jump of size:
/// `Spacing::from(0.0).run(1.0, 40, Grade::UNIFORM).run(50.0, 30, Grade::Smooth)`.
#[derive(Debug, Clone, PartialEq)]
pub struct Spacing {
    /// Where the first cell begins, a length (degrees along an arc).
    pub from: f64,
    /// The runs, in order; their ends increase.
    pub runs: Vec<SpacingRun>,
}

/// Cells up to a breakpoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpacingRun {
    /// The breakpoint, in the units of [`Spacing::from`].
    pub to: f64,
    /// Number of cells, at least one.
    pub cells: usize,
    /// How their sizes change along the run.
    pub grade: Grade,
}

/// How the sizes of the cells of a run change: always as a geometric series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Grade {
    /// Size of the last cell over the size of the first.
    Ratio(f64),
    /// The series that continues the last cell of the run before: no jump of size at the breakpoint.
    Smooth,
}

impl Grade {
    /// All cells alike.
    pub const UNIFORM: Grade = Grade::Ratio(1.0);
}

impl Spacing {
    /// A start without cells yet; add runs with [`Spacing::run`].
    pub fn from(from: f64) -> Self {
        Self { from, runs: Vec::new() }
    }
    /// Equal cells between two ends.
    pub fn uniform(from: f64, to: f64, cells: usize) -> Self {
        Self::graded(from, to, cells, 1.0)
    }
    /// Cells between two ends, the last `ratio` times as large as the first.
    pub fn graded(from: f64, to: f64, cells: usize, ratio: f64) -> Self {
        Self::from(from).run(to, cells, Grade::Ratio(ratio))
    }
    /// Cells between two ends, those at the middle `ratio` times as large as those at the ends. An odd number of cells
    /// cannot be halved and becomes the next even one.
    pub fn symmetric(from: f64, to: f64, cells: usize, ratio: f64) -> Self {
        let (half, middle) = (cells.div_ceil(2), 0.5 * (from + to));
        Self::graded(from, middle, half, ratio).run(to, half, Grade::Ratio(1.0 / ratio))
    }
    /// Adds a run of cells up to a breakpoint.
    pub fn run(mut self, to: f64, cells: usize, grade: Grade) -> Self {
        self.runs.push(SpacingRun { to, cells, grade });
        self
    }
    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.runs.iter().fold(0, |sum, run| sum.saturating_add(run.cells))
    }
    /// Where the last cell ends.
    pub fn end(&self) -> f64 {
        self.runs.last().map_or(self.from, |run| run.to)
    }

    /// The stations: one more than cells, strictly increasing, the breakpoints met exactly.
    ///
    /// # Errors
    /// [`Error::Input`] if there is no cell, a number is not finite, the breakpoints do not increase, or a grade cannot
    /// be met; `what` names the direction in the message.
    pub fn stations(&self, what: &str) -> Result<Vec<f64>, Error> {
        self.check(what)?;
        let mut stations = vec![self.from];
        for run in &self.runs {
            let from = stations[stations.len() - 1];
            let length = run.to - from;
            let growth = match run.grade {
                Grade::Ratio(_) if run.cells == 1 => 1.0,
                Grade::Ratio(ratio) => ratio.powf(1.0 / (run.cells - 1) as f64),
                Grade::Smooth => smooth_growth(what, &stations, length, run.cells)?,
            };
            push_series(&mut stations, from, run, growth);
        }
        match stations.windows(2).all(|pair| pair[0] < pair[1]) {
            true => Ok(stations),
            false => {
                Err(Error::input(format!("{what}: the grading is so strong that cells vanish; use a milder ratio")))
            }
        }
    }

    fn check(&self, what: &str) -> Result<(), Error> {
        let refuse = |why: String| Err(Error::input(format!("{what}: {why}")));
        if self.runs.is_empty() || self.runs.iter().any(|run| run.cells == 0) {
            return refuse("the number of cells is zero; give at least one".into());
        }
        if self.cells() > MOST_CELLS {
            return refuse(format!("{} cells along one direction are too many; use fewer", self.cells()));
        }
        if !self.from.is_finite() || self.runs.iter().any(|run| !run.to.is_finite()) {
            return refuse("a coordinate is not a finite number".into());
        }
        let mut from = self.from;
        for run in &self.runs {
            if run.to <= from {
                return refuse(format!("{} does not lie beyond {from}; coordinates must increase", run.to));
            }
            if matches!(run.grade, Grade::Ratio(ratio) if !(ratio.is_finite() && ratio > 0.0)) {
                return refuse("the ratio of the last cell to the first must be positive".into());
            }
            from = run.to;
        }
        Ok(())
    }
}

/// Appends the stations of one geometric series; the last is the breakpoint itself.
fn push_series(stations: &mut Vec<f64>, from: f64, run: &SpacingRun, growth: f64) {
    let sizes: Vec<f64> = (0..run.cells).map(|i| growth.powi(i as i32)).collect();
    let total: f64 = sizes.iter().sum();
    let mut sum = 0.0;
    for size in &sizes[..run.cells - 1] {
        sum += size;
        stations.push(from + (run.to - from) * (sum / total));
    }
    stations.push(run.to);
}

/// The factor `q` from cell to cell with `h (q + q^2 + ... + q^n) = length`, `h` the cell before, by bisection.
fn smooth_growth(what: &str, stations: &[f64], length: f64, cells: usize) -> Result<f64, Error> {
    let [.., before, last] = stations else {
        return Err(Error::input(format!("{what}: the first run has no run before it to continue smoothly")));
    };
    let wanted = length / (last - before);
    let sum = |q: f64| (1..=cells).fold(0.0, |sum, i| sum + q.powi(i as i32));
    let (mut low, mut high) = (0.1, 10.0);
    if !(sum(low) < wanted && wanted < sum(high)) {
        let why = format!("{cells} cells cannot fill {length} smoothly after a cell of {}", last - before);
        return Err(Error::input(format!("{what}: {why}; change their number")));
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        *(if sum(middle) < wanted { &mut low } else { &mut high }) = middle;
    }
    Ok(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sizes(spacing: &Spacing) -> Vec<f64> {
        spacing.stations("x").unwrap().windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    #[test]
    fn a_ratio_is_last_over_first_and_the_ends_are_met() {
        let sizes = sizes(&Spacing::graded(2.0, 5.0, 7, 8.0));
        assert!((sizes[6] / sizes[0] - 8.0).abs() < 1e-12);
        assert!(sizes.windows(2).all(|pair| (pair[1] / pair[0] - 8f64.powf(1.0 / 6.0)).abs() < 1e-12));
        assert_eq!(Spacing::graded(2.0, 5.0, 7, 8.0).stations("x").unwrap()[7], 5.0);
    }

    #[test]
    fn a_smooth_run_continues_the_series() {
        let sizes = sizes(&Spacing::from(0.0).run(1.0, 10, Grade::UNIFORM).run(50.0, 30, Grade::Smooth));
        let growth = sizes[12] / sizes[11];
        assert!(growth > 1.05);
        assert!(sizes.windows(2).skip(9).all(|pair| (pair[1] / pair[0] / growth - 1.0).abs() < 1e-9));
    }

    #[test]
    fn a_symmetric_spacing_mirrors() {
        let sizes = sizes(&Spacing::symmetric(-1.0, 1.0, 8, 4.0));
        assert!((0..4).all(|i| (sizes[i] - sizes[7 - i]).abs() < 1e-15));
        assert!((sizes[3] / sizes[0] - 4.0).abs() < 1e-12);
    }

    #[test]
    fn what_cannot_be_is_refused() {
        for (spacing, word) in [
            (Spacing::uniform(0.0, 1.0, 0), "zero"),
            (Spacing::from(0.0), "zero"),
            (Spacing::uniform(1.0, 0.0, 2), "increase"),
            (Spacing::uniform(0.0, f64::NAN, 2), "finite"),
            (Spacing::graded(0.0, 1.0, 2, -1.0), "positive"),
            (Spacing::graded(1.0, 2.0, 3, 1e300), "vanish"),
            (Spacing::uniform(0.0, 1.0, usize::MAX), "are too many"),
            (Spacing::from(0.0).run(1.0, 4, Grade::Smooth), "before it"),
            (Spacing::uniform(0.0, 1.0, 1).run(1.001, 4, Grade::Smooth), "change their number"),
        ] {
            let error = spacing.stations("x").unwrap_err().to_string();
            assert!(error.starts_with("x: ") && error.contains(word), "{error}");
        }
    }
}
