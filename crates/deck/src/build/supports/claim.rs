//! What conditions claim of the unknowns, step by step.

use crate::source::Place;
use asperity_core::mesh::ROUNDING;
use asperity_core::solve::Course;
use std::collections::BTreeMap;

/// What one condition claims.
#[derive(Debug, Clone)]
pub struct Claim {
    /// The condition, as the deck names it: `displacement.far_end`; nothing for nodes of no cell.
    pub by: String,
    /// Where the deck says it.
    pub place: Place,
    /// The unknowns.
    pub what: What,
    /// Where it leads them.
    pub course: Course,
}

/// What a claim is laid on.
#[derive(Debug, Clone)]
pub enum What {
    /// One unknown.
    Unknown(usize),
    /// A direction (a unit vector) of the node whose first unknown this is.
    Direction(usize, [f64; 3]),
}

/// Values of the unknowns at the beginning of a step, where they are known: all zero at first, later those of the
/// unknowns that a claim led.
pub struct Known(Vec<Option<f64>>);

impl Known {
    /// All zero.
    pub fn new(count: usize) -> Self {
        Self(vec![Some(0.0); count])
    }
    /// Where an unknown is, if that is known.
    pub fn at(&self, dof: usize) -> Option<f64> {
        self.0[dof]
    }
    /// A claim that leads its unknown to where it is holds it: so that two claims of the same can be seen to agree.
    pub fn settle(&self, claim: &mut Claim) {
        if let (Some(dof), Course::To(end, _)) = (claim.single(), &claim.course)
            && self.0[dof] == Some(*end)
        {
            claim.course = Course::Hold;
        }
    }
    /// Passes a step with these claims.
    pub fn pass<'c>(&mut self, claims: impl Iterator<Item = &'c Claim>) {
        let mut after = vec![None; self.0.len()];
        for claim in claims {
            let Some(dof) = claim.single() else { continue };
            after[dof] = match &claim.course {
                Course::Hold => self.0[dof],
                Course::To(end, amplitude) if amplitude.value(1.0) == 1.0 => Some(*end),
                Course::To(end, amplitude) => self.0[dof].map(|start| start + (end - start) * amplitude.value(1.0)),
            };
        }
        self.0 = after;
    }
}

/// Claims by the condition and the component that make them, so that a later step finds them again.
pub type Claims = BTreeMap<(String, usize), Vec<Claim>>;

impl Claim {
    /// Whether any other claim goes before it: it only keeps what nothing else holds, the nodes of no cell.
    pub fn is_weak(&self) -> bool {
        self.by.is_empty()
    }
    /// The only unknown that is claimed, if it is one.
    pub fn single(&self) -> Option<usize> {
        match &self.what {
            What::Unknown(dof) => Some(*dof),
            What::Direction(first, normal) => {
                let axis = (0..3).find(|&axis| 1.0 - normal[axis].abs() < ROUNDING * ROUNDING)?;
                // Against the axis, the course would have to be turned about as well.
                (normal[axis] > 0.0 || self.course == Course::Hold).then_some(first + axis)
            }
        }
    }
}

/// What was moved stays where it came to.
pub fn hold(claims: &mut Claims) {
    claims.values_mut().flatten().for_each(|claim| claim.course = Course::Hold);
}
