//! What a run is watched for: samples, extremes, energies.
//!
//! The step loop calls [`Observers::enter`] where a segment starts, [`Observers::step`] with the dense
//! output of every step, cut at its event if it has one, and [`Observers::jump`] after every
//! transition. What is not asked for costs a branch.
//!
//! Reactions, energies and powers have no series of their own. A step represents them, and the motion
//! with them, by polynomials through their values at Chebyshev points (`interpolants`), of a degree that
//! follows from the decay of their coefficients. One such representation gives the energies, by its
//! integral, and the extremes, of which most steps are told from a bound that they have none.

mod crests;
mod extremes;
mod interpolants;
mod ledger;
mod observer;
mod recording;
mod represent;
mod samples;
mod summit;

use super::equations::Equations;
use super::guards;
use super::outputs::Outputs;
use super::problem::{Problem, Record};
use super::simulation::Here;
use crate::integrate::Path;
use crate::kernel::Free;
use crate::model::{Contacts, Mode};
use crate::numerics::Size;
use crate::numerics::{Memory, Persist};
use crate::run::{Layout, Peak};
use extremes::Extremes;
use interpolants::{Interpolants, MOST};
use ledger::RunningLedger;
pub use observer::{Collected, MadeStep, Observer};
pub(super) use recording::Recording;
use samples::{Points, Samples};
pub(super) use samples::{held, sample_time};
use std::ops::ControlFlow;

/// Most times that a step is cut in halves: in a part with a kink the error is quartered each time, and a
/// step that is smooth is not cut at all.
const MOST_HALVINGS: u32 = 4;

/// Most windows in which inputs are told by values that a step is cut into: the places of their halves are counted in 32 bits.
const MOST_WINDOWS: f64 = (1_u32 << (31 - MOST_HALVINGS)) as f64;

/// Loosest tolerance of the polynomials. The value at an extremum is off by the square of what its
/// place is off by, so that this finds it to rounding.
const LOOSEST: f64 = 1e-8;

/// The observers of a run.
#[derive(Debug)]
pub(super) struct Observers<'o> {
    record: Record,
    pub layout: Layout,
    /// Where rows and transitions go.
    pub recording: Recording<'o>,
    pub samples: Samples,
    points: Points,
    /// When the run ends, if not before, s.
    end: f64,
    /// The discrete states that are recorded, by their indices.
    discretes: Box<[usize]>,
    /// Evaluates outputs, where they are recorded.
    pub outputs: Outputs,
    /// The energy ledger, where it is kept.
    pub ledger: Option<RunningLedger>,
    extremes: Option<Extremes>,
    interpolants: Interpolants,
    functions: Functions,
    tolerance: f64,
    /// Largest magnitude of kinetic and potential energy so far, J: work below its rounding is nothing.
    energy: f64,
    /// Whether the values at the last node are those at the start of the next step.
    joined: bool,
}

/// All but rows and transitions that are past.
impl Persist for Observers<'_> {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.recording.persist(memory)?;
        self.samples.persist(memory)?;
        self.ledger
            .iter_mut()
            .try_for_each(|ledger| ledger.persist(memory))?;
        self.extremes
            .iter_mut()
            .try_for_each(|extremes| extremes.persist(memory))?;
        self.interpolants.persist(memory)?;
        self.energy.persist(memory)?;
        self.joined.persist(memory)
    }
}

/// What is represented in the present mode, in this order: free coordinates, their rates, reactions, outputs, coordinates that
/// depend on free ones, their rates, stored energy, powers.
#[derive(Debug)]
struct Functions {
    /// Columns of all but the powers.
    columns: Vec<usize>,
    /// Which reactions, by their index.
    reactions: Vec<usize>,
    /// Number of outputs.
    outputs: usize,
    /// Of each output the contact whose gap or slip rate it is, where these are held by multipliers.
    of_contacts: Box<[Option<OfContact>]>,
    stored: bool,
    /// Number of free coordinates that are columns; multipliers, which come last, are none.
    free: usize,
    /// Which coordinates depend on free ones.
    dependent: Vec<usize>,
    /// Room for all reactions, and for all coordinates.
    room: Box<[f64]>,
}

/// What of a contact, by its index, an output is.
#[derive(Debug, Clone, Copy)]
enum OfContact {
    Gap(usize),
    Slip(usize),
}

impl OfContact {
    /// Of an output by its name.
    fn named(name: &str, mode: &Mode) -> Option<Self> {
        let contacts = mode.contacts.as_ref()?.contacts.iter();
        contacts.enumerate().find_map(|(k, contact)| {
            let of = name.strip_prefix(contact.name)?;
            match of {
                ".gap" | ".rate" => Some(OfContact::Gap(k)),
                ".slip" => Some(OfContact::Slip(k)),
                _ => None,
            }
        })
    }

    /// Whether the contact holds it at zero, as these discrete states say.
    fn is_held(self, contacts: &Contacts, discrete: &[f64]) -> bool {
        let (OfContact::Gap(k) | OfContact::Slip(k)) = self;
        let contact = &contacts.contacts[k];
        let is_closed = contact.closed.is_none_or(|i| discrete[i] != 0.0);
        match self {
            OfContact::Gap(_) => is_closed,
            OfContact::Slip(_) => {
                is_closed && contact.direction.is_some_and(|i| discrete[i] == 0.0)
            }
        }
    }
}

impl Functions {
    /// Whether a function is what contacts hold at zero. The dense output of a step is not: it is off by its error.
    fn is_held(&self, function: usize, mode: &Mode, discrete: &[f64]) -> bool {
        let outputs = 2 * self.free + self.reactions.len();
        let output = function.checked_sub(outputs);
        let of = output.and_then(|output| *self.of_contacts.get(output)?);
        (of.zip(mode.contacts.as_ref()))
            .is_some_and(|(of, contacts)| of.is_held(contacts, discrete))
    }

    /// Which function is the rate of another.
    fn rate_of(&self, function: usize) -> Option<usize> {
        let dependent = 2 * self.free + self.reactions.len() + self.outputs;
        match function.checked_sub(dependent) {
            None => (function < self.free).then_some(self.free + function),
            Some(i) => (i < self.dependent.len()).then_some(function + self.dependent.len()),
        }
    }
}

/// A step that was made, or what its first event has left of it.
pub(super) struct Step<'s, 'e, F: Size> {
    pub equations: &'s mut Equations<'e, F>,
    pub motion: &'s dyn Path<F>,
    pub mode: &'s Mode,
    /// Room for the full state of a row; its free coordinates are overwritten.
    pub here: &'s mut Here,
    /// End of the step in local time, s.
    pub end: f64,
    /// How far beyond it the event is, s; negative where it is before the end.
    pub beyond: f64,
    /// [dissipated, input] energy of the step, J, where the method has a quadrature that is more accurate than its
    /// dense output.
    pub work: Option<[f64; 2]>,
}

impl<F: Size> Step<'_, '_, F> {
    /// Up to where it is looked at, in local time, s: its end, or the event where that is before the end. (An event that
    /// rounding does not tell from `start` leaves the step as it was made.)
    fn seen(&self, start: f64) -> f64 {
        let event = self.end + self.beyond.min(0.0);
        if event > start { event } else { self.end }
    }
}

/// A sample at which the run ends.
struct Sampled {
    /// Start of the part of the step that it is in, in local time, s.
    from: f64,
    /// When it is, in local time and in that of the run, s.
    tau: f64,
    t: f64,
}

/// A part of a step.
#[derive(Debug, Clone, Copy)]
struct Part {
    from: f64,
    to: f64,
    is_last: bool,
}

impl Part {
    fn time(&self, place: f64) -> f64 {
        match place {
            1.0 => self.to,
            _ => self.from + (self.to - self.from) * place,
        }
    }
}

impl<'o> Observers<'o> {
    /// The observers of a run; rows and transitions go to `observer`, else to memory.
    pub fn new(problem: &Problem, observer: Option<&'o mut dyn Observer>) -> Self {
        let record = problem.record;
        let layout = problem.layout();
        let recording = match observer {
            None => Recording::collected(problem, &layout),
            Some(observer) => Recording::told(observer, &layout),
        };
        let n = layout.coordinates.len();
        let extremes = record.extremes.then(|| Extremes::new(&layout));
        let most = 2 * n + layout.reactions.len() + layout.outputs.len() + 3;
        Observers {
            points: Points::new(recording.window),
            samples: Samples::new(record.every, recording.sees_rows),
            recording,
            end: problem.end.time,
            discretes: problem.variant().discretes.clone(),
            outputs: Outputs::new(problem),
            ledger: (record.ledger || record.columns.energies).then(RunningLedger::default),
            interpolants: match extremes.is_some() || record.ledger || record.columns.energies {
                true => Interpolants::new(most),
                false => Interpolants::new(0),
            },
            functions: Functions {
                columns: Vec::with_capacity(most),
                reactions: Vec::with_capacity(layout.reactions.len()),
                outputs: layout.outputs.len(),
                of_contacts: (layout.outputs.iter())
                    .map(|output| OfContact::named(&output.name, &problem.automaton().modes[0]))
                    .collect(),
                stored: false,
                free: 0,
                dependent: Vec::with_capacity(n),
                room: vec![0.0; layout.reactions.len().max(problem.model.coordinates.len())].into(),
            },
            extremes,
            layout,
            record,
            tolerance: problem.accuracy.relative.min(LOOSEST),
            energy: 0.0,
            joined: false,
        }
    }

    /// Whether steps are looked at beyond the samples.
    pub fn watch_steps(&self) -> bool {
        let recording = &self.recording;
        let seen = recording.sees_steps || recording.sees_points;
        self.ledger.is_some() || self.extremes.is_some() || seen
    }

    /// Whether a step up to this local time is looked at between its ends.
    pub fn look_within<F: Size>(&self, equations: &Equations<F>, to: f64) -> bool {
        self.extremes.is_some() || self.due(equations, to).is_some()
    }

    /// Whether what is recorded in a mode depends on the accelerations.
    fn needs_accelerations(&self, mode: &Mode) -> bool {
        samples::has_reactions(&self.layout, mode) || !self.layout.outputs.is_empty()
    }

    /// Whether extremes are looked for.
    pub fn watch_extremes(&self) -> bool {
        self.extremes.is_some()
    }

    /// Looks for no extremes.
    pub fn leave_out_extremes(&mut self) {
        self.extremes = None;
    }

    /// The extremes of a column so far; the times of one without a value are not numbers.
    ///
    /// # Panics
    /// If none are looked for.
    pub fn peak(&self, column: usize) -> Peak {
        self.extremes
            .as_ref()
            .expect("extremes are looked for")
            .peak(column)
    }

    /// A column has a value at time `t`, s: nothing where that is not a number.
    pub fn note(&mut self, column: usize, t: f64, x: f64) {
        if let (Some(extremes), false) = (&mut self.extremes, t.is_nan()) {
            extremes.note(column, t, x);
        }
    }

    /// A segment starts here.
    pub fn enter(&mut self, mode: &Mode, here: &Here) {
        self.joined = false;
        self.represent_mode(mode);
        let Some(extremes) = &mut self.extremes else {
            return;
        };
        // What the mode holds moves along a straight line at most, or is represented.
        let t = here.now.seconds();
        extremes.note_state(t, [&here.q, &here.v]);
        if !extremes.reactions.is_empty() {
            for &i in &self.functions.columns[..self.functions.free] {
                extremes.note(extremes.reactions.start + i, t, 0.0);
            }
        }
    }

    /// What is represented is that of a mode.
    pub fn represent_mode(&mut self, mode: &Mode) {
        let Some(extremes) = &mut self.extremes else {
            return;
        };
        let n = extremes.coordinates;
        let Functions {
            columns,
            reactions,
            stored,
            free,
            dependent,
            ..
        } = &mut self.functions;
        let own = &mode.free[..mode.free.iter().filter(|&&i| i < n).count()];
        *free = own.len();
        columns.clear();
        columns.extend(own);
        columns.extend(own.iter().map(|i| n + i));
        reactions.clear();
        // Of a free coordinate there is none.
        let all = 0..extremes.reactions.len();
        reactions.extend(all.filter(|i| !own.contains(i)));
        columns.extend(reactions.iter().map(|i| extremes.reactions.start + i));
        columns.extend(extremes.outputs.clone());
        dependent.clear();
        dependent.extend((0..n).filter(|&i| mode.depends[i]));
        columns.extend(&*dependent);
        columns.extend(dependent.iter().map(|i| n + i));
        *stored = !extremes.energies.is_empty();
        columns.extend(stored.then_some(extremes.energies.start));
    }

    /// The state is another one: after a transition, and where the run begins and ends. `reactions` and `outputs` are those
    /// of the state, or none where they are not known.
    pub fn jump(&mut self, here: &Here, [reactions, outputs]: [&[f64]; 2], stored: Option<f64>) {
        let Some(extremes) = &mut self.extremes else {
            return;
        };
        let t = here.now.seconds();
        extremes.note_state(t, [&here.q, &here.v]);
        extremes.note_all(extremes.reactions.clone(), t, reactions);
        extremes.note_all(extremes.outputs.clone(), t, outputs);
        if let (Some(ledger), Some(stored)) = (&self.ledger, stored) {
            extremes.note_all(extremes.energies.clone(), t, &ledger.row(stored, [0.0; 2]));
        }
    }

    /// A run starts, with this kinetic and potential energy, J.
    pub fn begin(&mut self, stored: f64) {
        if let Some(ledger) = &mut self.ledger {
            *ledger = RunningLedger::starting_with(stored);
        }
    }

    /// Forgets all that was recorded, and keeps the room.
    pub fn rewind(&mut self) {
        self.recording.rewind();
        self.samples.rewind();
        self.points = Points::new(self.recording.window);
        if let Some(extremes) = &mut self.extremes {
            *extremes = Extremes::new(&self.layout);
        }
    }

    /// The extremes, `(column, peak)`.
    pub fn peaks(&self) -> Vec<(usize, Peak)> {
        self.extremes.as_ref().map_or(Vec::new(), Extremes::finish)
    }

    /// Looks at a step: its samples, its extremes, its energies. `Break`: the run ends at a sample, whose time (s) is
    /// given and whose state is in `step.here`.
    #[inline]
    pub fn step<F: Size>(&mut self, mut step: Step<F>) -> ControlFlow<f64> {
        if self.recording.sees_steps {
            self.show(&mut step);
        }
        if self.recording.sees_points {
            let (from, to) = (step.motion.start(), step.end + step.beyond);
            let t = step.equations.clock.start.plus(from).seconds();
            self.points
                .enter([from, to], t, self.record.every, self.end);
        }
        let due = self.due(step.equations, step.end + step.beyond).is_some();
        // What the method gives in one number is not enough inside of the step.
        let inside = due && self.record.columns.energies || self.functions.stored;
        let powers = self.ledger.is_some() && (step.work.is_none() || inside);
        if due || powers || self.extremes.is_some() {
            let start = step.motion.start();
            if let ControlFlow::Break(cut) = self.observe(&mut step, start, powers) {
                return ControlFlow::Break(self.cut(&mut step, cut, powers));
            }
        } else {
            self.joined = false;
        }
        if let (Some(ledger), Some(work), false) = (&mut self.ledger, step.work, powers) {
            ledger.add_work(work);
        }
        ControlFlow::Continue(())
    }

    /// Ends a step at a sample in it: what is left of it has no samples. Gives the time of the sample, s.
    #[cold]
    fn cut<F: Size>(
        &mut self,
        step: &mut Step<F>,
        Sampled { from, tau, t }: Sampled,
        powers: bool,
    ) -> f64 {
        // The work of the parts before was added, or none was.
        let from = match powers {
            true => from,
            false => step.motion.start(),
        };
        (step.end, step.beyond, step.work) = (tau, 0.0, None);
        self.joined = false;
        if tau > from && self.watches() {
            let _ = self.observe(step, from, self.ledger.is_some());
        }
        t
    }

    /// Whether steps are looked at for extremes or energies.
    fn watches(&self) -> bool {
        self.ledger.is_some() || self.extremes.is_some()
    }

    /// Shows a step to the observer.
    fn show<F: Size>(&mut self, step: &mut Step<F>) {
        let clock = step.equations.clock;
        let seconds = |tau: f64| clock.start.plus(tau).seconds();
        let (from, to) = (step.motion.start(), step.end + step.beyond);
        let (equations, motion, mode) = (&mut *step.equations, step.motion, step.mode);
        let here = &*step.here;
        let mut state = |t: f64, q: &mut [f64], v: &mut [f64]| {
            let tau = super::instant::Instant::new(t).since(clock.start);
            let [free, rates, a] = guards::motion(equations, motion, tau.clamp(from, to), false);
            q.copy_from_slice(&here.q);
            v.copy_from_slice(&here.v);
            for (i, &full) in mode.free.iter().enumerate() {
                (q[full], v[full]) = (free[i], rates[i]);
            }
            if !clock.drift.is_empty() {
                let at = Free {
                    q: &free,
                    v: &rates,
                    a: &a,
                };
                equations.kernel.coordinates(equations.context, at, q);
                equations.kernel.rates(equations.context, at, v);
            }
        };
        self.recording.step(&mut MadeStep {
            from: seconds(from),
            to: seconds(to),
            mode: here.shown,
            state: &mut state,
        });
    }

    /// Observes a step from local time `start` on.
    fn observe<F: Size>(
        &mut self,
        step: &mut Step<F>,
        start: f64,
        powers: bool,
    ) -> ControlFlow<Sampled> {
        let columns = match self.extremes {
            Some(_) => self.functions.columns.len(),
            None => 0,
        };
        let count = columns + if powers { 2 } else { 0 };
        let end = step.seen(start);
        // The motion may depend on no input, in which case its steps are as long as it likes.
        let windows = match count {
            0 => 1.0,
            _ => ((end - start) / step.equations.told_by_values(start)).ceil(),
        };
        let least = (windows.min(MOST_WINDOWS) as u32).next_power_of_two();
        let mut part = Part {
            from: start,
            to: match least {
                1 => end,
                _ => start + (end - start) / f64::from(least),
            },
            is_last: least == 1,
        };
        self.joined &= self.interpolants.set_count(count);
        let mut flown = [0.0; 2];
        let (mut index, mut parts) = (0, least);
        if count == 0 {
            self.joined = false;
            return self.sample(step, part, None);
        }
        loop {
            let resolved = self.represent(step, part, (columns, powers));
            if !resolved && parts < least << MOST_HALVINGS {
                (index, parts) = (2 * index, 2 * parts);
                // The values at the start stay.
                self.joined = true;
            } else {
                let work = match self.take(step, part, (columns, powers)) {
                    ControlFlow::Continue(work) => work,
                    ControlFlow::Break(sampled) => return ControlFlow::Break(sampled),
                };
                flown = [flown[0] + work[0], flown[1] + work[1]];
                self.interpolants.copy_values(MOST, 0);
                self.joined = true;
                index += 1;
                part.from = part.to;
            }
            if index == parts {
                break;
            }
            part.is_last = index + 1 == parts;
            part.to = match part.is_last {
                true => end,
                false => start + (end - start) * f64::from(index + 1) / f64::from(parts),
            };
        }
        if let (Some(ledger), Some(work)) = (&mut self.ledger, step.work)
            && powers
        {
            ledger.add_work([work[0] - flown[0], work[1] - flown[1]]);
        }
        ControlFlow::Continue(())
    }

    /// Takes what there is in a part of a step that is represented; gives its work [dissipated, input], J.
    fn take<F: Size>(
        &mut self,
        step: &mut Step<F>,
        part: Part,
        (columns, powers): (usize, bool),
    ) -> ControlFlow<Sampled, [f64; 2]> {
        let length = part.to - part.from;
        let integral = |i: usize| self.interpolants.polynomial(columns + i).integral(length);
        // Inside of the part the work is asked for by samples alone, and where a power changes its sign.
        let inside = powers
            && (self.due(step.equations, part.to).is_some()
                || self.functions.stored
                    && (0..2).any(|i| self.interpolants.changes_sign(columns + i)));
        let work = inside.then(|| [0, 1].map(integral));
        let whole = match powers {
            true => [0, 1].map(|i| self.interpolants.whole_integral(columns + i) * length),
            false => [0.0; 2],
        };
        // Before the rest: the run may end at one.
        if let ControlFlow::Break(sampled) = self.sample(step, part, work.as_ref()) {
            return ControlFlow::Break(sampled);
        }
        if let Some(mut extremes) = self.extremes.take() {
            self.find_extremes(&mut extremes, step, part, columns);
            if powers && self.functions.stored {
                let work = (work.as_ref(), whole);
                self.find_extremes_of_work(&mut extremes, step, part, (columns, work));
            }
            self.extremes = Some(extremes);
        }
        if let (Some(ledger), true) = (&mut self.ledger, powers) {
            ledger.add_work(whole);
            if part.is_last && step.beyond > 0.0 && step.work.is_none() {
                let of = &self.interpolants;
                ledger.add_work([0, 1].map(|i| of.value_at(MOST, columns + i) * step.beyond));
            }
        }
        ControlFlow::Continue(whole)
    }
}
