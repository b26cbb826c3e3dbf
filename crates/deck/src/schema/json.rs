//! The schema as JSON Schema (draft 2020-12), for editors that complete and check while one types.

use super::{Key, Presence, Schema, interface_root, point_root, root};
use crate::tree::{Node, Value as Written};
use asperity_core::declare::Range;
use serde_json::{Map, Value, json};

/// The JSON Schema of a deck.
pub fn json_schema() -> Value {
    titled("Asperity deck", &root())
}

/// The JSON Schema of a deck for one material point.
pub fn point_json_schema() -> Value {
    titled("Asperity deck of a material point", &point_root())
}

/// The JSON Schema of a deck for one point of an interface.
pub fn interface_json_schema() -> Value {
    titled("Asperity deck of a point of an interface", &interface_root())
}

fn titled(title: &str, root: &Schema) -> Value {
    let mut schema = object(root);
    schema.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    schema.insert("title".into(), json!(title));
    Value::Object(schema)
}

fn object(schema: &Schema) -> Map<String, Value> {
    let value = match schema {
        Schema::Number { unit, range } => number(unit, range),
        Schema::Whole { least, most } if *most == u64::MAX => json!({ "type": "integer", "minimum": least }),
        Schema::Whole { least, most } => json!({ "type": "integer", "minimum": least, "maximum": most }),
        Schema::Flag => json!({ "type": "boolean" }),
        Schema::Text(what) => json!({ "type": "string", "description": what }),
        Schema::Word(words) => word(words),
        Schema::Name(names) => json!({ "type": "string", "description": names.noun() }),
        Schema::List { item, least, most } => list(item, *least, *most),
        Schema::Map { item, .. } => json!({ "type": "object", "additionalProperties": object(item) }),
        Schema::Table(keys) => table(keys, true),
        Schema::OneOf(keys) => table(keys, false),
    };
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}

fn number(unit: &str, range: &Range) -> Value {
    let mut map = Map::new();
    map.insert("type".into(), json!("number"));
    if !unit.is_empty() {
        map.insert("description".into(), json!(unit));
    }
    if let Some((end, included)) = range.least {
        map.insert(if included { "minimum" } else { "exclusiveMinimum" }.into(), json!(end));
    }
    if let Some((end, included)) = range.most {
        map.insert(if included { "maximum" } else { "exclusiveMaximum" }.into(), json!(end));
    }
    Value::Object(map)
}

fn word(words: &[(&str, &str)]) -> Value {
    let one = |(word, meaning): &(&str, &str)| json!({ "const": word, "description": meaning });
    json!({ "oneOf": words.iter().map(one).collect::<Vec<_>>() })
}

fn list(item: &Schema, least: usize, most: usize) -> Value {
    let mut value = json!({ "type": "array", "items": object(item), "minItems": least });
    if most != usize::MAX {
        value["maxItems"] = json!(most);
    }
    value
}

/// A table of keys of which the required ones must be there, or just one.
fn table(keys: &[Key], all: bool) -> Value {
    let properties: Map<String, Value> = keys.iter().map(|key| (key.name.to_owned(), property(key))).collect();
    let mut value = json!({ "type": "object", "properties": properties, "additionalProperties": false });
    if all {
        let required = keys.iter().filter(|key| key.presence == Presence::Required).map(|key| key.name);
        value["required"] = json!(required.collect::<Vec<_>>());
    } else {
        value["minProperties"] = json!(1);
        value["maxProperties"] = json!(1);
    }
    value
}

fn property(key: &Key) -> Value {
    let mut map = object(&key.schema);
    let unit = map.get("description").and_then(Value::as_str).map(|unit| format!(" ({unit})")).unwrap_or_default();
    let unless = match &key.presence {
        Presence::Optional(words) => format!(" If not given: {words}."),
        _ => String::new(),
    };
    map.insert("description".into(), json!(format!("{}{unit}{unless}", key.doc)));
    if let Presence::Default(text) = &key.presence {
        map.insert("default".into(), plain(&Node::written(text, Default::default())));
    }
    Value::Object(map)
}

/// A default as JSON.
fn plain(node: &Node) -> Value {
    match &node.value {
        Written::Text(text) => json!(text),
        Written::Whole(x) => json!(x),
        Written::Real(x) => json!(x),
        Written::Flag(flag) => json!(flag),
        Written::Date => Value::Null,
        Written::List(items) => items.iter().map(plain).collect(),
        Written::Table(entries) => {
            Value::Object(entries.iter().map(|entry| (entry.key.clone(), plain(&entry.node))).collect())
        }
    }
}
