//! Runs in parts: the same bits as the whole, inputs that are commanded on the way, and why an advance stops.

use crate::common::problem;
use dalembert::hybrid::{
    Checkpoint, Invalid, Method, Misfit, Observed, OwnLimit, Problem, Reason, Simulator, Stopped,
    simulate,
};
use dalembert::input::{Command, Function, Interpolation, Outside, Table};
use dalembert::model::models;
use dalembert::record::{ColumnKind, Jump, Silent};
use dalembert::scene::{Disk, Scene};
use std::path::{Path, PathBuf};

const METHODS: [Method; 2] = [Method::Auto, Method::Radau];

/// The shipped scenes, by name, by both methods.
fn scenes() -> Vec<(String, Problem)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .collect();
    paths.sort();
    let each = |path: &PathBuf| {
        let text = std::fs::read(path).unwrap();
        let scene = Scene::parse(&text, path, &[], models(), &Disk);
        let problem = scene.unwrap().problem;
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        METHODS.map(|method| {
            let problem = Problem {
                method,
                ..problem.clone()
            };
            (format!("{name} by {method:?}"), problem)
        })
    };
    // Radau does not pass singular positions at this tolerance.
    let stops = |name: &str| name == "double_four_bar by Radau";
    (paths.iter().flat_map(each))
        .filter(|(name, _)| !stops(name))
        .collect()
}

/// State and discrete state by their bits, and the transitions.
fn bits(simulator: &Simulator) -> (Vec<u64>, Vec<Jump>) {
    let state = [simulator.q(), simulator.v(), simulator.discrete()].concat();
    let state = state.into_iter().map(f64::to_bits).collect();
    (state, simulator.events().to_vec())
}

/// Irregular parts of a duration, the same in every run: a logistic map (Ulam and von Neumann 1947).
fn parts(duration: f64, count: usize) -> impl Iterator<Item = f64> {
    let chaos = std::iter::successors(Some(0.3), |&x| Some(4.0 * x * (1.0 - x)));
    let mean = duration / count as f64;
    let times = chaos.scan(0.0, move |t, x| {
        *t += 2.0 * mean * x;
        Some(*t)
    });
    times.take_while(move |&t| t < duration)
}

#[test]
fn the_times_at_which_a_run_is_stopped_change_no_bit_of_it() {
    for (name, problem) in scenes() {
        let mut whole = Simulator::new(&problem).unwrap();
        whole.run(&mut Silent).unwrap();
        let mut in_parts = Simulator::new(&problem).unwrap();
        let (mut stopped, mut events) = (0, 0);
        for (i, t) in parts(problem.end.time, 300).enumerate() {
            let why = match i % 3 {
                0 => in_parts.advance_to_event(t).unwrap(),
                _ => in_parts.advance_to(t).unwrap(),
            };
            match why {
                Stopped::Time => assert_eq!(in_parts.time(), t, "{name}"),
                Stopped::Event | Stopped::Rest => events += 1,
                Stopped::End => assert_eq!(in_parts.time(), whole.time(), "{name}"),
                Stopped::Limit => panic!("{name}: no scene ends at a limit"),
            }
            // Looking disturbs nothing.
            let now = in_parts.moment();
            let mut reactions = vec![0.0; now.q().len() + problem.model.motions.len()];
            now.reactions(&mut reactions);
            let all = [now.q(), now.v(), now.a(), &reactions, &now.energies()].concat();
            assert!(all.iter().all(|x| x.is_finite()), "{name} at {t} s");
            stopped += 1;
        }
        let last = in_parts.advance_to(f64::INFINITY).unwrap();
        assert_eq!(last, Stopped::End, "{name}");
        assert_eq!(in_parts.time(), whole.time(), "{name}");
        assert_eq!(bits(&in_parts), bits(&whole), "{name}");
        assert_eq!(in_parts.mode(), whole.mode(), "{name}");
        assert_eq!(in_parts.solver(), whole.solver(), "{name}");
        assert!(stopped > 100, "{name}: {stopped} stops, {events} events");
        in_parts.rewind();
        assert_eq!(in_parts.time(), 0.0);
        in_parts.run(&mut Silent).unwrap();
        assert_eq!(bits(&in_parts), bits(&whole), "{name} again");
    }
}

#[test]
fn what_is_seen_on_the_way_is_what_a_run_records() {
    for (name, mut problem) in scenes() {
        problem.record.columns.reactions = true;
        problem.record.every = Some(problem.end.time / 64.0);
        let run = simulate(&problem, &mut Silent).unwrap();
        let mut simulator = Simulator::new(&problem).unwrap();
        let n = run.layout.coordinates.len();
        let mut compared = 0;
        for (row, &t) in run.trajectory.t.iter().enumerate() {
            simulator.advance_to(t).unwrap();
            // At its very end a step is not the polynomial but what it was made for.
            if simulator.at(f64::INFINITY).unwrap_err().to == t {
                continue;
            }
            compared += 1;
            let now = simulator.moment();
            let (all, motions) = (now.q().len(), problem.model.motions.len());
            let mut reactions = vec![0.0; all + motions];
            now.reactions(&mut reactions);
            // Those of multipliers are outputs of contacts.
            let reactions = [&reactions[..n], &reactions[all..]].concat();
            let recorded = run.trajectory.row(row);
            let [state, held] =
                [0..2 * n, run.layout.range(ColumnKind::Reaction)].map(|range| &recorded[range]);
            let own = [&now.q()[..n], &now.v()[..n]].concat();
            assert_eq!(state, own, "{name} at {t} s");
            assert_eq!(held, reactions, "{name} at {t} s");
        }
        assert!(compared > 50, "{name}: {compared} rows are within steps");
    }
}

/// A table of holds or ramps, and the commands that say the same: holds to the bit, ramps to the tolerance; both at multiples of 0.25 s, of a problem up to 5 s.
fn commanded(of: &Problem, input: &str, size: f64, ramps: bool) {
    let times: Vec<f64> = (0..20).map(|i| 0.25 * f64::from(i)).collect();
    let values: Vec<f64> = parts(20.0, 40)
        .map(|t| size * (t - t.floor() - 0.5))
        .take(20)
        .collect();
    let interpolation = match ramps {
        true => Interpolation::Linear,
        false => Interpolation::Previous,
    };
    let table = Table::new(&times, &values, interpolation, Outside::Hold).unwrap();
    let (mut given, mut commanded) = (of.clone(), of.clone());
    (given.end.time, commanded.end.time) = (5.0, 5.0);
    given.set_input(input, table.into()).unwrap();
    commanded
        .set_input(input, Function::commanded(values[0]))
        .unwrap();
    for method in METHODS {
        (given.method, commanded.method) = (method, method);
        let mut whole = Simulator::new(&given).unwrap();
        whole.run(&mut Silent).unwrap();
        let mut in_parts = Simulator::new(&commanded).unwrap();
        for _ in 0..2 {
            for (i, &t) in times.iter().enumerate() {
                // An event may be where it is stopped first.
                while in_parts.advance_to_event(t).unwrap() != Stopped::Time {}
                assert_eq!(in_parts.time(), t);
                let command = match (ramps, times.get(i + 1)) {
                    (true, Some(&until)) => Command::Ramp {
                        to: values[i + 1],
                        until,
                    },
                    _ => Command::Hold(values[i]),
                };
                in_parts.command(input, command).unwrap();
                assert_eq!(in_parts.moment().input(input), Some(values[i]));
            }
            assert_eq!(in_parts.advance_to(5.0).unwrap(), Stopped::End);
            let name = given.model.name;
            assert!(!whole.events().is_empty(), "{name}: nothing happens");
            let what = format!("{name} by {method:?}, ramps: {ramps}");
            match ramps {
                // The motion starts anew with a command, and not at a kink of a table.
                true => {
                    let of = |s: &Simulator| [s.q().to_vec(), s.v().to_vec()].concat();
                    let pairs = of(&in_parts).into_iter().zip(of(&whole));
                    let error = pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
                    assert!(error <= given.accuracy.relative, "{what}: {error:e}");
                    let names = |s: &Simulator| -> Vec<_> {
                        s.events().iter().map(|e| e.transition).collect()
                    };
                    assert_eq!(names(&in_parts), names(&whole), "{what}");
                }
                false => assert_eq!(bits(&in_parts), bits(&whole), "{what}"),
            }
            in_parts.rewind();
        }
    }
}

#[test]
fn a_commanded_input_moves_as_the_table_that_says_the_same() {
    let slider = problem("hand_coulomb", &[]);
    let mut block = problem("rocking_block", &[]);
    block.set_initial("theta", 0.01).unwrap();
    for ramps in [false, true] {
        commanded(&slider, "force", 2.0, ramps);
        commanded(&block, "ground_acceleration", 4.0, ramps);
    }
}

#[test]
fn an_advance_says_why_it_stops() {
    let mut ball = problem("hand_ball", &[]);
    ball.set_initial("h", 1.0).unwrap();
    ball.end.time = 10.0;
    let mut simulator = Simulator::new(&ball).unwrap();
    assert_eq!(simulator.advance_to(0.1).unwrap(), Stopped::Time);
    assert_eq!(simulator.advance_to(0.1).unwrap(), Stopped::Time);
    assert_eq!(simulator.time(), 0.1);
    let height = simulator.q()[0];
    assert!(height < 1.0 && simulator.at(0.1).unwrap().q()[0] == height);
    assert_eq!(simulator.advance_to_event(5.0).unwrap(), Stopped::Event);
    assert_eq!(simulator.events().len(), 1);
    assert_eq!(simulator.time(), simulator.events()[0].t);
    assert!(simulator.v()[0] > 0.0, "the state is that after the impact");
    let beyond = simulator.at(20.0).unwrap_err();
    assert_eq!(beyond.to, simulator.time());
    while simulator.advance_to_event(9.0).unwrap() == Stopped::Event {}
    assert_eq!(simulator.events().last().unwrap().transition, "rest");
    assert_eq!(simulator.q(), [0.0]);
    assert_eq!(simulator.advance_to_event(9.0).unwrap(), Stopped::Time);
    assert_eq!(simulator.advance_to(11.0).unwrap(), Stopped::End);
    assert_eq!(simulator.advance_to(12.0).unwrap(), Stopped::End);
    assert_eq!(simulator.time(), 10.0);
}

#[test]
fn an_advance_ends_at_a_limit_state_and_stays_there() {
    let mut ball = problem("hand_ball", &[]);
    ball.set_initial("h", 1.0).unwrap();
    ball.limits.own.push(OwnLimit {
        name: "low".into(),
        message: "the ball is low".into(),
        of: Observed::Coordinate(0),
        above: false,
        level: 0.5,
        ends: true,
    });
    for method in METHODS {
        ball.method = method;
        let mut simulator = Simulator::new(&ball).unwrap();
        assert_eq!(simulator.advance_to(0.3).unwrap(), Stopped::Time);
        let checkpoint = kept(&simulator.snapshot().unwrap());
        for _ in 0..2 {
            assert_eq!(simulator.advance_to(0.5).unwrap(), Stopped::Limit);
            let exact = (2.0 * 0.5 / 9.81_f64).sqrt();
            assert!(
                (simulator.time() - exact).abs() < 1e-7,
                "{}",
                simulator.time()
            );
            assert_eq!(simulator.advance_to_event(0.9).unwrap(), Stopped::Limit);
            assert_eq!(simulator.reached().limit_states[0].name, "low");
            simulator.restore(&checkpoint).unwrap();
            assert_eq!(simulator.time(), 0.3);
            assert!(simulator.reached().limit_states.is_empty());
        }
    }
}

#[test]
fn a_run_that_cannot_go_on_says_so_each_time_and_keeps_its_state() {
    let mut block = problem("rocking_block", &[]);
    block
        .set_input("ground_acceleration", Function::commanded(0.0))
        .unwrap();
    block.set_initial("theta", 0.01).unwrap();
    let mut simulator = Simulator::new(&block).unwrap();
    simulator.advance_to(0.01).unwrap();
    simulator
        .command("ground_acceleration", Command::Hold(1e4))
        .unwrap();
    let why = simulator.advance_to(0.5).unwrap_err();
    assert!(matches!(why, Reason::Requirement { .. }), "{why}");
    assert_eq!(simulator.advance_to(0.6).unwrap_err(), why);
    assert!(simulator.time() < 0.5 && simulator.q().iter().all(|q| q.is_finite()));
    simulator.rewind();
    assert_eq!(simulator.advance_to(0.01).unwrap(), Stopped::Time);
}

#[test]
fn commands_that_are_none_are_refused() {
    let mut slider = problem("hand_coulomb", &[]);
    let refused = |problem: &Problem, input: &str, command| {
        let mut simulator = Simulator::new(problem).unwrap();
        simulator.advance_to(0.5).unwrap();
        simulator.command(input, command).unwrap_err()
    };
    let not = refused(&slider, "force", Command::Hold(1.0));
    assert_eq!(not, Invalid::NotCommanded { input: "force" });
    slider.set_input("force", Function::commanded(1.0)).unwrap();
    let unknown = refused(&slider, "torque", Command::Hold(1.0));
    assert!(matches!(unknown, Invalid::Unknown(_)), "{unknown}");
    for command in [
        Command::Hold(f64::NAN),
        Command::Ramp {
            to: f64::INFINITY,
            until: 1.0,
        },
        Command::Ramp {
            to: 1.0,
            until: 0.5,
        },
        Command::Ramp {
            to: 1.0,
            until: f64::INFINITY,
        },
    ] {
        let wrong = refused(&slider, "force", command);
        assert!(matches!(wrong, Invalid::Command { .. }), "{wrong}");
    }
}

/// Through text and back.
fn kept(checkpoint: &Checkpoint) -> Checkpoint {
    let text = serde_json::to_string(checkpoint).unwrap();
    let back = serde_json::from_str(&text).unwrap();
    assert_eq!(checkpoint, &back);
    back
}

/// Seven masses on a belt: more free coordinates than the engine is compiled for, by both methods.
fn seven_masses() -> impl Iterator<Item = (String, Problem)> {
    METHODS.into_iter().map(|method| {
        let mut masses = problem("spring_chain", &[]);
        masses.choose(&[("masses", "7")]).unwrap();
        masses.method = method;
        masses.end.time = 6.0;
        (format!("seven masses by {method:?}"), masses)
    })
}

#[test]
fn a_run_that_was_saved_and_restored_anywhere_gives_the_same_bits() {
    let scenes = scenes().into_iter().chain(seven_masses());
    let scenes = scenes.chain(super::lines::wheels());
    for (name, mut problem) in scenes.chain(super::driven::carried()) {
        problem.record.columns.energies = true;
        let end = problem.end.time;
        let mut whole = Simulator::new(&problem).unwrap();
        assert_eq!(whole.advance_to(end).unwrap(), Stopped::End);
        let mut first = Simulator::new(&problem).unwrap();
        let mut other = Simulator::new(&problem).unwrap();
        let mut events = Vec::new();
        for (i, t) in parts(end, 60).enumerate() {
            // Each part by another simulator than the one before, which has gone on meanwhile.
            match i % 2 {
                0 => first.advance_to(t).map(|_| ()).unwrap(),
                _ => first.advance_to_event(t).map(|_| ()).unwrap(),
            }
            let checkpoint = kept(&first.snapshot().unwrap());
            assert_eq!(checkpoint.time(), first.time());
            events.extend_from_slice(first.events());
            other.restore(&checkpoint).unwrap();
            assert!(other.events().is_empty());
            let [one, two] = [&mut first, &mut other].map(|run| {
                let now = run.moment();
                let mut reactions = vec![0.0; now.q().len() + problem.model.motions.len()];
                now.reactions(&mut reactions);
                ([now.q(), now.v(), now.a(), &reactions].concat(), now.mode())
            });
            assert_eq!(one, two, "{name} at {t} s");
            assert!(
                kept(&other.snapshot().unwrap()) == checkpoint,
                "{name} at {t} s"
            );
            first.advance_to(t + 0.1 * end).unwrap();
            std::mem::swap(&mut first, &mut other);
        }
        assert_eq!(first.advance_to(end).unwrap(), Stopped::End);
        events.extend_from_slice(first.events());
        assert_eq!(bits(&first).0, bits(&whole).0, "{name}");
        assert_eq!(events, whole.events(), "{name}");
        assert_eq!(first.solver(), whole.solver(), "{name}");
        assert_eq!(first.reached(), whole.reached(), "{name}");
        // Ledger, doubts and all else, too.
        assert!(
            first.snapshot().unwrap() == whole.snapshot().unwrap(),
            "{name}"
        );
    }
}

#[test]
fn a_run_is_restored_inside_of_an_accumulation_and_between_commands() {
    let mut ball = problem("hand_ball", &[]);
    ball.set_initial("h", 1.0).unwrap();
    ball.end.time = 10.0;
    for method in METHODS {
        ball.method = method;
        let mut whole = Simulator::new(&ball).unwrap();
        whole.advance_to(10.0).unwrap();
        let mut simulator = Simulator::new(&ball).unwrap();
        let (mut events, mut stopped) = (Vec::new(), Stopped::Event);
        while stopped == Stopped::Event {
            stopped = simulator.advance_to_event(10.0).unwrap();
            let checkpoint = kept(&simulator.snapshot().unwrap());
            events.extend_from_slice(simulator.events());
            simulator = Simulator::new(&ball).unwrap();
            simulator.restore(&checkpoint).unwrap();
        }
        assert_eq!(stopped, Stopped::Rest);
        assert_eq!(events, whole.events());
    }
    let mut slider = problem("hand_coulomb", &[]);
    slider.set_input("force", Function::commanded(0.5)).unwrap();
    slider.end.time = 5.0;
    let drive = |restores: bool| {
        let mut simulator = Simulator::new(&slider).unwrap();
        for i in 0..40_i32 {
            let t = 0.125 * f64::from(i);
            simulator.advance_to(t).unwrap();
            let to = f64::from((7 * i) % 11 - 5);
            let until = t + 0.3;
            simulator
                .command("force", Command::Ramp { to, until })
                .unwrap();
            if restores {
                let checkpoint = kept(&simulator.snapshot().unwrap());
                simulator = Simulator::new(&slider).unwrap();
                simulator.restore(&checkpoint).unwrap();
            }
        }
        simulator.advance_to(5.0).unwrap();
        bits(&simulator).0
    };
    assert_eq!(drive(true), drive(false));
}

#[test]
fn a_checkpoint_of_another_run_is_refused_with_what_differs() {
    let mut slider = problem("hand_coulomb", &[]);
    slider.set_initial("x.rate", 1.0).unwrap();
    let mut simulator = Simulator::new(&slider).unwrap();
    simulator.advance_to(0.3).unwrap();
    let checkpoint = simulator.snapshot().unwrap();
    let refused = |change: &dyn Fn(&mut Problem)| {
        let mut problem = slider.clone();
        change(&mut problem);
        let mut simulator = Simulator::new(&problem).unwrap();
        let why = simulator.restore(&checkpoint).unwrap_err();
        assert_eq!(simulator.time(), 0.0, "{why}");
        why.to_string()
    };
    let said = refused(&|problem| problem.set_parameter("m", 2.0).unwrap());
    assert!(said.contains("`m` is 2 now and was 1"), "{said}");
    let said = refused(&|problem| problem.set_tolerance(1e-7));
    assert!(said.contains("`accuracy`"), "{said}");
    let said = refused(&|problem| problem.set_input("force", Function::constant(1.0)).unwrap());
    assert!(said.contains("`inputs`"), "{said}");
    let said = refused(&|problem| problem.record.every = Some(0.5));
    assert!(
        said.contains("the interval of samples is every 0.5 s now"),
        "{said}"
    );
    let said = refused(&|problem| problem.record.ledger = false);
    assert!(
        said.contains("the energy balance is not kept now and was kept"),
        "{said}"
    );
    let said = refused(&|problem| problem.end.after = Some(("stick", 3)));
    assert!(said.contains("is stick now and was none"), "{said}");
    let ball = problem("hand_ball", &[]);
    let why = Simulator::new(&ball)
        .unwrap()
        .restore(&checkpoint)
        .unwrap_err();
    assert!(why.to_string().contains("the model"), "{why}");
    // Its end may be another one.
    let mut longer = slider.clone();
    longer.end.time = 2.0;
    Simulator::new(&longer)
        .unwrap()
        .restore(&checkpoint)
        .unwrap();

    let text = serde_json::to_string(&checkpoint).unwrap();
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{text}");
        let damaged = serde_json::from_str::<Checkpoint>(&text.replacen(from, to, 1)).unwrap();
        let mut simulator = Simulator::new(&slider).unwrap();
        simulator.restore(&damaged).unwrap_err()
    };
    let why = changed("\"version\":7", "\"version\":1");
    assert_eq!(why, Misfit::Version { found: 1 });
    let why = changed("\"words\":\"", "\"words\":\"0000000000000000");
    assert!(matches!(why, Misfit::Damaged { .. }), "{why}");
}
