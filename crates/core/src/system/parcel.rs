//! What ranks tell each other of an evaluation: what the chunks of each come to, in the order of terms and stencils.

use super::chunk::{CHUNK, Chunk};
use super::shares::{apart, said};
use super::sink::Miss;
use super::{Communicator, Energies, History, Stencils};
use crate::{Failure, FailureKind};
use std::ops::Range;

/// What one rank tells.
#[derive(Debug, Default)]
pub struct Parcel {
    numbers: Vec<f64>,
    missed: bool,
    /// Term and stencil that failed, and why.
    failed: Option<(usize, usize, Failure)>,
}

/// What all have told, each read from its beginning on.
pub struct Parcels {
    numbers: Vec<f64>,
    at: Vec<usize>,
}

/// Numbers before those of the chunks: whether entries were missed; term and stencil of a failure, its kind and the length of its text.
const HEAD: usize = 5;

impl Parcel {
    /// Adds a chunk that this rank owns.
    pub fn add(&mut self, chunk: &Chunk) {
        let Energies { stored, dissipated, supplied, residue, across, bonds } = chunk.energies;
        self.numbers.extend_from_slice(&chunk.forces);
        self.numbers.extend_from_slice(&chunk.carried);
        self.numbers.extend(chunk.branches.iter().map(|(branch, _)| f64::from(*branch)));
        self.numbers.extend([stored, dissipated, supplied, residue, across, bonds]);
    }
    /// Notes that the pattern lacks entries.
    pub fn miss(&mut self) {
        self.missed = true;
    }
    /// Notes the first failure.
    pub fn fail(&mut self, term: usize, (stencil, failure): (usize, Failure)) {
        self.failed = Some((term, stencil, failure));
    }

    /// Tells all ranks; whether none of them missed an entry.
    ///
    /// # Errors
    /// The first failure in the order of terms and stencils, with the rank that met it, or that ranks have come apart.
    pub fn exchange(self, with: &dyn Communicator) -> Result<Result<Parcels, Miss>, Failure> {
        let mut piece = vec![f64::from(u8::from(self.missed)), f64::INFINITY, 0.0, 0.0, 0.0];
        match &self.failed {
            None => piece.extend(self.numbers),
            Some((term, stencil, Failure { reason, kind })) => {
                let kind = FailureKind::ALL.iter().position(|other| other == kind).unwrap_or_default();
                for (number, told) in piece[1..].iter_mut().zip([*term, *stencil, kind, reason.len()]) {
                    *number = told as f64;
                }
                piece.extend(reason.bytes().map(f64::from));
            }
        }
        let (numbers, starts) = with.gather(&piece).map_err(apart)?;
        let heads = || starts.windows(2).map(|ends| &numbers[ends[0]..ends[1]]);
        let first = heads().enumerate().min_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]).then(a[2].total_cmp(&b[2])));
        if let Some((rank, failed)) = first.filter(|(_, head)| head[1].is_finite()) {
            let text: Vec<u8> = failed[HEAD..].iter().map(|byte| *byte as u8).collect();
            let kind = FailureKind::ALL[failed[3] as usize];
            return Err(Failure::new(said(&String::from_utf8_lossy(&text), rank, with.size())).of(kind));
        }
        if heads().any(|head| head[0] != 0.0) {
            return Ok(Err(Miss));
        }
        let at = starts[..starts.len() - 1].iter().map(|start| start + HEAD).collect();
        Ok(Ok(Parcels { numbers, at }))
    }
}

impl Parcels {
    /// Reads the results of some stencils, which make a chunk, from the rank that owns it.
    pub fn read(
        &mut self,
        owner: usize,
        (stencils, range): (&Stencils, Range<usize>),
        carried: bool,
        into: &mut Chunk,
    ) {
        let list = &stencils.list[range];
        let count = list.iter().map(|stencil| stencil.len).sum();
        let mut next = |count: usize| {
            let begin = self.at[owner];
            self.at[owner] += count;
            &self.numbers[begin..begin + count]
        };
        into.forces.clear();
        into.forces.extend_from_slice(next(count));
        into.carried.clear();
        into.carried.extend_from_slice(next(if carried { count } else { 0 }));
        into.branches.clear();
        into.branches
            .extend(next(list.len()).iter().zip(list).map(|(branch, stencil)| (*branch as u8, stencil.choice)));
        if let &[stored, dissipated, supplied, residue, across, bonds] = next(6) {
            into.energies = Energies { stored, dissipated, supplied, residue, across, bonds };
        }
    }
}

/// Completes the new histories of terms of which each rank has those of its own chunks, `owner(term, first stencil)`.
pub fn share_histories(
    with: &dyn Communicator,
    stencils: &[Stencils],
    histories: &mut [History],
    owner: impl Fn(usize, usize) -> usize,
) -> Result<(), String> {
    let chunks = |term: usize| {
        let count = stencils[term].list.len();
        (0..count).step_by(CHUNK).map(move |first| first..(first + CHUNK).min(count))
    };
    let of = |history: &History, chunk: &Range<usize>| history.starts[chunk.start]..history.starts[chunk.end];
    let mut piece = Vec::new();
    for (term, history) in histories.iter().enumerate() {
        for chunk in chunks(term).filter(|chunk| owner(term, chunk.start) == with.rank()) {
            piece.extend_from_slice(&history.data[of(history, &chunk)]);
        }
    }
    let (all, mut at) = with.gather(&piece)?;
    for (term, history) in histories.iter_mut().enumerate() {
        for chunk in chunks(term) {
            let (from, range) = (&mut at[owner(term, chunk.start)], of(history, &chunk));
            let end = *from + range.len();
            history.data[range].copy_from_slice(&all[*from..end]);
            *from = end;
        }
    }
    Ok(())
}
