//! What leads nodes and tools, step by step: the last line that names a node and an axis holds.

use super::Writer;
use super::conditions::Table;
use super::courses::{Item, Record};
use crate::elements::Family;
use crate::message::Place;
use crate::model::{ActionKind, Condition, RigidPart};
use std::collections::BTreeMap;

/// Who leads each node along each axis.
type Owners = BTreeMap<(usize, usize), usize>;

/// What leads nodes, and what leads tools.
pub struct Supports {
    /// By groups.
    pub displacement: Table,
    /// By tools.
    pub motion: Table,
}

impl Writer<'_> {
    /// All supports.
    pub(super) fn supports(&mut self) -> Supports {
        let model = self.model;
        let (mut owners, mut records) = (Owners::new(), Vec::<Record>::new());
        let mut supports = Supports { displacement: vec![], motion: vec![] };
        for number in 0..model.steps.len() {
            let before = owners.clone();
            for action in model.actions(number) {
                match &action.kind {
                    ActionKind::Fresh(Condition::Boundary) => owners.clear(),
                    ActionKind::Lead(target, axis, value) => {
                        let (name, place, course) = (target.name.clone(), action.place, action.course);
                        records.push(Record { name, value: *value, course, place, step: number, reached: 0.0 });
                        owners.extend(target.members.iter().map(|&node| ((node, *axis), records.len() - 1)));
                    }
                    _ => {}
                }
            }
            let start = |key: &(usize, usize)| match number {
                0 => Some(0.0),
                _ => before.get(key).map(|&record| records[record].reached),
            };
            let (displacement, motion) = self.led(number, &owners, &records, &start);
            supports.displacement.push(displacement);
            supports.motion.push(motion);
            let reached: Vec<f64> = records.iter().map(|record| self.followed(record, number).0).collect();
            records.iter_mut().zip(reached).for_each(|(record, reached)| record.reached = reached);
        }
        supports
    }

    /// What is led in one step.
    #[allow(clippy::type_complexity)]
    fn led(
        &mut self,
        step: usize,
        owners: &Owners,
        records: &[Record],
        start: &dyn Fn(&(usize, usize)) -> Option<f64>,
    ) -> (BTreeMap<(String, usize), Item>, BTreeMap<(String, usize), Item>) {
        let mut pieces: BTreeMap<(usize, usize, Option<u64>), Vec<usize>> = BTreeMap::new();
        let mut motion = BTreeMap::new();
        for (key @ (node, axis), &record) in owners {
            let (end, course) = self.followed(&records[record], step);
            let place = records[record].place;
            if let Some(led) = self.led_tool(*node, *axis) {
                motion.insert(led, Item { end, start: start(key), course: course.clone(), place });
                continue;
            }
            if self.used[*node] && *axis < self.dimension() {
                let from = course.as_ref().and_then(|_| start(key)).map(f64::to_bits);
                pieces.entry((record, *axis, from)).or_default().push(*node);
            } else if !self.used[*node]
                && !self.model.rigid.iter().any(|r| r.node == *node || r.rotation_node == Some(*node))
            {
                let what = format!("'{}' holds nodes of no body; they are left out", records[record].name);
                self.note(place, what);
            }
        }
        let mut displacement = BTreeMap::new();
        for ((record, axis, from), nodes) in pieces {
            let (end, course) = self.followed(&records[record], step);
            let place = records[record].place;
            if course.is_some() && from.is_none() {
                self.note(place, "the nodes were free before: the amplitude leads on from where they are");
            }
            let group = self.groups.nodes(&records[record].name, nodes);
            displacement.insert((group, axis), Item { end, start: from.map(f64::from_bits), course, place });
        }
        for (group, axis, record) in self.rigid_nodes(owners, records) {
            let (end, course) = self.followed(&records[record], step);
            let start = if step == 0 { Some(0.0) } else { Some(records[record].reached) };
            displacement.insert((group, axis), Item { end, start, course, place: records[record].place });
        }
        (displacement, motion)
    }

    /// Nodes of bodies that a reference node makes rigid: where it is led along all axes and does not turn, they go with it.
    fn rigid_nodes(&mut self, owners: &Owners, records: &[Record]) -> Vec<(String, usize, usize)> {
        let (model, dimension) = (self.model, self.dimension());
        let mut led = Vec::new();
        for rigid in &model.rigid {
            let RigidPart::Nodes(nodes, name) = &rigid.what else { continue };
            if self.family != Family::Axisymmetric {
                continue;
            }
            let turns: Vec<usize> = if dimension == 3 { vec![3, 4, 5] } else { vec![5] };
            let turn = |&axis: &usize| match rigid.rotation_node {
                Some(node) => owners.get(&(node, axis - 3)),
                None => owners.get(&(rigid.node, axis)),
            };
            let still = turns.iter().all(|axis| turn(axis).is_some_and(|&record| records[record].value == 0.0));
            let axes: Vec<Option<&usize>> = (0..dimension).map(|axis| owners.get(&(rigid.node, axis))).collect();
            if !still || axes.iter().any(Option::is_none) {
                self.free_rigid(rigid.place, name);
                continue;
            }
            let group = self.groups.nodes(name, nodes.clone());
            led.extend(
                axes.iter().enumerate().filter_map(|(axis, record)| Some((group.clone(), axis, **record.as_ref()?))),
            );
        }
        led
    }

    fn free_rigid(&mut self, place: Place, name: &str) {
        let what = format!(
            "'{name}' is rigid and free to move or turn, which cannot be translated; lead its reference node along all axes without a \
             turn, or make it an analytical surface or rigid elements"
        );
        self.error(place, what);
    }
}
