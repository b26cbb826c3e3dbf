//! The outline of a rigid tool, hatched on the side of its material, which is the left of the way it is drawn.

use super::drawing::{Drawing, Point, Stroke, polyline};
use super::palette::Color;
use super::view::View;

/// Distance between hatch lines, on the page.
const PITCH: f64 = 5.0;
/// Their length.
const LENGTH: f64 = 7.0;

/// Draws a profile given as a fine broken line.
pub fn draw_outline(drawing: &mut Drawing, view: &View, profile: &[[f64; 3]]) {
    let points: Vec<Point> = profile.iter().map(|&p| view.map(p)).collect();
    for (foot, tip) in hatch(&points) {
        drawing.stroke(polyline(&[foot, tip]), Stroke::full(Color::GREY, 0.7));
    }
    drawing.stroke(polyline(&points), Stroke::full(Color::BLACK, 1.4));
}

/// Feet and tips of the hatch: at even distances along the line, leaning back by half a right angle.
fn hatch(points: &[Point]) -> Vec<(Point, Point)> {
    let mut lines = Vec::new();
    let mut next = 0.5 * PITCH;
    for pair in points.windows(2) {
        let along = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let length = along[0].hypot(along[1]);
        if !(length > 0.0 && length < 1e6) {
            continue;
        }
        let unit = along.map(|x| x / length);
        // Left of the way in space is right-handed; the page counts y downwards.
        let left = [unit[1], -unit[0]];
        while next < length {
            let foot = [pair[0][0] + next * unit[0], pair[0][1] + next * unit[1]];
            let reach = LENGTH * std::f64::consts::FRAC_1_SQRT_2;
            lines.push((foot, [0, 1].map(|a| foot[a] + reach * (left[a] - unit[a]))));
            next += PITCH;
        }
        next -= length;
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hatch_is_on_the_left() {
        // To the right in space and on the page: the left is up, which is less y on the page.
        let lines = hatch(&[[0.0, 100.0], [12.0, 100.0], [50.0, 100.0]]);
        assert_eq!(lines.len(), 10);
        assert!(lines.iter().all(|(foot, tip)| foot[1] == 100.0 && tip[1] < 100.0));
        let feet: Vec<f64> = lines.iter().map(|(foot, _)| foot[0]).collect();
        assert!(feet.windows(2).all(|w| (w[1] - w[0] - PITCH).abs() < 1e-9), "{feet:?}");
    }

    #[test]
    fn odd_points_do_no_harm() {
        assert!(hatch(&[[0.0, 0.0], [0.0, 0.0], [f64::NAN, 1.0]]).is_empty());
    }
}
