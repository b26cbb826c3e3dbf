//! Materials and bodies.

use super::{Writer, list, quoted, rubber};
use crate::elements::{Family, Formulation};
use crate::message::{InputPlace, suggestion};
use crate::model::{ActionKind, Material, Model, Orientation, RigidPart, Section, Stiffness, Target, UserLaw};
use std::collections::{BTreeMap, BTreeSet};

/// A body: its group, material and formulation.
pub struct Body {
    /// The group of its cells.
    pub group: String,
    /// Its elements.
    pub elements: Vec<usize>,
    /// The material's number.
    pub material: usize,
    /// The name of its law.
    pub law: String,
    /// The name of its axes, where they are those of a cylinder.
    pub cylinder: Option<String>,
}

impl Writer<'_> {
    /// Which section each element has, the last one that names it; and what the coordinates mean.
    pub(super) fn sort_elements(&mut self) {
        let model = self.model;
        self.section = vec![None; model.elements.len()];
        for (number, section) in model.sections.iter().enumerate() {
            for &element in &section.elements {
                let found = &model.elements[element];
                if !found.kind.is_cell() {
                    let what = format!(
                        "elements of type {} are no part of a body; take them out of '{}'",
                        found.kind.name, section.set
                    );
                    self.error(section.place, what);
                    break;
                }
                self.section[element] = Some(number);
            }
        }
        self.used = vec![false; model.nodes.len()];
        for (element, _) in model.elements.iter().zip(&self.section).filter(|(_, section)| section.is_some()) {
            element.nodes.iter().for_each(|&node| self.used[node] = true);
        }
        let plane = model.elements.iter().all(|element| element.kind.family != Family::Solid);
        let ring = model.elements.iter().any(|element| element.kind.family == Family::Axisymmetric) && plane;
        for rigid in &model.rigid {
            let of_nodes = matches!(rigid.what, RigidPart::Nodes(..) | RigidPart::Sides(..)) && !rigid.distributing;
            self.used[rigid.node] |= of_nodes && (ring || rigid.is_partial());
        }
        for equation in &model.equations {
            equation.terms.iter().for_each(|term| self.used[term.0] = true);
        }
        let kept = || model.elements.iter().zip(self.section.clone()).filter(|(_, section)| section.is_some());
        let families: BTreeSet<Family> = kept().map(|(element, _)| element.kind.family).collect();
        match families.iter().copied().collect::<Vec<_>>().as_slice() {
            [] => {
                let place = model.steps.first().map(|step| step.place).unwrap_or_default();
                self.error(place, "no element has a material; give the sets of elements a *SOLID SECTION");
            }
            [one] => self.family = *one,
            [one, other, ..] => {
                let name = |family: Family| family.space();
                if let Some((element, _)) = kept().find(|(element, _)| element.kind.family == *other) {
                    let what = format!("{} and {} elements cannot be one model", name(*one), name(*other));
                    self.error(element.place, what);
                }
            }
        }
        let bare = model
            .elements
            .iter()
            .zip(&self.section)
            .find(|(element, section)| element.kind.is_cell() && section.is_none());
        if let Some((element, _)) = bare {
            let count =
                model.elements.iter().zip(&self.section).filter(|(e, s)| e.kind.is_cell() && s.is_none()).count();
            self.messages.note(element.place, format!("{count} elements have no *SOLID SECTION and are left out"));
        }
    }

    /// The thickness of all sections, if one is given.
    pub(super) fn thickness(&mut self) -> Option<f64> {
        if !matches!(self.family, Family::PlaneStrain | Family::PlaneStress) {
            return None;
        }
        let given: Vec<_> =
            self.model.sections.iter().map(|section| (section.thickness.unwrap_or(1.0), section.place)).collect();
        let (first, _) = *given.first()?;
        if let Some((other, place)) = given.iter().find(|(thickness, _)| *thickness != first) {
            self.messages.error(
                *place,
                format!("all sections must have one thickness; this one has {other}, the first has {first}"),
            );
        }
        Some(first).filter(|&thickness| thickness != 1.0)
    }

    /// Whether the bodies of a material strain by little.
    fn small(&self, material: &Material) -> bool {
        !self.model.steps.iter().any(|step| step.large) && material.hyperelastic.is_none()
    }

    /// The materials that sections name.
    pub(super) fn materials(&mut self) {
        let model = self.model;
        for section in &model.sections {
            if let Some(name) = section.orientation.as_ref().filter(|name| !model.orientations.contains_key(*name)) {
                let near = suggestion(name, model.orientations.keys().map(String::as_str));
                self.error(section.place, format!("there is no *ORIENTATION '{name}'{near}"));
            }
        }
        let own =
            |section: &&Section| section.orientation.is_some() && model.materials[section.material].user.is_some();
        for section in model.sections.iter().filter(own) {
            let what =
                "a *USER MATERIAL is called along x, y and z, and the *ORIENTATION of its section cannot be translated";
            self.error(section.place, what);
        }
        let used: BTreeSet<(usize, Option<&String>)> =
            model.sections.iter().map(|section| (section.material, axes(model, section))).collect();
        for (number, axes) in used {
            let Some(material) = model.materials.get(number) else { continue };
            let Some(law) = self.law(material, axes) else { continue };
            let from = self.from(material.place);
            let name = named(material, axes);
            self.text += &format!("\n[material.{}.{}]{from}\n{}", quoted(&name), law.0, law.1);
        }
    }

    /// The law of a material with its constants.
    fn law(&mut self, material: &Material, axes: Option<&String>) -> Option<(&'static str, String)> {
        let place = material.place;
        if let Some(given) = &material.hyperelastic {
            if !material.plastic.is_empty() {
                self.error(place, format!("material '{}' is rubber and flows; keep one of the two", material.name));
                return None;
            }
            let (law, remark) = rubber::law(given)?;
            self.note(given.place, remark);
            return Some(law);
        }
        if let Some(user) = &material.user {
            return self.user_law(material, user);
        }
        if let Some(stiffness) = &material.stiffness {
            return self.stiffness(material, stiffness, axes);
        }
        let Some([young, poisson]) = material.elastic else {
            self.error(place, format!("material '{}' has no *ELASTIC and no *HYPERELASTIC", material.name));
            return None;
        };
        if !self.small(material) && material.plastic.is_empty() {
            let what = "*ELASTIC at large strain: stress rates are Jaumann's, as in Abaqus; CalculiX' law is linear in Green's strain";
            self.note(place, what);
        }
        let elastic = format!("young = {young:?}\npoisson = {poisson:?}\n");
        if let Some(ratios) = &material.potential {
            return self.hill(material, (elastic, ratios), axes);
        }
        Some(match material.plastic.as_slice() {
            [] => ("elastic", elastic),
            [[stress, _]] => ("von_mises", format!("{elastic}yield_stress = {stress:?}\n")),
            [[stress, _], [later, strain]] if material.kinematic => {
                let slope = (later - stress) / strain;
                ("von_mises", format!("{elastic}yield_stress = {stress:?}\nkinematic = {slope:?}\n"))
            }
            curve => {
                let points: Vec<String> = curve.iter().map(|[stress, strain]| list(&[*strain, *stress])).collect();
                ("von_mises_table", format!("{elastic}curve = [{}]\n", points.join(", ")))
            }
        })
    }

    /// Hill's law by the yield stresses along the axes of the material, over that of the flow curve.
    fn hill(
        &mut self,
        material: &Material,
        (elastic, ratios): (String, &[f64; 6]),
        axes: Option<&String>,
    ) -> Option<(&'static str, String)> {
        let hardening = match material.plastic.as_slice() {
            [[stress, _]] => format!("yield_stress = {stress:?}\n"),
            [[stress, _], [later, strain]] if !material.kinematic => {
                format!("yield_stress = {stress:?}\nhardening = {:?}\n", (later - stress) / strain)
            }
            _ => {
                let what =
                    "*POTENTIAL goes with a *PLASTIC of one or two rows, which harden isotropically and linearly";
                self.error(material.place, what);
                return None;
            }
        };
        let [a, b, c, l, m, n] = ratios.map(|ratio| (ratio * ratio).recip());
        let sides = [("f", b + c - a), ("g", c + a - b), ("h", a + b - c)].map(|(key, sum)| (key, 0.5 * sum));
        let shears = [("l", n), ("m", m), ("n", l)].map(|(key, square)| (key, 1.5 * square));
        let mut text = elastic + &hardening;
        text.extend(sides.into_iter().chain(shears).map(|(key, value)| format!("{key} = {value:?}\n")));
        text += &self.along(axes, ["rolling", "normal"]);
        Some(("hill_coefficients", text))
    }

    /// The keys of the first and the third axis of a law.
    fn along(&self, axes: Option<&String>, keys: [&str; 2]) -> String {
        let Some(Orientation::Straight([first, _, third])) = axes.and_then(|name| self.model.orientations.get(name))
        else {
            return String::new();
        };
        let lines = |(key, axis): (&str, &[f64; 3])| {
            ["x", "y", "z"].iter().zip(axis).map(|(name, x)| format!("{key}_{name} = {x:?}\n")).collect::<String>()
        };
        keys.into_iter().zip([first, third]).map(lines).collect()
    }

    /// Elasticity along axes.
    fn stiffness(
        &mut self,
        material: &Material,
        stiffness: &Stiffness,
        axes: Option<&String>,
    ) -> Option<(&'static str, String)> {
        if !material.plastic.is_empty() || material.elastic.is_some() {
            let what = "an elastic law along axes takes no *PLASTIC and no second *ELASTIC; keep one of the two";
            self.error(material.place, what);
            return None;
        }
        if !self.small(material) {
            let what = "*ELASTIC at large strain: the axes turn with the polar rotation, and the stress follows the strain of each \
                        increment; CalculiX' law is linear in Green's strain";
            self.note(material.place, what);
        }
        let keyed = |keys: &[&str], values: &[f64]| {
            keys.iter().zip(values).map(|(key, value)| format!("{key} = {value:?}\n")).collect::<String>()
        };
        let (name, text) = match stiffness {
            Stiffness::Constants(values) => ("orthotropic", keyed(CONSTANTS, values)),
            Stiffness::Coefficients(values) => ("anisotropic", keyed(COEFFICIENTS, values)),
        };
        Some((name, text + &self.along(axes, ["first", "third"])))
    }

    /// A law of the user's own, in a shared library.
    fn user_law(&mut self, material: &Material, user: &UserLaw) -> Option<(&'static str, String)> {
        let name = material.name.to_ascii_uppercase();
        if let Some(own) = BUILT_IN.iter().find(|own| name.starts_with(**own)) {
            let what = format!(
                "the law {own} is in CalculiX itself and cannot be translated; give one that there is, or a UMAT"
            );
            self.error(user.place, what);
            return None;
        }
        if material.elastic.is_some() || material.stiffness.is_some() || !material.plastic.is_empty() {
            let what =
                format!("material '{}' is a *USER MATERIAL and something else; keep one of the two", material.name);
            self.error(material.place, what);
            return None;
        }
        let what = "*USER MATERIAL is called as a UMAT in the library `umat.so` beside the input deck; another: \
                    --set 'material.NAME.umat.library=\"PATH\"', from the root";
        self.note(user.place, what);
        let keys = format!(
            "library = {}\nname = {}\nproperties = {}\nstates = {}\n",
            quoted(self.library),
            quoted(&name),
            list(&user.properties),
            material.states
        );
        Some(("umat", keys))
    }

    /// The axes of a body that are those of a cylinder.
    fn cylinder(&self, name: &str) -> String {
        let Some(Orientation::Cylinder { origin, along, turn: (about, angle) }) = self.model.orientations.get(name)
        else {
            return String::new();
        };
        let turn = if *angle == 0.0 { String::new() } else { format!(", about = {}, angle = {angle:?}", about + 1) };
        format!("axes = {{ origin = {}, along = {}{turn} }}\n", list(origin), list(along))
    }

    /// The bodies: the elements of a section that are integrated alike.
    pub(super) fn bodies(&mut self) {
        let warmed = self.model.steps.iter().flat_map(|step| &step.actions).filter_map(|action| match &action.kind {
            ActionKind::Temperature(target, _) => Some(&target.members),
            _ => None,
        });
        let warmed: BTreeSet<usize> = warmed.flatten().copied().collect();
        for (body, formulation) in self.sorted_bodies() {
            let material = &self.model.materials[body.material];
            let mut text = format!("\n[body.{}]\nmaterial = {}\n", quoted(&body.group), quoted(&body.law));
            text += formulation.keys();
            if let Some(name) = &body.cylinder {
                text += &self.cylinder(name);
            }
            if self.small(material) {
                text += "strain = \"small\"\n";
            }
            let mut nodes = body.elements.iter().flat_map(|&element| &self.model.elements[element].nodes);
            if let Some(expansion) = material.expansion.filter(|_| nodes.any(|node| warmed.contains(node))) {
                text += &format!("expansion = {expansion:?}\n");
            }
            self.text += &text;
        }
    }

    /// All bodies with their formulations; remarks on those that change.
    pub(super) fn sorted_bodies(&mut self) -> Vec<(Body, Formulation)> {
        let model = self.model;
        let mut sorted: BTreeMap<(usize, Formulation, Vec<usize>), Vec<usize>> = BTreeMap::new();
        let changes: Vec<&Target> = changes(model).map(|(target, ..)| target).collect();
        for (at, element) in model.elements.iter().enumerate() {
            let Some(section) = self.section[at] else { continue };
            let (formulation, remark) = element.kind.formulation(&element.variant, model.dialect);
            if let Some(remark) = remark {
                let (name, variant) = (element.kind.name, &element.variant);
                self.note(model.sections[section].place, format!("{name}{variant}: {remark}"));
            }
            // What comes and goes with steps is a body of its own.
            let change = |target: &&Target| target.members.binary_search(&at).is_ok();
            let changed = (0..changes.len()).filter(|&number| change(&changes[number])).collect();
            sorted.entry((section, formulation, changed)).or_default().push(at);
        }
        let body = |((number, formulation, changed), elements): ((usize, Formulation, Vec<usize>), Vec<usize>)| {
            let section = &model.sections[number];
            let name = match (elements.len() == section.elements.len(), changed.first()) {
                (true, _) => section.set.clone(),
                (false, Some(&change)) => changes[change].name.clone(),
                (false, None) => format!("{}.{}", section.set, model.elements[elements[0]].kind.name),
            };
            let group = self.groups.cells(&name, elements.clone());
            let law = named(&model.materials[section.material], axes(model, section));
            let cylinder = oriented(model, section)
                .filter(|name| matches!(model.orientations.get(*name), Some(Orientation::Cylinder { .. })));
            (Body { group, elements, material: section.material, law, cylinder: cylinder.cloned() }, formulation)
        };
        sorted.into_iter().map(body).collect()
    }

    /// The bodies that a step ends, and those that are there again.
    pub(super) fn changed_bodies(&mut self, step: usize) -> [Vec<String>; 2] {
        let (model, mut changed) = (self.model, [vec![], vec![]]);
        if changes(model).next().is_none() {
            return changed;
        }
        let bodies = self.sorted_bodies();
        for (target, add, _, place) in changes(model).filter(|(_, _, number, _)| *number == step) {
            let within = |body: &Body| target.members.binary_search(&body.elements[0]).is_ok();
            let names: Vec<String> =
                bodies.iter().filter(|(body, _)| within(body)).map(|(body, _)| quoted(&body.group)).collect();
            if names.is_empty() {
                self.error(place, format!("'{}' has no element of a body", target.name));
            }
            changed[usize::from(add)].extend(names);
        }
        changed
    }
}

/// The elements that steps take away and bring back, whether they come back, the number of the step and the place.
fn changes(model: &Model) -> impl Iterator<Item = (&Target, bool, usize, InputPlace)> {
    let steps = model.steps.iter().enumerate();
    let all = steps.flat_map(|(number, step)| step.actions.iter().map(move |action| (number, action)));
    all.filter_map(|(number, action)| match &action.kind {
        ActionKind::Elements(target, add) => Some((target, *add, number, action.place)),
        _ => None,
    })
}

/// The axes of a section whose material has some.
fn oriented<'m>(model: &'m Model, section: &'m Section) -> Option<&'m String> {
    let material = &model.materials[section.material];
    section.orientation.as_ref().filter(|_| material.potential.is_some() || material.stiffness.is_some())
}

/// Those that are the same everywhere, and belong to the law.
fn axes<'m>(model: &'m Model, section: &'m Section) -> Option<&'m String> {
    let straight = |name: &&String| matches!(model.orientations.get(*name), Some(Orientation::Straight(_)));
    oriented(model, section).filter(straight)
}

/// Laws of CalculiX that are called as those of users are.
const BUILT_IN: &[&str] = &[
    "ANISO_PLAS",
    "ANISO_CREEP",
    "CIARLET_EL",
    "COMPRESSION_ONLY",
    "ELASTIC_FIBER",
    "HONEYCOMB_",
    "IDEAL_GAS",
    "LIN_ISO_EL",
    "MOHR_COULOMB",
    "SINGLE_CRYSTAL",
    "TENSION_ONLY",
    "UNDO_",
];

const CONSTANTS: &[&str] =
    &["young_1", "young_2", "young_3", "poisson_12", "poisson_13", "poisson_23", "shear_12", "shear_13", "shear_23"];

const COEFFICIENTS: &[&str] = &[
    "c1111", "c1122", "c2222", "c1133", "c2233", "c3333", "c1112", "c2212", "c3312", "c1212", "c1113", "c2213",
    "c3313", "c1213", "c1313", "c1123", "c2223", "c3323", "c1223", "c1323", "c2323",
];

/// The name of a material along axes.
fn named(material: &Material, axes: Option<&String>) -> String {
    axes.map_or_else(|| material.name.clone(), |axes| format!("{}.{axes}", material.name))
}
