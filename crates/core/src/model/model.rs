//! A model owns its mesh, bodies, tools, contacts, springs, loads and steps; a run only reads it.

use super::audited::claims;
use super::bearing::bearing;
use super::builder::ModelBuilder;
use crate::audit::{Audit, Subject};
use crate::contact::PaperContact;
use crate::contact::field::{FieldContact, TiedSurfaces};
use crate::load::{Bearing, PenetratingPressure};
use crate::mesh::{Mesh, Space};
use crate::solid::{Body, Strain};
use crate::solve::{NewtonOptions, Problem, Run, Step, engine};
use crate::system::{Dofs, Following, FollowingGroup, State, Term, Whole};
use crate::tensor::Vec3;
use crate::tool::{self, ProfileTool};
use std::collections::BTreeSet;
use std::sync::Arc;

/// What a model is put together from: begin with [`ModelParts::new`], and say what there is. [`Model::builder`] does so by names.
#[non_exhaustive]
pub struct ModelParts {
    /// The user's words for it; may be empty.
    pub title: String,
    /// What the coordinates mean.
    pub space: Space,
    /// Nominal thickness in the plane spaces.
    pub thickness: f64,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The numbering of the unknowns.
    pub dofs: Dofs,
    /// The bodies, each with the number of its material.
    pub bodies: Vec<(Body, usize)>,
    /// The names of the materials.
    pub materials: Vec<String>,
    /// The tools of a plane model, in the order of their unknowns.
    pub tools: Vec<Arc<ProfileTool>>,
    /// The tools of a model in space, in the order of their unknowns.
    pub solid_tools: Vec<Arc<tool::space::SpaceTool>>,
    /// The contacts whose stress lives at Gauss points.
    pub contacts: Vec<PaperContact>,
    /// The contacts whose stress is a field of nodal values.
    pub field_contacts: Vec<FieldContact>,
    /// Springs.
    pub springs: Vec<Box<dyn Term>>,
    /// Loads.
    pub loads: Vec<Box<dyn Term>>,
    /// Fluids that enter openings, which are told what contacts bear.
    pub fluids: Vec<Arc<PenetratingPressure>>,
    /// Where they are told.
    pub bearing: Bearing,
    /// The steps.
    pub steps: Vec<Step>,
    /// Names and nodes of the groups that are held or moved in any step.
    pub supports: Vec<(String, Vec<usize>)>,
    /// The same of other groups whose motion is reported.
    pub watched: Vec<(String, Vec<usize>)>,
    /// What is glued, each with the names of surface and target.
    pub ties: Vec<([String; 2], TiedSurfaces)>,
    /// Groups of nodes that are rigid, in the order of their unknowns, which follow those of the tools.
    pub rigid: Vec<RigidGroup>,
    /// Options of the iterations.
    pub newton: NewtonOptions,
}

impl ModelParts {
    /// A mesh in a space with its numbering of unknowns, and nothing else yet.
    pub fn new(space: Space, mesh: Arc<Mesh>, dofs: Dofs) -> Self {
        Self {
            title: String::new(),
            space,
            thickness: 1.0,
            mesh,
            dofs,
            bodies: Vec::new(),
            materials: Vec::new(),
            tools: Vec::new(),
            solid_tools: Vec::new(),
            contacts: Vec::new(),
            field_contacts: Vec::new(),
            springs: Vec::new(),
            loads: Vec::new(),
            fluids: Vec::new(),
            bearing: Bearing::default(),
            steps: Vec::new(),
            supports: Vec::new(),
            watched: Vec::new(),
            ties: Vec::new(),
            rigid: Vec::new(),
            newton: NewtonOptions::default(),
        }
    }
}

/// Nodes that follow a reference point as a rigid body.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidGroup {
    /// Its name.
    pub name: String,
    /// The reference point.
    pub reference: Vec3,
    /// The nodes.
    pub nodes: Vec<usize>,
}

/// What is to be solved. Terms are numbered bodies first, then contacts, springs and loads.
#[non_exhaustive]
pub struct Model {
    /// The user's words for it.
    pub title: String,
    /// What the coordinates mean.
    pub space: Space,
    /// Nominal thickness in the plane spaces.
    pub thickness: f64,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The bodies, each with the number of its material.
    pub bodies: Vec<(Arc<Body>, usize)>,
    /// The names of the materials.
    pub materials: Vec<String>,
    /// The tools of a plane model, in the order of their unknowns.
    pub tools: Vec<Arc<ProfileTool>>,
    /// The tools of a model in space, in the order of their unknowns.
    pub solid_tools: Vec<Arc<tool::space::SpaceTool>>,
    /// The contacts whose stress lives at Gauss points.
    pub contacts: Vec<Arc<PaperContact>>,
    /// The contacts whose stress is a field of nodal values, which follow these.
    pub field_contacts: Vec<Arc<FieldContact>>,
    /// Number of springs.
    pub springs: usize,
    /// Fluids that enter openings, the last of the terms.
    pub fluids: Vec<Arc<PenetratingPressure>>,
    /// Names and nodes of the groups that are held or moved in any step.
    pub supports: Vec<(String, Vec<usize>)>,
    /// The same of other groups whose motion is reported.
    pub watched: Vec<(String, Vec<usize>)>,
    /// What is glued, each with the names of surface and target.
    pub ties: Vec<([String; 2], TiedSurfaces)>,
    /// Groups of nodes that are rigid.
    pub rigid: Vec<RigidGroup>,
    /// The terms, steps and options that are solved.
    pub problem: Problem,
}

impl Model {
    /// A model of bodies, tools, contacts, loads and steps, called by their names.
    pub fn builder(space: Space, mesh: impl Into<Arc<Mesh>>) -> ModelBuilder {
        ModelBuilder::new(space, mesh.into())
    }

    /// Puts the parts together.
    pub fn new(parts: ModelParts) -> Self {
        let ModelParts {
            title,
            space,
            thickness,
            mesh,
            dofs,
            materials,
            tools,
            solid_tools,
            supports,
            watched,
            ties,
            rigid,
            steps,
            newton,
            ..
        } = parts;
        let bodies: Vec<_> = parts.bodies.into_iter().map(|(body, material)| (Arc::new(body), material)).collect();
        let contacts: Vec<_> = parts.contacts.into_iter().map(Arc::new).collect();
        let know_steps = |mut contact: FieldContact| {
            contact.know_steps(steps.iter().map(|step| &step.constraints));
            Arc::new(contact)
        };
        let field_contacts: Vec<_> = parts.field_contacts.into_iter().map(know_steps).collect();
        let springs = parts.springs.len();
        let mut terms: Vec<Arc<dyn Term>> = bodies.iter().map(|(body, _)| body.clone() as Arc<dyn Term>).collect();
        terms.extend(contacts.iter().map(|contact| contact.clone() as Arc<dyn Term>));
        terms.extend(field_contacts.iter().map(|contact| contact.clone() as Arc<dyn Term>));
        terms.extend(parts.springs.into_iter().chain(parts.loads).map(Arc::from));
        let fluids = parts.fluids;
        terms.extend(fluids.iter().map(|fluid| fluid.clone() as Arc<dyn Term>));
        if !fluids.is_empty() {
            parts.bearing.tell(bearing(bodies.len(), &contacts, &field_contacts));
        }
        let arms = |group: &RigidGroup| {
            let arm = |&node: &usize| (node, mesh.points[node] - group.reference);
            group.nodes.iter().map(arm).collect()
        };
        let first = tools.len() + solid_tools.len();
        let contacts_end = bodies.len() + contacts.len() + field_contacts.len();
        let in_small_strain = |group: &RigidGroup| {
            let nodes: BTreeSet<usize> = group.nodes.iter().copied().collect();
            let holds = |&cell: &usize| mesh.cell(cell).nodes.iter().any(|node| nodes.contains(node));
            let mut holding = bodies.iter().filter(|(body, _)| body.cells().iter().any(holds)).peekable();
            holding.peek().is_some() && holding.all(|(body, _)| body.strain() == Strain::Small)
        };
        let group = |(i, group): (usize, &RigidGroup)| FollowingGroup {
            tool: first + i,
            nodes: arms(group),
            small: in_small_strain(group),
        };
        let groups: Vec<_> = rigid.iter().enumerate().map(group).collect();
        let following = Arc::new(Following::new(&dofs, &groups));
        if !following.is_empty() {
            terms = terms.into_iter().map(|term| Following::wrap(&following, term)).collect();
        }
        let cells = bodies.iter().flat_map(|(body, _)| body.cells());
        let audit = Audit::new(Subject {
            mesh: mesh.clone(),
            dofs: dofs.clone(),
            axisymmetric: space == Space::Axisymmetric,
            bodies: bodies.iter().map(|(body, _)| (body.name().to_owned(), body.cells().to_vec())).collect(),
            tools: tools.clone(),
            solid_tools: solid_tools.clone(),
            claims: claims(bodies.len(), &contacts, &field_contacts, &ties),
            cell_size: smallest_cell(&mesh),
            limit: INTERPENETRATION[0],
            contact_limit: INTERPENETRATION[1],
        });
        let glued: Vec<Vec<usize>> = ties.iter().map(|(_, tie)| tie.nodes.concat()).collect();
        let glued = glued.iter().map(Vec::as_slice);
        let count = terms.len();
        let problem = Problem {
            terms,
            contacts: bodies.len()..contacts_end,
            // Nothing would be left without the only body.
            removable: if bodies.len() > 1 { 0..count } else { bodies.len()..contacts_end },
            audit: Some(audit),
            dofs,
            steps,
            newton,
            size: mesh.size(),
            cell_size: smallest_cell(&mesh),
            wholes: Whole::all(cells.map(|&cell| mesh.cell(cell).nodes).chain(glued), &mesh.points, space),
            tools: tools
                .iter()
                .map(|tool| tool.name())
                .chain(solid_tools.iter().map(|tool| tool.name()))
                .chain(rigid.iter().map(|group| group.name.as_str()))
                .map(str::to_owned)
                .collect(),
            following,
            node_name: node_namer(mesh.clone()),
        };
        Self {
            title,
            space,
            thickness,
            mesh,
            bodies,
            materials,
            tools,
            solid_tools,
            contacts,
            field_contacts,
            springs,
            fluids,
            supports,
            watched,
            ties,
            rigid,
            problem,
        }
    }

    /// Number of the first contact among the terms.
    pub fn first_contact(&self) -> usize {
        self.bodies.len()
    }
    /// Number of the first fluid among the terms.
    pub fn first_fluid(&self) -> usize {
        self.problem.terms.len() - self.fluids.len()
    }
    /// Number of the first spring among the terms.
    pub fn first_spring(&self) -> usize {
        self.bodies.len() + self.contacts.len() + self.field_contacts.len()
    }

    /// A run from a given state: the initial one ([`Problem::initial_state`]) or that of a checkpoint.
    pub fn run(&self, state: State) -> Run<'_> {
        Run::new(&self.problem, state, engine::make(&self.problem))
    }
}

/// An increment is refused that lets bodies lie in something by more than this part of a cell, beyond what is explained:
/// where no contact is declared, and between the two sides of one, which is blind between its points.
const INTERPENETRATION: [f64; 2] = [0.01, 0.25];

/// Edge of the square or cube that is cut into the smallest cell and such as it: triangles are as large as the squares that they halve.
fn smallest_cell(mesh: &Mesh) -> f64 {
    let size = |cell: usize| {
        let kind = mesh.kinds[cell];
        let parts = match (kind.dimension, kind.linear.nodes.len()) {
            (2, 3) | (3, 6) => 2.0,
            (3, 5) => 3.0,
            (3, 4) => 6.0,
            _ => 1.0,
        };
        (parts * mesh.measure(cell).abs()).powf(1.0 / kind.dimension as f64)
    };
    (0..mesh.cell_count()).map(size).fold(f64::INFINITY, f64::min)
}

/// Names a node by its number and the smallest group that holds it.
fn node_namer(mesh: Arc<Mesh>) -> Box<dyn Fn(usize) -> String + Send + Sync> {
    Box::new(move |node| {
        let holds = mesh.groups.iter().filter(|(_, group)| group.nodes.binary_search(&node).is_ok());
        match holds.min_by_key(|(_, group)| group.nodes.len()) {
            Some((name, _)) => format!("node {node} of '{name}'"),
            None => format!("node {node}"),
        }
    })
}
