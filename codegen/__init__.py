"""From energies to C: the model interface, the derivation and the emission of generated code."""
