//! What contacts of both forms know of an increment: how far a target is seen, how far a point may
//! come and a tool turn, and for which part of it a point is in contact.

use crate::tensor::Scalar;
use crate::{Failure, FailureKind};

/// A point counts as closed from this part of the shortest edge on. One depth for all points: a flat surface
/// under uniform pressure then stays flat.
pub const CLOSED: f64 = 1e-10;

/// The largest gap at which faces no longer than `longest` are seen in the increment after `last_change`: their unknowns would
/// couple for nothing beyond an edge's length and twice the motion of the last increment.
pub fn reach(longest: f64, last_change: &[f64]) -> f64 {
    longest + 2.0 * last_change.iter().fold(0.0_f64, |most, d| most.max(d.abs()))
}

/// Refuses a point that nothing was seen from before and that now lies deep: it has jumped over the target's face.
/// `depth` is its largest admissible penetration.
pub fn refuse_jump(penetration: f64, depth: f64, name: impl FnOnce() -> String) -> Result<(), Failure> {
    if penetration > 0.25 * depth {
        let reason = format!("{} came to lie {penetration:.3e} deep in one increment", name());
        return Err(Failure::new(reason).of(FailureKind::Passage));
    }
    Ok(())
}

/// The part of the increment during which a point that began open is in contact, at constant speed of approach.
pub fn in_contact<T: Scalar>(penetration: T, before: f64) -> T {
    if before < 0.0 && penetration.re() > 0.0 { penetration / (penetration - before) } else { T::one() }
}
