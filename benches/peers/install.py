"""How each peer is installed and built in the scratch folder, and the command that runs it."""

import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SUNDIALS = "sundials-sys-0.6.2"  # a Rust crate with the sources of SUNDIALS 7.1
SUNDIALS_LIBRARIES = ["cvode", "arkode", "nvecserial", "sunmatrixdense", "sunlinsoldense", "sunnonlinsolfixedpoint", "sunnonlinsolnewton", "sunmatrixband", "core"]
CXX = ["g++", "-O3", "-march=native", "-std=c++20"]


def call(command, **more):
    print("+", " ".join(map(str, command)), file=sys.stderr, flush=True)
    subprocess.run(list(map(str, command)), check=True, **more)


class Peers:
    """A method for each peer of `RUNNABLE`: it builds what is missing or older than its sources, and returns
    the command to which the names of problems are added."""

    def __init__(self, scratch, floor=None):
        self.scratch = scratch
        self.floor_source = floor
        self.python = scratch / "venv" / "bin" / "python"
        self.tank = scratch / "tank"
        self.ready = set()

    def once(self, step):
        """Whether a step that several peers need is still to be done in this run."""
        new = step not in self.ready
        self.ready.add(step)
        return new

    def venv(self):
        if self.once("venv"):
            if not self.python.exists():
                call([sys.executable, "-m", "venv", self.scratch / "venv"])
            call([self.python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"])

    def walking_tank(self):
        if self.once("tank"):
            self.venv()
            call([self.python, "-B", HERE / "tank.py", self.tank])

    def sundials(self):
        self.walking_tank()
        prefix = self.scratch / "sundials"
        if not (prefix / "lib" / "libsundials_arkode.a").exists():
            # The crate is only fetched, not built.
            project = self.scratch / "sundials-source"
            (project / "src").mkdir(parents=True, exist_ok=True)
            (project / "src" / "lib.rs").touch()
            name, version = SUNDIALS.rsplit("-", 1)
            (project / "Cargo.toml").write_text(f'[package]\nname = "source"\nversion = "0.0.0"\nedition = "2021"\n[workspace]\n[dependencies]\n{name} = "={version}"\n')
            call(["cargo", "vendor", "--quiet", project / "vendor"], cwd=project, stdout=subprocess.DEVNULL)
            cmake = self.python.parent / "cmake"
            build = self.scratch / "sundials-build"
            off = [f"-D{o}=OFF" for o in ("BUILD_SHARED_LIBS", "EXAMPLES_ENABLE_C", "EXAMPLES_INSTALL", "BUILD_IDA", "BUILD_IDAS", "BUILD_KINSOL", "BUILD_CVODES")]
            call([cmake, "-S", project / "vendor" / name / "vendor", "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_C_FLAGS_RELEASE=-O3 -march=native -DNDEBUG",
                  f"-DCMAKE_INSTALL_PREFIX={prefix}", "-DCMAKE_INSTALL_LIBDIR=lib", *off])
            call([cmake, "--build", build, "--parallel", "--target", "install"])
        program = self.scratch / "sundials_rows"
        libraries = [prefix / "lib" / f"libsundials_{name}.a" for name in SUNDIALS_LIBRARIES]
        call([*CXX, "-I", prefix / "include", "-I", self.tank, HERE / "sundials.cpp", "-o", program, *libraries, self.tank / "libtank.a", "-lm"])
        return [program]

    def floor(self):
        program = self.scratch / "floor_rows"
        call([*CXX, self.floor_source, "-o", program])
        return [program]

    def fortran(self):
        self.walking_tank()
        if not list(pathlib.Path("/usr/lib").glob("*/libsiconos_externals.so*")):
            # A list of yesterday may name versions that are gone.
            call(["apt-get", "update"])
            call(["apt-get", "install", "-y", "--no-install-recommends", "libsiconos-kernel-dev"])
        program = self.scratch / "fortran_rows"
        call([*CXX, "-I", self.tank, HERE / "fortran.cpp", "-o", program, self.tank / "libtank.a", "-lsiconos_externals"])
        return [program]

    def heyoka(self):
        self.walking_tank()
        library = self.tank / "libtank_events.so"
        call([*CXX, "-shared", "-fPIC", "-I", self.tank, HERE / "tank_events.cpp", self.tank / "libtank.a", "-o", library])
        os.environ["PEERS_TANK"] = str(library)
        return [self.python, "-B", HERE / "heyoka_rows.py"]

    def casadi(self):
        self.venv()
        return [self.python, "-B", HERE / "casadi_rows.py"]

    def crates(self):
        """The program with the Rust peers."""
        target = self.scratch / "crates-target"
        if self.once("crates"):
            self.walking_tank()
            call([*CXX, "-I", self.tank, "-c", HERE / "crates" / "problems.cpp", "-o", self.tank / "problems.o"])
            (self.tank / "libproblems.a").unlink(missing_ok=True)
            call(["ar", "rcs", self.tank / "libproblems.a", self.tank / "problems.o"])
            environment = os.environ | {"PEERS_LIBRARIES": str(self.tank), "CARGO_TARGET_DIR": str(target), "RUSTFLAGS": "-C target-cpu=native"}
            call(["cargo", "build", "--release", "--locked"], cwd=HERE / "crates", env=environment)
        return target / "release" / "peers"

    def diffsol(self):
        return [self.crates(), "diffsol"]

    def ivp(self):
        return [self.crates(), "ivp"]

    def heyoka_ensemble(self):
        self.venv()
        return [self.python, "-B", HERE / "heyoka_ensemble.py"]

    def dalembert(self):
        return self.bench("peers")

    def dalembert_ensemble(self):
        return [*self.bench("ensemble"), "pendulums", "--rows"]

    def bench(self, name):
        # As it is delivered, for every processor: built for this one, as the peers are, it is no faster.
        os.environ |= {"CARGO_TARGET_DIR": str(self.scratch / "target")}
        call(["cargo", "bench", "--no-run", "--bench", name], cwd=ROOT)
        return ["cargo", "bench", "--quiet", "--bench", name, "--"]


RUNNABLE = ["sundials", "fortran", "heyoka", "casadi", "diffsol", "ivp", "dalembert"]
