//! A piece of a target that a Gauss point hits or touched, at given values of its own unknowns: those of a tool's reference point,
//! or the displacements of a face's nodes.

use crate::contact::field::FieldTarget;
use crate::contact::field::face::{PlacedFace, moved};
use crate::contact::field::faces::{self, FaceProjection, TargetFaces};
use crate::contact::field::tool::ToolInPlace;
use crate::mesh::Mesh;
use crate::system::Dofs;
use crate::tensor::{Scalar, Vec3};
use crate::tool::{Hit, ProfileRay};

/// A segment of a tool or a face of a body in its place.
pub struct SegmentInPlace<'a> {
    number: usize,
    of: SegmentOwner<'a>,
    /// Unknowns of a node, or translations of a tool.
    axes: usize,
    /// Number of its unknowns.
    count: usize,
}

/// Whose segment it is.
enum SegmentOwner<'a> {
    Tool(ToolInPlace<'a>),
    Body(&'a TargetFaces, PlacedFace),
}

impl FieldTarget {
    /// Whether it deforms.
    pub fn deforms(&self) -> bool {
        self.as_faces().is_some()
    }

    /// Diagonal of the box around it, a length.
    pub(super) fn size(&self) -> f64 {
        match self {
            Self::Tool(rigid) => rigid.size(),
            Self::Faces(faces) => faces.size(),
        }
    }

    /// The unknowns of a segment.
    pub(super) fn unknowns(&self, segment: usize, dofs: &Dofs) -> Vec<usize> {
        match self {
            Self::Tool(rigid) => rigid.unknowns().collect(),
            Self::Faces(faces) => dofs_of(&faces.surface.faces[segment].nodes, dofs).collect(),
        }
    }

    /// A segment for values `u` of its unknowns.
    pub(super) fn segment(&self, number: usize, (mesh, dofs): (&Mesh, &Dofs), u: &[f64]) -> SegmentInPlace<'_> {
        let of = match self {
            Self::Tool(rigid) => SegmentOwner::Tool(rigid.in_place(u)),
            Self::Faces(faces) => SegmentOwner::Body(faces, placed(&faces.surface.faces[number].nodes, mesh, u)),
        };
        SegmentInPlace { number, of, axes: dofs.per_node(), count: u.len() }
    }
}

/// How far from a ray a place on a face lies at most, as a part of the face: a projection that has not converged is none.
const ON_RAY: f64 = 1e-7;

/// Where a ray meets a face.
pub fn met(segment: usize, ray: &faces::FaceRay, at: FaceProjection) -> Option<Hit> {
    let off = (ray.x + ray.n * at.gap - at.y).norm();
    (off <= ON_RAY * at.tangents[0].norm()).then(|| Hit { segment, s: at.s, u: at.gap, normal: at.normal() })
}

/// The unknowns of nodes.
pub fn dofs_of<'a>(nodes: &'a [usize], dofs: &'a Dofs) -> impl Iterator<Item = usize> + 'a {
    nodes.iter().flat_map(|&node| dofs.displacements(node))
}

/// Nodes in place for values `u` of their unknowns.
pub fn placed(nodes: &[usize], mesh: &Mesh, u: &[f64]) -> PlacedFace {
    let axes = u.len() / nodes.len();
    PlacedFace::new(nodes.iter().zip(u.chunks_exact(axes)).map(|(&node, u)| moved(mesh.points[node], u)))
}

impl SegmentInPlace<'_> {
    /// Where a ray meets it or what continues it, near `near`; None if the ray runs along it.
    pub fn meet(&self, ray: &ProfileRay, near: [f64; 2]) -> Option<Hit> {
        match &self.of {
            SegmentOwner::Tool(tool) => tool.meet(self.number, ray, near),
            SegmentOwner::Body(faces, placed) => {
                let ray = faces::FaceRay { x: ray.origin, n: ray.direction };
                met(self.number, &ray, faces.project(self.number, placed, &ray)?)
            }
        }
    }

    /// The tool, if it is one's.
    pub fn tool(&self) -> Option<ToolInPlace<'_>> {
        if let SegmentOwner::Tool(tool) = &self.of { Some(*tool) } else { None }
    }

    /// Present place of the material point at `s`.
    pub fn point(&self, s: [f64; 2]) -> Vec3 {
        match &self.of {
            SegmentOwner::Tool(tool) => tool.point(self.number, s),
            SegmentOwner::Body(faces, placed) => faces.surface.faces[self.number].shape(s).value(placed.nodes()),
        }
    }

    /// Derivatives along its unknowns of the material point at `s`, which is now at `at`.
    pub fn rates(&self, s: [f64; 2], at: Vec3) -> Vec<Vec3> {
        match &self.of {
            SegmentOwner::Tool(tool) => tool.rates(at)[..self.count].to_vec(),
            SegmentOwner::Body(faces, _) => {
                let n = faces.surface.faces[self.number].shape(s).n;
                (0..self.count).map(|k| Vec3::axis(k % self.axes) * n[k / self.axes]).collect()
            }
        }
    }

    /// What `force` at the place `at` does to its unknowns: its work along their rates. `b` is the material point that is hit there;
    /// their derivatives differ by the sliding of the one over the other.
    pub fn receive<T: Scalar>(&self, hit: &Hit, (at, b): (Vec3<T>, Vec3<T>), force: Vec3<T>) -> Vec<T> {
        match &self.of {
            SegmentOwner::Tool(tool) => {
                let moment = (at - tool.reference().lift()).cross(force);
                let turned = tool.spins().map(|spin| spin.lift().dot(moment));
                (0..self.count).map(|k| if k < self.axes { force[k] } else { turned[k] }).collect()
            }
            SegmentOwner::Body(faces, placed) => {
                let face = &faces.surface.faces[self.number];
                let shape = face.shape(hit.s);
                let [a, c] = shape.tangents(placed.nodes(), faces.surface.plane);
                let normal = a.cross(c);
                let size = 1.0 / normal.dot(normal);
                let ds = [c.cross(normal), normal.cross(a)].map(|along| (at - b).dot((along * size).lift()));
                let share = |k: usize| {
                    let [s, t] = shape.dn[k];
                    (ds[0] * s + ds[1] * t).chain(shape.n[k], 1.0)
                };
                (0..self.count).map(|k| force[k % self.axes] * share(k / self.axes)).collect()
            }
        }
    }

    /// What the motion of a tool adds to the derivatives of that besides those of place and force: the arm shortens as the reference
    /// point moves, and a turning tool has other axes. Calls `add` with row, column and value.
    pub fn stiffen(&self, (at, force): (Vec3, Vec3), add: &mut dyn FnMut(usize, usize, f64)) {
        let SegmentOwner::Tool(tool) = &self.of else { return };
        let (spins, arm) = (tool.spins(), at - tool.reference());
        for column in 0..self.count {
            let turning = tool.spin_rates(column);
            for row in self.axes..self.count {
                let shorter = if column < self.axes { spins[row].cross(-Vec3::axis(column)) } else { Vec3::zero() };
                add(row, column, (shorter + turning[row].cross(arm)).dot(force));
            }
        }
    }
}
