//! `probe.NAME.csv`: what a probe reads, a row an increment, and along a path a row a point.

use super::{At, Pick, Probe, ProbeSpot};
use crate::output::table::{Columns, Field, Table};
use crate::output::units::Units;
use crate::output::{Frame, QuantityPlace, Unit};
use asperity_core::Error;
use asperity_core::tensor::Vec3;
use std::path::Path;

/// The table of one probe.
#[derive(Debug)]
pub struct ProbeTable {
    probe: Probe,
    picks: Vec<Pick>,
    plane: bool,
    table: Table,
}

impl ProbeTable {
    /// The table's file.
    pub fn file(name: &str) -> String {
        format!("probe.{name}.csv")
    }
    /// Begins the table of a probe in a model whose frames are like this one.
    ///
    /// # Errors
    /// [`Error::Input`] when a quantity is none, [`Error::File`] when the file cannot be written.
    pub fn create(
        directory: &Path,
        probe: &Probe,
        (frame, plane): (&Frame, bool),
        units: Option<&Units>,
    ) -> Result<Self, Error> {
        let picks = picks(probe, frame, plane)?;
        let table = Table::create(&directory.join(Self::file(&probe.name)), &header(probe, &picks, plane, units))?;
        Ok(Self { probe: probe.clone(), picks, plane, table })
    }
    /// Continues the table of a run after its increment; later rows are dropped.
    ///
    /// # Errors
    /// As [`ProbeTable::create`], and [`Error::File`] when the old table cannot be read.
    pub fn resume(
        directory: &Path,
        probe: &Probe,
        (frame, plane): (&Frame, bool),
        units: Option<&Units>,
    ) -> Result<Self, Error> {
        let path = directory.join(Self::file(&probe.name));
        if !path.exists() {
            return Self::create(directory, probe, (frame, plane), units);
        }
        Table::resume(&path, |columns: &Columns, row: &[String]| {
            let at = columns.position("increment").and_then(|i| row[i].parse::<usize>().ok());
            at.is_some_and(|at| at <= frame.increment)
        })?;
        // What is read, and in which units, may have been changed.
        let picks = picks(probe, frame, plane)?;
        let table = Table::relay(&path, &header(probe, &picks, plane, units))?;
        Ok(Self { probe: probe.clone(), picks, plane, table })
    }
    /// Adds the rows of a frame.
    ///
    /// # Errors
    /// [`Error::Write`] when they cannot be written, [`Error::Internal`] when the frame lacks a quantity.
    pub fn push(&mut self, frame: &Frame) -> Result<(), Error> {
        let leading = [frame.time.into(), frame.step.into(), frame.increment.into()];
        let mut values = Vec::new();
        for pick in &self.picks {
            let lost = || Error::Internal(format!("probe '{}' lost '{}'", self.probe.name, pick.quantity));
            values.push(Probe::values(frame, pick).ok_or_else(lost)?);
        }
        match &self.probe.at {
            At::Nodes(shares, takes) => {
                let mut row = leading.to_vec();
                for (pick, values) in self.picks.iter().zip(&values) {
                    let width = pick.width();
                    for (_, part) in &pick.columns {
                        let at = |node: usize| part.of(&values[node * width..][..width], pick.unit);
                        row.extend(takes.iter().map(|take| Field::Real(take.of(shares, at))));
                    }
                }
                self.table.push(&row)
            }
            At::Point(spot) => {
                let row = leading.into_iter().chain(self.read(spot, &values, frame)).collect::<Vec<_>>();
                self.table.push(&row)
            }
            At::Path(spots) => {
                for (distance, spot) in spots {
                    let own = [Field::Real(*distance)].into_iter().chain(self.read(spot, &values, frame));
                    let row = leading.iter().cloned().chain(own).collect::<Vec<_>>();
                    self.table.push(&row)?;
                }
                Ok(())
            }
        }
    }

    /// Where a point is now, and what is read there.
    fn read(&self, spot: &ProbeSpot, values: &[Vec<f64>], frame: &Frame) -> Vec<Field> {
        let mut now = spot.point;
        if let Some(moved) = frame.get(QuantityPlace::Node, "displacement") {
            now += spot.nodes.iter().fold(Vec3::zero(), |sum, &(node, n)| sum + Vec3(moved.vector(node)) * n);
        }
        let axes = if self.plane { 2 } else { 3 };
        let mut fields: Vec<Field> = (0..axes).map(|axis| Field::Real(now[axis])).collect();
        for (pick, values) in self.picks.iter().zip(values) {
            let width = pick.width();
            let value: Vec<f64> =
                (0..width).map(|i| spot.nodes.iter().map(|&(node, n)| n * values[node * width + i]).sum()).collect();
            fields.extend(pick.columns.iter().map(|(_, part)| Field::Real(part.of(&value, pick.unit))));
        }
        fields
    }
}

fn picks(probe: &Probe, frame: &Frame, plane: bool) -> Result<Vec<Pick>, Error> {
    let pick = |name: &String| {
        Pick::new(name, frame, plane).map_err(|fault| Error::input(format!("probe '{}': {fault}", probe.name)))
    };
    probe.quantities.iter().map(pick).collect()
}

fn header(probe: &Probe, picks: &[Pick], plane: bool, units: Option<&Units>) -> Vec<String> {
    let with = |name: &str, unit| Units::header(units, name, unit);
    let mut header = vec![with("time", Unit::Time), "step".to_owned(), "increment".to_owned()];
    if matches!(probe.at, At::Path(_)) {
        header.push(with("distance", Unit::Length));
    }
    if !matches!(probe.at, At::Nodes(..)) {
        header.extend(["x", "y", "z"][..if plane { 2 } else { 3 }].iter().map(|axis| with(axis, Unit::Length)));
    }
    for pick in picks {
        for (name, _) in &pick.columns {
            match &probe.at {
                At::Nodes(shares, takes) if shares.len() > 1 || takes[..] != [super::Take::Mean] => {
                    header.extend(takes.iter().map(|take| with(&format!("{name}.{}", take.word()), pick.unit)));
                }
                _ => header.push(with(name, pick.unit)),
            }
        }
    }
    header
}
