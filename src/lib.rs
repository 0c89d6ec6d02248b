//! Simulation of mechanical systems that stick, slip, rock and impact, from equations that are
//! derived from their energies at build time.
//!
//! energies → derivation → C → [`kernel`] → [`integrate`] → [`hybrid`] (events) → [`record`]
//!
//! A ball that bounces infinitely often comes to rest at a known time:
//!
//! ```
//! use dalembert::hybrid::{Problem, simulate};
//! use dalembert::model::models;
//! use dalembert::record::Silent;
//!
//! let model = models().find("bouncing_ball").expect("it is in models/");
//! let mut problem = Problem::new(&model);
//! problem.set_parameter("e", 0.5)?;
//! problem.set_initial("h", 1.0)?;
//! problem.end.time = 2.0;
//! let run = simulate(&problem, &mut Silent)?;
//!
//! let rest = run.events.iter().find(|e| e.transition == "rest").expect("it comes to rest");
//! let exact = (2.0f64 / 9.81).sqrt() * (1.0 + 0.5) / (1.0 - 0.5);
//! assert!((rest.t / exact - 1.0).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A crate with models of its own brings them in by [`models!`].
//!
//! | feature | adds |
//! |---|---|
//! | `shipped-models` | the models under `models/` |
//! | `plots` | pictures and pages of runs, output folders |
//! | `folders` | models from folders, built while a program runs |
//! | `cli` | the program `dalembert`, with the two before |
//!
//! All are on unless `default-features = false`.
//!
//! [`scene::Scene::load`] makes a [`hybrid::Problem`] of a JSON file, [`record::Run::write`] makes
//! tables and plots of the result.

#![deny(unsafe_code)]
#![warn(missing_docs)]

#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "folders")]
pub mod folders;
pub mod formula;
pub mod hybrid;
pub mod input;
pub mod integrate;
pub mod jets;
// The calls into the generated C.
#[allow(unsafe_code)]
pub mod kernel;
pub mod model;
pub mod motion;
pub mod numerics;
#[cfg(feature = "plots")]
pub mod page;
pub mod precision;
pub mod record;
pub mod run;
pub mod scene;
pub mod study;

/// Compiles and runs the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
