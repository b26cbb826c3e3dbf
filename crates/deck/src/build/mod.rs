//! From a deck and its mesh to what is solved: names become indices, options meet the mesh, conditions of the steps
//! become constraints and timelines. What the parts of a model say against the deck is shown at the deck's lines; all of
//! it at once.

mod absent;
mod bodies;
mod contacts;
mod distributing;
mod field_contacts;
mod friction;
mod loads;
mod overlaps;
mod path;
mod results;
mod rigid;
mod solid_tools;
mod supports;
mod temperatures;
mod ties;
mod tools;

use contacts::Tools;
pub(super) use contacts::backings;
use supports::Held;

use super::diagnose::Diagnostic;
use super::keys::{self, Deck};
use super::source::Place;
use super::{Diagnostics, Loaded, Unsaid, prints};
use asperity_core::load::{Bearing, Site};
use asperity_core::mesh::Space;
use asperity_core::model::{Model, ModelParts};
use asperity_core::solve::{Increments, Step, engine};
use asperity_core::system::{Dofs, Term};
use asperity_core::tensor::Vec3;
use asperity_core::{Error, machine};
use asperity_results::output::checkpoint::InputHash;
use asperity_results::output::{Asked, Part, ResultOptions};
use std::path::Path;
use std::sync::Arc;

/// A deck and the model that it makes.
#[non_exhaustive]
pub struct Made {
    /// The deck.
    pub deck: Deck,
    /// The model.
    pub model: Model,
    /// What its run writes, and how often.
    pub results: ResultOptions,
    /// What was not said, and what holds instead.
    pub unsaid: Vec<Unsaid>,
    /// Fingerprint of the deck's text, what was set over it, and the mesh.
    pub input: InputHash,
    /// Those of its parts.
    pub parts: Vec<Part>,
    /// Warnings and notes, and the texts that later messages point into.
    pub diagnostics: Diagnostics,
}

/// Numbers of the deck as a vector; those that it does not say are zero.
fn vector(x: &[f64]) -> Vec3 {
    Vec3(std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0)))
}

/// What the builders of the parts share: the deck, where things are, and what was found.
struct Builder<'d> {
    deck: &'d Deck,
    site: Site,
    /// Where files are looked for, and the bytes of those that were read.
    folder: &'d Path,
    files: Vec<Vec<u8>>,
    /// Whether another program is to run the model.
    elsewhere: bool,
    bearing: Bearing,
    ties: Vec<ties::Glued>,
    found: Vec<Diagnostic>,
}

impl Builder<'_> {
    fn refuse(&mut self, what: impl Into<String>, place: Place) {
        self.found.push(Diagnostic::error(what).at(place));
    }

    /// The value, or its error reported at a place.
    fn keep<T>(&mut self, result: Result<T, Error>, place: Place) -> Option<T> {
        result.map_err(|error| self.refuse(error.to_string(), place)).ok()
    }

    /// Nodes of a group; empty for a name of nothing, which was reported when the deck was read.
    fn nodes(&self, group: &str) -> &[usize] {
        self.site.mesh.groups.get(group).map_or(&[], |group| &group.nodes)
    }

    /// Those of a group that the mesh had before its cells were raised, on which nodal forces and springs act; all of one without them.
    fn own_nodes(&self, group: &str) -> &[usize] {
        let nodes = self.nodes(group);
        let all = nodes.len();
        let own = self.site.mesh.before_raised.map_or(all, |count| nodes.partition_point(|&node| node < count));
        &nodes[..if own == 0 { all } else { own }]
    }

    /// A point of the deck, from the origin of the mesh.
    fn point(&self, x: &[f64]) -> Vec3 {
        vector(x) - self.site.mesh.origin
    }

    fn plane(&self) -> bool {
        self.site.space.dimension() == 2
    }
}

impl Made {
    /// What was asked, for `deck.json`: the texts that the diagnostics point into are the deck and what was set over it.
    pub fn asked(&self) -> Asked {
        let deck = self.diagnostics.sources.first();
        let sets = self.diagnostics.sources.iter().filter(|source| source.name == "--set");
        Asked {
            path: deck.map_or_else(String::new, |source| source.name.clone()),
            text: deck.map_or_else(String::new, |source| source.text.clone()),
            sets: sets.map(|source| source.text.clone()).collect(),
            defaults: self.unsaid.iter().map(|unsaid| (unsaid.path.clone(), unsaid.instead.clone())).collect(),
        }
    }
}

/// Makes what a deck says; messages are added to those of the reading.
///
/// # Errors
/// [`Diagnostics`] with everything that the mesh, the tools and the laws say against the deck.
pub fn build(loaded: Loaded) -> Result<Made, Diagnostics> {
    let texts = texts(&loaded);
    let Loaded { deck, mut mesh, folder, elsewhere, unsaid, mut parts, mut diagnostics } = loaded;
    let space = *deck.space;
    mesh.recentre(space);
    let dofs = Dofs::new(space.dimension(), mesh.points.len(), deck.tool.len() + deck.rigid.len());
    let thickness = deck.thickness.map_or(1.0, |thickness| thickness.value);
    let site = Site { mesh: Arc::new(mesh), dofs, space, thickness };
    let mut builder = Builder {
        deck: &deck,
        site,
        folder: &folder,
        elsewhere,
        files: Vec::new(),
        bearing: Bearing::default(),
        ties: Vec::new(),
        found: Vec::new(),
    };
    let built = builder.settled();
    let input = InputHash::of(&texts.iter().chain(&builder.files).map(Vec::as_slice).collect::<Vec<_>>());
    let files: Vec<_> = builder.files.iter().map(Vec::as_slice).collect();
    parts.push(Part { key: "files".into(), print: InputHash::of(&files) });
    diagnostics.list.append(&mut builder.found);
    diagnostics.sort();
    match built {
        Some(built) if !diagnostics.has_errors() => {
            let model = Model::new(built);
            let (results, mut found) = results::results(&deck, &model);
            diagnostics.list.append(&mut found);
            diagnostics.sort();
            if diagnostics.has_errors() {
                return Err(diagnostics.without_notes());
            }
            Ok(Made { deck, model, results, unsaid, input, parts, diagnostics })
        }
        _ => Err(diagnostics.without_notes()),
    }
}

/// The deck's text, what was set over it, and the mesh it led to.
fn texts(loaded: &Loaded) -> Vec<Vec<u8>> {
    let texts = loaded.diagnostics.sources.iter().map(|source| source.text.as_bytes().to_vec());
    let groups = format!("{:?}", loaded.mesh.groups).into_bytes();
    texts.chain(prints::mesh(&loaded.mesh)).chain([groups]).collect()
}

/// Bytes that a model takes for each unknown, at least.
const LEAST: u64 = 500;
/// Rounds of moving nodes out of targets: a node of two contacts may need more than one.
const ROUNDS: usize = 5;

impl Builder<'_> {
    /// Everything, with the nodes moved that are to be.
    fn settled(&mut self) -> Option<ModelParts> {
        self.glue();
        let glued = std::mem::take(&mut self.found);
        let built = self.adjusted();
        self.found.extend(glued);
        built
    }

    /// Everything, with the nodes moved out of targets that are to be.
    fn adjusted(&mut self) -> Option<ModelParts> {
        let mut built = self.everything()?;
        for _ in 0..ROUNDS {
            if !self.adjust(&built) {
                break;
            }
            self.found.clear();
            self.files.clear();
            built = self.everything()?;
        }
        self.refuse_overlaps(&built);
        Some(built)
    }

    fn everything(&mut self) -> Option<ModelParts> {
        self.check_mesh();
        self.check_engine();
        if !self.fits_memory() {
            return None;
        }
        let bodies = self.bodies();
        let plane = self.plane();
        let tools = if plane { self.tools() } else { Some(Vec::new()) };
        let solid_tools = if plane { Some(Vec::new()) } else { self.solid_tools() };
        let all = tools.as_deref().zip(solid_tools.as_deref()).map(|(plane, solid)| Tools { plane, solid });
        let contacts = all.and_then(|tools| self.paper_contacts(tools, bodies.as_deref()?));
        let field_contacts = self.field_contacts(all, bodies.as_deref());
        let (springs, loads, fluids, rigid) = (self.springs(), self.loads(), self.fluids(), self.rigid());
        let (constrained, supports) = self.supports();
        let mut names: Vec<String> = self.deck.body.iter().map(|(name, _)| name.text.clone()).collect();
        names.extend(contacts.iter().flatten().map(|contact| contact.name().to_owned()));
        names.extend(field_contacts.iter().flatten().map(|contact| contact.name().to_owned()));
        let contacts_end = names.len();
        names.extend(springs.iter().flatten().chain(loads.iter().flatten()).map(|term| term.name().to_owned()));
        names.extend(fluids.iter().flatten().map(|fluid| fluid.name().to_owned()));
        let absent = self.absent(&names, contacts_end);
        let deck = self.deck;
        let arc_lengths: Vec<_> = deck.step.iter().map(|step| self.path(step)).collect();
        let steps = deck.step.iter().enumerate().zip(constrained);
        let leaving = |i: usize| {
            let next = absent.get(i + 1).into_iter().flatten().copied();
            next.filter(|term| !absent[i].contains(term)).collect()
        };
        let mut parts = ModelParts::new(self.site.space, self.site.mesh.clone(), self.site.dofs.clone());
        parts.title = self.deck.title.clone();
        parts.thickness = self.site.thickness;
        parts.bodies = bodies?;
        parts.materials = self.deck.material.iter().map(|(name, _)| name.text.clone()).collect();
        (parts.tools, parts.solid_tools) = (tools?, solid_tools?);
        (parts.contacts, parts.field_contacts) = (contacts?, field_contacts?);
        (parts.springs, parts.loads, parts.fluids) = (springs?, loads?, fluids?);
        parts.bearing = std::mem::take(&mut self.bearing);
        let step = |((i, keys), (constraints, prescribed)): ((usize, &keys::StepKeys), Held)| {
            let name = keys.name.as_ref().map_or_else(|| format!("step {}", i + 1), |name| name.value.clone());
            let mut step = Step::new(&name, constraints, prescribed);
            (step.duration, step.increments) = (keys.duration, increments(&keys.increments));
            step.arc_length = arc_lengths[i].clone();
            step.amplitudes = keys.amplitudes();
            (step.idle, step.leaving) = (absent[i].clone(), leaving(i));
            step
        };
        parts.steps = steps.map(step).collect();
        parts.supports = supports;
        parts.watched = self.watched();
        parts.ties = self.ties.iter().map(|glued| (glued.names.clone(), glued.tie.clone())).collect();
        parts.rigid = rigid;
        parts.newton = self.deck.solver.newton_options();
        Some(parts)
    }

    /// Who asks for PETSc must have it, and cannot ask for what only the library's own solver does.
    fn check_engine(&mut self) {
        let solver = &self.deck.solver;
        let Some(petsc) = &solver.petsc else { return };
        if solver.memory.is_some() {
            let what = "`memory` is that of the library's own solver, and has no use beside `petsc`";
            self.found.push(Diagnostic::error(what).at(petsc.place).help("leave `petsc` or `memory` out"));
        }
        if !engine::provided() && !self.elsewhere {
            let what = "`petsc` wants a program with the crate `cluster`, and this one was built without";
            let help = "build it by `cargo install --path crates/asperity-cli --features cluster`, which needs PETSc and MPI (see the \
                        manual's page on a cluster), or leave `petsc` out";
            self.found.push(Diagnostic::error(what).at(petsc.place).help(help));
        }
    }

    /// The model alone must fit into memory.
    fn fits_memory(&mut self) -> bool {
        let unknowns = self.site.dofs.count() as u64;
        let short = machine::room(None).filter(|room| LEAST * unknowns > room.left());
        if let Some(room) = short {
            let (need, total) = ((LEAST * unknowns + room.taken) as f64 / 1e9, room.total as f64 / 1e9);
            let what = format!(
                "a model of {unknowns} unknowns needs {need:.2} GB before anything is solved, and {total:.2} GB is {}",
                room.source
            );
            self.found.push(Diagnostic::error(what).help("fewer cells"));
        }
        short.is_none()
    }

    /// The mesh must fill the space, and lie on the right side of an axis.
    fn check_mesh(&mut self) {
        let (mesh, space) = (self.site.mesh.clone(), self.deck.space);
        if space.value == Space::Axisymmetric && mesh.bounds().min[0] < -1e-9 * mesh.size() {
            let what = format!("the mesh reaches the negative radius {}", mesh.bounds().min[0]);
            self.found.push(
                Diagnostic::error(what)
                    .at(space.place)
                    .help("x is the radius, y the axis: draw the part where x is positive"),
            );
        }
    }
}

fn increments(keys: &keys::IncrementKeys) -> Increments {
    let (first, largest) = keys.sizes();
    Increments { first, largest, smallest: keys.smallest.value, most: keys.most }
}
