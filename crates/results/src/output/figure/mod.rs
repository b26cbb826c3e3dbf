//! Pictures without any other program: a page of shapes and labels, written as SVG and PNG; on it charts, and meshes
//! with stress vectors and tools. Pictures read frames and tables and compute nothing of mechanics.

mod arrows;
mod axes;
mod chart;
mod curves;
mod drawing;
mod facets;
mod hidden;
mod legend;
mod outline;
mod palette;
mod panels;
mod png;
mod scene;
mod shell;
mod standard;
mod svg;
mod text;
mod ticks;
mod view;

pub use arrows::Arrow;
pub use chart::{Chart, Series};
pub use drawing::{Anchor, Drawing, Item, Label, Point, Rect, Segment, Stroke};
pub use palette::{Color, field as field_color};
pub use panels::Panels;
pub use scene::Scene;
pub use standard::{FigureOptions, draw_standard};
pub use ticks::Scale;
pub use view::{Projection, Window};
