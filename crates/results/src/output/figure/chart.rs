//! Line charts: several series over two axes, with a legend where it hides least.

use super::axes::{Axes, Axis, LARGE, MEDIUM, SMALL};
use super::drawing::{Anchor, Drawing, Label, Point, Rect, Segment, Stroke, polyline};
use super::palette::{self, Color};
use super::text;
use super::ticks::{Scale, ticks};

/// Room between the ends of a linear axis and the frame, over its length.
const ROOM: f64 = 0.03;

/// A chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Written above; may be empty.
    pub title: String,
    /// Titles of the axes, x and y.
    pub axes: [String; 2],
    /// How the axes are divided, x and y.
    pub scales: [Scale; 2],
    /// What is drawn.
    pub series: Vec<Series>,
    /// Width and height of the page.
    pub size: [f64; 2],
}

/// One line of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name in the legend; an empty one does not appear there.
    pub name: String,
    /// Its points.
    pub points: Vec<[f64; 2]>,
    /// Whether its points are marked.
    pub marks: bool,
    /// Its colour and dashes, by number.
    pub style: usize,
    /// Width of its line.
    pub width: f64,
}

impl Chart {
    /// A chart of ordinary size on linear axes.
    pub fn new(title: impl Into<String>, x: impl Into<String>, y: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            axes: [x.into(), y.into()],
            scales: [Scale::Linear, Scale::Linear],
            series: Vec::new(),
            size: [560.0, 380.0],
        }
    }
    /// The same with the y axis by powers of ten.
    pub fn log_y(mut self) -> Self {
        self.scales[1] = Scale::Log;
        self
    }
    /// Adds a line.
    pub fn line(&mut self, name: impl Into<String>, points: Vec<[f64; 2]>) -> &mut Series {
        let style = self.series.len();
        self.series.push(Series { name: name.into(), points, marks: false, style, width: 1.8 });
        let last = self.series.len() - 1;
        &mut self.series[last]
    }
    /// Draws the chart.
    pub fn draw(&self) -> Drawing {
        let [width, height] = self.size;
        let mut drawing = Drawing::new(width, height);
        let axes = self.layout();
        let legend = self.legend(&axes);
        drawing.width = legend.map_or(width, |place| width.max(place.right() + 8.0));
        axes.draw_grid(&mut drawing);
        drawing.clipped(axes.frame, |drawing| self.series.iter().for_each(|s| s.draw_line(drawing, &s.on_page(&axes))));
        axes.draw_frame(&mut drawing);
        self.series.iter().for_each(|s| s.draw_marks(&mut drawing, &s.on_page(&axes)));
        let middle = axes.frame.x + 0.5 * axes.frame.width;
        drawing.label(Label::new([middle, LARGE + 6.0], &self.title, LARGE).anchored(Anchor::Middle).bold());
        if let Some(place) = legend {
            self.draw_legend(&mut drawing, place);
        }
        drawing
    }
    fn axis(&self, which: usize, count: usize) -> Axis {
        let scale = self.scales[which];
        let values = self.series.iter().flat_map(|s| &s.points).map(|p| p[which]);
        let usable = |x: &f64| x.is_finite() && (scale == Scale::Linear || *x > 0.0);
        let (low, high) =
            values.filter(usable).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
        // An axis that nearly begins at zero does; time and travel end where they do, the other at round numbers.
        let low = if scale == Scale::Linear && low > 0.0 && low < 0.25 * high { 0.0 } else { low };
        let widen = which == 1;
        let mut ticks = ticks(scale, [low, high], count, widen);
        if scale == Scale::Linear {
            // What runs along the end of an axis is not lost in the frame.
            let [low, high] = ticks.range;
            ticks.range = [low - ROOM * (high - low), high + ROOM * (high - low)];
        }
        Axis { title: self.axes[which].clone(), scale, ticks }
    }
    fn layout(&self) -> Axes {
        let [width, height] = self.size;
        let (x, y) = (self.axis(0, 7), self.axis(1, 6));
        let left = Axes::left_margin(&y) + 8.0;
        let above = if y.ticks.exponent != 0 { SMALL + 4.0 } else { 0.0 };
        let top = if self.title.is_empty() { 12.0 + above } else { LARGE + 18.0 + above };
        let bottom = Axes::bottom_margin(&x) + 8.0;
        let frame = Rect { x: left, y: top, width: width - left - 20.0, height: height - top - bottom };
        Axes { frame, x, y }
    }
    fn named(&self) -> impl Iterator<Item = &Series> {
        self.series.iter().filter(|s| !s.name.is_empty())
    }
    /// Where the legend stands, if there is one: in a corner of the frame through which no line runs, or beside it.
    fn legend(&self, axes: &Axes) -> Option<Rect> {
        let widest = self.named().map(|s| text::width(&s.name, MEDIUM, false)).reduce(f64::max)?;
        let size = [widest + 52.0, 18.0 * self.named().count() as f64 + 8.0];
        let beside = Rect { x: axes.frame.right() + 8.0, y: axes.frame.y, width: size[0], height: size[1] };
        Some(self.free_corner(axes, size).unwrap_or(beside))
    }
    fn draw_legend(&self, drawing: &mut Drawing, place: Rect) {
        drawing.fill(place.path(), Color::WHITE);
        for (i, series) in self.named().enumerate() {
            let y = place.y + 18.0 * i as f64 + 13.0;
            let sample = [[place.x + 8.0, y], [place.x + 36.0, y]];
            series.draw_line(drawing, &sample);
            series.draw_marks(drawing, &sample);
            drawing.label(Label::new([place.x + 43.0, y + 0.36 * MEDIUM], &series.name, MEDIUM));
        }
    }
    /// A box of this size in a corner of the frame through which no line runs.
    fn free_corner(&self, axes: &Axes, [width, height]: [f64; 2]) -> Option<Rect> {
        let frame = axes.frame;
        let (left, right) = (frame.x + 8.0, frame.right() - width - 8.0);
        let (top, bottom) = (frame.y + 8.0, frame.bottom() - height - 8.0);
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
        let lines: Vec<Vec<Point>> = self.series.iter().map(|s| s.on_page(axes)).collect();
        let free = |place: &Rect| !lines.iter().flat_map(|line| line.windows(2)).any(|w| crosses([w[0], w[1]], place));
        corners.map(|[x, y]| Rect { x, y, width, height }).into_iter().find(free)
    }
}

impl Series {
    /// Marks the points.
    pub fn marked(&mut self) -> &mut Self {
        self.marks = true;
        self
    }
    /// Takes the colour and dashes of another number.
    pub fn styled(&mut self, style: usize) -> &mut Self {
        self.style = style;
        self
    }
    /// Draws it thin, as one of many.
    pub fn thin(&mut self) -> &mut Self {
        self.width = 0.7;
        self
    }
    fn on_page(&self, axes: &Axes) -> Vec<Point> {
        self.points.iter().map(|&p| axes.map(p)).filter(|p| p.iter().all(|x| x.is_finite())).collect()
    }
    fn draw_line(&self, drawing: &mut Drawing, points: &[Point]) {
        let color = palette::line(self.style);
        drawing.stroke(polyline(points), Stroke { color, width: self.width, dash: palette::dash(self.style) });
    }
    fn draw_marks(&self, drawing: &mut Drawing, points: &[Point]) {
        let marked = if self.marks { points } else { &[] };
        marked.iter().for_each(|&p| drawing.fill(disc(p, 2.6), palette::line(self.style)));
    }
}

/// Whether a piece of a line has a part inside a rectangle: the part between both pairs of sides is not empty.
fn crosses([a, b]: [Point; 2], place: &Rect) -> bool {
    let ends = [[place.x, place.right()], [place.y, place.bottom()]];
    let mut part = [0.0f64, 1.0f64];
    for (axis, [low, high]) in ends.into_iter().enumerate() {
        let along = b[axis] - a[axis];
        if along == 0.0 && !(low..=high).contains(&a[axis]) {
            return false;
        }
        if along != 0.0 {
            let [s, t] = [(low - a[axis]) / along, (high - a[axis]) / along];
            part = [part[0].max(s.min(t)), part[1].min(s.max(t))];
        }
    }
    part[0] <= part[1]
}

/// A small disc, as eight parabolas.
fn disc([x, y]: Point, radius: f64) -> Vec<Segment> {
    let at = |i: f64, r: f64| {
        let (sin, cos) = (i * std::f64::consts::FRAC_PI_4).sin_cos();
        [x + r * cos, y + r * sin]
    };
    let outer = radius / (0.5 * std::f64::consts::FRAC_PI_4).cos();
    let arcs = (1..=8).map(|i| Segment::Quad(at(f64::from(i) - 0.5, outer), at(f64::from(i), radius)));
    [Segment::Move(at(0.0, radius))].into_iter().chain(arcs).chain([Segment::Close]).collect()
}

#[cfg(test)]
mod tests {
    use super::super::drawing::Item;
    use super::*;

    fn chart() -> Chart {
        let mut chart = Chart::new("Force over travel", "travel", "force");
        chart.line("low", (0..=100).map(|i| [f64::from(i), 10.0]).collect());
        chart.line("rising", (0..=100).map(|i| [f64::from(i), f64::from(i)]).collect());
        chart
    }

    #[test]
    fn the_legend_goes_where_no_line_runs() {
        let chart = chart();
        let place = chart.legend(&chart.layout()).unwrap();
        let frame = chart.layout().frame;
        assert!(place.x < frame.x + 20.0 && place.y < frame.y + 20.0, "upper left, not {place:?}");
        assert_eq!(chart.draw().width, chart.size[0]);
    }

    #[test]
    fn the_legend_stands_beside_a_chart_that_is_full() {
        let mut chart = chart();
        // Two points a line: a legend must not slip between the ends of a long one.
        chart.line("falling", vec![[0.0, 100.0], [100.0, 0.0]]);
        let place = chart.legend(&chart.layout()).unwrap();
        let drawing = chart.draw();
        assert!(place.x >= chart.layout().frame.right() && place.right() < drawing.width, "{place:?}");
        assert!(Chart::new("", "", "").legend(&chart.layout()).is_none());
    }

    #[test]
    fn a_line_through_a_box_is_noticed_between_its_points() {
        let place = Rect { x: 10.0, y: 10.0, width: 5.0, height: 5.0 };
        for (line, through) in [
            ([[0.0, 0.0], [30.0, 30.0]], true),
            ([[12.0, 0.0], [12.0, 99.0]], true),
            ([[11.0, 11.0], [12.0, 12.0]], true),
            ([[16.0, 0.0], [16.0, 99.0]], false),
            ([[0.0, 18.0], [18.0, 0.0]], false),
            ([[0.0, 0.0], [9.0, 9.0]], false),
        ] {
            assert_eq!(crosses(line, &place), through, "{line:?}");
        }
    }

    #[test]
    fn lines_at_the_ends_of_the_axes_stay_off_the_frame() {
        let chart = chart();
        let axes = chart.layout();
        for p in chart.series.iter().flat_map(|s| s.on_page(&axes)) {
            let frame = axes.frame;
            let room = [p[0] - frame.x, frame.right() - p[0], p[1] - frame.y, frame.bottom() - p[1]];
            assert!(room.iter().all(|&room| room > 5.0), "{p:?} in {frame:?}");
        }
    }

    #[test]
    fn everything_stays_on_the_page() {
        for chart in [chart(), chart().log_y(), Chart::new("empty", "", "")] {
            let drawing = chart.draw();
            for item in &drawing.items {
                let Item::Label(label) = item else { continue };
                let [x, y] = label.at;
                assert!((0.0..=drawing.width).contains(&x) && (0.0..=drawing.height).contains(&y), "{label:?}");
            }
        }
    }

    #[test]
    fn what_is_no_number_is_left_out() {
        let mut chart = Chart::new("", "x", "y");
        chart.line("a", vec![[0.0, 1.0], [1.0, f64::NAN], [2.0, 3.0]]);
        assert_eq!(chart.series[0].on_page(&chart.layout()).len(), 2);
    }
}
