//! What right scenes mean.

use super::*;
use crate::hybrid::{End, Initial, Problem, Record};
use crate::record::Recorded;

fn full() -> Problem {
    let tables: &[(&str, &[u8])] = &[("record.csv", RECORD.as_bytes())];
    parse_with(FULL.as_bytes(), &[], tables).unwrap().problem
}

fn coordinate(scene: &Problem, name: &str) -> usize {
    scene.model.coordinate(name).unwrap()
}

fn parameter(scene: &Problem, name: &str) -> f64 {
    scene.parameters[scene.model.parameter(name).unwrap()]
}

#[test]
fn smallest_scene_takes_every_default() {
    let scene = parse(r#"{ "model": "walking_tank", "end": 1 }"#)
        .unwrap()
        .problem;
    let defaults: Vec<f64> = scene.model.parameters.iter().map(|p| p.default).collect();
    assert_eq!(scene.parameters, defaults);
    assert_eq!(
        scene.initial,
        Initial {
            q: vec![0.0; scene.model.coordinates.len()],
            v: vec![0.0; scene.model.coordinates.len()],
            discrete: (scene.model.discretes.iter())
                .map(|d| d.values[0])
                .collect(),
            mode: None
        }
    );
    assert_eq!(
        scene.end,
        End {
            time: 1.0,
            after: None
        }
    );
    assert_eq!(scene.accuracy.relative, 1e-8);
    let [sizes, rates] = scene.typical_sizes();
    let products = |sizes: Vec<f64>| sizes.iter().map(|size| 1e-8 * size).collect::<Vec<_>>();
    assert_eq!(scene.accuracy.q_absolute, products(sizes));
    assert_eq!(scene.accuracy.v_absolute, products(rates));
    assert_eq!(
        scene.record,
        Record {
            every: None,
            columns: Recorded {
                reactions: true,
                outputs: true,
                energies: true,
                inputs: true
            },
            ledger: true,
            event_states: true,
            extremes: true,
        }
    );
    let mut u = [f64::NAN; 6];
    scene.signals.evaluate(0.3, &mut u);
    assert_eq!(u, [0.0; 6]);
    assert_eq!(scene.signals.next_breakpoint(0.0), f64::INFINITY);
}

#[test]
fn every_key_is_read() {
    let scene = full();
    assert_eq!(scene.title.as_deref(), Some("Full plate, 20 m/s² at 7 Hz"));
    assert_eq!(parameter(&scene, "I_E"), 1.065, "from the set");
    assert_eq!(parameter(&scene, "mu_s"), 0.6);
    assert_eq!(parameter(&scene, "mu_k"), 0.5);
    assert_eq!(parameter(&scene, "R_0"), 0.28);
    let mode = scene.initial.mode.map(|m| scene.variant().modes[m].name);
    assert_eq!(mode, Some("rocks_sticks"));
    let theta = coordinate(&scene, "theta");
    assert_eq!(
        (scene.initial.q[theta], scene.initial.v[theta]),
        (0.02, -0.1)
    );
    assert_eq!(scene.initial.discrete[..2], [-1.0, 1.0]);
    assert_eq!(scene.freeze, [coordinate(&scene, "x")]);
    assert_eq!(
        scene.end,
        End {
            time: 2.0,
            after: Some(("landing", 30))
        }
    );
    assert_eq!(scene.accuracy.relative, 1e-9);
    assert_eq!(scene.accuracy.q_absolute[theta], 1e-12);
    assert_eq!(scene.accuracy.v_absolute[coordinate(&scene, "x_I")], 1e-3);
    let x = coordinate(&scene, "x");
    assert_eq!(
        scene.accuracy.q_absolute[x],
        1e-9 * scene.model.coordinates[x].scale
    );
    assert_eq!(
        scene.record,
        Record {
            every: Some(0.001),
            columns: Recorded {
                reactions: true,
                outputs: true,
                energies: false,
                inputs: true
            },
            ledger: false,
            event_states: true,
            extremes: true,
        }
    );
}

#[test]
fn inputs_add_up() {
    let scene = full();
    let mut u = [0.0; 6];
    // Before the sine: parabola 6 t (1 − t) with its top 1.5 at 0.5, record 2 × 1, constant.
    scene.signals.evaluate(0.1, &mut u);
    assert!(
        (u[0] - (6.0 * 0.1 * 0.9 + 2.0 + 0.25)).abs() < 1e-14,
        "{u:?}"
    );
    // v = 3 t² − 2 t³ + 2 t + t / 4
    assert!(
        (u[1] - (3.0 * 0.01 - 2.0 * 0.001 + 0.2 + 0.025)).abs() < 1e-15,
        "{u:?}"
    );
    // The sine starts with its phase of 90°, at 2 g; the record has ended.
    scene.signals.evaluate(0.5, &mut u);
    assert!((u[0] - (1.5 + 0.25 + 2.0 * 9.80665)).abs() < 1e-13, "{u:?}");
    scene.signals.evaluate_left(0.5, &mut u);
    assert!((u[0] - (1.5 - 2.0 + 0.25)).abs() < 1e-14, "{u:?}");
    let mut t = 0.0;
    let mut breakpoints = Vec::new();
    while scene.signals.next_breakpoint(t) < f64::INFINITY {
        t = scene.signals.next_breakpoint(t);
        breakpoints.push(t);
    }
    assert_eq!(breakpoints, [0.25, 0.5, 0.5 + 3.0 / 7.0, 1.0]);
    // Two pieces of the spline join at 0.5; then a quarter period counts.
    assert_eq!(scene.signals.next_joint(0.0), 0.5);
    assert_eq!(scene.signals.resolution(0.0), f64::INFINITY);
    assert!((scene.signals.resolution(0.6) - 0.25 / 7.0).abs() < 1e-16);
}

#[test]
fn defaults_of_choices_follow_the_choices_that_are_named() {
    let options = |choices: &str| {
        let text = format!(r#"{{ "model": "walking_tank", "end": 1 {choices} }}"#);
        let scene = parse(&text).unwrap();
        ["rules", "landing"].map(|choice| option(&scene, choice))
    };
    assert_eq!(options(""), ["reactions", "momenta"]);
    assert_eq!(options(r#", "rules": "paper""#), ["paper", "velocities"]);
    assert_eq!(
        options(r#", "landing": "velocities""#),
        ["reactions", "velocities"]
    );
    assert_eq!(
        options(r#", "rules": "paper", "landing": "momenta""#),
        ["paper", "momenta"]
    );
}

#[test]
fn inputs_may_be_null_and_angular() {
    let input = |text: &str| {
        let text = format!(
            r#"{{ "model": "belt_oscillator", "end": 1, "inputs": {{ "force": {text} }} }}"#
        );
        let scene = parse(&text).unwrap().problem;
        let mut u = [f64::NAN];
        scene.signals.evaluate(0.5, &mut u);
        u[0]
    };
    assert_eq!(input("null"), 0.0);
    assert_eq!(input(r#"{ "constant": "3 kN" }"#), 3000.0);
    let sine = input(r#"{ "sine": { "amplitude": 2, "angular_frequency": 1 } }"#);
    assert!((sine - 2.0 * 0.5_f64.sin()).abs() < 1e-15);
    let sine = input(r#"{ "sine": { "amplitude": 2, "frequency": "1 rad/s", "end": 0.5 } }"#);
    assert_eq!(sine, 0.0);
    let hold = r#"{ "knots": [[0, 0], [0.25, 4]], "outside": "hold" }"#;
    assert_eq!(input(hold), 4.0);
}

#[test]
fn tables_may_have_comments_quotes_and_a_byte_order_mark() {
    let scene = r#"{ "model": "belt_oscillator", "end": 1,
        "inputs": { "force": { "table": { "file": "f.csv" } } } }"#;
    for table in [
        "\u{feff}t,F\n0,1\n1,3\n",
        "# measured\n\n0,1\r\n# half way\r\n1,3",
        "\"t [s]\",\"F, horizontal\"\n\"0\",\"1\"\n\"1\",\"3\"\n",
    ] {
        let scene = parse_with(scene.as_bytes(), &[], &[("f.csv", table.as_bytes())]).unwrap();
        let mut u = [0.0];
        scene.problem.signals.evaluate(0.5, &mut u);
        assert_eq!(u, [2.0], "{table}");
    }
}

/// A choice of a model is a key of its scenes: none may be called like one that all scenes have.
#[test]
fn no_choice_can_be_named_like_a_key_of_scenes() {
    let names = include_str!("../../../codegen/arguments.py");
    let (_, choices) = names.split_once("\"choice\": dict.fromkeys(").unwrap();
    let (choices, _) = choices.split_once("\"a key of scenes\"").unwrap();
    let schema = crate::scene::schema(None);
    for key in schema["properties"].as_object().unwrap().keys() {
        let is_reserved = choices.contains(&format!("\"{key}\""));
        assert!(is_reserved || key.starts_with('$'), "{key}");
    }
}

#[test]
fn schema_lists_what_a_model_has() {
    for model in models().iter() {
        let schema = crate::scene::schema(Some(&model));
        let parameters = schema["properties"]["parameters"]["properties"]
            .as_object()
            .unwrap();
        assert!(
            model
                .parameters
                .iter()
                .all(|p| parameters.contains_key(p.name))
        );
        let initial = &schema["properties"]["initial"]["anyOf"][0]["properties"];
        for c in &model.coordinates {
            // Multipliers are nobody's to give.
            let key = format!("{}.rate", c.name);
            assert_eq!(initial[&key].is_object(), !c.multiplier, "{key}");
        }
        assert_eq!(schema["additionalProperties"], false);
        assert_eq!(schema["required"], serde_json::json!(["model", "end"]));
    }
    let tank = crate::scene::schema(models().find("walking_tank").as_deref());
    assert_eq!(
        tank["properties"]["rules"]["enum"],
        serde_json::json!(["reactions", "paper"])
    );
    let mu_k = &tank["properties"]["parameters"]["properties"]["mu_k"];
    assert_eq!(
        mu_k["description"],
        "kinetic friction coefficient; at most mu_s [1]"
    );
    assert_eq!(
        mu_k["anyOf"][0],
        serde_json::json!({ "type": "number", "minimum": 0.0 })
    );
    assert_eq!(
        crate::scene::schema(None)["additionalProperties"],
        serde_json::json!({ "type": "string" })
    );
}

#[test]
fn documentation_names_every_key() {
    let documentation = include_str!("../../../docs/scene.md");
    fn keys(schema: &serde_json::Value, found: &mut Vec<String>) {
        if let Some(properties) = schema.get("properties").and_then(|p| p.as_object()) {
            found.extend(properties.keys().cloned());
        }
        match schema {
            serde_json::Value::Object(map) => map.values().for_each(|v| keys(v, found)),
            serde_json::Value::Array(items) => items.iter().for_each(|v| keys(v, found)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    keys(&crate::scene::schema(None), &mut found);
    assert!(found.len() > 30);
    for key in found {
        assert!(
            documentation.contains(&format!("`{key}`")),
            "docs/scene.md does not name `{key}`"
        );
    }
}

#[test]
fn a_byte_order_mark_says_only_that_the_text_is_utf_8() {
    let text = "{ \"model\": \"bouncing_ball\", \"end\": 1 }";
    let marked = format!("\u{feff}{text}");
    parse(&marked).unwrap();
    // Columns are those of the text behind it.
    let wrong = only_error(parse(&marked.replace("end", "ent").replace('1', "one")));
    let plain = only_error(parse(&text.replace("end", "ent").replace('1', "one")));
    assert_eq!(wrong.to_string(), plain.to_string());
    let table = "\u{feff}t,a\n0,0\n1,2\n2,0\n";
    let scene = r#"{ "model": "walking_tank", "end": 1,
        "inputs": { "ground_acceleration": { "table": { "file": "a.csv" } } } }"#;
    parse_with(scene.as_bytes(), &[], &[("a.csv", table.as_bytes())]).unwrap();
}

#[test]
fn a_scale_is_a_factor_or_what_one_in_the_file_stands_for() {
    let value = |scale: &str| {
        let scene = format!(
            r#"{{ "model": "walking_tank", "end": 1, "inputs": {{
                "ground_acceleration": {{ "table": {{ "file": "a.csv", "scale": {scale} }} }} }} }}"#
        );
        let table: &[u8] = b"t,a\n0,0\n1,2\n2,0\n";
        let scene =
            parse_with(scene.as_bytes(), &[], &[("a.csv", table)]).map_err(|e| e.to_string())?;
        let mut u = [0.0; 6];
        scene.problem.signals.evaluate(1.0, &mut u);
        Ok::<_, String>(u[0])
    };
    assert_eq!(value("\"1 g_n\""), Ok(2.0 * 9.80665));
    assert_eq!(value("\"1 cm/s^2\""), Ok(0.02));
    assert_eq!(value("\"50 %\""), Ok(1.0));
    assert_eq!(value("3"), Ok(6.0));
    assert!(value("\"1 m\"").unwrap_err().contains("unit"));
}
