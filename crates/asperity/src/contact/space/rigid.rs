//! A rigid tool in space as a target: all of its facets move with the six unknowns of one reference node.

use crate::system::Dofs;
use crate::tensor::{Dual, Scalar, Vec3};
use crate::tool::space::{Pose, Tool};
use std::ops::Range;
use std::sync::Arc;

/// A tool and the place of its unknowns.
#[derive(Debug)]
pub struct Rigid {
    tool: Arc<Tool>,
    number: usize,
    first: usize,
}

/// Unknowns of a tool.
pub const COUNT: usize = 6;

impl Rigid {
    /// Tool number `number` in the numbering of the unknowns.
    pub fn new(tool: Arc<Tool>, number: usize, dofs: &Dofs) -> Self {
        Self { tool, number, first: dofs.tool(number) }
    }
    /// The tool.
    pub fn tool(&self) -> &Tool {
        &self.tool
    }
    /// Its number among the tools.
    pub fn number(&self) -> usize {
        self.number
    }
    pub(super) fn unknowns(&self) -> Range<usize> {
        self.first..self.first + COUNT
    }
    /// Where it stands for unknowns `u`.
    pub fn pose(&self, u: &[f64]) -> Pose {
        pose(&u[self.unknowns()])
    }
    /// Present place of its reference point for unknowns `u`.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.tool.reference() + self.pose(u).translation
    }

    pub(super) fn rates(&self, motion: &[f64], at: Vec3) -> [Vec3; COUNT] {
        let pose = pose(motion);
        pose.rates(&pose.spins(), self.tool.reference(), at)
    }

    /// The force, and what does the work of its moment about the reference point.
    pub(super) fn receive<T: Scalar>(&self, motion: &[f64], at: Vec3<T>, force: Vec3<T>) -> [T; COUNT] {
        let turning = conjugate(&pose(motion), self.moment(motion, at, force));
        [force[0], force[1], force[2], turning[0], turning[1], turning[2]]
    }

    fn moment<T: Scalar>(&self, motion: &[f64], at: Vec3<T>, force: Vec3<T>) -> Vec3<T> {
        (at - (self.tool.reference() + pose(motion).translation).lift()).cross(force)
    }

    /// What the motion of the tool adds to the derivatives besides those of the place and the force: the arm shortens
    /// as the reference point moves, and a turning tool has other axes. Calls `add` with row, column and value.
    pub(super) fn stiffen(&self, motion: &[f64], (at, force): (Vec3, Vec3), add: &mut dyn FnMut(usize, usize, f64)) {
        let (pose, moment) = (pose(motion), self.moment(motion, at, force));
        let turned = Pose {
            translation: Vec3::zero(),
            rotation: Vec3(std::array::from_fn(|i| Dual::<3>::variable(pose.rotation[i], i))),
        };
        let turning = turned.conjugate(moment.lift());
        for j in 0..3 {
            let axis = Vec3(std::array::from_fn(|k| f64::from(u8::from(k == j))));
            let shorter = pose.conjugate(-axis.cross(force));
            for i in 0..3 {
                add(3 + i, j, shorter[i]);
                add(3 + i, 3 + j, turning[i].du[j]);
            }
        }
    }
}

pub(super) fn pose(motion: &[f64]) -> Pose {
    Pose::new(std::array::from_fn(|i| motion[i]))
}

/// The forces on the unknowns of a rotation that do the work of a moment.
fn conjugate<T: Scalar>(pose: &Pose, moment: Vec3<T>) -> Vec3<T> {
    let rotation = Pose { translation: Vec3::zero(), rotation: pose.rotation.lift() };
    rotation.conjugate(moment)
}
