//! The search for the border of a target over a face of the surface.

use super::faces::Standing;
use super::placed::Placed;
use super::point::Triad;
use super::polygon::{Point, Polygon, left_of};
use super::split::{Border, VERTICES};
use super::target::{Cast, Memory};
use crate::contact::known::Known;
use crate::tensor::Vec3;
use crate::tool::{Bounds, Ray, Rules};

/// Parts of a face smaller than this are none, and cut nothing off.
const NOTHING: f64 = 1e-9;
/// A border that turns inwards by more than this, in `xi`, is not split at.
const INWARDS: f64 = 0.2;

/// A search on behalf of one face.
pub struct Seeker<'a> {
    /// Its target in place.
    pub standing: &'a Standing<'a>,
    /// The face.
    pub placed: &'a Placed<'a>,
    /// Any ray of the face: its bounds and relatives hold for all.
    pub cast: Cast<'a>,
}

/// A vertex of the border: its node and its foot.
type Vertex = (usize, Point<f64>);

impl Seeker<'_> {
    /// The border over the face, if the target covers a part of it only, and one that is convex.
    pub fn border(&self, memory: &mut Memory) -> Option<Border> {
        let lines = self.lines();
        if lines.is_empty() {
            return None;
        }
        let owners: Vec<usize> = lines.iter().map(|(segment, _)| *segment).collect();
        let (mut chains, closed) = chains(lines.into_iter().map(|(_, line)| line).collect())?;
        let spare = |chains: &[Vec<Vertex>]| chains.iter().map(Vec::len).sum::<usize>() > VERTICES;
        // Where the border turns inwards a little, or hardly at all, the straight line stands for it.
        while let Some((chain, k, bow)) = flattest(&chains, closed) {
            if bow > INWARDS {
                return None;
            }
            if bow < -NOTHING && !spare(&chains) {
                break;
            }
            chains[chain].remove(k);
        }
        if spare(&chains) {
            return None;
        }
        let mut border = Border { first: chains[0].len() as u32, closed, ..Border::default() };
        let all: Vec<Vertex> = chains.into_iter().flatten().collect();
        all.iter().zip(&mut border.nodes).for_each(|((node, _), to)| *to = *node as u32 + 1);
        let feet: Vec<Point<f64>> = all.iter().map(|(_, foot)| *foot).collect();
        self.holds(border, &feet, &owners, memory).then_some(border)
    }

    /// Whether a part is left, all of the border bounds it, and nothing is to be seen beyond but what curved edges of
    /// its owners leave on the far side of their chords.
    fn holds(&self, border: Border, feet: &[Point<f64>], owners: &[usize], memory: &mut Memory) -> bool {
        let corners = self.placed.face.corners();
        let whole = Polygon::<f64>::whole(corners).moments().area;
        let left = border.part(corners, feet).moments().area;
        let inside = |line: [Point<f64>; 2]| feet.iter().all(|&foot| left_of(line, foot) >= -NOTHING);
        let mut beyond = |[a, b]: [Point<f64>; 2]| {
            let off = Polygon::whole(corners).cut([b, a]).moments();
            off.area > NOTHING * whole && self.sees(off.centre, owners, memory)
        };
        left > NOTHING * whole
            && border.lines().map(|[a, b]| [feet[a], feet[b]]).all(|line| inside(line) && !beyond(line))
    }

    /// Edges of the border that cut something off the face, the covered part on their left, with the faces they end.
    fn lines(&self) -> Vec<(usize, [Vertex; 2])> {
        let (mut found, mut feet) = (Vec::new(), Known::default());
        let (_, tangents) = self.placed.frame(self.placed.face.middle());
        let inward = Triad::new(tangents).inward;
        let nodes = &self.placed.x[..self.placed.face.nodes.len()];
        let around = Bounds::of(nodes.iter().copied());
        let wide = Vec3([around.size(); 3]);
        let around = Bounds { min: around.min - wide, max: around.max + wide };
        let looks = |normal: Vec3| inward.dot(normal) > Rules::LEAST_COSINE;
        // Each vertex ends two edges.
        self.standing.borders_near(&around, &looks, &mut |segment, ends| {
            // Its face lies on the left of an edge seen from outside, on the right seen through the surface.
            let [b, a] = ends.map(|(node, x)| feet.of(node, || self.vertex(node, x)));
            let line = a.zip(b).map(|(a, b)| [a, b]).filter(|&[a, b]| self.cuts([a.1, b.1]));
            found.extend(line.map(|line| (segment, line)));
        });
        found.sort_unstable_by_key(|(_, [a, b])| [a.0, b.0]);
        found
    }

    /// A vertex within the reach of the face.
    fn vertex(&self, node: usize, x: Vec3) -> Option<Vertex> {
        let foot = self.placed.foot(x)?;
        let (at, tangents) = self.placed.frame(foot);
        let gap = Triad::new(tangents).inward.dot(x - at);
        (gap >= -self.cast.reach && gap <= self.cast.depth).then_some((node, foot))
    }

    /// Whether a piece of a line, and not only what it would be if carried on, runs through the face.
    fn cuts(&self, line: [Point<f64>; 2]) -> bool {
        let whole = Polygon::<f64>::whole(self.placed.face.corners());
        let area = |polygon: &Polygon<f64>| polygon.moments().area;
        let parted = |off: f64, area: f64| off > NOTHING * area && off < (1.0 - NOTHING) * area;
        whole.holds_part(line, NOTHING) && parted(area(&whole.cut([line[1], line[0]])), area(&whole))
    }

    fn sees(&self, xi: [f64; 2], owners: &[usize], memory: &mut Memory) -> bool {
        let (origin, tangents) = self.placed.frame(xi);
        let ray = Ray { origin, direction: Triad::new(tangents).inward };
        self.standing.select(&Cast { ray, ..self.cast }, memory).is_some_and(|hit| !owners.contains(&hit.facet))
    }
}

/// Lines joined to one chain or two, and whether the only one is closed.
fn chains(mut lines: Vec<[Vertex; 2]>) -> Option<(Vec<Vec<Vertex>>, bool)> {
    let (mut chains, mut closed) = (Vec::new(), false);
    while !lines.is_empty() {
        let begins = |line: &[Vertex; 2]| !lines.iter().any(|other| other[1].0 == line[0].0);
        let start = lines.iter().position(begins);
        closed = start.is_none();
        let mut chain = lines.remove(start.unwrap_or(0)).to_vec();
        while let Some(next) = lines.iter().position(|line| Some(line[0].0) == chain.last().map(|last| last.0)) {
            chain.push(lines.remove(next)[1]);
        }
        if closed {
            chain.pop();
        }
        chains.push(chain);
    }
    (chains.len() <= 2 && !(closed && chains.len() == 2)).then_some((chains, closed))
}

/// The vertex that turns inwards most, or outwards least: chain, place, and its distance on the covered side of the line
/// between its neighbours.
fn flattest(chains: &[Vec<Vertex>], closed: bool) -> Option<(usize, usize, f64)> {
    let mut most = None::<(usize, usize, f64)>;
    for (c, chain) in chains.iter().enumerate() {
        let n = chain.len();
        let inner = if closed { 0..n } else { 1..n - 1 };
        for k in inner.filter(|_| n > 2) {
            let (a, b) = (chain[(k + n - 1) % n].1, chain[(k + 1) % n].1);
            let bow = left_of([a, b], chain[k].1) / (b[0] - a[0]).hypot(b[1] - a[1]);
            if most.is_none_or(|most| bow > most.2) {
                most = Some((c, k, bow));
            }
        }
    }
    most
}
