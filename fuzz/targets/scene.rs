//! Scenes: any text.
#![no_main]

use dalembert_fuzz::{TABLE, read_and_run};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &[u8]| read_and_run(text, &[], TABLE));
