//! The places of a quadrature on a patch, and how they move with its unknowns.

use super::column::PointColumn;
use super::face::CORNERS;
use super::patch::{BoundRates, PatchInPlace};
use super::space::{DIRECTIONS, INTEGRALS, PartMap, Spread, spread, whole};
use crate::tensor::{Dual, Vec3, legendre};
use std::sync::LazyLock;

/// Four Gauss points in the plane: the integrals of linear functions times those of second degree over a density of first.
pub static GAUSS: LazyLock<Vec<IntervalPoint>> =
    LazyLock::new(|| legendre(4).into_iter().map(|(eta, weight)| IntervalPoint { eta, weight }).collect());

/// A point of the rule on an interval.
#[derive(Debug, Clone, Copy)]
pub struct IntervalPoint {
    /// Its place, from -1 to 1.
    pub eta: f64,
    /// Its weight.
    pub weight: f64,
}

/// A place of a quadrature on a face.
#[derive(Debug, Clone)]
pub struct FaceSpot {
    /// Reference coordinates.
    pub xi: [f64; 2],
    /// Area in reference coordinates that it stands for.
    pub weight: f64,
    /// The corner of the face that it is, where the surface ends there: it stands for no area of its own.
    pub vertex: Option<usize>,
    laid: SpotMap,
}

/// How a place depends on unknowns.
#[derive(Debug, Clone)]
enum SpotMap {
    /// On an interval, or a part of a face: derivatives of both coordinates and of the area along what bounds it.
    Bounded([[f64; INTEGRALS]; 3]),
    /// On a whole face: not at all.
    Whole,
    /// On an overlap: derivatives of both coordinates and of the area along the corners of both faces.
    Overlap(Box<[[f64; DIRECTIONS]; 3]>),
}

impl FaceSpot {
    /// One that is no vertex.
    fn new(xi: [f64; 2], weight: f64, laid: SpotMap) -> Self {
        Self { xi, weight, vertex: None, laid }
    }
}

impl PatchInPlace<'_> {
    /// The places of its quadrature, and of its vertices.
    pub fn spots(&self, derivatives: bool) -> Vec<FaceSpot> {
        let mut spots = self.quadrature(derivatives);
        spots.extend(self.patch.vertices().map(|corner| FaceSpot {
            vertex: Some(corner),
            ..FaceSpot::new(self.face.face.corner_place(corner), 0.0, SpotMap::Whole)
        }));
        spots
    }

    fn quadrature(&self, derivatives: bool) -> Vec<FaceSpot> {
        if self.face.plane {
            let half = 0.5 * (self.interval[1] - self.interval[0]);
            let both = |a: f64, b: f64| std::array::from_fn(|k| [a, b].get(k).map_or(0.0, |x| 0.5 * x));
            let place = |&IntervalPoint { eta, weight }: &IntervalPoint| {
                let laid = SpotMap::Bounded([both(1.0 - eta, 1.0 + eta), both(0.0, 0.0), both(-weight, weight)]);
                FaceSpot::new([self.place(eta), 0.0], weight * half, laid)
            };
            return GAUSS.iter().map(place).collect();
        }
        let own = self.face.corners();
        if self.patch.seen.is_some() {
            let Some(cut) = &self.cut else { return Vec::new() };
            let laid = PartMap::new(own.len(), cut.moments(Dual::<INTEGRALS>::variable));
            let share = laid.share();
            let on = |spread: Spread<f64>| {
                let ([a, b], weight) = (laid.place(spread.xi), share * spread.weight);
                FaceSpot::new([a.re, b.re], weight.re, SpotMap::Bounded([a.du, b.du, weight.du]))
            };
            return whole(own.len()).map(on).collect();
        }
        let Some((faces, seen)) = &self.seen else {
            let on = |Spread { xi, weight }| FaceSpot::new(xi, weight, SpotMap::Whole);
            return whole(own.len()).map(on).collect();
        };
        let other = &seen.nodes()[..faces.surface.faces[self.patch.target].corners()];
        let (mut spots, cubic) = (Vec::new(), self.cubic);
        if !derivatives {
            spread(cubic, own, other, |Spread { xi, weight }| spots.push(FaceSpot::new(xi, weight, SpotMap::Whole)));
            return spots;
        }
        type D = Dual<DIRECTIONS>;
        let lift = |x: &[Vec3], first: usize| {
            let mut all = [Vec3::<D>::zero(); CORNERS];
            for (k, (all, x)) in all.iter_mut().zip(x).enumerate() {
                *all = Vec3(std::array::from_fn(|i| D::variable(x[i], first + 3 * k + i)));
            }
            all
        };
        let (own_lifted, other_lifted) = (lift(own, 0), lift(other, DIRECTIONS / 2));
        spread(cubic, &own_lifted[..own.len()], &other_lifted[..other.len()], |Spread { xi: [a, b], weight }| {
            let laid = SpotMap::Overlap(Box::new([a.du, b.du, weight.du]));
            spots.push(FaceSpot::new([a.re, b.re], weight.re, laid));
        });
        spots
    }

    /// Derivatives of a place's coordinates and of its area along an unknown; `bounds` are those of what bounds the patch.
    pub fn spot_rates(&self, spot: &FaceSpot, column: &PointColumn, bounds: &BoundRates) -> ([f64; 2], f64) {
        match &spot.laid {
            SpotMap::Bounded(rates) => {
                let [a, b, area] =
                    rates.map(|rates| rates.iter().zip(bounds).map(|(rate, bound)| rate * bound).sum::<f64>());
                ([a, b], area)
            }
            SpotMap::Whole => ([0.0; 2], 0.0),
            SpotMap::Overlap(rates) => {
                let PointColumn::Node { axis, own, seen, .. } = column else { return ([0.0; 2], 0.0) };
                let corner = |k: Option<usize>, first: usize| k.filter(|&k| k < CORNERS).map(|k| first + 3 * k + axis);
                let own = own.and_then(|node| self.face.face.corner_at(node));
                let places = [corner(own, 0), corner(*seen, DIRECTIONS / 2)];
                let sum = |c: usize| places.iter().flatten().map(|&place| rates[c][place]).sum::<f64>();
                ([sum(0), sum(1)], sum(2))
            }
        }
    }
}
