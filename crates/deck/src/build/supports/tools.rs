//! What leads the tools and rigid groups in each step: motions, loads, and what is let go.

use super::claim::{Claim, Claims, What};
use crate::build::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{StepKeys, ToolCondition};
use crate::reader::Name;
use asperity_core::amplitude::Amplitude;
use asperity_core::solve::Course;

impl Builder<'_> {
    /// The steps before one.
    fn before(&self, step: &StepKeys) -> impl DoubleEndedIterator<Item = &StepKeys> {
        let number = self.deck.step.iter().position(|other| std::ptr::eq(other, step)).unwrap_or(0);
        self.deck.step[..number].iter()
    }

    pub(super) fn release(&self, step: &StepKeys, claims: &mut Claims) {
        claims.retain(|(by, _), _| by.is_empty() || by.starts_with("motion.") || !step.releases_path(by));
        // A tool that is released from its motion is free along it.
        for name in self.leaders().filter(|name| step.releases("motion", &name.text)) {
            let motions = self.before(step).flat_map(|step| &step.motion).filter(|(other, _)| other.text == name.text);
            for (_, keys) in motions {
                let moved = if self.plane() { keys.plane().to_vec() } else { keys.space().to_vec() };
                for (i, _) in moved.iter().enumerate().filter(|(_, value)| value.is_some()) {
                    claims.remove(&(format!("motion.{name}"), i));
                }
            }
        }
        // A tool that is released from a load, or removed, is held again.
        for (tool, name) in self.leaders().enumerate() {
            if step.ends_load(&name.text) {
                self.hold_tool(tool, name, claims);
            }
        }
    }

    pub(super) fn hold_tool(&self, tool: usize, name: &Name, claims: &mut Claims) {
        for i in 0..self.site.dofs.per_tool() {
            let (by, dof) = (format!("motion.{name}"), self.site.dofs.tool(tool) + i);
            let claim =
                || vec![Claim { by: by.clone(), place: name.place, what: What::Unknown(dof), course: Course::Hold }];
            claims.entry((by.clone(), i)).or_insert_with(claim);
        }
    }

    /// What a condition says of each unknown of a tool; keys of the other kind of space are refused.
    pub(super) fn of_tool(&mut self, kind: &str, name: &Name, keys: &impl ToolCondition) -> Vec<Option<f64>> {
        let (space, plane) = keys.foreign();
        let (foreign, help): (&[_], _) = match self.plane() {
            true => (&space, "remove it: the model is plane"),
            false => (&[plane], "say it by its components `_x`, `_y`, `_z`: the model is in space"),
        };
        for (key, spot) in foreign {
            if let Some(spot) = spot {
                let what = format!("`{kind}.{name}` cannot say `{key}` where space = \"{}\"", self.site.space.name());
                self.found.push(Diagnostic::error(what).at(spot.place).help(help));
            }
        }
        if self.plane() { keys.plane().to_vec() } else { keys.space().to_vec() }
    }

    /// Whether an earlier step loads a tool along one of its unknowns, and nothing has ended that.
    fn is_loaded(&self, step: &StepKeys, name: &Name, i: usize) -> bool {
        let loads = |step: &StepKeys| {
            let said = step.load.iter().find(|(other, _)| other.text == name.text);
            said.is_some_and(|(_, keys)| if self.plane() { keys.plane()[i] } else { keys.space()[i] }.is_some())
        };
        let moves = |step: &StepKeys| {
            let said = step.motion.iter().find(|(other, _)| other.text == name.text);
            said.is_some_and(|(_, keys)| if self.plane() { keys.plane()[i] } else { keys.space()[i] }.is_some())
        };
        if step.ends_load(&name.text) {
            return false;
        }
        self.before(step).rev().find_map(|step| match () {
            () if loads(step) => Some(true),
            () if step.ends_load(&name.text) || moves(step) => Some(false),
            () => None,
        }) == Some(true)
    }

    pub(super) fn move_tool(
        &mut self,
        (step, name): (&StepKeys, &Name),
        to: &[Option<f64>],
        amplitude: &Amplitude,
        claims: &mut Claims,
    ) {
        let Some(tool) = self.leader(&name.text) else { return };
        let by = format!("motion.{name}");
        for (i, value) in to.iter().enumerate().filter_map(|(i, value)| Some((i, (*value)?))) {
            let what = What::Unknown(self.site.dofs.tool(tool) + i);
            let course = Course::To(value, amplitude.clone());
            let claim = Claim { by: by.clone(), place: name.place, what, course };
            claims.insert((by.clone(), i), vec![claim]);
            if self.is_loaded(step, name, i) {
                let what = format!("tool `{name}` is moved along what an earlier step loads");
                self.found.push(
                    Diagnostic::error(what)
                        .at(name.place)
                        .help(format!("release it in this step: release = [\"load.{name}\"]")),
                );
            }
        }
    }
}
