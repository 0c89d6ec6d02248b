//! Location of events: cases with exact answers, each named for what it guards.
#![allow(clippy::excessive_precision)] // references keep the digits they were computed with

use dalembert::hybrid::roots::{Crossing, Kind, Polynomial, Search, Watch, earliest, search};
use std::cell::Cell;

/// The crossing of a search, after checking its contract with the guard's own values.
fn crossing(found: Search, g: impl Fn(f64) -> f64) -> Crossing {
    let crossing = found.crossing.expect("an event");
    assert!(found.resolved);
    assert_eq!(
        crossing.outside,
        crossing.inside.next_up(),
        "neighbouring doubles"
    );
    match crossing.kind {
        Kind::Touch => assert!(g(crossing.inside) == 0.0 && g(crossing.outside) >= 0.0),
        Kind::LeavesNegative => assert!(g(crossing.outside) < 0.0),
        _ => assert!(g(crossing.inside) >= 0.0 && g(crossing.outside) < 0.0),
    }
    crossing
}

fn polynomial<const N: usize>(coefficients: [f64; N]) -> Polynomial<N> {
    Polynomial { coefficients }
}

/// Product of the factors, of which N coefficients must hold the result.
fn product<const N: usize>(factors: &[&[f64]]) -> Polynomial<N> {
    let mut coefficients = vec![1.0];
    for factor in factors {
        let mut next = vec![0.0; coefficients.len() + factor.len() - 1];
        for (i, a) in coefficients.iter().enumerate() {
            for (j, b) in factor.iter().enumerate() {
                next[i + j] += a * b;
            }
        }
        coefficients = next;
    }
    coefficients.resize(N, 0.0);
    polynomial(coefficients.try_into().expect("N coefficients"))
}

fn assert_near(actual: f64, expected: f64, tolerance: f64) {
    assert!(
        (actual - expected).abs() <= tolerance,
        "{actual:e} is not {expected:e} ± {tolerance:e}"
    );
}

/// What `earliest` overwrites.
fn blank<const G: usize>() -> [Search; G] {
    [Search {
        crossing: None,
        watch: Watch::Dormant,
        resolved: false,
        turn: f64::NAN,
    }; G]
}

// Reference 10c.
#[test]
fn graze_with_a_tiny_excess() {
    for (excess, time) in [(1e-6, 1.569382113821778795), (1e-10, 1.570782184659274738)] {
        let g = |t: f64| 1.0 - (1.0 + excess) * t.sin();
        for end in [1.58, 2.0, 3.0, 6.0] {
            let event = crossing(search(g, 0.0, end, Watch::Armed, 0.0), g);
            assert_eq!(event.kind, Kind::Crossing);
            assert_near(event.outside, time, 1e-15 / (2.0_f64 * excess).sqrt());
        }
        // From below: never reached.
        let g = |t: f64| 1.0 - (1.0 - excess) * t.sin();
        assert_eq!(search(g, 0.0, 3.0, Watch::Armed, 0.0).crossing, None);
    }
}

// Reference 10e.
#[test]
fn two_roots_in_one_window() {
    let c = 0.7310585786300049;
    for (d, first, second) in [
        (1e-2, 0.7210585786300049, 0.7410585786300049),
        (1e-4, 0.7309585786300049, 0.7311585786300049),
    ] {
        let g = |t: f64| (t - c) * (t - c) - d * d;
        let p = polynomial([c * c - d * d, -2.0 * c, 1.0]);
        for end in [0.75, 0.9, 1.0] {
            let event = crossing(search(g, 0.0, end, Watch::Armed, 0.0), g);
            assert_near(event.outside, first, 2e-16 / d);
            let event = crossing(p.search(0.0, end, Watch::Armed, 0.0), |s| p.value(s));
            assert_near(event.outside, first, 2e-16 / d);
            // The guard of the other sign rises at the first and falls at the second.
            let h = |t: f64| -g(t);
            let event = crossing(search(h, 0.0, end, Watch::Violated, 0.0), h);
            assert_near(event.outside, second, 2e-16 / d);
            let q = polynomial(p.coefficients.map(|c| -c));
            let event = crossing(q.search(0.0, end, Watch::Violated, 0.0), |s| q.value(s));
            assert_near(event.outside, second, 2e-16 / d);
        }
    }
}

// Reference 10f.
#[test]
fn triple_root() {
    let third = 1.0 / 3.0;
    let g = |t: f64| (third - t).powi(3);
    let event = crossing(search(g, 0.0, 1.0, Watch::Armed, 0.0), g);
    assert_eq!((event.inside, event.kind), (third, Kind::Crossing));
    let p: Polynomial<4> = product(&[&[third, -1.0], &[third, -1.0], &[third, -1.0]]);
    let event = crossing(p.search(0.0, 1.0, Watch::Armed, 0.0), |s| p.value(s));
    assert_near(event.outside, third, f64::EPSILON.cbrt());
}

// Reference 10g: y(0) = 0 exactly.
#[test]
fn event_at_the_start() {
    for (velocity, impact) in [(2.0, 0.407747196738022426), (-2.0, 0.0), (0.0, 0.0)] {
        let g = |t: f64| t * (velocity - 4.905 * t);
        let p = polynomial([0.0, velocity, -4.905]);
        for event in [
            crossing(search(g, 0.0, 1.0, Watch::of(g(0.0)), 0.0), g),
            crossing(p.search(0.0, 1.0, Watch::of(p.value(0.0)), 0.0), |s| {
                p.value(s)
            }),
        ] {
            if impact > 0.0 {
                assert_eq!(event.kind, Kind::Crossing);
                assert_near(event.outside, impact, 1e-16);
            } else {
                assert_eq!(event.kind, Kind::LeavesNegative);
                // At once, but for the underflow of the guard's value.
                assert!(event.outside <= 1e-161, "{event:?}");
            }
        }
    }
}

// Reference 10h.
#[test]
fn a_jump_is_located_to_a_double() {
    let g = |t: f64| if t < 0.3 { 1.0 } else { -1.0 };
    let event = crossing(search(g, 0.0, 1.0, Watch::Armed, 0.0), g);
    assert_eq!((event.outside, event.kind), (0.3, Kind::Jump));
    // Upwards it is no event, but arms.
    let found = search(|t| -g(t), 0.0, 1.0, Watch::Violated, 0.0);
    assert_eq!((found.crossing, found.watch), (None, Watch::Armed));
    // On a sloping guard.
    let g = |t: f64| 2.0 - t - if t < 0.7 { 0.0 } else { 3.0 };
    let event = crossing(search(g, 0.0, 1.0, Watch::Armed, 0.0), g);
    assert_eq!((event.outside, event.kind), (0.7, Kind::Jump));
}

// Reference 10h.
#[test]
fn a_pole_is_not_a_zero() {
    let g = |t: f64| 1.0 / (0.6 - t);
    let found = search(g, 0.0, 1.0, Watch::Armed, 0.0)
        .crossing
        .expect("the sign changes");
    assert_eq!(found.kind, Kind::Pole);
    assert_near(found.outside, 0.6, 2e-16);
    let found = search(|t| -g(t), 0.0, 1.0, Watch::Violated, 0.0);
    assert_eq!((found.crossing, found.watch), (None, Watch::Armed));
    let g = |t: f64| 1.0 / (0.6 - t).cbrt();
    let found = search(g, 0.0, 1.0, Watch::Armed, 0.0)
        .crossing
        .expect("the sign changes");
    assert_eq!(found.kind, Kind::Pole);
}

#[test]
fn a_kink_at_zero_is_a_fall() {
    let g = |t: f64| if t < 0.3 { 0.3 - t } else { 5.0 * (0.3 - t) };
    let event = crossing(search(g, 0.0, 1.0, Watch::Armed, 0.0), g);
    assert_eq!((event.inside, event.kind), (0.3, Kind::Crossing));
}

// Reference 10q.
#[test]
fn identically_zero_but_for_rounding_sleeps() {
    let g = |t: f64| {
        let (x, y) = ((0.1 * t).cos(), -(0.1 * t).sin());
        x * x + y * y - 1.0
    };
    // Two squares that sum to 1, and their sum: a relative error of 2u each, of sine and cosine 2u.
    let noise = 4.0 * f64::EPSILON;
    for windows in [1, 7, 1000] {
        let (mut known, mut unknown) = (Watch::of(g(0.0)), Watch::of(g(0.0)));
        assert_eq!(known, Watch::Dormant);
        for k in 0..windows {
            let time = |k: i32| 10.0 * f64::from(k) / f64::from(windows);
            let found = search(g, time(k), time(k + 1), known, noise);
            assert_eq!(
                (found.crossing, found.watch, found.resolved),
                (None, Watch::Dormant, true)
            );
            known = found.watch;
            let found = search(g, time(k), time(k + 1), unknown, 0.0);
            assert_eq!(
                (found.crossing, found.watch),
                (None, Watch::Dormant),
                "{k} of {windows}"
            );
            unknown = found.watch;
        }
    }
    // The same guard wakes when it does leave.
    let leaves = |t: f64| g(t) + 1e-3 * (t - 5.0).max(0.0).powi(2);
    let found = search(leaves, 0.0, 5.0, Watch::Dormant, noise);
    assert_eq!(found.watch, Watch::Dormant);
    assert_eq!(
        search(leaves, 5.0, 6.0, found.watch, noise).watch,
        Watch::Armed
    );
    let leaves = |t: f64| g(t) - 1e-3 * (t - 5.0).max(0.0).powi(2);
    let found = search(leaves, 5.0, 6.0, Watch::Dormant, noise)
        .crossing
        .expect("it leaves");
    assert_eq!(found.kind, Kind::LeavesNegative);
    assert!(leaves(found.outside) < -noise && leaves(found.inside) >= -noise);
}

#[test]
fn exactly_zero_stays_dormant_at_six_evaluations() {
    let count = Cell::new(0);
    let g = |_| {
        count.set(count.get() + 1);
        0.0
    };
    assert_eq!(
        search(g, 0.0, 1.0, Watch::Dormant, 0.0).watch,
        Watch::Dormant
    );
    assert_eq!(count.get(), 6);
    assert_eq!(
        polynomial([0.0; 6])
            .search(0.0, 1.0, Watch::Dormant, 0.0)
            .watch,
        Watch::Dormant
    );
    // Below a bound of its noise a polynomial sleeps; without one its coefficients are its word.
    let p = polynomial([0.0, 1e-17, -3e-17, 1e-17]);
    assert_eq!(
        p.search(0.0, 1.0, Watch::Dormant, 1e-16).watch,
        Watch::Dormant
    );
    assert_eq!(
        p.search(0.0, 1.0, Watch::Dormant, 0.0)
            .crossing
            .unwrap()
            .kind,
        Kind::Crossing
    );
}

/// s^m (flight − s): zero of order m, then a flight however short.
#[test]
fn short_flights_after_a_zero_of_any_order() {
    for order in 1..=4 {
        for flight in [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-30] {
            let g = |t: f64| t.powi(order) * (flight - t);
            let event = crossing(search(g, 0.0, 1.0, Watch::Dormant, 0.0), g);
            assert_eq!(
                (event.inside, event.kind),
                (flight, Kind::Crossing),
                "{order} {flight:e}"
            );
            let mut p = polynomial([0.0; 6]);
            p.coefficients[order as usize] = flight;
            p.coefficients[order as usize + 1] = -1.0;
            let event = crossing(p.search(0.0, 1.0, Watch::Dormant, 0.0), |s| p.value(s));
            assert_eq!((event.inside, event.kind), (flight, Kind::Crossing));
            // Upside down it leaves to the negative side, at once.
            let mirrored = polynomial(p.coefficients.map(|c| -c));
            let event = mirrored
                .search(0.0, 1.0, Watch::Dormant, 0.0)
                .crossing
                .unwrap();
            assert_eq!(event.kind, Kind::LeavesNegative);
        }
    }
}

#[test]
fn a_guard_that_leaves_downwards_and_soon_turns() {
    // Negative in (0, 1/64), positive up to 3/64.
    let g = |t: f64| -t.powi(3) * (t - 1.0 / 64.0) * (t - 3.0 / 64.0);
    let found = search(g, 0.0, 1.0, Watch::Dormant, 0.0);
    assert_eq!(crossing(found, g).kind, Kind::LeavesNegative);
}

#[test]
fn curved_guards_leave_zero_of_any_order() {
    for order in 1..=4_i32 {
        for sign in [1.0, -1.0] {
            // Accurate relative to its value near the start, as the sine is.
            let g = |t: f64| sign * t.sin().powi(order) * (1.0 + t.exp());
            let found = search(g, 0.0, 1.0, Watch::of(g(0.0)), 0.0);
            if sign > 0.0 {
                assert_eq!((found.crossing, found.watch), (None, Watch::Armed));
                assert!(found.resolved);
            } else {
                assert_eq!(crossing(found, g).kind, Kind::LeavesNegative);
            }
        }
    }
}

#[test]
fn rounding_noise_on_a_lift_off_does_not_decide_its_sign() {
    // t − sin t ~ t³/6 has no correct digit below t = 1e-5.
    let g = |t: f64| (t - t.sin()) * (0.5 - t);
    let event = crossing(search(g, 0.0, 1.0, Watch::Dormant, 0.0), g);
    assert_eq!((event.inside, event.kind), (0.5, Kind::Crossing));
    let event = crossing(search(g, 0.0, 1.0, Watch::Dormant, 1e-16), g);
    assert_eq!((event.inside, event.kind), (0.5, Kind::Crossing));
}

#[test]
fn a_window_may_start_anywhere() {
    let start = 0.45152398;
    let g = |t: f64| (t - start) * (1e-9 - (t - start));
    let event = crossing(search(g, start, start + 1.0, Watch::Dormant, 0.0), g);
    assert_eq!(event.kind, Kind::Crossing);
    assert_near(event.outside, start + 1e-9, 1e-16);
    // A polynomial that is dormant at 1/4 with a double zero, and falls at 3/4.
    let p: Polynomial<4> = product(&[&[-0.25, 1.0], &[-0.25, 1.0], &[0.75, -1.0]]);
    let event = crossing(p.search(0.25, 1.0, Watch::Dormant, 0.0), |s| p.value(s));
    assert_eq!((event.inside, event.kind), (0.75, Kind::Crossing));
}

#[test]
fn exact_touches_are_found() {
    for place in [0.5, 0.375, 0.25 + 1.0 / 1024.0] {
        let p: Polynomial<5> =
            product(&[&[place, -1.0], &[place, -1.0], &[3.0, -1.0], &[2.0, 1.0]]);
        let event = crossing(p.search(0.0, 1.0, Watch::Armed, 0.0), |s| p.value(s));
        // At the double zero the value is exact; beside it, it may be negative by rounding.
        assert!(
            matches!(event.kind, Kind::Touch | Kind::Crossing),
            "{event:?}"
        );
        assert_near(event.inside, place, f64::EPSILON.sqrt());
        for place in [place, 0.3, 0.1 + 0.2] {
            let g = |t: f64| (t - place) * (t - place) * t.cos();
            let event = crossing(search(g, 0.0, 1.0, Watch::Armed, 0.0), g);
            assert_eq!((event.inside, event.kind), (place, Kind::Touch));
        }
    }
}

#[test]
fn a_touch_from_below_and_an_inflection_are_told_apart() {
    let p: Polynomial<4> = product(&[&[0.5, -1.0], &[0.5, -1.0], &[-2.0, 1.0]]);
    let quiet = Search {
        crossing: None,
        watch: Watch::Violated,
        resolved: true,
        turn: f64::INFINITY,
    };
    assert_eq!(p.search(0.0, 1.0, Watch::Violated, 0.0), quiet);
    let p: Polynomial<4> = product(&[&[0.5, -1.0], &[0.5, -1.0], &[0.5, -1.0]]);
    let event = crossing(p.search(0.0, 1.0, Watch::Armed, 0.0), |s| p.value(s));
    assert_eq!((event.inside, event.kind), (0.5, Kind::Crossing));
}

#[test]
fn a_crossing_at_the_end_is_found_once() {
    let g = |t: f64| 0.5 - t;
    let p = polynomial([0.5, -1.0]);
    let by_function = |from, to, watch| search(g, from, to, watch, 0.0);
    let by_polynomial = |from, to, watch| p.search(from, to, watch, 0.0);
    let both: [&dyn Fn(f64, f64, Watch) -> Search; 2] = [&by_function, &by_polynomial];
    for find in both {
        // Exactly zero at the end has not fallen; it does with the next double.
        let first = find(0.0, 0.5, Watch::Armed);
        assert_eq!((first.crossing, first.watch), (None, Watch::Armed));
        let event = crossing(find(0.5, 1.0, first.watch), g);
        assert_eq!(event.inside, 0.5);
        let event = crossing(find(0.0, 0.5_f64.next_up(), Watch::Armed), g);
        assert_eq!(event.inside, 0.5);
        // Beyond the event it is violated, and does not fire again.
        let after = find(event.outside, 1.0, Watch::Violated);
        assert_eq!((after.crossing, after.watch), (None, Watch::Violated));
    }
    // A touch at the end is reported when the guard has left zero.
    let g = |t: f64| (t - 0.5) * (t - 0.5);
    let first = search(g, 0.0, 0.5, Watch::Armed, 0.0);
    assert_eq!((first.crossing, first.watch), (None, Watch::Armed));
    let event = crossing(search(g, 0.5, 1.0, first.watch, 0.0), g);
    assert_eq!((event.inside, event.kind), (0.5, Kind::Touch));
    let after = search(g, event.outside, 1.0, Watch::of(g(event.outside)), 0.0);
    assert_eq!((after.crossing, after.watch), (None, Watch::Armed));
}

// Reference 10p: the stop and the wall at x(t) = t − t² coincide.
#[test]
fn coinciding_events_are_a_set() {
    let guards = [[1.0, -2.0, 0.0], [1.0, 0.0, 0.0], [0.25, -1.0, 1.0]].map(polynomial);
    let mut found = blank::<3>();
    let set = earliest(
        0.0,
        1.0,
        &[Watch::Armed; 3],
        &mut found,
        |i, from, to, watch, found| *found = guards[i].search(from, to, watch, 0.0),
    );
    assert_eq!((set.time, set.resolved), (Some(0.5_f64.next_up()), true));
    let kinds = found.map(|f| f.crossing.map(|c| c.kind));
    assert_eq!(kinds, [Some(Kind::Crossing), None, Some(Kind::Touch)]);
    assert_eq!(found[1].watch, Watch::Armed);
}

#[test]
fn signs_of_the_others_are_those_at_the_event() {
    // The first falls at 0.5; the second has risen at 0.25, and would fall at 0.75; the third rises
    // only after 0.5.
    let guards = [[0.5, -1.0, 0.0], [-0.1875, 1.0, -1.0], [-0.6, 1.0, 0.0]].map(polynomial);
    let watches = [Watch::Armed, Watch::Violated, Watch::Violated];
    let mut found = blank::<3>();
    let mut find = |to| {
        let set = earliest(
            0.0,
            to,
            &watches,
            &mut found,
            |i, from, to, watch, found| {
                *found = guards[i].search(from, to, watch, 0.0);
            },
        );
        (
            set.time,
            found.map(|f| f.crossing.is_some()),
            found.map(|f| f.watch),
        )
    };
    let at_event = [Watch::Violated, Watch::Armed, Watch::Violated];
    assert_eq!(
        find(1.0),
        (Some(0.5_f64.next_up()), [true, false, false], at_event)
    );
    assert_eq!(find(0.2), (None, [false; 3], watches));
    assert_eq!(
        find(0.5),
        (
            None,
            [false; 3],
            [Watch::Armed, Watch::Armed, Watch::Violated]
        )
    );
}

#[test]
fn neighbouring_brackets_are_one_set_in_any_order() {
    let half = 0.5_f64;
    let roots = [half.next_up(), half, half.next_up().next_up(), 0.7];
    for shift in 0..4 {
        let root = |i: usize| roots[(i + shift) % 4];
        let mut found = blank::<4>();
        let set = earliest(
            0.0,
            1.0,
            &[Watch::Armed; 4],
            &mut found,
            |i, from, to, watch, found| *found = search(|t| root(i) - t, from, to, watch, 0.0),
        );
        // The earliest bracket ends where the second begins; the third shares nothing with it.
        assert_eq!(set.time, Some(half.next_up().next_up()));
        for (i, found) in found.iter().enumerate() {
            assert_eq!(found.crossing.is_some(), root(i) <= half.next_up());
        }
    }
}

#[test]
fn evaluations_stay_few() {
    let evaluations = |g: &dyn Fn(f64) -> f64| {
        let count = Cell::new(0);
        let counted = |t| {
            count.set(count.get() + 1);
            g(t)
        };
        let found = search(counted, 0.0, 1.0, Watch::of(g(0.0)), 0.0);
        (found.crossing.is_some(), count.get())
    };
    assert_eq!(evaluations(&|t| 2.0 + t.sin() - 0.3 * t * t), (false, 6));
    let (fell, count) = evaluations(&|t| (2.0 * t).cos() - 0.1);
    assert!(fell && count <= 20, "{count}");
    let (fell, count) = evaluations(&|t| t * (1.0 - t - 0.9 * t.sin()));
    assert!(fell && count <= 48, "{count}");
    let (fell, count) = evaluations(&|t| if t < 0.3 { 1.0 } else { -1.0 });
    assert!(fell && count < 1802, "{count}");
}

#[test]
fn an_oscillation_within_the_window_is_resolved_by_halving() {
    let g = |t: f64| 0.3 + (40.0 * t).cos();
    let (mut from, mut watch) = (0.0, Watch::Armed);
    for k in 0..3 {
        let found = search(g, from, 1.0, watch, 0.0);
        let event = crossing(found, g);
        let expected = ((-0.3_f64).acos() + f64::from(k) * std::f64::consts::TAU) / 40.0;
        assert_near(event.outside, expected, 1e-15);
        (from, watch) = (event.outside, found.watch);
    }
    // Dormant at first.
    let g = |t: f64| (200.0 * t).sin();
    let event = crossing(search(g, 0.0, 1.0, Watch::Dormant, 0.0), g);
    assert_near(event.outside, std::f64::consts::PI / 200.0, 1e-17);
}

/// The window's halves, 2⁻²⁶ of which are a whole number of units in the last place.
#[test]
fn what_a_rounded_argument_does_to_the_value_is_rounding() {
    let roots = [0.5065669060998059, 0.5069113974395631, 0.507428134449199];
    let g = |t: f64| -roots.iter().map(|root| t - root).product::<f64>();
    let from = roots[0].next_up();
    let found = search(g, from, 0.5075682633240519, Watch::Violated, 0.0);
    assert!(found.resolved);
    assert_eq!(crossing(found, g).inside, roots[2]);
}

/// Sums of cosines with up to two periods in the window, of which the sample that tests degree 4 lies by
/// chance near the interpolant, which does not see the fall.
#[test]
fn a_sample_that_agrees_by_chance_is_not_trusted() {
    let cases: [(f64, &[[f64; 3]]); 5] = [
        (
            0.9948413933367637,
            &[
                [-0.6245572369216521, 3.982353861720448, 2.7708701551821897],
                [-0.7778508172567629, 11.008144964035386, 4.616578605698934],
                [-0.44077497865819915, 4.19387545893391, 0.8539644786259628],
                [-0.6234977525954151, 8.190859915851908, 1.544485321138374],
            ],
        ),
        (
            0.5779143147010717,
            &[
                [0.40796598083797897, 3.628866443633302, 0.5688810056791723],
                [0.6601557389236483, 4.819715886525662, 3.6226939164620617],
                [0.4807985248513431, 11.694488876937482, 1.1114019013114685],
                [0.4894599624329887, 6.317023236059308, 5.784881191380191],
            ],
        ),
        (
            0.7792418799737715,
            &[
                [-0.841715470715563, 10.783177265937319, 0.17773772203944066],
                [-0.753445212322944, 11.77429235052502, 3.349120579618038],
                [-0.3110945811187935, 5.938135751856436, 1.625600170421456],
            ],
        ),
        (
            0.4514021244317028,
            &[
                [-0.3282762908292636, 10.8433523246714, 4.825193583002033],
                [-0.1759546288811875, 3.690853941333196, 3.0858862160658207],
            ],
        ),
        (
            0.7623391595646282,
            &[
                [-0.23878467376547352, 2.9997983240003023, 3.337000652355397],
                [-0.6268450285839386, 11.45717217699623, 4.198170079161215],
                [-0.465931353067665, 9.451538411058142, 1.1112302505870089],
            ],
        ),
    ];
    for (offset, waves) in cases {
        let g = |t: f64| {
            let wave = |&[a, w, phase]: &[f64; 3]| a * (w * t + phase).cos();
            offset + waves.iter().map(wave).sum::<f64>()
        };
        let event = crossing(search(g, 0.0, 1.0, Watch::Armed, 0.0), g);
        let before = (0..1000).map(|k| f64::from(k) / 1000.0 * event.inside);
        assert!(before.into_iter().all(|t| g(t) > 0.0), "{offset}");
    }
}
