//! The structure of the matrix: its pattern, and where the stencils that stay the same find their entries in it.
//!
//! Most couplings are those of stencils that never change. Their pattern is kept, and what couples in an attempt besides,
//! such as the two sides of a contact, is added to the few rows that it touches.

use super::places::Places;
use super::{Assembly, Constraints, Couplings, Csr, PackedPattern, Stencils};
use std::mem::take;
use std::ops::Range;
use std::sync::Arc;

/// Pattern and places, and what they follow from.
#[derive(Debug, Default)]
pub struct Structure {
    constraints: Option<Constraints>,
    /// Groups of the terms whose stencils never change, and their pattern, of which the starts of the rows are kept as they are.
    fixed: Couplings,
    base: PackedPattern,
    starts: Arc<Vec<usize>>,
    /// Groups of the other terms, and the pattern of all.
    moving: Couplings,
    pattern: Csr,
    /// Places of the stencils that never change, term by term.
    places: Vec<Option<Places>>,
    analysis: usize,
}

impl Structure {
    /// The pattern.
    pub fn pattern(&self) -> &Csr {
        &self.pattern
    }
    /// Changes whenever the pattern changes.
    pub fn analysis(&self) -> usize {
        self.analysis
    }
    /// Places of the stencils of a term, where these never change.
    pub fn places(&self, term: usize) -> Option<&Places> {
        self.places.get(term)?.as_ref()
    }

    /// Makes the pattern of the stencils of all terms and of what they reach, in the rows `own`.
    pub fn prepare(&mut self, assembly: &Assembly, stencils: &[Stencils], own: Range<usize>) {
        let [mut fixed, mut moving] = [Couplings::default(), Couplings::default()];
        for (attempt, stencils) in assembly.attempts.iter().zip(stencils) {
            let couplings = if attempt.is_fixed() { &mut fixed } else { &mut moving };
            couplings.extend(stencils);
            attempt.reach(couplings);
        }
        if fixed != self.fixed || self.constraints.as_ref() != Some(assembly.constraints) {
            (self.fixed, self.moving) = (fixed, moving);
            self.rebuild(assembly, stencils, own);
        } else if moving != self.moving {
            self.moving = moving;
            self.add_moving(assembly.constraints);
        }
    }

    /// Adds the couplings of stencils that have changed.
    pub fn enlarge(&mut self, assembly: &Assembly, stencils: &[Stencils]) {
        let attempts = assembly.attempts.iter().zip(stencils);
        attempts.filter(|(attempt, _)| !attempt.is_fixed()).for_each(|(_, s)| self.moving.extend(s));
        self.add_moving(assembly.constraints);
    }

    fn rebuild(&mut self, assembly: &Assembly, stencils: &[Stencils], own: Range<usize>) {
        let constraints = assembly.constraints;
        self.constraints = Some(constraints.clone());
        let base = Csr::build(constraints, &self.fixed, own.clone());
        (self.base, self.starts) = (PackedPattern::of(&base, 0..base.rows()), base.starts.clone());
        let attempts = assembly.attempts.iter().zip(stencils);
        let places = attempts.map(|(attempt, s)| attempt.is_fixed().then(|| Places::new(constraints, s, own.clone())));
        self.places = places.collect();
        self.places.iter_mut().flatten().for_each(|places| places.find(&base, |_| true));
        self.pattern = base;
        if self.moving.is_empty() { self.analysis += 1 } else { self.add_moving(constraints) }
    }

    /// Adds the moving couplings to the pattern of the fixed ones, and finds places anew in the rows that it changes.
    fn add_moving(&mut self, constraints: &Constraints) {
        let was_longer = self.longer();
        let (rows, entries) = (self.starts.len() - 1, self.starts.last().copied().unwrap_or(0));
        let base = self.base.unpacked(rows, entries).expect("a pattern packed here");
        // The solver may still hold the old one.
        let memory = Arc::into_inner(take(&mut self.pattern).columns).unwrap_or_default();
        self.pattern = if self.moving.is_empty() { base } else { base.with(constraints, &self.moving, memory) };
        let is_longer = self.longer();
        for places in self.places.iter_mut().flatten() {
            places.find(&self.pattern, |row| was_longer[row] || is_longer[row]);
        }
        self.analysis += 1;
    }

    /// Which rows have more entries than those of the fixed couplings.
    fn longer(&self) -> Vec<bool> {
        let rows = self.starts.windows(2).enumerate();
        rows.map(|(row, starts)| self.pattern.row(row).len() > starts[1] - starts[0]).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::Failure;
    use crate::system::*;
    use std::collections::BTreeMap;
    use std::sync::Arc;

    /// Stencils with made-up matrices: those of the accepted state, and others elsewhere.
    #[derive(Clone)]
    struct Made {
        fixed: bool,
        groups: [Vec<Vec<usize>>; 2],
    }

    /// Entry `k` of the matrix of a stencil; some are zero.
    fn entry(stencil: usize, k: usize) -> f64 {
        ((stencil + 2) * (k + 1) % 7) as f64 / 3.0
    }

    impl Term for Made {
        fn name(&self) -> &str {
            "made"
        }
        fn initial(&self) -> History {
            History::new(self.groups[0].iter().map(|_| 0))
        }
        fn attempt<'a>(&'a self, _: &'a State, _: &'a History, _: Instant) -> Result<Box<dyn Attempt + 'a>, Failure> {
            Ok(Box::new(self.clone()))
        }
        fn name_of(&self, _: usize) -> String {
            String::new()
        }
    }

    impl Attempt for Made {
        fn is_fixed(&self) -> bool {
            self.fixed
        }
        fn scratch(&self, _: usize) -> Vec<f64> {
            Vec::new()
        }
        fn stencils(&self, u: &[f64], out: &mut Stencils) -> Result<(), Failure> {
            self.groups[u[0] as usize].iter().for_each(|group| out.push(group.iter().copied(), 0));
            Ok(())
        }
        fn evaluate(&self, index: usize, _: &Stencil, _: &mut [f64], local: &mut Local) -> Result<Branch, Failure> {
            local.tangent.iter_mut().enumerate().for_each(|(k, value)| *value = entry(index, k));
            Ok(0)
        }
    }

    /// A number below `most` from a linear congruence (Knuth's MMIX).
    fn random(state: &mut u64, most: usize) -> usize {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 33) as usize % most
    }

    const COUNT: usize = 240;

    /// Groups of the unknowns of three nodes each.
    fn groups(state: &mut u64, count: usize) -> Vec<Vec<usize>> {
        let node = |state: &mut u64| 3 * random(state, COUNT / 3);
        let group = |state: &mut u64| (0..3).map(|_| node(state)).flat_map(|dof| dof..dof + 3).collect();
        (0..count).map(|_| group(state)).collect()
    }

    /// Two unknowns that are prescribed, and some that follow others.
    fn constraints(state: &mut u64, combined: usize) -> Constraints {
        let fixed = [0, 1].map(|_| random(state, COUNT));
        let combine = |state: &mut u64| {
            let (dof, others) = (random(state, COUNT), [0, 1].map(|_| random(state, COUNT)));
            (dof, others.into_iter().filter(|&other| other != dof).map(|other| (other, 0.5)).collect())
        };
        let combined: Vec<(usize, Vec<(usize, f64)>)> = (0..combined).map(|_| combine(state)).collect();
        Constraints::new(COUNT, &fixed, &combined)
    }

    /// A matrix by its entries, zero ones included.
    type Entries = BTreeMap<(usize, usize), f64>;

    /// Adds a stencil to a matrix, times `part`.
    fn add(matrix: &mut Entries, (index, group): (usize, &[usize]), constraints: &Constraints, part: f64) {
        let pairs = group.iter().flat_map(|&dof| group.iter().map(move |&other| (dof, other)));
        for (k, (dof, other)) in pairs.enumerate() {
            let columns = || constraints.followed(other);
            let reduced = constraints.followed(dof).flat_map(|row| columns().map(move |column| (row, column)));
            for ((i, ci), (j, cj)) in reduced {
                *matrix.entry((i, j)).or_default() += part * (ci * cj * entry(index, k));
            }
        }
    }

    /// What the assembly must come to in the accepted state or elsewhere, where the pattern may have been enlarged.
    fn sum(made: &[Made], at: usize, constraints: &Constraints) -> Entries {
        let mut matrix: Entries = (0..constraints.free_count()).map(|i| ((i, i), 0.0)).collect();
        for (which, part) in [(0, if at == 0 { 1.0 } else { 0.0 }), (1, 1.0)].into_iter().take(at + 1) {
            for groups in made.iter().map(|made| &made.groups[which]) {
                groups.iter().enumerate().for_each(|(i, group)| add(&mut matrix, (i, group), constraints, part));
            }
        }
        matrix
    }

    fn check(workspace: &mut Workspace, made: &[Made], constraints: &Constraints) {
        let terms: Vec<Arc<dyn Term>> = made.iter().map(|made| Arc::new(made.clone()) as _).collect();
        let attempts = made.iter().map(|made| Box::new(made.clone()) as _).collect();
        let assembly =
            Assembly { terms: &terms, attempts, dofs: &Dofs::new(3, COUNT / 3, 0), constraints, apart: 0..0 };
        let histories = made.iter().map(Term::initial).collect();
        let mut accepted = State { u: vec![0.0; COUNT], histories, ..State::default() };
        workspace.prepare(&assembly, &accepted).unwrap();
        for at in 0..2 {
            accepted.u[0] = at as f64;
            let trial = Trial::at(&accepted.u, Tangent::Exact);
            let (mut evaluation, before) = (Evaluation::new(&terms, &accepted), workspace.enlarged());
            workspace.evaluate(&assembly, &trial, &mut evaluation).unwrap();
            let pattern = workspace.pattern();
            let row = |i: usize| pattern.row(i).iter().map(move |&j| (i, j));
            let found: Vec<(usize, usize)> = (0..pattern.rows()).flat_map(row).collect();
            let sum = sum(made, at, constraints);
            if at == 0 || workspace.enlarged() > before {
                assert_eq!(found, sum.keys().copied().collect::<Vec<_>>());
            }
            assert!((0..pattern.rows()).all(|i| pattern.diagonal(i).is_some_and(|place| found[place] == (i, i))));
            assert_eq!(evaluation.values, found.iter().map(|entry| sum[entry]).collect::<Vec<_>>());
        }
    }

    /// However moving couplings come and go, the pattern is that of all groups and every entry is where it belongs, in
    /// whichever band its row is.
    #[test]
    fn a_pattern_that_is_kept_is_that_of_all_couplings() {
        let (mut state, mut workspace) = (1, Workspace::default());
        for scene in 0..12 {
            let (constraints, fixed) = (constraints(&mut state, scene % 4), groups(&mut state, 100));
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1 + scene % 5).build().unwrap();
            for attempt in 0..8 {
                let mut moving = || groups(&mut state, [3, 5, 0, 2][attempt % 4]);
                let moving = Made { fixed: false, groups: [moving(), moving()] };
                let fixed = Made { fixed: true, groups: [fixed.clone(), fixed.clone()] };
                pool.install(|| check(&mut workspace, &[moving, fixed], &constraints));
            }
        }
        assert!(workspace.enlarged() > 50, "{}", workspace.enlarged());
    }
}
