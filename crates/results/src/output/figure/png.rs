//! A drawing as PNG, rasterised in software: no display, no other program, the same bytes every time.

use super::drawing::{Drawing, Item, Label, Point, Rect, Segment, Stroke};
use super::palette::Color;
use super::text;
use asperity_core::Error;
use tiny_skia::{FillRule, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, StrokeDash, Transform};
use ttf_parser::OutlineBuilder;

/// Pixels along the longer side beyond which no picture is made.
const LARGEST: f64 = 20_000.0;

struct Canvas {
    pixels: Pixmap,
    transform: Transform,
    clip: Option<Clip>,
}

/// What is shown: the inside of a rectangle of the page.
struct Clip {
    rect: Rect,
    mask: Mask,
}

impl Drawing {
    /// The drawing as the bytes of a PNG file with `scale` pixels a point.
    ///
    /// # Errors
    /// [`Error::Internal`] when the page has no size, or too large a one.
    pub fn to_png(&self, scale: f64) -> Result<Vec<u8>, Error> {
        Canvas::of(self, scale)?
            .encode()
            .map_err(|error| Error::Internal(format!("a picture cannot be encoded: {error}")))
    }
}

/// Frames of a film in a second, and for how many of them the last one stays.
const RATE: u16 = 10;
const LAST: u16 = 15;

/// Drawings of one size as the bytes of an animated PNG, which any browser plays, over and over; a viewer that does not know
/// how shows the first. `scale` pixels a point.
///
/// # Errors
/// [`Error::Internal`] when there is no drawing, or they have no size, unlike ones, or too large a one.
pub fn film(drawings: impl ExactSizeIterator<Item = Drawing>, scale: f64) -> Result<Vec<u8>, Error> {
    let failed = |error: png::EncodingError| Error::Internal(format!("a film cannot be encoded: {error}"));
    let count = drawings.len();
    let mut drawings = drawings.peekable();
    let Some(first) = drawings.peek() else { return Err(Error::Internal("a film has no frames".into())) };
    let size = Canvas::new(first.width * scale, first.height * scale, scale)?.pixels;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.width(), size.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_animated(count as u32, 0).map_err(failed)?;
    encoder.set_frame_delay(1, RATE).map_err(failed)?;
    let mut writer = encoder.write_header().map_err(failed)?;
    for (number, drawing) in drawings.enumerate() {
        if number + 1 == count {
            writer.set_frame_delay(LAST, RATE).map_err(failed)?;
        }
        let canvas = Canvas::of(&drawing, scale)?;
        writer.write_image_data(&canvas.colors()).map_err(failed)?;
    }
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

impl Canvas {
    fn of(drawing: &Drawing, scale: f64) -> Result<Self, Error> {
        let mut canvas = Self::new(drawing.width * scale, drawing.height * scale, scale)?;
        drawing.items.iter().for_each(|item| canvas.draw(item));
        Ok(canvas)
    }
    fn new(width: f64, height: f64, scale: f64) -> Result<Self, Error> {
        let fits = width <= LARGEST && height <= LARGEST;
        let pixels = fits.then(|| Pixmap::new(width.ceil() as u32, height.ceil() as u32)).flatten();
        let mut pixels =
            pixels.ok_or_else(|| Error::Internal(format!("a picture of {width} by {height} pixels cannot be made")))?;
        pixels.fill(tiny_skia::Color::WHITE);
        Ok(Self { pixels, transform: Transform::from_scale(scale as f32, scale as f32), clip: None })
    }
    /// The page is opaque, so that colours alone are written; packing them tighter would take as long as drawing them.
    fn encode(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.pixels.width(), self.pixels.height());
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_compression(png::Compression::Fast);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.colors())?;
        writer.finish()?;
        Ok(bytes)
    }
    /// Red, green and blue of all pixels.
    fn colors(&self) -> Vec<u8> {
        self.pixels.pixels().iter().flat_map(|p| [p.red(), p.green(), p.blue()]).collect()
    }
    fn draw(&mut self, item: &Item) {
        match item {
            Item::Path { path, fill, stroke } => self.path(path, *fill, *stroke),
            Item::Tile { path, color } => {
                // Pixels belong to the tile that holds their middle: neighbours leave no seam.
                if let Some(path) = build(path) {
                    self.fill(&path, &paint(*color, false));
                }
            }
            Item::Label(label) => self.label(label),
            Item::Clip(rect) => self.clip = self.mask(rect).map(|mask| Clip { rect: *rect, mask }),
            Item::Unclip => self.clip = None,
        }
    }
    fn mask(&self, rect: &Rect) -> Option<Mask> {
        let mut mask = Mask::new(self.pixels.width(), self.pixels.height())?;
        mask.fill_path(&build(&rect.path())?, FillRule::Winding, true, self.transform);
        Some(mask)
    }
    fn path(&mut self, segments: &[Segment], fill: Option<Color>, stroke: Option<Stroke>) {
        let Some(path) = build(segments) else { return };
        if let Some(color) = fill {
            self.fill(&path, &paint(color, true));
        }
        if let Some(stroke) = stroke {
            let line = tiny_skia::Stroke {
                width: stroke.width as f32,
                line_cap: LineCap::Butt,
                line_join: LineJoin::Round,
                dash: StrokeDash::new(stroke.dash.iter().map(|&d| d as f32).collect(), 0.0),
                ..tiny_skia::Stroke::default()
            };
            // However thin, a line takes pixels on either side.
            let width = stroke.width.max(2.0 / f64::from(self.transform.sx));
            let mask = mask_of(&self.clip, &path, width);
            self.pixels.stroke_path(&path, &paint(stroke.color, true), &line, self.transform, mask);
        }
    }
    fn fill(&mut self, path: &Path, paint: &Paint) {
        self.pixels.fill_path(path, paint, FillRule::Winding, self.transform, mask_of(&self.clip, path, 0.0));
    }
    fn label(&mut self, label: &Label) {
        let mut sink = Outlines(PathBuilder::new());
        text::outline(label, &mut sink);
        if let Some(path) = sink.0.finish() {
            self.fill(&path, &paint(label.color, true));
        }
    }
}

/// The mask, where a path drawn with a line of this width leaves what is shown.
fn mask_of<'a>(clip: &'a Option<Clip>, path: &Path, width: f64) -> Option<&'a Mask> {
    let Clip { rect, mask } = clip.as_ref()?;
    let (bounds, reach) = (path.bounds(), 0.5 * width);
    let [left, top, right, bottom] = [bounds.left(), bounds.top(), bounds.right(), bounds.bottom()].map(f64::from);
    let across = rect.x + reach < left && right < rect.right() - reach;
    let down = rect.y + reach < top && bottom < rect.bottom() - reach;
    (!(across && down)).then_some(mask)
}

fn paint(Color([r, g, b]): Color, smooth: bool) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, 255);
    paint.anti_alias = smooth;
    paint
}

fn build(segments: &[Segment]) -> Option<Path> {
    let single = |p: &Point| (p[0] as f32, p[1] as f32);
    let mut path = PathBuilder::new();
    for segment in segments {
        match segment {
            Segment::Move(p) => path.move_to(single(p).0, single(p).1),
            Segment::Line(p) => path.line_to(single(p).0, single(p).1),
            Segment::Quad(c, p) => path.quad_to(single(c).0, single(c).1, single(p).0, single(p).1),
            Segment::Close => path.close(),
        }
    }
    path.finish()
}

struct Outlines(PathBuilder);

impl OutlineBuilder for Outlines {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }
    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(x1, y1, x, y);
    }
    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.cubic_to(x1, y1, x2, y2, x, y);
    }
    fn close(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(drawing: &Drawing) -> Pixmap {
        Pixmap::decode_png(&drawing.to_png(2.0).unwrap()).unwrap()
    }

    #[test]
    fn shapes_clips_and_words_reach_the_pixels() {
        let mut drawing = Drawing::new(40.0, 20.0);
        let left = Rect { x: 0.0, y: 0.0, width: 10.0, height: 20.0 };
        let all = Rect { width: 40.0, ..left };
        drawing.clipped(left, |d| d.fill(all.path(), Color([200, 0, 0])));
        drawing.label(Label::new([20.0, 18.0], "M", 20.0));
        let pixels = pixels(&drawing);
        let at = |x, y| pixels.pixel(x, y).map(|p| (p.red(), p.green()));
        assert_eq!((pixels.width(), pixels.height()), (80, 40));
        assert_eq!(at(10, 20), Some((200, 0)), "inside the clip");
        assert_eq!(at(30, 20), Some((255, 255)), "outside");
        assert!((42..80).any(|x| at(x, 30) == Some((0, 0))), "the letter's ink");
    }

    #[test]
    fn a_film_is_read_back_frame_by_frame() {
        let page = |red: u8| {
            let mut drawing = Drawing::new(20.0, 10.0);
            drawing.fill(Rect { x: 0.0, y: 0.0, width: 20.0, height: 10.0 }.path(), Color([red, 0, 0]));
            drawing
        };
        let bytes = film([10, 120, 250].map(page).into_iter(), 2.0).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let animation = reader.info().animation_control().copied().unwrap();
        assert_eq!((animation.num_frames, animation.num_plays), (3, 0));
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        for (red, delay) in [(10, 1), (120, 1), (250, LAST)] {
            let frame = reader.next_frame(&mut pixels).unwrap();
            assert_eq!((frame.width, frame.height, pixels[0], pixels[1]), (40, 20, red, 0));
            let control = reader.info().frame_control().copied().unwrap();
            assert_eq!((control.delay_num, control.delay_den), (delay, RATE));
        }
        assert!(film(std::iter::empty(), 2.0).is_err());
    }

    #[test]
    fn the_same_drawing_gives_the_same_bytes() {
        let mut drawing = Drawing::new(100.0, 30.0);
        drawing.label(Label::new([2.0, 20.0], "contact.force^{2}", 12.0));
        assert_eq!(drawing.to_png(2.0).unwrap(), drawing.to_png(2.0).unwrap());
    }

    #[test]
    fn a_page_without_size_is_an_error() {
        assert!(Drawing::new(0.0, 10.0).to_png(2.0).is_err());
        assert!(Drawing::new(1e9, 10.0).to_png(2.0).is_err());
        assert!(Drawing::new(f64::NAN, 10.0).to_png(2.0).is_err());
    }
}
