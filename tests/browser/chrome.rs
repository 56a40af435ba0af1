//! Chromium, by the protocol of its developer tools: messages in JSON through a pipe, so that no port is open.

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine as _;
use serde_json::{Value, json};

use crate::screen::Screen;

/// A browser with one page.
pub(crate) struct Chrome {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    number: u64,
    session: Option<String>,
    /// What happened meanwhile.
    events: Vec<Value>,
    _profile: tempfile::TempDir,
}

/// The names under which it is installed.
const NAMES: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// It knows no network: no name has an address, and it asks for nothing by itself.
const FLAGS: [&str; 12] = [
    "--headless=new",
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--force-device-scale-factor=1",
    "--remote-debugging-pipe",
];

impl Chrome {
    /// Starts one; none if there is none, and nobody wants it.
    pub(crate) fn start() -> Option<Chrome> {
        let is_there = |name: &&str| {
            let found = Command::new(name).arg("--version").output();
            found.is_ok_and(|output| output.status.success())
        };
        let Some(name) = NAMES.into_iter().find(is_there) else {
            let skip = std::env::var("TEARMESH_SKIP").unwrap_or_default();
            assert!(
                skip.split_whitespace().any(|tool| tool == "chromium"),
                "there is no chromium; install it, or let TEARMESH_SKIP name it"
            );
            println!("skipped: there is no chromium; TEARMESH_SKIP names it");
            return None;
        };
        let profile = tempfile::tempdir().expect("a temporary folder");
        // It reads descriptor 3 and writes descriptor 4, which only a shell can set for it.
        let mut child = Command::new("sh")
            .args([
                "-c",
                "exec \"$@\" 3<&0 4>&1 </dev/null >/dev/null 2>&1",
                "sh",
            ])
            .arg(name)
            .args(FLAGS)
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("a shell");
        let (to, from) = (child.stdin.take(), child.stdout.take());
        let mut chrome = Chrome {
            child,
            to: to.expect("a pipe"),
            from: BufReader::new(from.expect("a pipe")),
            number: 0,
            session: None,
            events: Vec::new(),
            _profile: profile,
        };
        let target = chrome.call("Target.createTarget", &json!({"url": "about:blank"}));
        let attached = json!({"targetId": target["targetId"], "flatten": true});
        let session = chrome.call("Target.attachToTarget", &attached);
        chrome.session = session["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            chrome.call(&format!("{domain}.enable"), &json!({}));
        }
        chrome.size(1000, 640);
        Some(chrome)
    }

    /// Calls a method of the protocol, and gives its result.
    pub(crate) fn call(&mut self, method: &str, params: &Value) -> Value {
        self.number += 1;
        let mut message = json!({"id": self.number, "method": method, "params": params});
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let mut bytes = message.to_string().into_bytes();
        bytes.push(0);
        self.to.write_all(&bytes).expect("the browser listens");
        self.to.flush().expect("the browser listens");
        loop {
            let mut bytes = Vec::new();
            self.from.read_until(0, &mut bytes).expect("an answer");
            assert_eq!(bytes.pop(), Some(0), "the browser ended during {method}");
            let answer: Value = serde_json::from_slice(&bytes).expect("JSON");
            if answer["id"] != self.number {
                self.events.push(answer);
                continue;
            }
            assert_eq!(answer["error"], Value::Null, "{method}");
            return answer["result"].clone();
        }
    }

    /// The value of an expression in the page.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let params = json!({"expression": expression, "returnByValue": true, "awaitPromise": true});
        let result = self.call("Runtime.evaluate", &params);
        assert_eq!(result["exceptionDetails"], Value::Null, "{expression}");
        result["result"]["value"].clone()
    }

    /// The text of an element as it is seen; empty where it is hidden.
    pub(crate) fn text(&mut self, id: &str) -> String {
        let seen = format!(
            "(e => e.checkVisibility() ? e.textContent : '')({})",
            element(id)
        );
        self.value(&seen).as_str().expect("a text").to_owned()
    }

    /// The text of an element, seen or not.
    pub(crate) fn hidden_text(&mut self, id: &str) -> String {
        let text = self.value(&format!("{}.textContent", element(id)));
        text.as_str().expect("a text").to_owned()
    }

    /// Opens a file, and waits until all of it is there.
    pub(crate) fn open(&mut self, path: &Path) {
        let url = format!("file://{}", path.display());
        self.call("Page.navigate", &json!({"url": url}));
        let begun = Instant::now();
        while self.value("document.body?.dataset.ready ?? ''") != "yes" {
            let said = self.value("document.getElementById('say')?.textContent");
            assert!(
                begun.elapsed() < Duration::from_secs(30),
                "not ready: {said}"
            );
            std::thread::sleep(Duration::from_millis(20));
        }
        self.drawn();
    }

    /// Waits until what was asked for is drawn.
    pub(crate) fn drawn(&mut self) {
        self.value("new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))");
    }

    /// Has files that a page saves go into a folder.
    pub(crate) fn downloads_to(&mut self, folder: &Path) {
        // It is the browser that is asked, not the page.
        let session = self.session.take();
        let into = json!({"behavior": "allow", "downloadPath": folder});
        self.call("Browser.setDownloadBehavior", &into);
        self.session = session;
    }

    /// The size of the window.
    pub(crate) fn size(&mut self, width: u32, height: u32) {
        let size =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        self.call("Emulation.setDeviceMetricsOverride", &size);
    }

    /// A mouse's event.
    pub(crate) fn mouse(&mut self, kind: &str, [x, y]: [f64; 2]) {
        let (button, buttons) = match kind {
            "mousePressed" | "mouseDragged" => ("left", 1),
            "mouseReleased" => ("left", 0),
            _ => ("none", 0),
        };
        let delta_y = if kind == "mouseWheel" { -300 } else { 0 };
        let kind = kind.replace("Dragged", "Moved");
        let event = json!({"type": kind, "x": x, "y": y, "button": button, "buttons": buttons,
            "clickCount": 1, "deltaX": 0, "deltaY": delta_y});
        self.call("Input.dispatchMouseEvent", &event);
    }

    /// Clicks.
    pub(crate) fn click(&mut self, at: [f64; 2]) {
        for kind in ["mouseMoved", "mousePressed", "mouseReleased"] {
            self.mouse(kind, at);
        }
    }

    /// Clicks the middle of an element.
    pub(crate) fn press(&mut self, id: &str) {
        let middle = format!(
            "(b => [b.x + b.width / 2, b.y + b.height / 2])({}.getBoundingClientRect())",
            element(id)
        );
        let middle = self.value(&middle);
        self.click([0, 1].map(|i| middle[i].as_f64().expect("a number")));
        self.drawn();
    }

    /// Presses a key, and lets it go.
    pub(crate) fn key(&mut self, key: &str) {
        let text = if key.len() == 1 { key } else { "" };
        for kind in ["keyDown", "keyUp"] {
            let event = json!({"type": kind, "key": key, "text": text});
            self.call("Input.dispatchKeyEvent", &event);
        }
    }

    /// An event of fingers at these places.
    pub(crate) fn touch(&mut self, kind: &str, places: &[[f64; 2]]) {
        let points = (1..).zip(places);
        let points = points.map(|(id, [x, y])| json!({"x": x, "y": y, "id": id}));
        let event = json!({"type": kind, "touchPoints": points.collect::<Vec<_>>()});
        self.call("Input.dispatchTouchEvent", &event);
    }

    /// Gives a control a value, as if a person had.
    pub(crate) fn set(&mut self, id: &str, value: &str) {
        let event = "dispatchEvent(new Event('input'))";
        self.value(&format!("{id}.value = {value}, {id}.{event}"));
    }

    /// Whether something sticks out at the side of the window.
    pub(crate) fn sticks_out(&mut self) -> bool {
        self.value("document.documentElement.scrollWidth > innerWidth") == true
    }

    /// Drags from a place to another.
    pub(crate) fn drag(&mut self, from: [f64; 2], to: [f64; 2]) {
        self.mouse("mousePressed", from);
        for part in [0.25, 0.5, 0.75, 1.0] {
            let at = [0, 1].map(|i| from[i] + (to[i] - from[i]) * part);
            self.mouse("mouseDragged", at);
        }
        self.mouse("mouseReleased", to);
        self.drawn();
    }

    /// A picture of the left upper part of the window.
    pub(crate) fn screen(&mut self, [width, height]: [f64; 2]) -> Screen {
        self.drawn();
        let clip = json!({"x": 0, "y": 0, "width": width, "height": height, "scale": 1});
        let shot = self.call(
            "Page.captureScreenshot",
            &json!({"format": "png", "clip": clip}),
        );
        let data = shot["data"].as_str().expect("a picture");
        let bytes = base64::engine::general_purpose::STANDARD.decode(data);
        Screen::of(&bytes.expect("base64"))
    }

    /// Checks that the page said nothing on the console, threw nothing, and asked for nothing but itself.
    pub(crate) fn was_quiet(&mut self) {
        self.value("1"); // What it had to say has come before the answer.
        for event in &self.events {
            let method = event["method"].as_str().unwrap_or_default();
            let noise = [
                "Runtime.consoleAPICalled",
                "Runtime.exceptionThrown",
                "Log.entryAdded",
            ];
            assert!(!noise.contains(&method), "{event:#}");
            if method == "Network.requestWillBeSent" {
                let url = event["params"]["request"]["url"].as_str().expect("a URL");
                let is_own = url.starts_with("file:///") && url.ends_with(".html");
                // What it saves is a blob of its own.
                assert!(
                    is_own || url == "data:," || url.starts_with("blob:"),
                    "{url}"
                );
            }
        }
    }
}

impl Drop for Chrome {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn element(id: &str) -> String {
    format!("document.getElementById('{id}')")
}
