//! Whose models a build links: the engine's own, or those of a crate that depends on it.
//!
//! Several crates of a program may have models, and models of one name. So what they link has names that begin with the
//! crate's own.

use std::env;

use super::error::Error;
use super::fingerprint::Fingerprint;

/// `links` in the manifest of the engine: what cargo knows it by.
const ENGINE: &str = "dalembert";

/// Whose models are linked.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Owner {
    /// The engine's own.
    Engine,
    /// Those of a crate, by what its names in C begin with.
    Crate(String),
}

impl Owner {
    /// The crate whose build script runs.
    pub fn of_build() -> Result<Self, Error> {
        if env::var("CARGO_MANIFEST_LINKS").is_ok_and(|links| links == ENGINE) {
            return Ok(Owner::Engine);
        }
        let variable = |variable| env::var(variable).map_err(|_| Error::NotUnderCargo { variable });
        let (name, version) = (variable("CARGO_PKG_NAME")?, variable("CARGO_PKG_VERSION")?);
        Ok(Owner::of(&name, &version))
    }

    /// A crate. Names that differ in a hyphen are two crates, and so are two versions, which one program may have.
    fn of(name: &str, version: &str) -> Self {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let readable: String = name.chars().map(plain).collect();
        let exact = Fingerprint::default().with(name).with(version).finish();
        Owner::Crate(format!("{readable}_{exact}"))
    }

    /// What names in C begin with; nothing for the engine.
    pub fn tag(&self) -> &str {
        match self {
            Owner::Engine => "",
            Owner::Crate(tag) => tag,
        }
    }

    /// A name in C of something that each owner has one of.
    pub fn symbol(&self, name: &str) -> String {
        match self {
            Owner::Engine => format!("dalembert_{name}"),
            Owner::Crate(tag) => format!("dalembert_{tag}_{name}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Owner;

    #[test]
    fn no_two_crates_have_the_same_names() {
        let crates = [
            ("a-b", "1.0.0"),
            ("a_b", "1.0.0"),
            ("a-b", "1.0.1"),
            ("a", "b-1.0.0"),
        ];
        let symbols = crates.map(|(name, version)| Owner::of(name, version).symbol("models"));
        for (i, one) in symbols.iter().enumerate() {
            assert!(
                one.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'),
                "{one}"
            );
            for other in &symbols[..i] {
                assert_ne!(one, other);
            }
        }
        assert!(symbols[0].starts_with("dalembert_a_b_"), "{}", symbols[0]);
    }
}
