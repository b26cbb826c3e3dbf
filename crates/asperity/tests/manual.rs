//! The manual says what the program does: the page of keys is the present one, and the decks of the guide can be built.
//! `ASPERITY_BLESS=1` writes the page of keys anew.

use asperity::deck::{build, read, review, schema};
use asperity::solve::{RunOptions, Silent, Stop};
use std::path::{Path, PathBuf};

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
