//! Whether a point lies behind a boundary, how deep, and whether it passed through one on its way.

use super::hierarchy::{Bounds, Hierarchy, bounds};
use super::simplex::{Simplex, crosses};
use crate::tensor::Vec3;

/// Distances that differ by less than this part are the same: the point is nearest to an edge of several pieces.
const SAME: f64 = 1e-9;
/// Least cosine between the way to the nearest piece and its normal, where a boundary may end there.
const ACROSS: f64 = 0.8;

/// Depth of a point behind the piece nearest to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depth {
    /// A length.
    pub depth: f64,
    /// The piece.
    pub piece: usize,
}

/// How deep `p` lies behind the pieces that are nearest to it: of several at one distance that counts above which it is
/// highest or below which it is deepest. With `open`, what is nearest to the border of a boundary lies beside it. Nothing
/// farther than `most` is looked at, and no piece that is not `wanted`.
pub fn depth(
    tree: &Hierarchy,
    p: Vec3,
    (most, open): (f64, bool),
    wanted: &dyn Fn(usize, &Simplex) -> bool,
) -> Option<Depth> {
    let (mut found, mut least): (Option<(f64, usize)>, f64) = (None, f64::INFINITY);
    tree.nearest(p, most, &mut |number, piece, distance| {
        if !wanted(number, piece) {
            return true;
        }
        if distance > least * (1.0 + SAME) {
            return false;
        }
        least = least.min(distance);
        let height = piece.height(p);
        let beats = |(old, known): (f64, usize)| height.abs() > old.abs() || height == old && number < known;
        if found.is_none_or(beats) {
            found = Some((height, number));
        }
        true
    });
    let (height, piece) = found?;
    let beside = open && height.abs() < ACROSS * least;
    (height < 0.0 && !beside).then_some(Depth { depth: least, piece })
}

/// A direction that is none of a mesh's own.
const ASKEW: [Vec3; 2] = [Vec3([0.0137, -0.0211, 0.0173]), Vec3([-0.0291, 0.0119, -0.0233])];

/// Whether `p` lies inside a closed boundary: whether ways out along `direction`, and a little askew of it, lead out of the
/// material more often than in. Pieces that are not `wanted` do not count.
pub fn is_inside(
    tree: &Hierarchy,
    [low, high]: Bounds,
    (p, direction): (Vec3, Vec3),
    wanted: &dyn Fn(usize) -> bool,
) -> bool {
    let far = 2.0 * (high - low).norm() + (p - low).norm();
    let plane = matches!(tree, Hierarchy::Plane(_));
    let out = |askew: &Vec3| {
        let mut way = direction + *askew;
        if plane {
            way[2] = 0.0;
        }
        let (way, mut sum) = ([p, p + way * far], 0);
        tree.along(way, &mut |number, piece| {
            if let Some(crossing) = piece.crossing(way).filter(|_| wanted(number)) {
                sum += if crossing.leaves { 1 } else { -1 };
            }
        });
        sum > 0
    };
    ASKEW.iter().all(out)
}

/// The way of a point past a boundary that moves too, from part 0 to 1.
pub struct Way<'a> {
    /// Where the point is.
    pub at: &'a dyn Fn(f64) -> Vec3,
    /// Where a piece is.
    pub piece: &'a dyn Fn(usize, f64) -> Simplex,
    /// Parts into which the way is divided.
    pub steps: usize,
    /// How far below a piece a point may begin or end and still count as on it.
    pub near: f64,
}

/// A passage from one side of a boundary to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Thickness of what was passed, a length.
    pub depth: f64,
    /// Where it came out.
    pub piece: usize,
}

/// Cosine between the normals of two faces that are the two sides of something.
const OPPOSITE: f64 = -0.5;
/// Halvings that find the part of the way at which a piece is met.
const HALVINGS: usize = 40;
/// A point that ends this close below the far side, over what is near, has passed.
const THROUGH: f64 = 1e-3;

/// One meeting of the way with a piece.
#[derive(Debug, Clone, Copy)]
struct Event {
    part: f64,
    piece: usize,
    leaves: bool,
}

impl Way<'_> {
    fn height(&self, piece: usize, part: f64) -> f64 {
        (self.piece)(piece, part).height((self.at)(part))
    }

    /// The box around the way.
    pub fn bounds(&self) -> Bounds {
        bounds((0..=self.steps).map(|i| (self.at)(i as f64 / self.steps as f64)))
    }

    /// Whether the way leads through what the boundary encloses: in at one side and out, or to the border, at another that
    /// looks the other way.
    pub fn passage(&self, tree: &Hierarchy, wanted: &dyn Fn(usize) -> bool) -> Option<Passage> {
        let ([low, high], mut near) = (self.bounds(), Vec::new());
        let margin =
            Vec3(std::array::from_fn(|i| if i == 2 && matches!(tree, Hierarchy::Plane(_)) { 0.0 } else { self.near }));
        tree.within([low - margin, high + margin], &mut |number, _| near.push(number));
        near.retain(|&number| wanted(number));
        if near.len() < 2 {
            return None;
        }
        near.sort_unstable();
        let mut events: Vec<Event> = near.iter().flat_map(|&piece| self.events(piece)).collect();
        events.sort_by(|a, b| a.part.total_cmp(&b.part).then(a.leaves.cmp(&b.leaves)).then(a.piece.cmp(&b.piece)));
        let mut entries: Vec<usize> = self.resting(&near, 0.0, self.near).into_iter().collect();
        for event in &events {
            if !event.leaves {
                entries.push(event.piece);
            } else if let Some(passage) = self.through(&entries, event.piece, event.part) {
                return Some(passage);
            }
        }
        if entries.is_empty() {
            return None;
        }
        self.resting(&near, 1.0, THROUGH * self.near).and_then(|piece| self.through(&entries, piece, 1.0))
    }

    /// The passage from one of the pieces that were entered out through another.
    fn through(&self, entries: &[usize], piece: usize, part: f64) -> Option<Passage> {
        let out = (self.piece)(piece, part).direction();
        let opposite = |entry: &&usize| (self.piece)(**entry, part).direction().dot(out) < OPPOSITE;
        let entry = entries.iter().rev().find(opposite)?;
        Some(Passage { depth: -self.height(*entry, part), piece })
    }

    /// The piece that is closest to the point, if it is close and the point below it: one that lies outside of a thin body, by however little, is below the
    /// far side of that.
    fn resting(&self, near: &[usize], part: f64, depth: f64) -> Option<usize> {
        let p = (self.at)(part);
        let height = |&piece: &usize| {
            let simplex = (self.piece)(piece, part);
            let height = simplex.height(p);
            (height.abs() <= depth && simplex.holds(p)).then_some((height, piece))
        };
        let closest = near.iter().filter_map(height).min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        closest.filter(|(height, _)| *height <= 0.0).map(|(_, piece)| piece)
    }

    /// Where the way meets a piece; most are never met.
    fn events(&self, piece: usize) -> Vec<Event> {
        let part = |i: usize| i as f64 / self.steps as f64;
        let heights: Vec<f64> = (0..=self.steps).map(|i| self.height(piece, part(i))).collect();
        let met = |i: usize| {
            let leaves = crosses(heights[i], heights[i + 1])?;
            let (mut low, mut high) = (part(i), part(i + 1));
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if crosses(heights[i], self.height(piece, middle)).is_some() { high = middle } else { low = middle }
            }
            (self.piece)(piece, high).holds((self.at)(high)).then_some(Event { part: high, piece, leaves })
        };
        (0..self.steps).filter_map(met).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::{PI, TAU};

    fn tree(pieces: &[Simplex]) -> Hierarchy {
        Hierarchy::new(pieces[0].plane, pieces.iter().map(|piece| (*piece, bounds(piece.corners))))
    }

    fn around(pieces: &[Simplex]) -> Bounds {
        bounds(pieces.iter().flat_map(|piece| piece.corners))
    }

    /// A polygon around the origin, counter-clockwise, with the given distances of its corners.
    fn star(radii: &[f64]) -> Vec<Simplex> {
        let corner = |i: usize| {
            let (sin, cos) = (TAU * (i % radii.len()) as f64 / radii.len() as f64).sin_cos();
            Vec3::new(cos, sin, 0.0) * radii[i % radii.len()]
        };
        (0..radii.len()).map(|i| Simplex::segment(corner(i), corner(i + 1))).collect()
    }

    /// An octahedron with its faces divided in four, its corners at the given distances.
    fn stone(radii: &[f64]) -> Vec<Simplex> {
        let axis = |i: usize, sign: f64| Vec3(std::array::from_fn(|k| if k == i { sign } else { 0.0 }));
        let mut corners: Vec<Vec3> = Vec::new();
        let mut number = |p: Vec3| match corners.iter().position(|q| (*q - p).norm() < 1e-9) {
            Some(place) => place,
            None => {
                corners.push(p);
                corners.len() - 1
            }
        };
        let mut faces = Vec::new();
        for signs in 0..8u8 {
            let sign = |bit: u8| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let [x, y, z] = [axis(0, sign(0)), axis(1, sign(1)), axis(2, sign(2))];
            let [x, y, z] = if signs.count_ones() % 2 == 0 { [x, y, z] } else { [y, x, z] };
            let [a, b, c] = [(x + y) * 0.5, (y + z) * 0.5, (z + x) * 0.5];
            faces.extend([[x, a, c], [a, y, b], [c, b, z], [a, b, c]].map(|face| face.map(&mut number)));
        }
        let place = |i: usize| corners[i].unit() * radii[i % radii.len()];
        faces.into_iter().map(|face| Simplex::triangle(face.map(place))).collect()
    }

    /// How often pieces go around a point, by the angles that they span there (in space: Van Oosterom and Strackee, IEEE
    /// Trans. Biomed. Eng. 30, 1983).
    fn winding(pieces: &[Simplex], p: Vec3) -> f64 {
        let angle = |piece: &Simplex| {
            let [a, b, c] = piece.corners.map(|corner| corner - p);
            if piece.plane {
                return (a[0] * b[1] - a[1] * b[0]).atan2(a.dot(b)) / TAU;
            }
            let [la, lb, lc] = [a.norm(), b.norm(), c.norm()];
            let under = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * a.dot(b.cross(c)).atan2(under) / (4.0 * PI)
        };
        pieces.iter().map(angle).sum()
    }

    fn agrees(pieces: &[Simplex], p: Vec3) -> Result<(), TestCaseError> {
        let (tree, inside) = (tree(pieces), winding(pieces, p) > 0.5);
        let nearest = pieces.iter().map(|piece| (piece.closest(p) - p).norm()).fold(f64::INFINITY, f64::min);
        prop_assume!(nearest > 1e-6);
        let found = depth(&tree, p, (f64::INFINITY, false), &|_, _| true);
        let direction = Vec3::new(1.0, 0.0, 0.0);
        prop_assert_eq!(is_inside(&tree, around(pieces), (p, direction), &|_| true), inside);
        prop_assert_eq!(found.is_some(), inside, "{:?}", found);
        prop_assert!(found.is_none_or(|found| (found.depth - nearest).abs() < 1e-12));
        Ok(())
    }

    proptest! {
        /// Against the winding number and the least of all distances.
        #[test]
        fn points_in_polygons(radii in prop::collection::vec(0.2..1.0f64, 3..30), x in -1.0..1.0f64, y in -1.0..1.0f64) {
            agrees(&star(&radii), Vec3::new(x, y, 0.0))?;
        }

        #[test]
        fn points_in_stones(radii in prop::collection::vec(0.6..1.0f64, 18), p in [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]) {
            agrees(&stone(&radii), Vec3(p))?;
        }

        /// A straight way past a polygon that stands still comes through it where it crosses its border at two places that
        /// look away from each other, the first of them inwards: by the crossings of all pieces, in their order.
        #[test]
        fn ways_through_polygons(
            radii in prop::collection::vec(0.5..1.0f64, 4..20),
            from in 0.0..TAU, to in 0.0..TAU,
        ) {
            let pieces = star(&radii);
            let [from, to] = [from, to].map(|angle| Vec3::new(angle.cos(), angle.sin(), 0.0) * 1.5);
            let mut all: Vec<(f64, bool, Vec3)> = pieces
                .iter()
                .filter_map(|piece| piece.crossing([from, to]).map(|c| (c.part, c.leaves, piece.direction())))
                .collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            let pairs = (0..all.len()).flat_map(|i| (i..all.len()).map(move |j| (i, j)));
            let through = pairs.filter(|&(i, j)| !all[i].1 && all[j].1).any(|(i, j)| all[i].2.dot(all[j].2) < OPPOSITE);
            let at = |part| from + (to - from) * part;
            let way = Way { at: &at, piece: &|number: usize, _| pieces[number], steps: 8, near: 1e-3 };
            prop_assert_eq!(way.passage(&tree(&pieces), &|_| true).is_some(), through);
        }
    }

    /// A point above a strip of thickness 1 that goes down by so much while the strip rises or not.
    fn thickness_passed(start: f64, by: f64, rise: f64) -> Option<f64> {
        let side = |y: f64, sign: f64| Simplex::segment(Vec3::new(2.0 * sign, y, 0.0), Vec3::new(-2.0 * sign, y, 0.0));
        let pieces = [side(1.0, 1.0), side(0.0, -1.0)];
        let boxes = pieces.map(|p| (p, bounds([p.corners[0], p.corners[1] + Vec3::new(0.0, rise, 0.0)])));
        let moved = |i: usize, part: f64| {
            let up = Vec3::new(0.0, rise * part, 0.0);
            Simplex::segment(pieces[i].corners[0] + up, pieces[i].corners[1] + up)
        };
        let at = |part: f64| Vec3::new(0.3, start - by * part, 0.0);
        let way = Way { at: &at, piece: &moved, steps: 4, near: 0.01 };
        way.passage(&Hierarchy::new(true, boxes.into_iter()), &|_| true).map(|passage| passage.depth)
    }

    #[test]
    fn a_strip_is_passed_from_outside_from_its_border_and_to_its_border() {
        for (start, by, rise) in [(1.2, 1.3, 0.0), (1.0, 1.0, 0.0), (0.995, 1.5, 0.0), (1.0, 5.0, 0.0), (1.2, 0.0, 1.3)]
        {
            let depth = thickness_passed(start, by, rise).unwrap_or_else(|| panic!("{start} {by} {rise}"));
            assert!((depth - 1.0).abs() < 1e-2, "{start} {by} {rise}: {depth}");
        }
        for (start, by, rise) in
            [(1.2, 0.1, 0.0), (1.2, 0.7, 0.0), (0.995, -3.0, 0.0), (1.0, 0.5, 0.4), (-0.1, 2.0, 0.0)]
        {
            assert_eq!(thickness_passed(start, by, rise), None, "{start} {by} {rise}");
        }
    }

    /// Beside a strip thinner than what a point may lie below a side and rest on it, a point that lies outside of one side is none below the other.
    #[test]
    fn a_thin_strip_is_not_passed_by_what_lies_beside_it() {
        let side = |y: f64, sign: f64| Simplex::segment(Vec3::new(2.0 * sign, y, 0.0), Vec3::new(-2.0 * sign, y, 0.0));
        let pieces = [side(0.2, 1.0), side(0.0, -1.0)];
        let passes = |from: f64, to: f64| {
            let at = |part: f64| Vec3::new(0.3, from + (to - from) * part, 0.0);
            let way = Way { at: &at, piece: &|number: usize, _| pieces[number], steps: 4, near: 0.25 };
            way.passage(&Hierarchy::new(true, pieces.into_iter().map(|p| (p, bounds(p.corners)))), &|_| true).is_some()
        };
        for (from, to) in [(-1e-3, 1e-3), (1e-3, -1e-3), (-1e-3, -2e-3), (1e-3, 2e-3), (0.201, 0.199), (0.199, 0.201)] {
            assert!(!passes(from, to), "{from} {to}");
        }
        for (from, to) in [(0.21, -0.01), (-0.01, 0.21), (0.21, 1e-5), (0.199, -1e-3), (0.199, 1e-5)] {
            assert!(passes(from, to), "{from} {to}");
        }
    }
}
