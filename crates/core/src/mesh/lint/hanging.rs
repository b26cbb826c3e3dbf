//! Nodes that hang: inside an edge or face of a neighbour that does not have them, so that the two gape under load.

use super::{LintFinding, LintKind, LintSeverity, words};
use crate::mesh::{Faces, Mesh, Side};
use crate::tensor::Vec3;
use std::collections::HashMap;

/// Distance from an edge or face, and from its corners, over its size, within which a node is on it.
const ON: f64 = 1e-6;

/// Nodes of one body that hang; `same` says whether two cells belong to one.
pub(super) fn check(mesh: &Mesh, faces: &Faces, same: impl Fn(usize, usize) -> bool) -> Option<LintFinding> {
    let outer = faces.outer();
    let shapes: Vec<Vec<usize>> = outer.iter().map(|&side| corners(mesh, side)).collect();
    let sizes: Vec<f64> = shapes.iter().map(|shape| reach(mesh, shape)).collect();
    let grid = sizes.iter().copied().filter(|size| size.is_finite()).sum::<f64>() / sizes.len().max(1) as f64;
    if !(grid > 0.0 && grid.is_finite()) {
        return None;
    }
    let boxed = |x: Vec3| x.0.map(|x| (x / grid).floor() as i64);
    // Nodes of the boundary by boxes, each with a cell that has it.
    let mut boxes = HashMap::<[i64; 3], Vec<(usize, usize)>>::new();
    let mut known = vec![false; mesh.points.len()];
    for (side, shape) in outer.iter().zip(&shapes) {
        for &node in shape.iter().filter(|&&node| mesh.points[node].is_finite()) {
            if !std::mem::replace(&mut known[node], true) {
                boxes.entry(boxed(mesh.points[node])).or_default().push((node, side.cell));
            }
        }
    }
    let (mut nodes, mut cells) = (Vec::new(), Vec::new());
    for ((side, shape), size) in outer.iter().zip(&shapes).zip(sizes) {
        let places = || shape.iter().map(|&node| mesh.points[node]);
        // A side as long as thousands of others would be looked at box by box.
        if !places().all(|x| x.is_finite()) || size > 100.0 * grid {
            continue;
        }
        let end = |pick: fn(f64, f64) -> f64, slack: f64| {
            let corner = |i: usize| places().map(|x| x[i]).reduce(pick).unwrap_or(0.0) + slack;
            boxed(Vec3(std::array::from_fn(corner)))
        };
        let (low, high) = (end(f64::min, -ON * size), end(f64::max, ON * size));
        for key in (low[0]..=high[0])
            .flat_map(|i| (low[1]..=high[1]).flat_map(move |j| (low[2]..=high[2]).map(move |k| [i, j, k])))
        {
            for &(node, cell) in boxes.get(&key).into_iter().flatten() {
                let corners: Vec<Vec3> = places().collect();
                if !shape.contains(&node) && lies_on(mesh.points[node], &corners, ON * size) && same(cell, side.cell) {
                    nodes.push(node);
                    cells.push(side.cell);
                }
            }
        }
    }
    for list in [&mut nodes, &mut cells] {
        list.sort_unstable();
        list.dedup();
    }
    let text = format!(
        "nodes hang in a body: {} in the middle of an edge or face of a neighbour, which does not have them and gapes there under load, at {}; \
         mesh both sides alike, or make two bodies of them and tie them",
        words::count(nodes.len(), "node") + " lie",
        words::nodes(mesh, &nodes)
    );
    (!nodes.is_empty()).then_some(LintFinding {
        kind: LintKind::Hanging,
        severity: LintSeverity::Warning,
        cells,
        nodes,
        text,
    })
}

fn corners(mesh: &Mesh, side: Side) -> Vec<usize> {
    let (kind, nodes) = mesh.side(side);
    nodes.take(kind.linear.nodes.len()).collect()
}

fn reach(mesh: &Mesh, shape: &[usize]) -> f64 {
    let from = mesh.points[shape[0]];
    shape.iter().map(|&node| (mesh.points[node] - from).norm()).fold(0.0, f64::max)
}

/// Whether a place is on an edge, or on a face taken as triangles about its first corner, and in none of the corners.
fn lies_on(x: Vec3, corners: &[Vec3], slack: f64) -> bool {
    if corners.iter().any(|&corner| (x - corner).norm() <= slack) {
        return false;
    }
    if let [a, b] = *corners {
        let along = b - a;
        let s = (x - a).dot(along) / along.dot(along);
        return (0.0..=1.0).contains(&s) && (x - a - along * s).norm() <= slack;
    }
    (2..corners.len()).any(|k| {
        let [p, q, to] = [corners[k - 1] - corners[0], corners[k] - corners[0], x - corners[0]];
        let normal = p.cross(q);
        let size = normal.dot(normal);
        let [s, t] = [to.cross(q).dot(normal) / size, p.cross(to).dot(normal) / size];
        let inside = s >= -ON && t >= -ON && s + t <= 1.0 + ON;
        inside && to.dot(normal).abs() <= slack * size.sqrt()
    })
}
