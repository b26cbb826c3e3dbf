//! Steps.

use super::conditions::{Kind, Said, Table};
use super::courses::Item;
use super::{Writer, quoted};
use crate::model::{ActionKind, Step};
use std::collections::BTreeMap;

const AXES: &[&str] = &["x", "y", "z"];
const PLANE_MOTION: &[&str] = &["x", "y", "", "", "", "rotation"];
const SPACE_MOTION: &[&str] = &["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"];
const PLANE_LOAD: &[&str] = &["x", "y", "", "", "", "torque"];
const SPACE_LOAD: &[&str] = &["x", "y", "z", "torque_x", "torque_y", "torque_z"];

impl Writer<'_> {
    /// All steps.
    pub(super) fn steps(&mut self) {
        let model = self.model;
        let (supports, loads) = (self.supports(), self.loads());
        let plane = self.dimension() == 2;
        let (motion, tool_loads) = self.tool_conditions(supports.motion, &loads.tool);
        let large = model.steps.iter().any(|step| step.large);
        let group = |key, components, more| Kind { key, components, more, of_group: true };
        let tool = |key, components| Kind { key, components, more: "", of_group: false };
        let pressure = if large { "kind = \"follower\"" } else { "kind = \"dead\"" };
        let said: Vec<Vec<Said>> = [
            (group("displacement", AXES, ""), &supports.displacement),
            (tool("motion", if plane { PLANE_MOTION } else { SPACE_MOTION }), &motion),
            (group("force", AXES, ""), &loads.force),
            (tool("load", if plane { PLANE_LOAD } else { SPACE_LOAD }), &tool_loads),
            (group("pressure", &["value"], pressure), &loads.pressure),
            (group("body_force", AXES, ""), &loads.body_force),
            (group("temperature", &["value"], ""), &loads.temperature.bodies),
        ]
        .into_iter()
        .map(|(kind, table)| self.said(&kind, table))
        .collect();
        let mut names = Vec::<String>::new();
        for (number, step) in model.steps.iter().enumerate() {
            let mut name = step.name.clone();
            if names.contains(&name) {
                name = format!("{name} ({})", number + 1);
            }
            names.push(name.clone());
            let from = self.from(step.place);
            let mut text = format!("\n[[step]]{from}\nname = {}\nduration = {:?}\n", quoted(&name), step.duration);
            text += &increments(step);
            text += &self.path(number, step);
            let released: Vec<String> =
                said.iter().flat_map(|kind| &kind[number].released).map(|name| quoted(name)).collect();
            if !released.is_empty() {
                text += &format!("release = [{}]\n", released.join(", "));
            }
            let (contacts, bodies) = (self.changed_contacts(number), self.changed_bodies(number));
            for (key, names) in
                ["remove", "add"].iter().zip(contacts.iter().zip(&bodies).map(|(a, b)| [&a[..], b].concat()))
            {
                if !names.is_empty() {
                    text += &format!("{key} = [{}]\n", names.join(", "));
                }
            }
            text.extend(self.changed_frictions(number));
            text.extend(said.iter().flat_map(|kind| kind[number].lines.clone()));
            text.extend(loads.temperature.nodes[number].iter().map(String::as_str));
            self.text += &text;
            if released.iter().any(|name| name.starts_with("\"displacement.")) {
                self.note(
                    step.place,
                    "what is no longer held is let go little by little over the step; CalculiX lets go of it at the beginning",
                );
            }
            if number > 0 && step.large && !model.steps[number - 1].large {
                self.note(step.place, "strains are large from the first step on, since they are here");
            }
        }
    }

    /// The keys of a step that follows a path, in which everything goes with the load factor.
    fn path(&mut self, number: usize, step: &Step) -> String {
        let (Some(path), model) = (&step.path, self.model) else { return String::new() };
        for action in model.actions(number) {
            let what = match &action.kind {
                _ if action.course.is_some() => "an AMPLITUDE",
                ActionKind::Temperature(..) => "a *TEMPERATURE",
                ActionKind::Friction(..) => "a *CHANGE FRICTION",
                ActionKind::Contact(..) | ActionKind::Elements(..) => "a *MODEL CHANGE",
                _ => continue,
            };
            let text = format!(
                "{what} in a step of *STATIC, RIKS, in which loads go with the load factor: put it into another step"
            );
            self.error(action.place, text);
        }
        let mut text = String::from("control = \"arc-length\"\n");
        if let Some((target, axis, value)) = &path.until
            && *axis < self.dimension()
        {
            let group = self.groups.nodes(&target.name, target.members.clone());
            text += &format!("until = {{ group = {}, {} = {value:?} }}\n", quoted(&group), AXES[*axis]);
        }
        text
    }

    /// Motions in degrees, and loads along what is not led: a reference node is free where nothing holds it.
    fn tool_conditions(&mut self, led: Table, forces: &Table) -> (Table, Table) {
        let axes: &[usize] = if self.dimension() == 2 { &[0, 1, 5] } else { &[0, 1, 2, 3, 4, 5] };
        let (model, mut loads, mut held) = (self.model, Table::new(), Vec::new());
        for (step, led) in led.iter().enumerate() {
            let mut row = BTreeMap::new();
            for tool in &self.tools {
                for &axis in axes {
                    let key = (tool.name.clone(), axis);
                    let free = Item { end: 0.0, start: Some(0.0), course: None, place: tool.place };
                    let force = forces.get(step).and_then(|row| row.get(&key)).cloned();
                    match (led.get(&key), model.rigid[tool.rigid].distributing) {
                        (Some(item), true) => held.push(item.place),
                        (None, true) => row.extend(force.map(|force| (key, force))),
                        (None, false) => drop(row.insert(key, force.unwrap_or(free))),
                        (Some(_), false) => {}
                    }
                }
            }
            loads.push(row);
        }
        for place in held {
            let what = "the node of a distributing coupling carries forces and moments only; hold or lead nodes of the surface";
            self.error(place, what);
        }
        let turned = |(key, item): ((String, usize), Item)| {
            let factor = if key.1 < 3 { 1.0 } else { 180.0 / std::f64::consts::PI };
            let course = item.course.map(|points| points.iter().map(|[t, v]| [*t, v * factor]).collect());
            (
                key,
                Item {
                    end: item.end * factor,
                    start: item.start.map(|start| start * factor),
                    course,
                    place: item.place,
                },
            )
        };
        let kept = |key: &(String, usize)| axes.contains(&key.1);
        let motion = led.into_iter().map(|row| row.into_iter().filter(|(key, _)| kept(key)).map(turned).collect());
        (motion.collect(), loads)
    }
}

/// The increments of a step: fractions of it in place of times.
fn increments(step: &Step) -> String {
    let [first, least, largest] = step.increments.map(|time| time.map(|time| (time / step.duration).min(1.0)));
    let first = first.unwrap_or(1.0);
    if step.direct {
        return format!("increments = {{ count = {} }}\n", (1.0 / first).round().clamp(1.0, 1e7));
    }
    let largest = largest.unwrap_or(1.0).max(first);
    let smallest = least.unwrap_or(1e-5).min(1e-5).clamp(1e-12, first);
    // A path is often left at its last increment.
    let most = step.most.filter(|_| step.path.is_some()).map_or(String::new(), |most| format!(", most = {most}"));
    format!("increments = {{ first = {first:?}, largest = {largest:?}, smallest = {smallest:?}{most} }}\n")
}
