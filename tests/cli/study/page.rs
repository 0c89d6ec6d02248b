//! The page of a study: its commands give its numbers, and it works in a browser, where there is one.

use std::fs;

use serde_json::{Value, json};

use super::super::browser::in_browser;
use super::super::page::data;
use super::super::{dalembert, json as read_json, names, stdout};
use super::{folder, run, write};

/// An analysis with a fan, a fragility, points, and a title that is no markup.
fn analysis() -> Value {
    json!({
        "title": "</script><script>alert(1)</script>",
        "scene": "scene.json",
        "random": { "variables": { "parameters.alpha": { "uniform": { "from": 0.2, "to": 0.3 } } }, "count": 6 },
        "ida": { "intensity": "initial.theta", "first": 0.02, "step": 0.04, "runs": 8, "resolution": 0.05 },
        "failure": { "measure": "peak.theta", "above": 0.1 },
        "measure": ["peak.theta", "end.theta"]
    })
}

fn page_of_analysis(folder: &std::path::Path) -> String {
    let scene = json!({
        "model": "rocking_block",
        "initial": { "theta": 0.1, "side": 1, "mode": "base open" },
        "end": 0.3
    });
    write(folder, "scene.json", &scene);
    write(folder, "study.json", &analysis());
    run(folder);
    fs::read_to_string(folder.join("out/study.html")).unwrap()
}

#[test]
fn the_command_of_a_point_makes_its_run() {
    let folder = folder();
    let page = page_of_analysis(folder.path());
    let rows = super::table(&folder.path().join("out/runs.csv"));
    let data = data(&page);
    let commands = data["matrix"]["commands"].as_array().unwrap();
    assert_eq!(commands.len(), rows.len());
    for i in [0, 17, rows.len() - 1] {
        let command = commands[i].as_str().unwrap();
        let words: Vec<&str> = command.split(' ').skip(1).collect();
        let output = dalembert(folder.path())
            .args(&words)
            .args(["--out", "again"])
            .assert()
            .success();
        assert!(!stdout(output.get_output()).is_empty());
        let summary = read_json(&folder.path().join("again/summary.json"));
        let peak = summary["peaks"]["theta"]["max"].as_f64();
        assert_eq!(rows[i]["peak.theta"].parse().ok(), peak, "{command}");
        fs::remove_dir_all(folder.path().join("again")).unwrap();
    }
}

#[test]
fn pictures_and_page_of_an_analysis_are_whole_and_escaped() {
    let folder = folder();
    let page = page_of_analysis(folder.path());
    assert!(!page.contains("<script>alert"), "the title is markup");
    for link in ["http:", "src=", "href=", "url(", "@import"] {
        assert!(!page.contains(link), "{link} stands in the page");
    }
    let files = names(&folder.path().join("out"));
    for file in ["fragility.svg", "ida.svg", "capacities.svg", "runs.svg"] {
        assert!(files.iter().any(|name| name == file), "{files:?}");
        let svg = fs::read_to_string(folder.path().join("out").join(file)).unwrap();
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
            "{file}"
        );
        assert!(!svg.contains("<script"), "{file}");
    }
}

#[test]
fn the_page_works_in_a_browser() {
    let folder = folder();
    let page = page_of_analysis(folder.path());
    let script = "
        const { plots, matrix, setTheme } = dalembert, seen = [];
        const fan = plots.find((plot) => plot.curves.some((curve) => curve.style === 'background'));
        seen.push(`plots ${plots.length}`, `fan ${fan.curves.map((curve) => curve.name).join(' ')}`);
        const [cell] = matrix.cells(), box = cell.canvas.getBoundingClientRect();
        const send = (kind, [x, y]) => cell.canvas.dispatchEvent(
            new PointerEvent(kind, { clientX: box.left + x, clientY: box.top + y, bubbles: true }));
        const [x, y] = matrix.pointOf(cell, 3);
        send('pointerdown', [x, y]); send('pointerup', [x, y]);
        const command = document.getElementById('command');
        seen.push(`command ${!command.hidden && command.textContent.startsWith('dalembert run scene.json --set')}`);
        send('pointerdown', [x - 5, y - 5]); send('pointermove', [x + 5, y + 5]); send('pointerup', [x + 5, y + 5]);
        seen.push(`marked ${matrix.marked().has(3) && matrix.marked().size < 40}`);
        const light = cell.canvas.toDataURL();
        setTheme('dark');
        seen.push(`dark ${cell.canvas.toDataURL() !== light}`);
        document.querySelector('#columns input:not(:checked)').click();
        seen.push(`cells ${matrix.cells().length}`);
        done(seen);";
    if let Some(seen) = in_browser(folder.path(), &[page], script) {
        let expected = [
            "plots 3",
            "fan cases 16 % 50 % 84 %",
            "command true",
            "marked true",
            "dark true",
            "cells 10",
        ];
        assert_eq!(seen[0], expected);
    }
}
