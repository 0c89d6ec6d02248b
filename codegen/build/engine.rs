//! What the engine's build tells the crates that depend on it, and whether this crate fits the engine.
//!
//! Cargo hands `cargo::metadata` of a crate with `links` to the build scripts of those that depend on it, as variables.

use std::env;
use std::fmt;

use super::error::Error;
use super::generator::Bundle;

/// Version of this crate, and of the engine that it builds for.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What the line of contract.h with its version begins with.
const CONTRACT_LINE: &str = "#define DALEMBERT_CONTRACT_VERSION ";

/// The contract between compiled models and the engine.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Contract {
    version: u32,
    /// Of the whole header.
    digest: String,
}

impl Contract {
    /// That of the models which a generator makes.
    pub fn of(generator: &Bundle) -> Result<Self, Error> {
        let (text, digest) = generator.text("contract.h");
        let version = text.lines().find_map(|line| {
            let number = line.strip_prefix(CONTRACT_LINE)?;
            number.trim().parse().ok()
        });
        let version = version.ok_or(Error::NoContract {
            line: CONTRACT_LINE,
        })?;
        Ok(Self { version, digest })
    }

    /// Tells the crates that depend on the engine, whose build this is.
    pub fn tell(&self) {
        println!("cargo::metadata=version={VERSION}");
        println!("cargo::metadata=contract={self}");
    }

    /// Compares it with what the engine was built for: models of this crate are to run with it.
    pub fn compare(&self) -> Result<(), Error> {
        let told = |variable| env::var(variable).map_err(|_| Error::NoEngine { build: VERSION });
        let version = told("DEP_DALEMBERT_VERSION")?;
        let contract = told("DEP_DALEMBERT_CONTRACT")?;
        if version != VERSION {
            return Err(Error::Skew {
                engine: version,
                build: VERSION,
            });
        }
        if contract != self.to_string() {
            return Err(Error::OtherContract {
                version: VERSION,
                engine: contract,
                build: self.to_string(),
            });
        }
        Ok(())
    }
}

impl fmt::Display for Contract {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.version, self.digest)
    }
}
