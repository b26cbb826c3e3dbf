//! Contacts of every kind under one roof, for reports.

use asperity_core::contact::field::FieldContact;
use asperity_core::contact::{ContactOptions, ContactRecord, ContactSides, PaperContact, Sample};
use asperity_core::declare::Variable;
use asperity_core::interface::Interface;
use asperity_core::mesh::Side;
use asperity_core::mesh::cells::{Cell, MAX_NODES};
use asperity_core::system::History;
use asperity_core::tensor::Vec3;

/// A contact of any kind.
#[derive(Clone, Copy)]
pub enum Touching<'a> {
    /// At Gauss points.
    Points(&'a PaperContact),
    /// A field of nodal values, in either.
    Field(&'a FieldContact),
}

/// What a record of a contact speaks for.
pub enum Stand {
    /// A part of a face: its number, and the corners with their shape functions there.
    Face(usize, Vec<(usize, f64)>),
    /// A node of the mesh.
    Node(usize),
    /// A tip of a tool, which stands on no node of the surface.
    Apart,
}

/// The corners of a face with the shape functions of the cell of first degree at `xi`.
fn corners(kind: &Cell, nodes: &[usize], xi: [f64; 3]) -> Vec<(usize, f64)> {
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    (kind.linear.shape)(xi, &mut n, &mut dn);
    nodes.iter().copied().zip(n).take(kind.linear.nodes.len()).collect()
}

impl Touching<'_> {
    /// Both of its sides.
    fn both(&self) -> &ContactSides {
        match self {
            Self::Points(contact) => contact,
            Self::Field(contact) => contact,
        }
    }
    /// The sides of the mesh that are the surface, each once.
    pub fn sides(&self) -> Vec<Side> {
        let mut sides: Vec<Side> = self.both().surface().faces.iter().map(|face| face.side).collect();
        // The halves of an edge of second degree follow each other.
        sides.dedup();
        sides
    }
    /// What the record in place `slot` speaks for.
    pub fn stand(&self, slot: usize) -> Stand {
        match self {
            Self::Points(contact) => {
                let (point, face) = (&contact.points()[slot], contact.face(slot));
                Stand::Face(point.face, corners(face.kind, &face.nodes, [point.xi[0], point.xi[1], 0.0]))
            }
            Self::Field(contact) => contact.node_at(slot).map_or(Stand::Apart, Stand::Node),
        }
    }
    /// The user's name for it.
    pub fn name(&self) -> &str {
        self.both().title()
    }
    /// How it is computed.
    pub fn options(&self) -> &ContactOptions {
        self.both().options()
    }
    /// Variables of its law.
    pub fn variables(&self) -> &'static [Variable] {
        self.law().variables()
    }
    /// All points in an accepted state, with this term's lane of its history.
    pub fn records(&self, u: &[f64], history: &History) -> Vec<ContactRecord> {
        match self {
            Self::Points(contact) => contact.records(u, history),
            Self::Field(contact) => contact.records(u, history),
        }
    }
    /// Where moments are taken about.
    pub fn pole(&self, u: &[f64]) -> Vec3 {
        self.both().pole(u)
    }
    /// False contacts that the search refuses at displacements `u`.
    pub fn false_contacts(&self, u: &[f64]) -> usize {
        match self {
            Self::Points(contact) => contact.search(u).1.total(),
            Self::Field(_) => 0,
        }
    }
    /// The deepest place of the surface between its points.
    pub fn sampled(&self, u: &[f64], history: &History) -> Option<Sample> {
        match self {
            Self::Points(contact) => contact.sampled(u, history),
            Self::Field(_) => None,
        }
    }
    /// Whether its target carries points of its own: one of two passes.
    pub fn loads_itself(&self) -> bool {
        match self {
            Self::Points(contact) => contact.loads_itself(),
            Self::Field(_) => false,
        }
    }
    /// The law of its interface.
    pub fn law(&self) -> &dyn Interface {
        self.both().law()
    }
    /// Part of the interface's energy that is counted here.
    pub fn share(&self) -> f64 {
        match self {
            Self::Points(contact) => contact.options().loads.share(),
            Self::Field(_) => 1.0,
        }
    }
    /// How much of its pressure facets stand for, where the target deforms.
    pub fn facet_ratio(&self, u: &[f64], history: &History) -> Option<f64> {
        match self {
            Self::Points(contact) => contact.facet_ratio(u, history),
            Self::Field(_) => None,
        }
    }
    /// The most points of a field that are closed beside one another.
    pub fn largest_patch(&self, history: &History) -> Option<usize> {
        match self {
            Self::Points(_) => None,
            Self::Field(contact) => Some(contact.largest_patch(history)),
        }
    }
    /// By how much the pressure of a field changes from node to node, and where most.
    pub fn roughness(&self, history: &History) -> Option<(f64, usize)> {
        match self {
            Self::Points(_) => None,
            Self::Field(contact) => contact.roughness(history),
        }
    }
    /// The part of the force that a field's tips of a tool bear.
    pub fn borne_by_tips(&self, history: &History) -> f64 {
        match self {
            Self::Points(_) => 0.0,
            Self::Field(contact) => contact.borne_by_tips(history),
        }
    }
    /// The largest penetration that augmentation leaves at a node, over the size of its elements, where there is any.
    pub fn nodal_penetration(&self, history: &History) -> Option<f64> {
        match self {
            Self::Points(_) => None,
            Self::Field(contact) => contact.nodal_penetration(history),
        }
    }
    /// Area of the faces that bear over that which they see of a tool in space.
    pub fn coarseness(&self, history: &History) -> Option<f64> {
        match self {
            Self::Points(_) => None,
            Self::Field(contact) => contact.coarseness(history),
        }
    }
    /// Nodes whose distance is the length of an edge, or of the first edge of a face.
    pub fn edge_ends(&self, edge: usize) -> Option<[usize; 2]> {
        let nodes = &self.both().surface().faces[edge].nodes;
        nodes.first().zip(nodes.get(1)).map(|(a, b)| [*a, *b])
    }
}
