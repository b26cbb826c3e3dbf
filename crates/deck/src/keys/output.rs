//! What is written.

use crate::form::{Form, Words, flag, list, one_of, refers, table, table_of, text, whole, word};
use crate::reader::Name;
use crate::schema::Names;
use crate::source::Spot;
use asperity_results::output::{Export, Keep, Totals};

table! {
    /// What is written, and how often.
    pub struct OutputKeys {
        /// A frame of fields every so many increments; the last of a step always.
        every: usize = whole(1..=1_000_000).or("1"),
        /// A checkpoint every so many increments, and at the end of each step.
        checkpoint_every: usize = whole(1..=1_000_000).or("10"),
        /// Which checkpoints stay in the result directory, to go on from.
        checkpoints: Keep = word().or("\"last\""),
        /// Whether the standard pictures are drawn at the end; `asperity figure` draws them at any time.
        pictures: bool = flag().or("true"),
        /// Files for other programs, with a frame as often as those of VTU.
        export: Vec<Export> = list(word(), 0..=usize::MAX).or("[]"),
        /// Tables of values in `results.dat`, as CalculiX prints them, as often as frames.
        print: Vec<PrintKeys> = list(table_of(), 0..=usize::MAX).or("[]"),
    }
}

impl Words for Keep {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::Last, "last", "the last one"),
            (Self::Steps, "steps", "those at the ends of steps too, for `asperity restart --from STEP`"),
            (Self::All, "all", "every one that is written, for `asperity restart --from TIME`"),
        ]
    }
}

table! {
    /// A table of values.
    pub struct PrintKeys {
        /// Whose values.
        of: PrintedOf = PrintedOf::form().required(),
        /// What is printed: quantities at nodes, at the integration points of cells, or at the points of a contact, by the names
        /// that they have in the VTU files.
        quantities: Vec<Spot<String>> = list(text(QUANTITY).spot(), 1..=usize::MAX).required(),
        /// Whether values or their sum are printed.
        totals: Totals = word().or("\"no\""),
    }
}

/// What the schema calls the name of a quantity.
pub const QUANTITY: &str = "the name of a quantity";

one_of! {
    /// Whose values are printed.
    pub enum PrintedOf {
        /// Of the nodes of a group.
        Nodes(Name) = "nodes" => refers(Names::Group),
        /// Of the integration points of the cells of a group.
        Cells(Name) = "cells" => refers(Names::Cells),
        /// Of the points of a contact.
        Contact(Name) = "contact" => refers(Names::Contact),
    }
}

impl Words for Export {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        let frd = "`results.frd`, for CalculiX GraphiX, PrePoMax and FreeCAD: displacements, stress, strain, plastic strain, \
                   reactions and contact at the nodes";
        let xdmf = "`results.xdmf`, all frames of the bodies in one file, for ParaView, PyVista and meshio";
        let deformed = "`deformed.pvd`, VTU with the points of the bodies at their present places";
        vec![(Self::Frd, "frd", frd), (Self::Xdmf, "xdmf", xdmf), (Self::Deformed, "deformed", deformed)]
    }
}

impl Words for Totals {
    fn words() -> Vec<(Self, &'static str, &'static str)> {
        vec![
            (Self::No, "no", "values"),
            (Self::Yes, "yes", "values and their sum"),
            (Self::Only, "only", "the sum alone"),
        ]
    }
}
