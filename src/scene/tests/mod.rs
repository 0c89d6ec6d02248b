//! Scenes of the generated models, right and wrong.

mod errors;
mod inputs;
mod mutation;
mod overrides;
mod records;
mod states;
mod values;

use std::io;
use std::path::Path;

use super::{Scene, SceneError, SceneErrors};
use crate::model::models;

/// Reads a scene called `scenes/test.json`, with some tables beside it.
fn parse_with(
    text: &[u8],
    overrides: &[&str],
    tables: &[(&str, &[u8])],
) -> Result<Scene, SceneErrors> {
    let files = |path: &Path| -> io::Result<Vec<u8>> {
        let table = tables
            .iter()
            .find(|(name, _)| path == Path::new("scenes").join(name));
        table
            .map(|(_, bytes)| bytes.to_vec())
            .ok_or(io::ErrorKind::NotFound.into())
    };
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    Scene::parse(
        text,
        Path::new("scenes/test.json"),
        &overrides,
        models(),
        &files,
    )
}

fn parse(text: &str) -> Result<Scene, SceneErrors> {
    parse_with(text.as_bytes(), &[], &[])
}

/// The option that a scene gets for a choice of its model.
fn option(scene: &Scene, choice: &str) -> &'static str {
    let choices = &scene.problem.model.choices;
    let index = choices.iter().position(|c| c.name == choice);
    scene.problem.variant().options[index.expect("a choice of the model")]
}

/// The only error of a scene.
fn only_error(result: Result<Scene, SceneErrors>) -> SceneError {
    let errors = result.expect_err("this scene is wrong");
    let all: Vec<_> = errors.iter().collect();
    assert_eq!(all.len(), 1, "{errors}");
    all[0].clone()
}

/// A scene that uses most of the format.
const FULL: &str = r#"{
  "$schema": "scene.schema.json",
  "model": "walking_tank",
  "title": "Full plate, 20 m/s² at 7 Hz",
  "parameters": { "set": "doughnut", "mu_s": 0.6, "mu_k": "50 %", "R_0": "280 mm" },
  "rules": "reactions",
  "landing": "velocities",
  "inputs": {
    "ground_acceleration": {
      "sum": [
        { "sine": { "amplitude": "2 g_n", "frequency": 7.0, "phase": "90 deg", "start": 0.5, "cycles": 3 } },
        { "knots": [[0, 0], ["500 ms", 1.5], [1, 0]], "interpolation": "cubic" },
        { "table": { "file": "record.csv", "interpolation": "previous", "scale": 2 } },
        { "constant": 0.25 }
      ]
    }
  },
  "initial": { "mode": "rocks_sticks", "theta": 0.02, "theta.rate": -0.1, "side": -1 },
  "freeze": ["x"],
  "end": { "time": 2.0, "after": { "landing": 30 } },
  "accuracy": { "relative": 1e-9, "absolute": { "theta": 1e-12, "x_I.rate": "1 mm/s" } },
  "record": { "every": 0.001, "energies": false }
}"#;

const RECORD: &str = "time,acceleration\n0.0, 1.0\n0.25,-1.0\n0.5,0\n";
