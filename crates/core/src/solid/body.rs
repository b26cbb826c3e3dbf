//! A body as a term of equilibrium: one stencil a cell.

use super::attempt::OpenBody;
use super::free::Free;
use super::gradient::Shapes;
use super::incompatible;
use super::patches::{self, Patches};
use super::slenderness::Slenderness;
use super::volume::Places;
use super::{BodyOptions, Choice, CylinderAxes, Formulation, Heat, InitialStress, Integration, Strain};
use crate::material::{Material, Placement};
use crate::mesh::cells::{Cell, Quadrature};
use crate::mesh::{Mesh, Space};
use crate::system::{Attempt, Dofs, History, Instant, State, Term, Unevenness};
use crate::{Error, Failure};
use std::cell::OnceCell;
use std::sync::Arc;

/// A set of cells made of one material.
pub struct Body {
    name: String,
    pub(super) mesh: Arc<Mesh>,
    pub(super) dofs: Dofs,
    pub(super) space: Space,
    pub(super) cells: Vec<usize>,
    pub(super) material: Arc<dyn Material>,
    pub(super) options: BodyOptions,
    choices: Vec<Choice>,
    pub(super) shapes: Vec<KindShapes>,
    pub(super) patches: Patches,
    pub(super) places: Places,
    axes: Option<CylinderAxes>,
    pub(super) initial_stress: Option<InitialStress>,
    pub(super) heat: Option<Heat>,
}

/// The shape functions of one kind of cell at the points where a body needs them.
pub(super) struct KindShapes {
    kind: &'static Cell,
    /// At the points of its quadrature.
    pub points: Vec<Shapes>,
    /// Weights of its first nodes there, for temperatures.
    pub warmth: Vec<Vec<f64>>,
    /// Whose change of volume its points have.
    pub bar: Bar,
    /// How many incompatible modes its cells have.
    pub modes: usize,
}

/// Whose change of volume the points of a cell have.
pub(super) enum Bar {
    /// Each its own.
    Own,
    /// The mean of the cell's patch.
    Mean,
    /// A field over the cell's patch that is linear.
    Linear,
}

impl Bar {
    fn of(choice: &Choice) -> Self {
        match choice.formulation {
            // Tetrahedra of second degree alone have fewer motions than a linear field needs.
            Formulation::FBar if choice.kind.degree == 2 && (choice.kind.nodes.len() != 10 || choice.joined) => {
                Self::Linear
            }
            Formulation::FBar => Self::Mean,
            Formulation::Auto | Formulation::Standard | Formulation::Incompatible => Self::Own,
        }
    }
}

impl Body {
    /// A body of the given cells.
    ///
    /// # Errors
    /// An input error where a cell's kind and the options do not go together, or the law has no small strain.
    pub fn new(
        name: &str,
        (mesh, dofs, space): (Arc<Mesh>, Dofs, Space),
        cells: Vec<usize>,
        material: Arc<dyn Material>,
        options: BodyOptions,
    ) -> Result<Self, Error> {
        for &cell in &cells {
            refuse(name, mesh.cell(cell).kind, space, &options)?;
        }
        let material = options.strain.law(material).map_err(|why| Error::input(format!("body '{name}': {why}")))?;
        let (mut choices, slenderness) = (Vec::<Choice>::new(), OnceCell::new());
        for kind in cells.iter().map(|&cell| mesh.cell(cell).kind) {
            if choices.iter().all(|known| known.kind != kind) {
                let choice = Choice::of(kind, space, material.as_ref(), &options);
                let body = || *slenderness.get_or_init(|| Slenderness::of(&mesh, &cells, options.held));
                choices.push(choice.in_body(body, &options));
            }
        }
        let size = |kind: &Cell| choices.iter().find(|choice| choice.kind == kind).map_or(1, patches::size);
        let patches = Patches::new(&mesh, &cells, size);
        let name = name.into();
        let (shapes, places, axes, initial_stress, heat) = (Vec::new(), Places::default(), None, None, None);
        let mut body = Self {
            name,
            mesh,
            dofs,
            space,
            cells,
            material,
            options,
            choices,
            shapes,
            patches,
            places,
            axes,
            initial_stress,
            heat,
        };
        body.shapes = body.choices.iter().map(|choice| body.kind_shapes(choice)).collect();
        body.places = Places::of(&body);
        Ok(body)
    }

    fn kind_shapes(&self, choice: &Choice) -> KindShapes {
        let (kind, rule) = (choice.kind, self.rule(choice.kind));
        let modes = incompatible::modes(choice);
        let shapes = |(&xi, &weight)| Shapes::new(kind, xi, weight).with_modes(kind, xi, modes);
        let points = rule.points.iter().zip(rule.weights).map(shapes);
        let warmth = rule.points.iter().map(|&xi| super::heat::weights(kind, xi, choice.integration, modes)).collect();
        KindShapes { kind, points: points.collect(), warmth, bar: Bar::of(choice), modes }
    }

    /// What its cells became, kind by kind.
    pub fn choices(&self) -> &[Choice] {
        &self.choices
    }

    /// The kind of one of its cells.
    pub(super) fn kind(&self, slot: usize) -> &'static Cell {
        self.mesh.cell(self.cells[slot]).kind
    }

    /// The shape functions of a kind of its cells.
    pub(super) fn shapes(&self, kind: &'static Cell) -> &KindShapes {
        let place = self.shapes.iter().position(|known| known.kind.name == kind.name);
        // Every kind among the cells was met when the body was made.
        &self.shapes[place.unwrap_or(0)]
    }

    /// Most points of a cell.
    pub(super) fn most_points(&self) -> usize {
        self.shapes.iter().map(|kind| kind.points.len()).max().unwrap_or(0)
    }

    /// Most nodes of a cell, incompatible modes among them.
    pub(super) fn most_nodes(&self) -> usize {
        self.shapes.iter().map(|kind| kind.kind.nodes.len() + kind.modes).max().unwrap_or(0)
    }

    /// The body with axes of a cylinder in place of those that its law says.
    ///
    /// # Errors
    /// An input error where the law is alike in all directions.
    pub fn along(mut self, axes: CylinderAxes) -> Result<Self, Error> {
        if self.material.axes_at().is_none() {
            let what = format!("body '{}': its law has no axes, or not such of a cylinder", self.name);
            return Err(Error::input(what));
        }
        self.axes = Some(axes);
        Ok(self)
    }

    /// The body with stresses before the first increment.
    ///
    /// # Errors
    /// An input error where the law or the space does not bear them.
    pub fn prestressed(mut self, field: InitialStress) -> Result<Self, Error> {
        self.initial_stress = Some(field);
        let history = self.initial();
        for record in self.records(&vec![0.0; self.dofs.count()], &history) {
            let refuse = |why: &str| {
                let (stress, at) = (&record.state[..6], record.reference.0);
                Error::input(format!("body '{}': the initial stress {stress:?} at {at:?}: {why}", self.name))
            };
            if self.space == Space::PlaneStress && record.state[2] != 0.0 {
                return Err(refuse("there is no stress across the plane in plane stress"));
            }
            self.material.bears(record.state).map_err(|why| refuse(&why))?;
        }
        Ok(self)
    }

    /// The body with a temperature.
    pub fn heated(mut self, heat: Heat) -> Self {
        self.heat = Some(heat);
        self
    }

    /// How it measures strain.
    pub fn strain(&self) -> Strain {
        self.options.strain
    }
    /// The cells of the body, in the order of the history slots.
    pub fn cells(&self) -> &[usize] {
        &self.cells
    }
    /// The law.
    pub fn material(&self) -> &Arc<dyn Material> {
        &self.material
    }
    /// Quadrature of a cell of the body.
    pub fn rule(&self, kind: &'static Cell) -> &'static Quadrature {
        let reduced = |choice: &Choice| choice.kind == kind && choice.integration == Integration::Reduced;
        kind.reduced.filter(|_| self.choices.iter().any(reduced)).unwrap_or(kind.full)
    }
    /// Values of the state of one integration point.
    pub fn point_len(&self) -> usize {
        let ratios = usize::from(self.space == Space::PlaneStress) + usize::from(self.heat.is_some());
        self.material.state_len() + ratios + self.amplitudes_by_point()
    }

    /// The state of a point before the first increment: that of the law, then thickness as a ratio, amplitudes of
    /// incompatible modes and thermal stretch as a ratio.
    fn begin(&self, at: &Placement, stress: Option<&InitialStress>, state: &mut [f64]) {
        let (law, ratios) = state.split_at_mut(self.material.state_len());
        self.material.initialise_at(law, at);
        if let Some((axes, first)) = self.axes.zip(self.material.axes_at()) {
            law[first..first + 6]
                .iter_mut()
                .zip(axes.at(at.place).map(|axis| axis.0).as_flattened())
                .for_each(|(x, e)| *x = *e);
        }
        if let Some(field) = stress {
            law[..6].copy_from_slice(&field.at(at.place));
        }
        ratios.fill(1.0);
        let first = usize::from(self.space == Space::PlaneStress);
        ratios[first..first + self.amplitudes_by_point()].fill(0.0);
    }

    /// The state of all points before the first increment, with a stress or none.
    fn begun(&self, stress: Option<&InitialStress>) -> History {
        let points = |&cell: &usize| self.rule(self.mesh.cell(cell).kind).points.len();
        let mut history = History::new(self.cells.iter().map(|cell| points(cell) * self.point_len()));
        for (slot, &cell) in self.cells.iter().enumerate() {
            let view = self.mesh.cell(cell);
            let states = history.slot_mut(slot).chunks_exact_mut(self.point_len());
            let length = self.mesh.measure(cell).powf(1.0 / self.space.dimension() as f64);
            for (point, (state, &xi)) in states.zip(self.rule(view.kind).points).enumerate() {
                let place = view.map(&self.mesh.points, xi).0;
                let at = Placement { cell: self.mesh.cell_number(cell), point: point + 1, place, length };
                self.begin(&at, stress, state);
            }
        }
        history
    }

    pub(super) fn inverted(&self, cell: usize) -> String {
        format!("cell {cell} of body '{}' is turned inside out", self.name)
    }
}

/// Pairs of options that mean nothing are refused by name.
fn refuse(body: &str, kind: &Cell, space: Space, options: &BodyOptions) -> Result<(), Error> {
    let BodyOptions { formulation, integration, .. } = options;
    let because = match (formulation, integration) {
        _ if kind.dimension != space.dimension() => {
            format!("cells {} cannot fill a {} model", kind.name, space.name())
        }
        (_, Integration::Reduced) if kind.reduced.is_none() => {
            format!("cells {} have no reduced integration; use integration = \"full\"", kind.name)
        }
        (Formulation::FBar, Integration::Reduced) => {
            "f-bar has no use with reduced integration, which does not lock; choose one".to_string()
        }
        (Formulation::Incompatible, Integration::Reduced) => {
            "incompatible modes need full integration; with reduced integration nothing resists them".to_string()
        }
        (Formulation::Incompatible, _) if !incompatible::has_modes(kind) => {
            format!(
                "cells {} have no incompatible modes, only quad4 and hex8 do; use formulation = \"auto\"",
                kind.name
            )
        }
        (Formulation::FBar, _) if space == Space::PlaneStress => {
            "f-bar means nothing in plane stress, where nothing locks; use formulation = \"standard\"".to_string()
        }
        _ => return Ok(()),
    };
    Err(Error::input(format!("body '{body}': {because}")))
}

impl Term for Body {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial(&self) -> History {
        self.begun(self.initial_stress.as_ref())
    }

    /// Without stress, also at the temperature that it then has.
    fn returned(&self, accepted: &State, at: Instant, _: f64) -> Result<History, Failure> {
        let mut history = self.begun(None);
        let warmth = self.heat.as_ref().map(|heat| heat.over(at)).transpose()?;
        if warmth.is_some() {
            let before = history.clone();
            let open = OpenBody { body: self, accepted, history: &before, gradients: vec![], dt: 0.0, warmth };
            for slot in 0..self.cells.len() {
                let own = matches!(self.shapes(self.kind(slot)).bar, Bar::Own);
                let shared = if own { None } else { open.shared_warmth(slot) };
                for (point, state) in history.slot_mut(slot).chunks_exact_mut(self.point_len()).enumerate() {
                    let warm = open.warmth_at((slot, point), shared.as_ref()).map(|(_, stretch)| stretch);
                    state.iter_mut().last().zip(warm).into_iter().for_each(|(last, warm)| *last = warm);
                }
            }
        }
        Ok(history)
    }

    fn unevenness(&self, old: &History, new: &History, dt: f64) -> Unevenness {
        let (mut largest, mut power) = ([0.0_f64; 2], [0.0; 2]);
        for slot in 0..self.cells.len() {
            let states =
                old.slot(slot).chunks_exact(self.point_len()).zip(new.slot(slot).chunks_exact(self.point_len()));
            for (old, new) in states {
                let state = ..self.material.state_len();
                let (Some(from), Some(to)) = (self.material.creep(&old[state]), self.material.creep(&new[state]))
                else {
                    return Unevenness::default();
                };
                largest = [largest[0].max(from.unevenness(&to, dt)), largest[1].max(from.stress).max(to.stress)];
                let point = from.change_of_power(&to, dt);
                power = [power[0] + point[0], power[1] + point[1]];
            }
        }
        let [stress, power] = [largest, power].map(|[part, of]| if part > 0.0 { part / of } else { 0.0 });
        Unevenness { stress, power }
    }

    fn at_start(&self, forces: &mut [f64]) -> Result<f64, Failure> {
        if self.initial_stress.is_none() {
            return Ok(0.0);
        }
        let history = self.initial();
        let start = State { u: vec![0.0; forces.len()], ..State::default() };
        let attempt = self.attempt(&start, &history, Instant::default())?;
        let mut stored = 0.0;
        attempt.each(&start.u, &mut |dofs, local| {
            dofs.iter().zip(&local.force).for_each(|(&dof, force)| forces[dof] += force);
            stored += local.energies.stored;
        })?;
        Ok(stored)
    }

    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let gradients = self.gradients(&self.options.strain.base(&accepted.u))?;
        let warmth = self.heat.as_ref().map(|heat| heat.over(at)).transpose()?;
        Ok(Box::new(OpenBody { body: self, accepted, history, gradients, dt: at.dt, warmth }))
    }

    fn name_of(&self, stencil: usize) -> String {
        format!("cell {} of body '{}'", self.cells[stencil], self.name)
    }

    fn describe_motions(&self, motions: &[Vec<f64>]) -> Vec<String> {
        let mut nodes: Vec<usize> = self.cells.iter().flat_map(|&c| self.mesh.cell(c).nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let found = Free::of(motions, (&self.dofs, &self.mesh.points), &nodes, self.space);
        found.words(self.space).into_iter().map(|words| format!("body '{}' {words}", self.name)).collect()
    }
}
