//! What contacts bear in an accepted state, for fluids that enter where they bear little.

use crate::contact::field::FieldContact;
use crate::contact::{Borne, PaperContact};
use crate::system::State;
use std::sync::Arc;

/// What the nodes and closed points of all contacts bear; `first` is the number of the first of them among the terms.
pub(super) fn bearing(
    first: usize,
    points: &[Arc<PaperContact>],
    fields: &[Arc<FieldContact>],
) -> impl Fn(&State) -> Vec<Borne> + Send + Sync + 'static {
    let (points, fields) = (points.to_vec(), fields.to_vec());
    move |state| {
        let (mut term, mut borne) = (first, Vec::<Borne>::new());
        let mut next = || {
            term += 1;
            &state.histories[term - 1]
        };
        points.iter().for_each(|contact| borne.extend(contact.borne(&state.u, next())));
        fields.iter().for_each(|contact| borne.extend(contact.borne(&state.u, next())));
        borne
    }
}
