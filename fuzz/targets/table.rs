//! Tables: any bytes as the table of a scene, read in one of three ways, and as a ground-motion record.
#![no_main]

use dalembert::motion;
use dalembert_fuzz::read_and_run;
use libfuzzer_sys::fuzz_target;

const INTERPOLATIONS: [&str; 3] = ["linear", "cubic", "previous"];

fuzz_target!(|bytes: &[u8]| {
    for interpolation in INTERPOLATIONS {
        let table = format!(
            r#"{{ "file": "table", "interpolation": "{interpolation}", "outside": "hold" }}"#
        );
        let scene = format!(
            r#"{{ "model": "sliding_oscillator", "inputs": {{ "ground_acceleration": {{ "table": {table} }} }}, "end": 1 }}"#
        );
        read_and_run(scene.as_bytes(), &[], bytes);
    }
    if let Ok(text) = motion::decode(bytes) {
        let _ = motion::read(&text, &Default::default());
    }
});
