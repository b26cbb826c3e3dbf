//! `certificate.csv`: the readings for the certificate, a row a reading. From it a restart takes up the certificate where the
//! checkpoint stands.

use super::certificate::{Certificate, Reading};
use super::figures::Figure;
use super::quantity::Frame;
use super::table::{Columns, Field, Table};
use asperity_core::Error;
use asperity_core::tensor::Vec3;
use std::path::Path;

/// Name of the table in the result directory.
pub const READINGS: &str = "certificate.csv";

const COLUMNS: &[&str] = &["time", "step", "increment", "figure", "of", "value", "scale", "x", "y", "z"];

/// Writes the readings of a run.
#[derive(Debug)]
pub struct ReadingTable(Table);

impl ReadingTable {
    /// Begins the table.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written.
    pub fn create(directory: &Path) -> Result<Self, Error> {
        Ok(Self(Table::create(&directory.join(READINGS), COLUMNS)?))
    }

    /// Continues the table after a restart from `increment`, without the rows that came after it; and the certificate of
    /// those that stay.
    ///
    /// # Errors
    /// [`Error::File`] when the old table cannot be read or rewritten.
    pub fn resume(directory: &Path, increment: usize) -> Result<(Self, Certificate), Error> {
        let (path, mut certificate) = (directory.join(READINGS), Certificate::default());
        if !path.exists() {
            return Ok((Self::create(directory)?, certificate));
        }
        let table = Table::resume(&path, |columns, row| {
            let at = columns.position("increment").and_then(|i| row[i].parse::<usize>().ok());
            at.is_some_and(|at| at <= increment)
        })?;
        for row in Columns::read(&path)?.rows {
            if let Some((reading, at)) = read(&row) {
                certificate.take(&reading, at);
            }
        }
        Ok((Self(table), certificate))
    }

    /// Adds the readings of a frame.
    ///
    /// # Errors
    /// [`Error::File`] when they cannot be written.
    pub fn push(&mut self, frame: &Frame) -> Result<(), Error> {
        for reading in frame.readings() {
            let leading = [frame.time.into(), frame.step.into(), frame.increment.into()];
            let read = [reading.figure.into(), reading.of.as_str().into(), reading.value.into(), reading.scale.into()];
            let place = (0..3).map(|axis| reading.position.map(|x| x[axis]).into());
            self.0.push(&leading.into_iter().chain(read).chain(place).collect::<Vec<Field>>())?;
        }
        Ok(())
    }
}

/// The reading of a row, with step, increment and time.
fn read(row: &[String]) -> Option<(Reading, (usize, usize, f64))> {
    let [time, step, increment, figure, of, value, scale, place @ ..] = row else { return None };
    let number = |text: &String| text.parse::<f64>().ok();
    let [x, y, z] = place else { return None };
    let position = number(x).zip(number(y)).zip(number(z)).map(|((x, y), z)| Vec3::new(x, y, z));
    let figure = Figure::named(figure)?.name;
    let reading = Reading { figure, of: of.clone(), value: number(value)?, scale: number(scale), position };
    Some((reading, (step.parse().ok()?, increment.parse().ok()?, number(time)?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A certificate that was resumed is the one of a run that was never stopped, to the bit; what came after is gone.
    #[test]
    fn a_restart_takes_up_the_certificate() {
        let directory = tempfile::tempdir().unwrap();
        let mut table = ReadingTable::create(directory.path()).unwrap();
        let mut whole = Certificate::default();
        for increment in 1..=4 {
            let mut frame = Frame::new(1, increment, 0.1 * increment as f64);
            let value = (increment as f64).sin();
            frame.certify(Reading::new("imbalance", "contact 'a, \"b\"'", value).over(value.cos()));
            frame.certify(Reading::new("max_penetration", "", value / 3.0).at(Vec3::new(0.1, value, 0.0)));
            frame.certify(Reading::new("least_dissipation", "", f64::NAN));
            table.push(&frame).unwrap();
            if increment <= 3 {
                whole.observe(&frame);
            }
        }
        let (_, resumed) = ReadingTable::resume(directory.path(), 3).unwrap();
        assert_eq!(format!("{resumed:?}"), format!("{whole:?}"));
        assert_eq!(Columns::read(&directory.path().join(READINGS)).unwrap().rows.len(), 9);
    }
}
