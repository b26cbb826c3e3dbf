//! The integration points of a body in an accepted state: what outputs may ask of them.

use super::gradient::Shapes;
use super::volume::value;
use super::{Body, Strain};
use crate::mesh::Space;
use crate::system::History;
use crate::tensor::{Tensor2, Vec3};

/// One integration point in an accepted state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointRecord<'a> {
    /// The cell it lies in.
    pub cell: usize,
    /// Its number in the cell's quadrature.
    pub point: usize,
    /// Position before any motion.
    pub reference: Vec3,
    /// Present position.
    pub position: Vec3,
    /// Present volume it stands for, in small strain that before any motion, with F-bar that of its material: with the
    /// thickness in the plane, the full circumference when axisymmetric.
    pub volume: f64,
    /// Cauchy stress XX YY ZZ XY YZ XZ, then the variables of the law.
    pub state: &'a [f64],
}

impl Body {
    /// All integration points, cell by cell, at displacements `u` with this body's lane of the history.
    pub fn records<'a>(&'a self, u: &'a [f64], history: &'a History) -> impl Iterator<Item = PointRecord<'a>> + 'a {
        let len = self.point_len();
        self.cells.iter().enumerate().flat_map(move |(slot, &cell)| {
            let points = history.slot(slot).chunks_exact(len).enumerate();
            let shared = self.present_volume(slot, u);
            points.map(move |(point, state)| {
                let mut record = self.record(cell, point, u, state);
                if let Some(shared) = &shared {
                    let place = &self.places.cell(slot)[point];
                    record.volume = place.volume * value(shared, &place.functions) * self.thickness(state);
                }
                record
            })
        })
    }

    fn record<'a>(&self, cell: usize, point: usize, u: &[f64], state: &'a [f64]) -> PointRecord<'a> {
        let view = self.mesh.cell(cell);
        let Shapes { n, dn, weight, .. } = &self.shapes(view.kind).points[point];
        let (mut reference, mut position, mut jacobian) = (Vec3::zero(), Vec3::zero(), Tensor2::zero());
        let small = self.options.strain == Strain::Small;
        for (&node, (n, dn)) in view.nodes.iter().zip(n.iter().zip(dn)) {
            let x = self.mesh.points[node];
            let first = self.dofs.node(node);
            let mut present = x;
            (0..self.dofs.per_node()).for_each(|a| present[a] += u[first + a]);
            reference += x * *n;
            position += present * *n;
            for (row, x) in jacobian.0.iter_mut().zip(if small { x.0 } else { present.0 }) {
                row.iter_mut().zip(dn).for_each(|(entry, dn)| *entry += x * dn);
            }
        }
        if self.space != Space::Solid {
            jacobian[(2, 2)] = 1.0;
        }
        let radius = if small { reference[0] } else { position[0] };
        let around = if self.space == Space::Axisymmetric { std::f64::consts::TAU * radius } else { 1.0 };
        let volume = jacobian.det() * weight * around * self.thickness(state);
        PointRecord { cell, point, reference, position, volume, state: &state[..self.material().state_len()] }
    }
}
