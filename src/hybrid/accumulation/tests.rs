use super::*;

fn push(accumulation: &mut Accumulation, guard: usize, at: Instant, before: &[f64], after: &[f64]) {
    let signature = Signature {
        guard,
        ..Signature::default()
    };
    accumulation.compare([before, &[]]);
    accumulation.push(signature.key(), at, after);
}

fn bounce(e: f64, tolerance: f64) -> (usize, Limit) {
    let g = 9.81;
    let mut accumulation = Accumulation::new([tolerance; 2].into(), 0);
    let mut t = Instant::new((2.0f64 / g).sqrt());
    let mut v = e * (2.0 * g).sqrt();
    for k in 0.. {
        push(&mut accumulation, 1, t, &[0.0, -v], &[0.0, v]);
        if let Some(limit) = accumulation.limit(tolerance) {
            return (k, limit);
        }
        t = t.plus(2.0 * v / g);
        v *= e;
    }
    unreachable!()
}

#[test]
fn a_ball_comes_to_rest_at_the_closed_form_limit() {
    for (e, exact) in [
        (0.5, 1.354_570_922_957_192_7),
        (0.9, 8.578_949_178_728_887),
        (0.99, 89.853_204_556_160_45),
    ] {
        let (_, limit) = bounce(e, 1e-12);
        assert!(
            (limit.at.seconds() / exact - 1.0).abs() < 1e-13,
            "{e}: {limit:?}"
        );
        assert_eq!(limit.state, [0.0, 0.0]);
    }
}

#[test]
fn a_series_that_still_moves_is_not_left_out() {
    let (loose, _) = bounce(0.9, 1e-3);
    let (tight, _) = bounce(0.9, 1e-12);
    assert!(loose > 50 && tight > 250, "{loose} {tight}");
}

#[test]
fn alternating_hops_are_recognised_over_two() {
    let mut accumulation = Accumulation::new([1e-9].into(), 0);
    let mut t = Instant::new(0.0);
    let (mut long, mut short) = (1.0, 0.3);
    let mut found = None;
    for k in 0..400 {
        push(&mut accumulation, k % 2, t, &[0.0], &[long]);
        found = accumulation.limit(1e-12);
        if found.is_some() {
            break;
        }
        if k % 2 == 0 {
            t = t.plus(long);
            long *= 0.7;
        } else {
            t = t.plus(short);
            short *= 0.7;
        }
    }
    let limit = found.expect("accumulates");
    assert_eq!(limit.modes.len(), 2);
    assert!((limit.at.seconds() - 1.3 / 0.3).abs() < 1e-12, "{limit:?}");
}

/// The rest no longer advances the time, though each hop moves the state.
#[test]
fn hops_too_short_for_the_time_end_whatever_they_move() {
    let mut accumulation = Accumulation::new([1e-9].into(), 0);
    let (mut t, mut hop) = (Instant::new(0.0), 1.0);
    let found = (0..40).find_map(|k| {
        let now = if k % 2 == 0 { 1.0 } else { -1.0 };
        push(&mut accumulation, k % 2, t, &[-now], &[now]);
        t = t.plus(hop);
        hop *= if k % 2 == 0 { 0.3 } else { 1e-3 / 0.3 };
        accumulation.limit(1e-12)
    });
    let limit = found.expect("the time stands still");
    assert_eq!(limit.modes.len(), 2);
    assert!((limit.at.seconds() - 1.3 / 0.999).abs() < 1e-15);
}

#[test]
fn a_series_is_over_where_what_is_left_of_it_takes_no_time() {
    let mut accumulation = Accumulation::new([1e-9].into(), 0);
    let (mut t, mut hop) = (Instant::new(1.0), 1.0);
    let over = (0..100).find(|k| {
        push(&mut accumulation, k % 2, t, &[hop], &[-hop]);
        t = t.plus(hop);
        hop *= 0.5;
        accumulation.is_over(1e-12)
    });
    // At 3 s less than one place of it is left.
    assert_eq!(over, Some(52));
}

#[test]
fn regular_events_do_not_accumulate() {
    let mut accumulation = Accumulation::new([1.0].into(), 0);
    for k in 0..100 {
        let (at, v) = (Instant::new(k as f64 * 1e-6), 1.0);
        push(&mut accumulation, 0, at, &[-v], &[v]);
        assert!(accumulation.limit(1e-12).is_none());
        assert!(!accumulation.stands_still(at));
    }
}

#[test]
fn events_between_which_nothing_moves_stand_still() {
    for (moved, stands) in [(2.0 * f64::EPSILON, true), (1e-12, false), (0.0, false)] {
        let mut accumulation = Accumulation::new([1.0].into(), 0);
        let mut now = Instant::default();
        for k in 0..Accumulation::MEMORY + 1 {
            let (at, x) = (Instant::new(1.0 + k as f64 * 1e-15), 1.0 + k as f64 * moved);
            push(&mut accumulation, 0, at, &[x], &[x]);
            now = at;
        }
        assert_eq!(accumulation.stands_still(now), stands);
    }
}

#[test]
fn what_follows_is_foreseen_from_hops_that_shrink() {
    let mut accumulation = Accumulation::new([1e-9; 2].into(), 0);
    let mut happens = |mode: usize, t: f64| {
        let signature = Signature {
            mode,
            ..Signature::default()
        };
        accumulation.push(signature.key(), Instant::new(t), &[0.0, t]);
        accumulation.foreseen()
    };
    // From another mode, then hops of 4, 2 and 1 s.
    for t in [0.0, 0.5] {
        assert_eq!(happens(1, t), f64::INFINITY);
    }
    assert_eq!(happens(0, 1.0), f64::INFINITY);
    assert_eq!(happens(0, 5.0), f64::INFINITY);
    assert_eq!(happens(0, 7.0), f64::INFINITY);
    assert_eq!(happens(0, 8.0), 1.0);
    // One that is longer tells nothing.
    assert_eq!(happens(0, 9.5), f64::INFINITY);
    // Two kinds in turns: what follows one of them is what followed it before.
    let turns = [(1, 10.0), (0, 14.0), (1, 15.0), (0, 18.0), (1, 18.5)];
    let foreseen: Vec<f64> = turns.iter().map(|&(mode, t)| happens(mode, t)).collect();
    assert_eq!(foreseen[3..], [f64::INFINITY, 3.0]);
    assert_eq!(happens(0, 20.0), 0.5);
    assert_eq!(happens(1, 20.25), 1.5);
}

/// Impacts, all at one instant, of a light ball between the floor and a ball that is `heavy` times as heavy, which both come down
/// at 1 m/s: after how many their limit is known, and the limit.
fn squeezed(heavy: f64, e: f64) -> Option<(usize, Limit)> {
    let mut accumulation = Accumulation::new([1e-12; 4].into(), 0);
    let at = Instant::new(0.9);
    let (mut light, mut other) = (-1.0, -1.0);
    for k in 0..Accumulation::MEMORY {
        let before = [0.0, 0.0, light, other];
        match k % 2 {
            0 if light < 0.0 => light *= -e,
            1 if other < light => {
                let (mean, between) =
                    ((light + heavy * other) / (1.0 + heavy), e * (light - other));
                light = mean - between * heavy / (1.0 + heavy);
                other = mean + between / (1.0 + heavy);
            }
            // They have parted.
            _ => return None,
        }
        push(
            &mut accumulation,
            k % 2,
            at,
            &before,
            &[0.0, 0.0, light, other],
        );
        if let Some(limit) = accumulation.at_one_instant(1e-12) {
            return Some((k, limit));
        }
    }
    None
}

#[test]
fn impacts_in_turn_at_one_instant_have_a_limit() {
    for (heavy, e) in [(5.0, 0.0625), (20.0, 0.1), (20.0, 0.2), (5.0, 0.1)] {
        let (count, limit) = squeezed(heavy, e).unwrap_or_else(|| panic!("{heavy} {e}"));
        assert!(count > 6, "{heavy} {e}: {count}");
        assert_eq!(limit.at, Instant::new(0.9));
        let [light, other] = [2, 3].map(|i| limit.state[i]);
        assert!(
            light.abs() < 1e-11 && other.abs() < 1e-11,
            "{heavy} {e}: {limit:?}"
        );
    }
    // They part after a few, or go on without losing anything.
    assert_eq!(squeezed(1.0, 0.5), None);
    assert_eq!(squeezed(20.0, 1.0), None);
}
