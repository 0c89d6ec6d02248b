//! The engine, one subject a file: references, events, stability, refusals. In one program, since every program takes
//! seconds to link.

#[path = "../common/mod.rs"]
mod common;

mod advance;
mod bouncing;
mod contacts;
mod coulomb;
mod derivatives;
mod doubts;
mod equilibrium;
mod extreme_damping;
mod grazing;
mod grips;
mod impacts;
mod impulses;
mod invariants;
mod knots;
mod libraries;
mod lift_off;
mod limits;
mod linkages;
mod mechanisms;
mod methods;
mod multipliers;
mod newmark;
mod onsets;
mod order;
mod outputs;
mod overturning;
mod painleve;
mod paradoxes;
mod peaks;
mod pendulum;
mod random_contacts;
mod random_scenes;
mod ratchets;
mod refusals;
mod requirements;
mod resets;
mod rest;
mod rocking;
mod roots_cases;
mod roots_properties;
mod shipped;
mod sin_cos;
mod sizes;
mod stacks;
mod stiff;
mod tolerances;
mod torture;
mod torture_tolerances;
mod units;
mod validation;
mod validity;
mod wedges;
