//! The compliance of contact: what forces on the unknowns near contact do there, by the factor there is.
//!
//! Column `p` is `K0^-1 e_p` at the unknowns near contact, found when it is first asked for and kept as long as the factor of `K0`.
//! Near contact the matrix jumps, elsewhere it changes little; with the columns of the unknowns of closed points at hand the factor
//! is put right for the jumps (see [`frontal::LowRankChange`]), and so is what the columns say.

use super::{LinearError, LinearSolver};
use crate::system::Near;
use frontal::{LowRankChange, Sparse, subtract_product};
use pulp::Arch;
use std::collections::{BTreeMap, BTreeSet};

/// Columns of the inverse of the matrix that was factorised last, and its rows, near contact.
#[derive(Debug, Default)]
pub(super) struct ContactCompliance {
    /// Unknowns near contact, ascending.
    pub at: Vec<usize>,
    /// Those of closed points when it was factorised.
    pub closed: BTreeSet<usize>,
    /// Motions `at` all under a unit of force.
    pub columns: BTreeMap<usize, Vec<f64>>,
    /// Loads that were solved for instead of columns since the factor was made.
    loads: usize,
    /// Unknowns whose rows have changed, and how.
    pub change: Option<(Vec<usize>, LowRankChange)>,
    /// Whether the factor is to serve for more than one matrix.
    stays: bool,
}

/// An engine, and the number of unknowns that it solves for.
pub(super) type Engine<'e> = (&'e mut (dyn LinearSolver + 'static), usize);

impl ContactCompliance {
    /// With the factor of a matrix, of which the unknowns near contact and those of closed points are known; the latter where it is
    /// to serve for more than that matrix.
    pub fn new(at: Vec<usize>, closed: Option<BTreeSet<usize>>) -> Self {
        Self { at, stays: closed.is_some(), closed: closed.unwrap_or_default(), ..Self::default() }
    }

    /// What must be known to go on from here.
    pub fn near(&self) -> Near {
        let closed = self.closed.iter().copied().collect();
        Near { at: self.at.clone(), closed, columns: self.columns.keys().copied().collect(), loads: self.loads }
    }

    /// With a factor of which so much was known.
    ///
    /// # Errors
    /// When a solution with the factor fails, or a column is none of those near contact.
    pub fn resume(near: &Near, engine: Engine) -> Result<Self, LinearError> {
        let mut resumed = Self::new(near.at.clone(), Some(near.closed.iter().copied().collect()));
        resumed.loads = near.loads;
        resumed.find(&near.columns.iter().copied().collect(), engine)?;
        Ok(resumed)
    }

    /// Sees to it that the columns reach all of these unknowns, which ascend.
    pub fn cover(&mut self, unknowns: &[usize]) {
        if unknowns.iter().any(|unknown| self.at.binary_search(unknown).is_err()) {
            self.at.extend_from_slice(unknowns);
            self.at.sort_unstable();
            self.at.dedup();
            self.columns.clear();
            self.change = None;
        }
    }

    /// Finds the columns that are missing.
    pub fn find(&mut self, unknowns: &BTreeSet<usize>, engine: Engine) -> Result<(), LinearError> {
        let missing = unknowns.iter().copied().filter(|unknown| !self.columns.contains_key(unknown));
        let missing: Vec<usize> = missing.collect();
        let loads: Vec<Sparse> = missing.iter().map(|&unknown| vec![(unknown, 1.0)]).collect();
        let motions = self.solve(&loads, engine)?;
        self.columns.extend(missing.into_iter().zip(motions));
        Ok(())
    }

    /// Motions under loads, by the factor.
    fn solve(&self, loads: &[Sparse], (engine, unknowns): Engine) -> Result<Vec<Vec<f64>>, LinearError> {
        let (count, mut motions) = (self.at.len(), vec![0.0; loads.len() * self.at.len()]);
        if !engine.compliance(loads, &self.at, &mut motions)? {
            one_by_one(engine, unknowns, (loads, &self.at), &mut motions)?;
        }
        Ok((0..loads.len()).map(|k| motions[k * count..(k + 1) * count].to_vec()).collect())
    }

    /// Where an unknown stands among [`at`](Self::at).
    pub fn place(&self, unknown: usize) -> usize {
        self.at.binary_search(&unknown).expect("the columns reach all of contact")
    }

    /// Motions of the unknowns `wanted` under loads, unknown after unknown, by the columns where no more of those are missing than
    /// there are loads, and were before: so that what is solved for is at most twice what it would be, had it been known
    /// how long the factor serves.
    ///
    /// # Errors
    /// When a solution with the factor fails.
    pub fn motions(&mut self, loads: &[Sparse], wanted: &[usize], engine: Engine) -> Result<Vec<f64>, LinearError> {
        let wanted: Vec<usize> = wanted.iter().map(|&unknown| self.place(unknown)).collect();
        let unknowns: BTreeSet<usize> = loads.iter().flatten().map(|&(unknown, _)| unknown).collect();
        let missing = unknowns.iter().filter(|unknown| !self.columns.contains_key(unknown)).count();
        let motions = if !self.stays || missing > self.loads + loads.len() {
            self.loads += loads.len();
            self.solve(loads, engine)?
        } else {
            self.find(&unknowns, engine)?;
            loads.iter().map(|load| self.sum(load)).collect()
        };
        let rows = transposed(&motions, self.at.len());
        let mut right = Vec::with_capacity(wanted.len() * loads.len());
        wanted.iter().for_each(|place| right.extend_from_slice(&rows[place * loads.len()..][..loads.len()]));
        if let Some((unknowns, change)) = &self.change {
            self.put_right((unknowns, change), (&rows, loads.len()), (&mut right, &wanted));
        }
        Ok(right)
    }

    /// The motion under a load, from the columns.
    fn sum(&self, load: &Sparse) -> Vec<f64> {
        let mut sum = vec![0.0; self.at.len()];
        load.iter().for_each(|(unknown, force)| add_multiple(&mut sum, *force, &self.columns[unknown]));
        sum
    }

    /// Turns `width` motions by the factorised matrix into those by the changed one, at the places `wanted`.
    fn put_right(
        &self,
        (unknowns, change): (&[usize], &LowRankChange),
        (motions, width): (&[f64], usize),
        (right, wanted): (&mut [f64], &[usize]),
    ) {
        let weights = change.weights_together(width, |unknown| &motions[self.place(unknown) * width..][..width]);
        let mut columns = Vec::with_capacity(unknowns.len() * wanted.len());
        for column in unknowns.iter().map(|unknown| &self.columns[unknown]) {
            columns.extend(wanted.iter().map(|&place| column[place]));
        }
        subtract_product(right, &columns, &weights, width);
    }
}

/// What an engine without a way of its own does for loads: a whole solution each.
fn one_by_one(
    engine: &mut dyn LinearSolver,
    unknowns: usize,
    (loads, at): (&[Sparse], &[usize]),
    motions: &mut [f64],
) -> Result<(), LinearError> {
    let mut whole = vec![0.0; unknowns];
    for (load, motion) in loads.iter().zip(motions.chunks_mut(at.len().max(1))) {
        whole.fill(0.0);
        load.iter().for_each(|&(unknown, force)| whole[unknown] += force);
        engine.precondition(None, &mut whole)?;
        motion.iter_mut().zip(at).for_each(|(motion, &unknown)| *motion = whole[unknown]);
    }
    Ok(())
}

/// Vectors of this length, number after number.
fn transposed(vectors: &[Vec<f64>], length: usize) -> Vec<f64> {
    let mut rows = Vec::with_capacity(vectors.len() * length);
    (0..length).for_each(|k| rows.extend(vectors.iter().map(|vector| vector[k])));
    rows
}

/// `y <- y + factor x`.
pub(super) fn add_multiple(y: &mut [f64], factor: f64, x: &[f64]) {
    Arch::new().dispatch(
        #[inline(always)]
        || y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x),
    );
}
