//! `history.csv`: one row an accepted increment, one column a component of every global quantity of its frame.

use super::quantity::{Frame, QuantityPlace, Unit};
use super::table::{Columns, Field, Table};
use super::units::Units;
use asperity_core::Error;
use std::path::{Path, PathBuf};

/// The columns before those of the quantities.
const LEADING: [&str; 3] = ["time", "step", "increment"];

/// Writes the history of a run. The first frame gives the columns.
#[derive(Debug)]
pub struct HistoryTable {
    path: PathBuf,
    plane: bool,
    units: Option<Units>,
    columns: Vec<String>,
    table: Option<Table>,
    /// Whether the run has just gone on, with a deck whose quantities may be others.
    resumed: bool,
}

/// Name of the table of histories in the result directory.
pub const HISTORY: &str = "history.csv";

/// The global quantities of a frame by column; a plane has no z forces and no x, y moments.
pub fn global_columns(frame: &Frame, plane: bool) -> Vec<(String, f64)> {
    let entries = |quantity: &super::Quantity| {
        let columns = quantity.width.columns(plane).iter();
        columns.map(|&(c, suffix)| (format!("{}{suffix}", quantity.name), quantity.values[c])).collect::<Vec<_>>()
    };
    frame.at(QuantityPlace::Global).flat_map(entries).collect()
}

impl HistoryTable {
    /// A history in `directory`; the file appears with the first frame.
    pub fn create(directory: &Path, plane: bool, units: Option<Units>) -> Self {
        Self { path: directory.join(HISTORY), plane, units, columns: Vec::new(), table: None, resumed: false }
    }
    /// Continues a history after a restart from `increment`; later rows are dropped.
    ///
    /// # Errors
    /// [`Error::File`] when the old history cannot be read or rewritten.
    pub fn resume(directory: &Path, plane: bool, increment: usize, units: Option<Units>) -> Result<Self, Error> {
        let mut history = Self::create(directory, plane, units);
        if !history.path.exists() {
            return Ok(history);
        }
        history.table = Some(Table::resume(&history.path, |columns, row| {
            let at = columns.position("increment").and_then(|i| row[i].parse::<usize>().ok());
            at.is_some_and(|at| at <= increment)
        })?);
        history.resumed = true;
        history.columns = Columns::read(&history.path)?.header.split_off(LEADING.len());
        Ok(history)
    }
    /// The names of the columns, with their units where those have names.
    fn header(&self, frame: &Frame) -> Vec<String> {
        let named = |name: &str, unit| Units::header(self.units.as_ref(), name, unit);
        let leading = LEADING.iter().map(|&name| named(name, if name == "time" { Unit::Time } else { Unit::One }));
        let columns = frame.at(QuantityPlace::Global).flat_map(|quantity| {
            let columns = quantity.width.columns(self.plane).iter();
            columns.map(|(_, suffix)| named(&format!("{}{suffix}", quantity.name), quantity.unit)).collect::<Vec<_>>()
        });
        leading.chain(columns).collect()
    }
    /// Adds the row of a frame.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be written, [`Error::Internal`] when its columns differ from the first frame's.
    pub fn push(&mut self, frame: &Frame) -> Result<(), Error> {
        let (names, values): (Vec<String>, Vec<f64>) = global_columns(frame, self.plane).into_iter().unzip();
        if self.table.is_none() {
            self.table = Some(Table::create(&self.path, &self.header(frame))?);
            self.columns.clone_from(&names);
        }
        if std::mem::take(&mut self.resumed) {
            self.table = Some(Table::relay(&self.path, &self.header(frame))?);
            self.columns.clone_from(&names);
        }
        if let Some(odd) = first_difference(&self.columns, &names) {
            return Err(Error::Internal(format!("the columns of history.csv changed within the run, at '{odd}'")));
        }
        let leading = [frame.time.into(), frame.step.into(), frame.increment.into()];
        let row: Vec<Field> = leading.into_iter().chain(values.into_iter().map(Field::Real)).collect();
        self.table.as_mut().map_or(Ok(()), |table| table.push(&row))
    }
}

fn first_difference<'a>(old: &'a [String], new: &'a [String]) -> Option<&'a str> {
    let longest = if old.len() > new.len() { old } else { new };
    let same = old.iter().zip(new).take_while(|(a, b)| a == b).count();
    longest.get(same).map(String::as_str)
}

#[cfg(test)]
mod tests {
    use super::super::{Quantity, Width};
    use super::*;

    fn frame(increment: usize, names: &[&str]) -> Frame {
        let mut frame = Frame::new(1, increment, 0.1 * increment as f64);
        for name in names {
            let values = vec![1.0, 2.0, increment as f64];
            frame.push(Quantity::new(*name, Unit::Force, QuantityPlace::Global, Width::Vector, values)).unwrap();
        }
        frame
    }

    #[test]
    fn columns_follow_the_space_and_rows_the_frames() {
        let directory = tempfile::tempdir().unwrap();
        let mut history = HistoryTable::create(directory.path(), true, None);
        (1..=3).for_each(|i| history.push(&frame(i, &["reaction.end"])).unwrap());
        let columns = Columns::read(&directory.path().join("history.csv")).unwrap();
        assert_eq!(columns.header, ["time", "step", "increment", "reaction.end.x", "reaction.end.y"]);
        assert_eq!(columns.numbers("increment").unwrap(), [1.0, 2.0, 3.0]);
        assert_eq!(global_columns(&frame(3, &["a"]), false)[2], ("a.z".to_string(), 3.0));
    }

    #[test]
    fn a_restart_continues_the_same_columns() {
        let directory = tempfile::tempdir().unwrap();
        let mut history = HistoryTable::create(directory.path(), false, Units::parse("N, mm").ok());
        (1..=3).for_each(|i| history.push(&frame(i, &["a"])).unwrap());
        let mut history = HistoryTable::resume(directory.path(), false, 2, Units::parse("N, mm").ok()).unwrap();
        let text = std::fs::read_to_string(directory.path().join(HISTORY)).unwrap();
        assert!(text.starts_with("time,step,increment,a.x [N],"), "{text}");
        assert_eq!(Columns::read(&directory.path().join(HISTORY)).unwrap().rows.len(), 2);
        history.push(&frame(3, &["a"])).unwrap();
        assert!(history.push(&frame(4, &["a", "b"])).unwrap_err().to_string().contains("b.x"));
    }
}
