//! Pages in a browser, where there is one.

use std::fs;
use std::path::Path;
use std::process::Command;

/// What listens before anything else of a page runs.
const LISTEN: &str = "<script>window.said = [];
window.onerror = (e) => { said.push('error: ' + e); setTimeout(() => done([]), 500); };
for (const kind of ['error', 'warn', 'log']) console[kind] = (...x) => said.push(kind + ': ' + x.join(' '));
window.alert = (x) => said.push('alert: ' + x);
let ended = false; // what goes on in a page that is gone is nobody's
window.done = (seen) => { if (!ended) window.seen([...said, ...seen]); ended = true; };
</script></head>";

/// The browser of this machine, if there is one; there must be where `DALEMBERT_BROWSER=required`, as in `.ci/run`.
pub fn browser() -> Option<&'static str> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let is_there = |name: &&str| {
        let found = Command::new(name).arg("--version").output();
        found.is_ok_and(|output| output.status.success())
    };
    let found = names.into_iter().find(is_there);
    if found.is_none() {
        assert!(
            std::env::var_os("DALEMBERT_BROWSER").is_none(),
            "no Chromium on this machine"
        );
        eprintln!("left out: no Chromium on this machine");
    }
    found
}

/// The browser with a profile of its own, without a window.
fn headless(browser: &str, profile: &Path) -> Command {
    let mut command = Command::new(browser);
    command
        .args(["--headless", "--no-sandbox", "--disable-gpu"])
        .args(["--no-first-run", "--disable-background-networking"])
        .args(["--disable-component-update", "--disable-sync"])
        .arg("--disable-quic")
        .arg(format!("--user-data-dir={}", profile.display()));
    command
}

/// A picture of a file in the browser, of this width and height, with two pixels on each.
#[allow(dead_code)] // not every program that has this module asks for pictures
pub fn screenshot(file: &Path, picture: &Path, (width, height): (usize, usize)) {
    let profile = tempfile::tempdir().unwrap();
    let output = headless(browser().unwrap(), profile.path())
        .args(["--force-device-scale-factor=2", "--hide-scrollbars"])
        .arg(format!("--window-size={width},{height}"))
        .arg(format!("--screenshot={}", picture.display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(picture.exists(), "no picture: {said}");
}

/// What a browser does with pages: `script` calls `done` with what it has seen in one, a list of texts. Gives for each page
/// what was said on the console, and that; nothing where there is no browser, unless `DALEMBERT_BROWSER=required`, as in
/// `.ci/run`. A single page is opened as a file, several are frames of one, since a browser takes long to start.
pub fn in_browser(home: &Path, pages: &[String], script: &str) -> Option<Vec<Vec<String>>> {
    let browser = browser()?;
    let act = format!("<script>setTimeout(() => {{ {script} }}, 200)</script></body>");
    let acting = |page: &String, seen: &str| {
        let listen = format!("<script>window.seen = {seen};</script>{LISTEN}");
        let page = page.replacen("</head>", &listen, 1);
        let (before, _) = page.rsplit_once("</body>").unwrap();
        format!("{before}{act}</html>")
    };
    let told = "document.body.innerHTML = ''; document.body.textContent = 'seen:' + JSON.stringify(all) + ':seen';";
    let file = home.join("seen.html");
    let text = match pages {
        [page] => acting(page, &format!("(seen) => {{ const all = [seen]; {told} }}")),
        _ => {
            let frames = pages.iter().enumerate();
            let frames =
                frames.map(|(i, page)| acting(page, &format!("(seen) => parent.seen({i}, seen)")));
            let frames = serde_json::to_string(&frames.collect::<Vec<_>>()).unwrap();
            let frames = frames.replace('<', "\\u003c");
            format!(
                "<!DOCTYPE html><meta charset=\"utf-8\"><body><script>const frames = {frames}, all = [];
                window.seen = (i, seen) => {{
                    all[i] = seen;
                    if (all.filter(Boolean).length === frames.length) {{ {told} }}
                }};
                for (const text of frames) {{
                    const frame = document.createElement('iframe');
                    frame.style = 'width: 1200px; height: 1000px';
                    frame.srcdoc = text;
                    document.body.append(frame);
                }}
                </script></body>"
            )
        }
    };
    fs::write(&file, text).unwrap();
    let profile = tempfile::tempdir().unwrap();
    let output = headless(browser, profile.path())
        .arg("--window-size=1200,1000")
        .args(["--virtual-time-budget=20000", "--dump-dom"])
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout);
    let (_, rest) = dom.rsplit_once("seen:[").unwrap_or_else(|| {
        panic!(
            "a page never ended its script: {}",
            String::from_utf8_lossy(&output.stderr)
        )
    });
    let (seen, _) = rest.split_once(":seen").unwrap();
    let seen = seen
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&");
    Some(serde_json::from_str(&format!("[{seen}")).unwrap())
}
