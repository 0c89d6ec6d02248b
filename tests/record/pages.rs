//! Pages of runs that no scene would easily give: hostile names, bad data, very many points and transitions.

use super::browser::in_browser;
use super::*;
use dalembert::page::{Told, run_page};
use dalembert::record::{Jump, ModeNames, Sketch, Units};

/// A drawing whose only point is at (0, y), with a contact.
const DRAWING: &str = r#"{"symbols":["y"],"registers":2,"outputs":4,
    "program":[["const",0,0],["in",1,0],["out",0,0],["out",1,1],["out",2,0],["out",3,0]],
    "shapes":[{"name":"NAME","kind":"point","start":0,"points":1,"radius":false},
        {"name":"NAME","kind":"contact","start":2,"points":1,"radius":false,"force":[null,"reaction.y"],"states":{"rests":"closed"}}]}"#;

fn page(run: &Run, sketch: &Sketch, drawing: &str) -> String {
    let told = Told {
        drawing,
        parameters: &[],
        scene: "{}",
        command: "dalembert run",
        units: &Units::default(),
    };
    run_page(run, sketch, told)
}

/// A page that shows all it has: times, contacts, a zoom.
const ALL: &str = "
    const { show, plots, motion, zoomGroup } = dalembert, [first, last] = motion.span;
    document.getElementById('with-forces').click();
    for (const part of [0, 0.4, 1]) show(first + part * (last - first));
    const timed = plots.filter((plot) => plot.spec.time);
    if (timed.length) zoomGroup(timed[0], [first, first + 0.3 * (last - first)], null);
    setTimeout(() => done(window.hacked ? ['hacked'] : [document.body.innerText]), 100);";

#[test]
fn names_are_text_wherever_they_come_from() {
    const HOSTILE: &str =
        "</script><img src=x onerror=\"window.hacked=1\"><!--<script>'\"&\u{2028}__proto__";
    let mut run = bouncing_ball(1.0, 3, 50);
    run.subject.model = format!("model {HOSTILE}");
    run.subject.title = format!("title {HOSTILE}");
    run.subject.choices = vec![(format!("choice {HOSTILE}"), format!("option {HOSTILE}"))];
    run.subject
        .parameters
        .push((format!("parameter {HOSTILE}"), 1.0));
    run.layout.modes = ModeNames::listed(vec![format!("flies {HOSTILE}"), "rests".into()]);
    for quantity in [
        &mut run.layout.velocities[0],
        &mut run.layout.reactions[0],
        &mut run.layout.energies[0],
    ] {
        quantity.name += HOSTILE;
        quantity.meaning += HOSTILE;
    }
    run.layout.coordinates[0].meaning += HOSTILE;
    run.trajectory.columns = run.layout.columns();
    let mut drawing: serde_json::Value = serde_json::from_str(DRAWING).unwrap();
    for shape in drawing["shapes"].as_array_mut().unwrap() {
        shape["name"] = HOSTILE.into();
    }
    let drawing = drawing.to_string();
    let page = page(&run, &Sketch::of(&run), &drawing);
    assert!(!page.contains("<img"), "a name is markup");
    let home = tempfile::tempdir().unwrap();
    if let Some(seen) = in_browser(home.path(), &[page], ALL) {
        let [text] = &seen[0][..] else {
            panic!("{seen:?}");
        };
        for part in ["title <", "option <", "flies <", "parameter <"] {
            let part = part.replace('<', "</script><img src=x onerror=");
            assert!(text.contains(&part), "{part} in {text}");
        }
    }
}

#[test]
fn bad_data_have_a_page_that_says_so() {
    let mut pages = Vec::new();
    let mut expect: Vec<&[&str]> = Vec::new();
    let mut add = |run: &Run, sketch: &Sketch, words: &'static [&'static str]| {
        pages.push(page(run, sketch, DRAWING));
        expect.push(words);
    };
    // A run that stopped at what is no number.
    let mut run = stopped(bouncing_ball(1.0, 3, 50));
    let mut sketch = Sketch::of(&run);
    sketch.row(1.3, &[f64::NAN; 5]);
    sketch.row(1.4, &[f64::NAN; 5]);
    run.end.state.q[0] = f64::NAN;
    add(
        &run,
        &sketch,
        &[
            "Stopped early at t = 1.25 s",
            "the normal force would be negative",
        ],
    );
    // One sample, and nothing else.
    let mut run = bouncing_ball(1.0, 1, 1);
    run.events.clear();
    run.tally = Default::default();
    run.end.t = 0.0;
    add(&run, &Sketch::of(&run), &["nothing to draw over time"]);
    // No transitions.
    let mut run = bouncing_ball(1.0, 1, 50);
    run.events.clear();
    run.tally = Default::default();
    add(&run, &Sketch::of(&run), &["Extremes", "y"]);
    // The ends of the range of doubles.
    for (size, words) in [
        (1e-308, &["not drawn: y, from"] as &[&str]),
        (1e300, &["not drawn: y, from"]),
        (1e-200, &["Extremes"]),
        (1e200, &["Extremes"]),
    ] {
        let run = bouncing_ball(1.0, 1, 50);
        let mut sketch = Sketch::new(&run.layout);
        for (i, &t) in run.trajectory.t.iter().enumerate() {
            let row: Vec<f64> = run.trajectory.row(i).iter().map(|x| x * size).collect();
            sketch.row(t, &row);
        }
        add(&run, &sketch, words);
    }
    // A million transitions.
    let run = bouncing_ball(1.0, 1, 50);
    let mut sketch = Sketch::new(&run.layout);
    for i in 0..1_000_000_u64 {
        let t = i as f64 * 1e-6;
        if i % 1000 == 0 {
            sketch.row(t, &[1.0 - t, 0.0, 0.0, 1.0, 0.0]);
        }
        let jump = Jump {
            t,
            j: i,
            ..run.events[0].jump()
        };
        sketch.event(&jump, None);
    }
    add(&run, &sketch, &["of 1000000 transitions are marked"]);
    let home = tempfile::tempdir().unwrap();
    if let Some(seen) = in_browser(home.path(), &pages, ALL) {
        for (seen, words) in seen.iter().zip(&expect) {
            let [text] = &seen[..] else {
                panic!("{words:?}: {seen:?}");
            };
            for word in *words {
                assert!(text.contains(word), "{word} in {text}");
            }
        }
    }
}

#[test]
fn a_million_points_are_few_and_none_of_their_extremes_is_lost() {
    let run = bouncing_ball(1.0, 1, 2);
    let mut sketch = Sketch::new(&run.layout);
    let spikes = [(123_456, 7.0), (654_321, -7.0)];
    for i in 0..1_000_000 {
        let spike = spikes.iter().find(|spike| spike.0 == i);
        let y = spike.map_or((i as f64 * 0.37).sin(), |spike| spike.1);
        sketch.row(i as f64 * 1e-3, &[y, 0.5 * y, 0.0, 1.0, 0.0]);
    }
    let page = page(&run, &sketch, DRAWING);
    assert!(page.len() < 4_000_000, "{} bytes", page.len());
    assert!(
        page.contains("of 1000000 points"),
        "the page does not say so"
    );
    let script = "
        const [plot] = dalembert.plots, { y } = plot.curves[0];
        done([String([Math.max(...y), Math.min(...y), y.length < 25000])]);";
    let home = tempfile::tempdir().unwrap();
    if let Some(seen) = in_browser(home.path(), &[page], script) {
        assert_eq!(seen[0], ["7,-7,true"]);
    }
}
