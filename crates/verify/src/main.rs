//! `verify [--quick] [CASE ...]`: runs the cases in full, prints value, reference, error and time, and writes the
//! verification table. Exit code 1 where a figure misses its limit, 2 for a case that does not run.
#![forbid(unsafe_code)]

use std::path::Path;
use std::process::ExitCode;
use verify::{Case, Report, Size, cases, table};

fn main() -> ExitCode {
    let (flags, names): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|word| word.starts_with("--"));
    let quick = flags == ["--quick"];
    if !quick && !flags.is_empty() {
        eprintln!("verify [--quick] [CASE ...]");
        return ExitCode::from(2);
    }
    match chosen(&names) {
        Ok(chosen) => run(&chosen, if quick { Size::Quick } else { Size::Full }),
        Err(unknown) => {
            let known: Vec<&str> = cases::ALL.iter().map(|case| case.name).collect();
            eprintln!("there is no case '{unknown}'; there are: {}", known.join(", "));
            ExitCode::from(2)
        }
    }
}

/// The cases of the names given; all without a name.
fn chosen(names: &[String]) -> Result<Vec<&'static Case>, &String> {
    if names.is_empty() {
        return Ok(cases::ALL.to_vec());
    }
    let find = |name| cases::ALL.iter().copied().find(|case| case.name == name).ok_or(name);
    names.iter().map(find).collect()
}

fn run(chosen: &[&Case], size: Size) -> ExitCode {
    let (mut reports, mut broken) = (Vec::new(), false);
    for case in chosen {
        match case.run(size) {
            Ok(report) => {
                show(&report);
                reports.push(report);
            }
            Err(error) => {
                println!("  FAIL {}: {error}\n", case.name);
                broken = true;
            }
        }
    }
    if size == Size::Full {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src/verification.md");
        let order: Vec<&str> = cases::ALL.iter().map(|case| case.name).collect();
        if let Err(error) = table::write(&path, &order, &reports) {
            println!("{error}");
            broken = true;
        }
    }
    match (broken, reports.iter().all(Report::holds)) {
        (true, _) => ExitCode::from(2),
        (_, holds) => ExitCode::from(u8::from(!holds)),
    }
}

fn show(report: &Report) {
    println!("{} ({}, {:.1} s, {})", report.title, report.name, report.seconds, report.effort);
    println!("{}", report.effort.audit(report.seconds));
    report.lines.iter().for_each(|line| println!("{}", table::printed(line)));
    println!();
}
