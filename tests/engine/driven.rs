//! Prescribed motions that are not of the ground: a belt and a crank, from where they start.

use super::multipliers::sine;
use crate::common::*;
use crate::peaks::{peak, record_all};
use dalembert::hybrid::{Method, Observed, OwnLimit, Problem, simulate};
use dalembert::input::{Function, Interpolation, Outside, Sine, Table};
use dalembert::model::models;
use dalembert::record::Silent;
use dalembert::scene::{Disk, Scene};
use std::f64::consts::TAU;
use std::path::Path;

const METHODS: [Method; 2] = [Method::Taylor, Method::Radau];

fn at_tolerance(mut problem: Problem, method: Method, end: f64) -> Problem {
    problem.set_tolerance(1e-12);
    problem.method = method;
    problem.end.time = end;
    problem
}

/// A mass on a belt, and two on a table, that are driven, by both methods.
pub fn carried() -> Vec<(String, Problem)> {
    let of = |method| {
        let mut belt = problem("driven_belt", &[("k", 30.0)]);
        belt.set_initial("belt", 3.0).unwrap();
        let mut table = problem("masses_on_a_table", &[]);
        table.set_initial("one", 0.2).unwrap();
        table.set_initial("other", 0.3).unwrap();
        for (problem, input) in [(&mut belt, "belt_acceleration"), (&mut table, "a")] {
            problem.set_input(input, sine("6 sin(5 t+0.4)")).unwrap();
            problem.method = method;
            problem.end.time = 3.0;
        }
        [("belt", belt), ("table", table)]
            .map(|(name, problem)| (format!("{name} by {method:?}"), problem))
    };
    METHODS.into_iter().flat_map(of).collect()
}

#[test]
fn a_belt_of_constant_speed_is_one_whose_speed_is_a_parameter() {
    for method in METHODS {
        let mut by_parameter = problem("belt_oscillator", &[("belt", 0.1), ("k", 20.0)]);
        by_parameter.set_initial("x.rate", 0.1).unwrap();
        let mut driven = problem("driven_belt", &[("k", 20.0)]);
        for (what, value) in [("x.rate", 0.1), ("belt.rate", 0.1), ("belt", 3.0)] {
            driven.set_initial(what, value).unwrap();
        }
        let [expected, found] = [by_parameter, driven].map(|p| run(&at_tolerance(p, method, 40.0)));
        for (expected_name, name) in [("belt slips", "base slips"), ("belt sticks", "base sticks")]
        {
            let [expected, found] = [times(&expected, expected_name), times(&found, name)];
            assert_eq!(expected.len(), found.len());
            assert!(found.len() > 3, "{found:?}");
            for (expected, found) in expected.iter().zip(&found) {
                assert!(
                    (expected - found).abs() < 1e-11,
                    "{method:?}: {expected} {found}"
                );
            }
        }
        for column in ["x", "x.rate"] {
            let [expected, found] = [&expected, &found].map(|run| at_end(run, column));
            assert!(
                (expected - found).abs() < 1e-11,
                "{method:?}: {column} {expected} {found}"
            );
        }
    }
}

#[test]
fn a_belt_that_is_braked_lets_its_mass_slip_until_that_is_as_slow() {
    let (v, braking, until, slows) = (1.0, 6.0, 0.1, 0.25 * 9.81);
    for method in METHODS {
        let mut driven = problem("driven_belt", &[("k", 0.0)]);
        for rate in ["x.rate", "belt.rate"] {
            driven.set_initial(rate, v).unwrap();
        }
        let rows = ([0.0, until], [-braking, 0.0]);
        let table = Table::new(&rows.0, &rows.1, Interpolation::Previous, Outside::Zero).unwrap();
        driven.set_input("belt_acceleration", table.into()).unwrap();
        let run = run(&at_tolerance(driven, method, 0.5));
        let [stops] = times(&run, "base sticks")[..] else {
            panic!("{:?}", transitions(&run));
        };
        let expected = braking * until / slows;
        assert!(
            (stops - expected).abs() < 1e-13,
            "{method:?}: {stops} {expected}"
        );
        let after = v - braking * until;
        let x = v * stops - 0.5 * slows * stops * stops + after * (0.5 - stops);
        assert!((at_end(&run, "x") - x).abs() < 1e-13, "{method:?}");
        // The mass slips on by how much farther it goes than the belt.
        let belt = v * stops - braking * until * (stops - 0.5 * until);
        let slipped = v * stops - 0.5 * slows * stops * stops - belt;
        let energy = run.energy.as_ref().unwrap();
        assert!(
            (energy.dissipated - slows * slipped).abs() < 1e-12,
            "{energy:?}"
        );
        assert!(energy.imbalance().abs() < 1e-13, "{energy:?}");
    }
}

#[test]
fn a_driven_crank_moves_its_slider_as_the_closed_form_says() {
    let (r, l, m, rod, rate, acceleration) = (0.1, 0.3, 2.0, 0.5, 10.0, -3.0);
    let psi = |phi: f64| (r * phi.sin() / l).asin();
    let x = |phi: f64| r * phi.cos() + l * psi(phi).cos();
    let phi = |t: f64| 0.4 + rate * t + 0.5 * acceleration * t * t;
    let energy = |t: f64| {
        let (phi, rate) = (phi(t), rate + acceleration * t);
        let psi_rate = r * phi.cos() * rate / (l * psi(phi).cos());
        let x_rate = -r * phi.sin() * rate - l * psi(phi).sin() * psi_rate;
        let half = 0.5 * l * psi_rate;
        let [u, w] = [x_rate + half * psi(phi).sin(), half * psi(phi).cos()];
        0.5 * (m * x_rate * x_rate
            + rod * (u * u + w * w)
            + rod * l * l / 12.0 * psi_rate * psi_rate)
    };
    for method in METHODS {
        let mut driven = problem("driven_crank", &[]);
        let psi_rate = r * 0.4_f64.cos() * rate / (l * psi(0.4).cos());
        let x_rate = -r * 0.4_f64.sin() * rate - l * psi(0.4).sin() * psi_rate;
        let start = [
            ("phi", 0.4),
            ("phi.rate", rate),
            ("x", x(0.4)),
            ("psi", psi(0.4)),
            ("x.rate", x_rate),
            ("psi.rate", psi_rate),
        ];
        for (what, value) in start {
            driven.set_initial(what, value).unwrap();
        }
        // An input that is set later leaves it where it starts.
        let constant = Function::constant(acceleration);
        driven.set_input("crank_acceleration", constant).unwrap();
        driven.record.columns.reactions = true;
        let end = 1.7;
        let run = run(&at_tolerance(driven, method, end));
        for (column, expected) in [("x", x(phi(end))), ("psi", psi(phi(end)))] {
            let found = at_end(&run, column);
            assert!(
                (found - expected).abs() < 1e-14,
                "{method:?}: {column} {found} {expected}"
            );
        }
        // What drives the crank is the power over its rate; a central difference of fourth order.
        let h = 1e-3;
        let change = |k: f64| energy(end + k * h) - energy(end - k * h);
        let power = (8.0 * change(1.0) - change(2.0)) / (12.0 * h);
        let last = run.trajectory.len() - 1;
        let column = run.trajectory.column("reaction.phi").unwrap();
        let torque = run.trajectory.row(last)[column];
        let expected = power / (rate + acceleration * end);
        assert!(
            (torque - expected).abs() < 1e-8,
            "{method:?}: {torque} {expected}"
        );
        let ledger = run.energy.as_ref().unwrap();
        let work = energy(end) - energy(0.0);
        assert!(
            (ledger.input_work - work).abs() < 1e-10,
            "{ledger:?} {work}"
        );
    }
}

#[test]
fn a_scene_says_where_a_motion_starts() {
    let scene = |initial: &str| {
        let text =
            format!(r#"{{ "model": "driven_belt", "initial": {{ {initial} }}, "end": 0.2 }}"#);
        let path = Path::new("belt.json");
        Scene::parse(text.as_bytes(), path, &[], models(), &Disk)
    };
    let problem = scene(r#""belt": "30 mm", "belt.rate": 0.1, "x.rate": "10 cm/s""#)
        .unwrap()
        .problem;
    let mut expected = common_belt();
    expected.end.time = 0.2;
    assert_eq!(problem.signals, expected.signals);
    let mut problem = problem;
    problem.record.columns.inputs = true;
    let run_of_it = run(&problem);
    let signals = &run_of_it.layout.inputs;
    let said = |name: &str| {
        let of = signals.iter().find(|s| s.name == name).expect("a signal");
        of.meaning.clone()
    };
    let rate = said("belt_acceleration.velocity");
    assert!(rate.ends_with("from where belt starts"), "{rate}");
    assert_eq!(transitions(&run_of_it), [""; 0]);
    let refused = scene(r#""belt_acceleration": 1"#).map(|_| ()).unwrap_err();
    assert!(
        refused.to_string().contains("belt_acceleration"),
        "{refused}"
    );
}

/// A belt that starts 30 mm on, at 0.1 m/s, with its mass.
fn common_belt() -> Problem {
    let mut belt = problem("driven_belt", &[]);
    for (what, value) in [("belt", 0.03), ("belt.rate", 0.1), ("x.rate", 0.1)] {
        belt.set_initial(what, value).unwrap();
    }
    belt
}

#[test]
fn only_what_is_not_of_the_ground_starts_somewhere() {
    let mut driven = problem("driven_belt", &[]);
    let refused = driven.set_initial("belt.rate", f64::NAN).unwrap_err();
    assert!(
        refused.to_string().contains("initial `belt.rate`"),
        "{refused}"
    );
    let mut block = problem("rigid_block", &[]);
    let refused = block.set_initial("x_g.rate", 1.0).unwrap_err();
    assert!(refused.to_string().contains("x_g.rate"), "{refused}");
    // Nor does it have to be given.
    let run = simulate(&driven, &mut Silent).unwrap();
    assert_eq!(run.failure.map(|f| f.reason.to_string()), None);
}

/// Two that hop side by side have an accumulation each; neither is taken for lower hops of the other, both rest at the same limit, and
/// that is where one rests alone. Heights are far above the hops, so that the last of these are below rounding.
#[test]
fn masses_that_hop_side_by_side_on_a_driven_table_rest_together() {
    let ends = |other: f64| {
        let mut masses = problem("masses_on_a_table", &[]);
        for (what, value) in [("table", 0.7), ("one", 0.9), ("other", other)] {
            masses.set_initial(what, value).unwrap();
        }
        let shakes = sine("4 sin(9 t+1)");
        masses.set_input("a", shakes).unwrap();
        let mut masses = at_tolerance(masses, Method::Taylor, 0.6);
        masses.record.columns.outputs = true;
        masses.record.every = Some(0.01);
        run(&masses)
    };
    let [both, alone] = [0.9, 20.0].map(ends);
    let rests = times(&both, "rest");
    let [first, second] = rests[..] else {
        panic!("{:?}", transitions(&both));
    };
    assert_eq!(first, second);
    let [expected] = times(&alone, "rest")[..] else {
        panic!("{:?}", transitions(&alone));
    };
    assert!((first - expected).abs() < 1e-9, "{first} {expected}");
    let strikes = ["first strikes", "second strikes"].map(|name| times(&both, name).len());
    assert!(strikes[0].abs_diff(strikes[1]) <= 1, "{strikes:?}");
    for name in ["first.gap", "second.gap"] {
        let column = both.trajectory.column(name).expect("a column");
        let (_, peak) = (both.peaks.iter().find(|(of, _)| *of == column)).expect("a peak");
        assert!(peak.min > -1e-12, "{name}: {peak:?}");
    }
    let ledger = both.energy.as_ref().unwrap();
    assert!(ledger.imbalance().abs() < 1e-11, "{ledger:?}");
}

/// Where a function that is positive at 0 first falls through zero, by steps that do not miss it and by halves of one.
fn first_fall(function: impl Fn(f64) -> f64, step: f64) -> f64 {
    let mut low = 0.0;
    while function(low + step) > 0.0 {
        low += step;
    }
    let mut high = low + step;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if function(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// A cam that turns ever faster loses its follower when its force first vanishes, after a hundred turns in which nothing that is free moves, or
/// only another follower falls.
#[test]
fn a_follower_leaves_its_cam_when_its_force_vanishes() {
    let (m, c, k, l, g) = (0.5, 0.01, 2000.0, 0.02, 9.81);
    let force = |t: f64| {
        let (phi, rate) = (20.0 * t + 5.0 * t * t, 20.0 + 10.0 * t);
        let acceleration = c * (10.0 * phi.cos() - rate * rate * phi.sin());
        k * (c * phi.sin() + l) + m * (g + acceleration)
    };
    let leaves = first_fall(force, 1e-4);
    for (form, method, height) in [
        ("reduced", Method::Taylor, 0.0),
        ("reduced", Method::Taylor, 1e4),
        ("reduced", Method::Radau, 0.0),
        ("reduced", Method::Radau, 1e4),
        ("multipliers", Method::Taylor, 0.0),
    ] {
        let mut cam = problem("cam", &[]);
        cam.choose(&[("form", form)]).unwrap();
        for (what, value) in [("phi.rate", 20.0), ("y.rate", c * 20.0), ("z", height)] {
            cam.set_initial(what, value).unwrap();
        }
        cam.set_input("spin", Function::constant(10.0)).unwrap();
        cam.set_tolerance(1e-11);
        cam.method = method;
        cam.end.time = 20.0;
        cam.end.after = Some(("cam opens", 1));
        let run = run(&cam);
        let of = format!("{form} by {method:?} from {height}");
        assert!(
            (run.end.t - leaves).abs() < 1e-9,
            "{of}: {} and {leaves}",
            run.end.t
        );
        let energy = run.energy.as_ref().unwrap();
        assert!(energy.imbalance().abs() < 1e-7, "{of}: {energy:?}");
    }
}

/// A limit on the speed of either sign that the cam gives: not smooth, so that it has no series, but what it is made of has.
#[test]
fn a_limit_that_is_not_smooth_is_reached_in_time() {
    let (c, most) = (0.01, 1.6);
    let rate = |t: f64| c * (20.0 + 10.0 * t) * (20.0 * t + 5.0 * t * t).cos();
    let expected = first_fall(|t| most - rate(t).abs(), 1e-5);
    for method in METHODS {
        let mut cam = problem("cam", &[("c", c), ("most", most)]);
        cam.choose(&[("form", "none")]).unwrap();
        // What falls for twenty seconds does not know of the cam.
        for (what, value) in [("phi.rate", 20.0), ("z", 2e3)] {
            cam.set_initial(what, value).unwrap();
        }
        cam.set_parameter("k", 0.0).unwrap();
        cam.set_input("spin", Function::constant(10.0)).unwrap();
        cam.set_tolerance(1e-11);
        cam.method = method;
        cam.end.time = 20.0;
        let run = run(&cam);
        let [state] = &run.reached.limit_states[..] else {
            panic!("{method:?}: {:?}", run.reached)
        };
        assert!(
            (state.t - expected).abs() < 1e-12,
            "{method:?}: {state:?} and {expected}"
        );
    }
}

/// A follower that is tied to the cam: nothing is free and nothing happens, and extremes and energies follow its crests all the same.
#[test]
fn a_follower_that_is_tied_to_its_cam_is_followed() {
    let c = 0.01;
    let rate = |t: f64| c * (20.0 + 10.0 * t) * (20.0 * t + 5.0 * t * t).cos();
    let fastest = (0..800_000).map(|i| rate(f64::from(i) * 1e-5));
    let fastest = fastest.fold(0.0, f64::max);
    for method in METHODS {
        let mut cam = problem("cam", &[("c", c)]);
        cam.choose(&[("form", "tied")]).unwrap();
        cam.set_initial("phi.rate", 20.0).unwrap();
        cam.set_initial("y.rate", c * 20.0).unwrap();
        cam.set_input("spin", Function::constant(10.0)).unwrap();
        cam.set_tolerance(1e-11);
        cam.method = method;
        cam.end.time = 8.0;
        let run = run(&cam);
        let energy = run.energy.as_ref().unwrap();
        assert!(energy.imbalance().abs() < 1e-9, "{method:?}: {energy:?}");
        let column = run.trajectory.column("y.rate").unwrap();
        let peak = run.peaks.iter().find(|(i, _)| *i == column).unwrap().1;
        assert!(
            (peak.max / fastest - 1.0).abs() < 1e-6,
            "{method:?}: {peak:?}, {fastest}"
        );
    }
}

/// A ball falls slowly on to a table that shakes fast: hundreds of crests in one flight, of which it meets the first that is as high.
#[test]
fn a_slow_ball_meets_the_first_crest_of_a_fast_table() {
    let (g, high, amplitude) = (0.5, 3.0, 0.02);
    for frequency in [20.0, 50.0, 73.0, 200.0] {
        let omega = TAU * frequency;
        let gap = |t: f64| high - 0.5 * g * t * t + amplitude * (omega * t).sin();
        let meets = first_fall(gap, 1e-3 / frequency);
        for form in ["reduced", "multipliers"] {
            for method in METHODS {
                let mut ball = problem("table_ball", &[("g", g)]);
                ball.choose(&[("form", form)]).unwrap();
                ball.set_initial("y", high).unwrap();
                ball.set_initial("table.rate", -amplitude * omega).unwrap();
                let shakes = Sine::new(amplitude * omega * omega, omega, 0.0);
                ball.set_input("a", shakes.into()).unwrap();
                ball.set_tolerance(1e-11);
                ball.method = method;
                ball.end.time = 5.0;
                ball.end.after = Some(("table strikes", 1));
                let run = run(&ball);
                let of = format!(
                    "{form} by {method:?}, {frequency} Hz: {} and {meets}",
                    run.end.t
                );
                assert!((run.end.t - meets).abs() < 1e-10, "{of}");
            }
        }
    }
}

/// Pairs of frequencies, rad/s, of a load 0.55 (sin at + sin(bt + 3)), N. A search by values alone misses the first crest above 1 N at the
/// first three.
const LOADS: [(f64, f64); 4] = [
    (1286.4, 1303.9),
    (2327.6, 2360.3),
    (3026.3, 3069.2),
    (440.0, 443.0),
];

/// A ball in a long flight with such a load, in each form and by each method.
fn with_each_load(input: &str, end: f64, test: impl Fn(&str, Problem, &dyn Fn(f64) -> f64)) {
    for (a, b) in LOADS {
        let load = |t: f64| 0.55 * ((a * t).sin() + (b * t + 3.0).sin());
        for form in ["reduced", "multipliers"] {
            for method in METHODS {
                let mut ball = problem("table_ball", &[]);
                ball.choose(&[("form", form)]).unwrap();
                ball.set_initial("y", 1e3).unwrap();
                let sines = [(a, 0), (b, 3)]
                    .map(|(omega, phase)| sine(&format!("0.55 sin({omega} t+{phase})")));
                ball.set_input(input, Function::sum(sines)).unwrap();
                let of = format!("{form} by {method:?}, {a} and {b} rad/s");
                test(&of, at_tolerance(ball, method, end), &load);
            }
        }
    }
}

/// A limit on an input that nothing else depends on, of the model or of the problem: of hundreds of crests in one flight the first that is
/// as high.
#[test]
fn a_limit_on_what_the_motion_does_not_know_is_reached_in_time() {
    for input in ["load", "wind"] {
        with_each_load(input, 10.0, |of, mut ball, load| {
            let expected = first_fall(|t| 1.0 - load(t), 1e-6);
            if input == "wind" {
                ball.add_output("own", "N", "2 * twice", "four times the wind")
                    .unwrap();
                ball.limits.own = vec![OwnLimit {
                    name: "mine".into(),
                    message: "it is too much".into(),
                    of: Observed::Output(ball.output("own").unwrap()),
                    above: true,
                    level: 4.0,
                    ends: true,
                }];
            }
            let run = run(&ball);
            let [state] = &run.reached.limit_states[..] else {
                panic!("{input}, {of}: {:?}", run.reached)
            };
            assert!(
                (state.t - expected).abs() < 1e-10,
                "{input}, {of}: {state:?} and {expected}"
            );
        });
    }
}

/// The largest value of an output that the motion does not know, in a flight of hundreds of crests.
#[test]
fn the_extremes_of_what_the_motion_does_not_know_are_found() {
    with_each_load("wind", 0.5, |of, mut ball, load| {
        record_all(&mut ball, Some(f64::INFINITY));
        ball.record.columns.outputs = true;
        let run = run(&ball);
        // Through three neighbours a parabola.
        let step = 2e-6;
        let values: Vec<f64> = (0..=250_000).map(|k| load(f64::from(k) * step)).collect();
        let crest = |[a, b, c]: [f64; 3]| match b >= a && b >= c {
            true => b - (c - a) * (c - a) / (8.0 * (a + c - 2.0 * b)),
            false => b,
        };
        let largest = |sign: f64| {
            let crests = values
                .windows(3)
                .map(|w| crest([w[0], w[1], w[2]].map(|v| sign * v)));
            crests.fold(f64::NEG_INFINITY, f64::max)
        };
        let found = peak(&run, "twice");
        for (found, exact) in [(found.max, largest(1.0)), (-found.min, largest(-1.0))] {
            assert!(
                (found - 2.0 * exact).abs() < 1e-9,
                "{of}: {found} and {}",
                2.0 * exact
            );
        }
    });
}
