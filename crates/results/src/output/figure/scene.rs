//! What one panel shows, and how its mesh is drawn.

use super::arrows::{Arrow, draw_arrows};
use super::axes::SMALL;
use super::drawing::{Anchor, Drawing, Label, Stroke, polygon, polyline};
use super::facets::{Facet, edge_path, edges, facets};
use super::hidden::Cover;
use super::palette::{self, Color};
use super::shell::Tile;
use super::view::{Projection, View};
use asperity_core::mesh::Mesh;

/// What one panel shows.
#[derive(Debug, Clone)]
pub struct Scene<'a> {
    /// Written above it.
    pub title: String,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Present positions of its nodes.
    pub points: Vec<[f64; 3]>,
    /// A nodal field to colour it with.
    pub field: Option<Vec<f64>>,
    /// Stress vectors.
    pub arrows: Vec<Arrow>,
    /// Profiles of tools as fine broken lines, their material on the left.
    pub tools: Vec<Vec<[f64; 3]>>,
    /// Tiles of tools in space.
    pub shells: Vec<Tile>,
}

/// Draws the stress vectors; in space those that stand behind a body in a pale colour, and no line joins them.
pub(super) fn draw_stress(drawing: &mut Drawing, scene: &Scene, view: &View, scale: f64) {
    if view.projection == Projection::Plane {
        return draw_arrows(drawing, view, &scene.arrows, scale, Color::ARROW);
    }
    let acting: Vec<Arrow> = scene.arrows.iter().filter(|arrow| arrow.size() > 0.0).copied().collect();
    let cover = Cover::new(&facets(scene.mesh), view, &scene.points);
    let (hidden, seen): (Vec<Arrow>, Vec<Arrow>) = acting.into_iter().partition(|arrow| cover.hides(view, arrow.at));
    draw_arrows(drawing, view, &hidden, scale, Color::HIDDEN_ARROW);
    draw_arrows(drawing, view, &seen, scale, Color::ARROW);
}

/// Draws cells, colours and edges.
pub(super) fn draw_mesh(drawing: &mut Drawing, scene: &Scene, view: &View, range: [f64; 2]) {
    let at = |node: usize| view.map(scene.points[node]);
    let mut facets = facets(scene.mesh);
    let solid = view.projection == Projection::Corner;
    if solid {
        let near = |facet: &Facet| facet.nearness(view, &scene.points);
        facets.sort_by(|a, b| near(a).total_cmp(&near(b)));
    }
    if scene.field.is_none() && !solid {
        drawing.tile(facets.iter().flat_map(|facet| facet.outline(at)).collect(), Color::BODY);
    }
    for facet in &facets {
        match &scene.field {
            None if solid => drawing.tile(facet.outline(at), Color::BODY),
            None => {}
            Some(field) => {
                for (tile, value) in facet.tiles(at, field, 4.0) {
                    let t = (value - range[0]) / (range[1] - range[0]);
                    drawing.tile(polygon(&tile), palette::field(t));
                }
            }
        }
        if solid {
            drawing.stroke(facet.outline(at), Stroke::full(Color::CELLS, 0.5));
        }
    }
    if solid {
        return;
    }
    let (inner, outer): (Vec<_>, Vec<_>) = edges(&facets).into_iter().partition(|(_, count)| *count > 1);
    for (edges, stroke) in [(inner, Stroke::full(Color::CELLS, 0.5)), (outer, Stroke::full(Color::BLACK, 1.0))] {
        drawing.stroke(edges.iter().flat_map(|(edge, _)| edge_path(edge, at)).collect(), stroke);
    }
}

/// Draws the axes of space at the corner of a solid picture.
pub(super) fn draw_triad(drawing: &mut Drawing, view: &View) {
    // Beside the frame, where no body is.
    let origin = [view.frame.x - 28.0, view.frame.bottom() + 20.0];
    for (axis, name) in ["x", "y", "z"].iter().enumerate() {
        let mut unit = [0.0; 3];
        unit[axis] = 1.0;
        let [x, y] = view.projection.flat(unit);
        let tip = [origin[0] + 24.0 * x, origin[1] - 24.0 * y];
        drawing.stroke(polyline(&[origin, tip]), Stroke::full(Color::BLACK, 1.0));
        let beyond = [origin[0] + 33.0 * x, origin[1] - 33.0 * y + 0.36 * SMALL];
        drawing.label(Label::new(beyond, *name, SMALL).anchored(Anchor::Middle));
    }
}
