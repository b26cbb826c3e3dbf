//! Every number that tunes the procedure, and why it is what it is.

/// When forces balance.
pub mod convergence {
    /// Part of the past yardstick that still counts: after unloading, equilibrium is asked to a tolerance of this.
    pub const MEMORY: f64 = 1e-3;
    /// Forces below this multiple of what rounding leaves of their equation are no forces.
    pub const NOTHING: f64 = 100.0;
    /// Part of the tolerance below which unbalanced forces need no iteration: a small load moves what is soft or slender, whatever the others.
    pub const NEGLIGIBLE: f64 = 1e-4;
    /// What the next iteration would change over what the increment has changed so far, at most.
    pub const CORRECTION: f64 = 1e-3;
    /// Displacement that an unbalanced force makes against the stiffness of its equation alone, over the largest of the increment, at most: in
    /// a part that is soft beside others.
    pub const LOCAL: f64 = 1e-7;
    /// By what factor an iteration makes unbalanced forces smaller that are not yet rounding.
    pub const FALLING: f64 = 10.0;
}

/// Contact states that repeat.
pub mod cycles {
    /// Iterations that are remembered: two rounds of the longest cycle that is looked for.
    pub const LENGTH: usize = 8;
}

/// What nothing holds in an iterate.
pub mod regularisation {
    /// Stiffness that regularises an iterate in which something is free, over the largest in the matrix,
    pub const SMALL: f64 = 1e-4;
    /// what each iteration makes of it over which no contact changes, as it slows the bending of a slender body too,
    pub const EASED: f64 = 0.1;
    /// and how often it does so at most.
    pub const MOST_EASED: i32 = 5;
    /// Iterations in a row over which no contact changes, two beyond the last easing, and part of the unbalanced forces that one leaves
    /// after which what is free is pushed by more than may hold it: a block beyond its friction.
    pub const STEADY: i32 = MOST_EASED + 2;
    pub const PUSHED: f64 = 0.9;
    /// Force over the reference force that holds what meets no stiffness.
    pub const RESISTANCE: f64 = 1e-3;
    /// Gap over a cell that a node may have whose faces touch: the mean, weighted by its function, of what a corner with flanks of 45
    /// degrees leaves.
    pub const CLOSE: f64 = 1.0 / 3.0;
    /// Part of the largest entry of a motion that meets no stiffness from which on an entry is more than rounding.
    pub const MOVED: f64 = 1e-6;
}

/// Memory beside the factor, measured on runs.
pub mod demand {
    /// Bytes beside the factor, its pattern and the histories. For each entry of the matrix its value in the evaluation at hand and in
    /// the copy that preconditions;
    pub const PER_ENTRY: f64 = 16.0;
    /// for each pair of unknowns of a stencil its place (1.3), the gradients of its cell (4) and the fields of a frame that is written
    /// (5 for 20 nodes of a cell, 9 for 8);
    pub const PER_PAIR: f64 = 13.0;
    /// and for each unknown the vectors of the iterations.
    pub const PER_UNKNOWN: f64 = 500.0;
    /// What tables, buffers and the program itself take whatever the model.
    pub const BESIDES: f64 = 9e6;
    /// The same for each entry, in the plane and in space, where contact moves and an old factor preconditions: a pattern and a matrix
    /// more, and the columns of the inverse near contact.
    pub const PER_ENTRY_OF_CONTACT: [f64; 2] = [25.0, 50.0];
    /// Unknowns of which no more than so many bytes each are asked for.
    pub const PLENTY: u64 = 60_000;
    /// Powers by which memory grows with unknowns in the plane and in space (George, SIAM J. Numer. Anal. 10, 1973).
    pub const GROWTH: [f64; 2] = [1.1, 4.0 / 3.0];

    /// Bytes of a rank of a cluster, measured on few of them with OpenBLAS and Debian's PETSc 3.18.
    pub mod ranks {
        /// What a rank takes whatever the model, and the first besides, which writes.
        pub const BESIDES: f64 = 68e6;
        pub const FIRST: f64 = 36e6;
        /// Where MUMPS factorises: for each unknown of the whole model, which all hold, and on the first rank besides; for each entry of
        /// the matrix that preconditions, which the first holds whole; for each entry of the rows of a rank.
        pub const PER_UNKNOWN: f64 = 2000.0;
        pub const FIRST_PER_UNKNOWN: f64 = 400.0;
        pub const FIRST_PER_ENTRY: f64 = 4.0;
        pub const PER_ENTRY: f64 = 40.0;
        /// For each number of the factors, with working memory and reserve, where one rank has all; `n` ranks have `n` to this power of
        /// it each, since fronts at the root are shared out unevenly.
        pub const PER_FACTOR: f64 = 10.5;
        pub const SHARE: f64 = -0.65;
        /// Where BoomerAMG preconditions FGMRES: the same for unknowns, on all and on the first, and for the entries of a rank, at most:
        /// small models and cells without modes of their own take two thirds.
        pub const MULTIGRID_PER_UNKNOWN: f64 = 8200.0;
        pub const MULTIGRID_FIRST_PER_UNKNOWN: f64 = 450.0;
        pub const MULTIGRID_PER_ENTRY: f64 = 66.0;
    }
}

/// Factors of the library's own engine.
pub mod frontal {
    /// Difference of mirrored values over the geometric mean of their diagonal entries up to which they are the same: thousands
    /// of roundings, and far less than any friction.
    pub const SYMMETRIC: f64 = 1e-12;
    /// Bytes of a factor of which no question is asked.
    pub const SMALL: u64 = 1 << 26;
}

/// The change of low rank by which a factor is put right.
pub mod low_rank {
    /// Most unknowns for which the factor is put right, and the part of its largest value by which a row must have changed.
    pub const MOST: usize = 1024;
    pub const CHANGED: f64 = 0.01;
}

/// Newton's iterations.
pub mod iterations {
    /// The line search takes a step at whose end the slope is at most this multiple of the initial one: a point that
    /// closes over the step raises it a little and is dealt with by the next iteration, and so does a snap; only what goes far
    /// astray is shortened.
    pub const SLOPE: f64 = 10.0;
    /// The same where bodies flow: it must not lead farther away, since what is deformed beyond flow there leads to no end.
    pub const FLOWING: f64 = 1.0;
    /// Slopes tell nothing of a step that goes uphill, as one may that is put right for contact: it may leave this part of the unbalanced
    /// forces.
    pub const ASCENT: f64 = 2.0;
    /// An iteration with an old factor stalls that leaves more than this part of the unbalanced forces; so many in a row, and
    /// the next has a fresh one.
    pub const STALLED: f64 = 0.5;
    pub const STALLS: usize = 2;
    /// Iterations after which the line search turns strict: a step must then lower the slope,
    pub const PATIENCE: usize = 8;
    /// to this part of the initial one. Points that slip to and fro in turn are held by it.
    pub const STRICT: f64 = 0.5;
    /// Points of a cycle that a message names.
    pub const NAMED: usize = 3;
}

/// Steps of arc length.
pub mod path {
    /// What the solution for the load may leave of it where it is an iterative one.
    pub const LOAD: f64 = 1e-7;
    /// By what part of itself the square of the length of an increment may differ from what it should be.
    pub const LENGTH: f64 = 0.05;
    /// Difference of an end that is reached, over what leads to it.
    pub const REACHED: f64 = 1e-9;
    /// Cosine of the angle between two increments, at least: else the path turns back.
    pub const AHEAD: f64 = -0.5;
    /// Shortest part of a step that is taken where the whole cannot be evaluated.
    pub const SHORTEST: f64 = 0.01;
    /// Part of the size of the model by which the first increment, one of the load, may move a node where it takes many iterations: it
    /// may else have gone past the limit points of a shallow arch.
    pub const ASTRAY: f64 = 0.01;
    /// Part of an increment that served below which those that fail are taken to fail at a corner of the path.
    pub const CORNER: f64 = 0.2;
}

/// The first guess.
pub mod predictor {
    /// Below this part of the increment's prescribed motion, what the predictor misses is rounding.
    pub const ROUNDING: f64 = 1e-12;
    /// A motion is smooth whose parabola would have missed the last increment by less than this part of what a straight line missed
    /// it by, at the node where that is most: where contact changes it is more, in smooth motion a tenth to a third.
    pub const SMOOTH: f64 = 0.6;
}

/// Iterations that wander.
pub mod progress {
    /// Iterations that are judged together; as many and the first guess come before them.
    pub const WINDOW: usize = 6;
    /// Part of the forces in play above which unbalanced forces are large,
    pub const LARGE: f64 = 0.01;
    /// what the least of them must fall to within the window,
    pub const FALL: f64 = 0.5;
    /// and the part of Newton's step below which it counts as shortened; it is so in most iterations that wander.
    pub const SHORT: f64 = 0.5;
    /// Steps over which contact found no states, at which an attempt is given up: of those of a drawn cup and a rolled strip that met
    /// so many, 93 of 100 failed.
    pub const LOST: usize = 2;
    /// Iterations after which, where bodies flow, an attempt is given up that leaves more than this part of the forces in play: of
    /// 333 of rolled strips, upset billets and punches 320 failed, after three more iterations each.
    pub const SOON: usize = 4;
    pub const STILL: f64 = 0.1;
}

/// Pseudo-transient continuation.
pub mod relaxation {
    /// First viscosity over the mean stiffness of an unknown.
    pub const START: f64 = 1e-2;
    /// What a step that took few iterations, or many, leaves of the viscosity, and what one that failed makes of it.
    pub const FAST: f64 = 0.25;
    pub const SLOW: f64 = 0.5;
    pub const BACK: f64 = 4.0;
    /// Iterations of a step, and up to which they are few.
    pub const ITERATIONS: usize = 10;
    pub const FEW: usize = 3;
    /// A step must lower the unbalanced forces to this part of what they are without the medium.
    pub const ENOUGH: f64 = 0.05;
    /// Part of the tolerance that iterations without the medium must reach at the end.
    pub const SETTLED: f64 = 1e-2;
    /// Motion over the size of the model, more than what is prescribed, beyond which nothing comes to rest.
    pub const AWAY: f64 = 1.0;
    /// Iterations of one relaxation, at most: those that lead to an end take a few hundred.
    pub const MOST: usize = 600;
}

/// Rigid motions that meet no stiffness.
pub mod rigid_motions {
    /// Part of the size of the model by which motions are tried: rounding leaves 1e-9 of their forces, curvature less.
    pub const TRIED: f64 = 1e-7;
    /// Part of the mean stiffness of an unknown that holds.
    pub const HELD: f64 = 1e-7;
    /// Part of a unit motion by which constraints may be missed.
    pub const ALLOWED: f64 = 1e-9;
}

/// Attempts at an increment.
pub mod increments {
    /// Part that the trapezoid of the work misses, of half of what the forces grow by along the motion, of a force that grows from nothing
    /// with the third power of the motion, as a membrane's does: `(1/2 - 1/4) / (1/2)`.
    pub const CUBIC: f64 = 0.5;
    /// Energy below this part of that of the model and of its forces over a cell is rounding.
    pub const NOISE: f64 = 1e-9;
    /// Part of the size that served last, at most the first of the step, from which on an increment that fails is relaxed (its square
    /// in the first increment of a step), and what the next one is after that, at least. Where nothing touches and an increment has been
    /// relaxed before it is the whole: soil without dilatancy has no equilibrium near most states under a footing, however short the increment.
    pub const RELAX: f64 = 0.125;
    pub const JUMPED: f64 = 0.25;
    /// Attempts at one increment before the run gives up.
    pub const ATTEMPTS: usize = 40;
    /// An increment leaps that moves this many times as fast as the one before,
    pub const LEAP: f64 = 20.0;
    /// by more than this multiple of what is prescribed,
    pub const DRIVEN: f64 = 3.0;
    /// and by more than this part of the model's size.
    pub const FAR: f64 = 0.05;
    /// One goes back whose change turns against that of the one before and is longer by so much than that carried on,
    pub const BACK: f64 = 1.0;
    /// and moves some node by more than this part of the model's size;
    pub const NEAR: f64 = 1e-4;
    /// it is halved so often, and then taken: a column of slenderness 170 under a side load of 4e-6 of its Euler stress takes the right side from a 400th of
    /// the step on.
    pub const RETURNS: usize = 6;
}

/// Sizes of increments.
pub mod sizes {
    /// Iterations up to which an increment counts as easy.
    pub const EASY: usize = 6;
    /// Growth after an easy increment.
    pub const GROWTH: f64 = 1.5;
    /// Increments that must succeed after one that failed before a larger one is tried; twice as many each time that this fails, up
    /// to the most. An attempt that fails costs about as much as three or four increments that succeed.
    pub const PATIENCE: usize = 4;
    pub const MOST_PATIENCE: usize = 16;
    /// Part of the stress of a body by which creep may make it wrong over an increment, in which it is taken to go on evenly.
    /// Relaxation at a fixed strain, by the fifth power, is then within a hundredth of its closed form, and increments grow by a half each.
    pub const UNEVEN: f64 = 0.02;
    /// Part of all that the terms have taken up from which on work of creep under loads counts.
    pub const PAST: f64 = 0.01;
    /// Part of that for which a size is chosen.
    pub const AIM: f64 = 0.9;
    /// Part of the size of the model by which an increment along a path may move a node where nothing is said of the largest: forty
    /// of them lie in the snap-through of a shallow arch, whose length before it is in load is far shorter.
    pub const SHORT: f64 = 1.0 / 400.0;
    /// Part of the first increment of a step below which no size counts as usual.
    pub const USUAL: f64 = 1.0 / 16.0;
}

/// Contact stresses over a step, by an old factor.
pub mod semismooth {
    /// Most of its right-hand side that an iterative solution may leave where that is much smaller than the unbalanced forces.
    pub const LOOSE: f64 = 0.3;
    /// Part of the unbalanced forces that contact stresses may leave, what asking them again must lower that to, and what
    /// they may leave where that does not come about so many times.
    pub const LEFT: f64 = 0.002;
    pub const GAIN: f64 = 0.5;
    pub const TOLERABLE: f64 = 0.1;
    pub const PATIENCE: usize = 2;
    /// Rings of stencils around those near contact that the compliance reaches from the start where a factor serves on.
    pub const RINGS: usize = 2;
}

/// The small problem over contact stresses.
pub mod small_problem {
    /// Stresses that the linear system leaves count from this part of the largest stress on.
    pub const NOTHING: f64 = 1e-9;
    /// Iterations for the small problem.
    pub const ITERATIONS: usize = 40;
    /// Shortest step of its line search and along its path, and what a searched step must lower the error by, over its length.
    pub const SHORTEST: f64 = 0.01;
    pub const DESCENT: f64 = 0.1;
    /// Part of a step below which the whole linear step does better: what bends has met its limit, and only another geometry
    /// may carry more.
    pub const ENOUGH: f64 = 0.25;
    /// Most pieces that a path is followed through, halvings of the way to the end of one, and how far back it may lead.
    pub const PIECES: usize = 40;
    pub const HALVINGS: usize = 50;
    pub const FARTHEST: f64 = 100.0;
    /// Most stresses that are put right: more cost as much as a new matrix.
    pub const MOST: usize = 512;
}

/// Increments that jump.
pub mod snaps {
    /// Part of the work and of what heat supplied that is no error of the increment.
    pub const FREE: f64 = 0.1;
    /// Work of what is loaded or driven, over the energy set free, below which something else set that free: an overlap that is pressed
    /// apart, a change of temperature.
    pub const DRIVEN: f64 = 1e-3;
}

/// Eigenvalues that pass zero.
pub mod stability {
    /// Inverse iterations on a mode that is followed, on one that is begun, and at most where the number of negative eigenvalues has
    /// changed, where they end at this change of the eigenvalue.
    pub const FOLLOWED: usize = 1;
    pub const BEGUN: usize = 3;
    pub const CHANGED: usize = 12;
    pub const SETTLED: f64 = 1e-3;
    /// Part of itself that the quotient, carried on in time, keeps where an increment is passed over, and how many are in a row at
    /// most.
    pub const KEPT: f64 = 0.5;
    pub const PASSED: usize = 8;
    /// Cosine of the angle between two vectors of the same mode, at least.
    pub const SAME: f64 = 0.9;
    /// Amplitude of a mode over the model's size below which nothing tells to which side a path turns.
    pub const TOWARDS: f64 = 1e-6;
    /// Part of what the increment before led along a mode, carried on, from which on one that leads back turns against it. Beyond a
    /// bifurcation the branch that is not stable has gone back almost all of it.
    pub const BACKWARDS: f64 = 0.25;
    /// Part of a mode, as a root of squares, that goes with no body as a whole, above which it deforms them: half a wave of a column leaves .4
    /// and a quarter of one .6, what rolls from one notch of its mesh into the next less than .01.
    pub const DEFORMS: f64 = 0.1;
}

/// The linear step and the line search.
pub mod steps {
    /// Slope, as a part of the initial one, at which the search for a shorter step ends.
    pub const GOOD: f64 = 0.8;
    /// Bounds of what an iterative solution may leave of its right-hand side.
    pub const LOOSEST: f64 = 1e-3;
    pub const TIGHTEST: f64 = 1e-8;
    /// Part of the unbalanced forces allowed at the end that it may always leave.
    pub const ENOUGH: f64 = 0.01;
    /// Shortest step of the line search.
    pub const SHORTEST: f64 = 0.01;
    /// A step is at most a cell long, or this multiple of what was moved in the increment so far and what is still missing,
    pub const FAR: f64 = 4.0;
    /// and turns a tool by at most so much, in radians.
    pub const TURN: f64 = 0.5;
}

/// Tools that nothing bears any more.
pub mod stops {
    /// Part of its load that contacts may bear on a tool that they have lost.
    pub const LOST: f64 = 0.01;
    /// Yield of a stop under the whole load, over the size of a cell.
    pub const YIELD: f64 = 1e-4;
}
