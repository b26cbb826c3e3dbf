//! `asperity schema`: the declared keys, for editors and for readers.

use super::{Outcome, print};
use crate::arguments::Schema;
use asperity::deck::schema::{json_schema, manual, point_json_schema, point_manual};

/// Prints the JSON Schema, or the manual's page.
pub fn schema(arguments: &Schema) -> Outcome {
    print(&match (arguments.manual, arguments.point) {
        (true, false) => manual(),
        (true, true) => point_manual(),
        (false, false) => format!("{:#}\n", json_schema()),
        (false, true) => format!("{:#}\n", point_json_schema()),
    })
}
