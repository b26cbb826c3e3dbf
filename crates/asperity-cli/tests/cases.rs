//! Every case of `cases/` in its quick size; `cargo run --release -p verify` runs them in full.

use verify::{Size, cases, table};

#[test]
fn every_case_holds_in_its_quick_size() {
    let mut wrong = String::new();
    for case in cases::ALL {
        match case.run(Size::Quick) {
            Ok(report) => {
                for line in report.lines.iter().filter(|line| !line.holds) {
                    wrong += &format!("{}: {}\n", case.name, table::printed(line));
                }
                assert!(report.lines.iter().any(|line| line.reference != "-"), "{} checks nothing", case.name);
            }
            Err(error) => wrong += &format!("{}: {error}\n", case.name),
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
}
