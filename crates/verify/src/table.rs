//! The verification table: lines as they are printed, and as the manual shows them.

use crate::Report;
use crate::expect::Line;
use asperity::Error;
use std::fmt::Write;
use std::path::Path;

const HEAD: &str = "# Verification\n\nWritten by `cargo run --release -p verify`; each case alone by \
`cargo run --release -p verify -- CASE`.\nThe cases, with their sources and decks, are in `cases/`.\n";
const COLUMNS: &str = "| figure | value | reference | error | allowed |\n|---|---|---|---|---|\n";

/// One line for a terminal.
pub fn printed(line: &Line) -> String {
    let mark = if line.holds { "ok  " } else { "FAIL" };
    let allowed = line.allowed.map_or(String::new(), |allowed| format!(" (allowed {})", amount(allowed, line.relative)));
    let error = line.error.map_or(String::new(), |error| format!("  error {}{allowed}", amount(error, line.relative)));
    format!("  {mark} {:<52} {:>14}  reference {}{error}", line.what, significant(line.value), line.reference)
}

/// An error, in per cent where it is relative.
fn amount(error: f64, relative: bool) -> String {
    if relative { format!("{} %", significant(100.0 * error)) } else { significant(error) }
}

/// Seven digits for what has the size of a measured value, two powers of ten and a mantissa for the rest.
fn significant(value: f64) -> String {
    match value.abs() {
        0.0 => "0".into(),
        size if (1e-3..1e7).contains(&size) => {
            let digits = (6 - size.log10().floor() as i32).clamp(0, 6) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.2e}"),
    }
}

/// The section of a case.
fn section(report: &Report) -> String {
    let mut text = format!("## {}\n\n`cases/{}`, {:.1} s\n\n{COLUMNS}", report.title, report.name, report.seconds);
    for line in &report.lines {
        let error = line.error.map_or("-".into(), |error| amount(error, line.relative));
        let allowed = line.allowed.map_or("-".into(), |allowed| amount(allowed, line.relative));
        let mark = if line.holds { "" } else { " **missed**" };
        let value = significant(line.value);
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
