//! From space to the page: plane models as they are, solid ones seen from the corner between their front, right and top
//! sides, in true proportions.

use super::drawing::{Point, Rect};

/// How space is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Projection {
    /// x to the right, y upwards.
    Plane,
    /// From above the front right corner, without perspective: y stands upright, x goes to the right, z comes towards
    /// the eye on the left.
    Corner,
}

/// A window of projected space: left, low, right, high.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Least projected coordinates.
    pub low: [f64; 2],
    /// Largest projected coordinates.
    pub high: [f64; 2],
}

/// A window shown in a frame of the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// How space is looked at.
    pub projection: Projection,
    /// What is seen.
    pub window: Window,
    /// Where it is shown.
    pub frame: Rect,
}

impl Projection {
    /// Projected coordinates of a point or vector.
    pub fn flat(self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        match self {
            Self::Plane => [x, y],
            Self::Corner => [0.829 * x - 0.559 * z, -0.254 * x + 0.891 * y - 0.376 * z],
        }
    }
    /// How near a point is to the eye.
    pub fn nearness(self, [x, y, z]: [f64; 3]) -> f64 {
        match self {
            Self::Plane => 0.0,
            // The direction normal to both rows of `flat`: 27 degrees above the horizon.
            Self::Corner => 0.498 * x + 0.454 * y + 0.739 * z,
        }
    }
}

impl Window {
    /// The least window around points; unit size where there are none.
    pub fn around(points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let empty = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
        let finite = points.into_iter().filter(|p| p.iter().all(|x| x.is_finite()));
        let window = finite.fold(empty, |w, p| Self {
            low: [w.low[0].min(p[0]), w.low[1].min(p[1])],
            high: [w.high[0].max(p[0]), w.high[1].max(p[1])],
        });
        if window.low[0].is_finite() { window } else { Self { low: [0.0; 2], high: [1.0; 2] } }
    }
    /// Width and height.
    pub fn size(&self) -> [f64; 2] {
        [self.high[0] - self.low[0], self.high[1] - self.low[1]]
    }
    /// The window of the given size about the same centre.
    pub fn resized(&self, size: [f64; 2]) -> Self {
        let center = [0, 1].map(|a| 0.5 * (self.low[a] + self.high[a]));
        Self {
            low: [center[0] - 0.5 * size[0], center[1] - 0.5 * size[1]],
            high: [center[0] + 0.5 * size[0], center[1] + 0.5 * size[1]],
        }
    }
}

impl View {
    /// Points of the page in a unit of length.
    pub fn scale(&self) -> f64 {
        self.frame.width / self.window.size()[0]
    }
    /// Place on the page of projected coordinates.
    pub fn place(&self, [x, y]: [f64; 2]) -> Point {
        let scale = self.scale();
        [self.frame.x + scale * (x - self.window.low[0]), self.frame.bottom() - scale * (y - self.window.low[1])]
    }
    /// Place on the page of a point of space.
    pub fn map(&self, point: [f64; 3]) -> Point {
        self.place(self.projection.flat(point))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corner_view_keeps_lengths_at_right_angles_to_the_eye() {
        let p = Projection::Corner;
        let rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| (p.flat(e), p.nearness(e)));
        let dot = |f: &dyn Fn(usize) -> f64, g: &dyn Fn(usize) -> f64| (0..3).map(|i| f(i) * g(i)).sum::<f64>();
        let (right, up, eye) = (|i: usize| rows[i].0[0], |i: usize| rows[i].0[1], |i: usize| rows[i].1);
        for (a, b) in [(&right as &dyn Fn(usize) -> f64, &up as &dyn Fn(usize) -> f64), (&right, &eye), (&up, &eye)] {
            assert!(dot(a, b).abs() < 0.01 && (dot(a, a) - 1.0).abs() < 0.02 && (dot(b, b) - 1.0).abs() < 0.02);
        }
        for (side, outward) in [("right", [1.0, 0.0, 0.0]), ("top", [0.0, 1.0, 0.0]), ("front", [0.0, 0.0, 1.0])] {
            assert!(p.nearness(outward) > 0.4, "the {side} side of a box is seen");
        }
        assert!(p.flat([0.0, 1.0, 0.0])[0] == 0.0 && p.flat([0.0, 1.0, 0.0])[1] > 0.0, "y stands upright");
        assert!(right(0) > 0.0, "x goes to the right");
    }

    #[test]
    fn windows_and_frames_correspond() {
        let window = Window::around([[0.0, 0.0], [2.0, 1.0], [f64::NAN, 9.0]]);
        let frame = Rect { x: 10.0, y: 20.0, width: 200.0, height: 100.0 };
        let view = View { projection: Projection::Plane, window, frame };
        assert_eq!(view.map([0.0, 0.0, 5.0]), [10.0, 120.0]);
        assert_eq!(view.map([2.0, 1.0, 5.0]), [210.0, 20.0]);
        assert_eq!(window.resized([4.0, 4.0]).low, [-1.0, -1.5]);
    }
}
