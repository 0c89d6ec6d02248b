//! Builds the models: see `codegen/build/lib.rs`. The style of pages comes from there, too.

use std::path::Path;

fn main() {
    let folder = std::env::var_os("OUT_DIR").expect("cargo sets it");
    let style = Path::new(&folder).join("page.css");
    std::fs::write(style, dalembert_build::PAGE_STYLE).expect("cargo's folder can be written");
    dalembert_build::models();
}
