//! A contact of Gauss points during one attempt.

use super::contact::PaperContact;
use crate::contact::record::{entry, past};
use crate::interface::{Interface, Past};
use crate::system::{History, Instant};
use crate::tool::Hit;
use std::sync::Arc;

/// A contact during one attempt.
pub struct PaperAttempt<'a> {
    /// The contact.
    pub contact: &'a PaperContact,
    /// The law at its end.
    pub law: Arc<dyn Interface>,
    /// Its history in the accepted state.
    pub history: &'a History,
    /// Accepted unknowns.
    pub accepted: &'a [f64],
    /// Largest admissible penetration at each point.
    pub depths: Vec<f64>,
    /// Largest gap at which the target is seen.
    pub reach: f64,
    /// Unknowns that the last increment, carried on, leads to: a guess of what will couple.
    pub ahead: Vec<f64>,
    /// When it ends.
    pub at: Instant,
}

/// Begins the new history of a point with what the search found.
pub fn write_hit(hit: Option<Hit>, values: &mut [f64]) {
    values.fill(0.0);
    values[entry::SEGMENT] = hit.map_or(-1.0, |hit| hit.segment as f64);
    if let Some(hit) = hit {
        values[entry::PENETRATION] = hit.u;
        [values[entry::S], values[entry::S2]] = hit.s;
    }
}

/// The segment that a history says was touched, and where on it.
pub fn touched(values: &[f64]) -> Option<(usize, [f64; 2])> {
    let segment = values[entry::SEGMENT];
    (segment >= 0.0).then(|| (segment as usize, [values[entry::S], values[entry::S2]]))
}

impl PaperAttempt<'_> {
    /// What overlap and wear add to the penetration of a point before the law sees it.
    pub(super) fn closure(&self, index: usize) -> f64 {
        let options = &self.contact.parts.options;
        options.overlap.recession(self.law.recession(), self.history.slot(index), self.at)
    }

    /// What the law may know of a point.
    pub(super) fn past(&self, index: usize) -> Past<'_> {
        let options = &self.contact.parts.options;
        past(self.history.slot(index), [options.penalty, options.tangential_penalty], self.at.dt)
    }
}
