//! A small project on which the real build script runs: two models, a stand-in for the generator,
//! and a lock file that pins a stand-in for CasADi, offered in a folder of wheels. Nothing is
//! downloaded.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use tempfile::TempDir;

/// The interpreter with which the crate itself was built.
pub const PYTHON: &str = env!("DALEMBERT_PYTHON_EXE");

/// The version of the stand-in for CasADi.
pub const VERSION: &str = "1.2.3";

/// The project and everything around it.
pub struct Fixture {
    folder: TempDir,
}

/// What a run of the build script said.
#[derive(Debug)]
pub struct Outcome {
    /// Its instructions to cargo, without the errors.
    pub directives: Vec<String>,
    /// The lines of its error, which is all that cargo shows when it failed.
    pub errors: String,
}

impl Fixture {
    /// A project, if the interpreter has pip to install something for it. (One that was named by
    /// DALEMBERT_PYTHON needs no pip to build the crate, and then there is nothing to test.)
    pub fn if_pip() -> Option<Self> {
        let pip = Command::new(PYTHON)
            .args(["-m", "pip", "--version"])
            .output();
        pip.is_ok_and(|output| output.status.success())
            .then(Self::new)
    }

    /// A project with the models `alpha` and `beta`, and nothing built.
    pub fn new() -> Self {
        let fixture = Self {
            folder: TempDir::new().unwrap(),
        };
        fixture.write("project/build.rs", "");
        fixture.write("project/codegen/__main__.py", include_str!("generator.py"));
        for (name, text) in [
            ("elementary.c", include_str!("../../codegen/elementary.c")),
            ("contract.h", include_str!("../../codegen/contract.h")),
            ("elementary.h", include_str!("../../codegen/elementary.h")),
            ("lanes.c", include_str!("../../codegen/lanes.c")),
            ("lanes.h", include_str!("../../codegen/lanes.h")),
            ("ranges.c", include_str!("../../codegen/ranges.c")),
            ("sums.c", include_str!("../../codegen/sums.c")),
            ("vectors.h", include_str!("../../codegen/vectors.h")),
        ] {
            fixture.write(&format!("project/codegen/{name}"), text);
        }
        fixture.model("alpha", "1.0");
        fixture.model("beta", "2.0");
        fs::create_dir_all(fixture.path("wheels")).unwrap();
        let hash = fixture.wheel(VERSION);
        fixture.lock(&hash);
        fixture.program("bin/python3", &format!("exec '{PYTHON}' \"$@\""));
        // Cargo marks its target directory so.
        fixture.write("target/CACHEDIR.TAG", "");
        fixture.write("home/.profile", "");
        fixture
    }

    /// A path inside the fixture.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file, and the folders on the way.
    pub fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, text).unwrap();
        path
    }

    /// Writes a model whose generated C function returns `value`.
    pub fn model(&self, name: &str, value: &str) {
        self.write(&format!("project/models/{name}/model.py"), value);
    }

    /// Writes a lock file that pins the stand-in by a hash.
    pub fn lock(&self, hash: &str) {
        let text = format!("casadi=={VERSION} \\\n    --hash=sha256:{hash}\n");
        self.write("project/codegen/requirements.lock", &text);
    }

    /// Puts a stand-in for CasADi into the folder of wheels and returns its hash.
    pub fn wheel(&self, version: &str) -> String {
        let output = Command::new(PYTHON)
            .args(["-c", include_str!("wheel.py")])
            .args([self.path("wheels").as_os_str(), version.as_ref()])
            .output()
            .unwrap();
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    }

    /// Writes a shell script that can be run.
    pub fn program(&self, name: &str, body: &str) -> PathBuf {
        let path = self.write(name, &format!("#!/bin/sh\n{body}\n"));
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        path
    }

    /// An interpreter that has a stand-in for CasADi of its own, and no other package.
    pub fn python_with_casadi(&self, version: &str) -> PathBuf {
        let packages = format!("packages-{version}");
        self.write(
            &format!("{packages}/casadi/__init__.py"),
            &format!("__version__ = '{version}'"),
        );
        let packages = self.path(&packages);
        self.program(
            &format!("python-with-casadi-{version}"),
            &format!(
                "PYTHONPATH='{}' exec '{PYTHON}' -S \"$@\"",
                packages.display()
            ),
        )
    }

    /// The build script, in the environment that cargo gives it, with an interpreter that has the
    /// stand-in for CasADi.
    pub fn script(&self) -> Command {
        let mut command = self.installing();
        command.env("DALEMBERT_PYTHON", self.python_with_casadi(VERSION));
        command
    }

    /// The build script, when it has to find an interpreter and to install the stand-in.
    pub fn installing(&self) -> Command {
        let mut command = Command::new(env!("DALEMBERT_BUILD_SCRIPT"));
        let search_path = std::env::var("PATH").unwrap();
        command
            .current_dir(self.path("project"))
            .env_clear()
            .env("CARGO_MANIFEST_DIR", self.path("project"))
            .env("CARGO_MANIFEST_LINKS", "dalembert")
            .env("CARGO_FEATURE_SHIPPED_MODELS", "1")
            .env("DALEMBERT_GENERATOR", self.path("project/codegen"))
            .env("TARGET", env!("DALEMBERT_TARGET"))
            .env("HOST", env!("DALEMBERT_TARGET"))
            .env("OPT_LEVEL", "0")
            .env("DEBUG", "false")
            .env("NUM_JOBS", "2")
            .env(
                "PATH",
                format!("{}:{search_path}", self.path("bin").display()),
            )
            .env("HOME", self.path("home"))
            .env("PIP_NO_INDEX", "1")
            .env("PIP_FIND_LINKS", self.path("wheels"))
            .env("PROVISIONING_LOG", self.path("log"));
        self.out_dir(&mut command, "target");
        command
    }

    /// The build script of another crate, as [`Fixture::script`], which depends on the engine that the script belongs to.
    pub fn script_of_crate(&self, name: &str, version: &str) -> Command {
        let told = succeeds(&mut self.script()).directives;
        self.log();
        let told = |key: &str| {
            let prefix = format!("cargo::metadata={key}=");
            let found = told.iter().find_map(|line| line.strip_prefix(&prefix));
            found.expect("the engine tells it").to_owned()
        };
        let mut command = self.script();
        command
            .env_remove("CARGO_MANIFEST_LINKS")
            .env("CARGO_PKG_NAME", name)
            .env("CARGO_PKG_VERSION", version)
            .env("DEP_DALEMBERT_VERSION", told("version"))
            .env("DEP_DALEMBERT_CONTRACT", told("contract"));
        self.out_dir(&mut command, "target-of-crate");
        command
    }

    /// Takes Python from a build script, and what it has cached.
    pub fn without_python(&self, command: &mut Command) {
        let tools = self.path("tools");
        fs::create_dir_all(&tools).unwrap();
        let path = std::env::var_os("PATH").unwrap();
        for name in ["cc", "ar", "as", "ld", "ld.mold"] {
            let found = std::env::split_paths(&path).map(|folder| folder.join(name));
            if let Some(file) = found.into_iter().find(|file| file.exists()) {
                let _ = std::os::unix::fs::symlink(file, tools.join(name));
            }
        }
        command
            .env_remove("DALEMBERT_PYTHON")
            .env("PATH", tools)
            .env("DALEMBERT_CACHE", self.path("no-cache"));
    }

    /// Lets the build script write below another target directory.
    pub fn out_dir(&self, command: &mut Command, target: &str) {
        let out_dir = self.path(target).join("debug/build/project/out");
        fs::create_dir_all(&out_dir).unwrap();
        command.env("OUT_DIR", out_dir);
    }

    /// The generated list of models.
    pub fn models(&self) -> String {
        fs::read_to_string(self.path("target/debug/build/project/out/models.c")).unwrap()
    }

    /// What was installed and generated since the last call, sorted.
    pub fn log(&self) -> Vec<String> {
        let log = self.path("log");
        let text = fs::read_to_string(&log).unwrap_or_default();
        let _ = fs::remove_file(log);
        let mut lines: Vec<_> = text.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    }
}

/// Starts the build script.
pub fn start(command: &mut Command) -> Child {
    command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Waits for the build script.
pub fn finish(child: Child) -> Outcome {
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    // On any other end cargo would show the whole output instead of the message.
    assert!(output.status.success(), "{}: {stderr}", output.status);
    assert_eq!(stderr, "");
    let mut outcome = Outcome {
        directives: Vec::new(),
        errors: String::new(),
    };
    for line in String::from_utf8(output.stdout).unwrap().lines() {
        match line.strip_prefix("cargo::error=") {
            Some(error) => outcome.errors += &format!("{error}\n"),
            None => outcome.directives.push(line.to_owned()),
        }
    }
    outcome
}

/// Runs the build script, which succeeds.
pub fn succeeds(command: &mut Command) -> Outcome {
    let outcome = finish(start(command));
    assert_eq!(outcome.errors, "");
    outcome
}

/// Runs the build script, which fails; returns its message.
pub fn fails(command: &mut Command) -> String {
    let outcome = finish(start(command));
    assert_ne!(outcome.errors, "", "{:?}", outcome.directives);
    outcome.errors
}

/// The only entry of a folder whose name begins with `prefix` and which is a folder.
pub fn only_folder(folder: &Path, prefix: &str) -> PathBuf {
    let found: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .filter(|path| {
            path.file_name()
                .unwrap()
                .to_str()
                .unwrap()
                .starts_with(prefix)
        })
        .collect();
    assert_eq!(found.len(), 1, "{found:?}");
    found[0].clone()
}
