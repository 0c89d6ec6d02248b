//! Four-bar linkages with random bars, held by constraints, against the same linkage in the angle of its crank alone.

use crate::common::random::Random;
use crate::common::*;
use dalembert::hybrid::Method;

const G: f64 = 9.81;

/// A linkage whose crank turns over: it is the shortest bar, and with the longest not longer than the other two together
/// (Grashof 1883). Lengths of crank, coupler, rocker and ground.
struct Linkage {
    lengths: [f64; 4],
    /// On which side of the line from the crank's pin to the rocker's fixed one the coupler's is.
    side: f64,
}

type Point = [f64; 2];

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn less(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

/// The vector with these products with two others.
fn with_products(of: [Point; 2], products: Point) -> Point {
    let [a, b] = of;
    let determinant = a[0] * b[1] - a[1] * b[0];
    [
        (products[0] * b[1] - products[1] * a[1]) / determinant,
        (products[1] * a[0] - products[0] * b[0]) / determinant,
    ]
}

impl Linkage {
    fn random(random: &mut Random) -> Self {
        loop {
            let mut lengths = [(); 4].map(|()| random.within(0.3, 1.5));
            lengths.sort_by(f64::total_cmp);
            let [shortest, a, b, longest] = lengths;
            if shortest + longest > 0.95 * (a + b) {
                continue;
            }
            let turned = (random.next() % 3) as usize;
            let mut others = [a, b, longest];
            others.rotate_left(turned);
            let lengths = [shortest, others[0], others[1], others[2]];
            let side = if random.next().is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            return Linkage { lengths, side };
        }
    }

    /// The pins at an angle of the crank, with their first and second derivatives by it.
    fn pins(&self, angle: f64) -> [[Point; 3]; 2] {
        let [crank, coupler, rocker, ground] = self.lengths;
        let (sin, cos) = angle.sin_cos();
        let a = [
            [crank * cos, crank * sin],
            [-crank * sin, crank * cos],
            [-crank * cos, -crank * sin],
        ];
        let fixed = [ground, 0.0];
        let line = less(fixed, a[0]);
        let square = dot(line, line);
        let along = (coupler * coupler - rocker * rocker + square) / (2.0 * square);
        let across = self.side * (coupler * coupler / square - along * along).sqrt();
        let b = [
            a[0][0] + along * line[0] - across * line[1],
            a[0][1] + along * line[1] + across * line[0],
        ];
        let bars = [less(b, a[0]), less(b, fixed)];
        let first = with_products(bars, [dot(bars[0], a[1]), 0.0]);
        let relative = less(first, a[1]);
        let second = with_products(
            bars,
            [
                dot(bars[0], a[2]) - dot(relative, relative),
                -dot(first, first),
            ],
        );
        [a, [b, first, second]]
    }

    /// Inertia over the angle of the crank and half its derivative; potential energy, and its derivative.
    fn energies(&self, angle: f64) -> [f64; 4] {
        let [a, b] = self.pins(angle);
        let still = [[0.0; 2]; 3];
        let bars = [
            (self.lengths[0], still, a),
            (self.lengths[1], a, b),
            (self.lengths[2], still, b),
        ];
        let mut sums = [0.0; 4];
        for (length, p, q) in bars {
            let mass = length;
            sums[0] += mass / 3.0 * (dot(p[1], p[1]) + dot(p[1], q[1]) + dot(q[1], q[1]));
            sums[1] += mass / 6.0
                * (2.0 * dot(p[1], p[2])
                    + dot(p[1], q[2])
                    + dot(p[2], q[1])
                    + 2.0 * dot(q[1], q[2]));
            sums[2] += mass * G / 2.0 * (p[0][1] + q[0][1]);
            sums[3] += mass * G / 2.0 * (p[1][1] + q[1][1]);
        }
        sums
    }

    /// Angle and rate after a second, by the classical method of fourth order (Kutta 1901).
    fn after_a_second(&self, start: [f64; 2]) -> [f64; 2] {
        let rates = |[angle, rate]: [f64; 2]| {
            let [inertia, half_slope, _, slope] = self.energies(angle);
            [rate, -(half_slope * rate * rate + slope) / inertia]
        };
        let steps = 40_000;
        let h = 1.0 / f64::from(steps);
        let moved = |at: [f64; 2], by: [f64; 2], h: f64| [at[0] + h * by[0], at[1] + h * by[1]];
        (0..steps).fold(start, |at, _| {
            let k1 = rates(at);
            let k2 = rates(moved(at, k1, h / 2.0));
            let k3 = rates(moved(at, k2, h / 2.0));
            let k4 = rates(moved(at, k3, h));
            let mean = |i: usize| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
            moved(at, [mean(0), mean(1)], h)
        })
    }
}

#[test]
fn random_four_bars_move_as_in_the_angle_of_the_crank() {
    for seed in 0..40 {
        let mut random = Random(seed);
        let linkage = Linkage::random(&mut random);
        let start = [random.within(-3.0, 3.0), random.within(-6.0, 6.0)];
        let [angle, rate] = linkage.after_a_second(start);
        let [a, b] = linkage.pins(start[0]);
        let names = ["crank", "coupler", "rocker", "ground"];
        let parameters: Vec<(&str, f64)> = names.into_iter().zip(linkage.lengths).collect();
        let mut problem = problem("four_bar", &parameters);
        for (pin, point) in [("A", a), ("B", b)] {
            for (i, axis) in ["x", "y"].iter().enumerate() {
                let name = format!("{axis}_{pin}");
                problem.set_initial(&name, point[0][i]).unwrap();
                let name = format!("{name}.rate");
                problem.set_initial(&name, point[1][i] * start[1]).unwrap();
            }
        }
        problem.project = true;
        problem.set_tolerance(1e-13);
        problem.end.time = 1.0;
        problem.record.every = Some(0.05);
        problem.record.ledger = true;
        for method in [Method::Taylor, Method::Radau] {
            problem.method = method;
            let run = run(&problem);
            let of = format!("linkage {seed} by {method:?}");
            let [exact_a, exact_b] = linkage.pins(angle);
            let (q, v) = (&run.end.state.q, &run.end.state.v);
            let exact = [exact_a[0], exact_b[0]].concat();
            let rates = [exact_a[1], exact_b[1]].concat();
            for i in 0..4 {
                let off = [
                    q[i] - exact[i],
                    (v[i] - rate * rates[i]) / (1.0 + rate.abs()),
                ];
                let most = off[0].abs().max(off[1].abs());
                assert!(most < 2e-11, "{of}: coordinate {i} {off:?}");
            }
            for k in 0..run.trajectory.t.len() {
                let row = run.trajectory.row(k);
                let (a, b) = ([row[0], row[1]], [row[2], row[3]]);
                let fixed = [linkage.lengths[3], 0.0];
                let bars = [a, less(b, a), less(b, fixed)];
                for (bar, length) in bars.into_iter().zip(linkage.lengths) {
                    let off = dot(bar, bar).sqrt() - length;
                    // Coordinates are up to the length of the linkage: two roundings of each, squared and rooted.
                    let within = f64::EPSILON * linkage.lengths.iter().sum::<f64>();
                    assert!(off.abs() <= within, "{of}: {off:e}");
                }
            }
            let energy = run.energy.as_ref().unwrap();
            let size = energy.initial.abs() + G * linkage.lengths.iter().sum::<f64>();
            let imbalance = energy.imbalance() / size;
            assert!(imbalance.abs() <= 1e-12, "{of}: {imbalance:e}");
        }
    }
}
