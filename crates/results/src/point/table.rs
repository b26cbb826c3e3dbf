//! What is recorded of a driven point, and its files.

use super::curves::Curve;
use super::probe::{MaterialPointDriver, named};
use crate::output::file::{Durability, write_atomic};
use crate::output::{Field, Table};
use asperity_core::Error;
use asperity_core::material::{Material, Variable, VariableKind};
use std::path::{Path, PathBuf};

/// Everything recorded of one law along a path: a row at the beginning and at the end of each increment.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// The material's name.
    pub name: String,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
}

/// Columns of every law, before those of its variables.
fn common() -> Vec<String> {
    let ends = ["mean_stress", "von_mises", "volume_strain", "stored_energy", "dissipated_energy"];
    let names = ["time".to_string()].into_iter().chain(named("strain")).chain(named("stress"));
    names.chain(ends.map(str::to_string)).collect()
}

/// Names of the columns recorded of a law.
pub fn columns(material: &dyn Material) -> Vec<String> {
    let of = |variable: &Variable| -> Vec<String> {
        match variable.kind {
            VariableKind::Scalar => vec![variable.name.to_string()],
            VariableKind::Vector => ["x", "y", "z"].map(|axis| format!("{}_{axis}", variable.name)).into(),
            VariableKind::Symmetric => named(variable.name).collect(),
        }
    };
    common().into_iter().chain(material.variables().iter().flat_map(of)).collect()
}

impl Record {
    /// An empty record of a law.
    pub fn new(name: &str, material: &dyn Material) -> Self {
        Self { name: name.into(), columns: columns(material), rows: Vec::new() }
    }

    /// Adds a row.
    pub fn push(&mut self, probe: &MaterialPointDriver) {
        let volume: f64 = probe.strain[..3].iter().sum();
        let stored = probe.material.stored_energy(&probe.state) * volume.exp();
        let row = [probe.time].into_iter().chain(probe.strain).chain(probe.state[..6].iter().copied());
        let ends = [probe.mean_stress(), probe.von_mises(), volume, stored, probe.dissipated];
        self.rows.push(row.chain(ends).chain(probe.state[6..].iter().copied()).collect());
    }

    /// A column by its name.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        let place = self.columns.iter().position(|column| column == name)?;
        Some(self.rows.iter().map(|row| row[place]).collect())
    }
}

/// Writes each record as `NAME.csv` into a directory and returns the files.
///
/// # Errors
/// [`Error::File`] when one cannot be written.
pub fn write(records: &[Record], directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let one = |record: &Record| {
        let path = directory.join(format!("{}.csv", record.name));
        let mut table = Table::create(&path, &record.columns)?;
        for row in &record.rows {
            table.push(&row.iter().map(|&x| Field::Real(x)).collect::<Vec<_>>())?;
        }
        Ok(path)
    };
    records.iter().map(one).collect()
}

/// Draws curves of all records together as SVG and PNG and returns the files; none of what would be empty unasked.
///
/// # Errors
/// [`Error::File`] when a picture cannot be written.
pub fn draw(records: &[Record], curves: &[Curve], title: &str, directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut written = Vec::new();
    for curve in curves.iter().filter(|curve| curve.is_drawn(records)) {
        let drawing = curve.chart(title, records).draw();
        let [svg, png] = ["svg", "png"].map(|kind| directory.join(format!("{}.{kind}", curve.file_name())));
        write_atomic(&svg, drawing.to_svg().as_bytes(), Durability::Process)?;
        write_atomic(&png, &drawing.to_png(2.0)?, Durability::Process)?;
        written.extend([svg, png]);
    }
    Ok(written)
}
