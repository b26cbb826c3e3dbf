//! `*TRANSFORM`: nodes with axes of their own, along which conditions, forces and equations are meant; `*ORIENTATION`: the axes of
//! materials.

use super::Reader;
use super::names::Of;
use crate::model::{Frame, Orientation};
use crate::source::KeywordBlock;
use crate::vector::{cross, dot, less, unit};

impl Reader {
    /// `*ORIENTATION`.
    pub(crate) fn orientation(&mut self, block: &KeywordBlock) {
        let Some(name) = self.required(block, "NAME").map(|name| self.full_name(name).to_ascii_uppercase()) else {
            return;
        };
        let Some(line) = self.first_line(block, "two points") else { return };
        let Some(turn) = self.turn(block) else { return };
        let mut given = [0.0; 6];
        for (at, value) in given.iter_mut().enumerate() {
            let Some(number) = self.real(line, at, "a coordinate of the axes") else { return };
            *value = number;
        }
        let zero = self.placed([0.0; 3]);
        let (a, b) = (self.placed([given[0], given[1], given[2]]), self.placed([given[3], given[4], given[5]]));
        if block.word("SYSTEM").as_deref() == Some("CYLINDRICAL") {
            match unit(less(b, a)) {
                Some(along) => {
                    self.model.orientations.insert(name, Orientation::Cylinder { origin: a, along, turn });
                }
                None => self.error(line.place, "the two points of the axis of *ORIENTATION are one; give two"),
            }
            return;
        }
        let Some(frame) = rectangular(less(a, zero), less(b, zero)) else {
            let what =
                "the two points of *ORIENTATION span no plane; the first lies on the x axis, the second beside it";
            return self.error(line.place, what);
        };
        self.model.orientations.insert(name, Orientation::Straight(turned(&frame, turn)));
    }

    /// The axis of an additional turn of *ORIENTATION, from 0 to 2, and its angle in degrees: the second line, if there is one.
    fn turn(&mut self, block: &KeywordBlock) -> Option<(usize, f64)> {
        let Some(line) = block.lines.get(1) else { return Some((0, 0.0)) };
        let axis = match line.field(0) {
            "" | "1" => 0,
            "2" => 1,
            "3" => 2,
            other => {
                let what = format!("'{}' is no axis; axes are turned about 1, 2 or 3", super::shorten(other));
                self.error(line.place, what);
                return None;
            }
        };
        Some((axis, self.real_or(line, 1, "the angle", 0.0)?))
    }

    /// `*TRANSFORM`.
    pub(crate) fn transform(&mut self, block: &KeywordBlock) {
        let Some(name) = self.required(block, "NSET").map(str::to_string) else { return };
        let Some(target) = self.members(block.place, &name, Of::Nodes) else { return };
        let Some(line) = self.first_line(block, "two points") else { return };
        let mut given = [0.0; 6];
        for (at, value) in given.iter_mut().enumerate() {
            let Some(number) = self.real(line, at, "a coordinate of the system of axes") else { return };
            *value = number;
        }
        let (zero, point) = (self.placed([0.0; 3]), |at: usize| [given[at], given[at + 1], given[at + 2]]);
        let (a, b) = (self.placed(point(0)), self.placed(point(3)));
        if block.word("TYPE").as_deref() != Some("C") {
            let Some(frame) = rectangular(less(a, zero), less(b, zero)) else {
                let what =
                    "the two points of *TRANSFORM span no plane; the first lies on the x axis, the second beside it";
                return self.error(line.place, what);
            };
            self.model.frames.extend(target.members.iter().map(|&node| (node, frame)));
            return;
        }
        let Some(axis) = unit(less(b, a)) else {
            return self.error(line.place, "the two points of the axis of *TRANSFORM are one; give two");
        };
        let mut on_axis = 0;
        for &node in &target.members {
            let from = less(self.model.nodes[node].x, a);
            let along = dot(from, axis);
            let radial: [f64; 3] = std::array::from_fn(|i| from[i] - along * axis[i]);
            let size = dot(from, from).sqrt().max(f64::MIN_POSITIVE);
            // Around a node on the axis all directions are alike: the first is taken across it.
            let near = dot(radial, radial).sqrt() <= 1e-10 * size;
            on_axis += usize::from(near);
            let least = (0..3).min_by(|&i, &j| axis[i].abs().total_cmp(&axis[j].abs())).unwrap_or(0);
            let across = cross(axis, std::array::from_fn(|i| f64::from(u8::from(i == least))));
            if let Some(x) = unit(if near { across } else { radial }) {
                self.model.frames.insert(node, [x, cross(axis, x), axis]);
            }
        }
        if on_axis > 0 {
            let what = format!(
                "{on_axis} nodes of '{name}' lie on the axis of *TRANSFORM, where no direction is radial: one is chosen"
            );
            self.note(line.place, what);
        }
    }
}

/// Axes turned about one of them by an angle in degrees.
fn turned(frame: &Frame, (about, angle): (usize, f64)) -> Frame {
    let (sin, cos) = angle.to_radians().sin_cos();
    let (next, last) = ((about + 1) % 3, (about + 2) % 3);
    let mut turned = *frame;
    for i in 0..3 {
        turned[next][i] = cos * frame[next][i] + sin * frame[last][i];
        turned[last][i] = cos * frame[last][i] - sin * frame[next][i];
    }
    turned
}

/// Axes whose first is along a vector and whose second lies in the plane of another.
fn rectangular(x: [f64; 3], y: [f64; 3]) -> Option<Frame> {
    unit(x).zip(unit(cross(x, y))).map(|(x, z)| [x, cross(z, x), z])
}

/// A component of a vector of the model along an axis of a frame: factors along x, y, z.
pub fn along(frame: Option<&Frame>, axis: usize) -> [f64; 3] {
    match frame {
        Some(frame) => frame[axis],
        None => std::array::from_fn(|i| f64::from(u8::from(i == axis))),
    }
}
