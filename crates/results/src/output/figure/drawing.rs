//! A drawing: a list of shapes and labels on a page, in points, y downwards. It becomes an SVG or a PNG; both come
//! from the same list. Nothing here knows what is drawn.

use super::palette::Color;

/// A place on the page.
pub type Point = [f64; 2];

/// A rectangle on the page: left, top, width, height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub x: f64,
    /// Upper edge.
    pub y: f64,
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
}

/// One piece of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Segment {
    /// Begin anew here.
    Move(Point),
    /// A straight line to here.
    Line(Point),
    /// A parabola with this control point to here.
    Quad(Point, Point),
    /// Back to the last beginning.
    Close,
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub color: Color,
    /// Width.
    pub width: f64,
    /// Lengths of dashes and gaps in turn; empty for a full line.
    pub dash: &'static [f64],
}

/// Which part of a label stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// A line of text. `^{..}` raises, `_{..}` lowers.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Where its base line is anchored.
    pub at: Point,
    /// The words.
    pub text: String,
    /// Size of the type.
    pub size: f64,
    /// Which part stands at `at`.
    pub anchor: Anchor,
    /// Whether in bold type.
    pub bold: bool,
    /// Whether it runs upwards.
    pub upright: bool,
    /// Colour.
    pub color: Color,
}

/// One thing on the page; later ones cover earlier ones.
#[derive(Debug, Clone, PartialEq)]
pub enum Item {
    /// A path, filled, drawn or both.
    Path {
        /// The path.
        path: Vec<Segment>,
        /// Colour inside.
        fill: Option<Color>,
        /// The line.
        stroke: Option<Stroke>,
    },
    /// A filled path without a seam between it and its neighbours.
    Tile {
        /// The path.
        path: Vec<Segment>,
        /// Colour inside.
        color: Color,
    },
    /// A line of text.
    Label(Label),
    /// Show only what lies in the rectangle, until the next [`Item::Unclip`].
    Clip(Rect),
    /// Show everything again.
    Unclip,
}

/// A page with things on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// Width of the page.
    pub width: f64,
    /// Height of the page.
    pub height: f64,
    /// What is on it.
    pub items: Vec<Item>,
}

impl Rect {
    /// Right edge.
    pub fn right(&self) -> f64 {
        self.x + self.width
    }
    /// Lower edge.
    pub fn bottom(&self) -> f64 {
        self.y + self.height
    }
    /// The rectangle as a path.
    pub fn path(&self) -> Vec<Segment> {
        let (l, t, r, b) = (self.x, self.y, self.right(), self.bottom());
        polygon(&[[l, t], [r, t], [r, b], [l, b]])
    }
}

impl Stroke {
    /// A full line.
    pub fn full(color: Color, width: f64) -> Self {
        Self { color, width, dash: &[] }
    }
}

impl Label {
    /// A black label of ordinary type, anchored at its beginning.
    pub fn new(at: Point, text: impl Into<String>, size: f64) -> Self {
        let text = text.into();
        Self { at, text, size, anchor: Anchor::Start, bold: false, upright: false, color: Color::BLACK }
    }
    /// The same, anchored elsewhere.
    pub fn anchored(self, anchor: Anchor) -> Self {
        Self { anchor, ..self }
    }
    /// The same in bold type.
    pub fn bold(self) -> Self {
        Self { bold: true, ..self }
    }
    /// The same running upwards.
    pub fn upright(self) -> Self {
        Self { upright: true, ..self }
    }
}

/// A broken line.
pub fn polyline(points: &[Point]) -> Vec<Segment> {
    let first = points.iter().take(1).map(|&p| Segment::Move(p));
    first.chain(points.iter().skip(1).map(|&p| Segment::Line(p))).collect()
}

/// A closed broken line.
pub fn polygon(points: &[Point]) -> Vec<Segment> {
    let mut path = polyline(points);
    path.push(Segment::Close);
    path
}

impl Drawing {
    /// An empty page.
    pub fn new(width: f64, height: f64) -> Self {
        Self { width, height, items: Vec::new() }
    }
    /// A line along a path.
    pub fn stroke(&mut self, path: Vec<Segment>, stroke: Stroke) {
        self.items.push(Item::Path { path, fill: None, stroke: Some(stroke) });
    }
    /// A filled path.
    pub fn fill(&mut self, path: Vec<Segment>, color: Color) {
        self.items.push(Item::Path { path, fill: Some(color), stroke: None });
    }
    /// A filled path without a seam between it and its neighbours.
    pub fn tile(&mut self, path: Vec<Segment>, color: Color) {
        self.items.push(Item::Tile { path, color });
    }
    /// A label; one without words leaves no trace.
    pub fn label(&mut self, label: Label) {
        if !label.text.is_empty() {
            self.items.push(Item::Label(label));
        }
    }
    /// Draws only inside the rectangle what `inner` draws.
    pub fn clipped(&mut self, rect: Rect, inner: impl FnOnce(&mut Self)) {
        self.items.push(Item::Clip(rect));
        inner(self);
        self.items.push(Item::Unclip);
    }
    /// Puts another drawing on this page, shifted.
    pub fn place(&mut self, other: Drawing, at: Point) {
        self.items.extend(other.items.into_iter().map(|item| item.shifted(at)));
    }
}

impl Item {
    fn shifted(self, by: Point) -> Self {
        let shift = |p: Point| [p[0] + by[0], p[1] + by[1]];
        let segment = |s: Segment| match s {
            Segment::Move(p) => Segment::Move(shift(p)),
            Segment::Line(p) => Segment::Line(shift(p)),
            Segment::Quad(c, p) => Segment::Quad(shift(c), shift(p)),
            Segment::Close => Segment::Close,
        };
        match self {
            Self::Path { path, fill, stroke } => {
                Self::Path { path: path.into_iter().map(segment).collect(), fill, stroke }
            }
            Self::Tile { path, color } => Self::Tile { path: path.into_iter().map(segment).collect(), color },
            Self::Label(label) => Self::Label(Label { at: shift(label.at), ..label }),
            Self::Clip(r) => Self::Clip(Rect { x: r.x + by[0], y: r.y + by[1], ..r }),
            Self::Unclip => Self::Unclip,
        }
    }
}
