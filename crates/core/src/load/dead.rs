//! Loads whose forces do not depend on the displacements: `F_k = v_c(k)(t) share_k`.

use super::now;
use crate::Failure;
use crate::amplitude::Timeline;
use crate::mesh::Side;
use crate::system::{Attempt, Branch, History, Instant, Local, Role, State, Stencil, Stencils, Term};
use std::fmt;

/// A load of fixed direction and size: values that run in time, and what share of which of them each unknown takes.
/// Values that are not given are zero.
#[derive(Debug)]
pub struct DeadLoad {
    name: String,
    values: Vec<Timeline>,
    parts: Vec<Part>,
}

/// One stencil: a loaded face, cell, node or tool.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) on: On,
    pub(super) dofs: Vec<usize>,
    /// For each unknown, which value and its share of it.
    pub(super) shares: Vec<(usize, f64)>,
}

/// What a part acts on.
#[derive(Debug, Clone, Copy)]
pub(super) enum On {
    Side(Side),
    Cell(usize),
    Node(usize),
    Tool,
}

impl fmt::Display for On {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Side(side) => write!(f, "face {} of cell {} under", side.face, side.cell),
            Self::Cell(cell) => write!(f, "cell {cell} under"),
            Self::Node(node) => write!(f, "node {node} under"),
            Self::Tool => f.write_str("the tool under"),
        }
    }
}

impl DeadLoad {
    pub(super) fn new(name: &str, values: Vec<Timeline>, parts: Vec<Part>) -> Self {
        Self { name: name.into(), values, parts }
    }
}

impl Term for DeadLoad {
    fn name(&self) -> &str {
        &self.name
    }
    fn role(&self) -> Role {
        Role::Load
    }
    fn initial(&self) -> History {
        History::new(self.parts.iter().map(|_| 0))
    }
    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        _: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let values = self.values.iter().map(|value| now(value, accepted, at)).collect();
        Ok(Box::new(OpenDeadLoad { load: self, values }))
    }
    fn name_of(&self, stencil: usize) -> String {
        format!("{} load '{}'", self.parts[stencil].on, self.name)
    }
}

/// A load at one instant.
struct OpenDeadLoad<'a> {
    load: &'a DeadLoad,
    values: Vec<f64>,
}

impl Attempt for OpenDeadLoad<'_> {
    fn scratch(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }
    fn stencils(&self, _: &[f64], out: &mut Stencils) -> Result<(), Failure> {
        self.load.parts.iter().for_each(|part| out.push(part.dofs.iter().copied(), 0));
        Ok(())
    }
    fn evaluate(&self, index: usize, _: &Stencil, _: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
        let shares = &self.load.parts[index].shares;
        for (force, &(value, share)) in local.force.iter_mut().zip(shares) {
            *force = self.values.get(value).map_or(0.0, |value| value * share);
        }
        Ok(0)
    }
}
