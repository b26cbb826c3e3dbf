//! The command as scripts and shells meet it: exit codes, files, interrupts.

use std::path::Path;
use std::process::{Command, Output};

/// A block pressed on a plate and pushed along it.
const DECK: &str = r#"
version = 1
title = "Block on a plate"
space = "plane-strain"
mesh.part.block.rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [4, 2], cell = "quad4" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.block = { material = "steel", formulation = "f-bar" }
tool.plate.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]
contact.sole = { surface = "block.bottom", target = "plate", law.coulomb = { friction = 0.2 } }

[[step]]
name = "press"
increments = { count = 2 }
displacement."block.top" = { x = 0.0, y = -0.01 }

[[step]]
name = "push"
increments = { count = 200 }
displacement."block.top" = { x = 1.0 }
"#;

fn asperity(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).current_dir(directory).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn error(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn folder(deck: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("block.toml"), deck).unwrap();
    folder
}

fn summary(directory: &Path) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(directory.join("summary.json")).unwrap()).unwrap()
}

#[test]
fn a_run_converges_and_leaves_its_files() {
    let folder = folder(DECK);
    let run = asperity(folder.path(), &["run", "block.toml", "--set", "step.push.increments={count=4}"]);
    assert_eq!(code(&run), 0, "{}", error(&run));
    let results = folder.path().join("block.results");
    let summary = summary(&results);
    assert_eq!(summary["status"], "converged");
    assert_eq!(summary["increments"], 6);
    for file in summary["files"].as_array().unwrap() {
        assert!(results.join(file.as_str().unwrap()).exists(), "{file}");
    }
    let text = String::from_utf8_lossy(&run.stdout).into_owned();
    assert!(text.contains("converged: 6 increments, 0 cut") && text.contains("certificate"), "{text}");

    assert!(text.contains(" summary.json"), "{text}");
    let late = asperity(folder.path(), &["figure", "block.results", "--at", "7"]);
    assert_eq!(code(&late), 2);
    assert!(error(&late).contains("this run goes from 0 to 2"), "{}", error(&late));
    let chosen = |quantity: &str| asperity(folder.path(), &["figure", "block.results", "--quantity", quantity]);
    for quantity in ["displacement.y", "displacement", "von_mises_averaged", "cauchy_stress_averaged.xy"] {
        assert_eq!(code(&chosen(quantity)), 0, "{quantity}: {}", error(&chosen(quantity)));
        assert!(results.join(format!("{quantity}.png")).exists(), "{quantity}");
    }
    for (quantity, words) in [
        ("displacment", "did you mean `displacement`?"),
        ("cauchy_stress_averaged", "drawn by component: xx, yy"),
        ("von_mises_averaged.x", "has no components"),
        ("displacement.w", "drawn by component: x, y, z"),
    ] {
        let refused = chosen(quantity);
        assert!(code(&refused) == 2 && error(&refused).contains(words), "{quantity}: {}", error(&refused));
    }
    let film = asperity(folder.path(), &["figure", "block.results", "--film", "--resolution", "0.5"]);
    assert_eq!(code(&film), 0, "{}", error(&film));
    let bytes = std::fs::read(results.join("von_mises_averaged_film.png")).unwrap();
    let control = bytes.windows(4).position(|name| name == b"acTL").unwrap();
    assert_eq!(bytes[control + 4..control + 8], 6u32.to_be_bytes(), "a frame an increment");
    let drawn = asperity(folder.path(), &["figure", "block.results", "--at", "1,2", "--window", "-1,5,-1,3"]);
    assert_eq!(code(&drawn), 0, "{}", error(&drawn));
    assert!(String::from_utf8_lossy(&drawn.stdout).contains("contact_stress.svg"));
}

/// What `check` would have warned of is told before the run and stays in its summary.
#[test]
fn a_run_says_what_looks_wrong() {
    let folder = folder(&DECK.replace("[[20.0, 0.0], [-20.0, 0.0]]", "[[-20.0, 0.0], [20.0, 0.0]]"));
    let run = asperity(folder.path(), &["run", "block.toml", "--set", "step.push.increments={count=4}"]);
    assert_eq!(code(&run), 6, "no contact ever closed: {}", error(&run));
    let said = "no point of contact `sole` sees its target";
    assert!(error(&run).contains(said) && error(&run).contains("material on its left?"), "{}", error(&run));
    let notes = &summary(&folder.path().join("block.results"))["notes"];
    assert_eq!(notes[0], said);
    let never = |note: &serde_json::Value| note.as_str().unwrap().starts_with("contact 'sole' never closed");
    assert!(notes.as_array().unwrap().iter().any(never), "{notes}");
}

/// That cells were raised is told by the run, and stays in its summary.
#[test]
fn a_run_says_that_cells_were_raised() {
    let folder = folder(
        "version = 1
        space = \"plane-strain\"
        mesh.part.b.rectangle = { from = [0.0, 0.0], to = [20.0, 1.0], cells = [20, 1], cell = \"tri3\" }
        material.m.elastic = { young = 1e6, poisson = 0.3 }
        body.b.material = \"m\"
        [[step]]
        increments.count = 1
        displacement.\"b.left\" = { x = 0.0, y = 0.0 }
        traction.\"b.right\" = { y = -1.0 }",
    );
    let run = asperity(folder.path(), &["run", "block.toml"]);
    assert_eq!(code(&run), 0, "{}", error(&run));
    assert!(error(&run).contains("they became tri6"), "{}", error(&run));
    let end = String::from_utf8_lossy(&run.stdout);
    assert!(!end.contains("they became tri6"), "told once: {end}");
    let notes = &summary(&folder.path().join("block.results"))["notes"];
    assert!(notes[0].as_str().unwrap().contains("they became tri6"), "{notes}");
    let check = asperity(folder.path(), &["check", "block.toml"]);
    assert_eq!(code(&check), 0, "a note is no problem: {}", error(&check));
}

/// What a frame keeps must not bear the name of another result.
#[test]
fn bodies_in_every_frame_are_written() {
    for rate in ["jaumann", "green-naghdi", "logarithmic"] {
        let steel = "material = \"steel\", formulation = \"f-bar\"";
        let folder = folder(&DECK.replace(steel, &format!("material = \"steel\", rate = \"{rate}\"")));
        let run = asperity(folder.path(), &["run", "block.toml", "--set", "step.push.increments={ count = 1 }"]);
        assert!([0, 3, 6].contains(&code(&run)), "{rate}: {}", error(&run));
    }
}

#[test]
fn wrong_input_ends_with_2_and_a_caret() {
    let folder = folder(&DECK.replace("friction", "fricton"));
    let run = asperity(folder.path(), &["run", "block.toml"]);
    assert_eq!(code(&run), 2);
    assert!(error(&run).contains("did you mean `friction`?"), "{}", error(&run));
    assert!(!folder.path().join("block.results").exists());
    let lost = asperity(folder.path(), &["run", "lost.toml"]);
    assert_eq!(code(&lost), 2);
    std::fs::write(folder.path().join("taken"), "").unwrap();
    std::fs::write(folder.path().join("good.toml"), DECK).unwrap();
    let taken = asperity(folder.path(), &["run", "good.toml", "--out", "taken"]);
    assert_eq!(code(&taken), 2);
    assert!(error(&taken).contains("taken: this is a file"), "{}", error(&taken));
    let early = asperity(folder.path(), &["restart", "block.toml", "--set", "contact.sole.law={coulomb={friction=0}}"]);
    assert_eq!(code(&early), 2);
}

#[test]
fn what_does_not_converge_ends_with_3_and_a_summary() {
    // Nothing holds the block along x before it touches.
    let free = DECK.replace("x = 0.0, y = -0.01", "y = -0.01").replace("to = [4.0, 2.0]", "to = [4.0, 3.0]");
    let folder = folder(&free.replace("from = [0.0, 0.0]", "from = [0.0, 1.0]"));
    let run = asperity(folder.path(), &["run", "block.toml", "--out", "here"]);
    assert_eq!(code(&run), 3, "{}", error(&run));
    assert!(error(&run).contains("'block' is free along x"), "{}", error(&run));
    let summary = summary(&folder.path().join("here"));
    assert_eq!(summary["status"], "not-converged");
    assert!(summary["reason"].as_str().unwrap().contains("free along x"));
    let text = String::from_utf8_lossy(&run.stdout).into_owned();
    assert!(text.contains("\n  asperity restart block.toml --out here\n"), "{text}");
    let check = asperity(folder.path(), &["check", "block.toml"]);
    assert_eq!(code(&check), 5);
    assert!(error(&check).contains("free along x"), "{}", error(&check));
}

/// A run that accepts no increment leaves nothing of an earlier one that a restart or a reader could take for its own.
#[test]
fn a_run_begins_without_the_results_of_another() {
    let folder = folder(DECK);
    let file = |name: &str| folder.path().join("here").join(name);
    assert_eq!(code(&asperity(folder.path(), &["run", "block.toml", "--out", "here"])), 0);
    let written = ["history.csv", "forces.svg"];
    assert!(written.iter().all(|name| file(name).exists()));
    // Nothing holds the block along x before it touches.
    let free = DECK.replace("x = 0.0, y = -0.01", "y = -0.01").replace("from = [0.0, 0.0]", "from = [0.0, 1.0]");
    std::fs::write(folder.path().join("free.toml"), free.replace("to = [4.0, 2.0]", "to = [4.0, 3.0]")).unwrap();
    assert_eq!(code(&asperity(folder.path(), &["run", "free.toml", "--out", "here"])), 3);
    let left: Vec<_> = written.iter().filter(|name| file(name).exists()).collect();
    assert!(left.is_empty(), "{left:?}");
    let restart = asperity(folder.path(), &["restart", "block.toml", "--out", "here"]);
    assert_eq!(code(&restart), 2);
    assert!(error(&restart).contains("another deck"), "{}", error(&restart));
}

/// A run that is interrupted ends with 4, goes on from its checkpoint, and arrives where an undisturbed one does.
#[cfg(unix)]
#[test]
fn an_interrupted_run_goes_on() {
    let folder = folder(DECK);
    let results = folder.path().join("block.results");
    let mut child = Command::new(env!("CARGO_BIN_EXE_asperity"))
        .args(["run", "block.toml"])
        .current_dir(folder.path())
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    let begun = std::time::Instant::now();
    while std::fs::read_to_string(results.join("increments.csv")).map_or(0, |text| text.lines().count()) < 4 {
        assert!(begun.elapsed().as_secs() < 60, "the run does not get on");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    // As `timeout` does, which signals a program and then its group.
    let twice =
        Command::new("sh").args(["-c", "kill -TERM $0; kill -TERM $0", &child.id().to_string()]).status().unwrap();
    assert!(twice.success());
    assert_eq!(child.wait().unwrap().code(), Some(4));
    let stopped = summary(&results);
    assert_eq!(stopped["status"], "stopped");
    assert!(stopped["increments"].as_u64().unwrap() < 202);

    let other = asperity(folder.path(), &["restart", "block.toml", "--set", "material.steel.elastic.young=2e5"]);
    assert_eq!(code(&other), 2);
    assert!(
        error(&other).contains("another deck")
            && error(&other).contains("`material.steel` is not")
            && error(&other).contains("--set"),
        "{}",
        error(&other)
    );

    assert_eq!(code(&asperity(folder.path(), &["restart", "block.toml", "--threads", "1"])), 0);
    assert_eq!(code(&asperity(folder.path(), &["run", "block.toml", "--out", "whole", "--threads", "2"])), 0);
    let [parted, undisturbed] = [&results, &folder.path().join("whole")].map(|directory| summary(directory));
    for what in ["certificate", "worst", "notes", "status"] {
        assert_eq!(parted[what], undisturbed[what]);
    }
    for file in ["history.csv", "certificate.csv", "iterations.csv", "increments.csv"] {
        let read = |directory: &Path| std::fs::read(directory.join(file)).unwrap();
        assert_eq!(read(&results), read(&folder.path().join("whole")), "{file}");
    }
}

#[test]
fn the_smaller_verbs_speak() {
    let folder = folder(DECK);
    let says = |arguments: &[&str], words: &str| {
        let output = asperity(folder.path(), arguments);
        assert_eq!(code(&output), 0, "{arguments:?}: {}", error(&output));
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(text.contains(words), "{arguments:?}: {text}");
    };
    says(&["schema"], "\"$schema\"");
    says(&["schema", "--manual"], "friction");
    says(&["completions", "bash"], "asperity");
    says(&["--help"], "Exit codes");
    let empty = asperity(folder.path(), &["info", "block.toml"]);
    assert_eq!(code(&empty), 2);
}

/// What ranks of a cluster need is said by any program, also of a deck for PETSc, and this machine's memory is then no matter.
#[test]
fn the_memory_of_ranks_is_predicted_anywhere() {
    let folder = folder(DECK);
    let check =
        |ranks: &str, set: &str| asperity(folder.path(), &["check", "block.toml", "--ranks", ranks, "--set", set]);
    let need = |ranks: &str, set: &str| {
        let output = check(ranks, set);
        assert_eq!(code(&output), 0, "{}", error(&output));
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let said = text.split_once(&format!("memory of a rank, {ranks} in all:\n")).expect("a prediction").1;
        let gigabytes = |line: &str| -> Vec<f64> {
            line.split(" GB").filter_map(|words| words.rsplit(' ').next()?.parse().ok()).collect()
        };
        said.lines().take(2).map(gigabytes).collect::<Vec<_>>()
    };
    for set in ["solver.petsc=\"-ksp_type fgmres -pc_type hypre\"", "solver.iterations=20"] {
        let (one, four) = (need("1", set), need("4", set));
        assert_eq!(one.iter().chain(&four).map(Vec::len).collect::<Vec<_>>(), [1, 1, 2, 2]);
        assert!(one.iter().zip(&four).all(|(one, four)| one[0] >= four[0] && four[0] > four[1] && four[1] > 0.05));
    }
    for wrong in ["0", "two", "-1", "1.5", "99999999999999999999999"] {
        let output = check(wrong, "solver.iterations=20");
        let (code, message) = (code(&output), error(&output));
        assert!(code == 2 && message.contains(wrong), "{code} {message}");
        assert_eq!(message.matches("error:").count(), 1, "{message}");
    }
}

#[test]
fn a_point_is_driven_and_leaves_table_and_curves() {
    let directory = tempfile::tempdir().unwrap();
    let deck = "version = 1\nmaterial.m.elastic = { young = 2.0, poisson = 0.25 }\n[[step]]\nincrements = 4\nstrain.xx = 0.1\n";
    std::fs::write(directory.path().join("bar.toml"), deck).unwrap();
    let point = asperity(directory.path(), &["point", "bar.toml"]);
    assert_eq!(code(&point), 0, "{}", error(&point));
    let table = std::fs::read_to_string(directory.path().join("bar.results/m.csv")).unwrap();
    assert_eq!(table.lines().count(), 6);
    for file in String::from_utf8(point.stdout).unwrap().lines() {
        assert!(directory.path().join(file).exists(), "{file}");
    }
    let mistaken = asperity(directory.path(), &["run", "bar.toml"]);
    assert_eq!(code(&mistaken), 2);
    assert!(error(&mistaken).contains("asperity point") && !error(&mistaken).contains("does not say"));
    let wrong = asperity(directory.path(), &["point", "bar.toml", "--set", "step.1.strain.xx=\"much\""]);
    assert_eq!(code(&wrong), 2, "{}", error(&wrong));
}

#[test]
fn a_path_that_fails_leaves_what_was_reached_and_the_reason() {
    let folder = folder("");
    let deck = "version = 1\ninterface.joint.cohesive = { friction = 0.6, cohesion = 4.0, tension = 5.0 }\npenalty = 1e4\n\
                [[step]]\npressure = -8.0\nincrements = 8\n";
    std::fs::write(folder.path().join("joint.toml"), deck).unwrap();
    let run = asperity(folder.path(), &["point", "joint.toml"]);
    assert_eq!(code(&run), 3, "{}", error(&run));
    assert!(error(&run).contains("joint, step 1") && error(&run).contains("out of reach"), "{}", error(&run));
    let table = std::fs::read_to_string(folder.path().join("joint.results/joint.csv")).unwrap();
    assert_eq!(table.lines().count(), 2 + 5, "{table}");
}

#[test]
fn laws_are_listed_with_their_numbers() {
    let laws = asperity(Path::new("."), &["laws"]);
    let text = String::from_utf8(laws.stdout).unwrap();
    for entry in asperity::material::laws::ALL {
        assert!(text.contains(&format!("  {}: {}", entry.name, entry.meaning)), "{}", entry.name);
        entry.parameters.iter().for_each(|p| assert!(text.contains(p.meaning), "{}", p.key));
    }
}

#[test]
fn a_point_of_an_interface_leaves_a_table_and_its_curves() {
    let folder = folder("");
    let joint = "friction = 0.6, dilatancy = 0.3, dilation_slip = 2e-3";
    let deck = format!(
        "version = 1\ninterface.joint.dilatant = {{ {joint} }}\npenalty = 1e6\n[[step]]\npressure = 100.0\n\
         [[step]]\nnormal_stiffness = 2e4\nslip = [0.02, 0.0]\n"
    );
    std::fs::write(folder.path().join("joint.toml"), &deck).unwrap();
    let run = asperity(folder.path(), &["point", "joint.toml"]);
    assert_eq!(code(&run), 0, "{}", error(&run));
    let results = folder.path().join("joint.results");
    let table = std::fs::read_to_string(results.join("joint.csv")).unwrap();
    assert!(table.starts_with("time,penetration,slip_s,") && table.lines().count() == 202, "{table}");
    for curve in ["shear_s_over_slip_s", "closure_over_slip_s", "shear_over_pressure"] {
        assert!(results.join(format!("{curve}.svg")).exists(), "{curve}");
    }
    let dry = deck.replace(".dilatant", ".coulomb").replace(joint, "friction = 0.6");
    std::fs::write(folder.path().join("dry.toml"), dry).unwrap();
    let run = asperity(folder.path(), &["point", "dry.toml"]);
    assert_eq!(code(&run), 0, "{}", error(&run));
    let dry = folder.path().join("dry.results");
    assert!(dry.join("shear_s_over_slip_s.svg").exists() && !dry.join("closure_over_slip_s.svg").exists());
}

#[test]
fn tangents_of_a_point_are_compared() {
    let folder = folder("");
    let steel = "young = 200e3, poisson = 0.3, yield_stress = 200.0, hardening = 1e3";
    let deck = format!(
        "version = 1\nmaterial.steel.von_mises = {{ {steel} }}\n[[step]]\nincrements = 5\nstrain = {{ xx = 0.01 }}\n"
    );
    std::fs::write(folder.path().join("steel.toml"), deck).unwrap();
    let run = asperity(folder.path(), &["point", "steel.toml", "--tangent"]);
    let text = String::from_utf8_lossy(&run.stdout).into_owned();
    assert!(code(&run) == 0 && text.starts_with("steel: tangent within ") && text.contains("45 columns"), "{text}");
    let slide = "version = 1\ninterface.joint.coulomb = { friction = 0.6 }\npenalty = 1e6\n[[step]]\npressure = 1.0\n";
    std::fs::write(folder.path().join("joint.toml"), slide).unwrap();
    let run = asperity(folder.path(), &["point", "joint.toml", "--tangent"]);
    assert!(code(&run) == 2 && error(&run).contains("laws of interfaces"), "{}", error(&run));
}

#[test]
fn every_law_of_an_interface_is_listed_with_its_numbers() {
    let listed = asperity(Path::new("."), &["laws"]);
    let text = String::from_utf8_lossy(&listed.stdout).into_owned();
    for entry in asperity::interface::laws::ALL {
        assert!(text.contains(&format!("\n  {}: {}\n", entry.name, entry.meaning)), "{} is not listed", entry.name);
        let own = text.split_once(&format!("\n  {}: ", entry.name)).map(|(_, rest)| rest).unwrap();
        let own = own.split("\n\n").next().unwrap();
        assert!(entry.parameters.iter().all(|p| own.contains(&format!("    {} ", p.key))), "{own}");
    }
}

/// The force of a rigid interface differs from that with the penalty of the deck by less than the error that is stated, and
/// a penalty sixteen times stiffer is nearer to it.
#[test]
fn a_penalty_study_states_its_error() {
    let folder = folder(DECK);
    // Without friction, whose own penalty would change too.
    let few = ["--set", "step.push.increments={count=2}", "--set", "contact.sole.law.coulomb.friction=0.0"];
    let stiff = "contact.sole.penalty=2e8";
    let study = asperity(folder.path(), &[&["penalty", "study", "block.toml"], &few[..]].concat());
    assert_eq!(code(&study), 0, "{}", error(&study));
    let numbers = |output: &Output| -> [f64; 4] {
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let line = text.lines().find(|line| line.contains("contact.sole.thrust")).expect("a line of the contact");
        let numbers: Vec<f64> = line.split_whitespace().skip(1).map(|word| word.parse().unwrap()).collect();
        numbers.try_into().unwrap()
    };
    let [soft, penalty, rigid, stated] = numbers(&study);
    assert!(soft < penalty && penalty < rigid, "{soft} {penalty} {rigid}");
    assert!(rigid - penalty < stated, "{rigid} {penalty} {stated}");
    let [_, stiffer, ..] =
        numbers(&asperity(folder.path(), &[&["penalty", "study", "block.toml", "--set", stiff], &few[..]].concat()));
    assert!((stiffer - rigid).abs() < 0.2 * (penalty - rigid).abs(), "{stiffer} {rigid} {penalty}");
    let refused = asperity(folder.path(), &["penalty", "study", "block.toml", "--ratio", "1"]);
    assert_eq!(code(&refused), 2);
    assert!(error(&refused).contains("above 1"), "{}", error(&refused));
}
