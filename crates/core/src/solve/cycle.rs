//! The branches that the stencils took in the last iterations of an attempt: which of them changed, and whether they go
//! round in circles.

use super::constants::cycles::LENGTH;
use std::collections::VecDeque;

/// Branch and discrete choice of every stencil, for each term.
type Branches = Vec<Vec<(u8, u32)>>;

/// The last iterations, the latest first.
#[derive(Debug, Default)]
pub struct CycleDetector {
    steps: VecDeque<Branches>,
}

/// Stencils whose branches repeat.
#[derive(Debug, PartialEq)]
pub struct Cycle {
    /// After how many iterations.
    pub period: usize,
    /// The stencils.
    pub members: Vec<Member>,
}

/// A stencil that goes round in circles.
#[derive(Debug, PartialEq)]
pub struct Member {
    /// Its term.
    pub term: usize,
    /// Its number in it.
    pub stencil: usize,
    /// The branches and choices that it goes through.
    pub through: Vec<(u8, u32)>,
}

impl CycleDetector {
    /// Remembers what one iteration met.
    pub fn push(&mut self, branches: &Branches) {
        let mut room = if self.steps.len() == LENGTH { self.steps.pop_back() } else { None }.unwrap_or_default();
        room.clone_from(branches);
        self.steps.push_front(room);
    }

    /// Term and number of the stencils that differ between the last two iterations.
    pub fn changed(&self) -> impl Iterator<Item = (usize, usize)> {
        let pair = self.steps.front().zip(self.steps.get(1));
        let terms = pair.into_iter().flat_map(|(now, then)| now.iter().zip(then).enumerate());
        terms.flat_map(|(term, (now, then))| {
            let stencils = now.iter().zip(then).enumerate();
            stencils.filter(|(_, (now, then))| now != then).map(move |(stencil, _)| (term, stencil))
        })
    }

    /// The shortest cycle that has been gone through twice.
    pub fn cycle(&self) -> Option<Cycle> {
        let period = (2..=LENGTH / 2).find(|&period| self.repeats(period))?;
        let members = self.changed().map(|(term, stencil)| {
            let mut through: Vec<_> = (0..period).rev().map(|step| self.steps[step][term][stencil]).collect();
            through.dedup();
            Member { term, stencil, through }
        });
        Some(Cycle { period, members: members.collect() })
    }

    fn repeats(&self, period: usize) -> bool {
        self.steps.len() >= 2 * period
            && self.steps[0] != self.steps[1]
            && (0..period).all(|step| self.steps[step] == self.steps[step + period])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn detector(steps: &[[u8; 3]]) -> CycleDetector {
        let mut detector = CycleDetector::default();
        steps.iter().for_each(|step| detector.push(&vec![vec![(7, 0)], step.map(|branch| (branch, 4)).to_vec()]));
        detector
    }

    #[test]
    fn what_changed_is_told_by_term_and_stencil() {
        let none: [(usize, usize); 0] = [];
        assert_eq!(detector(&[]).changed().collect::<Vec<_>>(), none);
        assert_eq!(detector(&[[0, 1, 2]]).changed().collect::<Vec<_>>(), none);
        assert_eq!(detector(&[[0, 1, 2], [0, 2, 1]]).changed().collect::<Vec<_>>(), [(1, 1), (1, 2)]);
    }

    #[test]
    fn a_cycle_is_one_gone_through_twice() {
        let (a, b, c) = ([0, 1, 2], [0, 2, 2], [0, 2, 1]);
        assert_eq!(detector(&[a, b, a]).cycle(), None);
        assert_eq!(detector(&[a, a, a, a]).cycle(), None);
        let cycle = detector(&[c, a, b, a, b]).cycle().unwrap();
        let member = Member { term: 1, stencil: 1, through: vec![(1, 4), (2, 4)] };
        assert_eq!(cycle, Cycle { period: 2, members: vec![member] });
        assert_eq!(detector(&[a, b, c, a, b, c]).cycle().unwrap().period, 3);
    }

    #[test]
    fn old_iterations_are_forgotten() {
        let (a, b) = ([0, 1, 2], [0, 2, 2]);
        let mut steps = vec![a; 20];
        steps.extend([b, a, b, a]);
        assert_eq!(detector(&steps).cycle().unwrap().period, 2);
        assert_eq!(detector(&steps).steps.len(), LENGTH);
    }
}
