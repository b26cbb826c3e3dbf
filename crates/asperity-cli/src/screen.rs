//! What a run shows while it goes, and the page at its end.

use crate::ranks;
use asperity::Error;
use asperity::error::visible;
use asperity::output::{FIGURES, RunStatus, Summary};
use asperity::solve::{AttemptRecord, IterationRecord, Observer, Problem, Step};
use asperity::system::State;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::fmt::Write as _;
use std::io::{IsTerminal, Write as _};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A line an increment, below it a bar with the iterations as they happen when a person watches, and a line with the last iteration
/// where nothing was said for a while; asks the run to stop when a signal came.
pub struct Screen<'a> {
    problem: &'a Problem,
    stop: Arc<AtomicBool>,
    bar: Option<ProgressBar>,
    begun: bool,
    voice: Voice,
    /// When something was said last.
    said: Instant,
}

/// How a run is told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Voice {
    /// Lines for people.
    Page,
    /// Nothing but errors.
    Quiet,
    /// Events as lines of JSON.
    Json,
}

const HEADER: &str = "increment  step              time  iterations  residual  order    open   stick    slip";
const TICKS: u64 = 10_000;
/// Silence after which an iteration is told in a line of its own.
const SILENCE: Duration = Duration::from_secs(5);

impl<'a> Screen<'a> {
    /// A screen for a run that begins.
    pub fn new(problem: &'a Problem, stop: Arc<AtomicBool>) -> Self {
        let watched = std::io::stdout().is_terminal() && std::io::stderr().is_terminal();
        Self { problem, stop, bar: watched.then(bar), begun: false, voice: Voice::Page, said: Instant::now() }
    }

    /// The same in another voice; only people get a bar.
    pub fn speaking(self, voice: Voice) -> Self {
        let bar = self.bar.filter(|_| voice == Voice::Page);
        Self { voice, bar, ..self }
    }

    /// Says what begins, to who reads events.
    pub fn begin(&self, title: &str, directory: &Path) {
        if self.voice == Voice::Json {
            let step = |step: &Step| json!({ "name": step.name, "duration": step.duration });
            let steps: Vec<_> = self.problem.steps.iter().map(step).collect();
            let unknowns = self.problem.dofs.count();
            self.line(&json!({ "event": "begin", "title": title, "directory": directory, "unknowns": unknowns, "steps": steps }).to_string());
        }
    }

    /// An attempt as an event.
    fn event(&self, record: &AttemptRecord) -> String {
        let last = record.iterations.last();
        let [open, stick, slip] = last.map_or([0; 3], |last| self.problem.points_by_status(last));
        json!({
            "event": "attempt",
            "step": self.problem.steps.get(record.step).map(|step| &step.name),
            "increment": record.increment,
            "attempt": record.attempt,
            "time": record.time,
            "dt": record.dt,
            "accepted": record.failure.is_none(),
            "reason": record.failure,
            "iterations": record.solutions(),
            "residual": last.map(|last| last.residual),
            "order": record.order(),
            "open": open,
            "stick": stick,
            "slip": slip,
        })
        .to_string()
    }

    /// An iteration as an event.
    fn iteration_event(&self, record: &AttemptRecord, iteration: &IterationRecord) -> String {
        let [open, stick, slip] = self.problem.points_by_status(iteration);
        json!({
            "event": "iteration",
            "increment": record.increment,
            "attempt": record.attempt,
            "iteration": iteration.iteration,
            "residual": iteration.residual,
            "tolerance": iteration.tolerance,
            "open": open,
            "stick": stick,
            "slip": slip,
        })
        .to_string()
    }

    /// An iteration in words.
    fn iteration_words(&self, record: &AttemptRecord, iteration: &IterationRecord) -> String {
        let [open, stick, slip] = self.problem.points_by_status(iteration);
        let relaxed = if record.relaxed { ", relaxed" } else { "" };
        format!(
            "increment {} to {:.5}{relaxed}: iteration {}, residual {:.1e} of {:.0e}, {open} open, {stick} stick, {slip} slip",
            record.increment, record.time, iteration.iteration, iteration.residual, iteration.tolerance
        )
    }

    /// Says that an iteration was made.
    fn tell(&mut self, record: &AttemptRecord, iteration: &IterationRecord) {
        match (self.voice, &self.bar) {
            (Voice::Quiet, _) => {}
            (Voice::Json, _) => self.line(&self.iteration_event(record, iteration)),
            (Voice::Page, Some(bar)) => bar.set_message(visible(&self.iteration_words(record, iteration)).into_owned()),
            (Voice::Page, None) if self.said.elapsed() > SILENCE => {
                self.said = Instant::now();
                self.line(&format!("           {}", self.iteration_words(record, iteration)));
            }
            (Voice::Page, None) => {}
        }
    }

    /// Removes the bar.
    pub fn close(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }

    fn line(&self, line: &str) {
        let line = visible(line);
        match &self.bar {
            Some(bar) => bar.println(line),
            // A reader that has gone is no reason to end a run.
            None => drop(writeln!(std::io::stdout(), "{line}")),
        }
    }

    fn row(&self, record: &AttemptRecord) -> String {
        let step = self.problem.steps.get(record.step).map_or("", |step| step.name.as_str());
        let last = record.iterations.last();
        let residual = last.map_or(f64::NAN, |last| last.residual);
        let order = record.order().map_or("-".into(), |order| format!("{order:.1}"));
        let [open, stick, slip] = last.map_or([0; 3], |last| self.problem.points_by_status(last));
        format!(
            "{:>9}  {step:<12} {:>9.5}  {:>10}  {residual:>8.1e}  {order:>5}  {open:>6}  {stick:>6}  {slip:>6}",
            record.increment,
            record.time,
            record.solutions(),
        )
    }
}

impl Observer for Screen<'_> {
    fn iteration(&mut self, record: &AttemptRecord, iteration: &IterationRecord) {
        self.tell(record, iteration);
    }

    fn attempt(&mut self, record: &AttemptRecord) {
        match self.voice {
            Voice::Quiet => return,
            Voice::Json => return self.line(&self.event(record)),
            Voice::Page => {}
        }
        self.said = Instant::now();
        if !self.begun {
            self.begun = true;
            self.line(HEADER);
        }
        match &record.failure {
            None => {
                self.line(&self.row(record));
                if let Some(turn) = &record.turn {
                    self.line(&format!("{:>9}  {turn}", record.increment));
                }
            }
            Some(why) => self.line(&format!("{:>9}  increment of {:.3e} cut: {why}", record.increment, record.dt)),
        }
    }

    fn accepted(&mut self, state: &State, _: &AttemptRecord) -> Result<(), Error> {
        let total: f64 = self.problem.steps.iter().map(|step| step.duration).sum();
        if let Some(bar) = &self.bar {
            bar.set_position((TICKS as f64 * state.time / total) as u64);
        }
        Ok(())
    }

    fn wants_stop(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    fn stops(&self, asked: bool) -> bool {
        ranks::any(asked || self.wants_stop())
    }

    fn ended(&mut self) {
        ranks::arrive();
    }
}

fn bar() -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {percent:>3} %  {elapsed} of about {duration}  {wide_msg}");
    ProgressBar::new(TICKS).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// How a run ended, how far its answer can be trusted, and where its files are; `again` is the command that goes
/// on, with a setting of its own or none.
pub fn farewell(summary: &Summary, directory: &Path, again: &dyn Fn(Option<&str>) -> String) -> String {
    let mut text = String::from("\n");
    let word = match summary.status {
        RunStatus::Converged => "converged",
        RunStatus::Doubtful => "doubtful",
        RunStatus::Stopped => "stopped on request",
        RunStatus::FileError => "broken off",
        _ => "not converged",
    };
    let (increments, attempts, iterations) = (summary.increments, summary.attempts, summary.iterations);
    let cut = attempts.saturating_sub(increments);
    let seconds = summary.timings.get("run").copied().unwrap_or(0.0);
    // Writing into a String cannot fail.
    let _ = writeln!(
        text,
        "{word}: {increments} increments, {cut} cut, {iterations} iterations, {} unknowns, {seconds:.2} s",
        summary.unknowns
    );
    if summary.factorisations > 0 {
        let _ = writeln!(text, "{}", factors(summary));
    }
    for (body, lines) in &summary.formulations {
        let _ = writeln!(text, "body {body}: {}", lines.join("; "));
    }
    for note in &summary.notes {
        let _ = writeln!(text, "note: {note}");
    }
    text += &likely(summary);
    let _ = writeln!(text, "certificate, the worst of all increments:               limit");
    figures(summary).for_each(|line| text += &line);
    if !matches!(
        summary.status,
        RunStatus::Converged | RunStatus::Doubtful | RunStatus::FileError | RunStatus::InputError
    ) {
        let _ = writeln!(text, "the last accepted increment is kept; from there goes on\n  {}", again(None));
        for setting in &summary.settings {
            let _ = writeln!(text, "or, with {}\n  {}", setting.what, again(Some(&setting.set)));
        }
    }
    let _ = writeln!(text, "results in {}: {}", directory.display(), summary.files.join(" "));
    text
}

/// How often and how matrices were factorised.
fn factors(summary: &Summary) -> String {
    let (all, symmetric) = (summary.factorisations, summary.symmetric_factorisations);
    let how = match symmetric {
        0 => "as L U (unsymmetric)".into(),
        some if some == all => "as L D L^T (symmetric)".into(),
        some => format!("{some} as L D L^T (symmetric), {} as L U", all - some),
    };
    let seconds = summary.timings.get("factorisation").copied().unwrap_or(0.0);
    format!("{all} factorisations, {how}, {seconds:.2} s")
}

/// What the run most likely suffers from, what speaks for it and what to try.
fn likely(summary: &Summary) -> String {
    let mut text = String::new();
    for (rank, finding) in summary.diagnosis.iter().enumerate() {
        let head = if rank == 0 { "most likely" } else { "or else" };
        // Writing into a String cannot fail.
        let _ = writeln!(text, "{head}: {} [{}]", finding.what, finding.cause);
        for line in &finding.evidence {
            let _ = writeln!(text, "  seen: {line}");
        }
        for line in &finding.advice {
            let _ = writeln!(text, "  try:  {line}");
        }
    }
    text
}

/// A line a figure that was read: its value, its limit, and where and when it was worst.
fn figures(summary: &Summary) -> impl Iterator<Item = String> {
    FIGURES.iter().filter_map(|figure| {
        let worst = summary.worst.get(figure.name)?;
        let limit = worst.limit.map_or(String::new(), |limit| format!("{limit}"));
        let place = if worst.value == 0.0 { String::new() } else { worst.place() };
        Some(format!("  {:<37}{:>10.3e}  {limit:>6} {place}", figure.words, worst.value).trim_end().to_owned() + "\n")
    })
}
