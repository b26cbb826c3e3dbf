//! Temperatures above those at the beginning: one for a body whose nodes all have the same, else that of each node.

use super::conditions::{Table, changes};
use super::courses::{Item, Record};
use super::groups::shifts;
use super::{Writer, list, quoted};
use crate::model::{ActionKind, Condition};
use std::collections::BTreeMap;

/// Pairs of a node and its temperature on a line.
const PAIRS: usize = 6;

/// What the steps say of temperatures.
pub struct Temperatures {
    /// Of bodies.
    pub bodies: Table,
    /// Lines of each step with those of nodes.
    pub nodes: Vec<Vec<String>>,
}

/// The nodes that go with the same factors to temperatures of their own.
type Together = BTreeMap<Vec<u64>, Vec<(usize, Item)>>;

impl Writer<'_> {
    /// All temperatures of bodies that expand.
    pub(super) fn temperatures(&mut self) -> Temperatures {
        let model = self.model;
        let steps = self.temperatures_of_nodes();
        let mut all = Temperatures { bodies: vec![BTreeMap::new(); steps.len()], nodes: vec![vec![]; steps.len()] };
        if steps.iter().all(BTreeMap::is_empty) {
            return all;
        }
        let bodies: Vec<_> = self.sorted_bodies().into_iter().map(|(body, _)| body).collect();
        for body in bodies.iter().filter(|body| model.materials[body.material].expansion.is_some()) {
            let mut nodes: Vec<usize> =
                body.elements.iter().flat_map(|&element| model.elements[element].nodes.iter().copied()).collect();
            nodes.sort_unstable();
            nodes.dedup();
            let of = |step: &BTreeMap<usize, Item>, node: usize| step.get(&node).map(bits);
            let alike = |step: &BTreeMap<usize, Item>| nodes.iter().all(|&node| of(step, node) == of(step, nodes[0]));
            let uniform = steps.iter().all(alike);
            for (number, step) in steps.iter().enumerate() {
                if uniform {
                    all.bodies[number].extend(step.get(&nodes[0]).map(|item| ((body.group.clone(), 0), item.clone())));
                    continue;
                }
                let before = |node: &usize| number.checked_sub(1).and_then(|before| steps[before].get(node));
                let mut together = Together::new();
                for node in &nodes {
                    let Some(item) = step.get(node).filter(|item| changes(item, before(node))) else { continue };
                    let factors = item.factors().1.into_iter().flatten().flatten().map(f64::to_bits).collect();
                    together.entry(factors).or_default().push((*node, item.clone()));
                }
                for of_nodes in together.into_values() {
                    let line = self.line_of_nodes((&body.group, nodes.len()), &of_nodes);
                    // Two bodies may share all of these nodes.
                    if !all.nodes[number].contains(&line) {
                        all.nodes[number].push(line);
                    }
                }
            }
        }
        all
    }

    /// The line of a step with temperatures of nodes.
    fn line_of_nodes(&mut self, (body, count): (&str, usize), nodes: &[(usize, Item)]) -> String {
        let model = self.model;
        let shift = shifts(model, |scope| &scope.nodes);
        let group = match nodes.len() == count {
            true => body.to_string(),
            false => self.groups.nodes(&format!("{body}.temperature"), nodes.iter().map(|(node, _)| *node).collect()),
        };
        let pair = |(node, item): &(usize, Item)| {
            let found = &model.nodes[*node];
            format!("[{}, {:?}]", found.label + shift[found.scope], item.factors().0)
        };
        let first = nodes.first().map_or(0.0, |(_, item)| item.factors().0);
        let values = match nodes.iter().all(|(_, item)| item.factors().0 == first) {
            true => format!("value = {first:?}"),
            false => {
                let pairs: Vec<String> = nodes.iter().map(pair).collect();
                let rows: Vec<String> = pairs.chunks(PAIRS).map(|row| row.join(", ")).collect();
                format!("nodes = [\n    {}\n]", rows.join(",\n    "))
            }
        };
        let amplitude = nodes.iter().find_map(|(_, item)| item.factors().1).map_or(String::new(), |factors| {
            let pairs: Vec<String> = factors.iter().map(|pair| list(pair)).collect();
            format!(", amplitude = [{}]", pairs.join(", "))
        });
        let from = nodes.first().map_or(String::new(), |(_, item)| self.from(item.place));
        format!("temperature.{} = {{ {values}{amplitude} }}{from}\n", quoted(&group))
    }

    /// The temperature of each node in each step, above that at the beginning, from the first step on that says one.
    fn temperatures_of_nodes(&mut self) -> Vec<BTreeMap<usize, Item>> {
        let model = self.model;
        let mut owners: BTreeMap<usize, usize> = BTreeMap::new();
        let (mut records, mut steps) = (Vec::<Record>::new(), Vec::<BTreeMap<usize, Item>>::new());
        for number in 0..model.steps.len() {
            for action in model.actions(number) {
                match &action.kind {
                    ActionKind::Fresh(Condition::Temperature) => owners.clear(),
                    ActionKind::Temperature(target, value) => {
                        let (name, course, place) = (target.name.clone(), action.course, action.place);
                        records.push(Record { name, value: *value, course, place, step: number, reached: 0.0 });
                        owners.extend(target.members.iter().map(|&node| (node, records.len() - 1)));
                    }
                    _ => {}
                }
            }
            let mut now = BTreeMap::new();
            let before = steps.last();
            for (&node, &record) in &owners {
                let free = model.initial_temperature.get(&node).copied().unwrap_or(0.0);
                let (end, course) = self.followed(&records[record], number);
                let course = course.map(|points| points.iter().map(|[t, v]| [*t, v - free]).collect());
                let start = Some(before.and_then(|before| before.get(&node)).map_or(0.0, |item| item.end));
                now.insert(node, Item { end: end - free, start, course, place: records[record].place });
            }
            // Those that no line holds any more go back to the beginning.
            for (node, item) in before.into_iter().flatten() {
                let back = Item { end: 0.0, start: Some(item.end), course: None, place: item.place };
                now.entry(*node).or_insert(back);
            }
            steps.push(now);
            self.reach(&mut records, number);
        }
        steps
    }
}

/// What tells items apart.
fn bits(item: &Item) -> (u64, Vec<u64>) {
    (item.end.to_bits(), item.course.iter().flatten().flatten().map(|value| value.to_bits()).collect())
}
