//! Collects samples without allocating in the step loop.

use super::Layout;
use super::result::Trajectory;

/// Fills a [`Trajectory`] row by row.
#[derive(Debug, Clone)]
pub struct Recorder {
    trajectory: Trajectory,
}

impl Recorder {
    /// A recorder with room for `rows` rows: the number of grid points known up front, plus what
    /// the caller wants to record at events. Pushing more rows than that allocates.
    pub fn new(layout: &Layout, rows: usize) -> Recorder {
        let columns = layout.columns();
        Recorder {
            trajectory: Trajectory {
                t: room(rows),
                mode: room(rows),
                values: room(rows.saturating_mul(columns.len())),
                columns,
            },
        }
    }

    /// Forgets all rows, and keeps the room.
    pub fn clear(&mut self) {
        self.trajectory.truncate(0);
    }

    /// Number of rows on the grid `0, every, 2 every, … ≤ end`, and one for an end off the grid.
    pub fn grid_rows(end: f64, every: f64) -> usize {
        (end / every).floor() as usize + 2
    }

    /// Appends a row. `fill` gets the row, one value a column and all of them zero, laid out as
    /// [`Layout::range`] says. Does not allocate while there is room.
    pub fn push_row(&mut self, t: f64, mode: usize, fill: impl FnOnce(&mut [f64])) {
        let trajectory = &mut self.trajectory;
        let start = trajectory.values.len();
        trajectory.t.push(t);
        trajectory.mode.push(mode);
        trajectory
            .values
            .resize(start + trajectory.columns.len(), 0.0);
        fill(&mut trajectory.values[start..]);
    }

    /// Time of the last row, s.
    pub fn last_time(&self) -> Option<f64> {
        self.trajectory.t.last().copied()
    }

    /// Number of rows so far.
    pub fn rows(&self) -> usize {
        self.trajectory.len()
    }

    /// The trajectory recorded.
    pub fn finish(self) -> Trajectory {
        self.trajectory
    }
}

/// Room for so many numbers, where there is so much; else it grows as far as it comes.
fn room<T>(numbers: usize) -> Vec<T> {
    let mut room = Vec::new();
    let _ = room.try_reserve_exact(numbers);
    room
}
