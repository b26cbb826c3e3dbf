//! The JSON Schema for editors: it uses only keywords that the small validator below understands, takes the good decks
//! and refuses decks whose fault a schema can express.

use asperity::deck::schema::json_schema;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests").join(name)
}

fn deck(path: &Path) -> Option<Value> {
    let table: toml::Table = String::from_utf8(std::fs::read(path).unwrap()).ok()?.parse().ok()?;
    serde_json::to_value(table).ok()
}

/// Whether a value is valid, for the keywords in use; an unknown keyword is a fault of the schema.
fn valid(schema: &Value, value: &Value) -> bool {
    schema.as_object().unwrap().iter().all(|(keyword, rule)| match keyword.as_str() {
        "$schema" | "title" | "description" | "default" => true,
        "type" => has_type(rule.as_str().unwrap(), value),
        "const" => value == rule,
        "oneOf" => rule.as_array().unwrap().iter().filter(|schema| valid(schema, value)).count() == 1,
        "minimum" => value.as_f64().is_none_or(|x| x >= rule.as_f64().unwrap()),
        "maximum" => value.as_f64().is_none_or(|x| x <= rule.as_f64().unwrap()),
        "exclusiveMinimum" => value.as_f64().is_none_or(|x| x > rule.as_f64().unwrap()),
        "exclusiveMaximum" => value.as_f64().is_none_or(|x| x < rule.as_f64().unwrap()),
        "items" => value.as_array().is_none_or(|items| items.iter().all(|item| valid(rule, item))),
        "minItems" => value.as_array().is_none_or(|items| items.len() as u64 >= rule.as_u64().unwrap()),
        "maxItems" => value.as_array().is_none_or(|items| items.len() as u64 <= rule.as_u64().unwrap()),
        "minProperties" => value.as_object().is_none_or(|table| table.len() as u64 >= rule.as_u64().unwrap()),
        "maxProperties" => value.as_object().is_none_or(|table| table.len() as u64 <= rule.as_u64().unwrap()),
        "required" => {
            let keys = rule.as_array().unwrap().iter().map(|key| key.as_str().unwrap());
            value.as_object().is_none_or(|table| keys.into_iter().all(|key| table.contains_key(key)))
        }
        "properties" => value.as_object().is_none_or(|table| {
            rule.as_object().unwrap().iter().all(|(key, schema)| table.get(key).is_none_or(|v| valid(schema, v)))
        }),
        "additionalProperties" => value.as_object().is_none_or(|table| {
            let known = schema.get("properties").and_then(Value::as_object);
            let more = table.iter().filter(|(key, _)| known.is_none_or(|known| !known.contains_key(*key)));
            match rule {
                Value::Bool(false) => more.count() == 0,
                schema => more.into_iter().all(|(_, value)| valid(schema, value)),
            }
        }),
        other => panic!("the keyword {other} is unknown"),
    })
}

fn has_type(name: &str, value: &Value) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        other => panic!("the type {other} is unknown"),
    }
}

#[test]
fn good_decks_are_valid() {
    let schema = json_schema();
    assert_eq!(schema["$schema"], json!("https://json-schema.org/draft/2020-12/schema"));
    for entry in std::fs::read_dir(folder("decks")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            assert!(valid(&schema, &deck(&path).unwrap()), "{}", path.display());
        }
    }
}

#[test]
fn decks_with_faults_that_a_schema_can_express_are_not() {
    let schema = json_schema();
    for name in [
        "empty",
        "missing_version",
        "version_of_the_future",
        "misspelt_space",
        "misspelt_key_at_the_top",
        "two_generators_for_one_part",
        "half_a_cell",
        "negative_modulus",
        "incompressible",
        "missing_ratio",
        "modulus_in_quotes",
        "unknown_material_law",
        "unknown_formulation",
        "line_of_three_points",
        "no_integration_points",
        "empty_list_of_steps",
        "step_in_single_brackets",
        "increment_larger_than_its_step",
        "flag_in_quotes",
    ] {
        let deck = deck(&folder("bad_decks").join(name).with_extension("toml")).unwrap();
        assert!(!valid(&schema, &deck), "{name}");
    }
}

#[test]
fn every_default_is_valid_under_its_own_schema() {
    fn walk(schema: &Value, seen: &mut usize) {
        if let Some(default) = schema.get("default") {
            *seen += 1;
            let table = default.as_object().is_some_and(|table| table.is_empty());
            assert!(table || valid(schema, default), "{schema:#}");
        }
        match schema {
            Value::Object(map) => map.values().for_each(|inner| walk(inner, seen)),
            Value::Array(list) => list.iter().for_each(|inner| walk(inner, seen)),
            _ => {}
        }
    }
    let mut seen = 0;
    walk(&json_schema(), &mut seen);
    assert!(seen > 30);
}
