//! The legends below a picture of meshes: an arrow of a round value, and a colour bar.

use super::arrows::{Arrow, draw_arrow};
use super::axes::SMALL;
use super::drawing::{Anchor, Drawing, Label, Point, Rect, Stroke, polyline};
use super::palette::{self, Color};
use super::panels::{Extreme, Layout, Panels};
use super::text;
use super::ticks::{self, Scale, minus, round_down, short, ticks};
use super::view::Projection;

/// Height of the row of legends.
const HEIGHT: f64 = 48.0;
/// Length of the colour bar and number of its steps.
const BAR: f64 = 220.0;
const STEPS: usize = 64;

/// Four digits of a number.
fn rounded(x: f64) -> String {
    if x == 0.0 || (1e-3..1e5).contains(&x.abs()) {
        let digits = (3 - x.abs().max(1e-3).log10().floor() as i32).clamp(0, 6) as usize;
        let text = format!("{x:.digits$}");
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    } else {
        format!("{x:.3e}")
    }
}

impl Panels<'_> {
    fn has_arrows(&self) -> bool {
        self.strongest() > 0.0
    }
    /// The largest stress vector of all scenes.
    pub(super) fn strongest(&self) -> f64 {
        self.scenes.iter().flat_map(|s| &s.arrows).map(Arrow::size).fold(0.0, f64::max)
    }
    fn has_field(&self) -> bool {
        self.scenes.iter().any(|s| s.field.is_some())
    }
    /// Width that the legends need; zero when there are none.
    pub(super) fn legend_width(&self) -> f64 {
        let part = |has: bool, name: &str| if has { 260.0 + text::width(name, SMALL, false) } else { 0.0 };
        let extremes =
            self.extremes_in_words().iter().map(|words| text::width(words, SMALL, false)).fold(0.0, f64::max);
        let field = part(self.has_field(), &self.field_name).max(if self.has_field() { extremes + 20.0 } else { 0.0 });
        // Each stands in the middle of an equal part of the page.
        let arrows = part(self.has_arrows(), &self.arrow_name);
        if arrows > 0.0 && field > 0.0 { 2.0 * arrows.max(field) } else { arrows + field }
    }
    /// Height of the row of legends.
    pub(super) fn legend_height(&self) -> f64 {
        let extremes = if self.has_field() { 2.0 * (SMALL + 3.0) + 2.0 } else { 0.0 };
        if self.legend_width() > 0.0 { HEIGHT + extremes } else { 0.0 }
    }
    /// Draws the legends in the row at the bottom of the page.
    pub(super) fn draw_legends(&self, drawing: &mut Drawing, layout: &Layout) {
        let y = drawing.height - self.legend_height() + 0.5 * HEIGHT;
        let (arrows, field) = (self.has_arrows(), self.has_field());
        let parts = f64::from(u8::from(arrows) + u8::from(field));
        let mut x = drawing.width / (2.0 * parts).max(1.0);
        if arrows {
            self.draw_arrow_legend(drawing, [x, y], layout);
            x += drawing.width / parts;
        }
        if field {
            self.draw_color_bar(drawing, [x, y], layout.range);
        }
    }
    /// An arrow of a round value with that value beside it.
    fn draw_arrow_legend(&self, drawing: &mut Drawing, [x, y]: Point, layout: &Layout) {
        let value = round_down(self.strongest());
        let length = value * layout.arrow_scale * layout.scale;
        let text = format!("{}   {}", short(value), self.arrow_name);
        let start = x - 0.5 * (length + 8.0 + text::width(&text, SMALL, false));
        draw_arrow(drawing, [[start, y], [start + length, y]], 8.0, Color::ARROW);
        drawing.label(Label::new([start + length + 8.0, y + 0.36 * SMALL], text, SMALL));
    }
    fn draw_color_bar(&self, drawing: &mut Drawing, [x, y]: Point, range: [f64; 2]) {
        let bar = Rect { x: x - 0.5 * BAR, y: y - 8.0, width: BAR, height: 10.0 };
        for i in 0..STEPS {
            let width = BAR / STEPS as f64;
            let part = Rect { x: bar.x + width * i as f64, width, ..bar };
            drawing.tile(part.path(), palette::field((i as f64 + 0.5) / STEPS as f64));
        }
        drawing.stroke(bar.path(), Stroke::full(Color::BLACK, 0.7));
        let marks = ticks(Scale::Linear, range, 5, false);
        for (value, label) in &marks.major {
            let at = bar.x + BAR * (value - range[0]) / (range[1] - range[0]);
            drawing.stroke(polyline(&[[at, bar.bottom()], [at, bar.bottom() - 4.0]]), Stroke::full(Color::BLACK, 0.7));
            drawing.label(Label::new([at, bar.bottom() + SMALL + 2.0], label, SMALL).anchored(Anchor::Middle));
        }
        let power = match marks.exponent {
            0 => String::new(),
            e => ticks::minus(&format!(" × 10^{{{e}}}")),
        };
        let title = format!("{}{power}", self.field_name);
        drawing.label(Label::new([x, bar.y - 6.0], title, SMALL).anchored(Anchor::Middle));
        for (i, words) in self.extremes_in_words().into_iter().enumerate() {
            let below = [x, bar.bottom() + (i + 2) as f64 * (SMALL + 3.0)];
            drawing.label(Label::new(below, words, SMALL).anchored(Anchor::Middle));
        }
    }
    /// The least and the greatest value with their places.
    fn extremes_in_words(&self) -> Vec<String> {
        let words = |end: Extreme| {
            let scene = &self.scenes[end.scene];
            let place = scene.points.get(end.node).copied().unwrap_or_default();
            let axes = if self.projection == Projection::Plane { 2 } else { 3 };
            let place = place[..axes].iter().map(|&x| minus(&rounded(x))).collect::<Vec<_>>().join(", ");
            format!("{} at ({place}), {}", minus(&rounded(end.value)), scene.title)
        };
        let ends = self.extremes().into_iter().flatten().zip(["least", "greatest"]);
        ends.map(|(end, word)| format!("{word} {}", words(end))).collect()
    }
}
