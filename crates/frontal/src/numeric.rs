//! The numeric factorisation: assemble, eliminate, pass on, from the leaves to the roots.

use crate::assembly_tree::Front;
use crate::dense::{Pivot, PivotRule, eliminate};
use crate::extend_add::{Contribution, Parts, assemble};
use crate::plan::{Plan, Role};
use crate::symbolic::Inner;
use crate::symmetric;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// What all fronts are computed from.
pub(crate) struct Numeric<'a> {
    pub symbolic: &'a Inner,
    pub plan: &'a Plan,
    pub values: &'a [f64],
    pub rule: PivotRule,
    /// Stacks that no task is using.
    pub stacks: &'a Mutex<Vec<Vec<f64>>>,
}

/// The parts of the factor and of the shared blocks that belong to consecutive subtrees.
struct Part<'a> {
    /// First front.
    first: usize,
    factors: &'a mut [f64],
    pivots: &'a mut [Pivot],
    shared: &'a mut [f64],
}

impl<'a> Part<'a> {
    /// The parts before and from front `at`, with so many numbers of the shared blocks before it.
    fn split(self, fronts: &[Front], at: usize, shared: usize) -> (Part<'a>, Part<'a>) {
        let (first, next) = (&fronts[self.first], &fronts[at]);
        let (factors, later_factors) = self.factors.split_at_mut(next.factor - first.factor);
        let (pivots, later_pivots) = self.pivots.split_at_mut(next.first - first.first);
        let (shared, later_shared) = self.shared.split_at_mut(shared);
        let later = Part { first: at, factors: later_factors, pivots: later_pivots, shared: later_shared };
        (Part { first: self.first, factors, pivots, shared }, later)
    }
}

impl Numeric<'_> {
    /// Factorises all fronts.
    pub fn factorise(&self, factors: &mut [f64], pivots: &mut [Pivot], shared: &mut [f64]) {
        let tree = &self.symbolic.tree;
        let roots = tree.child_starts[tree.fronts.len()]..tree.child_list.len();
        self.subtrees(roots, Part { first: 0, factors, pivots, shared });
    }

    /// Factorises the subtrees of some entries of `child_list`, side by side where that is worth while.
    fn subtrees(&self, children: Range<usize>, part: Part) {
        let tree = &self.symbolic.tree;
        match children.len() {
            0 => {}
            1 => self.subtree(tree.child_list[children.start] as usize, part),
            count => {
                let middle = children.start + count / 2;
                let earlier = &tree.child_list[children.start..middle];
                let shared = earlier.iter().map(|&child| self.plan.shared_with(tree, child as usize)).sum();
                let next = tree.fronts[tree.child_list[middle] as usize].first_descendant;
                let (part, later) = part.split(&tree.fronts, next, shared);
                let first = || self.subtrees(children.start..middle, part);
                let second = || self.subtrees(middle..children.end, later);
                if self.plan.threads > 1 {
                    rayon::join(first, second);
                } else {
                    first();
                    second();
                }
            }
        }
    }

    /// Factorises the subtree of `s` and leaves its block at the end of the shared ones.
    fn subtree(&self, s: usize, part: Part) {
        let tree = &self.symbolic.tree;
        if self.plan.roles[s] == Role::Task {
            return self.task(s, part);
        }
        let (below, own) = part.split(&tree.fronts, s, self.plan.shared_below[s]);
        let Part { first, factors, pivots, shared } = below;
        self.subtrees(
            tree.child_starts[s]..tree.child_starts[s + 1],
            Part { first, factors, pivots, shared: &mut *shared },
        );
        let child = |k: usize| {
            let start = tree.children(s)[..k].iter().map(|&c| self.plan.shared_with(tree, c as usize)).sum::<usize>();
            let child = tree.children(s)[k] as usize;
            let start = start + self.plan.shared_below[child];
            self.contribution(child, &shared[start..])
        };
        // Not that of a stack: while this thread waits for others it may take up a task that needs one.
        let mut scratch = vec![0.0; tree.fronts[s].scratch_len()];
        self.front(s, own, &mut scratch, child, true);
    }

    /// Factorises the subtree of `task` in postorder, on a stack of its own.
    fn task(&self, task: usize, part: Part) {
        let mut stack = self.take_stack();
        let (blocks, scratch) = stack.split_at_mut(self.plan.stack_len);
        let tree = &self.symbolic.tree;
        let start = &tree.fronts[part.first];
        for s in part.first..=task {
            let front = &tree.fronts[s];
            let factors = &mut part.factors[front.factor - start.factor..][..front.factor_len()];
            let pivots = &mut part.pivots[front.first - start.first..][..front.pivots];
            let (shared, others) = match s == task {
                true => (&mut *part.shared, Others { stack: &*blocks, offset: 0 }),
                false => split_stack(front, self.plan.offsets[s], blocks),
            };
            let child = |k: usize| {
                let child = tree.children(s)[k] as usize;
                self.contribution(child, &others.stack[self.plan.offsets[child] - others.offset..])
            };
            self.front(s, Part { first: s, factors, pivots, shared }, scratch, child, false);
        }
        self.return_stack(stack);
    }

    fn take_stack(&self) -> Vec<f64> {
        let mut stack = self.stacks.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default();
        // More work may be under way than the factor was made for: in a larger pool, or where a thread that waits for
        // others takes up a task.
        stack.resize(self.plan.stack_len + self.plan.scratch_len, 0.0);
        stack
    }

    fn return_stack(&self, stack: Vec<f64>) {
        self.stacks.lock().unwrap_or_else(PoisonError::into_inner).push(stack);
    }

    /// Assembles and eliminates the front `s`, which has the whole `part`; its block is the shared one.
    fn front<'b>(
        &self,
        s: usize,
        part: Part,
        scratch: &mut [f64],
        child: impl Fn(usize) -> Contribution<'b> + Sync,
        parallel: bool,
    ) {
        let tree = &self.symbolic.tree;
        let front = &tree.fronts[s];
        part.factors.fill(0.0);
        for entry in tree.entries(s) {
            part.factors[entry.place as usize] += self.values[entry.value as usize];
        }
        let (left, right) = part.factors.split_at_mut(front.left_len());
        let mut parts = Parts { left, right, block: part.shared };
        assemble(front, &mut parts, tree.children(s).len(), child, parallel);
        if front.symmetric {
            let Parts { left, block, .. } = parts;
            return symmetric::eliminate(front, (left, block), scratch, part.pivots, (self.rule, parallel));
        }
        eliminate(front, &mut parts, part.pivots, self.rule, parallel);
    }

    fn contribution<'b>(&'b self, child: usize, from: &'b [f64]) -> Contribution<'b> {
        let front = &self.symbolic.tree.fronts[child];
        let block = &from[..front.block_len()];
        let (layout, relative) = (front.block(), self.symbolic.tree.relative(front));
        Contribution { block, layout, relative, lower: front.symmetric }
    }
}

/// The side of a stack that holds the blocks of a front's children.
struct Others<'a> {
    stack: &'a [f64],
    offset: usize,
}

/// The block of a front at one side of the stack, and the other side.
fn split_stack<'a>(front: &Front, offset: usize, stack: &'a mut [f64]) -> (&'a mut [f64], Others<'a>) {
    let len = front.block_len();
    if front.depth.is_multiple_of(2) {
        let (low, high) = stack.split_at_mut(offset + len);
        (&mut low[offset..], Others { stack: high, offset: offset + len })
    } else {
        let (low, high) = stack.split_at_mut(offset);
        (&mut high[..len], Others { stack: low, offset: 0 })
    }
}
