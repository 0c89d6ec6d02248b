//! `--html`: pages are whole, safe, and work in a browser, where there is one.

use super::*;

/// The page of a run with these further arguments.
fn page(status: i32, home: &Path, scene: &str, more: &[&str]) -> String {
    let arguments = [&["run", scene, "--html", "page.html"], more].concat();
    ends_with(status, home, &arguments);
    fs::read_to_string(home.join("page.html")).unwrap()
}

/// The data of a page.
pub fn data(page: &str) -> serde_json::Value {
    let start = "<script type=\"application/json\" id=\"data\">";
    let (_, rest) = page.split_once(start).expect("the page has data");
    let (data, _) = rest.split_once("</script>").expect("the data end");
    serde_json::from_str(data).expect("the data are JSON")
}

#[test]
fn a_page_is_one_file_without_links() {
    let home = tempfile::tempdir().unwrap();
    let page = page(0, home.path(), &scene("tank_rocks_and_slides"), &[]);
    for link in ["http:", "https:", "src=", "href=", "url(", "@import"] {
        // The licence of the plots names its author's address in a comment.
        let found = page.matches(link).count();
        let allowed = usize::from(link == "https:");
        assert!(found <= allowed, "{link} stands in the page {found} times");
    }
    let beside = page.len() - data(&page).to_string().len();
    assert!(beside < 200_000, "{beside} bytes beside the data");
    for part in [
        "Extremes",
        "Energies",
        "\"ground_acceleration\"",
        "--html page.html",
    ] {
        let escaped = part.replace('"', "&quot;");
        assert!(page.contains(&escaped), "{part}");
    }
}

#[test]
fn what_comes_from_a_scene_is_no_markup() {
    let home = tempfile::tempdir().unwrap();
    let title = "</script><script>alert(1)</script><b>&\"";
    let text = serde_json::json!({ "model": "bouncing_ball", "title": title, "end": 0.1 });
    fs::write(home.path().join("scene.json"), text.to_string()).unwrap();
    let page = page(0, home.path(), "scene.json", &[]);
    assert!(!page.contains("<script>alert") && !page.contains("<b>"));
    assert!(page.contains("<h1>&lt;/script&gt;&lt;script&gt;alert(1)"));
}

#[test]
fn extremes_of_long_runs_are_kept() {
    let home = tempfile::tempdir().unwrap();
    let more = ["--set", "record.every=1e-5", "--set", "end=1"];
    let page = page(0, home.path(), &scene("bouncing_ball"), &more);
    assert!(page.len() < 6_000_000, "{} bytes", page.len());
    let data = data(&page);
    let heights: Vec<f64> = data["plots"][0]["curves"][0]["y"]
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect();
    assert!(heights.len() > 5_000 && heights.len() < 25_000);
    let most = heights.iter().copied().fold(f64::MIN, f64::max);
    assert_eq!(most, 1.0);
}

#[test]
fn runs_that_cannot_be_drawn_have_a_page_that_says_so() {
    let home = tempfile::tempdir().unwrap();
    for (sets, words) in [
        (["end=1e-9", "initial.h=1"], "Reached t = 1e"),
        (["initial.h=1e-300", "end=1e-160"], "Reached t = "),
        (["initial.h.rate=1e153", "end=1e150"], "not drawn: h, "),
    ] {
        let more = ["--set", sets[0], "--set", sets[1], "--set", "record={}"];
        let page = page(0, home.path(), &scene("bouncing_ball"), &more);
        assert!(page.contains(words), "{sets:?}");
        in_browser(home.path(), &page, "done([])");
    }
}

/// What a browser does with a page: `script` calls `done` with what it has seen, a list of texts. Gives that and what
/// was said on the console; nothing where there is no browser, unless `DALEMBERT_BROWSER=required`, as in `.ci/run`.
pub fn in_browser(home: &Path, page: &str, script: &str) -> Option<Vec<String>> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let browser = names.iter().find(|name| {
        let found = std::process::Command::new(name).arg("--version").output();
        found.is_ok_and(|output| output.status.success())
    });
    let Some(browser) = browser else {
        assert!(
            std::env::var_os("DALEMBERT_BROWSER").is_none(),
            "no Chromium on this machine"
        );
        eprintln!("left out: no Chromium on this machine");
        return None;
    };
    let listen = "<script>window.said = [];
        window.onerror = (e) => said.push('error: ' + e);
        for (const kind of ['error', 'warn', 'log']) console[kind] = (...x) => said.push(kind + ': ' + x.join(' '));
        window.done = (seen) => { document.body.innerHTML = '';
            document.body.textContent = 'seen:' + JSON.stringify([...said, ...seen]) + ':seen'; };
        </script></head>";
    let act = format!("<script>setTimeout(() => {{ {script} }}, 200)</script></body>");
    let page = page.replacen("</head>", listen, 1);
    let (before, _) = page.rsplit_once("</body>").unwrap();
    let file = home.join("seen.html");
    fs::write(&file, format!("{before}{act}</html>")).unwrap();
    let profile = tempfile::tempdir().unwrap();
    let output = std::process::Command::new(browser)
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
        .args(["--virtual-time-budget=3000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout);
    let (_, rest) = dom.rsplit_once("seen:[").unwrap_or_else(|| {
        panic!(
            "the page never ended its script: {}",
            String::from_utf8_lossy(&output.stderr)
        )
    });
    let (seen, _) = rest.split_once(":seen").unwrap();
    let seen = seen
        .replace("&amp;", "&")
        .replace("&lt;", "<")
        .replace("&gt;", ">");
    Some(serde_json::from_str(&format!("[{seen}")).unwrap())
}

/// The page of a command, seen by a browser.
fn seen_page(home: &Path, arguments: &[&str], script: &str) -> Option<Vec<String>> {
    ends_with(0, home, &[arguments, &["--html", "page.html"]].concat());
    let page = fs::read_to_string(home.join("page.html")).unwrap();
    assert!(page.len() < 1_000_000, "{} bytes", page.len());
    in_browser(home, &page, script)
}

#[test]
fn pages_of_comparisons_zoom_together_and_show_the_reader_s_units() {
    let home = tempfile::tempdir().unwrap();
    let of = scene("tank_free_release");
    let arguments = [
        "compare", &of, "--vary", "landing", "--set", "end=0.3", "--units", "mm,ms",
    ];
    let script = "
        const { plots, zoomGroup } = dalembert;
        const before = plots.map((plot) => plot.u.scales.x.max);
        zoomGroup(plots[0], [0, 0.1], null);
        setTimeout(() => {
            const axes = plots.every((plot, i) => before[i] === 300 && plot.u.scales.x.max === 100);
            const units = [...document.querySelectorAll('.unit')].map((unit) => unit.textContent);
            done([`axes ${axes}`, `mm ${units.some((text) => text.includes('(mm)'))}`]);
        }, 200);";
    if let Some(seen) = seen_page(home.path(), &arguments, script) {
        assert_eq!(seen, ["axes true", "mm true"]);
    }
}

#[test]
fn pages_of_studies_of_precision_read_points_out() {
    let home = tempfile::tempdir().unwrap();
    let of = scene("bouncing_ball");
    let arguments = ["precision", &of, "--set", "end=0.7"];
    let script = "
        const [plot] = dalembert.plots, over = plot.u.over, box = over.getBoundingClientRect();
        const { x, y } = plot.curves[0];
        const at = (axis, v) => plot.pixel(axis, v) / devicePixelRatio;
        const [left, top] = [at('x', x[0]) - plot.u.bbox.left / devicePixelRatio, at('y', y[0]) - plot.u.bbox.top / devicePixelRatio];
        over.dispatchEvent(new MouseEvent('mousemove', { clientX: box.left + left, clientY: box.top + top, bubbles: true }));
        setTimeout(() => done([`read ${document.querySelector('.key output').textContent.includes(' at ')}`]), 200);";
    if let Some(seen) = seen_page(home.path(), &arguments, script) {
        assert_eq!(seen, ["read true"]);
    }
}

#[test]
fn pages_work_in_a_browser() {
    let home = tempfile::tempdir().unwrap();
    for name in names(&project().join("scenes")) {
        let Some(name) = name.strip_suffix(".json") else {
            continue;
        };
        let page = page(0, home.path(), &scene(name), &[]);
        let script = "
            const { show, plots, motion, picture, zoomGroup } = dalembert, [first, last] = motion.span;
            const at = (t) => { show(t); return picture.toDataURL(); };
            const frames = new Set([0.11, 0.31, 0.57].map((part) => at(first + part * (last - first))));
            const timed = plots.filter((plot) => plot.spec.time);
            const before = timed.map((plot) => plot.u.scales.x.max);
            zoomGroup(timed[0], [first, first + 0.25 * (last - first)], null);
            setTimeout(() => {
                const moved = timed.every((plot, i) => plot.u.scales.x.max < before[i]);
                done([`frames ${frames.size > 1}`, `zoom ${moved}`, `plots ${timed.length > 0}`]);
            }, 200);";
        let Some(seen) = in_browser(home.path(), &page, script) else {
            return;
        };
        assert_eq!(seen, ["frames true", "zoom true", "plots true"], "{name}");
    }
}
