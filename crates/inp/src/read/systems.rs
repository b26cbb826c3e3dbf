//! `*TRANSFORM`: nodes with axes of their own, along which conditions, forces and equations are meant; `*ORIENTATION`: the axes of
//! materials.

use super::Reader;
use super::names::Of;
use crate::model::Frame;
use crate::source::Block;
use crate::vector::{cross, dot, less, unit};

impl Reader {
    /// `*ORIENTATION`.
    pub(crate) fn orientation(&mut self, block: &Block) {
        let Some(name) = self.required(block, "NAME").map(|name| self.full_name(name).to_ascii_uppercase()) else {
            return;
        };
        let Some(line) = self.first_line(block, "two points") else { return };
        let turned =
            block.lines.get(1).is_some_and(|line| line.fields().get(1).is_some_and(|angle| angle.parse() != Ok(0.0)));
        if turned || block.word("SYSTEM").is_some_and(|system| system != "RECTANGULAR") {
            self.model.orientations.insert(name, None);
            return;
        }
        let mut given = [0.0; 6];
        for (at, value) in given.iter_mut().enumerate() {
            let Some(number) = self.real(line, at, "a coordinate of the axes") else { return };
            *value = number;
        }
        let zero = self.placed([0.0; 3]);
        let (a, b) = (self.placed([given[0], given[1], given[2]]), self.placed([given[3], given[4], given[5]]));
        let Some(frame) = rectangular(less(a, zero), less(b, zero)) else {
            let what =
                "the two points of *ORIENTATION span no plane; the first lies on the x axis, the second beside it";
            return self.error(line.place, what);
        };
        self.model.orientations.insert(name, Some(frame));
    }

    /// `*TRANSFORM`.
    pub(crate) fn transform(&mut self, block: &Block) {
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
