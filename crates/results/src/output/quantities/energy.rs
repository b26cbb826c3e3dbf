//! Energies: what is stored, what has been dissipated, what came from outside (with what was stored at the start, what heat
//! supplied, and what friction that turns within an increment takes beyond the trapezoid of the work), what was set free in instabilities, what rate laws leave over, and what is missing between them.

use super::Source;
use crate::output::{Frame, Quantity, Reading, Unit};
use asperity_core::Error;
use asperity_core::system::Energies;

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let bodies = of_bodies(source);
    let springs = sum(source, source.parts.springs.iter().copied());
    let all = sum(source, 0..source.state.energies.len());
    let contact = |whole: f64, bodies: f64, springs: f64| whole - bodies - springs;
    let external = source.state.external_work + all.supplied;
    let entries = [
        ("energy.external", external),
        ("energy.strain", bodies.stored),
        ("energy.plastic", bodies.dissipated),
        ("energy.contact", contact(all.stored, bodies.stored, springs.stored)),
        ("energy.friction", contact(all.dissipated, bodies.dissipated, springs.dissipated)),
        ("energy.spring", springs.stored),
        ("energy.released", source.state.released),
        ("energy.residue", all.residue),
    ];
    // Where no force is in play, energies are rounding, and their balance too.
    let acting = source.state.in_play[0] > 0.0;
    let sizes = entries.iter().filter(|entry| acting && entry.0 != "energy.residue").map(|entry| entry.1.abs());
    let largest = sizes.fold(0.0, f64::max);
    for (name, value) in entries {
        frame.push(Quantity::scalar(name, Unit::Energy, value))?;
    }
    let missing = source.state.external_work - all.taken() - source.state.released;
    let unexplained = (missing.abs() - source.state.unresolved_work).max(0.0);
    frame.certify(Reading::new("energy_balance", "", unexplained).over(largest));
    frame.certify(Reading::new("hypoelastic_residue", "", all.residue.abs()).over(largest));
    frame.push(Quantity::scalar("energy.missing", Unit::Energy, missing))
}

/// Energies of all bodies.
pub(super) fn of_bodies(source: &Source) -> Energies {
    sum(source, source.parts.bodies.iter().map(|(term, _)| *term))
}

fn sum(source: &Source, terms: impl Iterator<Item = usize>) -> Energies {
    let each = terms.filter_map(|term| source.state.energies.get(term));
    each.fold(Energies::default(), |mut sum, &energies| {
        sum += energies;
        sum
    })
}
