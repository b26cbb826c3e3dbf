//! The standard curves of a run, from its tables: forces over travel, residuals over iterations.

use super::chart::Chart;
use crate::output::{Columns, Unit, Units};
use std::collections::BTreeMap;

/// Forces smaller than this part of the largest are not drawn.
const SMALL: f64 = 1e-9;
/// A step that has less than this part of its share of the way stands still in the picture.
const IDLE: f64 = 0.05;

/// A column by name.
type Column = (String, Vec<f64>);

/// Contact forces over the way of what is driven, or over time; reactions where there is no contact. Contact begins
/// without force, which no row of the history says.
pub fn forces(history: &Columns, title: &str, axisymmetric: bool, units: Option<&Units>) -> Option<Chart> {
    let of = |column: &String| Some((column.clone(), history.numbers(column)?));
    let columns: Vec<Column> = history.header.iter().filter_map(of).collect();
    let axes = if axisymmetric { ["r", "z", ""] } else { ["x", "y", "z"] };
    let (name, travel) = travel(&columns, &history.numbers("step").unwrap_or_default())?;
    // The radial forces of a full circumference have no resultant.
    let shown = |axis: usize| !(axisymmetric && axis == 0);
    let contact = drawn(&columns, "contact.", ".force", shown);
    let (what, lines) = match contact.is_empty() {
        true => ("reaction", drawn(&columns, "reaction.", "", shown)),
        false => ("contact force", contact),
    };
    let with = |what: &str, unit| match units.map(|units| units.name(unit)).filter(|name| !name.is_empty()) {
        Some(name) => format!("{what} ({name})"),
        None => what.to_owned(),
    };
    let across = if name == "time" { Unit::Time } else { Unit::Length };
    let mut chart = Chart::new(title, with(&name, across), with(what, Unit::Force));
    for (name, axis, values) in lines {
        let origin = (what == "contact force").then_some([0.0, 0.0]);
        let points = origin.into_iter().chain(travel.iter().zip(values).map(|(&x, &y)| [x, y])).collect();
        chart.line(format!("{name} along {}", axes[axis]), points);
    }
    chart.series.iter().any(|series| series.points.len() > 1).then_some(chart)
}

/// The residuals of all attempts over the number of the iteration; those given up in another colour.
pub fn convergence(iterations: &Columns) -> Option<Chart> {
    let number = |name: &str| iterations.numbers(name);
    let (iteration, residual, tolerance) = (number("iteration")?, number("residual")?, number("tolerance")?);
    let mut chart =
        Chart::new("Convergence of all attempts", "iteration", "largest unbalanced force, relative").log_y();
    let mut attempts: Vec<Vec<[f64; 2]>> = Vec::new();
    for (&iteration, &residual) in iteration.iter().zip(&residual) {
        match attempts.last_mut() {
            Some(attempt) if iteration > 0.0 => attempt.push([iteration, residual]),
            _ => attempts.push(vec![[iteration, residual]]),
        }
    }
    let tolerance = tolerance.last()?;
    let good = |attempt: &[[f64; 2]]| attempt.last().is_some_and(|last| last[1] <= *tolerance);
    let (converged, given_up): (Vec<_>, Vec<_>) = attempts.into_iter().partition(|attempt| good(attempt));
    for (name, style, attempts) in [("converged", 0, converged), ("given up", 1, given_up)] {
        for (i, attempt) in attempts.into_iter().enumerate() {
            chart.line(if i == 0 { name } else { "" }, attempt).styled(style).thin();
        }
    }
    let most = iteration.iter().copied().fold(1.0, f64::max);
    chart.line("tolerance", vec![[0.0, *tolerance], [most, *tolerance]]).styled(6);
    Some(chart)
}

/// The number of the axis that a column ends with, and the name before it.
fn axis(name: &str) -> Option<(&str, usize)> {
    let (what, axis) = name.rsplit_once('.')?;
    Some((what, ["x", "y", "z"].iter().position(|&letter| letter == axis)?))
}

/// The length of the way of what goes farthest of all that is driven, with a title; time where nothing is, or where a
/// step brings it on by next to nothing while forces change.
fn travel(columns: &[Column], steps: &[f64]) -> Option<Column> {
    let time = &columns.iter().find(|(name, _)| name == "time")?.1;
    let mut driven: BTreeMap<&str, Vec<&[f64]>> = BTreeMap::new();
    for (name, values) in columns {
        driven.entry(driven_by(name).unwrap_or_default()).or_default().push(values);
    }
    driven.remove("");
    let paths = driven.into_iter().map(|(name, axes)| (name, path(&axes)));
    let length = |path: &[f64]| path.last().copied().unwrap_or(0.0);
    let farthest = paths.max_by(|(_, a), (_, b)| length(a).total_cmp(&length(b)));
    Some(match farthest {
        Some((name, path)) if length(&path) > 0.0 && every_step_moves(&path, steps) => {
            (format!("path length of {name}"), path)
        }
        _ => ("time".into(), time.clone()),
    })
}

/// The group or the tool whose motion a column is.
fn driven_by(column: &str) -> Option<&str> {
    let (what, _) = axis(column)?;
    what.strip_prefix("displacement.").or_else(|| what.strip_prefix("tool.")?.strip_suffix(".translation"))
}

/// The length of the way from the origin to each place of a list, given by its coordinates.
fn path(axes: &[&[f64]]) -> Vec<f64> {
    let rows = axes.iter().map(|axis| axis.len()).min().unwrap_or(0);
    let before = |axis: &[f64], row: usize| if row == 0 { 0.0 } else { axis[row - 1] };
    let part = |row: usize| axes.iter().map(|axis| (axis[row] - before(axis, row)).powi(2)).sum::<f64>().sqrt();
    let sum = |total: &mut f64, row: usize| {
        *total += part(row);
        Some(*total)
    };
    (0..rows).scan(0.0, sum).collect()
}

/// Whether every step has some share of a way.
fn every_step_moves(path: &[f64], steps: &[f64]) -> bool {
    let ends: Vec<f64> = (0..path.len()).filter(|&i| steps.get(i) != steps.get(i + 1)).map(|i| path[i]).collect();
    let share = path.last().copied().unwrap_or(0.0) / ends.len() as f64;
    let moved = (0..ends.len()).map(|i| ends[i] - if i == 0 { 0.0 } else { ends[i - 1] });
    moved.into_iter().all(|moved| moved > IDLE * share)
}

/// Columns `START NAME END .AXIS` by name and axis, without those that stay small.
fn drawn<'a>(
    columns: &'a [Column],
    start: &str,
    end: &str,
    shown: impl Fn(usize) -> bool,
) -> Vec<(&'a str, usize, &'a [f64])> {
    let of = |(name, values): &'a Column| -> Option<(&'a str, usize, &'a [f64])> {
        let (what, axis) = axis(name)?;
        let name = what.strip_prefix(start)?.strip_suffix(end)?;
        shown(axis).then_some((name, axis, values.as_slice()))
    };
    let size = |values: &[f64]| values.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let kind: Vec<_> = columns.iter().filter_map(of).collect();
    let largest = kind.iter().map(|(.., values)| size(values)).fold(0.0, f64::max);
    kind.into_iter().filter(|(.., values)| size(values) > SMALL * largest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(name: &str, values: &[f64]) -> Column {
        (name.to_string(), values.to_vec())
    }

    #[test]
    fn the_travel_is_the_way_of_what_goes_farthest() {
        let steps = [1.0, 2.0];
        let mut columns = vec![column("time", &[1.0, 2.0]), column("displacement.far.end.x", &[0.0, 0.0])];
        assert_eq!(travel(&columns, &steps).unwrap().0, "time");
        columns.push(column("displacement.far.end.y", &[-1.0, -3.0]));
        columns.push(column("tool.die.translation.x", &[1.0, 2.0]));
        columns.push(column("tool.die.rotation.z", &[1.0, 20.0]));
        assert_eq!(travel(&columns, &steps).unwrap(), ("path length of far.end".into(), vec![1.0, 3.0]));
        columns.push(column("tool.die.translation.y", &[0.0, 9.0]));
        assert_eq!(travel(&columns, &steps).unwrap(), ("path length of die".into(), vec![1.0, 1.0 + 82f64.sqrt()]));
    }

    #[test]
    fn a_way_back_counts_as_well() {
        let columns = [column("time", &[1.0, 2.0, 3.0]), column("displacement.end.x", &[2.0, -1.0, 0.0])];
        assert_eq!(travel(&columns, &[1.0, 1.0, 1.0]).unwrap().1, [2.0, 5.0, 6.0]);
    }

    #[test]
    fn where_a_step_stands_still_forces_are_shown_over_time() {
        let columns = [column("time", &[1.0, 2.0, 3.0, 4.0]), column("displacement.end.x", &[0.0, 1e-3, 1.0, 2.0])];
        assert_eq!(travel(&columns, &[1.0, 1.0, 2.0, 2.0]).unwrap().0, "time");
        assert_eq!(travel(&columns, &[1.0, 1.0, 1.0, 2.0]).unwrap().0, "path length of end");
    }

    #[test]
    fn contact_forces_begin_at_the_origin() {
        let header = ["time", "step", "displacement.end.y", "contact.sole.force.y"].map(String::from).to_vec();
        let rows = vec![["1.0", "1", "-0.5", "7.0"].map(String::from).to_vec()];
        let chart = forces(&Columns { header, rows }, "", false, None).unwrap();
        assert_eq!(chart.series[0].points, [[0.0, 0.0], [0.5, 7.0]]);
    }

    #[test]
    fn forces_that_stay_small_or_mean_nothing_are_not_drawn() {
        let columns = [
            column("contact.a.b.force.x", &[0.0, 5.0]),
            column("contact.a.b.force.y", &[1e-12, 0.0]),
            column("contact.a.b.area", &[9.0, 9.0]),
            column("contact.a.b.moment.z", &[9.0, 9.0]),
        ];
        let all = drawn(&columns, "contact.", ".force", |_| true);
        assert_eq!(all, [("a.b", 0, &[0.0, 5.0][..])]);
        assert_eq!(drawn(&columns, "contact.", ".force", |axis| axis > 0).len(), 1, "then the other is the largest");
    }

    #[test]
    fn attempts_are_told_apart() {
        let row = |iteration: f64, residual: f64| vec![iteration.to_string(), residual.to_string(), "1e-6".into()];
        let header = ["iteration", "residual", "tolerance"].map(String::from).to_vec();
        let rows = vec![row(0.0, 1.0), row(1.0, 1e-8), row(0.0, 1.0), row(1.0, 2.0), row(2.0, 3.0)];
        let chart = convergence(&Columns { header, rows }).unwrap();
        let named: Vec<(&str, usize)> = chart.series.iter().map(|s| (s.name.as_str(), s.points.len())).collect();
        assert_eq!(named, [("converged", 2), ("given up", 3), ("tolerance", 2)]);
        assert!(convergence(&Columns::default()).is_none());
    }
}
