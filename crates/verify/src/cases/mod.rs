//! The cases, in the order of the report.

mod hertz_cylinder;
mod tube;

use crate::Case;

/// All cases.
pub const ALL: &[&Case] = &[&hertz_cylinder::CASE, &tube::CASE];
