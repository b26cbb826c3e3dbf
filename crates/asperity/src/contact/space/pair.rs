//! A surface and its target in space as a term of equilibrium: one stencil a contact point.

use super::averaged::Around;
use super::capture::{Boundary, depths};
use super::open::{OpenContact, write_hit};
use super::point::Triad;
use super::surface::{Face, Surface, SurfacePoint};
use super::target::Target;
use crate::contact::augment::Corners;
use crate::contact::guard;
use crate::contact::nonlocal::{Neighbours, radius};
use crate::contact::pair::{CLOSED, ahead};
use crate::contact::record::{PointRecord, PointStatus, entry, largest_penetration, variables};
use crate::contact::search::relatives;
use crate::contact::{ContactOptions, Loads, Normals};
use crate::interface::{Interface, Rule};
use crate::mesh::{CellView, Mesh, Side};
use crate::system::{Attempt, Dofs, History, Instant, State, Term};
use crate::tensor::Vec3;
use crate::tool::Ray;
use crate::{Error, Failure};
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
    /// What they may touch.
    pub target: Target,
    /// The law of the interface.
    pub law: Rule,
    /// How it is computed.
    pub options: ContactOptions,
}

/// Contact in space between a surface and a target.
pub struct Contact {
    pub(super) parts: Parts,
    /// What bounds the bodies behind the surface.
    behind: Boundary,
    /// Penetration from which a point counts as closed.
    pub(in crate::contact) least: f64,
    /// For each face the segments of the target that share a node with it.
    pub(super) relatives: Vec<Vec<usize>>,
    /// Size of the largest face of both sides, a length.
    pub(super) longest: f64,
    /// The corners that carry multipliers; none without augmentation.
    pub(super) corners: Corners,
    /// Those of a target that deforms.
    pub(super) opposite: Corners,
    /// The points around each point, where the law is not local.
    pub(super) neighbours: Neighbours,
    /// For each face the nodes around it that turn its normals; none where each face has its own.
    pub(super) around: Vec<Around>,
}

impl Parts {
    /// Size of an undeformed face, a length: the root of its area.
    pub(super) fn length(&self, face: &Face) -> f64 {
        let Face { kind, nodes, .. } = face;
        CellView { kind, nodes }.extent(&self.mesh.points).sqrt()
    }
}

impl Contact {
    /// A contact of these parts.
    pub fn new(parts: Parts) -> Self {
        let opposite = parts.target.as_faces().map_or(&[][..], |faces| faces.list());
        let own = parts.surface.faces.iter();
        let relatives = relatives(own.map(|face| &face.nodes), opposite.iter().map(|face| &face.nodes));
        let sizes = parts.surface.faces.iter().chain(opposite).map(|face| face.size(&parts.mesh));
        let longest = sizes.fold(0.0, f64::max);
        // Common to both sides: else one would be pressed a little harder than the other.
        let lengths = parts.surface.faces.iter().chain(opposite).map(|face| parts.length(face));
        let least = CLOSED * lengths.fold(f64::INFINITY, f64::min);
        let (corners, opposite, neighbours) = (Corners::default(), Corners::default(), Neighbours::default());
        let around = match parts.options.normals {
            Normals::Own => Vec::new(),
            Normals::Averaged => Around::of(&parts.mesh, &parts.surface.faces),
        };
        let behind = Boundary::new(&parts.mesh, &parts.boundary);
        let mut contact = Self { parts, behind, least, relatives, longest, corners, opposite, neighbours, around };
        if contact.parts.options.augmentation.is_some() {
            contact.corners = contact.corners_of_faces();
            contact.opposite = contact.corners_of_target();
        }
        if let Some(radius) = radius(contact.parts.law.first()) {
            let places: Vec<Vec3> = contact.rays().iter().map(|ray| ray.origin).collect();
            let face = |i: usize| contact.parts.surface.points[i].face;
            contact.neighbours = Neighbours::new(&places, face, radius, |i| contact.undeformed_area(i));
        }
        contact
    }

    /// The user's name for it.
    pub fn title(&self) -> &str {
        &self.parts.name
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
    pub fn target(&self) -> &Target {
        &self.parts.target
    }
    /// Whether its points load their own side alone: one of two passes.
    pub fn loads_itself(&self) -> bool {
        self.parts.options.loads == Loads::Own
    }
    /// The law of the interface.
    pub fn law(&self) -> &dyn Interface {
        self.parts.law.first()
    }
    /// The largest penetration at a closed point, from the history of a state; a length.
    pub fn largest_penetration(&self, history: &History) -> f64 {
        largest_penetration(history, self.parts.surface.points.len())
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        &self.parts.options
    }

    /// Where moments are taken about: the present place of a tool's reference point, or the origin.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.parts.target.as_tool().map_or(Vec3::zero(), |rigid| rigid.pole(u))
    }

    /// The largest admissible penetration at each point.
    pub(super) fn depths(&self, u: &[f64]) -> Vec<f64> {
        let parts = &self.parts;
        depths(&parts.surface, &parts.mesh, &parts.dofs, &self.behind, u)
    }

    /// Position and tangents of a point.
    pub(super) fn locate(&self, point: &SurfacePoint, u: &[f64]) -> (Vec3, [Vec3; 2]) {
        self.placed(point.face, u).stand(point)
    }

    /// Size of the undeformed face of a point, a length.
    pub fn face_length(&self, point: usize) -> f64 {
        self.parts.length(&self.parts.surface.faces[self.parts.surface.points[point].face])
    }

    /// All points in an accepted state, with this term's lane of its history. Their `along` is the direction of the
    /// shear stress, and `shear` and `slip` are lengths of vectors.
    pub fn records(&self, u: &[f64], history: &History) -> Vec<PointRecord> {
        let record = |i: usize| {
            let values = history.slot(i);
            self.record((i, &self.spot(i, values)), values, u)
        };
        (0..self.parts.surface.points.len()).map(record).collect()
    }

    fn record(&self, (index, point): (usize, &SurfacePoint), values: &[f64], u: &[f64]) -> PointRecord {
        let (position, tangents) = self.locate(point, u);
        let Triad { inward, along, .. } = Triad::new(tangents);
        let [s, t] = [values[entry::SHEAR], values[entry::SHEAR2]];
        let shear = s.hypot(t);
        let direction = if shear > 0.0 { (along[0] * s + along[1] * t) * shear.recip() } else { along[0] };
        let segment = (values[entry::SEGMENT] >= 0.0).then_some(values[entry::SEGMENT] as usize);
        PointRecord {
            position,
            inward,
            facing: self.facing(values, u, &Ray { origin: position, direction: inward }),
            thrust: self.thrust(values, u, Ray { origin: position, direction: inward }),
            along: direction,
            area: self.acting_area(index, point, tangents),
            resultant: None,
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
            vars: variables(values),
            segment,
            edge: point.face,
        }
    }

    /// Outward normal of the target where the ray of a closed point meets it; the direction of the ray elsewhere.
    fn facing(&self, values: &[f64], u: &[f64], ray: &Ray) -> Vec3 {
        let closed = PointStatus::from_value(values[entry::STATUS]) != PointStatus::Open;
        let segment = Some(values[entry::SEGMENT]).filter(|segment| closed && *segment >= 0.0);
        let meet = |segment: usize| {
            let mut dofs = Vec::new();
            self.parts.target.unknowns(segment, &mut dofs);
            let own: Vec<f64> = dofs.iter().map(|&dof| u[dof]).collect();
            self.parts.target.meet(segment, &own, ray, [values[entry::S], values[entry::S2]])
        };
        segment.and_then(|segment| meet(segment as usize)).map_or(ray.direction, |hit| hit.normal)
    }

    /// Where a point stands on its face in an accepted state.
    pub(super) fn spot(&self, index: usize, values: &[f64]) -> SurfacePoint {
        self.parts.surface.moved(index, [values[entry::XI], values[entry::XI2]], values[entry::HALF])
    }

    /// The ray of a point, along its inward normal.
    pub(super) fn ray(&self, point: &SurfacePoint, u: &[f64]) -> Ray {
        let (origin, tangents) = self.locate(point, u);
        Ray { origin, direction: Triad::new(tangents).inward }
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
        let vars: usize = self.parts.law.first().variables().iter().map(|v| v.len()).sum();
        let points = self.parts.surface.points.iter().map(|_| entry::COUNT + vars);
        let corners = self.parts.options.augmentation.map(|_| self.corners.count());
        let mut history = History::new(points.chain(corners));
        let u = vec![0.0; self.parts.dofs.count()];
        for (i, hit) in self.search_within(&u, self.reach(&u)).0.into_iter().enumerate() {
            write_hit(&self.parts.surface.points[i], hit, history.slot_mut(i));
            self.parts.options.overlap.begin(history.slot_mut(i), self.least);
            self.parts.law.first().initial(&mut history.slot_mut(i)[entry::COUNT..]);
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
        Ok(Box::new(OpenContact {
            contact: self,
            law: parts.law.at(at.step, at.step_time)?,
            history,
            accepted: &accepted.u,
            standing: parts.target.deforms().then(|| parts.target.stand(&accepted.u)),
            depths: self.depths(&accepted.u),
            rotation: parts.target.as_tool().map_or(Vec3::zero(), |rigid| rigid.pose(&accepted.u).rotation),
            reach: self.reach(&accepted.last_change),
            ahead: ahead(accepted, at.dt),
            shifts: self.begun(&accepted.u, history),
            frames: self.frames(&accepted.u),
            augmented: 0,
            settled: parts.options.overlap.settled(at),
            dt: at.dt,
        }))
    }

    fn name_of(&self, stencil: usize) -> String {
        self.describe(stencil)
    }

    fn verdict(&self, state: &State, history: &History) -> Result<(), Error> {
        guard::verdict(self.facets(&state.u, history))
    }

    fn bends(&self) -> bool {
        true
    }

    fn branches(&self) -> &'static [&'static str] {
        &["open", "stick", "slip"]
    }
}
