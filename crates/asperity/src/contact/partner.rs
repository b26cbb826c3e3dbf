//! Multipliers of a contact both of whose sides carry points, each for its own forces.
//!
//! Pressure and counter-pressure agree only if both sides know the same multipliers: two sets, each improved by what its
//! own points penetrate, would drift apart, since nothing but the gap holds them together. Of two passes the surface
//! leads, therefore: the corners of its target take for their multipliers the weighted means of what their points find
//! where they touch it. On a surface that touches itself both sides are improved alike, each by the mean of what its own
//! points ask for and of what its points find that the other side asks for; and since multipliers move with the surface,
//! an increment begins with the means of both sides' values.

use super::augment::{Augmentation, Corners, Left, Shift};
use crate::tensor::Vec3;

/// Whose multipliers a contact has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// Its own.
    Leads,
    /// Those of the contact before it, of which it is the second pass.
    Follows,
    /// Its own, which are those of the other side as well: the surface touches itself.
    Itself,
}

/// Where a contact point touches a face of the other side, as [`Corners::new`] has it, and the area that it stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// The face.
    pub face: usize,
    /// The place on it.
    pub at: [f64; 2],
    /// The area.
    pub area: f64,
}

impl Shift {
    /// As plain numbers.
    pub fn numbers(&self) -> [f64; 4] {
        [self.closure, self.slip[0], self.slip[1], self.slip[2]]
    }
    /// From plain numbers.
    pub fn of([closure, x, y, z]: [f64; 4]) -> Self {
        Self { closure, slip: Vec3::new(x, y, z) }
    }
}

impl Corners {
    /// For each corner the weighted mean of what its points find, of multipliers `shifts` of the corners `other`; none
    /// around a corner whose points touch nothing. A slip counts `sign` times.
    pub fn found(
        &self,
        (other, shifts): (&Corners, &[Shift]),
        touches: impl IntoIterator<Item = Option<Touch>>,
        sign: f64,
    ) -> Vec<Shift> {
        let mut means = vec![(0.0, Shift::default()); self.count()];
        for (spread, touch) in self.spreads.iter().zip(touches) {
            let Some(Touch { face, at, area }) = touch else { continue };
            let here = other.spread(face, at).of(shifts);
            for (corner, function) in spread.iter() {
                let (weight, mean) = &mut means[corner];
                *weight += function * area;
                mean.closure += function * area * here.closure;
                mean.slip += here.slip * (sign * function * area);
            }
        }
        let mean = |(weight, sum): (f64, Shift)| match weight > 0.0 {
            true => Shift { closure: sum.closure / weight, slip: sum.slip * weight.recip() },
            false => Shift::default(),
        };
        means.into_iter().map(mean).collect()
    }

    /// How far multipliers have moved from others, as parts of the sizes of the corners.
    pub fn moved(&self, from: &[Shift], to: &[Shift]) -> Left {
        let mut moved = Left::default();
        for ((from, to), size) in from.iter().zip(to).zip(&self.sizes) {
            moved.penetration = moved.penetration.max((to.closure - from.closure).abs() / size);
            moved.slip = moved.slip.max((to.slip - from.slip).norm() / size);
        }
        moved
    }
}

impl Augmentation {
    /// Whether a motion of multipliers is worth taking up.
    pub fn is_felt(&self, moved: &Left) -> bool {
        moved.penetration > self.penetration || moved.slip > self.slip
    }
}

/// What two sets of multipliers have between them, of each half.
pub fn between(one: &[Shift], other: &[Shift]) -> Vec<Shift> {
    let half = |(one, other): (&Shift, &Shift)| Shift {
        closure: 0.5 * (one.closure + other.closure),
        slip: (one.slip + other.slip) * 0.5,
    };
    one.iter().zip(other).map(half).collect()
}

/// The changes from some multipliers to others.
pub fn changes(from: &[Shift], to: &[Shift]) -> Vec<Shift> {
    let change = |(from, to): (&Shift, &Shift)| Shift { closure: to.closure - from.closure, slip: to.slip - from.slip };
    from.iter().zip(to).map(change).collect()
}

/// Multipliers changed by so much; one that does not pull is not made to.
pub fn changed(from: &[Shift], by: &[Shift]) -> Vec<Shift> {
    let sum = |(from, by): (&Shift, &Shift)| Shift {
        closure: (from.closure + by.closure).max(from.closure.min(0.0)),
        slip: from.slip + by.slip,
    };
    from.iter().zip(by).map(sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two edges of the other side over three of this one: linear multipliers are found as they are.
    #[test]
    fn what_is_linear_is_found_at_the_place_where_it_is_touched() {
        let other = Corners::new([(&[0, 1][..], 1.0), (&[1, 2][..], 1.0)].into_iter(), std::iter::empty());
        let shifts: Vec<Shift> = [0.0, 1.0, 2.0].map(|x| Shift::of([3.0 + x, 0.5, 0.0, 0.0])).to_vec();
        let own = Corners::new([(&[7, 8][..], 0.5)].into_iter(), [(0, [-0.5, 0.0]), (0, [0.5, 0.0])].into_iter());
        let touch = |face: usize, xi: f64| Some(Touch { face, at: [xi, 0.0], area: 2.0 });
        // At 0.25 and 1.75: means with the weights 3 to 1.
        let found = own.found((&other, &shifts), [touch(0, -0.5), touch(1, 0.5)], -1.0);
        assert!((found[0].closure - (3.0 + 0.75 * 0.25 + 0.25 * 1.75)).abs() < 1e-15, "{found:?}");
        assert!((found[1].closure - (3.0 + 0.25 * 0.25 + 0.75 * 1.75)).abs() < 1e-15, "{found:?}");
        assert!((found[0].slip[0] + 0.5).abs() < 1e-15);
        assert_eq!(own.found((&other, &shifts), [None, None], 1.0), [Shift::default(); 2]);
        let moved = own.moved(&[Shift::default(); 2], &found);
        assert!((moved.penetration - found[1].closure / 0.5).abs() < 1e-15 && (moved.slip - 1.0).abs() < 1e-15);
    }
}
