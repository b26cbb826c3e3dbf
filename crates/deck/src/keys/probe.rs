//! Probes: what is read where.

use super::output::QUANTITY;
use crate::form::{Form, Words, list, number, one_of, refers, table, table_of, text, whole, word};
use crate::reader::Name;
use crate::schema::Names;
use crate::source::Spot;
use asperity_core::declare::{Range, unit};
use asperity_results::output::probe::Take;

table! {
    /// Quantities at a chosen place, a row an increment in `probe.NAME.csv`.
    pub struct ProbeKeys {
        /// Where.
        at: ProbeAt = ProbeAt::form().required(),
        /// Quantities at nodes by the names that they have in the VTU files, where `_averaged` may be left out; with a
        /// component, a principal value or another invariant behind a point: `displacement.y`, `cauchy_stress.major`.
        quantities: Vec<Spot<String>> = list(text(QUANTITY).spot(), 1..=usize::MAX).required(),
        /// What is taken of the values of a group.
        take: Option<Spot<Vec<Take>>> = list(word(), 1..=4).spot().unless_given("the mean"),
    }
}

one_of! {
    /// Where a probe reads.
    pub enum ProbeAt {
        /// At the nodes of a group.
        Group(Name) = "group" => refers(Names::Group),
        /// At a node, by its number in the mesh's file; in generated meshes counted from 1.
        Node(Spot<usize>) = "node" => whole(1..=u64::MAX).spot(),
        /// At the point of a body that lies at these coordinates before any motion, and moves with it.
        Point(Spot<Vec<f64>>) = "point" => list(number(unit::LENGTH, Range::ANY), 2..=3).spot(),
        /// At points along a line through bodies before any motion, which move with them.
        Path(PathKeys) = "path" => table_of(),
    }
}

table! {
    /// A line of points.
    pub struct PathKeys {
        /// Where it begins.
        from: Spot<Vec<f64>> = list(number(unit::LENGTH, Range::ANY), 2..=3).spot().required(),
        /// Where it ends.
        to: Spot<Vec<f64>> = list(number(unit::LENGTH, Range::ANY), 2..=3).spot().required(),
        /// How many points, both ends included.
        points: usize = whole(2..=100_000).or("11"),
    }
}

impl Words for Take {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        let meaning = |take| match take {
            Self::Mean => "the mean over the group's sides, or where it has none over its cells, or over its nodes",
            Self::Least => "the least at its nodes",
            Self::Greatest => "the greatest at its nodes",
            Self::Sum => "the sum over its nodes, of forces",
        };
        Self::ALL.map(|(take, word)| (take, word, meaning(take))).into()
    }
}
