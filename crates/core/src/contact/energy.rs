//! The energy of a contact point or node over an increment.

use super::ContactOptions;
use super::record::entry;
use crate::interface::{Interface, Linearised, Past, Status};
use crate::system::{Instant, Local};

/// Energy that a point of present `area` stores, and dissipates over an increment, with the law's answer `now`, none at an open one:
/// the work of the mean friction stress on the `slip` less what of it is stored, and of the mean pressure on the closure and the wear that
/// stay. A point that closes or opens takes part with half its stress, so that one which passes a peak of pressure within an
/// increment does not lose its work. Where multipliers bear the stress, of the penetration `multiplied`, nothing is stored by a slip.
///
/// Friction that turns within the increment has no mean: what the law let slip was slipped at the limit all the way. The
/// trapezoid of the work of supports and loads misses as much of that as the mean stress does, and is made up for.
pub(in crate::contact) fn account(
    (law, past, old): (&dyn Interface, &Past, &[f64]),
    (options, at): (&ContactOptions, Instant),
    (area, multiplied): (f64, f64),
    (now, slip): (Option<&Linearised>, [f64; 2]),
    local: &mut Local,
) {
    let (now, slipped, closure) = now.map_or(([0.0; 3], 0.0, 0.0), |now| (now.stress, now.slipped, now.closure));
    let ([pressure, s, t], [s_before, t_before]) = (now, [old[entry::SHEAR], old[entry::SHEAR2]]);
    local.energies.stored = area * (law.stored(pressure, past.penalty) - 0.5 * pressure * multiplied);
    let mean = [0.5 * (s_before + s), 0.5 * (t_before + t)];
    let (shear, before) = (s.hypot(t), s_before.hypot(t_before));
    let steady = if options.augmentation.is_some() {
        if shear > 0.0 { (mean[0] * s + mean[1] * t) / shear * slipped } else { 0.0 }
    } else {
        let stored = |shear: f64| 0.5 * shear * shear / past.tangential_penalty;
        local.energies.stored += area * stored(shear);
        mean[0] * slip[0] + mean[1] * slip[1] - (stored(shear) - stored(before))
    };
    let from = if old[entry::STATUS] == f64::from(Status::Stick as u8) { shear } else { before };
    let friction = steady.max(0.5 * (from + shear) * slipped);
    let pressure = 0.5 * (old[entry::PRESSURE] + pressure);
    local.energies.supplied = area * (pressure * options.overlap.removed(old, at) + friction - steady);
    local.energies.dissipated = area * (friction + pressure * closure);
}
