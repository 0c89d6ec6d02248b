//! `models`, `describe` and `schema`.

use super::*;

fn described(arguments: &[&str]) -> String {
    let output = ends_with(0, &project(), &[&["describe"][..], arguments].concat());
    stdout(&output).to_owned()
}

#[test]
fn models_are_listed_with_their_sources() {
    let output = ends_with(0, &project(), &["models"]);
    let text = stdout(&output);
    let names: Vec<&str> = text.lines().map(|l| l.split(' ').next().unwrap()).collect();
    let folders = super::names(&project().join("models"));
    let models = folders.iter().filter(|name| !name.starts_with(['_', '.']));
    let expected: Vec<&str> = ["model"]
        .into_iter()
        .chain(models.map(String::as_str))
        .collect();
    assert_eq!(
        names, expected,
        "every folder under models/, and no model of the tests"
    );
    assert!(text.contains("Rocking rigid block"));
    assert!(text.contains("Housner, G. W. (1963)"));
    let output = ends_with(0, &project(), &["models", "--json"]);
    let json: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(json.as_array().unwrap().len(), names.len() - 1);
}

#[test]
fn contacts_are_shown_with_what_they_open_to_and_turn_back() {
    let text = described(&["rocking_block"]);
    assert!(text.contains("theta to either side, side"), "{text}");
}

#[test]
fn modes_are_shown_with_guards_and_transitions() {
    let text = described(&["belt_oscillator"]);
    let modes = text.split("\nMode ").skip(1).collect::<Vec<_>>();
    assert!(
        modes[0].starts_with("belt sticks\n\n  free  none\n  held  x moving at its rate\n"),
        "{text}"
    );
    let slides = "belt slides

  free  x

  transition     to           may change              kind         when this falls through 0     unit
  belt sticks    belt sticks                          conditional  belt_direction*(x.rate-belt)  m/s
  belt reverses  belt slides  belt_direction, x.rate  otherwise    as above
";
    assert!(modes[1].starts_with(slides), "{text}");
}

#[test]
fn parameters_are_shown_with_units_defaults_and_bounds() {
    let text = described(&["walking_tank"]);
    let row = |name: &str| {
        let start = format!("  {name} ");
        let line = text.lines().find(|line| line.starts_with(&start));
        line.unwrap_or_else(|| panic!("no `{name}`"))
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    assert_eq!(
        row("mu_k"),
        "mu_k 1 0.19 >= 0, <= mu_s kinetic friction coefficient"
    );
    assert_eq!(row("M_0"), "M_0 kg 50.3 > 0 mass of the contents");
    assert!(row("rules").starts_with("rules reactions reactions, paper "));
    assert!(row("doughnut").contains("M_E = 9.56"));
    assert_eq!(
        row("theta"),
        "theta rad rad/s 0.01 0.1 >= 0 uplift angle about the pivot edge"
    );
    assert!(row("reaction.y").starts_with("reaction.y N "));
    assert!(
        row("jacobian")
            .split(' ')
            .nth(1)
            .unwrap()
            .parse::<u32>()
            .is_ok()
    );
    assert!(text.contains("needs R(y) > 0"));
}

#[test]
fn options_are_chosen() {
    let text = described(&["walking_tank", "--set", "rules=paper"]);
    assert!(text.contains("rules      paper "));
    assert!(
        text.contains("landing    velocities "),
        "the default under these rules"
    );
    for (setting, words) in [
        ("rule=paper", "unknown choice `rule`: did you mean `rules`?"),
        (
            "rules=papers",
            "unknown option `papers`: did you mean `paper`?",
        ),
        ("rules", "expected CHOICE=OPTION"),
    ] {
        let output = ends_with(
            2,
            &project(),
            &["describe", "walking_tank", "--set", setting],
        );
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    }
    let both = [
        "describe",
        "walking_tank",
        "--set",
        "equations=printed",
        "--set",
        "rules=reactions",
    ];
    let output = ends_with(2, &project(), &both);
    assert!(stderr(&output).contains("does not offer"));
}

#[test]
fn json_says_the_same() {
    let json: serde_json::Value =
        serde_json::from_str(&described(&["bouncing_ball", "--json"])).unwrap();
    assert_eq!(json["parameters"][0]["name"], "m");
    assert_eq!(json["parameters"][0]["minimum_exclusive"], true);
    assert!(json["parameters"][0]["maximum"].is_null());
    let flies = &json["modes"][0];
    assert_eq!(flies["free"], serde_json::json!(["h"]));
    assert_eq!(flies["rests"], serde_json::json!(["floor closed"]));
    let impact = &flies["guards"][0]["transitions"][0];
    assert_eq!(impact["name"], "floor strikes");
    assert_eq!(impact["impact"], true);
    assert_eq!(impact["changes"], serde_json::json!(["h", "h.rate"]));
    assert_eq!(flies["operations"][0]["function"], "residual");
}

#[test]
fn an_unknown_model_is_an_error() {
    for command in ["describe", "schema"] {
        let output = ends_with(2, &project(), &[command, "rocking_blok"]);
        let message = stderr(&output);
        assert!(
            message
                .starts_with("error: unknown model `rocking_blok`: did you mean `rocking_block`?")
        );
    }
}

#[test]
fn schema_of_a_model_knows_its_names() {
    let output = ends_with(0, &project(), &["schema", "walking_tank"]);
    let schema: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    let properties = &schema["properties"];
    assert_eq!(
        properties["parameters"]["properties"]["mu_s"]["default"],
        0.2
    );
    assert_eq!(
        properties["rules"]["enum"],
        serde_json::json!(["reactions", "paper"])
    );
    let output = ends_with(0, &project(), &["schema"]);
    let any: serde_json::Value = serde_json::from_str(stdout(&output)).unwrap();
    assert_eq!(any["required"], serde_json::json!(["model", "end"]));
}
