//! Contact stress, gap, slip and status on the faces of the surfaces, and at their nodes.
//!
//! A contact point gives to the corners of its face by the shape functions of the corners, weighed with its area; a node of
//! a field gives to itself. Nodes between corners get the mean of those. Nodes of no surface have no value.

use super::touching::Stand;
use super::{Source, Touching};
use crate::Error;
use crate::contact::{PointRecord, PointStatus};
use crate::mesh::cells::MAX_NODES;
use crate::mesh::{Mesh, Side};
use crate::output::{Frame, Place, Quantity, Unit, Width};
use crate::tensor::Vec3;

/// What is summed: pressure, the shear stress vector, gap, slip.
const SUMS: usize = 6;

/// The weighed sum of what contact points say; gaps are known where a target is seen.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    weight: f64,
    values: [f64; SUMS],
    /// Weight of the gaps alone.
    seen: f64,
    status: u8,
    touched: bool,
}

/// Means over a face or at a node.
#[derive(Debug, Clone, Copy)]
pub struct Mean {
    /// Pressure.
    pub pressure: f64,
    /// Shear stress on the solid.
    pub shear: Vec3,
    /// Distance, negative for a penetration.
    pub gap: f64,
    /// Slip: with its sign in the plane, its size in space.
    pub slip: f64,
    /// 0 open, 1 sticking, 2 slipping: the highest of its points.
    pub status: u8,
}

/// A face of the surface of a contact.
pub struct FaceOfContact {
    /// The side of the mesh.
    pub side: Side,
    /// Number of the contact.
    pub contact: usize,
    /// What its points say.
    pub mean: Mean,
}

impl Sum {
    fn add(&mut self, record: &PointRecord, weight: f64) {
        let shear = record.along * record.shear;
        let values = [record.pressure, shear[0], shear[1], shear[2], 0.0, record.slip];
        self.values.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
        if record.penetration.is_finite() {
            self.values[4] -= weight * record.penetration;
            self.seen += weight;
        }
        self.weight += weight;
        self.touched = true;
        if record.status != PointStatus::Open {
            self.status = self.status.max(record.status as u8);
        }
    }
    fn mean(&self) -> Option<Mean> {
        let over = |i: usize| if self.weight > 0.0 { self.values[i] / self.weight } else { 0.0 };
        let gap = if self.seen > 0.0 { self.values[4] / self.seen } else { f64::NAN };
        let shear = Vec3::new(over(1), over(2), over(3));
        self.touched.then(|| Mean { pressure: over(0), shear, gap, slip: over(5), status: self.status })
    }
}

/// The means at all nodes of a contact's surface, and its faces.
fn of_contact(
    mesh: &Mesh,
    (number, contact): (usize, Touching),
    records: &[PointRecord],
    nodes: &mut [Sum],
) -> Vec<FaceOfContact> {
    let sides = contact.sides();
    let (mut faces, mut own) = (vec![Sum::default(); sides.len()], vec![Sum::default(); mesh.points.len()]);
    for (slot, record) in records.iter().enumerate() {
        match contact.stand(slot) {
            Stand::Face(face, corners) => {
                if let Some(sum) = faces.get_mut(face) {
                    sum.add(record, record.area);
                }
                corners.iter().for_each(|&(node, n)| own[node].add(record, n * record.area));
            }
            Stand::Node(node) => own[node].add(record, record.area),
            Stand::Apart => {}
        }
    }
    for (&side, face) in sides.iter().zip(&mut faces) {
        let (kind, around) = mesh.side(side);
        let around: Vec<usize> = around.collect();
        let corners = kind.linear.nodes.len();
        for (i, &node) in around.iter().enumerate().skip(corners).filter(|(_, node)| !own[**node].touched) {
            let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
            (kind.linear.shape)(kind.nodes[i], &mut n, &mut dn);
            let mut between = Sum::default();
            for (&corner, &n) in around.iter().zip(&n[..corners]).filter(|(_, n)| **n > 0.0) {
                between.join(&own[corner], n);
            }
            nodes[node].join(&between, 1.0);
        }
        if !face.touched {
            around[..corners].iter().for_each(|&node| face.join(&own[node], 1.0));
        }
    }
    nodes.iter_mut().zip(&own).for_each(|(all, own)| all.join(own, 1.0));
    let found = sides.into_iter().zip(faces);
    found.filter_map(|(side, sum)| Some(FaceOfContact { side, contact: number, mean: sum.mean()? })).collect()
}

impl Sum {
    /// Adds a part of another.
    fn join(&mut self, other: &Self, part: f64) {
        if other.touched {
            self.values.iter_mut().zip(other.values).for_each(|(sum, value)| *sum += part * value);
            (self.weight, self.seen) = (self.weight + part * other.weight, self.seen + part * other.seen);
            (self.status, self.touched) = (self.status.max(other.status), true);
        }
    }
}

/// The faces of all contacts and the sums at all nodes.
fn gathered(source: &Source) -> Result<(Vec<FaceOfContact>, Vec<Sum>), Error> {
    let mesh = source.parts.mesh;
    let (mut faces, mut nodes) = (Vec::new(), vec![Sum::default(); mesh.points.len()]);
    for (number, (term, _, contact)) in source.parts.contacts.iter().enumerate() {
        let records = contact.records(&source.state.u, source.history(*term)?);
        faces.extend(of_contact(mesh, (number, *contact), &records, &mut nodes));
    }
    Ok((faces, nodes))
}

/// The faces of all contacts.
///
/// # Errors
/// [`Error::Internal`] when parts and state do not belong together.
pub fn faces(source: &Source) -> Result<Vec<FaceOfContact>, Error> {
    Ok(gathered(source)?.0)
}

pub(super) fn report(source: &Source, frame: &mut Frame) -> Result<(), Error> {
    if source.parts.contacts.is_empty() {
        return Ok(());
    }
    let means: Vec<Option<Mean>> = gathered(source)?.1.iter().map(Sum::mean).collect();
    let mut push = |name: &str, unit, of: &dyn Fn(&Mean) -> f64| {
        let values = means.iter().map(|mean| mean.as_ref().map_or(f64::NAN, of)).collect();
        frame.push(Quantity::new(format!("{name}_averaged"), unit, Place::Node, Width::Scalar, values))
    };
    push("contact_pressure", Unit::Stress, &|mean| mean.pressure)?;
    push("contact_shear", Unit::Stress, &|mean| mean.shear.norm())?;
    push("contact_gap", Unit::Length, &|mean| mean.gap)?;
    push("contact_slip", Unit::Length, &|mean| mean.slip)?;
    push("contact_status", Unit::One, &|mean| f64::from(mean.status))
}
