//! The places of a quadrature on a patch, and how they move with its unknowns.

use super::column::PointColumn;
use super::face::CORNERS;
use super::patch::{IntervalRates, PatchInPlace};
use super::space::{DIRECTIONS, Spread, spread, whole};
use crate::tensor::{Dual, Vec3};

/// A place of a quadrature on a face.
#[derive(Debug, Clone)]
pub struct FaceSpot {
    /// Reference coordinates.
    pub xi: [f64; 2],
    /// Area in reference coordinates that it stands for.
    pub weight: f64,
    laid: SpotMap,
}

/// How a place depends on unknowns.
#[derive(Debug, Clone)]
enum SpotMap {
    /// On an interval from -1 to 1: its place there and its weight.
    Interval([f64; 2]),
    /// On a whole face: not at all.
    Whole,
    /// On an overlap: derivatives of both coordinates and of the area along the corners of both faces.
    Overlap(Box<[[f64; DIRECTIONS]; 3]>),
}

impl PatchInPlace<'_> {
    /// The places of its quadrature; `rule` is that of an interval.
    pub fn spots(&self, rule: &[(f64, f64)], derivatives: bool) -> Vec<FaceSpot> {
        if self.face.plane {
            let half = 0.5 * (self.interval[1] - self.interval[0]);
            let place = |&(eta, weight): &(f64, f64)| FaceSpot {
                xi: [self.place(eta), 0.0],
                weight: weight * half,
                laid: SpotMap::Interval([eta, weight]),
            };
            return rule.iter().map(place).collect();
        }
        let own = self.face.corners();
        let Some((faces, seen)) = &self.seen else {
            let on = |Spread { xi, weight }| FaceSpot { xi, weight, laid: SpotMap::Whole };
            return whole(own.len()).map(on).collect();
        };
        let other = &seen.nodes()[..faces.surface.faces[self.patch.target].corners()];
        let (mut spots, degree) = (Vec::new(), self.degree);
        if !derivatives {
            spread(degree, own, other, |Spread { xi, weight }| {
                spots.push(FaceSpot { xi, weight, laid: SpotMap::Whole })
            });
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
        spread(degree, &own_lifted[..own.len()], &other_lifted[..other.len()], |Spread { xi: [a, b], weight }| {
            let laid = SpotMap::Overlap(Box::new([a.du, b.du, weight.du]));
            spots.push(FaceSpot { xi: [a.re, b.re], weight: weight.re, laid });
        });
        spots
    }

    /// Derivatives of a place's coordinates and of its area along an unknown; `ends` are those of the interval.
    pub fn spot_rates(&self, spot: &FaceSpot, column: &PointColumn, ends: &IntervalRates) -> ([f64; 2], f64) {
        match &spot.laid {
            SpotMap::Interval([eta, weight]) => {
                let along = 0.5 * (ends[0] * (1.0 - eta) + ends[1] * (1.0 + eta));
                ([along, 0.0], weight * 0.5 * (ends[1] - ends[0]))
            }
            SpotMap::Whole => ([0.0; 2], 0.0),
            SpotMap::Overlap(rates) => {
                let PointColumn::Node { axis, own, seen, .. } = column else { return ([0.0; 2], 0.0) };
                let corner = |k: Option<usize>, first: usize| k.filter(|&k| k < CORNERS).map(|k| first + 3 * k + axis);
                let places = [corner(*own, 0), corner(*seen, DIRECTIONS / 2)];
                let sum = |c: usize| places.iter().flatten().map(|&place| rates[c][place]).sum::<f64>();
                ([sum(0), sum(1)], sum(2))
            }
        }
    }
}
