//! The certificate of a run: how far the accepted increments were from what they claim. It is gathered from the global
//! quantities of each frame, by name, and from nothing else: what stands in `history.csv` is what is certified.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The worst of each figure over all accepted increments. A figure is absent, never zero, when no frame reported it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Largest penetration at an integration point, as a length.
    pub max_penetration: Option<f64>,
    /// The same over the size of the cell behind the point.
    pub max_penetration_relative: Option<f64>,
    /// The largest weighted mean of the penetration around a node of an augmented contact, over the size of its elements.
    pub nodal_penetration: Option<f64>,
    /// Largest unbalanced force over all reactions, contacts and loads, relative to the largest of them.
    pub equilibrium_error: Option<f64>,
    /// Largest magnitude of external work less stored and dissipated energy, over the largest energy of the run.
    pub energy_balance: Option<f64>,
    /// Largest magnitude of the work that rate laws neither store nor dissipate, over the largest energy of the run.
    pub hypoelastic_residue: Option<f64>,
    /// Largest excess of the shear stress over the friction limit, relative to that limit.
    pub coulomb_violation: Option<f64>,
    /// Least frictional dissipation of a point in an increment; below zero would be energy from nowhere.
    pub least_dissipation: Option<f64>,
    /// Pressure that the facets of curved faces are worth over the pressure that is carried, in the last increment:
    /// above 0.1 two passes suffer from it.
    pub facet_ratio: Option<f64>,
    /// Difference of the mean pressures of the two sides of a contact over their mean, in the last increment.
    pub mismatch: Option<f64>,
    /// What the forces on the two sides of a contact of two passes leave over, relative to the larger, in the last
    /// increment.
    pub imbalance: Option<f64>,
    /// Hits of a ray that the rules against false contact turned away, summed over the increments.
    pub rejected_false_contacts: Option<f64>,
    /// Largest motion of an increment over the size of the model, of those increments that moved many times as fast as
    /// the one before: beyond a limit load the next equilibrium may be far away.
    pub leap: Option<f64>,
    /// Largest part of the motion of cells with reduced integration that they do not resist.
    pub hourglass: Option<f64>,
    /// Largest displacement gradient of each body in small strain, which is wrong by a part of that order.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub small_strain: BTreeMap<String, f64>,
    /// The largest energy of the run, the largest that was missing, and the largest residue of rate laws.
    #[serde(skip)]
    energies: [f64; 3],
}

/// How the figures of several frames become one.
#[derive(Clone, Copy)]
enum Worst {
    Largest,
    Least,
    Sum,
}

impl Certificate {
    /// Takes in one frame, given as columns of the history.
    pub fn observe<'a>(&mut self, columns: impl IntoIterator<Item = (&'a str, f64)>) {
        // These mean the last increment.
        (self.facet_ratio, self.mismatch, self.imbalance) = (None, None, None);
        for (name, value) in columns {
            self.observe_energy(name, value);
            if let Some(body) = name.strip_prefix("small_strain.") {
                let largest = self.small_strain.entry(body.into()).or_default();
                *largest = largest.max(value);
            }
            if let Some((figure, worst)) = self.figure(name) {
                *figure = Some(figure.map_or(value, |old| worst.of(old, value)));
            }
        }
    }
    fn observe_energy(&mut self, name: &str, value: f64) {
        let place = match name {
            "energy.missing" => 1,
            "energy.residue" => 2,
            _ if name.starts_with("energy.") => 0,
            _ => return,
        };
        self.energies[place] = self.energies[place].max(value.abs());
        let [largest, missing, residue] = self.energies;
        let part = |energy: f64| if largest > 0.0 { energy / largest } else { 0.0 };
        (self.energy_balance, self.hypoelastic_residue) = (Some(part(missing)), Some(part(residue)));
    }
    /// The figure that a column of the history belongs to.
    fn figure(&mut self, column: &str) -> Option<(&mut Option<f64>, Worst)> {
        let (room, last) = column.split_once('.').map_or((column, ""), |(room, rest)| {
            let last = rest.rsplit_once('.').map_or(rest, |(_, last)| last);
            (room, last)
        });
        Some(match (room, last) {
            ("contact", "max_penetration") => (&mut self.max_penetration, Worst::Largest),
            ("contact", "max_penetration_relative") => (&mut self.max_penetration_relative, Worst::Largest),
            ("contact", "nodal_penetration") => (&mut self.nodal_penetration, Worst::Largest),
            ("contact", "coulomb_violation") => (&mut self.coulomb_violation, Worst::Largest),
            ("contact", "least_dissipation") => (&mut self.least_dissipation, Worst::Least),
            ("contact", "facet_ratio") => (&mut self.facet_ratio, Worst::Largest),
            ("contact", "mismatch") => (&mut self.mismatch, Worst::Largest),
            ("contact", "imbalance") => (&mut self.imbalance, Worst::Largest),
            ("contact", "false_contacts") => (&mut self.rejected_false_contacts, Worst::Sum),
            ("equilibrium", "error") => (&mut self.equilibrium_error, Worst::Largest),
            ("equilibrium", "leap") => (&mut self.leap, Worst::Largest),
            ("hourglass", _) => (&mut self.hourglass, Worst::Largest),
            _ => return None,
        })
    }
}

impl Worst {
    fn of(self, old: f64, new: f64) -> f64 {
        match self {
            Self::Largest => old.max(new),
            Self::Least => old.min(new),
            Self::Sum => old + new,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_of_all_frames_and_contacts_stands() {
        let mut certificate = Certificate::default();
        certificate.observe([
            ("contact.bore.max_penetration", 1e-3),
            ("contact.a.b.max_penetration", 2e-3),
            ("small_strain.block.left", 0.3),
            ("small_strain.disc", 0.1),
            ("energy.external", 10.0),
            ("energy.missing", -2.0),
            ("energy.residue", 0.5),
        ]);
        certificate.observe([
            ("contact.bore.max_penetration", 5e-4),
            ("contact.bore.least_dissipation", -1e-18),
            ("contact.bore.least_dissipation", 0.0),
            ("contact.bore.false_contacts", 2.0),
            ("contact.bore.false_contacts", 3.0),
            ("energy.external", 40.0),
            ("energy.missing", 1.0),
            ("equilibrium.leap", 0.2),
            ("hourglass.block", 0.1),
            ("small_strain.block.left", 0.2),
            ("time", 9.0),
        ]);
        let expected = Certificate {
            max_penetration: Some(2e-3),
            energy_balance: Some(0.05),
            hypoelastic_residue: Some(0.0125),
            least_dissipation: Some(-1e-18),
            rejected_false_contacts: Some(5.0),
            leap: Some(0.2),
            hourglass: Some(0.1),
            small_strain: BTreeMap::from([("block.left".into(), 0.3), ("disc".into(), 0.1)]),
            energies: [40.0, 2.0, 0.5],
            ..Certificate::default()
        };
        assert_eq!(certificate, expected);
    }
}
