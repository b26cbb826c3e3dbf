//! A surface and its target as a term of equilibrium: one stencil a contact point.

use super::capture::{depths, positions};
use super::landmarks::{Landmark, Landmarks};
use super::open::{OpenContact, write_hit};
use super::point::triad;
use super::record::{PointRecord, PointStatus, entry};
use super::surface::{MAX_EDGE_NODES, Surface, SurfacePoint};
use crate::Failure;
use crate::interface::Interface;
use crate::mesh::{Mesh, Side, Space};
use crate::system::{Attempt, Dofs, History, Instant, State, Term};
use crate::tensor::Vec3;
use crate::tool::{Hit, Pose, Ray, Rejected, Rules, Tool, select};
use std::sync::Arc;

/// How a contact is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactOptions {
    /// Normal penalty, a stress per length.
    pub penalty: f64,
    /// Tangential penalty, a stress per length.
    pub tangential_penalty: f64,
    /// Thickness in the plane cases.
    pub thickness: f64,
    /// Least confined modulus of the solids in contact: the measure of a pressure that no solution has.
    pub modulus: f64,
}

/// Pressures up to this part of the confined modulus leave the tangent exact,
const ORDINARY: f64 = 0.02;
/// and so do those up to this multiple of the largest in the accepted state.
const GROWTH: f64 = 4.0;

/// A point counts as closed from this part of the surface's shortest edge on. One depth for all points: a flat surface
/// under uniform pressure then stays flat.
const CLOSED: f64 = 1e-10;

/// Contact between a surface and a rigid tool.
pub struct Contact {
    name: String,
    pub(super) mesh: Arc<Mesh>,
    pub(super) dofs: Dofs,
    pub(super) space: Space,
    pub(super) surface: Surface,
    boundary: Vec<Side>,
    pub(super) tool: Arc<Tool>,
    pub(super) tool_number: usize,
    pub(super) law: Arc<dyn Interface>,
    pub(super) options: ContactOptions,
    /// Penetration from which a point counts as closed.
    pub(super) least: f64,
}

impl Contact {
    /// A contact of `surface` with tool number `tool_number`. `boundary` is the whole outer boundary of the bodies
    /// behind the surface.
    pub fn new(
        name: &str,
        (mesh, dofs, space): (Arc<Mesh>, Dofs, Space),
        (surface, boundary): (Surface, Vec<Side>),
        (tool, tool_number): (Arc<Tool>, usize),
        (law, options): (Arc<dyn Interface>, ContactOptions),
    ) -> Self {
        let name = name.into();
        let mut contact =
            Self { name, mesh, dofs, space, surface, boundary, tool, tool_number, law, options, least: 0.0 };
        let lengths = (0..contact.surface.points.len()).map(|point| contact.edge_length(point));
        contact.least = CLOSED * lengths.fold(f64::INFINITY, f64::min);
        contact
    }

    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }
    /// The target.
    pub fn tool(&self) -> &Tool {
        &self.tool
    }
    /// Its number among the tools.
    pub fn tool_number(&self) -> usize {
        self.tool_number
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        &self.options
    }

    /// Where the tool stands.
    pub fn pose(&self, u: &[f64]) -> Pose {
        let first = self.dofs.tool(self.tool_number);
        Pose::new(u[first], u[first + 1], u[first + 2])
    }

    /// Position, tangent and present nodes of a point.
    pub(super) fn locate(&self, point: &SurfacePoint, u: &[f64]) -> (Vec3, Vec3) {
        let mut x = [Vec3::zero(); MAX_EDGE_NODES];
        let nodes = self.surface.nodes(point);
        for (x, here) in x.iter_mut().zip(positions(&self.mesh, &self.dofs, nodes, u)) {
            *x = here;
        }
        point.place(&x[..nodes.len()])
    }

    /// Length of the undeformed edge of a point, as its tangent there measures it.
    pub fn edge_length(&self, point: usize) -> f64 {
        let point = &self.surface.points[point];
        let x: Vec<Vec3> = self.surface.nodes(point).iter().map(|&node| self.mesh.points[node]).collect();
        2.0 * point.place(&x).1.norm()
    }

    /// Area a point stands for.
    pub(super) fn area(&self, point: &SurfacePoint, a: Vec3, tangent: Vec3) -> f64 {
        let around = if self.space == Space::Axisymmetric { std::f64::consts::TAU * a[0] } else { 1.0 };
        self.thickness() * point.weight * tangent.norm() * around
    }

    pub(super) fn thickness(&self) -> f64 {
        match self.space {
            Space::PlaneStrain | Space::PlaneStress => self.options.thickness,
            Space::Axisymmetric | Space::Solid => 1.0,
        }
    }

    /// All points in an accepted state, with this term's lane of its history.
    pub fn records<'a>(&'a self, u: &'a [f64], history: &'a History) -> impl Iterator<Item = PointRecord> + 'a {
        self.surface.points.iter().enumerate().map(move |(i, point)| {
            let (values, (a, tangent)) = (history.slot(i), self.locate(point, u));
            let (along, inward, _) = triad(tangent);
            let segment = (values[entry::SEGMENT] >= 0.0).then_some(values[entry::SEGMENT] as usize);
            PointRecord {
                position: a,
                inward,
                along,
                area: self.area(point, a, tangent),
                status: PointStatus::from_value(values[entry::STATUS]),
                pressure: values[entry::PRESSURE],
                shear: values[entry::SHEAR],
                penetration: if segment.is_some() { values[entry::PENETRATION] } else { f64::NAN },
                slip: values[entry::SLIP],
                slipped: values[entry::SLIPPED],
                dissipated: values[entry::DISSIPATED],
                last_dissipated: values[entry::LAST_DISSIPATED],
                violation: values[entry::VIOLATION],
                segment,
                edge: point.edge,
            }
        })
    }

    /// What the search finds at displacements `u`, point by point, and how many false contacts it rejects.
    pub fn search(&self, u: &[f64]) -> (Vec<Option<Hit>>, Rejected) {
        let depths = depths(&self.surface, &self.mesh, &self.dofs, &self.boundary, u);
        let (pose, mut rejected, mut scratch) = (self.pose(u), Rejected::default(), Vec::new());
        let points = self.surface.points.iter().zip(&depths);
        let hits = points.map(|(point, &depth)| {
            let (a, tangent) = self.locate(point, u);
            let (_, inward, _) = triad(tangent);
            self.cast(&pose, Ray { origin: a, direction: inward }, depth, (&mut scratch, &mut rejected))
        });
        (hits.collect(), rejected)
    }

    /// The pattern in which the target is touched in an accepted state.
    fn landmarks(&self, history: &History) -> Landmarks {
        let landmark = |values: &[f64]| {
            let (segment, s) = (values[entry::SEGMENT], values[entry::S]);
            let place = (segment >= 0.0).then(|| self.tool.point(&Pose::default(), segment as usize, s))?;
            Some(Landmark { place, closed: values[entry::STATUS] > 0.0 })
        };
        Landmarks((0..history.slots()).map(|i| landmark(history.slot(i))).collect())
    }

    pub(super) fn cast(&self, pose: &Pose, ray: Ray, depth: f64, out: (&mut Vec<Hit>, &mut Rejected)) -> Option<Hit> {
        // To the far side of the body: what lies beyond its middle is refused, and counted.
        self.tool.cast(pose, &ray, [f64::NEG_INFINITY, 2.0 * depth], out.0);
        select(ray.direction, out.0, &Rules::new(depth, self.tool.size()), out.1)
    }
}

impl Term for Contact {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial(&self) -> History {
        let vars: usize = self.law.variables().iter().map(|v| v.len()).sum();
        let mut history = History::new(self.surface.points.iter().map(|_| entry::COUNT + vars));
        let u = vec![0.0; self.dofs.count()];
        for (i, hit) in self.search(&u).0.into_iter().enumerate() {
            write_hit(hit, history.slot_mut(i));
        }
        history
    }

    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let depths = depths(&self.surface, &self.mesh, &self.dofs, &self.boundary, &accepted.u);
        let pressures = (0..history.slots()).map(|i| history.slot(i)[entry::PRESSURE]);
        let ordinary = (ORDINARY * self.options.modulus).max(GROWTH * pressures.fold(0.0, f64::max));
        let landmarks = self.landmarks(history);
        Ok(Box::new(OpenContact { contact: self, history, depths, landmarks, ordinary, dt: at.dt }))
    }

    fn name_of(&self, stencil: usize) -> String {
        let nodes = self.surface.nodes(&self.surface.points[stencil]);
        format!("point {stencil} of contact '{}' (edge with nodes {nodes:?})", self.name)
    }

    fn softens(&self) -> bool {
        true
    }

    fn branches(&self) -> &'static [&'static str] {
        &["open", "stick", "slip"]
    }
}
