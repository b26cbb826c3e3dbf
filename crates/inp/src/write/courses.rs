//! How values run within steps: from amplitudes in time to the tables of a deck, which lead from the old value to the new.

use super::Writer;
use crate::message::InputPlace;
use crate::model::{Amplitude, Course};

/// What a line of the input deck laid on, as long as it holds.
#[derive(Debug, Clone)]
pub struct Record {
    /// Name of what it is laid on.
    pub name: String,
    /// The value, times the amplitude.
    pub value: f64,
    /// The amplitude.
    pub course: Course,
    /// Where it stands.
    pub place: InputPlace,
    /// The step that said it.
    pub step: usize,
    /// The value at the end of the last step.
    pub reached: f64,
}

/// A value in one step.
#[derive(Debug, Clone)]
pub struct Item {
    /// The value at the end.
    pub end: f64,
    /// That at the beginning, where it is known.
    pub start: Option<f64>,
    /// Fractions of the step and values; none for a straight line from whatever it was.
    pub course: Option<Vec<[f64; 2]>>,
    /// Where it stands.
    pub place: InputPlace,
}

/// Pairs of a fraction of the step and a factor.
pub type Factors = Option<Vec<[f64; 2]>>;

impl Item {
    /// The same, times a factor.
    pub fn scaled(&self, factor: f64) -> Self {
        // Adding zero makes a negative one positive.
        let times = |value: f64| value * factor + 0.0;
        let course = self.course.as_ref().map(|points| points.iter().map(|[at, v]| [*at, times(*v)]).collect());
        Self { end: times(self.end), start: self.start.map(times), course, place: self.place }
    }

    /// The sum of values; none where one follows a course and another comes from an unknown value.
    pub fn sum(items: &[Self]) -> Option<Self> {
        let place = items.first()?.place;
        let end = items.iter().map(|item| item.end).sum();
        let start = items.iter().map(|item| item.start).sum::<Option<f64>>();
        if items.iter().all(|item| item.course.is_none()) {
            return Some(Self { end, start, course: None, place });
        }
        let courses: Vec<Vec<[f64; 2]>> = items
            .iter()
            .map(|item| item.course.clone().or_else(|| Some(vec![[0.0, item.start?], [1.0, item.end]])))
            .collect::<Option<_>>()?;
        let mut fractions: Vec<f64> = courses.iter().flatten().map(|point| point[0]).collect();
        fractions.sort_by(f64::total_cmp);
        fractions.dedup();
        let value = |points: &Vec<[f64; 2]>, at: f64| at_time(&Amplitude { points: points.clone(), total: false }, at);
        let points = fractions.iter().map(|&at| [at, courses.iter().map(|points| value(points, at)).sum()]);
        Some(Self { end, start, course: Some(points.collect()), place })
    }

    /// The value that the deck gives and the factors that lead to it, `v0 + (v1 - v0) a`; none for the straight line.
    pub fn factors(&self) -> (f64, Factors) {
        let Some(points) = &self.course else { return (self.end, None) };
        let start = self.start.unwrap_or(0.0);
        let far = |value: f64| (value - start).abs();
        let widest = points.iter().map(|point| point[1]).fold(start, |a, b| if far(b) > far(a) { b } else { a });
        let to = if far(self.end) > 1e-12 * far(widest) { self.end } else { widest };
        if far(to) == 0.0 {
            return (self.end, None);
        }
        let factors: Vec<[f64; 2]> = points.iter().map(|[at, value]| [*at, (value - start) / (to - start)]).collect();
        let straight = factors.iter().all(|[at, factor]| (factor - at).abs() < 1e-12);
        (to, Some(factors).filter(|_| !straight))
    }
}

/// Values of an amplitude over a step that begins at a time, at fractions of it.
pub fn points(amplitude: &Amplitude, begins: f64, duration: f64, value: f64) -> Vec<[f64; 2]> {
    let begins = if amplitude.total { begins } else { 0.0 };
    let inner = amplitude.points.iter().map(|point| (point[0] - begins) / duration);
    let mut fractions = vec![0.0];
    fractions.extend(inner.filter(|&at| at > 1e-9 && at < 1.0 - 1e-9));
    fractions.push(1.0);
    fractions.into_iter().map(|at| [at, value * at_time(amplitude, begins + at * duration)]).collect()
}

/// The factor of an amplitude at a time; constant before its first and after its last point.
fn at_time(amplitude: &Amplitude, time: f64) -> f64 {
    let points = &amplitude.points;
    let after = points.partition_point(|point| point[0] <= time);
    match (after.checked_sub(1).and_then(|at| points.get(at)), points.get(after)) {
        (Some([t0, a0]), Some([t1, a1])) => a0 + (a1 - a0) * (time - t0) / (t1 - t0),
        (Some([_, a]), None) | (None, Some([_, a])) => *a,
        (None, None) => 0.0,
    }
}

impl Writer<'_> {
    /// What a record does in a step: the value at its end, and the course to there.
    pub(super) fn followed(&self, record: &Record, step: usize) -> (f64, Option<Vec<[f64; 2]>>) {
        let steps = &self.model.steps;
        let now = record.step == step;
        match record.course.and_then(|at| self.model.amplitudes.get(at)) {
            Some((_, amplitude)) if now || amplitude.total => {
                let begins: f64 = steps[..step].iter().map(|step| step.duration).sum();
                let points = points(amplitude, begins, steps[step].duration, record.value);
                (points.last().map_or(record.reached, |point| point[1]), Some(points))
            }
            Some(_) => (record.reached, None),
            None if now && steps[step].at_once => (record.value, Some(vec![[0.0, record.value], [1.0, record.value]])),
            None => (record.value, None),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn saw(total: bool) -> Amplitude {
        Amplitude { points: vec![[0.0, 0.0], [1.0, 1.0], [3.0, 0.0]], total }
    }

    #[test]
    fn amplitudes_are_cut_into_steps() {
        assert_eq!(points(&saw(false), 5.0, 2.0, 4.0), [[0.0, 0.0], [0.5, 4.0], [1.0, 2.0]]);
        assert_eq!(points(&saw(true), 2.0, 2.0, 4.0), [[0.0, 2.0], [0.5, 0.0], [1.0, 0.0]]);
    }

    #[test]
    fn factors_lead_from_the_old_value_to_the_new() {
        let item = |start, end, course: &[[f64; 2]]| Item {
            end,
            start: Some(start),
            course: Some(course.to_vec()),
            place: InputPlace::default(),
        };
        assert_eq!(item(1.0, 3.0, &[[0.0, 1.0], [1.0, 3.0]]).factors(), (3.0, None));
        let there_and_back = item(0.0, 0.0, &[[0.0, 0.0], [0.5, -2.0], [1.0, 0.0]]);
        assert_eq!(there_and_back.factors(), (-2.0, Some(vec![[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]])));
        assert_eq!(item(2.0, 2.0, &[[0.0, 2.0], [1.0, 2.0]]).factors(), (2.0, None));
    }
}
