//! The rule of the house: a room uses rooms of lower layers only. Rooms of one line below are strangers; a line uses
//! the lines above it. This reads every `crate::ROOM` of the core and of the results against the table; the borders between crates
//! are the compiler's.

use std::path::{Path, PathBuf};

const LAYERS: &[&[&str]] = &[
    &["error"],
    &["tensor", "declare", "amplitude", "machine"],
    &["integrate", "files"],
    &["mesh", "material", "interface", "tool"],
    &["system"],
    &["solid", "contact", "load", "audit"],
    &["solve"],
    &["model"],
    &["diagnosis"],
    &["output"],
    &["point"],
];

/// The folder of the sources of a crate.
fn source(of: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join(of).join("src")
}

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
    let mut paths = Vec::new();
    for source in ["core", "results"].map(source) {
        let mut found = Vec::new();
        files(&source, &mut found);
        paths.extend(
            found.into_iter().map(|path| path.strip_prefix(&source).unwrap().to_owned()).map(|p| (source.clone(), p)),
        );
    }
    let mut broken = Vec::new();
    let mut read = 0;
    for (source, inside) in &paths {
        let room = inside.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs").to_owned();
        if room == "lib" {
            continue;
        }
        let own = layer(&room).unwrap_or_else(|| panic!("the room '{room}' stands in no layer"));
        for other in named(&std::fs::read_to_string(source.join(inside)).unwrap()) {
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
fn the_core_needs_few_packages() {
    let mut tree = std::process::Command::new(env!("CARGO"));
    tree.args(["tree", "--offline", "--locked", "-p", "asperity-core", "-e", "normal", "--prefix", "none"]);
    let said = tree.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    let said = String::from_utf8(said.stdout).unwrap();
    let packages: std::collections::BTreeSet<&str> = said.lines().map(|line| line.trim_end_matches(" (*)")).collect();
    assert!(packages.iter().any(|package| package.starts_with("faer ")), "is the reading broken? {said}");
    assert!(packages.len() <= 85, "{} packages", packages.len());
    let heavy = ["png ", "zstd ", "toml ", "tiny-skia ", "serde_json "];
    assert!(!packages.iter().any(|package| heavy.iter().any(|name| package.starts_with(name))), "{packages:?}");
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
    let rooms = [Path::new("core/src/contact"), Path::new("core/src/tool")];
    let theirs = |path: &PathBuf| rooms.iter().any(|room| path.starts_with(room));
    assert!(owners.values().filter(|paths| paths.iter().any(theirs)).count() > 50, "is the reading broken?");
    let shared = owners.iter().filter(|(_, paths)| paths.len() > 1 && paths.iter().any(theirs));
    let shared: Vec<_> = shared.map(|(name, paths)| format!("{name}: {paths:?}")).collect();
    assert!(shared.is_empty(), "{}", shared.join("\n"));
}

/// Paths that the `use` items of a text name, groups written out; what follows `#[cfg(test)]` is left out.
fn imports(text: &str) -> Vec<String> {
    fn spread(prefix: &str, tree: &str, out: &mut Vec<String>) {
        let Some((head, rest)) = tree.split_once('{') else {
            return out.push(format!("{prefix}{}", tree.split(" as ").next().unwrap().trim()));
        };
        let (inside, mut depth, mut from) = (rest.rsplit_once('}').unwrap().0, 0, 0);
        let prefix = format!("{prefix}{}", head.trim());
        for (at, c) in inside.char_indices().chain([(inside.len(), ',')]) {
            depth += i32::from(c == '{') - i32::from(c == '}');
            if c == ',' && depth == 0 {
                spread(&prefix, &inside[from..at], out);
                from = at + 1;
            }
        }
    }
    let code = text.split("#[cfg(test)]").next().unwrap();
    let code: Vec<&str> = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let mut paths = Vec::new();
    for part in format!("\n{}", code.join("\n")).split("\nuse ").skip(1) {
        spread("", &part.split(';').next().unwrap().replace('\n', " "), &mut paths);
    }
    paths
}

#[test]
fn files_of_contact_import_one_another_in_no_circle() {
    use std::collections::{BTreeMap, BTreeSet};
    let source = source("core");
    let mut paths = Vec::new();
    files(&source.join("contact"), &mut paths);
    let module = |path: &PathBuf| -> Vec<String> {
        let inside = path.strip_prefix(&source).unwrap().with_extension("");
        let mut names: Vec<String> = inside.iter().map(|name| name.to_str().unwrap().to_owned()).collect();
        names.pop_if(|last| last == "mod");
        names
    };
    let all: BTreeMap<Vec<String>, &PathBuf> = paths.iter().map(|path| (module(path), path)).collect();
    let mut uses = BTreeMap::<&Vec<String>, BTreeSet<&Vec<String>>>::new();
    for (own, path) in &all {
        let theirs = uses.entry(own).or_default();
        for import in imports(&std::fs::read_to_string(path).unwrap()) {
            let mut names: Vec<String> = import.split("::").map(str::to_owned).collect();
            let mut from = own.clone();
            let absolute = names[0] == "crate";
            while names[0] == "super" || names[0] == "crate" || names[0] == "self" {
                match &*names.remove(0) {
                    "super" => drop(from.pop()),
                    "crate" => from.clear(),
                    _ => (),
                }
            }
            if !absolute && from == *own && !import.starts_with("self") {
                continue; // a crate
            }
            from.extend(names);
            while !from.is_empty() && !all.contains_key(&from) {
                from.pop();
            }
            // What a folder hands on from within is no use of it.
            if let Some((other, _)) =
                all.get_key_value(&from).filter(|(other, _)| *other != own && !other.starts_with(own))
            {
                theirs.insert(other);
            }
        }
    }
    assert!(uses.values().map(BTreeSet::len).sum::<usize>() > 100, "is the reading broken?");
    // Files that use none that is left are taken away until none can be.
    while let Some(leaf) = uses.iter().find(|(_, theirs)| theirs.is_empty()).map(|(leaf, _)| *leaf) {
        uses.remove(leaf);
        for theirs in uses.values_mut() {
            theirs.remove(leaf);
        }
    }
    assert!(uses.is_empty(), "these use one another, or what does: {uses:#?}");
}
