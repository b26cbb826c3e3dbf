//! What is reported of an accepted state: each file computes a few quantities from the parts of a model and its state
//! and puts them into the frame. To add one: its file here and its line in [`ALL`].

mod contact;
mod energy;
mod equilibrium;
mod fluids;
mod hourglass;
mod interpenetration;
mod nodes;
mod oscillation;
mod reactions;
mod small_strain;
mod strain;
mod stress;
mod surface;
#[cfg(test)]
mod tests;
mod tools;
mod touching;

pub use touching::Touching;

use super::Frame;
use asperity_core::Error;
use asperity_core::load::PenetratingPressure;
use asperity_core::mesh::{Mesh, Space};
use asperity_core::model::Model;
use asperity_core::solid::Body;
use asperity_core::system::{Constraints, Dofs, History, State};
use asperity_core::tool::{self, Pose, ProfileTool};

/// The parts of a model that outputs read. Numbers of terms are places in the list of terms and in the state.
pub struct Parts<'a> {
    /// The space.
    pub space: Space,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// The numbering of the unknowns.
    pub dofs: &'a Dofs,
    /// The bodies with their numbers of terms.
    pub bodies: Vec<(usize, &'a Body)>,
    /// For each body the number of its material.
    pub materials: Vec<usize>,
    /// Names of the materials.
    pub material_names: Vec<String>,
    /// The contacts with their numbers of terms and names.
    pub contacts: Vec<(usize, String, Touching<'a>)>,
    /// Fluids that enter openings, with their numbers of terms.
    pub fluids: Vec<(usize, &'a PenetratingPressure)>,
    /// Terms that store energy and are neither bodies nor contacts.
    pub springs: Vec<usize>,
    /// The rigid tools of a plane model.
    pub tools: Vec<&'a ProfileTool>,
    /// The rigid tools of a model in space.
    pub solid_tools: Vec<&'a tool::space::SpaceTool>,
    /// Names of the rigid groups, whose unknowns follow those of the tools.
    pub rigid: Vec<&'a str>,
    /// Names and nodes of the groups that anything holds or moves in any step.
    pub supports: Vec<(String, Vec<usize>)>,
    /// The same of other groups, whose motion is reported.
    pub watched: Vec<(String, Vec<usize>)>,
    /// For each step what it does with each unknown.
    pub constraints: Vec<&'a Constraints>,
    /// For each step the terms that it does without.
    pub idle: Vec<&'a [usize]>,
    /// Whether any step follows a path, so that the load factor is worth a column.
    pub follows: bool,
}

/// An accepted state of a model.
pub struct Source<'a> {
    /// The model.
    pub parts: &'a Parts<'a>,
    /// Its state.
    pub state: &'a State,
    /// The step that led to it, from zero.
    pub step: usize,
}

/// Computes some quantities and puts them into a frame.
type Report = fn(&Source, &mut Frame) -> Result<(), Error>;

/// Everything that is reported, in the order of the columns and arrays.
static ALL: &[Report] = &[
    nodes::report,
    stress::report,
    strain::report,
    oscillation::report,
    reactions::report,
    contact::report,
    tools::report,
    fluids::report,
    energy::report,
    equilibrium::report,
    interpenetration::report,
    hourglass::report,
    small_strain::report,
];

impl Source<'_> {
    /// Everything that is reported of the state.
    ///
    /// # Errors
    /// [`Error::Internal`] when the parts and the state do not belong together.
    pub fn gather(&self) -> Result<Frame, Error> {
        let mut frame = Frame::new(self.step + 1, self.state.increment, self.state.time);
        ALL.iter().try_for_each(|report| report(self, &mut frame))?;
        frame.shift(self.parts.mesh.origin);
        Ok(frame)
    }
    /// Displacement of a node.
    pub(in crate::output) fn displacement(&self, node: usize) -> [f64; 3] {
        self.nodal(&self.state.u, node)
    }
    /// Components at all nodes of values on all unknowns, one after the other.
    pub fn nodal_field(&self, values: &[f64]) -> Vec<f64> {
        (0..self.parts.dofs.nodes()).flat_map(|node| self.nodal(values, node)).collect()
    }
    /// Components at a node of values on all unknowns; the third is zero in the plane.
    fn nodal(&self, values: &[f64], node: usize) -> [f64; 3] {
        let (first, count) = (self.parts.dofs.node(node), self.parts.dofs.per_node());
        std::array::from_fn(|a| if a < count { values[first + a] } else { 0.0 })
    }
    /// The force that holds an unknown: what resists less what acts.
    fn reaction(&self, dof: usize) -> f64 {
        self.state.internal[dof] - self.state.load[dof]
    }
    /// The forces that hold all unknowns; what follows others by equations or ties is borne by those.
    fn borne(&self) -> Vec<f64> {
        let mut reactions: Vec<f64> = (0..self.state.u.len()).map(|dof| self.reaction(dof)).collect();
        if let Some(constraints) = self.parts.constraints.get(self.step) {
            constraints.carry(&mut reactions);
        }
        reactions
    }
    /// Whether a body, by its term, counts in the mean at a node: where a body is that the step has, those that it does without have
    /// forgotten their stress.
    fn counting(&self) -> impl Fn(usize, usize) -> bool {
        let (mesh, idle) = (self.parts.mesh, self.parts.idle.get(self.step).copied().unwrap_or_default());
        let mut borne = vec![false; mesh.points.len()];
        for (_, body) in self.parts.bodies.iter().filter(|(term, _)| !idle.is_empty() && !idle.contains(term)) {
            body.cells().iter().flat_map(|&cell| mesh.cell(cell).nodes).for_each(|&node| borne[node] = true);
        }
        move |term, node| !idle.contains(&term) || !borne[node]
    }
    /// A term's lane of the history.
    ///
    /// # Errors
    /// [`Error::Internal`] when the state has no such term.
    fn history(&self, term: usize) -> Result<&History, Error> {
        self.state.histories.get(term).ok_or_else(|| Error::Internal(format!("the state has no term {term}")))
    }
    /// Where a tool stands.
    pub fn pose(&self, tool: usize) -> Pose {
        let first = self.parts.dofs.tool(tool);
        Pose::new(&self.state.u[first..first + self.parts.dofs.per_tool()])
    }
    /// Whether forces and moments out of the plane have no meaning.
    pub fn is_plane(&self) -> bool {
        self.parts.space != Space::Solid
    }
}

impl<'a> Parts<'a> {
    /// The parts of a model.
    pub fn of(model: &'a Model) -> Self {
        let points = model.contacts.iter().map(|contact| Touching::Points(contact));
        let fields = model.field_contacts.iter().map(|contact| Touching::Field(contact));
        let contact =
            |(i, contact): (usize, Touching<'a>)| (model.first_contact() + i, contact.name().to_string(), contact);
        Self {
            space: model.space,
            mesh: &model.mesh,
            dofs: &model.problem.dofs,
            bodies: model.bodies.iter().enumerate().map(|(i, (body, _))| (i, body.as_ref())).collect(),
            materials: model.bodies.iter().map(|(_, material)| *material).collect(),
            material_names: model.materials.clone(),
            contacts: points.chain(fields).enumerate().map(contact).collect(),
            fluids: model
                .fluids
                .iter()
                .enumerate()
                .map(|(i, fluid)| (model.first_fluid() + i, fluid.as_ref()))
                .collect(),
            springs: (model.first_spring()..).take(model.springs).collect(),
            tools: model.tools.iter().map(AsRef::as_ref).collect(),
            solid_tools: model.solid_tools.iter().map(AsRef::as_ref).collect(),
            rigid: model.rigid.iter().map(|group| group.name.as_str()).collect(),
            supports: model.supports.clone(),
            watched: model.watched.clone(),
            constraints: model.problem.steps.iter().map(|step| &step.constraints).collect(),
            idle: model.problem.steps.iter().map(|step| step.idle.as_slice()).collect(),
            follows: model.problem.steps.iter().any(|step| step.arc_length.is_some()),
        }
    }
}

impl Parts<'_> {
    /// Names of the tools and of the rigid groups, in the order of their unknowns.
    pub fn tool_names(&self) -> Vec<&str> {
        let solid = self.solid_tools.iter().map(|tool| tool.name());
        self.tools.iter().map(|tool| tool.name()).chain(solid).chain(self.rigid.iter().copied()).collect()
    }
    /// Whether a column out of the plane would say nothing.
    pub fn is_plane(&self) -> bool {
        self.space != Space::Solid
    }
}
