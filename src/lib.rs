//! placeholder

pub mod integrate;
