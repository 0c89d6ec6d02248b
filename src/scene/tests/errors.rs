//! What is wrong, where, and what would be right.

use super::*;

/// Replaces `old` by `new` in a scene that is right, and gives the only error there is.
pub(super) fn tank(old: &str, new: &str) -> SceneError {
    const RIGHT: &str = r#"{
  "model": "walking_tank",
  "parameters": { "mu_s": 0.3, "M_S": 7.5 },
  "inputs": { "ground_acceleration": { "sine": { "amplitude": 20, "frequency": 7 } } },
  "initial": { "theta": 0.02, "side": 1 },
  "freeze": ["x"],
  "end": 2,
  "accuracy": { "relative": 1e-8 },
  "record": { "every": 0.001 }
}
"#;
    assert!(RIGHT.contains(old));
    parse(RIGHT).unwrap();
    only_error(parse(&RIGHT.replacen(old, new, 1)))
}

/// Checks message, `line:column`, and a part of the help.
#[track_caller]
pub(super) fn expect(error: &SceneError, message: &str, at: &str, help: &str) {
    let position = error.position().unwrap();
    let place = format!("{}:{}", position.line, position.column);
    assert_eq!(
        (error.kind().to_string().as_str(), place.as_str()),
        (message, at),
        "{error}"
    );
    let given = error.suggestion().unwrap_or("");
    assert!(
        given.contains(help) && given.is_empty() == help.is_empty(),
        "{error}"
    );
}

#[test]
fn an_error_shows_the_line_with_a_caret_and_what_would_be_right() {
    assert_eq!(
        tank(r#""end": 2,"#, r#""end": 2, "rules": "papers","#).to_string(),
        "error: unknown choice `papers`
 --> scenes/test.json:7:22
  |
7 |   \"end\": 2, \"rules\": \"papers\",
  |                      ^^^^^^^^
  |
  = help: did you mean `paper`? known: `reactions` or `paper`"
    );
}

#[test]
fn malformed_json() {
    let missing_comma = tank("\"end\": 2,", "\"end\": 2");
    expect(&missing_comma, "not JSON: expected a comma", "7:11", "");
    expect(
        &tank("0.001 }\n}", "0.001 }, }"),
        "not JSON: trailing commas are not allowed",
        "9:31",
        "remove",
    );
    expect(
        &tank("\"end\": 2", "// end\n\"end\": 2"),
        "not JSON: comments are not allowed",
        "7:3",
        "title",
    );
    expect(
        &tank("20", "0x14"),
        "not JSON: hexadecimal numbers are not allowed",
        "4:63",
        "",
    );
    expect(
        &tank("20", "NaN"),
        "not JSON: unexpected token",
        "4:63",
        "double quotes",
    );
    expect(
        &tank("2,\n", "2,\u{a0}\n"),
        "not JSON: key must be a string",
        "7:12",
        "",
    );
    expect(
        &only_error(parse("")),
        "not JSON: there is nothing here",
        "1:1",
        "model",
    );
    expect(
        &only_error(parse("[1]")),
        "expected an object, found a list",
        "1:1",
        "model",
    );
    expect(
        &only_error(parse_with(b"{\n \"a\xff\"", &[], &[])),
        "the text is not UTF-8",
        "2:4",
        "save",
    );
}

#[test]
fn keys() {
    expect(
        &tank("\"end\": 2,", ""),
        "end missing",
        "1:1",
        "when the run ends",
    );
    expect(
        &tank("\"model\": \"walking_tank\",", ""),
        "model missing",
        "1:1",
        "known models: `bead",
    );
    expect(
        &tank("\"end\"", "\"ende\": 2, \"end\""),
        "unknown key `ende`",
        "7:3",
        "did you mean `end`?",
    );
    expect(
        &tank("\"freeze\"", "\"mu_k\": 0.1, \"freeze\""),
        "unknown key `mu_k`",
        "6:3",
        "belongs inside `parameters`",
    );
    expect(
        &tank("\"end\"", "\"end\": 2, \"end\""),
        "`end` is already there",
        "7:13",
        "line 7",
    );
    expect(
        &tank("\"every\"", "\"evry\""),
        "unknown key of the record `evry`",
        "9:15",
        "did you mean `every`?",
    );
    expect(
        &tank("walking_tank", "waking_tank"),
        "unknown model `waking_tank`",
        "2:12",
        "`walking_tank`",
    );
    expect(
        &tank("\"theta\"", "\"phi\""),
        "unknown coordinate `phi`",
        "5:16",
        "known: `at_rest`, `mode`, `project`, `theta`, `theta.rate`",
    );
    expect(
        &tank("[\"x\"]", "[\"z\"]"),
        "unknown coordinate `z`",
        "6:14",
        "`theta`",
    );
    expect(
        &tank("\"side\": 1", "\"mode\": \"rocks\""),
        "unknown mode `rocks`",
        "5:39",
        "`rocks_sticks`",
    );
    expect(
        &tank("\"M_S\"", "\"M_s\""),
        "unknown parameter `M_s`",
        "3:32",
        "did you mean `M_S`? known: `set`, ",
    );
    expect(
        &tank(
            "\"end\": 2",
            "\"end\": { \"time\": 2, \"after\": { \"landng\": 3 } }",
        ),
        "unknown transition `landng`",
        "7:34",
        "`landing`",
    );
    expect(
        &tank("\"end\": 2", "\"end\": { \"after\": { \"landing\": 3 } }"),
        "time missing",
        "7:10",
        "latest end",
    );
}

#[test]
fn types() {
    expect(
        &tank("0.3", "true"),
        "expected a number, found true or false",
        "3:27",
        "",
    );
    expect(
        &tank("20", "[20]"),
        "expected a number in m/s^2, found a list",
        "4:63",
        "",
    );
    expect(
        &tank("[\"x\"]", "\"x\""),
        "expected a list, found a text",
        "6:13",
        "",
    );
    expect(
        &tank("\"end\": 2", "\"end\": null"),
        "expected a number in s or an object, found null",
        "7:10",
        "",
    );
    expect(
        &tank("\"walking_tank\"", "7"),
        "expected the name of a model, or the path of a model folder, found a number",
        "2:12",
        "",
    );
    expect(
        &tank("\"side\": 1", "\"mode\": 1"),
        "expected the name of a mode, found a number",
        "5:39",
        "`stands_sticks`",
    );
}

#[test]
fn numbers() {
    expect(
        &tank("7.5", "1e999"),
        "`1e999` is not a finite number",
        "3:39",
        "largest",
    );
    expect(
        &tank("7.5", "-7.5"),
        "-7.5 is not admissible here: it must be > 0 kg",
        "3:39",
        "",
    );
    expect(
        &tank("7.5", "\"-75 g\""),
        "-0.075 is not admissible here: it must be > 0 kg",
        "3:39",
        "",
    );
    expect(
        &tank("0.3", "-0.3"),
        "-0.3 is not admissible here: it must be >= 0",
        "3:27",
        "",
    );
    expect(
        &tank("\"end\": 2", "\"end\": -2"),
        "-2 is not admissible here: it must be > 0 s",
        "7:10",
        "",
    );
    expect(
        &tank("0.001", "0"),
        "0 is not admissible here: it must be > 0 s",
        "9:24",
        "",
    );
    expect(
        &tank("0.02", "-0.02"),
        "-0.02 is not admissible here: it must be >= 0 rad",
        "5:25",
        "",
    );
    expect(
        &tank("\"side\": 1", "\"side\": 2"),
        "2 is not admissible here: it must be 1 or -1",
        "5:39",
        "",
    );
    expect(
        &tank("1e-8", "1e-17"),
        "1e-17 is not admissible here: it must be >= 2.220446049250313e-15 and <= 0.1",
        "8:29",
        "",
    );
    expect(
        &tank(
            "\"end\": 2",
            "\"end\": { \"time\": 2, \"after\": { \"landing\": 1.5 } }",
        ),
        "1.5 is not admissible here: it must be a whole number from 1 on",
        "7:45",
        "",
    );
}

#[test]
fn units() {
    expect(
        &tank("20", "\"20 m\""),
        "unit `m` does not fit, expected `m/s^2`",
        "4:63",
        "plain number is in m/s^2",
    );
    expect(
        &tank("20", "\"2 g\""),
        "unit `g` does not fit, expected `m/s^2`",
        "4:63",
        "`g_n`",
    );
    expect(
        &tank("20", "\"20\""),
        "unit `1` does not fit, expected `m/s^2`",
        "4:63",
        "quotes",
    );
    expect(
        &tank("7.5", "\"7.5 m^3\""),
        "unit `m^3` does not fit, expected `kg`",
        "3:39",
        "kg",
    );
    expect(
        &tank("20", "\"fast\""),
        "`fast` is not a number with a unit: it does not begin with a number",
        "4:63",
        "0.5 m/s^2",
    );
}

#[test]
fn independent_errors_are_reported_together() {
    let text = r#"{ "model": "walking_tank", "ende": 2, "parameters": { "M_S": -1, "mu": 3 } }"#;
    let errors = parse(text).unwrap_err();
    let kinds: Vec<String> = errors.iter().map(|e| e.kind().to_string()).collect();
    assert_eq!(
        kinds,
        [
            "unknown key `ende`",
            "-1 is not admissible here: it must be > 0 kg",
            "unknown parameter `mu`",
            "end missing"
        ]
    );
    assert_eq!(errors.to_string().matches("error: ").count(), 4);
}

#[test]
fn unreadable_scene_has_no_place() {
    let errors = Scene::load(Path::new("no/such/scene.json"), &[], models()).unwrap_err();
    let error = errors.iter().next().unwrap();
    assert_eq!(error.position(), None);
    assert!(
        error
            .to_string()
            .starts_with("error: cannot read `no/such/scene.json`: "),
        "{error}"
    );
}

#[test]
fn columns_count_characters() {
    let text = "{ \"model\": \"walking_tank\",\r\n\t\"title\": \"m/s² é\", \"end\": -1 }";
    let error = only_error(parse(text));
    expect(
        &error,
        "-1 is not admissible here: it must be > 0 s",
        "2:28",
        "",
    );
    assert!(
        error.to_string().contains("scenes/test.json:2:28"),
        "{error}"
    );
}

#[test]
fn a_title_is_of_printable_characters() {
    let error = tank(r#""end": 2,"#, r#""end": 2, "title": "two\u001b[31m red","#);
    let message = "this text holds U+001B, which cannot be printed";
    expect(&error, message, "7:22", "one line of printable characters");
    let scene = parse(r#"{ "model": "bouncing_ball", "title": "Größe µ — 30 °", "end": 1 }"#);
    assert_eq!(
        scene.unwrap().problem.title.as_deref(),
        Some("Größe µ — 30 °")
    );
}

#[test]
fn what_concerns_multipliers_where_there_are_none() {
    let under = "under equations = derived, rules = reactions, landing = momenta, edges = modes";
    let message = |key| {
        format!(
            "`{key}` has no effect {under}, where there is neither a contact with a gap nor a constraint"
        )
    };
    let error = tank(
        r#""end": 2,"#,
        r#""end": 2, "impacts": { "law": "poisson" },"#,
    );
    expect(&error, &message("impacts"), "7:24", "edges = contacts");
    let error = tank(r#""side": 1"#, r#""project": true"#);
    expect(
        &error,
        &message("project"),
        "5:42",
        "leave it out, or choose",
    );
}

#[test]
fn an_input_that_the_options_do_not_know() {
    let error = tank(
        r#""inputs": { "#,
        r#""rules": "paper", "inputs": { "vertical_acceleration": { "constant": 1 }, "#,
    );
    let message = "input `vertical_acceleration` has no effect under equations = derived, rules = paper, \
                   landing = velocities, edges = modes, and may not be given";
    expect(
        &error,
        message,
        "4:58",
        "or choose equations = derived, rules = reactions",
    );
}
