//! The smooth surface that faces with straight edges stand for: arcs over their edges, to which gaps are measured.
//!
//! The chords of a circle lie inside it by their sagitta, by two thirds of that in the mean, and sides that fit would be apart or inside one another by
//! as much. The height of the arc over an edge follows from the normals at its ends, those of a circle or a sphere through the
//! nodes around (Max, J. Graphics Tools 4(2), 1999); over a face it is carried by the functions of second degree of the middles of its edges, as on
//! a curved patch between averaged normals (Vlachos, Peters, Boyd and Mitchell, Curved PN triangles, 2001), with what an arc has beyond a parabola. Edges of second degree lack
//! only that. Heights are those before any motion, or of the accepted state where straight edges flatten or bend.

use super::face::{CORNERS, FieldFace, PlacedFace, ShapeFunctions};
use super::surface::{ALONE, FieldNode, FieldSurface, mirrored};
use crate::contact::plates;
use crate::mesh::{ALONG, Mesh, Side, arc_height, round_share};
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// Lean of a normal up to which a surface is flat.
const FLAT: f64 = 1e-6;
/// Part of a straight edge by which what rises above it may change before it counts: under pressure alone the strain of small deformations, which
/// is of the order of what the cells behind resolve, would move it from increment to increment.
const STRAINED: f64 = 1e-3;

/// Part by which what leans at both ends of an edge may differ where the surface goes on round there.
const ROUND: f64 = 0.5;

/// How far the smooth surface that a side stands for rises above its edges, outward.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Rises {
    /// Height `h` of the parabola `h (1 - x^2)` over each edge, zero over those of second degree whose middle lies on the surface,
    parabola: [f64; CORNERS],
    /// and `q` of `q x^2 (1 - x^2)`, by which the arc is beyond that: along normals of the surface `-l s^3 / 16` over a chord of length `l` that the arc leaves with a
    /// sine `s`, and `l s / 4` over a parabola.
    quartic: [f64; CORNERS],
}

/// Those of a side; None of what is flat.
pub type Heights = Option<Rises>;

impl Rises {
    fn is_none(&self, edge: usize) -> bool {
        self.parabola[edge] == 0.0 && self.quartic[edge] == 0.0
    }

    /// The two numbers of an edge.
    fn of(&self, edge: usize) -> [f64; 2] {
        [self.parabola[edge], self.quartic[edge]]
    }
}

/// The rise over an edge with these numbers at its coordinate `x`, with its slope.
fn over_edge([h, q]: [f64; 2], x: f64) -> [f64; 2] {
    let square = x * x;
    [(h + q * square) * (1.0 - square), 2.0 * x * (q * (1.0 - 2.0 * square) - h)]
}

/// Heights of both sides of a contact, face by face; none known are none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Arcs {
    /// Of the surface,
    pub own: Vec<Heights>,
    /// and of the bodies that are its target.
    pub seen: Vec<Heights>,
}

/// An edge of a side with what goes on beyond its ends.
#[derive(Debug, Clone)]
struct Chord {
    /// Numbers of the corners of the side at its ends.
    corners: [usize; 2],
    /// Its length before any motion.
    length: f64,
    /// Whether the smooth piece goes on there.
    goes_on: [bool; 2],
    /// Edges that go on along it there, as numbers of their side and of themselves, and which of their ends is the far one.
    beyond: [Vec<[usize; 3]>; 2],
}

/// What a smooth surface leans beyond an edge of a side at its ends.
#[derive(Debug, Clone, Copy)]
struct Lean {
    /// Sines, unknown where the surface ends.
    beyond: [Option<f64>; 2],
    /// What the side itself leans, at both together.
    own: f64,
    length: f64,
}

impl Lean {
    /// The mean at both ends, but no more than twice the lesser: flat faces are flat up to where a curve begins (the limiter of van Leer, 1977). None where
    /// they lean to two sides.
    fn limited(&self) -> f64 {
        let [from, to] = self.beyond.map(Option::unwrap_or_default);
        let lean = (0.5 * (from + to).abs()).min(2.0 * from.abs().min(to.abs()));
        if from * to > 0.0 && lean > FLAT { lean.min(1.0).copysign(from) } else { 0.0 }
    }

    /// Height of the arc that leans by this sine beyond the edge.
    fn height(&self, sine: f64) -> f64 {
        arc_height(self.length, sine.abs()).copysign(sine)
    }
}

/// The edges of the sides of a surface.
#[derive(Debug, Clone, Default)]
pub struct Chords {
    /// The sides, each once and whole.
    whole: FieldSurface,
    /// For each face of the surface its side.
    sides: Vec<usize>,
    /// For each node the side whose normal is the surface's there, if it is at the end of what is flat.
    flat: Vec<Option<usize>>,
    edges: Vec<Vec<Chord>>,
    /// Heights before any motion,
    rest: Vec<Heights>,
    /// and of which sides they change: straight ones of what is round, which flattens, and of thin bodies, which bend without much strain. Flat bulky ones turn where
    /// they are pressed in or folded, and those of second degree bend with the cells behind.
    bends: Vec<bool>,
}

impl Chords {
    /// Those of a surface.
    pub fn of(surface: &FieldSurface, mesh: &Mesh) -> Self {
        let FieldSurface { ref faces, plane, revolves, .. } = *surface;
        let mut whole = FieldSurface { plane, revolves, ..FieldSurface::default() };
        let mut sides: Vec<Side> = faces.iter().map(|face| face.side).collect();
        sides.sort_unstable();
        sides.dedup();
        whole.faces = sides.iter().map(|&side| FieldFace::new(mesh, side)).collect();
        whole.number(mesh, &[]);
        let number = |face: &FieldFace| sides.partition_point(|side| *side < face.side);
        let mut chords = Self { sides: faces.iter().map(number).collect(), whole, ..Self::default() };
        chords.flat = (0..chords.whole.nodes.len()).map(|node| chords.flat_beside(node, mesh)).collect();
        chords.edges = chords.list(mesh);
        chords.rest = chords.of_sides(&|node| mesh.points[node]);
        let thin: BTreeMap<usize, bool> = plates(mesh, &mesh.cells_behind(&sides, 0..mesh.cell_count()))
            .map(|(cell, plate)| (cell, plate.is_some()))
            .collect();
        let bends =
            |(face, rest): (&FieldFace, &Heights)| face.kind.degree == 1 && (rest.is_some() || thin[&face.side.cell]);
        chords.bends = chords.whole.faces.iter().zip(&chords.rest).map(bends).collect();
        chords
    }

    /// The edges of each side.
    fn list(&self, mesh: &Mesh) -> Vec<Vec<Chord>> {
        let whole = &self.whole;
        let middle =
            |f: usize| whole.faces[f].shape(whole.faces[f].middle()).value(whole.faces[f].at_rest(mesh).nodes());
        let edges = |f: usize| {
            let count = whole.faces[f].corners();
            (0..if count == 2 { 1 } else { count }).map(move |k| [k, (k + 1) % count])
        };
        let mut from: BTreeMap<usize, Vec<(usize, [usize; 3])>> = BTreeMap::new();
        for f in 0..whole.faces.len() {
            for (k, corners) in edges(f).enumerate() {
                let [a, b] = corners.map(|corner| whole.faces[f].corner_node(corner));
                from.entry(a).or_default().push((b, [f, k, 1]));
                from.entry(b).or_default().push((a, [f, k, 0]));
            }
        }
        let chord = |f: usize, corners: [usize; 2]| {
            let nodes = corners.map(|corner| whole.faces[f].corner_node(corner));
            let ends = [nodes, [nodes[1], nodes[0]]].map(|[here, there]| {
                let x = mesh.points[here];
                (here, x, (x - mesh.points[there]).unit())
            });
            let goes_on = [0, 1].map(|end| {
                let (_, x, way) = ends[end];
                let ahead = |&(other, _): &(usize, usize)| (middle(other) - x).dot(way) > 0.0;
                whole.nodes[whole.field[f][corners[end]]].support.iter().any(ahead)
            });
            let beyond = ends.map(|(here, x, way)| {
                let along = |to: &usize| (mesh.points[*to] - x).unit().dot(way) > ALONG;
                from[&here].iter().filter(|(to, _)| along(to)).map(|(_, edge)| *edge).collect()
            });
            let length = (ends[1].1 - ends[0].1).norm();
            Chord { corners, length, goes_on, beyond }
        };
        (0..whole.faces.len()).map(|f| edges(f).map(|corners| chord(f, corners)).collect()).collect()
    }

    /// The normal at a node of the sphere, in the plane of the circle, through it and the corners beside it: the sum of the
    /// normals of its faces over the products of the lengths of their edges there (Max, J. Graphics Tools 4(2), 1999), however long these are.
    fn round_normal(&self, node: usize, position: &dyn Fn(usize) -> Vec3) -> Vec3 {
        let whole = &self.whole;
        let FieldNode { support, mirrors, .. } = &whole.nodes[node];
        let share = |(f, corner): (usize, usize)| {
            let (face, count) = (&whole.faces[f], whole.faces[f].corners());
            let x = |corner: usize| position(face.corner_node(corner % count));
            let edges = match whole.plane {
                true => [x(1) - x(0), Vec3::axis(2)],
                false => [x(corner + 1) - x(corner), x(corner + count - 1) - x(corner)],
            };
            round_share(edges[0].cross(edges[1]), &edges)
        };
        let sum = match self.flat[node] {
            Some(flat) => share((flat, 0)),
            None => support.iter().fold(Vec3::zero(), |sum, &of| sum + share(of)),
        };
        mirrored(sum, mirrors).unit()
    }

    /// Of a node in the plane at which a curve in chords leaves what is flat the side of that: the faces turn there by half of what they turn
    /// at the next node on one side, and on the other not at all.
    fn flat_beside(&self, node: usize, mesh: &Mesh) -> Option<usize> {
        let whole = &self.whole;
        let &[one, other] = &whole.nodes[node].support[..] else { return None };
        let normal = |f: usize| whole.middle_normal(&whole.faces[f], &whole.faces[f].at_rest(mesh));
        let turn = |f: usize, g: usize| normal(f).cross(normal(g)).norm();
        let here = turn(one.0, other.0);
        let beyond = |(f, corner): (usize, usize)| {
            let beside = whole.nodes[whole.field[f][1 - corner]].support.iter().find(|(g, _)| *g != f);
            beside.map(|(g, _)| turn(f, *g))
        };
        let leaves = |flat: (usize, usize), round: (usize, usize)| {
            let [flat_on, round_on] = [beyond(flat)?, beyond(round)?];
            (flat_on < ALONE * here && round_on > here).then_some(flat.0)
        };
        if !whole.plane {
            return None;
        }
        leaves(one, other).or_else(|| leaves(other, one))
    }

    /// The heights of each face of the surface before any motion.
    pub fn at_rest(&self) -> Vec<Heights> {
        self.sides.iter().map(|&side| self.rest[side]).collect()
    }

    /// Whether they may change.
    pub fn bend(&self) -> bool {
        self.bends.contains(&true)
    }

    /// The same with the nodes of the mesh in place.
    pub fn heights(&self, position: &dyn Fn(usize) -> Vec3) -> Vec<Heights> {
        if !self.bend() {
            return self.at_rest();
        }
        let all = self.of_sides(position);
        self.sides.iter().map(|&side| all[side]).collect()
    }

    /// The normal at a node of the sides of second degree around it, each by the inverse cubes of its edges there, as those of parabolas lean from that of the arc
    /// through their nodes.
    fn curved_normal(&self, node: usize, placed: &dyn Fn(usize) -> PlacedFace) -> Vec3 {
        let whole = &self.whole;
        let share = |&(f, corner): &(usize, usize)| {
            let (face, x) = (&whole.faces[f], placed(f));
            let edge = |other: usize| (x.nodes()[other] - x.nodes()[corner]).norm().powi(-3);
            let count = face.corners();
            let weight =
                edge((corner + 1) % count) * if whole.plane { 1.0 } else { edge((corner + count - 1) % count) };
            whole.area_vector(face, &x, corner).unit() * weight
        };
        whole.nodes[node].support.iter().fold(Vec3::zero(), |sum, of| sum + share(of)).unit()
    }

    /// For each node of the surface the planes in which it is held and in which its normal lies, since it ends there round: it leans there from a side as at the other end of an
    /// edge of that.
    pub fn mirrors(&self, surface: &FieldSurface, mesh: &Mesh) -> Vec<[Vec3; 2]> {
        let position = |node: usize| mesh.points[node];
        let round: Vec<Vec3> = (0..self.whole.nodes.len()).map(|node| self.round_normal(node, &position)).collect();
        let leans = self.leans(&|f| self.whole.faces[f].at_rest(mesh), &round, 1);
        let of = |number: usize| {
            let FieldNode { node, support, mirrors, .. } = &surface.nodes[number];
            let mut found = *mirrors;
            let own = surface.normal(number, |f| surface.faces[f].at_rest(mesh)).unit;
            for m in surface.held.iter().filter(|held| held.nodes.contains(node)).filter_map(|held| held.normal) {
                let ends = |&(f, _): &(usize, usize)| self.ends_in(m, (self.sides[f], *node), own, &leans, mesh);
                let (apart, free) = (mirrored(m, &found), found.iter().position(|mirror| *mirror == Vec3::zero()));
                if own.dot(m).abs() > FLAT && apart.norm() > ROUND && support.iter().all(ends) {
                    free.into_iter().for_each(|free| found[free] = apart.unit());
                }
            }
            found
        };
        (0..surface.nodes.len()).map(of).collect()
    }

    /// Whether the smooth surface with the normal `own` at a node of a side ends there in a plane with the normal `m`.
    fn ends_in(&self, m: Vec3, (side, node): (usize, usize), own: Vec3, leans: &[Vec<Lean>], mesh: &Mesh) -> bool {
        let (face, rest) = (&self.whole.faces[side], self.whole.faces[side].at_rest(mesh));
        let flat = mirrored(own, &[m, Vec3::zero()]).unit();
        let Some(corner) = (0..face.corners()).find(|&corner| face.corner_node(corner) == node) else {
            // A node in the middle of an edge of second degree, which may lean as much as a parabola leans from an arc.
            return flat.dot(own) > (ROUND * ROUND).cos();
        };
        let way = |end: usize, chord: &Chord| {
            let [here, there] = [end, 1 - end].map(|end| rest.nodes()[chord.corners[end]]);
            (there - here).unit()
        };
        let leave = self.edges[side].iter().enumerate().filter_map(|(k, chord)| {
            let end = chord.corners.iter().position(|other| *other == corner)?;
            Some((k, end, way(end, chord)))
        });
        let across = leave.max_by(|(.., one), (.., other)| one.dot(m).abs().total_cmp(&other.dot(m).abs()));
        across.is_some_and(|(k, end, d)| {
            let normal = self.whole.area_vector(face, &rest, corner).unit();
            let (here, itself) = ((normal - flat).dot(d), normal.dot(d));
            if itself.abs() > FLAT {
                // A parabola leans from its arc by little of what it leans itself.
                return here.abs() < ROUND * itself.abs();
            }
            let there = leans[side][k].beyond[1 - end];
            there.is_some_and(|there| (here - there).abs() < ROUND * here.abs().max(there.abs()))
        })
    }

    /// What the surface with these normals at its nodes leans beyond each edge of each side at its ends, along the edge from either.
    /// They go with this power of its length.
    fn leans(&self, placed: &dyn Fn(usize) -> PlacedFace, normals: &[Vec3], power: i32) -> Vec<Vec<Lean>> {
        let whole = &self.whole;
        let of = |f: usize| {
            let x = placed(f);
            let lean = |chord: &Chord| {
                let [a, b] = chord.corners;
                let d = x.nodes()[b] - x.nodes()[a];
                let ways = [d.unit(), -d.unit()];
                let own = chord.corners.map(|corner| whole.area_vector(&whole.faces[f], &x, corner).unit());
                let by = |end: usize| (own[end] - normals[whole.field[f][chord.corners[end]]]).dot(ways[end]);
                let beyond = [0, 1].map(|end| chord.goes_on[end].then(|| by(end)));
                Lean { beyond, own: own[0].dot(ways[0]) + own[1].dot(ways[1]), length: d.norm() }
            };
            self.edges[f].iter().map(lean).collect::<Vec<_>>()
        };
        let leans: Vec<Vec<Lean>> = (0..whole.faces.len()).map(of).collect();
        // Where the surface ends it goes on as at the other end, as long as it does so beyond that: what folds there is no arc.
        let ended = |chord: &Chord, lean: &Lean, end: usize| {
            let (None, Some(other)) = (lean.beyond[end], lean.beyond[1 - end]) else { return lean.beyond[end] };
            let along = |&[g, j, far]: &[usize; 3]| {
                Some(leans[g][j].beyond[far]? * (lean.length / leans[g][j].length).powi(power))
            };
            let beyond = chord.beyond[1 - end].iter().filter_map(along);
            let least = beyond.map(|lean| lean * other.signum()).reduce(f64::min);
            Some(least.map_or(other, |least| other.signum() * least.clamp(0.0, other.abs())))
        };
        let of = |(chord, lean): (&Chord, &Lean)| Lean { beyond: [0, 1].map(|end| ended(chord, lean, end)), ..*lean };
        self.edges.iter().zip(&leans).map(|(chords, leans)| chords.iter().zip(leans).map(of).collect()).collect()
    }

    /// The heights of each side: of the arc at whose ends normals lean by an angle `t` from those of a straight edge half of the length of that times `tan t/2`, and
    /// of edges of second degree what an arc has beyond them. None where they lean to two sides, of what is flat, and of one chord alone.
    fn of_sides(&self, position: &dyn Fn(usize) -> Vec3) -> Vec<Heights> {
        let whole = &self.whole;
        let placed = |f: usize| PlacedFace::new(whole.faces[f].nodes.iter().map(|&node| position(node)));
        let normals = |normal: &dyn Fn(usize) -> Vec3| (0..whole.nodes.len()).map(normal).collect::<Vec<Vec3>>();
        let round = normals(&|node| self.round_normal(node, position));
        let straight = self.leans(&placed, &round, 1);
        // Sides of second degree stay what they are before any motion.
        let curved =
            self.rest.is_empty().then(|| self.leans(&placed, &normals(&|node| self.curved_normal(node, &placed)), 3));
        let height = |f: usize, k: usize| {
            let lean = &straight[f][k];
            let beyond = lean.limited();
            if lean.own.abs() < beyond.abs() {
                return [lean.height(beyond), 0.0];
            }
            let Some(lean) = curved.as_ref().map(|curved| &curved[f][k]).filter(|_| whole.faces[f].kind.degree > 1)
            else {
                return [0.0; 2];
            };
            let beyond = lean.limited();
            [0.0, if beyond * lean.own < 0.0 && beyond.abs() < lean.own.abs() { lean.height(beyond) } else { 0.0 }]
        };
        let of = |f: usize| {
            if let (Some(false), Some(rest)) = (self.bends.get(f), self.rest.get(f)) {
                return rest.unwrap_or_default();
            }
            let mut rises = Rises::default();
            for (k, chord) in self.edges[f].iter().enumerate() {
                let [mut parabola, mut quartic] = height(f, k);
                if let Some(rest) = self.rest.get(f) {
                    let rest = rest.map_or(0.0, |rest| rest.parabola[k]);
                    let (change, counts) = (parabola - rest, STRAINED * chord.length);
                    parabola = rest + (change.abs() - counts).max(0.0).copysign(change);
                }
                if parabola != 0.0 {
                    quartic = -4.0 * parabola.powi(3) / straight[f][k].length.powi(2);
                }
                (rises.parabola[k], rises.quartic[k]) = (parabola, quartic);
            }
            rises
        };
        let all: Vec<Rises> = (0..whole.faces.len()).map(of).collect();
        // One chord alone is a chamfer.
        let goes_on = |chord: &Chord| chord.beyond.iter().flatten().any(|&[g, j, _]| !all[g].is_none(j));
        let kept = |f: usize| {
            let mut rises = all[f];
            for (k, _) in self.edges[f].iter().enumerate().filter(|(_, chord)| !goes_on(chord)) {
                (rises.parabola[k], rises.quartic[k]) = (0.0, 0.0);
            }
            (rises != Rises::default()).then_some(rises)
        };
        (0..all.len()).map(kept).collect()
    }
}

impl FieldSurface {
    /// How far the smooth surface that a face stands for rises above it at a place, outward, with the slopes of that along the reference
    /// coordinates: what it does over the edges of its side falls to zero over the side.
    pub(super) fn rise(&self, face: usize, arcs: &[Heights], xi: [f64; 2]) -> (f64, [f64; 2]) {
        let Some(heights) = arcs.get(face).copied().flatten() else { return (0.0, [0.0; 2]) };
        let face = &self.faces[face];
        let ([x, y], on_side) = face.on_side(xi);
        let (rise, slopes) = match face.kind.linear.nodes.len() {
            2 => {
                let [rise, slope] = over_edge(heights.of(0), x);
                (rise, [slope, 0.0])
            }
            3 => {
                let functions = ShapeFunctions::of(face.kind.linear, [x, y]);
                (0..3).fold((0.0, [0.0; 2]), |(rise, slopes), a| {
                    let (b, [h, q]) = ((a + 1) % 3, heights.of(a));
                    let ([one, other], [da, db]) =
                        ([functions.n[a], functions.n[b]], [functions.dn[a], functions.dn[b]]);
                    let (bow, across) = (4.0 * one * other, one - other);
                    let slope = |k: usize| {
                        let change = 4.0 * (da[k] * other + one * db[k]);
                        slopes[k] + change * (h + q * across * across) + bow * 2.0 * q * across * (da[k] - db[k])
                    };
                    (rise + bow * (h + q * across * across), [slope(0), slope(1)])
                })
            }
            _ => {
                // Between two edges that face each other, along their coordinate and across.
                let between = |[from, to]: [usize; 2], along: f64, across: f64| {
                    let [from, to] = [from, to].map(|edge| over_edge(heights.of(edge), along));
                    let mean = |i: usize| 0.5 * (from[i] + to[i]) + 0.5 * across * (to[i] - from[i]);
                    (mean(0), [mean(1), 0.5 * (to[0] - from[0])])
                };
                let ((one, by_one), (other, by_other)) = (between([0, 2], x, y), between([3, 1], y, x));
                (one + other, [by_one[0] + by_other[1], by_one[1] + by_other[0]])
            }
        };
        (rise, [0, 1].map(|a| slopes[0] * on_side[0][a] + slopes[1] * on_side[1][a]))
    }
}
