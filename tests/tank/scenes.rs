//! The scenes the tank is looked at in.

use dalembert::hybrid::Problem;
use dalembert::model::models;
use dalembert::scene::Scene;
use std::path::Path;

/// The shipped scenes of the tank.
pub const SCENES: [&str; 4] = [
    "tank_full_plate",
    "tank_doughnut",
    "tank_free_release",
    "tank_rocks_and_slides",
];

/// A shipped scene, changed by `path=value`.
pub fn scene(name: &str, overrides: &[&str]) -> Problem {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.json"));
    let overrides: Vec<String> = overrides.iter().map(|&o| o.into()).collect();
    match Scene::load(&path, &overrides, models()) {
        Ok(scene) => scene.problem,
        Err(errors) => panic!("{errors}"),
    }
}
