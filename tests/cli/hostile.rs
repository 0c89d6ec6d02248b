//! Models of strangers: whatever their texts hold, pages, pictures and terminals show it as text.

use super::browser::in_browser;
use super::*;

/// Ends elements, comments, strings and lines, wherever it is put.
const TEXT: &str = "</script><script>hacked=1</script><img src=x onerror=hacked=2> \"q\" 'p' & &lt; \u{2028} \
    ]]> --> `${hacked=3}` \\u003c \u{202e}";

/// A ball whose title, meanings, messages and drawing are that text.
const MODEL: &str = r#"from codegen.model import *

model = Model("Ball " + TEXT, source="Source " + TEXT)
h0 = model.parameter("h0", "m", 0.5, "height " + TEXT, above=0)
m = model.parameter("m", "kg", 1.0, "mass " + TEXT, above=0)
e = model.parameter("e", "1", 0.8, "restitution " + TEXT, minimum=0, maximum=1)
g = model.parameter("g", "m/s^2", 9.81, "gravity " + TEXT, minimum=0)
kind = model.choice("kind", ("plain", "other"), "kind " + TEXT)
h = model.coordinate("h", "m", "height " + TEXT, minimum=0)
s = model.discrete("s", (1, -1), "state " + TEXT)
model.gravity(g)
model.point_mass(m, position=(0, h))
flies = model.mode("flies", "flight " + TEXT)
rests = model.mode("rests", "floor " + TEXT, freeze=[(h, 0)])
model.transition("impact", flies, flies, when=falls(h), impact=True, reset=[(h, 0), (h.rate, -e * h.rate)])
model.transition("take_off", rests, flies, when=falls(rests.reaction(h)))
model.rest(flies, rests)
model.output("twice", "m", 2 * h, "double " + TEXT)
model.limit("high " + TEXT, "message " + TEXT, when=2 * h > h0, ends=False)
model.valid(h < h0, "sentence " + TEXT)
model.draw("floor " + TEXT, [(-1, 0), (1, 0)], kind="fixed")
model.draw("ball " + TEXT, [(0, h)], kind="point")
model.draw("lowest " + TEXT, [(0, h)], kind="contact", force=(None, h), states=[(rests, "closed")])
"#;

#[test]
fn texts_of_a_model_folder_are_text_in_pages_and_pictures() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    fs::create_dir(home.join("evil")).unwrap();
    // A string of JSON is one of Python, too.
    let text = serde_json::to_string(TEXT).unwrap();
    let model = MODEL.replacen("\n\n", &format!("\n\nTEXT = {text}\n\n"), 1);
    fs::write(home.join("evil/model.py"), model).unwrap();
    let scene =
        serde_json::json!({ "model": "./evil", "title": TEXT, "initial": { "h": 1 }, "end": 0.8 });
    fs::write(home.join("scene.json"), scene.to_string()).unwrap();
    let mut arguments = vec!["run", "scene.json", "--html", "page.html", "--out", "out"];
    if cfg!(feature = "png-pdf") {
        arguments.extend(["--plot-format", "svg,png,pdf"]);
    }
    ends_with(0, home, &arguments);
    let read = |name: &str| fs::read_to_string(home.join(name)).unwrap();
    let page = read("page.html");
    assert!(!page.contains("<script>hacked") && !page.contains("<img"));
    // Pictures are judged by a parser of XML: that of the browser.
    let pictures: Vec<String> = names(&home.join("out"))
        .iter()
        .filter(|name| name.ends_with(".svg"))
        .map(|name| read(&format!("out/{name}")))
        .collect();
    assert_eq!(pictures.len(), 2);
    let pictures = serde_json::to_string(&pictures).unwrap();
    let pictures = pictures.replace('<', "\\u003c");
    let text = serde_json::to_string(TEXT).unwrap().replace('<', "\\u003c");
    let script = format!(
        "const {{ show, motion, zoomGroup, plots }} = dalembert;
        document.getElementById('with-forces').click();
        for (const t of [0.1, 0.5, 0.8]) show(t);
        zoomGroup(plots[0], [0.1, 0.3], null);
        const xml = {pictures}.map((text) => new DOMParser().parseFromString(text, 'image/svg+xml'));
        const whole = xml.filter((picture) => !picture.querySelector('parsererror, script, img'));
        const plain = (text) => text.replace(/\\s+/g, ' ').trim(), text = plain({text});
        const words = plain(document.body.textContent);
        setTimeout(() => done([`hacked ${{window.hacked}}`, `pictures ${{whole.length}}`, `title ${{whole.some((p) => plain(p.documentElement.textContent).includes(text))}}`,
            `images ${{document.images.length}}`, ...['height', 'mass', 'double', 'message', 'sentence'].map((of) => `${{of}} ${{words.includes(`${{of}} ${{text}}`)}}`),
            `drawn ${{motion.drawing.shapes.every((shape) => plain(shape.name).endsWith(text))}}`]), 100);"
    );
    if let Some(seen) = in_browser(home, &[page], &script) {
        let expected = [
            "hacked undefined",
            "pictures 2",
            "title true",
            "images 0",
            "height true",
            "mass true",
            "double true",
            "message true",
            "sentence true",
            "drawn true",
        ];
        assert_eq!(seen[0], expected);
    }
}

#[test]
fn names_are_refused_where_they_are_more_than_names() {
    let home = tempfile::tempdir().unwrap();
    fs::create_dir(home.path().join("evil")).unwrap();
    let scene = r#"{ "model": "./evil" }"#;
    fs::write(home.path().join("scene.json"), scene).unwrap();
    let plain = MODEL.replace(" + TEXT", "");
    for (name, hostile, words) in [
        ("\"twice\"", "\"<b>\"", "`<b>` is not a name for a output"),
        ("\"flies\"", "\"a&b\"", "`a&b` is not a name for a mode"),
        ("\"impact\"", "\"'\"", "`'` is not a name for a transition"),
        ("\"h0\"", "\"\\u2028\"", "is not a name for a parameter"),
        ("\"double \"", "\"\\x1b[31m\"", "holds U+001B"),
        ("\"lowest \"", "\"\\ue000\"", "holds U+E000"),
    ] {
        let model = plain.replacen(name, hostile, 1);
        assert_ne!(model, plain, "{name}");
        fs::write(home.path().join("evil/model.py"), model).unwrap();
        let output = ends_with(2, home.path(), &["check", "evil"]);
        let said = format!("{}{}", stdout(&output), stderr(&output));
        assert!(said.contains(words), "{said}");
    }
}
