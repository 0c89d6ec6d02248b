//! Maps of impacts of several contacts, against exact references and closed forms.

use super::multipliers::sine;
use crate::common::*;
use dalembert::hybrid::{ImpactLaw, ImpactOrder, Problem, simulate};
use dalembert::record::{Run, Silent};

/// `-3/5` or `2` as a number.
fn fraction(text: &str) -> f64 {
    match text.split_once('/') {
        Some((above, below)) => {
            above.trim().parse::<f64>().unwrap() / below.trim().parse::<f64>().unwrap()
        }
        None => text.trim().parse().unwrap(),
    }
}

/// `[[1, -1/2], [0, 1]]` as rows; `None` as an empty one.
fn matrix(text: &str) -> Vec<Vec<f64>> {
    let inner = &text[1..text.len() - 1];
    let mut rows = Vec::new();
    let mut rest = inner;
    while !rest.is_empty() {
        rest = rest.trim_start_matches([',', ' ']);
        if let Some(after) = rest.strip_prefix("None") {
            rows.push(Vec::new());
            rest = after;
        } else if let Some(begins) = rest.strip_prefix('[') {
            let (row, after) = begins.split_once(']').unwrap();
            rows.push(row.split(',').map(fraction).collect());
            rest = after;
        }
    }
    rows
}

fn list(text: &str) -> Vec<f64> {
    let inner = text.trim_matches(['[', ']']);
    inner.split(',').map(fraction).collect()
}

/// A problem whose first event is the impact of a row.
fn impact(masses: &[f64], normals: &[Vec<f64>], before: &[f64]) -> Problem {
    let mut problem = problem("impact_map", &[]);
    let mut set = |name: String, value: f64| problem.set_parameter(&name, value).unwrap();
    for (i, &mass) in masses.iter().enumerate() {
        set(format!("m_{}", i + 1), mass);
    }
    for (k, normal) in normals.iter().enumerate() {
        set(format!("away_{}", k + 1), 0.0);
        for (i, &along) in normal.iter().enumerate() {
            set(format!("normal_{}_{}", k + 1, i + 1), along);
        }
    }
    for (i, &rate) in before.iter().enumerate() {
        (problem.set_initial(&format!("q_{}.rate", i + 1), rate)).unwrap();
    }
    problem.end.time = 1e-9;
    problem.record.every = Some(1.0);
    problem.record.columns.outputs = true;
    problem
}

/// Adds friction to a contact.
fn roughen(problem: &mut Problem, k: usize, tangent: &[f64], mu: f64) {
    problem.set_parameter(&format!("smooth_{k}"), 0.0).unwrap();
    problem.set_parameter(&format!("mu_{k}"), mu).unwrap();
    for (i, &along) in tangent.iter().enumerate() {
        (problem.set_parameter(&format!("tangent_{k}_{}", i + 1), along)).unwrap();
    }
}

/// The rates after the first event, of the first coordinates.
fn after(run: &Run, count: usize) -> &[f64] {
    &run.events[0].after.v[..count]
}

#[test]
fn impacts_of_several_contacts_are_those_of_exact_maps() {
    let reference = reference("16_multi_impact_maps");
    let mut count = 0;
    for (_, rows) in reference["reference"].as_object().unwrap() {
        for row in rows.as_array().unwrap() {
            let text = |key: &str| row[key].as_str().unwrap();
            let mass = matrix(text("M"));
            let masses: Vec<f64> = (0..mass.len()).map(|i| mass[i][i]).collect();
            let (normals, tangents) = (matrix(text("W_N")), matrix(text("W_T")));
            let mut problem = impact(&masses, &normals, &list(text("u_minus")));
            for (k, (&mu, &e)) in list(text("mu")).iter().zip(&list(text("e_N"))).enumerate() {
                problem.set_parameter(&format!("e_{}", k + 1), e).unwrap();
                if !tangents[k].is_empty() {
                    roughen(&mut problem, k + 1, &tangents[k], mu);
                }
            }
            let run = run(&problem);
            let solution = &row["solutions"][0];
            for (i, exact) in solution["u_plus"].as_array().unwrap().iter().enumerate() {
                let exact = fraction(exact.as_str().unwrap());
                let found = after(&run, masses.len())[i];
                assert!((found - exact).abs() <= 1e-14, "{row}: {found} {exact}");
            }
            let event = &run.events[0];
            for (key, of) in [("P_N", "normal_impulse"), ("P_T", "friction_impulse")] {
                for (k, exact) in solution[key].as_object().unwrap() {
                    let exact = fraction(exact.as_str().unwrap());
                    let name = format!("c_{k}.{of}");
                    let i = (run.layout.outputs.iter()).position(|o| o.name == name);
                    let i = i.expect("an output");
                    let impulse = event.after.outputs[i] - event.before.outputs[i];
                    assert!((impulse - exact).abs() <= 1e-14, "{row}: {key} {impulse}");
                }
            }
            let change = fraction(solution["kinetic_energy_change"].as_str().unwrap());
            let energy = event.energy.expect("an impact");
            assert!((energy.lost + change).abs() <= 1e-14, "{row}");
            let gains = solution["energy_gain"].as_bool().unwrap();
            assert_eq!(run.tally.gaining() > 0, gains, "{row}");
            count += 1;
        }
    }
    assert_eq!(count, 43);
}

/// Three equal balls in a row, the first of which moves: in sequence the last one flies off, as in a cradle.
#[test]
fn a_cradle_in_sequence_passes_the_motion_on() {
    assert_eq!(sequence(1.0), [0.0, 0.0, 1.0]);
    for e in [1.0, 0.5, 0.0] {
        let mut cradle = impact(
            &[1.0; 3],
            &[vec![-1.0, 1.0, 0.0], vec![0.0, -1.0, 1.0]],
            &[1.0, 0.0, 0.0],
        );
        cradle.collisions.order = ImpactOrder::InSequence;
        for k in [1, 2] {
            cradle.set_parameter(&format!("e_{k}"), e).unwrap();
        }
        let run = run(&cradle);
        for (found, exact) in after(&run, 3).iter().zip(sequence(e)) {
            assert!((found - exact).abs() <= 1e-15, "{e}: {found} {exact}");
        }
    }
}

/// The same by the law of two balls, again and again.
fn sequence(e: f64) -> [f64; 3] {
    let mut u = [1.0, 0.0, 0.0];
    let strike = |u: &mut [f64; 3], i: usize| {
        let (mean, half) = (0.5 * (u[i] + u[i + 1]), 0.5 * e * (u[i] - u[i + 1]));
        (u[i], u[i + 1]) = (mean - half, mean + half);
    };
    // Without restitution the rates come together by a quarter each time.
    while u[0] - u[1] > f64::EPSILON || u[1] - u[2] > f64::EPSILON {
        let i = usize::from(u[0] - u[1] <= f64::EPSILON);
        strike(&mut u, i);
    }
    u
}

/// A rod whose lower end strikes rough ground (as in the reference): under Poisson's law the energy does not grow.
#[test]
fn poissons_law_delivers_its_part_of_the_impulse_and_makes_no_energy() {
    let (normal, tangent) = (vec![0.0, 1.0, -0.6], [1.0, 0.0, 0.8]);
    let masses = [1.0, 1.0, 1.0 / 3.0];
    for (mu, e) in [(0.7, 1.0), (0.3, 0.5), (0.1, 0.8), (2.0, 0.6)] {
        let mut rod = impact(&masses, std::slice::from_ref(&normal), &[0.7, -1.0, 0.0]);
        roughen(&mut rod, 1, &tangent, mu);
        rod.set_parameter("e_1", e).unwrap();
        rod.collisions.law = ImpactLaw::Poisson;
        let run = run(&rod);
        let exact = by_sweep(&masses, [&normal, &tangent], &[0.7, -1.0, 0.0], (mu, e));
        for (found, exact) in after(&run, 3).iter().zip(exact) {
            assert!((found - exact).abs() <= 1e-14, "{mu} {e}: {found} {exact}");
        }
        assert_eq!(run.tally.gaining(), 0);
    }
}

/// Poisson's law with one contact, by cases: in each phase the contact sticks if its impulse is within the cone, else it slips
/// the way that it would.
fn by_sweep(
    masses: &[f64],
    [normal, tangent]: [&[f64]; 2],
    before: &[f64],
    (mu, e): (f64, f64),
) -> Vec<f64> {
    let product = |a: &[f64], b: &[f64]| -> f64 {
        (a.iter().zip(b).zip(masses))
            .map(|((a, b), m)| a * b / m)
            .sum()
    };
    let (nn, nt, tt) = (
        product(normal, normal),
        product(normal, tangent),
        product(tangent, tangent),
    );
    let dot = |a: &[f64], u: &[f64]| -> f64 { a.iter().zip(u).map(|(a, u)| a * u).sum() };
    let mut u = before.to_vec();
    let apply = |u: &mut Vec<f64>, pn: f64, pt: f64| {
        for i in 0..u.len() {
            u[i] += (normal[i] * pn + tangent[i] * pt) / masses[i];
        }
    };
    // Compression: both rates to zero, if the cone allows it.
    let (un, ut) = (dot(normal, &u), dot(tangent, &u));
    let det = nn * tt - nt * nt;
    let (pn, pt) = ((-un * tt + ut * nt) / det, (-ut * nn + un * nt) / det);
    let (pn, pt) = match pt.abs() <= mu * pn {
        true => (pn, pt),
        false => {
            let slips = [1.0, -1.0].into_iter().find_map(|s: f64| {
                let pn = -un / (nn - mu * s * nt);
                let after = ut + (nt - mu * s * tt) * pn;
                (pn >= 0.0 && s * after > 0.0).then_some((pn, -mu * s * pn))
            });
            slips.unwrap()
        }
    };
    apply(&mut u, pn, pt);
    // Expansion: the part of the impulse is given, and the contact leaves.
    let pn = e * pn;
    let ut = dot(tangent, &u);
    let hold = -(ut + nt * pn) / tt;
    let pt = match hold.abs() <= mu * pn {
        true => hold,
        false => hold.signum() * mu * pn,
    };
    apply(&mut u, pn, pt);
    assert!(dot(normal, &u) >= 0.0);
    u
}

/// A ball with spin that grips the floor turns its slip back: the superball.
#[test]
fn tangential_restitution_turns_the_slip_of_a_ball_that_grips_back() {
    // x, y, and R times the turn, with the inertia 2/5: slip = x + R theta.
    let masses = [1.0, 1.0, 0.4];
    let (vx, vy, spin) = (1.0, -2.0, 0.5);
    for law in [ImpactLaw::Newton, ImpactLaw::Poisson] {
        for (back, e, mu) in [(1.0, 1.0, 5.0), (0.6, 0.8, 5.0), (0.0, 0.5, 5.0)] {
            let mut ball = impact(&masses, &[vec![0.0, 1.0, 0.0]], &[vx, vy, spin]);
            roughen(&mut ball, 1, &[1.0, 0.0, 1.0], mu);
            ball.set_parameter("e_1", e).unwrap();
            ball.set_parameter("back_1", back).unwrap();
            ball.collisions.law = law;
            let run = run(&ball);
            let impulse = -(1.0 + back) * (vx + spin) / (1.0 + 1.0 / 0.4);
            let exact = [vx + impulse, -e * vy, spin + impulse / 0.4];
            for (found, exact) in after(&run, 3).iter().zip(exact) {
                assert!(
                    (found - exact).abs() <= 1e-14,
                    "{law:?} {back}: {found} {exact}"
                );
            }
            let lost = run.events[0].energy.expect("an impact").lost;
            let exact = 0.5 * (1.0 - e * e) * vy * vy
                + 0.5 * (1.0 - back * back) * (vx + spin).powi(2) / (1.0 + 1.0 / 0.4);
            assert!((lost - exact).abs() <= 1e-14, "{lost} {exact}");
        }
    }
}

/// What a disc does that falls to the bottom of a wedge, with friction that locks it.
fn wedge(mu: f64, e: f64) -> Problem {
    let mut disc = problem("disc_in_wedge", &[("mu", mu), ("e", e)]);
    // It touches both sides.
    disc.set_initial("y", 0.625).unwrap();
    disc
}

#[test]
fn an_impact_without_an_outcome_or_with_two_stops_and_says_so() {
    let mut kinds = [0; 3];
    for (vx, vy, spin) in [
        (0.0, -1.0, 0.0),
        (0.5, -1.0, 0.0),
        (0.5, -1.0, 3.0),
        (-0.9, -1.0, -4.0),
        (1.2, -1.0, 2.0),
        (1.0, -1.0, -2.0),
    ] {
        for (mu, e) in [(0.3, 0.5), (1.0, 0.5), (2.0, 0.5), (1.0, 0.0)] {
            let mut disc = wedge(mu, e);
            disc.set_initial("x.rate", vx).unwrap();
            disc.set_initial("y.rate", vy).unwrap();
            disc.set_initial("theta.rate", spin).unwrap();
            disc.end.time = 1e-9;
            let run = simulate(&disc, &mut Silent).unwrap();
            let outcomes = count_outcomes(&disc);
            match &run.failure {
                None => {
                    assert_eq!(outcomes, 1, "{vx} {spin} {mu} {e}");
                    kinds[0] += 1;
                }
                Some(failure) if failure.reason.to_string().contains("has no outcome") => {
                    assert!(
                        failure.reason.to_string().contains("left, right"),
                        "{failure:?}"
                    );
                    assert_eq!(outcomes, 0, "{vx} {spin} {mu} {e}");
                    kinds[1] += 1;
                }
                Some(failure) => {
                    let text =
                        format!("the impact of left, right has {outcomes} outcomes that differ");
                    assert!(failure.reason.to_string().contains(&text), "{failure:?}");
                    kinds[2] += 1;
                }
            }
        }
    }
    println!("one, none, several: {kinds:?}");
    assert!(kinds[0] > 0 && kinds[1] + kinds[2] > 0, "{kinds:?}");
}

/// Number of outcomes of an impact of a disc on both sides, by a second method: for each of the cases of both contacts the two
/// equations of each, in the impulses alone.
fn count_outcomes(disc: &Problem) -> usize {
    let of = |name: &str| disc.parameters[disc.model.parameter(name).unwrap()];
    let (mu, e) = (of("mu"), of("e"));
    let u = &disc.initial.v;
    let (n_x, n_y, r) = (0.6, 0.8, 0.5);
    let lines = [
        [n_x, n_y, 0.0],
        [n_y, -n_x, r],
        [-n_x, n_y, 0.0],
        [n_y, n_x, r],
    ];
    let masses = [1.0, 1.0, 0.5 * r * r];
    let dot = |a: &[f64; 3], u: &[f64]| -> f64 { (0..3).map(|i| a[i] * u[i]).sum() };
    let mut found: Vec<[f64; 3]> = Vec::new();
    // 0: no impulse; 1: sticks; 2, 3: slips.
    for cases in 0..16 {
        let cases = [cases / 4, cases % 4];
        let mut matrix = [[0.0; 5]; 4];
        for (k, &case) in cases.iter().enumerate() {
            let (n, t) = (2 * k, 2 * k + 1);
            let row = |line: usize, target: f64| {
                let mut row = [0.0; 5];
                for (j, other) in lines.iter().enumerate() {
                    row[j] = (0..3).map(|i| lines[line][i] * other[i] / masses[i]).sum();
                }
                row[4] = target - dot(&lines[line], u);
                row
            };
            let unit = |line: usize| {
                let mut row = [0.0; 5];
                row[line] = 1.0;
                row
            };
            matrix[n] = match case {
                0 => unit(n),
                _ => row(n, -e * dot(&lines[n], u)),
            };
            matrix[t] = match case {
                0 => unit(t),
                1 => row(t, 0.0),
                _ => {
                    let mut cone = unit(t);
                    cone[n] = if case == 2 { mu } else { -mu };
                    cone
                }
            };
        }
        let Some(p) = eliminate(matrix) else { continue };
        let after: [f64; 3] = std::array::from_fn(|i| {
            u[i] + (0..4).map(|j| lines[j][i] * p[j]).sum::<f64>() / masses[i]
        });
        let small = 1e-12;
        let agrees = (0..2).all(|k| {
            let [un, ut] = [0, 1].map(|j| dot(&lines[2 * k + j], &after));
            let (pn, pt) = (p[2 * k], p[2 * k + 1]);
            pn >= -small
                && un + e * dot(&lines[2 * k], u) >= -small
                && pt.abs() <= mu * pn + small
                && match cases[k] {
                    2 => ut >= -small,
                    3 => ut <= small,
                    _ => true,
                }
        });
        let is_new = |known: &[f64; 3]| (0..3).any(|i| (known[i] - after[i]).abs() > small);
        if agrees && found.iter().all(is_new) {
            found.push(after);
        }
    }
    found.len()
}

/// The solution of four equations, by Gauss with pivots.
fn eliminate(mut a: [[f64; 5]; 4]) -> Option<[f64; 4]> {
    for c in 0..4 {
        let pivot = (c..4).max_by(|&i, &j| a[i][c].abs().total_cmp(&a[j][c].abs()))?;
        if a[pivot][c].abs() < 1e-12 {
            return None;
        }
        a.swap(c, pivot);
        for i in (0..4).filter(|&i| i != c) {
            let factor = a[i][c] / a[c][c];
            for j in 0..5 {
                a[i][j] -= factor * a[c][j];
            }
        }
    }
    Some(std::array::from_fn(|i| a[i][4] / a[i][i]))
}

#[test]
fn an_impact_reaches_what_lies_behind_a_contact_that_it_opens() {
    // p₀ and p₁ stay, v₂ becomes 0: v₁ = −c/(1 − c²), v₀ = −c v₁, for v₂ = −1 before.
    let mut problem = problem("inertia_row", &[]);
    problem.set_initial("x2", 0.1).unwrap();
    problem.set_initial("x2.rate", -1.0).unwrap();
    problem.end.time = 0.2;
    let run = run(&problem);
    let [event] = &run.events[..] else {
        panic!("{:?}", run.events);
    };
    let middle = 0.3 / 0.91;
    for (found, exact) in event.after.v.iter().zip([0.3 * middle, middle, 0.0]) {
        assert!((found - exact).abs() < 1e-15, "{:?}", event.after.v);
    }
    let energy = run.energy.as_ref().unwrap();
    assert!(energy.imbalance().abs() < 1e-15, "{energy:?}");
}

/// A load strikes the end of its tray: neither does the tray push nor does the load leave it, and both are zero but for what elimination
/// leaves. No outcome was found where bounds did not see that (the second scene).
#[test]
fn an_impact_beside_which_a_contact_does_nothing_has_an_outcome() {
    let scenes = [
        (0.04, 0.06, 0.55, 0.11, "38.98 sin(5.789 t+0.12)"),
        (0.0, 0.09, 0.27, 0.15, "33.228 sin(4.672 t+0.15)"),
        (0.3, 0.02, 0.4, -0.6, "45 sin(7 t+1)"),
        (0.1, 0.05, 0.7, 0.3, "50 sin(3 t+2)"),
    ];
    for (mu, nu, e, b, push) in scenes {
        with_each_method(|| {
            let mut cart = problem("loaded_cart", &[("mu", mu), ("nu", nu), ("e", e)]);
            cart.set_initial("b", b).unwrap();
            cart.set_input("push", sine(push)).unwrap();
            cart.set_tolerance(1e-12);
            cart.end.time = 2.5;
            let run = run(&cart);
            assert!(run.events.len() > 10, "{push}: {} events", run.events.len());
            let energy = run.energy.as_ref().expect("a ledger");
            let turnover = energy.initial.abs() + energy.input_work.abs();
            assert!(
                energy.imbalance().abs() < 1e-9 * turnover,
                "{push}: {energy:?}"
            );
        });
    }
}
