//! Where a case is run: its folder, its size, its decks solved.

use crate::{Measured, Size};
use asperity::contact::ContactRecord;
use asperity::model::Model;
use asperity::output::Parts;
use asperity::output::figure::Chart;
use asperity::solve::{AttemptRecord, Observer, RunOptions};
use asperity::system::State;
use asperity::tensor::Vec3;
use asperity::{Error, deck};
use std::cell::Cell;
use std::path::{Path, PathBuf};

/// The folder and the size of a case.
pub struct Bench {
    folder: PathBuf,
    /// The size to run.
    pub size: Size,
    effort: Cell<Effort>,
}

/// What all runs of a case took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Effort {
    /// Accepted increments.
    pub increments: usize,
    /// Increments that were cut.
    pub cuts: usize,
    /// Solved linear systems, those of increments that were cut too.
    pub iterations: usize,
    /// The worst interpenetration that the audit found, over the size of the cell,
    pub interpenetration: f64,
    /// and the seconds that it took.
    pub audited: f64,
}

impl Effort {
    /// Together with the attempts of one more run.
    fn and(self, attempts: &[AttemptRecord]) -> Self {
        let cuts = attempts.iter().filter(|attempt| attempt.failure.is_some()).count();
        Self {
            increments: self.increments + attempts.len() - cuts,
            cuts: self.cuts + cuts,
            iterations: self.iterations + attempts.iter().map(AttemptRecord::solutions).sum::<usize>(),
            ..self
        }
    }
    /// What the audit found and took, in words, of a case that took so many seconds.
    pub fn audit(&self, seconds: f64) -> String {
        let share = 100.0 * self.audited / seconds.max(f64::MIN_POSITIVE);
        format!("interpenetration {:.4}, audit {share:.1} % of the time", self.interpenetration)
    }
}

impl std::fmt::Display for Effort {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mean = self.iterations as f64 / self.increments.max(1) as f64;
        write!(f, "{} increments of {mean:.2} iterations, {} cut", self.increments, self.cuts)
    }
}

/// A model and its last state.
pub struct Solved {
    /// The model.
    pub model: Model,
    /// The state at the end of the last step.
    pub state: State,
    /// All attempts, with their iterations.
    pub attempts: Vec<AttemptRecord>,
}

impl Bench {
    /// The bench of the case in `cases/NAME`.
    pub fn new(name: &str, size: Size) -> Self {
        Self {
            folder: Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name),
            size,
            effort: Cell::default(),
        }
    }

    /// The folder of the case.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// What the runs so far took.
    pub fn effort(&self) -> Effort {
        self.effort.get()
    }

    /// One value for each size.
    pub fn pick<T>(&self, quick: T, full: T) -> T {
        match self.size {
            Size::Quick => quick,
            Size::Full => full,
        }
    }

    /// The first line of the README, without its mark.
    ///
    /// # Errors
    /// [`Error::File`] without a README.
    pub fn title(&self) -> Result<String, Error> {
        let text = read(&self.folder.join("README.md"))?;
        Ok(text.lines().next().unwrap_or_default().trim_start_matches(['#', ' ']).to_owned())
    }

    /// Writes a chart of a full run among the pictures of the book.
    ///
    /// # Errors
    /// [`Error::File`] where it cannot be written.
    pub fn draw(&self, name: &str, chart: &Chart) -> Result<(), Error> {
        if self.size == Size::Quick {
            return Ok(());
        }
        let path = self.folder.join("../../book/src/images").join(name).with_extension("svg");
        std::fs::write(&path, chart.draw().to_svg()).map_err(|error| Error::file(&path, error))
    }

    /// The model of a deck with some of its values set.
    ///
    /// # Errors
    /// What the deck says.
    pub fn model(&self, deck: &str, sets: &[String]) -> Result<Model, Error> {
        Ok(deck::build(deck::load(&self.folder.join(deck), sets)?)?.model)
    }

    /// Solves a deck with some of its values set.
    ///
    /// # Errors
    /// What the deck says, or why the run stopped.
    pub fn solve(&self, deck: &str, sets: &[String]) -> Result<Solved, Error> {
        self.follow(deck, sets, |_, _| {})
    }

    /// The same, with a look at every accepted state.
    ///
    /// # Errors
    /// What the deck says, or why the run stopped.
    pub fn follow(&self, deck: &str, sets: &[String], look: impl FnMut(&Model, &State)) -> Result<Solved, Error> {
        let (solved, end) = self.run(deck, sets, look)?;
        end.map(|()| solved)
    }

    /// Solves a deck whose load is more than is carried: the state in which no increment is found any more.
    ///
    /// # Errors
    /// What the deck says, or that all of the load is carried.
    pub fn exhaust(&self, deck: &str, sets: &[String]) -> Result<Solved, Error> {
        match self.run(deck, sets, |_, _| {})? {
            (solved, Err(Error::NotConverged(_))) => Ok(solved),
            (_, Err(error)) => Err(error),
            (_, Ok(())) => Err(Error::input(format!("{deck}: all of the load is carried, so that it is no limit"))),
        }
    }

    /// The last accepted state, and why the run ended.
    fn run(
        &self,
        deck: &str,
        sets: &[String],
        look: impl FnMut(&Model, &State),
    ) -> Result<(Solved, Result<(), Error>), Error> {
        let model = self.model(deck, sets)?;
        let mut follower = Follower { model: &model, look, attempts: Vec::new() };
        let mut run = model.run(model.problem.initial_state());
        let end = run.run(&RunOptions::default(), &mut follower).map(|_| ());
        let effort = self.effort().and(&follower.attempts);
        self.effort.set(Effort {
            interpenetration: effort.interpenetration.max(run.state.worst_interpenetration.relative),
            audited: effort.audited + run.audited.as_secs_f64(),
            ..effort
        });
        let (state, attempts) = (run.state, follower.attempts);
        Ok((Solved { model, state, attempts }, end))
    }
}

/// What a case measures by default, and under `points-` what it measures with the sets of the paper's form.
///
/// # Errors
/// Those of the case.
pub fn both_forms(paper: &[&str], measure: impl Fn(&[String]) -> Result<Measured, Error>) -> Result<Measured, Error> {
    let paper: Vec<String> = paper.iter().map(|&set| set.to_owned()).collect();
    let points = measure(&paper)?.into_iter().map(|(key, value)| (format!("points-{key}"), value));
    Ok(measure(&[])?.into_iter().chain(points).collect())
}

/// The text of a file.
///
/// # Errors
/// [`Error::File`] with its path.
pub fn read(path: &Path) -> Result<String, Error> {
    std::fs::read_to_string(path).map_err(|error| Error::file(path, error))
}

struct Follower<'a, F> {
    model: &'a Model,
    look: F,
    attempts: Vec<AttemptRecord>,
}

impl<F: FnMut(&Model, &State)> Observer for Follower<'_, F> {
    fn attempt(&mut self, attempt: &AttemptRecord) {
        self.attempts.push(attempt.clone());
    }
    fn accepted(&mut self, state: &State, _: &AttemptRecord) -> Result<(), Error> {
        (self.look)(self.model, state);
        Ok(())
    }
}

/// The points of a contact in a state.
pub fn points(model: &Model, state: &State, contact: usize) -> Vec<ContactRecord> {
    let (term, _, contact) = Parts::of(model).contacts.swap_remove(contact);
    contact.records(&state.u, &state.histories[term])
}

/// The force of points together.
pub fn resultant(points: &[ContactRecord]) -> Vec3 {
    points.iter().fold(Vec3::zero(), |sum, point| sum + point.force())
}

/// What both sides of the first contact bear: of a field, which has one side, the same points turned round.
pub fn sides(model: &Model, state: &State) -> [Vec<ContactRecord>; 2] {
    let one = points(model, state, 0);
    if model.field_contacts.is_empty() {
        return [one, points(model, state, 1)];
    }
    let mut other = one.clone();
    other.iter_mut().for_each(ContactRecord::turn);
    [one, other]
}

/// The penalty of the first contact, whatever its kind.
pub fn penalty(model: &Model) -> f64 {
    Parts::of(model).contacts[0].2.options().penalty
}

/// Force of the supports on the nodes of a group: what the terms exert there beyond the loads.
pub fn reaction(model: &Model, state: &State, group: &str) -> [f64; 2] {
    let nodes = model.mesh.groups.get(group).map_or(&[][..], |group| &group.nodes);
    let at = |axis: usize| {
        let dofs = nodes.iter().map(|&node| model.problem.dofs.node(node) + axis);
        dofs.map(|dof| state.internal[dof] - state.load[dof]).sum()
    };
    [at(0), at(1)]
}

impl Solved {
    /// The points of a contact at the end.
    pub fn points(&self, contact: usize) -> Vec<ContactRecord> {
        points(&self.model, &self.state, contact)
    }
    /// Force of the supports on the nodes of a group at the end.
    pub fn reaction(&self, group: &str) -> [f64; 2] {
        reaction(&self.model, &self.state, group)
    }
    /// Increments that were cut.
    pub fn cuts(&self) -> usize {
        self.attempts.iter().filter(|attempt| attempt.failure.is_some()).count()
    }
    /// Solved linear systems; those of increments that were cut count.
    pub fn solutions(&self) -> usize {
        self.attempts.iter().map(AttemptRecord::solutions).sum()
    }
    /// The same over accepted increments.
    pub fn iterations(&self) -> f64 {
        self.solutions() as f64 / (self.attempts.len() - self.cuts()) as f64
    }
    /// Median of the orders of convergence of all increments that show one.
    pub fn order(&self) -> f64 {
        let mut orders: Vec<f64> = self.attempts.iter().filter_map(|attempt| attempt.order()).collect();
        orders.sort_by(f64::total_cmp);
        orders.get(orders.len() / 2).copied().unwrap_or(f64::NAN)
    }
}
