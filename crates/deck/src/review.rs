//! Everything that can be said of a model before it is solved: its parts and their numbers, what each contact finds,
//! overlaps, penalties, what is free to move, defaults in use. What looks wrong is a warning at the deck's line.

use super::build::Made;
use super::diagnose::{Diagnostic, Severity};
use super::facts::facts_seen;
use super::keys;
use super::reader::Name;
use asperity_core::contact::field::{FieldContact, FieldSurface};
use asperity_core::contact::{ContactOptions, LoadedSides, PaperContact, second_name};
use asperity_core::solve::{OfRanks, Step, engine};
use asperity_core::system::Term;
use asperity_core::tool::Hit;
use asperity_core::tool::{ProfileTool, Rejected};
use asperity_core::{Error, machine};
use asperity_results::diagnosis::oddities;
use rayon::current_num_threads;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::num::NonZeroUsize;

/// A penetration above this part of its edge is worth a warning before the first increment.
const OVERLAP: f64 = 1e-3;

/// Flops of a factorisation from which on its time is worth knowing.
const LASTING: f64 = 1e9;

/// Time of a factorisation over that of as much work in the one full matrix that is timed: the fronts of a tree keep all
/// threads busy. Measured on two threads, from 6 000 to 102 000 unknowns; single models lie between 0.3 and 0.6.
const OF_A_TREE: f64 = 0.53;

/// What is said of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Review {
    /// A page for people.
    pub text: String,
    /// What looks wrong; the warnings of the reading among them.
    pub problems: Vec<Diagnostic>,
}

/// What is known to look wrong without solving anything: the warnings of the reading, and contacts that find nothing or
/// begin inside; and what was made otherwise than the deck has it.
pub fn warnings(made: &Made) -> Vec<Diagnostic> {
    let changes = made.diagnostics.list.iter().filter(|found| found.changes).cloned();
    warnings_of(made, &Seen::all(made)).into_iter().chain(changes).collect()
}

fn warnings_of(made: &Made, all: &[Seen]) -> Vec<Diagnostic> {
    let warnings = made.diagnostics.list.iter().filter(|d| d.severity <= Severity::Warning).cloned();
    let odd = made.deck.contact.iter().flat_map(|(name, contact)| {
        // What may touch itself seldom does so from the beginning.
        let itself = contact.surface.text == contact.target.text;
        let told = move |seen: &&Seen| !(itself && seen.found.is_empty());
        Seen::of(all, name).filter(told).filter_map(|seen| seen.oddity(name))
    });
    let facts = facts_seen(made, all);
    let implausible = oddities(&facts).into_iter().map(|oddity| Diagnostic::warning(oddity.what).help(oddity.help));
    warnings.chain(odd).chain(implausible).collect()
}

/// Looks a model over.
///
/// # Errors
/// An error of the solver that is not the model's fault.
pub fn review(made: &Made) -> Result<Review, Error> {
    review_for(made, None)
}

/// The same for a run on this machine, or on so many ranks of a cluster, whose memory is not this machine's.
///
/// # Errors
/// An error of the solver that is not the model's fault.
pub fn review_for(made: &Made, ranks: Option<NonZeroUsize>) -> Result<Review, Error> {
    let all = Seen::all(made);
    let mut problems = warnings_of(made, &all);
    let mut page = Page::default();
    page.model(made);
    page.bodies(made);
    page.tools(made);
    for (name, keys) in &made.deck.contact {
        Seen::of(&all, name).for_each(|seen| page.contact(name, keys, seen));
    }
    page.ties(made);
    page.rigid(made);
    page.steps(made);
    problems.extend(page.motions(made)?);
    problems.extend(page.cost(made, ranks)?);
    page.unsaid(made);
    Ok(Review { text: page.text, problems })
}

/// The page as it grows. Writing into a `String` cannot fail.
#[derive(Default)]
struct Page {
    text: String,
}

impl Page {
    fn line(&mut self, line: impl AsRef<str>) {
        let _ = writeln!(self.text, "{}", line.as_ref());
    }

    fn model(&mut self, made: &Made) {
        let (model, mesh) = (&made.model, &made.model.mesh);
        if !model.title.is_empty() {
            self.line(&model.title);
        }
        let thickness = match model.space.dimension() {
            2 if model.space != asperity_core::mesh::Space::Axisymmetric => format!(", thickness {}", model.thickness),
            _ => String::new(),
        };
        self.line(format!("space {}{thickness}", model.space.name()));
        let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
        mesh.kinds.iter().for_each(|kind| *kinds.entry(kind.name).or_default() += 1);
        let kinds = kinds.iter().map(|(kind, count)| format!("{count} {kind}")).collect::<Vec<_>>().join(", ");
        let unknowns = model.problem.dofs.count();
        self.line(format!("mesh: {} nodes, {kinds}, {unknowns} unknowns", mesh.points.len()));
    }

    fn bodies(&mut self, made: &Made) {
        for (body, material) in &made.model.bodies {
            let law = &made.deck.material[*material].1;
            let cells = body.cells().len();
            self.line(format!("body {}: {cells} cells of {} ({law:?})", body.name(), made.model.materials[*material]));
            for choice in body.choices() {
                self.line(format!("  {}", choice.line()));
                choice.advice().for_each(|advice| self.line(format!("  note: {advice}")));
            }
            for advice in body.material().advice().into_iter().chain(law.advice()) {
                self.line(format!("  note: {advice}"));
            }
            if body.unseen() > 0 {
                self.line(format!(
                    "  {} motions of each of its cells of first degree meet no stiffness with reduced integration \
                     (hourglass); hourglass.{} of the history is their part of the motion",
                    body.unseen(),
                    body.name()
                ));
            }
        }
    }

    fn tools(&mut self, made: &Made) {
        for tool in &made.model.tools {
            self.line(format!("tool {}: {}", tool.name(), profile(tool)));
        }
        for tool in &made.model.solid_tools {
            let (facets, bounds) = (tool.facets().len(), tool.bounds());
            let ends = ["x", "y", "z"].iter().enumerate();
            let ends: Vec<_> = ends.map(|(i, x)| format!("{x} from {} to {}", bounds.min[i], bounds.max[i])).collect();
            self.line(format!("tool {}: {facets} facets, {}", tool.name(), ends.join(", ")));
        }
        for note in made.diagnostics.list.iter().filter(|d| d.severity == Severity::Note) {
            self.line(format!("  {}", note.what));
        }
    }

    /// What a contact finds in the undeformed state.
    fn contact(&mut self, name: &Name, keys: &keys::Contact, seen: &Seen) {
        let nearest = seen.found.iter().map(|(u, _)| -u).fold(f64::INFINITY, f64::min).max(0.0);
        let (surface, target) = match seen.name == name.text {
            true => (&keys.surface, &keys.target),
            false => (&keys.target, &keys.surface),
        };
        let target = if seen.deforms { target.to_string() } else { format!("the tool {target}") };
        self.line(format!("contact {}: {} points on {} of {surface}", seen.name, seen.points, seen.pieces));
        self.line(match seen.found.as_slice() {
            [] => format!("  none sees {target}"),
            _ => format!("  {} see {target}, the nearest {nearest:.3e} away", seen.found.len()),
        });
        if seen.deforms {
            let two = seen.options.loads == LoadedSides::Own;
            self.line(if two { "  two passes: they load their own side" } else { "  one pass" });
        }
        if seen.rejected.total() > 0 {
            let (behind, deep) = (seen.rejected.wrong_side, seen.rejected.too_deep);
            self.line(format!("  false contacts refused: {behind} on faces that look away, {deep} too deep"));
        }
        let (options, origin) = (seen.options, if keys.penalty.is_some() { "given" } else { "computed" });
        let (penalty, tangential) = (options.penalty, options.tangential_penalty);
        self.line(match options.elastic_slip {
            None => format!("  penalty {penalty:.4e} ({origin}), tangential {tangential:.4e}"),
            Some(part) => format!("  penalty {penalty:.4e} ({origin}), elastic slip {part} of an edge or face"),
        });
    }

    fn ties(&mut self, made: &Made) {
        for ([surface, target], tie) in &made.model.ties {
            let count = tie.conditions.iter().filter(|condition| condition.follows).count();
            let (gap, tolerance) = (tie.gap, tie.tolerance);
            self.line(format!(
                "tie: {count} nodes of {surface} follow {target}; largest gap {gap:.3e}, tolerance {tolerance:.3e}"
            ));
        }
    }

    fn rigid(&mut self, made: &Made) {
        for group in &made.model.rigid {
            let (count, [x, y, z]) = (group.nodes.len(), group.reference.0);
            self.line(format!("rigid {}: {count} nodes follow the point ({x}, {y}, {z})", group.name));
        }
    }

    fn steps(&mut self, made: &Made) {
        for step in &made.model.problem.steps {
            self.line(describe(step));
            if !step.idle.is_empty() {
                let names = step.idle.iter().map(|&term| made.model.problem.terms[term].name()).collect::<Vec<_>>();
                self.line(format!("  without {}", names.join(", ")));
            }
        }
    }

    /// What nothing holds when the first step begins.
    fn motions(&mut self, made: &Made) -> Result<Vec<Diagnostic>, Error> {
        let free = made.model.run(made.model.problem.initial_state()).free_motions()?;
        let place = made.deck.step.first().map(|step| step.place);
        let warn = |motion: String| {
            let (until, help) = if made.deck.contact.is_empty() {
                ("", "hold it: a support (`displacement`, `symmetry`), or springs")
            } else {
                (" until contact or friction holds it", "hold it, or let it touch what is to hold it from the start")
            };
            let warning = Diagnostic::warning(format!("{motion}{until}"));
            place.map_or(warning.clone(), |place| warning.at(place)).help(help)
        };
        Ok(free.into_iter().map(warn).collect())
    }

    /// Unknowns, work and memory, from the symbolic analysis alone.
    fn cost(&mut self, made: &Made, ranks: Option<NonZeroUsize>) -> Result<Option<Diagnostic>, Error> {
        let problem = &made.model.problem;
        let room = machine::room(problem.newton.memory);
        let demand = problem.demand(&problem.initial_state())?;
        let (unknowns, entries, cost) = (demand.unknowns, demand.entries as f64, demand.factorisation);
        let mut line = format!(
            "equations: {unknowns} unknowns, {entries:.3e} entries; a factorisation takes {:.3e} flops",
            cost.flops
        );
        if cost.flops > LASTING
            && let Ok(speed) = frontal::speed()
        {
            let [seconds, half] = [cost, demand.symmetric].map(|cost| OF_A_TREE * cost.factorisation_work() / speed);
            let threads = current_num_threads();
            let _ = write!(
                line,
                ", about {seconds:.2e} s on {threads} threads, {half:.2e} s where the matrix is symmetric"
            );
        }
        self.line(line);
        // A program with an engine from outside solves by that, on one rank where nothing is said.
        if let Some(count) = ranks.or_else(|| engine::provided().then_some(NonZeroUsize::MIN)) {
            self.ranks(count, demand.of_ranks(count));
            let bound = room.filter(|_| ranks.is_none() && problem.newton.memory.is_some());
            let short = bound.and_then(|room| demand.check_ranks(&room).err());
            return Ok(short.map(|error| Diagnostic::warning(error.to_string())));
        }
        let Some(room) = room else { return Ok(None) };
        let [need, half] = [demand.bytes, demand.symmetric_bytes].map(|bytes| (room.taken + bytes) as f64 / 1e9);
        self.line(format!(
            "memory: about {need:.3} GB, {half:.3} GB where the matrix is symmetric; {:.2} GB is {}",
            room.total as f64 / 1e9,
            room.source
        ));
        let help = "fewer cells, or cells of first degree; symmetry where there is one";
        let half =
            "where all matrices are symmetric, as without friction, it fits; the run ends at the first that is not";
        let tight = |error: Error| Diagnostic::warning(error.to_string()).help(half);
        let short = demand.check(&room).err().map(|error| Diagnostic::warning(error.to_string()).help(help));
        Ok(short.or_else(|| demand.check_unsymmetric(&room).err().map(tight)))
    }

    fn ranks(&mut self, ranks: NonZeroUsize, bytes: OfRanks) {
        let gigabytes = |[first, other]: [u64; 2]| match ranks.get() {
            1 => format!("about {:.3} GB", first as f64 / 1e9),
            _ => format!("about {:.3} GB on the first, {:.3} GB on each other", first as f64 / 1e9, other as f64 / 1e9),
        };
        self.line(format!("memory of a rank, {ranks} in all:"));
        self.line(format!("  where MUMPS factorises every matrix: {}", gigabytes(bytes.direct)));
        self.line(format!(
            "  where BoomerAMG preconditions FGMRES (`solver.petsc`), at most: {}",
            gigabytes(bytes.multigrid)
        ));
    }

    fn unsaid(&mut self, made: &Made) {
        self.line("not said in the deck, and what holds instead:");
        for unsaid in &made.unsaid {
            self.line(format!("  {} = {}", unsaid.path, unsaid.instead));
        }
    }
}

/// What a contact is, and what its search finds in the undeformed state.
pub(super) struct Seen<'a> {
    name: &'a str,
    options: &'a ContactOptions,
    deforms: bool,
    pub points: usize,
    /// On how many edges or faces they stand.
    pieces: String,
    /// Penetrations, and the same as parts of the edge or face.
    pub found: Vec<(f64, f64)>,
    rejected: Rejected,
    /// What faces a target well.
    advice: &'static str,
}

impl<'a> Seen<'a> {
    /// Every contact, and every second side, in the undeformed state.
    pub fn all(made: &'a Made) -> Vec<Self> {
        let still = vec![0.0; made.model.problem.dofs.count()];
        let points = made.model.contacts.iter().map(|contact| Self::points(contact, &still));
        points.chain(made.model.field_contacts.iter().map(|contact| Self::field(contact))).collect()
    }

    /// Those of one contact of the deck.
    pub fn of<'s>(all: &'s [Self], name: &Name) -> impl Iterator<Item = &'s Self> {
        let names = [name.text.clone(), second_name(&name.text)];
        all.iter().filter(move |seen| names.iter().any(|name| name == seen.name))
    }

    fn points(contact: &'a PaperContact, u: &[f64]) -> Self {
        let ((hits, rejected), surface) = (contact.search(u), contact.surface());
        let part = |(i, hit): (usize, &Option<Hit>)| hit.map(|hit| (hit.u, hit.u / contact.face_size(i)));
        Self {
            name: contact.title(),
            options: contact.options(),
            deforms: contact.target().deforms(),
            points: hits.len(),
            pieces: pieces(surface),
            found: hits.iter().enumerate().filter_map(part).collect(),
            rejected,
            advice: advice(surface),
        }
    }

    fn field(contact: &'a FieldContact) -> Self {
        let surface = contact.surface();
        Self {
            name: contact.name(),
            options: contact.options(),
            deforms: contact.target().as_faces().is_some(),
            points: surface.nodes.len(),
            pieces: pieces(surface),
            found: contact.initial_gaps(),
            rejected: Rejected::default(),
            advice: advice(surface),
        }
    }

    /// What is odd about the distances.
    fn oddity(&self, name: &Name) -> Option<Diagnostic> {
        let Some((u, part)) = self.found.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
            let what = format!("no point of contact `{name}` sees its target");
            let advice =
                if self.deforms { "do the two sides face each other, and do they come near?" } else { self.advice };
            return Some(Diagnostic::warning(what).at(name.place).help(advice));
        };
        let closed = self.found.iter().filter(|(u, _)| *u > 0.0).count();
        let what = format!("{closed} points of contact `{name}` lie inside the target before the first increment");
        let help = match self.deforms {
            true => {
                "for an interference fit that is as it should be; else move the bodies apart, or say overlap = \"adjust\""
            }
            false => {
                "move the tool or the body apart, or say overlap = \"adjust\"; else it is removed over the first step"
            }
        };
        let label = format!("the deepest by {u:.3e}, {part:.1e} of its edge");
        (*part > OVERLAP).then(|| Diagnostic::warning(what).at(name.place).label(label).help(help))
    }
}

/// On how many edges or faces points stand.
fn pieces(surface: &FieldSurface) -> String {
    format!("{} {}", surface.faces.len(), if surface.plane { "edges" } else { "faces" })
}

fn advice(surface: &FieldSurface) -> &'static str {
    if surface.plane { PROFILE_ADVICE } else { FACETS_ADVICE }
}

const PROFILE_ADVICE: &str =
    "is the surface the right one, and does the profile run with the tool's material on its left?";
const FACETS_ADVICE: &str = "is the surface the right one, and do the tool's facets look outward?";

fn profile(tool: &ProfileTool) -> String {
    let closed = tool.chains().iter().all(|chain| chain.closed);
    let bounds = tool.bounds();
    let ends = |axis: usize| format!("{} to {}", bounds.min[axis], bounds.max[axis]);
    let kind = if closed { "closed" } else { "open" };
    format!("{} segments, {kind}, x from {}, y from {}", tool.segments().len(), ends(0), ends(1))
}

fn describe(step: &Step) -> String {
    let sizes = &step.increments;
    format!(
        "step {}: time {}, increments from {} to {} of it, {} unknowns prescribed",
        step.name,
        step.duration,
        sizes.first,
        sizes.largest,
        step.prescribed.len()
    )
}
