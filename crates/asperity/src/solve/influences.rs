//! What forces on the unknowns near contact do there, by the factor there is, and what has changed of the matrix near
//! contact since it was factorised.
//!
//! Column `p` is `K0^-1 e_p` at the unknowns of the stencils that bend, found when it is first asked for and kept as long
//! as the factor of `K0`. Where stencils bend the matrix jumps, elsewhere it changes little; with the columns of the
//! unknowns of closed stencils at hand the factor is put right for the jumps (see [`frontal::Change`]), and so is what the
//! columns say.

use super::linear::{LinearError, LinearSolver};
use crate::Failure;
use crate::system::{Assembly, Attempt, Constraints, Csr, Kink, Kinks, Workspace};
use frontal::{Change, Sparse};
use pulp::Arch;
use std::collections::{BTreeMap, BTreeSet};

/// Most unknowns for which the factor is put right, and the part of its largest value by which a row must have changed.
const MOST: usize = 1024;
const CHANGED: f64 = 0.01;

/// Columns of the inverse of the matrix that was factorised last, and its rows, near contact.
#[derive(Debug, Default)]
pub(super) struct Influences {
    /// Unknowns of the stencils near contact, and the free ones that they follow, ascending.
    dofs: Vec<usize>,
    at: Vec<usize>,
    /// Free unknowns of closed stencils when it was factorised.
    closed: BTreeSet<usize>,
    /// Motions `at` all under a unit of force.
    columns: BTreeMap<usize, Vec<f64>>,
    /// Unknowns whose rows have changed, and how.
    change: Option<(Vec<usize>, Change)>,
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
    fn closed(&self) -> Result<BTreeSet<usize>, Failure> {
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

/// The matrix at hand.
#[derive(Clone, Copy)]
pub(super) struct Matrix<'a> {
    pub pattern: &'a Csr,
    pub values: &'a [f64],
}

impl<'a> Matrix<'a> {
    pub fn of(workspace: &'a Workspace, values: &'a [f64]) -> Self {
        Self { pattern: workspace.pattern(), values }
    }

    fn row(&self, row: usize) -> (&[usize], &[f64]) {
        let range = self.pattern.starts[row]..self.pattern.starts[row + 1];
        (&self.pattern.columns[range.clone()], &self.values[range])
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
    fn find(&mut self, unknowns: &BTreeSet<usize>, solver: &dyn LinearSolver) -> Result<(), LinearError> {
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
    fn place(&self, unknown: usize) -> usize {
        self.at.binary_search(&unknown).expect("the columns reach all stencils")
    }

    /// Calls `take` with the motion of all unknowns near contact under a unit of each stress, given by kink and coordinate.
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
        let mut full = vec![0.0; site.constraints.count()];
        for motions in self.motions(&loads, solver)? {
            for &dof in &self.dofs {
                full[dof] = site.constraints.followed(dof).map(|(i, c)| c * motions[self.place(i)]).sum();
            }
            take(&full);
        }
        Ok(())
    }

    /// Motions under loads, by the columns where fewer of those are missing.
    fn motions(&mut self, loads: &[Sparse], solver: &dyn LinearSolver) -> Result<Vec<Vec<f64>>, LinearError> {
        let unknowns: BTreeSet<usize> = loads.iter().flatten().map(|&(unknown, _)| unknown).collect();
        let missing = unknowns.iter().filter(|unknown| !self.columns.contains_key(unknown)).count();
        let mut motions = if !self.stays || missing > loads.len() {
            self.solve(loads, solver)?
        } else {
            self.find(&unknowns, solver)?;
            loads.iter().map(|load| self.sum(load)).collect()
        };
        self.put_right(&mut motions);
        Ok(motions)
    }

    /// The motion under a load, from the columns.
    fn sum(&self, load: &Sparse) -> Vec<f64> {
        let mut sum = vec![0.0; self.at.len()];
        load.iter().for_each(|(unknown, force)| add_multiple(&mut sum, *force, &self.columns[unknown]));
        sum
    }

    /// Turns motions by the factorised matrix into those by the changed one.
    fn put_right(&self, motions: &mut [Vec<f64>]) {
        let Some((unknowns, change)) = &self.change else { return };
        let weights: Vec<_> = motions.iter().map(|m| change.weights(|unknown| m[self.place(unknown)])).collect();
        for (k, unknown) in unknowns.iter().enumerate() {
            let column = &self.columns[unknown];
            motions.iter_mut().zip(&weights).for_each(|(motion, weights)| add_multiple(motion, -weights[k], column));
        }
    }

    /// What has changed of the matrix among the unknowns of stencils that are closed or were; None if that is nothing, or
    /// too much.
    ///
    /// # Errors
    /// When a law cannot answer, or a solution with the factor fails.
    pub fn change(
        &mut self,
        (site, matrix): (Site, Matrix),
        solver: &dyn LinearSolver,
    ) -> Result<Option<Change>, Failure> {
        self.change = None;
        let mut near: BTreeSet<usize> = self.closed.union(&site.closed()?).copied().collect();
        near.retain(|unknown| self.at.binary_search(unknown).is_ok());
        let changed = near.iter().filter_map(|&row| {
            let change = difference(matrix.row(row), solver.row(row), &near)?;
            Some((row, change))
        });
        let (unknowns, rows): (BTreeSet<usize>, Vec<Sparse>) = changed.unzip();
        if unknowns.is_empty() || unknowns.len() > MOST {
            return Ok(None);
        }
        self.find(&unknowns, solver).map_err(|error| Failure::new(error.to_string()))?;
        let unknowns: Vec<usize> = unknowns.into_iter().collect();
        let forces = unknowns.iter().map(|&unknown| vec![(unknown, 1.0)]).collect();
        let capacitance = self.capacitance(&rows, &unknowns);
        let change = Change::new(forces, rows, capacitance);
        self.change = change.clone().map(|change| (unknowns, change));
        Ok(change)
    }

    /// `I + V^T K0^-1 U` by rows.
    fn capacitance(&self, rows: &[Sparse], unknowns: &[usize]) -> Vec<f64> {
        let columns: Vec<&Vec<f64>> = unknowns.iter().map(|unknown| &self.columns[unknown]).collect();
        let mut inverse: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
        let mut entries = vec![0.0; rows.len() * rows.len()];
        for (i, (row, sums)) in rows.iter().zip(entries.chunks_exact_mut(rows.len())).enumerate() {
            sums[i] = 1.0;
            for &(unknown, value) in row {
                let place = self.place(unknown);
                let inverse = inverse.entry(place).or_insert_with(|| columns.iter().map(|c| c[place]).collect());
                add_multiple(sums, value, inverse);
            }
        }
        entries
    }
}

/// `y <- y + factor x`.
fn add_multiple(y: &mut [f64], factor: f64, x: &[f64]) {
    Arch::new().dispatch(
        #[inline(always)]
        || y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x),
    );
}

/// What has changed of a row among these unknowns, if that is much.
fn difference((columns, now): (&[usize], &[f64]), then: Sparse, among: &BTreeSet<usize>) -> Option<Sparse> {
    let largest = now.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let mut changed: BTreeMap<usize, f64> = columns.iter().copied().zip(now.iter().copied()).collect();
    then.into_iter().for_each(|(column, value)| *changed.entry(column).or_default() -= value);
    changed.retain(|column, value| *value != 0.0 && among.contains(column));
    changed.values().any(|value| value.abs() > CHANGED * largest).then(|| changed.into_iter().collect())
}
