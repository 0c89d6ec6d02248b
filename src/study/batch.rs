//! Cases side by side: in the vector lanes of an ensemble as far as they can go there, the others one by one.
//!
//! Whether a run goes in lanes follows from its own problem and the study, and what it gives there depends on no other
//! ([`Ensemble`]): so the rows of a case are the same whatever batch, thread or part of the study it is in.

use std::sync::atomic::{AtomicBool, Ordering};

use super::ending::OfEnsemble;
use super::file::Study;
use super::member::Planned;
use super::procedure::Failed;
use super::rows::Row;
use crate::hybrid::{Ensemble, Member, Problem};

/// Cases of single runs in a batch: at the end of one, lanes run empty.
const MOST: usize = 256;

/// Most lanes that a processor has: with fewer cases than these a study has no use of an ensemble.
const LANES: usize = 8;

/// Searches in a batch. Each round makes one run of each; what is finished is known when the last one is.
const MOST_SEARCHES: usize = 16;

/// A search under way.
struct Search {
    case: u64,
    rows: Vec<Row>,
    /// Value along the path, and whether it failed.
    runs: Vec<(f64, Failed)>,
}

impl Study {
    /// The ensemble whose members the runs of the study can be: of the scene itself or, where that is not like a case in the
    /// middle of the design, of that. `None` where what is measured is more than an ensemble tells, or where there are few cases.
    pub fn ensemble(&self, stop: &AtomicBool) -> Option<Ensemble> {
        if self.cases() < LANES as u64 {
            return None;
        }
        let middle = self.planned(self.cases() / 2, self.procedure.first_value());
        let middle = middle.problem.ok()?;
        let of = |problem: &Problem| Ensemble::recording(problem, stop).ok().flatten();
        let scene = self.problem(&[], None).ok();
        let of_scene = scene.and_then(|scene| of(&scene));
        of_scene
            .filter(|ensemble| ensemble.is_like(&middle))
            .or_else(|| of(&middle))
    }

    /// How many cases make a batch, of so many that some threads have to run.
    pub fn batch(&self, pending: usize, threads: usize) -> usize {
        let most = match self.procedure.along() {
            None => MOST,
            Some(_) => MOST_SEARCHES,
        };
        // Towards the end no thread is to wait long for another; and lanes are to be full, as long as each thread has some.
        let least = LANES.min(pending.div_ceil(threads)).max(1);
        (pending / (8 * threads)).clamp(least, most)
    }

    /// Runs all cases of a batch; `finished` gets each with its rows in the order in which they were made. Those that have not
    /// come to their end when `stop` becomes true are left out.
    pub fn run_cases(
        &self,
        cases: &[u64],
        ensemble: Option<&Ensemble>,
        stop: &AtomicBool,
        finished: &mut dyn FnMut(u64, Vec<Row>),
    ) {
        if self.procedure.along().is_none() {
            let planned: Vec<_> = cases.iter().map(|&case| self.planned(case, None)).collect();
            self.make(&planned, ensemble, stop, &mut |i, row| {
                finished(planned[i].case, vec![row]);
            });
            return;
        }
        let search = |&case: &u64| Search {
            case,
            rows: Vec::new(),
            runs: Vec::new(),
        };
        let mut searches: Vec<Search> = cases.iter().map(search).collect();
        while !searches.is_empty() && !stop.load(Ordering::Relaxed) {
            let mut next = Vec::new();
            searches.retain_mut(|search| match self.procedure.next(&search.runs) {
                Some(value) => {
                    next.push(self.planned(search.case, Some(value)));
                    true
                }
                None => {
                    let mut rows = std::mem::take(&mut search.rows);
                    if self.check_bracket(search.case, &mut rows, stop).is_some() {
                        finished(search.case, rows);
                    }
                    false
                }
            });
            self.make(&next, ensemble, stop, &mut |i, row| {
                let search = &mut searches[i];
                search.runs.push((next[i].intensity, row.failed));
                search.rows.push(row);
            });
        }
    }

    /// Makes some runs, in any order; `take` gets each row with the index of its run.
    fn make(
        &self,
        planned: &[Planned],
        ensemble: Option<&Ensemble>,
        stop: &AtomicBool,
        take: &mut dyn FnMut(usize, Row),
    ) {
        let mut members = Vec::new();
        let mut places = Vec::new();
        for (i, run) in planned.iter().enumerate() {
            match (&run.problem, ensemble) {
                (Ok(problem), Some(ensemble)) if ensemble.is_like(problem) => {
                    members.push(Member::from(problem));
                    places.push(i);
                }
                _ => {
                    if let Some(row) = self.run_alone(run, stop) {
                        take(i, row);
                    }
                }
            }
        }
        let Some(ensemble) = ensemble else { return };
        ensemble.run_here(&members, stop, |member, mut finished| {
            let run = &planned[places[member]];
            let row = match &finished.failure {
                Some(reason) if !finished.has_begun => Some(self.refused(run, reason.to_string())),
                _ => {
                    let row = self.row(run, &OfEnsemble::new(&mut finished));
                    self.decided(row, run, true, stop)
                }
            };
            if let Some(row) = row {
                take(places[member], row);
            }
        });
    }
}
