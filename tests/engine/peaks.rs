//! Extremes and energies against closed forms: they are those of the motion, not of the rows.

use crate::common::*;
use dalembert::hybrid::{Method, Problem};
use dalembert::input::{Function, Sine};
use dalembert::record::{Peak, Recorded, Run};
use dalembert::scene::Scene;
use std::f64::consts::PI;

/// The peak of a column by name.
pub fn peak(run: &Run, name: &str) -> Peak {
    let column = run.trajectory.column(name).expect("it is recorded");
    let found = run.peaks.iter().find(|(i, _)| *i == column);
    found.expect("it has a peak").1
}

pub fn record_all(problem: &mut Problem, every: Option<f64>) {
    problem.record.every = every;
    problem.record.columns = Recorded {
        reactions: true,
        outputs: false,
        energies: true,
        inputs: true,
    };
}

/// Intervals of the samples: the steps, some, none.
const INTERVALS: [Option<f64>; 3] = [None, Some(0.3), Some(f64::INFINITY)];

fn close(found: f64, exact: f64, size: f64, what: &str) {
    within(1e-12, found, exact, size, what);
}

fn within(tolerance: f64, found: f64, exact: f64, size: f64, what: &str) {
    let error = (found - exact).abs();
    assert!(error <= tolerance * size, "{what}: {found:.17} {exact:.17}");
}

#[test]
fn the_top_of_a_flight_is_found_between_rows() {
    with_each_method(|| {
        for every in INTERVALS {
            let mut problem = problem("hand_ball", &[("e", 0.8)]);
            problem.set_initial("h.rate", 5.0).unwrap();
            problem.end.time = 2.0;
            record_all(&mut problem, every);
            let run = run(&problem);
            let h = peak(&run, "h");
            close(h.max, 25.0 / (2.0 * 9.81), 1.0, "height");
            close(h.t_max, 5.0 / 9.81, 1.0, "time");
            // Both sides of the first impact.
            let rate = peak(&run, "h.rate");
            close(rate.min, -5.0, 5.0, "before the impact");
            close(rate.max, 5.0, 5.0, "at the start");
        }
    });
}

/// A moment M sin ωt on a rod without gravity, from the rate −M/2ω: θ′ = (M/ω) (1/2 − cos ωt).
fn driven_rod(omega: f64) -> Problem {
    let mut problem = problem("forced_pendulum", &[("g", 0.0)]);
    problem.set_initial("theta.rate", -0.5 / omega).unwrap();
    let moment = Sine::new(1.0, omega, 0.0);
    problem.set_input("moment", Function::from(moment)).unwrap();
    problem.end.time = 4.0 * PI / omega;
    problem.set_tolerance(1e-13);
    problem
}

#[test]
fn extremes_of_a_driven_motion_and_its_energies_are_those_of_the_formula() {
    with_each_method(|| {
        for every in INTERVALS {
            let omega = 2.5;
            let mut problem = driven_rod(omega);
            record_all(&mut problem, every);
            let run = run(&problem);
            // It turns back where cos ωt = 1/2.
            let turn = PI / 3.0;
            let theta = peak(&run, "theta");
            let least = (0.5 * turn - turn.sin()) / (omega * omega);
            close(theta.min, least, 0.1, "first turn");
            // The dense output of Radau has a lower order, which a place shows before a value does.
            let at = match problem.method {
                Method::Taylor => 1e-12,
                _ => 1e-10,
            };
            within(at, theta.t_min, turn / omega, 1.0, "its time");
            let rate = peak(&run, "theta.rate");
            close(rate.max, 1.5 / omega, 1.0, "fastest");
            // At a zero of the acceleration, which Radau's dense output has at a lower order still; the second crest is
            // as high as the first.
            let since = rate.t_max % (2.0 * PI / omega);
            within(1e5 * at, since, PI / omega, 1.0, "its time");
            let stored = peak(&run, "energy.stored");
            close(stored.max, 1.125 / (omega * omega), 1.0, "kinetic energy");
            close(stored.min, 0.0, 1.0, "kinetic energy at the turn");
            let work = peak(&run, "energy.input_work");
            close(work.max, 1.0 / (omega * omega), 1.0, "largest work");
            close(work.min, -0.125 / (omega * omega), 1.0, "least work");
            // It is as low wherever the rod stands still.
            within(
                at,
                (omega * work.t_min).cos(),
                0.5,
                3.0,
                "time of the least work",
            );
            let ledger = run.energy.as_ref().unwrap();
            close(ledger.imbalance(), 0.0, 1.0, "imbalance");
        }
    });
}

/// A coordinate that rises when an event ends it has no zero of its rate there: a mass without a spring against a stop.
#[test]
fn a_rise_that_an_event_ends_is_highest_there() {
    with_each_method(|| {
        for every in INTERVALS {
            let parameters = [
                ("k", 0.0),
                ("static_friction", 0.0),
                ("kinetic_friction", 0.0),
                ("stop", 0.7),
                ("e", 0.5),
            ];
            let mut problem = problem("coulomb_oscillator", &parameters);
            problem.set_initial("x.rate", 3.0).unwrap();
            problem.end.time = 0.5;
            record_all(&mut problem, every);
            let run = run(&problem);
            let x = peak(&run, "x");
            close(x.max, 0.7, 1.0, "at the stop");
            close(x.t_max, 0.7 / 3.0, 1.0, "its time");
            let rate = peak(&run, "x.rate");
            close(rate.max, 3.0, 3.0, "before the impact");
            close(rate.min, -1.5, 3.0, "after the impact");
            close(rate.t_min, 0.7 / 3.0, 1.0, "its time");
        }
    });
}

/// θ = sin t + 0.3 sin 3t + εt has two crests at a distance of 1.5 s, of which ε says which one is higher: by 1e-6 of its
/// size.
#[test]
fn of_two_crests_between_rows_the_higher_one_is_found() {
    with_each_method(|| {
        for (drift, every) in [1e-6, -1e-6]
            .into_iter()
            .flat_map(|drift| INTERVALS.map(|every| (drift, every)))
        {
            let mut problem = problem("forced_pendulum", &[("g", 0.0)]);
            problem.set_initial("theta.rate", 1.9 + drift).unwrap();
            let sines = [Sine::new(-1.0, 1.0, 0.0), Sine::new(-2.7, 3.0, 0.0)];
            let moment = Function::sum(sines.map(Function::from));
            problem.set_input("moment", moment).unwrap();
            problem.end.time = 2.5;
            problem.set_tolerance(1e-13);
            record_all(&mut problem, every);
            let run = run(&problem);
            let theta = |t: f64| t.sin() + 0.3 * (3.0 * t).sin() + drift * t;
            // Its rate is cos t (3.6 cos² t - 1.7) + ε.
            let mut t = match drift > 0.0 {
                true => PI - (1.7 / 3.6_f64).sqrt().acos(),
                false => (1.7 / 3.6_f64).sqrt().acos(),
            };
            for _ in 0..5 {
                let rate = t.cos() + 0.9 * (3.0 * t).cos() + drift;
                t += rate / (t.sin() + 2.7 * (3.0 * t).sin());
            }
            let found = peak(&run, "theta");
            close(found.max, theta(t), 1.0, "the higher crest");
            // The dense output of Radau has a lower order, which a place shows before a value does.
            let at = match problem.method {
                Method::Taylor => 1e-11,
                _ => 1e-9,
            };
            within(at, found.t_max, t, 1.0, "its time");
        }
    });
}

#[test]
fn the_reaction_of_a_shaken_table_has_its_peaks_between_rows() {
    with_each_method(|| {
        for every in INTERVALS {
            let mut problem = problem("hand_table_ball", &[("m", 2.0)]);
            let shake = Sine::new(7.0, 11.0, 0.4);
            problem
                .set_input("table_acceleration", Function::from(shake))
                .unwrap();
            problem.end.time = 1.5;
            record_all(&mut problem, every);
            let run = run(&problem);
            assert_eq!(run.layout.modes.name(run.end.mode), "sticks");
            let reaction = peak(&run, "reaction.gap");
            close(reaction.max, 2.0 * (9.81 + 7.0), 30.0, "largest reaction");
            close(reaction.min, 2.0 * (9.81 - 7.0), 30.0, "least reaction");
        }
    });
}

#[test]
fn energies_of_rows_are_those_of_the_formula() {
    // By Taylor, whose dense output is as exact as its steps.
    let omega = 2.5;
    let mut problem = driven_rod(omega);
    problem.method = Method::Taylor;
    record_all(&mut problem, Some(0.01));
    let run = run(&problem);
    let work = run.trajectory.column("energy.input_work").unwrap();
    for (i, t) in run.trajectory.t.iter().enumerate() {
        let rate = (0.5 - (omega * t).cos()) / omega;
        let exact = 0.5 * rate * rate - 0.125 / (omega * omega);
        close(run.trajectory.row(i)[work], exact, 1.0, "work");
    }
}

#[test]
fn energies_balance_as_well_as_the_motion_is_computed() {
    for (name, most) in [
        ("tank_full_plate", 1e-10),
        ("tank_rocks_and_slides", 1e-10),
        ("tank_doughnut", 1e-10),
        ("tank_free_release", 1e-10),
        // See the next test.
        ("vibrating_table_ball", 2e-10),
        ("sliding_oscillator", 1e-10),
    ] {
        let path = format!("{}/scenes/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let models = dalembert::model::models();
        let scene = Scene::load(path.as_ref(), &[], models).expect("the scene is in order");
        let run = run(&scene.problem);
        let ledger = run.energy.as_ref().unwrap();
        let flown = ledger.initial.abs() + ledger.input_work.abs() + ledger.dissipated.abs();
        let imbalance = ledger.imbalance().abs();
        assert!(
            imbalance <= most * flown,
            "{name}: {imbalance:e} of {flown} J"
        );
    }
}

/// A rest leaves out impacts that move the state by less than the tolerance, and with them the work that the table does in
/// their time: the imbalance goes with the tolerance, and both methods have the same one, so that it is no error of theirs.
#[test]
fn what_rests_leave_out_of_the_balance_goes_with_the_tolerance() {
    let path = format!(
        "{}/scenes/vibrating_table_ball.json",
        env!("CARGO_MANIFEST_DIR")
    );
    let models = dalembert::model::models();
    let scene = Scene::load(path.as_ref(), &[], models).expect("the scene is in order");
    for relative in [1e-8, 1e-10, 1e-12] {
        let [taylor, radau] = [Method::Taylor, Method::Radau].map(|method| {
            let mut problem = scene.problem.clone();
            problem.method = method;
            problem.set_tolerance(relative);
            let run = run(&problem);
            let ledger = run.energy.as_ref().unwrap();
            let flown = ledger.initial.abs() + ledger.input_work.abs();
            ledger.imbalance() / flown
        });
        let what = format!("{relative:e}: {taylor:e} and {radau:e}");
        assert!(taylor.abs() <= 2.0 * relative, "{what}");
        // Sums of a thousand terms of the size of the energies have some roundings.
        let rounding = 100.0 * f64::EPSILON;
        assert!(
            (taylor - radau).abs() <= 0.01 * taylor.abs() + rounding,
            "{what}"
        );
    }
}

#[test]
fn extremes_do_not_depend_on_the_rows() {
    for name in ["tank_doughnut", "coulomb_oscillator", "rocking_block"] {
        let path = format!("{}/scenes/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let peaks = ["", "record.every=0.07", "record={}"].map(|setting| {
            let settings: Vec<String> = match setting {
                "" => vec![],
                setting => vec![setting.to_owned()],
            };
            let models = dalembert::model::models();
            let scene = Scene::load(path.as_ref(), &settings, models).unwrap();
            let run = run(&scene.problem);
            // No row exceeds them by more than rounding.
            for (column, peak) in &run.peaks {
                let size = peak.max.abs().max(peak.min.abs());
                let room = 1e-12 * size;
                for (t, x) in run.curve(*column) {
                    let fits = peak.min - room <= x && x <= peak.max + room;
                    assert!(fits, "{name} {column} {t}: {x} not in {peak:?}");
                }
            }
            run.peaks
        });
        assert_eq!(peaks[0], peaks[1], "{name}");
        assert_eq!(peaks[0], peaks[2], "{name}");
    }
}

#[test]
fn energies_of_rows_do_not_depend_on_whether_extremes_are_looked_for() {
    with_each_method(|| {
        let rows = [true, false].map(|extremes| {
            let mut problem = driven_rod(2.5);
            problem.set_tolerance(1e-9);
            record_all(&mut problem, Some(0.37));
            problem.record.extremes = extremes;
            run(&problem)
        });
        let work = rows[0].trajectory.column("energy.input_work").unwrap();
        for i in 0..rows[0].trajectory.len() {
            let [one, other] = [0, 1].map(|k| rows[k].trajectory.row(i)[work]);
            within(1e-9, one, other, 1.0, "work");
        }
    });
}

/// Closed contacts hold their gaps at zero: the dense output of a step, which is off by its error, has no part in the extremes.
#[test]
fn a_gap_that_is_held_is_zero_in_the_extremes_too() {
    with_each_method(|| {
        let mut block = problem("rigid_block", &[]);
        block.set_initial("y", 0.6).unwrap();
        for (input, amplitude, frequency) in [("a_h", 5.5, 2.0), ("a_v", 3.0, 4.0)] {
            let turns = 2.0 * std::f64::consts::PI * frequency;
            let shakes = dalembert::input::Sine::new(amplitude, turns, 0.0);
            block.set_input(input, shakes.into()).unwrap();
        }
        block.end.time = 3.0;
        let run = run(&block);
        assert!(run.events.len() >= 10, "{}", run.events.len());
        let columns = run.layout.columns();
        for (i, peak) in &run.peaks {
            if columns[*i].name.ends_with(".gap") {
                assert!(peak.min > -1e-15, "{} {:e}", columns[*i].name, peak.min);
                assert!(peak.max > 1e-3, "{} {:e}", columns[*i].name, peak.max);
            }
        }
    });
}
