//! `report.html` and `asperity watch`, as files, as requests, and in a browser where one is installed.
#![cfg(unix)]

mod browser;

use browser::Browser;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

const PLANE: &str = r#"
version = 1
title = "A block </script><img src=x onerror=alert(1)> & 'so on'"
space = "plane-strain"
mesh.part."a<b>&c".rectangle = { from = [0.0, 0.0], to = [4.0, 2.0], cells = [8, 4], cell = "quad8" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body."a<b>&c" = { material = "steel" }
tool.plate.profile = [{ line = [[20.0, 0.0], [-20.0, 0.0]] }]
contact.sole = { surface = "a<b>&c.bottom", target = "plate", law.coulomb = { friction = 0.2 } }

[[step]]
name = "press"
increments = { count = 6, smallest = 0.02 }
displacement."a<b>&c.top" = { x = 0.0, y = -0.01 }
"#;

const SPACE: &str = r#"
version = 1
title = "A cube under a ball"
space = "solid"
mesh.part.cube.box = { from = [0.0, 0.0, -2.0], to = [2.0, 2.0, 0.0], cells = [5, 5, 5], cell = "hex8" }
material.steel.elastic = { young = 210e3, poisson = 0.3 }
body.cube = { material = "steel" }
tool.ball.sphere = { center = [0.0, 0.0, 3.0], radius = 3.0 }
contact.top = { surface = "cube.front", target = "ball", form = "paper", law.coulomb = { friction = 0.2 } }

[[step]]
name = "press"
increments = { count = 5, smallest = 0.05 }
symmetry = ["cube.left", "cube.bottom"]
displacement."cube.back" = { z = 0.0 }
motion.ball = { z = -0.1 }
"#;

const TUBE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/tube/tube.toml");

fn asperity(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_asperity")).args(arguments).current_dir(directory).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap_or_else(|| panic!("{output:?}"))
}

/// Runs decks in a folder; each must end with its code.
fn runs(decks: &[(&str, String, i32)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, deck, expected) in decks {
        std::fs::write(folder.path().join(format!("{name}.toml")), deck).unwrap();
        let output = asperity(folder.path(), &["run", &format!("{name}.toml"), "--quiet"]);
        assert_eq!(code(&output), *expected, "{name}: {output:?}");
        assert!(output.stdout.is_empty());
    }
    folder
}

/// Failed runs in the plane and in space: pressed flat.
fn failing() -> [String; 2] {
    [PLANE.replace("y = -0.01", "y = -3.0"), SPACE.replace("z = -0.1 }", "z = -3.0 }")]
}

#[test]
fn the_page_is_one_file_that_carries_no_foreign_markup() {
    let folder = runs(&[("block", PLANE.into(), 0)]);
    let directory = folder.path().join("block.results");
    let page = std::fs::read_to_string(directory.join("report.html")).unwrap();
    assert!(!page.contains("<img") && page.contains("&lt;img src=x"), "the title is a text");
    assert!(!page.contains("a<b>"), "so are names");
    assert!(page.contains("a&lt;b&gt;&amp;c"));
    for foreign in ["http://", "https://", "src=\"", "url("] {
        let found = page.replace("http://www.w3.org/2000/svg", "").replace("url(#", "").contains(foreign);
        assert!(!found, "{foreign}");
    }
    assert!(page.contains("connect-src 'none'") && page.len() < 1_000_000);
    for said in ["seconds of run", "largest penetration", "fingerprint", "Balance of energy"] {
        assert!(page.contains(said), "{said}");
    }
    let summary: Value = serde_json::from_slice(&std::fs::read(directory.join("summary.json")).unwrap()).unwrap();
    assert!(summary["files"].as_array().unwrap().iter().any(|file| file == "report.html"));
    std::fs::remove_file(directory.join("report.html")).unwrap();
    let again = asperity(folder.path(), &["report", "block.results"]);
    assert_eq!((code(&again), String::from_utf8_lossy(&again.stdout).trim()), (0, "block.results/report.html"));
    let text = std::fs::read_to_string(directory.join("report.html")).unwrap();
    assert!(text.contains("increments = { count = 6") && text.contains("keys that were not said"), "deck and defaults");
}

#[test]
fn nothing_to_report_is_one_message() {
    let folder = tempfile::tempdir().unwrap();
    for verb in ["report", "watch"] {
        let refused = asperity(folder.path(), &[verb, "nowhere"]);
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(
            code(&refused) == 2 && said.contains("no results of a run here") && said.lines().count() == 1,
            "{said}"
        );
    }
    std::fs::write(folder.path().join("summary.json"), "{").unwrap();
    let damaged = asperity(folder.path(), &["report", "."]);
    assert!(code(&damaged) == 2 && String::from_utf8_lossy(&damaged.stderr).contains("summary.json"));
}

#[test]
fn events_are_lines_of_json_and_a_report_can_be_left_out() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("block.toml"), PLANE).unwrap();
    let output = asperity(folder.path(), &["run", "block.toml", "--json", "--no-report"]);
    let text = String::from_utf8(output.stdout).unwrap();
    let all: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    // Iterations come before the attempt that they are of, which counts them; the first is the state before any.
    let (mut events, mut iterations) = (Vec::new(), 0);
    for event in all {
        match event["event"].as_str() {
            Some("iteration") => {
                assert_eq!(event["iteration"], iterations);
                iterations += 1;
            }
            kind => {
                assert!(kind != Some("attempt") || event["iterations"] == iterations - 1, "{event}");
                iterations = 0;
                events.push(event);
            }
        }
    }
    let kinds: Vec<&str> = events.iter().map(|event| event["event"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["begin", "attempt", "attempt", "attempt", "attempt", "attempt", "attempt", "end"]);
    assert_eq!(events[0]["steps"][0]["name"], "press");
    assert!(events[3]["accepted"] == true && events[3]["increment"] == 3 && events[3]["step"] == "press");
    assert_eq!(events[7]["summary"]["status"], "converged");
    assert!(!folder.path().join("block.results/report.html").exists());
    let status: Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("block.results/status.json")).unwrap()).unwrap();
    assert_eq!((&status["status"], status["increment"].as_u64()), (&"converged".into(), Some(6)));
}

/// A run of many increments, and a server beside it.
struct Watched {
    run: Child,
    server: Child,
    port: u16,
    token: String,
    address: String,
}

impl Watched {
    fn start(folder: &Path) -> Self {
        let deck = std::fs::read_to_string(TUBE).unwrap().replace("count = 100", "count = 20000");
        std::fs::write(folder.join("tube.toml"), deck).unwrap();
        let program = || {
            let mut command = Command::new(env!("CARGO_BIN_EXE_asperity"));
            command.current_dir(folder);
            command
        };
        let run = program().args(["run", "tube.toml", "--quiet", "--set", "output.every=10"]).spawn().unwrap();
        let directory = folder.join("tube.results");
        until(|| {
            std::fs::read_to_string(directory.join("status.json")).is_ok_and(|text| !text.contains("\"increment\":0"))
        });
        let mut server = program().args(["watch", "tube.results"]).stdout(Stdio::piped()).spawn().unwrap();
        let mut address = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut address).unwrap();
        let address = address.trim().to_owned();
        let (host, token) = address.strip_prefix("http://127.0.0.1:").unwrap().split_once("/?token=").unwrap();
        Self { run, server, port: host.parse().unwrap(), token: token.into(), address: address.clone() }
    }

    /// The status and the content of an answer.
    fn ask(&self, line: &str, headers: &str) -> (u16, String) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.write_all(format!("{line} HTTP/1.1\r\n{headers}\r\n").as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        let (head, content) = answer.split_once("\r\n\r\n").unwrap();
        (head.split(' ').nth(1).unwrap().parse().unwrap(), content.to_owned())
    }

    fn own(&self) -> String {
        format!("Host: 127.0.0.1:{}\r\nX-Asperity-Token: {}\r\n", self.port, self.token)
    }

    fn ended(&mut self) -> i32 {
        let begun = Instant::now();
        loop {
            if let Some(status) = self.run.try_wait().unwrap() {
                return status.code().unwrap();
            }
            assert!(begun.elapsed() < Duration::from_secs(60), "the run goes on");
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        for child in [&mut self.run, &mut self.server] {
            drop(child.kill());
            drop(child.wait());
        }
    }
}

fn until(is: impl Fn() -> bool) {
    let begun = Instant::now();
    while !is() {
        assert!(begun.elapsed() < Duration::from_secs(60), "this never came true");
        std::thread::sleep(Duration::from_millis(10));
    }
}

#[test]
fn a_terminal_shows_the_run_and_stops_it() {
    if Command::new("script").arg("--version").output().is_err() {
        println!("skipped: there is no `script` to make a terminal");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut watched = Watched::start(folder.path());
    let watch = format!("stty rows 30 cols 100; exec '{}' watch tube.results", env!("CARGO_BIN_EXE_asperity"));
    let mut terminal = Command::new("script")
        .args(["-qec", &watch, "/dev/null"])
        .env("TERM", "xterm")
        .current_dir(folder.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut keys = terminal.stdin.take().unwrap();
    for key in ["", "s", "y"] {
        std::thread::sleep(Duration::from_secs(1));
        keys.write_all(key.as_bytes()).unwrap();
    }
    assert_eq!(watched.ended(), 4, "the run was not stopped from the terminal");
    keys.write_all(b"q").unwrap();
    let shown = terminal.wait_with_output().unwrap();
    assert!(shown.status.success());
    let shown = String::from_utf8_lossy(&shown.stdout).into_owned();
    // What stands between words is not drawn where nothing was before.
    for part in ["tube.results", "contact.bore.thrust", "trust", "yes,", "http://127.0.0.1:"] {
        assert!(shown.contains(part), "'{part}' was not shown");
    }
    // The screen that was there before is back.
    assert!(shown.contains("\u{1b}[?1049h") && shown.contains("\u{1b}[?1049l"));
    assert!(folder.path().join("tube.results/run.checkpoint").exists());
}

#[test]
fn the_server_answers_its_own_page_only_and_stops_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let mut watched = Watched::start(folder.path());
    let own = watched.own();
    let host = format!("Host: 127.0.0.1:{}\r\n", watched.port);
    for (line, headers, status) in [
        ("GET /", host.clone(), 403),
        ("GET /?token=00", host.clone(), 403),
        ("GET /status.json", host.clone(), 403),
        ("POST /stop", host.clone(), 403),
        ("POST /stop", format!("{own}Origin: https://evil.example\r\n"), 403),
        ("POST /stop", own.replace("127.0.0.1", "evil.example"), 403),
        ("GET /deck.json", own.clone(), 404),
        ("GET /../tube.toml", own.clone(), 404),
        ("GET /stop", own.clone(), 405),
    ] {
        assert_eq!(watched.ask(line, &headers).0, status, "{line} {headers}");
    }
    let asked = |name: &str| folder.path().join("tube.results").join(name).exists();
    assert!(!asked("stop.request") && !asked("checkpoint.request"), "nothing was asked of the run");
    // Loopback only: no other address of this machine listens.
    assert!(TcpStream::connect(("127.0.0.2", watched.port)).is_err());
    let json = |watched: &Watched, path: &str| -> Value {
        let (status, content) = watched.ask(&format!("GET {path}"), &own);
        assert_eq!(status, 200, "{content}");
        serde_json::from_str(&content).unwrap()
    };
    let first = json(&watched, "/rows?table=history&from=0");
    let next = first["next"].as_u64().unwrap();
    until(|| json(&watched, &format!("/rows?table=history&from={next}"))["table"]["rows"].as_u64() > Some(0));
    let more = json(&watched, &format!("/rows?table=history&from={next}"));
    let times = |table: &Value| table["table"]["columns"][0].as_array().unwrap().clone();
    assert!(times(&more)[0].as_f64() > times(&first).last().unwrap().as_f64(), "the rows follow one another");
    let status = json(&watched, "/status.json");
    assert!(status["runs"] == true && status["progress"]["remaining"].as_f64() > Some(0.0), "{status}");
    let summary = json(&watched, "/summary.json");
    assert!(
        summary["status"] == "running" && summary["increments"].as_u64() > Some(0),
        "the summary tells the truth meanwhile"
    );
    let checkpoint = folder.path().join("tube.results/run.checkpoint");
    let written = || std::fs::metadata(&checkpoint).and_then(|data| data.modified()).ok();
    assert_eq!(watched.ask("POST /checkpoint", &own).0, 200);
    until(|| written().is_some() && !asked("checkpoint.request"));
    assert_eq!(watched.ask("POST /stop", &own).0, 200);
    assert_eq!(watched.ended(), 4);
    assert!(checkpoint.exists() && folder.path().join("tube.results/report.html").exists());
    let status = json(&watched, "/status.json");
    assert!(status["runs"] == false && status["progress"]["status"] == "stopped", "{status}");
}

/// Where pictures of pages go, for whoever wants to look at them.
fn pictures() -> std::path::PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Opens a report, uses all of it, and takes pictures of it.
fn try_page(browser: &mut Browser, page: &Path, name: &str) {
    let address = format!("file://{}", page.display());
    for (width, dark) in [(390, true), (2560, false), (1280, true), (1280, false)] {
        browser.look(width, dark);
        let ready = browser.open(&address);
        assert!(ready < 6000.0, "{name} is usable after {ready} ms");
        let wider = browser.value("document.documentElement.scrollWidth - document.documentElement.clientWidth");
        assert_eq!(wider, 0, "{name} at {width} does not scroll sideways");
        let theme = if dark { "dark" } else { "light" };
        browser.picture(&pictures().join(format!("{name}-{width}-{theme}.png")));
        eprintln!("{name} at {width}, {theme}: usable after {ready} ms");
    }
    browser.look(800, false);
    let begun = Instant::now();
    let told = browser.value(include_str!("browser/exercise.js"));
    eprintln!("{name}: {} uses of controls in {:.0} s", told["used"], begun.elapsed().as_secs_f64());
    let changed = |control: &str| told["changed"].get(control).is_none_or(|changed| changed == true);
    for control in [
        "quantity",
        "range",
        "bands",
        "mesh",
        "vectors",
        "tools",
        "vector-length",
        "frame",
        "back",
        "factor",
        "nearer",
        "fit",
        "x",
        "clip",
        "clip-at",
        "clip-flip",
        "theme",
    ] {
        assert!(changed(control), "{name}: {control} does not change the picture: {told}");
    }
    assert!(told["first"]["colors"].as_u64() > Some(20), "{name} is drawn: {told}");
    assert!(told["left"].as_array().unwrap().is_empty(), "{name}: controls that were not used: {}", told["left"]);
    assert!(told["unnamed"].as_array().unwrap().is_empty(), "{name}: controls without a name: {}", told["unnamed"]);
    assert!(told["history"].as_u64() > Some(0) && told["curves"].as_u64() > Some(0), "{name}: {told}");
    // By hand: turn or move, wheel, click on the body, keys.
    browser.value("document.getElementById('fit').click(); document.getElementById('body').scrollIntoView()");
    let middle = browser.value("(() => { const b = document.getElementById('canvas').getBoundingClientRect(); return [b.left + b.width / 2, b.top + b.height / 2] })()");
    let [x, y] = [0, 1].map(|a| middle[a].as_f64().unwrap());
    for (kind, at) in [
        ("mousePressed", [x, y]),
        ("mouseReleased", [x, y]),
        ("mousePressed", [x, y]),
        ("mouseMoved", [x + 40.0, y + 20.0]),
        ("mouseReleased", [x + 40.0, y + 20.0]),
        ("mouseWheel", [x, y]),
    ] {
        browser.mouse(kind, at);
    }
    assert!(browser.value("document.activeElement.id") == "canvas", "{name}: the picture takes the focus");
    ["ArrowLeft", "ArrowUp", "+", "-", ",", ".", "0", "Escape"].iter().for_each(|key| browser.key(key));
    browser.value("document.querySelector('#history-chart svg').focus()");
    ["ArrowRight", "ArrowRight", "+", "0", "Escape"].iter().for_each(|key| browser.key(key));
    if name == "block" || name == "cube" {
        let pdf = browser.send("Page.printToPDF", serde_json::json!({}));
        assert!(pdf["data"].as_str().unwrap().len() > 10_000, "{name} prints");
    }
    assert_eq!(browser.requests, [address], "{name} asks for nothing besides itself");
    assert!(browser.troubles.is_empty(), "{name}: {:#?}", browser.troubles);
}

#[test]
fn reports_work_in_a_browser() {
    let Some(mut browser) = Browser::start() else { return };
    let [plane, space] = failing();
    let tube = std::fs::read_to_string(TUBE).unwrap();
    let decks = [
        ("block", PLANE.to_owned(), 0),
        ("cube", SPACE.to_owned(), 6),
        ("flat_block", plane, 3),
        ("flat_cube", space, 3),
        ("tube", tube, 0),
    ];
    let folder = runs(&decks);
    for (name, ..) in &decks {
        try_page(&mut browser, &folder.path().join(format!("{name}.results/report.html")), name);
    }
}

/// A hundred thousand unknowns and twenty frames: at most 15 MB.
#[test]
#[ignore = "two runs of a minute each"]
fn large_reports_work_in_a_browser() {
    let Some(mut browser) = Browser::start() else { return };
    let plane = PLANE
        .replace("[8, 4]", "[320, 155]")
        .replace("quad8", "quad4")
        .replace("count = 6", "count = 20")
        .replace("{ line = [[20.0, 0.0], [-20.0, 0.0]] }", "{ arc = [[3.0, -1.0], [2.0, 0.0], [1.0, -1.0]] }");
    let space =
        SPACE.replace("[5, 5, 5]", "[31, 31, 31]").replace("count = 5", "count = 20").replace("-0.1 }", "-0.06 }");
    let decks = [("large_block", plane, 0), ("large_cube", space, 0)];
    let folder = runs(&decks);
    for (name, ..) in &decks {
        let page = folder.path().join(format!("{name}.results/report.html"));
        let size = std::fs::metadata(&page).unwrap().len();
        eprintln!("{name}: {:.1} MB", size as f64 / 1e6);
        assert!(size < 15_000_000, "{name}: {size} bytes");
        try_page(&mut browser, &page, name);
    }
}

#[test]
fn curves_grow_in_a_browser_and_its_button_stops_the_run() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut watched = Watched::start(folder.path());
    browser.look(1280, false);
    let address = watched.address.clone();
    browser.open(&address);
    let points = "(document.querySelector('#history-chart path.curve')?.getAttribute('d').match(/L/g) || []).length";
    browser.until(&format!("{points} > 3"));
    let before = browser.value(points).as_u64();
    browser.until(&format!("{points} > {}", before.unwrap() + 2));
    browser.until("document.getElementById('log').children.length > 5 && document.getElementById('done').value > 0");
    browser.until("document.getElementById('now').textContent.includes('push')");
    browser.picture(&pictures().join("watch.png"));
    browser.until("!document.getElementById('frames').disabled");
    browser.value("document.getElementById('frames').click()");
    browser.until("document.getElementById('live-told').textContent.includes('so far')");
    browser.value("document.getElementById('checkpoint').click()");
    browser.until("document.getElementById('live-told').textContent.includes('checkpoint')");
    browser.value("document.getElementById('stop').click()");
    assert_eq!(watched.ended(), 4);
    assert!(folder.path().join("tube.results/run.checkpoint").exists());
    browser.until("document.getElementById('standing')?.textContent === 'stopped on request'");
    browser.until("document.documentElement.dataset.ready && !document.getElementById('viewer').hidden");
    let host = format!("http://127.0.0.1:{}/", watched.port);
    assert!(browser.requests.iter().all(|request| request.starts_with(&host)), "{:?}", browser.requests);
    assert!(browser.troubles.is_empty(), "{:#?}", browser.troubles);
}
