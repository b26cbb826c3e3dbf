//! Loads and springs: each group's conditions of one kind over all steps make one term with its timelines.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{Components, Pressure, PressureKind, StepKeys, ToolCondition};
use crate::reader::Name;
use crate::source::Spot;
use asperity_core::amplitude::{Amplitude, Change, Timeline};
use asperity_core::load::{
    FollowerPressure, PenetratingPressure, Springs, TorqueOnTool, body_force, dead_pressure, force_on_nodes,
    force_on_tool, traction,
};
use asperity_core::mesh::Side;
use asperity_core::system::Term;
use std::sync::Arc;

type Terms = Vec<Box<dyn Term>>;

/// The conditions of one kind that a step says.
type Said<T> = fn(&StepKeys) -> &[(Name, T)];

/// Names in the order in which the steps say them first.
fn names<'d, T: 'd>(steps: &'d [StepKeys], said: Said<T>) -> Vec<&'d Name> {
    let mut names: Vec<&Name> = Vec::new();
    for (name, _) in steps.iter().flat_map(said) {
        if !names.iter().any(|known| known.text == name.text) {
            names.push(name);
        }
    }
    names
}

/// The course of one value of a condition over the steps. `value` picks it from what a step says; nothing leaves it as
/// it is.
fn timeline<T>(
    steps: &[StepKeys],
    (kind, name): (&str, &str),
    said: Said<T>,
    value: impl Fn(&T) -> Option<(f64, Amplitude)>,
) -> Timeline {
    let change = |step: &StepKeys| {
        let new = said(step).iter().find(|(other, _)| other.text == name).and_then(|(_, keys)| value(keys));
        match new {
            Some((value, amplitude)) => Change::To(value, amplitude),
            None if step.releases(kind, name) || (kind == "load" && step.ends_load(name)) => Change::Release,
            None => Change::Keep,
        }
    };
    Timeline::new(steps.iter().map(|step| (step.duration, change(step))))
}

impl<'d> Builder<'d> {
    /// All springs.
    pub(super) fn springs(&mut self) -> Option<Terms> {
        let said: Said<_> = |step| &step.spring;
        let mut terms = Terms::new();
        for name in names(&self.deck.step, said) {
            let stiffness = self.vector("spring", name, said, |_| Amplitude::at_once())?;
            let nodes = self.own_nodes(&name.text).to_vec();
            terms.push(Box::new(Springs::new(&format!("spring.{name}"), self.site.dofs.clone(), nodes, stiffness)));
        }
        Some(terms)
    }

    /// All loads.
    pub(super) fn loads(&mut self) -> Option<Terms> {
        let kinds = [
            self.forces(),
            self.pressures(),
            self.tractions(),
            self.body_forces(),
            self.gravities(),
            self.tool_loads(),
        ];
        kinds.into_iter().collect::<Option<Vec<Terms>>>().map(|terms| terms.into_iter().flatten().collect())
    }

    fn forces(&mut self) -> Option<Terms> {
        let said: Said<_> = |step| &step.force;
        let mut terms = Terms::new();
        for name in names(&self.deck.step, said) {
            let components = self.vector("force", name, said, |force| force.amplitude.clone())?;
            let nodes = self.own_nodes(&name.text);
            terms.push(Box::new(force_on_nodes(&format!("force.{name}"), &self.site.dofs, nodes, components)));
        }
        Some(terms)
    }

    fn tractions(&mut self) -> Option<Terms> {
        let said: Said<_> = |step| &step.traction;
        let mut terms = Terms::new();
        for name in names(&self.deck.step, said) {
            let components = self.vector("traction", name, said, |load| load.amplitude.clone())?;
            let load = traction(&format!("traction.{name}"), &self.site, &self.sides(name), components);
            terms.push(Box::new(self.keep(load, name.place)?));
        }
        Some(terms)
    }

    fn body_forces(&mut self) -> Option<Terms> {
        let said: Said<_> = |step| &step.body_force;
        let mut terms = Terms::new();
        for name in names(&self.deck.step, said) {
            let components = self.vector("body_force", name, said, |load| load.amplitude.clone())?;
            let cells = self.site.mesh.groups.get(&name.text).map_or(&[][..], |group| &group.cells);
            terms.push(Box::new(body_force(&format!("body_force.{name}"), &self.site, cells, components)));
        }
        Some(terms)
    }

    /// The weight of every body that has a density.
    fn gravities(&mut self) -> Option<Terms> {
        let (deck, dimension) = (self.deck, self.site.space.dimension());
        let gravity: Vec<_> = deck.step.iter().filter_map(|step| step.gravity.as_ref()).collect();
        let heavy: Vec<_> = deck.body.iter().filter_map(|(name, keys)| Some((name, keys.density?))).collect();
        match (gravity.first(), heavy.first()) {
            (Some(gravity), None) => {
                self.refuse("`gravity` has no use: no body has a `density`", gravity.place);
                return None;
            }
            (None, Some((name, density))) => {
                self.refuse(format!("`body.{name}.density` has no use: no step says `gravity`"), density.place);
                return None;
            }
            _ => {}
        }
        if let Some(z) = gravity.iter().find_map(|gravity| gravity.z).filter(|_| self.plane()) {
            self.refuse("`gravity` has a component along z, but the model is plane", z.place);
            return None;
        }
        let term = |(name, density): (&Name, Spot<f64>)| {
            let weight = |axis: usize| {
                let change = |step: &StepKeys| {
                    let said = step.gravity.as_ref().and_then(|g| Some((g.components()[axis]?, g.amplitude.clone())));
                    said.map_or(Change::Keep, |(value, amplitude)| Change::To(value * density.value, amplitude))
                };
                Timeline::new(deck.step.iter().map(|step| (step.duration, change(step))))
            };
            let cells = self.site.mesh.groups.get(&name.text).map_or(&[][..], |group| &group.cells);
            let components = (0..dimension).map(weight).collect();
            Box::new(body_force(&format!("gravity.{name}"), &self.site, cells, components)) as Box<dyn Term>
        };
        Some(heavy.into_iter().map(term).collect())
    }

    fn pressures(&mut self) -> Option<Terms> {
        let said: Said<_> = |step| &step.pressure;
        let mut terms = Terms::new();
        for name in names(&self.deck.step, said) {
            let Pressure { kind, penetrates: false, .. } = *self.pressure_of(name)? else { continue };
            let value = self.pressure_value(name);
            let (title, sides) = (format!("pressure.{name}"), self.sides(name));
            let term: Result<Box<dyn Term>, _> = match kind {
                PressureKind::Follower => {
                    FollowerPressure::new(&title, self.site.clone(), &sides, value).map(|load| Box::new(load) as _)
                }
                PressureKind::Dead => dead_pressure(&title, &self.site, &sides, value).map(|load| Box::new(load) as _),
            };
            terms.push(self.keep(term, name.place)?);
        }
        Some(terms)
    }

    /// Pressures of fluids that enter between surfaces.
    pub(super) fn fluids(&mut self) -> Option<Vec<Arc<PenetratingPressure>>> {
        let mut fluids = Vec::new();
        for name in names(&self.deck.step, |step| &step.pressure) {
            let first = self.pressure_of(name)?;
            if !first.penetrates {
                continue;
            }
            self.check_fluid(name);
            let from = first.from.as_ref();
            let (title, value, sides) = (format!("pressure.{name}"), self.pressure_value(name), self.sides(name));
            let (source, bearing) = (from.map(|from| self.nodes(&from.text).to_vec()), self.bearing.clone());
            let fluid =
                PenetratingPressure::new(&title, self.site.clone(), (&sides, source.as_deref()), value, bearing);
            fluids.push(Arc::new(self.keep(fluid, from.unwrap_or(name).place)?));
        }
        Some(fluids)
    }

    /// A fluid enters between surfaces that touch, and presses on both where both are of bodies.
    fn check_fluid(&mut self, name: &Name) {
        let (deck, wet) = (self.deck, self.sides(name));
        let in_fluid = |side: &Side| wet.contains(side);
        let tool = |keys: &Name| deck.tool.iter().any(|(tool, _)| tool.text == keys.text);
        let of_bodies = |keys: &crate::keys::Contact| {
            let target = (!tool(&keys.target)).then_some(&keys.target);
            std::iter::once(&keys.surface).chain(target).cloned().collect::<Vec<_>>()
        };
        let touching = deck.contact.iter().map(|(_, keys)| of_bodies(keys));
        let touching: Vec<Vec<Name>> =
            touching.filter(|sides| sides.iter().any(|side| self.sides(side).iter().any(in_fluid))).collect();
        if touching.is_empty() {
            let what = format!("`pressure.{name}` penetrates, but none of its sides is in a contact");
            let help =
                "a fluid enters where contact bears less than it: name sides that touch, or leave `penetrates` out";
            self.found.push(Diagnostic::error(what).at(name.place).help(help));
        }
        let said = deck.step.iter().flat_map(|step| &step.pressure);
        let fluids: Vec<&Name> = said.filter(|(_, pressure)| pressure.penetrates).map(|(name, _)| name).collect();
        let all: Vec<Side> = fluids.iter().flat_map(|name| self.sides(name)).collect();
        let dry = |side: &&Name| !self.sides(side).iter().any(|side| all.contains(side));
        let dry: Vec<Name> = touching.iter().flatten().filter(dry).cloned().collect();
        for side in dry {
            let what = format!("the fluid of `pressure.{name}` enters, but does not press on `{side}` opposite");
            let help = format!("say `pressure.{side}` with `penetrates = true` as well");
            if self.found.iter().all(|found| found.what != what) {
                self.found.push(Diagnostic::warning(what).at(name.place).help(help));
            }
        }
    }

    fn pressure_value(&self, name: &Name) -> Timeline {
        let said: Said<_> = |step| &step.pressure;
        timeline(&self.deck.step, ("pressure", &name.text), said, |p| Some((p.value, p.amplitude.clone())))
    }

    /// What is said of a pressure first; what kind it is all steps must say alike.
    fn pressure_of(&mut self, name: &Name) -> Option<&'d Pressure> {
        let deck = self.deck;
        let said = deck.step.iter().flat_map(|step| &step.pressure).filter(|(other, _)| other.text == name.text);
        let said: Vec<_> = said.collect();
        let (_, first) = *said.first()?;
        let from = |pressure: &Pressure| pressure.from.as_ref().map(|from| from.text.clone());
        let kind = |pressure: &Pressure| (pressure.kind, pressure.penetrates, from(pressure));
        let other = |pressure: &Pressure| kind(pressure) != kind(first);
        if let Some((other, _)) = said.iter().find(|(_, pressure)| other(pressure)) {
            let what = format!(
                "the pressure on `{name}` cannot change its kind: follower, dead, or of a fluid from one place"
            );
            let help = "say one kind in all steps, or lay the other on a group of its own";
            self.found.push(Diagnostic::error(what).at(other.place).help(help));
            return None;
        }
        Some(first)
    }

    fn tool_loads(&mut self) -> Option<Terms> {
        let said: Said<_> = |step| &step.load;
        let mut terms = Terms::new();
        for name in names(&self.deck.step, said) {
            let (plane, title) = (self.plane(), format!("load.{name}"));
            let values = (0..if plane { 3 } else { 6 }).map(|i| {
                timeline(&self.deck.step, ("load", &name.text), said, |load| {
                    let value = if plane { load.plane()[i] } else { load.space()[i] };
                    Some((value?, load.amplitude.clone()))
                })
            });
            let mut values: Vec<Timeline> = values.collect();
            if self.distributing(name).is_some() {
                terms.push(self.distributed(&title, name, values)?);
                continue;
            }
            let tool = self.leader(&name.text)?;
            if !plane {
                let torques = values.split_off(3);
                terms.push(Box::new(TorqueOnTool::new(&title, &self.site.dofs, tool, torques)));
            }
            terms.push(Box::new(force_on_tool(&title, &self.site.dofs, tool, values)));
        }
        Some(terms)
    }

    pub(super) fn sides(&self, name: &Name) -> Vec<Side> {
        self.site.mesh.groups.get(&name.text).map_or_else(Vec::new, |group| group.sides.clone())
    }

    /// A timeline for each component along the axes; a z in the plane is refused.
    fn vector<T: Components>(
        &mut self,
        kind: &str,
        name: &Name,
        said: Said<T>,
        amplitude: fn(&T) -> Amplitude,
    ) -> Option<Vec<Timeline>> {
        let steps = &self.deck.step;
        let flat = steps.iter().flat_map(said).find(|(other, keys)| other.text == name.text && keys.z().is_some());
        if let Some(z) = flat.and_then(|(_, keys)| keys.z()).filter(|_| self.plane()) {
            let what = format!("`{kind}.{name}` has a component along z, but the model is plane");
            self.found.push(Diagnostic::error(what).at(z.place).help("remove `z`"));
            return None;
        }
        let component = |axis: usize| {
            timeline(steps, (kind, &name.text), said, |keys| Some((keys.components()[axis]?, amplitude(keys))))
        };
        Some((0..self.site.space.dimension()).map(component).collect())
    }
}
