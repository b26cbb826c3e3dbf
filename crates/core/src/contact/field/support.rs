//! What a search finds: patches, and which of them each stencil sums.

use super::arc::Arcs;
use super::cover::Patch;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A patch and the nodes of the mesh on which its points depend, ascending.
#[derive(Debug, Clone)]
pub struct FoundPatch {
    /// The patch,
    pub patch: Patch,
    /// and its middle on the face.
    pub place: [f64; 2],
    /// The nodes.
    pub nodes: Vec<usize>,
}

/// Which patches a stencil sums, and which unknowns it has.
#[derive(Debug, Clone)]
pub struct Support {
    /// Numbers of the patches; the node's own number among the corners of each face.
    pub patches: Vec<(usize, usize)>,
    /// Nodes of the mesh on which they depend, ascending.
    pub nodes: Vec<usize>,
    /// The target came through the body here.
    pub through: bool,
    /// Deformed over undeformed area of the faces of the patches around the node.
    pub stretch: f64,
    /// Gap of a node that was closed and has gone so far that it sees nothing.
    pub parted: f64,
    /// How far it has slid along its shear over what it saw, if it slipped.
    pub slid: [f64; 2],
}

impl Default for Support {
    fn default() -> Self {
        Self { patches: Vec::new(), nodes: Vec::new(), through: false, stretch: 1.0, parted: 0.0, slid: [0.0; 2] }
    }
}

/// What a search finds.
#[derive(Debug, Clone, Default)]
pub struct FieldSearch {
    /// No other search of the program has this number.
    pub number: usize,
    /// The patches.
    pub patches: Vec<FoundPatch>,
    /// What each stencil has of them.
    pub supports: Vec<Support>,
    /// How far the smooth surfaces that faces of both sides stand for rise above them.
    pub arcs: Arc<Arcs>,
}

static SEARCHES: AtomicUsize = AtomicUsize::new(1);

impl FieldSearch {
    /// A search that found these.
    pub fn new(patches: Vec<FoundPatch>, supports: Vec<Support>, arcs: Arc<Arcs>) -> Self {
        Self { number: SEARCHES.fetch_add(1, Ordering::Relaxed), patches, supports, arcs }
    }

    /// The faces of the patches of a stencil, each once, with the node's number among their corners; none for a tip or a corner.
    pub fn faces(&self, slot: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let patches = &self.supports[slot].patches;
        let patch = |&(number, _): &(usize, usize)| &self.patches[number].patch;
        let fresh = move |i: usize, face: usize| !patches[..i].iter().any(|other| patch(other).face == face);
        let faces = patches.iter().enumerate().map(move |(i, of)| (i, patch(of), of.1));
        faces
            .filter(move |(i, patch, _)| patch.tip.is_none() && patch.corner.is_none() && fresh(*i, patch.face))
            .map(|(_, patch, c)| (patch.face, c))
    }
}
