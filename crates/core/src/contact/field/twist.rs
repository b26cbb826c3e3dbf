//! The slip of an increment over which a tool and the surface turn beside each other.
//!
//! A place of the surface carries a triad `e` with it, the direction of its gap and the two tangents; the one that it had at the
//! accepted state, moved with the tool, is `f = R e`. Between them the tool moves as a screw of constant twist, the geodesic of
//! rigid motions (Murray, Li & Sastry, A Mathematical Introduction to Robotic Manipulation, 1994, ch. 2): its material point that
//! lay at the place is then at `w = T(phi) u`, with `phi` the rotation vector of `R`, `T` as in [`Pose`], and `u` what slid past the
//! place: `w` is the chord of the way and `u` its arc, along the velocity at the place. About its first vector the triad turns with the
//! surface, by the rotation of its gradient in the plane (polar decomposition), and not with the line of its tangents, which strains turn too.

use crate::tensor::{Dual, Vec3};
use crate::tool::Pose;

/// A twist of an increment.
#[derive(Debug, Clone, Copy)]
pub struct Twist {
    rotation: Vec3,
    /// The way that slid past the place.
    pub way: Vec3,
}

impl Twist {
    /// Of the triads at the end and of what the tool's point at the place moved by.
    pub fn of(e: &[Vec3; 3], f: &[Vec3; 3], moved: Vec3) -> Self {
        let pairs = || e.iter().zip(f);
        let q = pairs().fold(Vec3::zero(), |sum, (e, f)| sum + e.cross(*f) * 0.5);
        let cosine = 0.5 * (pairs().map(|(e, f)| e.dot(*f)).sum::<f64>() - 1.0);
        let sine = q.norm();
        let rotation = if sine > 0.0 { q * (sine.atan2(cosine) / sine) } else { q };
        Self { rotation, way: Pose::turned(-rotation).moment(moved) }
    }

    /// Derivatives of the component of the way along `e`: along what moved, and along a spin of the tool beside the triad.
    pub fn slopes(&self, e: Vec3) -> [Vec3; 2] {
        let pose = Pose::turned(self.rotation);
        let along = pose.moment(e);
        let varied = Pose::turned(Vec3(std::array::from_fn(|i| Dual::<3>::variable(self.rotation[i], i))));
        let moved = varied.spin(self.way.lift());
        let change = Vec3(std::array::from_fn(|j| (0..3).map(|i| moved[i].du[j] * along[i]).sum()));
        [along, -pose.moment(change)]
    }

    /// Spin of the tool beside the triad, where that spins by the first and the other by the second.
    pub fn beside(&self, [own, carried]: [Vec3; 2]) -> Vec3 {
        carried - Pose::turned(self.rotation).rotate(own)
    }
}

/// Spin of a triad by the rates of its vectors.
pub fn spin(triad: &[Vec3; 3], rates: &[Vec3; 3]) -> Vec3 {
    triad.iter().zip(rates).fold(Vec3::zero(), |sum, (e, de)| sum + e.cross(*de) * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triad() -> [Vec3; 3] {
        let n = Vec3::new(0.2, -0.5, 0.9).unit();
        let e = n.cross(Vec3::axis(0)).unit();
        [n, e, n.cross(e)]
    }

    /// Along the arc about the middle, by its length, and along the thread where the tool advances as it turns.
    #[test]
    fn the_way_is_that_of_a_screw() {
        let (e, arm) = (triad(), Vec3::new(0.3, 0.7, -0.2));
        for angle in [0.0, 1e-12, 0.4, 2.0, -3.0] {
            let turn = Pose::turned(e[0] * angle);
            let f = e.map(|e| turn.rotate(e));
            let advance = e[0] * 0.3;
            let twist = Twist::of(&e, &f, turn.rotate(arm) - arm + advance);
            assert!((twist.way - (e[0] * angle).cross(arm) - advance).norm() < 1e-14, "{angle}: {:?}", twist.way);
        }
    }

    #[test]
    fn slopes_are_those_of_differences() {
        let (e, moved, h) = (triad(), Vec3::new(0.3, 0.7, -0.2), 1e-6);
        for w in [Vec3::zero(), Vec3::new(0.3, -0.8, 0.5), Vec3::new(1.0, 1.9, -1.0)] {
            let f = e.map(|e| Pose::turned(w).rotate(e));
            let [along, turned] = Twist::of(&e, &f, moved).slopes(e[1]);
            for d in [0, 1, 2].map(Vec3::axis) {
                let at = |step: f64| {
                    let spun = f.map(|f| Pose::turned(d * step).rotate(f));
                    [Twist::of(&e, &f, moved + d * step), Twist::of(&e, &spun, moved)].map(|twist| twist.way.dot(e[1]))
                };
                let ([a, b], [c, g]) = (at(h), at(-h));
                assert!((along.dot(d) - 0.5 * (a - c) / h).abs() < 1e-8, "{w:?}");
                assert!((turned.dot(d) - 0.5 * (b - g) / h).abs() < 1e-8, "{w:?}");
            }
        }
    }
}
