//! A rigid tool in space, drawn as if of glass: the contour of its tiles, where one looks to the eye and its neighbour
//! away from it, their borders and their sharp edges. What lies behind stays in sight.

use super::drawing::{Drawing, Stroke, polyline};
use super::palette::Color;
use super::view::View;
use std::collections::BTreeMap;

/// Neighbours whose normals have a smaller cosine meet in a sharp edge.
const SHARP: f64 = 0.8;
/// Corners nearer than this part of the tool's size are one.
const ALIKE: f64 = 1e-7;

/// A tile: its corners in turn, its outside where they run counter-clockwise.
pub type Tile = Vec<[f64; 3]>;
/// A corner on a fine lattice.
type Spot = [i64; 3];
/// The normals of the tiles at an edge, by its ends.
type Edges = BTreeMap<[Spot; 2], ([[f64; 3]; 2], Vec<[f64; 3]>)>;

/// Draws the lines of a tool that is made of tiles.
pub fn draw_shell(drawing: &mut Drawing, view: &View, tiles: &[Tile]) {
    let lines = edges(tiles).into_values().filter(|(_, normals)| is_drawn(view, normals));
    let path = lines.flat_map(|(ends, _)| polyline(&ends.map(|end| view.map(end)))).collect::<Vec<_>>();
    if !path.is_empty() {
        drawing.stroke(path, Stroke::full(Color::GREY, 0.9));
    }
}

fn edges(tiles: &[Tile]) -> Edges {
    let size = tiles.iter().flatten().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    let spot = |p: [f64; 3]| p.map(|x| (x / (ALIKE * size)).round() as i64);
    let mut edges = Edges::new();
    for tile in tiles {
        let normal = normal(tile);
        for i in 0..tile.len() {
            let ends = [tile[i], tile[(i + 1) % tile.len()]];
            let mut key = ends.map(spot);
            key.sort_unstable();
            if key[0] != key[1] {
                edges.entry(key).or_insert_with(|| (ends, Vec::new())).1.push(normal);
            }
        }
    }
    edges
}

fn is_drawn(view: &View, normals: &[[f64; 3]]) -> bool {
    let &[a, b] = normals else { return true };
    let looks_here = |n| view.projection.nearness(n) > 0.0;
    let cosine: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
    looks_here(a) != looks_here(b) || cosine < SHARP
}

/// The unit normal of a tile, by its two longest spans (Newell); zero where it has no area.
fn normal(tile: &Tile) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for i in 0..tile.len() {
        let (p, q) = (tile[i], tile[(i + 1) % tile.len()]);
        for (a, total) in sum.iter_mut().enumerate() {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            *total += (p[b] - q[b]) * (p[c] + q[c]);
        }
    }
    let length = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 { sum.map(|x| x / length) } else { sum }
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Rect;
    use super::super::view::{Projection, Window};
    use super::*;

    fn view() -> View {
        let frame = Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 };
        View { projection: Projection::Corner, window: Window { low: [-2.0; 2], high: [2.0; 2] }, frame }
    }

    /// A half cylinder of twelve strips about the z axis, from z = 0 to 1, open at its ends.
    fn vault() -> Vec<Tile> {
        let at = |i: usize, z: f64| {
            let (sin, cos) = (i as f64 * std::f64::consts::PI / 12.0).sin_cos();
            [cos, sin, z]
        };
        (0..12).map(|i| vec![at(i, 0.0), at(i, 1.0), at(i + 1, 1.0), at(i + 1, 0.0)]).collect()
    }

    #[test]
    fn a_vault_shows_its_borders_and_one_contour() {
        let view = view();
        let drawn = edges(&vault()).into_values().filter(|(_, normals)| is_drawn(&view, normals));
        let along: Vec<f64> = drawn.map(|(ends, _)| (ends[0][2] - ends[1][2]).abs()).collect();
        assert_eq!(along.iter().filter(|length| **length == 0.0).count(), 24, "the arcs at both ends");
        assert_eq!(along.iter().filter(|length| **length == 1.0).count(), 3, "two borders and the contour");
    }

    #[test]
    fn normals_follow_the_turn_of_the_corners() {
        let tile = vec![[0.0, 0.0, 5.0], [2.0, 0.0, 5.0], [2.0, 1.0, 5.0], [0.0, 1.0, 5.0]];
        assert_eq!(normal(&tile), [0.0, 0.0, 1.0]);
        assert_eq!(normal(&vec![[1.0; 3]; 3]), [0.0; 3]);
    }
}
