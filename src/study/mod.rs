//! Many runs as one question: designs of what varies, and what their results say.

pub mod fragility;
pub mod normal;
pub mod sampling;
