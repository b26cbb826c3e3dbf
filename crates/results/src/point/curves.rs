//! Which columns are drawn over which.

use super::course::{COMPONENTS, PathControl, Stage};
use super::table::Record;
use crate::output::figure::Chart;

/// Columns drawn over another one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Curve {
    /// The column of the abscissa.
    pub x: String,
    /// The columns of the ordinate.
    pub y: Vec<String>,
    /// Whether it was asked for; one that was not is left away where its ordinate is zero throughout.
    pub asked: bool,
}

impl Curve {
    /// The curves drawn where none are asked for: the stress over the first strain that is driven (or else the equivalent
    /// stress over time), the change of volume over the same, and the path of mean and equivalent stress.
    pub fn standard(stages: &[Stage]) -> Vec<Self> {
        let driven = |stage: &Stage| {
            (0..6).find(|&i| matches!(stage.controls[i], PathControl::Strain(end) if end != 0.0)).map(|i| COMPONENTS[i])
        };
        let component = stages.iter().find_map(driven);
        let x = component.map_or("time".into(), |c| format!("strain_{c}"));
        let stress = component.map_or("von_mises".into(), |c| format!("stress_{c}"));
        vec![Self::unasked(&x, &stress), Self::unasked(&x, "volume_strain"), Self::unasked("mean_stress", "von_mises")]
    }

    /// The curves of an interface where none are asked for: shear and closure over slip, and the path of the stress.
    pub fn of_interfaces() -> Vec<Self> {
        let pairs = [("slip_s", "shear_s"), ("slip_s", "closure"), ("slip_s", "pressure"), ("pressure", "shear")];
        pairs.map(|(x, y)| Self::unasked(x, y)).into()
    }

    fn unasked(x: &str, y: &str) -> Self {
        Self { x: x.into(), y: vec![y.into()], asked: false }
    }

    /// Whether there is something to see in it: it was asked for, or its ordinate is not zero throughout.
    pub fn is_drawn(&self, records: &[Record]) -> bool {
        let columns = records.iter().flat_map(|record| self.y.iter().filter_map(|name| record.column(name)));
        self.asked || columns.flatten().any(|y| y != 0.0)
    }

    /// Name of its picture without the ending: `stress_yy_over_strain_yy`.
    pub fn file_name(&self) -> String {
        format!("{}_over_{}", self.y[0], self.x)
    }

    /// The chart, a line for each record and column; a column that a law does not have is left out.
    pub fn chart(&self, title: &str, records: &[Record]) -> Chart {
        let ordinate = if self.y.len() == 1 { plain(&self.y[0]) } else { "stress".into() };
        let same = |what: &str| self.y.iter().all(|y| y.starts_with(what));
        let ordinate = if self.y.len() > 1 && same("strain") { "strain".into() } else { ordinate };
        let mut chart = Chart::new(title, plain(&self.x), ordinate);
        for record in records {
            let Some(x) = record.column(&self.x) else { continue };
            for name in &self.y {
                let Some(y) = record.column(name) else { continue };
                let points = x.iter().zip(y).map(|(&x, y)| [x, y]).collect();
                chart.line(self.legend(&record.name, name, records.len()), points);
            }
        }
        chart
    }

    fn legend(&self, record: &str, column: &str, records: usize) -> String {
        match (records, self.y.len()) {
            (1, 1) => String::new(),
            (1, _) => plain(column),
            (_, 1) => record.into(),
            _ => format!("{record}, {}", plain(column)),
        }
    }
}

/// A column in words.
fn plain(column: &str) -> String {
    if column == "von_mises" { "von Mises stress".into() } else { column.replace('_', " ") }
}

#[cfg(test)]
mod tests {
    use super::super::course::PathControl;
    use super::*;

    fn record(closure: f64) -> Record {
        let columns = ["slip_s", "closure"].map(String::from).to_vec();
        Record { name: "joint".into(), columns, rows: vec![vec![0.0, 0.0], vec![1.0, closure]] }
    }

    #[test]
    fn a_law_without_dilation_has_no_picture_of_its_closure_unless_asked() {
        let curves = Curve::of_interfaces();
        let closure = curves.iter().find(|curve| curve.y == ["closure"]).unwrap();
        assert!(!closure.is_drawn(&[record(0.0)]) && closure.is_drawn(&[record(0.0), record(-1e-9)]));
        assert!(Curve { asked: true, ..closure.clone() }.is_drawn(&[record(0.0)]));
    }

    #[test]
    fn a_loop_of_stress_has_a_picture_of_its_own() {
        let mut controls = [PathControl::Stress(0.0); 6];
        controls[1] = PathControl::Strain(0.1);
        let stage = Stage { name: String::new(), duration: 1.0, increments: 1, controls, temperature: None };
        let curves = Curve::standard(&[stage]);
        assert_eq!((curves[0].file_name().as_str(), curves[0].y.len()), ("stress_yy_over_strain_yy", 1));
        let axes = curves[2].chart("", &[]).axes;
        assert_eq!(axes, ["mean stress".to_string(), "von Mises stress".to_string()]);
    }
}
