//! Contact: everything at the integration points of the surfaces, and the resultants of each contact. Forces and
//! stress vectors are those that the target exerts on the surface.

use super::energy::of_bodies;
use super::{Source, Touching, surface};
use crate::output::quantity::REFERENCE_POSITION;
use crate::output::{Frame, Quantity, QuantityPlace, Reading, Unit, Width};
use asperity_core::Error;
use asperity_core::contact::{ContactRecord, PointStatus, second_name};
use asperity_core::declare::Variable;
use asperity_core::mesh::Space;
use asperity_core::system::History;
use asperity_core::tensor::Vec3;

/// A contact in an accepted state.
struct Seen<'a> {
    contact: Touching<'a>,
    name: &'a str,
    reference: Vec<Vec3>,
    records: Vec<ContactRecord>,
    history: &'a History,
    /// What has been dissipated in it since the start.
    dissipated: f64,
}

impl Seen<'_> {
    /// A reading of this contact.
    fn reading(&self, figure: &'static str, value: f64) -> Reading {
        Reading::new(figure, format!("contact '{}'", self.name), value)
    }
    /// The points that are closed.
    fn closed(&self) -> impl Iterator<Item = &ContactRecord> {
        self.records.iter().filter(|record| record.status != PointStatus::Open)
    }
    /// Hands in the largest reading over the closed points, and where it is.
    fn certify_largest(&self, frame: &mut Frame, figure: &'static str, of: impl Fn(&ContactRecord) -> f64) {
        let largest =
            self.closed().map(|record| (of(record), record.position)).reduce(|a, b| if b.0 > a.0 { b } else { a });
        if let Some((value, position)) = largest {
            frame.certify(self.reading(figure, value.max(0.0)).at(position));
        }
    }
}

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    let zero = vec![0.0; source.state.u.len()];
    let mut all = Vec::new();
    for (term, name, contact) in &source.parts.contacts {
        let history = source.history(*term)?;
        let reference = contact.records(&zero, history).iter().map(|record| record.position).collect();
        let records = contact.records(&source.state.u, history);
        let dissipated = source.state.energies.get(*term).map_or(0.0, |energies| energies.dissipated);
        all.push(Seen { contact: *contact, name, reference, records, history, dissipated });
    }
    if !all.is_empty() {
        report_points(&all, frame)?;
        let records: Vec<_> = all.iter().map(|seen| (seen.contact, seen.records.as_slice())).collect();
        surface::report(source.parts.mesh, &records, frame)?;
    }
    all.iter().try_for_each(|seen| report_contact(source, seen, frame))?;
    for first in &all {
        let second = second_name(first.name);
        if let Some(second) = all.iter().find(|other| other.name == second && other.contact.loads_itself()) {
            let name = format!("contact.{}.mismatch", first.name);
            let apart = mismatch(first, second);
            frame.push(Quantity::scalar(name, Unit::One, apart))?;
            frame.certify(first.reading("mismatch", apart));
            let name = format!("contact.{}.imbalance", first.name);
            let (left, larger) = imbalance(source, first, second);
            frame.push(Quantity::scalar(name, Unit::One, if larger > 0.0 { left / larger } else { 0.0 }))?;
            frame.certify(first.reading("imbalance", left).over(larger));
            if source.parts.space != Space::Axisymmetric {
                let (left, scale) = couple(first, Some(second));
                frame.certify(first.reading("moment_imbalance", left).over(scale));
            }
        }
    }
    Ok(())
}

/// Difference of the mean pressures of the two sides of a contact over their mean.
fn mismatch(first: &Seen, second: &Seen) -> f64 {
    let [one, other] = [first, second].map(|seen| {
        let closed = || seen.records.iter().filter(|record| record.status != PointStatus::Open);
        closed().map(|r| r.pressure * r.area).sum::<f64>() / closed().map(|r| r.area).sum::<f64>()
    });
    // Without contact there is nothing to disagree about.
    if one + other > 0.0 { 2.0 * (one - other).abs() / (one + other) } else { 0.0 }
}

/// What the forces on the two sides of a contact leave over, and the larger of them.
fn imbalance(source: &Source, first: &Seen, second: &Seen) -> (f64, f64) {
    // Radial forces of a full circumference have no sum.
    let radial = source.parts.space == Space::Axisymmetric;
    let [one, other] = [first, second].map(|seen| {
        let sum = seen.records.iter().fold(Vec3::zero(), |sum, record| sum + record.force());
        if radial { Vec3::new(0.0, sum[1], 0.0) } else { sum }
    });
    ((one + other).norm(), one.norm().max(other.norm()))
}

/// Force and middle of what the closed points of a contact bear, the middle weighed by the forces.
fn resultant(seen: &Seen) -> (f64, Vec3) {
    let force = || seen.closed().map(|record| (record.force().norm(), record.position));
    let total: f64 = force().map(|(force, _)| force).sum();
    let middle = force().fold(Vec3::zero(), |sum, (force, x)| sum + x * force) * total.recip();
    (total, middle)
}

/// The moment that the forces of a contact and those on its target leave over, and the largest that they could make: all
/// forces at the ends of the surface. The target bears the forces of its own points, or those of the surface where their
/// rays meet it.
fn couple(first: &Seen, second: Option<&Seen>) -> (f64, f64) {
    let (total, middle) = resultant(first);
    let extent = first.records.iter().map(|record| (record.position - middle).norm()).fold(0.0, f64::max);
    let about = |seen: &Seen| {
        let moment = |record: &ContactRecord| (record.position - middle).cross(record.force());
        seen.closed().fold(Vec3::zero(), |sum, record| sum + moment(record))
    };
    let across = |record: &ContactRecord| (record.inward * -record.penetration).cross(record.force());
    let left = match second {
        Some(second) => about(first) + about(second),
        None => first.closed().fold(Vec3::zero(), |sum, record| sum + across(record)),
    };
    (left.norm(), total * extent)
}

/// By how much the shear force of the points that slip differs from what their law allows, both resolved on the normals of
/// the target; and the shear force of all points, or half of what they would bear if all slipped where that is more: a wheel that rolls freely
/// has none. Where the law allows none, the shear force itself and the normal one. None where nothing slips.
///
/// The stress at a point follows the normal of its own edge or face. Where that is not the one of what it touches, the
/// ratio of shear to pressure there is not the one of the law.
fn friction(seen: &Seen, plane: bool) -> Option<(f64, f64)> {
    let (mut excess, mut carried, mut thrust, mut shear, mut slips) = (0.0, 0.0, 0.0, Vec3::zero(), false);
    let mut most = 0.0_f64;
    for record in seen.closed().filter(|record| record.pressure > 0.0) {
        let (force, normal) = (record.force(), record.facing);
        let pressing = force.dot(normal);
        let ratio = record.shear.abs() / record.pressure;
        let allowed = ratio * pressing;
        (carried, thrust) = (carried + allowed, thrust + pressing);
        if record.status == PointStatus::Slip {
            let tangential = force - normal * pressing;
            (excess, slips) = (excess + tangential.norm() - allowed, true);
            most = most.max(ratio);
            // Along a curved target of the plane its tangents are one direction.
            shear += if plane { Vec3::new(force.dot(normal.left()), 0.0, 0.0) } else { tangential };
        }
    }
    let least = 0.5 * most * thrust;
    slips.then(|| if carried > 0.0 { (excess.abs(), carried.max(least)) } else { (shear.norm(), thrust) })
}

fn report_points(all: &[Seen], frame: &mut Frame) -> Result<(), Error> {
    let records = || all.iter().flat_map(|seen| &seen.records);
    let vector = |name: &str, unit, of: &dyn Fn(&ContactRecord) -> Vec3| {
        let values = records().flat_map(|record| of(record).0).collect();
        Quantity::new(name, unit, QuantityPlace::Contact, Width::Vector, values)
    };
    let scalar = |name: &str, unit, of: &dyn Fn(&ContactRecord) -> f64| {
        Quantity::new(name, unit, QuantityPlace::Contact, Width::Scalar, records().map(of).collect())
    };
    let reference = || all.iter().flat_map(|seen| &seen.reference);
    let moved = records().zip(reference()).flat_map(|(record, before)| (record.position - *before).0).collect();
    let before = reference().flat_map(|x| x.0).collect();
    let number = all.iter().enumerate().flat_map(|(i, seen)| seen.records.iter().map(move |_| i as f64)).collect();
    let length = |name: &str, values| Quantity::new(name, Unit::Length, QuantityPlace::Contact, Width::Vector, values);
    frame.push(length(REFERENCE_POSITION, before))?;
    frame.push(length("displacement", moved))?;
    frame.push(Quantity::integer("contact", QuantityPlace::Contact, number))?;
    let status = records().map(|record| f64::from(record.status as u8)).collect();
    frame.push(Quantity::byte("contact_status", QuantityPlace::Contact, status))?;
    frame.push(scalar("contact_pressure", Unit::Stress, &|r| r.pressure))?;
    frame.push(vector("contact_traction", Unit::Stress, &ContactRecord::traction))?;
    frame.push(scalar("contact_gap", Unit::Length, &|r| -r.penetration))?;
    frame.push(scalar("contact_slip", Unit::Length, &|r| r.slip))?;
    frame.push(scalar("contact_slip_path", Unit::Length, &|r| r.slipped))?;
    frame.push(scalar("contact_heat", Unit::EnergyDensity, &|r| r.dissipated))?;
    frame.push(scalar("contact_rubbing", Unit::EnergyDensity, &|r| r.rubbed))?;
    if let Some(wear) = wear_of(all) {
        frame.push(Quantity::new("contact_wear", Unit::Length, QuantityPlace::Contact, Width::Scalar, wear))?;
    }
    variables(all).into_iter().try_for_each(|variable| frame.push(values_of(variable, all)))?;
    frame.push(scalar("contact_area", Unit::Area, &|r| r.area))?;
    frame.push(vector("contact_normal", Unit::One, &|r| r.inward))?;
    frame.push(vector("contact_force", Unit::Force, &ContactRecord::force))
}

/// Depth of wear at all points; not a number in contacts that do not wear. None where none does.
fn wear_of(all: &[Seen]) -> Option<Vec<f64>> {
    let coefficient = |seen: &Seen| seen.contact.options().wear;
    all.iter().find_map(coefficient)?;
    let depth = |seen| {
        let coefficient = coefficient(seen).unwrap_or(f64::NAN);
        seen.records.iter().map(move |record| coefficient * record.worn)
    };
    Some(all.iter().flat_map(depth).collect())
}

/// The variables of all laws, each name once.
fn variables(all: &[Seen]) -> Vec<&'static Variable> {
    let mut found: Vec<&Variable> = Vec::new();
    for variable in all.iter().flat_map(|seen| seen.contact.variables()) {
        if found.iter().all(|known| known.name != variable.name) {
            found.push(variable);
        }
    }
    found
}

/// A variable at all points; not a number where the law has none of that name.
fn values_of(variable: &Variable, all: &[Seen]) -> Quantity {
    let of = |seen| {
        let seen: &Seen = seen;
        let place = seen.contact.variables().iter().position(|known| known.name == variable.name);
        seen.records.iter().map(move |record| place.map_or(f64::NAN, |place| record.vars[place]))
    };
    let values = all.iter().flat_map(of).collect();
    Quantity::new(format!("contact_{}", variable.name), Unit::One, QuantityPlace::Contact, Width::Scalar, values)
}

fn report_contact(source: &Source, seen: &Seen, frame: &mut Frame) -> Result<(), Error> {
    certify(source, seen, frame);
    let closed = || seen.closed();
    let sum = |of: &dyn Fn(&ContactRecord) -> Vec3| closed().fold(Vec3::zero(), |sum, record| sum + of(record));
    let total = |of: &dyn Fn(&ContactRecord) -> f64| closed().map(of).sum::<f64>();
    let most = |of: &dyn Fn(&ContactRecord) -> f64| closed().map(of).fold(0.0, f64::max);
    let count = |status| closed().filter(|record| record.status == status).count() as f64;
    let pole = seen.contact.pole(&source.state.u);
    let thrust = total(&|r| r.pressure * r.area);
    // The centre of pressure; that of a contact without pressure is nowhere.
    let center = sum(&|r| r.center() * (r.pressure * r.area)) * thrust.recip();
    let vectors = [
        ("force", Unit::Force, Width::Vector, sum(&ContactRecord::force)),
        ("moment", Unit::Moment, Width::Axial, sum(&|r| (r.center() - pole).cross(r.force()))),
        ("center", Unit::Length, Width::Vector, center + source.parts.mesh.origin),
    ];
    let least = closed().map(|r| r.last_dissipated * r.area).reduce(f64::min).unwrap_or(0.0);
    let refused = seen.contact.false_contacts(&source.state.u) as f64;
    let scalars = [
        ("area", Unit::Area, total(&|r| r.area)),
        ("thrust", Unit::Force, thrust),
        ("max_pressure", Unit::Stress, most(&|r| r.pressure)),
        ("max_penetration", Unit::Length, most(&|r| r.penetration)),
        ("max_penetration_relative", Unit::One, most(&|r| r.penetration / edge_length(source, seen.contact, r.edge))),
        ("stick", Unit::One, count(PointStatus::Stick)),
        ("slip", Unit::One, count(PointStatus::Slip)),
        ("dissipation", Unit::Energy, seen.dissipated),
        ("least_dissipation", Unit::Energy, least),
        ("coulomb_violation", Unit::One, most(&|r| r.violation)),
        ("false_contacts", Unit::One, refused),
    ];
    frame.certify(seen.reading("rejected_false_contacts", refused));
    let name = |what: &str| format!("contact.{}.{what}", seen.name);
    for (what, unit, width, value) in vectors {
        frame.push(Quantity::new(name(what), unit, QuantityPlace::Global, width, value.0.to_vec()))?;
    }
    scalars.into_iter().try_for_each(|(what, unit, value)| frame.push(Quantity::scalar(name(what), unit, value)))?;
    let (u, history) = (&source.state.u, seen.history);
    let sometimes = [
        ("facet_ratio", seen.contact.facet_ratio(u, history)),
        ("nodal_penetration", seen.contact.nodal_penetration(history)),
        ("coarseness", seen.contact.coarseness(history)),
    ];
    for (what, value) in sometimes.into_iter().filter_map(|(what, value)| Some((what, value?))) {
        frame.push(Quantity::scalar(name(what), Unit::One, value))?;
        // What little is carried is worth little beside what facets stand for and small tools press.
        frame.certify(if what == "nodal_penetration" {
            seen.reading(what, value)
        } else {
            seen.reading(what, value * thrust).over(thrust)
        });
    }
    Ok(())
}

/// The readings at the points of a contact.
fn certify(source: &Source, seen: &Seen, frame: &mut Frame) {
    let length = |record: &ContactRecord| edge_length(source, seen.contact, record.edge);
    seen.certify_largest(frame, "max_penetration", |record| record.penetration);
    seen.certify_largest(frame, "max_penetration_relative", |record| record.penetration / length(record));
    if let Some(sample) = seen.contact.sampled(&source.state.u, seen.history) {
        let relative = sample.penetration / edge_length(source, seen.contact, sample.edge);
        frame.certify(seen.reading("sampled_penetration", relative).at(sample.position));
    }
    seen.certify_largest(frame, "coulomb_violation", |record| record.violation);
    if let Some((apart, scale)) = friction(seen, source.is_plane()) {
        frame.certify(seen.reading("friction_deviation", apart).over(scale));
    }
    if !seen.contact.loads_itself() && source.parts.space != Space::Axisymmetric {
        let (left, scale) = couple(seen, None);
        frame.certify(seen.reading("moment_imbalance", left).over(scale));
    }
    if !seen.contact.law().is_compliant() {
        // What the law let close or dilate for good is no penalty's.
        let still = |record: &ContactRecord| seen.contact.law().stays(&record.vars);
        let pressed = |record: &ContactRecord| record.penetration + record.closure.min(0.0) - still(record);
        let work = |record: &ContactRecord| 0.5 * record.pressure * pressed(record).max(0.0) * record.area;
        let bodies = of_bodies(source);
        let work = seen.contact.share() * seen.closed().map(work).sum::<f64>();
        frame.certify(seen.reading("penalty_energy", work).over(bodies.stored + bodies.dissipated));
    }
    let together = seen.contact.largest_patch(seen.history).unwrap_or_else(|| seen.closed().count());
    frame.certify(seen.reading("closed_points", together as f64));
    if let Some(least) = seen.closed().map(|record| record.last_dissipated * record.area).reduce(f64::min) {
        frame.certify(seen.reading("least_dissipation", least));
    }
}

/// Present distance between the ends of an edge of the surface.
fn edge_length(source: &Source, contact: Touching, edge: usize) -> f64 {
    let place = |node: usize| source.parts.mesh.points[node] + Vec3(source.displacement(node));
    contact.edge_ends(edge).map_or(f64::NAN, |[start, end]| (place(end) - place(start)).norm())
}
