//! Stress vectors drawn to scale on the boundary they act on: the tip touches the body, the shaft lies outside it. In
//! the plane, where points follow each other along the boundary, a thin line joins the tails of neighbours so that the
//! distribution is seen.

use super::drawing::{Drawing, Point, Segment, Stroke, polygon, polyline};
use super::palette::Color;
use super::view::{Projection, View};

/// A vector that acts on a point of the boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrow {
    /// Where it acts.
    pub at: [f64; 3],
    /// The vector.
    pub vector: [f64; 3],
    /// What it belongs to; only neighbours of one contact are joined.
    pub group: usize,
}

/// Arrows shorter than this on the page are not drawn.
const SHORTEST: f64 = 0.8;

impl Arrow {
    /// Magnitude.
    pub fn size(&self) -> f64 {
        self.vector.iter().map(|x| x * x).sum::<f64>().sqrt()
    }
    /// Where its shaft begins, with `scale` lengths of space a unit of the vector.
    pub fn tail(&self, scale: f64) -> [f64; 3] {
        std::array::from_fn(|a| self.at[a] - scale * self.vector[a])
    }
}

/// Draws arrows of one colour with `scale` lengths of space a unit of the vector.
pub fn draw_arrows(drawing: &mut Drawing, view: &View, arrows: &[Arrow], scale: f64, color: Color) {
    let shafts: Vec<(Point, Point)> = arrows.iter().map(|a| (view.map(a.tail(scale)), view.map(a.at))).collect();
    let runs = if view.projection == Projection::Plane { runs(arrows, &shafts) } else { Vec::new() };
    for run in runs.into_iter().filter(|run| run.len() > 1) {
        let tails: Vec<Point> = run.iter().map(|&i| shafts[i].0).collect();
        drawing.stroke(polyline(&tails), Stroke::full(color, 0.7));
    }
    let head = head_size(&shafts);
    for &(tail, tip) in &shafts {
        draw_arrow(drawing, [tail, tip], head, color);
    }
}

/// One arrow on the page.
pub fn draw_arrow(drawing: &mut Drawing, [tail, tip]: [Point; 2], head: f64, color: Color) {
    let along = [tip[0] - tail[0], tip[1] - tail[1]];
    let length = along[0].hypot(along[1]);
    if !(SHORTEST..f64::INFINITY).contains(&length) {
        return;
    }
    let unit = along.map(|x| x / length);
    let head = head.min(0.6 * length);
    let neck = [tip[0] - head * unit[0], tip[1] - head * unit[1]];
    let side = |s: f64| [neck[0] - 0.32 * s * head * unit[1], neck[1] + 0.32 * s * head * unit[0]];
    drawing.stroke(vec![Segment::Move(tail), Segment::Line(neck)], Stroke::full(color, 0.9));
    drawing.fill(polygon(&[tip, side(1.0), side(-1.0)]), color);
}

/// Heads shrink where arrows stand close together.
fn head_size(shafts: &[(Point, Point)]) -> f64 {
    (1.2 * spacing(shafts).unwrap_or(f64::INFINITY)).clamp(3.0, 8.0)
}

/// The median distance of consecutive tips.
fn spacing(shafts: &[(Point, Point)]) -> Option<f64> {
    let distance = |w: &[(Point, Point)]| (w[1].1[0] - w[0].1[0]).hypot(w[1].1[1] - w[0].1[1]);
    let mut distances: Vec<f64> = shafts.windows(2).map(distance).collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied()
}

/// Runs of consecutive arrows of one group that stand as close as neighbours do. Where there is no stress a run ends,
/// with one such point on either side, so that the line of tails comes down to the boundary.
fn runs(arrows: &[Arrow], shafts: &[(Point, Point)]) -> Vec<Vec<usize>> {
    let reach = 4.0 * spacing(shafts).unwrap_or(0.0);
    let mut runs: Vec<Vec<usize>> = Vec::new();
    for i in 0..arrows.len() {
        let near = |&j: &usize| {
            let (a, b) = (shafts[i].1, shafts[j].1);
            let close = (a[0] - b[0]).hypot(a[1] - b[1]) <= reach;
            close && arrows[i].group == arrows[j].group && arrows[i].size() + arrows[j].size() > 0.0
        };
        match runs.last_mut() {
            Some(run) if run.last().is_some_and(near) => run.push(i),
            _ => runs.push(vec![i]),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::super::drawing::{Item, Rect};
    use super::super::view::Window;
    use super::*;

    fn arrow(x: f64, group: usize) -> Arrow {
        Arrow { at: [x, 0.0, 0.0], vector: [0.0, 3.0, 4.0], group }
    }

    #[test]
    fn the_tip_touches_and_the_tail_is_to_scale() {
        assert_eq!(arrow(1.0, 0).size(), 5.0);
        assert_eq!(arrow(1.0, 0).tail(2.0), [1.0, -6.0, -8.0]);
    }

    #[test]
    fn runs_end_at_gaps_and_at_other_contacts() {
        let arrows: Vec<Arrow> =
            [(0.0, 0), (1.0, 0), (2.0, 0), (9.0, 0), (10.0, 0), (11.0, 1)].map(|(x, g)| arrow(x, g)).to_vec();
        let shafts: Vec<_> = arrows.iter().map(|a| ([a.at[0], 5.0], [a.at[0], 0.0])).collect();
        assert_eq!(runs(&arrows, &shafts), [vec![0, 1, 2], vec![3, 4], vec![5]]);
    }

    #[test]
    fn runs_come_down_to_the_boundary_where_stress_ends() {
        let mut arrows: Vec<Arrow> = (0..8).map(|i| arrow(f64::from(i), 0)).collect();
        [0, 1, 4, 5, 6].into_iter().for_each(|i| arrows[i].vector = [0.0; 3]);
        let shafts: Vec<_> = arrows.iter().map(|a| ([a.at[0], 5.0], [a.at[0], 0.0])).collect();
        assert_eq!(runs(&arrows, &shafts), [vec![0], vec![1, 2, 3, 4], vec![5], vec![6, 7]]);
    }

    #[test]
    fn tails_are_joined_in_the_plane_only() {
        let arrows: Vec<Arrow> = (0..8).map(|i| arrow(f64::from(i), 0)).collect();
        let lines = |projection| {
            let frame = Rect { x: 0.0, y: 0.0, width: 100.0, height: 100.0 };
            let view = View { projection, window: Window { low: [0.0; 2], high: [10.0; 2] }, frame };
            let mut drawing = Drawing::new(100.0, 100.0);
            draw_arrows(&mut drawing, &view, &arrows, 1.0, Color::ARROW);
            let long = |item: &&Item| matches!(item, Item::Path { path, stroke: Some(_), .. } if path.len() > 2);
            drawing.items.iter().filter(long).count()
        };
        assert_eq!([Projection::Plane, Projection::Corner].map(lines), [1, 0]);
    }

    #[test]
    fn no_arrow_is_drawn_for_nothing() {
        let mut drawing = Drawing::new(10.0, 10.0);
        draw_arrow(&mut drawing, [[1.0, 1.0], [1.0, 1.0]], 5.0, Color::ARROW);
        draw_arrow(&mut drawing, [[1.0, 1.0], [f64::NAN, 1.0]], 5.0, Color::ARROW);
        assert!(drawing.items.is_empty());
    }
}
