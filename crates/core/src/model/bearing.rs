//! What contacts bear in an accepted state, for fluids that enter where they bear little.

use crate::contact::field::FieldContact;
use crate::contact::{ContactRecord, PaperContact, PointStatus};
use crate::system::State;
use crate::tensor::Vec3;
use std::sync::Arc;

/// Places and pressures of the closed points of all contacts; `first` is the number of the first of them among the terms.
pub(super) fn bearing(
    first: usize,
    points: &[Arc<PaperContact>],
    fields: &[Arc<FieldContact>],
) -> impl Fn(&State) -> Vec<(Vec3, f64)> + Send + Sync + 'static {
    let (points, fields) = (points.to_vec(), fields.to_vec());
    move |state| {
        let (mut term, mut records) = (first, Vec::<ContactRecord>::new());
        let mut next = || {
            term += 1;
            &state.histories[term - 1]
        };
        points.iter().for_each(|contact| records.extend(contact.records(&state.u, next())));
        fields.iter().for_each(|contact| records.extend(contact.records(&state.u, next())));
        let closed = records.into_iter().filter(|record| record.status != PointStatus::Open);
        closed.map(|record| (record.position, record.pressure)).collect()
    }
}
