//! The members of an ensemble that a thread runs: which of them is in which lane.

use super::super::failure::Stoppable;
use super::super::member::Member;
use super::super::simulation::{Simulation, Stop};
use super::group::{Group, Outcome};
use super::{Ensemble, Finished};
use crate::integrate::LaneMask;
use crate::kernel::{LaneLevel, with_kernel};
use crate::run::Until;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A group, whatever its number of free coordinates.
trait AnyGroup<'p, const W: usize> {
    fn load(&mut self, lane: usize, from: &Simulation<'p>);
    fn go_on(&mut self, lane: usize, from: &Simulation) -> bool;
    fn vacate(&mut self, lane: usize);
    fn unload(&mut self, lane: usize, into: &mut Simulation);
    fn step(&mut self) -> [LaneMask; 3];
    /// Records the transitions that lanes have just taken, whose slots are told; gives the lanes among
    /// `may_rest` in which events accumulate.
    fn record(
        &self,
        gone: LaneMask,
        may_rest: LaneMask,
        slots: &[Option<usize>; W],
        all: &mut [Slot],
    ) -> LaneMask;
    fn outcome(&self, lane: usize) -> Outcome;
}

impl<'p, const F: usize, const W: usize> AnyGroup<'p, W> for Group<'p, F, W> {
    fn load(&mut self, lane: usize, from: &Simulation<'p>) {
        Group::load(self, lane, from)
    }
    fn go_on(&mut self, lane: usize, from: &Simulation) -> bool {
        Group::go_on(self, lane, from)
    }
    fn vacate(&mut self, lane: usize) {
        Group::vacate(self, lane)
    }
    fn unload(&mut self, lane: usize, into: &mut Simulation) {
        Group::unload(self, lane, into)
    }
    fn step(&mut self) -> [LaneMask; 3] {
        let ended = Group::step(self);
        let [gone, may_rest] = self.transit();
        [gone, may_rest, ended & !gone]
    }
    fn record(
        &self,
        gone: LaneMask,
        may_rest: LaneMask,
        slots: &[Option<usize>; W],
        all: &mut [Slot],
    ) -> LaneMask {
        let mut at_rest = LaneMask::NONE;
        for guard in &self.guards {
            for lane in (guard.falls & gone).lanes() {
                let slot = slots[lane].expect("what goes on is in a lane");
                let simulation = &mut all[slot].simulation;
                Group::record(self, guard, lane, simulation);
                if may_rest.is(lane) {
                    at_rest.set(lane, simulation.rest().is_some());
                }
            }
        }
        at_rest
    }
    fn outcome(&self, lane: usize) -> Outcome {
        Group::outcome(self, lane)
    }
}

/// The lanes of a mode.
struct Lanes<'a, const W: usize> {
    group: Box<dyn AnyGroup<'a, W> + 'a>,
    /// The slot in each lane.
    slots: [Option<usize>; W],
    /// Number of lanes with a slot.
    occupied: usize,
}

/// A trajectory under way.
struct Slot<'a> {
    simulation: Simulation<'a>,
    /// The member that it is.
    member: usize,
    state: Progress,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Progress {
    /// It has come to its end.
    Free,
    /// It is in a mode that goes in lanes.
    Waiting,
    InLane,
}

pub(super) struct Worker<'a, const W: usize> {
    ensemble: &'a Ensemble,
    members: &'a [Member<'a>],
    /// The first member that no worker has started.
    next: &'a AtomicUsize,
    /// Whether it is to stop.
    stop: Until<'a>,
    slots: Vec<Slot<'a>>,
    /// The lanes of each mode, made when they are first needed.
    lanes: Vec<Option<Lanes<'a, W>>>,
    /// Whether a slot or a lane has become free.
    vacancies: bool,
    autonomous: bool,
    level: LaneLevel<W>,
}

impl<'a, const W: usize> Worker<'a, W> {
    /// Ready to run members of an ensemble, from the `next` on that no other of so many `workers` has started.
    pub fn new(
        ensemble: &'a Ensemble,
        members: &'a [Member<'a>],
        (next, workers): (&'a AtomicUsize, usize),
        stop: Until<'a>,
    ) -> Self {
        let modes = ensemble.problem.variant().modes.len();
        let going = ensemble.in_lanes.iter().filter(|&&goes| goes).count();
        // The fewest of which, however they are spread over the modes, some mode has as many as lanes.
        let count = (going * (W - 1) + 1).min(members.len().div_ceil(workers));
        let slot = |_| Slot {
            simulation: Simulation::new(&ensemble.problem).expect("the scene was prepared"),
            member: 0,
            state: Progress::Free,
        };
        Worker {
            ensemble,
            members,
            next,
            stop,
            slots: (0..count).map(slot).collect(),
            lanes: (0..modes).map(|_| None).collect(),
            vacancies: true,
            autonomous: ensemble.problem.signals.is_zero(),
            level: LaneLevel::new(ensemble.level),
        }
    }

    /// Runs all of them; `take` gets each at its end.
    pub fn run(mut self, take: &mut impl FnMut(usize, Finished)) {
        while !self.stop.is_reached() {
            if std::mem::take(&mut self.vacancies) {
                (0..self.slots.len()).for_each(|slot| self.fill(slot, take));
            }
            let occupied = |mode: usize| self.lanes[mode].as_ref().map_or(0, |l| l.occupied);
            let fullest = (0..self.lanes.len()).max_by_key(|&m| (occupied(m), usize::MAX - m));
            let Some(mode) = fullest.filter(|&mode| occupied(mode) > 0) else {
                return;
            };
            self.step(mode, take);
        }
    }

    /// Starts members in a slot until one waits for a lane, and looks for one.
    fn fill(&mut self, slot: usize, take: &mut impl FnMut(usize, Finished)) {
        while self.slots[slot].state == Progress::Free && !self.stop.is_reached() {
            let member = self.next.fetch_add(1, Ordering::Relaxed);
            let Some(next) = self.members.get(member) else {
                return;
            };
            self.slots[slot].member = member;
            match self.slots[slot].simulation.become_member(next) {
                Ok(()) => self.go_on(slot, Ok(true), false, take),
                Err(reason) => {
                    let finished = Finished {
                        simulation: &mut self.slots[slot].simulation,
                        failure: Some(reason),
                        has_begun: false,
                    };
                    take(member, finished);
                }
            }
        }
        if self.slots[slot].state == Progress::Waiting {
            self.find_lane(slot);
        }
    }

    /// Puts a waiting slot into a lane of its mode, if one is free.
    fn find_lane(&mut self, slot: usize) {
        let simulation = &self.slots[slot].simulation;
        let mode = simulation.here.mode;
        let (level, autonomous) = (self.level, self.autonomous);
        let order = self.ensemble.orders[mode];
        let lanes = self.lanes[mode].get_or_insert_with(|| {
            let kernels = &simulation.mode().kernels;
            let group: Box<dyn AnyGroup<'a, W> + 'a> =
                with_kernel!(kernels,
                    k => Box::new(Group::new(k, level, autonomous, order, simulation)),
                    _any => unreachable!("a mode of so many free coordinates does not go in lanes"));
            Lanes {
                group,
                slots: [None; W],
                occupied: 0,
            }
        });
        if let Some(lane) = lanes.slots.iter().position(Option::is_none) {
            lanes.group.load(lane, simulation);
            lanes.slots[lane] = Some(slot);
            lanes.occupied += 1;
            self.slots[slot].state = Progress::InLane;
        }
    }

    /// A step of a group, and what follows from it.
    fn step(&mut self, mode: usize, take: &mut impl FnMut(usize, Finished)) {
        let lanes = self.lanes[mode].as_mut().expect("it is occupied");
        let [gone, may_rest, ended] = lanes.group.step();
        let at_rest = (lanes.group).record(gone, may_rest, &lanes.slots, &mut self.slots);
        for lane in at_rest.lanes() {
            let lanes = self.lanes[mode].as_mut().expect("it is occupied");
            let slot = lanes.slots[lane].expect("what goes on is in a lane");
            let simulation = &mut self.slots[slot].simulation;
            lanes.group.unload(lane, simulation);
            simulation.visited.clear();
            let passed = simulation.find_accumulation();
            self.leave(mode, lane, passed.map(|()| true), false, take);
        }
        for lane in ended.lanes() {
            let lanes = self.lanes[mode].as_mut().expect("it is occupied");
            let Some(slot) = lanes.slots[lane] else {
                continue;
            };
            let outcome = lanes.group.outcome(lane);
            let simulation = &mut self.slots[slot].simulation;
            lanes.group.unload(lane, simulation);
            let (stop, unclear) = match outcome {
                Outcome::Event(guard) => (Stop::Event(guard), false),
                Outcome::Until
                    if simulation.here.now.seconds() >= self.ensemble.problem.end.time =>
                {
                    (Stop::End, false)
                }
                Outcome::Until => (Stop::Breakpoint, false),
                _ => (Stop::Method, true),
            };
            let passed = simulation.pass(stop);
            let stays = matches!(outcome, Outcome::Event(_))
                && matches!(passed, Ok(true))
                && simulation.here.mode == mode
                && !simulation.is_over();
            if stays && lanes.group.go_on(lane, simulation) {
                continue;
            }
            self.leave(mode, lane, passed, unclear, take);
        }
    }

    /// Takes the slot out of a lane of a mode, and goes on with it as [`Self::go_on`].
    fn leave(
        &mut self,
        mode: usize,
        lane: usize,
        passed: Stoppable<bool>,
        alone: bool,
        take: &mut impl FnMut(usize, Finished),
    ) {
        let lanes = self.lanes[mode].as_mut().expect("it is occupied");
        let slot = lanes.slots[lane].take().expect("it is occupied");
        lanes.group.vacate(lane);
        lanes.occupied -= 1;
        self.vacancies = true;
        self.go_on(slot, passed, alone, take);
        if self.slots[slot].state == Progress::Waiting {
            self.find_lane(slot);
        }
    }

    /// From the end of a segment on to where the slot waits for a lane, or to its end. `alone`: the next
    /// segment is for the engine of single runs.
    fn go_on(
        &mut self,
        slot: usize,
        passed: Stoppable<bool>,
        mut alone: bool,
        take: &mut impl FnMut(usize, Finished),
    ) {
        let Slot {
            simulation,
            member,
            state,
        } = &mut self.slots[slot];
        let mut passed = passed;
        let failure = loop {
            match passed {
                Err(reason) => break Some(*reason),
                Ok(false) => break None,
                Ok(true) => {}
            }
            match simulation.settle() {
                Err(reason) => break Some(*reason),
                Ok(false) => break None,
                Ok(true) => {}
            }
            if !alone
                && self.ensemble.in_lanes[simulation.here.mode]
                && Group::<0, W>::takes(simulation)
            {
                *state = Progress::Waiting;
                return;
            }
            alone = false;
            passed = simulation.advance_to_event(&mut self.stop);
        };
        *state = Progress::Free;
        // One that was stopped has not come to its end.
        if self.stop.is_reached() {
            return;
        }
        simulation.count_work();
        simulation
            .observers
            .jump(&simulation.here, [&[], &[]], None);
        take(
            *member,
            Finished {
                simulation,
                failure,
                has_begun: true,
            },
        );
    }
}
