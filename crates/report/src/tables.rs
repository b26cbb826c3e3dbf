//! Tables of numbers for the page, short: seven digits, and at most so many rows.

use asperity_results::output::Columns;
use serde::Serialize;
use serde_json::Value;

/// Rows of a table on the page; of longer ones evenly chosen rows, the last among them.
const ROWS: usize = 3000;

/// A table of the page.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Table {
    /// Names of the columns.
    header: Vec<String>,
    /// The columns; numbers where they are numbers.
    columns: Vec<Vec<Value>>,
    /// Rows that there are in the file.
    rows: usize,
}

impl Table {
    /// The columns of a table that `keep` names, in the rows that are wanted.
    pub fn of(all: &Columns, keep: impl Fn(&str) -> bool, wanted: impl Fn(usize) -> bool) -> Self {
        let rows: Vec<&Vec<String>> =
            (0..all.rows.len()).filter(|&row| wanted(row)).map(|row| &all.rows[row]).collect();
        let count = rows.len();
        let stride = count.div_ceil(ROWS).max(1);
        let chosen: Vec<&Vec<String>> = rows
            .into_iter()
            .enumerate()
            .filter(|(i, _)| (count - 1 - i).is_multiple_of(stride))
            .map(|(_, row)| row)
            .collect();
        let kept = all.header.iter().enumerate().filter(|(_, name)| keep(name));
        let column =
            |(at, name): (usize, &String)| (name.clone(), chosen.iter().map(|row| value(&row[at])).collect::<Vec<_>>());
        let (header, columns) = kept.map(column).unzip();
        Self { header, columns, rows: all.rows.len() }
    }
}

/// A number with seven digits, or a text; nothing where it is no finite number.
fn value(text: &str) -> Value {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => format!("{number:.6e}").parse::<f64>().map_or(Value::Null, short),
        Ok(_) => Value::Null,
        Err(_) if text.is_empty() => Value::Null,
        Err(_) => text.into(),
    }
}

/// Whole numbers without a fraction.
fn short(number: f64) -> Value {
    // Exact below 2^53.
    if number.fract() == 0.0 && number.abs() < 1e15 { (number as i64).into() } else { number.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_table_is_thinned_and_keeps_its_last_row() {
        let rows =
            (0..10_000).map(|i| vec![i.to_string(), "0.123456789".into(), "NaN".into(), "a <b>".into()]).collect();
        let header = ["n", "x", "nan", "text"].map(String::from).to_vec();
        let table = Table::of(&Columns { header, rows }, |name| name != "skip", |_| true);
        assert!(table.columns[0].len() <= ROWS && table.rows == 10_000);
        assert_eq!(table.columns[0].last(), Some(&Value::from(9999)));
        assert_eq!((&table.columns[1][0], &table.columns[2][0]), (&Value::from(0.1234568), &Value::Null));
    }
}
