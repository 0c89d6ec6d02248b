//! Builds the models: see `codegen/build/lib.rs`.

fn main() {
    dalembert_build::models();
}
