//! Shapes of rigid tools in space.

use crate::diagnose::Diagnostic;
use crate::form::{Form, flag, list, number, table, text, whole};
use crate::reader::Reader;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};

table! {
    /// An axis of revolution.
    pub struct Revolve {
        /// Where the profile's origin lies.
        origin: Vec<f64> = point().or("[0.0, 0.0, 0.0]"),
        /// The profile's y axis, of any length.
        axis: Vec<f64> = direction().or("[0.0, 0.0, 1.0]"),
    }
}

table! {
    /// A line of extrusion.
    pub struct Extrude {
        /// Where the profile's origin lies at one end.
        origin: Vec<f64> = point().or("[0.0, 0.0, 0.0]"),
        /// From that end to the other. It is across the profile: x, y and this are right-handed.
        along: Vec<f64> = point().required(),
        /// The profile's x axis, of any length.
        x: Vec<f64> = direction().or("[1.0, 0.0, 0.0]"),
    }
}

table! {
    /// A path in a plane, along which a profile is swept.
    pub struct SweepKeys {
        /// Corners `[x, y]` in the order of travel; the profile's x points to the right of it.
        path: Vec<Vec<f64>> = list(list(number(unit::LENGTH, Range::ANY), 2..=2), 2..=usize::MAX).required(),
        /// Radius of the arcs by which the corners are rounded.
        radius: f64 = number(unit::LENGTH, Range::POSITIVE).required(),
        /// Whether the path goes on to its first corner.
        closed: bool = flag().or("true"),
        /// Where the path's origin lies.
        origin: Vec<f64> = point().or("[0.0, 0.0, 0.0]"),
        /// What the path's plane is across, and the profile's y axis, of any length.
        axis: Vec<f64> = direction().or("[0.0, 0.0, 1.0]"),
        /// The path's x axis, of any length; its y axis makes them right-handed.
        x: Vec<f64> = direction().or("[1.0, 0.0, 0.0]"),
    }
}

table! {
    /// Facets between nodes.
    pub struct FacetKeys check facets {
        /// Coordinates `[x, y, z]` of the nodes.
        nodes: Vec<Vec<f64>> = list(point(), 3..=usize::MAX).required(),
        /// Three or four nodes a facet, numbered from 1, counter-clockwise as seen from outside. Four that do not lie in
        /// a plane span a bilinear surface.
        faces: Spot<Vec<Spot<Vec<usize>>>> =
            list(list(whole(1..=1_000_000_000), 3..=4).spot(), 1..=usize::MAX).spot().required(),
    }
}

table! {
    /// An STL file, ASCII or binary.
    pub struct StlKeys {
        /// Path of the file, from the folder of the deck.
        file: Spot<String> = text("the path of an STL file").spot().required(),
        /// What its coordinates are multiplied by.
        scale: f64 = number(unit::NONE, Range::POSITIVE).or("1.0"),
        /// Where its origin lies.
        origin: Vec<f64> = point().or("[0.0, 0.0, 0.0]"),
    }
}

table! {
    /// A square plate.
    pub struct Plane {
        /// Its middle.
        at: Vec<f64> = point().required(),
        /// Where its face looks, of any length.
        normal: Vec<f64> = direction().required(),
        /// Its sides.
        side: f64 = number(unit::LENGTH, Range::POSITIVE).required(),
    }
}

table! {
    /// A ball.
    pub struct Sphere {
        /// Its centre.
        center: Vec<f64> = point().required(),
        /// Its radius.
        radius: f64 = number(unit::LENGTH, Range::POSITIVE).required(),
    }
}

table! {
    /// A cylinder.
    pub struct Cylinder {
        /// Middle of one end.
        from: Vec<f64> = point().required(),
        /// Middle of the other end.
        to: Vec<f64> = point().required(),
        /// Its radius.
        radius: f64 = number(unit::LENGTH, Range::POSITIVE).required(),
        /// Radius by which its rims are rounded.
        fillet: f64 = number(unit::LENGTH, Range::NOT_NEGATIVE).or("0.0"),
    }
}

table! {
    /// A cone or frustum.
    pub struct Cone {
        /// Middle of one end.
        from: Vec<f64> = point().required(),
        /// Middle of the other end.
        to: Vec<f64> = point().required(),
        /// Radii of the two ends, one of which may be zero.
        radii: Vec<f64> = list(number(unit::LENGTH, Range::NOT_NEGATIVE), 2..=2).required(),
        /// Radius by which its rims are rounded.
        fillet: f64 = number(unit::LENGTH, Range::NOT_NEGATIVE).or("0.0"),
    }
}

table! {
    /// A ring.
    pub struct Torus {
        /// Its centre.
        center: Vec<f64> = point().required(),
        /// Its axis, of any length.
        axis: Vec<f64> = direction().required(),
        /// From its centre to the middle of its tube.
        radius: f64 = number(unit::LENGTH, Range::POSITIVE).required(),
        /// Radius of its tube.
        tube: f64 = number(unit::LENGTH, Range::POSITIVE).required(),
    }
}

pub(super) fn point() -> impl Form<Value = Vec<f64>> {
    list(number(unit::LENGTH, Range::ANY), 3..=3)
}

pub(super) fn direction() -> impl Form<Value = Vec<f64>> {
    list(number(unit::NONE, Range::ANY), 3..=3)
}

/// Every facet names nodes that there are.
fn facets(keys: &FacetKeys, reader: &mut Reader) {
    let nodes = keys.nodes.len();
    for face in &keys.faces.value {
        if let Some(node) = face.value.iter().find(|&&node| node > nodes) {
            let what = format!("`{}`: there is no node {node} among {nodes}", reader.path());
            reader.report(Diagnostic::error(what).at(face.place).help("nodes are numbered from 1"));
            return;
        }
    }
}
