//! The manual says what the program does: the page of keys is the present one, and the decks of the guide can be built.
//! `ASPERITY_BLESS=1` writes the page of keys anew.

use asperity::deck::schema::{Schema, path_behind, path_of};
use asperity::deck::{build, read, read_driven, review, schema};
use asperity::solve::{RunOptions, Silent, Stop};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Value;

fn page(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src").join(name)
}

/// The blocks of TOML on a page, in order, without their indentation.
fn blocks(page: &str) -> Vec<String> {
    let (mut blocks, mut open) = (Vec::new(), false);
    for line in page.lines() {
        match line.trim_start() {
            "```toml" => {
                blocks.push(String::new());
                open = true;
            }
            fence if fence.starts_with("```") => open = false,
            line if open => *blocks.last_mut().unwrap() += &format!("{line}\n"),
            _ => {}
        }
    }
    blocks
}

/// What stands behind the keys of a deck, by the paths of the manual; tables have pages of their own and are left out.
fn gather(value: &Value, schema: &Schema, path: &str, found: &mut BTreeMap<String, Vec<Value>>) {
    let behind = path_behind(path, schema);
    match (schema, value) {
        (Schema::Table(keys) | Schema::OneOf(keys), Value::Table(table)) => {
            for (key, value) in keys.iter().filter_map(|key| Some((key, table.get(key.name)?))) {
                let path = path_of(path, key.name);
                if !has_tables(&key.schema) {
                    found.entry(path.clone()).or_default().push(value.clone());
                }
                gather(value, &key.schema, &path, found);
            }
        }
        (Schema::Map { item, .. }, Value::Table(table)) => {
            table.values().for_each(|value| gather(value, item, &behind, found));
        }
        (Schema::List { item, .. }, Value::Array(items)) => {
            items.iter().for_each(|value| gather(value, item, &behind, found));
        }
        _ => {}
    }
}

/// Whether the values of a key have a section of their own.
fn has_tables(schema: &Schema) -> bool {
    match schema {
        Schema::Table(_) | Schema::OneOf(_) | Schema::Map { .. } => true,
        Schema::List { item, .. } => has_tables(item),
        _ => false,
    }
}

/// The paths of all keys of a schema that need an example.
fn needed(schema: &Schema, path: &str, found: &mut Vec<String>) {
    match schema {
        Schema::Table(keys) | Schema::OneOf(keys) => {
            for key in keys {
                let path = path_of(path, key.name);
                if !has_tables(&key.schema) {
                    found.push(path.clone());
                }
                needed(&key.schema, &path, found);
            }
        }
        Schema::Map { item, .. } | Schema::List { item, .. } => needed(item, &path_behind(path, schema), found),
        _ => {}
    }
}

/// The best of the values as an example: short, and more than a bare zero.
fn example(values: &[Value]) -> String {
    let text = |value: &Value| value.to_string().replace('\n', " ");
    let rank = |text: &String| {
        (text.len() > 60, matches!(text.as_str(), "0" | "0.0" | "{}" | "[]"), text.len() < 3, text.len())
    };
    values.iter().map(text).min_by_key(rank).unwrap_or_default()
}

/// The examples of the manual are values of decks that are built and run by tests.
#[test]
fn each_key_has_an_example() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    let cases = own.join("../../cases");
    let kinds = [
        ("deck", schema::root(), own.join("tests/decks")),
        ("point", schema::point_root(), cases.join("point")),
        ("interface", schema::interface_root(), cases.join("interface")),
    ];
    let (mut lines, mut missing, mut of_decks) = (String::new(), Vec::new(), BTreeMap::new());
    for (kind, schema, folder) in kinds {
        let read = |folder: &Path| std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path());
        let mut paths: Vec<_> = read(&folder).chain(read(&own.join("tests/decks").join(format!("{kind}s")))).collect();
        paths.retain(|path| path.extension().is_some_and(|e| e == "toml") && !path.ends_with("expect.toml"));
        paths.sort();
        let mut found = BTreeMap::new();
        for path in paths {
            let deck: toml::Table = std::fs::read_to_string(path).unwrap().parse().unwrap();
            gather(&Value::Table(deck), &schema, "", &mut found);
        }
        let mut all = Vec::new();
        needed(&schema, "", &mut all);
        for path in all {
            // Laws and their updates have the same keys in all kinds of decks.
            let law = path.strip_prefix("interface.INTERFACE.").map(|rest| format!("contact.CONTACT.law.{rest}"));
            let [contact, body] = ["contact.CONTACT", "body.GROUP"].map(|table| format!("{table}.{path}"));
            let alike = [Some(path.clone()), law, Some(contact), Some(body)].into_iter().flatten();
            match found.get(&path).or_else(|| alike.filter_map(|path| of_decks.get(&path)).next()) {
                Some(values) => lines += &format!("{kind}\t{path}\t{}\n", example(values)),
                None => missing.push(format!("{kind} {path}")),
            }
        }
        if kind == "deck" {
            of_decks = found;
        }
    }
    let file = own.join("../deck/src/schema/examples.txt");
    if std::env::var_os("ASPERITY_BLESS").is_some() {
        std::fs::write(&file, &lines).unwrap();
    }
    assert!(missing.is_empty(), "no deck says\n{}", missing.join("\n"));
    assert!(lines.lines().count() > 500 && !lines.contains(['|', '`']), "an example breaks the page");
    assert!(std::fs::read_to_string(&file).unwrap() == lines, "{} is old: ASPERITY_BLESS=1", file.display());
}

#[test]
fn the_deck_of_a_point_that_only_the_manual_has_is_followed() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks/points/shear.toml");
    let text = std::fs::read_to_string(path).unwrap();
    let driven = read_driven(&text, "shear.toml", Path::new(""), &[]).unwrap_or_else(|d| panic!("{}", d.render(false)));
    let (records, stopped) = driven.follow();
    assert!(stopped.is_none(), "{stopped:?}");
    let shear = records[0].columns.iter().position(|name| name == "stress_xy").unwrap();
    assert!((records[0].rows.last().unwrap()[shear] / 150.0 - 1.0).abs() < 1e-6);
}

#[test]
fn the_page_of_keys_is_up_to_date() {
    for (name, option, present) in [
        ("keys.md", "", schema::manual()),
        ("point-keys.md", " --point", schema::point_manual()),
        ("interface-keys.md", " --interface", schema::interface_manual()),
    ] {
        if std::env::var_os("ASPERITY_BLESS").is_some() {
            std::fs::write(page(name), &present).unwrap();
        }
        let committed = std::fs::read_to_string(page(name)).unwrap();
        let hint = format!("cargo run -- schema --manual{option} > book/src/{name}");
        assert!(committed == present, "book/src/{name} is old: {hint}");
    }
}

#[test]
fn the_small_deck_of_the_guide_runs_to_its_end() {
    let deck = blocks(&std::fs::read_to_string(page("deck.md")).unwrap()).swap_remove(0);
    let made = read(&deck, "guide.toml", Path::new(""), &[]).and_then(build).unwrap_or_else(|d| panic!("{d:?}"));
    let mut run = made.model.run(made.model.problem.initial_state());
    assert_eq!(run.run(&RunOptions::default(), &mut Silent).unwrap(), Stop::Done);
}

/// The first block is a whole deck, the others are added to it.
#[test]
fn the_decks_of_the_guide_are_good() {
    let blocks = blocks(&std::fs::read_to_string(page("deck.md")).unwrap());
    assert!(blocks.len() >= 3);
    for deck in [blocks[0].clone(), blocks.concat()] {
        let made = read(&deck, "guide.toml", Path::new(""), &[]).and_then(build);
        let made = made.unwrap_or_else(|diagnostics| panic!("{}", diagnostics.render(false)));
        let problems = review(&made).unwrap().problems;
        assert!(problems.is_empty(), "{problems:?}");
    }
}
