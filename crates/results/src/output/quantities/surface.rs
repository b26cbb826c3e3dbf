//! Contact stress, gap, slip, wear and status on the faces of the surfaces, and at their nodes.
//!
//! A contact point gives to the corners of its face by the shape functions of the corners, weighed with its area; a node of
//! a field gives to itself. Nodes between corners get the mean of those. Nodes of no surface have no value.

use super::Touching;
use super::touching::Stand;
use crate::output::{Frame, Quantity, QuantityPlace, Unit, Width};
use asperity_core::Error;
use asperity_core::contact::{ContactRecord, PointStatus};
use asperity_core::mesh::Mesh;
use asperity_core::mesh::cells::MAX_NODES;
use asperity_core::tensor::Vec3;

/// What is summed: pressure, the shear stress vector, gap, slip, depth of wear.
const SUMS: usize = 6;

/// The weighed sum of what contact points say; gaps are known where a target is seen.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    weight: f64,
    values: [f64; SUMS],
    /// Weight of the gaps alone.
    seen: f64,
    /// Depths of wear with their weight: at a node the sum over the pieces of what it touched.
    worn: [f64; 2],
    status: u8,
    touched: bool,
}

/// Means over a face or at a node.
#[derive(Debug, Clone, Copy)]
struct Mean {
    pressure: f64,
    /// Shear stress on the solid.
    shear: Vec3,
    /// Distance, negative for a penetration.
    gap: f64,
    /// With its sign in the plane, its size in space.
    slip: f64,
    /// Depth of wear, zero in contacts that do not wear.
    wear: f64,
    /// 0 open, 1 sticking, 2 slipping: the highest of its points.
    status: u8,
}

impl Sum {
    /// Adds a record, of a point with the area that it stands for.
    fn add(&mut self, record: &ContactRecord, wear: f64, area: Option<f64>) {
        let weight = area.unwrap_or(record.area);
        let shear = record.along * record.shear;
        let values = [record.pressure, shear[0], shear[1], shear[2], 0.0, record.slip];
        self.values.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
        if record.penetration.is_finite() {
            self.values[4] -= weight * record.penetration;
            self.seen += weight;
        }
        self.worn = match area {
            Some(area) => [self.worn[0] + area * wear * record.worn, self.worn[1] + area],
            None => [self.worn[0] + wear * record.worn, 1.0],
        };
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
        let wear = if self.worn[1] > 0.0 { self.worn[0] / self.worn[1] } else { 0.0 };
        let (pressure, slip, status) = (over(0), over(5), self.status);
        self.touched.then_some(Mean { pressure, shear, gap, slip, wear, status })
    }
}

/// Adds what a contact says to the sums at all nodes; the sums over its faces.
fn of_contact(mesh: &Mesh, contact: Touching, records: &[ContactRecord], nodes: &mut [Sum]) -> Vec<Sum> {
    let (sides, wear) = (contact.sides(), contact.options().wear.unwrap_or(0.0));
    let (mut faces, mut own) = (vec![Sum::default(); sides.len()], vec![Sum::default(); mesh.points.len()]);
    for (slot, record) in records.iter().enumerate() {
        match contact.stand(slot) {
            Stand::Face(face, corners) => {
                if let Some(sum) = faces.get_mut(face) {
                    sum.add(record, wear, Some(record.area));
                }
                corners.iter().for_each(|&(node, n)| own[node].add(record, wear, Some(n * record.area)));
            }
            Stand::Node(node) => own[node].add(record, wear, None),
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
    faces
}

impl Sum {
    /// Adds a part of another.
    fn join(&mut self, other: &Self, part: f64) {
        if other.touched {
            self.values.iter_mut().zip(other.values).for_each(|(sum, value)| *sum += part * value);
            (self.weight, self.seen) = (self.weight + part * other.weight, self.seen + part * other.seen);
            self.worn = [0, 1].map(|i| self.worn[i] + part * other.worn[i]);
            (self.status, self.touched) = (self.status.max(other.status), true);
        }
    }
}

/// Reports faces and nodes of the contacts with their records.
pub(super) fn report(mesh: &Mesh, all: &[(Touching, &[ContactRecord])], frame: &mut Frame) -> Result<(), Error> {
    let (mut faces, mut nodes) = (Vec::new(), vec![Sum::default(); mesh.points.len()]);
    let mut number = Vec::new();
    for (i, (contact, records)) in all.iter().enumerate() {
        faces.extend(of_contact(mesh, *contact, records, &mut nodes));
        number.resize(faces.len(), i as f64);
    }
    let [faces, nodes] = [faces, nodes].map(|sums| sums.iter().map(Sum::mean).collect::<Vec<_>>());
    let values = |means: &[Option<Mean>], of: &dyn Fn(&Mean) -> f64| -> Vec<f64> {
        means.iter().map(|mean| mean.as_ref().map_or(f64::NAN, of)).collect()
    };
    let status = |mean: &Mean| f64::from(mean.status);
    frame.push(Quantity::integer("contact", QuantityPlace::Face, number))?;
    // A face of which nothing is said is open.
    let open = values(&faces, &status).into_iter().map(|status| if status.is_nan() { 0.0 } else { status }).collect();
    frame.push(Quantity::byte("contact_status", QuantityPlace::Face, open))?;
    let shear = faces.iter().flat_map(|mean| mean.map_or([f64::NAN; 3], |mean| mean.shear.0)).collect();
    frame.push(Quantity::new("contact_shear", Unit::Stress, QuantityPlace::Face, Width::Vector, shear))?;
    let mut push = |name: &str, unit, of: &dyn Fn(&Mean) -> f64| {
        let scalar = |name: String, place, values| Quantity::new(name, unit, place, Width::Scalar, values);
        frame.push(scalar(name.to_owned(), QuantityPlace::Face, values(&faces, of)))?;
        frame.push(scalar(format!("{name}_averaged"), QuantityPlace::Node, values(&nodes, of)))
    };
    push("contact_pressure", Unit::Stress, &|mean| mean.pressure)?;
    push("contact_gap", Unit::Length, &|mean| mean.gap)?;
    push("contact_slip", Unit::Length, &|mean| mean.slip)?;
    if all.iter().any(|(contact, _)| contact.options().wear.is_some()) {
        push("contact_wear", Unit::Length, &|mean| mean.wear)?;
    }
    let mut nodal = |name: &str, unit, of: &dyn Fn(&Mean) -> f64| {
        frame.push(Quantity::new(name, unit, QuantityPlace::Node, Width::Scalar, values(&nodes, of)))
    };
    nodal("contact_shear_averaged", Unit::Stress, &|mean| mean.shear.norm())?;
    nodal("contact_status_averaged", Unit::One, &status)
}
