//! Rigid tools and their profiles.

use super::solid_tool::{Cone, Cylinder, Extrude, FacetKeys, Plane, Revolve, Sphere, StlKeys, SweepKeys, Torus};
use crate::diagnose::Diagnostic;
use crate::form::{Form, list, number, table, table_of, tag};
use crate::reader::Reader;
use crate::schema::{Key, Presence, Schema};
use crate::source::{Place, Spot};
use crate::tree::Node;
use asperity_core::declare::{Range, unit};
use asperity_core::tensor::Vec3;
use asperity_core::tool::shapes::{self, ShapeKind};

table! {
    /// A rigid tool: in the plane a profile; in space a profile that is revolved, extruded or swept, facets, a file
    /// of triangles, or one of the simple shapes.
    pub struct ToolKeys check tool {
        /// Its profile: segments in the order of travel, each from the end of the one before, with the tool's material
        /// on the left.
        profile: Option<Spot<Vec<SegmentKeys>>> =
            list(SegmentForm, 1..=usize::MAX).spot().unless_given("another key says its shape"),
        /// Radius of the arcs that round every corner between two straight segments of the profile.
        fillet: Option<Spot<f64>> =
            number(unit::LENGTH, Range::POSITIVE).spot().unless_given("corners stay sharp"),
        /// In space: the profile revolved once about an axis; its x is the distance from the axis, its y along it.
        revolve: Option<Revolve> = table_of().unless_given("not revolved"),
        /// In space: the profile carried along a line; its ends stay open.
        extrude: Option<Extrude> = table_of().unless_given("not extruded"),
        /// In space: the profile swept along a path of straight lines and arcs. One that begins or ends at `x = -radius`, over the middles
        /// of the arcs, is joined there by a flat face if the path is closed and turns left only.
        sweep: Option<SweepKeys> = table_of().unless_given("not swept"),
        /// In space: triangles and quadrilaterals between nodes.
        facets: Option<FacetKeys> = table_of().unless_given("another key says its shape"),
        /// In space: the triangles of an STL file.
        stl: Option<StlKeys> = table_of().unless_given("another key says its shape"),
        /// In space: a square plate.
        plane: Option<Plane> = table_of().unless_given("another key says its shape"),
        /// In space: a ball.
        sphere: Option<Sphere> = table_of().unless_given("another key says its shape"),
        /// In space: a cylinder with its two ends.
        cylinder: Option<Cylinder> = table_of().unless_given("another key says its shape"),
        /// In space: a cone or frustum with its ends.
        cone: Option<Cone> = table_of().unless_given("another key says its shape"),
        /// In space: a ring.
        torus: Option<Torus> = table_of().unless_given("another key says its shape"),
        /// The point that its motion moves and about which it turns; where its force and torque act.
        reference: Option<Spot<Vec<f64>>> =
            list(number(unit::LENGTH, Range::ANY), 2..=3).spot().computed("the origin"),
    }
}

impl ToolKeys {
    /// What is said of how a profile makes a surface.
    pub fn swept(&self) -> Vec<&'static str> {
        let all =
            [("revolve", self.revolve.is_some()), ("extrude", self.extrude.is_some()), ("sweep", self.sweep.is_some())];
        all.iter().filter(|(_, said)| *said).map(|(key, _)| *key).collect()
    }
}

/// A tool has one shape, and only profiles are swept.
fn tool(keys: &ToolKeys, reader: &mut Reader) {
    let shapes = [
        ("profile", keys.profile.is_some()),
        ("facets", keys.facets.is_some()),
        ("stl", keys.stl.is_some()),
        ("plane", keys.plane.is_some()),
        ("sphere", keys.sphere.is_some()),
        ("cylinder", keys.cylinder.is_some()),
        ("cone", keys.cone.is_some()),
        ("torus", keys.torus.is_some()),
    ];
    let said: Vec<&str> = shapes.iter().filter(|(_, said)| *said).map(|(key, _)| *key).collect();
    let path = reader.path();
    let mut refuse = |what: String, help: &str| reader.report(Diagnostic::error(what).at(keys.place).help(help));
    match said[..] {
        [_] => {}
        [] => {
            let names = shapes.iter().map(|(key, _)| format!("`{key}`")).collect::<Vec<_>>().join(", ");
            refuse(format!("`{path}` says no shape"), &format!("give one of {names}"));
        }
        [first, second, ..] => {
            refuse(format!("`{path}` says both `{first}` and `{second}`"), "keep one: a tool has one shape");
        }
    }
    let swept = keys.swept();
    if keys.fillet.is_some() && keys.profile.is_none() {
        refuse(format!("`{path}.fillet` has no profile to act on"), "cylinders and cones have a fillet of their own");
    }
    match swept[..] {
        [key] if keys.profile.is_none() => {
            refuse(format!("`{path}.{key}` has no profile to act on"), "give `profile`, or remove it");
        }
        [one, other, ..] => refuse(format!("`{path}` says both `{one}` and `{other}`"), "keep one of them"),
        _ => {}
    }
}

/// A segment of a profile: its shape and its nodes.
#[derive(Debug, Clone)]
pub struct SegmentKeys {
    /// Its registered shape.
    pub kind: &'static ShapeKind,
    /// Its nodes.
    pub nodes: Vec<Vec3>,
    /// Where it stands.
    pub place: Place,
}

struct SegmentForm;

fn nodes(kind: &ShapeKind) -> impl Form<Value = Vec<Vec<f64>>> {
    list(list(number(unit::LENGTH, Range::ANY), 2..=2), kind.nodes..=kind.nodes)
}

impl Form for SegmentForm {
    type Value = SegmentKeys;
    fn schema(&self) -> Schema {
        let key = |kind: &&'static ShapeKind| Key {
            name: kind.key,
            doc: kind.meaning,
            schema: nodes(kind).schema(),
            presence: Presence::Required,
        };
        Schema::OneOf(shapes::ALL.iter().map(key).collect())
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<SegmentKeys> {
        let keys: Vec<&str> = shapes::ALL.iter().map(|kind| kind.key).collect();
        let entry = tag(node, &keys, reader)?;
        let kind = shapes::ALL.iter().copied().find(|kind| kind.key == entry.key)?;
        let points = reader.under(kind.key, |reader| nodes(kind).read(&entry.node, reader))?;
        let nodes = points.iter().map(|p| Vec3([p[0], p[1], 0.0])).collect();
        Some(SegmentKeys { kind, nodes, place: node.place })
    }
}
