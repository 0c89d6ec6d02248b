//! The result types. The event engine fills them; nothing here computes.

/// Estimate of the error of a run: its difference to a run by another method at a tighter tolerance, and
/// the rounding of their steps.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ErrorEstimate {
    /// The methods of the better run, as [`Solver::method`] names them.
    pub method: String,
    /// Relative tolerance of the better run.
    pub tolerance: f64,
    /// Of each coordinate at the end, in its unit.
    pub q: Vec<f64>,
    /// Of each velocity at the end, in its unit.
    pub v: Vec<f64>,
    /// Largest of these, each divided by what a relative tolerance of 1 would allow: its typical size
    /// (absolute ÷ relative tolerance) and its magnitude.
    pub relative: f64,
    /// Largest difference of the times of a transition (s).
    pub event_time: f64,
    /// Transitions that the better run alone has.
    pub missed: usize,
    /// Transitions that the run alone has.
    pub extra: usize,
    /// Transitions that one of the two alone has, in the tails of accumulations: no errors.
    pub in_tails: usize,
}

/// What was simulated: enough to say which run a file belongs to.
#[derive(Debug, Clone, Default)]
pub struct Subject {
    /// Name of the model.
    pub model: String,
    /// Title of the scene; empty when the scene has none.
    pub title: String,
    /// Chosen option of each choice of the model, as `(choice, option)`.
    pub choices: Vec<(String, String)>,
    /// Value of each parameter, in the model's order and units.
    pub parameters: Vec<(String, f64)>,
    /// Digests of the model and of the parts of the scene that decide the motion, as (part, digest).
    pub digests: Vec<(String, String)>,
    /// By how much a projection has changed the initial state that was asked for: coordinates and rates, by name, in their units.
    pub projected: Vec<(String, f64)>,
}

/// Samples of the columns over time.
///
/// Times never decrease. A transition may be recorded from both of its sides: the row of the
/// state before and the row of the state after then carry the same time, in this order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Trajectory {
    /// The columns, in the order of a row.
    pub columns: Vec<Column>,
    /// Time of each row (s).
    pub t: Vec<f64>,
    /// Mode of each row, an index into [`Layout::modes`](super::Layout::modes).
    pub mode: Vec<usize>,
    /// Row-major, `columns.len()` values a row.
    pub values: Vec<f64>,
}

/// One column of the trajectory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Name: `theta`, `theta.rate`, `reaction.theta`, ….
    pub name: String,
    /// Unit, as the model writes it: `rad`, `m/s`, `N m`; `1` where there is none.
    pub unit: String,
    /// Meaning and sign, in words.
    pub meaning: String,
    /// What kind of quantity it is.
    pub group: ColumnKind,
}

/// What kind of quantity a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ColumnKind {
    /// A generalized coordinate.
    Coordinate,
    /// The rate of a generalized coordinate.
    Velocity,
    /// The force a constraint, or the ground, exerts on the system; 0 while the coordinate is free.
    Reaction,
    /// A discrete state.
    Discrete,
    /// An output.
    Output,
    /// An entry of the energy ledger.
    Energy,
    /// A prescribed function of time.
    Input,
}

/// One transition, without the states around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// Time (s).
    pub t: f64,
    /// Number of transitions up to and including this one: the first has 1.
    pub j: u64,
    /// Name of the transition.
    pub transition: &'static str,
    /// Mode left, an index into [`Layout::modes`](super::Layout::modes).
    pub from: usize,
    /// Mode entered, an index into [`Layout::modes`](super::Layout::modes).
    pub to: usize,
    /// Jump of the energy; `None` for a transition that is no impact.
    pub energy: Option<EnergyJump>,
}

/// One transition.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// Time (s).
    pub t: f64,
    /// Number of transitions up to and including this one: the first has 1.
    pub j: u64,
    /// Name of the transition.
    pub transition: &'static str,
    /// Mode left, an index into [`Layout::modes`](super::Layout::modes).
    pub from: usize,
    /// Mode entered, an index into [`Layout::modes`](super::Layout::modes).
    pub to: usize,
    /// State just before.
    pub before: Snapshot,
    /// State just after.
    pub after: Snapshot,
    /// Jump of the energy; `None` for a transition that is no impact.
    pub energy: Option<EnergyJump>,
    /// The impulses of contacts and constraints in it, in the order of [`Layout::impulses`](super::Layout::impulses).
    pub impulses: Vec<f64>,
}

/// What is kept of a transition beside its name and time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sides {
    /// State just before.
    pub before: Snapshot,
    /// State just after.
    pub after: Snapshot,
    /// The impulses of contacts and constraints between them, in the order of [`Layout::impulses`](super::Layout::impulses).
    pub impulses: Vec<f64>,
}

/// The state at an instant.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Snapshot {
    /// Coordinates, all of them.
    pub q: Vec<f64>,
    /// Velocities, all of them.
    pub v: Vec<f64>,
    /// Discrete states.
    pub discrete: Vec<f64>,
    /// Reaction of each coordinate (0 where it is free), then of each motion of the ground; empty
    /// where reactions are not recorded.
    pub reactions: Vec<f64>,
    /// The outputs; empty where they are not recorded.
    pub outputs: Vec<f64>,
}

/// What an impact does to the energy. In the inertial frame the energy changes by
/// `ground_work − lost`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EnergyJump {
    /// Energy lost, in the frame of what is struck (J); negative where the impact law creates energy.
    pub lost: f64,
    /// Work of the ground's impulse under the ground's own motion, in the inertial frame (J).
    pub ground_work: f64,
}

/// A point of a run in hybrid time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct HybridState {
    /// Time (s).
    pub t: f64,
    /// Number of transitions so far.
    pub j: u64,
    /// Mode, an index into [`Layout::modes`](super::Layout::modes).
    pub mode: usize,
    /// State.
    pub state: Snapshot,
}

/// Work done by the integrator.
#[derive(Debug, Clone, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Solver {
    /// Name of the method.
    pub method: String,
    /// Steps accepted.
    pub steps: u64,
    /// Steps tried and given up, for whichever cause.
    pub rejected: u64,
    /// Evaluations of the residual.
    pub residual_evaluations: u64,
    /// Evaluations of the Jacobians.
    pub jacobian_evaluations: u64,
    /// Factorizations of iteration matrices.
    pub factorizations: u64,
}

/// The balance of energies, `initial + input_work − dissipated − lost_at_impacts = final`, in one
/// stated frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Ledger {
    /// Kinetic and potential energy at the start (J).
    pub initial: f64,
    /// Kinetic and potential energy at the end (J).
    pub final_: f64,
    /// Energy taken by dissipation and friction (J).
    pub dissipated: f64,
    /// Work of the prescribed motions and forces, impulses of a moving ground included (J).
    pub input_work: f64,
    /// Energy lost at impacts, in the frame of what is struck (J).
    pub lost_at_impacts: f64,
    /// A sentence that says in which frame the ledger is kept.
    pub frame: String,
}

impl Event {
    /// A transition with the states before and after it.
    pub fn new(jump: &Jump, sides: Sides) -> Self {
        let Sides {
            before,
            after,
            impulses,
        } = sides;
        let Jump {
            t,
            j,
            transition,
            from,
            to,
            energy,
        } = *jump;
        Event {
            t,
            j,
            transition,
            from,
            to,
            before,
            after,
            energy,
            impulses,
        }
    }

    /// The transition alone.
    pub fn jump(&self) -> Jump {
        Jump {
            t: self.t,
            j: self.j,
            transition: self.transition,
            from: self.from,
            to: self.to,
            energy: self.energy,
        }
    }
}

impl ColumnKind {
    /// Whether a [`Snapshot`] holds values of this group.
    pub fn is_of_the_state(self) -> bool {
        match self {
            ColumnKind::Coordinate
            | ColumnKind::Velocity
            | ColumnKind::Reaction
            | ColumnKind::Discrete
            | ColumnKind::Output => true,
            ColumnKind::Energy | ColumnKind::Input => false,
        }
    }
}

impl Snapshot {
    /// The values in the order of a row of the trajectory, which starts with them.
    pub fn values(&self) -> impl Iterator<Item = f64> + '_ {
        let Snapshot {
            q,
            v,
            reactions,
            discrete,
            outputs,
        } = self;
        let state = q.iter().chain(v).chain(reactions).chain(discrete);
        state.chain(outputs).copied()
    }
}

impl Trajectory {
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.t.len()
    }
    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }
    /// The values of row `i`, one a column.
    ///
    /// # Panics
    /// If there is no such row.
    pub fn row(&self, i: usize) -> &[f64] {
        let width = self.columns.len();
        &self.values[i * width..(i + 1) * width]
    }
    /// Keeps the first `rows` rows.
    pub fn truncate(&mut self, rows: usize) {
        self.t.truncate(rows);
        self.mode.truncate(rows);
        self.values.truncate(rows * self.columns.len());
    }
    /// Index of a column by name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|c| c.name == name)
    }
}

impl Ledger {
    /// What the balance is off by (J): `initial + input_work − dissipated − lost_at_impacts − final`.
    pub fn imbalance(&self) -> f64 {
        self.initial + self.input_work - self.dissipated - self.lost_at_impacts - self.final_
    }
}
