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

/// The part of the factor that belongs to consecutive fronts.
struct Part<'a> {
    /// First front.
    first: usize,
    factors: &'a mut [f64],
    pivots: &'a mut [Pivot],
}

impl<'a> Part<'a> {
    /// The parts before and from front `at`.
    fn split(self, fronts: &[Front], at: usize) -> (Part<'a>, Part<'a>) {
        let (first, next) = (&fronts[self.first], &fronts[at]);
        let (factors, later_factors) = self.factors.split_at_mut(next.factor - first.factor);
        let (pivots, later_pivots) = self.pivots.split_at_mut(next.first - first.first);
        (Part { factors, pivots, ..self }, Part { first: at, factors: later_factors, pivots: later_pivots })
    }
}

impl Numeric<'_> {
    /// Factorises all fronts.
    pub fn factorise(&self, factors: &mut [f64], pivots: &mut [Pivot], shared: &mut [f64]) {
        let tree = &self.symbolic.tree;
        let roots = tree.child_starts[tree.fronts.len()]..tree.child_list.len();
        let (even, odd) = shared.split_at_mut(self.plan.shared_of(&tree.child_list[roots.clone()])[0]);
        self.subtrees(roots, Part { first: 0, factors, pivots }, [even, odd]);
    }

    /// Factorises the subtrees of some entries of `child_list`, side by side where that is worth while, with their sides of the
    /// shared blocks.
    fn subtrees(&self, children: Range<usize>, part: Part, [even, odd]: [&mut [f64]; 2]) {
        let tree = &self.symbolic.tree;
        match children.len() {
            0 => {}
            1 => self.subtree(tree.child_list[children.start] as usize, part, [even, odd]),
            count => {
                let middle = children.start + count / 2;
                let earlier = &tree.child_list[children.start..middle];
                let next = tree.fronts[tree.child_list[middle] as usize].first_descendant;
                let (part, later) = part.split(&tree.fronts, next);
                let room = self.plan.shared_of(earlier);
                let ((even, later_even), (odd, later_odd)) = (even.split_at_mut(room[0]), odd.split_at_mut(room[1]));
                let first = || self.subtrees(children.start..middle, part, [even, odd]);
                let second = || self.subtrees(middle..children.end, later, [later_even, later_odd]);
                if self.plan.threads > 1 {
                    rayon::join(first, second);
                } else {
                    first();
                    second();
                }
            }
        }
    }

    /// Factorises the subtree of `s` and leaves its block at the start of its side of the shared ones.
    fn subtree(&self, s: usize, part: Part, [even, odd]: [&mut [f64]; 2]) {
        let tree = &self.symbolic.tree;
        let (front, children) = (&tree.fronts[s], tree.children(s));
        if self.plan.roles[s] == Role::Task {
            return self.task(s, part, if front.side() == 0 { even } else { odd });
        }
        let (below, part) = part.split(&tree.fronts, s);
        self.subtrees(tree.child_starts[s]..tree.child_starts[s + 1], below, [&mut *even, &mut *odd]);
        let (own, others) = if front.side() == 0 { (even, &*odd) } else { (odd, &*even) };
        let child = |k: usize| {
            let start = self.plan.shared_of(&children[..k])[1 - front.side()];
            self.contribution(children[k] as usize, &others[start..])
        };
        // Not that of a stack: while this thread waits for others it may take up a task that needs one.
        let mut scratch = vec![0.0; front.scratch_len()];
        self.front(s, (part, &mut own[..front.block_len()]), &mut scratch, child, true);
    }

    /// Factorises the subtree of `task` in postorder, on a stack of its own, and leaves its block at the start of `shared`.
    fn task(&self, task: usize, part: Part, shared: &mut [f64]) {
        let mut stack = self.take_stack();
        let (blocks, scratch) = stack.split_at_mut(self.plan.stack_len);
        let tree = &self.symbolic.tree;
        let start = &tree.fronts[part.first];
        for s in part.first..=task {
            let front = &tree.fronts[s];
            let factors = &mut part.factors[front.factor - start.factor..][..front.factor_len()];
            let pivots = &mut part.pivots[front.first - start.first..][..front.pivots];
            let (block, others) = match s == task {
                true => (&mut shared[..front.block_len()], Others { stack: &*blocks, offset: 0 }),
                false => split_stack(front, self.plan.offsets[s], blocks),
            };
            let child = |k: usize| {
                let child = tree.children(s)[k] as usize;
                self.contribution(child, &others.stack[self.plan.offsets[child] - others.offset..])
            };
            self.front(s, (Part { first: s, factors, pivots }, block), scratch, child, false);
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

    /// Assembles and eliminates the front `s`, which has the whole part and the block.
    fn front<'b>(
        &self,
        s: usize,
        (part, block): (Part, &mut [f64]),
        scratch: &mut [f64],
        child: impl Fn(usize) -> Contribution<'b> + Sync,
        parallel: bool,
    ) {
        let tree = &self.symbolic.tree;
        let front = &tree.fronts[s];
        let Part { factors, pivots, .. } = part;
        factors.fill(0.0);
        for entry in tree.entries(s) {
            factors[entry.place as usize] += self.values[entry.value as usize];
        }
        let (left, right) = factors.split_at_mut(front.left_len());
        let mut parts = Parts { left, right, block };
        assemble(front, &mut parts, tree.children(s).len(), child, parallel);
        if front.symmetric {
            let Parts { left, block, .. } = parts;
            return symmetric::eliminate(front, (left, block), scratch, pivots, (self.rule, parallel));
        }
        eliminate(front, &mut parts, pivots, self.rule, parallel);
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
    if front.side() == 0 {
        let (low, high) = stack.split_at_mut(offset + len);
        (&mut low[offset..], Others { stack: high, offset: offset + len })
    } else {
        let (low, high) = stack.split_at_mut(offset);
        (&mut high[..len], Others { stack: low, offset: 0 })
    }
}
