//! What forces on the unknowns near contact do there, by the factor there is.
//!
//! Column `p` is `K0^-1 e_p` at the unknowns of the stencils that bend, found when it is first asked for and kept as long
//! as the factor of `K0`. Where stencils bend the matrix jumps, elsewhere it changes little; with the columns of the
//! unknowns of closed stencils at hand the factor is put right for the jumps (see [`frontal::Change`]), and so is what the
//! columns say.

use super::linear::{LinearError, LinearSolver};
use crate::Failure;
use crate::system::{Assembly, Attempt, Constraints, Kink, Kinks, Near};
use frontal::{Change, Sparse, subtract_product};
use pulp::Arch;
use std::collections::{BTreeMap, BTreeSet};

/// Columns of the inverse of the matrix that was factorised last, and its rows, near contact.
#[derive(Debug, Default)]
pub(super) struct Influences {
    /// Unknowns of the stencils near contact, and the free ones that they follow, ascending.
    dofs: Vec<usize>,
    pub(super) at: Vec<usize>,
    /// Free unknowns of closed stencils when it was factorised.
    pub(super) closed: BTreeSet<usize>,
    /// Motions `at` all under a unit of force.
    pub(super) columns: BTreeMap<usize, Vec<f64>>,
    /// Loads that were solved for instead of columns since the factor was made.
    loads: usize,
    /// Unknowns whose rows have changed, and how.
    pub(super) change: Option<(Vec<usize>, Change)>,
    /// Whether the factor is to serve for more than one matrix.
    stays: bool,
}

/// What the factor and the stencils are asked with.
#[derive(Clone, Copy)]
pub(super) struct Site<'a> {
    pub attempts: &'a [Box<dyn Attempt + 'a>],
    pub kinks: &'a Kinks,
    pub constraints: &'a Constraints,
}

impl<'a> Site<'a> {
    pub fn of(assembly: &'a Assembly<'a>, kinks: &'a Kinks) -> Self {
        Self { attempts: &assembly.attempts, kinks, constraints: assembly.constraints }
    }

    /// Forces of a unit of stress on free unknowns.
    fn forces(&self, kink: &Kink, coordinate: usize) -> Sparse {
        let forces = self.kinks.forces(kink, coordinate);
        forces.flat_map(|(dof, force)| self.constraints.followed(dof).map(move |(i, c)| (i, c * force))).collect()
    }

    /// Free unknowns of the stencils whose stresses have slopes.
    pub fn closed(&self) -> Result<BTreeSet<usize>, Failure> {
        let mut closed = BTreeSet::new();
        for kink in self.kinks.list() {
            let slopes = self.attempts[kink.term].answer(kink.stencil, &kink.y)?.slopes;
            if slopes.as_flattened().iter().any(|slope| *slope != 0.0) {
                closed.extend(self.forces(kink, 0).into_iter().map(|(unknown, _)| unknown));
            }
        }
        Ok(closed)
    }
}

impl Influences {
    /// Begins with the factor of a matrix, which is to serve for more than that one if it `stays`.
    ///
    /// # Errors
    /// When a law cannot answer.
    pub fn begin(&mut self, site: Site, near: Vec<usize>, stays: bool) -> Result<(), Failure> {
        *self = Self { dofs: near, stays, ..Self::default() };
        self.find_free(site.constraints);
        if stays {
            self.closed = site.closed()?;
        }
        Ok(())
    }

    /// What must be known to go on from here.
    pub fn near(&self) -> Near {
        let closed = self.closed.iter().copied().collect();
        Near { dofs: self.dofs.clone(), closed, columns: self.columns.keys().copied().collect(), loads: self.loads }
    }

    /// Goes on with a factor of which so much was known.
    ///
    /// # Errors
    /// When a solution with the factor fails.
    pub fn resume(
        &mut self,
        near: &Near,
        constraints: &Constraints,
        solver: &dyn LinearSolver,
    ) -> Result<(), LinearError> {
        let closed = near.closed.iter().copied().collect();
        *self = Self { dofs: near.dofs.clone(), closed, stays: true, loads: near.loads, ..Self::default() };
        self.find_free(constraints);
        self.find(&near.columns.iter().copied().collect(), solver)
    }

    /// Forgets all: the unknowns may be numbered anew.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    fn find_free(&mut self, constraints: &Constraints) {
        self.dofs.sort_unstable();
        self.dofs.dedup();
        self.at = self.dofs.iter().flat_map(|&dof| constraints.followed(dof)).map(|(i, _)| i).collect();
        self.at.sort_unstable();
        self.at.dedup();
    }

    /// Sees to it that the columns reach all stencils.
    pub fn cover(&mut self, site: Site) {
        if site.kinks.dofs().iter().any(|dof| self.dofs.binary_search(dof).is_err()) {
            self.dofs.extend_from_slice(site.kinks.dofs());
            self.find_free(site.constraints);
            self.columns.clear();
            self.change = None;
        }
    }

    /// Finds the columns that are missing.
    pub(super) fn find(&mut self, unknowns: &BTreeSet<usize>, solver: &dyn LinearSolver) -> Result<(), LinearError> {
        let missing = unknowns.iter().copied().filter(|unknown| !self.columns.contains_key(unknown));
        let missing: Vec<usize> = missing.collect();
        let loads: Vec<Sparse> = missing.iter().map(|&unknown| vec![(unknown, 1.0)]).collect();
        let motions = self.solve(&loads, solver)?;
        self.columns.extend(missing.into_iter().zip(motions));
        Ok(())
    }

    /// Motions under loads, by the factor.
    fn solve(&self, loads: &[Sparse], solver: &dyn LinearSolver) -> Result<Vec<Vec<f64>>, LinearError> {
        let (count, mut motions) = (self.at.len(), vec![0.0; loads.len() * self.at.len()]);
        solver.influence(loads, &self.at, &mut motions)?;
        Ok((0..loads.len()).map(|k| motions[k * count..(k + 1) * count].to_vec()).collect())
    }

    /// Where a free unknown stands among [`at`](Self::at).
    pub(super) fn place(&self, unknown: usize) -> usize {
        self.at.binary_search(&unknown).expect("the columns reach all stencils")
    }

    /// Calls `take` with the motion of the unknowns of all kinks under a unit of each stress, given by kink and coordinate.
    ///
    /// # Errors
    /// When a solution with the factor fails.
    pub fn respond(
        &mut self,
        stresses: &[(usize, usize)],
        (site, solver): (Site, &dyn LinearSolver),
        mut take: impl FnMut(&[f64]),
    ) -> Result<(), LinearError> {
        let load = |&(kink, coordinate): &(usize, usize)| site.forces(&site.kinks.list()[kink], coordinate);
        let loads: Vec<Sparse> = stresses.iter().map(load).collect();
        let dofs: BTreeSet<usize> = site.kinks.dofs().iter().copied().collect();
        let followed = |&dof: &usize| site.constraints.followed(dof).map(move |(i, c)| (dof, i, c));
        let follow: Vec<_> = dofs.iter().flat_map(followed).collect();
        let mut wanted: Vec<usize> = follow.iter().map(|(_, unknown, _)| self.place(*unknown)).collect();
        wanted.sort_unstable();
        wanted.dedup();
        let motions = self.motions(&loads, &wanted, solver)?;
        let place = |unknown: &usize| wanted.binary_search(&self.place(*unknown)).expect("it is wanted");
        let follow: Vec<_> = follow.iter().map(|(dof, unknown, c)| (*dof, place(unknown), *c)).collect();
        let mut full = vec![0.0; site.constraints.count()];
        for number in 0..loads.len() {
            dofs.iter().for_each(|&dof| full[dof] = 0.0);
            follow.iter().for_each(|(dof, place, c)| full[*dof] += c * motions[place * loads.len() + number]);
            take(&full);
        }
        Ok(())
    }

    /// Motions at the places `wanted` under loads, place after place, by the columns where no more of those are missing than
    /// there are loads, and were before: so that what is solved for is at most twice what it would be, had it been known
    /// how long the factor serves.
    fn motions(
        &mut self,
        loads: &[Sparse],
        wanted: &[usize],
        solver: &dyn LinearSolver,
    ) -> Result<Vec<f64>, LinearError> {
        let unknowns: BTreeSet<usize> = loads.iter().flatten().map(|&(unknown, _)| unknown).collect();
        let missing = unknowns.iter().filter(|unknown| !self.columns.contains_key(unknown)).count();
        let motions = if !self.stays || missing > self.loads + loads.len() {
            self.loads += loads.len();
            self.solve(loads, solver)?
        } else {
            self.find(&unknowns, solver)?;
            loads.iter().map(|load| self.sum(load)).collect()
        };
        let rows = transposed(&motions, self.at.len());
        let mut right = Vec::with_capacity(wanted.len() * loads.len());
        wanted.iter().for_each(|place| right.extend_from_slice(&rows[place * loads.len()..][..loads.len()]));
        if let Some((unknowns, change)) = &self.change {
            self.put_right((unknowns, change), (&rows, loads.len()), (&mut right, wanted));
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
        (unknowns, change): (&[usize], &Change),
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
