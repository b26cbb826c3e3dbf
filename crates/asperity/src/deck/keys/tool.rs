//! Rigid tools and their profiles.

use crate::deck::form::{Form, list, number, table, tag};
use crate::deck::reader::Reader;
use crate::deck::schema::{Key, Presence, Schema};
use crate::deck::source::{Place, Spot};
use crate::deck::tree::Node;
use crate::declare::{Range, unit};
use crate::tensor::Vec3;
use crate::tool::shapes::{self, Kind};

table! {
    /// A rigid tool in the plane.
    pub struct ToolKeys {
        /// Its profile: segments in the order of travel, each from the end of the one before, with the tool's material
        /// on the left.
        profile: Spot<Vec<Segment>> = list(SegmentForm, 1..=usize::MAX).spot().required(),
        /// The point that its motion moves and about which it turns; where its force and torque act.
        reference: Vec<f64> = list(number(unit::LENGTH, Range::ANY), 2..=2).or("[0.0, 0.0]"),
    }
}

/// A segment of a profile: its shape and its nodes.
#[derive(Debug, Clone)]
pub struct Segment {
    /// Its registered shape.
    pub kind: &'static Kind,
    /// Its nodes.
    pub nodes: Vec<Vec3>,
    /// Where it stands.
    pub place: Place,
}

struct SegmentForm;

fn nodes(kind: &Kind) -> impl Form<Value = Vec<Vec<f64>>> {
    list(list(number(unit::LENGTH, Range::ANY), 2..=2), kind.nodes..=kind.nodes)
}

impl Form for SegmentForm {
    type Value = Segment;
    fn schema(&self) -> Schema {
        let key = |kind: &&'static Kind| Key {
            name: kind.key,
            doc: kind.meaning,
            schema: nodes(kind).schema(),
            presence: Presence::Required,
        };
        Schema::OneOf(shapes::ALL.iter().map(key).collect())
    }
    fn read(&self, node: &Node, reader: &mut Reader) -> Option<Segment> {
        let keys: Vec<&str> = shapes::ALL.iter().map(|kind| kind.key).collect();
        let entry = tag(node, &keys, reader)?;
        let kind = shapes::ALL.iter().copied().find(|kind| kind.key == entry.key)?;
        let points = reader.under(kind.key, |reader| nodes(kind).read(&entry.node, reader))?;
        let nodes = points.iter().map(|p| Vec3([p[0], p[1], 0.0])).collect();
        Some(Segment { kind, nodes, place: node.place })
    }
}
