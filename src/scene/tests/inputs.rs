//! Inputs that are wrong: sines, and tables from files and inside a scene.

use super::errors::{expect, tank};
use super::*;

fn with_table(options: &str, table: Option<&[u8]>) -> SceneError {
    let scene = format!(
        r#"{{ "model": "belt_oscillator", "end": 1,
  "inputs": {{ "force": {{ "table": {{ "file": "f.csv"{options} }} }} }} }}"#
    );
    let tables: Vec<(&str, &[u8])> = table.map(|bytes| ("f.csv", bytes)).into_iter().collect();
    only_error(parse_with(scene.as_bytes(), &[], &tables))
}

#[test]
fn tables() {
    let file = |error: &SceneError| error.position().unwrap().file;
    let missing = with_table("", None);
    let message = "cannot read `scenes/f.csv`: entity not found";
    expect(&missing, message, "2:45", "relative to the folder");
    assert_eq!(file(&missing), "scenes/test.json");

    let unsorted = with_table("", Some(b"t,F\n0,1\n\n0.2,1\n  0.1 ,1\n"));
    let message = "time 0.1 does not come after 0.2, the time of the row before";
    expect(&unsorted, message, "5:3", "sort");
    assert_eq!(file(&unsorted), "scenes/f.csv");

    let few = "a table needs at least 2 rows, this one has";
    expect(
        &with_table("", Some(b"")),
        &format!("{few} 0"),
        "1:1",
        "each row",
    );
    expect(
        &with_table("", Some(b"t,F\n")),
        &format!("{few} 0"),
        "1:4",
        "each row",
    );
    expect(
        &with_table("", Some(b"0,1\n")),
        &format!("{few} 1"),
        "1:4",
        "each row",
    );
    expect(
        &with_table("", Some(b"0,1\n1,2,3\n")),
        "expected two columns, found 3",
        "2:1",
        "comma",
    );
    expect(
        &with_table("", Some(b"0;1\n1;2\n")),
        "expected two columns, found 1",
        "2:1",
        "comma",
    );
    expect(
        &with_table("", Some(b"0,1\n1,x\n")),
        "`x` is not a number",
        "2:3",
        "two finite",
    );
    expect(
        &with_table("", Some(b"0,1\n# note\n1,inf\n")),
        "`inf` is not a finite number",
        "3:3",
        "two finite",
    );
    expect(
        &with_table("", Some(b"0,1\nnan,1\n")),
        "`nan` is not a finite number",
        "2:1",
        "two finite",
    );
    expect(
        &with_table("", Some(b"0,1\n1,\xff\n")),
        "the text is not UTF-8",
        "2:3",
        "UTF-8",
    );
    let scaled = with_table(r#", "scale": 1e10"#, Some(b"0,1\n1,1e300\n"));
    expect(&scaled, "times and values must be finite", "2:3", "scale");
    let last = with_table(r#", "interpolation": "previous""#, Some(b"0,1\n1,2\n"));
    expect(
        &last,
        "the last value, 2, would hold for no time",
        "2:3",
        "hold",
    );
    let steep = with_table("", Some(b"0,1\n1,2\n1.0000000000000002,1e300\n"));
    expect(
        &steep,
        "the table is too steep here for double precision",
        "2:1",
        "close",
    );
}

#[test]
fn knots() {
    let sine = r#""sine": { "amplitude": 20, "frequency": 7 }"#;
    let message = "time 0.5 does not come after 1, the time of the row before";
    expect(
        &tank(sine, r#""knots": [[0, 0], [1, 0], ["500 ms", 0]]"#),
        message,
        "4:67",
        "sort",
    );
    expect(
        &tank(sine, r#""knots": []"#),
        "a table needs at least 2 rows, this one has 0",
        "4:49",
        "each row",
    );
    expect(
        &tank(sine, r#""knots": [[0, 0], [1]]"#),
        "expected a list [time, value], found a list of 1",
        "4:58",
        "",
    );
    expect(
        &tank(sine, r#""knots": [[0, 0], [1, "3 m"]]"#),
        "unit `m` does not fit, expected `m/s^2`",
        "4:62",
        "plain number",
    );
}

#[test]
fn sines() {
    let sine = "\"frequency\": 7 }";
    expect(
        &tank(sine, "\"phase\": 0 }"),
        "frequency or angular_frequency missing",
        "4:48",
        "add `frequency` or",
    );
    expect(
        &tank(sine, "\"frequency\": 7, \"angular_frequency\": 44 }"),
        "`frequency` and `angular_frequency` exclude each other",
        "4:83",
        "keep one",
    );
    expect(
        &tank(sine, "\"frequency\": 7, \"end\": 1, \"start\": 1.5 }"),
        "1 is not admissible here: it must be > 1.5 s, its start",
        "4:90",
        "",
    );
    expect(
        &tank("\"frequency\": 7", "\"frequency\": 0"),
        "0 is not admissible here: it must be > 0 Hz",
        "4:80",
        "",
    );
    expect(
        &tank("\"frequency\": 7", "\"frequency\": 1e-300"),
        "1e-300 is not admissible here: it must be such that its derivative and its antiderivatives are finite",
        "4:80",
        "",
    );
    expect(
        &tank("\"sine\": {", "\"cosine\": {"),
        "unknown kind of input `cosine`",
        "4:40",
        "did you mean `sine`?",
    );
    expect(
        &tank(sine, "\"frequency\": 7 }, \"constant\": 1"),
        "`sine` and `constant` exclude each other",
        "4:85",
        "`sum`",
    );
    expect(
        &tank("\"ground_acceleration\"", "\"ground_motion\""),
        "unknown input `ground_motion`",
        "4:15",
        "`ground_acceleration`",
    );
}
