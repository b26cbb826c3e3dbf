//! Keywords of nodes that have axes of their own, or go with others.

use super::{Keyword, late, left, of_model, one_of, used};
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
];
