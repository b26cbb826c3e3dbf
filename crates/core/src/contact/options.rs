//! How a contact is computed.

use super::augment::Augmentation;
use super::overlap::Overlap;
use crate::tensor::Vec3;

/// How a penalty is raised that no user gave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaisedPenalty {
    /// Mean penetration from which on it is, without augmentation,
    pub from: f64,
    /// and up to which stress per length.
    pub most: f64,
}

/// How a contact is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactOptions {
    /// Normal penalty, a stress per length; the least where it is raised.
    pub penalty: f64,
    /// Modulus of both sides against each other, the inverse of the sum of the inverses of what stands behind each; that of the only one
    /// that deforms.
    pub modulus: f64,
    /// How the normal penalty of a field is raised where penetration takes up energy that is the bodies', or where augmentation is slow;
    /// none where it stays as it is.
    pub raised: Option<RaisedPenalty>,
    /// Tangential penalty, a stress per length; the largest where it follows from an elastic slip.
    pub tangential_penalty: f64,
    /// Elastic slip under the friction that the pressure of the accepted state allows, over the length of an edge or face;
    /// none where the tangential penalty stays as it is.
    pub elastic_slip: Option<f64>,
    /// Thickness in the plane cases.
    pub thickness: f64,
    /// Which side a contact point loads.
    pub loads: LoadedSides,
    /// Whether the tangent holds the coupling of the two sides.
    pub coupling: bool,
    /// How far penetration and elastic slip are taken out by multipliers, if they are.
    pub augmentation: Option<Augmentation>,
    /// What becomes of penetration before the first increment.
    pub overlap: Overlap,
    /// Depth of Archard's wear for a unit of pressure times sliding, if the surface wears; by a law that is [`Wearing`](crate::interface::Wearing) it
    /// recedes by it.
    pub wear: Option<f64>,
}

/// A node that is to be moved before the first increment, without strain, by how much, and the cell behind it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    /// The node.
    pub node: usize,
    /// The way.
    pub by: Vec3,
    /// A cell behind it.
    pub cell: usize,
}

/// Name of the second of two passes, whose points lie on what is the target of the first.
pub fn second_name(name: &str) -> String {
    format!("{name}.target")
}

/// Which side a contact point loads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadedSides {
    /// The surface and its target: one pass.
    Both,
    /// The surface alone, since the target carries contact points of its own: one of two passes.
    Own,
}

impl LoadedSides {
    /// Part of the energy of the interface that is counted here: with two passes each side counts half.
    pub fn share(self) -> f64 {
        match self {
            Self::Both => 1.0,
            Self::Own => 0.5,
        }
    }
}
