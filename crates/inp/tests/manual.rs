//! The manual's page of keywords is the present one; `ASPERITY_BLESS=1` writes it anew. Every keyword that is read stands in a
//! deck of the corpus.

use inp::keywords::{Treated, all, named};
use std::collections::BTreeSet;
use std::path::Path;

fn root() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn the_page_of_keywords_is_up_to_date() {
    let (path, present) = (root().join("book/src/keywords.md"), inp::manual());
    if std::env::var_os("ASPERITY_BLESS").is_some() {
        std::fs::write(&path, &present).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap();
    assert!(committed == present, "book/src/keywords.md is old: cargo run -- schema --keywords > book/src/keywords.md");
}

#[test]
fn every_keyword_is_declared_once() {
    let names: BTreeSet<&str> = all().map(|keyword| keyword.name).collect();
    assert_eq!(names.len(), all().count());
    assert!(names.iter().all(|name| named(name).is_some() && *name == name.to_uppercase()));
}

#[test]
fn every_keyword_that_is_read_stands_in_a_deck() {
    let decks = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/decks");
    let texts = std::fs::read_dir(decks).unwrap().map(|entry| std::fs::read_to_string(entry.unwrap().path()).unwrap());
    let text = texts.collect::<String>().to_uppercase();
    let names: BTreeSet<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix('*'))
        .map(|line| line.split(',').next().unwrap().trim())
        .collect();
    for keyword in all() {
        if matches!(keyword.treated, Treated::Read(_) | Treated::Late(_) | Treated::Mesh(_) | Treated::Structure) {
            assert!(names.contains(keyword.name), "*{} stands in no deck", keyword.name);
        }
    }
}
