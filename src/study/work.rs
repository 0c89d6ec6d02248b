//! All cases of a study on all cores.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::time::{Duration, Instant};

use rayon::prelude::*;

use super::file::Study;
use super::folder::{StudyFolder, StudyFolderError};
use super::rows::Row;

/// How often finished cases are kept: a program that is killed loses what it computed since.
const KEEP: Duration = Duration::from_millis(500);

/// How often it is asked whether to go on, and how long a thread holds what it has finished: to hand each case over by itself
/// would wake the thread that keeps them as often as there are cases.
const ASK: Duration = Duration::from_millis(20);

/// A part of a study: the cases whose index leaves a rest after division.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    /// Which part, from 1.
    pub part: u64,
    /// Of how many.
    pub of: u64,
}

impl Shard {
    /// All of it.
    pub const WHOLE: Shard = Shard { part: 1, of: 1 };

    /// Whether a case belongs to it.
    pub fn has(self, case: u64) -> bool {
        case % self.of == self.part - 1
    }
}

/// How a study came to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ended {
    /// All cases are finished.
    Done,
    /// It was stopped; what was finished is kept.
    Stopped,
}

/// Hears how many cases are finished; `Break` stops the study.
pub(crate) trait Watch {
    fn progress(&mut self, finished: u64) -> ControlFlow<()>;
}

/// Runs the cases that are `pending` on as many threads as the present pool of rayon has, and keeps them in a folder as they
/// come.
pub(crate) fn run(
    study: &Study,
    pending: &[u64],
    folder: &mut StudyFolder,
    watch: &mut dyn Watch,
) -> Result<Ended, StudyFolderError> {
    let stop = AtomicBool::new(false);
    let next = AtomicUsize::new(0);
    let size = study.batch(pending.len(), rayon::current_num_threads());
    let batches: &Vec<&[u64]> = &pending.chunks(size).collect();
    let (send, receive) = mpsc::channel::<Vec<(u64, Vec<Row>)>>();
    std::thread::scope(|scope| {
        let (stop, next) = (&stop, &next);
        let pool = rayon::current_num_threads();
        // Rayon's threads must not wait for the disk, so this thread keeps what they send.
        let spawned = std::thread::Builder::new()
            .name("study".into())
            .spawn_scoped(scope, move || {
                let ensemble = match pending.is_empty() {
                    true => None,
                    false => study.ensemble(stop),
                };
                let ensemble = ensemble.as_ref();
                let work = || {
                    let threads = (0..pool).into_par_iter().with_max_len(1);
                    threads.for_each_with(send, |send, _| {
                        let mut finished = Vec::new();
                        let mut sent = Instant::now();
                        // Each takes the next batch that nobody has begun, so none waits while there are any.
                        while let Some(cases) = batches.get(next.fetch_add(1, Ordering::Relaxed)) {
                            if stop.load(Ordering::Relaxed) {
                                break;
                            }
                            study.run_cases(cases, ensemble, stop, &mut |case, rows| {
                                finished.push((case, rows));
                                if sent.elapsed() >= ASK {
                                    // Nobody hears any more where the disk is full.
                                    let _ = send.send(std::mem::take(&mut finished));
                                    sent = Instant::now();
                                }
                            });
                        }
                        let _ = send.send(finished);
                    });
                };
                match rayon::ThreadPoolBuilder::new().num_threads(pool).build() {
                    Ok(pool) => pool.install(work),
                    Err(_) => work(),
                }
            });
        let outcome = match spawned {
            Ok(_) => collect(receive, folder, watch, stop),
            Err(error) => Err(StudyFolderError::Io {
                action: "start a thread for the study in",
                path: "the system".into(),
                source: error,
            }),
        };
        if outcome.is_err() {
            stop.store(true, Ordering::Relaxed);
        }
        outcome
    })
}

/// Keeps what comes until nobody sends any more.
fn collect(
    receive: mpsc::Receiver<Vec<(u64, Vec<Row>)>>,
    folder: &mut StudyFolder,
    watch: &mut dyn Watch,
    stop: &AtomicBool,
) -> Result<Ended, StudyFolderError> {
    let mut finished = 0;
    let mut waiting: Vec<(u64, Vec<Row>)> = Vec::new();
    let (mut kept, mut asked) = (Instant::now(), Instant::now());
    loop {
        let came = receive.recv_timeout(ASK);
        let over = matches!(came, Err(mpsc::RecvTimeoutError::Disconnected));
        if let Ok(cases) = came {
            finished += cases.len() as u64;
            waiting.extend(cases);
        }
        if !waiting.is_empty() && (over || kept.elapsed() >= KEEP) {
            folder.keep(&waiting)?;
            waiting.clear();
            kept = Instant::now();
        }
        if over {
            break;
        }
        if asked.elapsed() >= ASK {
            asked = Instant::now();
            if watch.progress(finished).is_break() {
                stop.store(true, Ordering::Relaxed);
            }
        }
    }
    Ok(match stop.load(Ordering::Relaxed) {
        true => Ended::Stopped,
        false => Ended::Done,
    })
}
