//! Both sides of a contact of either form: what it is made of, and what follows from that before any motion.

use super::ContactOptions;
use super::field::faces::TargetFaces;
use super::field::{FieldSurface, FieldTarget};
use super::increment::{CLOSED, reach};
use crate::interface::{Interface, Rule};
use crate::mesh::{Mesh, Side, Space};
use crate::system::Dofs;
use crate::tensor::Vec3;
use std::sync::Arc;

/// A pressure, and the undeformed areas over which the node or point that bears it stands around corners of sides of both bodies.
pub type Borne = (f64, Vec<(Side, usize, f64)>);

/// What a contact is made of.
pub struct ContactParts {
    /// The user's name for it.
    pub name: String,
    /// The mesh.
    pub mesh: Arc<Mesh>,
    /// The numbering of the unknowns.
    pub dofs: Dofs,
    /// What the coordinates mean.
    pub space: Space,
    /// The faces that carry contact stress.
    pub surface: FieldSurface,
    /// The whole outer boundary of the bodies behind the surface.
    pub boundary: Vec<Side>,
    /// What they may touch.
    pub target: FieldTarget,
    /// The law of the interface.
    pub law: Rule,
    /// How it is computed.
    pub options: ContactOptions,
}

/// Both sides of a contact.
pub struct ContactSides {
    pub(super) parts: ContactParts,
    pub(super) boundary: TargetFaces,
    /// Penetration from which a point counts as closed.
    pub(super) least: f64,
    /// The longest edge of both sides, a length.
    pub(super) longest: f64,
}

impl ContactSides {
    /// Of these parts.
    pub(super) fn new(parts: ContactParts) -> Self {
        let ContactParts { mesh, surface, .. } = &parts;
        let boundary = TargetFaces::new(FieldSurface::whole(mesh, &parts.boundary, parts.space, 1.0), mesh);
        let [mut shortest, mut longest] = surface.sizes(mesh);
        // Common to both sides: else one would be pressed a little harder than the other.
        if let Some(faces) = parts.target.as_faces() {
            let [least, most] = faces.surface.sizes(mesh);
            (shortest, longest) = (shortest.min(least), longest.max(most));
        }
        Self { parts, boundary, least: CLOSED * shortest, longest }
    }

    /// The user's name for it.
    pub fn title(&self) -> &str {
        &self.parts.name
    }
    /// The surface.
    pub fn surface(&self) -> &FieldSurface {
        &self.parts.surface
    }
    /// What it may touch.
    pub fn target(&self) -> &FieldTarget {
        &self.parts.target
    }
    /// The law of the interface.
    pub fn law(&self) -> &dyn Interface {
        self.parts.law.first()
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        &self.parts.options
    }
    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.parts.mesh
    }
    /// Where moments are taken about: the present place of a tool's reference point, or the origin.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        let origin = Vec3::zero() - self.parts.mesh.origin;
        self.parts.target.as_tool().map_or(origin, |rigid| rigid.at(u).reference())
    }

    /// Mesh and numbering.
    pub(super) fn site(&self) -> (&Mesh, &Dofs) {
        (&self.parts.mesh, &self.parts.dofs)
    }
    /// The largest gap at which the target is seen in the increment after `last_change`: a tool at any distance.
    pub(super) fn reach(&self, last_change: &[f64]) -> f64 {
        if self.parts.target.deforms() { reach(self.longest, last_change) } else { f64::INFINITY }
    }
}
