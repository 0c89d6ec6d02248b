//! Points that fill a cube evenly, for designs of studies: by the same bits on every machine.

mod directions;
mod halton;
mod latin;
mod random;
mod sobol;

pub use halton::halton;
pub use latin::latin_hypercube;
pub use random::Random;
pub use sobol::Sobol;

#[cfg(test)]
mod tests;
