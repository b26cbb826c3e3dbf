//! Pictures of meshes: one or more panels side by side, all in one scale, with tools, a colour field, stress vectors
//! and their legends.

use super::arrows::Arrow;
use super::axes::{Axes, Axis, LARGE, MEDIUM};
use super::drawing::{Anchor, Drawing, Label, Rect, Stroke, polyline};
use super::outline::draw_outline;
use super::palette::Color;
use super::scene::{Scene, draw_mesh, draw_stress, draw_triad};
use super::shell::draw_shell;
use super::text;
use super::ticks::{Scale, ticks};
use super::view::{Projection, View, Window};

/// A picture of one or more scenes.
#[derive(Debug, Clone)]
pub struct Panels<'a> {
    /// Written above all; may be empty.
    pub title: String,
    /// The panels.
    pub scenes: Vec<Scene<'a>>,
    /// How space is looked at.
    pub projection: Projection,
    /// Titles of the axes, x and y.
    pub axes: [String; 2],
    /// What the arrows are, for the legend.
    pub arrow_name: String,
    /// What the field is, for the colour bar.
    pub field_name: String,
    /// What is shown of every scene; all bodies and arrows where not given.
    pub window: Option<Window>,
    /// The largest size of the panels together.
    pub room: [f64; 2],
}

/// The least or greatest value of a field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Extreme {
    /// The value.
    pub value: f64,
    /// The scene that it is in.
    pub scene: usize,
    /// The point of that scene.
    pub node: usize,
}

/// Height of the triangles that mark them; that of the greatest stands above its place, that of the least below.
const MARK: f64 = 7.0;
/// Space around a frame for its title, marks and labels.
const LEFT: f64 = 62.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 44.0;
/// The longest arrow over the larger side of the bodies, at most,
const LONGEST: f64 = 0.22;
/// and the median one.
const TYPICAL: f64 = 0.07;
/// Space around the bodies over the larger side of the window.
const MARGIN: f64 = 0.03;

/// Sizes shared by all panels.
pub(super) struct Layout {
    columns: usize,
    rows: usize,
    frame: [f64; 2],
    windows: Vec<Window>,
    /// Points of the page in a unit of length.
    pub(super) scale: f64,
    /// Lengths of space a unit of stress.
    pub(super) arrow_scale: f64,
    /// Least and largest value of the field.
    pub(super) range: [f64; 2],
}

impl Panels<'_> {
    /// Draws the picture.
    pub fn draw(&self) -> Drawing {
        let shown: Vec<usize> = (0..self.scenes.len()).collect();
        self.page(&self.layout(shown.len()), &shown)
    }

    /// A page for each scene, all of one size and in one scale: the frames of a film.
    pub fn film(&self) -> impl ExactSizeIterator<Item = Drawing> + '_ {
        let layout = self.layout(1);
        (0..self.scenes.len()).map(move |scene| self.page(&layout, &[scene]))
    }

    /// A page with some of the scenes.
    fn page(&self, layout: &Layout, shown: &[usize]) -> Drawing {
        let (cell_width, cell_height) = (self.cell_width(layout), layout.frame[1] + TOP + BOTTOM);
        let top = if self.title.is_empty() { 4.0 } else { LARGE + 16.0 };
        let width = (cell_width * layout.columns as f64).max(self.legend_width());
        let mut drawing = Drawing::new(width, top + cell_height * layout.rows as f64 + self.legend_height());
        let middle = [0.5 * width, LARGE + 5.0];
        drawing.label(Label::new(middle, &self.title, LARGE).anchored(Anchor::Middle).bold());
        let left = 0.5 * (width - cell_width * layout.columns as f64);
        for (i, &number) in shown.iter().enumerate() {
            let (column, row) = ((i % layout.columns) as f64, (i / layout.columns) as f64);
            let corner = [left + column * cell_width + LEFT, top + row * cell_height + TOP];
            let frame = Rect { x: corner[0], y: corner[1], width: layout.frame[0], height: layout.frame[1] };
            let view = View { projection: self.projection, window: layout.windows[number], frame };
            self.draw_scene(&mut drawing, (number, &self.scenes[number]), &view, layout);
        }
        self.draw_legends(&mut drawing, layout);
        drawing
    }

    /// Width of a frame with its labels and its title, which may be the wider.
    fn cell_width(&self, layout: &Layout) -> f64 {
        let widest = self.scenes.iter().map(|s| text::width(&s.title, MEDIUM, false)).fold(0.0, f64::max);
        let frame = layout.frame[0];
        (frame + LEFT + RIGHT).max(LEFT + 0.5 * (frame + widest) + RIGHT)
    }

    /// The layout of pages with so many panels.
    fn layout(&self, panels: usize) -> Layout {
        let flat = |p: [f64; 3]| self.projection.flat(p);
        let bodies: Vec<Window> =
            self.scenes.iter().map(|s| Window::around(s.points.iter().map(|&p| flat(p)))).collect();
        let largest = bodies.iter().flat_map(|w| w.size()).fold(0.0, f64::max);
        let extent = self.window.map_or(largest, |w| w.size()[0].max(w.size()[1]));
        let arrow_scale = extent * self.arrow_scale();
        let windows = self.windows(arrow_scale, MARGIN * extent);
        let size = windows.first().map_or([1.0, 1.0], Window::size);
        let (columns, scale) = best_columns(panels, size, self.room);
        let frame = size.map(|s| s * scale);
        let rows = panels.div_ceil(columns);
        Layout { columns, rows, frame, windows, scale, arrow_scale, range: self.field_range() }
    }
    /// Lengths of arrows a unit of stress, over the extent of the bodies. A few peaks do not shrink all the rest to
    /// nothing, nor do they fill the picture.
    fn arrow_scale(&self) -> f64 {
        let sizes = self.scenes.iter().flat_map(|s| &s.arrows).map(Arrow::size);
        let mut sizes: Vec<f64> = sizes.filter(|&size| size > 0.0).collect();
        sizes.sort_by(f64::total_cmp);
        match (sizes.last(), sizes.get(sizes.len() / 2)) {
            (Some(strongest), Some(median)) => (LONGEST / strongest).min(TYPICAL / median),
            _ => 0.0,
        }
    }
    /// One window about the bodies and arrows of all scenes.
    fn windows(&self, arrow_scale: f64, margin: f64) -> Vec<Window> {
        if let Some(window) = self.window {
            return vec![window; self.scenes.len()];
        }
        let around = |s: &Scene| {
            let tails = s.arrows.iter().map(|a| a.tail(arrow_scale));
            Window::around(s.points.iter().copied().chain(tails).map(|p| self.projection.flat(p)))
        };
        let corners = |w: Window| [w.low, w.high];
        let all = Window::around(self.scenes.iter().map(around).flat_map(corners));
        let size = all.size().map(|size| size + 2.0 * margin);
        vec![all.resized(size); self.scenes.len()]
    }
    fn field_range(&self) -> [f64; 2] {
        let [low, high] = self.extremes().map_or([0.0; 2], |ends| ends.map(|end| end.value));
        if high > low { [low, high] } else { [low.min(0.0), low.max(0.0) + 1.0] }
    }
    /// Where the field is least and greatest in all scenes.
    pub(super) fn extremes(&self) -> Option<[Extreme; 2]> {
        let values = |(scene, s): (usize, &Scene)| {
            let known = s.field.iter().flatten().copied().enumerate().filter(|(_, value)| value.is_finite());
            known.map(|(node, value)| Extreme { value, scene, node }).collect::<Vec<_>>()
        };
        let all = || self.scenes.iter().enumerate().flat_map(values);
        let least = all().reduce(|a, b| if b.value < a.value { b } else { a })?;
        let greatest = all().reduce(|a, b| if b.value > a.value { b } else { a })?;
        Some([least, greatest])
    }
    /// Marks the places of the least and of the greatest value, where they are in this scene.
    fn mark_extremes(&self, drawing: &mut Drawing, (number, scene): (usize, &Scene), view: &View) {
        let ends = self.extremes().into_iter().flat_map(|ends| ends.into_iter().zip([-1.0, 1.0]));
        for (end, up) in ends.filter(|(end, _)| end.scene == number) {
            let Some(&place) = scene.points.get(end.node) else { continue };
            let [x, y] = view.map(place);
            let base = y - up * MARK;
            let corners = [[x, y], [x - 0.6 * MARK, base], [x + 0.6 * MARK, base], [x, y], [x - 0.6 * MARK, base]];
            drawing.stroke(polyline(&corners), Stroke::full(Color::BLACK, 1.2));
        }
    }

    fn draw_scene(&self, drawing: &mut Drawing, (number, scene): (usize, &Scene), view: &View, layout: &Layout) {
        drawing.clipped(view.frame, |drawing| {
            scene.tools.iter().for_each(|profile| draw_outline(drawing, view, profile));
            draw_mesh(drawing, scene, view, layout.range);
            draw_shell(drawing, view, &scene.shells);
            draw_stress(drawing, scene, view, layout.arrow_scale);
            self.mark_extremes(drawing, (number, scene), view);
        });
        let above = [view.frame.x + 0.5 * view.frame.width, view.frame.y - 8.0];
        drawing.label(Label::new(above, &scene.title, MEDIUM).anchored(Anchor::Middle));
        match self.projection {
            Projection::Plane => self.axes_of(view).draw_frame(drawing),
            Projection::Corner => draw_triad(drawing, view),
        }
    }
    fn axes_of(&self, view: &View) -> Axes {
        let axis = |a: usize, length: f64, title: &str| {
            let range = [view.window.low[a], view.window.high[a]];
            let count = (length / 45.0).round().clamp(3.0, 9.0) as usize;
            Axis { title: title.into(), scale: Scale::Linear, ticks: ticks(Scale::Linear, range, count, false) }
        };
        let frame = view.frame;
        Axes { frame, x: axis(0, frame.width, &self.axes[0]), y: axis(1, frame.height, &self.axes[1]) }
    }
}

/// The number of columns that lets equal frames be largest, and their scale.
fn best_columns(count: usize, size: [f64; 2], room: [f64; 2]) -> (usize, f64) {
    let scale = |columns: usize| {
        let rows = count.div_ceil(columns);
        let width = room[0] / columns as f64 - LEFT - RIGHT;
        let height = room[1] / rows as f64 - TOP - BOTTOM;
        (width.max(40.0) / size[0]).min(height.max(40.0) / size[1])
    };
    let candidates = (1..=count.max(1)).map(|columns| (columns, scale(columns)));
    candidates.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((1, 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::drawing::{Item, Segment};
    use super::*;
    use asperity_core::mesh::{Cell, Mesh};
    use asperity_core::tensor::Vec3;

    fn block() -> Mesh {
        let mut mesh = Mesh::new();
        mesh.points = [[0.0, 0.0], [10.0, 0.0], [10.0, 20.0], [0.0, 20.0]].map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec();
        mesh.push_cell(Cell::named("quad4").unwrap(), &[0, 1, 2, 3]);
        mesh
    }

    fn picture(mesh: &Mesh) -> Panels<'_> {
        let scene = |i: usize| Scene {
            title: format!("a long title of the panel number {i}"),
            mesh,
            points: mesh.points.iter().map(|p| [p[0], p[1] + 5.0 * i as f64, 0.0]).collect(),
            field: Some(vec![0.0, 1.0, 2.0, 3.0]),
            arrows: vec![Arrow { at: [0.0, 10.0, 0.0], vector: [400.0 + 80.0 * i as f64, 0.0, 0.0], group: 0 }],
            tools: vec![vec![[0.0, -50.0, 0.0], [0.0, 50.0, 0.0]]],
            shells: Vec::new(),
        };
        Panels {
            title: "title".into(),
            scenes: (0..3).map(scene).collect(),
            projection: Projection::Plane,
            axes: ["x".into(), "y".into()],
            arrow_name: "contact stress".into(),
            field_name: "field".into(),
            window: None,
            room: [900.0, 700.0],
        }
    }

    #[test]
    fn labels_stay_on_the_page() {
        let mesh = block();
        let drawing = picture(&mesh).draw();
        for item in &drawing.items {
            let Item::Label(label) = item else { continue };
            let left = label.at[0] + if label.upright { 0.0 } else { label.start_offset() };
            let right = left + if label.upright { 0.0 } else { text::width(&label.text, label.size, label.bold) };
            assert!(left >= 0.0 && right <= drawing.width, "{label:?}");
            assert!(label.at[1] > 0.0 && label.at[1] < drawing.height, "{label:?}");
        }
    }

    /// The arrows for 400, 480 and 560 and the one of the legend, for 500, have one scale.
    #[test]
    fn the_legend_is_to_scale() {
        let mesh = block();
        let length = |item: &Item| match item {
            Item::Path { path, stroke: Some(stroke), .. } if stroke.color == Color::ARROW => match path[..] {
                [Segment::Move(a), Segment::Line(b)] => Some(b[0] - a[0]),
                _ => None,
            },
            _ => None,
        };
        let drawing = picture(&mesh).draw();
        let found: Vec<f64> = drawing.items.iter().filter_map(length).collect();
        let [first, second, third, legend] = found[..] else { panic!("{found:?}") };
        // All heads have the same size, so differences of the shafts are those of the arrows.
        assert!(((second - first) / (third - second) - 1.0).abs() < 1e-9);
        let unit = (third - first) / 160.0;
        assert!(((third - legend) / unit - 60.0).abs() < 1e-6, "the legend stands for 500: {found:?}");
    }

    #[test]
    fn all_frames_show_the_same_part_of_space() {
        let mesh = block();
        let layout = picture(&mesh).layout(3);
        assert!(layout.windows.iter().all(|window| *window == layout.windows[0]));
        let Window { low, high } = layout.windows[0];
        assert!(low[1] < 0.0 && high[1] > 30.0, "the block rises by ten over its height of twenty: {low:?} {high:?}");
    }

    /// The first and the last node of the field in the first scene.
    #[test]
    fn the_least_and_the_greatest_value_are_told_with_their_places() {
        let mesh = block();
        let drawing = picture(&mesh).draw();
        let told = |word: &str| {
            let labels = drawing.items.iter().filter_map(|item| match item {
                Item::Label(label) => Some(label.text.as_str()),
                _ => None,
            });
            labels.filter(|text| text.starts_with(word)).collect::<Vec<_>>()
        };
        let title = "a long title of the panel number 0";
        assert_eq!(told("least "), [format!("least 0 at (0, 0), {title}")]);
        assert_eq!(told("greatest "), [format!("greatest 3 at (0, 20), {title}")]);
    }

    #[test]
    fn the_frames_of_a_film_have_one_size() {
        let mesh = block();
        let picture = picture(&mesh);
        let pages: Vec<Drawing> = picture.film().collect();
        assert_eq!(pages.len(), 3);
        let size = |page: &Drawing| [page.width, page.height];
        assert!(pages.iter().all(|page| size(page) == size(&pages[0])));
        let shows = |page: &Drawing, text: &str| {
            page.items.iter().any(|item| matches!(item, Item::Label(label) if label.text == text))
        };
        let title = |i: usize| format!("a long title of the panel number {i}");
        assert!((0..3).all(|i| (0..3).all(|j| shows(&pages[i], &title(j)) == (i == j))));
    }

    #[test]
    fn tall_panels_stand_side_by_side_and_wide_ones_above_each_other() {
        assert_eq!(best_columns(3, [1.0, 8.0], [900.0, 700.0]).0, 3);
        assert_eq!(best_columns(3, [8.0, 1.0], [900.0, 700.0]).0, 1);
    }
}
