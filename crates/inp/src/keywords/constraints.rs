//! Keywords of nodes that have axes of their own, go with others, or are moved before the first step.

use super::{Keyword, late, left, of_model, one_of, refused, used};
use crate::read::Reader;

/// In the order of the manual.
pub static CONSTRAINTS: &[Keyword] = &[
    of_model(
        "TRANSFORM",
        Reader::transform,
        &[used("NSET"), one_of("TYPE", &["R", "C"])],
        "`along` of displacements; components of forces and equations",
    ),
    late("MPC", Reader::mpc, &[left("MODE")], "`equation` of types PIN and TIE, `rigid` of type BEAM (Abaqus)"),
    late(
        "KINEMATIC COUPLING",
        Reader::kinematic_coupling,
        &[used("REF NODE")],
        "`rigid`, or `equation` along some axes",
    ),
    late(
        "CLEARANCE",
        Reader::clearance,
        &[
            used("SLAVE"),
            used("MASTER"),
            used("VALUE"),
            refused("CPSET", "name the surfaces by SLAVE and MASTER"),
            refused("TABULAR", "give one VALUE for all nodes"),
            refused("BOLT", "give one VALUE for all nodes"),
        ],
        "nodes of the slave are moved to that distance, without strain",
    ),
];
