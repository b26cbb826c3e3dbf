//! `asperity schema`: the declared keys, for editors and for readers.

use super::{Outcome, print};
use crate::arguments::Schema;
use asperity::deck::schema::{
    interface_json_schema, interface_manual, json_schema, manual, point_json_schema, point_manual,
};

/// Prints the JSON Schema, or the manual's page.
pub fn schema(arguments: &Schema) -> Outcome {
    if arguments.keywords {
        return print(&inp::manual());
    }
    let (page, schema): (fn() -> String, fn() -> _) = match (arguments.point, arguments.interface) {
        (true, _) => (point_manual, point_json_schema),
        (_, true) => (interface_manual, interface_json_schema),
        _ => (manual, json_schema),
    };
    print(&if arguments.manual { page() } else { format!("{:#}\n", schema()) })
}
