//! Hard cases for an event engine, with exact answers (tests/data/10_event_engine.json).

use crate::common::*;
use dalembert::hybrid::{Problem, simulate};
use dalembert::input::{Function, Interpolation, Outside, Sine, Table};
use dalembert::record::{Doubt, Question, Run, Silent, Uncertain};
use serde_json::Value;

/// An item of the reference by name.
fn item(name: &str) -> Value {
    let reference = reference("10_event_engine");
    let items = reference["reference"]["items"].as_array().unwrap();
    items.iter().find(|i| i["name"] == name).unwrap().clone()
}

/// An oscillator without friction or spring, between stops at ±`stop`.
fn slot(stop: f64, e: f64, x: f64, speed: f64) -> Problem {
    let none = [
        ("k", 0.0),
        ("static_friction", 0.0),
        ("kinetic_friction", 0.0),
    ];
    let mut problem = problem("hand_coulomb", &none);
    for (name, value) in [("stop", stop), ("e", e)] {
        problem.set_parameter(name, value).unwrap();
    }
    problem.set_initial("x", x).unwrap();
    problem.set_initial("x.rate", speed).unwrap();
    problem.set_tolerance(TIGHTEST);
    problem
}

fn relative(found: f64, exact: f64) -> f64 {
    (found / exact - 1.0).abs()
}

#[test]
fn grazing_impacts_are_found() {
    with_each_method(|| {
        for (name, excess) in [("10c_graze_eps_1e-6", 1e-6), ("10c_graze_eps_1e-10", 1e-10)] {
            let item = item(name);
            let mut problem = slot(1.0, 0.5, 0.0, 1.0 + excess);
            problem.set_parameter("k", 1.0).unwrap();
            problem.end.time = 2.0;
            tighten(&mut problem, 1e-2);
            // The tightest tolerance leaves three roundings of x. Inputs limit the steps: one without
            // amplitude, but of high frequency, makes them shorter than the tolerance asks for.
            let nothing = Function::from(Sine::new(0.0, 1000.0, 0.0));
            problem.set_input("force", nothing).unwrap();
            let run = run(&problem);
            let impact = &run.events[0];
            assert_eq!(impact.transition, "impact");
            // A relative error u of the state moves the impact by u ÷ speed: √(2 excess).
            let allowed = 1e-15 / (2.0 * excess).sqrt();
            let error = impact.t - number(&item["t_impact"]);
            assert!(
                error.abs() < allowed,
                "{name}: {error:e}, allowed {allowed:e}"
            );
            let speed = number(&item["v_minus"]);
            assert!(relative(impact.before.v[0], speed) < allowed / speed);
        }
    });
}

fn runner(guard: &str, c: f64, d: f64) -> Run {
    let mut problem = problem("runner", &[("c", c), ("d", d)]);
    problem.choose(&[("guard", guard)]).unwrap();
    problem.initial.mode = Some(mode(&problem, "outside"));
    problem.set_initial("x.rate", 1.0).unwrap();
    run(&problem)
}

#[test]
fn two_crossings_in_one_step_are_found() {
    with_each_method(|| {
        for (name, d) in [("10e_two_roots_1e-2", 1e-2), ("10e_two_roots_1e-4", 1e-4)] {
            let item = item(name);
            let run = runner("two_roots", 0.7310585786300049, d);
            assert_eq!(transitions(&run), ["enter", "leave"], "{name}");
            for (event, root) in run.events.iter().zip(["r1", "r2"]) {
                let error = relative(event.t, number(&item[root]));
                // The guard is (x − c)² − d²: rounding of d² moves its roots by u d/2, that of x by u.
                assert!(error < 1e-14, "{name}: {root} off by {error:e}");
            }
        }
    });
}

#[test]
fn a_triple_root_is_crossed_once() {
    with_each_method(|| {
        let run = runner("triple_root", 1.0 / 3.0, 0.0);
        assert_eq!(transitions(&run), ["enter"]);
        let error = (run.events[0].t - number(&item("10f_triple_root")["t"])).abs();
        assert!(error < 1e-5, "off by {error:e}");
    });
}

#[test]
fn a_pole_is_no_crossing() {
    with_each_method(|| {
        let run = runner("pole", 0.6, 0.0);
        assert_eq!(run.layout.modes.name(run.end.mode), "outside");
        assert_eq!(transitions(&run).len(), 0);
    });
}

/// A ball at h = 0 with the given velocity.
fn ball_at_the_floor(velocity: f64) -> Run {
    let mut problem = problem("hand_ball", &[("e", 0.5)]);
    problem.set_initial("h.rate", velocity).unwrap();
    problem.initial.mode = Some(mode(&problem, "flies"));
    problem.set_tolerance(TIGHTEST);
    problem.end.time = 0.5;
    run(&problem)
}

#[test]
fn an_event_at_the_start_is_told_from_a_departure() {
    with_each_method(|| {
        let item = item("10g_event_at_t0");
        let up = ball_at_the_floor(2.0);
        assert!(relative(times(&up, "impact")[0], number(&item["t_up"])) < 1e-14);
        let down = ball_at_the_floor(-2.0);
        let impacts = times(&down, "impact");
        assert_eq!((impacts[0], down.events[0].after.v[0]), (0.0, 1.0));
        assert!(relative(impacts[1], number(&item["t_down"])) < 1e-14);
        let rest = ball_at_the_floor(0.0);
        assert_eq!(transitions(&rest), ["rest"]);
        assert_eq!(rest.layout.modes.name(rest.end.mode), "rests");
    });
}

#[test]
fn short_flights_are_flown() {
    with_each_method(|| {
        for (name, e) in [
            ("10i_short_flight_e_1e-3", 1e-3),
            ("10i_short_flight_e_1e-6", 1e-6),
            ("10i_short_flight_e_1e-8", 1e-8),
        ] {
            let item = item(name);
            let mut problem = problem("hand_ball", &[("e", e)]);
            problem.set_initial("h", 1.0).unwrap();
            problem.set_tolerance(TIGHTEST);
            let run = run(&problem);
            let impacts = times(&run, "impact");
            assert!(relative(impacts[0], number(&item["t1"])) < 1e-14, "{name}");
            assert!(relative(impacts[1], number(&item["t2"])) < 1e-14, "{name}");
            let limit = times(&run, "rest");
            assert_eq!(limit.len(), 1, "{name}: {:?}", transitions(&run));
            assert!(
                relative(limit[0], number(&item["accumulation"])) < 1e-14,
                "{name}"
            );
        }
    });
}

#[test]
fn a_thousand_impacts_in_a_narrow_slot() {
    with_each_method(|| {
        let item = item("10j_narrow_slot");
        let mut problem = slot(5e-7, 0.999, -5e-7, 1.0);
        problem.end.time = 2e-3;
        let run = run(&problem);
        let impacts = times(&run, "impact");
        let error = relative(impacts[999], number(&item["t1000"]));
        assert!(error < 1e-12, "impact 1000 off by {error:e}");
        let speed = run.events[999].after.v[0].abs();
        assert!(relative(speed, number(&item["v1000"])) < 1e-12);
    });
}

/// A function that rises from zero at `slope` until `end`.
fn ramp(slope: f64, end: f64) -> Function {
    let table = Table::new(
        &[0.0, end],
        &[0.0, slope * end],
        Interpolation::Linear,
        Outside::Hold,
    );
    Function::from(table.unwrap())
}

#[test]
fn a_long_stick_neither_creeps_nor_misses_its_release() {
    with_each_method(|| {
        let item = item("10k_long_stick");
        let parameters = [("mu_s", 0.3), ("mu_k", 0.3), ("k", 0.0), ("belt", 0.0)];
        let mut problem = problem("hand_belt", &parameters);
        problem.set_input("force", ramp(1e-6, 4e6)).unwrap();
        problem.initial.mode = Some(mode(&problem, "sticks"));
        let release = number(&item["t_release"]);
        problem.end.time = release + 1000.0;
        problem.set_tolerance(TIGHTEST);
        let run = run(&problem);
        assert_eq!(transitions(&run), ["slip"]);
        assert!(relative(run.events[0].t, release) < 1e-14);
        assert_eq!(run.events[0].before.q[0], 0.0);
        // The release is off by one rounding of t, 5e-10 s, in 1000 s.
        assert!(relative(at_end(&run, "x"), number(&item["x_after_1000"])) < 3.0 * 5e-10 / 1000.0);
    });
}

#[test]
fn stick_and_slip_on_a_belt_repeat() {
    with_each_method(|| {
        let item = item("10l_belt_stick_slip");
        let parameters = [("belt", 0.1), ("mu_s", 0.1), ("mu_k", 0.06), ("g", 10.0)];
        let mut problem = problem("hand_belt", &parameters);
        problem.initial.mode = Some(mode(&problem, "sticks"));
        problem.end.time = 60.0;
        problem.set_tolerance(TIGHTEST);
        let run = run(&problem);
        let (slips, sticks) = (times(&run, "slip"), times(&run, "stick"));
        assert!(slips.len() >= 5);
        // From x = 0 the belt takes (1 N)/(1 N/m)/(0.1 m/s) to the first slip.
        assert!(relative(slips[0], 10.0) < 1e-14);
        let (slip, period) = (number(&item["slip_duration"]), number(&item["period"]));
        for k in 0..4 {
            assert!((sticks[k] - slips[k] - slip).abs() < 1e-12, "slip {k}");
            assert!(
                (slips[k + 1] - slips[k] - period).abs() < 1e-12,
                "period {k}"
            );
        }
        let restick = run.events.iter().find(|e| e.transition == "stick").unwrap();
        assert!((restick.after.q[0] - number(&item["x_restick"])).abs() < 1e-12);
    });
}

#[test]
fn sticks_down_to_a_picosecond_are_kept() {
    with_each_method(|| {
        let (belt, limit, kinetic) = (0.1, 1.0, 0.6);
        for duration in [1e-6, 1e-9, 1e-12] {
            // It is faster than the belt, which it meets where the spring has almost reached the limit:
            // x″ = −x − F_k up to there, on a circle about −F_k.
            let meets: f64 = limit - belt * duration;
            let start = ((meets + kinetic).powi(2) + belt * belt - kinetic * kinetic).sqrt();
            let parameters = [("belt", belt), ("mu_s", 0.1), ("mu_k", 0.06), ("g", 10.0)];
            let mut problem = problem("hand_belt", &parameters);
            problem.set_initial("x.rate", start).unwrap();
            problem.set_initial("slip", 1.0).unwrap();
            problem.set_tolerance(TIGHTEST);
            problem.end.time = 4.0;
            let run = run(&problem);
            assert_eq!(transitions(&run), ["stick", "slip"], "{duration:e}");
            let angle = |speed: f64, x: f64| speed.atan2(x + kinetic);
            let exact = angle(start, 0.0) - angle(belt, meets);
            let error = run.events[0].t - exact;
            assert!(error.abs() < 2e-15, "{duration:e}: sticks {error:e} off");
            // A rounding of x is ten of t.
            let error = run.events[1].t - run.events[0].t - duration;
            assert!(error.abs() < 1e-14, "{duration:e}: {error:e} off");
        }
    });
}

#[test]
fn flights_down_to_a_picosecond_are_flown() {
    with_each_method(|| {
        for e in [1e-9, 1e-12] {
            let mut problem = problem("hand_ball", &[("e", e)]);
            problem.set_initial("h", 1.0).unwrap();
            problem.set_tolerance(TIGHTEST);
            let run = run(&problem);
            let impacts = times(&run, "impact");
            let first = (2.0 / 9.81_f64).sqrt();
            assert!(relative(impacts[0], first) < 1e-15);
            // Flights of 0.9 ns and 0.9 ps: seen in t to its last place.
            let flight = impacts[1] - impacts[0];
            assert!(
                (flight - 2.0 * e * first).abs() < 2.0 * f64::EPSILON,
                "{flight:e}"
            );
            // What a flight of free fall takes off it gives back.
            let speed = run.events[1].before.v[0];
            assert!(relative(-speed, e * 9.81 * first) < 1e-14, "{speed:e}");
            // So do those after it, of 0.9e-18 s and 0.9e-24 s, far below the last place of t.
            let speed = run.events[2].before.v[0];
            let exact = e * e * 9.81 * first;
            assert!(relative(-speed, exact) < 1e-14, "{speed:e}");
            assert_eq!(times(&run, "rest").len(), 1);
        }
    });
}

#[test]
fn a_relay_switches_five_thousand_times() {
    with_each_method(|| {
        let item = item("10o_relay_hysteresis");
        let mut problem = slot(1e-4, 1.0, 0.0, 1.0);
        problem.end.time = 1.0;
        let run = run(&problem);
        let switches = times(&run, "impact");
        assert_eq!(switches.len(), 5000);
        for (k, t) in switches.iter().enumerate() {
            let exact = 1e-4 * (2 * k + 1) as f64;
            assert!((t - exact).abs() < 1e-12, "switch {k}: {t}");
        }
        assert!(relative(switches[4999], number(&item["t_5000"])) < 1e-13);
    });
}

#[test]
fn a_stop_at_the_instant_of_a_touch_is_no_impact() {
    with_each_method(|| {
        let item = item("10p_cascade_same_instant");
        let mut problem = slot(0.25, 0.5, 0.0, 1.0);
        for friction in ["static_friction", "kinetic_friction"] {
            problem.set_parameter(friction, 2.0).unwrap();
        }
        let run = run(&problem);
        assert_eq!(run.layout.modes.name(run.end.mode), "sticks");
        assert!((at_end(&run, "x") - number(&item["x"])).abs() < 1e-14);
        assert!((run.events[0].t - number(&item["t"])).abs() < 1e-8);
        assert!(run.energy.as_ref().unwrap().lost_at_impacts.abs() < 1e-15);
    });
}

#[test]
fn a_guard_that_is_zero_throughout_does_not_fire_without_end() {
    with_each_method(|| {
        let item = item("10q_guard_identically_zero");
        let mut problem = problem("circle", &[("omega", 0.1)]);
        problem.set_initial("x", 1.0).unwrap();
        problem.set_initial("y.rate", -0.1).unwrap();
        problem.set_tolerance(TIGHTEST);
        problem.end.time = 10.0;
        let run = run(&problem);
        for name in ["x", "y"] {
            assert!((at_end(&run, name) - number(&item[name])).abs() < 1e-13);
        }
        assert!(run.events.len() < 10, "{} events", run.events.len());
        // The series of the Taylor method is zero; values alone are no more than rounding.
        if run.solver.method.contains("Radau") {
            let doubts = run.uncertain;
            let unresolved = |doubt: &Doubt| doubt.what == Question::Unresolved;
            assert!(doubts.first.iter().any(unresolved), "{doubts:?}");
            assert!(doubts.first.len() <= Uncertain::MOST);
        }
    });
}

#[test]
fn simultaneous_contacts_are_recorded_at_one_instant() {
    with_each_method(|| {
        for e in [1.0, 0.5] {
            let mut problem = problem("three_balls", &[("e", e)]);
            for (name, value) in [
                ("left", -1.0),
                ("right", 1.0),
                ("left.rate", 1.0),
                ("right.rate", -1.0),
            ] {
                problem.set_initial(name, value).unwrap();
            }
            problem.end.time = 2.0;
            problem.set_tolerance(TIGHTEST);
            let run = run(&problem);
            assert!(run.events.iter().any(|e| e.transition == "left_contact"));
            assert!(run.events.iter().any(|e| e.transition == "right_contact"));
            assert!(run.events.iter().all(|e| relative(e.t, 1.0) < 1e-14));
            let v = &run.end.state.v;
            assert!(v.iter().sum::<f64>().abs() < 1e-15, "momentum: {v:?}");
            if e == 1.0 {
                assert_eq!(v[..], [-1.0, 0.0, 1.0]);
                assert_eq!(run.events.len(), 3);
            }
        }
    });
}

/// Two balls run into a third one from both sides at once. Above e = 7 − 4√3 = 0.0718 the cascade ends after so many impacts
/// as the impact law says (exact fractions); below there are infinitely many at one instant (inelastic collapse: McNamara
/// and Young 1992), after which no mode of the model goes on.
#[test]
fn a_cascade_at_one_instant_ends_or_is_named() {
    with_each_method(|| {
        for (e, impacts) in [
            (0.1, Some(6)),
            (0.08, Some(11)),
            (0.075, Some(17)),
            (0.07, None),
            (0.03, None),
            (0.0, None),
        ] {
            let mut problem = problem("three_balls", &[("e", e)]);
            for (name, value) in [
                ("left", -1.0),
                ("right", 1.0),
                ("left.rate", 1.0),
                ("right.rate", -1.0),
            ] {
                problem.set_initial(name, value).unwrap();
            }
            problem.end.time = 2.0;
            let run = simulate(&problem, &mut Silent).expect("the problem can be started");
            assert!(
                run.events.iter().all(|e| relative(e.t, 1.0) < 1e-14),
                "e = {e}"
            );
            match (impacts, &run.failure) {
                (Some(impacts), None) => assert_eq!(run.events.len(), impacts, "e = {e}"),
                (None, Some(failure)) => {
                    assert!(relative(failure.at.t, 1.0) < 1e-14, "e = {e}");
                    for part in [
                        "accumulate",
                        "left_contact, right_contact",
                        "a mode is missing",
                    ] {
                        assert!(
                            failure.reason.to_string().contains(part),
                            "{}",
                            failure.reason
                        );
                    }
                }
                (_, failure) => panic!("e = {e}: {failure:?}"),
            }
        }
    });
}

/// Two contacts of free motions within one step: what falls first happens first, however near the other is.
#[test]
fn contacts_that_all_but_coincide_are_in_order() {
    with_each_method(|| {
        for k in 3..=14 {
            for later in [10f64.powi(-k), -10f64.powi(-k)] {
                let mut problem = problem("three_balls", &[("e", 1.0)]);
                for (name, value) in [
                    ("left", -1.0),
                    ("right", 1.0 + later),
                    ("left.rate", 1.0),
                    ("right.rate", -1.0),
                ] {
                    problem.set_initial(name, value).unwrap();
                }
                problem.end.time = 2.0;
                problem.set_tolerance(TIGHTEST);
                let run = run(&problem);
                let first = &run.events[0];
                let expected = match later > 0.0 {
                    true => ("left_contact", 1.0),
                    false => ("right_contact", 1.0 + later),
                };
                assert_eq!(first.transition, expected.0, "{later:e}");
                assert!(relative(first.t, expected.1) < 1e-15, "{later:e}");
            }
        }
    });
}
