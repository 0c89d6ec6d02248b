//! What each model under `models/` comes with.

use std::fs;
use std::path::Path;

use dalembert::model::models;
use serde_json::Value;

#[test]
fn every_shipped_model_has_a_page_a_scene_and_a_drawing() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let entries = |folder: &str| {
        let entries = fs::read_dir(project.join(folder)).unwrap();
        entries.map(|entry| entry.unwrap().path())
    };
    let scenes = entries("scenes").filter(|path| path.extension().is_some_and(|e| e == "json"));
    let of_scenes: Vec<String> = scenes
        .map(|path| {
            let scene: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
            scene["model"].as_str().unwrap().to_owned()
        })
        .collect();
    let folders = entries("models").filter(|path| path.join("model.py").is_file());
    let mut seen = 0;
    for folder in folders {
        let name = folder.file_name().unwrap().to_str().unwrap();
        assert!(folder.join("README.md").is_file(), "{name} has no page");
        assert!(
            of_scenes.iter().any(|model| model == name),
            "{name} has no scene"
        );
        let model = models().find(name).unwrap();
        for variant in &model.variants {
            assert!(
                !variant.drawing.is_empty(),
                "{name} draws nothing with {:?}",
                variant.options
            );
        }
        seen += 1;
    }
    assert!(seen >= 15, "{seen} models");
}
