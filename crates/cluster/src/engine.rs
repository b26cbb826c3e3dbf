//! The linear solver of a run: MUMPS, or PETSc's KSP as a deck says.

use crate::mumps::Mumps;
use crate::petsc::{DECIDE, KSP, Mat, Owned, Result, Vector, checked, ffi, int, text};
use crate::ranks::{Ranks, Rendezvous, start};
use crate::rows::{Rows, with_held};
use asperity_core::solve::{Factored, LinearError, LinearSolver, Problem, Unknowns};
use asperity_core::system::{Csr, Shares};
use frontal::{PivotSigns, Work};
use std::os::raw::c_int;
use std::ptr;
use std::sync::Arc;

/// Part of the right-hand side that an iterative solution may leave where the options say nothing else, and its iterations.
const LEFT: f64 = 1e-8;
const MOST: usize = 1000;
/// Componentwise backward errors at which a direct solution is good enough and beyond which it is none, and how often it is
/// refined at most: those of `frontal`.
const GOOD: f64 = 1e-14;
const ACCEPTABLE: f64 = 1e-10;
const REFINEMENTS: usize = 3;
/// A matrix is singular that shrinks some vector by this factor once its rows and columns are of one size: that of `frontal`.
const SINGULAR: f64 = 1e-12;
/// Solutions with one vector that look for the motion it shrinks most, and most motions that are named.
const LOOKS: usize = 3;
const MOTIONS: usize = 24;
/// What is added to the diagonal of a matrix without a factor, to find out why it has none.
const SHIFT: f64 = 1e-13;
/// What moving a number of the factor counts in flops, as it is made and as it solves: those of `frontal`.
const FACTOR_MOVED: f64 = 200.0;
const SOLUTION_MOVED: f64 = 30.0;
/// Loads that are solved for together.
const TOGETHER: usize = 32;

/// A linear solver whose matrices are spread over all ranks; each rank gives its own rows, and gets the same solution.
pub struct Petsc {
    ranks: Result<&'static Ranks>,
    options: Option<Arc<str>>,
    /// Where the nodes are, in space.
    places: Option<Vec<[f64; 3]>>,
    told: bool,
    system: Option<System>,
}

/// A pattern with what was made for it.
struct System {
    ranks: &'static Ranks,
    shares: Shares,
    engine: Engine,
    /// This rank's rows.
    pattern: Csr,
    values: Vec<f64>,
    /// One over the root of the largest entry of each row: `S A S` has rows and columns of one size.
    scale: Vec<f64>,
    direct: bool,
    factorised: bool,
}

/// What solves a system.
enum Engine {
    Mumps(Mumps),
    Petsc(Ksp),
}

/// What PETSc made for a pattern.
struct Ksp {
    ranks: &'static Ranks,
    rows: Rows,
    lengths: Vec<c_int>,
    /// Entries that hold places without an unknown.
    held: Vec<usize>,
    right: Owned<ffi::_p_Vec>,
    solution: Owned<ffi::_p_Vec>,
    solver: Owned<ffi::_p_KSP>,
    matrix: Owned<ffi::_p_Mat>,
}

// SAFETY: PETSc is called by one thread at a time, for which MPI is initialised.
unsafe impl Send for Petsc {}

impl Petsc {
    /// A solver for the systems of a problem.
    pub fn new(problem: &Problem) -> Self {
        let mut places = vec![[0.0; 3]; problem.dofs.nodes()];
        problem.wholes.iter().flat_map(|whole| whole.places()).for_each(|(node, x)| places[*node] = x.0);
        let places = (problem.dofs.per_node() == 3).then_some(places);
        Self { places, ..Self::with(problem.newton.engine.clone()) }
    }
    /// A solver with these options, which knows nothing of where unknowns are.
    pub fn with(options: Option<Arc<str>>) -> Self {
        Self { ranks: start(), options, places: None, told: false, system: None }
    }

    fn system(&mut self) -> std::result::Result<&mut System, LinearError> {
        self.system.as_mut().ok_or_else(|| LinearError::Other("nothing is analysed".into()))
    }

    fn prepare(&mut self, pattern: &Csr, unknowns: &Unknowns) -> Result<()> {
        // What was there goes first.
        self.system = None;
        let ranks = self.ranks.clone()?;
        ranks.agree(Rendezvous::Pattern, &[pattern.rows() as f64])?;
        let shares = Shares::new(crate::others(), unknowns.dofs, unknowns.free);
        let Some(options) = &self.options else {
            let engine = Engine::Mumps(Mumps::new(ranks, pattern, unknowns, &shares)?);
            self.system = Some(System::new(ranks, shares, engine, pattern, true));
            return Ok(());
        };
        if !std::mem::replace(&mut self.told, true) {
            let words = text(options);
            // SAFETY: it takes a copy of the words.
            checked(unsafe { ffi::PetscOptionsInsertString(ptr::null_mut(), words.as_ptr()) })?;
        }
        let rows = Rows::new(unknowns, &shares);
        let places = self.places.as_ref().map(|nodes| {
            let mut own = vec![0.0; rows.own().len()];
            for (&place, &dof) in rows.places.iter().zip(unknowns.free).filter(|(place, _)| rows.own().contains(place))
            {
                let block = (place - rows.own().start) / 3 * 3;
                own[block..block + 3].copy_from_slice(nodes.get(dof / 3).unwrap_or(&[0.0; 3]));
            }
            own
        });
        let (engine, direct) = Ksp::new(ranks, rows, pattern, places.as_deref())?;
        self.system = Some(System::new(ranks, shares, Engine::Petsc(engine), pattern, direct));
        Ok(())
    }

    /// The factorised system, for a right-hand side on which all ranks agree.
    fn checked(&mut self, rhs: &[f64]) -> std::result::Result<&mut System, LinearError> {
        let system = self.system()?;
        if !system.factorised {
            return Err(LinearError::Other("nothing is factorised".into()));
        }
        system.ranks.agree(Rendezvous::Forces, rhs).map_err(LinearError::Input)?;
        if rhs.iter().any(|force| !force.is_finite()) {
            return Err(LinearError::NotFinite("the forces are not finite".into()));
        }
        Ok(system)
    }

    /// Whether an option of the deck was asked for by nobody, once all that may ask has.
    fn unasked(&self) -> std::result::Result<(), LinearError> {
        let (mut count, mut names, mut values) = (0, ptr::null_mut(), ptr::null_mut());
        // SAFETY: PETSc lends lists of texts, which go back.
        let names: Vec<String> = unsafe {
            checked(ffi::PetscOptionsLeftGet(ptr::null_mut(), &mut count, &mut names, &mut values))
                .map_err(LinearError::Other)?;
            let name = |k: usize| std::ffi::CStr::from_ptr(*names.add(k)).to_string_lossy().into_owned();
            let found = (0..count as usize).map(name).collect();
            ffi::PetscOptionsLeftRestore(ptr::null_mut(), &mut count, &mut names, &mut values);
            found
        };
        let said = |name: &&String| {
            let words = self.options.as_deref().unwrap_or_default().split_whitespace();
            words.filter_map(|word| word.strip_prefix('-')).any(|word| word == name.as_str())
        };
        match names.iter().find(said) {
            None => Ok(()),
            Some(name) => Err(LinearError::Input(format!(
                "`solver.petsc` says `-{name}`, which nothing that it chooses has a use for: see PETSc's `-help`"
            ))),
        }
    }
}

impl Ksp {
    /// The objects for a pattern, and whether they factorise.
    fn new(ranks: &'static Ranks, rows: Rows, pattern: &Csr, places: Option<&[f64]>) -> Result<(Self, bool)> {
        let entries = rows.entries(pattern)?;
        let (own, all, block) = (int(rows.own().len())?, int(rows.count())?, int(rows.block)?);
        // SAFETY: the lists are those of the rows that the sizes say, and are copied; what is written is taken as ours.
        unsafe {
            let world = ffi::PETSC_COMM_WORLD;
            let [starts, columns] = [&entries.starts, &entries.columns].map(|list| list.as_ptr());
            let zeros = vec![0.0; entries.columns.len()];
            let make = |raw: *mut Mat| {
                ffi::MatCreateMPIAIJWithArrays(world, own, own, all, all, starts, columns, zeros.as_ptr(), raw)
            };
            let matrix = Owned::made(make, ffi::MatDestroy)?;
            drop(zeros);
            let held = entries.held;
            checked(ffi::MatSetBlockSize(matrix.raw, block))?;
            if let Some(places) = places {
                rigid_motions(&matrix, places, all)?;
            }
            let solver = Owned::made(|raw: *mut KSP| ffi::KSPCreate(world, raw), ffi::KSPDestroy)?;
            checked(ffi::KSPSetOperators(solver.raw, matrix.raw, matrix.raw))?;
            checked(ffi::KSPSetTolerances(solver.raw, LEFT, 1e-300, 1e10, int(MOST)?))?;
            checked(ffi::KSPSetFromOptions(solver.raw))?;
            let mut direct = 0;
            checked(ffi::PetscObjectTypeCompare(
                solver.raw.cast(),
                text("preonly").as_ptr(),
                ptr::from_mut(&mut direct).cast(),
            ))?;
            let vector = |raw: *mut Vector| ffi::MatCreateVecs(matrix.raw, ptr::null_mut(), raw);
            let [right, solution] = [Owned::made(vector, ffi::VecDestroy)?, Owned::made(vector, ffi::VecDestroy)?];
            let lengths = rows.lengths();
            Ok((Self { ranks, rows, lengths, held, right, solution, solver, matrix }, direct != 0))
        }
    }

    /// Makes the factor or preconditioner of values; says whether it has one.
    fn set_up(&mut self, values: &[f64], shares: &Shares) -> std::result::Result<bool, LinearError> {
        let mut held = [values.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()))];
        shares.largest(&mut held).map_err(LinearError::Input)?;
        let all = with_held(values, &self.held, held[0]);
        // SAFETY: the values are those of the pattern that the matrix was made with, and are copied.
        let updated = checked(unsafe { ffi::MatUpdateMPIAIJWithArray(self.matrix.raw, all.as_ptr()) });
        drop(all);
        let (mut reason, mut conditioner, mut failed) = (0, ptr::null_mut(), 0);
        // SAFETY: objects of ours.
        let made = unsafe {
            updated
                .and_then(|()| checked(ffi::KSPSetOperators(self.solver.raw, self.matrix.raw, self.matrix.raw)))
                .and_then(|()| checked(ffi::KSPSetUp(self.solver.raw)))
                .and_then(|()| checked(ffi::KSPGetConvergedReason(self.solver.raw, &mut reason)))
                .and_then(|()| checked(ffi::KSPGetPC(self.solver.raw, &mut conditioner)))
                .and_then(|()| checked(ffi::PCGetFailedReason(conditioner, &mut failed)))
        };
        made.map_err(LinearError::Input)?;
        // A rank that lacks memory may be the only one that knows.
        let told = [failed != ffi::PCFailedReason_PC_NOERROR, failed == ffi::PCFailedReason_PC_FACTOR_OUTMEMORY];
        let mut told = told.map(|yes| f64::from(u8::from(yes)));
        shares.largest(&mut told).map_err(LinearError::Input)?;
        let [fails, lacks] = told.map(|yes| yes > 0.0);
        if fails {
            // What once failed is not tried again as it is, nor taken for the factor of the next values.
            // SAFETY: the solver is ours.
            checked(unsafe { ffi::KSPReset(self.solver.raw) }).map_err(LinearError::Other)?;
        }
        if lacks {
            return Err(LinearError::Memory(
                "the factor does not fit into the memory of the ranks; more ranks on more machines, an iterative `solver.petsc`, or \
                 where MUMPS only guessed too little, `-mat_mumps_icntl_14 200`"
                    .into(),
            ));
        }
        Ok(!fails)
    }

    /// Replaces a right-hand side by what the factor or the iterations make of it.
    fn apply(&self, x: &mut [f64]) -> std::result::Result<(), LinearError> {
        let own = self.rows.own();
        let mut reason = 0;
        let mut piece = vec![0.0; own.len()];
        let places = || self.rows.places.iter().enumerate().filter(|(_, place)| own.contains(place));
        places().for_each(|(unknown, place)| piece[place - own.start] = x[unknown]);
        write(self.right.raw, &piece).map_err(LinearError::Other)?;
        let mut iterations = 0;
        // SAFETY: objects of ours, of one size.
        let solved = unsafe {
            checked(ffi::KSPSolve(self.solver.raw, self.right.raw, self.solution.raw))
                .and_then(|()| checked(ffi::KSPGetConvergedReason(self.solver.raw, &mut reason)))
                .and_then(|()| checked(ffi::KSPGetIterationNumber(self.solver.raw, &mut iterations)))
        };
        solved.map_err(LinearError::Input)?;
        if reason < 0 {
            let why = if iterations >= MOST as ffi::PetscInt { "do not converge" } else { "break down" };
            return Err(LinearError::Inaccurate(format!(
                "the iterations of PETSc {why} after {iterations} (its reason {reason})"
            )));
        }
        read(self.solution.raw, &mut piece).map_err(LinearError::Other)?;
        let mut whole = vec![0.0; self.rows.count()];
        self.ranks.gather(&piece, &self.lengths, &mut whole).map_err(LinearError::Other)?;
        x.iter_mut().zip(&self.rows.places).for_each(|(x, &place)| *x = whole[place]);
        Ok(())
    }

    /// What the factor took and a solution with it takes, in flops, a number of the factor that is moved counted as so many; none
    /// where the package that factorised does not say the size of its factors.
    fn work(&self) -> Result<Option<Work>> {
        let (mut conditioner, mut factor) = (ptr::null_mut(), ptr::null_mut());
        // SAFETY: objects of ours; the factor is lent, and the numbers are written where they are told to.
        let info = unsafe {
            checked(ffi::KSPGetPC(self.solver.raw, &mut conditioner))?;
            checked(ffi::PCFactorGetMatrix(conditioner, &mut factor))?;
            let mut info = std::mem::zeroed::<ffi::MatInfo>();
            checked(ffi::MatGetInfo(factor, ffi::MatInfoType_MAT_GLOBAL_SUM, &mut info))?;
            info
        };
        let (entries, rows) = (info.nz_used, self.rows.count() as f64);
        // The least that so many entries may have taken, with columns of one length (Cauchy and Schwarz).
        let flops = entries * entries / (2.0 * rows.max(1.0));
        let work = Work { factorisation: flops + FACTOR_MOVED * entries, solution: SOLUTION_MOVED * entries };
        Ok((entries > 0.0).then_some(work))
    }

    /// Solves for loads together and writes the solutions at some unknowns, load after load.
    fn influence(&self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<()> {
        let (own, count) = (self.rows.own(), loads.len());
        let (own_rows, all_rows, columns) = (int(own.len())?, int(self.rows.count())?, int(count)?);
        let dense = || {
            // SAFETY: the matrix has room of its own.
            unsafe {
                let make = |raw: *mut Mat| {
                    ffi::MatCreateDense(
                        ffi::PETSC_COMM_WORLD,
                        own_rows,
                        DECIDE,
                        all_rows,
                        columns,
                        ptr::null_mut(),
                        raw,
                    )
                };
                Owned::made(make, ffi::MatDestroy)
            }
        };
        let [right, solution] = [dense()?, dense()?];
        let (places, shares) = {
            let places: Vec<usize> = at.iter().map(|&unknown| self.rows.places[unknown]).collect();
            let shares = self.rows.shares(&places);
            (places, shares)
        };
        let mut piece = Vec::new();
        // SAFETY: the arrays are those of this rank's rows, column after column.
        unsafe {
            with_array(&right, own.len() * count, |array| {
                array.fill(0.0);
                for (load, column) in loads.iter().zip(array.chunks_mut(own.len().max(1))) {
                    for &(unknown, force) in load {
                        let place = self.rows.places[unknown];
                        if own.contains(&place) {
                            column[place - own.start] += force;
                        }
                    }
                }
            })?;
            for matrix in [&right, &solution] {
                checked(ffi::MatAssemblyBegin(matrix.raw, ffi::MatAssemblyType_MAT_FINAL_ASSEMBLY))?;
                checked(ffi::MatAssemblyEnd(matrix.raw, ffi::MatAssemblyType_MAT_FINAL_ASSEMBLY))?;
            }
            checked(ffi::KSPMatSolve(self.solver.raw, right.raw, solution.raw))?;
            with_array(&solution, own.len() * count, |array| {
                let mine: Vec<usize> =
                    places.iter().filter(|place| own.contains(place)).map(|place| place - own.start).collect();
                for column in array.chunks(own.len().max(1)).take(count) {
                    piece.extend(mine.iter().map(|&row| column[row]));
                }
            })?;
        }
        let lengths: Vec<c_int> = shares.iter().map(|share| (share * count) as c_int).collect();
        let mut pieces = vec![0.0; at.len() * count];
        self.ranks.gather(&piece, &lengths, &mut pieces)?;
        // Of each rank, load after load.
        let (mut begin, mut from) = (0, &pieces[..]);
        for share in shares {
            for load in 0..count {
                let (head, tail) = from.split_at(share);
                x[load * at.len() + begin..][..share].copy_from_slice(head);
                from = tail;
            }
            begin += share;
        }
        Ok(())
    }
}

impl System {
    fn new(ranks: &'static Ranks, shares: Shares, engine: Engine, pattern: &Csr, direct: bool) -> Self {
        let (pattern, scale) = (pattern.clone(), vec![1.0; pattern.rows()]);
        Self { ranks, shares, engine, pattern, values: Vec::new(), scale, direct, factorised: false }
    }

    /// Makes the factor or preconditioner of values; says whether it has one.
    fn set_up(&mut self, values: &[f64]) -> std::result::Result<bool, LinearError> {
        match &mut self.engine {
            Engine::Mumps(mumps) => mumps.factorise(values),
            Engine::Petsc(ksp) => ksp.set_up(values, &self.shares),
        }
    }

    /// Replaces a right-hand side by what the factor or the iterations make of it.
    fn apply(&mut self, x: &mut [f64]) -> std::result::Result<(), LinearError> {
        match &mut self.engine {
            Engine::Mumps(mumps) => mumps.apply(x).map_err(LinearError::Other),
            Engine::Petsc(ksp) => ksp.apply(x),
        }
    }

    /// Solves for loads together and writes the solutions at some unknowns, load after load.
    fn influence(&mut self, loads: &[Vec<(usize, f64)>], at: &[usize], x: &mut [f64]) -> Result<()> {
        let mumps = match &mut self.engine {
            Engine::Petsc(ksp) => return ksp.influence(loads, at, x),
            Engine::Mumps(mumps) => mumps,
        };
        let rows = self.pattern.rows();
        let mut sides = vec![0.0; rows * loads.len()];
        for (load, side) in loads.iter().zip(sides.chunks_mut(rows.max(1))) {
            load.iter().for_each(|&(unknown, force)| side[unknown] += force);
        }
        mumps.solve(&mut sides)?;
        let found = sides.chunks(rows.max(1)).flat_map(|side| at.iter().map(move |&unknown| side[unknown]));
        x.iter_mut().zip(found).for_each(|(x, found)| *x = found);
        mumps.share(x)
    }

    /// What the factor took and a solution with it takes, where that is known.
    fn work(&self) -> Result<Option<Work>> {
        match &self.engine {
            Engine::Mumps(mumps) => Ok(Some(mumps.work(FACTOR_MOVED, SOLUTION_MOVED))),
            Engine::Petsc(ksp) if self.direct => ksp.work(),
            Engine::Petsc(_) => Ok(None),
        }
    }

    /// What the factor says of the signs of the pivots.
    fn signs(&self) -> Result<Option<PivotSigns>> {
        match &self.engine {
            Engine::Mumps(mumps) => mumps.signs(),
            Engine::Petsc(_) => Ok(None),
        }
    }

    /// `b - A x`, and its componentwise backward error: the largest part of `|A| |x| + |b|` that it is.
    fn residual(&self, x: &[f64], b: &[f64]) -> std::result::Result<(Vec<f64>, f64), LinearError> {
        let mut error = 0.0_f64;
        let mut residual = vec![0.0; b.len()];
        for row in self.shares.own() {
            let entries = self.pattern.starts[row]..self.pattern.starts[row + 1];
            let (mut left, mut size) = (b[row], b[row].abs());
            for (&column, &value) in self.pattern.columns[entries.clone()].iter().zip(&self.values[entries]) {
                left -= value * x[column];
                size += (value * x[column]).abs();
            }
            let part = if left == 0.0 { 0.0 } else { left.abs() / size };
            error = if part.is_nan() { f64::INFINITY } else { error.max(part) };
            residual[row] = left;
        }
        let mut errors = [error];
        let told = self.shares.complete(&mut residual).and_then(|()| self.shares.largest(&mut errors));
        told.map(|()| (residual, errors[0])).map_err(LinearError::Input)
    }

    /// Solves, and refines what a factor says until it is as good as can be.
    fn solve(&mut self, b: &mut [f64]) -> std::result::Result<(), LinearError> {
        let mut x = b.to_vec();
        self.apply(&mut x)?;
        if self.direct {
            let (mut left, mut error) = self.residual(&x, b)?;
            for _ in 0..REFINEMENTS {
                if error <= GOOD {
                    break;
                }
                self.apply(&mut left)?;
                let better: Vec<f64> = x.iter().zip(&left).map(|(x, more)| x + more).collect();
                let (rest, now) = self.residual(&better, b)?;
                if now >= error {
                    break;
                }
                (x, left, error) = (better, rest, now);
            }
            if error > ACCEPTABLE {
                return Err(LinearError::Inaccurate(format!(
                    "the matrix is nearly singular: a backward error of {error:.1e}"
                )));
            }
        }
        b.copy_from_slice(&x);
        Ok(())
    }

    /// Motions that the matrix shrinks to nothing, by inverse iteration with the factor there is, one after the other.
    fn null_motions(&mut self) -> std::result::Result<Vec<Vec<f64>>, LinearError> {
        let mut found: Vec<Vec<f64>> = Vec::new();
        'motions: while found.len() < MOTIONS {
            // Any vector has a part along what is looked for.
            let scatter = |k: usize| ((k + 1) as f64 * (2.0 + found.len() as f64).sqrt()).fract() - 0.5;
            let mut x: Vec<f64> = (0..self.scale.len()).map(scatter).collect();
            for _ in 0..LOOKS {
                // In the scaled matrix: S A S y = x with y = S^-1 of what A is solved for.
                x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x /= s);
                self.apply(&mut x)?;
                x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x /= s);
                for motion in &found {
                    let part = dot(&x, motion);
                    x.iter_mut().zip(motion).for_each(|(x, m)| *x -= part * m);
                }
                let size = dot(&x, &x).sqrt();
                if !size.is_normal() {
                    break 'motions;
                }
                x.iter_mut().for_each(|x| *x /= size);
                if self.shrinks(&x)? <= SINGULAR {
                    found.push(x);
                    continue 'motions;
                }
                // What is far from singular stays so.
                if found.is_empty() && size < 1e-3 / SINGULAR * norm_of_scatter(self.scale.len()) {
                    break 'motions;
                }
            }
            break;
        }
        let unscaled = |motion: Vec<f64>| motion.iter().zip(&self.scale).map(|(m, s)| m * s).collect();
        Ok(found.into_iter().map(unscaled).collect())
    }

    /// Size of `S A S x` for a unit vector.
    fn shrinks(&self, x: &[f64]) -> std::result::Result<f64, LinearError> {
        let x: Vec<f64> = x.iter().zip(&self.scale).map(|(x, s)| x * s).collect();
        let (left, _) = self.residual(&x, &vec![0.0; x.len()])?;
        Ok(left.iter().zip(&self.scale).map(|(left, s)| (left * s).powi(2)).sum::<f64>().sqrt())
    }

    /// Takes up a matrix and its scale.
    fn take(&mut self, values: &[f64]) -> std::result::Result<(), LinearError> {
        self.values.clear();
        self.values.extend_from_slice(values);
        for (row, scale) in self.scale.iter_mut().enumerate() {
            let entries = &values[self.pattern.starts[row]..self.pattern.starts[row + 1]];
            let largest = entries.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            *scale = if largest > 0.0 { largest.sqrt().recip() } else { 1.0 };
        }
        self.shares.complete(&mut self.scale).map_err(LinearError::Input)
    }

    /// The values with a little more on the diagonal.
    fn shifted(&self) -> Vec<f64> {
        let mut shifted = self.values.clone();
        for (row, scale) in self.scale.iter().enumerate() {
            if let Some(entry) = self.pattern.diagonal(row) {
                shifted[entry] += SHIFT / (scale * scale);
            }
        }
        shifted
    }

    /// Makes the factor, and sees to it that the matrix has an inverse.
    fn factorise(&mut self, values: &[f64]) -> std::result::Result<(), LinearError> {
        self.take(values)?;
        let factorised = self.set_up(values)? || self.direct && self.set_up(&self.shifted())?;
        if !factorised {
            return Err(LinearError::Inaccurate("PETSc finds no preconditioner of the matrix".into()));
        }
        let motions = if self.direct { self.null_motions()? } else { Vec::new() };
        if motions.is_empty() { Ok(()) } else { Err(LinearError::Singular(motions)) }
    }
}

impl LinearSolver for Petsc {
    fn set_pattern(&mut self, pattern: &Csr, unknowns: Unknowns) -> std::result::Result<(), LinearError> {
        self.prepare(pattern, &unknowns).map_err(LinearError::Input)
    }

    /// What iterates anyway preconditions nothing; of a factor the cost is that which MUMPS says, or what there is to say of its size.
    fn factorise(&mut self, values: &[f64]) -> std::result::Result<Factored, LinearError> {
        let system = self.system()?;
        system.factorised = false;
        system.ranks.agree(Rendezvous::Matrix, &[]).map_err(LinearError::Input)?;
        if system.shares.any(values.iter().any(|value| !value.is_finite())).map_err(LinearError::Input)? {
            return Err(LinearError::NotFinite("the stiffness is not finite".into()));
        }
        system.factorise(values)?;
        system.factorised = true;
        let (signs, work) = (system.signs(), system.work());
        Ok(Factored { signs: signs.map_err(LinearError::Other)?, work: work.map_err(LinearError::Other)? })
    }

    fn solve(&mut self, rhs: &mut [f64]) -> std::result::Result<(), LinearError> {
        self.checked(rhs)?.solve(rhs)?;
        self.unasked()
    }

    fn substitute(&mut self, x: &mut [f64]) -> std::result::Result<(), LinearError> {
        self.checked(x)?.apply(x)
    }

    fn compliance(
        &mut self,
        loads: &[Vec<(usize, f64)>],
        at: &[usize],
        x: &mut [f64],
    ) -> std::result::Result<bool, LinearError> {
        let Some(system) = self.system.as_mut().filter(|system| system.factorised) else {
            return Err(LinearError::Other("nothing is factorised".into()));
        };
        let sizes = [loads.len() as f64, at.len() as f64];
        system.ranks.agree(Rendezvous::Loads, &sizes).map_err(LinearError::Input)?;
        let pieces = loads.chunks(TOGETHER).zip(x.chunks_mut((TOGETHER * at.len()).max(1)));
        pieces.into_iter().try_for_each(|(loads, x)| system.influence(loads, at, x)).map_err(LinearError::Other)?;
        Ok(true)
    }
}

/// Tells multigrid what moves without resistance: rigid motions of nodes at these places of this rank.
///
/// # Safety
/// The places are as many as this rank's rows.
unsafe fn rigid_motions(matrix: &Owned<ffi::_p_Mat>, places: &[f64], all: ffi::PetscInt) -> Result<()> {
    // SAFETY: the vector lends the places, and goes before them.
    unsafe {
        let (world, own) = (ffi::PETSC_COMM_WORLD, int(places.len())?);
        let make = |raw: *mut Vector| ffi::VecCreateMPIWithArray(world, 3, own, all, places.as_ptr(), raw);
        let places = Owned::made(make, ffi::VecDestroy)?;
        let motions = Owned::made(|raw| ffi::MatNullSpaceCreateRigidBody(places.raw, raw), ffi::MatNullSpaceDestroy)?;
        checked(ffi::MatSetNearNullSpace(matrix.raw, motions.raw))
    }
}

/// Works on the array of a dense matrix.
///
/// # Safety
/// It has that length.
unsafe fn with_array(matrix: &Owned<ffi::_p_Mat>, length: usize, work: impl FnOnce(&mut [f64])) -> Result<()> {
    let mut array = ptr::null_mut();
    // SAFETY: PETSc lends the array; where it has no rows it may be nothing.
    unsafe {
        checked(ffi::MatDenseGetArray(matrix.raw, &mut array))?;
        if length > 0 {
            work(std::slice::from_raw_parts_mut(array, length));
        } else {
            work(&mut []);
        }
        checked(ffi::MatDenseRestoreArray(matrix.raw, &mut array))
    }
}

/// Writes this rank's piece of a vector.
fn write(vector: Vector, piece: &[f64]) -> Result<()> {
    with_piece(vector, piece.len(), |own| own.copy_from_slice(piece))
}

/// Reads this rank's piece of a vector.
fn read(vector: Vector, piece: &mut [f64]) -> Result<()> {
    with_piece(vector, piece.len(), |own| piece.copy_from_slice(own))
}

fn with_piece(vector: Vector, length: usize, work: impl FnOnce(&mut [f64])) -> Result<()> {
    let mut array = ptr::null_mut();
    // SAFETY: PETSc lends the array of this rank's piece, which has the length of its rows.
    unsafe {
        checked(ffi::VecGetArray(vector, &mut array))?;
        if length > 0 {
            work(std::slice::from_raw_parts_mut(array, length));
        }
        checked(ffi::VecRestoreArray(vector, &mut array))
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Size of a scattered vector of so many numbers: those of a uniform distribution over one.
fn norm_of_scatter(count: usize) -> f64 {
    (count as f64 / 12.0).sqrt()
}
