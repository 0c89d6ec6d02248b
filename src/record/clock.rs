//! Looks at the clock that cost nothing: a step may take less time than a look.

use std::time::{Duration, Instant};

/// Time between two looks. A look takes some 50 ns, so that it costs less than a thousandth; and steps
/// that become a thousand times as long do not keep anybody waiting.
const INTERVAL: Duration = Duration::from_micros(100);

/// Looks at the clock once in many calls, so often that the time between two looks is about
/// [`INTERVAL`], or one call where that takes longer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SparseClock {
    /// Calls until the next look.
    left: u32,
    /// Calls from the last look to the next.
    stride: u32,
    last: Instant,
}

impl SparseClock {
    /// The first call is a look.
    pub fn new() -> Self {
        SparseClock {
            left: 1,
            stride: 1,
            last: Instant::now(),
        }
    }

    /// Counts a call; the time, if it is one that looks.
    #[inline]
    pub fn due(&mut self) -> Option<Instant> {
        self.left -= 1;
        (self.left == 0).then(|| self.read())
    }

    #[cold]
    fn read(&mut self) -> Instant {
        let now = Instant::now();
        self.stride = next(self.stride, now - self.last);
        self.left = self.stride;
        self.last = now;
        now
    }
}

/// The calls to the next look, if the last so many took `elapsed`: at most twice as many, since one that
/// took little may have been the exception.
fn next(stride: u32, elapsed: Duration) -> u32 {
    let pace = elapsed.as_secs_f64() / f64::from(stride);
    let wanted = INTERVAL.as_secs_f64() / pace;
    (wanted.min(f64::from(u32::MAX)) as u32).clamp(1, stride.saturating_mul(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_between_two_looks_is_the_interval_whatever_a_call_takes() {
        for nanoseconds in [1, 400, 30_000, 99_000] {
            let call = Duration::from_nanos(nanoseconds);
            let mut stride = 1;
            for _ in 0..40 {
                stride = next(stride, call * stride);
            }
            let between = call * stride;
            assert!(between <= INTERVAL && between * 2 > INTERVAL, "{between:?}");
        }
    }

    #[test]
    fn every_call_looks_where_it_takes_longer_than_the_interval() {
        assert_eq!(next(1, Duration::from_secs(3)), 1);
        assert_eq!(next(250, Duration::from_secs(3)), 1);
        assert_eq!(next(u32::MAX, Duration::ZERO), u32::MAX);
    }
}
