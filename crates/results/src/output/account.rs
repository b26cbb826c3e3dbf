//! What is known of a run while it goes and when it has ended, whether it leaves files or not: certificate, limits, summary.

use super::certificate::{Certificate, Limits, Occasion};
use super::figures::{FIGURES, Figure};
use super::quantities::{Parts, Source};
use super::quantity::Frame;
use super::summary::{RunStatus, Summary};
use super::witness::certified;
use crate::diagnosis::{Doubted, End, Facts, RunCourse, diagnose, settings};
use asperity_core::Error;
use asperity_core::solid::{Body, Choice};
use asperity_core::system::Term;

/// Certificate and summary of a run.
#[derive(Debug, Clone)]
pub struct Account {
    /// The worst figures so far.
    pub certificate: Certificate,
    /// What they may be.
    pub limits: Limits,
    /// What `summary.json` says.
    pub summary: Summary,
    /// Whether the model has contacts and none of them ever closed.
    idle: bool,
}

impl Account {
    /// Of a run that begins.
    pub fn new(parts: &Parts) -> Self {
        let mut summary = Summary::begin("", parts.space.name());
        summary.unknowns = parts.dofs.count();
        summary.bodies = parts.bodies.iter().map(|(_, body)| body.name().to_string()).collect();
        let lines = |body: &Body| body.choices().iter().map(Choice::line).collect();
        summary.formulations = parts.bodies.iter().map(|(_, body)| (body.name().to_string(), lines(body))).collect();
        summary.materials.clone_from(&parts.material_names);
        summary.contact_order = parts.contacts.iter().map(|(_, name, _)| name.clone()).collect();
        summary.tools = parts.tool_names().into_iter().map(str::to_owned).collect();
        summary.threads = rayon::current_num_threads();
        Self { certificate: Certificate::default(), limits: Limits::default(), summary, idle: false }
    }
    /// Takes up the account of a run that goes on from an accepted state, with what its readings say.
    ///
    /// # Errors
    /// [`Error::Internal`] when the state is not of the model.
    pub fn resume(&mut self, certificate: Certificate, at: &Source) -> Result<(), Error> {
        self.certificate = certificate;
        let (parts, state) = (at.parts, at.state);
        if state.increment > 0 {
            self.summary.observe(&at.gather()?, parts.is_plane());
        }
        (self.summary.steps, self.summary.attempts) = (state.step, state.attempts);
        self.summary.iterations = state.iterations;
        Ok(())
    }
    /// Takes an accepted increment.
    pub fn accepted(&mut self, source: &Source, frame: &Frame) {
        self.summary.observe(frame, source.parts.is_plane());
        self.certificate.observe(frame);
        (self.summary.attempts, self.summary.iterations) = (source.state.attempts, source.state.iterations);
        self.summary.steps = source.state.step;
        self.summary.status = RunStatus::Running;
    }
    /// Says in the summary what the run most likely suffers from, if it failed or is doubtful.
    pub fn diagnose(&mut self, facts: &Facts, course: RunCourse) {
        let mut course = certified(course, &self.certificate, &self.limits);
        let meant = facts.contacts.iter().any(|contact| !contact.itself);
        self.idle = course.ended == End::Well && meant && course.never_closed();
        if self.idle {
            course.doubts.push(Doubted { figure: "closed_points".into(), ..Doubted::default() });
        }
        self.summary.diagnosis = diagnose(facts, &course);
        self.summary.settings = settings(facts, &course);
    }
    /// Puts the figures of the certificate into the summary.
    pub fn certify(&mut self) {
        self.summary.certify(&self.certificate, &self.limits);
    }
    /// Says in the summary how the run ended.
    pub fn end(&mut self, outcome: &Result<(), Error>) {
        let doubts = self.certificate.doubts(&self.limits);
        self.summary.notes.extend(doubts.iter().map(ToString::to_string));
        self.summary.end(outcome, !doubts.is_empty() || self.idle);
        self.certify();
    }
    /// The figures that are beyond their limits, and the one nearest to its limit or farthest beyond.
    pub fn nearest_to_limits(&self) -> (Vec<String>, Option<(String, Occasion)>) {
        let limited = FIGURES.iter().filter(|figure| self.limits.of(figure.name).is_some());
        let worst =
            |figure: &Figure| Some((figure.name.to_owned(), self.certificate.worst(figure.name, &self.limits)?));
        let found: Vec<(String, Occasion)> = limited.filter_map(worst).collect();
        let part = |worst: &Occasion| worst.value / worst.limit.unwrap_or(f64::INFINITY);
        let passes = |worst: &Occasion| part(worst).is_nan() || part(worst) > 1.0;
        let beyond = found.iter().filter(|(_, worst)| passes(worst)).map(|(name, _)| name.clone()).collect();
        // What is not a number is worse than any number, for `total_cmp` too.
        let worst = found.into_iter().max_by(|(_, a), (_, b)| part(a).total_cmp(&part(b)));
        (beyond, worst.filter(|(_, worst)| worst.value != 0.0))
    }
}
