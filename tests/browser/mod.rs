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

/// What a browser does with pages: `script` calls `done` with what it has seen in one, a list of texts. Gives for each page
/// what was said on the console, and that; nothing where there is no browser, unless `DALEMBERT_BROWSER=required`, as in
/// `.ci/run`. A single page is opened as a file, several are frames of one, since a browser takes long to start.
pub fn in_browser(home: &Path, pages: &[String], script: &str) -> Option<Vec<Vec<String>>> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let is_there = |name: &&&str| {
        let found = Command::new(name).arg("--version").output();
        found.is_ok_and(|output| output.status.success())
    };
    let Some(browser) = names.iter().find(is_there) else {
        assert!(
            std::env::var_os("DALEMBERT_BROWSER").is_none(),
            "no Chromium on this machine"
        );
        eprintln!("left out: no Chromium on this machine");
        return None;
    };
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
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
        ])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
        ])
        .args([
            "--disable-sync",
            "--disable-quic",
            "--window-size=1200,1000",
        ])
        .args(["--virtual-time-budget=20000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
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
