//! Sides of an instant.

/// Which one-sided limit is meant at a breakpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The limit from earlier times.
    Left,
    /// The limit from later times.
    Right,
}
