//! Augmentation after Uzawa: a penalty without penetration.
//!
//! The nodes at the corners of a surface carry multipliers, here as lengths: `s_K = lambda_K / K_p` is a closure that the
//! law sees on top of the penetration, `p = K_p (u + M_K s_K - w)`, and `m_K` a slip on top of that of the increment. `M_K`
//! are the linear functions of the corners, since the integrals of serendipity functions are negative. When Newton's
//! method has converged, each node takes in what its points still penetrate, `s_K <- <s_K + e_K>` with
//! `e_K = int M_K (u - w) / int M_K`, and what its points slip without sliding, so that `m_K` bears the shear; then the iterations go on, until neither
//! exceeds its tolerance (Hestenes 1969; Simo & Laursen, Comput. Struct. 42, 1992). A law never learns of it.
//! The closures last from increment to increment. The slips begin at zero, since the shear stress itself is remembered.

use super::partner::Role;
use super::spread::{MOST, Spread};
use crate::tensor::Vec3;
use crate::{Failure, Kind};
use std::collections::BTreeMap;

/// How far a contact is augmented. Lengths are parts of the size of the surface's element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Augmentation {
    /// Largest penetration at a node that is left.
    pub penetration: f64,
    /// Largest slip of an increment that is left at a node where nothing slides.
    pub slip: f64,
    /// Most augmentations of an attempt.
    pub loops: usize,
    /// Whose multipliers these are.
    pub role: Role,
}

/// The corners of a surface, numbered among themselves.
#[derive(Debug, Clone, Default)]
pub struct Corners {
    pub(super) sizes: Vec<f64>,
    pub(super) spreads: Vec<Spread>,
    /// The corners of each face, and how many there are.
    places: Vec<([usize; MOST], usize)>,
}

/// Closure and slip that multipliers stand for, at a corner or at a point; in the plane the slip has one component.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shift {
    /// Closure.
    pub closure: f64,
    /// Slip.
    pub slip: Vec3,
}

/// Multipliers that close by so much at each corner.
pub fn closures_alone(closures: &[f64]) -> Vec<Shift> {
    closures.iter().map(|&closure| Shift { closure, ..Shift::default() }).collect()
}

/// What a contact point tells its corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report {
    /// Area it stands for.
    pub area: f64,
    /// What it penetrates of what its law allows, negative for a gap.
    pub penetration: f64,
    /// Whether it is closed, and without sliding.
    pub closed: bool,
    /// See [`closed`](Self::closed).
    pub sticks: bool,
    /// Slip of the increment that is no sliding.
    pub slip: Vec3,
    /// By how much its multipliers would have to grow to bear the shear stress alone.
    pub raise: Vec3,
    /// The least closure that multipliers may stand for: below zero where a bond pulls.
    pub least: f64,
}

/// What is left at the corners, as parts of their sizes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Left {
    /// Largest change of a closure.
    pub penetration: f64,
    /// Largest change of a slip at a corner around which nothing slides.
    pub slip: f64,
}

impl Augmentation {
    /// Whether what is left after `done` augmentations asks for another.
    ///
    /// # Errors
    /// A [`Failure`] when there may be no other.
    pub fn goes_on(&self, left: &Left, done: usize, name: &str) -> Result<bool, Failure> {
        if left.penetration <= self.penetration && left.slip <= self.slip {
            return Ok(false);
        }
        if done < self.loops {
            return Ok(true);
        }
        Err(Failure::new(format!(
            "contact '{name}': {done} augmentations leave a penetration of {:.1e} and a slip of {:.1e} of an element's size \
             at its nodes",
            left.penetration, left.slip
        ))
        .of(Kind::Multipliers))
    }
}

impl Corners {
    /// Of faces, each given by its corners and its size, and of points, each given by its face and its place on it: from
    /// -1 to 1 along an edge or both sides of a quadrilateral, from 0 to 1 on a triangle.
    pub fn new<'a>(
        faces: impl Iterator<Item = (&'a [usize], f64)>,
        points: impl Iterator<Item = (usize, [f64; 2])>,
    ) -> Self {
        let (mut numbers, mut sizes, mut places) = (BTreeMap::new(), Vec::new(), Vec::new());
        for (nodes, size) in faces {
            let mut corners = [0; MOST];
            for (corner, node) in corners.iter_mut().zip(nodes) {
                let fresh = numbers.len();
                *corner = *numbers.entry(*node).or_insert(fresh);
                if *corner == sizes.len() {
                    sizes.push(f64::INFINITY);
                }
                sizes[*corner] = sizes[*corner].min(size);
            }
            places.push((corners, nodes.len()));
        }
        let mut all = Self { sizes, spreads: Vec::new(), places };
        all.spreads = points.map(|(face, at)| all.spread(face, at)).collect();
        all
    }

    /// The corners around a place of a face, and their functions there.
    pub(super) fn spread(&self, face: usize, at: [f64; 2]) -> Spread {
        let (corners, count) = self.places[face];
        Spread::new((corners, count), at)
    }

    /// Number of corners.
    pub fn count(&self) -> usize {
        self.sizes.len()
    }

    /// What multipliers stand for at a point.
    pub fn at(&self, point: usize, shifts: &[Shift]) -> Shift {
        self.spreads[point].of(shifts)
    }

    /// Improves multipliers by what the points report, and says what was left. Points that see no target have none.
    pub fn improve(&self, shifts: &mut [Shift], reports: impl IntoIterator<Item = Option<Report>>) -> Left {
        let mut means = vec![Mean::default(); self.count()];
        for (spread, report) in self.spreads.iter().zip(reports) {
            let Some(report) = report else { continue };
            spread.iter().for_each(|(corner, function)| means[corner].add(function * report.area, &report));
        }
        let mut left = Left::default();
        for ((shift, mean), size) in shifts.iter_mut().zip(&means).zip(&self.sizes) {
            let [closure, slip] = mean.improve(shift);
            left.penetration = left.penetration.max(closure / size);
            left.slip = left.slip.max(slip / size);
        }
        left
    }
}

/// Weighted means over the points around a corner.
#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    weight: f64,
    penetration: f64,
    closed: f64,
    slip: Vec3,
    raise: Vec3,
    slides: bool,
    least: f64,
}

impl Mean {
    fn add(&mut self, weight: f64, report: &Report) {
        self.weight += weight;
        self.penetration += weight * report.penetration;
        self.least = self.least.min(report.least);
        if report.closed {
            self.closed += weight;
            self.slip += report.slip * weight;
            self.raise += report.raise * weight;
            self.slides |= !report.sticks;
        }
    }

    /// Improves the multipliers of its corner, and returns by how much.
    fn improve(&self, shift: &mut Shift) -> [f64; 2] {
        let before = shift.closure;
        let mean = if self.weight > 0.0 { self.penetration / self.weight } else { -before };
        shift.closure = (before + mean).max(self.least);
        let part = if self.closed > 0.0 { self.closed.recip() } else { 0.0 };
        shift.slip += self.raise * part;
        [(shift.closure - before).abs(), if self.slides { 0.0 } else { self.slip.norm() * part }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners() -> Corners {
        let faces: [(&[usize], f64); 2] = [(&[7, 3], 2.0), (&[3, 9], 1.0)];
        Corners::new(faces.into_iter(), [(0, [-0.5, 0.0]), (0, [0.5, 0.0]), (1, [0.0, 0.0])].into_iter())
    }

    fn report(penetration: f64) -> Option<Report> {
        Some(Report {
            area: 1.0,
            penetration,
            closed: true,
            sticks: true,
            slip: Vec3::zero(),
            raise: Vec3::zero(),
            least: 0.0,
        })
    }

    /// A corner takes in the mean of what its points penetrate; one whose points stand off gives up no more than it has.
    #[test]
    fn corners_take_in_what_is_left() {
        let corners = corners();
        assert_eq!((corners.count(), corners.sizes.as_slice()), (3, &[2.0, 1.0, 1.0][..]));
        let mut shifts = vec![Shift { closure: 0.1, slip: Vec3::zero() }; 3];
        let left = corners.improve(&mut shifts, [report(0.2), report(0.4), report(-0.5)]);
        let expected = [0.1 + 0.75 * 0.2 + 0.25 * 0.4, (0.1 + (0.25 * 0.2 + 0.75 * 0.4 - 0.5 * 0.5) / 1.5), 0.0];
        for (shift, expected) in shifts.iter().zip(expected) {
            assert!((shift.closure - expected).abs() < 1e-15, "{shift:?} {expected}");
        }
        assert!((left.penetration - 0.125).abs() < 1e-15 && left.slip == 0.0, "{left:?}");
        assert!((corners.at(2, &shifts).closure - 0.5 * expected[1]).abs() < 1e-15);
    }

    /// Points that see nothing leave their corners without multipliers; a bond may pull; what slides asks for nothing.
    #[test]
    fn what_sees_nothing_carries_nothing() {
        let corners = corners();
        let mut shifts = vec![Shift { closure: 0.1, slip: Vec3::zero() }; 3];
        corners.improve(&mut shifts, [None, None, None]);
        assert!(shifts.iter().all(|shift| shift.closure == 0.0));
        let bond = Report { least: -0.3, ..report(-0.2).unwrap() };
        corners.improve(&mut shifts, [None, None, Some(bond)]);
        assert_eq!(shifts[2].closure, -0.2);
        let slip = Vec3::new(0.5, 0.0, 0.0);
        let slides = Report { sticks: false, slip, raise: slip, ..report(0.0).unwrap() };
        let sticks = Report { slip, raise: slip, ..report(0.0).unwrap() };
        assert_eq!(corners.improve(&mut shifts.clone(), [Some(slides), None, None]).slip, 0.0);
        assert_eq!(corners.improve(&mut shifts, [Some(sticks), None, None]).slip, 0.5);
        assert_eq!(shifts[0].slip, slip);
    }
}
