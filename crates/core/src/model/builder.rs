//! A model in code: names and values; numbers of unknowns, defaults and checks follow.

use super::behind::{ELASTIC_SLIP, FieldSides, backings, boundary_behind, tool_target};
use super::model::{Model, ModelParts};
use crate::Error;
use crate::amplitude::Amplitude;
use crate::contact::field::{FieldContact, FieldRoles, FieldSurface};
use crate::contact::{Augmentation, Backing, ContactOptions, ContactParts, LoadedSides, Overlap, default_penalty};
use crate::declare::nearest;
use crate::interface::Rule;
use crate::load::Site;
use crate::material::Material;
use crate::mesh::{Group, Mesh, Side, Space};
use crate::solid::{Body, BodyOptions};
use crate::solve::{Course, Increments, NewtonOptions, Prescribed, Step};
use crate::system::{Constraints, Dofs, Term};
use crate::tool::space::SpaceTool;
use crate::tool::{FindingSeverity, ProfileTool};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Makes a load where the numbering of the unknowns is known.
type MakeLoad = dyn FnOnce(&Site) -> Result<Box<dyn Term>, Error>;

/// Puts a [`Model`] together in code ([`Model::builder`]); groups of the mesh and tools are called by their names. What a deck can
/// say and this cannot (ties, equations, fluids, rigid groups, the paper's contact) the deck says.
pub struct ModelBuilder {
    title: String,
    space: Space,
    thickness: f64,
    mesh: Arc<Mesh>,
    newton: NewtonOptions,
    bodies: Vec<(String, Arc<dyn Material>, BodyOptions)>,
    tools: Vec<Arc<ProfileTool>>,
    solid_tools: Vec<Arc<SpaceTool>>,
    contacts: Vec<ContactBuilder>,
    loads: Vec<Box<MakeLoad>>,
    steps: Vec<StepBuilder>,
}

/// A contact of a [`ModelBuilder`]: a surface, what it may touch, a law, and how it is computed where that is said.
pub struct ContactBuilder {
    name: String,
    surface: String,
    target: String,
    law: Rule,
    penalty: Option<f64>,
    elastic_slip: f64,
    augmentation: Option<Augmentation>,
    overlap: Overlap,
}

impl ContactBuilder {
    /// Contact of the sides of the group `surface` with the tool or the sides of the group `target`, by a law of
    /// [`interface::laws`](crate::interface::laws) or one of your own.
    pub fn new(name: &str, surface: &str, target: &str, law: impl Into<Rule>) -> Self {
        let (name, surface, target) = (name.into(), surface.into(), target.into());
        let (penalty, augmentation) = (None, None);
        Self {
            name,
            surface,
            target,
            law: law.into(),
            penalty,
            elastic_slip: ELASTIC_SLIP,
            augmentation,
            overlap: Overlap::Keep,
        }
    }
    /// Normal penalty, a stress per length, in place of the one that follows from the cells behind the surfaces.
    pub fn penalty(self, penalty: f64) -> Self {
        Self { penalty: Some(penalty), ..self }
    }
    /// Elastic slip under the limit of friction, as a part of the size of a face: 0.005 where nothing is said.
    pub fn elastic_slip(self, part: f64) -> Self {
        Self { elastic_slip: part, ..self }
    }
    /// Penetration is taken out by multipliers (method of augmented Lagrangians).
    pub fn augmented(self, augmentation: Augmentation) -> Self {
        Self { augmentation: Some(augmentation), ..self }
    }
    /// What becomes of an overlap before the first increment.
    pub fn overlap(self, overlap: Overlap) -> Self {
        Self { overlap, ..self }
    }
}

/// A step of a [`ModelBuilder`]. What an earlier step moved stays where that came to.
#[derive(Debug, Clone)]
pub struct StepBuilder {
    name: String,
    duration: f64,
    increments: Increments,
    motions: Vec<(String, Vec<Option<f64>>)>,
}

impl StepBuilder {
    /// A step of unit duration in ten increments.
    pub fn new(name: &str) -> Self {
        Self { name: name.into(), duration: 1.0, increments: Increments::default(), motions: Vec::new() }
    }
    /// Its length in time.
    pub fn duration(self, duration: f64) -> Self {
        Self { duration, ..self }
    }
    /// Sizes of its increments.
    pub fn increments(self, increments: Increments) -> Self {
        Self { increments, ..self }
    }
    /// It is cut into so many equal increments at first, which may be cut further.
    pub fn count(self, count: usize) -> Self {
        let part = 1.0 / count.max(1) as f64;
        self.increments(Increments { first: part, largest: part, ..Increments::default() })
    }
    /// The nodes of a group, or a tool, go to these displacements along a straight line; `None` says nothing of an axis. A tool of the
    /// plane has an angle behind its two translations, one of space a rotation vector behind its three; what nothing is ever said
    /// of stays at rest.
    pub fn displace(mut self, what: &str, to: impl Into<Vec<Option<f64>>>) -> Self {
        self.motions.push((what.into(), to.into()));
        self
    }
    /// The nodes of a group are held along all axes.
    pub fn hold(self, what: &str) -> Self {
        self.displace(what, [Some(0.0); 3])
    }
}

impl ModelBuilder {
    pub(super) fn new(space: Space, mesh: Arc<Mesh>) -> Self {
        Self {
            title: String::new(),
            space,
            thickness: 1.0,
            mesh,
            newton: NewtonOptions::default(),
            bodies: Vec::new(),
            tools: Vec::new(),
            solid_tools: Vec::new(),
            contacts: Vec::new(),
            loads: Vec::new(),
            steps: Vec::new(),
        }
    }
    /// Words for it.
    pub fn title(self, title: &str) -> Self {
        Self { title: title.into(), ..self }
    }
    /// Nominal thickness in the plane spaces, a length; one where nothing is said.
    pub fn thickness(self, thickness: f64) -> Self {
        Self { thickness, ..self }
    }
    /// Options of the iterations.
    pub fn newton(self, newton: NewtonOptions) -> Self {
        Self { newton, ..self }
    }
    /// The cells of a group become a body.
    pub fn body(mut self, group: &str, material: Arc<dyn Material>, options: BodyOptions) -> Self {
        self.bodies.push((group.into(), material, options));
        self
    }
    /// A rigid tool of a plane or axisymmetric model.
    pub fn tool(mut self, tool: ProfileTool) -> Self {
        self.tools.push(Arc::new(tool));
        self
    }
    /// A rigid tool of a model in space.
    pub fn solid_tool(mut self, tool: SpaceTool) -> Self {
        self.solid_tools.push(Arc::new(tool));
        self
    }
    /// A contact.
    pub fn contact(mut self, contact: ContactBuilder) -> Self {
        self.contacts.push(contact);
        self
    }
    /// A load or any other term: those of [`load`](crate::load), or one of your own.
    pub fn load(mut self, make: impl FnOnce(&Site) -> Result<Box<dyn Term>, Error> + 'static) -> Self {
        self.loads.push(Box::new(make));
        self
    }
    /// A step, after those before.
    pub fn step(mut self, step: StepBuilder) -> Self {
        self.steps.push(step);
        self
    }

    /// The model.
    ///
    /// # Errors
    /// [`Error::Input`] with a line for each name that nothing has (and the nearest that there is), motion that contradicts another,
    /// options that do not go together, and tool that cannot be used.
    pub fn build(self) -> Result<Model, Error> {
        let mut found = Vec::new();
        let (space, plane) = (self.space, self.space.dimension() == 2);
        if self.mesh.dimension() != space.dimension() {
            return Err(Error::input(format!(
                "a mesh of dimension {} does not fill space = \"{}\"",
                self.mesh.dimension(),
                space.name()
            )));
        }
        if (plane && !self.solid_tools.is_empty()) || (!plane && !self.tools.is_empty()) {
            found.push("tools of the plane are for plane and axisymmetric models, those of space for space".to_owned());
        }
        if self.bodies.is_empty() || self.steps.is_empty() {
            found.push("a model needs a body and a step".to_owned());
        }
        for tool in &self.tools {
            let errors = tool.check(space == Space::Axisymmetric).into_iter();
            let errors = errors.filter(|finding| finding.severity() == FindingSeverity::Error);
            found.extend(errors.map(|finding| format!("tool '{}': {finding}", tool.name())));
        }
        let tools = if plane { self.tools.len() } else { self.solid_tools.len() };
        let dofs = Dofs::new(space.dimension(), self.mesh.points.len(), tools);
        let site = Site { mesh: self.mesh.clone(), dofs: dofs.clone(), space, thickness: self.thickness };
        let names = Names { site: &site, tools: &self.tools, solid_tools: &self.solid_tools };
        let (mut bodies, mut materials) = (Vec::new(), Vec::new());
        for (number, (name, material, options)) in self.bodies.iter().enumerate() {
            let Some(group) = names.group(name, &mut found) else { continue };
            if group.cells.is_empty() {
                found.push(format!("the group '{name}' has no cells to make a body of"));
            }
            let parts = (site.mesh.clone(), dofs.clone(), space);
            match Body::new(name, parts, group.cells.clone(), material.clone(), *options) {
                Ok(body) => bodies.push((body, number)),
                Err(error) => found.push(error.to_string()),
            }
            materials.push(name.clone());
        }
        let steps = names.steps(&self.steps, &mut found);
        let holds = self.steps.first().into_iter().flat_map(|step| &step.motions);
        let holds =
            holds.map(|(what, to)| (what.clone(), [0, 1, 2].map(|axis| to.get(axis).is_some_and(Option::is_some))));
        let backings = backings(&site.mesh, holds, bodies.iter().map(|(body, _)| body));
        let cells: Vec<usize> = bodies.iter().flat_map(|(body, _)| body.cells()).copied().collect();
        let contact = |contact: ContactBuilder| names.contact(contact, (&backings, &cells), &mut found);
        let field_contacts: Vec<_> = self.contacts.into_iter().filter_map(contact).collect();
        let mut loads = Vec::new();
        for make in self.loads {
            match make(&site) {
                Ok(load) => loads.push(load),
                Err(error) => found.push(error.to_string()),
            }
        }
        let moved = self.steps.iter().flat_map(|step| &step.motions).map(|(what, _)| what);
        let mut supports: Vec<(String, Vec<usize>)> = Vec::new();
        for name in moved.filter(|name| names.tool(name).is_none()) {
            if let Some(group) =
                site.mesh.groups.get(name.as_str()).filter(|_| supports.iter().all(|(known, _)| known != name))
            {
                supports.push((name.clone(), group.nodes.clone()));
            }
        }
        if !found.is_empty() {
            return Err(Error::input(found.join("\n")));
        }
        let mut parts = ModelParts::new(space, site.mesh.clone(), dofs.clone());
        (parts.title, parts.thickness, parts.newton) = (self.title, self.thickness, self.newton);
        (parts.bodies, parts.materials, parts.field_contacts) = (bodies, materials, field_contacts);
        (parts.loads, parts.steps, parts.supports) = (loads, steps, supports);
        (parts.tools, parts.solid_tools) = (self.tools, self.solid_tools);
        Ok(Model::new(parts))
    }
}

/// What names stand for.
struct Names<'a> {
    site: &'a Site,
    tools: &'a [Arc<ProfileTool>],
    solid_tools: &'a [Arc<SpaceTool>],
}

impl Names<'_> {
    fn tool_names(&self) -> impl Iterator<Item = &str> {
        self.tools.iter().map(|tool| tool.name()).chain(self.solid_tools.iter().map(|tool| tool.name()))
    }

    fn tool(&self, name: &str) -> Option<usize> {
        self.tool_names().position(|tool| tool == name)
    }

    fn group(&self, name: &str, found: &mut Vec<String>) -> Option<&Group> {
        let group = self.site.mesh.groups.get(name);
        if group.is_none() {
            let known = self.site.mesh.groups.keys().map(String::as_str).chain(self.tool_names());
            let near = nearest(name, known).map_or_else(String::new, |near| format!("; did you mean '{near}'?"));
            found.push(format!("nothing is called '{name}'{near}"));
        }
        group
    }

    /// Unknowns of what is moved, a list for each entry of the motion.
    fn unknowns(&self, (what, to): &(String, Vec<Option<f64>>), found: &mut Vec<String>) -> Vec<(usize, f64)> {
        let dofs = &self.site.dofs;
        let (firsts, most) = match self.tool(what) {
            Some(tool) => (vec![dofs.tool(tool)], dofs.per_tool()),
            None => {
                let nodes = self.group(what, found).map_or(&[][..], |group| &group.nodes);
                (nodes.iter().map(|&node| dofs.node(node)).collect(), dofs.per_node())
            }
        };
        if to.iter().skip(most).any(|to| to.is_some_and(|to| to != 0.0)) {
            found.push(format!("'{what}' has {most} motions, and one behind them is given"));
        }
        if to.iter().flatten().any(|to| !to.is_finite()) {
            found.push(format!("a displacement of '{what}' is not finite"));
        }
        let given: Vec<_> = to.iter().take(most).enumerate().filter_map(|(axis, to)| Some((axis, (*to)?))).collect();
        firsts.iter().flat_map(|first| given.iter().map(move |(axis, to)| (first + axis, *to))).collect()
    }

    fn steps(&self, steps: &[StepBuilder], found: &mut Vec<String>) -> Vec<Step> {
        let dofs = &self.site.dofs;
        // Tools rest where nothing is said of them.
        let tools = dofs.tool(0)..dofs.count();
        let mut standing: BTreeSet<usize> = tools.collect();
        let mut made = Vec::new();
        for step in steps {
            let mut courses: BTreeMap<usize, Course> = standing.iter().map(|&dof| (dof, Course::Hold)).collect();
            let mut said = BTreeMap::<usize, f64>::new();
            for motion in &step.motions {
                let unknowns = self.unknowns(motion, found);
                if unknowns.iter().any(|(dof, to)| said.get(dof).is_some_and(|other| other != to)) {
                    let (name, what) = (&step.name, &motion.0);
                    found.push(format!("step '{name}': displacements of '{what}' and before it contradict each other"));
                }
                said.extend(unknowns.iter().copied());
                standing.extend(unknowns.iter().map(|(dof, _)| dof));
                courses.extend(unknowns.into_iter().map(|(dof, to)| (dof, Course::To(to, Amplitude::ramp()))));
            }
            if !(step.duration > 0.0 && step.duration.is_finite()) {
                found.push(format!("step '{}': its duration is not positive", step.name));
            }
            let fixed: Vec<usize> = courses.keys().copied().collect();
            let prescribed = courses.into_iter().map(|(dof, course)| Prescribed { dof, others: Vec::new(), course });
            let mut built = Step::new(&step.name, Constraints::new(dofs.count(), &fixed, &[]), prescribed.collect());
            (built.duration, built.increments) = (step.duration, step.increments);
            made.push(built);
        }
        made
    }

    fn contact(
        &self,
        contact: ContactBuilder,
        (backings, cells): (&[Backing], &[usize]),
        found: &mut Vec<String>,
    ) -> Option<FieldContact> {
        let Site { mesh, dofs, space, thickness } = self.site;
        let sides = |name: &str, found: &mut Vec<String>| {
            let sides = self.group(name, found).map(|group| group.sides.as_slice());
            if sides.is_some_and(<[Side]>::is_empty) {
                found.push(format!("contact '{}': the group '{name}' has no sides", contact.name));
            }
            sides.filter(|sides| !sides.is_empty())
        };
        let surface = sides(&contact.surface, found);
        let tool = self.tool(&contact.target);
        let others = if tool.is_none() { sides(&contact.target, found) } else { None };
        let surface = surface.filter(|_| tool.is_some() || others.is_some())?;
        let FieldSides { carrier, target, itself, swapped } = match others {
            Some(others) => FieldSides::new([surface, others], true, (mesh, *space, *thickness), backings),
            None => FieldSides {
                carrier: surface,
                target: tool_target((self.tools, self.solid_tools), tool?, dofs)?,
                itself: false,
                swapped: false,
            },
        };
        let surfaces: Vec<&[Side]> = std::iter::once(surface).chain(others).collect();
        let computed = default_penalty((mesh, *space), &surfaces, |cell| backings[cell]);
        let penalty = contact.penalty.unwrap_or(computed.value);
        if !(penalty > 0.0 && penalty.is_finite() && contact.elastic_slip > 0.0) {
            found.push(format!("contact '{}': penalty and elastic slip must be positive", contact.name));
        }
        let slides = contact.law.first().sliding_stress(1.0).is_some();
        let options = ContactOptions {
            penalty,
            modulus: computed.modulus,
            raised: contact.penalty.is_none().then_some(computed.raised),
            tangential_penalty: penalty,
            elastic_slip: (slides && contact.augmentation.is_none()).then_some(contact.elastic_slip),
            thickness: *thickness,
            loads: LoadedSides::Both,
            coupling: true,
            augmentation: contact.augmentation,
            overlap: contact.overlap,
            wear: None,
        };
        let parts = ContactParts {
            name: contact.name,
            mesh: mesh.clone(),
            dofs: dofs.clone(),
            space: *space,
            surface: FieldSurface::new(mesh, carrier, *space, *thickness),
            boundary: boundary_behind(mesh, carrier, cells.iter().copied()),
            target,
            law: contact.law,
            options,
        };
        Some(FieldContact::new(parts, FieldRoles { itself, swapped }))
    }
}
