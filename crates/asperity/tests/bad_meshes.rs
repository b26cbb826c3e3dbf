//! Mesh files that people broke: each gives one sentence with its place and what to do, and nothing ever panics.

use asperity::Error;
use asperity::mesh::{formats, lint};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/meshes")
}

/// The error of a text read as a file of an extension.
fn error(extension: &str, text: &str) -> String {
    let format = formats::ALL.iter().find(|format| format.extension == extension).unwrap();
    match (format.read)(&folder().join(format!("bad.{extension}")), text.as_bytes()) {
        Err(Error::Input(text)) => text,
        other => panic!("no input error but {other:?} for\n{text}"),
    }
}

/// The sentence must stand at the line, hold the words and say what to do.
fn expect(extension: &str, text: &str, line: usize, words: &str) {
    let error = error(extension, text);
    let place = format!("bad.{extension}:{line}: ");
    assert!(error.contains(&place) && error.contains(words) && error.contains("; "), "{error}\nfor\n{text}");
}

const HEADER: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const NODES: &str = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n";

#[test]
fn broken_files_of_gmsh_are_named() {
    let msh = |line, text: &str, words| expect("msh", text, line, words);
    let body = |line, text: &str, words| expect("msh", &format!("{HEADER}{text}"), line, words);
    let cells = |line, text: &str, words| expect("msh", &format!("{HEADER}{NODES}{text}"), line, words);
    msh(1, "", "does not begin with '$MeshFormat'");
    msh(1, "solid cube\n", "a section such as '$Nodes' is expected");
    msh(1, "$Nodes\n1\n", "does not begin with '$MeshFormat'");
    msh(2, "$MeshFormat\n4.0 0 8\n$EndMeshFormat\n", "format 4.0 is not read; save it with -format msh41");
    msh(2, "$MeshFormat\n2.2 7 8\n$EndMeshFormat\n", "0 for text or 1 for binary, not 7");
    msh(2, "$MeshFormat\n2.2 0 4\n$EndMeshFormat\n", "8 bytes");
    msh(3, "$MeshFormat\n2.2 0 8\n$EndMesh\n", "'$EndMeshFormat' is expected here, not '$EndMesh'");
    msh(2, "$MeshFormat\n2.2 0", "the file ends inside '$MeshFormat'");
    body(4, "", "the file ends without '$Nodes'");
    body(11, NODES, "the file ends without '$Elements'");
    body(5, "$Nodes\n-3\n", "is negative");
    body(5, "$Nodes\nmany\n", "should be a whole number but is 'many'");
    body(5, "$Nodes\n900000000000000\n1 0 0 0\n", "more than the rest of it can hold");
    body(6, "$Nodes\n1\n1 0 zero 0\n$EndNodes\n", "a coordinate should be a number but is 'zero'");
    body(6, "$Nodes\n1\n1 0 nan 0\n$EndNodes\n", "node 1 has a coordinate that is not a finite number");
    body(6, "$Nodes\n1\n1 0 1e999 0\n$EndNodes\n", "not a finite number");
    body(7, "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n", "node 1 is there twice");
    body(6, "$Nodes\n1\n-1 0 0 0\n$EndNodes\n", "must be positive");
    body(8, "$Nodes\n2\n1 0 0 0\n2 0 0 0\n3 0 0 0\n$EndNodes\n", "'$EndNodes' is expected here, not '3'");
    body(7, "$Nodes\n2\n1 0 0 0\n$EndNodes\n", "should be a whole number but is '$EndNodes'");
    body(11, &format!("{NODES}$Nodes\n"), "'$Nodes' is there twice");
    body(7, "$Nodes\n2\n1 0 0 0\n2 0 0", "the file ends inside '$Nodes'; write it again");
    cells(13, "$Elements\n1\n1 2 0 1 2 9\n$EndElements\n", "element 1: there is no node 9");
    cells(13, "$Elements\n1\n1 7 0 1 2 3 4 1\n$EndElements\n", "element type 7 is a pyramid");
    cells(13, "$Elements\n1\n1 36 0 1 2 3 4 1\n$EndElements\n", "set Mesh.ElementOrder to 1 or 2");
    cells(13, "$Elements\n1\n1 2 99999 1 2 3\n$EndElements\n", "99999 tags, more than the rest");
    cells(14, "$Elements\n1\n1 3 0 1 2 3\n$EndElements\n", "is '$EndElements'");
    cells(11, "$PartitionedEntities\n", "cut into partitions");
    cells(12, "$Periodic\n1\n", "ends inside '$Periodic'");
    let no_cells = error("msh", &format!("{HEADER}{NODES}$Elements\n1\n1 1 0 1 2\n$EndElements\n"));
    assert!(no_cells.contains("no plane or solid elements; save the cells"), "{no_cells}");
}

#[test]
fn broken_files_of_gmsh_4_are_named() {
    let header = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    let msh = |line, text: &str, words| expect("msh", &format!("{header}{text}"), line, words);
    let nodes = "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n";
    msh(5, "$Entities\n1 x 0 0\n", "the number of curves should be a whole number but is 'x'");
    msh(5, "$Entities\n1 88888888888 0 0\n", "88888888888 curves, more than the rest");
    msh(5, "$Nodes\n1 3 9 3\n", "the least number exceeds the largest");
    msh(6, "$Nodes\n1 3 1 3\n2 1 0 18446744073709551615\n", "more than the rest of it can hold");
    msh(12, &nodes.replace("1 3 1 3", "1 4 1 3"), "4 nodes are announced but 3 are there");
    msh(16, &format!("{nodes}$Elements\n1 1 1 1\n2 1 99 1\n"), "element type 99");
    msh(17, &format!("{nodes}$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 7\n$EndElements\n"), "there is no node 7");
    msh(17, &format!("{nodes}$Elements\n1 2 1 1\n2 1 2 1\n1 1 2 3\n$EndElements\n"), "2 elements are announced but 1");
}

const INP: &str = "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n";

#[test]
fn broken_input_files_are_named() {
    let inp = |line, text: &str, words| expect("inp", text, line, words);
    let more = |line, text: &str, words| expect("inp", &format!("{INP}{text}"), line, words);
    let quad = "*ELEMENT, TYPE=CPS4, ELSET=body\n1, 1, 2, 3, 4\n";
    let sets = |line, text: &str, words| expect("inp", &format!("{INP}{quad}{text}"), line, words);
    inp(1, "1, 0, 0\n", "data without a keyword");
    inp(2, "*NODE\nx, 0, 0\n", "'x' is not the number of a node");
    inp(2, "*NODE\n1, 0, y\n", "'y' is not a coordinate");
    inp(2, "*NODE\n1, 0, nan\n", "not a finite number");
    inp(2, "*NODE\n1, 0, 1e999\n", "not a finite number");
    inp(3, "*NODE\n1, 0, 0\n1, 0, 0\n", "node 1 is there twice");
    inp(2, "*NODE\n1, 0, 0, 0, 1, 0, 0, 7, 8\n", "too many fields");
    inp(1, "*NODE, SYSTEM=C\n", "only rectangular coordinates");
    inp(1, "*NODES\n1, 0, 0\n", "*NODES is no keyword; did you mean *NODE?");
    inp(1, "*Part, name=tube\n", "*PART changes the mesh and is not read; write the model flat");
    inp(1, "*NGEN\n1, 10\n", "write the nodes and elements out");
    inp(1, "*INCLUDE\n", "names no file");
    inp(1, "*INCLUDE, INPUT=nowhere.inp\n", "paths count from the including file");
    more(6, "*ELEMENT\n1, 1, 2, 3\n", "names no type");
    more(6, "*ELEMENT, TYPE=B31\n1, 1, 2\n", "type 'B31' are not read; the readable ones are CPS3");
    more(7, "*ELEMENT, TYPE=CPS4\n1, 1, 2, 3, 9\n", "element 1: there is no node 9");
    more(7, "*ELEMENT, TYPE=CPS4\n1, 1, 2, 3\n*NSET, NSET=a\n1\n", "element 1 has 3 nodes but CPS4 needs 4");
    more(7, "*ELEMENT, TYPE=CPS4\n1, 1, 2, 3", "element 1 has 3 nodes but CPS4 needs 4");
    more(7, "*ELEMENT, TYPE=CPS3\n1, 1, 2, 3, 4\n", "element 1 has more than the 3 nodes of CPS3");
    more(8, "*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n1, 1, 3, 4\n", "element 1 is there twice");
    more(7, "*ELEMENT, TYPE=CPS3\n1, 1, 2, c\n", "'c' is not the number of a node");
    sets(8, "*NSET\n1\n", "*NSET has no name");
    sets(9, "*NSET, NSET=a\n1, 99\n", "set 'a': there is no node 99");
    sets(9, "*ELSET, ELSET=a\n7\n", "set 'a': there is no element 7");
    sets(9, "*ELSET, ELSET=a\nbodi\n", "there is no set 'bodi'; did you mean 'body'?");
    sets(9, "*NSET, NSET=a, GENERATE\n5, 1\n", "first, last and step");
    sets(9, "*NSET, NSET=a, GENERATE\n1, 5, 0\n", "first, last and step");
    sets(8, "*SURFACE, TYPE=ELEMENT\nbody, S1\n", "*SURFACE has no name");
    sets(9, "*SURFACE, NAME=s\nbody, S7\n", "element 1 (quad4) has no face 'S7'; its faces are S1 to S4");
    sets(9, "*SURFACE, NAME=s\nbuddy, S1\n", "there is no set of elements 'buddy'");
    sets(9, "*SURFACE, NAME=s\n12, S1\n", "there is no element 12");
    sets(8, "*SURFACE, NAME=s, COMBINE=UNION\na, b\n", "list the faces themselves");
    let no_cells = error("inp", INP);
    assert!(no_cells.contains("no plane or solid elements"), "{no_cells}");
    let shells = error("inp", &format!("{INP}*ELEMENT, TYPE=S4\n1, 1, 2, 3, 4\n"));
    assert!(shells.contains("no elements that can be part of a body"), "{shells}");
}

#[test]
fn files_that_include_themselves_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("one.inp", "*NODE\n1, 0, 0\n*INCLUDE, INPUT=two.inp\n");
    write("two.inp", "** nothing here\n*INCLUDE, INPUT=one.inp\n");
    let text = formats::read(folder.path().join("one.inp")).unwrap_err().to_string();
    assert!(text.contains("two.inp:2: 'one.inp' includes itself; "), "{text}");
    write("many.inp", &"*INCLUDE, INPUT=empty.inp\n".repeat(2000));
    write("empty.inp", "");
    let text = formats::read(folder.path().join("many.inp")).unwrap_err().to_string();
    assert!(text.contains("many.inp:1000: more than 1000 files"), "{text}");
}

#[test]
fn sets_that_double_do_not_fill_the_memory() {
    let mut text = format!("{INP}*ELEMENT, TYPE=CPS4\n1, 1, 2, 3, 4\n*NSET, NSET=s0\n1, 2\n");
    for i in 1..200 {
        text.push_str(&format!("*NSET, NSET=s{i}\ns{}, s{}\n", i - 1, i - 1));
    }
    text.push_str("*NSET, NSET=wide, GENERATE\n1, 18446744073709551615\n0, 18446744073709551615, 1\n");
    let (mesh, notes) = (formats::ALL[1].read)(Path::new("sets.inp"), text.as_bytes()).unwrap();
    assert_eq!((&mesh.groups["s199"].nodes[..], mesh.groups["wide"].nodes.len()), (&[0, 1][..], 4));
    assert!(notes.iter().any(|note| note.text.contains("do not exist")), "{notes:?}");
}

#[test]
fn unknown_extensions_and_missing_files_are_named() {
    let text = formats::read("tube.stl").unwrap_err().to_string();
    assert_eq!(text, "tube.stl: '.stl' is no known mesh format; use .msh (Gmsh) or .inp (Abaqus/CalculiX)");
    assert!(matches!(formats::read("nowhere.msh"), Err(Error::File { path, .. }) if path == "nowhere.msh"));
}

/// A random walk that is the same in every run (splitmix64).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % end as u64) as usize
    }

    /// One to three changes: bytes, words of the format, cuts, doubled and exchanged pieces.
    fn mutate(&mut self, bytes: &mut Vec<u8>) {
        const WORDS: [&str; 12] = [
            "nan",
            "-1",
            "0",
            "99999999999999999999",
            "18446744073709551615",
            "1e308",
            "\n",
            "$End",
            "*NSET",
            ",",
            "$",
            "=",
        ];
        for _ in 0..1 + self.below(3) {
            let at = self.below(bytes.len().max(1)).min(bytes.len());
            let end = (at + self.below(40)).min(bytes.len());
            match self.below(9) {
                0 => bytes.truncate(at),
                1 => drop(bytes.drain(at..end)),
                2 => drop(bytes.splice(at..end.min(at + 3), WORDS[self.below(WORDS.len())].bytes())),
                3 => {
                    let piece = bytes[at..end].to_vec();
                    let to = self.below(bytes.len() + 1);
                    bytes.splice(to..to, piece);
                }
                4 if end > at => bytes[at..end].iter_mut().for_each(|byte| *byte = 0xff),
                5 if end > at => bytes[at] = self.below(256) as u8,
                _ if end > at => bytes[at] = b'0' + self.below(10) as u8,
                _ => {}
            }
        }
    }
}

#[test]
fn no_mutation_of_a_file_makes_a_reader_or_the_lint_panic() {
    let mut random = Random(7);
    let (mut read, mut refused) = (0, 0);
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    for path in files {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_string();
        let Some(format) = formats::ALL.iter().find(|format| format.extension == extension) else { continue };
        let sound = std::fs::read(&path).unwrap();
        for _ in 0..400 {
            let mut bytes = sound.clone();
            random.mutate(&mut bytes);
            match (format.read)(&path, &bytes) {
                Ok((mut mesh, _)) => {
                    lint::check(&mesh);
                    mesh.orient();
                    read += 1;
                }
                Err(Error::Input(text)) => {
                    assert!(text.starts_with(path.to_str().unwrap()) || text.contains("written_nodes.inp:"), "{text}");
                    assert!(text.contains("; "), "{text}");
                    refused += 1;
                }
                Err(other) => panic!("{other:?}"),
            }
        }
    }
    assert!(read > 500 && refused > 2000, "{read} read, {refused} refused: the mutations are too strong or too weak");
}
