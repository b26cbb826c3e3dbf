//! Contacts.

use super::{Writer, quoted};
use crate::elements::{Dialect, Family};
use crate::message::InputPlace;
use crate::model::{Action, ActionKind, Interaction, Pair, SurfaceKind, Tie};
use std::collections::{BTreeMap, BTreeSet};

/// A side of a contact.
pub(super) enum Sided {
    /// Faces of bodies, by their group.
    Sides(String),
    /// A tool.
    Tool(String),
}

impl Writer<'_> {
    /// One contact for each pair.
    pub(super) fn contacts(&mut self) {
        let model = self.model;
        for pair in model.pairs.iter().filter(|pair| !model.is_tied(pair)) {
            let what = if pair.field {
                "contact stress is a field of nodal values: `form = \"field\"`"
            } else {
                "contact stress lives at points within the slave faces, as CalculiX' face to face does; `form = \"field\"` makes a field \
                 of it"
            };
            self.note(pair.place, what);
        }
        for (number, pair) in model.pairs.iter().enumerate().filter(|(_, pair)| !model.is_tied(pair)) {
            self.adjust(pair);
            self.contact(number + 1, pair);
        }
    }

    fn contact(&mut self, number: usize, pair: &Pair) -> Option<()> {
        let (slave, master) = (self.sided(pair.place, &pair.slave)?, self.sided(pair.place, &pair.master)?);
        let of_bodies = matches!((&slave, &master), (Sided::Sides(_), Sided::Sides(_)));
        let (surface, target) = match (slave, master) {
            (Sided::Sides(surface), Sided::Sides(target) | Sided::Tool(target)) => (surface, target),
            (Sided::Tool(target), Sided::Sides(surface)) => {
                self.note(pair.place, "the rigid surface is the target, though it was named first");
                (surface, target)
            }
            (Sided::Tool(_), Sided::Tool(_)) => {
                self.error(pair.place, "two rigid surfaces cannot touch; one side must be that of a body");
                return None;
            }
        };
        let interaction = self.model.interactions.get(pair.interaction)?;
        let law = self.friction((interaction, pair.interaction), pair.place);
        let name = self.contact_name(number, pair)?;
        let from = self.from(pair.place);
        let mut text = format!(
            "\n[contact.{}]{from}\nsurface = {}\ntarget = {}\n",
            quoted(&name),
            quoted(&surface),
            quoted(&target)
        );
        match (pair.field, of_bodies) {
            (true, _) => text += "form = \"field\"\n",
            (false, true) if pair.slave != pair.master => text += "passes = \"one\"\n",
            (false, _) => {}
        }
        if !pair.field {
            // CalculiX cuts the slave faces along those of the master; so many points come as near where they do not match.
            let points = match self.family {
                Family::Solid => 6,
                Family::Axisymmetric => 5,
                _ => 10,
            };
            text += &format!("gauss = {points}\n");
        }
        text += &law;
        if let Some(slope) = interaction.slope {
            text += &format!("penalty = {slope:?}\n");
        }
        if !interaction.closure.is_empty() {
            let rows: Vec<String> = interaction.closure.iter().map(|row| super::list(row)).collect();
            text += &format!("closure = [{}]\n", rows.join(", "));
        }
        if let Some(slope) = interaction.stick_slope.filter(|_| interaction.friction.is_some_and(|f| f > 0.0)) {
            text += &format!("tangential_penalty = {slope:?}\n");
        }
        text += &format!("overlap = \"{}\"\n", if pair.adjust.is_some() { "adjust" } else { "keep" });
        self.text += &text;
        Some(())
    }

    /// One tie for each, and for each contact pair that is tied.
    pub(super) fn ties(&mut self) {
        let model = self.model;
        for tie in &model.ties {
            self.tie(tie);
        }
        for pair in model.pairs.iter().filter(|pair| model.is_tied(pair)) {
            self.note(pair.place, "the surfaces are glued by constraint, without the elasticity that TIED has");
            let (slave, master) = (pair.slave.clone(), pair.master.clone());
            self.tie(&Tie { place: pair.place, slave, master, tolerance: None, adjust: pair.adjust.is_some() });
        }
    }

    fn tie(&mut self, tie: &Tie) -> Option<()> {
        let (slave, master) = (self.sided(tie.place, &tie.slave)?, self.sided(tie.place, &tie.master)?);
        let (Sided::Sides(surface), Sided::Sides(target)) = (slave, master) else {
            self.error(tie.place, "a rigid surface cannot be tied; both sides must be those of bodies");
            return None;
        };
        let from = self.from(tie.place);
        self.text += &format!("\n[[tie]]{from}\nsurface = {}\ntarget = {}\n", quoted(&surface), quoted(&target));
        if let Some(tolerance) = tie.tolerance {
            self.text += &format!("tolerance = {tolerance:?}\n");
        }
        if !tie.adjust {
            self.text += "gap = \"keep\"\n";
        }
        Some(())
    }

    /// What the contact of a pair is called, unless it is glued.
    pub(super) fn contact_name(&self, number: usize, pair: &Pair) -> Option<String> {
        if self.model.is_tied(pair) {
            return None;
        }
        let name = &self.model.interactions.get(pair.interaction)?.name;
        let alike = self.model.pairs.iter().filter(|other| other.interaction == pair.interaction);
        Some(if alike.count() == 1 { name.clone() } else { format!("{name} {number}") })
    }

    /// The contacts that a step ends, and those that are there again.
    pub(super) fn changed_contacts(&mut self, step: usize) -> [Vec<String>; 2] {
        let (model, mut changed) = (self.model, [vec![], vec![]]);
        for action in model.actions(step) {
            let ActionKind::Contact(slave, master, add) = &action.kind else { continue };
            let pairs = model.pairs.iter().enumerate();
            let names: Vec<String> = pairs
                .filter(|(_, pair)| (&pair.slave, &pair.master) == (slave, master))
                .filter_map(|(number, pair)| self.contact_name(number + 1, pair))
                .collect();
            if names.is_empty() {
                self.error(action.place, format!("there is no *CONTACT PAIR of '{}' and '{}'", slave.1, master.1));
            }
            changed[usize::from(*add)].extend(names.iter().map(|name| quoted(name)));
        }
        changed
    }

    /// The lines of coefficients of friction that a step changes.
    pub(super) fn changed_frictions(&mut self, number: usize) -> Vec<String> {
        let (model, mut lines) = (self.model, Vec::new());
        // CalculiX changes it at once, Abaqus over the step.
        let at_once = model.dialect == Dialect::CalculiX || model.steps.get(number).is_some_and(|step| step.at_once);
        let course = if at_once { ", amplitude = [[0.0, 1.0], [1.0, 1.0]]" } else { "" };
        for action in model.actions(number) {
            let ActionKind::Friction(interaction, value) = action.kind else { continue };
            for (at, pair) in model.pairs.iter().enumerate().filter(|(_, pair)| pair.interaction == interaction) {
                let Some(name) = self.contact_name(at + 1, pair) else { continue };
                let from = self.from(action.place);
                lines.push(format!("friction.{} = {{ value = {value:?}{course} }}{from}\n", quoted(&name)));
            }
        }
        lines
    }

    /// The law of an interaction.
    fn friction(&mut self, (interaction, number): (&Interaction, usize), place: InputPlace) -> String {
        let changes = |action: &Action| matches!(action.kind, ActionKind::Friction(other, _) if other == number);
        let changes = self.model.steps.iter().any(|step| step.actions.iter().any(changes));
        match (interaction.friction, interaction.shear_limit, interaction.decay) {
            _ if interaction.rough => "law.sticking = {}\n".into(),
            (None | Some(0.0), None, None) if changes => "law.coulomb = { friction = 0.0 }\n".into(),
            (None | Some(0.0), _, None) => "law.frictionless = {}\n".into(),
            (Some(friction), Some(limit), None) => {
                format!("law.orowan = {{ friction = {friction:?}, shear_strength = {limit:?} }}\n")
            }
            (Some(friction), limit, Some([kinetic, decay])) => {
                if limit.is_some() {
                    self.note(place, "TAUMAX left out: friction that decays with velocity has no limit of its shear");
                }
                let velocity = 1.0 / decay;
                format!(
                    "law.velocity_dependent = {{ static = {friction:?}, kinetic = {kinetic:?}, velocity = {velocity:?} }}\n"
                )
            }
            (Some(friction), None, None) => format!("law.coulomb = {{ friction = {friction:?} }}\n"),
            (None, _, Some(_)) => "law.frictionless = {}\n".into(),
        }
    }

    /// What a surface of a pair is here.
    pub(super) fn sided(&mut self, place: InputPlace, name: &(usize, String)) -> Option<Sided> {
        let surface = self.model.surface(name)?;
        let rigid = |element: usize| self.model.elements[element].kind.family == Family::Rigid;
        match &surface.kind {
            SurfaceKind::Analytical(_) => self.tool_of_surface(name).map(Sided::Tool).or_else(|| {
                let what = format!("surface '{}' has no *RIGID BODY, which says what it follows", surface.name);
                self.error(place, what);
                None
            }),
            SurfaceKind::Faces(faces) if faces.iter().any(|&(element, ..)| rigid(element)) => {
                let found = faces.first().and_then(|&(element, ..)| self.tool_of_element(element));
                found.map(Sided::Tool).or_else(|| {
                    self.error(place, format!("surface '{}' lies on rigid elements of no *RIGID BODY", surface.name));
                    None
                })
            }
            SurfaceKind::Faces(faces) => {
                let faces: Vec<_> = faces
                    .iter()
                    .filter(|(element, ..)| self.section[*element].is_some())
                    .map(|&(element, face, _)| (element, face))
                    .collect();
                let (count, boundary) = (faces.len(), self.boundary());
                let outer = |(element, face): &(usize, Option<usize>)| {
                    face.is_none_or(|face| boundary.contains(&(*element, face)))
                };
                let faces: Vec<_> = faces.into_iter().filter(outer).collect();
                if faces.is_empty() {
                    self.error(place, format!("surface '{}' has no face on the outside of a body", surface.name));
                    return None;
                }
                if faces.len() < count {
                    let what = format!(
                        "{} faces of surface '{}' lie within bodies and are left out",
                        count - faces.len(),
                        surface.name
                    );
                    self.note(surface.place, what);
                }
                Some(Sided::Sides(self.groups.sides(&surface.name, faces)))
            }
            SurfaceKind::Nodes(nodes) => {
                let faces = self.faces_of_nodes(nodes);
                if faces.is_empty() {
                    let what =
                        format!("the nodes of surface '{}' make up no face; name faces of elements", surface.name);
                    self.error(place, what);
                    return None;
                }
                self.note(surface.place, format!("surface '{}' of nodes becomes the faces between them", surface.name));
                Some(Sided::Sides(self.groups.sides(&surface.name, faces)))
            }
        }
    }

    /// The faces of the outer boundary whose corners are all among the nodes.
    fn faces_of_nodes(&mut self, nodes: &[usize]) -> Vec<(usize, Option<usize>)> {
        let chosen: BTreeSet<usize> = nodes.iter().copied().collect();
        let held = |&(element, face): &(usize, usize)| {
            let element = &self.model.elements[element];
            element.kind.faces[face - 1].iter().all(|&corner| chosen.contains(&element.nodes[corner]))
        };
        self.boundary().iter().filter(|face| held(face)).map(|&(element, face)| (element, Some(face))).collect()
    }

    /// The faces that only one element with a section has, by their numbers.
    pub(super) fn boundary(&self) -> BTreeSet<(usize, usize)> {
        let mut faces = BTreeMap::<Vec<usize>, Option<(usize, usize)>>::new();
        for (at, element) in self.model.elements.iter().enumerate().filter(|(at, _)| self.section[*at].is_some()) {
            for (face, corners) in element.kind.faces.iter().enumerate() {
                let mut corners: Vec<usize> = corners.iter().map(|&corner| element.nodes[corner]).collect();
                corners.sort_unstable();
                faces.entry(corners).and_modify(|owner| *owner = None).or_insert(Some((at, face + 1)));
            }
        }
        faces.into_values().flatten().collect()
    }
}
