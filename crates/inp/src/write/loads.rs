//! Loads and temperatures, step by step.

use super::Writer;
use super::adjust::nodes_of;
use super::conditions::Table;
use super::courses::{Item, Record};
use super::temperatures::Temperatures;
use super::turned::PARALLEL;
use crate::model::{Action, ActionKind, Condition, Target};
use crate::read::along;
use std::collections::BTreeMap;

/// Loads of each kind.
pub struct Loads {
    /// On nodes.
    pub force: Table,
    /// On tools, by axis from 0 to 5.
    pub tool: Table,
    /// On sides.
    pub pressure: Table,
    /// On cells.
    pub body_force: Table,
    /// Of bodies and nodes.
    pub temperature: Temperatures,
}

/// A step's values by name and component.
type Row = BTreeMap<(String, usize), Item>;

impl Writer<'_> {
    /// All loads.
    pub(super) fn loads(&mut self) -> Loads {
        let forces = self.forces();
        let (pressure, body_force) = self.distributed();
        Loads { force: forces.0, tool: forces.1, pressure, body_force, temperature: self.temperatures() }
    }

    /// Forces: within a step they add up, a later step replaces those at the same node and axis.
    fn forces(&mut self) -> (Table, Table) {
        let model = self.model;
        let mut owners: BTreeMap<(usize, usize), Vec<usize>> = BTreeMap::new();
        let mut records: Vec<Record> = Vec::new();
        let (mut on_nodes, mut on_tools) = (Table::new(), Table::new());
        for number in 0..model.steps.len() {
            for action in model.actions(number) {
                match &action.kind {
                    ActionKind::Fresh(Condition::Force) => owners.clear(),
                    ActionKind::Force(target, axis, value) => {
                        records.push(record(target, *value, action, number));
                        for &node in &target.members {
                            let owner = owners.entry((node, *axis)).or_default();
                            owner.retain(|&other| records[other].step == number);
                            owner.push(records.len() - 1);
                        }
                    }
                    _ => {}
                }
            }
            let mut pieces: BTreeMap<(usize, usize, u64), Vec<usize>> = BTreeMap::new();
            let (mut tools, mut idle) = (Row::new(), BTreeMap::<usize, usize>::new());
            for ((node, axis), owner) in &owners {
                for &record in owner {
                    let (end, course) = self.followed(&records[record], number);
                    let place = records[record].place;
                    if let Some(led) = self.led_tool(*node, *axis) {
                        add(&mut tools, led, Item { end, start: None, course, place });
                    } else if self.held.get(number).is_some_and(|held| held.contains(&(*node, *axis))) {
                        *idle.entry(record).or_insert(0) += 1;
                    } else if self.used[*node] && *axis < self.dimension() {
                        let parts = along(model.frames.get(node), *axis);
                        for at in (0..self.dimension()).filter(|&at| parts[at].abs() > PARALLEL) {
                            pieces.entry((record, at, parts[at].to_bits())).or_default().push(*node);
                        }
                    } else if !self.used[*node] && !model.rigid.iter().any(|rigid| rigid.node == *node) {
                        self.error(place, format!("'{}' loads nodes of no body", records[record].name));
                    } else if self.used[*node] && end != 0.0 {
                        self.error(place, "nodes of bodies bear no moments; lay a pressure or forces on several nodes");
                    }
                }
            }
            for (record, count) in idle {
                let what = format!(
                    "forces on {count} nodes that are held along their direction are left out: they move nothing"
                );
                self.note(records[record].place, what);
            }
            let mut row = Row::new();
            for ((record, axis, factor), nodes) in pieces {
                let (end, course) = self.followed(&records[record], number);
                let group = self.groups.nodes(&records[record].name, nodes);
                let item = Item { end, start: None, course, place: records[record].place };
                let item = item.scaled(f64::from_bits(factor));
                self.lay(&mut row, group, axis, item);
            }
            begin(&mut row, on_nodes.last());
            begin(&mut tools, on_tools.last());
            on_nodes.push(row);
            on_tools.push(tools);
            self.reach(&mut records, number);
        }
        (on_nodes, on_tools)
    }

    /// Lays a value on a group; a second one of the same step adds up, under another name where its course differs.
    fn lay(&mut self, row: &mut Row, group: String, component: usize, item: Item) {
        let key = (group, component);
        match row.get(&key) {
            Some(there) if there.course.is_some() || item.course.is_some() => {
                let other = self.groups.again(&key.0, "more");
                row.insert((other, component), item);
            }
            _ => add(row, key, item),
        }
    }

    pub(super) fn reach(&self, records: &mut [Record], step: usize) {
        let reached: Vec<f64> = records.iter().map(|record| self.followed(record, step).0).collect();
        records.iter_mut().zip(reached).for_each(|(record, reached)| record.reached = reached);
    }

    /// Pressures and forces per volume; a later line of the same name and label replaces the earlier one.
    fn distributed(&mut self) -> (Table, Table) {
        let model = self.model;
        let mut standing: BTreeMap<(String, bool), (Record, &ActionKind)> = BTreeMap::new();
        let (mut pressures, mut volumes) = (Table::new(), Table::new());
        for number in 0..model.steps.len() {
            for action in model.actions(number) {
                match &action.kind {
                    ActionKind::Fresh(Condition::Distributed) => standing.clear(),
                    ActionKind::Pressure(target, _, value) => {
                        let key = (target.name.to_ascii_uppercase(), true);
                        standing.insert(key, (record(target, *value, action, number), &action.kind));
                    }
                    ActionKind::Volume(target, vector, weight) => {
                        let axis = vector.iter().position(|&x| x != 0.0).filter(|_| !*weight);
                        let key = (format!("{} {axis:?}", target.name.to_ascii_uppercase()), false);
                        standing.insert(key, (record(target, 1.0, action, number), &action.kind));
                    }
                    _ => {}
                }
            }
            let (mut pressed, mut heavy) = (Row::new(), Row::new());
            for (record, kind) in standing.values() {
                let (end, course) = self.followed(record, number);
                let item = Item { end, start: None, course, place: record.place };
                match kind {
                    ActionKind::Pressure(_, faces, _) => {
                        let kept: Vec<_> =
                            faces.iter().copied().filter(|(element, _)| self.section[*element].is_some()).collect();
                        if !kept.is_empty() && kept.iter().all(|side| self.is_held(*side, number)) {
                            let what = "this pressure acts on faces all of whose nodes are held, and is left out: it moves nothing";
                            self.note(record.place, what);
                            continue;
                        }
                        let group = self.groups.sides(&record.name, kept);
                        self.lay(&mut pressed, group, 0, item);
                    }
                    ActionKind::Volume(target, vector, weight) => {
                        self.pull(&mut heavy, target, *vector, *weight, &item)
                    }
                    _ => {}
                }
            }
            begin(&mut pressed, pressures.last());
            begin(&mut heavy, volumes.last());
            pressures.push(pressed);
            volumes.push(heavy);
            for (record, _) in standing.values_mut() {
                record.reached = self.followed(record, number).0;
            }
        }
        (pressures, volumes)
    }

    /// Whether all nodes of a face are held or led along all axes in a step.
    fn is_held(&self, (element, face): (usize, Option<usize>), step: usize) -> bool {
        let (Some(face), Some(held)) = (face, self.held.get(step)) else { return false };
        let nodes = nodes_of(&self.model.elements[element], face);
        let is_led = |&node: &usize| (0..self.dimension()).all(|axis| held.contains(&(node, axis)));
        !nodes.is_empty() && nodes.iter().all(is_led)
    }

    /// A force per volume on elements: times their density where it is gravity.
    fn pull(&mut self, row: &mut Row, target: &Target, vector: [f64; 3], weight: bool, item: &Item) {
        let model = self.model;
        let mut parts: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &element in &target.members {
            if let Some(section) = self.section[element] {
                parts.entry(if weight { model.sections[section].material } else { 0 }).or_default().push(element);
            }
        }
        let several = parts.len() > 1;
        for (material, cells) in parts {
            let found = &model.materials[material];
            let density = match (weight, found.density) {
                (false, _) => 1.0,
                (true, Some(density)) => density,
                (true, None) => {
                    self.error(item.place, format!("material '{}' has no *DENSITY, on which gravity acts", found.name));
                    continue;
                }
            };
            let name = if several { format!("{}.{}", target.name, found.name) } else { target.name.clone() };
            let group = self.groups.cells(&name, cells);
            for axis in (0..self.dimension()).filter(|&axis| vector[axis] != 0.0) {
                let factor = density * vector[axis];
                let course = item.course.as_ref().map(|points| points.iter().map(|[t, v]| [*t, v * factor]).collect());
                let part = Item { end: item.end * factor, start: None, course, place: item.place };
                self.lay(row, group.clone(), axis, part);
            }
        }
    }
}

fn record(target: &Target, value: f64, action: &Action, step: usize) -> Record {
    Record { name: target.name.clone(), value, course: action.course, place: action.place, step, reached: 0.0 }
}

/// Adds to what is there.
fn add(row: &mut Row, key: (String, usize), item: Item) {
    match row.get_mut(&key) {
        Some(there) => there.end += item.end,
        None => {
            row.insert(key, item);
        }
    }
}

/// Loads begin at what the step before left, or at nothing.
fn begin(row: &mut Row, before: Option<&Row>) {
    for (key, item) in row.iter_mut() {
        item.start = Some(before.and_then(|before| before.get(key)).map_or(0.0, |item| item.end));
    }
}
