//! All that a run in parts remembers at an instant, so that it goes on from there, later or elsewhere, without the change
//! of a bit.

use super::advance::{MadeBy, Stage};
use super::failure::Reason;
use super::problem::{AtLimit, Observed, Problem};
use super::resume::digests;
use super::segment::tolerances;
use super::simulation::{Simulation, Stop, Violation};
use super::solvers::{SlotsOf, Solvers};
use crate::integrate::{Radau, Taylor};
use crate::kernel::{ModeKernel, with_kernel};
use crate::model::name::intern;
use crate::numerics::Size;
use crate::numerics::{Memory, Persist};
use crate::run::digest;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

/// Version of what a checkpoint holds; another one is refused.
const VERSION: u32 = 7;

/// A run in parts, at an instant: see [`super::Simulator::snapshot`]. It can be kept by serde, in any format that keeps
/// texts; numbers of the run are in it by their bits.
///
/// Of a run that has gone on from it state, steps and events are, to the last bit, those of the run that it was taken of:
/// it holds the memory of the method and of the choice between methods, the signs of guards, the events by which an
/// accumulation is recognised, doubts, ledger, what was commanded. It does not hold rows and transitions that are past.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    version: u32,
    /// Name of the model.
    model: String,
    /// When it was taken, s.
    time: f64,
    /// Digests of the model and of what the run is simulated with: (part, digest).
    digests: Vec<(String, String)>,
    /// What is watched and recorded, as far as the run remembers something of it: (part, in words).
    watched: Vec<(String, String)>,
    /// Parameters: name, and bits in hexadecimal digits.
    parameters: Vec<(String, String)>,
    /// The words of the memory, sixteen hexadecimal digits each.
    words: String,
    /// Their digest.
    digest: String,
}

/// Why a checkpoint cannot be taken over.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Misfit {
    /// It is of another version of this program.
    #[error(
        "the checkpoint has format {found}, and this program reads format {VERSION}: go on with the program that took it, or run from the start"
    )]
    Version {
        /// Its format.
        found: u32,
    },
    /// It is of another run.
    #[error("the checkpoint is of another run: {what} is {now} now and was {then}")]
    Other {
        /// What differs.
        what: String,
        /// What it is in the problem.
        now: String,
        /// What it was.
        then: String,
    },
    /// It is not as it was written.
    #[error("the checkpoint is damaged: {why}; take another one, or run from the start")]
    Damaged {
        /// In which way.
        why: &'static str,
    },
}

impl Checkpoint {
    /// When it was taken: the time that was advanced to, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    fn new(problem: &Problem, (time, extremes): (f64, bool), words: &[u64]) -> Self {
        let words = words.iter().fold(String::new(), |mut text, word| {
            let _ = write!(text, "{word:016x}");
            text
        });
        Checkpoint {
            version: VERSION,
            model: problem.model.name.into(),
            time,
            digests: digests(problem),
            watched: watched(problem, extremes).into(),
            parameters: parameters(problem),
            digest: digest(&words),
            words,
        }
    }

    /// The words, if this is a whole checkpoint of the problem.
    fn words(&self, problem: &Problem, extremes: bool) -> Result<Vec<u64>, Misfit> {
        if self.version != VERSION {
            let found = self.version;
            return Err(Misfit::Version { found });
        }
        let other = |what: &str, now: &str, then: &str| {
            let [what, now, then] = [what, now, then].map(String::from);
            Err(Misfit::Other { what, now, then })
        };
        let name = problem.model.name;
        if self.model != name {
            return other("the model", name, &self.model);
        }
        for ((name, now), (_, then)) in parameters(problem).iter().zip(&self.parameters) {
            if now != then {
                let value = |bits: &str| match u64::from_str_radix(bits, 16) {
                    Ok(bits) => f64::from_bits(bits).to_string(),
                    Err(_) => bits.into(),
                };
                return other(&format!("`{name}`"), &value(now), &value(then));
            }
        }
        for ((part, now), (_, then)) in watched(problem, extremes).iter().zip(&self.watched) {
            if now != then {
                return other(part, now, then);
            }
        }
        let now = digests(problem);
        for (i, (part, now)) in now.iter().enumerate() {
            match self.digests.get(i) {
                Some((of, then)) if of == part && then == now => {}
                Some((of, then)) if of == part => {
                    let digests = [now, then].map(|digest| format!("that of digest {digest}"));
                    return other(&format!("`{part}`"), &digests[0], &digests[1]);
                }
                _ => {
                    return Err(Misfit::Damaged {
                        why: "its digests are not those of a problem",
                    });
                }
            }
        }
        if digest(&self.words) != self.digest {
            return Err(Misfit::Damaged {
                why: "its words do not have its digest",
            });
        }
        let word = |digits: &[u8]| u64::from_str_radix(str::from_utf8(digits).ok()?, 16).ok();
        let words: Option<Vec<u64>> = self.words.as_bytes().chunks(16).map(word).collect();
        words.ok_or(Misfit::Damaged {
            why: "its words are no numbers",
        })
    }
}

/// Of what is watched and recorded that of which a run remembers something, in words.
fn watched(problem: &Problem, extremes: bool) -> [(String, String); 5] {
    let Problem {
        record,
        limits,
        end,
        ..
    } = problem;
    let kept = |is_kept: bool| if is_kept { "kept" } else { "not kept" };
    let energies = kept(record.ledger || record.columns.energies);
    let samples = match record.every {
        Some(every) => format!("every {every} s"),
        None => "every step".into(),
    };
    let of_model = (limits.of_model.iter()).map(|(name, course)| match course {
        AtLimit::End => format!("{name} ends the run"),
        AtLimit::Continue => format!("{name} does not end the run"),
        AtLimit::Ignore => format!("{name} is ignored"),
    });
    let own = limits.own.iter().map(|limit| {
        let (quantity, index) = match limit.of {
            Observed::Coordinate(i) => ("coordinate", i),
            Observed::Rate(i) => ("rate", i),
            Observed::Reaction(i) => ("reaction", i),
            Observed::Output(i) => ("output", i),
        };
        let side = if limit.above { "above" } else { "below" };
        let ends = if limit.ends { ", ends the run" } else { "" };
        let (name, level) = (&limit.name, limit.level);
        format!("{name}: {quantity} {index} {side} {level}{ends}")
    });
    let limits: Vec<String> = of_model.chain(own).collect();
    let after = end.after.map_or("none", |(name, _)| name);
    [
        ("the energy balance", energies.into()),
        ("the list of extremes", kept(extremes).into()),
        ("the interval of samples", samples),
        ("the list of limits", format!("[{}]", limits.join("; "))),
        ("the transition that ends the run", after.into()),
    ]
    .map(|(part, words)| (part.into(), words))
}

/// Names and bits of the parameters.
fn parameters(problem: &Problem) -> Vec<(String, String)> {
    let parameters = problem.model.parameters.iter().zip(&problem.parameters);
    let named = parameters.map(|(p, x)| (p.name.into(), format!("{:016x}", x.to_bits())));
    named.collect()
}

impl<'p> Simulation<'p> {
    /// Takes a checkpoint of a run that was advanced to `time`, s.
    ///
    /// # Errors
    /// [`Reason`] why the run has failed: it does not go on.
    pub fn checkpoint(&mut self, time: f64) -> Result<Checkpoint, Reason> {
        if let Stage::Failed(reason) = &self.stage {
            return Err((**reason).clone());
        }
        let mut words = Vec::new();
        let written = self.persist(&mut Memory::Write(&mut words));
        written.expect("memory that is written takes everything");
        let extremes = self.observers.watch_extremes();
        Ok(Checkpoint::new(self.problem, (time, extremes), &words))
    }

    /// Goes to where a checkpoint was taken, of a run of this problem.
    ///
    /// # Errors
    /// [`Misfit`] with what differs; the run is where it was, or, where the words of the checkpoint do not fit, to be rewound.
    pub fn restore(&mut self, from: &Checkpoint) -> Result<(), Misfit> {
        let words = from.words(self.problem, self.observers.watch_extremes())?;
        let why = "its words do not fit the model";
        self.take_over(&words).ok_or(Misfit::Damaged { why })
    }

    fn take_over(&mut self, words: &[u64]) -> Option<()> {
        let mut memory = Memory::Read(words);
        self.persist(&mut memory)?;
        matches!(memory, Memory::Read([])).then_some(())?;
        // What follows from the state.
        self.smooth_until = f64::NEG_INFINITY;
        self.context.forget_signals();
        self.signs.start();
        self.set_context();
        self.observers.represent_mode(self.mode());
        Some(())
    }

    /// All that is remembered, in both directions.
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        self.here.now.persist(memory)?;
        self.here.j.persist(memory)?;
        self.here.mode.persist(memory)?;
        self.here.shown.persist(memory)?;
        let modes = self.modes.len();
        (self.here.mode < modes).then_some(())?;
        for numbers in [&mut self.here.q, &mut self.here.v, &mut self.here.a] {
            memory.slice(numbers)?;
        }
        memory.slice(self.context.discrete_mut())?;
        memory.slice(&mut self.at_start)?;
        memory.slice(&mut self.drift)?;
        self.began.persist(memory)?;
        memory.slice(&mut self.has_inertia)?;
        memory.slice(&mut self.stiffness)?;
        self.counted.persist(memory)?;
        self.signs.persist(memory)?;
        self.doubts.persist(memory)?;
        self.margins.persist(memory)?;
        self.best_determined.persist(memory)?;
        self.accumulation.persist(memory)?;
        self.visited.persist(memory)?;
        self.observers.persist(memory)?;
        self.persist_solver(memory)?;
        self.persist_inputs(memory)?;
        self.stage.persist(memory)?;
        if self.stage.is_in_segment() {
            self.pause.persist(memory)?;
        }
        let all = [MadeBy::Taylor, MadeBy::RadauOfFive, MadeBy::RadauOfSeven];
        memory.one_of(&mut self.made_by, &all)?;
        (0..modes).try_for_each(|index| {
            let mode = &self.modes[index];
            with_kernel!(&mode.kernels, k => self.persist_methods(k, index, memory))
        })
    }

    /// The work done, and who did it.
    fn persist_solver(&mut self, memory: &mut Memory) -> Option<()> {
        let solver = &mut self.solver;
        solver.method.persist(memory)?;
        for count in [
            &mut solver.steps,
            &mut solver.rejected,
            &mut solver.residual_evaluations,
            &mut solver.jacobian_evaluations,
            &mut solver.factorizations,
        ] {
            count.persist(memory)?;
        }
        let named = |(name, order): &(&str, usize)| (String::from(*name), *order);
        let mut methods: Vec<(String, usize)> = self.methods.iter().map(named).collect();
        memory.list(&mut methods, Default::default)?;
        let interned = methods.iter().map(|(name, order)| (intern(name), *order));
        self.methods = interned.collect();
        Some(())
    }

    /// What was commanded.
    fn persist_inputs(&mut self, memory: &mut Memory) -> Option<()> {
        match self.signals.are_commanded() {
            true => self.signals.to_mut().persist(memory),
            false => Some(()),
        }
    }

    /// The memory of the methods of a mode, of those that were used.
    fn persist_methods<F: Size>(
        &mut self,
        kernel: &'p ModeKernel<F>,
        index: usize,
        memory: &mut Memory,
    ) -> Option<()>
    where
        Solvers: SlotsOf<F>,
    {
        let tolerances = tolerances(kernel.size(), self.accuracy, &self.modes[index]);
        let context = &self.context;
        let slots = self.solvers.slots();
        let taylor = || Taylor::new(&tolerances, kernel.series_kind(context));
        persist_method(&mut slots.taylor[index], taylor, memory)?;
        let radau = || Radau::new(&tolerances);
        persist_method(&mut slots.radau_of_five[index], radau, memory)?;
        let radau = || Radau::new(&tolerances);
        persist_method(&mut slots.radau_of_seven[index], radau, memory)
    }
}

/// The memory of a method, if there is one.
fn persist_method<M: Persist>(
    method: &mut Option<Box<M>>,
    make: impl FnOnce() -> M,
    memory: &mut Memory,
) -> Option<()> {
    let mut is_made = method.is_some();
    is_made.persist(memory)?;
    match is_made {
        true => method
            .get_or_insert_with(|| Box::new(make()))
            .persist(memory)?,
        false => *method = None,
    }
    Some(())
}

impl Persist for Stage {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let mut stop = match self {
            Stage::Pending(stop) => *stop,
            _ => Stop::End,
        };
        let mut place = match self {
            Stage::Start => 0_usize,
            Stage::Settle => 1,
            Stage::Entered => 2,
            Stage::Between => 3,
            Stage::Pending(_) => 4,
            Stage::Over => 5,
            Stage::Failed(_) => return None,
        };
        place.persist(memory)?;
        stop.persist(memory)?;
        *self = match place {
            0 => Stage::Start,
            1 => Stage::Settle,
            2 => Stage::Entered,
            3 => Stage::Between,
            4 => Stage::Pending(stop),
            5 => Stage::Over,
            _ => return None,
        };
        Some(())
    }
}

impl Persist for Stop {
    fn persist(&mut self, memory: &mut Memory) -> Option<()> {
        let (mut place, mut guard, mut rests) = match *self {
            Stop::End => (0_usize, 0, false),
            Stop::Breakpoint => (1, 0, false),
            Stop::Method => (2, 0, false),
            Stop::Event(guard) => (3, guard, false),
            Stop::Fired => (4, 0, false),
            Stop::Pause => (5, 0, false),
            Stop::Violated(Violation { guard, rests }) => (6, guard, rests),
        };
        place.persist(memory)?;
        guard.persist(memory)?;
        rests.persist(memory)?;
        *self = match place {
            0 => Stop::End,
            1 => Stop::Breakpoint,
            2 => Stop::Method,
            3 => Stop::Event(guard),
            4 => Stop::Fired,
            5 => Stop::Pause,
            6 => Stop::Violated(Violation { guard, rests }),
            _ => return None,
        };
        Some(())
    }
}
