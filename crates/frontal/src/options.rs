//! What a user may choose.

/// How the elimination order is found.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Ordering {
    /// Nested dissection with a fixed seed, on the graph of the nodes: by METIS with the feature `metis` (the default),
    /// by a crate in pure Rust with the feature `feral` alone.
    #[default]
    NestedDissection,
    /// Approximate minimum degree, on the graph of the nodes; with the feature `feral`. For small or thin bodies.
    MinimumDegree,
    /// The unknowns in the order in which they are to be eliminated.
    Given(Vec<usize>),
}

/// When a supernode is merged with its parent although that stores zeros: fewer, larger fronts run faster.
///
/// A merge is made if the merged front has at most [`always`](Self::always) pivots, or if the share of stored zeros
/// in its factor stays below the bound that goes with its number of pivots.
#[derive(Debug, Clone, PartialEq)]
pub struct Amalgamation {
    /// Merge whatever the zeros, up to this number of pivots.
    pub always: usize,
    /// Pairs of a number of pivots and the share of zeros allowed up to it, in ascending order; past the last pair
    /// its share holds.
    pub shares: Vec<(usize, f64)>,
}

impl Default for Amalgamation {
    fn default() -> Self {
        Amalgamation { always: 8, shares: vec![(16, 0.5), (48, 0.1), (usize::MAX, 0.05)] }
    }
}

/// Choices of the analysis and of the factorisation. The default suits finite element matrices.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// How the elimination order is found.
    pub ordering: Ordering,
    /// Unknowns to eliminate after all others, in this order: those that couple to very many, such as a tool's
    /// reference node. All unknowns of their nodes go with them.
    pub last: Vec<usize>,
    /// When supernodes are merged.
    pub amalgamation: Amalgamation,
    /// Whether the values are symmetric. The factorisation is then L D L^T with pivots from the diagonal in their order,
    /// at half the flops and half the memory; of each pair of mirrored values it reads one, while refinement uses both. Values
    /// that are not definite and for which such pivots will not do are refused, see
    /// [`FrontalError::Unstable`](crate::FrontalError::Unstable).
    pub symmetric: bool,
    /// Bytes that analysis, factor and working memory may take together; refused before any number is touched.
    pub memory_limit: Option<usize>,
    /// Pivots smaller than this times the largest value of the equilibrated matrix make it doubtful: it is looked at for null vectors, and
    /// factorised once more if it has none. The last pivots of a free body of n unknowns are of the order of n times the unit round-off.
    pub pivot_threshold: f64,
    /// Whether rows and columns are scaled to largest values near one before the factorisation.
    pub equilibrate: bool,
    /// Refinement stops at this componentwise backward error.
    pub backward_error: f64,
    /// Steps of iterative refinement at the most.
    pub refinements: usize,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            ordering: Ordering::default(),
            last: Vec::new(),
            symmetric: false,
            amalgamation: Amalgamation::default(),
            memory_limit: None,
            pivot_threshold: 1e-9,
            equilibrate: true,
            backward_error: 1e-14,
            refinements: 3,
        }
    }
}
