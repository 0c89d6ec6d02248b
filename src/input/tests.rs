//! Functions of time against closed forms, numerical quadrature and each other.

use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

use super::*;

/// ∫ f over [a, b] by Gauss–Legendre quadrature with five points on each of `panels` panels: exact
/// up to degree 9. Nodes and weights from Abramowitz and Stegun, table 25.4.
fn quadrature(f: impl Fn(f64) -> f64, a: f64, b: f64, panels: usize) -> f64 {
    let inner = (5.0 - 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let outer = (5.0 + 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
    let (near, far) = (
        (322.0 + 13.0 * 70.0_f64.sqrt()) / 900.0,
        (322.0 - 13.0 * 70.0_f64.sqrt()) / 900.0,
    );
    let nodes = [
        (0.0, 128.0 / 225.0),
        (inner, near),
        (-inner, near),
        (outer, far),
        (-outer, far),
    ];
    let half = (b - a) / (2 * panels) as f64;
    (0..panels)
        .map(|i| {
            let middle = a + (2 * i + 1) as f64 * half;
            half * nodes
                .iter()
                .map(|(x, w)| w * f(middle + x * half))
                .sum::<f64>()
        })
        .sum()
}

/// Checks both antiderivatives of `f` at `times` (increasing, from 0 on) by quadrature of `f` and
/// of its first antiderivative between knots; `panels` for each interval. Errors are
/// measured against `scale` of f, and its powers of time.
fn check_antiderivatives(f: &Function, times: &[f64], panels: usize, scale: f64) {
    let (mut at, mut integral, mut double) = (0.0, 0.0, 0.0);
    for &end in times {
        while at < end {
            let next = f.next_knot(at).min(end);
            // A quadrature node never falls on an end of its interval.
            integral += quadrature(|t| f.at(t, Side::Right).value, at, next, panels);
            double += quadrature(|t| f.at(t, Side::Right).integral, at, next, panels);
            at = next;
        }
        let jet = f.at(end, Side::Left);
        let long = end.max(1.0);
        assert!(
            (jet.integral - integral).abs() <= 1e-14 * scale * long,
            "{jet:?} {integral} at {end}"
        );
        assert!(
            (jet.double_integral - double).abs() <= 1e-14 * scale * long * long,
            "{jet:?} {double} at {end}"
        );
    }
}

fn sine(amplitude: f64, frequency: f64, phase: f64) -> Sine {
    Sine::new(amplitude, TAU * frequency, phase)
}

#[test]
fn sine_has_its_closed_form() {
    let (amplitude, omega, phase) = (20.0, TAU * 7.0, 0.3);
    let f = Function::from(sine(amplitude, 7.0, phase));
    for i in 0..200 {
        let t = i as f64 * 0.0137;
        let jet = f.at(t, Side::Right);
        let y = omega * t + phase;
        let double = amplitude / omega * (t * phase.cos() - (y.sin() - phase.sin()) / omega);
        assert!((jet.value - amplitude * y.sin()).abs() <= 1e-14 * amplitude * (1.0 + y));
        assert!(
            (jet.rate - amplitude * omega * y.cos()).abs() <= 1e-14 * amplitude * omega * (1.0 + y)
        );
        assert!((jet.integral - amplitude / omega * (phase.cos() - y.cos())).abs() <= 1e-14);
        assert!((jet.double_integral - double).abs() <= 1e-14 * (1.0 + t));
    }
}

#[test]
fn sine_keeps_full_relative_accuracy_near_its_start() {
    // ∫∫ A sin ωs = A ω t³/6 (1 − (ωt)²/20 + …), which the textbook form loses to cancellation.
    let f = Function::from(Sine::new(3.0, 2.0, 0.0));
    for t in [1e-9, 1e-6, 1e-4] {
        let jet = f.at(t, Side::Right);
        let relative = |x: f64, exact: f64| ((x - exact) / exact).abs();
        let y2 = (2.0 * t) * (2.0 * t);
        assert!(relative(jet.integral, 3.0 * t * t * (1.0 - y2 / 12.0)) < 1e-15);
        assert!(relative(jet.double_integral, t * t * t * (1.0 - y2 / 20.0)) < 1e-15);
    }
}

#[test]
fn sine_antiderivatives_agree_with_quadrature() {
    let times: Vec<f64> = (1..40).map(|i| 0.05 * i as f64).collect();
    for phase in [0.0, 0.4, -2.0, PI / 2.0] {
        check_antiderivatives(&sine(20.0, 7.0, phase).into(), &times, 40, 20.0);
    }
}

#[test]
fn sine_pulse_is_zero_outside_and_jumps_at_both_ends() {
    let f = Function::from(Sine::new(2.0, PI, PI / 2.0).between(1.0, 2.5));
    assert_eq!(f.at(0.5, Side::Right), Jet::default());
    assert_eq!(f.at(1.0, Side::Left).value, 0.0);
    assert_eq!(f.at(1.0, Side::Right).value, 2.0);
    assert!(f.at(2.5, Side::Left).value.abs() < 1e-15);
    assert!((f.at(2.5, Side::Left).rate - 2.0 * PI).abs() < 1e-14);
    assert_eq!(f.at(2.5, Side::Right).rate, 0.0);
    assert_eq!(
        f.at(3.0, Side::Right).integral,
        f.at(2.5, Side::Left).integral
    );
    let breaks: Vec<f64> = breakpoints(&f);
    assert_eq!(breaks, [1.0, 2.5]);
    assert_eq!(
        (f.resolution(0.0), f.resolution(1.5), f.resolution(3.0)),
        (f64::INFINITY, 0.5, f64::INFINITY)
    );
    check_antiderivatives(&f, &[0.5, 1.0, 1.7, 2.5, 4.0], 40, 2.0);
}

fn breakpoints(f: &Function) -> Vec<f64> {
    let next = |t: &f64| Some(f.next_breakpoint(*t)).filter(|t| t.is_finite());
    std::iter::successors(next(&f64::NEG_INFINITY), next).collect()
}

fn table(
    rows: &[(f64, f64)],
    interpolation: Interpolation,
    outside: Outside,
) -> Result<Table, TableError> {
    let (times, values): (Vec<f64>, Vec<f64>) = rows.iter().copied().unzip();
    Table::new(&times, &values, interpolation, outside)
}

const ROWS: [(f64, f64); 5] = [
    (0.0, 0.0),
    (0.5, 1.0),
    (0.75, -2.0),
    (1.5, -2.0),
    (2.0, 0.0),
];

#[test]
fn linear_table_interpolates_and_has_a_joint_at_every_kink() {
    let f = Function::from(table(&ROWS, Interpolation::Linear, Outside::Zero).unwrap());
    assert_eq!(f.at(0.25, Side::Right).value, 0.5);
    assert_eq!(f.at(0.5, Side::Right).value, 1.0);
    assert_eq!(
        (f.at(0.5, Side::Left).rate, f.at(0.5, Side::Right).rate),
        (2.0, -12.0)
    );
    assert_eq!(f.at(2.5, Side::Right).value, 0.0);
    // ∫ = 0.25 − 0.125 − 1.5 − 0.5
    assert_eq!(f.at(7.0, Side::Right).integral, -1.875);
    // The value jumps at the start; at the end the slope.
    assert_eq!(breakpoints(&f), [0.0, 2.0]);
    assert_eq!(
        [0.0, 0.5, 0.75, 1.5].map(|t| f.next_joint(t)),
        [0.5, 0.75, 1.5, 2.0]
    );
    assert_eq!(f.resolution(0.1), f64::INFINITY);
}

#[test]
fn knots_on_a_straight_line_are_no_joints() {
    let rows = [(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 2.0), (4.0, 2.0)];
    let f = Function::from(table(&rows, Interpolation::Linear, Outside::Hold).unwrap());
    assert_eq!(breakpoints(&f), [0.0]);
    assert_eq!([0.0, 2.0].map(|t| f.next_joint(t)), [2.0, f64::INFINITY]);
}

#[test]
fn previous_holds_each_value_and_jumps() {
    let rows = [(0.0, 1.0), (1.0, 1.0), (2.0, -3.0), (4.0, 0.0)];
    let f = Function::from(table(&rows, Interpolation::Previous, Outside::Zero).unwrap());
    assert_eq!(
        (f.at(2.0, Side::Left).value, f.at(2.0, Side::Right).value),
        (1.0, -3.0)
    );
    assert_eq!(f.at(4.0, Side::Right).value, 0.0);
    assert_eq!(
        (
            f.at(4.0, Side::Right).integral,
            f.at(5.0, Side::Right).double_integral
        ),
        (-4.0, -4.0)
    );
    assert_eq!(breakpoints(&f), [0.0, 2.0, 4.0]);
}

#[test]
fn previous_does_not_drop_its_last_value_silently() {
    let rows = [(0.0, 1.0), (1.0, 2.0)];
    let error = table(&rows, Interpolation::Previous, Outside::Zero).unwrap_err();
    assert_eq!(error, TableError::LastValueUnused { row: 1, value: 2.0 });
    let f = Function::from(table(&rows, Interpolation::Previous, Outside::Hold).unwrap());
    assert_eq!(
        (f.at(-1.0, Side::Right).value, f.at(9.0, Side::Right).value),
        (1.0, 2.0)
    );
}

#[test]
fn spline_gives_a_cubic_back() {
    let cubic = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t + 0.25 * t * t * t;
    let double = |t: f64| t * t / 2.0 - t.powi(3) / 3.0 + t.powi(4) / 24.0 + t.powi(5) / 80.0;
    // Four points determine it; unequal spacings take part in every coefficient.
    for times in [&[0.0, 0.7, 1.0, 2.5][..], &[0.0, 0.1, 0.9, 1.0, 1.7, 2.5]] {
        let rows: Vec<_> = times.iter().map(|&t| (t, cubic(t))).collect();
        let f = Function::from(table(&rows, Interpolation::Cubic, Outside::Zero).unwrap());
        for i in 0..100 {
            let t = 0.025 * i as f64;
            let jet = f.at(t, Side::Right);
            assert!((jet.value - cubic(t)).abs() < 1e-14, "{t} {jet:?}");
            assert!((jet.rate - (-2.0 + t + 0.75 * t * t)).abs() < 1e-13);
            assert!((jet.double_integral - double(t)).abs() < 1e-14);
        }
        assert_eq!(breakpoints(&f), [0.0, 2.5]);
    }
}

#[test]
fn spline_of_two_points_is_a_line_and_of_three_a_parabola() {
    let f = Function::from(
        table(
            &[(0.0, 1.0), (2.0, 5.0)],
            Interpolation::Cubic,
            Outside::Hold,
        )
        .unwrap(),
    );
    assert_eq!(f.at(0.5, Side::Right).value, 2.0);
    let rows = [(0.0, 0.0), (1.0, 1.0), (3.0, 9.0)];
    let f = Function::from(table(&rows, Interpolation::Cubic, Outside::Hold).unwrap());
    for t in [0.25, 0.5, 2.0, 2.75] {
        assert!((f.at(t, Side::Right).value - t * t).abs() < 1e-15);
        assert!((f.at(t, Side::Right).rate - 2.0 * t).abs() < 1e-14);
    }
}

#[test]
fn spline_converges_with_order_four_up_to_its_ends() {
    let error = |n: usize| {
        let rows: Vec<_> = (0..=n)
            .map(|i| i as f64 / n as f64)
            .map(|t| (t, (5.0 * t).cos()))
            .collect();
        let f = Function::from(table(&rows, Interpolation::Cubic, Outside::Zero).unwrap());
        (0..1000)
            .map(|i| i as f64 / 1000.0)
            .map(|t| (f.at(t, Side::Right).value - (5.0 * t).cos()).abs())
            .fold(0.0, f64::max)
    };
    let order = (error(40) / error(80)).log2();
    assert!((3.8..4.3).contains(&order), "{order}");
}

/// Rows of which the last is zero.
const STEPS: [(f64, f64); 3] = [(0.0, 1.0), (1.0, -2.0), (2.0, 0.0)];

#[test]
fn pieces_of_a_spline_join_at_its_rows() {
    let f = Function::from(table(&ROWS, Interpolation::Cubic, Outside::Zero).unwrap());
    assert_eq!(f.next_joint(0.25), 0.5);
    assert_eq!(f.next_joint(0.5), 0.75);
    assert_eq!(f.next_joint(1.75), 2.0);
    assert_eq!(f.next_joint(2.0), f64::INFINITY);
    let steps = Function::from(table(&STEPS, Interpolation::Previous, Outside::Zero).unwrap());
    assert_eq!(steps.next_joint(0.25), f64::INFINITY);
}

#[test]
fn antiderivatives_start_at_t_0_wherever_the_table_starts() {
    for shift in [-1.1, -0.6, 0.0, 0.4] {
        for interpolation in [
            Interpolation::Linear,
            Interpolation::Cubic,
            Interpolation::Previous,
        ] {
            for outside in [Outside::Zero, Outside::Hold] {
                let rows = ROWS.map(|(t, y)| (t + shift, y));
                let f = Function::from(table(&rows, interpolation, outside).unwrap());
                let start = f.at(0.0, Side::Right);
                assert_eq!((start.integral, start.double_integral), (0.0, 0.0));
                // The knots of a spline are no breakpoints, so the quadrature is told of them.
                let mut times: Vec<f64> = rows.iter().map(|r| r.0).chain([0.3, 1.0, 3.5]).collect();
                times.retain(|&t| t > 0.0);
                times.sort_by(f64::total_cmp);
                check_antiderivatives(&f, &times, 1, 2.0);
                // Before t = 0 too, where ∫₀ᵗ = −∫ₜ⁰.
                let back = quadrature(|t| f.at(t, Side::Right).value, -0.1, 0.0, 1);
                let knots_inside = rows.iter().any(|(t, _)| (-0.1..0.0).contains(t));
                assert!(knots_inside || (f.at(-0.1, Side::Right).integral + back).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn long_record_keeps_its_accuracy() {
    // A plain running sum of these 100 000 pieces is wrong by 1e-12 of the velocity.
    let n = 100_000;
    let rows: Vec<_> = (0..=n).map(|i| (0.1 * i as f64, 0.1)).collect();
    let f = Function::from(table(&rows, Interpolation::Linear, Outside::Hold).unwrap());
    let end = rows[n].0;
    let jet = f.at(end, Side::Left);
    assert!((jet.integral / (0.1 * end) - 1.0).abs() < 1e-15, "{jet:?}");
    assert!(
        (jet.double_integral / (0.05 * end * end) - 1.0).abs() < 1e-15,
        "{jet:?}"
    );
}

#[test]
fn wrong_rows_are_named() {
    use Interpolation::Linear;
    use Outside::Zero;
    assert_eq!(
        table(&[(0.0, 1.0)], Linear, Zero),
        Err(TableError::TooFewRows {
            found: 1,
            needed: 2
        })
    );
    assert_eq!(
        table(&[(0.0, 1.0), (1.0, 1.0), (1.0, 2.0)], Linear, Zero),
        Err(TableError::UnsortedTime {
            row: 2,
            time: 1.0,
            previous: 1.0
        })
    );
    assert_eq!(
        table(&[(0.0, 1.0), (1.0, f64::NAN)], Linear, Zero),
        Err(TableError::NotFinite { row: 1 })
    );
    assert_eq!(
        table(
            &[(0.0, 1.0), (1.0, 0.0), (1.0 + f64::EPSILON, 1e300)],
            Linear,
            Zero
        ),
        Err(TableError::TooSteep { row: 1 })
    );
}

#[test]
fn signals_follow_the_layout_of_the_model() {
    let input = |name, kind, signal| Input {
        name,
        unit: "",
        meaning: "",
        kind,
        signal,
    };
    let inputs = [
        input("force", InputKind::Value, 3),
        input("ground", InputKind::Acceleration, 0),
    ];
    let force = Function::from(Sine::new(1.0, 1.0, 0.0));
    let ground = Function::sum([Function::constant(2.0), Function::constant(1.0)]);
    let signals = Signals::new(&inputs, vec![force, ground]);
    let mut u = [f64::NAN; 4];
    signals.evaluate(2.0, &mut u);
    assert_eq!(u[..3], [3.0, 6.0, 6.0]);
    assert!((u[3] - 2.0_f64.sin()).abs() < 1e-15);
    signals.rate(2.0, &mut u);
    assert_eq!(u[..3], [0.0, 3.0, 6.0]);
    assert!((u[3] - 2.0_f64.cos()).abs() < 1e-15);
}

#[test]
fn a_motion_goes_on_from_where_it_starts() {
    let inputs = [Input {
        name: "drive",
        unit: "",
        meaning: "",
        kind: InputKind::Acceleration,
        signal: 0,
    }];
    let mut signals = Signals::new(&inputs, vec![Sine::new(2.0, 3.0, 0.5).into()]);
    let own = |signals: &Signals| {
        let (mut u, mut rates) = ([f64::NAN; 3], [f64::NAN; 3]);
        signals.jets(0.7, Side::Right, &mut u, &mut rates);
        let mut rows = [f64::NAN; 3 * 6];
        signals.series(0.7, [&u, &rates], &[true; 3], &mut rows);
        (u, rates, rows)
    };
    let (still, _, still_rows) = own(&signals);
    signals.start(0, None, Some(5.0));
    signals.start(0, Some(-4.0), None);
    signals.set(0, Sine::new(2.0, 3.0, 0.5).into());
    let (u, rates, rows) = own(&signals);
    assert_eq!(u, [still[0], still[1] + 5.0, still[2] + (5.0 * 0.7 - 4.0)]);
    assert_eq!(rates[1..], u[..2]);
    // Their series differ in what a steady motion has.
    for (k, (row, still)) in rows.chunks(3).zip(still_rows.chunks(3)).enumerate() {
        let more = [[0.0, 5.0, -0.5], [0.0, 0.0, 5.0]].get(k).copied();
        for (i, more) in more.unwrap_or_default().into_iter().enumerate() {
            assert!((row[i] - still[i] - more).abs() < 1e-15, "{k} {i}");
        }
    }
    assert!(!signals.is_zero());
    signals.start(0, Some(0.0), Some(0.0));
    assert_eq!(own(&signals).0, still);
}

fn rows() -> impl Strategy<Value = Vec<(f64, f64)>> {
    let start = -1.0..1.0;
    let steps = prop::collection::vec((0.01..1.0, -10.0..10.0), 2..20);
    (start, steps).prop_map(|(start, steps): (f64, Vec<(f64, f64)>)| {
        let mut t = start;
        let mut rows: Vec<_> = steps
            .into_iter()
            .map(|(step, y)| {
                t += step;
                (t, y)
            })
            .collect();
        // So that it is a table for every interpolation.
        rows.last_mut().unwrap().1 = 0.0;
        rows
    })
}

fn interpolation() -> impl Strategy<Value = Interpolation> {
    prop::sample::select(vec![
        Interpolation::Linear,
        Interpolation::Cubic,
        Interpolation::Previous,
    ])
}

proptest! {
    #[test]
    fn tables_pass_through_their_rows_and_integrate_exactly(rows in rows(), interpolation in interpolation()) {
        let f = Function::from(table(&rows, interpolation, Outside::Hold).unwrap());
        for &(t, y) in &rows {
            prop_assert!((f.at(t, Side::Right).value - y).abs() <= 1e-14 * 10.0);
        }
        let positive: Vec<f64> = rows.iter().map(|r| r.0).filter(|&t| t > 0.0).collect();
        // Splines of unequal steps overshoot; their knots are no breakpoints, but times here.
        let largest = positive
            .iter()
            .flat_map(|&t| [f.at(t - 0.005, Side::Right).value.abs(), f.at(t, Side::Right).value.abs()])
            .fold(100.0, f64::max);
        check_antiderivatives(&f, &positive, 1, largest);
    }

    #[test]
    fn both_limits_agree_away_from_breakpoints(rows in rows(), interpolation in interpolation(), t in -2.0..20.0) {
        let f = Function::sum([
            table(&rows, interpolation, Outside::Zero).unwrap().into(),
            Sine::new(1.0, 3.0, 0.5).between(0.5, 1.5).into(),
        ]);
        // Splines of unequal steps overshoot between their rows.
        let largest = rows
            .windows(2)
            .flat_map(|w| [0.25, 0.5, 0.75].map(|part| w[0].0 + part * (w[1].0 - w[0].0)))
            .map(|t| f.at(t, Side::Right).value.abs())
            .fold(10.0, f64::max);
        for t in rows.iter().map(|r| r.0).chain([t]) {
            let (left, right) = (f.at(t, Side::Left), f.at(t, Side::Right));
            // The antiderivatives are continuous everywhere: sums of so many pieces, each rounded.
            let span = 1.0 + t.abs().max(rows[rows.len() - 1].0.abs());
            let rounding = 2.0 * rows.len() as f64 * f64::EPSILON * largest * span;
            prop_assert!((left.integral - right.integral).abs() <= rounding);
            prop_assert!((left.double_integral - right.double_integral).abs() <= rounding * span);
            if f.next_breakpoint(t.next_down()) != t {
                // The pieces of a spline round what their slopes carry over steps of up to a second, and, four terms on
                // either side, what they reach between their rows.
                let size = 1.0 + left.rate.abs();
                let of_terms = 8.0 * f64::EPSILON * largest;
                prop_assert!((left.value - right.value).abs() < 1e-13 * size + of_terms);
            }
        }
    }

    #[test]
    fn uniform_and_bisected_lookup_agree(n in 2..50_usize, t in -1.0..6.0) {
        // The same function on a uniform grid, and with one far row that spoils the mean spacing.
        let mut rows: Vec<_> = (0..=n).map(|i| (0.1 * i as f64, (i % 7) as f64)).collect();
        let uniform = Function::from(table(&rows, Interpolation::Linear, Outside::Hold).unwrap());
        rows.push((1e6, rows[n].1));
        let skewed = Function::from(table(&rows, Interpolation::Linear, Outside::Hold).unwrap());
        for t in rows[..=n].iter().map(|r| r.0).chain([t]) {
            for side in [Side::Left, Side::Right] {
                prop_assert_eq!(uniform.at(t, side).value, skewed.at(t, side).value);
            }
        }
    }
}

/// Side by side or one after the other: a sum is the sum of its terms, to the bit, and so are its coefficients to rounding.
#[test]
fn sums_of_many_sines_are_the_sums_of_their_terms() {
    let sine = |k: u32| {
        let k = f64::from(k);
        let sine = Sine::new(1.0 / k, 0.7 * k * 2.0_f64.sqrt(), k);
        sine.between(0.1 * k, 0.1 * k + 3.0)
    };
    for count in [1, 2, 8, 9, 27] {
        let single = |k: u32| match k {
            5 => Function::constant(0.3),
            _ => sine(k).into(),
        };
        let all = Function::sum((1..=count).map(single));
        for i in 0..50 {
            let t = 0.1 * f64::from(i);
            for side in [Side::Left, Side::Right] {
                let jets = (1..=count).map(|k| single(k).at(t, side));
                let sum = jets.fold(Jet::default(), |sum, jet| sum + jet);
                assert_eq!(all.at(t, side), sum, "{count} at {t}");
                let known = [sum.value, sum.rate];
                let [mut found, mut expected, mut own] = [[0.0; 21]; 3];
                all.series(t, side, known, 1, &mut found);
                for k in 1..=count {
                    let jet = single(k).at(t, side);
                    single(k).series(t, side, [jet.value, jet.rate], 1, &mut own);
                    expected.iter_mut().zip(own).for_each(|(e, own)| *e += own);
                }
                for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
                    // Of the largest of the terms, whose frequency is the highest.
                    let scale = (0.7 * f64::from(count) * 1.5).powi(k as i32).max(1.0);
                    let off = (found - expected).abs();
                    assert!(off <= 1e-14 * scale, "{count} at {t}, {k}: {off:e}");
                }
            }
        }
    }
}
