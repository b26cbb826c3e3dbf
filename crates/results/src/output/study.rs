//! What the penalty is worth: the same model with two penalties, and what their answers say of a rigid interface.
//!
//! The answer with a penalty `K` misses that of a rigid interface by a term of the order of `1 / K`, hence from those with
//! `K / r` and `K`: `F = F_K + (F_K - F_K/r) / (r - 1)`. As for two meshes of a convergence study, three times the
//! correction is stated as its error (Roache, J. Fluids Eng. 116, 1994), but no less than what the iterations leave.

use super::{Parts, Source, global_columns};
use asperity_core::Error;
use asperity_core::model::Model;
use asperity_core::solve::{AttemptRecord, Observer, RunOptions, Stop};
use asperity_core::system::State;
use std::fmt::Write;

/// Margin of the stated error over the correction.
const MARGIN: f64 = 3.0;
/// Values below this part of the largest of their step are not listed.
const LITTLE: f64 = 1e-6;

/// The forces of a run at the end of each step.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ends {
    /// For each step its name and the columns of the history that are forces and moments, or motions of tools.
    pub steps: Vec<(String, Vec<(String, f64)>)>,
}

/// One line of the study.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyLine {
    /// The step at whose end it stands.
    pub step: String,
    /// The column of the history.
    pub name: String,
    /// Values with the soft and with the stiff penalty.
    pub values: [f64; 2],
    /// The value of a rigid interface.
    pub extrapolated: f64,
    /// What it may be wrong by.
    pub error: f64,
}

/// Listens to a run and keeps what stands at the ends of its steps.
struct Keeper<'a> {
    parts: Parts<'a>,
    model: &'a Model,
    audience: &'a mut dyn Observer,
    ends: Ends,
}

impl Observer for Keeper<'_> {
    fn attempt(&mut self, record: &AttemptRecord) {
        self.audience.attempt(record);
    }
    fn accepted(&mut self, state: &State, record: &AttemptRecord) -> Result<(), Error> {
        self.audience.accepted(state, record)?;
        if state.step > record.step {
            let frame = Source { parts: &self.parts, state, step: record.step }.gather()?;
            let columns = global_columns(&frame, self.parts.is_plane()).into_iter();
            let name = self.model.problem.steps[record.step].name.clone();
            self.ends.steps.push((name, columns.filter(|(column, _)| listed(column)).collect()));
        }
        Ok(())
    }
    fn wants_stop(&self) -> bool {
        self.audience.wants_stop()
    }
}

/// Whether a column of the history is worth a line.
fn listed(column: &str) -> bool {
    let contact = |column: &str| [".force", ".moment", ".thrust"].iter().any(|part| column.contains(part));
    match column.split_once('.') {
        Some(("reaction" | "tool", _)) => true,
        Some(("contact", rest)) => contact(rest),
        _ => false,
    }
}

/// Runs a model and keeps its forces at the ends of its steps.
///
/// # Errors
/// What the run ends with; [`Error::Stopped`] when the audience asked for it.
pub fn forces(model: &Model, audience: &mut dyn Observer) -> Result<Ends, Error> {
    let mut keeper = Keeper { parts: Parts::of(model), model, audience, ends: Ends::default() };
    let mut run = model.run(model.problem.initial_state());
    match run.run(&RunOptions::default(), &mut keeper)? {
        Stop::Done => Ok(keeper.ends),
        Stop::Asked => Err(Error::Stopped),
    }
}

/// What two runs say whose penalties differ by the factor `ratio`; `tolerance` is that of the iterations.
pub fn extrapolate(soft: &Ends, stiff: &Ends, ratio: f64, tolerance: f64) -> Vec<StudyLine> {
    let mut lines = Vec::new();
    for ((step, soft), (_, stiff)) in soft.steps.iter().zip(&stiff.steps) {
        // Forces, moments and motions are measured by the largest of their kind.
        let largest = |kind: &str| {
            let same = stiff.iter().filter(|(name, _)| kind_of(name) == kind);
            same.map(|(_, value)| value.abs()).fold(0.0, f64::max)
        };
        for ((name, soft), (_, stiff)) in soft.iter().zip(stiff) {
            let (size, correction) = (largest(kind_of(name)), (stiff - soft) / (ratio - 1.0));
            if stiff.abs() > LITTLE * size {
                let error = (MARGIN * correction.abs()).max(tolerance * size);
                let (step, name) = (step.clone(), name.clone());
                lines.push(StudyLine { step, name, values: [*soft, *stiff], extrapolated: stiff + correction, error });
            }
        }
    }
    lines
}

/// What is measured by the same largest value.
fn kind_of(name: &str) -> &'static str {
    let what = name.rsplit('.').nth(1);
    ["moment", "rotation", "translation"].into_iter().find(|kind| what == Some(kind)).unwrap_or("force")
}

/// The study as a table: for each step the values with both penalties, the extrapolated one and its error.
pub fn table(lines: &[StudyLine]) -> String {
    let width = lines.iter().map(|line| line.name.len()).max().unwrap_or(0);
    let (mut text, mut step) = (String::new(), None);
    for line in lines {
        // Writing into a String cannot fail.
        if step != Some(&line.step) {
            let _ = writeln!(text, "\nstep '{}'", line.step);
            let _ =
                writeln!(text, "  {:width$}  {:>14}  {:>14}  {:>14}  {:>8}", "", "softer", "stiffer", "rigid", "+-");
            step = Some(&line.step);
        }
        let [soft, stiff] = line.values;
        let _ = writeln!(
            text,
            "  {:width$}  {soft:>14.7e}  {stiff:>14.7e}  {:>14.7e}  {:>8.1e}",
            line.name, line.extrapolated, line.error
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ends(penalty: f64) -> Ends {
        let force = 100.0 * (1.0 - 2.0 / penalty + 1.0 / (penalty * penalty));
        let columns = [("contact.c.force.y", force), ("reaction.top.x", 1e-9), ("reaction.top.y", -force)];
        let columns = columns.map(|(name, value)| (name.to_owned(), value)).to_vec();
        Ends { steps: vec![("push".into(), columns)] }
    }

    #[test]
    fn the_term_in_the_penalty_is_taken_out() {
        let lines = extrapolate(&ends(100.0), &ends(400.0), 4.0, 1e-9);
        assert_eq!(lines.len(), 2, "rounding is not listed");
        for (line, exact) in lines.iter().zip([100.0, -100.0]) {
            let off = |value: f64| (value - exact).abs();
            assert!(off(line.extrapolated) < 0.02 * off(line.values[1]), "{line:?}");
            assert!((line.extrapolated - line.values[1]).abs() < line.error && off(line.extrapolated) < line.error);
        }
        assert!(table(&lines).contains("contact.c.force.y"));
    }

    /// Where the penalty changes nothing the error is that of the iterations.
    #[test]
    fn no_error_is_less_than_that_of_the_iterations() {
        let lines = extrapolate(&ends(1e30), &ends(4e30), 4.0, 1e-6);
        assert!((lines[0].error - 1e-4).abs() < 1e-12);
    }
}
