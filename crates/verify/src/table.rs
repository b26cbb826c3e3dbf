//! The verification table: lines as they are printed, and as the manual shows them.

use crate::Report;
use crate::expect::Line;
use asperity::Error;
use std::fmt::Write;
use std::path::Path;

const HEAD: &str = "# Verification\n\nWritten by `cargo run --release -p verify`; each case alone by \
`cargo run --release -p verify -- CASE`.\nThe cases, with their sources and decks, are in `cases/`. Coarse ones of \
the same physics are part of `cargo test --release`.\n\nEvery registered cell, with every integration and formulation, \
in every space that it fills, passes a patch test, a\nrigid rotation of a stressed body in one increment, and a \
refinement on a field in equilibrium:\n`cargo test --release -p asperity --test cells`.\n";
const COLUMNS: &str = "| figure | value | reference | error | allowed |\n|---|---|---|---|---|\n";

/// One line for a terminal.
pub fn printed(line: &Line) -> String {
    let mark = if line.holds { "ok  " } else { "FAIL" };
    let allowed =
        line.allowed.map_or(String::new(), |allowed| format!(" (allowed {})", amount(allowed, line.relative)));
    let error = line.error.map_or(String::new(), |error| format!("  error {}{allowed}", amount(error, line.relative)));
    format!("  {mark} {:<52} {:>14}  reference {}{error}", line.what, rounded(line.value, 7), line.reference)
}

/// An error, in per cent where it is relative.
fn amount(error: f64, relative: bool) -> String {
    if relative { format!("{} %", rounded(100.0 * error, 3)) } else { rounded(error, 3) }
}

/// So many digits, without zeros at the end; a power of ten where the number is far from one.
fn rounded(value: f64, digits: usize) -> String {
    let size = value.abs();
    if size == 0.0 {
        return "0".into();
    }
    if !(1e-3..1e7).contains(&size) {
        return format!("{value:.*e}", digits.min(3) - 1);
    }
    let places = (digits as i32 - 1 - size.log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.places$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').into() } else { text }
}

/// The section of a case.
fn section(report: &Report) -> String {
    let Report { name, title, seconds, effort, .. } = report;
    let mut text = format!("## {title}\n\n`cases/{name}`, {seconds:.1} s, {effort}\n\n{COLUMNS}");
    for line in &report.lines {
        let error = line.error.map_or("-".into(), |error| amount(error, line.relative));
        let allowed = line.allowed.map_or("-".into(), |allowed| amount(allowed, line.relative));
        let mark = if line.holds { "" } else { " **missed**" };
        let value = rounded(line.value, 7);
        let _ = writeln!(text, "| {} | {value}{mark} | {} | {error} | {allowed} |", line.what, line.reference);
    }
    text
}

/// Writes the sections of the reports into the table; those of other cases stay.
///
/// # Errors
/// [`Error::File`] where the table cannot be written.
pub fn write(path: &Path, order: &[&str], reports: &[Report]) -> Result<(), Error> {
    let old = std::fs::read_to_string(path).unwrap_or_default();
    let old: Vec<&str> = old.split("\n## ").skip(1).collect();
    let mut text = HEAD.to_owned();
    for name in order {
        let kept = || {
            let section = old.iter().find(|section| section.contains(&format!("\n`cases/{name}`, ")));
            section.map(|section| format!("## {}\n", section.trim_end()))
        };
        let new = reports.iter().find(|report| report.name == *name).map(section);
        if let Some(section) = new.or_else(kept) {
            let _ = write!(text, "\n{section}");
        }
    }
    std::fs::write(path, text).map_err(|error| Error::file(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded() {
        assert_eq!(rounded(0.525_232_12, 7), "0.5252321");
        assert_eq!(rounded(-1000.0, 7), "-1000");
        assert_eq!(rounded(46_153.846_2, 7), "46153.85");
        assert_eq!(rounded(3.14e-15, 3), "3.14e-15");
        assert_eq!(amount(0.01, true), "1 %");
        assert_eq!(amount(0.0, true), "0 %");
    }
}
