//! Random models whose gaps and slips are coordinates or solve for coordinates, each in both forms: a mode for each set of contact states, and one mode with
//! multipliers. Impacts, friction and rests that were derived for the one must be what complementarity decides in the other.
//!
//! `DALEMBERT_RANDOM_SCENES=300` runs as many, `DALEMBERT_RANDOM_SCENE=17` one of them.

use super::random::Random;
use super::random_mechanisms::{Kind, mechanism};
use super::{dalembert, json};
use serde_json::json;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Models in the suite: each is derived and compiled twice.
const SHARE: u64 = 6;

/// How each model begins: units of its numbers, and a force.
pub const HEAD: &str = "from codegen.model import *

model = Model(\"Random\", source=\"test model: random lines and mechanisms\")
one = model.parameter(\"one\", \"m\", 1.0, \"length\", above=0)
m = model.parameter(\"m\", \"kg\", 1.0, \"mass\", above=0)
k = model.parameter(\"k\", \"N/m\", 1.0, \"stiffness\", above=0)
c = model.parameter(\"c\", \"N s/m\", 1.0, \"damping\", above=0)
F = model.input(\"F\", \"N\", \"force\")
";

/// A line that solves for a coordinate of so many: itself, or with what another or a prescribed motion adds, and by some factor.
fn line(random: &mut Random, i: usize, n: usize) -> String {
    let factor = match random.next().is_multiple_of(6) {
        true => *random.one_of(&["ratio * ", "2 * ", "-0.5 / ratio * "]),
        false => "",
    };
    let motion = match random.next().is_multiple_of(4) {
        true => *random.one_of(&[" - z", " + 0.5 * z", " - one * sin(z / one)"]),
        false => "",
    };
    let place = with_others(random, i, n);
    match (factor, motion) {
        ("", "") => place,
        _ => format!("{factor}({place}{motion})"),
    }
}

/// A coordinate, or with what another adds.
fn with_others(random: &mut Random, i: usize, n: usize) -> String {
    if n == 1 || random.next().is_multiple_of(2) {
        return format!("x{i}");
    }
    let j = (i + 1 + random.next() as usize % (n - 1)) % n;
    let part = random.within(-0.8, 0.8);
    let other = random.one_of(&["x", "part * x", "part * one * sin(x / one)"]);
    let other = other
        .replace('x', &format!("x{j}"))
        .replace("part", &format!("{part:.4}"));
    format!("(x{i} - {other})")
}

/// A model file, how many coordinates it has, and whether they are all alike: then much happens at one instant.
fn model(random: &mut Random) -> (String, usize, bool) {
    let n = 1 + (random.next() % 3) as usize;
    let alike = random.next().is_multiple_of(3);
    let [of_each, of_pairs] = [random.next(), random.next()];
    let mut next = |seed| Random(if alike { seed } else { random.next() });
    let mut text = HEAD.to_owned();
    text.push_str(
        "N = model.parameter(\"N\", \"N\", 1.0, \"force\", above=0)\n\
         speed = model.parameter(\"speed\", \"m/s\", 1.0, \"speed of belts\", above=0)\n\
         ratio = model.parameter(\"ratio\", \"1\", 1.3, \"of a gear\", above=0)\n\
         z = model.motion(\"z\", \"a table, or a belt\", input=\"a\")\n",
    );
    let mut say = |line: String| writeln!(text, "{line}").unwrap();
    let masses: Vec<f64> = (0..n).map(|_| next(of_each).within(0.5, 2.0)).collect();
    for i in 0..n {
        say(format!(
            "x{i} = model.coordinate(\"x{i}\", \"m\", \"place {i}\")"
        ));
        say(format!(
            "model.kinetic({:.4} * m * x{i}.rate**2 / 2)",
            masses[i]
        ));
    }
    for i in 0..n {
        for j in 0..i {
            let random = &mut next(of_pairs);
            if random.next().is_multiple_of(4) {
                let most = 0.4 * (masses[i] * masses[j]).sqrt();
                let (part, at) = (random.within(-most, most), random.next() as usize % n);
                let factor = *random.one_of(&["1", "cos"]);
                let factor = if alike { "1" } else { factor };
                let factor = factor.replace("cos", &format!("cos(x{at} / one)"));
                say(format!(
                    "model.kinetic({part:.4} * m * x{i}.rate * x{j}.rate * {factor})"
                ));
            }
            if random.next().is_multiple_of(3) {
                let stiffness = random.within(1.0, 20.0);
                say(format!(
                    "model.potential({stiffness:.4} * k * (x{i} - x{j})**2 / 2)"
                ));
            }
        }
    }
    for i in 0..n {
        let random = &mut next(of_each);
        let [stiffness, weight, damping, force] =
            [(1.0, 20.0), (-10.0, 10.0), (0.0, 0.5), (-1.0, 1.0)]
                .map(|range| random.either(0.0, range));
        say(format!(
            "model.potential({stiffness:.4} * k * x{i}**2 / 2 + {weight:.4} * N * x{i})"
        ));
        say(format!(
            "model.dissipation({damping:.4} * c * x{i}.rate**2 / 2)"
        ));
        say(format!("model.force(x{i}, {force:.4} * F)"));
        let kind = *random.one_of(&["", "stop", "friction", "stop friction", "stop end"]);
        let mu = random.within(0.1, 0.8);
        let kinetic = mu * random.within(0.6, 1.0);
        let side = *random.one_of(&[1.0, -1.0]);
        let mut moves = false;
        if kind.contains("stop") {
            let slip = match n {
                1 => String::new(),
                _ if random.next().is_multiple_of(3) => {
                    let along = (i + 1 + random.next() as usize % (n - 1)) % n;
                    let place = line(random, along, n);
                    format!(", slip={place}, static={mu:.4}, kinetic={kinetic:.4}")
                }
                _ => String::new(),
            };
            let (at, e) = (random.within(0.1, 0.6), random.either(0.0, (0.1, 0.9)));
            let place = line(random, i, n);
            moves = place.contains('z');
            say(format!(
                "model.contact(\"stop{i}\", gap={side} * {place} + {at:.4} * one, restitution={e:.4}{slip})"
            ));
        }
        // A stop that moves leaves no room before an end that does not.
        if kind.contains("end") && !moves {
            let at = random.within(0.1, 0.6);
            say(format!(
                "model.contact(\"end{i}\", gap={} * x{i} + {at:.4} * one)",
                -side
            ));
        }
        if kind.contains("friction") || (i == 0 || alike) && kind.is_empty() {
            let (holds, slides) = (5.0 * mu, 5.0 * kinetic);
            let (place, belt) = (line(random, i, n), random.within(-1.0, 1.0));
            let belt = match place.len() {
                2 => format!("x{i}.rate - {belt:.4} * speed"),
                _ => place.clone(),
            };
            let slip = random.one_of(&[place, belt]).clone();
            say(format!(
                "model.friction(\"base{i}\", slip={slip}, normal=N, static={holds:.4}, kinetic={slides:.4})"
            ));
        }
    }
    (text, n, alike)
}

/// Runs the model of a folder; the summary, and the coordinates and rates at the end.
fn run(folder: &Path, form: &str, scene: &serde_json::Value) -> (serde_json::Value, Vec<f64>) {
    runs(folder, form, scene).unwrap_or_else(|refused| panic!("{refused}"))
}

/// The same, or why the scene is refused.
fn runs(
    folder: &Path,
    form: &str,
    scene: &serde_json::Value,
) -> Result<(serde_json::Value, Vec<f64>), String> {
    let mut scene = scene.clone();
    scene["model"] = json!(format!("./{form}"));
    let file = format!("{form}.json");
    fs::write(folder.join(&file), scene.to_string()).unwrap();
    let out = format!("out_{form}");
    let _ = fs::remove_dir_all(folder.join(&out));
    let assert = dalembert(folder)
        .args(["run", &file, "--out", &out])
        .assert();
    let output = assert.get_output();
    let path = folder.join(&out).join("summary.json");
    if !path.exists() {
        return Err(super::stderr(output).to_owned());
    }
    let summary = json(&path);
    let of = |what: &str| {
        let values = summary["end"][what].as_object().unwrap().iter();
        let own = values.filter(|(name, _)| name.starts_with('x'));
        own.map(|(_, value)| value.as_f64().unwrap())
            .collect::<Vec<_>>()
    };
    let state = [of("q"), of("v")].concat();
    Ok((summary, state))
}

/// The sum of each impulse over all events of the run in a form, and a bound of what is left out: the impacts of an accumulation
/// from where it is certain, or below rounding. With restitutions up to 0.9 they are ten times the last one.
fn impulses(folder: &Path, form: &str) -> BTreeMap<String, [f64; 2]> {
    let file = folder.join(format!("out_{form}/events.csv"));
    let mut table = csv::Reader::from_path(file).unwrap();
    let names = table.headers().unwrap().clone();
    let own = |(_, name): &(usize, &str)| name.ends_with("impulse");
    let own: Vec<(usize, &str)> = names.iter().enumerate().filter(own).collect();
    let transition = names.iter().position(|name| name == "transition").unwrap();
    let mut sums: BTreeMap<_, _> = (own.iter())
        .map(|&(_, name)| (name.into(), [0.0; 2]))
        .collect();
    let mut last = vec![0.0; own.len()];
    for row in table.records() {
        let row = row.unwrap();
        for (&(i, name), last) in own.iter().zip(&mut last) {
            let [sum, left] = sums.get_mut(name).unwrap();
            let impulse: f64 = row[i].parse().unwrap();
            *sum += impulse;
            match &row[transition] == "rest" {
                true => *left += 10.0 * *last,
                false if impulse != 0.0 => *last = impulse.abs(),
                false => {}
            }
        }
    }
    sums
}

/// Both forms start in the same static equilibrium, or in none.
fn assert_rests_alike(folder: &Path, force: f64, of: &str) {
    let scene = json!({
        "initial": "at rest", "inputs": { "F": { "constant": force } }, "end": 0.1,
    });
    let [a, b] = ["reduced", "multipliers"].map(|form| runs(folder, form, &scene));
    match (a, b) {
        (Ok((_, a)), Ok((_, b))) => {
            for (a, b) in a.iter().zip(&b) {
                assert!((a - b).abs() < 1e-12, "at rest: {a} and {b} in {of}");
            }
        }
        (Err(a), Err(b)) => {
            let reasons = ["no static equilibrium", "several motions"];
            let is_same = |reason: &&str| a.contains(*reason) && b.contains(*reason);
            assert!(reasons.iter().any(is_same), "{a} and {b} in {of}");
        }
        (a, b) => panic!("{:?} and {:?} in {of}", a.err(), b.err()),
    }
}

/// A model in both forms, and a scene of it: they move alike, with the same impulses, balanced energies and the same extremes. How
/// many events there were, and whether the first form is reduced. They also start at rest alike under a constant force.
fn move_alike(
    (text, n): (&str, usize),
    (scene, force): (&serde_json::Value, f64),
    of: &str,
) -> (u64, bool) {
    let folder = tempfile::tempdir().unwrap();
    for (form, more) in [("reduced", ""), ("multipliers", "model.multipliers()\n")] {
        fs::create_dir(folder.path().join(form)).unwrap();
        let file = folder.path().join(form).join("model.py");
        fs::write(file, format!("{text}{more}")).unwrap();
    }
    let [(one, a), (other, b)] =
        ["reduced", "multipliers"].map(|form| run(folder.path(), form, scene));
    let stops = |run: &serde_json::Value| {
        let reason = run["failure"]["reason"].as_str()?;
        reason
            .contains("goes to infinity")
            .then(|| run["failure"]["t"].as_f64().unwrap())
    };
    if let (Some(a), Some(b)) = (stops(&one), stops(&other)) {
        // There is no telling numbers there.
        assert!((a - b).abs() <= 1e-7 * a, "{a} s and {b} s in {of}");
        return (0, false);
    }
    assert_eq!(one["failure"], other["failure"], "{of}");
    for (a, b) in a.iter().zip(&b) {
        assert!(
            (a - b).abs() <= 1e-7 * (1.0 + a.abs()),
            "{a} and {b} in {of}"
        );
    }
    let [a, b] = ["reduced", "multipliers"].map(|form| impulses(folder.path(), form));
    assert!(a.keys().eq(b.keys()), "{a:?} and {b:?} in {of}");
    for (name, [a, left_by_one]) in a {
        let [b, left_by_other] = b[&name];
        let left = left_by_one.max(left_by_other);
        assert!(
            (a - b).abs() <= 1e-7 * (1.0 + a.abs()) + left,
            "{name}: {a} and {b} in {of}"
        );
    }
    for run in [&one, &other] {
        let imbalance = run["energy"]["imbalance"].as_f64().unwrap();
        // Masses are of 1 kg: what is stored may be a small difference of kinetic and potential energy.
        let largest = |name: &String, extreme| run["peaks"][name][extreme].as_f64().unwrap();
        let rates = (0..n).map(|i| format!("x{i}.rate"));
        let kinetic: f64 = rates
            .map(|name| largest(&name, "max").max(-largest(&name, "min")).powi(2))
            .sum();
        let bound = 1e-10 * (10.0 + kinetic);
        assert!(imbalance.abs() < bound, "{imbalance:e} J in {of}");
    }
    for name in (0..n).flat_map(|i| [format!("x{i}"), format!("x{i}.rate")]) {
        for extreme in ["min", "max"] {
            let [a, b] = [&one, &other].map(|run| run["peaks"][&name][extreme].as_f64().unwrap());
            assert!(
                (a - b).abs() <= 1e-7 * (1.0 + a.abs()),
                "{name}: {a} and {b} in {of}"
            );
        }
    }
    // A belt carries along what nothing else holds, in reduced modes alone.
    if !text.contains("* speed") {
        assert_rests_alike(folder.path(), force, of);
    }
    let has_impulses = |name: &String| name.ends_with("_impulse");
    let is_reduced = !one["peaks"].as_object().unwrap().keys().any(has_impulses);
    (one["events"]["total"].as_u64().unwrap(), is_reduced)
}

/// A scene of a model.
fn scene(random: &mut Random, text: &str, rates: &[f64]) -> serde_json::Value {
    let rates = rates.iter().enumerate();
    let rates = rates.map(|(i, rate)| (format!("x{i}.rate"), json!(rate)));
    let mut scene = json!({
        "initial": rates.collect::<serde_json::Map<_, _>>(),
        "inputs": { "F": { "sine": {
            "amplitude": random.within(0.0, 15.0),
            "angular_frequency": random.within(1.0, 8.0),
        } } },
        "end": 3.0,
        "accuracy": { "relative": 1e-11 },
        "record": { "every": 0.1 },
    });
    if text.contains("input=\"a\"") {
        scene["inputs"]["a"] = json!({ "sine": {
            "amplitude": random.within(0.0, 8.0),
            "angular_frequency": random.within(1.0, 8.0),
            "phase": random.within(0.0, 6.0),
        } });
    }
    if text.contains("model.contact(") {
        let law = random.one_of(&["newton", "poisson"]);
        let order = random.one_of(&["together", "sequence"]);
        scene["impacts"] = json!({ "law": law, "order": order });
    }
    scene
}

/// The numbers of models that are asked for.
fn numbers() -> std::ops::Range<u64> {
    let asked = |name: &str| std::env::var(name).ok().and_then(|n| n.parse::<u64>().ok());
    match asked("DALEMBERT_RANDOM_SCENE") {
        Some(number) => number..number + 1,
        None => {
            let share = asked("DALEMBERT_RANDOM_SCENES").unwrap_or(SHARE);
            asked("DALEMBERT_FROM").unwrap_or(0)..share
        }
    }
}

#[test]
fn random_models_move_alike_in_both_forms() {
    let (mut events, mut reduced) = (0, 0);
    for number in numbers() {
        let mut random = Random(number);
        let (text, n, alike) = model(&mut random);
        let common = random.within(-2.0, 2.0);
        let mut rate = || match alike {
            true => common,
            false => random.within(-2.0, 2.0),
        };
        let rates: Vec<f64> = (0..n).map(|_| rate()).collect();
        let scene = scene(&mut random, &text, &rates);
        let of = format!("model {number}:\n{text}{scene}");
        let force = random.within(-2.0, 2.0);
        let (happened, is_reduced) = move_alike((&text, n), (&scene, force), &of);
        events += happened;
        reduced += u64::from(is_reduced);
    }
    println!("{events} events, {reduced} models in two forms");
}

#[test]
fn random_mechanisms_move_alike_in_both_forms() {
    let (mut events, mut reduced) = (0, 0);
    for number in numbers() {
        let mut random = Random(number);
        let kinds = [Kind::Cart, Kind::Pendulum, Kind::Feet];
        let (text, n) = mechanism(&mut random, kinds[number as usize % kinds.len()]);
        let rates: Vec<f64> = (0..n).map(|_| random.within(-1.0, 1.0)).collect();
        let scene = scene(&mut random, &text, &rates);
        let of = format!("mechanism {number}:\n{text}{scene}");
        let force = random.within(-2.0, 2.0);
        let (happened, is_reduced) = move_alike((&text, n), (&scene, force), &of);
        events += happened;
        reduced += u64::from(is_reduced);
    }
    println!("{events} events, {reduced} mechanisms in two forms");
}
