//! Everything that can be said of a model before it is solved: its parts and their numbers, what each contact finds,
//! overlaps, penalties, what is free to move, defaults in use. What looks wrong is a warning at the deck's line.

use super::build::Made;
use super::diagnose::{Diagnostic, Severity};
use super::keys;
use super::reader::Name;
use crate::Error;
use crate::contact::space::Contact as Solid;
use crate::contact::{Contact, second_name};
use crate::solve::Step;
use crate::system::Term;
use crate::tool::Tool;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A penetration above this part of its edge is worth a warning before the first increment.
const OVERLAP: f64 = 1e-3;

/// What is said of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Review {
    /// A page for people.
    pub text: String,
    /// What looks wrong; the warnings of the reading among them.
    pub problems: Vec<Diagnostic>,
}

/// Looks a model over.
///
/// # Errors
/// An error of the solver that is not the model's fault.
pub fn review(made: &Made) -> Result<Review, Error> {
    let warnings = made.diagnostics.list.iter().filter(|d| d.severity <= Severity::Warning);
    let mut problems: Vec<Diagnostic> = warnings.cloned().collect();
    let mut page = Page::default();
    page.model(made);
    page.bodies(made);
    page.tools(made);
    for (name, keys) in &made.deck.contact {
        let second = second_name(&name.text);
        let passes =
            made.model.contacts.iter().filter(|contact| [&name.text, &second].contains(&&contact.name().into()));
        for contact in passes {
            problems.extend(page.contact((name, keys), contact, made));
        }
    }
    for ((name, keys), contact) in made.deck.contact.iter().zip(&made.model.solid_contacts) {
        problems.extend(page.solid_contact(name, keys, contact, made));
    }
    page.steps(made);
    problems.extend(page.motions(made)?);
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
            2 if model.space != crate::mesh::Space::Axisymmetric => format!(", thickness {}", model.thickness),
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

    /// What a contact finds in the undeformed state, and what is odd about it.
    fn contact(&mut self, deck: (&Name, &keys::Contact), contact: &Contact, made: &Made) -> Vec<Diagnostic> {
        let (name, keys) = deck;
        let (hits, rejected) = contact.search(&vec![0.0; made.model.problem.dofs.count()]);
        let found: Vec<f64> = hits.iter().flatten().map(|hit| hit.u).collect();
        let nearest = found.iter().map(|u| -u).fold(f64::INFINITY, f64::min).max(0.0);
        let edges = contact.surface().edges.len();
        let (surface, target) = match contact.name() == name.text {
            true => (&keys.surface, &keys.target),
            false => (&keys.target, &keys.surface),
        };
        let target = if contact.target().deforms() { target.to_string() } else { format!("the tool {target}") };
        self.line(format!("contact {}: {} points on {edges} edges of {surface}", contact.name(), hits.len()));
        self.line(match found.as_slice() {
            [] => format!("  none sees {target}"),
            _ => format!("  {} see {target}, the nearest {nearest:.3e} away", found.len()),
        });
        if contact.target().deforms() {
            let passes = if contact.loads_itself() { "two passes: they load their own side" } else { "one pass" };
            self.line(format!("  {passes}"));
        }
        if rejected.total() > 0 {
            let (behind, deep) = (rejected.wrong_side, rejected.too_deep);
            self.line(format!("  false contacts refused: {behind} on faces that look away, {deep} too deep"));
        }
        let options = contact.options();
        let origin = if keys.penalty.is_some() { "given" } else { "computed" };
        self.line(format!(
            "  penalty {:.4e} ({origin}), tangential {:.4e}",
            options.penalty, options.tangential_penalty
        ));
        self.overlaps(name, contact, &hits)
    }

    fn overlaps(&mut self, name: &Name, contact: &Contact, hits: &[Option<crate::contact::Hit>]) -> Vec<Diagnostic> {
        if hits.iter().all(Option::is_none) {
            let what = format!("no point of contact `{name}` sees its target");
            let help = "is the surface the right one, and does the profile run with the tool's material on its left?";
            return vec![Diagnostic::warning(what).at(name.place).help(help)];
        }
        let depth =
            |(i, hit): (usize, &Option<crate::contact::Hit>)| Some((hit.as_ref()?.u / contact.edge_length(i), i));
        let deepest = hits.iter().enumerate().filter_map(depth).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((part, i)) = deepest.filter(|(part, _)| *part > OVERLAP) else { return vec![] };
        let closed = hits.iter().flatten().filter(|hit| hit.u > 0.0).count();
        let u = hits[i].as_ref().map_or(0.0, |hit| hit.u);
        let what = format!("{closed} points of contact `{name}` lie inside the target before the first increment");
        let help = match contact.target().deforms() {
            true => "for an interference fit that is as it should be; else move the bodies apart",
            false => "move the tool or the body apart",
        };
        let label = format!("the deepest by {u:.3e}, {part:.1e} of its edge");
        vec![Diagnostic::warning(what).at(name.place).label(label).help(help)]
    }

    /// The same of a contact in space.
    fn solid_contact(&mut self, name: &Name, keys: &keys::Contact, contact: &Solid, made: &Made) -> Vec<Diagnostic> {
        let (hits, rejected) = contact.search(&vec![0.0; made.model.problem.dofs.count()]);
        let found: Vec<(f64, usize)> =
            hits.iter().enumerate().filter_map(|(i, hit)| Some((hit.as_ref()?.u, i))).collect();
        let (faces, target) = (contact.surface().faces.len(), &keys.target);
        self.line(format!("contact {name}: {} points on {faces} faces of {}", hits.len(), keys.surface));
        let nearest = found.iter().map(|(u, _)| -u).fold(f64::INFINITY, f64::min).max(0.0);
        self.line(match found.as_slice() {
            [] => format!("  none sees the tool {target}"),
            _ => format!("  {} see the tool {target}, the nearest {nearest:.3e} away", found.len()),
        });
        if rejected.total() > 0 {
            let (behind, deep) = (rejected.wrong_side, rejected.too_deep);
            self.line(format!("  false contacts refused: {behind} on faces that look away, {deep} too deep"));
        }
        let (options, origin) = (contact.options(), if keys.penalty.is_some() { "given" } else { "computed" });
        let (penalty, tangential) = (options.penalty, options.tangential_penalty);
        self.line(format!("  penalty {penalty:.4e} ({origin}), tangential {tangential:.4e}"));
        solid_overlaps(name, contact, &found)
    }

    fn steps(&mut self, made: &Made) {
        for step in &made.model.problem.steps {
            self.line(describe(step));
        }
    }

    /// What nothing holds when the first step begins.
    fn motions(&mut self, made: &Made) -> Result<Vec<Diagnostic>, Error> {
        let free = made.model.run(made.model.problem.initial_state()).free_motions()?;
        let place = made.deck.step.first().map(|step| step.place);
        let warn = |motion: String| {
            let warning = Diagnostic::warning(format!("{motion} until contact closes"));
            let help = "hold it, or let it touch what is to hold it from the start";
            place.map_or(warning.clone(), |place| warning.at(place)).help(help)
        };
        Ok(free.into_iter().map(warn).collect())
    }

    fn unsaid(&mut self, made: &Made) {
        self.line("not said in the deck, and what holds instead:");
        for unsaid in &made.unsaid {
            self.line(format!("  {} = {}", unsaid.path, unsaid.instead));
        }
    }
}

/// What is odd about the distances that the points of a contact in space begin with.
fn solid_overlaps(name: &Name, contact: &Solid, found: &[(f64, usize)]) -> Vec<Diagnostic> {
    if found.is_empty() {
        let what = format!("no point of contact `{name}` sees its target");
        let help = "is the surface the right one, and do the tool's facets look outward?";
        return vec![Diagnostic::warning(what).at(name.place).help(help)];
    }
    let part = |&(u, i): &(f64, usize)| (u / contact.face_length(i), u);
    let Some((part, u)) = found.iter().map(part).max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(part, _)| *part > OVERLAP)
    else {
        return vec![];
    };
    let closed = found.iter().filter(|(u, _)| *u > 0.0).count();
    let what = format!("{closed} points of contact `{name}` lie inside the tool before the first increment");
    let label = format!("the deepest by {u:.3e}, {part:.1e} of its face");
    vec![Diagnostic::warning(what).at(name.place).label(label).help("move the tool or the body apart")]
}

fn profile(tool: &Tool) -> String {
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
