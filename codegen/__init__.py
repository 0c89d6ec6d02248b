"""From energies to C: the model interface, the derivation and the emission of generated code."""

# that of Cargo.toml, which a program that is installed does not have
VERSION = "0.1.0"
