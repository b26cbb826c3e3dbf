//! What becomes of overlap before the first increment: the deck is refused, or nodes are moved.

use super::Builder;
use crate::keys::{self, OverlapWord};
use crate::reader::Name;
use asperity_core::contact::Move;
use asperity_core::model::ModelParts;
use asperity_core::tool::Hit;
use std::sync::Arc;

/// Overlap up to this part of an edge or face is none.
const NONE: f64 = 1e-6;
/// Nodes are moved by at most this part of the size of the cell behind them.
const MOST: f64 = 0.5;

/// The name of a contact with its penetrations before the first increment, as lengths and as parts of their edges.
type Found = (String, Vec<(f64, f64)>);

fn penetrations(parts: &ModelParts) -> Vec<Found> {
    let still = vec![0.0; parts.dofs.count()];
    let points = parts.contacts.iter().map(|contact| {
        let hits = contact.search(&still).0.into_iter().enumerate();
        let part = |(i, hit): (usize, Option<Hit>)| hit.map(|hit| (hit.u, hit.u / contact.face_size(i)));
        (contact.title().to_owned(), hits.filter_map(part).collect())
    });
    let fields = parts.field_contacts.iter().map(|c| (c.title().to_owned(), c.initial_penetrations()));
    points.chain(fields).collect()
}

impl Builder<'_> {
    fn said(&self, word: OverlapWord) -> impl Iterator<Item = &(Name, keys::Contact)> {
        self.deck.contact.iter().filter(move |(_, keys)| keys.overlap.value == word)
    }

    /// Refuses overlap where the deck says so.
    pub(super) fn refuse_overlaps(&mut self, parts: &ModelParts) {
        if self.said(OverlapWord::Refuse).next().is_none() {
            return;
        }
        let (found, mut refused) = (penetrations(parts), Vec::new());
        for (name, keys) in self.said(OverlapWord::Refuse) {
            let own = found.iter().filter(|(contact, _)| *contact == name.text).flat_map(|(_, own)| own);
            let inside: Vec<_> = own.filter(|(_, part)| *part > NONE).collect();
            let deepest = inside.iter().map(|(u, _)| *u).fold(0.0, f64::max);
            if !inside.is_empty() {
                let count = inside.len();
                let what =
                    format!("{count} points of contact `{name}` lie inside the target, the deepest by {deepest:.3e}");
                refused.push((what, keys.overlap.place));
            }
        }
        refused.into_iter().for_each(|(what, place)| self.refuse(what, place));
    }

    /// Moves nodes out of targets where the deck says so, and says whether any was moved.
    pub(super) fn adjust(&mut self, parts: &ModelParts) -> bool {
        let mut moves = Vec::new();
        for (name, keys) in self.said(OverlapWord::Adjust) {
            let points = parts.contacts.iter().filter(|c| c.title() == name.text).flat_map(|c| c.moves());
            let fields = parts.field_contacts.iter().filter(|c| c.title() == name.text).flat_map(|c| c.moves());
            moves.extend(points.chain(fields).map(|moved| (moved, keys.overlap.place)));
        }
        let mut mesh = (*self.site.mesh).clone();
        for (Move { node, by, cell }, place) in &moves {
            let size = mesh.measure(*cell).abs().powf(1.0 / mesh.kinds[*cell].dimension as f64);
            if by.norm() > MOST * size {
                let what = format!("node {node} would be moved by {:.3e}, more than half of its cell", by.norm());
                self.refuse(what, *place);
                return false;
            }
            mesh.points[*node] += *by;
        }
        self.site.mesh = Arc::new(mesh);
        !moves.is_empty()
    }
}
