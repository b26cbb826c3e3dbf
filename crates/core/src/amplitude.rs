//! How given values run in time: within a step along an [`Amplitude`], over the steps of a run along a [`Timeline`].
//!
//! A condition that a step says goes from where it was to the value it says, `v = v0 + (v1 - v0) a(t / T)`, and holds
//! in later steps until one of them says it anew or releases it. This room knows neither what the values are nor what
//! they act on. Layer 1.

/// Part of its range by which an amplitude may bend off the straight line of an increment.
const STRAIGHT: f64 = 0.01;
/// Part of a step within which two times are one.
const SAME: f64 = 1e-9;

/// A factor over a step: pairs of a fraction of the step and a factor, joined by straight lines and constant outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Amplitude {
    points: Vec<[f64; 2]>,
}

impl Amplitude {
    /// From pairs `[fraction of the step, factor]`.
    ///
    /// # Errors
    /// In words, if there is no pair, one is not finite, or the fractions do not rise.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Self, String> {
        if points.is_empty() {
            return Err("an amplitude needs at least one pair [fraction of the step, factor]".into());
        }
        if let Some([t, a]) = points.iter().find(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(format!("the pair [{t}, {a}] of an amplitude is not finite"));
        }
        if let Some(two) = points.windows(2).find(|two| two[0][0] >= two[1][0]) {
            return Err(format!("the fractions of an amplitude must rise, but {} follows {}", two[1][0], two[0][0]));
        }
        Ok(Self { points })
    }
    /// From 0 at the beginning of the step to 1 at its end: the default.
    pub fn ramp() -> Self {
        Self { points: vec![[0.0, 0.0], [1.0, 1.0]] }
    }
    /// 1 from the beginning of the step.
    pub fn at_once() -> Self {
        Self { points: vec![[0.0, 1.0]] }
    }
    /// The factor at a fraction of the step.
    pub fn value(&self, fraction: f64) -> f64 {
        let after = self.points.partition_point(|p| p[0] <= fraction);
        match (after.checked_sub(1).map(|i| self.points[i]), self.points.get(after)) {
            (Some([t0, a0]), Some([t1, a1])) => a0 + (a1 - a0) * ((fraction - t0) / (t1 - t0)),
            (Some([_, a]), None) | (None, Some(&[_, a])) => a,
            (None, None) => 0.0,
        }
    }
    /// The first fraction of the step in an interval at which an increment has to end: no point of the amplitude before it lies beyond the
    /// values at both ends, as a peak would, nor off the straight line between them by more than a hundredth of the range (Douglas &
    /// Peucker, Cartographica 10, 1973).
    pub fn bend(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let factors = || self.points.iter().map(|p| p[1]);
        let range = factors().fold(f64::NEG_INFINITY, f64::max) - factors().fold(f64::INFINITY, f64::min);
        let (begin, mut end, mut found) = (self.value(from), [to, self.value(to)], None);
        loop {
            let missed = |&[t, a]: &[f64; 2]| {
                let [least, most] = [begin.min(end[1]), begin.max(end[1])];
                let beyond = (least - a).max(a - most);
                let off = (a - begin - (end[1] - begin) * (t - from) / (end[0] - from)).abs();
                if beyond > SAME * range || off > STRAIGHT * range { off.max(beyond) } else { 0.0 }
            };
            let within = self.points.iter().filter(|[t, _]| *t > from + SAME && *t < end[0] - SAME);
            let worst = within.max_by(|a, b| missed(a).total_cmp(&missed(b))).filter(|point| missed(point) > 0.0);
            let Some(&point) = worst else { return found };
            (end, found) = (point, Some(point[0]));
        }
    }
}

/// What a step says of a value.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// Nothing: it stays what it is.
    Keep,
    /// It goes to this value along the amplitude.
    To(f64, Amplitude),
    /// It goes to zero along a straight line.
    Release,
}

/// A value over all steps of a run; zero before the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Timeline {
    pieces: Vec<Piece>,
}

/// The course over one step.
#[derive(Debug, Clone, PartialEq)]
struct Piece {
    duration: f64,
    from: f64,
    to: f64,
    amplitude: Amplitude,
    /// Whether the step says nothing of it.
    keeps: bool,
}

impl Piece {
    fn value(&self, step_time: f64) -> f64 {
        self.from + (self.to - self.from) * self.amplitude.value(step_time / self.duration)
    }
}

impl Timeline {
    /// From the duration of each step and what it says; there are as many changes as steps.
    pub fn new(steps: impl IntoIterator<Item = (f64, Change)>) -> Self {
        Self::from(0.0, steps)
    }
    /// The same of a value that is not zero before the first step.
    pub fn from(mut from: f64, steps: impl IntoIterator<Item = (f64, Change)>) -> Self {
        let piece = |(duration, change)| {
            let keeps = change == Change::Keep;
            let (to, amplitude) = match change {
                Change::Keep => (from, Amplitude::ramp()),
                Change::To(to, amplitude) => (to, amplitude),
                Change::Release => (0.0, Amplitude::ramp()),
            };
            let piece = Piece { duration, from, to, amplitude, keeps };
            from = piece.value(duration);
            piece
        };
        Self { pieces: steps.into_iter().map(piece).collect() }
    }
    /// The same value in all steps, from the beginning of the first.
    pub fn constant(value: f64) -> Self {
        Self::new([(1.0, Change::To(value, Amplitude::at_once()))])
    }
    /// The value at a time of a step (counted from zero); after the last step it stays what it was then.
    pub fn value(&self, step: usize, step_time: f64) -> f64 {
        match (self.pieces.get(step), self.pieces.last()) {
            (Some(piece), _) => piece.value(step_time),
            (None, Some(last)) => last.value(last.duration),
            (None, None) => 0.0,
        }
    }

    /// The value at the load factor of a step that follows a path: from where it was to the value of the step, in proportion and
    /// beyond. `ended` are the factors at which earlier steps did, by their numbers.
    pub fn on_path(&self, ended: &[(usize, f64)], step: usize, (step_time, factor): (f64, Option<f64>)) -> f64 {
        if ended.is_empty() && factor.is_none() {
            return self.value(step, step_time);
        }
        let mut value = self.pieces.first().map_or(0.0, |first| first.from);
        for (number, piece) in self.pieces.iter().enumerate().take(step + 1) {
            let ended = ended.iter().find(|(step, _)| *step == number).map(|(_, factor)| *factor);
            let (time, factor) = if number == step { (step_time, factor) } else { (piece.duration, ended) };
            let part = factor.unwrap_or_else(|| piece.amplitude.value(time / piece.duration));
            value += if piece.keeps { 0.0 } else { (piece.to - value) * part };
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amplitudes_are_linear_between_their_points_and_constant_outside() {
        let a = Amplitude::new(vec![[0.0, 1.0], [0.5, 3.0], [1.0, -1.0]]).unwrap();
        assert_eq!([-1.0, 0.0, 0.25, 0.5, 0.75, 1.0, 2.0].map(|t| a.value(t)), [1.0, 1.0, 2.0, 3.0, 1.0, -1.0, -1.0]);
        assert_eq!([0.0, 0.3, 1.0].map(|t| Amplitude::ramp().value(t)), [0.0, 0.3, 1.0]);
        assert_eq!([0.0, 0.3, 1.0].map(|t| Amplitude::at_once().value(t)), [1.0; 3]);
    }

    #[test]
    fn increments_end_where_an_amplitude_bends() {
        let wave = Amplitude::new(vec![[0.0, 0.0], [0.25, 1.0], [0.75, -1.0], [1.0, 0.0]]).unwrap();
        let ends =
            [[0.0, 0.2], [0.0, 0.25], [0.2, 0.26], [0.0, 1.0], [0.25, 0.9], [0.75, 1.0]].map(|part| wave.bend(part));
        assert_eq!(ends, [None, None, Some(0.25), Some(0.25), Some(0.75), None]);
        let pulse = Amplitude::new(vec![[0.0, 0.0], [0.42, 0.0], [0.45, 1.0], [0.48, 0.0], [1.0, 0.0]]).unwrap();
        assert_eq!([[0.4, 0.5], [0.42, 0.5]].map(|part| pulse.bend(part)), [Some(0.42), Some(0.45)]);
        let smooth: Vec<[f64; 2]> = (0..=1000).map(|k| [1e-3 * f64::from(k), (1e-3 * f64::from(k)).powi(2)]).collect();
        let smooth = Amplitude::new(smooth).unwrap();
        assert_eq!([smooth.bend([0.0, 0.1]), Amplitude::ramp().bend([0.0, 1.0])], [None; 2]);
        assert!(smooth.bend([0.0, 1.0]).is_some_and(|end| (0.05..0.25).contains(&end)));
    }

    #[test]
    fn bad_amplitudes_are_refused_in_words() {
        let refused = |points: &[[f64; 2]]| Amplitude::new(points.to_vec()).unwrap_err();
        assert!(refused(&[]).contains("at least one pair"));
        assert!(refused(&[[0.0, f64::NAN]]).contains("not finite"));
        assert_eq!(refused(&[[0.0, 0.0], [0.0, 1.0]]), "the fractions of an amplitude must rise, but 0 follows 0");
    }

    #[test]
    fn a_value_ramps_persists_changes_and_is_released() {
        let back = Amplitude::new(vec![[0.0, 0.0], [0.5, 1.0], [1.0, 0.5]]).unwrap();
        let line = Timeline::new([
            (2.0, Change::To(10.0, Amplitude::ramp())),
            (1.0, Change::Keep),
            (1.0, Change::To(20.0, back)),
            (4.0, Change::Release),
        ]);
        let at = [(0, 0.5), (0, 2.0), (1, 0.7), (2, 0.5), (2, 1.0), (3, 1.0), (3, 4.0), (4, 0.0)];
        assert_eq!(at.map(|(step, t)| line.value(step, t)), [2.5, 10.0, 10.0, 20.0, 15.0, 11.25, 0.0, 0.0]);
    }

    #[test]
    fn a_value_goes_with_the_load_factor_and_stays_where_that_ended() {
        let to = |value| (1.0, Change::To(value, Amplitude::ramp()));
        let line = Timeline::new([to(2.0), to(10.0), (1.0, Change::Keep), to(0.0)]);
        let on = |ended: &[(usize, f64)], step, factor| line.on_path(ended, step, (0.5, factor));
        assert_eq!([Some(0.25), Some(-0.5), Some(1.5), None].map(|f| on(&[], 1, f)), [4.0, -2.0, 14.0, 6.0]);
        assert_eq!([2, 3].map(|step| on(&[(1, 0.25)], step, None)), [4.0, 2.0]);
    }

    #[test]
    fn constants_hold_in_every_step() {
        assert_eq!([(0, 0.0), (0, 1.0), (7, 0.3)].map(|(s, t)| Timeline::constant(4.0).value(s, t)), [4.0; 3]);
        assert_eq!(Timeline::new([]).value(0, 1.0), 0.0);
    }
}
