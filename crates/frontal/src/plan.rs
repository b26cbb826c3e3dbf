//! Where contribution blocks lie, and which parts of the assembly tree are one thread's work.

use crate::assembly_tree::AssemblyTree;

/// Subtrees with less than this share of a thread's part of the flops are not divided further: with .2 in its place a cube of 46^3 takes .6 GB
/// more and no less time.
const TASK_SHARE: f64 = 0.5;
/// A matrix with fewer flops is one thread's work: the others would wake up too late.
const WORTHWHILE: f64 = 2e7;

/// What a front is to the threads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Role {
    /// In a task, below its root.
    Inside,
    /// Root of a subtree that is one thread's work, with a stack of its own: a task.
    Task,
    /// Above the tasks: all threads may work on it.
    Above,
}

/// Lengths on the side of even depths and on that of odd ones.
type Sides = [usize; 2];

/// The division of the tree among threads, and the layout of the working memory that goes with it.
///
/// A front is assembled while its children's blocks are still there, and those of its grandchildren are not: blocks of
/// even and of odd depth have memory of their own. In a task, those of even depth grow from the front of the stack and
/// those of odd depth from its back: on either side the last block in is the first out, and none is ever moved. The
/// blocks of the tasks' roots and of the fronts above are *shared*: they outlive the tasks. On either side of the shared
/// memory siblings lie next to each other, and a block lies where those of its grandchildren were.
///
/// The plan has no influence on results: every front is computed from the same numbers in the same order.
#[derive(Debug, Clone)]
pub(crate) struct Plan {
    pub threads: usize,
    pub roles: Vec<Role>,
    /// Place of each block in its task's stack.
    pub offsets: Vec<usize>,
    /// Length of the longest stack of a task.
    pub stack_len: usize,
    /// Room after the stack for the elimination of a symmetric front.
    pub scratch_len: usize,
    /// Length of the shared blocks of each subtree, on the side of even depths and on that of odd ones; the last entry is
    /// that of all.
    shared: Vec<Sides>,
}

impl Plan {
    pub fn new(tree: &AssemblyTree, threads: usize) -> Self {
        let n = tree.fronts.len();
        let roles = roles(tree, threads);
        let shared = vec![Sides::default(); n + 1];
        let mut plan = Plan { threads, roles, offsets: vec![0; n], stack_len: 0, scratch_len: 0, shared };
        plan.scratch_len = tree.fronts.iter().map(|front| front.scratch_len()).max().unwrap_or(0);
        for s in 0..n {
            match plan.roles[s] {
                Role::Inside => continue,
                Role::Task => plan.lay_out_stack(tree, s),
                Role::Above => plan.shared[s] = plan.shared_of(tree.children(s)),
            }
            let (front, shared) = (&tree.fronts[s], &mut plan.shared[s]);
            shared[front.side()] = shared[front.side()].max(front.block_len());
        }
        plan.shared[n] = plan.shared_of(tree.children(n));
        plan
    }

    /// Numbers of working memory: the shared blocks and one stack per thread.
    pub fn len(&self) -> usize {
        self.shared_len() + self.stacks() * (self.stack_len + self.scratch_len)
    }

    pub fn shared_len(&self) -> usize {
        self.shared.last().map_or(0, |sides| sides.iter().sum())
    }

    /// Number of tasks that can be under way together.
    pub fn stacks(&self) -> usize {
        self.threads.min(self.roles.iter().filter(|&&role| role == Role::Task).count())
    }

    /// Length of the shared blocks of so many subtrees.
    pub fn shared_of(&self, roots: &[u32]) -> Sides {
        let rooms = roots.iter().map(|&root| self.shared[root as usize]);
        rooms.fold(Sides::default(), |[even, odd], sides| [even + sides[0], odd + sides[1]])
    }

    fn lay_out_stack(&mut self, tree: &AssemblyTree, task: usize) {
        let range = tree.fronts[task].first_descendant..task;
        // Filled lengths of the two sides and the most that both ever took together.
        let (mut filled, mut len) = ([0, 0], 0);
        for s in range.clone() {
            let side = tree.fronts[s].side();
            self.offsets[s] = filled[side];
            filled[side] += tree.fronts[s].block_len();
            len = len.max(filled[0] + filled[1]);
            filled[1 - side] -= tree.children(s).iter().map(|&c| tree.fronts[c as usize].block_len()).sum::<usize>();
        }
        // The back side counts from the end.
        for s in range.filter(|&s| tree.fronts[s].side() == 1) {
            self.offsets[s] = len - self.offsets[s] - tree.fronts[s].block_len();
        }
        self.stack_len = self.stack_len.max(len);
    }
}

/// Above are the fronts whose subtrees are too much for one thread; tasks are the largest subtrees that are not.
fn roles(tree: &AssemblyTree, threads: usize) -> Vec<Role> {
    let n = tree.fronts.len();
    let mut flops = tree.fronts.iter().map(|front| front.flops()).collect::<Vec<_>>();
    for s in 0..n {
        flops[s] += tree.children(s).iter().map(|&c| flops[c as usize]).sum::<f64>();
    }
    let total = tree.children(n).iter().map(|&root| flops[root as usize]).sum::<f64>();
    let alone = threads <= 1 || total < WORTHWHILE;
    let largest_task = if alone { f64::INFINITY } else { total * TASK_SHARE / threads as f64 };
    let mut roles = vec![Role::Inside; n];
    for s in (0..=n).rev().filter(|&s| s == n || flops[s] > largest_task) {
        if s < n {
            roles[s] = Role::Above;
        }
        for &child in tree.children(s) {
            roles[child as usize] = Role::Task;
        }
    }
    roles
}
