//! The energy of a contact point or node over an increment.

use super::ContactOptions;
use super::record::entry;
use crate::interface::{Interface, Linearised, Past, Status};
use crate::system::{Instant, Local};

/// Energy that a point stores, and dissipates over an increment, with the law's answer `now`, none at an open one, and its present area before
/// and at the end, of which the part that a node sees changes as one side passes the other: the work of the mean friction force on the `slip`
/// less what of it is stored, and of the mean force of the pressure on the closure and the wear that stay. A point that closes or opens takes part
/// with half its force, so that one which passes a peak of pressure within an increment does not lose its work. Where multipliers bear the
/// stress, of the penetration `multiplied`, nothing is stored by a slip.
///
/// Friction that turns within the increment has no mean: what the law let slip was slipped at the limit all the way. The
/// trapezoid of the work of supports and loads misses as much of that as the mean stress does, and is made up for.
pub(in crate::contact) fn account(
    (law, past, old): (&dyn Interface, &Past, &[f64]),
    (options, at): (&ContactOptions, Instant),
    (areas, multiplied): ([f64; 2], f64),
    (now, slip): (Option<&Linearised>, [f64; 2]),
    local: &mut Local,
) {
    let (now, slipped, closure) = now.map_or(([0.0; 3], 0.0, 0.0), |now| (now.stress, now.slipped, now.closure));
    let (pressures, [s_before, t_before]) = ([old[entry::PRESSURE], now[0]], [old[entry::SHEAR], old[entry::SHEAR2]]);
    let [area_before, area] = areas;
    local.energies.stored = area * (law.stored(now[0], past.penalty) - 0.5 * now[0] * multiplied);
    let (before, [s, t]) =
        ([s_before, t_before].map(|stress| area_before * stress), [now[1], now[2]].map(|stress| area * stress));
    let mean = [0.5 * (before[0] + s), 0.5 * (before[1] + t)];
    let (shear, before) = (s.hypot(t), before[0].hypot(before[1]));
    let steady = if options.augmentation.is_some() {
        if shear > 0.0 { (mean[0] * s + mean[1] * t) / shear * slipped } else { 0.0 }
    } else {
        let stored = |[area, s, t]: [f64; 3]| 0.5 * area * (s * s + t * t) / past.tangential_penalty;
        let (stays, was) = (stored([area, now[1], now[2]]), stored([area_before, s_before, t_before]));
        local.energies.stored += stays;
        mean[0] * slip[0] + mean[1] * slip[1] - (stays - was)
    };
    let from = if old[entry::STATUS] == f64::from(Status::Stick as u8) { shear } else { before };
    let friction = steady.max(0.5 * (from + shear) * slipped);
    let force = 0.5 * (area_before * pressures[0] + area * pressures[1]);
    local.energies.supplied = force * options.overlap.removed(old, at) + friction - steady;
    local.energies.dissipated = friction + force * closure;
}
