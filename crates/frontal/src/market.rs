//! Matrix Market files, for tests and bug reports.

use crate::error::FrontalError;
use crate::pattern::Pattern;
use std::fmt;
use std::io::{self, BufRead, Write};

/// Why a Matrix Market file was not read.
#[derive(Debug)]
#[non_exhaustive]
pub enum MarketError {
    /// The file could not be read.
    Io(io::Error),
    /// A line, counted from one, is not what the format asks for there.
    Line {
        /// Number of the line.
        number: usize,
        /// What was expected.
        expected: &'static str,
    },
    /// The matrix is not square.
    NotSquare,
    /// The matrix was refused.
    Matrix(FrontalError),
}

impl fmt::Display for MarketError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MarketError::Io(error) => error.fmt(f),
            MarketError::Line { number, expected } => write!(f, "line {number}: expected {expected}"),
            MarketError::NotSquare => write!(f, "the matrix is not square"),
            MarketError::Matrix(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for MarketError {}

/// Reads a sparse real or integer matrix in coordinate form, general or symmetric, into a structurally symmetric
/// pattern and its values. Places that occur only on one side of the diagonal get a zero on the other; values of
/// repeated places are added.
///
/// # Errors
/// [`MarketError`], at the first line that offends.
pub fn read(source: impl BufRead) -> Result<(Pattern, Vec<f64>), MarketError> {
    let mut lines = source.lines().enumerate();
    let mut next = || -> Result<Option<(usize, String)>, MarketError> {
        for (number, line) in lines.by_ref() {
            let line = line.map_err(MarketError::Io)?;
            if number == 0 || !(line.starts_with('%') || line.trim().is_empty()) {
                return Ok(Some((number + 1, line)));
            }
        }
        Ok(None)
    };
    let symmetric = header(next()?)?;
    let (n, entries) = sizes(next()?)?;
    let mut matrix = Triplets { n, list: Vec::new() };
    for _ in 0..entries {
        matrix.push(next()?, symmetric)?;
    }
    matrix.compress()
}

/// Writes a matrix in general coordinate form, with values that read back to the same bits.
///
/// # Errors
/// Those of the writer.
pub fn write(mut target: impl Write, pattern: &Pattern, values: &[f64]) -> io::Result<()> {
    writeln!(target, "%%MatrixMarket matrix coordinate real general")?;
    writeln!(target, "{} {} {}", pattern.len(), pattern.len(), pattern.nonzeros())?;
    for row in 0..pattern.len() {
        for (at, column) in pattern.entries(row) {
            writeln!(target, "{} {} {:e}", row + 1, column + 1, values.get(at).copied().unwrap_or(0.0))?;
        }
    }
    Ok(())
}

fn header(line: Option<(usize, String)>) -> Result<bool, MarketError> {
    let expected = "%%MatrixMarket matrix coordinate real|integer general|symmetric";
    let line = line.map(|(_, line)| line.to_lowercase()).unwrap_or_default();
    match line.split_whitespace().collect::<Vec<_>>()[..] {
        ["%%matrixmarket", "matrix", "coordinate", "real" | "integer", "general"] => Ok(false),
        ["%%matrixmarket", "matrix", "coordinate", "real" | "integer", "symmetric"] => Ok(true),
        _ => Err(MarketError::Line { number: 1, expected }),
    }
}

fn sizes(line: Option<(usize, String)>) -> Result<(usize, usize), MarketError> {
    let expected = "rows, columns and entries";
    let (number, line) = line.ok_or(MarketError::Line { number: 2, expected })?;
    let numbers = line.split_whitespace().map(|word| word.parse::<usize>()).collect::<Result<Vec<_>, _>>();
    match numbers.as_deref() {
        Ok([rows, columns, _]) if rows != columns => Err(MarketError::NotSquare),
        Ok([rows, ..]) if u32::try_from(*rows).is_err() => Err(MarketError::Matrix(FrontalError::TooLarge)),
        Ok([rows, _, entries]) => Ok((*rows, *entries)),
        _ => Err(MarketError::Line { number, expected }),
    }
}

struct Triplets {
    n: usize,
    list: Vec<(u32, u32, f64)>,
}

impl Triplets {
    fn push(&mut self, line: Option<(usize, String)>, symmetric: bool) -> Result<(), MarketError> {
        let expected = "row, column and value";
        let (number, line) = line.ok_or(MarketError::Line { number: self.list.len() + 3, expected })?;
        let (row, column, value) = entry(&line, self.n).ok_or(MarketError::Line { number, expected })?;
        self.list.push((row, column, value));
        if row != column {
            self.list.push((column, row, if symmetric { value } else { 0.0 }));
        }
        Ok(())
    }

    /// Rows in order, with repeated places added up.
    fn compress(mut self) -> Result<(Pattern, Vec<f64>), MarketError> {
        self.list.sort_by_key(|&(row, column, _)| (row, column));
        let mut starts = vec![0; self.n + 1];
        let (mut columns, mut values) = (Vec::new(), Vec::<f64>::new());
        let mut previous = None;
        for (row, column, value) in self.list {
            match values.last_mut() {
                Some(last) if previous == Some((row, column)) => *last += value,
                _ => {
                    starts[row as usize + 1] += 1;
                    columns.push(column as usize);
                    values.push(value);
                }
            }
            previous = Some((row, column));
        }
        (0..self.n).for_each(|row| starts[row + 1] += starts[row]);
        Ok((Pattern::new(starts, columns).map_err(MarketError::Matrix)?, values))
    }
}

/// Row and column from zero, and value; `None` if the line is not of this form or out of range.
fn entry(line: &str, n: usize) -> Option<(u32, u32, f64)> {
    let mut words = line.split_whitespace();
    let mut index = || words.next()?.parse::<usize>().ok().filter(|k| (1..=n).contains(k)).map(|k| k as u32 - 1);
    let (row, column) = (index()?, index()?);
    let value = words.next()?.parse().ok()?;
    words.next().is_none().then_some((row, column, value))
}
