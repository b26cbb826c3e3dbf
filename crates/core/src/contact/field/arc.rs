//! The smooth surface that faces with straight edges stand for: arcs over their edges, to which gaps are measured.
//!
//! The chords of a circle lie inside it by their sagitta, by two thirds of that in the mean, and sides that fit would be apart or inside one another by
//! as much. The height of the arc over an edge follows from the normals at its ends before any motion, those of a circle or a sphere through the
//! nodes around (Max, J. Graphics Tools 4(2), 1999); over a face it is carried by the functions of second degree of the middles of its edges, as on
//! a curved patch between averaged normals (Vlachos, Peters, Boyd and Mitchell, Curved PN triangles, 2001), to leading order. It moves with the face.

use super::face::{CORNERS, FieldFace, PlacedFace, ShapeFunctions};
use super::surface::{ALONE, FieldNode, FieldSurface};
use crate::mesh::{ALONG, Mesh, Side, arc_height, round_share};
use crate::tensor::Vec3;
use std::collections::BTreeMap;

/// Lean of a normal up to which a surface is flat.
const FLAT: f64 = 1e-6;

impl FieldSurface {
    /// The normal at a node of the sphere, in the plane of the circle, through it and the corners beside it before any motion: the sum of the
    /// normals of its faces over the products of the lengths of their edges there (Max, J. Graphics Tools 4(2), 1999), however long these are.
    fn round_normal(&self, node: usize, mesh: &Mesh) -> Vec3 {
        let FieldNode { support, on_axis, .. } = &self.nodes[node];
        if let Some(flat) = self.plane.then(|| self.flat_beside(node, mesh)).flatten() {
            return flat;
        }
        let mut sum = Vec3::zero();
        for &(f, corner) in support {
            let (face, count) = (&self.faces[f], self.faces[f].corners());
            let x = |corner: usize| mesh.points[face.corner_node(corner % count)];
            let edges = match self.plane {
                true => [x(1) - x(0), Vec3::axis(2)],
                false => [x(corner + 1) - x(corner), x(corner + count - 1) - x(corner)],
            };
            sum += round_share(edges[0].cross(edges[1]), &edges);
        }
        if *on_axis {
            sum[0] = 0.0;
        }
        sum.unit()
    }

    /// Of a node in the plane at which a curve in chords leaves what is flat the normal of that: the faces turn there by half of what they turn
    /// at the next node on one side, and on the other not at all.
    fn flat_beside(&self, node: usize, mesh: &Mesh) -> Option<Vec3> {
        let &[one, other] = &self.nodes[node].support[..] else { return None };
        let normal = |f: usize| self.middle_normal(&self.faces[f], &self.faces[f].at_rest(mesh));
        let turn = |f: usize, g: usize| normal(f).cross(normal(g)).norm();
        let here = turn(one.0, other.0);
        let beyond = |(f, corner): (usize, usize)| {
            let beside = self.nodes[self.field[f][1 - corner]].support.iter().find(|(g, _)| *g != f);
            beside.map(|(g, _)| turn(f, *g))
        };
        let leaves = |flat: (usize, usize), round: (usize, usize)| {
            let [flat_on, round_on] = [beyond(flat)?, beyond(round)?];
            (flat_on < ALONE * here && round_on > here).then(|| normal(flat.0))
        };
        leaves(one, other).or_else(|| leaves(other, one))
    }

    /// How far the smooth surface that it stands for rises above the middles of the edges of each side with straight edges, outward: of the
    /// arc over an edge, or the parabola, at whose ends normals lean by an angle `t` from those of the side, half of its length times
    /// `tan t/2`. None where they lean to two sides, of what is flat, of one chord alone, and of edges of second degree that follow the
    /// surface themselves. Where the surface ends it goes on as at the other end of the edge.
    pub(super) fn heights(&self, mesh: &Mesh) -> Vec<Option<[f64; CORNERS]>> {
        let mut whole = Self { plane: self.plane, revolves: self.revolves, ..Self::default() };
        let mut sides: Vec<Side> = self.faces.iter().map(|face| face.side).collect();
        sides.sort_unstable();
        sides.dedup();
        whole.faces = sides.iter().map(|&side| FieldFace::new(mesh, side)).collect();
        whole.number(mesh, &[]);
        let placed = |f: usize| whole.faces[f].at_rest(mesh);
        let normals: Vec<Vec3> = (0..whole.nodes.len()).map(|node| whole.round_normal(node, mesh)).collect();
        let middle = |f: usize| whole.faces[f].shape(whole.faces[f].middle()).value(placed(f).nodes());
        let height = |f: usize, rest: &PlacedFace, [a, b]: [usize; 2]| {
            let d = rest.nodes()[b] - rest.nodes()[a];
            // What the surface leans beyond the side along an edge from a corner, unknown where it ends there; what the side does itself.
            let lean = |corner: usize, d: Vec3| {
                let (node, x) = (whole.field[f][corner], rest.nodes()[corner]);
                let goes_on = |&(other, _): &(usize, usize)| (middle(other) - x).dot(d) < 0.0;
                let own = whole.area_vector(&whole.faces[f], rest, corner).unit();
                let by = (own - normals[node]).dot(d);
                (whole.nodes[node].support.iter().any(goes_on).then_some(by), own.dot(d))
            };
            let ((from, own_from), (to, own_to)) = (lean(a, d), lean(b, -d));
            let [from, to] = [from.or(to), to.or(from)].map(Option::unwrap_or_default);
            // The mean, but no more than twice the lesser: flat faces are flat up to where a curve begins (the limiter of van Leer, 1977).
            let (least, length) = (from.abs().min(to.abs()), d.norm());
            let lean = (0.5 * (from + to).abs()).min(2.0 * least);
            let sine = (lean / length).min(1.0);
            let stands_off = from * to > 0.0 && sine > FLAT && (own_from + own_to).abs() < lean;
            if stands_off { from.signum() * arc_height(length, sine) } else { 0.0 }
        };
        let of = |f: usize| {
            let (rest, count, mut heights) = (placed(f), whole.faces[f].corners(), [0.0; CORNERS]);
            let edges = if count == 2 { 1 } else { count };
            (0..edges).for_each(|k| heights[k] = height(f, &rest, [k, (k + 1) % count]));
            (heights != [0.0; CORNERS]).then_some(heights)
        };
        let mut all: Vec<_> = (0..sides.len()).map(of).collect();
        // One chord alone is a chamfer.
        let ends =
            |f: usize, k: usize| [k, (k + 1) % whole.faces[f].corners()].map(|corner| whole.faces[f].nodes[corner]);
        let ways = |f: usize| {
            let raised =
                all[f].iter().flat_map(|heights| heights.iter().enumerate()).filter(|(_, height)| **height != 0.0);
            raised.map(move |(k, _)| ends(f, k))
        };
        let mut beyond: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for [a, b] in (0..sides.len()).flat_map(ways) {
            [(a, b), (b, a)].into_iter().for_each(|(node, other)| beyond.entry(node).or_default().push(other));
        }
        let goes_on = |[node, other]: [usize; 2]| {
            let way = (mesh.points[node] - mesh.points[other]).unit();
            let along = |to: &usize| (mesh.points[*to] - mesh.points[node]).unit().dot(way) > ALONG;
            beyond[&node].iter().any(along)
        };
        for (f, found) in all.iter_mut().enumerate() {
            let Some(heights) = found else { continue };
            for (k, height) in heights.iter_mut().enumerate().filter(|(_, height)| **height != 0.0) {
                let [a, b] = ends(f, k);
                if !goes_on([a, b]) && !goes_on([b, a]) {
                    *height = 0.0;
                }
            }
            if *heights == [0.0; CORNERS] {
                *found = None;
            }
        }
        self.faces.iter().map(|face| sides.binary_search(&face.side).ok().and_then(|f| all[f])).collect()
    }

    /// How far the smooth surface that a face stands for rises above it at a place, outward, with the slopes of that along the reference
    /// coordinates: parabolas over the edges of its side, that fall to zero over the side.
    pub(super) fn rise(&self, face: usize, xi: [f64; 2]) -> (f64, [f64; 2]) {
        let Some(heights) = self.arcs[face] else { return (0.0, [0.0; 2]) };
        let face = &self.faces[face];
        let ([x, y], on_side) = face.on_side(xi);
        let (rise, slopes) = match face.kind.linear.nodes.len() {
            2 => (heights[0] * (1.0 - x * x), [-2.0 * x * heights[0], 0.0]),
            3 => {
                let functions = ShapeFunctions::of(face.kind.linear, [x, y]);
                (0..3).fold((0.0, [0.0; 2]), |(rise, slopes), a| {
                    let (b, h) = ((a + 1) % 3, 4.0 * heights[a]);
                    let [one, other] = [functions.n[a], functions.n[b]];
                    let slope = |k: usize| slopes[k] + h * (functions.dn[a][k] * other + one * functions.dn[b][k]);
                    (rise + h * one * other, [slope(0), slope(1)])
                })
            }
            _ => {
                let middle = |[from, to]: [f64; 2]| [0.5 * (from + to), 0.5 * (to - from)];
                let [[one, leans], [other, tilts]] =
                    [middle([heights[0], heights[2]]), middle([heights[3], heights[1]])];
                let (one, other, u, v) = (one + leans * y, other + tilts * x, 1.0 - x * x, 1.0 - y * y);
                (u * one + v * other, [-2.0 * x * one + v * tilts, u * leans - 2.0 * y * other])
            }
        };
        (rise, [0, 1].map(|a| slopes[0] * on_side[0][a] + slopes[1] * on_side[1][a]))
    }
}
