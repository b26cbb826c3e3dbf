//! A browser without a window, driven through a pipe by the Chrome DevTools Protocol: each message is JSON with a zero byte at
//! its end.

use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(60);

/// A browser with one page.
pub struct Browser {
    child: Child,
    input: ChildStdin,
    output: Receiver<Value>,
    session: Option<String>,
    number: u64,
    /// What went wrong in the page: exceptions, errors and warnings of the console.
    pub troubles: Vec<String>,
    /// Addresses that were asked for, texts of `data:` and `blob:` left out.
    pub requests: Vec<String>,
    _profile: tempfile::TempDir,
}

/// The browser of this machine, if it has one.
fn installed() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).flat_map(|folder| names.map(|name| folder.join(name))).find(|file| file.is_file())
}

impl Browser {
    /// Starts it; none, with a line that says so, where none is installed.
    pub fn start() -> Option<Self> {
        let Some(program) = installed() else {
            eprintln!("skipped: no Chromium is installed (Debian: apt-get install chromium)");
            return None;
        };
        let profile = tempfile::tempdir().unwrap();
        // The pipe is on descriptors 3 and 4; a shell moves it there from the standard ones.
        let line = r#"exec "$0" --headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader --remote-debugging-pipe \
            --disable-background-networking --no-first-run --user-data-dir="$1" about:blank 3<&0 4>&1 0</dev/null 1>/dev/null 2>/dev/null"#;
        let mut child = Command::new("bash")
            .args(["-c", line])
            .args([program.as_path(), profile.path()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (input, output) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
        let (sender, receiver) = channel();
        std::thread::spawn(move || {
            let mut output = BufReader::new(output);
            let mut bytes = Vec::new();
            while output.read_until(0, &mut bytes).is_ok_and(|read| read > 0) {
                bytes.pop();
                if sender.send(serde_json::from_slice(&bytes).unwrap()).is_err() {
                    return;
                }
                bytes.clear();
            }
        });
        let mut browser = Self {
            child,
            input,
            output: receiver,
            session: None,
            number: 0,
            troubles: Vec::new(),
            requests: Vec::new(),
            _profile: profile,
        };
        let target = browser.send("Target.createTarget", json!({ "url": "about:blank" }))["targetId"].clone();
        let attached = browser.send("Target.attachToTarget", json!({ "targetId": target, "flatten": true }));
        browser.session = attached["sessionId"].as_str().map(str::to_owned);
        ["Runtime.enable", "Log.enable", "Network.enable", "Page.enable"]
            .iter()
            .for_each(|method| drop(browser.send(method, json!({}))));
        browser.send("Browser.setDownloadBehavior", json!({ "behavior": "deny" }));
        Some(browser)
    }

    /// Sends a command and waits for its answer.
    pub fn send(&mut self, method: &str, parameters: Value) -> Value {
        self.number += 1;
        let mut message = json!({ "id": self.number, "method": method, "params": parameters });
        if let Some(session) = self.session.as_ref().filter(|_| !method.starts_with("Browser.")) {
            message["sessionId"] = json!(session);
        }
        self.input.write_all(format!("{message}\0").as_bytes()).unwrap();
        loop {
            let answer = self.output.recv_timeout(PATIENCE).unwrap_or_else(|_| panic!("no answer to {method}"));
            if answer["id"] == self.number {
                assert!(answer["error"].is_null(), "{method}: {}", answer["error"]);
                return answer["result"].clone();
            }
            self.note(&answer);
        }
    }

    fn note(&mut self, event: &Value) {
        let text = &event["params"];
        match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => self.troubles.push(text["exceptionDetails"].to_string()),
            Some("Runtime.consoleAPICalled") if text["type"] != "log" => self.troubles.push(text.to_string()),
            Some("Log.entryAdded") => self.troubles.push(text["entry"].to_string()),
            Some("Network.requestWillBeSent") => {
                let url = text["request"]["url"].as_str().unwrap_or_default();
                if !url.starts_with("data:") && !url.starts_with("blob:") {
                    self.requests.push(url.to_owned());
                }
            }
            _ => {}
        }
    }

    /// The value of an expression; promises are waited for.
    pub fn value(&mut self, expression: &str) -> Value {
        let parameters = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let answer = self.send("Runtime.evaluate", parameters);
        assert!(answer["exceptionDetails"].is_null(), "{}", answer["exceptionDetails"]);
        answer["result"]["value"].clone()
    }

    /// Waits until an expression is true.
    pub fn until(&mut self, expression: &str) {
        let begun = Instant::now();
        while self.value(&format!("Boolean({expression})")) != true {
            assert!(begun.elapsed() < PATIENCE, "never true: {expression}; {:?}", self.troubles);
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Opens a page and waits until it is usable; the milliseconds that it says it took.
    pub fn open(&mut self, address: &str) -> f64 {
        self.troubles.clear();
        self.requests.clear();
        self.send("Page.navigate", json!({ "url": address }));
        self.until("document.documentElement && document.documentElement.dataset.ready");
        self.value("Number(document.documentElement.dataset.ready)").as_f64().unwrap()
    }

    /// Sets the width of the window and whether the system is dark.
    pub fn look(&mut self, width: usize, dark: bool) {
        let size = json!({ "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": false });
        self.send("Emulation.setDeviceMetricsOverride", size);
        let scheme = if dark { "dark" } else { "light" };
        self.send(
            "Emulation.setEmulatedMedia",
            json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] }),
        );
    }

    /// Writes a picture of the window.
    pub fn picture(&mut self, path: &Path) {
        use base64::Engine;
        let shot = self.send("Page.captureScreenshot", json!({ "format": "png" }));
        let bytes = base64::engine::general_purpose::STANDARD.decode(shot["data"].as_str().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    /// Presses a key on what has the focus.
    pub fn key(&mut self, key: &str) {
        for kind in ["keyDown", "keyUp"] {
            self.send("Input.dispatchKeyEvent", json!({ "type": kind, "key": key }));
        }
    }

    /// A move of the mouse: `mouseMoved`, `mousePressed`, `mouseReleased`, `mouseWheel`.
    pub fn mouse(&mut self, kind: &str, [x, y]: [f64; 2]) {
        let pressed = kind == "mousePressed" || kind == "mouseReleased";
        let (button, count) = if pressed { ("left", 1) } else { ("none", 0) };
        let buttons = if kind == "mouseReleased" || kind == "mouseWheel" { 0 } else { 1 };
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": count, "deltaX": 0, "deltaY": if kind == "mouseWheel" { -120 } else { 0 } });
        self.send("Input.dispatchMouseEvent", event);
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}
