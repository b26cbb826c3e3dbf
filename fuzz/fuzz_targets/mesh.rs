//! Any bytes as a mesh file of any format: read and checked, or refused in words, never a panic. The first byte chooses
//! the format.
#![no_main]

use asperity::Error;
use asperity::mesh::{formats, lint};
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    let Some((&choice, content)) = bytes.split_first() else { return };
    let format = &formats::ALL[choice as usize % formats::ALL.len()];
    match (format.read)(Path::new("fuzzed"), content) {
        Ok((mut mesh, _)) => {
            lint::check(&mesh);
            mesh.orient();
        }
        Err(Error::Input(text)) => assert!(text.contains("; ")),
        Err(other) => panic!("{other}"),
    }
});
