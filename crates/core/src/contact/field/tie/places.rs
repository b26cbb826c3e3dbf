//! Where faces of the surface have the target opposite: points of a quadrature on the overlap of both meshes.

use crate::contact::field::cover::{FaceInPlace, between_vertices};
use crate::contact::field::face::{CORNERS, FieldFace, PlacedFace, ShapeFunctions};
use crate::contact::field::faces::{FaceProjection, FaceRay, FacesInPlace, LEAST_COSINE, TargetFaces};
use crate::contact::field::space::FacePart;
use crate::contact::field::surface::FieldSurface;
use crate::mesh::Mesh;
use crate::system::Dofs;
use crate::tensor::{Vec3, legendre};
use crate::tool::BoundingBox;

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

/// A part of a face that sees a face of the target.
enum TiePart {
    Interval([f64; 2]),
    Polygon(Box<FacePart>),
}

/// Finds places.
pub struct TiePlaces<'a> {
    surface: &'a FieldSurface,
    faces: &'a TargetFaces,
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
        Self { surface, faces, target, placed, normals, tolerance, rule: legendre(POINTS) }
    }

    fn face(&self, number: usize) -> FaceInPlace<'_> {
        let mut normals = [Vec3::zero(); CORNERS];
        for (normal, node) in normals.iter_mut().zip(self.surface.field[number]) {
            *normal = self.normals.get(node).copied().unwrap_or(Vec3::zero());
        }
        let (face, placed) = (&self.surface.faces[number], self.placed[number]);
        FaceInPlace { face, placed, normals, plane: self.surface.plane }
    }

    /// What a face has opposite.
    pub fn of(&self, number: usize) -> TieCover {
        let (face, mut near, mut seen) = (self.face(number), Vec::new(), Vec::new());
        let around = BoundingBox::of(face.placed.nodes().iter().copied());
        self.target.near(&around, LOOKED * self.tolerance, &mut near);
        for &target in &near {
            let part = self.part(&face, target);
            let middle = |part: TiePart| {
                let xi = part.middle();
                let hit = self.project(&face, xi, target)?;
                let looks = -hit.normal().dot(face.own_normal(xi)) > LEAST_COSINE;
                (looks && hit.gap.abs() <= LOOKED * self.tolerance).then_some((target, part, hit.gap))
            };
            seen.extend(part.and_then(middle));
        }
        let mut cover = TieCover::default();
        for (i, (target, part, gap)) in seen.iter().enumerate() {
            let nearer = |(j, (_, other, there)): (usize, &(usize, TiePart, f64))| {
                (there.abs(), j) < (gap.abs(), i) && other.covers(part)
            };
            if seen.iter().enumerate().any(nearer) {
                continue;
            }
            if gap.abs() > self.tolerance {
                cover.beyond.push((gap.abs(), face.at(part.middle()).x));
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

    /// The part of a face that sees one of the target.
    fn part(&self, face: &FaceInPlace, target: usize) -> Option<TiePart> {
        let other = self.target.placed(target).nodes();
        if self.surface.plane {
            return between_vertices(face, [other[1], other[0]]).map(|(interval, _)| TiePart::Interval(interval));
        }
        let own = &face.placed.nodes()[..face.face.corners()];
        FacePart::new(own, &other[..self.target.corners(target)]).map(|part| TiePart::Polygon(Box::new(part)))
    }

    fn project(&self, face: &FaceInPlace, xi: [f64; 2], target: usize) -> Option<FaceProjection> {
        let at = face.at(xi);
        self.faces.project(target, self.target.placed(target), &FaceRay { x: at.x, n: at.normal.unit() })
    }
}

impl TiePart {
    fn middle(&self) -> [f64; 2] {
        match self {
            Self::Interval([from, to]) => [0.5 * (from + to), 0.0],
            Self::Polygon(part) => part.places().last().copied().unwrap_or([0.0; 2]),
        }
    }

    fn covers(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Interval(a), Self::Interval(b)) => a[1].min(b[1]) - a[0].max(b[0]) > 1e-6,
            (Self::Polygon(a), Self::Polygon(b)) => a.covers(b),
            _ => false,
        }
    }

    /// Places and areas in reference coordinates, by a rule of the interval from -1 to 1.
    fn rule(&self, rule: &[(f64, f64)]) -> Vec<([f64; 2], f64)> {
        match self {
            Self::Interval([from, to]) => {
                let half = 0.5 * (to - from);
                rule.iter().map(|(x, weight)| ([0.5 * (from + to) + half * x, 0.0], half * weight)).collect()
            }
            Self::Polygon(part) => part.spread(rule).map(|place| (place.xi, place.weight)).collect(),
        }
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
