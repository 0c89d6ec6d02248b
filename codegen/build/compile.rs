//! From C to static libraries: one for each model, and, in the engine, one for the functions that all models call.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::cache::{Cache, Compares, Kind};
use super::error::Error;
use super::fingerprint::Fingerprint;
use super::generate::Generated;
use super::generator::Generator;
use super::owner::Owner;
use super::{parallel, registry};

/// Variable that has the C compiled with sanitizers of addresses and undefined behaviour: `.ci/sanitize`.
pub const SANITIZE: &str = "DALEMBERT_SANITIZE";

/// Kind of the entries that hold libraries, in the package's own output folder.
const KIND: Kind = Kind {
    name: "libraries",
    compares: Compares::Digests,
};

/// C of the generator that generated code and the crate call, and for lanes; what they include.
const ELEMENTARY: [&str; 3] = ["elementary.c", "ranges.c", "sums.c"];
const LANES: &str = "lanes.c";
const INCLUDED: [&str; 4] = ["contract.h", "elementary.h", "lanes.h", "vectors.h"];

/// A level of the processor, with the width of its registers: see `codegen/lanes.h`.
pub struct Level {
    pub name: &'static str,
    lanes: usize,
    flags: &'static [&'static str],
}

/// Levels of any processor, and of x86-64 alone; `LEVELS` in `codegen/emit_model.py` has their names.
const ANY: Level = Level {
    name: "v1",
    lanes: 2,
    flags: &[],
};
const X86_64: [Level; 2] = [
    Level {
        name: "v3",
        lanes: 4,
        flags: &["-mavx2"],
    },
    Level {
        name: "v4",
        lanes: 8,
        flags: &["-mavx512f", "-mavx512dq", "-mavx512vl"],
    },
];

/// What becomes a library.
struct Library {
    /// Its name for the linker.
    name: String,
    /// What the preprocessor is told.
    defines: Vec<(&'static str, String)>,
    /// Level of the processor, where it matters.
    level: Option<&'static Level>,
    /// Where its C comes from, relative to the project.
    origin: String,
    directory: PathBuf,
    sources: Vec<PathBuf>,
}

/// Compiles what changed and tells cargo to link all libraries.
///
/// A library is kept under the hash of its C files, the compiler and the flags, so that a model
/// that generated the same C as before is not compiled again.
pub fn compile(
    generator: &Generator,
    models: &[Generated],
    owner: &Owner,
    out_dir: &Path,
) -> Result<(), Error> {
    let of_model = |model: &Generated| Library {
        name: owner.symbol(&model.name),
        defines: Vec::new(),
        level: None,
        origin: model.folder.clone(),
        directory: model.directory.clone(),
        sources: model.sources.clone(),
    };
    // Apart from the functions, which may be the same for another digest.
    let tables = models.iter().map(|model| {
        let mut defines = vec![
            ("DALEMBERT_DIGEST", format!("\"{}\"", model.digest)),
            ("DALEMBERT_SYMBOL", registry::symbol(&model.name, owner)),
        ];
        if !model.lanes.is_empty() {
            defines.push(("DALEMBERT_WITH_LANES", "1".to_owned()));
        }
        Library {
            name: owner.symbol(&format!("{}_model", model.name)),
            sources: vec![model.tables.clone()],
            defines,
            ..of_model(model)
        }
    });
    let list = Library {
        // No model has this name, nor those of what all models call: a model's has no double underscore.
        name: owner.symbol("_models"),
        defines: Vec::new(),
        level: None,
        origin: "the list of the models".to_owned(),
        directory: out_dir.to_owned(),
        sources: vec![registry::write(models, owner, out_dir)?],
    };
    let elementary = Library {
        name: owner.symbol("_elementary"),
        defines: Vec::new(),
        level: None,
        origin: ELEMENTARY.join(", "),
        directory: generator.folder(),
        sources: ELEMENTARY.map(|file| generator.file(file)).into(),
    };
    let x86_64 = std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|arch| arch == "x86_64");
    let levels = || levels(x86_64);
    let with_lanes = models.iter().filter(|model| !model.lanes.is_empty());
    let lanes = with_lanes.map(|model| Library {
        name: owner.symbol(&format!("{}_lanes", model.name)),
        sources: model.lanes.clone(),
        ..of_model(model)
    });
    let elementary_lanes = Library {
        name: owner.symbol("_lanes"),
        defines: Vec::new(),
        level: None,
        origin: LANES.to_owned(),
        directory: generator.folder(),
        sources: vec![generator.file(LANES)],
    };
    // Crates that depend on the engine find in it what all models call.
    let is_engine = *owner == Owner::Engine;
    let lanes = lanes.chain(is_engine.then_some(elementary_lanes));
    let lanes = lanes.flat_map(|library| {
        levels().map(move |level| Library {
            name: format!("{}_{}", library.name, level.name),
            defines: Vec::new(),
            level: Some(level),
            origin: library.origin.clone(),
            directory: library.directory.clone(),
            sources: library.sources.clone(),
        })
    });
    // What others call comes after them on the command line of a linker.
    let all: Vec<_> = (std::iter::once(list).chain(tables))
        .chain(models.iter().map(of_model))
        .chain(lanes)
        .chain(is_engine.then_some(elementary))
        .collect();
    let build = compiler(cc::Build::new());
    let failed = |what: &str, problem: String| Error::Compiler {
        what: what.to_owned(),
        problem,
    };
    let command = command(&build).map_err(|problem| failed("the models", problem))?;
    let included = INCLUDED.map(|file| generator.file(file));
    let command = Fingerprint::default()
        .with(command)
        .with_files(&generator.folder(), included.iter().map(PathBuf::as_path))?;
    let libraries = Cache::at(out_dir);
    let compiled = parallel::map(&all, |library| {
        let flags = library.level.map_or(&[][..], |level| level.flags);
        let hash = command
            .clone()
            .with(flags.join(" "))
            .with(format!("{:?}", library.defines))
            .with_files(
                &library.directory,
                library.sources.iter().map(PathBuf::as_path),
            )?
            .finish();
        let key = format!("{}-{hash}", library.name);
        let entry = libraries.entry(KIND, &key, |folder| {
            let mut build = build.clone();
            if let Some(level) = library.level {
                level.set(&mut build);
            }
            for (name, value) in &library.defines {
                build.define(name, value.as_str());
            }
            build
                // Linked below, whether it was compiled now or before.
                .cargo_metadata(false)
                .files(&library.sources)
                .out_dir(folder)
                .try_compile(&library.name)
                .map_err(|error| {
                    failed(
                        &format!("the C code of {}", library.origin),
                        error.to_string(),
                    )
                })
        })?;
        Ok((key, entry.path))
    });
    if sanitizes() {
        for library in ["-lasan", "-lubsan"] {
            println!("cargo::rustc-link-arg={library}");
        }
    }
    let mut keys = Vec::new();
    for (library, result) in all.iter().zip(compiled) {
        let (key, folder) = result?;
        println!("cargo::rustc-link-search=native={}", folder.display());
        println!("cargo::rustc-link-lib=static={}", library.name);
        keys.push(key);
    }
    libraries.retain(KIND, &keys)
}

/// The compiler of `build`, with the flags of generated code. Generated code is the inner loop of every simulation: it is
/// optimised in every profile, in the same way, so that a debug build and a release build give the
/// same bits. For the same reason products and sums are not contracted (a fused multiply-add
/// changes the last bits, and with them the time of an event), and the code is not tuned to the
/// machine of the build.
pub fn compiler(mut build: cc::Build) -> cc::Build {
    build
        // Level 3 makes vectors of the independent sums of a Taylor series; it changes no bit.
        .opt_level(3)
        .debug(false)
        // Generated functions have one signature, whether or not they use every argument.
        .flag_if_supported("-Wno-unused-parameter");
    if sanitizes() {
        build
            .opt_level(1)
            .flag("-fsanitize=address,undefined")
            .flag("-fno-sanitize-recover=all")
            .flag("-fno-omit-frame-pointer");
    }
    // Not only if it is supported: without it other bits would come out, and nobody would know. Microsoft's compiler does not
    // contract unless it is asked to.
    if !build
        .try_get_compiler()
        .is_ok_and(|tool| tool.is_like_msvc())
    {
        build.flag("-ffp-contract=off");
    }
    build
}

/// Whether [`SANITIZE`] is set.
fn sanitizes() -> bool {
    std::env::var_os(SANITIZE).is_some_and(|value| !value.is_empty())
}

/// The compiler and its flags, once it is known to exist: otherwise the `cc` crate would warn once for every flag that it
/// cannot try.
fn command(build: &cc::Build) -> Result<String, String> {
    let mut plain = cc::Build::new();
    exists(plain.cargo_metadata(false).cargo_warnings(false))?;
    let tool = build
        .try_get_compiler()
        .map_err(|error| error.to_string())?;
    Ok(line(&tool))
}

/// The command line of a compiler, without the environment that is handed on to it.
pub fn line(tool: &cc::Tool) -> String {
    let words = std::iter::once(tool.path().as_os_str()).chain(tool.args().iter().map(|a| &**a));
    words
        .map(|word| word.to_string_lossy())
        .collect::<Vec<_>>()
        .join(" ")
}

/// The levels of a processor.
pub fn levels(x86_64: bool) -> impl Iterator<Item = &'static Level> {
    std::iter::once(&ANY).chain(X86_64.iter().filter(move |_| x86_64))
}

/// Whether there is a compiler.
pub fn exists(plain: &cc::Build) -> Result<(), String> {
    let found = plain
        .try_get_compiler()
        .map_err(|error| error.to_string())?;
    let program = found.path();
    let answer = Command::new(program).arg("--version").output();
    answer.map_err(|error| format!("{}: {error}", program.display()))?;
    Ok(())
}

impl Level {
    pub fn set(&self, build: &mut cc::Build) {
        build
            .define("DALEMBERT_LEVEL", format!("_{}", self.name).as_str())
            .define("DALEMBERT_LANES", self.lanes.to_string().as_str())
            // Both branches of a choice may be computed, of which a lane takes one.
            .flag_if_supported("-fno-trapping-math")
            // Roots of several numbers are one instruction, which tells no error.
            .flag_if_supported("-fno-math-errno")
            // No vector is passed between functions that are not inlined.
            .flag_if_supported("-Wno-psabi");
        for flag in self.flags {
            build.flag(flag);
        }
    }
}
