//! A run with everything that is written of it, from its start or from the checkpoint in its result directory.

use super::certificate::{Certificate, Limits};
use super::checkpoint::{self, InputHash};
use super::log::RunLog;
use super::progress::Request;
use super::quantities::{Parts, Source};
use super::recorder::Recorder;
use super::results::{CHECKPOINT, ResultOptions, Results, SUMMARY};
use super::summary::{Status, Summary};
use crate::Error;
use crate::diagnosis::Facts;
use crate::mesh::Space;
use crate::model::Model;
use crate::solve::{Observer, Run, RunOptions, Stop, Turn};
use crate::system::State;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Where and how the results of a run are written.
#[derive(Debug, Clone, Copy)]
pub struct Job<'a> {
    /// The result directory.
    pub directory: &'a Path,
    /// What is written, and how often.
    pub options: ResultOptions,
    /// Fingerprint of deck and mesh.
    pub input: InputHash,
    /// Where the run begins.
    pub start: Start,
    /// What the figures of the certificate may be.
    pub limits: &'a Limits,
    /// What was said of the model beforehand, for the notes of the summary.
    pub notes: &'a [String],
    /// What a diagnosis asks of the model.
    pub facts: &'a Facts,
}

/// Where a run begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// At the first increment.
    Beginning,
    /// At the checkpoint in the result directory.
    Checkpoint,
}

/// Runs a model and writes its results; `summary.json` says how it ended, however it ended.
///
/// # Errors
/// An error when the results cannot be written or the checkpoint not be read; nothing was run then. What the run itself
/// ends with is the second part of the result: [`Error::Stopped`] when the audience asked for it.
pub fn simulate(model: &Model, job: &Job, audience: &mut dyn Observer) -> Result<(Summary, Result<(), Error>), Error> {
    let parts = Parts::of(model);
    let state = job.state(model)?;
    if let Some(finished) = job.finished(model, &state) {
        return Ok((finished, Ok(())));
    }
    if let Err(error) = model.problem.check_memory(&state) {
        return Ok((job.refuse(model, &error)?, Err(error)));
    }
    let (results, log) = job.open(model, &Source { parts: &parts, state: &state, step: state.step })?;
    let mut recorder = Recorder::new((&parts, &model.problem), results, log, audience);
    let mut run = model.run(state);
    let begun = Instant::now();
    let ended = run.run(&RunOptions::default(), &mut recorder);
    let seconds = begun.elapsed().as_secs_f64();
    let (mut results, mut reporter, witness) = (recorder.results, recorder.reporter, recorder.witness);
    let mut ended = ended.and_then(|stop| if stop == Stop::Done { Ok(()) } else { Err(Error::Stopped) });
    if ended.is_err()
        && let Err(error) = results.checkpoint(&run.state)
    {
        results.summary.notes.push(format!("the last accepted increment is not kept: {error}"));
        if ended == Err(Error::Stopped) {
            ended = Err(error);
        }
    }
    account(&mut results.summary, &run, seconds);
    results.summary.notes.extend(facets(model, &run.state));
    results.summary.notes.extend(leap(&results.certificate));
    results.summary.notes.extend(imbalance(&results.certificate, job.limits));
    results.summary.notes.extend(large_strain(&results.certificate));
    results.summary.notes.extend(rests(&results.certificate, model.space));
    let failed = match &ended {
        Err(Error::NotConverged(reason)) => Some((run.ended, reason.clone())),
        _ => None,
    };
    let course = witness.course((&model.problem, &run.state), failed);
    if matches!(ended, Ok(()) | Err(Error::NotConverged(_))) {
        results.diagnose(job.facts, course);
    }
    results.finish(&ended)?;
    Request::clear(job.directory)?;
    (reporter.progress.status, reporter.progress.remaining) = (results.summary.status, None);
    reporter.write()?;
    Ok((results.summary, ended))
}

impl Job<'_> {
    /// The checkpoint in a result directory.
    ///
    /// # Errors
    /// [`Error::File`] when there is none.
    pub fn checkpoint_in(directory: &Path) -> Result<PathBuf, Error> {
        let path = directory.join(CHECKPOINT);
        let reason = "there is no checkpoint to go on from; `asperity run` begins at the first increment";
        if path.exists() { Ok(path) } else { Err(Error::file(&path, reason)) }
    }

    fn state(&self, model: &Model) -> Result<State, Error> {
        if self.start == Start::Beginning {
            return Ok(model.problem.initial_state());
        }
        let path = Self::checkpoint_in(self.directory)?;
        let (_, state) = checkpoint::load::<State>(&path, &self.input)?;
        model.problem.fits(&state).map_err(|reason| Error::file(&path, reason))?;
        Ok(state)
    }

    /// The summary of the run, where it goes on from its own end: that tells more than a run of no increments could.
    fn finished(&self, model: &Model, state: &State) -> Option<Summary> {
        if self.start == Start::Beginning || state.step < model.problem.steps.len() {
            return None;
        }
        let mut summary = Summary::read(&self.directory.join(SUMMARY)).ok()?;
        let same = summary.status == Status::Converged && summary.input_hash == Some(self.input.to_string());
        summary.notes.push("this run had come to its end before; nothing was computed or written".into());
        same.then_some(summary)
    }

    /// The summary of a run that does not begin; where it was to go on, that of the run so far stands.
    fn refuse(&self, model: &Model, error: &Error) -> Result<Summary, Error> {
        let mut summary = Summary::begin(&model.title, model.space.name());
        (summary.input_hash, summary.unknowns) = (Some(self.input.to_string()), model.problem.dofs.count());
        summary.notes.extend_from_slice(self.notes);
        summary.end(&Err(error.clone()), false);
        if self.start == Start::Beginning {
            Results::clear(self.directory)?;
            summary.write(&self.directory.join(SUMMARY))?;
        }
        Ok(summary)
    }

    fn open(&self, model: &Model, start: &Source) -> Result<(Results, RunLog), Error> {
        let mut results = match self.start {
            Start::Beginning => Results::create(self.directory, start, self.options, self.input)?,
            Start::Checkpoint => Results::resume(self.directory, start, self.options, self.input)?,
        };
        results.limits.clone_from(self.limits);
        results.summary.title.clone_from(&model.title);
        results.summary.notes.extend_from_slice(self.notes);
        results.summary.threads = rayon::current_num_threads();
        results.write_summary()?;
        let log = match self.start {
            Start::Beginning => RunLog::create(self.directory)?,
            Start::Checkpoint => RunLog::resume(self.directory, start.state.increment)?,
        };
        Ok((results, log))
    }
}

/// What an increment that leaps means.
fn leap(certificate: &Certificate) -> Option<String> {
    let far = certificate.figure("leap").filter(|far| *far > 0.0)?;
    Some(format!(
        "an increment moved the model by {far:.2} of its size, more than 20 times as fast as the increment before: past \
         a limit load that may be a remote equilibrium; prescribed displacements, or smaller increments, can tell"
    ))
}

/// Part of their force by which two sides of a contact may differ without a word.
const BALANCED: f64 = 0.02;

/// What it means that two sides of a contact press with different forces, where that is no doubt yet.
fn imbalance(certificate: &Certificate, limits: &Limits) -> Option<String> {
    let worst = certificate.worst("imbalance", limits)?;
    let noted = worst.value > BALANCED && worst.limit.is_some_and(|limit| worst.value <= limit);
    noted.then(|| {
        format!(
            "the forces on the two sides differ by {:.1} %{}: with two passes each side answers for itself, and action equals \
             reaction only as far as the meshes agree; finer meshes bring them together, passes = \"one\" makes them equal",
            100.0 * worst.value,
            worst.place()
        )
    })
}

/// Displacement gradient up to which small strain is taken at its word.
const SMALL: f64 = 0.1;

/// What it means that a body in small strain moves by more than that.
fn large_strain(certificate: &Certificate) -> Vec<String> {
    let beyond = certificate.each("small_strain").filter(|(_, gradient)| *gradient > SMALL);
    let said = |(body, gradient): (&str, f64)| {
        format!(
            "{body} is computed in small strain, but the gradient of its displacements reaches {gradient:.2}: strains \
             and rotations beyond {SMALL} are not small, and results are wrong by a part of that order; \
             strain = \"finite\" has no such limit"
        )
    };
    beyond.map(said).collect()
}

/// Closed points along one direction below which the force of a contact is not smooth.
const FEW: usize = 3;

/// What it means that a contact never closed, or at so few points that its force changes with each of them.
fn rests(certificate: &Certificate, space: Space) -> Vec<String> {
    let few = (if space == Space::Solid { FEW * FEW } else { FEW }) as f64;
    let said = |(contact, most): (&str, f64)| match most {
        0.0 => Some(format!(
            "{contact} never closed in the whole run; `asperity check` says what its points see: the surface or the target \
             may be another than is meant, a tool may have its material on the wrong side, or nothing moves them together"
        )),
        most if most < few => Some(format!(
            "{contact} rested on {most} points at most, fewer than the {few} of a force that changes smoothly as it moves; a \
             finer surface, a higher `gauss` or `parts` of an edge give it more"
        )),
        _ => None,
    };
    certificate.each("closed_points").filter_map(said).collect()
}

/// What contacts say of their facets in the last accepted state.
fn facets(model: &Model, state: &State) -> Vec<String> {
    let contacts = Parts::of(model).contacts;
    contacts.iter().filter_map(|(term, _, contact)| contact.facets(&state.u, &state.histories[*term])).collect()
}

/// Changes of stability that are told one by one.
const TOLD: usize = 5;

/// Where stability was lost or found again.
fn turns(turns: &[Turn]) -> impl Iterator<Item = String> {
    let more = turns.len().saturating_sub(TOLD);
    let more = (more > 0).then(|| format!("{more} more changes of stability; the modes of all are in modes.pvd"));
    let told = turns.iter().take(TOLD).map(|turn| {
        let lost = turn.negative[1] > turn.negative[0];
        let help =
            "; a perfect shape stays on its path beyond it, a small imperfection along the mode (modes.pvd) leaves it";
        format!("{turn}{}", if lost { help } else { "" })
    });
    told.chain(more)
}

/// What the run knows of its cost, and of promises that it bends.
fn account(summary: &mut Summary, run: &Run, seconds: f64) {
    (summary.attempts, summary.iterations) = (run.state.attempts, run.state.iterations);
    summary.timings.insert("run".into(), seconds);
    (summary.factorisations, summary.symmetric_factorisations) = (run.memory.factorisations, run.memory.symmetric);
    summary.timings.insert("factorisation".into(), run.memory.factorising.as_secs_f64());
    summary.timings.insert("stability".into(), run.stability.spent.as_secs_f64());
    summary.notes.extend(turns(&run.stability.turns));
    summary.timings.insert("audit".into(), run.audited.as_secs_f64());
    summary.notes.extend(run.problem.newton.notes());
    let cut = summary.attempts.saturating_sub(summary.increments);
    if cut > summary.increments / 2 {
        summary.notes.push(format!(
            "{cut} of {} attempts at an increment were cut; the page \"When a run does not converge\" of the manual says what helps",
            summary.attempts
        ));
    }
    if run.state.held > 0 {
        let first =
            run.first_held.as_ref().map_or(String::new(), |(what, time)| format!(" ({what} from time {time:.4} on)"));
        summary.notes.push(format!(
            "in {} increments something was held still that nothing holds any more{first}: it stays where it is until something \
             touches it; with `solver.if_free = \"stop\"` the run ends there",
            run.state.held
        ));
    }
    if run.state.jumps > 0 {
        summary.notes.push(format!(
            "{} increments ended beyond an instability; they set an energy of {:.4e} free",
            run.state.jumps, run.state.released
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Frame, Reading};
    use super::*;

    #[test]
    fn a_body_that_leaves_small_strain_is_named() {
        let mut frame = Frame::new(1, 1, 1.0);
        for (body, gradient) in [("body 'soft'", 0.137), ("body 'stiff'", 0.099)] {
            frame.certify(Reading::new("small_strain", body, gradient));
        }
        let mut certificate = Certificate::default();
        certificate.observe(&frame);
        let [said] = &large_strain(&certificate)[..] else { panic!("one note") };
        assert!(said.contains("'soft'") && said.contains("0.14") && said.contains("beyond 0.1"), "{said}");
    }
}
