//! A rigid tool as a target: all of its segments move with the unknowns of one reference node.

use crate::system::Dofs;
use crate::tensor::{Scalar, Vec3};
use crate::tool::{Pose, Tool};
use std::ops::Range;
use std::sync::Arc;

use super::target::{MAX_UNKNOWNS, Standing};

/// A tool and the place of its unknowns.
#[derive(Debug)]
pub struct Rigid {
    tool: Arc<Tool>,
    number: usize,
    first: usize,
}

/// Unknowns of a tool in the plane.
const COUNT: usize = 3;

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
    /// Values of its unknowns among all unknowns `u`.
    pub(super) fn motion<'u>(&self, u: &'u [f64]) -> &'u [f64] {
        &u[self.unknowns()]
    }
    /// Where it stands for values of its unknowns.
    pub(super) fn pose(&self, motion: &[f64]) -> Pose {
        Pose::new(motion[0], motion[1], motion[2])
    }
    /// Present place of its reference point for unknowns `u`.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.pose(self.motion(u)).place(self.tool.reference(), self.tool.reference())
    }

    /// The tool in its place for values of its unknowns.
    pub(super) fn standing(&self, motion: &[f64]) -> Standing<'_> {
        Standing::Tool(self, self.pose(motion))
    }

    pub(super) fn rates(&self, motion: &[f64], at: Vec3) -> [Vec3; MAX_UNKNOWNS] {
        let mut rates = [Vec3::zero(); MAX_UNKNOWNS];
        rates[..COUNT].copy_from_slice(&self.pose(motion).rates(self.tool.reference(), at));
        rates
    }

    /// The force and its moment about the reference point.
    pub(super) fn receive<T: Scalar>(&self, motion: &[f64], at: Vec3<T>, force: Vec3<T>) -> [T; MAX_UNKNOWNS] {
        let reference = self.tool.reference() + self.pose(motion).translation;
        let arm = at - reference.lift();
        let mut rows = [T::zero(); MAX_UNKNOWNS];
        (rows[0], rows[1], rows[2]) = (force[0], force[1], arm[0] * force[1] - arm[1] * force[0]);
        rows
    }

    /// The arm also shortens as the reference point itself moves.
    pub(super) fn stiffen(force: Vec3) -> Vec<(usize, usize, f64)> {
        vec![(2, 0, -force[1]), (2, 1, force[0])]
    }
}
