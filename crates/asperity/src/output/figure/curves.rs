//! The standard curves of a run, from its tables: forces over travel, residuals over iterations.

use super::chart::Chart;
use crate::output::Columns;

/// Forces smaller than this part of the largest are not drawn.
const SMALL: f64 = 1e-9;

/// A column by name.
type Column = (String, Vec<f64>);

/// Contact forces over the largest prescribed motion, or over time; reactions where there is no contact.
pub fn forces(history: &Columns, title: &str, axisymmetric: bool) -> Option<Chart> {
    let of = |column: &String| Some((column.clone(), history.numbers(column)?));
    let columns: Vec<Column> = history.header.iter().filter_map(of).collect();
    let axes = if axisymmetric { ["r", "z", ""] } else { ["x", "y", "z"] };
    let (name, travel) = travel(&columns, axes)?;
    // The radial forces of a full circumference have no resultant.
    let shown = |axis: usize| !(axisymmetric && axis == 0);
    let contact = drawn(&columns, "contact.", ".force", shown);
    let (what, lines) = match contact.is_empty() {
        true => ("reaction", drawn(&columns, "reaction.", "", shown)),
        false => ("contact force", contact),
    };
    let mut chart = Chart::new(title, name, what);
    for (name, axis, values) in lines {
        let points = travel.iter().zip(values).map(|(&x, &y)| [x, y]).collect();
        chart.line(format!("{name} along {}", axes[axis]), points);
    }
    (!chart.series.is_empty() && travel.len() > 1).then_some(chart)
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

fn span(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
    high - low
}

/// The number of the axis that a column ends with, and the name before it.
fn axis(name: &str) -> Option<(&str, usize)> {
    let (what, axis) = name.rsplit_once('.')?;
    Some((what, ["x", "y", "z"].iter().position(|&letter| letter == axis)?))
}

/// The prescribed motion that goes farthest, with a title; time where nothing moves.
fn travel(columns: &[Column], axes: [&str; 3]) -> Option<Column> {
    let time = &columns.iter().find(|(name, _)| name == "time")?.1;
    let moved = |(name, values): &'_ Column| -> Option<(String, f64)> {
        let (what, axis) = axis(name)?;
        let group = what.strip_prefix("displacement.");
        let tool = || what.strip_prefix("tool.")?.strip_suffix(".translation");
        let title = format!("travel of {} along {}", group.or_else(tool)?, axes[axis]);
        // A travel begins at zero, which no row says.
        Some((title, values.iter().fold(span(values), |most, x| most.max(x.abs()))))
    };
    let candidates = columns.iter().filter_map(|column| Some((moved(column)?, column)));
    let farthest = candidates.max_by(|((_, a), _), ((_, b), _)| a.total_cmp(b));
    Some(match farthest {
        Some(((title, travel), (_, values))) if travel > 0.0 => (title, values.iter().map(|x| x.abs()).collect()),
        _ => ("time".into(), time.clone()),
    })
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

    const XYZ: [&str; 3] = ["x", "y", "z"];

    fn column(name: &str, values: &[f64]) -> Column {
        (name.to_string(), values.to_vec())
    }

    #[test]
    fn the_travel_is_the_motion_that_goes_farthest() {
        let mut columns = vec![column("time", &[1.0, 2.0]), column("displacement.far.end.x", &[0.0, 0.0])];
        assert_eq!(travel(&columns, XYZ).unwrap().0, "time");
        columns.push(column("displacement.far.end.y", &[-1.0, -3.0]));
        columns.push(column("tool.die.translation.x", &[1.0, 2.0]));
        columns.push(column("tool.die.rotation.z", &[1.0, 20.0]));
        assert_eq!(travel(&columns, XYZ).unwrap(), ("travel of far.end along y".into(), vec![1.0, 3.0]));
        columns.push(column("tool.die.translation.y", &[0.0, 9.0]));
        assert_eq!(travel(&columns, ["r", "z", ""]).unwrap().0, "travel of die along z");
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
