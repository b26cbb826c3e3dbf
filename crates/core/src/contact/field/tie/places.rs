//! Where faces of the surface have the target opposite: points of a quadrature on the overlap of both meshes.

use crate::contact::field::cover::FaceInPlace;
use crate::contact::field::face::{FieldFace, PlacedFace, ShapeFunctions};
use crate::contact::field::faces::{FaceProjection, FaceRay, FacesInPlace, LEAST_COSINE, TargetFaces};
use crate::contact::field::part::{FacePart, nearest};
use crate::contact::field::surface::FieldSurface;
use crate::mesh::Mesh;
use crate::system::Dofs;
use crate::tensor::{BoundingBox, Vec3, legendre};

/// Points of a rule along each direction of a part of a face: all products of shape functions of faces with straight sides are
/// integrated exactly, others to rounding.
const POINTS: usize = 8;
/// Faces are looked for up to so many tolerances away, to tell those that lie too far off.
const LOOKED: f64 = 4.0;

/// A point of a quadrature.
#[derive(Debug, Clone, Copy)]
pub struct TiePlace {
    /// Undeformed area that it stands for, the circumference included.
    pub area: f64,
    /// Shape functions of the face of the surface.
    pub shape: ShapeFunctions,
    /// The face of the target opposite,
    pub target: usize,
    /// its shape functions there,
    pub seen: ShapeFunctions,
    /// and how far away it is.
    pub gap: f64,
}

/// What a face has opposite.
#[derive(Debug, Default)]
pub struct TieCover {
    /// Points within the tolerance.
    pub places: Vec<TiePlace>,
    /// Distance and place of the parts that lie beyond it.
    pub beyond: Vec<(f64, Vec3)>,
}

/// Finds places.
pub struct TiePlaces<'a> {
    surface: &'a FieldSurface,
    target: FacesInPlace<'a>,
    placed: Vec<PlacedFace>,
    normals: Vec<Vec3>,
    tolerance: f64,
    rule: Vec<(f64, f64)>,
}

impl<'a> TiePlaces<'a> {
    /// Before any motion.
    pub fn new(mesh: &'a Mesh, surface: &'a FieldSurface, faces: &'a TargetFaces, tolerance: f64) -> Self {
        let dofs = Dofs::new(if surface.plane { 2 } else { 3 }, mesh.points.len(), 0);
        let target = faces.in_place((mesh, &dofs), &vec![0.0; dofs.count()]);
        let placed: Vec<PlacedFace> = surface.faces.iter().map(|face| face.at_rest(mesh)).collect();
        let normals = (0..surface.nodes.len()).map(|node| surface.normal(node, |f| placed[f]).unit).collect();
        Self { surface, target, placed, normals, tolerance, rule: legendre(POINTS) }
    }

    /// What a face has opposite.
    pub fn of(&self, number: usize) -> TieCover {
        let face = FaceInPlace::of(self.surface, number, self.placed[number], &self.normals);
        let (mut near, mut seen) = (Vec::new(), Vec::new());
        let around = BoundingBox::of(face.placed.nodes().iter().copied());
        self.target.near(&around, LOOKED * self.tolerance, &mut near);
        for &target in &near {
            let part = FacePart::new(&face, self.target.corners(target));
            let middle = |part: FacePart| {
                let xi = *part.places().last()?;
                let hit = self.project(&face, xi, target)?;
                let looks = -hit.normal().dot(face.own_normal(xi)) > LEAST_COSINE;
                (looks && hit.gap.abs() <= LOOKED * self.tolerance).then_some(((target, xi), part, hit.gap))
            };
            seen.extend(part.and_then(middle));
        }
        let mut cover = TieCover::default();
        for ((target, middle), part, gap) in nearest(&seen) {
            if gap.abs() > self.tolerance {
                cover.beyond.push((gap.abs(), face.at(*middle).x));
                continue;
            }
            for (xi, weight) in part.rule(&self.rule) {
                let Some(hit) = self.project(&face, xi, *target) else { continue };
                let area = weight * self.surface.density_at(face.face, &face.placed, xi);
                let shape = face.face.shape(xi);
                cover.places.push(TiePlace { area, shape, target: *target, seen: hit.shape, gap: hit.gap });
            }
        }
        cover
    }

    fn project(&self, face: &FaceInPlace, xi: [f64; 2], target: usize) -> Option<FaceProjection> {
        let at = face.at(xi);
        self.target.project(target, &FaceRay { x: at.x, n: at.normal.unit() })
    }
}

/// Areas and shape functions all over a face.
pub fn everywhere(mesh: &Mesh, surface: &FieldSurface, face: &FieldFace) -> Vec<(f64, ShapeFunctions)> {
    let rest = face.at_rest(mesh);
    let rule = face.kind.gauss[2].into_iter().flat_map(|rule| rule.points.iter().zip(rule.weights));
    let place = |(&[a, b, _], weight): (&[f64; 3], &f64)| {
        (weight * surface.density_at(face, &rest, [a, b]), face.shape([a, b]))
    };
    rule.map(place).collect()
}
