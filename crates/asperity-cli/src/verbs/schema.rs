//! `asperity schema`: the declared keys, for editors and for readers.

use super::{Outcome, print};
use crate::arguments::Schema;
use asperity::deck::schema::{json_schema, manual};

/// Prints the JSON Schema, or the manual's page.
pub fn schema(arguments: &Schema) -> Outcome {
    print(&if arguments.manual { manual() } else { format!("{:#}\n", json_schema()) })
}
