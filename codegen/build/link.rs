//! From C to one shared library, with the compiler and the flags of the build script, and so the same bits.

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use super::compile::{self, Level};
use super::error::Error;
use super::fingerprint::Fingerprint;
use super::generate::Generated;
use super::generator::Generator;
use super::parallel;

/// What this crate was compiled for, and so what it compiles for.
pub const TARGET: &str = env!("DALEMBERT_BUILD_TARGET");

/// What the library exports, whatever its model is called.
const SYMBOL: &str = "dalembert_model";

/// Changes with the flags below and those in `compile.rs`, which a key cannot ask for without running the compiler.
const FLAGS: &str = "2";

/// Name of a model's library.
pub fn file(name: &str) -> String {
    format!(
        "{}{name}{}",
        env::consts::DLL_PREFIX,
        env::consts::DLL_SUFFIX
    )
}

/// The key of the library of derived code.
pub fn key(digest: &str, lanes: bool) -> String {
    let mut hash = Fingerprint::default()
        .with(digest)
        .with(FLAGS)
        .with(if lanes { "lanes" } else { "" });
    for (name, value) in settings() {
        hash = hash
            .with(name.as_encoded_bytes())
            .with(value.as_encoded_bytes());
    }
    for program in programs() {
        hash = hash.with(identity(&program));
    }
    hash.finish()
}

/// Variables by which the `cc` crate finds a compiler and its flags.
fn settings() -> Vec<(OsString, OsString)> {
    let mut found: Vec<_> = env::vars_os()
        .filter(|(name, _)| {
            let name = name.to_string_lossy();
            [
                "CC",
                "CFLAGS",
                "HOST_CC",
                "HOST_CFLAGS",
                "TARGET_CC",
                "TARGET_CFLAGS",
                "CRATE_CC_NO_DEFAULTS",
                compile::SANITIZE,
            ]
            .contains(&&*name)
                || name.starts_with("CC_")
                || name.starts_with("CFLAGS_")
        })
        .collect();
    found.sort();
    found
}

/// Programs that may be the compiler: what the variables name, or the system's.
fn programs() -> Vec<PathBuf> {
    let named = settings()
        .into_iter()
        .filter(|(name, _)| name.to_string_lossy().contains("CC"));
    let words: Vec<String> = named
        .flat_map(|(_, value)| {
            let value = value.to_string_lossy().into_owned();
            value
                .split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        })
        .collect();
    let words = if words.is_empty() {
        vec!["cc".to_owned()]
    } else {
        words
    };
    words.into_iter().filter_map(|word| search(&word)).collect()
}

/// A program on the search path.
fn search(word: &str) -> Option<PathBuf> {
    if word.contains('/') {
        return fs::canonicalize(word).ok();
    }
    let path = env::var_os("PATH")?;
    env::split_paths(&path).find_map(|folder| fs::canonicalize(folder.join(word)).ok())
}

/// What tells a compiler from another version of it, without running it: its file, size and time.
fn identity(program: &Path) -> String {
    let metadata = fs::metadata(program).ok();
    let time = metadata.as_ref().and_then(|m| m.modified().ok());
    let time = time.and_then(|t| t.duration_since(UNIX_EPOCH).ok());
    format!(
        "{} {:?} {time:?}",
        program.display(),
        metadata.map(|m| m.len())
    )
}

/// A file to compile.
struct Unit {
    source: PathBuf,
    level: Option<&'static Level>,
}

/// Makes the library in a folder.
pub fn library(
    generated: &Generated,
    generator: &Generator,
    lanes: bool,
    out: &Path,
) -> Result<(), Error> {
    let what = format!("the C code of {}", generated.folder);
    let missing = |problem: String| Error::Compiler {
        what: what.clone(),
        problem,
    };
    let objects = out.join("objects");
    fs::create_dir(&objects).map_err(Error::io("create", &objects))?;
    let mut plain = cc::Build::new();
    here(&mut plain, &objects);
    compile::exists(&plain).map_err(missing)?;
    let mut build = compile::compiler(plain);
    build
        .pic(true)
        // One name is enough, and no two models can meet.
        .flag("-fvisibility=hidden")
        .define("DALEMBERT_SYMBOL", SYMBOL)
        .define(
            "DALEMBERT_DIGEST",
            format!("\"{}\"", generated.digest).as_str(),
        );
    if lanes && !generated.lanes.is_empty() {
        build.define("DALEMBERT_WITH_LANES", "1");
    }
    let own = |source: &PathBuf| Unit {
        source: source.clone(),
        level: None,
    };
    let mut units: Vec<Unit> = generated.sources.iter().map(own).collect();
    units.push(own(&generated.tables));
    units.push(own(&generator.file("elementary.c")));
    if lanes {
        let x86_64 = TARGET.starts_with("x86_64");
        units.extend(generated.lanes.iter().flat_map(|source| {
            compile::levels(x86_64).map(|level| Unit {
                source: source.clone(),
                level: Some(level),
            })
        }));
    }
    let places: Vec<(usize, Unit)> = units.into_iter().enumerate().collect();
    let run = |build: &cc::Build, arguments: &[&std::ffi::OsStr]| -> Result<(), Error> {
        let tool = build
            .try_get_compiler()
            .map_err(|error| missing(error.to_string()))?;
        let mut command = tool.to_command();
        command.args(arguments);
        let output = (command.output()).map_err(Error::io("run", tool.path()))?;
        if output.status.success() {
            return Ok(());
        }
        let words: Vec<_> = arguments.iter().map(|a| a.to_string_lossy()).collect();
        Err(Error::Refused {
            what: what.clone(),
            command: format!("{} {}", compile::line(&tool), words.join(" ")),
            output: String::from_utf8_lossy(&output.stderr).into_owned(),
            kept: generated.directory.clone(),
        })
    };
    let compiled = parallel::map(&places, |(place, unit)| {
        let object = objects.join(format!("{place}.o"));
        let mut build = build.clone();
        if let Some(level) = unit.level {
            level.set(&mut build);
        }
        run(
            &build,
            &[
                "-c".as_ref(),
                unit.source.as_ref(),
                "-o".as_ref(),
                object.as_ref(),
            ],
        )?;
        Ok(object)
    });
    let compiled = compiled.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let library = out.join(file(&generated.name));
    let mut arguments: Vec<&std::ffi::OsStr> =
        vec!["-shared".as_ref(), "-o".as_ref(), library.as_ref()];
    arguments.extend(compiled.iter().map(|object| object.as_os_str()));
    arguments.push("-lm".as_ref());
    if TARGET.contains("linux") {
        // What is missing is told now, not when it is loaded.
        arguments.push("-Wl,-z,defs".as_ref());
    }
    run(&build, &arguments)?;
    fs::remove_dir_all(&objects).map_err(Error::io("remove", &objects))
}

/// Has the `cc` crate work without cargo.
fn here<'a>(build: &'a mut cc::Build, out: &Path) -> &'a mut cc::Build {
    build
        .target(TARGET)
        .host(TARGET)
        .out_dir(out)
        .opt_level(3)
        .debug(false)
        .cargo_metadata(false)
        .cargo_warnings(false)
}
