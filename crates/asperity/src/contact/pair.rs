//! A surface and its target as a term of equilibrium: one stencil a contact point.

use super::augment::Corners;
use super::averaged::Around;
use super::capture::depths;
use super::faces::Faces;
use super::guard;
use super::nonlocal::{Neighbours, radius};
use super::open::{OpenContact, write_hit};
use super::options::{ContactOptions, Loads, Normals};
use super::point::triad;
use super::record::{PointRecord, PointStatus, entry, largest_penetration, variables};
use super::search::relatives;
use super::surface::{Edge, Surface, SurfacePoint};
use super::target::Target;
use crate::interface::{Interface, Rule};
use crate::mesh::{Mesh, Side, Space};
use crate::system::{Attempt, Dofs, History, Instant, State, Term};
use crate::tensor::Vec3;
use crate::tool::Ray;
use crate::{Error, Failure};
use std::sync::Arc;

/// A point counts as closed from this part of the shortest edge on. One depth for all points: a flat surface
/// under uniform pressure then stays flat.
pub(super) const CLOSED: f64 = 1e-10;

/// Contact between a surface and a target.
pub struct Contact {
    name: String,
    pub(super) mesh: Arc<Mesh>,
    pub(super) dofs: Dofs,
    pub(super) space: Space,
    pub(super) surface: Surface,
    pub(super) boundary: Vec<Side>,
    /// The connected whole of each cell.
    pub(super) wholes: Vec<usize>,
    pub(super) target: Target,
    pub(super) law: Rule,
    pub(super) options: ContactOptions,
    /// Penetration from which a point counts as closed.
    pub(super) least: f64,
    /// For each edge the segments of the target that share a node with it.
    pub(super) relatives: Vec<Vec<usize>>,
    /// The longest edge of both sides, a length.
    pub(super) longest: f64,
    /// The corners that carry multipliers; none without augmentation.
    pub(super) corners: Corners,
    /// Those of a target that deforms.
    pub(super) opposite: Corners,
    /// The points around each point, where the law is not local.
    pub(super) neighbours: Neighbours,
    /// For each edge the nodes around it that turn its normals; none where each edge has its own.
    pub(super) around: Vec<Around>,
}

impl Contact {
    /// A contact of `surface` with `target`. `boundary` is the whole outer boundary of the bodies behind the surface.
    pub fn new(
        name: &str,
        (mesh, dofs, space): (Arc<Mesh>, Dofs, Space),
        (surface, boundary): (Surface, Vec<Side>),
        target: Target,
        (law, options): (Rule, ContactOptions),
    ) -> Self {
        let faces = target.as_faces().map_or(&[][..], Faces::edges);
        let relatives = relatives(surface.edges.iter().map(|edge| &edge.nodes), faces.iter().map(|edge| &edge.nodes));
        let (name, least, longest) = (name.into(), 0.0, 0.0);
        let (corners, opposite, neighbours) = (Corners::default(), Corners::default(), Neighbours::default());
        let around = match options.normals {
            Normals::Own => Vec::new(),
            Normals::Averaged => Around::of(&mesh, &surface.edges, space == Space::Axisymmetric),
        };
        let wholes = mesh.wholes();
        let mut contact = Self {
            name,
            wholes,
            mesh,
            dofs,
            space,
            surface,
            boundary,
            target,
            law,
            options,
            least,
            relatives,
            longest,
            corners,
            opposite,
            neighbours,
            around,
        };
        let lengths = |edges: &[Edge]| edges.iter().map(|edge| edge.chord(&contact.mesh)).collect::<Vec<_>>();
        let opposite = contact.target.as_faces().map_or(Vec::new(), |faces| lengths(faces.edges()));
        contact.longest = lengths(&contact.surface.edges).into_iter().chain(opposite.clone()).fold(0.0, f64::max);
        // Common to both sides: else one would be pressed a little harder than the other.
        let shortest = opposite.iter().copied().fold(f64::INFINITY, f64::min);
        let shortest = match contact.target.deforms() {
            true => lengths(&contact.surface.edges).into_iter().fold(shortest, f64::min),
            false => (0..contact.surface.points.len()).map(|i| contact.edge_length(i)).fold(f64::INFINITY, f64::min),
        };
        contact.least = CLOSED * shortest;
        if options.augmentation.is_some() {
            contact.corners = contact.corners_of_edges();
            contact.opposite = contact.corners_of_target();
        }
        if let Some(radius) = radius(contact.law.first()) {
            let (places, edge) = (contact.undeformed_places(), |i: usize| contact.surface.points[i].edge);
            contact.neighbours = Neighbours::new(&places, edge, radius, |i| contact.undeformed_area(i));
        }
        contact
    }

    /// The user's name for it.
    pub fn title(&self) -> &str {
        &self.name
    }
    /// The surface.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }
    /// The target.
    pub fn target(&self) -> &Target {
        &self.target
    }
    /// Whether its points load their own side alone: one of two passes.
    pub fn loads_itself(&self) -> bool {
        self.options.loads == Loads::Own
    }
    /// The law of the interface.
    pub fn law(&self) -> &dyn Interface {
        self.law.first()
    }
    /// The largest penetration at a closed point, from the history of a state; a length.
    pub fn largest_penetration(&self, history: &History) -> f64 {
        largest_penetration(history, self.surface.points.len())
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        &self.options
    }

    /// Where moments are taken about: the present place of a tool's reference point, or the origin.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.target.as_tool().map_or(Vec3::zero(), |rigid| rigid.pole(u))
    }

    /// The largest admissible penetration at each point.
    pub(super) fn depths(&self, u: &[f64]) -> Vec<f64> {
        depths(&self.surface, (&self.mesh, &self.wholes), &self.dofs, &self.boundary, u)
    }

    /// Position and tangent of a point.
    pub(super) fn locate(&self, point: &SurfacePoint, u: &[f64]) -> (Vec3, Vec3) {
        self.placed(point.edge, u).stand(point)
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

    /// Places of all points before any motion.
    fn undeformed_places(&self) -> Vec<Vec3> {
        let still = vec![0.0; self.dofs.count()];
        self.surface.points.iter().map(|point| self.locate(point, &still).0).collect()
    }

    pub(super) fn thickness(&self) -> f64 {
        match self.space {
            Space::PlaneStrain | Space::PlaneStress => self.options.thickness,
            Space::Axisymmetric | Space::Solid => 1.0,
        }
    }

    /// All points in an accepted state, with this term's lane of its history.
    pub fn records<'a>(&'a self, u: &'a [f64], history: &'a History) -> impl Iterator<Item = PointRecord> + 'a {
        (0..self.surface.points.len()).map(move |i| {
            let values = history.slot(i);
            let point = &self.spot(i, values);
            let (a, tangent) = self.locate(point, u);
            let (along, inward, _) = triad(tangent);
            let segment = (values[entry::SEGMENT] >= 0.0).then_some(values[entry::SEGMENT] as usize);
            PointRecord {
                position: a,
                inward,
                along,
                facing: self.facing(values, u, &Ray { origin: a, direction: inward }),
                thrust: self.thrust(values, u, Ray { origin: a, direction: inward }),
                area: self.acting_area(i, point, (a, tangent)),
                resultant: None,
                status: PointStatus::from_value(values[entry::STATUS]),
                pressure: values[entry::PRESSURE],
                shear: values[entry::SHEAR],
                penetration: if segment.is_some() { values[entry::PENETRATION] } else { f64::NAN },
                slip: values[entry::SLIP],
                slipped: values[entry::SLIPPED],
                dissipated: values[entry::DISSIPATED],
                last_dissipated: values[entry::LAST_DISSIPATED],
                rubbed: values[entry::RUBBED],
                violation: values[entry::VIOLATION],
                vars: variables(values),
                segment,
                edge: point.edge,
            }
        })
    }

    /// Outward normal of the target where the ray of a closed point meets it; the direction of the ray elsewhere.
    fn facing(&self, values: &[f64], u: &[f64], ray: &Ray) -> Vec3 {
        let closed = PointStatus::from_value(values[entry::STATUS]) != PointStatus::Open;
        let segment = Some(values[entry::SEGMENT]).filter(|segment| closed && *segment >= 0.0);
        let meet = |segment: usize| {
            let mut dofs = Vec::new();
            self.target.unknowns(segment, &mut dofs);
            let own: Vec<f64> = dofs.iter().map(|&dof| u[dof]).collect();
            self.target.meet(segment, &own, ray, [values[entry::S], values[entry::S2]])
        };
        segment.and_then(|segment| meet(segment as usize)).map_or(ray.direction, |hit| hit.normal)
    }

    /// Where a point stands on its edge in an accepted state.
    pub(super) fn spot(&self, index: usize, values: &[f64]) -> SurfacePoint {
        self.surface.moved(index, [values[entry::XI], values[entry::HALF]])
    }

    /// Words for a point.
    pub(super) fn describe(&self, point: usize) -> String {
        let nodes = self.surface.nodes(&self.surface.points[point]);
        format!("point {point} of contact '{}' (edge with nodes {nodes:?})", self.name)
    }
}

/// Unknowns that the last increment, carried on over `dt`, leads to.
pub(super) fn ahead(accepted: &State, dt: f64) -> Vec<f64> {
    let part = if accepted.last_dt > 0.0 { dt / accepted.last_dt } else { 0.0 };
    accepted.u.iter().zip(&accepted.last_change).map(|(u, change)| u + part * change).collect()
}

impl Term for Contact {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial(&self) -> History {
        let vars: usize = self.law.first().variables().iter().map(|v| v.len()).sum();
        let points = self.surface.points.iter().map(|_| entry::COUNT + vars);
        let mut history = History::new(points.chain(self.options.augmentation.map(|_| self.corners.count())));
        let u = vec![0.0; self.dofs.count()];
        for (i, hit) in self.search_within(&u, self.reach(&u)).0.into_iter().enumerate() {
            write_hit(&self.surface.points[i], hit, history.slot_mut(i));
            self.options.overlap.begin(history.slot_mut(i), self.least);
            self.law.first().initial(&mut history.slot_mut(i)[entry::COUNT..]);
        }
        history
    }

    fn attempt<'a>(
        &'a self,
        accepted: &'a State,
        history: &'a History,
        at: Instant,
    ) -> Result<Box<dyn Attempt + 'a>, Failure> {
        let depths = self.depths(&accepted.u);
        let reach = self.reach(&accepted.last_change);
        let standing = self.target.deforms().then(|| self.target.stand(&accepted.u));
        Ok(Box::new(OpenContact {
            contact: self,
            law: self.law.at(at.step, at.step_time)?,
            history,
            accepted: &accepted.u,
            standing,
            depths,
            reach,
            ahead: ahead(accepted, at.dt),
            shifts: self.begun(&accepted.u, history),
            augmented: 0,
            settled: self.options.overlap.settled(at),
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
