//! Prints of models and runs: equal for equal ones, different as soon as anything differs that matters.

use asperity::deck::Made;
use asperity::model::Model;
use asperity::output::{Job, Limits, Start, simulate};
use asperity::solve::{AttemptRecord, Observer};
use asperity::system::{History, Instant, Local, State, Stencils, Term};
use std::fmt::Debug;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

/// What a text feeds into a print.
struct Print(DefaultHasher);

impl Print {
    fn add(&mut self, thing: impl Debug) {
        format!("{thing:?}").hash(&mut self.0);
    }
    fn bits(&mut self, values: &[f64]) {
        values.iter().for_each(|value| value.to_bits().hash(&mut self.0));
    }
}

/// The print of all that the solution and the results of a model depend on.
pub fn print(made: &Made) -> u64 {
    let (model, mut print) = (&made.model, Print(DefaultHasher::new()));
    print.add((&model.title, model.space, model.thickness, &model.materials, &model.supports));
    mesh(model, &mut print);
    parts(model, &mut print);
    print.add((&model.problem.steps, &model.problem.newton, made.results.clone(), &made.deck.limits.limits));
    for (i, term) in model.problem.terms.iter().enumerate() {
        forces(model, i, term.as_ref(), &mut print);
    }
    print.0.finish()
}

fn mesh(model: &Model, print: &mut Print) {
    let mesh = &model.mesh;
    mesh.points.iter().for_each(|point| print.bits(&point.0));
    print.add((&mesh.nodes, &mesh.groups, mesh.kinds.iter().map(|kind| kind.name).collect::<Vec<_>>()));
}

fn parts(model: &Model, print: &mut Print) {
    for (body, material) in &model.bodies {
        print.add((body.name(), body.cells(), material));
    }
    for tool in &model.tools {
        print.add((tool.name(), tool.reference()));
        tool.segments().iter().for_each(|segment| print.add((segment.kind().key, segment.nodes())));
    }
    for tool in &model.solid_tools {
        print.add((tool.name(), tool.reference(), tool.facets()));
    }
    for contact in &model.field_contacts {
        print.add((contact.title(), contact.options()));
    }
    for contact in &model.contacts {
        print.add((
            contact.name(),
            contact.options(),
            contact.target().as_tool().map(|tool| tool.number()),
            contact.surface().faces.len(),
        ));
    }
}

/// Forces, tangents and energies of a term early and at the end of each step, at trial motions of several sizes, and
/// at the opposite one after each: what a law remembers counts.
fn forces(model: &Model, number: usize, term: &dyn Term, print: &mut Print) {
    let (state, mut time) = (model.problem.initial_state(), 0.0);
    print.add(term.name());
    for (step, keys) in model.problem.steps.iter().enumerate() {
        for part in [0.3, 1.0] {
            let step_time = part * keys.duration;
            let at = Instant { step, step_time, time: time + step_time, dt: step_time, factor: None };
            for size in [1e-3, 0.03, 0.1] {
                let u = motion(model, size);
                let history = evaluate((term, number), (&state, at), &u, print);
                let mut state = State { u, ..state.clone() };
                state.histories[number] = history;
                evaluate((term, number), (&state, at), &motion(model, -size), print);
            }
        }
        time += keys.duration;
    }
}

/// A motion without any symmetry.
fn motion(model: &Model, size: f64) -> Vec<f64> {
    let wave = |i: usize| size * model.problem.cell_size * (1.0 + 7.3 * i as f64).sin();
    (0..model.problem.dofs.count()).map(wave).collect()
}

/// The history after an attempt; the old one where there is none.
fn evaluate(
    (term, number): (&dyn Term, usize),
    (state, at): (&State, Instant),
    u: &[f64],
    print: &mut Print,
) -> History {
    let mut history = state.histories[number].clone();
    let attempt = match term.attempt(state, &state.histories[number], at) {
        Ok(attempt) => attempt,
        Err(failure) => {
            print.add(failure);
            return history;
        }
    };
    let (mut stencils, mut local) = (Stencils::default(), Local { wants_tangent: true, ..Local::default() });
    if let Err(failure) = attempt.stencils(u, &mut stencils) {
        print.add(failure);
        return history;
    }
    for (i, stencil) in stencils.list.iter().enumerate() {
        local.u = stencils.dofs(stencil).iter().map(|&dof| u[dof]).collect();
        local.reset(stencil.len);
        let mut new = attempt.scratch(i);
        print.add(attempt.evaluate(i, stencil, &mut new, &mut local));
        print.add(stencils.dofs(stencil));
        let energies = [local.energies.stored, local.energies.dissipated];
        [&local.force[..], &local.tangent, &new, &energies].iter().for_each(|values| print.bits(values));
        if history.slot(i).len() == new.len() {
            history.slot_mut(i).copy_from_slice(&new);
        }
    }
    history
}

/// Listens to the attempts of a run.
struct Listener(Print);

impl Observer for Listener {
    fn attempt(&mut self, attempt: &AttemptRecord) {
        self.0.add((attempt.step, attempt.increment, attempt.attempt, attempt.dt, attempt.failure.is_some()));
        attempt.iterations.iter().for_each(|iteration| self.0.bits(&[iteration.residual]));
    }
}

/// Whether a run converged, and its print: its attempts with their residuals, and which files and checkpoint it leaves.
pub fn run_print(made: &Made) -> (bool, u64) {
    let directory = tempfile::tempdir().unwrap();
    let options = made.results.clone();
    let job = Job {
        directory: directory.path(),
        options,
        input: made.input,
        parts: &made.parts,
        asked: None,
        start: Start::Beginning,
        limits: &Limits::default(),
        notes: &[],
        facts: &Default::default(),
    };
    let mut listener = Listener(Print(DefaultHasher::new()));
    let (_, ended) = simulate(&made.model, &job, &mut listener).unwrap();
    let checkpoint = asperity::output::checkpoint::inspect(&directory.path().join("run.checkpoint"));
    let stamp = checkpoint.map(|head| head.stamp.increment).ok();
    listener.0.add(stamp);
    files(directory.path(), &mut listener.0);
    (ended.is_ok(), listener.0.0.finish())
}

/// The names of all files of a directory and those in it.
fn files(directory: &Path, print: &mut Print) {
    let mut paths: Vec<_> = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        print.add(path.file_name());
        if path.is_dir() {
            files(&path, print);
        }
    }
}
