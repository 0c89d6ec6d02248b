//! `compare`.

use super::*;

#[test]
fn variants_come_side_by_side_in_a_table_and_plots() {
    let home = tempfile::tempdir().unwrap();
    let scene = scene("tank_free_release");
    let vary = ["--vary", "rules", "--vary", "landing"];
    let compare = [&["compare", &scene, "--out", "out"][..], &vary].concat();
    let output = ends_with(0, home.path(), &compare);
    let text = stdout(&output);
    let row = |name: &str| -> Vec<&str> {
        let line = text.lines().find(|line| line.starts_with(name));
        line.unwrap_or_else(|| panic!("no `{name}`"))
            .split_whitespace()
            .collect()
    };
    assert_eq!(row("rules").len(), 1 + 5);
    assert!(text.contains("reached end"));
    let out = home.path().join("out");
    // `y` moves in one of them, by contacts.
    for file in ["comparison.csv", "theta.svg", "x_I.svg", "x.svg", "y.svg"] {
        assert!(out.join(file).is_file(), "{file}");
    }

    // The numbers are those of the single runs.
    let mut csv = csv::Reader::from_path(out.join("comparison.csv")).unwrap();
    let heads = csv.headers().unwrap().clone();
    let column = |name: &str| heads.iter().position(|head| head == name).unwrap();
    let rows: Vec<_> = csv.records().map(Result::unwrap).collect();
    let options: Vec<_> = rows
        .iter()
        .map(|row| (row[0].to_owned(), row[1].to_owned()))
        .collect();
    for (rules, landing) in [("reactions", "momenta"), ("paper", "velocities")] {
        let i = options
            .iter()
            .position(|(r, l)| r == rules && l == landing)
            .unwrap();
        let [rules, landing] = [format!("rules={rules}"), format!("landing={landing}")];
        let single = [
            "run", &scene, "--set", &rules, "--set", &landing, "--out", "single",
        ];
        ends_with(0, home.path(), &single);
        let summary = json(&home.path().join("single/summary.json"));
        let number = |name: &str| rows[i][column(name)].parse::<f64>().unwrap();
        assert_eq!(Some(number("x end [m]")), summary["end"]["q"]["x"].as_f64());
        assert_eq!(
            Some(number("theta max [rad]")),
            summary["peaks"]["theta"]["max"].as_f64()
        );
        let landings = &summary["events"]["by_transition"]["landing"];
        assert_eq!(Some(number("landing count")), landings.as_f64());
    }
}

#[test]
fn a_refused_variant_says_why_and_the_others_run() {
    // Only the choices of the energies' equations offer the reaction rules.
    let home = tempfile::tempdir().unwrap();
    let scene = scene("tank_free_release");
    let compare = [
        "compare",
        &scene,
        "--set",
        "rules=reactions",
        "--vary",
        "equations",
    ];
    let output = ends_with(0, home.path(), &compare);
    let text = stdout(&output);
    assert!(text.contains("printed, refused:"), "{text}");
    assert!(text.contains("the model does not offer"), "{text}");
    assert!(text.contains("reached end"));
    assert!(names(home.path()).is_empty());
}

#[test]
fn wrong_requests_are_refused() {
    let tank = scene("tank_free_release");
    let output = ends_with(2, &project(), &["compare", &tank, "--vary", "rule"]);
    assert!(stderr(&output).contains("unknown choice `rule`: did you mean `rules`?"));
    let output = ends_with(2, &project(), &["compare", &scene("bouncing_ball")]);
    assert!(stderr(&output).contains("the model `bouncing_ball` has no choices"));
    let output = ends_with(2, &project(), &["compare", &tank, "--set", "end=-1"]);
    assert!(stderr(&output).contains("--set:1:5"));
}
