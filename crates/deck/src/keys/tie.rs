//! Surfaces that are glued.

use crate::form::{Form, number, refers, table, word, words};
use crate::reader::Name;
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};

table! {
    /// A surface glued to another where it is, in all steps.
    pub struct TieKeys {
        /// The group of sides whose nodes follow; those of the target do where the faces of this one are 1.5 times as long and more.
        surface: Name = refers(Names::Sides).required(),
        /// The group of sides that they follow.
        target: Name = refers(Names::Sides).required(),
        /// The largest gap or overlap across which they are glued; the deck is refused where the surfaces lie a little beyond it.
        tolerance: Option<Spot<f64>> = number(unit::LENGTH, Range::POSITIVE).spot().computed(
            "a twentieth of the mean size of their faces, and what the facets of curved ones stand off"),
        /// What becomes of the gap between them.
        gap: TieGap = word().or("\"close\""),
    }
}

words! {
    /// What becomes of the gap between surfaces that are glued.
    pub enum TieGap {
        /// The nodes of the surface are moved to where the target is, without strain, so that both turn as one.
        Close = "close",
        /// It stays what it is, along the axes: turning both strains them by as much as it is wide.
        Keep = "keep",
    }
}
