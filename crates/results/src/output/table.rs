//! Comma-separated tables that grow by whole rows: each row goes to the file in one write, so that a killed run leaves
//! no half of one. Numbers are written with as many digits as give the same bits back.

use super::file::{self, Durability, write_atomic};
use super::units::bare;
use asperity_core::Error;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// One entry of a row.
#[derive(Debug, Clone, PartialEq)]
pub enum Field {
    /// A count or a number of something.
    Count(usize),
    /// A measured value.
    Real(f64),
    /// Words.
    Text(String),
    /// Nothing to say.
    Empty,
}

/// A table in a file.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    file: File,
    width: usize,
}

/// A table read back.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Columns {
    /// Names of the columns, without units.
    pub header: Vec<String>,
    /// Entries, row after row; all rows are as long as the header.
    pub rows: Vec<Vec<String>>,
}

impl From<usize> for Field {
    fn from(value: usize) -> Self {
        Self::Count(value)
    }
}

impl From<f64> for Field {
    fn from(value: f64) -> Self {
        Self::Real(value)
    }
}

impl From<&str> for Field {
    fn from(value: &str) -> Self {
        Self::Text(value.into())
    }
}

impl<T: Into<Field>> From<Option<T>> for Field {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Empty, Into::into)
    }
}

impl std::fmt::Display for Field {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Count(value) => write!(f, "{value}"),
            Self::Real(value) => write!(f, "{value:?}"),
            Self::Text(value) => f.write_str(value),
            Self::Empty => Ok(()),
        }
    }
}

impl Table {
    /// Begins a table, replacing an old one.
    ///
    /// # Errors
    /// [`Error::File`] when the file cannot be written.
    pub fn create<S: AsRef<str>>(path: &Path, header: &[S]) -> Result<Self, Error> {
        let names: Vec<String> = header.iter().map(|name| name.as_ref().to_string()).collect();
        Self::begin(path, &Columns { header: names, rows: Vec::new() })
    }
    /// Continues a table after a restart with the rows that `keep` accepts, given as pairs of column and entry.
    ///
    /// # Errors
    /// [`Error::File`] when the old file cannot be read, or the new one not written.
    pub fn resume(path: &Path, keep: impl Fn(&Columns, &[String]) -> bool) -> Result<Self, Error> {
        let header = Columns::written(path, &file::read(path)?)?.header;
        let mut old = Columns::read(path)?;
        let kept = old.rows.iter().filter(|row| keep(&old, row)).cloned().collect();
        (old.rows, old.header) = (kept, header);
        Self::begin(path, &old)
    }
    /// Continues a table with other columns: rows keep what stood under the names that stay, and are empty under new ones.
    ///
    /// # Errors
    /// As [`resume`](Self::resume).
    pub fn relay(path: &Path, header: &[String]) -> Result<Self, Error> {
        let old = Columns::read(path)?;
        let places: Vec<_> = header.iter().map(|name| old.position(bare(name))).collect();
        let row = |row: &Vec<String>| places.iter().map(|at| at.map_or(String::new(), |at| row[at].clone())).collect();
        Self::begin(path, &Columns { header: header.to_vec(), rows: old.rows.iter().map(row).collect() })
    }
    fn begin(path: &Path, start: &Columns) -> Result<Self, Error> {
        let mut text = line(path, &start.header)?;
        for row in &start.rows {
            text.extend(line(path, row)?);
        }
        write_atomic(path, &text, Durability::Process)?;
        let file = OpenOptions::new().append(true).open(path).map_err(|error| Error::write(path, error))?;
        Ok(Self { path: path.into(), file, width: start.header.len() })
    }
    /// Adds a row.
    ///
    /// # Errors
    /// [`Error::Write`] when it cannot be written, [`Error::Internal`] when it is not as long as the header.
    pub fn push(&mut self, row: &[Field]) -> Result<(), Error> {
        if row.len() != self.width {
            let name = self.path.display();
            return Err(Error::Internal(format!("{name}: a row of {} entries for {} columns", row.len(), self.width)));
        }
        let entries: Vec<String> = row.iter().map(Field::to_string).collect();
        let bytes = line(&self.path, &entries)?;
        self.append(&bytes).map_err(|error| Error::write(&self.path, error))
    }

    /// Appends a row, or nothing of it: half a row, as a full disk leaves it, is taken back.
    fn append(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        let length = self.file.metadata()?.len();
        self.file.write_all(bytes).inspect_err(|_| drop(self.file.set_len(length)))
    }
}

fn line(path: &Path, entries: &[String]) -> Result<Vec<u8>, Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(entries).map_err(|error| Error::file(path, error))?;
    writer.into_inner().map_err(|error| Error::file(path, error.error()))
}

impl Columns {
    /// Reads a table. A last row that is cut short is left out.
    ///
    /// # Errors
    /// [`Error::File`] when it cannot be read or is no table.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::parse(path, &file::read(path)?)
    }
    /// A table from its bytes; messages call it `path`. A last row that is cut short is left out.
    ///
    /// # Errors
    /// [`Error::File`] when it is no table.
    pub fn parse(path: &Path, bytes: &[u8]) -> Result<Self, Error> {
        let mut columns = Self::written(path, bytes)?;
        columns.header.iter_mut().for_each(|name| *name = bare(name).to_owned());
        Ok(columns)
    }
    /// The same with the units behind the names.
    fn written(path: &Path, bytes: &[u8]) -> Result<Self, Error> {
        let mut reader = csv::ReaderBuilder::new().flexible(true).from_reader(bytes);
        let texts = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect::<Vec<_>>();
        let header = texts(reader.headers().map_err(|error| Error::file(path, error))?);
        let records: Result<Vec<_>, _> = reader.records().collect();
        let mut rows: Vec<_> = records.map_err(|error| Error::file(path, error))?.iter().map(texts).collect();
        if !bytes.ends_with(b"\n") {
            rows.pop();
        }
        match rows.iter().position(|row| row.len() != header.len()) {
            Some(row) => Err(Error::file(path, format!("row {} is not as long as the header", row + 1))),
            None => Ok(Self { header, rows }),
        }
    }
    /// Place of a column.
    pub fn position(&self, name: &str) -> Option<usize> {
        self.header.iter().position(|column| column == name)
    }
    /// A column as numbers; not a number where an entry is none.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        let column = self.position(name)?;
        Some(self.rows.iter().map(|row| row[column].parse().unwrap_or(f64::NAN)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(path: &Path) -> Vec<f64> {
        let values = vec![0.1, -1e-300, f64::MAX, 1.0 / 3.0, 0.0];
        let mut table = Table::create(path, &["increment", "force, \"x\"", "reason"]).unwrap();
        for (i, &value) in values.iter().enumerate() {
            table.push(&[i.into(), value.into(), "because, \"so\"\nand so".into()]).unwrap();
        }
        values
    }

    #[test]
    fn numbers_come_back_to_the_bit() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("t.csv");
        let values = sample(&path);
        assert_eq!(Columns::read(&path).unwrap().numbers("force, \"x\"").unwrap(), values);
    }

    #[test]
    fn a_cut_table_keeps_its_whole_rows() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("t.csv");
        sample(&path);
        let whole = std::fs::read(&path).unwrap();
        std::fs::write(&path, &whole[..whole.len() - 3]).unwrap();
        assert_eq!(Columns::read(&path).unwrap().rows.len(), 4);
    }

    #[test]
    fn a_resumed_table_drops_the_rows_after_the_restart() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("t.csv");
        sample(&path);
        let mut table = Table::resume(&path, |_, row| row[0].parse::<usize>().unwrap() < 2).unwrap();
        table.push(&[2.into(), 7.0.into(), Field::Empty]).unwrap();
        let columns = Columns::read(&path).unwrap();
        assert_eq!(columns.numbers("increment").unwrap(), [0.0, 1.0, 2.0]);
        assert_eq!(columns.rows[2], ["2", "7.0", ""]);
    }

    #[test]
    fn a_row_of_another_length_is_refused() {
        let directory = tempfile::tempdir().unwrap();
        let mut table = Table::create(&directory.path().join("t.csv"), &["a", "b"]).unwrap();
        assert!(table.push(&[1.0.into()]).is_err());
    }
}
