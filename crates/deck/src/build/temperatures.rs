//! Temperatures of bodies: one, or that of each node.

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{StepKeys, TemperatureKeys as Keys};
use crate::reader::Name;
use asperity_core::amplitude::{Change, Timeline};
use asperity_core::solid::Temperature;
use std::collections::{BTreeMap, BTreeSet};

/// What a step says of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Said {
    Nothing,
    Release,
    /// The number of the temperature in its step, and the bits of the value.
    Value(usize, u64),
}

impl Builder<'_> {
    /// The temperature of a body over all steps, if any says it.
    pub(super) fn temperature(&self, body: &str) -> Option<Temperature> {
        let steps = &self.deck.step;
        let values: Vec<Vec<_>> = steps
            .iter()
            .map(|step| step.temperature.iter().map(|(name, keys)| self.warmed(body, name, keys)).collect())
            .collect();
        let named = |(step, values): (&StepKeys, &Vec<BTreeMap<usize, f64>>)| {
            let all = step.temperature.iter().zip(values).filter(|(_, values)| !values.is_empty());
            all.map(|((name, keys), _)| name.text == body && keys.value.is_some()).collect::<Vec<_>>()
        };
        let whole: Vec<bool> = steps.iter().zip(&values).flat_map(named).collect();
        if whole.is_empty() {
            return None;
        }
        let nodes = if whole.contains(&false) { self.nodes(body) } else { &self.nodes(body)[..1] };
        let (mut courses, mut of) = (BTreeMap::<Vec<Said>, usize>::new(), vec![0; self.site.mesh.points.len()]);
        for &node in nodes {
            let next = courses.len();
            of[node] = *courses.entry(course(steps, &values, node)).or_insert(next);
        }
        let mut ordered: Vec<_> = courses.into_iter().collect();
        ordered.sort_by_key(|(_, number)| *number);
        let mut courses: Vec<Timeline> = ordered.iter().map(|(said, _)| timeline(steps, said)).collect();
        match courses.len() {
            1 => courses.pop().map(Temperature::uniform),
            _ => Some(Temperature::of_nodes(courses, of)),
        }
    }

    /// The temperatures that a name says of the nodes of a body: that of a body is not that of another.
    fn warmed(&self, body: &str, name: &Name, keys: &Keys) -> BTreeMap<usize, f64> {
        let other = name.text != body && self.deck.body.iter().any(|(other, _)| other.text == name.text);
        let (own, mesh) = (self.nodes(body), &self.site.mesh);
        let within = |node: &usize| !other && own.binary_search(node).is_ok();
        match keys.value {
            Some(value) => self.nodes(&name.text).iter().copied().filter(within).map(|node| (node, value)).collect(),
            None => {
                let given: BTreeMap<u64, f64> = keys.nodes.iter().map(|pair| (pair[0] as u64, pair[1])).collect();
                let found = |&node: &usize| Some((node, *given.get(&mesh.node_number(node))?));
                let group = self.nodes(&name.text);
                let mut values: BTreeMap<usize, f64> =
                    group.iter().filter(|node| within(node)).filter_map(found).collect();
                // A node in the middle of an edge has the mean of the ends where it is not given.
                for cell in mesh.groups.get(body).into_iter().flat_map(|body| &body.cells).map(|&cell| mesh.cell(cell))
                {
                    for (middle, [a, b]) in cell.kind.middles().filter(|_| cell.kind.degree == 2) {
                        let ends = values.get(&cell.nodes[a]).copied().zip(values.get(&cell.nodes[b]).copied());
                        if let (false, Some((a, b))) = (values.contains_key(&cell.nodes[middle]), ends) {
                            values.insert(cell.nodes[middle], 0.5 * (a + b));
                        }
                    }
                }
                values
            }
        }
    }

    /// A temperature must be that of a body, or of nodes of one that expands, and its nodes those of its group.
    pub(super) fn check_temperatures(&mut self) {
        let deck = self.deck;
        for (name, keys) in deck.step.iter().flat_map(|step| &step.temperature) {
            let known: BTreeSet<u64> =
                self.nodes(&name.text).iter().map(|&node| self.site.mesh.node_number(node)).collect();
            let lost = |number: f64| number.fract() != 0.0 || number < 0.0 || !known.contains(&(number as u64));
            if let Some(lost) = keys.nodes.iter().map(|pair| pair[0]).find(|number| lost(*number)) {
                let what = format!("`temperature.{name}`: there is no node {lost} in `{name}`");
                self.found.push(Diagnostic::error(what).at(keys.place).help("name a group that has all of the nodes"));
            }
            let mut expanding = deck.body.iter().filter(|(_, keys)| keys.expansion.is_some());
            let of_body = deck.body.iter().any(|(body, _)| body.text == name.text);
            if !of_body
                && !known.is_empty()
                && !expanding.any(|(body, _)| !self.warmed(&body.text, name, keys).is_empty())
            {
                let what = format!(
                    "`temperature.{name}` has no use: no body of its nodes has an `expansion` (which may be 0)"
                );
                self.refuse(what, name.place);
            }
        }
    }
}

/// What the steps say of a node; of several names in a step the last holds.
fn course<'s>(steps: &'s [StepKeys], values: &[Vec<BTreeMap<usize, f64>>], node: usize) -> Vec<Said> {
    let mut owner: Option<&str> = None;
    let said = |(step, values): (&'s StepKeys, &Vec<BTreeMap<usize, f64>>)| {
        let last = values.iter().enumerate().rev().find_map(|(number, values)| Some((number, values.get(&node)?)));
        if let Some((number, value)) = last {
            owner = Some(step.temperature[number].0.text.as_str());
            return Said::Value(number, value.to_bits());
        }
        match owner.filter(|name| step.releases("temperature", name)) {
            Some(_) => {
                owner = None;
                Said::Release
            }
            None => Said::Nothing,
        }
    };
    steps.iter().zip(values).map(said).collect()
}

fn timeline(steps: &[StepKeys], said: &[Said]) -> Timeline {
    let change = |(step, said): (&StepKeys, &Said)| {
        let change = match *said {
            Said::Nothing => Change::Keep,
            Said::Release => Change::Release,
            Said::Value(number, bits) => Change::To(f64::from_bits(bits), step.temperature[number].1.amplitude.clone()),
        };
        (step.duration, change)
    };
    Timeline::new(steps.iter().zip(said).map(change))
}
