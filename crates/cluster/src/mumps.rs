//! Every matrix factorised by MUMPS, in the order that `frontal` finds, which this library's METIS makes better than what is built into
//! most packages of MUMPS: a third fewer flops in space, shared out more evenly.

use crate::petsc::{Result, ffi};
use crate::ranks::Ranks;
use asperity_core::solve::{LinearError, Unknowns, dense};
use asperity_core::system::{Csr, Shares};
use frontal::{NodeGraph, Options, PivotSigns, Work};
use std::os::raw::c_int;

/// MUMPS's name of all ranks there are.
const ALL: c_int = -987_654;
/// Its parameters (ICNTL), counted from one, with what they are set to: no words, distributed entries, a given order, the determinant.
const SET: [(usize, c_int); 9] = [(1, -1), (2, -1), (3, -1), (4, 0), (7, 1), (18, 3), (28, 1), (33, 1), (RESERVE, FEW)];
/// That of hundredths of its workspace beyond what it foresees. What is not used is taken all the same, so that there are few at first and
/// more where they were too few.
const RESERVE: usize = 14;
const FEW: c_int = 10;
const MORE: [c_int; 2] = [60, 200];
/// Its jobs.
const BEGIN: c_int = -1;
const END: c_int = -2;
const ANALYSE: c_int = 1;
const FACTORISE: c_int = 2;
const SOLVE: c_int = 3;
/// What it says (INFOG(1)): a workspace or buffer is too small, a pivot is zero, memory is not given, in the analysis or later.
const TOO_SMALL: [c_int; 6] = [-8, -9, -11, -14, -17, -20];
const SINGULAR: c_int = -10;
const REFUSED: [c_int; 3] = [-5, -7, -13];
/// What is said where memory is short.
const SHORT: &str =
    "the factor does not fit into the memory of the ranks; more ranks on more machines, or an iterative `solver.petsc`";

/// Place of the determinant (RINFOG(12)), a number below ten that a power of two multiplies.
const DETERMINANT: usize = 12 - 1;
/// Place of the workspace that it foresees with few hundredths more (INFO(8)), in numbers.
const FORESEEN: usize = 8 - 1;

/// An instance of MUMPS for a pattern.
pub struct Mumps {
    ranks: &'static Ranks,
    id: Box<ffi::DMUMPS_STRUC_C>,
    more: std::slice::Iter<'static, c_int>,
    /// Unknowns.
    count: usize,
    /// The workspace, none before the first factor.
    workspace: Vec<f64>,
    /// Row and column of each entry of this rank, counted from one, and the place of each unknown in the order on the first rank:
    /// MUMPS has their addresses.
    _lent: [Vec<c_int>; 3],
}

impl Mumps {
    /// Analyses the rows of this rank.
    pub fn new(ranks: &'static Ranks, pattern: &Csr, unknowns: &Unknowns, shares: &Shares) -> Result<Self> {
        let count = c_int::try_from(pattern.rows()).map_err(|_| "there are more unknowns than MUMPS counts to")?;
        let order = order(pattern, unknowns, shares)?;
        // SAFETY: numbers, and addresses of nothing.
        let mut id: Box<ffi::DMUMPS_STRUC_C> = Box::new(unsafe { std::mem::zeroed() });
        (id.par, id.sym, id.comm_fortran) = (1, 0, ALL);
        let rows = (0..count).flat_map(|row| pattern.row(row as usize).iter().map(move |_| row + 1)).collect();
        let columns = pattern.columns.iter().map(|&column| column as c_int + 1).collect();
        let lent = [rows, columns, order];
        let mut made = Self { ranks, id, more: MORE.iter(), count: count as usize, workspace: Vec::new(), _lent: lent };
        made.call(BEGIN).map_err(told)?;
        SET.iter().for_each(|&(parameter, value)| made.set(parameter, value));
        let [rows, columns, order] = &mut made._lent;
        (made.id.n, made.id.nnz_loc) = (count, rows.len() as i64);
        (made.id.irn_loc, made.id.jcn_loc) = (rows.as_mut_ptr(), columns.as_mut_ptr());
        made.id.perm_in = order.as_mut_ptr();
        made.call(ANALYSE).map_err(told)?;
        Ok(made)
    }

    fn set(&mut self, parameter: usize, value: c_int) {
        self.id.icntl[parameter - 1] = value;
    }

    /// Has all ranks do a job, and says what they come to where it is not done.
    fn call(&mut self, job: c_int) -> std::result::Result<(), c_int> {
        self.id.job = job;
        // SAFETY: what the instance has addresses of lives as long as it does, or as the call that reads it.
        unsafe { ffi::dmumps_c(&mut *self.id) };
        if self.id.infog[0] < 0 { Err(self.id.infog[0]) } else { Ok(()) }
    }

    /// Makes the factor of values; says whether there is one.
    pub fn factorise(&mut self, values: &[f64]) -> std::result::Result<bool, LinearError> {
        loop {
            // They are read, and only until the call is over.
            self.id.a_loc = values.as_ptr().cast_mut();
            self.give_workspace();
            match self.call(FACTORISE) {
                Ok(()) => return Ok(true),
                Err(SINGULAR) => return Ok(false),
                Err(code) if TOO_SMALL.contains(&code) => match self.more.next() {
                    Some(&more) => {
                        self.set(RESERVE, more);
                        self.workspace = Vec::new();
                    }
                    None => return Err(LinearError::Memory(SHORT.into())),
                },
                Err(code) if REFUSED.contains(&code) => return Err(LinearError::Memory(told(code))),
                Err(code) => return Err(LinearError::Other(told(code))),
            }
        }
    }

    /// What the sign of the determinant says of the pivots, whose own signs its factor L U does not tell.
    pub fn signs(&self) -> Result<Option<PivotSigns>> {
        let mut determinant = [self.id.rinfog[DETERMINANT]];
        self.share(&mut determinant)?;
        let signs = PivotSigns { symmetric: false, negative: usize::from(determinant[0] < 0.0) };
        Ok((determinant[0] != 0.0 && determinant[0].is_finite()).then_some(signs))
    }

    /// Gives it the workspace that it would take for itself, in huge pages where the system has them: its first touch takes a fifth of a
    /// factorisation else. More than it foresees stays untouched.
    fn give_workspace(&mut self) {
        if self.workspace.capacity() > 0 {
            return;
        }
        let with_few = f64::from(100 + self.id.icntl[RESERVE - 1]) / f64::from(100 + FEW);
        let count = (counted(self.id.info[FORESEEN]) * with_few).ceil();
        let told = if count <= f64::from(c_int::MAX) { count } else { -(count / MILLION).ceil() };
        self.workspace.reserve_exact(if told < 0.0 { -told * MILLION } else { told } as usize);
        frontal::ask_for_huge_pages(self.workspace.spare_capacity_mut());
        (self.id.wk_user, self.id.lwk_user) = (self.workspace.as_mut_ptr(), told as c_int);
    }

    /// Solves for right-hand sides that stand one after another and are whole on the first rank, which then has the solutions in their place.
    pub fn solve(&mut self, x: &mut [f64]) -> Result<()> {
        let sides = x.len() / self.count.max(1);
        (self.id.nrhs, self.id.lrhs, self.id.rhs) = (sides as c_int, self.count as c_int, x.as_mut_ptr());
        self.call(SOLVE).map_err(told)
    }

    /// Replaces a right-hand side by the solution, on all ranks.
    pub fn apply(&mut self, x: &mut [f64]) -> Result<()> {
        self.solve(x)?;
        self.share(x)
    }

    /// Gives all ranks what the first has.
    pub fn share(&self, x: &mut [f64]) -> Result<()> {
        let first = self.ranks.rank() == 0;
        let lengths: Vec<c_int> =
            (0..self.ranks.size()).map(|rank| if rank == 0 { x.len() as c_int } else { 0 }).collect();
        let piece = if first { x.to_vec() } else { Vec::new() };
        self.ranks.gather(&piece, &lengths, x)
    }

    /// What the factor took and a solution takes, in flops, a number of the factor that is moved counted as so many.
    pub fn work(&self, factor: f64, solution: f64) -> Work {
        // Those foreseen, which are the same on any number of ranks.
        let entries = counted(self.id.infog[19]);
        Work { factorisation: self.id.rinfog[0] + factor * entries, solution: solution * entries }
    }
}

impl Drop for Mumps {
    fn drop(&mut self) {
        // All ranks give back together; one that ends alone would wait for the others.
        if !crate::ranks::has_arrived() {
            let _ = self.call(END);
        }
    }
}

/// Numbers are told in millions, below zero, where they are large.
const MILLION: f64 = 1e6;

fn counted(told: c_int) -> f64 {
    if told < 0 { -MILLION * f64::from(told) } else { f64::from(told) }
}

fn told(code: c_int) -> String {
    if REFUSED.contains(&code) { SHORT.into() } else { format!("MUMPS: its error {code}") }
}

/// The place of each unknown in `frontal`'s order, counted from one, on the first rank; on the others nothing.
fn order(pattern: &Csr, unknowns: &Unknowns, shares: &Shares) -> Result<Vec<c_int>> {
    let (node_of, own) = (unknowns.owners(), shares.own());
    let mut weights = vec![0; node_of.last().map_or(0, |last| last + 1)];
    node_of.iter().for_each(|&node| weights[node] += 1);
    // How many neighbours each node of this rank has, and which.
    let (mut piece, mut row) = (Vec::new(), own.start);
    while row < own.end {
        let node = node_of[row];
        let mut others: Vec<usize> = Vec::new();
        while row < own.end && node_of[row] == node {
            others.extend(pattern.row(row).iter().map(|&column| node_of[column]).filter(|&other| other != node));
            row += 1;
        }
        others.sort_unstable();
        others.dedup();
        piece.push(others.len() as f64);
        piece.extend(others.iter().map(|&other| other as f64));
    }
    let all = match shares.with() {
        Some(with) => with.collect(&piece)?,
        None => piece,
    };
    if shares.rank() != 0 {
        return Ok(Vec::new());
    }
    let mut lists = all.into_iter();
    let (mut starts, mut neighbours) = (vec![0], Vec::new());
    while let Some(count) = lists.next() {
        neighbours.extend(lists.by_ref().take(count as usize).map(|other| other as u32));
        starts.push(neighbours.len());
    }
    let graph = NodeGraph { starts, neighbours, weights };
    let last = graph.rows_beyond(dense(pattern.rows()));
    let nodes = graph.order(&last, &Options::default()).map_err(|error| error.to_string())?;
    let mut first = vec![0; node_of.last().map_or(0, |last| last + 1)];
    let (mut next, mut places) = (1, vec![0; node_of.len()]);
    node_of.iter().enumerate().rev().for_each(|(unknown, &node)| first[node] = unknown);
    for node in nodes {
        let members = first[node as usize]..;
        for unknown in members.take_while(|&unknown| node_of.get(unknown) == Some(&(node as usize))) {
            places[unknown] = next;
            next += 1;
        }
    }
    Ok(places)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::start;
    use asperity_core::system::Dofs;
    use std::sync::Arc;

    #[test]
    fn a_workspace_that_is_too_small_is_made_larger() {
        let n = 300;
        let (dofs, free): (Dofs, Vec<usize>) = (Dofs::new(2, n / 2, 0), (0..n).collect());
        let (starts, columns) = ((0..=n).map(|row| n * row).collect(), (0..n * n).map(|k| k % n).collect());
        let pattern = Csr::new(Arc::new(starts), Arc::new(columns));
        let values: Vec<f64> = (0..n * n).map(|k| if k % (n + 1) == 0 { n as f64 } else { (k as f64).sin() }).collect();
        let shares = Shares::new(None, &dofs, &free);
        let mut mumps =
            Mumps::new(start().unwrap(), &pattern, &Unknowns { dofs: &dofs, free: &free }, &shares).unwrap();
        mumps.set(RESERVE, -90);
        assert!(mumps.factorise(&values).unwrap());
        assert!(mumps.more.len() < MORE.len());
        assert_eq!(mumps.signs().unwrap(), Some(PivotSigns { symmetric: false, negative: 0 }));
        let expected: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
        let mut x = pattern.times(&values, &expected);
        mumps.apply(&mut x).unwrap();
        assert!(x.iter().zip(&expected).all(|(x, expected)| (x - expected).abs() < 1e-10));
    }
}
