//! A framed area with marked axes, and the map from data to the page.

use super::drawing::{Anchor, Drawing, Label, Point, Rect, Stroke, polyline};
use super::palette::Color;
use super::text;
use super::ticks::{Scale, Ticks};

/// Size of the type of labels at marks.
pub const SMALL: f64 = 11.0;
/// Size of the type of titles of axes and legends.
pub const MEDIUM: f64 = 12.5;
/// Size of the type of the titles of panels.
pub const LARGE: f64 = 14.0;
/// Length of a mark.
const MARK: f64 = 4.0;

/// One axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Its title.
    pub title: String,
    /// How it is divided.
    pub scale: Scale,
    /// Its marks.
    pub ticks: Ticks,
}

/// The framed area.
#[derive(Debug, Clone, PartialEq)]
pub struct Axes {
    /// Where on the page.
    pub frame: Rect,
    /// The axis to the right.
    pub x: Axis,
    /// The axis upwards.
    pub y: Axis,
}

impl Axis {
    /// Place of a value along the axis, 0 to 1 within its range.
    fn fraction(&self, value: f64) -> f64 {
        let [low, high] = self.ticks.range;
        match self.scale {
            Scale::Linear => (value - low) / (high - low),
            // Values at or below zero go far below the axis instead of nowhere.
            Scale::Log => (value.max(f64::MIN_POSITIVE) / low).ln() / (high / low).ln(),
        }
    }
    /// The widest label at a mark.
    pub fn label_width(&self) -> f64 {
        self.ticks.major.iter().map(|(_, label)| text::width(label, SMALL, false)).fold(0.0, f64::max)
    }
    fn power(&self) -> Option<String> {
        let exponent = self.ticks.exponent;
        (exponent != 0).then(|| super::ticks::minus(&format!("× 10^{{{exponent}}}")))
    }
}

impl Axes {
    /// Space that labels and titles need on the left of the frame.
    pub fn left_margin(y: &Axis) -> f64 {
        let title = if y.title.is_empty() { 0.0 } else { 1.5 * MEDIUM };
        y.label_width() + title + 10.0
    }
    /// Space that labels and titles need below the frame.
    pub fn bottom_margin(x: &Axis) -> f64 {
        let title = if x.title.is_empty() { 0.0 } else { 1.6 * MEDIUM };
        SMALL + title + 10.0
    }
    /// Place of a point of the data on the page.
    pub fn map(&self, [x, y]: [f64; 2]) -> Point {
        let Rect { x: left, width, height, .. } = self.frame;
        [left + width * self.x.fraction(x), self.frame.bottom() - height * self.y.fraction(y)]
    }
    /// Draws pale lines at the marks, to be covered by the data.
    pub fn draw_grid(&self, drawing: &mut Drawing) {
        let stroke = Stroke::full(Color::PALE, 0.7);
        for &(value, _) in &self.x.ticks.major {
            let x = self.along_x(value);
            drawing.stroke(polyline(&[[x, self.frame.y], [x, self.frame.bottom()]]), stroke);
        }
        for &(value, _) in &self.y.ticks.major {
            let y = self.along_y(value);
            drawing.stroke(polyline(&[[self.frame.x, y], [self.frame.right(), y]]), stroke);
        }
    }
    /// Draws the frame, the marks and the titles.
    pub fn draw_frame(&self, drawing: &mut Drawing) {
        drawing.stroke(self.frame.path(), Stroke::full(Color::BLACK, 0.9));
        self.draw_x(drawing);
        self.draw_y(drawing);
    }
    fn along_x(&self, value: f64) -> f64 {
        self.frame.x + self.frame.width * self.x.fraction(value)
    }
    fn along_y(&self, value: f64) -> f64 {
        self.frame.bottom() - self.frame.height * self.y.fraction(value)
    }
    fn draw_x(&self, drawing: &mut Drawing) {
        let bottom = self.frame.bottom();
        let mark = |value, length| polyline(&[[self.along_x(value), bottom], [self.along_x(value), bottom - length]]);
        for &value in &self.x.ticks.minor {
            drawing.stroke(mark(value, 0.6 * MARK), Stroke::full(Color::BLACK, 0.6));
        }
        for (value, label) in &self.x.ticks.major {
            drawing.stroke(mark(*value, MARK), Stroke::full(Color::BLACK, 0.9));
            let at = [self.along_x(*value), bottom + SMALL + 5.0];
            drawing.label(Label::new(at, label, SMALL).anchored(Anchor::Middle));
        }
        let below = bottom + SMALL + 7.0 + 1.3 * MEDIUM;
        let middle = self.frame.x + 0.5 * self.frame.width;
        drawing.label(Label::new([middle, below], &self.x.title, MEDIUM).anchored(Anchor::Middle));
        if let Some(power) = self.x.power() {
            drawing.label(Label::new([self.frame.right(), below], power, SMALL).anchored(Anchor::End));
        }
    }
    fn draw_y(&self, drawing: &mut Drawing) {
        let left = self.frame.x;
        let mark = |value, length| polyline(&[[left, self.along_y(value)], [left + length, self.along_y(value)]]);
        for &value in &self.y.ticks.minor {
            drawing.stroke(mark(value, 0.6 * MARK), Stroke::full(Color::BLACK, 0.6));
        }
        for (value, label) in &self.y.ticks.major {
            drawing.stroke(mark(*value, MARK), Stroke::full(Color::BLACK, 0.9));
            let at = [left - 6.0, self.along_y(*value) + 0.36 * SMALL];
            drawing.label(Label::new(at, label, SMALL).anchored(Anchor::End));
        }
        let at = [left - self.y.label_width() - 13.0, self.frame.y + 0.5 * self.frame.height];
        drawing.label(Label::new(at, &self.y.title, MEDIUM).anchored(Anchor::Middle).upright());
        if let Some(power) = self.y.power() {
            drawing.label(Label::new([left, self.frame.y - 6.0], power, SMALL));
        }
    }
}
