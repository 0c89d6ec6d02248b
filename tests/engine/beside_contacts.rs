//! Modes, transitions and resets by hand beside contacts.

use crate::common::*;
use dalembert::hybrid::{Method, Problem, simulate};
use dalembert::record::Silent;

const M: f64 = 2.0;
const G: f64 = 9.81;
const MU: f64 = 0.3;
const PULL: f64 = 20.0;

/// The block of `kicker`, on parabolas.
struct Kicked {
    t: f64,
    x: f64,
    u: f64,
    events: Vec<(f64, &'static str)>,
}

impl Kicked {
    fn go_on(&mut self, time: f64, a: f64) {
        self.t += time;
        self.x += time * (self.u + 0.5 * time * a);
        self.u += time * a;
    }

    fn happens(&mut self, name: &'static str) {
        self.events.push((self.t, name));
    }

    /// From the start to a time.
    fn run(u: f64, [slow, fast, kick]: [f64; 3], end: f64) -> Self {
        let mut block = Kicked {
            t: 0.0,
            x: 0.0,
            u,
            events: Vec::new(),
        };
        let [slides, flies] = [PULL / M - MU * G, PULL / M];
        let left = |block: &Self| end - block.t;
        loop {
            // It coasts, and slides.
            let time = (block.u - slow) / (MU * G);
            if time > left(&block) {
                block.go_on(left(&block), -MU * G);
                return block;
            }
            block.go_on(time, -MU * G);
            block.happens("turn_on");
            // It flies, and turns off there or when it has landed.
            let (flight, to_fast) = (2.0 * kick / G, (fast - block.u) / flies);
            let mut rest = flight;
            let turns_off = to_fast < flight;
            if turns_off {
                if to_fast > left(&block) {
                    block.go_on(left(&block), flies);
                    return block;
                }
                block.go_on(to_fast, flies);
                block.happens("turn_off");
                rest -= to_fast;
            }
            let a = if turns_off { 0.0 } else { flies };
            if rest > left(&block) {
                block.go_on(left(&block), a);
                return block;
            }
            block.go_on(rest, a);
            block.u -= MU * kick;
            block.happens("floor strikes");
            if !turns_off {
                let time = (fast - block.u) / slides;
                if time > left(&block) {
                    block.go_on(left(&block), slides);
                    return block;
                }
                block.go_on(time, slides);
                block.happens("turn_off");
            }
        }
    }
}

fn kicker([slow, fast, kick]: [f64; 3], u: f64) -> Problem {
    let given = [("m", M), ("g", G), ("mu", MU), ("pull", PULL)];
    let mut problem = problem("kicker", &given);
    for (name, value) in [("slow", slow), ("fast", fast), ("kick", kick)] {
        problem.set_parameter(name, value).unwrap();
    }
    problem.set_initial("x.rate", u).unwrap();
    problem.set_tolerance(TIGHTEST);
    problem
}

/// It falls, slides, and is kicked while its gap is what rounding has left of it, -1e-48 m: the kick was refused for that.
#[test]
fn a_block_that_has_fallen_is_kicked_from_where_it_slides() {
    for method in [Method::Taylor, Method::Radau] {
        let given = [("m", 1.8473), ("pull", 24.3247), ("fast", 2.0153)];
        let mut block = problem("kicker", &given);
        block.set_initial("x.rate", 0.194).unwrap();
        block.set_initial("y", 0.707).unwrap();
        block.set_tolerance(1e-12);
        block.method = method;
        block.end.time = 2.0;
        let run = run(&block);
        let kicks = run.events.iter().filter(|e| e.transition == "turn_on");
        assert!(kicks.count() > 3, "{:?}", transitions(&run));
    }
}

#[test]
fn a_block_is_kicked_and_driven_beside_its_contact() {
    // The second turns off while it flies.
    for (law, u) in [([1.0, 3.0, 0.5], 2.0), ([1.0, 1.8, 0.9], 1.5)] {
        let exact = Kicked::run(u, law, 4.0);
        assert!(exact.events.len() > 10, "{:?}", exact.events);
        for method in [Method::Taylor, Method::Radau] {
            let mut block = kicker(law, u);
            block.method = method;
            block.end.time = 4.0;
            block.record.every = Some(0.01);
            block.record.ledger = true;
            let run = run(&block);
            let found: Vec<_> = run.events.iter().map(|e| (e.t, e.transition)).collect();
            assert_eq!(
                found.len(),
                exact.events.len(),
                "{found:?} {:?}",
                exact.events
            );
            for ((t, name), (exact, expected)) in found.iter().zip(&exact.events) {
                assert_eq!(name, expected);
                assert!((t - exact).abs() <= 1e-13, "{name}: {t} {exact}");
            }
            let state = &run.end.state;
            assert!(
                (state.q[0] - exact.x).abs() <= 1e-12,
                "{} {}",
                state.q[0],
                exact.x
            );
            assert!(
                (state.v[0] - exact.u).abs() <= 1e-12,
                "{} {}",
                state.v[0],
                exact.u
            );
            // A kick makes energy, and is no impact.
            let kicks = run.tally.count("turn_on") as f64;
            let energy = run.energy.as_ref().unwrap();
            let made = kicks * 0.5 * M * law[2] * law[2];
            assert!((energy.lost_at_impacts + made - lost(&run)).abs() <= 1e-12);
            let names: Vec<String> = (run.events.iter())
                .map(|e| run.layout.modes.name(e.to).into_owned())
                .collect();
            assert_eq!(names[0], "drives, floor open");
            let after = |name: &str| found.iter().position(|(_, n)| *n == name).unwrap();
            assert!(names[after("floor strikes")].ends_with(", floor slides"));
            for name in &names {
                let number = run.layout.modes.number(name);
                assert_eq!(
                    number.map(|n| run.layout.modes.name(n)).as_deref(),
                    Some(&**name)
                );
            }
        }
    }
}

/// What landings take, J, by their energies.
fn lost(run: &dalembert::record::Run) -> f64 {
    let impacts = run
        .events
        .iter()
        .filter(|e| e.transition == "floor strikes");
    let kinetic = |v: &[f64]| 0.5 * M * v.iter().map(|v| v * v).sum::<f64>();
    impacts
        .map(|e| kinetic(&e.before.v) - kinetic(&e.after.v))
        .sum()
}

#[test]
fn a_scene_starts_in_a_mode_by_hand() {
    let mut block = kicker([1.0, 3.0, 0.5], 2.0);
    block.initial.mode = Some(mode(&block, "drives"));
    block.end.time = 1.0;
    let run = run(&block);
    let first = &run.events[0];
    assert_eq!(first.transition, "turn_off");
    assert!((first.t - 1.0 / (PULL / M - MU * G)).abs() <= 1e-14);
    assert_eq!(run.layout.modes.name(first.from), "drives, floor slides");
}

#[test]
fn a_reset_through_the_ground_is_refused() {
    let mut block = kicker([1.0, 3.0, 0.5], 2.0);
    block.set_parameter("drop", 0.01).unwrap();
    block.end.time = 1.0;
    let run = simulate(&block, &mut Silent).unwrap();
    let reason = run.failure.unwrap().reason.to_string();
    for part in ["`turn_on`", "gap of contact `floor` is -1e-2"] {
        assert!(reason.contains(part), "{reason}");
    }
}
