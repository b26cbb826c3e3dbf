//! Which columns are drawn over which.

use super::course::{COMPONENTS, Control, Stage};
use super::table::Record;
use crate::output::figure::Chart;

/// Columns drawn over another one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Curve {
    /// The column of the abscissa.
    pub x: String,
    /// The columns of the ordinate.
    pub y: Vec<String>,
}

impl Curve {
    /// The curves drawn where none are asked for: stresses over the first strain that is driven (or else over time),
    /// the change of volume over the same, and the path of mean and equivalent stress.
    pub fn standard(stages: &[Stage]) -> Vec<Self> {
        let driven = |stage: &Stage| {
            (0..6).find(|&i| matches!(stage.controls[i], Control::Strain(end) if end != 0.0)).map(|i| COMPONENTS[i])
        };
        let component = stages.iter().find_map(driven);
        let x = component.map_or("time".into(), |c| format!("strain_{c}"));
        let stress = component.map(|c| format!("stress_{c}")).into_iter().chain(["von_mises".into()]).collect();
        let curve = |x: &str, y: Vec<String>| Self { x: x.into(), y };
        vec![curve(&x, stress), curve(&x, vec!["volume_strain".into()]), curve("mean_stress", vec!["von_mises".into()])]
    }

    /// The curves of an interface where none are asked for: shear and closure over slip, and the path of the stress.
    pub fn of_interfaces() -> Vec<Self> {
        let curve = |x: &str, y: &str| Self { x: x.into(), y: vec![y.into()] };
        let slip = "slip_s";
        vec![curve(slip, "shear_s"), curve(slip, "closure"), curve(slip, "pressure"), curve("pressure", "shear")]
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

fn plain(column: &str) -> String {
    column.replace('_', " ")
}
