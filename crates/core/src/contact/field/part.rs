//! The part of a face that sees a face of a body: an interval of an edge in the plane, a polygon on a face in space.

use super::cover::{FaceInPlace, between_vertices};
use super::space::PolygonPart;
use crate::tensor::Vec3;

/// The part of a face that sees a face of a body.
pub enum FacePart {
    /// Of an edge, and the vertices of the other that bound it.
    Interval([f64; 2], [Option<usize>; 2]),
    /// Of a face in space.
    Polygon(Box<PolygonPart>),
}

impl FacePart {
    /// Of a face where it sees another one, given by its corners.
    pub fn new(face: &FaceInPlace, other: &[Vec3]) -> Option<Self> {
        if face.plane {
            let (interval, bounded) = between_vertices(face, [other[1], other[0]])?;
            return Some(Self::Interval(interval, [bounded[0].then_some(1), bounded[1].then_some(0)]));
        }
        PolygonPart::new(face.corners(), other).map(|part| Self::Polygon(Box::new(part)))
    }

    /// Its vertices and then its middle, in reference coordinates.
    pub fn places(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Interval(interval, _) => samples(*interval).to_vec(),
            Self::Polygon(part) => part.places().to_vec(),
        }
    }

    /// Whether it covers more than half of another of the same face: a sliver, as where the faces of two blocks meet, hides no face.
    pub fn covers(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Interval(a, _), Self::Interval(b, _)) => a[1].min(b[1]) - a[0].max(b[0]) > 0.5 * (b[1] - b[0]),
            (Self::Polygon(a), Self::Polygon(b)) => a.covers(b),
            _ => false,
        }
    }

    /// Area in reference coordinates.
    pub fn area(&self) -> f64 {
        const TWO: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];
        self.rule(&TWO).iter().map(|(_, area)| area).sum()
    }

    /// Places and areas in reference coordinates, by a rule of the interval from -1 to 1.
    pub fn rule(&self, rule: &[(f64, f64)]) -> Vec<([f64; 2], f64)> {
        match self {
            Self::Interval([from, to], _) => {
                let half = 0.5 * (to - from);
                rule.iter().map(|(x, weight)| ([0.5 * (from + to) + half * x, 0.0], half * weight)).collect()
            }
            Self::Polygon(part) => part.spread(rule).map(|place| (place.xi, place.weight)).collect(),
        }
    }
}

/// Of parts of one face, each with its gap, those over which no nearer one lies; of equals the first is the nearest.
pub fn nearest<T>(all: &[(T, FacePart, f64)]) -> impl Iterator<Item = &(T, FacePart, f64)> {
    let visible = |(i, (_, part, gap)): &(usize, &(T, FacePart, f64))| {
        let nearer = |(j, (_, _, other)): &(usize, &(T, FacePart, f64))| (other.abs(), *j) < (gap.abs(), *i);
        !all.iter().enumerate().filter(nearer).any(|(_, (_, over, _))| over.covers(part))
    };
    all.iter().enumerate().filter(visible).map(|(_, seen)| seen)
}

/// Ends and middle of an interval.
pub fn samples([from, to]: [f64; 2]) -> [[f64; 2]; 3] {
    [from, to, 0.5 * (from + to)].map(|xi| [xi, 0.0])
}
