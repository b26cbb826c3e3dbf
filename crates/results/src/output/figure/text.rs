//! Type: the two faces that are built in (Noto Sans, Open Font License), the width of a line, its outlines, and the
//! small markup of raised and lowered parts.

use super::drawing::{Label, Point};
use std::sync::LazyLock;
use ttf_parser::{Face, OutlineBuilder};

/// Families a viewer of an SVG should try, the one we measure with first.
pub const FAMILIES: &str = "Noto Sans, Open Sans, Helvetica, Arial, sans-serif";

static REGULAR: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(notosans::REGULAR_TTF, 0).ok());
static BOLD: LazyLock<Option<Face<'static>>> = LazyLock::new(|| Face::parse(notosans::BOLD_TTF, 0).ok());

/// A part of a line: its words, how far it is raised and how large it is, both over the size of the type.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// The words.
    pub text: String,
    /// Height above the base line.
    pub raise: f64,
    /// Size.
    pub scale: f64,
}

/// Splits `x^{2} y_{i}` into its runs.
pub fn runs(text: &str) -> Vec<Run> {
    let mut runs = Vec::new();
    let mut rest = text;
    while let Some((start, raise)) = next_mark(rest) {
        let Some(length) = rest[start + 2..].find('}') else { break };
        push(&mut runs, &rest[..start], 0.0, 1.0);
        push(&mut runs, &rest[start + 2..start + 2 + length], raise, 0.7);
        rest = &rest[start + 3 + length..];
    }
    push(&mut runs, rest, 0.0, 1.0);
    runs
}

fn next_mark(text: &str) -> Option<(usize, f64)> {
    let marks = [(text.find("^{"), 0.36), (text.find("_{"), -0.16)];
    marks.into_iter().filter_map(|(at, raise)| Some((at?, raise))).min_by_key(|mark| mark.0)
}

fn push(runs: &mut Vec<Run>, text: &str, raise: f64, scale: f64) {
    if !text.is_empty() {
        runs.push(Run { text: text.into(), raise, scale });
    }
}

fn face(bold: bool) -> Option<&'static Face<'static>> {
    if bold { BOLD.as_ref() } else { REGULAR.as_ref() }
}

/// Width of a line of text.
pub fn width(text: &str, size: f64, bold: bool) -> f64 {
    let Some(face) = face(bold) else { return 0.0 };
    let advance = |run: &Run| run.scale * run.text.chars().map(|c| advance(face, c)).sum::<f64>();
    size * runs(text).iter().map(advance).sum::<f64>()
}

/// Advance of one character over the size of the type.
fn advance(face: &Face, c: char) -> f64 {
    let glyph = face.glyph_index(c).unwrap_or_default();
    f64::from(face.glyph_hor_advance(glyph).unwrap_or(0)) / f64::from(face.units_per_em())
}

/// Draws the outlines of a label into `sink`, in page coordinates.
pub fn outline(label: &Label, sink: &mut dyn OutlineBuilder) {
    let Some(face) = face(label.bold) else { return };
    let mut x = label.start_offset();
    for run in runs(&label.text) {
        for c in run.text.chars() {
            let scale = label.size * run.scale;
            let glyph = face.glyph_index(c).unwrap_or_default();
            let place = Placed {
                label,
                sink: &mut *sink,
                x,
                raise: label.size * run.raise,
                scale: scale / f64::from(face.units_per_em()),
            };
            place.draw(face, glyph);
            x += scale * advance(face, c);
        }
    }
}

impl Label {
    /// Where the text begins along its base line, measured from the anchor.
    pub fn start_offset(&self) -> f64 {
        let width = width(&self.text, self.size, self.bold);
        match self.anchor {
            super::drawing::Anchor::Start => 0.0,
            super::drawing::Anchor::Middle => -0.5 * width,
            super::drawing::Anchor::End => -width,
        }
    }
    /// A point given along and above the base line, on the page.
    fn on_page(&self, along: f64, above: f64) -> Point {
        let [x, y] = self.at;
        if self.upright { [x - above, y - along] } else { [x + along, y - above] }
    }
}

/// A glyph on its way to the page.
struct Placed<'a> {
    label: &'a Label,
    sink: &'a mut dyn OutlineBuilder,
    x: f64,
    raise: f64,
    scale: f64,
}

impl Placed<'_> {
    fn draw(mut self, face: &Face, glyph: ttf_parser::GlyphId) {
        face.outline_glyph(glyph, &mut self);
    }
    fn map(&self, x: f32, y: f32) -> (f32, f32) {
        let along = self.x + self.scale * f64::from(x);
        let [x, y] = self.label.on_page(along, self.raise + self.scale * f64::from(y));
        (x as f32, y as f32)
    }
}

impl OutlineBuilder for Placed<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.map(x, y);
        self.sink.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.map(x, y);
        self.sink.line_to(x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.map(x1, y1), self.map(x, y));
        self.sink.quad_to(x1, y1, x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.map(x1, y1), self.map(x2, y2), self.map(x, y));
        self.sink.curve_to(x1, y1, x2, y2, x, y);
    }
    fn close(&mut self) {
        self.sink.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_splits_into_runs() {
        let texts = |text: &str| runs(text).iter().map(|r| (r.text.clone(), r.raise)).collect::<Vec<_>>();
        assert_eq!(
            texts("10^{−3} p_{max}"),
            [("10".into(), 0.0), ("−3".into(), 0.36), (" p".into(), 0.0), ("max".into(), -0.16)]
        );
        assert_eq!(texts("a_b^c {x}"), [("a_b^c {x}".into(), 0.0)]);
        assert_eq!(texts("open ^{end"), [("open ^{end".into(), 0.0)]);
    }

    #[test]
    fn the_built_in_faces_have_what_the_figures_say() {
        for face in [face(false).unwrap(), face(true).unwrap()] {
            assert!("0123456789−×·φτσ²°eE.()'/".chars().all(|c| face.glyph_index(c).is_some()));
        }
        assert!(width("wide", 10.0, true) > width("wide", 10.0, false));
        assert!((width("ab", 20.0, false) - 2.0 * width("ab", 10.0, false)).abs() < 1e-12);
    }
}
