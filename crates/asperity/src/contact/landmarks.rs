//! The pattern in which the target was touched at the accepted state: which of its places were loaded.
//!
//! A surface that slides carries its points on, and the pattern stays where it was on the target: at the kinks and
//! edges of a tool. Where a point has moved to the place of another, early iterations take the status from there. This
//! is a guess, and nothing here is asked about a solution. The target's material coordinates are used, so that its own
//! motion does not matter.

use crate::tensor::Vec3;

/// A place on the target that a point of the surface faces in the accepted state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landmark {
    /// Where it is, in the target's own coordinates.
    pub place: Vec3,
    /// Whether the point touched it.
    pub closed: bool,
}

/// Landmarks by points of the surface.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Landmarks(pub Vec<Option<Landmark>>);

/// The landmark beyond the nearest counts up to this multiple of the nearest's distance: between two landmarks the
/// edge of the pattern may be anywhere, and one closed point too many is found out sooner than one too few.
const BOTH: f64 = 2.0;

impl Landmarks {
    /// Whether point `index` is expected to be closed now that it faces `place` of the target. `None` where it still is
    /// nearest to its own landmark: then its penetration knows better.
    pub fn expected(&self, index: usize, place: Vec3) -> Option<bool> {
        self.0.get(index).copied().flatten()?;
        let (mut first, mut second) = ((f64::INFINITY, index, false), (f64::INFINITY, false));
        for (i, landmark) in self.0.iter().enumerate() {
            let Some(Landmark { place: there, closed }) = landmark else { continue };
            let distance = (*there - place).norm();
            if distance < first.0 {
                second = (first.0, first.2);
                first = (distance, i, *closed);
            } else if distance < second.0 {
                second = (distance, *closed);
            }
        }
        (first.1 != index).then_some(first.2 || (second.1 && second.0 < BOTH * first.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn status_belongs_to_the_place() {
        let closed = [false, true, true, false];
        let at = |z: f64| Vec3::new(0.0, z, 0.0);
        let landmarks = closed.iter().enumerate().map(|(i, &closed)| Some(Landmark { place: at(i as f64), closed }));
        let landmarks = Landmarks(landmarks.collect());
        assert_eq!(landmarks.expected(0, at(0.4)), None);
        assert_eq!(landmarks.expected(0, at(0.8)), Some(true));
        assert_eq!(landmarks.expected(1, at(2.9)), Some(false));
        // Halfway between a closed and an open place.
        assert_eq!(landmarks.expected(1, at(2.55)), Some(true));
        assert_eq!(Landmarks(vec![None]).expected(0, at(0.0)), None);
    }
}
