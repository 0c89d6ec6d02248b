//! `--html`: pages are whole, safe, and work in a browser, where there is one.

use super::browser::in_browser;
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
        in_browser(home.path(), &[page], "done([])");
    }
}

/// The page of a command, seen by a browser.
fn seen_page(home: &Path, arguments: &[&str], script: &str) -> Option<Vec<String>> {
    ends_with(0, home, &[arguments, &["--html", "page.html"]].concat());
    let page = fs::read_to_string(home.join("page.html")).unwrap();
    let beside = page.len() - data(&page).to_string().len();
    assert!(beside < 200_000, "{beside} bytes beside the data");
    in_browser(home, &[page], script)?.pop()
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
    let scenes = names(&project().join("scenes"));
    let scenes: Vec<&str> = scenes
        .iter()
        .filter_map(|name| name.strip_suffix(".json"))
        .collect();
    let pages: Vec<String> = scenes
        .iter()
        .map(|name| page(0, home.path(), &scene(name), &[]))
        .collect();
    let script = "
        const { show, plots, motion, picture, zoomGroup } = dalembert, [first, last] = motion.span;
        const at = (t) => { show(t); return picture.toDataURL(); };
        const frames = new Set([0.11, 0.31, 0.57].map((part) => at(first + part * (last - first))));
        const timed = plots.filter((plot) => plot.spec.time);
        const before = timed.map((plot) => plot.u.scales.x.max);
        zoomGroup(timed[0], [first, first + 0.25 * (last - first)], null);
        setTimeout(() => {
            const moved = timed.every((plot, i) => plot.u.scales.x.max < before[i]);
            const loaded = performance.getEntriesByType('resource').map((entry) => entry.name);
            done([`frames ${frames.size > 1}`, `zoom ${moved}`, `plots ${timed.length > 0}`, ...loaded]);
        }, 200);";
    let Some(seen) = in_browser(home.path(), &pages, script) else {
        return;
    };
    for (name, seen) in scenes.iter().zip(seen) {
        assert_eq!(seen, ["frames true", "zoom true", "plots true"], "{name}");
    }
}

#[test]
fn a_page_is_used_by_keys_in_the_dark_and_on_paper() {
    let home = tempfile::tempdir().unwrap();
    let page = page(0, home.path(), &scene("rocking_block"), &["--set", "end=1"]);
    let script = "
        const { plots, motion, picture } = dalembert, byId = (id) => document.getElementById(id), seen = [];
        const press = (key) => document.body.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
        const time = () => Number(byId('time').value), is = (what, holds) => seen.push(`${what} ${holds}`);
        press('ArrowRight'); is('step', time() > 0);
        press('End'); is('end', time() === 1);
        press('Home'); is('home', time() === 0);
        const slow = byId('speed').value; press('+'); is('speed', Number(byId('speed').value) > Number(slow));
        press(' '); is('play', byId('play').textContent === 'pause'); press(' ');
        press('Home');
        const plain = picture.toDataURL(); press('c');
        is('contacts', picture.toDataURL() !== plain && byId('forces').textContent.includes('edge.2.force'));
        const states = motion.drawing.shapes.filter((shape) => shape.of || shape.states);
        is('states', states.length > 0);
        const paper = () => getComputedStyle(document.body).backgroundColor;
        const light = paper(), ink = () => getComputedStyle(document.body).color, dark_on = light === 'rgb(255, 255, 255)';
        document.querySelector('#tools button').click();
        is('dark', dark_on && paper() !== light); is('ink', ink() !== 'rgb(27, 27, 27)');
        dispatchEvent(new Event('beforeprint')); is('paper', paper() === light);
        is('fits', plots.every((plot) => plot.u.width <= 700));
        dispatchEvent(new Event('afterprint')); is('dark again', paper() !== light);
        const printed = [...document.styleSheets].flatMap((sheet) => [...sheet.cssRules]).filter((rule) => rule.media?.mediaText === 'print');
        is('print', printed.some((rule) => rule.cssText.includes('.bar')));
        const whole = plots[0].u.scales.x.max; press('i');
        setTimeout(() => {
            is('zoom in', plots[0].u.scales.x.max < whole); press('0');
            setTimeout(() => { is('whole', plots[0].u.scales.x.max === whole); done(seen); }, 100);
        }, 100);";
    if let Some(seen) = in_browser(home.path(), &[page], script) {
        assert!(
            seen[0].iter().all(|line| line.ends_with(" true")),
            "{seen:#?}"
        );
        assert_eq!(seen[0].len(), 15, "{seen:#?}");
    }
}

#[test]
fn a_deep_zoom_shows_the_motion_its_points_and_the_names_of_transitions() {
    let home = tempfile::tempdir().unwrap();
    let pendulum = scene("forced_pendulum");
    let coarse = page(0, home.path(), &pendulum, &["--set", "end=2"]);
    // Rows between those of the page.
    let fine = ["--set", "end=2", "--set", "record.every=0.0007"];
    ends_with(
        0,
        home.path(),
        &[&["run", &pendulum, "--out", "fine"][..], &fine].concat(),
    );
    let mut rows = csv::Reader::from_path(home.path().join("fine/trajectory.csv")).unwrap();
    let rows: Vec<[f64; 3]> = rows
        .deserialize::<std::collections::HashMap<String, String>>()
        .map(|row| {
            let row = row.unwrap();
            ["t", "theta", "theta.rate"].map(|name| row[name].parse().unwrap())
        })
        .collect();
    let rows = serde_json::to_string(&rows).unwrap();
    let script = format!(
        "const rows = {rows}, {{ plots }} = dalembert, seen = [];
        for (const k of [0, 1]) {{
            const {{ x, y }} = plots[k].curves[0], errors = [0, 0];
            let i = 0;
            for (const [t, ...values] of rows) {{
                while (i + 2 < x.length && x[i + 1] <= t) i++;
                const line = y[i] + (y[i + 1] - y[i]) * (t - x[i]) / (x[i + 1] - x[i]);
                [plots[k].valueAt(0, t), line].forEach((value, of) => errors[of] = Math.max(errors[of], Math.abs(value - values[k])));
            }}
            seen.push(...errors.map(String));
        }}
        done(seen);"
    );
    let knock = page(0, home.path(), &scene("bouncing_ball"), &["--set", "end=1"]);
    let tags = "
        const { plots, motion, zoomGroup } = dalembert, [plot] = plots, [t, name] = motion.events[0];
        zoomGroup(plot, [t - 1e-3, t + 1e-3], null);
        setTimeout(() => {
            const over = plot.u.over, box = over.getBoundingClientRect(), clientX = box.left + plot.u.valToPos(t, 'x') + 2;
            over.dispatchEvent(new MouseEvent('mousemove', { clientX, clientY: box.top + 30, bubbles: true }));
            setTimeout(() => done([`tag ${!plot.tag.hidden && plot.tag.textContent.startsWith(name + ', t = ')}`]), 100);
        }, 200);";
    let Some(seen) = in_browser(home.path(), &[coarse], &script) else {
        return;
    };
    let [theta, line, rate, rate_line] = [0, 1, 2, 3].map(|i| seen[0][i].parse::<f64>().unwrap());
    // Cubics are wrong by h^4/384 of the fourth derivative, their derivatives by h^3/(72 √3) of it; lines are by h^2/8 of the second
    // and third. θ'' = −g sin θ + M with g = 4.84/s², M = sin(3π t)/s², θ'² < 5.4/s², so that
    // |θ''''| ≤ g √(θ''² + θ'⁴) + (3π)² 1/s² < 4.84 √(5.84² + 5.4²) + 88.9 = 128 rad/s⁴.
    let (h, fourth) = (0.01_f64, 128.0);
    assert!(theta < h.powi(4) / 384.0 * fourth, "{theta:e}");
    assert!(
        rate < h.powi(3) / (72.0 * 3_f64.sqrt()) * fourth,
        "{rate:e}"
    );
    assert!(line > 1e-5 && rate_line > 1e-5, "{line:e} {rate_line:e}");
    let seen = in_browser(home.path(), &[knock], tags).unwrap();
    assert_eq!(seen[0], ["tag true"]);
}

#[test]
fn forces_at_declared_contacts_are_those_of_the_ground() {
    let home = tempfile::tempdir().unwrap();
    let page = page(0, home.path(), &scene("rigid_block"), &["--set", "end=1.5"]);
    let script = "
        const { show, plots, motion, contacts } = dalembert, seen = new Set();
        document.getElementById('with-forces').click();
        const forces = plots.find(({ curves }) => curves.some(({ name }) => name === 'reaction.y_g'));
        const along = ['reaction.x_g', 'reaction.y_g'].map((name) => forces.curves.findIndex((curve) => curve.name === name));
        let worst = 0;
        for (const t of forces.curves[0].x) {
            show(t);
            const told = contacts();
            told.forEach(({ name, state }) => seen.add(`${name} ${state}`));
            along.forEach((i, axis) => {
                const sum = told.reduce((sum, { force }) => sum + force[axis], 0);
                worst = Math.max(worst, Math.abs(sum - forces.valueAt(i, t)));
            });
        }
        const told = document.getElementById('forces').textContent;
        done([`worst ${worst < 1e-10}`, `listed ${told.includes('left.normal') && told.includes('right.friction')}`, ...[...seen].sort()]);";
    if let Some(seen) = in_browser(home.path(), &[page], script) {
        let expected = [
            "worst true",
            "listed true",
            "left open",
            "left sticks",
            "right open",
            "right sticks",
        ];
        assert_eq!(seen[0], expected);
    }
}

#[test]
fn arguments_about_plots_are_refused_where_there_are_none() {
    let home = tempfile::tempdir().unwrap();
    let ball = scene("bouncing_ball");
    let tank = scene("tank_free_release");
    for arguments in [
        ["run", &ball, "--plot-window", "0:1"],
        ["run", &ball, "--plot-panels", "h"],
        ["run", &ball, "--plot-format", "svg"],
        ["compare", &tank, "--plot-window", "0:1"],
        ["precision", &ball, "--plot-size", "800x600"],
    ] {
        let output = ends_with(2, home.path(), &arguments);
        assert!(stderr(&output).contains("add --out DIR"), "{arguments:?}");
    }
}

#[test]
fn the_report_has_the_reader_s_units() {
    let home = tempfile::tempdir().unwrap();
    let ball = scene("bouncing_ball");
    let report = |units: &[&str]| {
        let arguments = [&["run", &ball, "--set", "end=0.2"], units].concat();
        stdout(&ends_with(0, home.path(), &arguments)).to_owned()
    };
    let line = |report: &str| {
        let line = report.lines().find(|line| line.starts_with("h "));
        line.unwrap()
            .split_whitespace()
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let (plain, shown) = (report(&[]), report(&["--units", "mm,ms,kJ"]));
    assert!(
        shown.contains("reached t = 200 ms") && shown.contains("energy / kJ"),
        "{shown}"
    );
    let (plain, shown) = (line(&plain), line(&shown));
    assert_eq!([&plain[1], &shown[1]], ["m", "mm"]);
    for column in 2..7 {
        let [a, b]: [f64; 2] = [&plain[column], &shown[column]].map(|x| x.parse().unwrap());
        assert!((1000.0 * a - b).abs() <= 1e-5 * b.abs(), "{a} {b}");
    }
}
