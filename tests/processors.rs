//! Generated C gives the same bits whichever instructions the compiler may use.
#![cfg(all(target_arch = "x86_64", unix))]

use std::path::Path;
use std::process::Command;

/// Runs a command and returns what it printed.
fn output(command: &mut Command) -> String {
    let output = command.output().expect("the command can be started");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}\n{errors}");
    String::from_utf8(output.stdout).expect("text")
}

/// Prints the bits of the Taylor series of the rocking block's motion, of sums by a table, of ranges, and of sines
/// and cosines.
const MAIN: &str = r#"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
static void print(const char *what, const double *x, int n) {
  for (int i = 0; i < n; ++i) {
    uint64_t bits;
    memcpy(&bits, x + i, sizeof bits);
    printf("%s %d %016" PRIx64 "\n", what, i, bits);
  }
}
void dalembert_triangular_sums(size_t n, const double *factors, const double *table, double *out);
void dalembert_ranges(size_t free, size_t count, const double *q, const double *v, const double *a, double tau,
                      double *middles, double *radii);
int main(void) {
  enum { ORDER = 34, ROWS = 36 };
  for (int n = 1; n <= ROWS; ++n) {
    double factors[ROWS], table[ROWS * ROWS] = {0.0}, out[ROWS];
    for (int k = 0; k < n; ++k) {
      factors[k] = 1.0 / (3.0 + k) - 0.1;
      for (int j = k; j < n; ++j) table[n * k + j] = 1.0 / (1.0 + k + 2.0 * j);
    }
    dalembert_triangular_sums(n, factors, table, out);
    print("sums", out, n);
  }
  for (int i = 0; i < 50; ++i) {
    double q[ROWS] = {0.17 - 0.003 * i}, v[ROWS] = {0.3 + 0.01 * i}, a[ROWS] = {0.0}, u[3 * ROWS], w[1024], out[2];
    double p[8] = {0.25, 1.5, 1.0, 0.9, 9.81, 1.0, 1.0, 1.0}, c[256], d[1] = {1.0}, h[8] = {0.0};
    for (int k = 0; k < 3 * ROWS; ++k) u[k] = 1.0 / (3.0 + k + i);
    struct dalembert_angle angles[4] = {{0.0, {0.0, 1.0}}, {0.0, {0.0, 1.0}}, {0.0, {0.0, 1.0}}, {0.0, {0.0, 1.0}}};
    const struct dalembert_context x = {u, u, d, h, c, a, angles};
    dalembert_rocking_block_constants(p, p, p, &x, c);
    dalembert_rocking_block_base_open_series_start(q, v, a, u, &x, w, out);
    double inverse = 1.0 / out[0];
    a[0] = v[1] = -inverse * out[1];
    q[1] = v[0];
    q[2] = 0.5 * a[0];
    dalembert_rocking_block_base_open_series_run(ORDER, q, v, a, u, &x, w, &inverse);
    print("q", q, ORDER + 2);
    print("a", a, ORDER);
    double middles[3], radii[3];
    dalembert_ranges(1, ORDER + 2, q, v, a, 0.01 * i, middles, radii);
    print("middles", middles, 3);
    print("radii", radii, 3);
  }
  for (double x = 1e-4; x < 1e100; x *= 1.7) {
    const struct dalembert_sin_cos y = dalembert_sin_cos(x);
    print("sin", &y.sin, 1);
    print("cos", &y.cos, 1);
  }
  return 0;
}
"#;

#[test]
fn the_bits_do_not_depend_on_the_instructions() {
    let project = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().unwrap();
    let mut generate = Command::new(env!("DALEMBERT_PYTHON_EXE"));
    if !env!("DALEMBERT_PYTHON_PATH").is_empty() {
        generate.env("PYTHONPATH", env!("DALEMBERT_PYTHON_PATH"));
    }
    generate
        .current_dir(project)
        .args(["-B", "-m", "codegen", "generate", "--model-dir"])
        .arg("models/rocking_block")
        .arg("--out")
        .arg(folder.path());
    output(&mut generate);
    let others =
        ["elementary.c", "ranges.c", "sums.c"].map(|file| project.join("codegen").join(file));
    let model = folder.path().join("rocking_block/rocking_block.c");
    let main = folder.path().join("main.c");
    std::fs::write(&main, format!("#include {model:?}\n{MAIN}")).unwrap();

    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let processors = [
        ("x86-64", true),
        ("x86-64-v3", is_x86_feature_detected!("avx2")),
        ("x86-64-v4", is_x86_feature_detected!("avx512f")),
    ];
    let mut all = Vec::new();
    for (name, _) in processors.iter().filter(|(_, present)| *present) {
        for level in ["-O0", "-O3"] {
            let program = folder.path().join(format!("{name}{level}"));
            let mut compile = Command::new(&compiler);
            // As in codegen/build/compile.rs.
            compile
                .args([level, "-ffp-contract=off", &format!("-march={name}"), "-o"])
                .args([&program, &main])
                .args(&others)
                .arg("-lm");
            output(&mut compile);
            all.push(output(&mut Command::new(program)));
        }
    }
    assert!(all[0].lines().count() > 2000);
    for other in &all[1..] {
        assert!(all[0] == *other, "the bits differ");
    }
}
