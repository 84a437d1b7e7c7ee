//! The page in a browser: what is chosen is shown, sliders slide, tables sort, nothing is loaded, nothing overflows.
//!
//! The page stands in a frame of the width under test, since a browser's window has a least width. A script that is
//! added to the page uses it and sends what it finds to the page around it, which the browser prints.

use crate::fixture;
use serde_json::Value;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use voxgi::report::html;

const PATIENCE: Duration = Duration::from_secs(120);

fn find() -> Option<PathBuf> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|file| file.is_file())
}

/// What the script in `drive.js` finds in the page of a comparison in a frame `width` pixels wide. `change` may spoil
/// the page first. `None`, with a line that says so, where there is no browser.
fn drive(width: u32, change: impl Fn(String) -> String) -> Option<Value> {
    let Some(browser) = find() else {
        println!("skipped: there is no chromium, chromium-browser or google-chrome in PATH");
        return None;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let comparison = fixture::write(folder.path(), "sweep");
    let page = change(html(&comparison, folder.path()).expect("a page"));
    let watch = "<script>window.faults = []; addEventListener('error', (e) => faults.push(String(e.message))); \
                 console.error = (...words) => faults.push(words.join(' ')); \
                 addEventListener('securitypolicyviolation', (e) => faults.push('policy: ' + e.blockedURI));</script>";
    let script = format!("<script>{}</script></body>", include_str!("drive.js"));
    let page = page.replacen("<head>", &format!("<head>{watch}"), 1).replacen("</body>", &script, 1);
    let around = format!(
        "<!DOCTYPE html><pre id=found></pre><script>addEventListener('message', (event) => \
         {{ document.getElementById('found').textContent = event.data; }});</script>\
         <iframe src=page.html style='width:{width}px;height:900px;border:0'></iframe>"
    );
    std::fs::write(folder.path().join("page.html"), page).expect("the folder can be written to");
    std::fs::write(folder.path().join("around.html"), around).expect("the folder can be written to");
    let printed = run(&browser, folder.path());
    let found = printed.split_once("<pre id=\"found\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let (found, _) = found.unwrap_or_else(|| panic!("the browser printed: {printed}"));
    let found = found.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    Some(serde_json::from_str(&found).unwrap_or_else(|error| panic!("{error}: `{found}`")))
}

fn run(browser: &Path, folder: &Path) -> String {
    let mut child = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--window-size=1400,1000"])
        .args(["--virtual-time-budget=20000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", folder.join("browser").display()))
        .arg(format!("file://{}", folder.join("around.html").display()))
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("the browser starts");
    let mut stdout = child.stdout.take().expect("its output is piped");
    let reader = std::thread::spawn(move || {
        let mut text = String::new();
        stdout.read_to_string(&mut text).map(|_| text)
    });
    let start = Instant::now();
    while child.try_wait().expect("the browser can be waited for").is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().expect("the browser can be ended");
            child.wait().expect("the browser ends");
            panic!("the browser took more than {PATIENCE:?}");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    reader.join().expect("the reader ends").expect("its output is text")
}

fn is_right(width: u32, chart: &str) {
    let Some(found) = drive(width, |page| page) else { return };
    let expected = serde_json::json!({
        "faults": [],
        "loaded": [],
        "overflow": [],
        "first": {
            "outputs": ["color"],
            "measures": ["relmse"],
            "runs": ["run-1"],
            "charts": [format!("chart {chart}")],
        },
        "chosen": { "outputs": ["direct"], "measures": ["flip"] },
        "run": { "chosen": ["run-3"], "linked": ["run-2"], "select": "run-2", "clicked": ["run-5"] },
        "slider": { "half": "50%", "moved": "20%", "dragged": "75%", "after": "75%", "uncut": true },
        "sorted": { "rising": true, "falling": true, "aria": ["ascending", "descending"], "rows": 18 },
        "points": { "some": true, "lost": [] },
        "unnamed": [],
    });
    assert_eq!(found, expected, "at {width} pixels");
}

#[test]
fn the_page_works_on_a_desk() {
    is_right(1280, "wide");
}

#[test]
fn the_page_works_on_a_phone() {
    is_right(375, "narrow");
}

/// That the checks above can fail.
#[test]
fn a_spoilt_page_is_noticed() {
    let spoil = |page: String| {
        let wrong = "<script>console.error('on purpose');</script>\
                     <img src='http://127.0.0.1:9/x.png' alt=''><div style='width:3000px'>wide</div>\
                     <a class=point href='#run-999'></a></main>";
        page.replacen("</main>", wrong, 1)
    };
    let Some(found) = drive(375, spoil) else { return };
    let faults: Vec<&str> =
        found["faults"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    assert!(faults.contains(&"on purpose"), "{faults:?}");
    assert!(faults.iter().any(|fault| fault.starts_with("policy: http://127.0.0.1:9")), "{faults:?}");
    assert_ne!(found["overflow"], serde_json::json!([]));
    assert_eq!(found["unnamed"].as_array().map(Vec::len), Some(2), "the picture and the link");
    assert_eq!(found["points"]["lost"], serde_json::json!(["#run-999"]));
}
