//! Rigid tools: analytical profiles and rigid elements.

use super::contacts::Sided;
use super::{Writer, list, quoted};
use crate::elements::Family;
use crate::message::InputPlace;
use crate::model::{Profile, RigidPart, Segment, SurfaceKind, Sweep};

/// A tool and the node that leads it.
pub struct Tool {
    /// Its name.
    pub name: String,
    /// The reference node.
    pub node: usize,
    /// The rigid body's number.
    pub rigid: usize,
    /// Where it stands.
    pub place: InputPlace,
}

impl Writer<'_> {
    /// One tool for each rigid body that is no body's own.
    pub(super) fn tools(&mut self) {
        let model = self.model;
        for (number, rigid) in model.rigid.iter().enumerate() {
            let shape = match &rigid.what {
                RigidPart::Surface(scope, name) => {
                    let surface = model.surface(&(*scope, name.clone()));
                    surface.and_then(|surface| match &surface.kind {
                        SurfaceKind::Analytical(profile) => {
                            Some((surface.name.clone(), self.swept(profile, rigid.place)?))
                        }
                        _ => {
                            self.error(rigid.place, format!("surface '{}' is not analytical", surface.name));
                            None
                        }
                    })
                }
                RigidPart::Elements(elements) => {
                    let negative = self.negative(elements);
                    let name = self.name_of(elements).unwrap_or_else(|| format!("rigid {}", number + 1));
                    self.facets(elements, negative, rigid.place).map(|shape| (name, shape))
                }
                RigidPart::Nodes(nodes, name) => {
                    let group = self.groups.nodes(name, nodes.clone());
                    self.rigid_group(&group, number);
                    None
                }
                RigidPart::Sides(scope, name) => {
                    match self.sided(rigid.place, &(*scope, name.clone())) {
                        Some(Sided::Sides(group)) => self.rigid_group(&group, number),
                        Some(Sided::Tool(_)) => {
                            self.error(rigid.place, "a rigid surface cannot be coupled; name one of bodies")
                        }
                        None => {}
                    }
                    None
                }
            };
            let Some((name, shape)) = shape else { continue };
            let from = self.from(rigid.place);
            let reference = &model.nodes[rigid.node].x[..self.dimension()];
            self.text += &format!("\n[tool.{}]{from}\n{shape}reference = {}\n", quoted(&name), list(reference));
            self.tools.push(Tool { name, node: rigid.node, rigid: number, place: rigid.place });
        }
    }

    /// A group of nodes that goes with the node of a rigid body.
    fn rigid_group(&mut self, group: &str, number: usize) {
        let rigid = &self.model.rigid[number];
        let ring = self.family == Family::Axisymmetric && !rigid.distributing;
        if ring || (rigid.is_partial() && !rigid.distributing) {
            return self.partial_group(group, number);
        }
        if self.model.frames.contains_key(&rigid.node) {
            return self.error(rigid.place, "the reference node has axes of its own, which cannot be translated");
        }
        let taken = |name: &str| self.tools.iter().any(|tool| tool.name == name);
        let name = if taken(group) { format!("{group} {}", number + 1) } else { group.to_owned() };
        let (from, reference) = (self.from(rigid.place), &self.model.nodes[rigid.node].x[..self.dimension()]);
        if !self.model.steps.iter().any(|step| step.large) {
            let what =
                "the nodes go with the reference node by finite rotation, also without NLGEOM: small rotations agree";
            self.note(rigid.place, what);
        }
        let (kind, more) = if rigid.distributing { ("distributing", "weights = \"area\"\n") } else { ("rigid", "") };
        let (title, group) = (quoted(&name), quoted(group));
        self.text += &format!("\n[{kind}.{title}]{from}\ngroup = {group}\nreference = {}\n{more}", list(reference));
        self.tools.push(Tool { name, node: rigid.node, rigid: number, place: rigid.place });
    }

    /// The tool that a node leads, and along which axis: a node of its rotation has turns for translations.
    pub(super) fn led_tool(&self, node: usize, axis: usize) -> Option<(String, usize)> {
        let of = |tool: &Tool| {
            let turns = self.model.rigid[tool.rigid].rotation_node == Some(node);
            match (tool.node == node, turns) {
                (true, _) => Some((tool.name.clone(), axis)),
                // In the plane the turn is about the third axis.
                (false, true) => Some((tool.name.clone(), axis + 3)),
                _ => None,
            }
        };
        self.tools.iter().find_map(of)
    }

    /// The tool of an analytical surface.
    pub(super) fn tool_of_surface(&self, name: &(usize, String)) -> Option<String> {
        let of = |tool: &&Tool| match &self.model.rigid[tool.rigid].what {
            RigidPart::Surface(scope, surface) => (*scope, surface) == (name.0, &name.1),
            _ => false,
        };
        self.tools.iter().find(of).map(|tool| tool.name.clone())
    }

    /// The tool of a rigid element.
    pub(super) fn tool_of_element(&self, element: usize) -> Option<String> {
        let of = |tool: &&Tool| match &self.model.rigid[tool.rigid].what {
            RigidPart::Elements(elements) => elements.contains(&element),
            _ => false,
        };
        self.tools.iter().find(of).map(|tool| tool.name.clone())
    }

    /// The surfaces of contact pairs that lie on rigid elements.
    fn surfaces_on<'a>(&'a self, elements: &'a [usize]) -> impl Iterator<Item = (&'a str, bool)> {
        let names = self.model.pairs.iter().flat_map(|pair| [&pair.slave, &pair.master]);
        names.filter_map(|name| self.model.surface(name)).filter_map(|surface| match &surface.kind {
            SurfaceKind::Faces(faces) => {
                let (_, _, negative) = faces.iter().find(|(element, ..)| elements.contains(element))?;
                Some((surface.name.as_str(), *negative))
            }
            _ => None,
        })
    }

    fn negative(&self, elements: &[usize]) -> bool {
        self.surfaces_on(elements).next().is_some_and(|(_, negative)| negative)
    }

    fn name_of(&self, elements: &[usize]) -> Option<String> {
        self.surfaces_on(elements).next().map(|(name, _)| name.to_string())
    }

    /// The shape of an analytical surface. Its outward normal lies on the left of its segments, a tool's material on the left
    /// of its profile: the profile is travelled backwards.
    fn swept(&mut self, profile: &Profile, place: InputPlace) -> Option<String> {
        let plane = self.family != Family::Solid;
        if plane != (profile.sweep == Sweep::Plane) {
            let what = if plane {
                "a plane model needs a surface of type SEGMENTS"
            } else {
                "a model in space needs CYLINDER or REVOLUTION"
            };
            self.error(place, what);
            return None;
        }
        let mut text = String::from("profile = [\n");
        for segment in profile.segments.iter().rev() {
            let points = |points: &[[f64; 2]]| {
                let points: Vec<String> = points.iter().rev().map(|point| list(point)).collect();
                points.join(", ")
            };
            text += &match segment {
                Segment::DataLine(ends) => format!("    {{ line = [{}] }},\n", points(ends)),
                Segment::Arc(three) => format!("    {{ arc = [{}] }},\n", points(three)),
                Segment::Parabola(three) => format!("    {{ parabola = [{}] }},\n", points(three)),
            };
        }
        text += "]\n";
        if let Some(fillet) = profile.fillet {
            text += &format!("fillet = {fillet:?}\n");
        }
        match profile.sweep {
            Sweep::Plane => {}
            Sweep::Revolved([origin, axis]) => {
                text += &format!("revolve = {{ origin = {}, axis = {} }}\n", list(&origin), list(&axis));
            }
            Sweep::Extruded([origin, x, along]) => {
                let (half, length) = (self.size(), norm(along));
                if length <= 0.0 || norm(x) <= 0.0 {
                    self.error(
                        place,
                        "the x axis or the generator of the cylinder has no length; give three points apart",
                    );
                    return None;
                }
                let start: [f64; 3] = std::array::from_fn(|i| origin[i] - half * along[i] / length);
                let along = along.map(|c| 2.0 * half * c / length);
                text +=
                    &format!("extrude = {{ origin = {}, along = {}, x = {} }}\n", list(&start), list(&along), list(&x));
                self.note(place, format!("the cylinder ends {half} to both sides of its origin"));
            }
        }
        Some(text)
    }

    /// The largest extent of the model, from anywhere to anywhere.
    fn size(&self) -> f64 {
        let range = |axis: usize| {
            let x = self.model.nodes.iter().map(|node| node.x[axis]);
            x.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        let far = (0..3).map(|axis| range(axis).iter().fold(0.0_f64, |far, x| far.max(x.abs())));
        2.0 * far.fold(0.0, |size: f64, far| size.hypot(far)).max(f64::MIN_POSITIVE)
    }

    /// The shape of rigid elements: a profile in the plane, facets in space.
    fn facets(&mut self, elements: &[usize], negative: bool, place: InputPlace) -> Option<String> {
        let model = self.model;
        if self.family != Family::Solid {
            return self.chain(elements, negative, place);
        }
        let mut nodes: Vec<usize> =
            elements.iter().flat_map(|&element| model.elements[element].nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut text = String::from("facets.nodes = [\n");
        for &node in &nodes {
            text += &format!("    {},\n", list(&model.nodes[node].x));
        }
        text += "]\nfacets.faces = [\n";
        for &element in elements {
            let mut corners: Vec<String> = model.elements[element]
                .nodes
                .iter()
                .map(|node| (1 + nodes.binary_search(node).unwrap_or(0)).to_string())
                .collect();
            if negative {
                corners.reverse();
            }
            text += &format!("    [{}],\n", corners.join(", "));
        }
        Some(text + "]\n")
    }

    /// Rigid lines, each from the end of the one before. The outward normal lies on the left from the first node to the second.
    fn chain(&mut self, elements: &[usize], negative: bool, place: InputPlace) -> Option<String> {
        let ends = |&element: &usize| {
            let nodes = &self.model.elements[element].nodes;
            Some(if negative { [*nodes.first()?, *nodes.get(1)?] } else { [*nodes.get(1)?, *nodes.first()?] })
        };
        let mut rest: Vec<[usize; 2]> = elements.iter().filter_map(ends).collect();
        let starts = |rest: &[[usize; 2]], of: usize| rest.iter().position(|line| line[0] == of);
        let first = rest.iter().position(|line| !rest.iter().any(|other| other[1] == line[0])).unwrap_or(0);
        let mut chain = vec![rest.swap_remove(first)];
        while let Some(next) = chain.last().and_then(|line| starts(&rest, line[1])) {
            chain.push(rest.swap_remove(next));
        }
        if !rest.is_empty() {
            self.error(place, "the rigid elements are not one line; each must begin where the one before ends");
            return None;
        }
        let point = |node: usize| list(&self.model.nodes[node].x[..2]);
        let lines = chain.iter().map(|[a, b]| format!("    {{ line = [{}, {}] }},\n", point(*a), point(*b)));
        Some(format!("profile = [\n{}]\n", lines.collect::<String>()))
    }
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().fold(0.0, |length: f64, x| length.hypot(*x))
}
