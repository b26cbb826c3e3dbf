//! A drawing as SVG.

use super::drawing::{Anchor, Drawing, Item, Label, Point, Segment, Stroke};
use super::palette::Color;
use super::text::{FAMILIES, runs};
use std::fmt::Write;

impl Drawing {
    /// The drawing as the text of an SVG file.
    pub fn to_svg(&self) -> String {
        let (w, h) = (number(self.width), number(self.height));
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
             font-family=\"{FAMILIES}\">\n<rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n"
        );
        let mut clips = 0;
        for item in &self.items {
            match item {
                Item::Path { path, fill, stroke } => write_path(&mut svg, path, *fill, *stroke),
                // A line of its own colour covers the seam beside a neighbour.
                Item::Tile { path, color } => write_path(&mut svg, path, Some(*color), Some(Stroke::full(*color, 0.4))),
                Item::Label(label) => write_label(&mut svg, label),
                Item::Clip(rect) => {
                    let (x, y, w, h) = (number(rect.x), number(rect.y), number(rect.width), number(rect.height));
                    let _ = writeln!(
                        svg,
                        "<clipPath id=\"c{clips}\"><rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\"/></clipPath>\n\
                         <g clip-path=\"url(#c{clips})\">"
                    );
                    clips += 1;
                }
                Item::Unclip => svg.push_str("</g>\n"),
            }
        }
        svg.push_str("</svg>\n");
        svg
    }
}

fn write_path(svg: &mut String, path: &[Segment], fill: Option<Color>, stroke: Option<Stroke>) {
    svg.push_str("<path d=\"");
    write_data(svg, path);
    let _ = write!(svg, "\" fill=\"{}\"", fill.map_or("none".into(), hex));
    if let Some(Stroke { color, width, dash }) = stroke {
        let _ = write!(svg, " stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"", hex(color), number(width));
        if !dash.is_empty() {
            let dash: Vec<String> = dash.iter().map(|&d| number(d)).collect();
            let _ = write!(svg, " stroke-dasharray=\"{}\"", dash.join(" "));
        }
    }
    svg.push_str("/>\n");
}

fn write_data(svg: &mut String, path: &[Segment]) {
    for segment in path {
        let (letter, points): (char, &[&Point]) = match segment {
            Segment::Move(p) => ('M', &[p]),
            Segment::Line(p) => ('L', &[p]),
            Segment::Quad(c, p) => ('Q', &[c, p]),
            Segment::Close => ('Z', &[]),
        };
        svg.push(letter);
        for (i, x) in points.iter().flat_map(|p| p.iter()).enumerate() {
            if i > 0 {
                svg.push(' ');
            }
            write_number(svg, *x);
        }
    }
}

fn write_label(svg: &mut String, label: &Label) {
    let [x, y] = label.at.map(number);
    let anchor = match label.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let _ = write!(svg, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\"", number(label.size));
    if label.bold {
        svg.push_str(" font-weight=\"bold\"");
    }
    if label.upright {
        let _ = write!(svg, " transform=\"rotate(-90 {x} {y})\"");
    }
    let _ = write!(svg, " fill=\"{}\" xml:space=\"preserve\">", hex(label.color));
    let mut height = 0.0;
    for run in runs(&label.text) {
        let (shift, size) = (label.size * (height - run.raise), label.size * run.scale);
        height = run.raise;
        let text = escape(&run.text);
        let _ = match (run.scale == 1.0, shift == 0.0) {
            (true, true) => write!(svg, "{text}"),
            _ => write!(svg, "<tspan dy=\"{}\" font-size=\"{}\">{text}</tspan>", number(shift), number(size)),
        };
    }
    svg.push_str("</text>\n");
}

fn hex(Color([r, g, b]): Color) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn number(x: f64) -> String {
    let mut text = String::new();
    write_number(&mut text, x);
    text
}

/// Writes hundredths of a point, which are finer than any screen or press. A page has tens of thousands of numbers, so that
/// they are written as whole numbers are.
fn write_number(text: &mut String, x: f64) {
    let hundredths = (100.0 * x).round();
    if !hundredths.is_finite() || hundredths.abs() > 1e15 {
        let _ = write!(text, "{x}");
        return;
    }
    let (whole, part) = ((hundredths.abs() / 100.0) as u64, (hundredths.abs() % 100.0) as u64);
    if hundredths < 0.0 {
        text.push('-');
    }
    let _ = write!(text, "{whole}");
    match (part / 10, part % 10) {
        (0, 0) => {}
        (tenths, 0) => text.extend(['.', digit(tenths)]),
        (tenths, rest) => text.extend(['.', digit(tenths), digit(rest)]),
    }
}

fn digit(value: u64) -> char {
    char::from(b'0' + value as u8)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::super::drawing::{Rect, polyline};
    use super::*;

    #[test]
    fn numbers_are_short() {
        let numbers = [0.0, -0.004, 0.05, -0.1, 12.0, 3.456, -7.999, 1e17].map(number);
        assert_eq!(numbers, ["0", "0", "0.05", "-0.1", "12", "3.46", "-8", "100000000000000000"]);
    }

    #[test]
    fn a_drawing_is_written_whole() {
        let mut drawing = Drawing::new(100.0, 50.0);
        let rect = Rect { x: 1.0, y: 2.0, width: 3.0, height: 4.0 };
        let stroke = Stroke { color: Color([255, 0, 16]), width: 1.5, dash: &[3.0, 1.0] };
        drawing.clipped(rect, |d| d.stroke(polyline(&[[0.0, 0.0], [10.004, -0.001]]), stroke));
        drawing.label(Label::new([5.0, 6.0], "a < b^{2}", 10.0).bold().upright());
        let svg = drawing.to_svg();
        assert!(svg.contains("M0 0L10 0\" fill=\"none\" stroke=\"#ff0010\" stroke-width=\"1.5\""));
        assert!(svg.contains("stroke-dasharray=\"3 1\""));
        assert!(svg.contains("a &lt; b<tspan dy=\"-3.6\" font-size=\"7\">2</tspan></text>"));
        assert!(svg.contains("rotate(-90 5 6)"));
        assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count());
    }
}
