//! History of a contact point, and what outputs may ask of it.

use crate::interface::{Interface, Linearised, MOST_VARIABLES, Past};
use crate::system::{Coordinates, History};
use crate::tensor::Vec3;

/// Places of the values in a point's history; the law's own variables follow.
pub mod entry {
    /// Penetration, negative for a gap.
    pub const PENETRATION: usize = 0;
    /// Segment of the target that is hit, of a tip of a tool the face of the surface; -1 without a hit.
    pub const SEGMENT: usize = 1;
    /// First coordinate on that segment.
    pub const S: usize = 2;
    /// Pressure.
    pub const PRESSURE: usize = 3;
    /// Shear stress along the tangent.
    pub const SHEAR: usize = 4;
    /// Slip along the tangent, accumulated with its sign since the start.
    pub const SLIP: usize = 5;
    /// Irreversible slip, accumulated without sign since the start.
    pub const SLIPPED: usize = 6;
    /// Energy dissipated per area since the start.
    pub const DISSIPATED: usize = 7;
    /// 0 open, 1 stick, 2 slip.
    pub const STATUS: usize = 8;
    /// Relative violation of the yield surface.
    pub const VIOLATION: usize = 9;
    /// Energy dissipated per area in the last increment.
    pub const LAST_DISSIPATED: usize = 10;
    /// Second coordinate on the segment; zero in the plane.
    pub const S2: usize = 11;
    /// Shear stress along the second tangent, in space.
    pub const SHEAR2: usize = 12;
    /// Slip along the second tangent, accumulated with its sign since the start, in space.
    pub const SLIP2: usize = 13;
    /// Area that a node of a field stands for.
    pub const XI: usize = 14;
    /// Stretch of that area.
    pub const HALF: usize = 15;
    /// Pressure times irreversible slip, summed since the start.
    pub const RUBBED: usize = 16;
    /// What was added to the penetration that the law saw: multipliers, overlap not yet removed, wear, how much nearer a tool lies.
    pub const CLOSURE: usize = 17;
    /// Penetration at the beginning that is removed little by little,
    pub const OVERLAP: usize = 18;
    /// the time from which on,
    pub const SINCE: usize = 19;
    /// and the time at which nothing is left of it.
    pub const UNTIL: usize = 20;
    /// Pressure at the beginning of the last increment.
    pub const PRESSURE_BEFORE: usize = 21;
    /// Normal penalty of a node of a field, for undeformed area.
    pub const PENALTY: usize = 22;
    /// Largest share of dual functions at a node of a field, by how the surface bends there,
    pub const UNBENT: usize = 23;
    /// and of those of second degree by how near the contact is to sliding.
    pub const AT_REST: usize = 24;
    /// How much nearer the target lies than in the mean, so far as that is added to the penetration.
    pub const NEARER: usize = 25;
    /// Of a node of the field: pressure times irreversible slip over the part of its area that saw the target, with what tips rubbed there.
    pub const WORN: usize = 26;
    /// Of a corner of a body: the direction in which it touches, as long as its part of the force is large.
    pub const POINTS: usize = 27;
    /// Of a node of the field: what a corner of the body takes at least of what it stands for.
    pub const TAKEN: usize = POINTS;
    /// Number of these values.
    pub const COUNT: usize = 30;
}

/// What is said of an overlap.
const OVERLAP: std::ops::Range<usize> = entry::OVERLAP..entry::UNTIL + 1;

/// Pressure and shear stresses over the coordinates of a point; the last of these has none.
pub fn stresses(values: &[f64]) -> Coordinates {
    [values[entry::PRESSURE], values[entry::SHEAR], values[entry::SHEAR2], 0.0]
}

/// Writes what the law answers at a closed point that slips along the two tangents, in the plane the second zero, and recedes by wear.
pub fn write(response: &Linearised, (slip, wear): ([f64; 2], f64), old: &[f64], new: &mut [f64]) {
    new[OVERLAP].copy_from_slice(&old[OVERLAP]);
    new[entry::PRESSURE] = response.pressure();
    new[entry::PRESSURE_BEFORE] = old[entry::PRESSURE];
    [new[entry::SHEAR], new[entry::SHEAR2]] = response.shear();
    new[entry::SLIP] = old[entry::SLIP] + slip[0];
    new[entry::SLIP2] = old[entry::SLIP2] + slip[1];
    new[entry::SLIPPED] = old[entry::SLIPPED] + response.slipped;
    new[entry::DISSIPATED] = old[entry::DISSIPATED] + response.dissipated;
    let rubbed = response.pressure().max(0.0) * response.slipped;
    new[entry::RUBBED] = old[entry::RUBBED] + rubbed;
    new[entry::WORN] = old[entry::WORN];
    new[entry::CLOSURE] -= wear * rubbed;
    new[entry::STATUS] = f64::from(response.status as u8);
    new[entry::VIOLATION] = response.violation;
    new[entry::LAST_DISSIPATED] = response.dissipated;
}

/// What a law may know of a point with this accepted history, for its normal and its tangential penalty.
pub fn past(old: &[f64], [penalty, tangential_penalty]: [f64; 2], dt: f64) -> Past<'_> {
    Past {
        penalty,
        tangential_penalty,
        penetration: old[entry::PENETRATION] + old[entry::CLOSURE],
        pressure: old[entry::PRESSURE],
        shear: [old[entry::SHEAR], old[entry::SHEAR2]],
        vars: &old[entry::COUNT..],
        dt,
    }
}

/// An open point keeps what has been, and of the law's own state what the law says.
pub fn leave(law: &dyn Interface, old: &[f64], new: &mut [f64]) {
    use entry::{DISSIPATED, RUBBED, SLIP, SLIP2, SLIPPED, WORN};
    for kept in [SLIP, SLIP2, SLIPPED, DISSIPATED, RUBBED, WORN].into_iter().chain(OVERLAP) {
        new[kept] = old[kept];
    }
    law.release(&old[entry::COUNT..], &mut new[entry::COUNT..]);
}

/// The present area of a node of a field, from what is known of it.
pub fn area(values: &[f64]) -> f64 {
    values[entry::XI] * values[entry::HALF]
}

/// The normal force of a node of a field, from what is known of it.
pub fn normal_force(values: &[f64]) -> f64 {
    values[entry::PRESSURE].max(0.0) * values[entry::HALF] * values[entry::XI]
}

/// The largest penetration at a closed point of the first so many slots, which are those of points.
pub fn largest_penetration(history: &History, points: usize) -> f64 {
    let slots = (0..points).map(|i| history.slot(i));
    let closed = slots.filter(|values| values[entry::STATUS] > 0.0);
    closed.map(|values| values[entry::PENETRATION]).filter(|depth| depth.is_finite()).fold(0.0, f64::max)
}

/// Whether a contact point is open, sticks or slips.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum PointStatus {
    /// No contact.
    #[default]
    Open = 0,
    /// Contact without slip.
    Stick = 1,
    /// Contact with slip.
    Slip = 2,
}

impl PointStatus {
    pub(super) fn from_value(value: f64) -> Self {
        match value as u8 {
            1 => Self::Stick,
            2 => Self::Slip,
            _ => Self::Open,
        }
    }
}

/// The law's variables in the history of a point.
pub fn variables(values: &[f64]) -> [f64; MOST_VARIABLES] {
    std::array::from_fn(|i| values.get(entry::COUNT + i).copied().unwrap_or(0.0))
}

/// One contact point in an accepted state.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ContactRecord {
    /// Present position.
    pub position: Vec3,
    /// Unit normal into the solid.
    pub inward: Vec3,
    /// Where a unit of pressure acts: along the normal, or so that it does its work on the penetration.
    pub thrust: Vec3,
    /// Outward unit normal of the target where a closed point meets it; the normal of the surface at an open one.
    pub facing: Vec3,
    /// Unit tangent, the solid on its left.
    pub along: Vec3,
    /// Area the point stands for; the full circumference when axisymmetric.
    pub area: f64,
    /// Force on the solid and where it acts, of a node that stands for more than a point.
    pub resultant: Option<[Vec3; 2]>,
    /// Status.
    pub status: PointStatus,
    /// Pressure, positive in compression.
    pub pressure: f64,
    /// Shear stress on the solid along the tangent.
    pub shear: f64,
    /// Penetration, negative for a gap; not a number without an admissible hit.
    pub penetration: f64,
    /// Slip accumulated with its sign.
    pub slip: f64,
    /// Irreversible slip accumulated without sign.
    pub slipped: f64,
    /// Energy dissipated per area since the start.
    pub dissipated: f64,
    /// Energy dissipated per area in the last increment.
    pub last_dissipated: f64,
    /// What is added to the penetration before the law sees it: less than nothing for overlap that is yet to be removed.
    pub closure: f64,
    /// Pressure times irreversible slip, summed since the start.
    pub rubbed: f64,
    /// The same over the area of a node, whatever part of it saw the target, with what tips rubbed there: the depth of wear over Archard's
    /// coefficient. Of a tip none, which wears the nodes beneath.
    pub worn: f64,
    /// Relative violation of the yield surface.
    pub violation: f64,
    /// The law's own variables; those that it does not have are zero.
    pub vars: [f64; MOST_VARIABLES],
    /// Segment of the target that is hit.
    pub segment: Option<usize>,
    /// Edge of the surface it lies on.
    pub edge: usize,
}

impl ContactRecord {
    /// Has it stand for this many times the area, under as much less of its stress.
    pub(super) fn spread(&mut self, times: f64) {
        self.area *= times;
        let densities = [&mut self.pressure, &mut self.shear, &mut self.last_dissipated];
        densities.into_iter().for_each(|density| *density /= times);
    }

    /// What the history of a point says, at no place yet.
    pub(super) fn of(values: &[f64], plane: bool) -> Self {
        // In the plane with their signs, in space their sizes.
        let along = |[s, t]: [usize; 2]| if plane { values[s] } else { values[s].hypot(values[t]) };
        Self {
            status: PointStatus::from_value(values[entry::STATUS]),
            pressure: values[entry::PRESSURE],
            shear: along([entry::SHEAR, entry::SHEAR2]),
            penetration: if values[entry::SEGMENT] >= 0.0 { values[entry::PENETRATION] } else { f64::NAN },
            slip: along([entry::SLIP, entry::SLIP2]),
            slipped: values[entry::SLIPPED],
            dissipated: values[entry::DISSIPATED],
            last_dissipated: values[entry::LAST_DISSIPATED],
            closure: values[entry::CLOSURE],
            rubbed: values[entry::RUBBED],
            worn: values[entry::RUBBED],
            violation: values[entry::VIOLATION],
            vars: variables(values),
            ..Self::default()
        }
    }
    /// Stress vector on the solid.
    pub fn traction(&self) -> Vec3 {
        self.thrust * self.pressure + self.along * self.shear
    }
    /// Force on the solid.
    pub fn force(&self) -> Vec3 {
        self.resultant.map_or_else(|| self.traction() * self.area, |[force, _]| force)
    }
    /// The same as the other side sees it.
    pub fn turn(&mut self) {
        for v in [&mut self.inward, &mut self.thrust, &mut self.facing, &mut self.along] {
            *v = -*v;
        }
        self.resultant = self.resultant.map(|[force, center]| [-force, center]);
    }
    /// Where that acts.
    pub fn center(&self) -> Vec3 {
        self.resultant.map_or(self.position, |[_, center]| center)
    }
}
