//! What each of several ranks owns of a model that they evaluate together.
//!
//! Of `n` free unknowns rank `r` of `p` owns those from the node or tool on that has number `n r / p`, with their rows of the matrix; of
//! the others what lies between. A chunk of stencils belongs to the rank of its first unknown, which says what it comes to: forces, new
//! history, energies, branches. For the rows of the matrix every rank evaluates all stencils that have an unknown of its own. All
//! sums are made in the order of the stencils, so that no bit depends on how many ranks there are.

use super::{Constraints, Dofs};
use crate::{Failure, FailureKind};
use std::fmt;
use std::ops::Range;

/// Ranks that run together. Each calls these methods in the same order as the others.
pub trait Communicator: Send + Sync {
    /// The number of this rank.
    fn rank(&self) -> usize;
    /// How many there are.
    fn size(&self) -> usize;
    /// Sees to it that all come here with the same numbers.
    ///
    /// # Errors
    /// That they have not, in words, on all of them, with what [`failed`](Self::failed) since they last did.
    fn agree(&self, numbers: &[f64]) -> Result<(), String>;
    /// Notes why an attempt failed on this rank, which the others hear of where they come to something else.
    fn failed(&self, _why: &str) {}
    /// The pieces of all ranks, one after another, and where each begins and the last ends.
    ///
    /// # Errors
    /// That some rank is elsewhere, in words, on all of them.
    fn gather(&self, piece: &[f64]) -> Result<(Vec<f64>, Vec<usize>), String>;
    /// The pieces of all ranks one after another on the first rank, on the others nothing.
    ///
    /// # Errors
    /// As those of [`gather`](Self::gather).
    fn collect(&self, piece: &[f64]) -> Result<Vec<f64>, String>;
}

/// The shares of all ranks in the unknowns.
#[derive(Clone, Default)]
pub struct Shares {
    /// The others, where there are any.
    with: Option<&'static dyn Communicator>,
    /// Where the free unknowns of each rank begin, and the last end.
    rows: Vec<usize>,
    /// The same of all unknowns.
    dofs: Vec<usize>,
}

impl fmt::Debug for Shares {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Shares({:?})", self.rows)
    }
}

impl Shares {
    /// The shares in these free unknowns, which ascend, of ranks that run together, or of the one that is alone.
    pub fn new(with: Option<&'static dyn Communicator>, dofs: &Dofs, free: &[usize]) -> Self {
        let size = with.map_or(1, Communicator::size);
        let begin =
            |rank: usize| free.get(free.len() * rank / size).map_or(dofs.count(), |&dof| dofs.first_of_owner(dof));
        let mut begins: Vec<usize> = (0..size).map(begin).chain([dofs.count()]).collect();
        begins[0] = 0;
        let rows = begins.iter().map(|begin| free.partition_point(|dof| dof < begin)).collect();
        Self { with, rows, dofs: begins }
    }

    /// The other ranks, where there are any.
    pub fn with(&self) -> Option<&'static dyn Communicator> {
        self.with
    }
    /// The number of this rank.
    pub fn rank(&self) -> usize {
        self.with.map_or(0, Communicator::rank)
    }
    /// Where the free unknowns of each rank begin, and the last end.
    pub fn rows(&self) -> &[usize] {
        &self.rows
    }
    /// The free unknowns of this rank.
    pub fn own(&self) -> Range<usize> {
        self.rows[self.rank()]..self.rows[self.rank() + 1]
    }
    /// The rank that has an unknown, free or not.
    pub fn owner(&self, dof: usize) -> usize {
        self.dofs.partition_point(|begin| *begin <= dof) - 1
    }
    /// Whether a stencil of these unknowns has rows of this rank.
    pub fn has(&self, constraints: &Constraints, dofs: &[usize]) -> bool {
        let own = self.own();
        dofs.iter().any(|&dof| constraints.followed(dof).any(|(row, _)| own.contains(&row)))
    }

    /// Completes a vector over the free unknowns of which this rank has found its own part.
    ///
    /// # Errors
    /// As those of [`Communicator::gather`].
    pub fn complete(&self, x: &mut [f64]) -> Result<(), String> {
        let Some(with) = self.with else { return Ok(()) };
        let (all, _) = with.gather(&x[self.own()])?;
        x.copy_from_slice(&all);
        Ok(())
    }

    /// Replaces each of some numbers, none of them negative, by the largest of all ranks.
    ///
    /// # Errors
    /// As those of [`Communicator::gather`].
    pub fn largest(&self, x: &mut [f64]) -> Result<(), String> {
        let Some(with) = self.with else { return Ok(()) };
        // Most of them are zero but on one rank.
        let known = x.iter().enumerate().filter(|(_, x)| **x != 0.0);
        let piece: Vec<f64> = known.flat_map(|(place, &x)| [place as f64, x]).collect();
        for pair in with.gather(&piece)?.0.chunks_exact(2) {
            let most = &mut x[pair[0] as usize];
            *most = most.max(pair[1]);
        }
        Ok(())
    }

    /// Whether any rank says yes.
    ///
    /// # Errors
    /// As those of [`Communicator::gather`].
    pub fn any(&self, yes: bool) -> Result<bool, String> {
        let mut said = [f64::from(u8::from(yes))];
        self.largest(&mut said)?;
        Ok(said[0] != 0.0)
    }
}

/// What one of several ranks said, with its number.
pub fn said(words: &str, rank: usize, size: usize) -> String {
    format!("{words} (rank {rank} of {size})")
}

/// Why ranks that have come apart do not go on.
pub fn apart(words: String) -> Failure {
    Failure::new(words).of(FailureKind::Apart)
}
