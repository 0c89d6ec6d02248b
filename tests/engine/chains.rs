//! The shipped `slider_chain`: blocks on each other, and in a row, against parabolas.

use crate::common::*;
use dalembert::hybrid::Method;
use dalembert::input::{Function, Interpolation, Outside, Table};

/// A stack of three blocks of 1 kg whose table has constant accelerations, so that all moves on parabolas: of all sets of sticking
/// and sliding interfaces the one that agrees with itself.
struct Stack {
    /// Most friction of each interface, N.
    most: [f64; 3],
    /// Slip rates and slips.
    u: [f64; 3],
    s: [f64; 3],
}

impl Stack {
    /// Slip accelerations under that of the table.
    fn accelerations(&self, table: f64) -> [f64; 3] {
        let mut found = Vec::new();
        for set in 0..27_i32 {
            // 0: sticks; ±1: slides that way.
            let states = [set % 3, set / 3 % 3, set / 9].map(|s| f64::from(s - 1));
            let fits = |k: usize| self.u[k] == 0.0 || self.u[k].signum() == states[k];
            if !(0..3).all(fits) {
                continue;
            }
            // An interface that slides moves what lies on it; one that sticks moves with what is beneath.
            let mut slips = [0.0; 3];
            for k in 0..3 {
                if states[k] != 0.0 {
                    // Blocks that stick on this one move with it.
                    let with = (k + 1..3).take_while(|&j| states[j] == 0.0).count() + 1;
                    let above = if k + with < 3 {
                        -states[k + with] * self.most[k + with]
                    } else {
                        0.0
                    };
                    let force = -states[k] * self.most[k] - above;
                    let beneath: f64 = table + slips[..k].iter().sum::<f64>();
                    slips[k] = force / with as f64 - beneath;
                }
            }
            let absolute = |k: usize| table + slips[..=k].iter().sum::<f64>();
            let agrees = (0..3).all(|k| match states[k] {
                0.0 => (k..3).map(absolute).sum::<f64>().abs() <= self.most[k],
                way => self.u[k] != 0.0 || slips[k] * way > 0.0,
            });
            if agrees {
                found.push(slips);
            }
        }
        assert_eq!(found.len(), 1, "{found:?}");
        found[0]
    }

    /// Moves on for a time; appends the times at which a slip ends.
    fn advance(&mut self, from: f64, time: f64, table: f64, ends: &mut Vec<(f64, usize)>) {
        let mut left = time;
        while left > 0.0 {
            let a = self.accelerations(table);
            let stop = |k: usize| match self.u[k] * a[k] < 0.0 {
                true => -self.u[k] / a[k],
                false => f64::INFINITY,
            };
            let first = (0..3).min_by(|&i, &j| stop(i).total_cmp(&stop(j))).unwrap();
            let step = left.min(stop(first));
            for k in 0..3 {
                self.s[k] += step * (self.u[k] + 0.5 * step * a[k]);
                self.u[k] += step * a[k];
            }
            left -= step;
            if left > 0.0 {
                self.u[first] = 0.0;
                ends.push((from + time - left, first));
            }
        }
    }
}

#[test]
fn a_stack_on_a_table_of_constant_accelerations_moves_on_parabolas() {
    let (mu, grading, g) = (0.3, 0.9, 9.81);
    let table = [6.0, -7.0, 4.0, -2.5, 3.1, 0.0];
    let interval = 0.25;
    let mut exact = Stack {
        most: [
            3.0 * mu * g,
            2.0 * mu * grading * g,
            mu * grading * grading * g,
        ],
        u: [0.0; 3],
        s: [0.0; 3],
    };
    let mut ends = Vec::new();
    for (k, &a) in table.iter().enumerate() {
        exact.advance(k as f64 * interval, interval, a, &mut ends);
    }
    let given = [("mu_s", mu), ("mu_k", mu), ("grading", grading), ("g", g)];
    for method in [Method::Taylor, Method::Radau] {
        let mut stack = problem("slider_chain", &given);
        let t: Vec<f64> = (0..table.len()).map(|k| k as f64 * interval).collect();
        let steps = Table::new(&t, &table, Interpolation::Previous, Outside::Hold).unwrap();
        stack.set_input("a", steps.into()).unwrap();
        stack.method = method;
        stack.set_tolerance(TIGHTEST);
        stack.end.time = table.len() as f64 * interval;
        let run = run(&stack);
        let stops = ["sticks", "reverses"];
        let found: Vec<(f64, &str)> = (run.events.iter())
            .filter(|event| stops.iter().any(|verb| event.transition.ends_with(verb)))
            .map(|event| (event.t, event.transition))
            .collect();
        assert_eq!(found.len(), ends.len(), "{found:?} {ends:?}");
        for ((t, name), (exact, interface)) in found.iter().zip(&ends) {
            assert!((t - exact).abs() <= 1e-13, "{name}: {t} {exact}");
            assert!(
                name.starts_with(&format!("block_{}", interface + 1)),
                "{name}"
            );
        }
        for k in 0..3 {
            let off = run.end.state.q[k] - exact.s[k];
            assert!(off.abs() <= 1e-14, "{k}: {off:e}");
        }
    }
    assert!(ends.len() >= 4, "{ends:?}");
}

/// Blocks of one mass in a row with friction, by parabolas: places from the left, rates; each collision is Newton's.
fn thrown_row(
    mut x: [f64; 3],
    mut u: [f64; 3],
    (width, friction, e): (f64, f64, f64),
) -> (Vec<(f64, String)>, [f64; 3]) {
    let (mut t, mut events) = (0.0, Vec::new());
    loop {
        let a = u.map(|u| -friction * f64::from(u > 0.0));
        let stops = (0..3).filter(|&k| u[k] > 0.0).map(|k| {
            let at = u[k] / friction;
            (at, k, "sticks")
        });
        // The instant at which a parabola of the distance vanishes first.
        let strikes = (0..2).filter_map(|k| {
            let (d, rate, half) = (
                x[k + 1] - x[k] - width,
                u[k] - u[k + 1],
                (a[k] - a[k + 1]) / 2.0,
            );
            let within = rate * rate + 4.0 * half * d;
            let at = 2.0 * d / (rate + within.max(0.0).sqrt());
            (d > 0.0 && rate > 0.0 && within > 0.0).then_some((at, k, "strikes"))
        });
        let next = stops.chain(strikes).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((after, k, what)) = next else {
            return (events, x);
        };
        for i in 0..3 {
            x[i] += after * (u[i] + after * a[i] / 2.0);
            u[i] += after * a[i];
        }
        t += after;
        if what == "sticks" {
            u[k] = 0.0;
            events.push((t, format!("block_{} sticks", k + 1)));
        } else {
            x[k + 1] = x[k] + width;
            let (sum, closing) = (u[k] + u[k + 1], u[k] - u[k + 1]);
            u[k] = (sum - e * closing) / 2.0;
            u[k + 1] = (sum + e * closing) / 2.0;
            events.push((t, format!("blocks_{}_{} strikes", k + 1, k + 2)));
        }
    }
}

#[test]
fn blocks_in_a_row_pass_a_throw_on_as_parabolas_say() {
    let (mu, g, e, width) = (0.3, 9.81, 0.6, 0.2);
    let distances = [0.1, 0.25];
    let places = [
        0.0,
        width + distances[0],
        2.0 * width + distances[0] + distances[1],
    ];
    for speed in [1.0, 2.0, 4.0] {
        let (exact, ends) = thrown_row(places, [speed, 0.0, 0.0], (width, mu * g, e));
        for method in [Method::Taylor, Method::Radau] {
            let given = [
                ("mu_s", mu),
                ("mu_k", mu),
                ("grading", 1.0),
                ("e", e),
                ("g", g),
                ("w", width),
            ];
            let mut row = problem("slider_chain", &given);
            row.choose(&[("arrangement", "row")]).unwrap();
            row.set_initial("s_2", distances[0]).unwrap();
            row.set_initial("s_3", distances[1]).unwrap();
            row.set_initial("s_1.rate", speed).unwrap();
            row.set_initial("s_2.rate", -speed).unwrap();
            row.method = method;
            row.set_tolerance(TIGHTEST);
            row.end.time = 2.0;
            let run = run(&row);
            let found: Vec<_> = (run.events.iter())
                .map(|event| (event.t, event.transition))
                .collect();
            assert_eq!(found.len(), exact.len(), "{found:?} {exact:?}");
            for ((t, name), (at, what)) in found.iter().zip(&exact) {
                assert_eq!(name, what);
                assert!((t - at).abs() <= 1e-13, "{method:?}, {name}: {t} {at}");
            }
            let imbalance = run.energy.as_ref().unwrap().imbalance();
            assert!(imbalance.abs() <= 1e-14, "{imbalance:e}");
            let q = &run.end.state.q;
            let found = [q[0], q[0] + width + q[1], q[0] + 2.0 * width + q[1] + q[2]];
            for (found, exact) in found.iter().zip(ends) {
                assert!((found - exact).abs() <= 1e-14, "{found} {exact}");
            }
        }
    }
}

/// The last block has half the friction of the one before and leans on it; on a table that accelerates to the right it pushes it to
/// the left.
#[test]
fn a_block_of_a_row_pushes_its_neighbour() {
    let (mu_s, mu_k, g, m, grading, table) = (0.35, 0.3, 9.81, 1.0, 0.5, 2.0);
    let friction = [grading, grading * grading].map(|share| share * mu_k * m * g);
    let acceleration = (friction[0] + friction[1]) / (2.0 * m) - table;
    let push = m * (acceleration + table) - friction[1];
    let given = [("mu_s", mu_s), ("mu_k", mu_k), ("grading", grading)];
    for method in [Method::Taylor, Method::Radau] {
        let mut row = problem("slider_chain", &given);
        row.choose(&[("arrangement", "row")]).unwrap();
        row.set_input("a", Function::constant(table)).unwrap();
        row.set_initial("s_2", 1.0).unwrap();
        row.method = method;
        row.set_tolerance(TIGHTEST);
        row.end.time = 1.0;
        row.record.columns.outputs = true;
        let run = run(&row);
        let off = run.end.state.q[1] - 1.0 - acceleration / 2.0;
        assert!(off.abs() <= 1e-14, "{method:?}: {off:e}");
        let distance = run.end.state.q[2];
        assert!(distance.abs() <= 1e-16, "{method:?}: {distance:e}");
        let column = run.trajectory.column("blocks_2_3.normal").unwrap();
        let last = run.trajectory.row(run.trajectory.t.len() - 1)[column];
        assert!((last - push).abs() <= 1e-13, "{method:?}: {last} {push}");
    }
}
