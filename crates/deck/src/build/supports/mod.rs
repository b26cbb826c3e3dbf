//! Supports: what holds or moves unknowns in each step.
//!
//! Each step is a set of claims on unknowns: a component that follows a course, or a direction of a node. A claim of an
//! earlier step stands, held where it came to, until it is said anew or released. Two claims on one unknown must agree.

mod claim;
mod combine;
mod equations;
mod periodic;
mod ties;
mod tools;

use super::Builder;
use crate::diagnose::Diagnostic;
use crate::keys::{Components, Displacement, StepKeys};
use crate::reader::Name;
use asperity_core::mesh::{Mesh, ROUNDING, Space, flat_normal, unit};
use asperity_core::solve::{Course, Prescribed};
use asperity_core::system::{Constraints, Row};
use claim::{Claim, Claims, Known, What, hold};
use std::collections::{BTreeMap, BTreeSet};

/// Constraints and prescribed values of one step.
pub(super) type Held = (Constraints, Vec<Prescribed>);
/// A group and its nodes.
pub(super) type Nodes = (String, Vec<usize>);

impl Builder<'_> {
    /// For each step its constraints and prescribed values; and the groups that are held or moved in any.
    pub(super) fn supports(&mut self) -> (Vec<Held>, Vec<Nodes>) {
        let mut claims = self.standing();
        let (deck, mut known) = (self.deck, Known::new(self.site.dofs.count()));
        let equations: Vec<_> = self.equations().into_iter().chain(self.periodic()).collect();
        let absent = self.absent_bodies();
        let ties = self.standing_ties(&absent);
        let steps = deck.step.iter().zip(absent.iter().zip(ties)).map(|(step, (absent, ties))| {
            self.release(step, &mut claims);
            hold(&mut claims);
            claims.insert((String::new(), 2), self.left_alone(absent));
            self.claim(step, &mut claims);
            claims.values_mut().flatten().for_each(|claim| known.settle(claim));
            known.pass(claims.values().flatten());
            let held = self.constrain((&claims.values().flatten().collect::<Vec<_>>(), &known), &equations, &ties);
            self.look_for_idle_loads(step, &held.0);
            held
        });
        (steps.collect(), self.groups())
    }

    /// A load along which all its nodes are held or led moves nothing: one of the two is a slip.
    fn look_for_idle_loads(&mut self, step: &StepKeys, constraints: &Constraints) {
        let (deck, rigid, dimension) = (self.deck, self.rigid_nodes(), self.site.space.dimension());
        let forces = step.force.iter().map(|(name, force)| ("force", name, name, force.components()));
        let tractions = step.traction.iter().map(|(name, load)| ("traction", name, name, load.components()));
        let volumes = step.body_force.iter().map(|(name, load)| ("body_force", name, name, load.components()));
        let springs = step.spring.iter().map(|(name, spring)| ("spring", name, name, spring.components()));
        let axes: Vec<_> = forces.chain(tractions).chain(volumes).chain(springs).collect();
        let pressures = step.pressure.iter().filter(|(_, pressure)| pressure.value != 0.0);
        let pressures = pressures.map(|(name, _)| ("pressure", name, name));
        let points = step.load.iter().filter_map(|(name, _)| {
            let (_, keys) = deck.distributing.iter().find(|(other, _)| other.text == name.text)?;
            Some(("load", name, &keys.group))
        });
        let mut found = Vec::new();
        let led = |group: &Name, axis: usize| {
            // What follows others carries its load over to them, be they held: what leads them bears it.
            let held = |node: usize| {
                let dof = self.site.dofs.node(node) + axis;
                match constraints.row(dof) {
                    Row::Free(_) => false,
                    Row::Fixed => true,
                    Row::Combined(others) => others.is_empty() && !constraints.is_tied(dof),
                }
            };
            let nodes = self.nodes(&group.text);
            !nodes.is_empty() && nodes.iter().all(|node| held(*node) && !rigid.contains_key(node))
        };
        let mut refuse = |kind: &str, name: &Name, along: String| {
            let what = format!("`{kind}.{name}` moves nothing{along}");
            let error = Diagnostic::error(what).at(name.place).label("all its nodes are held there");
            found.push(error.help("remove the load, or release the nodes"));
        };
        for (kind, name, group, components) in axes {
            for (axis, value) in components.iter().enumerate().take(dimension) {
                if value.is_some_and(|value| value != 0.0) && led(group, axis) {
                    refuse(kind, name, format!(" along {}", ["x", "y", "z"][axis]));
                }
            }
        }
        for (kind, name, group) in pressures.chain(points) {
            if (0..dimension).all(|axis| led(group, axis)) {
                refuse(kind, name, String::new());
            }
        }
        self.found.append(&mut found);
    }

    /// Nodes of rigid groups, with the names of these.
    fn rigid_nodes(&self) -> BTreeMap<usize, &Name> {
        let groups = self.deck.rigid.iter().map(|(name, keys)| (name, self.nodes(&keys.group.text)));
        groups.flat_map(|(name, nodes)| nodes.iter().map(move |&node| (node, name))).collect()
    }

    fn groups(&self) -> Vec<Nodes> {
        let steps = self.deck.step.iter();
        let names = steps.flat_map(|step| step.displacement.iter().map(|(name, _)| name).chain(&step.symmetry));
        let groups: BTreeMap<&str, &[usize]> = names.map(|name| (name.text.as_str(), self.nodes(&name.text))).collect();
        groups.into_iter().map(|(name, nodes)| (name.to_owned(), nodes.to_vec())).collect()
    }

    /// Groups that are neither held nor led, and whose motion the deck asks for: where a step ends that follows a path, and those
    /// of points that carry loads.
    pub(super) fn watched(&self) -> Vec<Nodes> {
        let until = self.deck.step.iter().filter_map(|step| step.until.as_ref()).map(|until| &until.group);
        let names = until.chain(self.deck.distributing.iter().map(|(_, keys)| &keys.group));
        let known: BTreeSet<String> = self.groups().into_iter().map(|(name, _)| name).collect();
        let groups: BTreeMap<&str, &[usize]> = names
            .filter(|name| !known.contains(&name.text))
            .map(|name| (name.text.as_str(), self.nodes(&name.text)))
            .collect();
        groups.into_iter().map(|(name, nodes)| (name.to_owned(), nodes.to_vec())).collect()
    }

    /// What holds from the start without a word in the deck: tools, nodes on the axis, nodes of no cell.
    fn standing(&self) -> Claims {
        let dofs = &self.site.dofs;
        let mut claims = Claims::new();
        let claim = |by: &str, dof| Claim {
            by: by.to_owned(),
            place: self.deck.space.place,
            what: What::Unknown(dof),
            course: Course::Hold,
        };
        for (tool, name) in self.leaders().enumerate() {
            for i in 0..dofs.per_tool() {
                let dof = dofs.tool(tool) + i;
                claims.insert((format!("motion.{name}"), i), vec![claim(&format!("motion.{name}"), dof)]);
            }
        }
        let unknowns = |node| dofs.node(node)..dofs.node(node) + dofs.per_node();
        let unused = unused(&self.site.mesh).into_iter().flat_map(unknowns);
        claims.insert((String::new(), 0), unused.map(|dof| claim("", dof)).collect());
        let axis = on_axis(&self.site.mesh, self.site.space).into_iter().map(|node| dofs.node(node));
        claims.insert((String::new(), 1), axis.map(|dof| claim("the axis", dof)).collect());
        claims
    }

    /// Nodes that only bodies have which a step does without stay where they are.
    fn left_alone(&self, absent: &BTreeSet<usize>) -> Vec<Claim> {
        if absent.is_empty() {
            return vec![];
        }
        let (mesh, dofs, owner) = (&self.site.mesh, &self.site.dofs, self.owners());
        let mut alone = vec![false; mesh.points.len()];
        for there in [false, true] {
            for cell in (0..mesh.cell_count()).filter(|&cell| absent.contains(&owner[cell]) != there) {
                mesh.cell(cell).nodes.iter().for_each(|&node| alone[node] = !there);
            }
        }
        let nodes = (0..alone.len()).filter(|&node| alone[node]);
        let claim = |dof| Claim {
            by: String::new(),
            place: self.deck.space.place,
            what: What::Unknown(dof),
            course: Course::Hold,
        };
        nodes.flat_map(|node| dofs.node(node)..dofs.node(node) + dofs.per_node()).map(claim).collect()
    }

    /// Holds all nodes of a group where they are.
    fn hold_group(&self, name: &Name, claims: &mut Claims) {
        let (by, dofs) = (format!("hold.{name}"), &self.site.dofs);
        for axis in 0..dofs.per_node() {
            let claim = |&node: &usize| {
                let what = What::Unknown(dofs.node(node) + axis);
                Claim { by: by.clone(), place: name.place, what, course: Course::Hold }
            };
            claims.insert((by.clone(), axis), self.nodes(&name.text).iter().map(claim).collect());
        }
    }

    /// What a step says.
    fn claim(&mut self, step: &StepKeys, claims: &mut Claims) {
        for released in &step.release {
            if let Some(name) = released.text.strip_prefix("hold.").filter(|name| self.leader(name).is_some()) {
                let what = format!("`{name}` stays where it is until it is moved or loaded");
                let help = format!("say `motion.{name}` or `load.{name}` in place of releasing it");
                self.found.push(Diagnostic::error(what).at(released.place).help(help));
            }
        }
        for name in step.hold.iter().filter(|name| self.leader(&name.text).is_none()) {
            self.hold_group(name, claims);
        }
        for (name, keys) in &step.displacement {
            self.displace(name, keys, claims);
        }
        for name in &step.symmetry {
            self.mirror(name, claims);
        }
        for (name, keys) in &step.motion {
            let values = self.of_tool("motion", name, keys);
            let translations = self.site.dofs.per_node();
            let value = |(i, value): (usize, Option<f64>)| {
                value.map(|value| if i < translations { value } else { value.to_radians() })
            };
            let values: Vec<_> = values.into_iter().enumerate().map(value).collect();
            self.move_tool((step, name), &values, &keys.amplitude, claims);
        }
        for (name, keys) in &step.load {
            let tool = self.leader(&name.text);
            let loaded = self.of_tool("load", name, keys);
            for (i, _) in loaded.iter().enumerate().filter(|(_, value)| value.is_some() && tool.is_some()) {
                claims.remove(&(format!("motion.{name}"), i));
            }
        }
    }

    fn displace(&mut self, name: &Name, keys: &Displacement, claims: &mut Claims) {
        let by = format!("displacement.{name}");
        let claim = |what, value| {
            let course = Course::To(value, keys.amplitude.clone());
            Claim { by: by.clone(), place: name.place, what, course }
        };
        if let Some(z) = keys.z.filter(|_| self.plane()) {
            let what = format!("`{by}` has a component along z, but the model is plane");
            self.found.push(Diagnostic::error(what).at(z.place).help("remove `z`"));
            return;
        }
        let dimension = self.site.space.dimension();
        if let Some(along) = keys.along.as_ref().filter(|along| along.len() != dimension) {
            let what = format!("`{by}.along` must have {dimension} components in this space; it has {}", along.len());
            return self.refuse(what, along.place);
        }
        let dofs = &self.site.dofs;
        let components = [keys.x, keys.y, keys.z.map(|z| z.value)];
        for (axis, value) in components.iter().enumerate().filter_map(|(axis, value)| Some((axis, (*value)?))) {
            let nodes = self.nodes(&name.text).iter();
            let made = nodes.map(|&node| claim(What::Unknown(dofs.node(node) + axis), value)).collect();
            claims.insert((by.clone(), axis), made);
        }
        if let (Some(along), Some(value)) = (&keys.along, keys.value) {
            let direction = unit(std::array::from_fn(|i| along.get(i).copied().unwrap_or(0.0)));
            let nodes = self.nodes(&name.text).iter();
            let made = nodes.map(|&node| claim(What::Direction(dofs.node(node), direction), value)).collect();
            claims.insert((by.clone(), 3), made);
        }
    }

    /// A plane of symmetry: its nodes keep their place along its normal.
    fn mirror(&mut self, name: &Name, claims: &mut Claims) {
        let Some(group) = self.site.mesh.groups.get(&name.text) else { return };
        let Some(normal) = flat_normal(&self.site.mesh, &group.sides) else {
            let what = format!("the group `{name}` is not flat, so that it is no plane of symmetry");
            self.found
                .push(Diagnostic::error(what).at(name.place).help("choose a flat side, or part of it by [group]"));
            return;
        };
        let by = format!("symmetry.{name}");
        let claim = |&node: &usize| Claim {
            by: by.clone(),
            place: name.place,
            what: What::Direction(self.site.dofs.node(node), normal),
            course: Course::Hold,
        };
        let made = group.nodes.iter().map(claim).collect();
        claims.insert((by.clone(), 3), made);
    }
}

/// Nodes that no cell uses.
fn unused(mesh: &Mesh) -> Vec<usize> {
    let mut used = vec![false; mesh.points.len()];
    mesh.nodes.iter().for_each(|&node| used[node] = true);
    (0..used.len()).filter(|&node| !used[node]).collect()
}

/// Nodes that the axis of revolution keeps from moving along the radius.
pub(super) fn on_axis(mesh: &Mesh, space: Space) -> Vec<usize> {
    let near = ROUNDING * mesh.size();
    let on = |&node: &usize| space == Space::Axisymmetric && mesh.points[node][0].abs() <= near;
    (0..mesh.points.len()).filter(on).collect()
}
