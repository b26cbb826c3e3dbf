//! The rule of the house: a room uses rooms of lower layers only. Rooms of one line below are strangers; a line uses
//! the lines above it. This reads every `crate::ROOM` of the library against the table.

use std::path::{Path, PathBuf};

const LAYERS: &[&[&str]] = &[
    &["error"],
    &["tensor", "declare", "amplitude", "machine", "diagnosis"],
    &["integrate", "files"],
    &["mesh", "material", "interface", "tool"],
    &["system"],
    &["solid", "contact", "load", "audit"],
    &["solve"],
    &["model"],
    &["output"],
    &["point"],
    &["deck"],
];

fn layer(room: &str) -> Option<usize> {
    LAYERS.iter().position(|rooms| rooms.contains(&room))
}

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// Rooms that a text names: `crate::mesh::Mesh`, `use crate::{Error, mesh::Mesh}`, not in comments. Macros name their
/// own room by `$crate`.
fn named(text: &str) -> Vec<String> {
    let code: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let code = code.join("\n");
    let mut rooms = Vec::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        let list = if rest.starts_with('{') { &rest[1..rest.find(';').unwrap_or(rest.len())] } else { rest };
        let word = |part: &str| part.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        match rest.starts_with('{') {
            true => rooms.extend(list.split(',').map(word)),
            false => rooms.push(word(list)),
        }
    }
    rooms
}

#[test]
fn rooms_use_lower_layers_only() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    files(&source, &mut paths);
    let mut broken = Vec::new();
    let mut read = 0;
    for path in &paths {
        let inside = path.strip_prefix(&source).unwrap();
        let room = inside.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned();
        if room == "lib" {
            continue;
        }
        let own = layer(&room).unwrap_or_else(|| panic!("the room '{room}' stands in no layer"));
        for other in named(&std::fs::read_to_string(path).unwrap()) {
            // `crate::Error` and `crate::Failure` are layer 0 under their short names; so are items of the lists.
            let Some(theirs) = layer(&other) else { continue };
            read += 1;
            if other != room && theirs >= own {
                broken.push(format!("{} uses '{other}'", inside.display()));
            }
        }
    }
    assert!(read > 100, "only {read} uses found: is the reading broken?");
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn the_reading_finds_uses_in_all_their_forms() {
    let text =
        "use crate::mesh::Mesh;\n// crate::deck\nuse crate::{Error, solid::Body, tool};\nlet x = crate::tensor::f();";
    assert_eq!(named(text), ["mesh", "Error", "solid", "tool", "tensor"]);
}

/// Names of the structs, enums and traits that a text defines, at any depth.
fn types(text: &str) -> Vec<String> {
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let defined = |line: &str| {
        let words = words(line);
        let keyword = words.iter().position(|word| matches!(&**word, "struct" | "enum" | "trait"))?;
        let public = words[..keyword].iter().all(|word| word.starts_with("pub") || word == "unsafe");
        let name = words.get(keyword + 1).filter(|_| public)?;
        Some(name.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
    };
    text.lines().filter_map(defined).collect()
}

#[test]
fn types_of_contact_and_tools_have_names_of_their_own() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(crates).unwrap() {
        files(&entry.unwrap().path().join("src"), &mut paths);
    }
    let mut owners = std::collections::BTreeMap::<String, Vec<PathBuf>>::new();
    for path in paths {
        for name in types(&std::fs::read_to_string(&path).unwrap()) {
            owners.entry(name).or_default().push(path.strip_prefix(crates).unwrap().to_owned());
        }
    }
    let rooms = [Path::new("asperity/src/contact"), Path::new("asperity/src/tool")];
    let theirs = |path: &PathBuf| rooms.iter().any(|room| path.starts_with(room));
    assert!(owners.values().filter(|paths| paths.iter().any(theirs)).count() > 50, "is the reading broken?");
    let shared = owners.iter().filter(|(_, paths)| paths.len() > 1 && paths.iter().any(theirs));
    let shared: Vec<_> = shared.map(|(name, paths)| format!("{name}: {paths:?}")).collect();
    assert!(shared.is_empty(), "{}", shared.join("\n"));
}
