//! Faces of bodies and a rigid tool in space as a term of equilibrium: one stencil a contact point.

use super::capture::{depths, locate};
use super::open::{OpenContact, write_hit};
use super::point::Triad;
use super::surface::{Surface, SurfacePoint};
use crate::Failure;
use crate::contact::ContactOptions;
use crate::contact::pair::CLOSED;
use crate::contact::record::{PointRecord, PointStatus, entry};
use crate::interface::Interface;
use crate::mesh::{Mesh, Side};
use crate::system::{Attempt, Dofs, History, Instant, State, Term};
use crate::tensor::Vec3;
use crate::tool::space::{Hit, Pose, Tool};
use crate::tool::{Ray, Rejected, Rules, select};
use std::sync::Arc;

/// What a contact in space is made of.
pub struct Parts {
    /// The user's name for it.
    pub name: String,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The numbering of the unknowns.
    pub dofs: Dofs,
    /// The faces that carry the contact points.
    pub surface: Surface,
    /// The whole outer boundary of the bodies behind the surface.
    pub boundary: Vec<Side>,
    /// The target and its number among the tools.
    pub tool: (Arc<Tool>, usize),
    /// The law of the interface.
    pub law: Arc<dyn Interface>,
    /// How it is computed.
    pub options: ContactOptions,
}

/// Contact in space between a surface and a rigid tool.
pub struct Contact {
    pub(super) parts: Parts,
    /// Penetration from which a point counts as closed.
    pub(super) least: f64,
}

impl Contact {
    /// A contact of these parts.
    pub fn new(parts: Parts) -> Self {
        let mut contact = Self { parts, least: 0.0 };
        let lengths = (0..contact.parts.surface.points.len()).map(|point| contact.face_length(point));
        contact.least = CLOSED * lengths.fold(f64::INFINITY, f64::min);
        contact
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.parts.mesh
    }
    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.parts.surface
    }
    /// The target.
    pub fn tool(&self) -> &Tool {
        &self.parts.tool.0
    }
    /// Its number among the tools.
    pub fn tool_number(&self) -> usize {
        self.parts.tool.1
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        &self.parts.options
    }

    /// Where the tool stands.
    pub fn pose(&self, u: &[f64]) -> Pose {
        let first = self.parts.dofs.tool(self.parts.tool.1);
        Pose::new(std::array::from_fn(|i| u[first + i]))
    }
    /// Where moments are taken about: the present place of the tool's reference point.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.tool().reference() + self.pose(u).translation
    }

    pub(super) fn locate(&self, point: &SurfacePoint, u: &[f64]) -> (Vec3, [Vec3; 2]) {
        locate(&self.parts.surface, point, (&self.parts.mesh, &self.parts.dofs), u)
    }

    /// Size of the undeformed face of a point, a length: the root of its area if the face were even.
    pub fn face_length(&self, point: usize) -> f64 {
        let point = &self.parts.surface.points[point];
        let nodes = self.parts.surface.nodes(point);
        let x: Vec<Vec3> = nodes.iter().map(|&node| self.parts.mesh.points[node]).collect();
        let kind = self.parts.surface.faces[point.face].kind;
        let measure: f64 = kind.gauss[0].map_or(1.0, |rule| rule.weights.iter().sum());
        (Triad::new(point.place(&x).1).area * measure).sqrt()
    }

    /// All points in an accepted state, with this term's lane of its history. Their `along` is the direction of the
    /// shear stress, and `shear` and `slip` are lengths of vectors.
    pub fn records(&self, u: &[f64], history: &History) -> Vec<PointRecord> {
        let points = self.parts.surface.points.iter().enumerate();
        points.map(|(i, point)| self.record(point, history.slot(i), u)).collect()
    }

    fn record(&self, point: &SurfacePoint, values: &[f64], u: &[f64]) -> PointRecord {
        let (position, tangents) = self.locate(point, u);
        let Triad { inward, along, area } = Triad::new(tangents);
        let [s, t] = [values[entry::SHEAR], values[entry::SHEAR2]];
        let shear = s.hypot(t);
        let direction = if shear > 0.0 { (along[0] * s + along[1] * t) * shear.recip() } else { along[0] };
        let segment = (values[entry::SEGMENT] >= 0.0).then_some(values[entry::SEGMENT] as usize);
        PointRecord {
            position,
            inward,
            along: direction,
            area: point.weight * area,
            status: PointStatus::from_value(values[entry::STATUS]),
            pressure: values[entry::PRESSURE],
            shear,
            penetration: if segment.is_some() { values[entry::PENETRATION] } else { f64::NAN },
            slip: values[entry::SLIP].hypot(values[entry::SLIP2]),
            slipped: values[entry::SLIPPED],
            dissipated: values[entry::DISSIPATED],
            last_dissipated: values[entry::LAST_DISSIPATED],
            rubbed: values[entry::RUBBED],
            violation: values[entry::VIOLATION],
            segment,
            edge: point.face,
        }
    }

    /// What the search finds at displacements `u`, point by point, and how many false contacts it rejects.
    pub fn search(&self, u: &[f64]) -> (Vec<Option<Hit>>, Rejected) {
        let parts = &self.parts;
        let depths = depths(&parts.surface, &parts.mesh, &parts.dofs, &parts.boundary, u);
        let (pose, mut rejected, mut scratch) = (self.pose(u), Rejected::default(), Vec::new());
        let points = parts.surface.points.iter().zip(&depths);
        let hits =
            points.map(|(point, &depth)| self.cast(&pose, self.ray(point, u), depth, &mut scratch, &mut rejected));
        (hits.collect(), rejected)
    }

    /// The ray of a point, along its inward normal.
    pub(super) fn ray(&self, point: &SurfacePoint, u: &[f64]) -> Ray {
        let (origin, tangents) = self.locate(point, u);
        Ray { origin, direction: Triad::new(tangents).inward }
    }

    pub(super) fn cast(
        &self,
        pose: &Pose,
        ray: Ray,
        depth: f64,
        hits: &mut Vec<Hit>,
        rejected: &mut Rejected,
    ) -> Option<Hit> {
        // To the far side of the body: what lies beyond its middle is refused, and counted.
        self.tool().cast(pose, &ray, [f64::NEG_INFINITY, 2.0 * depth], hits);
        select(ray.direction, hits, &Rules::new(depth, self.tool().size()), rejected)
    }

    /// Words for a point.
    pub(super) fn describe(&self, point: usize) -> String {
        let nodes = self.parts.surface.nodes(&self.parts.surface.points[point]);
        format!("point {point} of contact '{}' (face with nodes {nodes:?})", self.parts.name)
    }
}

impl Term for Contact {
    fn name(&self) -> &str {
        &self.parts.name
    }

    fn initial(&self) -> History {
        let vars: usize = self.parts.law.variables().iter().map(|v| v.len()).sum();
        let mut history = History::new(self.parts.surface.points.iter().map(|_| entry::COUNT + vars));
        let u = vec![0.0; self.parts.dofs.count()];
        for (i, hit) in self.search(&u).0.into_iter().enumerate() {
            write_hit(hit, history.slot_mut(i));
            self.parts.law.initial(&mut history.slot_mut(i)[entry::COUNT..]);
        }
        history
    }

    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let parts = &self.parts;
        let depths = depths(&parts.surface, &parts.mesh, &parts.dofs, &parts.boundary, &accepted.u);
        Ok(Box::new(OpenContact {
            contact: self,
            history,
            depths,
            rotation: self.pose(&accepted.u).rotation,
            ordinary: parts.options.ordinary(history),
            dt: at.dt,
        }))
    }

    fn name_of(&self, stencil: usize) -> String {
        self.describe(stencil)
    }

    fn bends(&self) -> bool {
        true
    }

    fn branches(&self) -> &'static [&'static str] {
        &["open", "stick", "slip"]
    }
}
