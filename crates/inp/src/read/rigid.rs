//! Rigid bodies and the profiles of analytical surfaces.

use super::Reader;
use super::names::Of;
use crate::elements::Family;
use crate::model::{Profile, Rigid, RigidPart, Segment, Sweep};
use crate::source::{DataLine, KeywordBlock};

impl Reader {
    /// The profile of a surface of type SEGMENTS, CYLINDER or REVOLUTION. Inside a part the lines of its system may be missing:
    /// then it is that of the part, with the y axis as axis of revolution.
    pub(super) fn profile(&mut self, block: &KeywordBlock, kind: &str) -> Option<Profile> {
        let system = block.lines.iter().take_while(|line| self.word(line) != "START").count();
        let wanted = match kind {
            "CYLINDER" => 2,
            "REVOLUTION" => 1,
            _ => 0,
        };
        if system != 0 && system != wanted || system == block.lines.len() {
            self.error(
                block.place,
                format!("a surface of type {kind} has {wanted} lines of its system, then START, LINE, CIRCL, PARAB"),
            );
            return None;
        }
        let given: Vec<f64> = block.lines[..system]
            .iter()
            .enumerate()
            .flat_map(|(row, line)| (0..if row == 0 { 6 } else { 3 }).map(move |at| (line, at)))
            .map(|(line, at)| self.real(line, at, "a coordinate of the system of the surface"))
            .collect::<Option<_>>()?;
        let point = |at: usize| -> Option<[f64; 3]> { given.get(3 * at..3 * at + 3)?.try_into().ok() };
        let zero = self.placed([0.0; 3]);
        let axis = |reader: &Self, x: [f64; 3]| less(reader.placed(x), zero);
        let sweep = match (kind, point(0), point(1)) {
            ("SEGMENTS", ..) => Sweep::Plane,
            ("REVOLUTION", Some(a), Some(b)) => Sweep::Revolved([self.placed(a), less(self.placed(b), self.placed(a))]),
            ("REVOLUTION", ..) => Sweep::Revolved([zero, axis(self, [0.0, 1.0, 0.0])]),
            (_, Some(a), Some(b)) => {
                let c = point(2).unwrap_or_default();
                let a = self.placed(a);
                Sweep::Extruded([a, less(self.placed(b), a), less(self.placed(c), a)])
            }
            _ => Sweep::Extruded([zero, axis(self, [1.0, 0.0, 0.0]), axis(self, [0.0, 0.0, 1.0])]),
        };
        let segments = self.segments(&block.lines[system..], sweep == Sweep::Plane)?;
        let fillet = match block.value("FILLET RADIUS") {
            Some(radius) => Some(self.number(block.place, radius, "the fillet radius")?).filter(|&radius| radius > 0.0),
            None => None,
        };
        Some(Profile { segments, fillet, sweep })
    }

    fn word(&self, line: &DataLine) -> String {
        line.field(0).to_ascii_uppercase()
    }

    /// The segments below START. A profile of the plane is placed with its instance.
    fn segments(&mut self, lines: &[DataLine], placed: bool) -> Option<Vec<Segment>> {
        let place = |reader: &Self, [x, y]: [f64; 2]| {
            let x = if placed { reader.placed([x, y, 0.0]) } else { [x, y, 0.0] };
            [x[0], x[1]]
        };
        let mut segments = Vec::new();
        let mut here: Option<[f64; 2]> = None;
        for line in lines {
            let pair = |reader: &mut Self, at: usize| -> Option<[f64; 2]> {
                Some([reader.real(line, at, "a coordinate")?, reader.real(line, at + 1, "a coordinate")?])
            };
            let word = self.word(line);
            let start = here.filter(|_| word != "START");
            let end = match (word.as_str(), start) {
                ("START", _) => pair(self, 1)?,
                ("LINE", Some(from)) => {
                    let to = pair(self, 1)?;
                    segments.push(Segment::DataLine([place(self, from), place(self, to)]));
                    to
                }
                ("CIRCL", Some(from)) => {
                    let (to, centre) = (pair(self, 1)?, pair(self, 3)?);
                    match between(from, to, centre) {
                        Some(middle) => segments.push(Segment::Arc([from, middle, to].map(|x| place(self, x)))),
                        None => {
                            let what =
                                "the ends of the arc do not lie on one circle about its centre, or half a circle apart";
                            self.error(line.place, what);
                            return None;
                        }
                    }
                    to
                }
                ("PARAB", Some(from)) => {
                    let (middle, to) = (pair(self, 1)?, pair(self, 3)?);
                    segments.push(Segment::Parabola([from, middle, to].map(|x| place(self, x))));
                    to
                }
                _ => {
                    self.error(
                        line.place,
                        format!("'{}' is no segment; write START, then LINE, CIRCL or PARAB", super::shorten(&word)),
                    );
                    return None;
                }
            };
            here = Some(end);
        }
        if segments.is_empty() {
            let place = lines.first().map(|line| line.place).unwrap_or_default();
            self.error(place, "the profile has no segment below START; add LINE, CIRCL or PARAB");
            return None;
        }
        Some(segments)
    }

    /// `*RIGID BODY`.
    pub(crate) fn rigid_body(&mut self, block: &KeywordBlock) {
        let place = block.place;
        let Some(node) = self.required(block, "REF NODE").map(str::to_string) else { return };
        let Some(node) = self.one_node(place, &node) else { return };
        let rotation_node = match block.value("ROT NODE").map(str::to_string) {
            Some(name) => match self.one_node(place, &name) {
                Some(node) => Some(node),
                None => return,
            },
            None => None,
        };
        // Nodes of solids have no rotations of their own to be tied.
        let pinned = block.value("PIN NSET").or_else(|| block.value("TIE NSET"));
        let nodes = block.value("NSET").or(pinned);
        if pinned.is_some() && ["ANALYTICAL SURFACE", "ELSET", "NSET"].iter().any(|other| block.has(other)) {
            let what =
                "*RIGID BODY: a set of nodes beside other rigid parts cannot be translated; give all nodes by NSET";
            return self.error(place, what);
        }
        let what = if let Some(name) = block.value("ANALYTICAL SURFACE") {
            self.named_surface(place, name).map(|(scope, name)| RigidPart::Surface(scope, name))
        } else if let Some(name) = block.value("ELSET") {
            let found = self.members(place, name, Of::Elements);
            found.map(|target| {
                let rigid = |&element: &usize| self.model.elements[element].kind.family == Family::Rigid;
                match target.members.iter().all(rigid) {
                    true => RigidPart::Elements(target.members),
                    false => RigidPart::Nodes(self.nodes_of(&target.members), target.name),
                }
            })
        } else if let Some(name) = nodes {
            self.members(place, name, Of::Nodes).map(|target| RigidPart::Nodes(target.members, target.name))
        } else {
            self.error(place, "*RIGID BODY says nothing that is rigid; give ANALYTICAL SURFACE, ELSET or NSET");
            None
        };
        if let Some(what) = what {
            self.model.rigid.push(Rigid { rotation_node, ..Rigid::new(place, node, what) });
        }
    }

    /// `*COUPLING`: a surface that goes with a node, as the block below says.
    pub(crate) fn coupling(&mut self, block: &KeywordBlock) {
        self.end_coupling();
        let place = block.place;
        let Some(node) = self.required(block, "REF NODE").map(str::to_string) else { return };
        let Some(surface) = self.required(block, "SURFACE").map(str::to_string) else { return };
        let (Some(node), Some((scope, name))) = (self.one_node(place, &node), self.named_surface(place, &surface))
        else {
            return;
        };
        self.coupling = Some(place);
        self.oriented = block.has("ORIENTATION");
        self.model.rigid.push(Rigid::new(place, node, RigidPart::Sides(scope, name)));
    }

    /// `*KINEMATIC`: along which axes.
    pub(crate) fn kinematic(&mut self, block: &KeywordBlock) {
        if self.coupling.take().is_none() {
            return self.error(block.place, "*KINEMATIC stands below no *COUPLING that says what it is about");
        }
        let mut held = [block.lines.is_empty(); 3];
        for line in &block.lines {
            let Some(axes) = self.held_axes(line, 0) else { return };
            held.iter_mut().zip(axes).for_each(|(held, axis)| *held |= axis);
        }
        let plane = self.model.elements.iter().all(|element| element.kind.family != Family::Solid);
        if self.oriented && !held.iter().take(if plane { 2 } else { 3 }).all(|&held| held) {
            let what = "*COUPLING, ORIENTATION: axes that are turned and some of which only are coupled cannot be translated; couple \
                        degrees of freedom 1 to 3";
            return self.error(block.place, what);
        }
        if let Some(coupling) = self.model.rigid.last_mut() {
            coupling.axes = held;
        }
    }

    /// `*DISTRIBUTING`: the surface carries what loads the node.
    pub(crate) fn distributing(&mut self, block: &KeywordBlock) {
        if self.coupling.take().is_none() {
            return self.error(block.place, "*DISTRIBUTING stands below no *COUPLING that says what it is about");
        }
        if let Some(coupling) = self.model.rigid.last_mut() {
            coupling.distributing = true;
        }
    }

    pub(super) fn end_coupling(&mut self) {
        if let Some(place) = self.coupling.take() {
            self.error(place, "the *COUPLING says no kind; write *KINEMATIC or *DISTRIBUTING below it");
        }
    }

    fn nodes_of(&self, elements: &[usize]) -> Vec<usize> {
        let mut nodes: Vec<usize> =
            elements.iter().flat_map(|&element| self.model.elements[element].nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}

fn less(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// The middle of the arc of less than half a circle from one point to another about a centre.
fn between(from: [f64; 2], to: [f64; 2], centre: [f64; 2]) -> Option<[f64; 2]> {
    let [a, b] = [from, to].map(|x| [x[0] - centre[0], x[1] - centre[1]]);
    let [ra, rb] = [a, b].map(|x: [f64; 2]| x[0].hypot(x[1]));
    let sum = [a[0] + b[0], a[1] + b[1]];
    let length = sum[0].hypot(sum[1]);
    let round = ra > 0.0 && (ra - rb).abs() <= 1e-2 * ra && length > 1e-3 * ra;
    round.then(|| [centre[0] + sum[0] * ra / length, centre[1] + sum[1] * ra / length])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_an_arc_lies_on_its_circle() {
        let middle = between([1.0, 0.0], [0.0, 1.0], [0.0, 0.0]).unwrap();
        assert!(middle.iter().all(|x| (x - 0.5_f64.sqrt()).abs() < 1e-15));
        assert_eq!(between([1.0, 0.0], [-1.0, 0.0], [0.0, 0.0]), None);
        assert_eq!(between([1.0, 0.0], [0.0, 2.0], [0.0, 0.0]), None);
    }
}
