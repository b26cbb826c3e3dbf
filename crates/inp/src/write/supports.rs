//! What leads nodes and tools, step by step: the last line that names a node and an axis holds.

use super::Writer;
use super::adjust::nodes_of;
use super::conditions::Table;
use super::courses::{Item, Record};
use super::turned::resolved;
use crate::model::{ActionKind, Condition, SurfaceKind};
use std::collections::{BTreeMap, BTreeSet};

/// Who leads each node along each axis.
type Owners = BTreeMap<(usize, usize), usize>;

/// Nodes that are led alike, by record, component and the values of the item.
type Alike = BTreeMap<(usize, usize, Vec<u64>), (Item, Vec<usize>)>;

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
        let glued = self.glued();
        for number in 0..model.steps.len() {
            let before = owners.clone();
            for action in model.actions(number) {
                match &action.kind {
                    ActionKind::Fresh(Condition::Boundary) => owners.clear(),
                    ActionKind::Lead(target, axis, value) => {
                        let both = target.members.iter().filter(|node| *value != 0.0 && glued.contains(node)).count();
                        if both > 0 {
                            let what = format!(
                                "{both} of these nodes are of a surface that follows in a *TIE: what leads them holds here, in CalculiX the tie"
                            );
                            self.note(action.place, what);
                        }
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
            self.held.push(owners.keys().copied().collect());
            let reached: Vec<f64> = records.iter().map(|record| self.followed(record, number).0).collect();
            records.iter_mut().zip(reached).for_each(|(record, reached)| record.reached = reached);
        }
        supports
    }

    /// Nodes of surfaces that follow in ties.
    fn glued(&self) -> BTreeSet<usize> {
        let slaves = self.model.ties.iter().filter_map(|tie| self.model.surface(&tie.slave));
        let faces =
            slaves.filter_map(|surface| if let SurfaceKind::Faces(faces) = &surface.kind { Some(faces) } else { None });
        let nodes = |&(element, face, _): &(usize, Option<usize>, bool)| {
            nodes_of(&self.model.elements[element], face.unwrap_or(0))
        };
        faces.flatten().filter(|face| face.1.is_some()).flat_map(nodes).collect()
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
        let mut owned: BTreeMap<usize, Vec<(usize, usize)>> = BTreeMap::new();
        for (key @ (node, axis), &record) in owners {
            let (end, course) = self.followed(&records[record], step);
            let place = records[record].place;
            if let Some(led) = self.led_tool(*node, *axis) {
                motion.insert(led, Item { end, start: start(key), course: course.clone(), place });
                continue;
            }
            if self.used[*node] && *axis < self.dimension() {
                if self.model.frames.contains_key(node) {
                    owned.entry(*node).or_default().push((*axis, record));
                    continue;
                }
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
        for (axis, (item, record), nodes) in self.turned(step, &owned, records, start) {
            let group = self.groups.nodes(&records[record].name, nodes);
            displacement.insert((group, axis), item);
        }
        for (group, place) in &self.rings {
            let item = Item { end: 0.0, start: Some(0.0), course: None, place: *place };
            displacement.insert((group.clone(), 0), item);
        }
        (displacement, motion)
    }

    /// What leads nodes with axes of their own: a component, its value with the record that it comes from, and the nodes of which
    /// this holds.
    fn turned(
        &mut self,
        step: usize,
        owned: &BTreeMap<usize, Vec<(usize, usize)>>,
        records: &[Record],
        start: &dyn Fn(&(usize, usize)) -> Option<f64>,
    ) -> Vec<(usize, (Item, usize), Vec<usize>)> {
        let mut alike = Alike::new();
        for (&node, led) in owned {
            let Some(frame) = self.model.frames.get(&node) else { continue };
            let items: Vec<(usize, Item)> = led
                .iter()
                .map(|&(axis, record)| {
                    let ((end, course), place) = (self.followed(&records[record], step), records[record].place);
                    (axis, Item { end, start: start(&(node, axis)), course, place })
                })
                .collect();
            let Some((record, resolved)) = led.first().map(|led| led.1).zip(resolved(frame, self.dimension(), &items))
            else {
                let what = "nodes are led along two of three inclined axes, or onto them by an amplitude from where they are, which cannot \
                            be translated; lead them along one or all of these axes";
                let place = items.first().map(|(_, item)| item.place).unwrap_or_default();
                self.error(place, what);
                return vec![];
            };
            for (led, item) in resolved {
                let component = self.component(led);
                let bits = [Some(item.end), item.start].into_iter().map(|value| value.map_or(u64::MAX, f64::to_bits));
                let course = item.course.iter().flatten().flatten().map(|value| value.to_bits());
                let key = (record, component, bits.chain(course).collect());
                alike.entry(key).or_insert_with(|| (item, vec![])).1.push(node);
            }
        }
        alike.into_iter().map(|((record, component, _), (item, nodes))| (component, (item, record), nodes)).collect()
    }
}
